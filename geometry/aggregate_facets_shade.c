// SPDX-License-Identifier: Apache-2.0
// Normals and curvature of bodies whose surface was flattened where they touch.
#include "aggregate_facets.h"
#include <string.h>

#define SMOOTH 0.8f // cosine between normals of one place up to which they are one surface

static bool is_moved(const facet_scene* f, uint32_t v)
{
    return memcmp(&f->before[v], &f->mesh->positions[v], sizeof(ty_vec3)) != 0;
}

static float angle_between(ty_vec3 a, ty_vec3 b)
{
    float length = ty_length(a) * ty_length(b);
    return length > 0.0f ? ty_acos(ty_clamp(ty_dot(a, b) / length, -1.0f, 1.0f)) : 0.0f;
}

// Angle-weighted normals of the body's triangles, and which vertices lie in one that changed.
static void sums_make(const facet_scene* f, const facet_body* body, ty_vec3* sums, bool* touched)
{
    const ty_vec3* x = f->mesh->positions + body->first;
    bool mirrored = ty_affine_determinant(&body->place) < 0.0f;
    for (uint32_t t = 0; t < body->shape->triangle_count; t++)
    {
        const uint32_t* v = body->shape->triangles[t];
        ty_vec3 n = ty_cross(ty_sub(x[v[1]], x[v[0]]), ty_sub(x[v[2]], x[v[0]]));
        float length = ty_length(n);
        bool moved = false;
        for (int k = 0; k < 3; k++)
            moved = moved || is_moved(f, body->first + v[k]);
        for (int k = 0; k < 3; k++)
        {
            touched[v[k]] |= moved;
            float angle = angle_between(ty_sub(x[v[(k + 1) % 3]], x[v[k]]), ty_sub(x[v[(k + 2) % 3]], x[v[k]]));
            if (length > 0.0f)
                sums[v[k]] = ty_mad(sums[v[k]], n, (mirrored ? -angle : angle) / length);
        }
    }
}

// Vertices at one place whose normals were nearly one share them still.
static void welds_share(const facet_scene* f, const facet_body* body, const ty_vec3* sums, ty_vec3* out)
{
    const uint32_t* welds = body->shape->welds;
    const ty_vec3* normals = f->mesh->normals + body->first;
    uint32_t n = body->shape->vertex_count;
    uint32_t* next = TY_ALLOC(uint32_t, n); // of those at the same place, back to the first
    for (uint32_t v = 0; v < n; v++)
        next[v] = v;
    for (uint32_t v = 0; v < n && welds; v++)
        if (welds[v] != v)
        {
            next[v] = next[welds[v]];
            next[welds[v]] = v;
        }
    for (uint32_t v = 0; v < n; v++)
    {
        out[v] = sums[v];
        for (uint32_t u = next[v]; u != v; u = next[u])
            if (ty_dot(normals[u], normals[v]) > SMOOTH)
                out[v] = ty_add(out[v], sums[u]);
    }
    ty_free(next);
}

static void body_shade(const facet_scene* f, const facet_body* body)
{
    uint32_t n = body->shape->vertex_count;
    ty_vec3 *sums = TY_ALLOC(ty_vec3, n), *shared = TY_ALLOC(ty_vec3, n);
    bool* touched = TY_ALLOC(bool, n);
    sums_make(f, body, sums, touched);
    welds_share(f, body, sums, shared);
    for (uint32_t v = 0; v < n; v++)
    {
        uint32_t at = body->first + v;
        if (touched[v] && ty_length_sqr(shared[v]) > 0.0f)
            f->mesh->normals[at] = ty_normalize(shared[v]);
        if (f->mesh->curvature_1 && is_moved(f, at))
            f->mesh->curvature_1[at] = f->mesh->curvature_2[at] = 0.0f;
    }
    ty_free(sums);
    ty_free(shared);
    ty_free(touched);
}

static void bodies_shade(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const facet_scene* f = context;
    for (int64_t i = begin; i < end; i++)
        if (f->bodies[i].hit_count > 0)
            body_shade(f, &f->bodies[i]);
}

void facets_shade(facet_scene* f, ty_workers* workers)
{
    ty_parallel_all(workers, f->count, 16, bodies_shade, f);
}
