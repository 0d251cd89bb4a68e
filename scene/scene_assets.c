// SPDX-License-Identifier: Apache-2.0
// The section `assets`: what each name stands for, before anything is read or made.
#include "loader.h"
#include "nearest.h"
#include <stdio.h>
#include <string.h>

// A key `loop` belongs to other kinds as well: it counts as one where it holds a recipe.
static const char* const kinds[] = {"mesh",   "shape",     "texture", "frames", "fill",
                                    "filter", "aggregate", "gltf",    "loop",   NULL};

#define KINDS "mesh, shape, texture, frames, fill, loop, filter, aggregate, gltf"

int ty_texture_index(ty_loader* loader, const ty_texture_def* def, ty_place place)
{
    ty_scene* scene = loader->scene;
    for (int i = 0; i < scene->texture_count; ++i)
    {
        const ty_texture_def* other = &loader->textures[i].def;
        bool same_space = def->color_space && other->color_space ? strcmp(def->color_space, other->color_space) == 0
                                                                 : def->color_space == other->color_space;
        if (same_space && def->wrap == other->wrap && strcmp(def->path, other->path) == 0)
            return i;
    }
    loader->textures = ty_loader_grow(loader->tree.arena, loader->textures, scene->texture_count,
                                      &loader->texture_capacity, sizeof(*loader->textures));
    loader->textures[scene->texture_count] = (ty_texture_entry){*def, place};
    return scene->texture_count++;
}

// A recipe in place of a file's name.
static void read_recipe(ty_loader* loader, ty_node* node, const char* key, ty_asset* asset)
{
    const char* const skip[] = {key, NULL};
    char of[64];
    snprintf(of, sizeof(of), "asset.%s with a recipe", key);
    if (ty_params_check_keys(&loader->reader, node, skip, of) &&
        ty_recipe_read(loader, ty_node_get(node, key), key, &asset->recipe))
        asset->kind = TY_ASSET_RECIPE;
}

// With times where it grows.
static void read_mesh_recipe(ty_loader* loader, ty_node* node, ty_node* recipe, ty_asset* asset)
{
    static const char* const skip[] = {"mesh", NULL};
    ty_mesh_asset_def def;
    if (!ty_recipe_read(loader, recipe, "mesh", &asset->recipe))
        return;
    bool grows = ty_recipe_frames(&asset->recipe) > 0;
    bool good = grows ? ty_params_read(&loader->reader, node, ty_mesh_asset_params(), &def, skip)
                      : ty_params_check_keys(&loader->reader, node, skip, "asset.mesh with a recipe");
    if (!good)
        return;
    asset->kind = TY_ASSET_RECIPE;
    if (grows)
        ty_mesh_sequence_expect(loader, asset, &def);
}

static void read_mesh(ty_loader* loader, ty_node* node, ty_asset* asset)
{
    static const char* const skip[] = {"mesh", NULL};
    ty_node* value = ty_node_get(node, "mesh");
    if (value->kind == TY_NODE_MAP)
    {
        read_mesh_recipe(loader, node, value, asset);
        return;
    }
    bool is_sequence = value->kind == TY_NODE_SCALAR && ty_path_is_sequence(value->text);
    ty_mesh_asset_def def;
    if (!ty_params_read(&loader->reader, node, ty_mesh_asset_params(), &def, is_sequence ? skip : NULL))
        return;
    if (!is_sequence && node->count > 1)
        ty_report(loader->errors, node->place, TY_BAD_INPUT, "'%s' belongs to sequences: mesh: name.####.ply",
                  node->keys[strcmp(node->keys[0].text, "mesh") == 0].text);
    asset->path = def.mesh;
    if (is_sequence)
        ty_mesh_sequence_read(loader, asset, &def, value);
    if (asset->sequence || !is_sequence)
        asset->kind = TY_ASSET_MESH;
}

