// SPDX-License-Identifier: Apache-2.0
// The surface at a hit: position, normals, uv; and where a ray that leaves it may begin.
#include "trace_world.h"
#include <tsuya/base/simd_vec3.h>

typedef struct corners
{
    const ty_mesh* mesh;
    const uint32_t* v;
    float w[3];
} corners;

static corners corners_of(const ty_mesh* mesh, uint32_t triangle, float u, float v)
{
    return (corners){mesh, mesh->triangles[triangle], {1.0f - u - v, u, v}};
}

// A vector at each corner.
typedef struct triple
{
    ty_f4 a, b, c;
} triple;

static inline triple triple_of(const corners* c, const ty_vec3* field)
{
    return (triple){ty_f4_load(&field[c->v[0]]), ty_f4_load(&field[c->v[1]]), ty_f4_load(&field[c->v[2]])};
}

// The same of steps, at a time within the shutter.
static triple triple_at(const corners* c, const ty_vec3* steps, float time)
{
    ty_vec3 at[3];
    for (int i = 0; i < 3; i++)
        at[i] = ty_trace_step_value(c->mesh, steps, c->v[i], time);
    return (triple){ty_f4_load(&at[0]), ty_f4_load(&at[1]), ty_f4_load(&at[2])};
}

static inline ty_f4 blend(const corners* c, const triple* t)
{
    ty_f4 ab = ty_f4_mad(ty_f4_mul(t->a, ty_f4_set(c->w[0])), t->b, ty_f4_set(c->w[1]));
    return ty_f4_mad(ab, t->c, ty_f4_set(c->w[2]));
}

static inline ty_f4 normalized(ty_f4 v, float* length)
{
    *length = sqrtf(ty_f4_dot(v, v));
    return *length > 0.0f ? ty_f4_mul(v, ty_f4_set(1.0f / *length)) : v;
}

// Largest coordinate of the sums that give the position: its rounding error, and that of the ray's own map, grows with
// it.
static inline float reach(const triple* p, const ty_f4_columns* m, ty_f4 translation)
{
    ty_f4 far = ty_f4_max(ty_f4_abs(p->a), ty_f4_max(ty_f4_abs(p->b), ty_f4_abs(p->c)));
    ty_f4 sum = ty_f4_mad(ty_f4_abs(translation), ty_f4_abs(m->x), ty_f4_xxx(far));
    sum = ty_f4_mad(ty_f4_mad(sum, ty_f4_abs(m->y), ty_f4_yyy(far)), ty_f4_abs(m->z), ty_f4_zzz(far));
    return ty_f4_largest(sum);
}

// Normals go by the inverse transpose: the cofactors over the determinant, of which the sign alone matters as long as
// nothing underflows. They stay outward under a mirror.
static inline ty_f4_columns cofactors(const ty_f4_columns* m)
{
    ty_f4_columns c = {ty_f4_cross(m->y, m->z), ty_f4_cross(m->z, m->x), ty_f4_cross(m->x, m->y)};
    float determinant = ty_f4_dot(c.x, m->x);
    ty_f4 scale = ty_f4_set(fabsf(determinant) > 1e-12f ? copysignf(1.0f, determinant) : 1.0f / determinant);
    return (ty_f4_columns){ty_f4_mul(c.x, scale), ty_f4_mul(c.y, scale), ty_f4_mul(c.z, scale)};
}

// Not of unit length, but not too short for its square either.
static inline ty_f4 triangle_normal(const triple* p)
{
    ty_f4 e1 = ty_f4_sub(p->b, p->a), e2 = ty_f4_sub(p->c, p->a), n = ty_f4_cross(e1, e2);
    if (ty_f4_dot(n, n) > 1e-24f)
        return n;
    float length;
    return normalized(ty_f4_cross(normalized(e1, &length), normalized(e2, &length)), &length);
}

