// SPDX-License-Identifier: Apache-2.0
// Meshes into a GLB file.
#pragma once
#include "glb_build.h"
#include <tsuya/geometry/mesh.h>

// "_" and the name in upper case.
void ty_glb_set_semantic(json_t* attributes, const char* name, int accessor);

// The mesh's arrays into the builder; returns its entry of "meshes": one primitive, or where triangles have slots one a
// slot. Materials that it names are added to the list where they are missing.
json_t* ty_glb_mesh_json(ty_glb_builder* builder, const ty_mesh* mesh, const char* name, json_t* materials);
