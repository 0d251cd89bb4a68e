// SPDX-License-Identifier: Apache-2.0
// A glTF material as a material of this program: the mapping that a scene's file would have for it. Images inside the
// file go to the cache of made assets, named by their content.
#include "loader.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/hash.h>

// --- images ---

static const char* cached_image(ty_loader* loader, const ty_gltf_image* image, ty_error* error)
{
    char folder[TY_PATH_MAX], name[64], path[TY_PATH_MAX], hex[33];
    ty_status status = ty_scene_cache_folder(loader->options->cache_folder, folder, error);
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

static void add_rgb(ty_text* text, const float c[3])
{
    ty_text_format(text, "{\"color\": [%.9g, %.9g, %.9g], \"space\": \"lin_rec709\"}", (double)c[0], (double)c[1],
                   (double)c[2]);
}

// "key": a colour, times a texture where there is one. Images are named by number; see bind_images.
static void add_color(ty_text* text, const char* key, const float c[3], const ty_gltf_texture* map)
{
    ty_text_format(text, ", \"%s\": ", key);
    if (map->image < 0)
    {
        add_rgb(text, c);
        return;
    }
    ty_text_format(text, "{\"texture\": \"%d\", \"value\": ", map->image);
    add_rgb(text, c);
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
    add_color(text, "emission_color", color, &m->emissive_map);
}

static void add_transmission(ty_text* text, const ty_gltf_material* m)
{
    static const ty_gltf_texture none = {.image = -1};
    if (!(m->transmission > 0.0f))
        return;
    add_number(text, "transmission_weight", m->transmission);
    // Without a volume the base colour tints what passes.
    bool has_volume = m->attenuation_distance > 0.0f && m->thickness > 0.0f;
    add_color(text, "transmission_color", has_volume ? m->attenuation_color : m->base_color, &none);
    if (has_volume)
        add_number(text, "transmission_depth", ty_min(m->attenuation_distance, 1000.0f));
}

static char* material_text(const ty_gltf_material* m)
{
    static const ty_gltf_texture none = {.image = -1};
    ty_text text = {0};
    ty_text_add(&text, "{\"model\": \"surface\"");
    add_color(&text, "base_color", m->base_color, &m->base_color_map);
    add_number(&text, "base_metalness", m->metallic);
    add_number(&text, "specular_roughness", m->roughness);
    add_number(&text, "specular_ior", ty_clamp(m->ior, 1.0f, 3.0f));
    add_number(&text, "specular_weight", m->specular);
    add_color(&text, "specular_color", m->specular_color, &none);
    add_emission(&text, m);
    add_transmission(&text, m);
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
    char* text = material_text(is_own ? &asset->gltf->materials[index] : &none);
    ty_node* node = ty_made_node(loader, asset->place, text);
    ty_free(text);
    return node && bind_images(loader, asset, node) ? node : NULL;
}
