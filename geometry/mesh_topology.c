// SPDX-License-Identifier: Apache-2.0
// Welds by exact position, edges, components, area, volume and convexity.
#include "mesh_edges.h"
#include <string.h>

// Radians by which an edge may bend inward in a mesh that still counts as convex: above what the rounding of float
// coordinates does to a sphere of 4096 segments (6e-8 of the radius over an edge of 1.5e-3 of it), far below a dent.
#define CONVEX_TOLERANCE 1e-4

static uint64_t position_hash(ty_vec3 p)
{
    uint32_t bits[3];
    memcpy(bits, &p, sizeof(bits));
    uint64_t h = (uint64_t)bits[0] << 32 | bits[1];
    h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ull + bits[2];
    h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ull;
    return h ^ (h >> 32);
}

// Adding zero makes -0 and +0 the same bits.
static ty_vec3 position_key(const ty_mesh* mesh, uint32_t i)
{
    ty_vec3 p = mesh->positions[i];
    return (ty_vec3){p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
}

void ty_mesh_compute_welds(ty_mesh* mesh)
{
    size_t size = 16;
    while (size < 2 * (size_t)mesh->vertex_count)
        size *= 2;
    uint32_t* table = TY_ALLOC(uint32_t, size); // vertex + 1, 0 = free
    ty_free(mesh->welds);
    mesh->welds = TY_ALLOC(uint32_t, mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 key = position_key(mesh, i);
        size_t slot = position_hash(key) & (size - 1);
        for (; table[slot]; slot = (slot + 1) & (size - 1))
        {
            ty_vec3 other = position_key(mesh, table[slot] - 1);
            if (memcmp(&key, &other, sizeof(key)) == 0)
                break;
        }
        if (!table[slot])
            table[slot] = i + 1;
        mesh->welds[i] = table[slot] - 1;
    }
    ty_free(table);
}

bool ty_triangle_is_collapsed(const ty_mesh* mesh, size_t triangle)
{
    const uint32_t* c = mesh->triangles[triangle];
    uint32_t a = mesh->welds[c[0]], b = mesh->welds[c[1]], d = mesh->welds[c[2]];
    return a == b || b == d || d == a;
}

static uint32_t edge_end(const ty_mesh* mesh, size_t h, bool high)
{
    uint32_t a = ty_half_edge_start(mesh, h), b = ty_half_edge_end(mesh, h);
    return (a < b) == high ? b : a;
}

// One stable counting pass by the higher or lower end.
static void sort_pass(const ty_mesh* mesh, const size_t* from, size_t* to, size_t count, size_t* bins, bool high)
{
    memset(bins, 0, ((size_t)mesh->vertex_count + 1) * sizeof(*bins));
    for (size_t i = 0; i < count; i++)
        bins[edge_end(mesh, from[i], high) + 1]++;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        bins[i + 1] += bins[i];
    for (size_t i = 0; i < count; i++)
        to[bins[edge_end(mesh, from[i], high)]++] = from[i];
}

size_t* ty_mesh_sort_half_edges(const ty_mesh* mesh, size_t* count)
{
    size_t all = 3 * (size_t)mesh->triangle_count, n = 0;
    size_t* order = TY_ALLOC(size_t, all);
    size_t* swap = TY_ALLOC(size_t, all);
    size_t* bins = TY_ALLOC(size_t, (size_t)mesh->vertex_count + 1);
    for (size_t h = 0; h < all; h++)
        if (!ty_triangle_is_collapsed(mesh, h / 3))
            order[n++] = h;
    sort_pass(mesh, order, swap, n, bins, true);
    sort_pass(mesh, swap, order, n, bins, false);
    ty_free(bins);
    ty_free(swap);
    *count = n;
    return order;
}

size_t ty_half_edge_run(const ty_mesh* mesh, const size_t* sorted, size_t begin, size_t count)
{
    uint32_t low = edge_end(mesh, sorted[begin], false), high = edge_end(mesh, sorted[begin], true);
    size_t end = begin + 1;
    while (end < count && edge_end(mesh, sorted[end], false) == low && edge_end(mesh, sorted[end], true) == high)
        end++;
    return end - begin;
}

// With e along the first triangle's half edge, (n1 x n2) . e is the sine of the outward bend.
static bool edge_is_convex(const ty_mesh* mesh, size_t h1, size_t h2)
{
    ty_double3 n1 = ty_double3_normalize(ty_triangle_cross(mesh, h1 / 3));
    ty_double3 n2 = ty_double3_normalize(ty_triangle_cross(mesh, h2 / 3));
    const ty_vec3* p = mesh->positions;
    ty_double3 e = ty_double3_between(p[ty_half_edge_start(mesh, h1)], p[ty_half_edge_end(mesh, h1)]);
    double bend = ty_double3_dot(ty_double3_cross(n1, n2), ty_double3_normalize(e));
    // Beyond a right angle the sine falls again: there its sign alone tells a blade's edge from the bottom of a slit.
    return ty_double3_dot(n1, n2) >= 0.0 ? bend >= -CONVEX_TOLERANCE : bend > 0.0;
}

// Counts the edges; true when every edge of exactly two triangles is convex.
static bool analyse_edges(const ty_mesh* mesh, ty_mesh_topology* out)
{
    size_t count;
    size_t* sorted = ty_mesh_sort_half_edges(mesh, &count);
    bool convex = true;
    for (size_t i = 0, run; i < count; i += run)
    {
        run = ty_half_edge_run(mesh, sorted, i, count);
        out->edges++;
        out->boundary_edges += run == 1;
        out->nonmanifold_edges += run > 2;
        if (run != 2)
            continue;
        if (ty_half_edge_start(mesh, sorted[i]) == ty_half_edge_start(mesh, sorted[i + 1]))
            out->misoriented_edges++;
        else if (convex)
            convex = edge_is_convex(mesh, sorted[i], sorted[i + 1]);
    }
    ty_free(sorted);
    return convex;
}

// Vertices that triangles use, and sets of triangles joined at vertices.
static void analyse_components(const ty_mesh* mesh, ty_mesh_topology* out)
{
    size_t* parents = TY_ALLOC(size_t, mesh->vertex_count);
    uint8_t* used = TY_ALLOC(uint8_t, mesh->vertex_count);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        parents[i] = i;
    for (size_t t = 0; t < mesh->triangle_count; t++)
    {
        if (ty_triangle_is_collapsed(mesh, t))
            continue;
        uint32_t first = mesh->welds[mesh->triangles[t][0]];
        for (int k = 0; k < 3; k++)
        {
            uint32_t v = mesh->welds[mesh->triangles[t][k]];
            used[v] = 1;
            ty_set_join(parents, first, v);
        }
    }
    for (size_t i = 0; i < mesh->vertex_count; i++)
    {
        out->welded_vertices += used[i];
        out->components += used[i] && parents[i] == i;
    }
    ty_free(used);
    ty_free(parents);
}

// The volume is summed about the first vertex, so that a mesh far from the origin loses no digits.
static void analyse_measures(const ty_mesh* mesh, ty_mesh_topology* out)
{
    for (size_t t = 0; t < mesh->triangle_count; t++)
    {
        ty_double3 cross = ty_triangle_cross(mesh, t);
        ty_double3 p = ty_double3_between(mesh->positions[0], mesh->positions[mesh->triangles[t][0]]);
        out->area += 0.5 * sqrt(ty_double3_dot(cross, cross));
        out->volume += ty_double3_dot(cross, p) / 6.0;
    }
}

void ty_mesh_analyse(const ty_mesh* mesh, ty_mesh_topology* out)
{
    TY_ASSERT(mesh->welds);
    *out = (ty_mesh_topology){0};
    bool convex_edges = analyse_edges(mesh, out);
    analyse_components(mesh, out);
    analyse_measures(mesh, out);
    out->closed = out->edges > 0 && out->boundary_edges == 0 && out->nonmanifold_edges == 0 &&
                  out->misoriented_edges == 0 && out->volume > 0.0;
    out->convex = out->closed && out->components == 1 && convex_edges;
}
