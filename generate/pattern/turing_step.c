// SPDX-License-Identifier: Apache-2.0
// Steps of a Turing field: what rows are made of, and many of them.
#include "turing_state.h"
#include <string.h>

enum
{
    PIECE_CELLS = 32768 // of a range: less is not worth waking a thread
};

// The openness beyond the edges: of the far side, or what the cells at the edge have.
static void open_around(const ty_turing* field)
{
    int w = field->def.width, h = field->def.height;
    bool wraps = field->def.edge == TY_TURING_WRAP;
    float* plane = field->planes[TY_TURING_OPEN];
    for (int y = 0; y < h; y++)
    {
        float* row = plane + ty_turing_cell(field, y);
        row[-1] = row[wraps ? w - 1 : 0];
        row[w] = row[wraps ? 0 : w - 1];
    }
    size_t stride = field->stream.stride;
    const float *first = plane + stride, *last = plane + (size_t)h * stride;
    memcpy(plane, wraps ? last : first, stride * sizeof *plane);
    memcpy(plane + (size_t)(h + 1) * stride, wraps ? first : last, stride * sizeof *plane);
}

static void cell_hold(const ty_turing* field, size_t i, float weight, float u, float v)
{
    field->weight[i] = weight;
    field->pull_u[i] = (1.0f - weight) * u;
    field->pull_v[i] = (1.0f - weight) * v;
}

// Implicit in the pull, which so may be as fast as one likes.
static void row_hold(const ty_turing* field, int y)
{
    const ty_turing_def* def = &field->def;
    float* const* planes = field->planes;
    for (int x = 0; x < def->width; x++)
    {
        size_t i = ty_turing_cell(field, y) + (size_t)x;
        bool edge = x == 0 || y == 0 || x == def->width - 1 || y == def->height - 1;
        if (edge && def->edge == TY_TURING_FIXED)
            cell_hold(field, i, 0.0f, def->edge_u, def->edge_v);
        else if (planes[TY_TURING_HOLD])
            cell_hold(field, i, 1.0f / (1.0f + def->time_step * planes[TY_TURING_HOLD][i]), planes[TY_TURING_HOLD_U][i],
                      planes[TY_TURING_HOLD_V][i]);
        else
            cell_hold(field, i, 1.0f, 0.0f, 0.0f);
    }
}

// What a row is made of, from the planes that were set.
static void rows_prepare(void* context, int64_t begin, int64_t end, int worker)
{
    const ty_turing* field = context;
    float* const* planes = field->planes;
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
    {
        size_t at = ty_turing_cell(field, y);
        for (size_t i = at; i < at + (size_t)field->def.width; i++)
        {
            float constant = planes[TY_TURING_CONSTANT] ? planes[TY_TURING_CONSTANT][i] : field->def.u.constant;
            field->constant[i] = field->def.time_step * constant;
            if (planes[TY_TURING_OPEN])
                field->inverse[i] = planes[TY_TURING_OPEN][i] > 0.0f ? 1.0f / planes[TY_TURING_OPEN][i] : 0.0f;
        }
        if (field->weight)
            row_hold(field, y);
    }
}

// Whether n cells from i and their neighbours, of rows above and below as well, are as open as can be.
static bool all_open(const ty_turing* field, size_t i, int n)
{
    if (!field->planes[TY_TURING_OPEN])
        return true;
    const float *at = field->planes[TY_TURING_OPEN] + i - 1, *above = at - field->stream.stride;
    const float* below = at + field->stream.stride;
    int closed = 0;
    for (int k = 0; k < n + 2; k++)
        closed |= (above[k] != 1.0f) | (at[k] != 1.0f) | (below[k] != 1.0f);
    return closed == 0;
}

static ty_turing_cells group_sort(const ty_turing* field, size_t i, int n)
{
    int held = 0, loose = 0;
    for (int k = 0; k < n && field->weight; k++)
    {
        held |= field->weight[i + (size_t)k] != 1.0f;
        loose |= field->weight[i + (size_t)k] != 0.0f;
    }
    if (field->weight && !loose)
        return TY_TURING_STILL;
    return !held && all_open(field, i, n) ? TY_TURING_EVEN : TY_TURING_MIXED;
}

static void rows_sort(void* context, int64_t begin, int64_t end, int worker)
{
    const ty_turing* field = context;
    int width = field->def.width;
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < width; x += STREAM_GROUP)
        {
            int n = width - x < STREAM_GROUP ? width - x : STREAM_GROUP;
            ty_turing_kinds(field, y)[x / STREAM_GROUP] =
                (uint8_t)group_sort(field, ty_turing_cell(field, y) + (size_t)x, n);
        }
}

void ty_turing_step(ty_turing* field, int step_count, ty_workers* workers)
{
    int64_t rows = PIECE_CELLS / field->def.width + 1;
    ty_parallel_all(workers, field->def.height, rows, rows_prepare, field);
    if (field->planes[TY_TURING_OPEN])
        open_around(field);
    if (field->kinds)
        ty_parallel_all(workers, field->def.height, rows, rows_sort, field);
    (void)!stream_steps(&field->stream, step_count, workers); // whole
}
