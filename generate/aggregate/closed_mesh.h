// SPDX-License-Identifier: Apache-2.0
// Mesh files that recipes name as solids: what is filled, and what fills it.
#pragma once
#include <tsuya/geometry/mesh.h>

// place is before ".mesh" in the recipe; with is the choice that asks for the path. Open surfaces and those that face
// inwards are TY_BAD_INPUT. On failure *out is NULL.
TY_CHECKED ty_status closed_mesh_read(const char* place, const char* with, const char* path, ty_mesh** out,
                                      ty_error* error);
