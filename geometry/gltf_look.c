// SPDX-License-Identifier: Apache-2.0
// Materials, textures and images of a glTF file as it says them.
#include "gltf_source.h"
#include <stdio.h>
#include <string.h>

typedef struct reader
{
    ty_gltf_scene* scene;
    const json_t* root;
    ty_error* error;
} reader;

#define FAIL(r, ...) ty_error_set_at((r)->error, TY_BAD_FILE, (r)->scene->path, 0, 0, __VA_ARGS__)

// --- images ---

static const char* extension_of(const uint8_t* bytes, size_t size)
{
    static const struct
    {
        const char *begins, *extension;
        size_t length;
    } types[] = {{"\x89PNG", "png", 4}, {"\xff\xd8\xff", "jpg", 3}, {"RIFF", "webp", 4}, {"\xabKTX", "ktx2", 4}};
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        if (size >= types[i].length && memcmp(bytes, types[i].begins, types[i].length) == 0)
            return types[i].extension;
    return "";
}

// The bytes of a view: the checks have seen that they are there.
static void view_bytes(const ty_gltf_source* source, int64_t index, ty_gltf_image* out)
{
    const json_t* view = json_array_get(json_object_get(source->root, "bufferViews"), (size_t)index);
    size_t buffer = (size_t)json_integer_value(json_object_get(view, "buffer"));
    out->bytes = source->buffers[buffer].data + (size_t)json_integer_value(json_object_get(view, "byteOffset"));
    out->size = (size_t)json_integer_value(json_object_get(view, "byteLength"));
}

static ty_status read_image(const reader* r, const json_t* object, int index)
{
    ty_gltf_source* source = r->scene->source;
    ty_gltf_image* out = &r->scene->images[index];
    char what[40], path[TY_PATH_MAX] = "";
    const char* uri = json_string_value(json_object_get(object, "uri"));
    size_t views = json_array_size(json_object_get(r->root, "bufferViews"));
    int64_t view;
    snprintf(what, sizeof what, "images[%d]", index);
    if (uri)
    {
        ty_status status = ty_gltf_resolve_uri(source, what, uri, &source->images[index], path, r->error);
        if (status != TY_OK)
            return status;
        if (path[0])
            out->path = ty_arena_string(source->arena, path);
        out->bytes = source->images[index].data;
        out->size = source->images[index].size;
    }
    else if (views == 0 || !ty_gltf_read_index(object, "bufferView", -2, views - 1, &view))
        return FAIL(r, "%s has no uri and no bufferView", what);
    else
        view_bytes(source, view, out);
    out->extension = out->bytes ? extension_of(out->bytes, out->size) : "";
    if (out->bytes && !out->extension[0])
        return FAIL(r, "%s is neither PNG nor JPEG", what);
    return TY_OK;
}

static ty_status read_images(const reader* r)
{
    const json_t* list = json_object_get(r->root, "images");
    ty_gltf_source* source = r->scene->source;
    if (list && !json_is_array(list))
        return FAIL(r, "\"images\" is not an array");
    int count = r->scene->image_count = source->image_count = (int)json_array_size(list);
    r->scene->images = TY_ARENA_ALLOC(source->arena, ty_gltf_image, count);
    source->images = TY_ARENA_ALLOC(source->arena, ty_bytes, count);
    ty_status status = TY_OK;
    for (int i = 0; i < count && status == TY_OK; i++)
        status = read_image(r, json_array_get(list, (size_t)i), i);
    return status;
}

// --- textures ---

static ty_gltf_wrap wrap_of(const json_t* sampler, const char* key)
{
    switch (json_integer_value(json_object_get(sampler, key)))
    {
    case 33071:
        return TY_GLTF_CLAMP;
    case 33648:
        return TY_GLTF_MIRROR;
    default:
        return TY_GLTF_REPEAT;
    }
}

