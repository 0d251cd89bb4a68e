// SPDX-License-Identifier: Apache-2.0
// Marching tetrahedra: every cell is cut into six about its diagonal (Kuhn), so that the surface is closed whatever the
// values. Layer by layer; an edge keeps its vertex until both layers at it are done.
#include "roots.h"
#include <string.h>

enum
{
    EDGES = 7, // from a corner to the others of its cell, by the bits x = 1, y = 2, z = 4, less one
};

typedef struct march
{
    const roots_grid* grid;
    int32_t* edges[2]; // vertices of the edges that begin in this layer and in the next; -1 = none yet
    ty_vec3* positions;
    uint32_t (*triangles)[3];
    size_t vertex_count, vertex_capacity, triangle_count, triangle_capacity;
    bool failed;
} march;

// Corners of the six, all turned the same way: two of them are always joined by a path of axes.
static const uint8_t tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7},
                                         {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}};

// Room for one more; NULL and items as they were when memory ends.
static void* room(void* items, size_t count, size_t* capacity, size_t size)
{
    if (count < *capacity)
        return items;
    size_t larger = *capacity ? 2 * *capacity : 65536;
    void* grown = ty_try_grow(items, *capacity, larger, size);
    *capacity = grown ? larger : *capacity;
    return grown;
}

static float value_at(const roots_grid* grid, const int at[3])
{
    return grid
        ->values[((size_t)at[2] * (size_t)grid->size[1] + (size_t)at[1]) * (size_t)grid->size[0] + (size_t)at[0]];
}

static int32_t vertex_add(march* m, const int a[3], const int b[3])
{
    const roots_grid* grid = m->grid;
    ty_vec3* grown = room(m->positions, m->vertex_count, &m->vertex_capacity, sizeof(ty_vec3));
    if (!grown || m->vertex_count >= INT32_MAX)
    {
        m->failed = true;
        return 0;
    }
    m->positions = grown;
    // Kept off the corners, so that no triangle shrinks to nothing.
    float va = value_at(grid, a), vb = value_at(grid, b), t = ty_clamp(va / (va - vb), 0.03f, 0.97f);
    ty_vec3 offset = {(float)a[0] + t * (float)(b[0] - a[0]), (float)a[1] + t * (float)(b[1] - a[1]),
                      (float)a[2] + t * (float)(b[2] - a[2])};
    m->positions[m->vertex_count] = ty_mad(grid->origin, offset, grid->step);
    return (int32_t)m->vertex_count++;
}

// The vertex on the edge between two corners of the cell at c.
static uint32_t edge_vertex(march* m, const int c[3], int from, int to)
{
    int low = from & to, offset = from ^ to; // on a path of axes one holds the other
    int a[3] = {c[0] + (low & 1), c[1] + (low >> 1 & 1), c[2] + (low >> 2)};
    int b[3] = {a[0] + (offset & 1), a[1] + (offset >> 1 & 1), a[2] + (offset >> 2)};
    size_t corner = (size_t)a[1] * (size_t)m->grid->size[0] + (size_t)a[0];
    int32_t* slot = &m->edges[low >> 2][corner * EDGES + (size_t)offset - 1];
    if (*slot < 0)
        *slot = vertex_add(m, a, b);
    return (uint32_t)*slot;
}

static void triangle_add(march* m, uint32_t a, uint32_t b, uint32_t c, bool turned)
{
    uint32_t(*grown)[3] = room(m->triangles, m->triangle_count, &m->triangle_capacity, sizeof(*m->triangles));
    if (!grown || m->triangle_count >= UINT32_MAX)
    {
        m->failed = true;
        return;
    }
    m->triangles = grown;
    uint32_t* t = m->triangles[m->triangle_count++];
    t[0] = a;
    t[1] = turned ? c : b;
    t[2] = turned ? b : c;
}

// Inside corners to the front; every exchange mirrors the tetrahedron.
static void tetrahedron(march* m, const int c[3], const uint8_t corners[4], int inside)
{
    uint8_t v[4];
    int count = 0;
    bool turned = false;
    memcpy(v, corners, 4);
    for (int i = 0; i < 4; i++)
        if (inside >> v[i] & 1)
        {
            uint8_t moved = v[i];
            v[i] = v[count];
            v[count] = moved;
            turned ^= i != count;
            count++;
        }
    if (count == 0 || count == 4)
        return;
    if (count == 1)
        triangle_add(m, edge_vertex(m, c, v[0], v[1]), edge_vertex(m, c, v[0], v[2]), edge_vertex(m, c, v[0], v[3]),
                     turned);
    else if (count == 3)
        triangle_add(m, edge_vertex(m, c, v[0], v[3]), edge_vertex(m, c, v[1], v[3]), edge_vertex(m, c, v[2], v[3]),
                     turned);
    else
    {
        uint32_t ac = edge_vertex(m, c, v[0], v[2]), bd = edge_vertex(m, c, v[1], v[3]);
        triangle_add(m, ac, edge_vertex(m, c, v[0], v[3]), bd, turned);
        triangle_add(m, ac, bd, edge_vertex(m, c, v[1], v[2]), turned);
    }
}

static void cell_march(march* m, const int c[3])
{
    int inside = 0;
    for (int corner = 0; corner < 8; corner++)
    {
        const int at[3] = {c[0] + (corner & 1), c[1] + (corner >> 1 & 1), c[2] + (corner >> 2)};
        inside |= (value_at(m->grid, at) < 0.0f) << corner;
    }
    if (inside == 0 || inside == 255)
        return;
    for (int i = 0; i < 6; i++)
        tetrahedron(m, c, tetrahedra[i], inside);
}

static void layers_march(march* m)
{
    const int* size = m->grid->size;
    size_t layer = (size_t)size[0] * (size_t)size[1] * EDGES;
    memset(m->edges[0], 0xff, layer * sizeof(int32_t));
    for (int k = 0; k + 1 < size[2] && !m->failed; k++)
    {
        memset(m->edges[1], 0xff, layer * sizeof(int32_t));
        for (int j = 0; j + 1 < size[1]; j++)
            for (int i = 0; i + 1 < size[0]; i++)
                cell_march(m, (const int[3]){i, j, k});
        int32_t* done = m->edges[0];
        m->edges[0] = m->edges[1];
        m->edges[1] = done;
    }
}

ty_status roots_march(const roots_grid* grid, ty_mesh** out, ty_error* error)
{
    march m = {.grid = grid};
    size_t layer = (size_t)grid->size[0] * (size_t)grid->size[1] * EDGES;
    *out = NULL;
    m.edges[0] = TY_TRY_ALLOC(int32_t, layer);
    m.edges[1] = TY_TRY_ALLOC(int32_t, layer);
    m.failed = !m.edges[0] || !m.edges[1];
    if (!m.failed)
        layers_march(&m);
    ty_mesh* mesh = m.failed ? NULL : ty_mesh_create((uint32_t)m.vertex_count, (uint32_t)m.triangle_count);
    if (mesh && m.triangle_count > 0)
    {
        memcpy(mesh->positions, m.positions, m.vertex_count * sizeof(ty_vec3));
        memcpy(mesh->triangles, m.triangles, m.triangle_count * sizeof(*m.triangles));
    }
    ty_free(m.edges[0]);
    ty_free(m.edges[1]);
    ty_free(m.positions);
    ty_free(m.triangles);
    *out = mesh;
    return mesh ? TY_OK : ty_error_set(error, TY_NO_MEMORY, "no memory for the surface of roots");
}
