// SPDX-License-Identifier: Apache-2.0
// A glTF material as a material of this program: the mapping that a scene's file would have for it. Images inside the
// file go to the cache of made assets, named by their content.
#include "loader.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/hash.h>

#define DEGREES (180.0f / TY_PI) // of a radian

// --- images ---

// Where nothing is kept: a folder that goes with the scene, the last of those.
static ty_status passing_folder(ty_loader* loader, char folder[TY_PATH_MAX], ty_error* error)
{
    struct ty_scene_resources* resources = loader->scene->resources;
    char parent[] = TY_SCENE_PASSING;
    if (!resources->images)
    {
        if (!mkdtemp(parent))
            return ty_error_set(error, TY_BAD_FILE, "no place for the images of a glTF file: /tmp cannot be written");
        resources->images = ty_arena_format(loader->arena, "%s/images", parent);
        resources->passing[resources->passing_count++] = resources->images;
    }
    snprintf(folder, TY_PATH_MAX, "%s", resources->images);
    return ty_folder_create(folder, error);
}

static const char* cached_image(ty_loader* loader, const ty_gltf_image* image, ty_error* error)
{
    char folder[TY_PATH_MAX], name[64], path[TY_PATH_MAX], hex[33];
    ty_status status = ty_scene_cache_folder(loader->options->cache_folder, folder, error);
    if (status == TY_OK && !folder[0])
        status = passing_folder(loader, folder, error);
    if (status != TY_OK)
        return NULL;
    ty_hasher* hasher = ty_hasher_create();
    ty_hasher_add(hasher, image->bytes, image->size);
    ty_hash_hex(ty_hasher_end(hasher), hex);
    snprintf(name, sizeof name, "%s.%s", hex, image->extension);
    ty_path_join(folder, name, path);
    if (!ty_file_exists(path))
        status = ty_file_write(path, image->bytes, image->size, error);
    return status == TY_OK ? ty_arena_string(loader->arena, path) : NULL;
}

// The file of an image; NULL after a report.
static const char* image_path(ty_loader* loader, const ty_asset* asset, int index)
{
    const ty_gltf_image* image = &asset->gltf->images[index];
    ty_error error = {0};
    const char* path = image->path ? image->path : cached_image(loader, image, &error);
    if (!path)
        ty_report_error(loader->errors, asset->place, "gltf", &error);
    return path;
}

// --- text ---

// Within what every colour of a surface may be; KHR_materials_specular goes beyond.
static void add_rgb(ty_text* text, const float c[3])
{
    ty_text_format(text, "{\"color\": [%.9g, %.9g, %.9g], \"space\": \"lin_rec709\"}",
                   (double)ty_clamp(c[0], 0.0f, 1.0f), (double)ty_clamp(c[1], 0.0f, 1.0f),
                   (double)ty_clamp(c[2], 0.0f, 1.0f));
}

// A use of an image, by its number: see bind_images. From v downwards to v upwards; the middle of KHR_texture_transform
// is the top left corner.
static void add_map(ty_text* text, const ty_gltf_texture* map, const char* channel)
{
    static const char* const wraps[] = {"repeat", "clamp", "mirror"};
    float s, c;
    ty_sincos(map->rotation, &s, &c);
    float offset[2] = {map->offset[0] + s * map->scale[1], 1.0f - map->offset[1] - c * map->scale[1]};
    ty_text_format(text, "\"texture\": \"%d\", \"wrap\": [\"%s\", \"%s\"]", map->image, wraps[map->wrap_u],
                   wraps[map->wrap_v]);
    if (channel)
        ty_text_format(text, ", \"channel\": \"%s\"", channel);
    ty_text_format(text, ", \"uv\": {\"scale\": [%.9g, %.9g], \"rotate\": %.9g, \"offset\": [%.9g, %.9g]}",
                   (double)map->scale[0], (double)map->scale[1], (double)(map->rotation * DEGREES), (double)offset[0],
                   (double)offset[1]);
}

