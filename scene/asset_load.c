// SPDX-License-Identifier: Apache-2.0
// Files to memory: textures, meshes, shapes, aggregates; recipes through the cache.
#include "loader.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/geometry/mesh_file.h>

#define CURVATURE_SMOOTHING 2
#define CHECK_DIVISIONS 16 // a shape made only to see whether its sizes are possible

// Once for all frames: whatever else of a light is keyed, its image is not.
static void make_environment_tables(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    scene->environment_tables = TY_ARENA_ALLOC(loader->arena, ty_environment_table, scene->texture_count);
    scene->light_tables = TY_ARENA_ALLOC(loader->arena, const ty_environment_table*, scene->light_count);
    bool* made = TY_ALLOC(bool, scene->texture_count);
    for (int i = 0; i < scene->light_count; ++i)
    {
        int image = loader->light_textures[i];
        if (image < 0 || !scene->textures[image] || scene->lights[i].kind != TY_LIGHT_ENVIRONMENT)
            continue;
        if (!made[image])
            ty_environment_table_init(&scene->environment_tables[image], scene->textures[image]);
        made[image] = true;
        scene->light_tables[i] = &scene->environment_tables[image];
    }
    ty_free(made);
}

void ty_load_textures(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    scene->textures = TY_ARENA_ALLOC(loader->arena, ty_texture*, scene->texture_count);
    scene->light_images = TY_ARENA_ALLOC(loader->arena, ty_texture*, scene->light_count);
    for (int i = 0; i < scene->texture_count; ++i)
    {
        ty_error error;
        const ty_texture_entry* entry = &loader->textures[i];
        if (ty_texture_create(&entry->def, scene->color, &scene->textures[i], &error) != TY_OK)
            ty_report_error(loader->errors, entry->place, "texture", &error);
    }
    for (int i = 0; i < scene->light_count; ++i)
        if (loader->light_textures[i] >= 0)
            scene->light_images[i] = scene->textures[loader->light_textures[i]];
    if (!loader->options->check_only)
        make_environment_tables(loader);
}

// Vertex colours to ACEScg, as textures are.
void ty_convert_colors(const ty_loader* loader, ty_mesh* mesh)
{
    for (int i = 0; i < mesh->attribute_count; ++i)
    {
        ty_error error;
        ty_mesh_attribute* attribute = &mesh->attributes[i];
        const char* space = attribute->space == TY_ATTRIBUTE_SRGB ? "srgb_texture" : "lin_rec709";
        if (attribute->space == TY_ATTRIBUTE_NUMBERS || attribute->components < 3 || !loader->scene->color)
            continue;
        if (ty_color_convert(loader->scene->color, space, "ACEScg", attribute->values, (int)mesh->vertex_count,
                             attribute->components, &error) != TY_OK)
            ty_log(TY_LOG_WARNING, "vertex colours '%s' are taken as ACEScg: %s", attribute->name, error.text);
        attribute->space = TY_ATTRIBUTE_NUMBERS;
    }
}

// What shading and tracing expect of every mesh.
void ty_complete_mesh(const ty_loader* loader, ty_mesh* mesh)
{
    ty_convert_colors(loader, mesh);
    if (!mesh->welds)
        ty_mesh_compute_welds(mesh);
    if (!mesh->curvature_1)
        ty_mesh_compute_curvature(mesh, CURVATURE_SMOOTHING);
}

static void keep_mesh(ty_loader* loader, ty_mesh* mesh)
{
    ty_complete_mesh(loader, mesh);
    struct ty_scene_resources* resources = loader->scene->resources;
    resources->meshes[resources->mesh_count++] = mesh;
}

static void keep_aggregate(ty_loader* loader, ty_aggregate* aggregate)
{
    for (int i = 0; i < aggregate->prototype_count; ++i)
        ty_complete_mesh(loader, aggregate->prototypes[i]);
    if (!ty_mesh_share_slots(aggregate->prototypes, aggregate->prototype_count))
        ty_log(TY_LOG_WARNING, "an aggregate has more than %d materials: its slots are not told apart",
               TY_MESH_MAX_SLOTS);
    struct ty_scene_resources* resources = loader->scene->resources;
    resources->aggregates[resources->aggregate_count++] = aggregate;
}

// Assets of the same file share one mesh.
static void load_mesh(ty_loader* loader, ty_asset* asset)
{
    if (asset->sequence)
    {
        ty_mesh_sequence_load(loader, asset);
        if (asset->mesh)
            keep_mesh(loader, asset->mesh);
        return;
    }
    for (int i = 0; i < loader->asset_count && !asset->mesh; ++i)
        if (loader->assets[i].kind == TY_ASSET_MESH && !loader->assets[i].sequence &&
            strcmp(loader->assets[i].path, asset->path) == 0)
            asset->mesh = loader->assets[i].mesh;
    ty_error error;
    if (asset->mesh)
        return;
    ty_status status =
        asset->gltf ? ty_gltf_scene_read_meshes(asset->gltf, &error) : ty_mesh_read(asset->path, &asset->mesh, &error);
    if (status == TY_OK && asset->gltf)
        status = ty_gltf_scene_merge(asset->gltf, &asset->mesh, &error);
    if (status == TY_OK)
        keep_mesh(loader, asset->mesh);
    else
        ty_report_error(loader->errors, asset->place, "mesh", &error);
}

