// SPDX-License-Identifier: Apache-2.0
// What the files about the host share.
#pragma once
#include "roots.h"

// The host's own shape or its objects, as one valid mesh with welds and bounds.
TY_CHECKED ty_status host_mesh_make(const ty_roots_host_def* def, ty_mesh** out, ty_error* error);
// Objects as one mesh; where: the list's name, for messages.
TY_CHECKED ty_status host_objects_make(const char* where, const ty_param_list* objects, ty_mesh** out, ty_error* error);

// The longest side of its bounds, m.
float host_longest(const ty_mesh* mesh);
// The field of the mesh with so many steps along its longest side, from the folder where it was kept, or made and kept
// there; NULL: neither. nearest as of ty_voxels_around_mesh. The same bits either way.
TY_CHECKED ty_status host_field_make(const ty_mesh* mesh, int resolution, const char* cache, ty_workers* workers,
                                     ty_voxels* out, int32_t** nearest, ty_error* error);

// One number at each vertex.
typedef struct host_channel
{
    const float* values;
    int stride;
} host_channel;

// "name", or "name.r" .g .b .a of an attribute with several numbers, of which `name` alone is the first. TY_BAD_INPUT
// names those that there are; key: the recipe's, for messages.
TY_CHECKED ty_status host_channel_find(const ty_mesh* mesh, const char* key, const char* name, host_channel* out,
                                       ty_error* error);
// Trilinear, with its gradient; beyond the grid the way to it is added.
float host_field_value(const ty_voxels* field, ty_vec3 p, ty_vec3* gradient);
// Masks of the host from the triangle that is nearest to each node.
TY_CHECKED ty_status host_masks_make(roots_host* host, const ty_roots_host_def* def, const int32_t* nearest,
                                     ty_workers* workers, ty_error* error);