// "key": a colour, times a texture, times vertex colours.
static void add_color(ty_text* text, const char* key, const float c[3], const ty_gltf_texture* map, bool by_vertex)
{
    ty_text_format(text, ", \"%s\": ", key);
    if (map->image < 0 && !by_vertex)
    {
        add_rgb(text, c);
        return;
    }
    ty_text_add(text, "{\"value\": ");
    add_rgb(text, c);
    if (by_vertex)
        ty_text_add(text, ", \"attribute\": \"color\"");
    bool is_grey = !(c[0] < c[1]) && !(c[0] > c[1]) && !(c[1] < c[2]) && !(c[1] > c[2]);
    if (!is_grey || (by_vertex && map->image >= 0))
        ty_text_add(text, ", \"product\": \"rec709\"");
    if (map->image >= 0)
    {
        ty_text_add(text, ", ");
        add_map(text, map, NULL);
    }
    ty_text_add(text, "}");
}

// "key": a number, times a channel of a texture.
static void add_scalar(ty_text* text, const char* key, float value, const ty_gltf_texture* map, const char* channel)
{
    ty_text_format(text, ", \"%s\": ", key);
    if (map->image < 0)
    {
        ty_text_format(text, "%.9g", (double)value);
        return;
    }
    ty_text_format(text, "{\"value\": %.9g, ", (double)value);
    add_map(text, map, channel);
    ty_text_add(text, "}");
}

static void add_number(ty_text* text, const char* key, float value)
{
    ty_text_format(text, ", \"%s\": %.9g", key, (double)value);
}

static void add_emission(ty_text* text, const ty_gltf_material* m)
{
    float most = ty_max(m->emissive[0], ty_max(m->emissive[1], m->emissive[2]));
    if (!(most > 0.0f))
        return;
    const float color[3] = {m->emissive[0] / most, m->emissive[1] / most, m->emissive[2] / most};
    add_number(text, "emission_luminance", most);
    add_color(text, "emission_color", color, &m->emissive_map, false);
}

static void add_transmission(ty_text* text, const ty_gltf_material* m)
{
    static const ty_gltf_texture none = {.image = -1};
    if (!(m->transmission > 0.0f))
        return;
    if (!(m->thickness > 0.0f))
        ty_text_add(text, ", \"thin_walled\": true");
    add_scalar(text, "transmission_weight", m->transmission, &m->transmission_map, "r");
    // Without a volume the base colour tints what passes.
    bool has_volume = m->attenuation_distance > 0.0f && m->thickness > 0.0f;
    if (has_volume)
        add_color(text, "transmission_color", m->attenuation_color, &none, false);
    else
        add_color(text, "transmission_color", m->base_color, &m->base_color_map, false);
    if (has_volume)
        add_number(text, "transmission_depth", ty_min(m->attenuation_distance, 1000.0f));
}

// A cut at the alpha of the texture is a steep ramp, so that what is filtered stays smooth.
static void add_opacity(ty_text* text, const ty_gltf_material* m)
{
    const float steepness = 20.0f;
    if (m->alpha == TY_GLTF_OPAQUE || (m->alpha == TY_GLTF_BLEND && m->base_color_map.image < 0))
    {
        if (m->alpha == TY_GLTF_BLEND && m->base_color[3] < 1.0f)
            add_number(text, "opacity", ty_clamp(m->base_color[3], 0.0f, 1.0f));
        return;
    }
    if (m->base_color_map.image < 0)
    {
        add_number(text, "opacity", m->base_color[3] >= m->alpha_cutoff ? 1.0f : 0.0f);
        return;
    }
    bool cut = m->alpha == TY_GLTF_MASK;
    float scale = cut ? steepness * m->base_color[3] : m->base_color[3];
    float offset = cut ? 0.5f - steepness * m->alpha_cutoff : 0.0f;
    ty_text_format(text, ", \"opacity\": {\"scale\": %.9g, \"offset\": %.9g, ", (double)scale, (double)offset);
    add_map(text, &m->base_color_map, "a");
    ty_text_add(text, "}");
}

