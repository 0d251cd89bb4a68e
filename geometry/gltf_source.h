// SPDX-License-Identifier: Apache-2.0
// A glTF file and its buffers in memory, before and after the checks.
#pragma once
#include "gltf_json.h"
#include <tsuya/base/arena.h>
#include <tsuya/base/file.h>
#include <tsuya/geometry/gltf.h>

#define TY_GLTF_TEXT_MAX ((size_t)128 << 20)    // of a .gltf
#define TY_GLTF_DATA_URI_MAX ((size_t)32 << 20) // decoded bytes of one

typedef struct ty_gltf_buffer
{
    const uint8_t* data;
    size_t size;
    ty_bytes owned; // of a file or data URI
} ty_gltf_buffer;

struct ty_gltf_source
{
    ty_arena* arena; // of the ty_gltf_scene
    ty_bytes file;   // empty when in memory
    json_t* root;
    ty_gltf_buffer* buffers;
    int buffer_count;
    ty_bytes* images; // [image_count] decoded data URIs
    int image_count;
    ty_gltf_find_fn* find;
    void* context;
    const char* path;
    int* uv_sets; // [material_count + 1]
    bool meshes_read;
};

typedef struct ty_gltf_source ty_gltf_source;

// gltf_source.c: text and buffers. On failure what is there is released by term.
TY_CHECKED ty_status ty_gltf_source_open(ty_gltf_source* source, const void* bytes, size_t size, ty_error* error);
void ty_gltf_source_term(ty_gltf_source* source);
// The bytes of a data URI, or the path of a file: one of *out and path is empty afterwards. what = for messages.
TY_CHECKED ty_status ty_gltf_resolve_uri(const ty_gltf_source* source, const char* what, const char* uri, ty_bytes* out,
                                         char path[TY_PATH_MAX], ty_error* error);

// gltf_look.c: materials, textures, images, cameras and lights of the checked file into scene.
TY_CHECKED ty_status ty_gltf_read_look(ty_gltf_scene* scene, ty_error* error);
// gltf_nodes.c: objects, and where cameras and lights stand.
TY_CHECKED ty_status ty_gltf_read_nodes(ty_gltf_scene* scene, ty_error* error);
// gltf_source.c: once of each text, 64 in all.
void ty_gltf_warn(ty_gltf_scene* scene, const char* format, ...) TY_PRINTF(2, 3);
