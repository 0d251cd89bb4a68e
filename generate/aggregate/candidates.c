// SPDX-License-Identifier: Apache-2.0
// The grid, built by counting; its cells stay within a few for each body. Blocks.
#include "candidates.h"
#include <string.h>

enum
{
    CELLS_EACH = 8, // of a body, at most
    CELLS_LEAST = 1 << 15,
    CLASS_BLOCKS = 20,
    BLOCK_LEAST = 24, // bodies, on the mean
    BLOCK_MOST = 96,
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
    const char* first = (const char*)bodies + offset;
    body_grid g = {.cell = cell, .centers = first, .stride = stride, .count = count};
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

// --- blocks ---

// Cells of space for blocks, at least as long as those of the grid.
typedef struct layout
{
    const body_grid* grid;
    float side;
    int half[3]; // cells of one parity along each axis
} layout;

// A block wants so few bodies that its contacts fit a core's own cache, and a class so many blocks that cores share
// them evenly.
static layout layout_make(const body_grid* g)
{
    const float wanted = ty_clamp((float)g->count / (8.0f * CLASS_BLOCKS), BLOCK_LEAST, BLOCK_MOST);
    int64_t cells = (int64_t)g->size[0] * g->size[1] * g->size[2], taken = 0;
    for (int64_t c = 0; c < cells; c++)
        taken += g->start[c + 1] > g->start[c];
    layout l = {.grid = g, .side = g->cell};
    float each = (float)g->count / (float)(taken > 0 ? taken : 1);
    if (each < wanted)
        l.side *= ty_pow(wanted / each, 1.0f / 3.0f);
    for (int axis = 0; axis < 3; axis++)
        l.half[axis] = (int)((float)g->size[axis] * g->cell / l.side) / 2 + 1;
    return l;
}

static void cell_at(const layout* l, int body, int out[3])
{
    const body_grid* g = l->grid;
    ty_vec3 p = ty_sub(*(const ty_vec3*)(g->centers + (size_t)body * g->stride), g->low);
    const float along[3] = {p.x, p.y, p.z};
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (int)ty_clamp(along[axis] / l->side, 0.0f, (float)(2 * l->half[axis] - 1));
}

// Class by class, then along x, y and z.
static int block_index(const layout* l, const int* pair)
{
    int a[3], b[3], parity = 0, at[3];
    cell_at(l, pair[0], a);
    cell_at(l, pair[1], b);
    for (int axis = 0; axis < 3; axis++)
    {
        int low = a[axis] < b[axis] ? a[axis] : b[axis];
        parity |= (low & 1) << axis;
        at[axis] = low >> 1;
    }
    return ((parity * l->half[2] + at[2]) * l->half[1] + at[1]) * l->half[0] + at[0];
}

static void block_push(pair_blocks* b, int first)
{
    list_reserve((void**)&b->first, &b->capacity, b->count + 2, sizeof(int));
    b->first[b->count++] = first;
}

void pair_blocks_make(pair_blocks* b, const body_grid* g, const void* pairs, size_t stride, int count, int* order)
{
    enum
    {
        WALLS_EACH = 256, // wall pairs of a block: they share no body at all
    };
    layout l = layout_make(g);
    int each = l.half[0] * l.half[1] * l.half[2], cells = 8 * each, walls = count;
    int *next = TY_ALLOC(int, cells + 1), *index = TY_ALLOC(int, count);
    for (int i = 0; i < count && walls == count; i++)
    {
        const int* p = (const int*)((const char*)pairs + (size_t)i * stride);
        if (p[1] < 0)
            walls = i;
        else
            next[(index[i] = block_index(&l, p)) + 1]++;
    }
    b->count = 0;
    for (int c = 0; c < cells; c++)
    {
        if (c % each == 0)
            b->class_first[c / each] = b->count;
        if (next[c + 1] > 0)
            block_push(b, next[c]);
        next[c + 1] += next[c];
    }
    for (int i = 0; i < walls; i++)
        order[next[index[i]]++] = i;
    b->class_first[BLOCK_CLASSES - 1] = b->count;
    for (int i = walls; i < count; i++)
    {
        order[i] = i;
        if ((i - walls) % WALLS_EACH == 0)
            block_push(b, i);
    }
    b->class_first[BLOCK_CLASSES] = b->count;
    list_reserve((void**)&b->first, &b->capacity, b->count + 1, sizeof(int));
    b->first[b->count] = count;
    ty_free(next);
    ty_free(index);
}

typedef struct blocks_run
{
    const pair_blocks* blocks;
    int from;
    block_fn* fn;
    void* context;
} blocks_run;

static void blocks_range(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const blocks_run* r = context;
    for (int i = r->from + (int)begin; i < r->from + (int)end; i++)
        r->fn(r->context, r->blocks->first[i], r->blocks->first[i + 1]);
}

void pair_blocks_sweep(const pair_blocks* b, ty_workers* workers, block_fn* fn, void* context)
{
    enum
    {
        WORTH_SHARING = 384, // pairs of a class; below, waking a thread costs more than it gives
    };
    for (int c = 0; c < BLOCK_CLASSES; c++)
    {
        blocks_run r = {b, b->class_first[c], fn, context};
        int count = b->class_first[c + 1] - r.from;
        if (count == 0)
            continue;
        bool share = b->first[r.from + count] - b->first[r.from] >= WORTH_SHARING;
        ty_parallel_all(share ? workers : NULL, count, share ? 1 : count, blocks_range, &r);
    }
}
