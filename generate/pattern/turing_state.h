// SPDX-License-Identifier: Apache-2.0
// The inside of a Turing field: its planes, and what a row of one step is made from.
#pragma once
#include "stream.h"
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

struct ty_turing
{
    ty_turing_def def;
    ty_turing_rates rates;
    stream stream;                   // of U and V
    float* planes[TY_TURING_PLANES]; // [height + 2][stride], a row more above and below; NULL = not needed
    // Made from planes, of the same layout.
    float *constant, *inverse;       // dt cu; 1 / openness, 0 where closed
    float *weight, *pull_u, *pull_v; // of what is held: weight * step + pull; NULL = nothing is
};

static inline size_t ty_turing_cell(const ty_turing* field, int y)
{
    return (size_t)(y + 1) * field->stream.stride + STREAM_MARGIN;
}

// The same operations in the same order, compiled for what every machine of the build has and for AVX-512. The context
// is the field.
stream_row_fn ty_turing_row_base, ty_turing_row_avx512;
