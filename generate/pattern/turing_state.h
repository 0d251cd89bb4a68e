// SPDX-License-Identifier: Apache-2.0
// The inside of a Turing field: its planes, and what a row of one step is made from.
#pragma once
#include "stream.h"
#include <stdint.h>
#include <tsuya/generate/turing.h>

// The reactions times the step, so that a cell costs as little as it can.
typedef struct ty_turing_rates
{
    float uu, uv, u_most; // of F
    float vu, vv, v_constant, v_most;
    float keep_u, keep_v;     // 1 - dt d
    float centre_u, centre_v; // 1 - dt d - 4 dt D
    float spread_u, spread_v; // dt D
    ty_turing_limit limit;
    float slope;
    bool conservative;
} ty_turing_rates;

// What STREAM_GROUP cells of a row are to each other and to those around.
typedef enum ty_turing_cells
{
    TY_TURING_MIXED,
    TY_TURING_EVEN,  // open as all around them, none held
    TY_TURING_STILL, // all held at once: there is nothing to make
} ty_turing_cells;

struct ty_turing
{
    ty_turing_def def;
    ty_turing_rates rates;
    stream stream;                   // of U and V
    float* planes[TY_TURING_PLANES]; // [height + 2][stride], a row more above and below; NULL = not needed
    // Made from planes, of the same layout.
    float *constant, *inverse;       // dt cu; 1 / openness, 0 where closed
    float *weight, *pull_u, *pull_v; // of what is held: weight * step + pull; NULL = nothing is
    uint8_t* kinds;                  // [height][stride / STREAM_GROUP] of ty_turing_cells; NULL = nothing open or held
};

static inline size_t ty_turing_cell(const ty_turing* field, int y)
{
    return (size_t)(y + 1) * field->stream.stride + STREAM_MARGIN;
}

static inline uint8_t* ty_turing_kinds(const ty_turing* field, int y)
{
    return field->kinds + (size_t)y * (field->stream.stride / STREAM_GROUP);
}

// The same operations in the same order, compiled for what every machine of the build has and for AVX-512. The context
// is the field.
stream_row_fn ty_turing_row_base, ty_turing_row_avx512;
