// SPDX-License-Identifier: Apache-2.0
// What the importer gets to see of a glTF file.
#pragma once
#include "gltf_source.h"

// A GLB with the file's buffers, accessors, meshes and instanced nodes under their own numbers. out is the caller's.
TY_CHECKED ty_status ty_gltf_pack(const ty_gltf_source* source, ty_bytes* out, ty_error* error);
