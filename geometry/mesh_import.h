// SPDX-License-Identifier: Apache-2.0
// Foreign mesh formats through assimp, in a child process.
#pragma once
#include <tsuya/geometry/mesh.h>

bool mesh_import_knows(const char* extension);
// Flattened, triangulated, validated; normals from the file where it has them, uv of the first set.
TY_CHECKED ty_status mesh_import(const char* path, ty_mesh** out, ty_error* error);
