// SPDX-License-Identifier: Apache-2.0
// `evaluate: depth`: a random line through a point at diffusion depth beneath x, in the prototype's space. On a sphere
// the exits follow the Poisson kernel exactly.
#include "curvature_at.h"
#include "depth_field.h"
#include "lobes.h"
#include <tsuya/shading/cdrf.h>
#include <tsuya/shading/sampling.h>

#define MAX_STEPS 64

typedef struct interior
{
    const ty_world* world;
    const ty_mesh* mesh;
    uint32_t prototype;
    float thickness; // D
} interior;

typedef enum crossing
{
    CROSSING_NONE,
    CROSSING_EXIT,
    CROSSING_ENTRY, // a front face: the ray began outside
} crossing;

static crossing trace(const interior* in, ty_vec3 p, ty_vec3 w, ty_hit* hit)
{
    if (!ty_world_intersect_prototype(in->world, in->prototype, p, w, in->thickness, hit))
        return CROSSING_NONE;
    const uint32_t* v = in->mesh->triangles[hit->triangle];
    const ty_vec3* q = in->mesh->positions;
    ty_vec3 n = ty_cross(ty_sub(q[v[1]], q[v[0]]), ty_sub(q[v[2]], q[v[0]]));
    return ty_dot(n, w) >= 0.0f ? CROSSING_EXIT : CROSSING_ENTRY;
}

// Direction through the point at depth d: uniform line, its end chosen as a gambler's ruin between the two crossings of
// the osculating spheroid (axis D, curvature H at x).
static ty_vec3 line_direction(ty_frame frame, float thickness, float curvature, float depth, const float u[3])
{
    float sine, cosine, z = 2.0f * u[0] - 1.0f, s2 = 1.0f - z * z, s = ty_safe_sqrt(s2);
    ty_sincos(2.0f * TY_PI * u[1], &sine, &cosine);
    ty_vec3 w = ty_to_world(frame, ty_vec3_make(s * cosine, s * sine, z));
    float a = 0.5f * thickness, q = depth / a, m = 1.0f - q; // m of the derivation, over a
    float A = s2 * curvature / a + z * z / (a * a), B = m * z / a, C = q * (2.0f - q);
    float S = sqrtf(B * B + A * C), chance = S * a < 1e-12f ? 0.5f : 0.5f * (1.0f + B / S);
    return u[2] > chance ? ty_neg(w) : w;
}

static ty_vec3 position_local(const ty_mesh* mesh, const ty_surface_point* x)
{
    const uint32_t* v = mesh->triangles[x->triangle];
    ty_vec3 p = ty_mul(mesh->positions[v[0]], 1.0f - x->u - x->v);
    return ty_mad(ty_mad(p, mesh->positions[v[1]], x->u), mesh->positions[v[2]], x->v);
}

// The walk's first crossing, starting at depth beneath p with direction w.
static crossing walk(const interior* in, ty_vec3 p, ty_vec3 w, ty_rng* extra, ty_hit* hit)
{
    for (int i = 0; i < MAX_STEPS; i++)
    {
        crossing c = trace(in, p, w, hit);
        if (c != CROSSING_NONE)
            return c;
        p = ty_mad(p, w, in->thickness);
        float u = ty_rng_float(extra);
        w = ty_sample_sphere((ty_vec2){u, ty_rng_float(extra)});
    }
    return CROSSING_NONE;
}

bool ty_cdrf_depth_exit(const ty_shading_context* context, const ty_surface_point* x, float mean_free_path,
                        const float u[3], ty_rng* extra, ty_surface_point* exit)
{
    const ty_world* world = context->world;
    uint32_t prototype = ty_world_prototype(world, x->object, x->instance);
    const ty_depth_field* field = context->depth_fields ? context->depth_fields[prototype] : NULL;
    if (!field || mean_free_path <= 0.0f)
        return false;
    ty_affine to_world = ty_world_to_world(world, x->object, x->instance, x->time);
    interior in = {world, ty_world_prototype_mesh(world, prototype), prototype,
                   ty_world_interpolate(world, x, field->depth)};
    float curvature = ty_world_interpolate(world, x, field->curvature), k = 0.5f * curvature + 1.0f / in.thickness;
    float free_path = mean_free_path / ty_instance_scale(&to_world);
    float depth = ty_min((1.0f - ty_exp(-ty_cdrf_poisson_t(k * free_path))) / k, 0.95f * in.thickness);
    ty_vec3 p = position_local(in.mesh, x), n = ty_normalize(ty_map_transpose(&to_world, x->ns));
    // Too shallow for the coordinates to tell p from x: the light leaves where it entered.
    if (depth < 1e-6f * (fabsf(p.x) + fabsf(p.y) + fabsf(p.z)))
        return false;
    ty_vec3 w = line_direction(ty_frame_from_normal(n), in.thickness, curvature, depth, u);
    ty_hit hit;
    if (walk(&in, ty_mad(p, n, -depth), w, extra, &hit) != CROSSING_EXIT)
        return false;
    hit.object = x->object;
    hit.instance = x->instance;
    hit.time = x->time;
    ty_world_surface(world, &hit, exit);
    return true;
}
