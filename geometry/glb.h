// SPDX-License-Identifier: Apache-2.0
// What our own checks know of a GLB file: its two chunks, and that every count in its JSON fits into them.
#pragma once
#include <jansson.h>
#include <stdint.h>
#include <tsuya/base/status.h>

#define TY_GLB_MAGIC 0x46546c67u // "glTF"
#define TY_GLB_JSON 0x4e4f534au
#define TY_GLB_BIN 0x004e4942u
#define TY_GLB_JSON_MAX ((size_t)16 << 20)
#define TY_GLB_SIZE_MAX (((size_t)1 << 31) - 1)
#define TY_GLTF_INSTANCING "EXT_mesh_gpu_instancing"
#define TY_GLTF_STATE "TSUYA_aggregate_state" // of the file: a view of bytes that only its generator knows
#define TY_GLTF_ATTRIBUTES_MAX 32             // different names of one kind in a file

// glTF's numbers for component types.
enum
{
    TY_GLTF_BYTE = 5120,
    TY_GLTF_UNSIGNED_BYTE = 5121,
    TY_GLTF_SHORT = 5122,
    TY_GLTF_UNSIGNED_SHORT = 5123,
    TY_GLTF_UNSIGNED_INT = 5125,
    TY_GLTF_FLOAT = 5126,
};

// And for what the corners of a primitive are; below are points and lines.
enum
{
    TY_GLTF_TRIANGLES = 4,
    TY_GLTF_STRIP = 5,
    TY_GLTF_FAN = 6,
};

typedef struct ty_glb
{
    const char* json; // borrowed, not terminated
    size_t json_size;
    const uint8_t* bin; // borrowed, NULL when there is none
    size_t bin_size;
} ty_glb;

// ty_glb_check, and where the chunks are.
TY_CHECKED ty_status ty_glb_split(const char* name, const void* bytes, size_t size, ty_glb* out, ty_error* error);

// How deep JSON goes is bounded before any parser sees it.
TY_CHECKED ty_status ty_gltf_check_depth(const char* name, const char* json, size_t size, ty_error* error);
// An object; the caller releases *root with json_decref. NULL on failure.
TY_CHECKED ty_status ty_gltf_parse(const char* name, const char* json, size_t size, json_t** root, ty_error* error);
// For an aggregate file: parses the JSON chunk and checks every index, count and length in it that the reader relies
// on. On success the caller releases *root.
TY_CHECKED ty_status ty_gltf_check_aggregate(const char* name, const ty_glb* glb, json_t** root, ty_error* error);
