// SPDX-License-Identifier: Apache-2.0
// What a Gray–Scott field is made of, for the files that step it.
#pragma once
#include "stream.h"
#include <tsuya/generate/gray_scott.h>

// What the groups of STREAM_GROUP cells of a row are: one mark 0..15 without a barrier near, or one of these. With how
// many groups of that kind follow, the group itself included: kind + GS_RUN_LENGTH count.
enum
{
    GS_RUN_MIXED = TY_GRAY_SCOTT_MARKS, // marks, no barriers near
    GS_RUN_BARRIERS,
    GS_RUN_VARIED, // rates have planes, no barriers near
    GS_RUN_VARIED_BARRIERS,
    GS_RUN_LENGTH = 32,
    GS_RUN_SHORT = 6,  // groups: fewer of a mark are not worth a run of their own
    GS_RUN_MOST = 2047 // groups
};

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
    stream stream;      // planes u and v; its stride is that of all rows, cell (0, 0) lies at STREAM_MARGIN
    float *feed, *kill; // [height][stride], times dt; NULL without
    uint8_t* marks;     // [height + 2][stride]: a row above and below
    uint16_t* runs;     // [height][run_stride]
    size_t run_stride;  // groups
    bool runs_valid;    // since marks or planes were touched
    float* memory;
};

static inline size_t gs_cell(const ty_gray_scott* field, int y)
{
    return (size_t)y * field->stream.stride + STREAM_MARGIN;
}

stream_row_fn gs_row_portable, gs_row_avx2, gs_row_avx512;

// Marks beyond the edges and the runs of every row.
void gs_runs_make(ty_gray_scott* field, ty_workers* workers);

// The fastest that this CPU has; NULL for a path that it has not.
stream_row_fn* gs_row_choose(ty_gray_scott_path path);
