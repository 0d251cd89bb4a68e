// SPDX-License-Identifier: Apache-2.0
// A mesh of a sequence of files: which of them are read, and what is shown.
#pragma once
#include "loader.h"
#include <tsuya/image/mip_texture.h>

typedef struct ty_mesh_sequence
{
    const char* pattern;
    ty_mip_texture_def timing; // path and what is of images unused
    int first, count;          // numbers of the files
    ty_mesh* frames[2];        // as read, and which of the files they are; NULL = none yet
    int loaded[2];
    int shown[2]; // what the asset's mesh is
    float weight;
    bool changed;      // since the world was built
    double shutter[2]; // s, of the sequence's time, that the mesh's steps are of, where it has any
    bool told;         // that it does not blur
} ty_mesh_sequence;

// mesh_sequence.c
// Files wanted[0] and [1] into frames; what is there already stays. like: the first that was read, if any. False after
// a report.
bool ty_mesh_sequence_files(ty_loader* loader, ty_mesh_sequence* s, const int wanted[2], const ty_mesh* like,
                            ty_place place);
void ty_mesh_blend_floats(float* out, const float* a, const float* b, size_t count, float weight);
void ty_mesh_blend_normals(ty_vec3* out, const ty_mesh* a, const ty_mesh* b, float weight);
