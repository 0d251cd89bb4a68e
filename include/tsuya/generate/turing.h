// SPDX-License-Identifier: Apache-2.0
// Turing's activator-inhibitor with clamped linear reactions, on a grid that pictures and masks may steer cell by cell:
//   U' = clamp(au U + bu V + cu, 0, Fmax) - du U + Du lap U,  V' = clamp(av U + bv V + cv, 0, Gmax) - dv V + Dv lap V
// (Miyazawa, Okamoto & Kondo, "Blending of animal colour patterns by hybridization", 2010). U is what one sees.
#pragma once
#include <tsuya/base/status.h>
#include <tsuya/base/workers.h>

typedef struct ty_turing ty_turing; // opaque

typedef enum ty_turing_edge
{
    TY_TURING_FREE,  // nothing passes
    TY_TURING_FIXED, // the cells at it are edge_u and edge_v
    TY_TURING_WRAP,  // the far side is the neighbour
} ty_turing_edge;

// What diffusion is multiplied by where U is steep: 1 / (1 + slope |grad U|).
typedef enum ty_turing_limit
{
    TY_TURING_LIMIT_NONE,
    TY_TURING_LIMIT_U, // U's alone
    TY_TURING_LIMIT_BOTH,
} ty_turing_limit;

typedef struct ty_turing_reaction
{
    float u, v, constant; // a, b, c
    float decay;          // d
    float most;           // Fmax, Gmax
    float diffusion;      // cells^2 per unit of time, > 0
} ty_turing_reaction;

typedef struct ty_turing_def
{
    int width, height; // cells, 4..32768 each
    ty_turing_reaction u, v;
    float time_step;      // at most ty_turing_step_bound; 0 = ty_turing_step_default
    ty_turing_edge edge;  // of the grid, all round
    float edge_u, edge_v; // with TY_TURING_FIXED
    ty_turing_limit limit;
    float limit_slope;       // 0..1000
    bool limit_conservative; // div(g grad U), g of each face by its own difference (Perona & Malik 1990); else g lap U
} ty_turing_def;

// The labyrinth of stripes, free edges, no limit.
ty_turing_def ty_turing_def_default(void);
// Above it the fastest wave of the grid grows without end: 2 / (8 D + d), the least of both.
float ty_turing_step_bound(const ty_turing_def* def);
float ty_turing_step_default(const ty_turing_def* def); // .9 / (4 D) with the larger D

// Copies def; U and V are 0. On failure *out is NULL and error names the field and the accepted range.
TY_CHECKED ty_status ty_turing_create(const ty_turing_def* def, ty_turing** out, ty_error* error);
void ty_turing_destroy(ty_turing* field); // NULL is allowed

float ty_turing_time_step(const ty_turing* field);
// Row y of U or V: [width], to be read or set. Borrowed until the next step or destroy.
float* ty_turing_u(ty_turing* field, int y);
float* ty_turing_v(ty_turing* field, int y);

// Planes that steer single cells: each stays away, at no cost, until its row is asked for first; then the whole plane
// is there with the value that changes nothing. TY_NO_MEMORY leaves the field as it was. Values may be set until steps
// are made and between them.
typedef enum ty_turing_plane
{
    TY_TURING_CONSTANT, // cu of the cell, instead of the def's
    // How open the cell is, 0..1. What passes from a neighbour goes with min(1, its openness / mine), so that rims of
    // soft masks let nothing through either (the diffuse domain of Li, Lowengrub, Raetz & Voigt 2009). Closed cells are
    // to be held.
    TY_TURING_OPEN,
    // How fast the cell goes to hold_u and hold_v, 1/time; INFINITY = it is there and stays.
    TY_TURING_HOLD,
    TY_TURING_HOLD_U,
    TY_TURING_HOLD_V,
    // Anisotropy of U's diffusion, Du [1 + s cos, s sin; s sin, 1 - s cos] with s <= .7 and the double angle of the
    // direction along which U spreads faster: s cos and s sin.
    TY_TURING_ALONG_COS,
    TY_TURING_ALONG_SIN,
    TY_TURING_PLANES
} ty_turing_plane;
TY_CHECKED ty_status ty_turing_need(ty_turing* field, ty_turing_plane plane, ty_error* error);
bool ty_turing_has(const ty_turing* field, ty_turing_plane plane);    // whether it is there
float* ty_turing_row(ty_turing* field, ty_turing_plane plane, int y); // of a plane that is needed

// Forward Euler with the 5-point Laplacian (9 points where U's is anisotropic). The same bits for any worker count and
// any CPU. Cannot fail; all steps are made, cancelled or not.
void ty_turing_step(ty_turing* field, int step_count, ty_workers* workers);