static ty_status read_transform(const reader* r, const json_t* info, const char* what, ty_gltf_texture* out)
{
    const json_t* transform = ty_gltf_extension(info, "KHR_texture_transform");
    int64_t set = out->uv_set;
    bool good = ty_gltf_read_floats_of(transform, "offset", 2, out->offset) &&
                ty_gltf_read_floats_of(transform, "scale", 2, out->scale) &&
                ty_gltf_read_float(transform, "rotation", -1e4f, 1e4f, &out->rotation) &&
                ty_gltf_read_index(transform, "texCoord", set, 1000, &set);
    if (!good)
        return FAIL(r, "%s: its KHR_texture_transform holds what is no number", what);
    if (set > 1)
        ty_gltf_warn(r->scene, "%s uses TEXCOORD_%d: of more than two sets the first is taken", what, (int)set);
    out->uv_set = set == 1;
    return TY_OK;
}

// A textureInfo under key; what it is absent: image -1.
static ty_status read_texture(const reader* r, const json_t* parent, const char* key, const char* of,
                              ty_gltf_texture* out)
{
    char what[160];
    int64_t index, image, sampler, set;
    const json_t *info = json_object_get(parent, key), *textures = json_object_get(r->root, "textures");
    const json_t* samplers = json_object_get(r->root, "samplers");
    *out = (ty_gltf_texture){.image = -1, .scale = {1.0f, 1.0f}, .factor = 1.0f};
    if (!info)
        return TY_OK;
    snprintf(what, sizeof what, "%.80s.%s", of, key);
    size_t count = json_array_size(textures);
    if (count == 0 || !ty_gltf_read_index(info, "index", -2, count - 1, &index))
        return FAIL(r, "%s.index is none of the %zu textures", what, count);
    const json_t* texture = json_array_get(textures, (size_t)index);
    if (!ty_gltf_read_index(texture, "source", -1, INT32_MAX, &image) || image >= r->scene->image_count)
        return FAIL(r, "textures[%d].source is none of the %d images", (int)index, r->scene->image_count);
    if (!ty_gltf_read_index(texture, "sampler", -1, INT32_MAX, &sampler) ||
        (sampler >= 0 && (size_t)sampler >= json_array_size(samplers)))
        return FAIL(r, "textures[%d].sampler is none of the %zu samplers", (int)index, json_array_size(samplers));
    if (!ty_gltf_read_index(info, "texCoord", 0, 1000, &set) ||
        !ty_gltf_read_float(info, "scale", -1000.0f, 1000.0f, &out->factor))
        return FAIL(r, "%s: texCoord or scale is no such number", what);
    if (image < 0)
        ty_gltf_warn(r->scene, "textures[%d] has no image that is read", (int)index);
    const json_t* sampled = sampler >= 0 ? json_array_get(samplers, (size_t)sampler) : NULL;
    out->image = (int)image;
    out->uv_set = (int)set;
    out->wrap_u = wrap_of(sampled, "wrapS");
    out->wrap_v = wrap_of(sampled, "wrapT");
    return read_transform(r, info, what, out);
}

// --- materials ---

static ty_status read_base(const reader* r, const json_t* object, const char* what, ty_gltf_material* out)
{
    const json_t* base = json_object_get(object, "pbrMetallicRoughness");
    bool good = ty_gltf_read_floats_of(base, "baseColorFactor", 4, out->base_color) &&
                ty_gltf_read_float(base, "metallicFactor", 0.0f, 1.0f, &out->metallic) &&
                ty_gltf_read_float(base, "roughnessFactor", 0.0f, 1.0f, &out->roughness) &&
                ty_gltf_read_floats_of(object, "emissiveFactor", 3, out->emissive);
    if (!good)
        return FAIL(r, "%s: a factor is no number or out of range", what);
    ty_status status = read_texture(r, base, "baseColorTexture", what, &out->base_color_map);
    if (status == TY_OK)
        status = read_texture(r, base, "metallicRoughnessTexture", what, &out->metallic_roughness_map);
    if (status == TY_OK)
        status = read_texture(r, object, "normalTexture", what, &out->normal_map);
    return status == TY_OK ? read_texture(r, object, "emissiveTexture", what, &out->emissive_map) : status;
}