static void read_texture(ty_loader* loader, ty_node* node, ty_asset* asset)
{
    if (!ty_params_read(&loader->reader, node, ty_texture_asset_params(), &asset->texture_def, NULL))
        return;
    asset->kind = TY_ASSET_TEXTURE;
    asset->path = asset->texture_def.texture;
}

static void read_frames(ty_loader* loader, ty_node* node, const char* key, ty_asset* asset)
{
    const char* const skip[] = {key, NULL};
    char described[80];
    ty_frames_asset_def* def = &asset->frames_def;
    ty_node* value = ty_node_get(node, key);
    bool good = ty_params_read(&loader->reader, node, ty_frames_asset_params(key), def, skip);
    ty_sequence_check(loader, &def->sequence, node->place);
    if (value->kind == TY_NODE_MAP)
    {
        if (ty_recipe_read(loader, value, key, &asset->recipe) && good)
            asset->kind = TY_ASSET_RECIPE;
        return;
    }
    if (strcmp(key, "frames") != 0)
    {
        if (!value->bad)
            ty_report(loader->errors, value->place, TY_BAD_INPUT,
                      "'%s': expected a recipe of kind '%s' (a .yaml file, or in place), got %s", key, key,
                      ty_node_describe(value, described));
        return;
    }
    asset->path = ty_files_use_frames(&loader->files, value, "frames");
    if (asset->path && good)
        asset->kind = TY_ASSET_FRAMES;
}

static void read_shape(ty_loader* loader, ty_node* node, ty_asset* asset)
{
    if (ty_params_read(&loader->reader, node, ty_shape_params(), &asset->shape, NULL))
        asset->kind = TY_ASSET_SHAPE;
}

// Files of instances: one, or one a frame.
static bool read_instances(ty_loader* loader, ty_node* node, ty_asset* asset)
{
    static const char* const skip[] = {"aggregate", NULL};
    ty_node* value = ty_node_get(node, "aggregate");
    bool is_sequence = ty_path_is_sequence(value->text);
    ty_aggregate_asset_def def;
    if (!ty_params_read(&loader->reader, node, ty_aggregate_asset_params(), &def, is_sequence ? skip : NULL))
        return false;
    for (int i = 0; !is_sequence && i < node->count; ++i)
        if (strcmp(node->keys[i].text, "aggregate") != 0 && strcmp(node->keys[i].text, "prototype") != 0 &&
            strcmp(node->keys[i].text, "velocity_scale") != 0)
            ty_report(loader->errors, node->keys[i].place, TY_BAD_INPUT,
                      "'%s' belongs to sequences: aggregate: name.####.glb", node->keys[i].text);
    asset->path = def.aggregate;
    asset->velocity_scale = def.velocity_scale;
    if (is_sequence)
        ty_aggregate_sequence_read(loader, asset, &def, value);
    if (asset->aggregate_sequence || !is_sequence)
        asset->kind = TY_ASSET_AGGREGATE;
    return asset->kind == TY_ASSET_AGGREGATE;
}

static void read_aggregate(ty_loader* loader, ty_node* node, ty_asset* asset)
{
    ty_node* value = ty_node_get(node, "aggregate");
    ty_node* prototype = ty_node_get(node, "prototype");
    if (value->kind == TY_NODE_SCALAR)
    {
        if (!read_instances(loader, node, asset))
            return;
        bool is_points = strcmp(ty_path_extension(value->text), "ply") == 0;
        if (is_points != (prototype != NULL))
            ty_report(loader->errors, prototype ? prototype->place : value->place, TY_BAD_INPUT,
                      is_points ? "points need a 'prototype': the mesh or shape asset that stands at each"
                                : "'prototype' belongs to .ply points; a .glb brings its own");
        return;
    }
    read_recipe(loader, node, "aggregate", asset);
}

// It was opened ahead, as far as it can be read; what hindered that is reported.
static void read_gltf(ty_loader* loader, ty_node* node, ty_asset* asset)
{
    ty_gltf_asset_def def;
    if (!ty_params_read(&loader->reader, node, ty_gltf_asset_params(), &def, NULL))
        return;
    asset->path = def.gltf;
    if (asset->gltf)
        asset->kind = TY_ASSET_GLTF;
}

