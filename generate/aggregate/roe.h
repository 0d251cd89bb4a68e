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

// Where a yolk is on its way through the white.
typedef struct ty_yolk
{
    ty_vec3 at;    // m, its middle from the egg's
    ty_vec3 speed; // m/s, against the egg
} ty_yolk;

// Where membrane, white and yolk of a body lie: the prototypes' maps. index: which egg, for its chance. yolk: NULL =
// where it comes to rest. def is complete.
void ty_roe_place(const ty_element_def* def, ty_seed seed, const ty_body* body, uint32_t index, const ty_yolk* yolk,
                  ty_affine out[TY_ROE_BODIES]);

// The way of a yolk for some seconds within a body that meanwhile changed its velocity by gained, m/s, under a gravity,
// m/s^2: buoyancy against the drag of a ball in a ball of liquid, until it touches the membrane.
void ty_roe_float(const ty_element_def* def, ty_seed seed, const ty_body* body, uint32_t index, ty_vec3 gained,
                  float gravity, float seconds, ty_yolk* yolk);
