// SPDX-License-Identifier: Apache-2.0
// How high a fill stands, and where its grains begin.
#pragma once
#include <tsuya/generate/aggregate_recipe.h>

// The upper surface that encloses volume between the walls, a layer of inset off walls and surface left out. Fails with
// TY_BAD_INPUT when even the steepest heap holds less; *capacity is then the volume that it holds.
TY_CHECKED ty_status ty_fill_plan(const ty_container* container, double volume, float heap, float inset,
                                  ty_fill_top* top, double* capacity, ty_error* error);

// The volume in which elements lie up to level over the lowest point of the inside (0: up to the rim, or all of it),
// with a crown of heap on it, walls and surface left out as above.
double ty_fill_space(const ty_container* container, float level, float heap, float inset);

// count points at even distances (Poisson disk: Bridson 2007 by dart throwing) below top, at least inset off the walls,
// in an order in which neighbours are near each other. Deterministic in seed. volume as planned for; out has room for
// count.
TY_CHECKED ty_status ty_fill_seeds(const ty_container* container, const ty_fill_top* top, float inset, double volume,
                                   ty_seed seed, int count, ty_vec3* out, ty_error* error);
