// SPDX-License-Identifier: Apache-2.0
// The grid, built by counting; its cells stay within a few for each body. Colours.
#include "candidates.h"
#include <string.h>

enum
{
    CELLS_EACH = 8, // of a body, at most
    CELLS_LEAST = 1 << 15,
};

void list_reserve(void** array, int* capacity, int needed, size_t size)
{
    if (needed <= *capacity)
        return;
    int grown = needed + needed / 2 + 64;
    *array = ty_grow(*array, (size_t)*capacity, (size_t)grown, size);
    *capacity = grown;
}

// --- the grid ---

static int coordinate(const body_grid* g, float x, float low, int axis)
{
    return (int)ty_clamp((x - low) / g->cell, 0.0f, (float)(g->size[axis] - 1));
}

// A body far off makes the space wide: then cells grow, which is right but slower.
static int64_t size_choose(body_grid* g, ty_vec3 extent, int count)
{
    int64_t most = (int64_t)CELLS_EACH * count + CELLS_LEAST;
    for (;; g->cell *= 1.25f)
    {
        const float along[3] = {extent.x, extent.y, extent.z};
        double cells = 1.0;
        for (int axis = 0; axis < 3; axis++)
        {
            g->size[axis] = (int)ty_clamp(along[axis] / g->cell + 1.0f, 1.0f, 1e6f);
            cells *= (double)g->size[axis];
        }
        if (cells <= (double)most)
            return (int64_t)cells;
    }
}

body_grid body_grid_create(const void* bodies, size_t offset, size_t stride, int count, float cell)
{
    body_grid g = {.cell = cell};
    const char* first = (const char*)bodies + offset;
    ty_bounds b = ty_bounds_empty();
    for (int i = 0; i < count; i++)
        b = ty_bounds_add(b, *(const ty_vec3*)(first + (size_t)i * stride));
    if (count == 0)
        b = ty_bounds_add(b, ty_vec3_make(0.0f, 0.0f, 0.0f));
    g.low = b.low;
    int64_t cells = size_choose(&g, ty_sub(b.high, b.low), count);
    g.start = TY_ALLOC(int, cells + 1);
    g.sorted = TY_ALLOC(int, count);
    g.cell_of = TY_ALLOC(int, count);
    for (int i = 0; i < count; i++)
    {
        ty_vec3 p = *(const ty_vec3*)(first + (size_t)i * stride);
        int x = coordinate(&g, p.x, g.low.x, 0), y = coordinate(&g, p.y, g.low.y, 1);
        g.cell_of[i] = (coordinate(&g, p.z, g.low.z, 2) * g.size[1] + y) * g.size[0] + x;
        g.start[g.cell_of[i] + 1]++;
    }
    for (int64_t c = 0; c < cells; c++)
        g.start[c + 1] += g.start[c];
    for (int i = count - 1; i >= 0; i--) // fills each cell from its end, and moves its end to its start
        g.sorted[--g.start[g.cell_of[i] + 1]] = i;
    memmove(g.start, g.start + 1, (size_t)cells * sizeof(int));
    g.start[cells] = count;
    return g;
}

void body_grid_destroy(body_grid* g)
{
    ty_free(g->start);
    ty_free(g->sorted);
    ty_free(g->cell_of);
}

static void list_insert(body_list* out, int j)
{
    list_reserve((void**)&out->at, &out->capacity, out->count + 1, sizeof(int));
    int at = out->count++;
    for (; at > 0 && out->at[at - 1] > j; at--)
        out->at[at] = out->at[at - 1];
    out->at[at] = j;
}

void body_grid_after(const body_grid* g, int i, body_meet_fn* meet, const void* owner, body_list* out)
{
    int c = g->cell_of[i], x = c % g->size[0], y = c / g->size[0] % g->size[1], z = c / (g->size[0] * g->size[1]);
    out->count = 0;
    for (int k = z > 0 ? z - 1 : 0; k <= z + 1 && k < g->size[2]; k++)
        for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < g->size[1]; j++)
        {
            // Neighbours along x lie one after the other.
            int row = (k * g->size[1] + j) * g->size[0];
            int begin = g->start[row + (x > 0 ? x - 1 : 0)], end = g->start[row + (x + 1 < g->size[0] ? x + 1 : x) + 1];
            for (int s = begin; s < end; s++)
                if (g->sorted[s] > i && meet(owner, i, g->sorted[s]))
                    list_insert(out, g->sorted[s]);
        }
}

int body_grid_find(const body_grid* g, ty_vec3 p, body_hold_fn* hold, const void* owner)
{
    int x = coordinate(g, p.x, g->low.x, 0), y = coordinate(g, p.y, g->low.y, 1), z = coordinate(g, p.z, g->low.z, 2);
    for (int k = z > 0 ? z - 1 : 0; k <= z + 1 && k < g->size[2]; k++)
        for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < g->size[1]; j++)
        {
            int row = (k * g->size[1] + j) * g->size[0];
            int begin = g->start[row + (x > 0 ? x - 1 : 0)], end = g->start[row + (x + 1 < g->size[0] ? x + 1 : x) + 1];
            for (int s = begin; s < end; s++)
                if (hold(owner, g->sorted[s], p))
                    return g->sorted[s];
        }
    return -1;
}

// --- colours ---

void pairs_color(const void* pairs, size_t stride, int count, int body_count, int* order, int first[PAIR_COLORS + 2])
{
    uint64_t* used = TY_ALLOC(uint64_t, body_count);
    uint8_t* color = TY_ALLOC(uint8_t, count);
    int next[PAIR_COLORS + 2] = {0};
    for (int i = 0; i < count; i++)
    {
        const int* p = (const int*)((const char*)pairs + (size_t)i * stride);
        color[i] = PAIR_COLORS;
        if (p[1] >= 0)
        {
            uint64_t open = ~(used[p[0]] | used[p[1]] | 1ull << (PAIR_COLORS - 1)) & ((1ull << PAIR_COLORS) - 1);
            color[i] = (uint8_t)(open ? __builtin_ctzll(open) : PAIR_COLORS - 1);
            used[p[0]] |= 1ull << color[i];
            used[p[1]] |= 1ull << color[i];
        }
        next[color[i] + 1]++;
    }
    for (int c = 0; c <= PAIR_COLORS; c++)
        next[c + 1] += next[c];
    memcpy(first, next, sizeof next);
    for (int i = 0; i < count; i++)
        order[next[color[i]]++] = i;
    ty_free(used);
    ty_free(color);
}