// The horizon of a triangle under any multiple m of the inverse transpose of its map; n is the normal before, length
// after it. In the prototype's space a direction w has elevation n.(m^T w) / |n| |m^T w|; the last is at most the root
// of Gershgorin's bound of m m^T, exact for a similarity.
static inline float horizon_at(const ty_trace_prototype* prototype, uint32_t triangle, const ty_f4_columns* m, ty_f4 n,
                               float length)
{
    if (!prototype->horizons || prototype->horizons[triangle] == 255)
        return 1.0f;
    if (prototype->horizons[triangle] == 0)
        return 0.0f;
    float xy = fabsf(ty_f4_dot(m->x, m->y)), yz = fabsf(ty_f4_dot(m->y, m->z)), zx = fabsf(ty_f4_dot(m->z, m->x));
    float stretch_sqr = ty_max(ty_f4_dot(m->x, m->x) + xy + zx,
                               ty_max(ty_f4_dot(m->y, m->y) + xy + yz, ty_f4_dot(m->z, m->z) + yz + zx));
    float sine = (float)prototype->horizons[triangle] * (1.00001f / TY_HORIZON_STEPS);
    return ty_min(sine * sqrtf(stretch_sqr * ty_f4_dot(n, n)) / length, 1.0f);
}

static ty_vec2 blend_uv(const corners* c)
{
    const ty_vec2* uvs = c->mesh->uvs;
    ty_vec2 p = uvs[c->v[0]], q = uvs[c->v[1]], r = uvs[c->v[2]];
    return (ty_vec2){p.x * c->w[0] + q.x * c->w[1] + r.x * c->w[2], p.y * c->w[0] + q.y * c->w[1] + r.y * c->w[2]};
}

void ty_world_surface(const ty_world* world, const ty_hit* hit, ty_surface_point* out)
{
    const ty_trace_object* object = &world->objects[hit->object];
    const ty_trace_prototype* prototype = &world->prototypes[ty_trace_prototype_of(object, hit->instance)];
    const ty_mesh* mesh = prototype->mesh;
    ty_affine scratch;
    const ty_affine* to_world = ty_trace_to_world(object, hit->instance, hit->time, &scratch);
    corners c = corners_of(mesh, hit->triangle, hit->u, hit->v);
    ty_f4_columns map = ty_f4_columns_of(to_world), m = cofactors(&map);
    ty_f4 translation = ty_f4_load(&to_world->t);
    triple positions = triple_of(&c, mesh->positions), normals = triple_of(&c, mesh->normals);
    if (prototype->moving && !object->aggregate)
    {
        positions = triple_at(&c, mesh->step_positions, hit->time);
        normals = triple_at(&c, mesh->step_normals, hit->time);
    }
    float length, ignored;
    ty_f4 n = triangle_normal(&positions), ng = normalized(ty_f4_map_vector(&m, n), &length);
    ty_f4 ns = normalized(ty_f4_map_vector(&m, blend(&c, &normals)), &ignored);
    float side = ty_f4_dot(ns, ng);
    if (side < 0.0f)
        ns = ty_f4_sub(ty_f4_set(0.0f), ns);
    else if (side == 0.0f)
        ns = ng;
    ty_f4_store(&out->position, ty_f4_add(ty_f4_map_vector(&map, blend(&c, &positions)), translation));
    ty_f4_store(&out->ng, ng);
    ty_f4_store(&out->ns, ns);
    out->reach = reach(&positions, &map, translation);
    out->uv = mesh->uvs ? blend_uv(&c) : (ty_vec2){0};
    out->object = hit->object;
    out->instance = hit->instance;
    out->triangle = hit->triangle;
    out->u = hit->u;
    out->v = hit->v;
    out->footprint[0] = out->footprint[1] = (ty_vec3){0};
    out->time = hit->time;
    out->horizon = horizon_at(prototype, hit->triangle, &m, n, length);
    out->convex = prototype->topology.convex;
}

float ty_world_interpolate(const ty_world* world, const ty_surface_point* point, const float* vertex_field)
{
    corners c = corners_of(ty_world_mesh(world, point->object, point->instance), point->triangle, point->u, point->v);
    return vertex_field[c.v[0]] * c.w[0] + vertex_field[c.v[1]] * c.w[1] + vertex_field[c.v[2]] * c.w[2];
}

void ty_world_interpolate_attribute(const ty_world* world, const ty_surface_point* point,
                                    const ty_mesh_attribute* attribute, float out[4])
{
    corners c = corners_of(ty_world_mesh(world, point->object, point->instance), point->triangle, point->u, point->v);
    size_t width = (size_t)attribute->components;
    out[0] = out[1] = out[2] = out[3] = 0.0f;
    for (size_t corner = 0; corner < 3; corner++)
        for (size_t i = 0; i < width; i++)
            out[i] += attribute->values[c.v[corner] * width + i] * c.w[corner];
}