static void add_normal(ty_text* text, const ty_gltf_material* m)
{
    if (m->normal_map.image < 0)
        return;
    ty_text_add(text, ", \"normal\": {");
    add_map(text, &m->normal_map, NULL);
    ty_text_add(text, "}");
    if (m->normal_map.factor < 1.0f || m->normal_map.factor > 1.0f)
        add_number(text, "normal_strength", ty_clamp(m->normal_map.factor, 0.0f, 100.0f));
}

// KHR_materials_anisotropy widens alpha along the direction to mix(alpha, 1, strength^2); OpenPBR keeps the mean of the
// squares. Under a texture of roughness the constant's ratio stands for all.
static void add_roughness(ty_text* text, const ty_gltf_material* m)
{
    float alpha = ty_max(ty_sqr(m->roughness), 1e-4f), wide = alpha + (1.0f - alpha) * ty_sqr(m->anisotropy);
    float ratio = alpha / wide, mean = wide * sqrtf(0.5f * (1.0f + ratio * ratio));
    float roughness = m->anisotropy > 0.0f ? sqrtf(mean) : m->roughness;
    add_scalar(text, "specular_roughness", ty_min(roughness, 1.0f), &m->metallic_roughness_map, "g");
    if (!(m->anisotropy > 0.0f))
        return;
    add_number(text, "specular_roughness_anisotropy", 1.0f - ratio);
    float turns = m->anisotropy_rotation * (0.5f * TY_INV_PI);
    add_number(text, "specular_rotation", 360.0f * (turns - floorf(turns)));
}

static char* material_text(const ty_gltf_material* m, bool has_colors)
{
    static const ty_gltf_texture none = {.image = -1};
    ty_text text = {0};
    ty_text_add(&text, "{\"model\": \"surface\"");
    add_color(&text, "base_color", m->base_color, &m->base_color_map, has_colors);
    add_scalar(&text, "base_metalness", m->metallic, &m->metallic_roughness_map, "b");
    add_roughness(&text, m);
    add_number(&text, "specular_ior", ty_clamp(m->ior, 1.0f, 3.0f));
    add_number(&text, "specular_weight", m->specular);
    add_color(&text, "specular_color", m->specular_color, &none, false);
    add_emission(&text, m);
    add_transmission(&text, m);
    add_opacity(&text, m);
    add_normal(&text, m);
    if (m->clearcoat > 0.0f)
    {
        add_number(&text, "coat_weight", m->clearcoat);
        add_number(&text, "coat_roughness", m->clearcoat_roughness);
        add_number(&text, "coat_ior", 1.5f);
    }
    ty_text_add(&text, "}");
    return ty_text_take(&text);
}

// Texture names that are numbers become the image's file.
static bool bind_images(ty_loader* loader, const ty_asset* asset, ty_node* node)
{
    bool good = true;
    for (int i = 0; i < node->count; ++i)
    {
        ty_node* item = node->items[i];
        if (node->kind != TY_NODE_MAP || strcmp(node->keys[i].text, "texture") != 0)
        {
            good &= bind_images(loader, asset, item);
            continue;
        }
        int index = 0;
        for (const char* c = item->text; *c; ++c)
            index = 10 * index + (*c - '0');
        item->text = item->path = image_path(loader, asset, index);
        good &= item->path != NULL;
    }
    return good;
}

ty_node* ty_gltf_material_node(ty_loader* loader, const ty_asset* asset, int index)
{
    ty_gltf_material none = {.base_color = {1, 1, 1, 1},
                             .metallic = 1.0f,
                             .roughness = 1.0f,
                             .ior = 1.5f,
                             .specular = 1.0f,
                             .specular_color = {1, 1, 1}};
    none.base_color_map.image = none.emissive_map.image = none.normal_map.image = -1;
    none.metallic_roughness_map.image = none.transmission_map.image = -1;
    bool is_own = index < asset->gltf->material_count;
    char* text = material_text(is_own ? &asset->gltf->materials[index] : &none, asset->gltf->has_colors);
    ty_node* node = ty_made_node(loader, asset->place, text);
    ty_free(text);
    return node && bind_images(loader, asset, node) ? node : NULL;
}
