// SPDX-License-Identifier: Apache-2.0
// What the files that lead tips over the host share.
#pragma once
#include "roots_growth.h"

enum
{
    MARCH_CELLS = 1 << 16, // of the table of places
};

typedef struct tip
{
    ty_vec3 p, t, n; // place, direction, away from the host
    float begin_r, r, flat, s, begin_s;
    float free;        // way over which it does not look for a hold, m
    float along, turn; // of a root that still runs down the trunk: share of it, angle about it; along 1 = it has left
    float twist;       // rad, over the whole trunk
    ty_vec3 across;    // unit, level: across the upright plane through the host's middle that is its own
    uint64_t key;
    roots_kind kind;
    int parent, parent_point;
    bool alive;
    roots_point* points;
    int count, capacity;
} tip;

// Where roots have been: lists by the cell of a grid, in a table by hash.
typedef struct trace
{
    ty_vec3 p;
    float way; // m, that it stands for
    int tip, next;
    int cell[3];
} trace;

typedef struct march
{
    const growth* g;
    tip* tips;
    int tip_count;
    float cell;        // m
    float step;        // m, the longest of a tip
    float wide;        // m, half of what each main root has for itself about the host
    ty_vec3 top, foot; // of the trunk; away from the foot roots spread where it is level
    int heads[MARCH_CELLS];
    trace* traces;
    int trace_count, trace_capacity;
} march;

march* march_create(const growth* g);
void march_destroy(march* m);
// Takes a copy with its first point, and makes it alive.
void march_add(march* m, tip t);
// All tips side by side until each has ended. Then they are lines of the network.
void march_run(march* m);
// Where the trunk's middle is, and along which way it goes; at 0 it is cut, at 1 it stands on the host.
ty_vec3 march_trunk(const march* m, float along, ty_vec3* direction);

// --- where tips want to go ---

// The root has gone so far (m) past where its tip is: others keep away from there.
void course_pass(march* m, int whose, float way);
float course_chance(const march* m, const tip* t, int which, int octaves, float x, float y);
// Level, away from the foot of the trunk, unit.
ty_vec3 course_outwards(const march* m, ty_vec3 p);
// What turns a tip, to be applied over its stiffness; across n where it holds on to the host.
ty_vec3 course_force(const march* m, int index, bool holds, ty_vec3 n);
// Puts a tip out of the way of obstacles.
void course_clear(const march* m, tip* t);
