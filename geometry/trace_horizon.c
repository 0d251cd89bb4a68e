// SPDX-License-Identifier: Apache-2.0
// Horizons: how high above a triangle's plane the rest of its mesh can be seen from anywhere on it. A ray that leaves
// more steeply cannot meet the mesh again, be it convex or not.
#include "trace_world.h"
#include <tsuya/base/memory.h>

#define MOST_TRIANGLES 8192u // the work is quadratic
#define STEEPEST 0.25f       // beyond this no skip is worth it

// A triangle's plane, and the triangle in it.
typedef struct site
{
    ty_vec3 corner[3], normal;
    ty_vec3 outward[3]; // of its edges, in the plane
    float offset[3];    // of the edges' lines along those
    ty_vec3 center;
    float epsilon; // m: what lies no higher is below the start of a ray
} site;

static bool site_init(const ty_mesh* mesh, uint32_t triangle, float size, site* s)
{
    for (int i = 0; i < 3; i++)
        s->corner[i] = mesh->positions[mesh->triangles[triangle][i]];
    ty_vec3 e1 = ty_sub(s->corner[1], s->corner[0]), e2 = ty_sub(s->corner[2], s->corner[0]);
    s->normal = ty_normalize(ty_cross(ty_normalize(e1), ty_normalize(e2)));
    s->epsilon = 1e-5f * size;
    s->center = ty_mul(ty_add(s->corner[0], ty_add(s->corner[1], s->corner[2])), 1.0f / 3.0f);
    for (int i = 0; i < 3; i++)
    {
        s->outward[i] = ty_normalize(ty_cross(ty_sub(s->corner[(i + 1) % 3], s->corner[i]), s->normal));
        s->offset[i] = ty_dot(s->outward[i], s->corner[i]);
    }
    return ty_length_sqr(s->normal) > 0.5f;
}

// Tangent of the elevation of a triangle over the line m.x = c, beyond which it lies and behind which the site does:
// height and distance from the line are linear, so that their ratio is largest in a corner. TY_FLOAT_MAX: it does not
// lie beyond.
static float elevation_over_line(const site* s, const ty_vec3 corner[3], const float height[3], ty_vec3 m, float c)
{
    float distance[3], k = 0.0f;
    for (int i = 0; i < 3; i++)
    {
        distance[i] = ty_dot(m, corner[i]) - c;
        if (height[i] > s->epsilon && !(distance[i] > 0.0f))
            return TY_FLOAT_MAX;
        if (height[i] > s->epsilon)
            k = ty_max(k, height[i] / distance[i]);
    }
    for (int i = 0; i < 3; i++)
        if (height[i] > k * distance[i] + s->epsilon)
            return TY_FLOAT_MAX;
    return k;
}

// The lowest such bound of four lines: the site's edges, and one across the way to the triangle.
static float elevation(const site* s, const ty_vec3 corner[3], const float height[3])
{
    ty_vec3 center = ty_mul(ty_add(corner[0], ty_add(corner[1], corner[2])), 1.0f / 3.0f);
    ty_vec3 way = ty_sub(center, s->center);
    way = ty_normalize(ty_mad(way, s->normal, -ty_dot(way, s->normal)));
    float c = ty_max(ty_dot(way, s->corner[0]), ty_max(ty_dot(way, s->corner[1]), ty_dot(way, s->corner[2])));
    float best = elevation_over_line(s, corner, height, way, c);
    for (int i = 0; i < 3; i++)
        best = ty_min(best, elevation_over_line(s, corner, height, s->outward[i], s->offset[i]));
    return best;
}

// Sine of the horizon of a triangle; scratch holds a height a vertex.
static float horizon_of(const ty_mesh* mesh, uint32_t triangle, float size, float* restrict height)
{
    site s;
    if (!site_init(mesh, triangle, size, &s))
        return 1.0f;
    float offset = ty_dot(s.normal, s.center), top = 0.0f, tangent = 0.0f;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        height[i] = ty_dot(s.normal, mesh->positions[i]) - offset;
        top = ty_max(top, height[i]);
    }
    if (top <= s.epsilon)
        return 0.0f;
    for (uint32_t t = 0; t < mesh->triangle_count && tangent < STEEPEST; t++)
    {
        const uint32_t* v = mesh->triangles[t];
        const float h[3] = {height[v[0]], height[v[1]], height[v[2]]};
        if (t == triangle || !(h[0] > s.epsilon || h[1] > s.epsilon || h[2] > s.epsilon))
            continue;
        const ty_vec3 corner[3] = {mesh->positions[v[0]], mesh->positions[v[1]], mesh->positions[v[2]]};
        tangent = ty_max(tangent, elevation(&s, corner, h));
    }
    return tangent < STEEPEST ? tangent / sqrtf(1.0f + tangent * tangent) : 1.0f;
}

void ty_trace_find_horizons(ty_trace_prototype* prototype)
{
    const ty_mesh* mesh = prototype->mesh;
    bool convex = prototype->topology.convex;
    if (prototype->horizons || (!convex && mesh->triangle_count > MOST_TRIANGLES))
        return;
    uint8_t* horizons = TY_TRY_ALLOC(uint8_t, mesh->triangle_count);
    float* height = convex ? NULL : TY_TRY_ALLOC(float, mesh->vertex_count);
    float size = ty_length(ty_sub(prototype->bounds.high, prototype->bounds.low));
    // Without room for them rays are traced that need not be: no more than that. What is convex has zeros.
    for (uint32_t t = 0; t < mesh->triangle_count && horizons && height; t++)
        horizons[t] = (uint8_t)ty_min(ceilf(horizon_of(mesh, t, size, height) * TY_HORIZON_STEPS), 255.0f);
    if (horizons && !convex && !height)
    {
        ty_free(horizons);
        horizons = NULL;
    }
    ty_free(height);
    prototype->horizons = horizons;
}