static bool has_kind(const ty_node* node, const char* kind)
{
    const ty_node* value = ty_node_get(node, kind);
    return value && (strcmp(kind, "loop") != 0 || value->kind == TY_NODE_MAP || ty_recipe_is_file(value));
}

static void read_asset(ty_loader* loader, ty_node* node, ty_asset* asset)
{
    char described[80], nearest[TY_NEAREST_SIZE];
    const char* kind = NULL;
    if (node->bad)
        return;
    if (node->kind != TY_NODE_MAP)
    {
        ty_report(loader->errors, node->place, TY_BAD_INPUT,
                  "asset '%.100s': expected a mapping with one of: " KINDS ", got %s", asset->name,
                  ty_node_describe(node, described));
        return;
    }
    for (int i = 0; kinds[i]; ++i)
        if (!kind && has_kind(node, kinds[i]))
            kind = kinds[i];
    if (!kind)
    {
        ty_report(loader->errors, node->place, TY_BAD_INPUT, "asset '%.100s': expected one of the keys " KINDS "%s",
                  asset->name,
                  node->count ? ty_nearest(node->keys[0].text, kinds, TY_PARAM_COUNT(kinds) - 1, nearest) : "");
        return;
    }
    asset->place = ty_node_get(node, kind)->place;
    if (strcmp(kind, "mesh") == 0)
        read_mesh(loader, node, asset);
    else if (strcmp(kind, "shape") == 0)
        read_shape(loader, node, asset);
    else if (strcmp(kind, "texture") == 0)
        read_texture(loader, node, asset);
    else if (strcmp(kind, "aggregate") == 0)
        read_aggregate(loader, node, asset);
    else if (strcmp(kind, "gltf") == 0)
        read_gltf(loader, node, asset);
    else
        read_frames(loader, node, kind, asset);
}

static void resolve_prototype(ty_loader* loader, ty_asset* asset, const ty_node* node)
{
    const ty_node* name = asset->kind == TY_ASSET_AGGREGATE ? ty_node_get(node, "prototype") : NULL;
    if (!name)
        return;
    asset->prototype = ty_asset_find(loader, name);
    if (asset->prototype < 0)
        return;
    ty_asset_kind kind = loader->assets[asset->prototype].kind;
    if (kind != TY_ASSET_MESH && kind != TY_ASSET_SHAPE && kind != TY_ASSET_NONE)
        ty_report(loader->errors, name->place, TY_BAD_INPUT, "'prototype': asset '%.200s' is no mesh or shape",
                  name->text);
}

void ty_read_assets(ty_loader* loader)
{
    ty_node* map = loader->asset_map = ty_section(loader, "assets", TY_NODE_MAP);
    TY_ASSERT(loader->asset_count == (map ? map->count : 0)); // made by ty_gltf_expand
    for (int i = 0; i < loader->asset_count; ++i)
    {
        ty_asset* asset = &loader->assets[i];
        asset->name = ty_arena_string(loader->arena, map->keys[i].text);
        asset->place = map->keys[i].place;
        asset->prototype = -1;
        read_asset(loader, map->items[i], asset);
    }
    for (int i = 0; i < loader->asset_count; ++i)
        resolve_prototype(loader, &loader->assets[i], map->items[i]);
}

int ty_asset_find(ty_loader* loader, const ty_node* name)
{
    char nearest[TY_NEAREST_SIZE];
    int index = name->kind == TY_NODE_SCALAR ? ty_node_find(loader->asset_map, name->text) : -1;
    if (index < 0 && name->kind == TY_NODE_SCALAR && name->text[0])
        ty_report(loader->errors, name->place, TY_BAD_INPUT, "no asset '%.200s'%s", name->text,
                  ty_nearest_key(name->text, loader->asset_map, nearest));
    return index;
}
