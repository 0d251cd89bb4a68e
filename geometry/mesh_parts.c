// SPDX-License-Identifier: Apache-2.0
// Which parts of a mesh are closed, which are open but hold a space in, and which are sheets.
#include "mesh_edges.h"
#include "winding.h"
#include <tsuya/base/rng.h>

enum
{
    SAMPLES = 64, // triangles of a part, at which the winding number is looked at
};

#define CLEAR 0.1f // mean winding number beyond one half, just inside of a part, that makes it hold a space in

// --- parts ---

// The smallest weld of each part.
static void parts_join(const ty_mesh* mesh, size_t* parents)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        parents[i] = mesh->welds[i];
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 2; k++)
            ty_set_join(parents, mesh->triangles[t][k], mesh->triangles[t][k + 1]);
}

// A sum over all edges, each by its direction: 0 where every edge is run through as often one way as the other. Sums
// of random numbers of 64 bits do not vanish by chance.
static uint64_t edges_sum(const ty_mesh* mesh, uint32_t triangle)
{
    uint64_t sum = 0;
    for (int k = 0; k < 3; k++)
    {
        uint32_t a = mesh->welds[mesh->triangles[triangle][k]], b = mesh->welds[mesh->triangles[triangle][(k + 1) % 3]];
        uint64_t edge = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
        uint64_t number = a == b ? 0 : ty_mix64(edge + 0x9e3779b97f4a7c15u);
        sum += a < b ? number : 0 - number;
    }
    return sum;
}

// --- open parts ---

// The mean winding number just inside of the part, by area: 1/2 of a sheet; -1: no memory.
static float inside_mean(const ty_mesh* mesh, const uint32_t* triangles, uint32_t count)
{
    winding* w = winding_create(mesh, triangles, count, NULL);
    if (!w)
        return -1.0f;
    double sum = 0.0, areas = 1e-30;
    for (uint32_t s = 0; s < SAMPLES && s < count; s++)
    {
        const uint32_t* c = mesh->triangles[triangles[(uint64_t)s * count / (count < SAMPLES ? count : SAMPLES)]];
        ty_vec3 a = mesh->positions[c[0]], b = mesh->positions[c[1]], d = mesh->positions[c[2]];
        ty_vec3 n = ty_cross(ty_sub(b, a), ty_sub(d, a)), middle = ty_mul(ty_add(ty_add(a, b), d), 1.0f / 3.0f);
        float area = ty_length(n);
        if (!(area > 0.0f))
            continue;
        ty_vec3 p = ty_mad(middle, n, -1e-3f * sqrtf(area) / area);
        sum += (double)(area * ty_clamp(winding_at(w, p), -2.0f, 2.0f));
        areas += (double)area;
    }
    winding_destroy(w);
    return ty_max((float)(sum / areas), -0.99f);
}

// Triangles by part, those of the open ones: [0, count) in `order`.
static uint32_t open_order(const mesh_parts* parts, const uint32_t* part, uint32_t vertices, uint32_t triangles,
                           uint32_t* begin, uint32_t* order)
{
    uint32_t count = 0;
    for (uint32_t t = 0; t < triangles; t++)
        begin[part[t]] += parts->kind[t] != MESH_PART_CLOSED;
    for (uint32_t v = 0; v < vertices; v++)
    {
        uint32_t here = begin[v];
        begin[v] = count;
        count += here;
    }
    for (uint32_t t = 0; t < triangles; t++)
        if (parts->kind[t] != MESH_PART_CLOSED)
            order[begin[part[t]]++] = t;
    return count;
}

static bool open_judge(const ty_mesh* mesh, const uint32_t* part, uint32_t* begin, mesh_parts* out)
{
    uint32_t* order = TY_TRY_ALLOC(uint32_t, mesh->triangle_count);
    bool held = order != NULL;
    uint32_t count = held ? open_order(out, part, mesh->vertex_count, mesh->triangle_count, begin, order) : 0;
    for (uint32_t first = 0, end = 0; first < count && held; first = end)
    {
        while (end < count && part[order[end]] == part[order[first]])
            end++;
        float mean = inside_mean(mesh, order + first, end - first);
        held = mean > -1.0f;
        bool sheet = fabsf(mean - 0.5f) < CLEAR;
        for (uint32_t i = first; i < end && held; i++)
        {
            out->kind[order[i]] = sheet ? MESH_PART_SHEET : MESH_PART_OPEN;
            out->side[order[i]] = mean < 0.5f ? -1 : 1;
            if (!sheet)
                out->open[out->open_count++] = order[i];
        }
    }
    ty_free(order);
    return held;
}

// part[t]: a number below vertex_count of the part that triangle t is of.
static bool parts_judge(const ty_mesh* mesh, uint32_t* part, mesh_parts* out)
{
    uint64_t* sums = TY_TRY_ALLOC(uint64_t, mesh->vertex_count);
    uint32_t* begin = TY_TRY_ALLOC(uint32_t, mesh->vertex_count);
    bool held = sums && begin;
    out->closed = true;
    for (uint32_t t = 0; t < mesh->triangle_count && held; t++)
        sums[part[t]] += edges_sum(mesh, t);
    for (uint32_t t = 0; t < mesh->triangle_count && held; t++)
    {
        out->kind[t] = sums[part[t]] == 0 ? MESH_PART_CLOSED : MESH_PART_OPEN;
        out->closed = out->closed && sums[part[t]] == 0;
    }
    held = held && (out->closed || open_judge(mesh, part, begin, out));
    ty_free(sums);
    ty_free(begin);
    return held;
}

bool mesh_parts_find(const ty_mesh* mesh, mesh_parts* out)
{
    *out = (mesh_parts){TY_TRY_ALLOC(uint8_t, mesh->triangle_count), TY_TRY_ALLOC(int8_t, mesh->triangle_count),
                        TY_TRY_ALLOC(uint32_t, mesh->triangle_count), 0, false};
    size_t* parents = TY_TRY_ALLOC(size_t, mesh->vertex_count);
    uint32_t* part = TY_TRY_ALLOC(uint32_t, mesh->triangle_count);
    bool held = out->kind && out->side && out->open && parents && part;
    if (held)
    {
        parts_join(mesh, parents);
        for (uint32_t t = 0; t < mesh->triangle_count; t++)
            part[t] = (uint32_t)ty_set_find(parents, mesh->triangles[t][0]);
        held = parts_judge(mesh, part, out);
    }
    ty_free(parents);
    ty_free(part);
    if (!held)
        mesh_parts_term(out);
    return held;
}

void mesh_parts_term(mesh_parts* parts)
{
    ty_free(parts->kind);
    ty_free(parts->side);
    ty_free(parts->open);
    *parts = (mesh_parts){0};
}
