// SPDX-License-Identifier: Apache-2.0
// What the files of tubes share: rings of vertices about a line, in frames that turn as little as can be.
#pragma once
#include "roots.h"

typedef struct tubes_def
{
    const ty_roots_recipe* recipe;
    const roots_network* network;
    int divisions; // sides of a section, at least 3
    float sag;     // how far sides and segments may be off, of the radius
    float longest; // of a segment, of the radius
    bool thesis;   // a ring at every point, and only first branches spread at their ends, as the formulas say
} tubes_def;

// The vertices of a section: number k lies 2 pi k / divisions from e1 towards e2.
typedef struct tube_ring
{
    roots_point at;    // centre and section
    roots_point axis;  // what it belongs to on the line: the same but on round ends
    ty_vec3 t, e1, e2; // unit: along the line, and across
    ty_vec3 off[2];    // m, of half of the vertices, from number `half` on, and of the others
    int half;
    float join; // 0..1, how much of the spread is left
    float v;    // length in circumferences, from the line's beginning
} tube_ring;

enum
{
    TUBE_CAP = 32, // rings of a round end at most
};

// Rings along a line, the first at its beginning. out: room for the line's points and TUBE_CAP more. 0: the line has no
// length.
int tube_rings(const tubes_def* def, int line, tube_ring* out);
// A vertex of a ring.
ty_vec3 tube_vertex(const tubes_def* def, const tube_ring* ring, int k);
