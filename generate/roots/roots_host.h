// SPDX-License-Identifier: Apache-2.0
// What the files about the host share.
#pragma once
#include "roots.h"

// Which triangles of a host are whose.
typedef struct host_parts
{
    int count;
    uint32_t* ends; // [count], behind the last of a part
    bool* mapped;   // [count], whether it has texture coordinates
} host_parts;

// The host's own shape or its objects, as one valid mesh with welds and bounds. The caller frees what parts holds, on
// failure too.
TY_CHECKED ty_status host_mesh_make(const ty_roots_host_def* def, ty_mesh** out, host_parts* parts, ty_error* error);
// Objects as one mesh; where: the list's name, for messages. parts may be NULL.
TY_CHECKED ty_status host_objects_make(const char* where, const ty_param_list* objects, ty_mesh** out,
                                       host_parts* parts, ty_error* error);
void host_parts_term(host_parts* parts);

// The longest side of its bounds, m.
float host_longest(const ty_mesh* mesh);
// The largest coordinate of its bounds, m.
float host_reach(const ty_mesh* mesh);
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
// Whether the mesh can have such a mask; key: the recipe's, for messages.
TY_CHECKED ty_status host_mask_check(const ty_mesh* mesh, const char* key, const ty_roots_mask_def* def,
                                     ty_error* error);
// What masks come from: attributes found, textures read. Borrows all but def; *out is NULL where nothing is painted.
typedef struct host_sources host_sources;
TY_CHECKED ty_status host_sources_open(const ty_mesh* mesh, const ty_roots_host_def* def, const host_parts* parts,
                                       host_sources** out, ty_error* error);
void host_sources_close(host_sources* sources); // NULL is allowed
// Masks of the host from the triangle that is nearest to each node.
TY_CHECKED ty_status host_masks_make(roots_host* host, const host_sources* from, const int32_t* nearest,
                                     ty_workers* workers, ty_error* error);

// One channel of a picture.
typedef struct host_texture
{
    int width, height;
    float* values; // [height][width], top row first; owned; NULL: none
} host_texture;

TY_CHECKED ty_status host_texture_read(const char* key, const ty_roots_mask_def* def, host_texture* out,
                                       ty_error* error);
void host_texture_term(host_texture* texture);
// Bilinear; v = 0 is the bottom row, and the picture repeats.
float host_texture_at(const host_texture* texture, ty_vec2 uv);
