// SPDX-License-Identifier: Apache-2.0
// The inside of a Turing field: its planes, and what a row of one step is made from.
#pragma once
#include <tsuya/generate/turing.h>

enum
{
    TY_TURING_ALIGNED = 16, // floats: rows begin at cache lines
};

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

// Rows above, here and below, each with one cell more on both sides; NULL where a plane is not needed.
typedef struct ty_turing_rows
{
    const float *u[3], *v[3], *open[3];
    const float* constant;                 // dt cu
    const float* inverse;                  // 1 / openness; 0 where closed
    const float *weight, *pull_u, *pull_v; // what is held: weight * step + pull
    const float *along_cos, *along_sin;
    float *out_u, *out_v;
} ty_turing_rows;

typedef void ty_turing_row_fn(const ty_turing_rates* rates, const ty_turing_rows* rows, int width);
// The same operations in the same order, compiled for what every machine of the build has and for AVX-512.
ty_turing_row_fn ty_turing_row_base, ty_turing_row_avx512;

struct ty_turing
{
    ty_turing_def def;
    ty_turing_rates rates;
    ty_turing_row_fn* row;
    size_t stride;                   // of a row, floats
    float *u, *v, *next_u, *next_v;  // [height + 2][stride], cell (0, 0) at stride + TY_TURING_ALIGNED
    float* planes[TY_TURING_PLANES]; // the same layout; NULL = not needed
    float *constant, *inverse;       // made from planes: dt cu, 1 / openness
    float *weight, *pull_u, *pull_v; // made from what is held
};

static inline size_t ty_turing_cell(const ty_turing* field, int y)
{
    return (size_t)(y + 1) * field->stride + TY_TURING_ALIGNED;
}
