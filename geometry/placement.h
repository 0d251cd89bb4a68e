// SPDX-License-Identifier: Apache-2.0
// Affine maps as translation, rotation and scale, such that taking apart and putting together again is stable.
#pragma once
#include <tsuya/base/math.h>

typedef struct ty_placement
{
    ty_vec3 translation;
    ty_quat rotation; // unit to float rounding, w >= 0
    ty_vec3 scale;    // x negative under a mirror
} ty_placement;

// Columns are rotation * scale, computed in double and rounded once.
ty_affine ty_placement_compose(const ty_placement* placement);

// False when the map shears (columns off a right angle by more than 1e-6) or a stable form is not found; *out is then
// the rotation and scale nearest in direction. When true, out is the same for compose(out): writing what was read gives
// the same bytes.
bool ty_placement_split(const ty_affine* m, ty_placement* out);

// Finite and not flat: |det| > 1e-30 times the cube of the longest column, which also must not be zero.
bool ty_placement_is_regular(const ty_affine* m);
