// SPDX-License-Identifier: Apache-2.0
// A fish's egg: one ball for packing, three bodies in one another for the picture.
#pragma once
#include <tsuya/generate/aggregate_recipe.h>

enum
{
    TY_ROE_BODIES = 3, // membrane, white, yolk
};

// Puts the preset's sizes where none are given, and the length, width and thickness of the egg; names what is not
// possible.
TY_CHECKED ty_status ty_roe_complete(ty_element_def* def, ty_error* error);

// The ball of an egg of mean size, and its membrane's mesh, a sphere whose one slot is `membrane`. def is complete.
TY_CHECKED ty_status ty_roe_init(const ty_element_def* def, ty_element* out, ty_error* error);

// Appends to an egg's membrane the prototypes of white and yolk, and to each settled body the three instances of its
// egg: all membranes, all whites, all yolks, in the order of the bodies. NULL: no memory. def is complete.
TY_CHECKED ty_aggregate* ty_roe_write(const ty_element_def* def, ty_seed seed, ty_element* egg, const ty_body* bodies,
                                      uint32_t count);
