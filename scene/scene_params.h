// SPDX-License-Identifier: Apache-2.0
// Tables of what only scene files know: objects, assets, and which keys belong to which light.
#pragma once
#include <tsuya/scene/scene.h>

// An entry of `objects:`.
typedef struct ty_object_def
{
    const char* name;
    const char* mesh;      // asset
    const char* aggregate; // asset
    const char* gltf;      // asset
    bool file_lights;      // those of the glTF file too
    const char* file_camera;
    const char* material;
    ty_param_list materials;          // of ty_param_name: slot, material
    ty_vec3 translate, rotate, scale; // m, radians, 1
    ty_visible_def visible;
    const char* light_group; // of what it emits, NULL = "default"
    ty_param_strings lights, exclude_lights;
} ty_object_def;

// When the files of a sequence are shown.
typedef struct ty_sequence_def
{
    float fps;
    float start;                 // s
    int first_frame, last_frame; // last below first: all there are
    bool loop, mirror, hold;     // at most one
    int interpolate;             // 0 none, 1 linear
} ty_sequence_def;

// Entries of `assets:` by their first key.
typedef struct ty_mesh_asset_def
{
    const char* mesh; // path, or the pattern of a sequence
    ty_sequence_def sequence;
} ty_mesh_asset_def;

typedef struct ty_texture_asset_def
{
    const char* texture; // path
    const char* color_space;
    int wrap; // ty_wrap
} ty_texture_asset_def;

typedef struct ty_frames_asset_def
{
    const char* frames; // pattern, or a recipe in place
    const char* color_space;
    int wrap; // ty_wrap
    ty_sequence_def sequence;
} ty_frames_asset_def;

typedef struct ty_aggregate_asset_def
{
    const char* aggregate; // path, the pattern of a sequence, or a recipe in place
    const char* prototype; // asset
    float velocity_scale;
    ty_sequence_def sequence;
} ty_aggregate_asset_def;

typedef struct ty_gltf_asset_def
{
    const char* gltf; // path
    float light_scale;
} ty_gltf_asset_def;

const ty_param_table* ty_object_params(void);
const ty_param_table* ty_gltf_asset_params(void);
const ty_param_table* ty_mesh_asset_params(void);
const ty_param_table* ty_texture_asset_params(void);
const ty_param_table* ty_frames_asset_params(const char* key); // frames, fill, loop, filter
const ty_param_table* ty_aggregate_asset_params(void);

// Whether a key of the light table means anything for a kind of light.
bool ty_light_has_key(ty_light_kind kind, const char* key);
const char* ty_light_kind_name(ty_light_kind kind); // as in the file
