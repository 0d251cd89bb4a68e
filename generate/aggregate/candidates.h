// SPDX-License-Identifier: Apache-2.0
// What both solvers find contacts with: a grid over the bodies' centres, and colours of pairs that share no body.
#pragma once
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>

enum
{
    PAIR_COLORS = 48, // the last one takes what finds no other and is worked off in order by one thread
};

// Room for needed elements of a growing array.
void list_reserve(void** array, int* capacity, int needed, size_t size);

typedef struct body_grid
{
    ty_vec3 low;
    float cell; // m, no less than what is asked for: further where space is wide and empty
    int size[3];
    int* start;  // [cells + 1]
    int* sorted; // bodies by cell, ascending within one
    int* cell_of;
} body_grid;

// Bodies that are asked for together, of which there is no bound.
typedef struct body_list
{
    int* at;
    int count, capacity;
} body_list;

// bodies: [count] structs of stride bytes with their centre, a ty_vec3, at offset. cell > 0.
body_grid body_grid_create(const void* bodies, size_t offset, size_t stride, int count, float cell);
void body_grid_destroy(body_grid* grid);

// Bodies after body, at most a cell from it along each axis, that meet it, ascending. Any thread, own list.
typedef bool body_meet_fn(const void* owner, int a, int b);
void body_grid_after(const body_grid* grid, int body, body_meet_fn* meet, const void* owner, body_list* out);

// A body at most a cell from p along each axis that holds it, or -1.
typedef bool body_hold_fn(const void* owner, int body, ty_vec3 p);
int body_grid_find(const body_grid* grid, ty_vec3 p, body_hold_fn* hold, const void* owner);

// pairs: [count] structs of stride bytes that begin with the numbers of two bodies, the second below 0 for a wall.
// Greedy, in the pairs' order: the lowest colour that neither body has; walls are the colour after the last.
// order: [count] pairs by colour, as they were within one; first: where each colour begins in it.
void pairs_color(const void* pairs, size_t stride, int count, int body_count, int* order, int first[PAIR_COLORS + 2]);