static ty_status read_extensions(const reader* r, const json_t* object, const char* what, ty_gltf_material* out)
{
    float strength = 1.0f;
    const json_t* volume = ty_gltf_extension(object, "KHR_materials_volume");
    const json_t* specular = ty_gltf_extension(object, "KHR_materials_specular");
    const json_t* coat = ty_gltf_extension(object, "KHR_materials_clearcoat");
    const json_t* transmission = ty_gltf_extension(object, "KHR_materials_transmission");
    const json_t* anisotropy = ty_gltf_extension(object, "KHR_materials_anisotropy");
    bool good = ty_gltf_read_float(ty_gltf_extension(object, "KHR_materials_emissive_strength"), "emissiveStrength",
                                   0.0f, 1e9f, &strength) &&
                ty_gltf_read_float(ty_gltf_extension(object, "KHR_materials_ior"), "ior", 0.0f, 100.0f, &out->ior) &&
                ty_gltf_read_float(transmission, "transmissionFactor", 0.0f, 1.0f, &out->transmission) &&
                ty_gltf_read_float(volume, "thicknessFactor", 0.0f, 1e9f, &out->thickness) &&
                ty_gltf_read_float(volume, "attenuationDistance", 1e-9f, 1e9f, &out->attenuation_distance) &&
                ty_gltf_read_floats_of(volume, "attenuationColor", 3, out->attenuation_color) &&
                ty_gltf_read_float(coat, "clearcoatFactor", 0.0f, 1.0f, &out->clearcoat) &&
                ty_gltf_read_float(coat, "clearcoatRoughnessFactor", 0.0f, 1.0f, &out->clearcoat_roughness) &&
                ty_gltf_read_float(specular, "specularFactor", 0.0f, 1.0f, &out->specular) &&
                ty_gltf_read_floats_of(specular, "specularColorFactor", 3, out->specular_color) &&
                ty_gltf_read_float(anisotropy, "anisotropyStrength", 0.0f, 1.0f, &out->anisotropy) &&
                ty_gltf_read_float(anisotropy, "anisotropyRotation", -1e4f, 1e4f, &out->anisotropy_rotation);
    if (!good)
        return FAIL(r, "%s: a number of one of its extensions is missing or out of range", what);
    for (int i = 0; i < 3; i++)
        out->emissive[i] *= strength;
    static const char* const unread[][2] = {{"KHR_materials_volume", "thicknessTexture"},
                                            {"KHR_materials_clearcoat", "clearcoatTexture"},
                                            {"KHR_materials_clearcoat", "clearcoatRoughnessTexture"},
                                            {"KHR_materials_clearcoat", "clearcoatNormalTexture"},
                                            {"KHR_materials_specular", "specularTexture"},
                                            {"KHR_materials_specular", "specularColorTexture"},
                                            {"KHR_materials_anisotropy", "anisotropyTexture"}};
    for (size_t i = 0; i < sizeof unread / sizeof unread[0]; i++)
        if (json_object_get(ty_gltf_extension(object, unread[i][0]), unread[i][1]))
            ty_gltf_warn(r->scene, "%s: %s of %s is ignored", what, unread[i][1], unread[i][0]);
    return read_texture(r, transmission, "transmissionTexture", what, &out->transmission_map);
}

static ty_status read_alpha(const reader* r, const json_t* object, const char* what, ty_gltf_material* out)
{
    static const char* const modes[] = {"OPAQUE", "MASK", "BLEND"};
    const char* mode = json_string_value(json_object_get(object, "alphaMode"));
    for (int i = 0; mode && i < 3; i++)
        if (strcmp(mode, modes[i]) == 0)
            out->alpha = (ty_gltf_alpha)i;
    if (!ty_gltf_read_float(object, "alphaCutoff", 0.0f, 1e6f, &out->alpha_cutoff))
        return FAIL(r, "%s.alphaCutoff is no such number", what);
    out->double_sided = json_is_true(json_object_get(object, "doubleSided"));
    return TY_OK;
}

