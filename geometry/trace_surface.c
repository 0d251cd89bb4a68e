// SPDX-License-Identifier: Apache-2.0
// The surface at a hit: position, normals, uv; and where a ray that leaves it may begin.
#include "trace_world.h"

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

static ty_vec3 blend3(const corners* c, const ty_vec3* field)
{
    ty_vec3 sum = ty_mul(field[c->v[0]], c->w[0]);
    return ty_mad(ty_mad(sum, field[c->v[1]], c->w[1]), field[c->v[2]], c->w[2]);
}

static ty_vec3 magnitude(ty_vec3 v)
{
    return (ty_vec3){fabsf(v.x), fabsf(v.y), fabsf(v.z)};
}

// Largest coordinate of the sums that give the position: its rounding error, and that of the ray's own map, grows with
// it.
static float reach(const corners* c, const ty_affine* m)
{
    const ty_vec3* p = c->mesh->positions;
    ty_vec3 far = ty_max3(magnitude(p[c->v[0]]), ty_max3(magnitude(p[c->v[1]]), magnitude(p[c->v[2]])));
    ty_vec3 sum = ty_mad(magnitude(m->t), magnitude(m->x), far.x);
    sum = ty_mad(ty_mad(sum, magnitude(m->y), far.y), magnitude(m->z), far.z);
    return ty_max(sum.x, ty_max(sum.y, sum.z));
}

// Normals go by the inverse transpose: the cofactors over the determinant, of which the sign alone matters as long as
// nothing underflows. They stay outward under a mirror.
static ty_affine cofactors(const ty_affine* m)
{
    ty_affine c = {ty_cross(m->y, m->z), ty_cross(m->z, m->x), ty_cross(m->x, m->y), {0, 0, 0}};
    float determinant = ty_dot(c.x, m->x);
    float scale = fabsf(determinant) > 1e-12f ? copysignf(1.0f, determinant) : 1.0f / determinant;
    return (ty_affine){ty_mul(c.x, scale), ty_mul(c.y, scale), ty_mul(c.z, scale), {0, 0, 0}};
}

// Not of unit length, but not too short for its square either.
static ty_vec3 triangle_normal(const ty_vec3* positions, const uint32_t* v)
{
    ty_vec3 p = positions[v[0]], e1 = ty_sub(positions[v[1]], p), e2 = ty_sub(positions[v[2]], p);
    ty_vec3 n = ty_cross(e1, e2);
    return ty_length_sqr(n) > 1e-24f ? n : ty_normalize(ty_cross(ty_normalize(e1), ty_normalize(e2)));
}

// The horizon of a triangle under any multiple m of the inverse transpose of its map; n is the normal before, length
// after it. In the prototype's space a direction w has elevation n.(m^T w) / |n| |m^T w|; the last is at most the root
// of Gershgorin's bound of m m^T, exact for a similarity.
static float horizon_at(const ty_trace_prototype* prototype, uint32_t triangle, const ty_affine* m, ty_vec3 n,
                        float length)
{
    if (!prototype->horizons || prototype->horizons[triangle] == 255)
        return 1.0f;
    if (prototype->horizons[triangle] == 0)
        return 0.0f;
    float xy = fabsf(ty_dot(m->x, m->y)), yz = fabsf(ty_dot(m->y, m->z)), zx = fabsf(ty_dot(m->z, m->x));
    float stretch_sqr =
        ty_max(ty_dot(m->x, m->x) + xy + zx, ty_max(ty_dot(m->y, m->y) + xy + yz, ty_dot(m->z, m->z) + yz + zx));
    float sine = (float)prototype->horizons[triangle] * (1.00001f / TY_HORIZON_STEPS);
    return ty_min(sine * sqrtf(stretch_sqr * ty_length_sqr(n)) / length, 1.0f);
}

void ty_world_surface(const ty_world* world, const ty_hit* hit, ty_surface_point* out)
{
    const ty_trace_object* object = &world->objects[hit->object];
    const ty_trace_prototype* prototype = &world->prototypes[ty_trace_prototype_of(object, hit->instance)];
    const ty_mesh* mesh = prototype->mesh;
    ty_affine scratch;
    const ty_affine* to_world = ty_trace_to_world(object, hit->instance, hit->time, &scratch);
    corners c = corners_of(mesh, hit->triangle, hit->u, hit->v);
    ty_affine m = cofactors(to_world);
    ty_vec3 n = triangle_normal(mesh->positions, c.v), mapped = ty_map_vector(&m, n);
    float length = ty_length(mapped);
    ty_vec3 ng = length > 0.0f ? ty_mul(mapped, 1.0f / length) : mapped;
    ty_vec3 ns = ty_normalize(ty_map_vector(&m, blend3(&c, mesh->normals)));
    float side = ty_dot(ns, ng);
    if (side < 0.0f)
        ns = ty_neg(ns);
    else if (side == 0.0f)
        ns = ng;
    *out = (ty_surface_point){.position = ty_map_point(to_world, blend3(&c, mesh->positions)),
                              .ng = ng,
                              .ns = ns,
                              .reach = reach(&c, to_world),
                              .object = hit->object,
                              .instance = hit->instance,
                              .triangle = hit->triangle,
                              .u = hit->u,
                              .v = hit->v,
                              .time = hit->time,
                              .horizon = horizon_at(prototype, hit->triangle, &m, n, length),
                              .convex = prototype->topology.convex};
    if (mesh->uvs)
    {
        ty_vec2 a = mesh->uvs[c.v[0]], b = mesh->uvs[c.v[1]], d = mesh->uvs[c.v[2]];
        out->uv = (ty_vec2){a.x * c.w[0] + b.x * c.w[1] + d.x * c.w[2], a.y * c.w[0] + b.y * c.w[1] + d.y * c.w[2]};
    }
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

// Units in the last place as in C. Waechter and N. Binder 2019, "A fast and robust method for avoiding
// self-intersection", Ray Tracing Gems ch. 6, but of all that went into the position: under a rotated instance and on a
// large triangle the error of every axis comes from there. 32 of them; rays begin to fail at 2. The floor is set for
// scenes of millimetres (half a micrometre).
ty_vec3 ty_offset_origin(const ty_surface_point* p, ty_vec3 n)
{
    return ty_mad(p->position, n, ty_max(p->reach * 0x1p-18f, 0x1p-21f));
}
