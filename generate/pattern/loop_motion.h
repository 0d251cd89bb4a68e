// SPDX-License-Identifier: Apache-2.0
// Where the rectangle of a looping texture is at a share of the loop.
#pragma once
#include "loop_volume.h"

// Sine and cosine of theta(t) = 2 pi t - easing / 2 sin 4 pi t at t = (i mod n) / n: from the first quarter of the
// turn, so that equal and opposite angles give equal bits, and turn n is turn 0.
void ty_loop_turn(int64_t i, int64_t n, float easing, double* sine, double* cosine);

// A mistake of plane, axis, motion or keys: TY_BAD_INPUT with its key.
TY_CHECKED ty_status ty_loop_motion_check(const ty_loop_recipe* recipe, const ty_loop_volume* volume, ty_error* error);

// The rectangle of moment i of n, in the voxels of a volume. The same bits for i and i + n.
ty_loop_grid ty_loop_motion_grid(const ty_loop_recipe* recipe, const int size[3], int64_t i, int64_t n);

// The share of frame i that lies outside the volume, by a lattice of its pixels with the corners.
double ty_loop_motion_outside(const ty_loop_recipe* recipe, const ty_loop_volume* volume, int i);

// The farthest that any pixel moves from moment i to the next, voxels.
double ty_loop_motion_step(const ty_loop_recipe* recipe, const int size[3], int64_t i, int64_t n);
