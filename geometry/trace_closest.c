// SPDX-License-Identifier: Apache-2.0
// Closest points of a prototype.
#include "trace_world.h"
#include "triangle.h"

typedef struct closest_query
{
    const ty_mesh* mesh;
    ty_vec3 p;
    ty_closest best;
} closest_query;

static bool try_triangle(struct RTCPointQueryFunctionArguments* args)
{
    closest_query* query = args->userPtr;
    const ty_mesh* mesh = query->mesh;
    const uint32_t* v = mesh->triangles[args->primID];
    ty_vec3 a = mesh->positions[v[0]], b = mesh->positions[v[1]], c = mesh->positions[v[2]];
    ty_vec2 w = ty_triangle_closest(query->p, a, b, c);
    ty_vec3 at = ty_triangle_at(a, b, c, w);
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
