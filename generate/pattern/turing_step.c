// SPDX-License-Identifier: Apache-2.0
// Steps of a Turing field.
#include "turing_state.h"
#include <string.h>

enum
{
    PIECE_CELLS = 32768 // of a range: less is not worth waking a thread
};

// The border's copies of row y, and the border rows that copy it. Fixed edges stand there from the beginning.
static void border_fill(const ty_turing* field, float* plane, int y, float beyond)
{
    const ty_turing_def* def = &field->def;
    float* row = plane + ty_turing_cell(field, y);
    bool wraps = def->edge == TY_TURING_WRAP, fixed = def->edge == TY_TURING_FIXED;
    row[-1] = fixed ? beyond : row[wraps ? def->width - 1 : 0];
    row[def->width] = fixed ? beyond : row[wraps ? 0 : def->width - 1];
    float* above = plane + ty_turing_cell(field, -1) - 1;
    float* below = plane + ty_turing_cell(field, def->height) - 1;
    size_t size = (size_t)(def->width + 2) * sizeof(float);
    if (fixed)
        return;
    if (y == 0)
        memcpy(wraps ? below : above, row - 1, size);
    if (y == def->height - 1)
        memcpy(wraps ? above : below, row - 1, size);
}

static void borders_fill(const ty_turing* field, float* plane, float beyond)
{
    for (int y = 0; y < field->def.height; y++)
        border_fill(field, plane, y, beyond);
    for (int x = -1; x <= field->def.width && field->def.edge == TY_TURING_FIXED; x++)
    {
        plane[ty_turing_cell(field, -1) + (size_t)x] = beyond;
        plane[ty_turing_cell(field, field->def.height) + (size_t)x] = beyond;
    }
}

// What a row is made of, from the planes that were set.
static void row_prepare(const ty_turing* field, int y)
{
    size_t at = ty_turing_cell(field, y);
    float dt = field->def.time_step;
    float* const* planes = field->planes;
    for (int x = 0; x < field->def.width; x++)
    {
        size_t i = at + (size_t)x;
        float cu = planes[TY_TURING_CONSTANT] ? planes[TY_TURING_CONSTANT][i] : field->def.u.constant;
        field->constant[i] = dt * cu;
        if (planes[TY_TURING_OPEN])
            field->inverse[i] = planes[TY_TURING_OPEN][i] > 0.0f ? 1.0f / planes[TY_TURING_OPEN][i] : 0.0f;
        if (!planes[TY_TURING_HOLD])
            continue;
        float weight = 1.0f / (1.0f + dt * planes[TY_TURING_HOLD][i]);
        field->weight[i] = weight;
        field->pull_u[i] = (1.0f - weight) * planes[TY_TURING_HOLD_U][i];
        field->pull_v[i] = (1.0f - weight) * planes[TY_TURING_HOLD_V][i];
    }
}

static void rows_prepare(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
        row_prepare(context, y);
}

static ty_turing_rows rows_at(const ty_turing* field, int y)
{
    size_t at = ty_turing_cell(field, y), stride = field->stride;
    ty_turing_rows r = {.constant = field->constant + at, .out_u = field->next_u + at, .out_v = field->next_v + at};
    for (int i = 0; i < 3; i++)
    {
        size_t near = at + (size_t)i * stride - stride;
        r.u[i] = field->u + near;
        r.v[i] = field->v + near;
        r.open[i] = field->planes[TY_TURING_OPEN] ? field->planes[TY_TURING_OPEN] + near : NULL;
    }
    r.inverse = field->planes[TY_TURING_OPEN] ? field->inverse + at : NULL;
    if (field->planes[TY_TURING_HOLD])
    {
        r.weight = field->weight + at;
        r.pull_u = field->pull_u + at;
        r.pull_v = field->pull_v + at;
    }
    if (field->planes[TY_TURING_ALONG_SIN])
    {
        r.along_cos = field->planes[TY_TURING_ALONG_COS] + at;
        r.along_sin = field->planes[TY_TURING_ALONG_SIN] + at;
    }
    return r;
}

static void rows_step(void* context, int64_t begin, int64_t end, int worker)
{
    const ty_turing* field = context;
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
    {
        ty_turing_rows rows = rows_at(field, y);
        field->row(&field->rates, &rows, field->def.width);
        border_fill(field, field->next_u, y, field->def.edge_u);
        border_fill(field, field->next_v, y, field->def.edge_v);
    }
}

void ty_turing_step(ty_turing* field, int step_count, ty_workers* workers)
{
    int64_t rows = PIECE_CELLS / field->def.width + 1;
    ty_parallel_all(workers, field->def.height, rows, rows_prepare, field);
    borders_fill(field, field->u, field->def.edge_u);
    borders_fill(field, field->v, field->def.edge_v);
    borders_fill(field, field->next_u, field->def.edge_u);
    borders_fill(field, field->next_v, field->def.edge_v);
    if (field->planes[TY_TURING_OPEN])
        borders_fill(field, field->planes[TY_TURING_OPEN], 1.0f);
    for (int i = 0; i < step_count; i++)
    {
        if (!ty_parallel_for(workers, field->def.height, rows, rows_step, field))
            return;
        float *u = field->u, *v = field->v;
        field->u = field->next_u;
        field->v = field->next_v;
        field->next_u = u;
        field->next_v = v;
    }
}
