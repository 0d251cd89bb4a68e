// SPDX-License-Identifier: Apache-2.0
// Gray–Scott reaction–diffusion on a grid with a feed/kill pair per cell. V is what one sees.
#pragma once
#include <tsuya/base/rng.h>
#include <tsuya/base/status.h>
#include <tsuya/base/workers.h>

typedef struct ty_gray_scott ty_gray_scott; // opaque

typedef struct ty_gray_scott_def
{
    int width, height;   // cells, 8..32768 each
    float diffusion_u;   // cells^2 per step at time_step 1, > 0
    float diffusion_v;   // the same
    float time_step;     // below 2 / (8 max(diffusion_u, diffusion_v) + .2)
    float feed, kill;    // of every cell to begin with
    bool wrap_x, wrap_y; // the far side is the neighbour; else nothing passes the edge
} ty_gray_scott_def;

// Pearson 1993 ("Complex patterns in a simple system"): 2e-5, 1e-5 over 2.5 / 256 a cell; wraps both ways; stripes.
ty_gray_scott_def ty_gray_scott_def_default(void);

// u = 1 and v = 0 everywhere. Copies def. On failure *out is NULL and error names the field and the accepted range.
TY_CHECKED ty_status ty_gray_scott_create(const ty_gray_scott_def* def, ty_gray_scott** out, ty_error* error);
void ty_gray_scott_destroy(ty_gray_scott* field); // NULL is allowed

// Sets the cells nearer than radius to (x, y) to u = 1/2, v = 1/4, each within 2 % by chance, over a wrapped edge too.
void ty_gray_scott_drop(ty_gray_scott* field, float x, float y, float radius, ty_rng* rng);

// Row y of u, v, feed or kill: [width], to be read or set. Borrowed until the next step or destroy.
float* ty_gray_scott_u(ty_gray_scott* field, int y);
float* ty_gray_scott_v(ty_gray_scott* field, int y);
float* ty_gray_scott_feed(ty_gray_scott* field, int y);
float* ty_gray_scott_kill(ty_gray_scott* field, int y);

// Forward Euler with the 5-point Laplacian. The same bits for any worker count. Cannot fail; when cancelled the values
// are of no use. Separate fields may step on separate threads.
void ty_gray_scott_step(ty_gray_scott* field, int step_count, ty_workers* workers);