static void load_shape(ty_loader* loader, ty_asset* asset)
{
    ty_error error;
    ty_shape_def def = asset->shape;
    if (loader->options->check_only && def.divisions > CHECK_DIVISIONS)
        def.divisions = CHECK_DIVISIONS;
    if (ty_shape_create(&def, &asset->mesh, &error) == TY_OK)
        keep_mesh(loader, asset->mesh);
    else
        ty_report_error(loader->errors, asset->place, "shape", &error);
}

static void load_aggregate(ty_loader* loader, ty_asset* asset)
{
    ty_error error;
    const ty_mesh* prototype = asset->prototype >= 0 ? loader->assets[asset->prototype].mesh : NULL;
    if (asset->prototype >= 0 && !prototype)
        return; // its own error is reported
    if (asset->aggregate_sequence)
    {
        ty_aggregate_sequence_load(loader, asset);
        if (asset->aggregate)
            keep_aggregate(loader, asset->aggregate);
        return;
    }
    if (ty_aggregate_read(asset->path, prototype, &asset->aggregate, &error) == TY_OK)
        keep_aggregate(loader, asset->aggregate);
    else
        ty_report_error(loader->errors, asset->place, "aggregate", &error);
}

static void load_recipe(ty_loader* loader, ty_asset* asset)
{
    ty_error error;
    if (loader->options->check_only)
        return;
    if (ty_asset_cache_get(loader, asset, &error) == TY_OK)
    {
        if (asset->sequence)
            ty_mesh_sequence_load(loader, asset);
        if (asset->aggregate)
            keep_aggregate(loader, asset->aggregate);
        if (asset->mesh)
            keep_mesh(loader, asset->mesh);
    }
    else if (error.status == TY_INTERRUPTED || error.status == TY_TERMINATED)
        ty_error_list_add(loader->errors, &error);
    else
        ty_report_error(loader->errors, asset->place, "recipe", &error);
}

static bool is_wanted(const ty_loader* loader, const ty_asset* asset)
{
    return asset->used || loader->options->check_only;
}

static void load_gltf(ty_loader* loader, ty_asset* asset)
{
    ty_error error;
    if (ty_gltf_scene_read_meshes(asset->gltf, &error) != TY_OK)
    {
        ty_report_error(loader->errors, asset->place, "gltf", &error);
        return;
    }
    for (int i = 0; i < asset->gltf->mesh_count; ++i)
        if (asset->gltf->meshes[i])
            ty_complete_mesh(loader, asset->gltf->meshes[i]);
}

static void load_meshes(ty_loader* loader)
{
    for (int i = 0; i < loader->asset_count; ++i)
    {
        ty_asset* asset = &loader->assets[i];
        if (is_wanted(loader, asset) && asset->kind == TY_ASSET_MESH)
            load_mesh(loader, asset);
        else if (is_wanted(loader, asset) && asset->kind == TY_ASSET_GLTF)
            load_gltf(loader, asset);
        else if (is_wanted(loader, asset) && asset->kind == TY_ASSET_SHAPE)
            load_shape(loader, asset);
    }
}

void ty_load_assets(ty_loader* loader)
{
    double start = ty_time_now();
    struct ty_scene_resources* resources = loader->scene->resources;
    resources->meshes = TY_ARENA_ALLOC(loader->arena, ty_mesh*, loader->asset_count);
    resources->aggregates = TY_ARENA_ALLOC(loader->arena, ty_aggregate*, loader->asset_count);
    resources->passing = TY_ARENA_ALLOC(loader->arena, const char*, loader->asset_count + 1); // and one of images
    int before = loader->errors->count;
    load_meshes(loader);
    for (int i = 0; i < loader->asset_count; ++i)
        if (is_wanted(loader, &loader->assets[i]) && loader->assets[i].kind == TY_ASSET_AGGREGATE)
            load_aggregate(loader, &loader->assets[i]);
    // making an asset may take minutes: not for a scene that will not load anyway
    for (int i = 0; i < loader->asset_count && loader->errors->count == before; ++i)
        if (is_wanted(loader, &loader->assets[i]) && loader->assets[i].kind == TY_ASSET_RECIPE)
            load_recipe(loader, &loader->assets[i]);
    loader->scene->asset_seconds = ty_time_now() - start;
}
