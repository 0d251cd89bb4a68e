// SPDX-License-Identifier: Apache-2.0
// The zero of a field as a mesh, on a grid that is stored only near the surface: closed, two-manifold, with good
// corners. For surfaces of millions of triangles.
#pragma once
#include <tsuya/base/workers.h>
#include <tsuya/geometry/mesh.h>

enum
{
    TY_NET_BLOCK = 8, // nodes a side of a block
    TY_NET_NODES = TY_NET_BLOCK * TY_NET_BLOCK * TY_NET_BLOCK,
};

// Writes the field at the nodes of a block, [z][y][x], negative inside, in units of length: near the surface about the
// distance. Any thread.
typedef void ty_net_fill(void* context, const int block[3], float values[TY_NET_NODES]);

typedef struct ty_net_def
{
    ty_vec3 origin; // of node 0, m
    float step;     // m, between nodes
    int blocks[3];  // of the whole grid, fewer than 2^31 together
    // Blocks that are looked at, [active_count], ascending numbers ((z * blocks[1] + y) * blocks[0] + x), and such as
    // lie inside as a whole; all others count as outside. Each that has nodes within two steps of the surface must be
    // among the former.
    const int32_t *active, *solid;
    int active_count, solid_count;
    ty_net_fill* fill;
    void* context;
} ty_net_def;

typedef struct ty_net ty_net; // opaque

// Surface nets (Gibson 1998): one vertex for each cell that the surface passes. Where the nodes are too far apart to
// tell two sheets from one, what is between them is filled (as in Latecki 1997), so that the surface is a two-manifold
// whatever the field. TY_BAD_INPUT where there is none, TY_NO_MEMORY, TY_INTERRUPTED; *out is NULL then. The same bits
// for any number of workers, here and below.
TY_CHECKED ty_status ty_net_create(const ty_net_def* def, ty_workers* workers, ty_net** out, ty_error* error);
void ty_net_destroy(ty_net* net); // NULL is allowed

// Rounds in which each vertex goes to the middle of its neighbours and back to the field's zero. false: cancelled.
bool ty_net_relax(ty_net* net, int rounds, ty_workers* workers);

typedef struct ty_net_pieces
{
    int shells, voids; // closed surfaces that face outwards, and inwards
} ty_net_pieces;

// The largest shell as triangles, positions alone; what was left out is said (NULL is allowed). *out is NULL on
// failure.
TY_CHECKED ty_status ty_net_mesh(const ty_net* net, ty_mesh** out, ty_net_pieces* pieces, ty_error* error);

// Where a vertex may stand that is meant to go to p; one that stands there stays.
typedef ty_vec3 ty_mesh_hold(void* context, ty_vec3 p);

// Flips and collapses edges and moves vertices along the surface by fractions of an edge until no corner is smaller
// than `corner` (rad) or nothing helps any more; about what is smaller than 17 degrees then they leave it a little. Of
// closed two-manifolds, which they stay; positions and triangles alone. hold, with its context, is asked for every
// place that a vertex goes to; NULL: all may. *smallest is what is left, NULL is allowed.
TY_CHECKED ty_status ty_mesh_mend_corners(ty_mesh* mesh, float corner, ty_mesh_hold* hold, void* context,
                                          float* smallest, ty_error* error);
