// SPDX-License-Identifier: Apache-2.0
// What a Gray–Scott field is made of, for the files that step it.
#pragma once
#include <tsuya/generate/gray_scott.h>

enum
{
    GS_MARGIN = 16 // cells left and right of every row: at least one is a copy
};

typedef struct gs_planes
{
    float *u, *v;
} gs_planes;

// Per step, by mark: u' = keep_u u + edge_u (up + left + right + down) + corner_u (the others) + feed - u v^2 dt.
typedef struct gs_rates
{
    float keep_u[TY_GRAY_SCOTT_MARKS], keep_v[TY_GRAY_SCOTT_MARKS];
    float feed[TY_GRAY_SCOTT_MARKS], kill[TY_GRAY_SCOTT_MARKS]; // times dt
    float base_u, base_v;                                       // keep without feed and kill
    float edge_u, edge_v, corner_u, corner_v;
    float time_step;
} gs_rates;

struct ty_gray_scott
{
    ty_gray_scott_def def;
    gs_rates rates;
    size_t stride;         // of a row, cells
    gs_planes front, back; // [height][stride], cell (0, 0) at GS_MARGIN
    float *feed, *kill;    // the same layout, times dt; NULL without
    uint8_t* marks;        // [height + 2][stride]: a row above and below
    float* memory;
};

static inline size_t gs_cell(const ty_gray_scott* field, int y)
{
    return (size_t)y * field->stride + GS_MARGIN;
}
