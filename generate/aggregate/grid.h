// SPDX-License-Identifier: Apache-2.0
// A grid over the centres of a pile's bodies: who is near a body, or near a point.
#pragma once
#include "pile_state.h"

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

body_grid body_grid_create(const ty_pile* pile, float cell); // cell > 0
void body_grid_destroy(body_grid* grid);

// Bodies after body whose bounding spheres come within the mean of both reaches, ascending. Any thread, own list.
void body_grid_after(const ty_pile* pile, const body_grid* grid, int body, body_list* out);

// Whether p lies in a ball of any body; the cell is at least the largest radius.
bool body_grid_inside(const ty_pile* pile, const body_grid* grid, ty_vec3 p);
