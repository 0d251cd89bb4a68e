// SPDX-License-Identifier: Apache-2.0
// glTF and GLB scenes: meshes and where they stand, materials as the file says them, cameras, punctual lights.
#pragma once
#include <tsuya/geometry/aggregate.h>
#include <tsuya/geometry/mesh.h>

// As in the files: how a texture goes on outside 0..1.
typedef enum ty_gltf_wrap
{
    TY_GLTF_REPEAT,
    TY_GLTF_CLAMP,
    TY_GLTF_MIRROR,
} ty_gltf_wrap;

typedef struct ty_gltf_image
{
    const char* path;     // to open, of an image in a file of its own; NULL otherwise
    const uint8_t* bytes; // of an image inside, else NULL
    size_t size;
    const char* extension; // "png", "jpg" ... by what the bytes begin with; "" = neither
} ty_gltf_image;

// A use of a texture. uv, from the bottom left, goes to (offset.x + cos scale.x u + sin scale.y v', ...) with
// v' = 1 - v as KHR_texture_transform has it.
typedef struct ty_gltf_texture
{
    int image;  // -1 = there is none
    int uv_set; // 0 or 1
    ty_gltf_wrap wrap_u, wrap_v;
    float offset[2], scale[2];
    float rotation; // radians
    float factor;   // scale of a normal map
} ty_gltf_texture;

typedef enum ty_gltf_alpha
{
    TY_GLTF_OPAQUE,
    TY_GLTF_MASK,
    TY_GLTF_BLEND,
} ty_gltf_alpha;

// Metallic-roughness with the extensions that are read. Colours are linear Rec.709.
typedef struct ty_gltf_material
{
    const char* name; // no two equal; "material3" where the file has none
    float base_color[4];
    float metallic, roughness;
    float emissive[3]; // factor times strength
    float transmission, ior;
    float attenuation_color[3], attenuation_distance; // m; 0 = no attenuation
    float thickness;                                  // 0 = the body of a thin wall
    float clearcoat, clearcoat_roughness;
    float specular, specular_color[3];
    float anisotropy, anisotropy_rotation;
    ty_gltf_alpha alpha;
    float alpha_cutoff;
    bool double_sided;
    ty_gltf_texture base_color_map, metallic_roughness_map, normal_map, emissive_map, transmission_map;
} ty_gltf_material;

// A mesh under a node.
typedef struct ty_gltf_object
{
    const char* name; // the node's, or "node5"
    int mesh, node;
    ty_affine to_file;       // node to the file's space
    bool is_instanced;       // EXT_mesh_gpu_instancing
    ty_aggregate* instances; // of those, after ty_gltf_scene_read_meshes; its prototype is that of meshes
} ty_gltf_object;

typedef struct ty_gltf_camera
{
    const char* name;
    bool is_orthographic;
    float yfov;        // radians
    float height;      // m, of an orthographic one
    float aspect;      // 0 = not given
    ty_affine to_file; // looks down -z
} ty_gltf_camera;

typedef enum ty_gltf_light_kind
{
    TY_GLTF_POINT,
    TY_GLTF_SPOT,
    TY_GLTF_DIRECTIONAL,
} ty_gltf_light_kind;

typedef struct ty_gltf_light
{
    const char* name;
    ty_gltf_light_kind kind;
    float color[3];     // linear Rec.709
    float intensity;    // candela, or lux of a directional one
    float inner, outer; // radians from the axis
    ty_affine to_file;  // shines down -z
} ty_gltf_light;

typedef struct ty_gltf_scene
{
    const char* path;
    ty_gltf_object* objects;
    ty_gltf_material* materials;
    ty_gltf_image* images;
    ty_gltf_camera* cameras;
    ty_gltf_light* lights;
    const char** mesh_names; // [mesh_count]
    const char** warnings;   // what is left out of this file, one sentence each
    int object_count, material_count, image_count, camera_count, light_count, mesh_count, warning_count;
    bool is_aggregate; // a file of ty_aggregate_write
    bool has_colors;   // some vertices have
    ty_bounds bounds;  // of the objects by what the accessors say of themselves; empty when they say nothing
    ty_mesh** meshes;  // [mesh_count], NULL before ty_gltf_scene_read_meshes and where no object shows it
    struct ty_gltf_source* source; // private
} ty_gltf_scene;

// Where a buffer or image of its own is. uri is decoded and names no scheme. Writes the path and says true; else sets
// error, if anybody asks, and says false.
typedef bool ty_gltf_find_fn(void* context, const char* uri, char path[4096], ty_error* error);

#define TY_GLTF_NO_MATERIAL "default" // the slot of triangles that name none

// Reads and checks the file and its buffers; the meshes come later. find NULL = beside the file, below its folder.
// Any fault is TY_BAD_FILE with the place in the file's JSON. The caller destroys *out.
TY_CHECKED ty_status ty_gltf_scene_open(const char* path, ty_gltf_find_fn* find, void* context, ty_gltf_scene** out,
                                        ty_error* error);
// The same of a file in memory, which must stay where it is until destroy.
TY_CHECKED ty_status ty_gltf_scene_open_memory(const char* path, const void* bytes, size_t size, ty_gltf_find_fn* find,
                                               void* context, ty_gltf_scene** out, ty_error* error);
void ty_gltf_scene_destroy(ty_gltf_scene* scene); // NULL is allowed

// The importer in a child process, once: meshes with slots by material, and instances. Validated, with welds, normals
// and bounds.
TY_CHECKED ty_status ty_gltf_scene_read_meshes(ty_gltf_scene* scene, ty_error* error);
// All objects as one mesh in the file's space; instances are realised. After ty_gltf_scene_read_meshes.
TY_CHECKED ty_status ty_gltf_scene_merge(const ty_gltf_scene* scene, ty_mesh** out, ty_error* error);
