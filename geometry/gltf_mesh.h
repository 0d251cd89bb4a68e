// SPDX-License-Identifier: Apache-2.0
// From the importer's model to a mesh; in the child.
#pragma once
#include "gltf_shim.h"
#include <tsuya/geometry/mesh.h>

typedef struct ty_gltf_mesh_job
{
    const char* name; // of the file, for messages
    const ty_gltf* gltf;
    bool keeps_vertices;           // all of them as they are; else those that triangles use
    const char* const* slot_names; // by material, and one more for none; NULL = no slots
    const int* uv_sets;            // the same: 0 or 1
    int material_count;
    ty_error* error;
} ty_gltf_mesh_job;

// All primitives of triangles as one mesh. Meshes without normals have normals == NULL afterwards. On failure *out is
// NULL or what was made so far, for the caller to destroy.
TY_CHECKED ty_status ty_gltf_gather_mesh(const ty_gltf_mesh_job* job, int index, ty_mesh** out);

// A semantic without its underscore in lower case; false when it has none or does not fit.
bool ty_gltf_plain_name(const char* semantic, char name[32]);
