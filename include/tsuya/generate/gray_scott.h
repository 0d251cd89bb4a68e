// SPDX-License-Identifier: Apache-2.0
// Gray–Scott reaction–diffusion on a grid whose cells carry marks: a mark picks the feed and kill of its cell, a
// barrier is a cell where nothing is and nothing passes. V is what one sees.
#pragma once
#include <tsuya/base/rng.h>
#include <tsuya/base/status.h>
#include <tsuya/base/workers.h>

typedef struct ty_gray_scott ty_gray_scott; // opaque

// A cell's byte: its mark, 0..15, and BARRIER or'ed to it.
enum
{
    TY_GRAY_SCOTT_MARKS = 16,
    TY_GRAY_SCOTT_BARRIER = 0x80
};

typedef struct ty_gray_scott_rates
{
    float feed, kill; // F and k, 0..1
} ty_gray_scott_rates;

typedef struct ty_gray_scott_def
{
    int width, height;                              // cells, 8..32768 each
    float diffusion_u;                              // cells^2 per unit of time, above 0 and below 10
    float diffusion_v;                              // the same
    float time_step;                                // below ty_gray_scott_time_limit
    int stencil;                                    // points of the Laplacian: 5, or 9 (isotropic: 4/6 and 1/6)
    bool wrap_x, wrap_y;                            // the far side is the neighbour; else nothing passes the edge
    ty_gray_scott_rates rates[TY_GRAY_SCOTT_MARKS]; // by mark
    int rate_count;                                 // 1..16; marks beyond have the rates of mark 0
} ty_gray_scott_def;

// Pearson 1993 ("Complex patterns in a simple system"): 2e-5, 1e-5 over 2.5 / 256 a cell; wraps both ways; one mark,
// stripes.
ty_gray_scott_def ty_gray_scott_def_default(void);

// Euler's bound on time_step for the diffusions, stencil and rates of def.
float ty_gray_scott_time_limit(const ty_gray_scott_def* def);

// u = 1, v = 0 and mark 0 everywhere. Copies def. On failure *out is NULL and error names the field and the accepted
// range.
TY_CHECKED ty_status ty_gray_scott_create(const ty_gray_scott_def* def, ty_gray_scott** out, ty_error* error);
void ty_gray_scott_destroy(ty_gray_scott* field); // NULL is allowed

// Sets the cells nearer than radius to (x, y) to u = 1/2, v = 1/4, each within 2 % by chance, over a wrapped edge too.
void ty_gray_scott_drop(ty_gray_scott* field, float x, float y, float radius, ty_rng* rng);

// Row y of u, v or the marks: [width], to be read or set. Borrowed until the next step or destroy. What a barrier's
// cell holds stays as it is.
float* ty_gray_scott_u(ty_gray_scott* field, int y);
float* ty_gray_scott_v(ty_gray_scott* field, int y);
uint8_t* ty_gray_scott_marks(ty_gray_scott* field, int y);
// To be read alone: the next step need not look what has changed, and any number of threads may.
const uint8_t* ty_gray_scott_marks_seen(const ty_gray_scott* field, int y);

// Adds to the rates of each cell: planes [height][width], copied; NULL adds nothing. For maps and jitter; slower.
// Feed and kill stay above -.1 and below 1 with it, which is the caller's to see to.
TY_CHECKED ty_status ty_gray_scott_vary(ty_gray_scott* field, const float* feed, const float* kill, ty_error* error);

// Forward Euler. The same bits for any worker count. Cannot fail; when cancelled the values are of no use.
// Flush-to-zero is set while it steps and put back. Separate fields may step on separate threads.
void ty_gray_scott_step(ty_gray_scott* field, int step_count, ty_workers* workers);

// How it is computed: the same bits for all. For measurements and tests.
typedef enum ty_gray_scott_path
{
    TY_GRAY_SCOTT_BEST, // of this CPU
    TY_GRAY_SCOTT_PORTABLE,
    TY_GRAY_SCOTT_AVX2,
    TY_GRAY_SCOTT_AVX512,
} ty_gray_scott_path;

typedef struct ty_gray_scott_tuning
{
    ty_gray_scott_path path;
    int depth; // steps that a pass over memory makes, 1..64; 0: chosen, as the others
    int strip; // cells across that it makes at once
    int bands; // parts of the height
} ty_gray_scott_tuning;

// False where this CPU has no such path; nothing is changed then.
bool ty_gray_scott_tune(ty_gray_scott* field, ty_gray_scott_tuning tuning);