// The set that most of a material's textures use; a mesh keeps one.
static int uv_set_of(const reader* r, const ty_gltf_material* m)
{
    const ty_gltf_texture* maps[] = {&m->base_color_map, &m->metallic_roughness_map, &m->normal_map, &m->emissive_map,
                                     &m->transmission_map};
    int set = -1;
    for (size_t i = 0; i < sizeof maps / sizeof maps[0]; i++)
    {
        if (maps[i]->image < 0)
            continue;
        if (set >= 0 && maps[i]->uv_set != set)
            ty_gltf_warn(r->scene, "material '%s': its textures use two sets of coordinates; all take TEXCOORD_%d",
                         m->name, set);
        set = set < 0 ? maps[i]->uv_set : set;
    }
    return set == 1;
}

static ty_status read_material(const reader* r, const json_t* object, int index)
{
    ty_gltf_material* out = &r->scene->materials[index];
    char what[40];
    snprintf(what, sizeof what, "materials[%d]", index);
    const char* name = out->name;
    *out = (ty_gltf_material){.name = name,
                              .base_color = {1, 1, 1, 1},
                              .metallic = 1.0f,
                              .roughness = 1.0f,
                              .ior = 1.5f,
                              .attenuation_color = {1, 1, 1},
                              .specular = 1.0f,
                              .specular_color = {1, 1, 1},
                              .alpha_cutoff = 0.5f};
    if (!json_is_object(object))
        return FAIL(r, "%s is not an object", what);
    ty_status status = read_base(r, object, what, out);
    if (status == TY_OK)
        status = read_extensions(r, object, what, out);
    if (status == TY_OK)
        status = read_alpha(r, object, what, out);
    if (status == TY_OK)
        r->scene->source->uv_sets[index] = uv_set_of(r, out);
    return status;
}

// Base, or base with a number: no name stands twice.
static const char* unique_name(ty_arena* arena, const char* base, const char* const* names, int count)
{
    // Where a file names a thousand alike, numbers are looked for from the count on.
    const char* name = ty_arena_string(arena, base);
    for (int number = 2;; number++)
    {
        bool taken = false;
        for (int i = 0; i < count && !taken; i++)
            taken = strcmp(names[i], name) == 0;
        if (!taken)
            return name;
        number = number > 20 && number < count ? count : number;
        name = ty_arena_format(arena, "%s.%d", base, number);
    }
}

static ty_status read_materials(const reader* r)
{
    const json_t* list = json_object_get(r->root, "materials");
    ty_arena* arena = r->scene->source->arena;
    if (list && !json_is_array(list))
        return FAIL(r, "\"materials\" is not an array");
    int count = r->scene->material_count = (int)json_array_size(list);
    if (count >= TY_MESH_MAX_SLOTS)
        return FAIL(r, "%d materials; at most %d are read", count, TY_MESH_MAX_SLOTS - 1);
    const char** names = TY_ARENA_ALLOC(arena, const char*, count);
    r->scene->materials = TY_ARENA_ALLOC(arena, ty_gltf_material, count);
    r->scene->source->uv_sets = TY_ARENA_ALLOC(arena, int, count + 1);
    ty_status status = TY_OK;
    for (int i = 0; i < count && status == TY_OK; i++)
    {
        char name[128];
        ty_gltf_copy_name(json_array_get(list, (size_t)i), name);
        names[i] = unique_name(arena, name[0] ? name : ty_arena_format(arena, "material%d", i), names, i);
        r->scene->materials[i].name = names[i];
        status = read_material(r, json_array_get(list, (size_t)i), i);
    }
    return status;
}

ty_status ty_gltf_read_look(ty_gltf_scene* scene, ty_error* error)
{
    const reader r = {scene, scene->source->root, error};
    ty_status status = read_images(&r);
    return status == TY_OK ? read_materials(&r) : status;
}
