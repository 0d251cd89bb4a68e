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

// Meshes of white and yolk, of the membrane's size; the caller's.
void ty_roe_prototypes(const ty_mesh* membrane, ty_mesh* out[2]);

// Where membrane, white and yolk of a settled body lie: the prototypes' maps. index: which egg, for its chance. def is
// complete.
void ty_roe_place(const ty_element_def* def, ty_seed seed, const ty_body* body, uint32_t index,
                  ty_affine out[TY_ROE_BODIES]);
