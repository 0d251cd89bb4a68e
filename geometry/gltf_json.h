// SPDX-License-Identifier: Apache-2.0
// Fields of a glTF file's JSON, and what all of its checks share.
#pragma once
#include "glb.h"
#include <tsuya/base/memory.h>

typedef struct ty_gltf_accessor
{
    int component; // TY_GLTF_FLOAT ...
    int width;     // 1..4 for SCALAR..VEC4; 0 for matrices, which nothing here reads
    uint32_t count;
    bool normalized;
} ty_gltf_accessor;

typedef struct ty_gltf_checker
{
    const char* name;
    ty_error* error;
    const json_t* root;
    bool is_aggregate;            // one buffer inside, triangles alone, some instance
    const uint64_t* buffer_sizes; // of the bytes that are there
    size_t buffer_count;
    uint64_t byte_count; // of all buffers
    ty_gltf_accessor* accessors;
    size_t accessor_count;
    // What the whole file expands to: shared accessors must not multiply it out of proportion to the file.
    uint64_t vertices, triangles, instances;
} ty_gltf_checker;

#define TY_GLTF_FAIL(c, ...) ty_error_set_at((c)->error, TY_BAD_FILE, (c)->name, 0, 0, __VA_ARGS__)

// An integer in 0..maximum; absent = fallback, which may be negative (must be given: -2).
bool ty_gltf_read_index(const json_t* object, const char* key, int64_t fallback, uint64_t maximum, int64_t* out);
// The array named key in root: NULL is an empty one.
TY_CHECKED ty_status ty_gltf_get_list(const ty_gltf_checker* c, const char* key, const json_t** out);
// A name for messages and scenes: never NULL, at most 127 bytes, control characters replaced.
void ty_gltf_copy_name(const json_t* object, char name[128]);
// Exactly count finite numbers within float; false when they are there and something else. Absent: *out is kept.
bool ty_gltf_read_floats_of(const json_t* object, const char* key, int count, float* out);
// One number in minimum..maximum, as above.
bool ty_gltf_read_float(const json_t* object, const char* key, float minimum, float maximum, float* out);
// object.extensions[name], or NULL.
const json_t* ty_gltf_extension(const json_t* object, const char* name);

// NULL when index names none.
const ty_gltf_accessor* ty_gltf_get_accessor(const ty_gltf_checker* c, const json_t* index);

// gltf_check.c
bool ty_gltf_knows_extension(const char* name);
// Extensions, buffers, views, accessors, meshes and nodes; name, error, root, is_aggregate and the sizes are given.
TY_CHECKED ty_status ty_gltf_check(ty_gltf_checker* c);
// gltf_check_meshes.c
TY_CHECKED ty_status ty_gltf_check_meshes(ty_gltf_checker* c);
// gltf_check_nodes.c
TY_CHECKED ty_status ty_gltf_check_nodes(ty_gltf_checker* c);
