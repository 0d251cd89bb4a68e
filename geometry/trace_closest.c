// SPDX-License-Identifier: Apache-2.0
// Closest points of a prototype.
#include "trace_world.h"

typedef struct closest_query
{
    const ty_mesh* mesh;
    ty_vec3 p;
    ty_closest best;
} closest_query;

// Closest point of a triangle as barycentric weights u, v of b and c (Ericson 2004, Real-Time Collision
// Detection, 5.1.5).
ty_vec2 ty_trace_closest_on_triangle(ty_vec3 p, ty_vec3 a, ty_vec3 b, ty_vec3 c)
{
    ty_vec3 ab = ty_sub(b, a), ac = ty_sub(c, a), ap = ty_sub(p, a), bp = ty_sub(p, b), cp = ty_sub(p, c);
    float d1 = ty_dot(ab, ap), d2 = ty_dot(ac, ap), d3 = ty_dot(ab, bp), d4 = ty_dot(ac, bp);
    float d5 = ty_dot(ab, cp), d6 = ty_dot(ac, cp);
    if (d1 <= 0.0f && d2 <= 0.0f)
        return (ty_vec2){0.0f, 0.0f};
    if (d3 >= 0.0f && d4 <= d3)
        return (ty_vec2){1.0f, 0.0f};
    if (d6 >= 0.0f && d5 <= d6)
        return (ty_vec2){0.0f, 1.0f};
    float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f)
        return (ty_vec2){d1 / (d1 - d3), 0.0f};
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f)
        return (ty_vec2){0.0f, d2 / (d2 - d6)};
    if (va <= 0.0f && d4 >= d3 && d5 >= d6)
    {
        float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (ty_vec2){1.0f - w, w};
    }
    float inverse = 1.0f / (va + vb + vc);
    return (ty_vec2){vb * inverse, vc * inverse};
}

static bool try_triangle(struct RTCPointQueryFunctionArguments* args)
{
    closest_query* query = args->userPtr;
    const ty_mesh* mesh = query->mesh;
    const uint32_t* v = mesh->triangles[args->primID];
    ty_vec3 a = mesh->positions[v[0]], b = mesh->positions[v[1]], c = mesh->positions[v[2]];
    ty_vec2 w = ty_trace_closest_on_triangle(query->p, a, b, c);
    ty_vec3 at = ty_mad(ty_mad(a, ty_sub(b, a), w.x), ty_sub(c, a), w.y);
    float distance = ty_length(ty_sub(at, query->p));
    if (!(distance < query->best.distance))
        return false;
    query->best = (ty_closest){at, distance, args->primID, w.x, w.y};
    args->query->radius = distance;
    return true;
}

bool ty_world_closest(const ty_world* world, uint32_t prototype, ty_vec3 p, float max_distance, ty_closest* out)
{
    closest_query query = {.mesh = world->prototypes[prototype].mesh, .p = p};
    query.best.distance = max_distance;
    query.best.triangle = TY_NONE;
    struct RTCPointQuery point = {p.x, p.y, p.z, 0.0f, max_distance};
    struct RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(world->prototypes[prototype].scene, &point, &context, try_triangle, &query);
    if (query.best.triangle == TY_NONE)
        return false;
    *out = query.best;
    return true;
}
