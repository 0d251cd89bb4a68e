// SPDX-License-Identifier: Apache-2.0
// Textures of surfaces: from assets and files to the cache of tiles, at the scene's time.
#include "loader.h"
#include <string.h>
#include <tsuya/base/log.h>

static bool same_text(const char* a, const char* b)
{
    return a && b ? strcmp(a, b) == 0 : a == b;
}

static bool same_texture(const ty_surface_texture* a, const ty_surface_texture* b)
{
    const ty_mip_texture_def *x = &a->def, *y = &b->def;
    return a->asset == b->asset && same_text(x->path, y->path) && same_text(x->color_space, y->color_space) &&
           same_text(x->channel, y->channel) && x->wrap[0] == y->wrap[0] && x->wrap[1] == y->wrap[1];
}

static int index_of(ty_loader* loader, const ty_surface_texture* texture)
{
    ty_scene* scene = loader->scene;
    for (int i = 0; i < scene->surface_texture_count; ++i)
        if (same_texture(&loader->surface_textures[i], texture))
            return i;
    loader->surface_textures =
        ty_loader_grow(loader->tree.arena, loader->surface_textures, scene->surface_texture_count,
                       &loader->surface_texture_capacity, sizeof(*loader->surface_textures));
    loader->surface_textures[scene->surface_texture_count] = *texture;
    return scene->surface_texture_count++;
}

// Numbers are taken as they stand in the file unless the asset names a space.
static const char* space_for(const char* named, bool is_data)
{
    return named || !is_data ? named : "raw";
}

ty_mip_texture_def ty_sequence_timing(const ty_sequence_def* sequence)
{
    ty_mip_texture_def def = ty_mip_texture_def_default();
    def.fps = sequence->fps;
    def.start = sequence->start;
    def.first = sequence->first_frame;
    def.last = sequence->last_frame;
    def.end = sequence->loop     ? TY_SEQUENCE_LOOP
              : sequence->mirror ? TY_SEQUENCE_MIRROR
              : sequence->hold   ? TY_SEQUENCE_HOLD
                                 : TY_SEQUENCE_STOP;
    def.blend = sequence->interpolate == 1;
    return def;
}

void ty_sequence_check(ty_loader* loader, const ty_sequence_def* sequence, ty_place place)
{
    if (sequence->loop + sequence->mirror + sequence->hold > 1)
        ty_report(loader->errors, place, TY_BAD_INPUT, "only one of 'loop', 'mirror' and 'hold'");
}

static void take_layer(ty_surface_texture* texture, const ty_node* layer)
{
    if (!layer)
        return;
    texture->def.channel = layer->text;
    texture->place = layer->place;
}

int ty_surface_texture_of_asset(ty_loader* loader, int asset_index, const ty_node* name, const ty_node* layer,
                                bool is_data)
{
    ty_asset* asset = &loader->assets[asset_index];
    ty_surface_texture texture = {.def = ty_mip_texture_def_default(), .place = asset->place, .asset = -1};
    bool made = asset->kind == TY_ASSET_RECIPE && asset->recipe.generator->product == TY_PRODUCT_FRAMES;
    if (asset->kind == TY_ASSET_NONE)
        return -1; // reported where it is defined; without a texture the material is not made
    if (asset->kind == TY_ASSET_TEXTURE)
    {
        texture.def.path = asset->texture_def.texture;
        texture.def.color_space = space_for(asset->texture_def.color_space, is_data);
        texture.def.wrap[0] = texture.def.wrap[1] = (ty_wrap)asset->texture_def.wrap;
    }
    else if (asset->kind == TY_ASSET_FRAMES || made)
    {
        texture.def = ty_sequence_timing(&asset->frames_def.sequence);
        texture.def.wrap[0] = texture.def.wrap[1] = (ty_wrap)asset->frames_def.wrap;
        texture.def.path = made ? NULL : asset->path;
        texture.def.color_space = space_for(asset->frames_def.color_space, is_data);
        texture.asset = asset_index;
    }
    else
    {
        ty_report(loader->errors, name->place, TY_BAD_INPUT, "'texture': asset '%.200s' is no texture", asset->name);
        return -1;
    }
    if (made && layer && !ty_recipe_bring_channel(loader, &asset->recipe, layer))
        return -1;
    take_layer(&texture, layer);
    asset->used = asset->is_texture = true;
    return index_of(loader, &texture);
}

int ty_surface_texture_of_file(ty_loader* loader, ty_node* name, const ty_node* layer, bool is_data, const int wrap[2])
{
    ty_surface_texture texture = {.def = ty_mip_texture_def_default(), .place = name->place, .asset = -1};
    texture.def.color_space = space_for(NULL, is_data);
    texture.def.path = ty_files_use(&loader->files, name, "texture");
    take_layer(&texture, layer);
    for (int i = 0; i < 2 && wrap[i] >= 0; ++i)
        texture.def.wrap[i] = (ty_wrap)wrap[i];
    return texture.def.path ? index_of(loader, &texture) : -1;
}

static void load_texture(ty_loader* loader, int index)
{
    ty_scene* scene = loader->scene;
    ty_surface_texture* entry = &loader->surface_textures[index];
    ty_mip_texture** texture = &scene->surface_textures[index];
    const ty_asset* asset = entry->asset >= 0 ? &loader->assets[entry->asset] : NULL;
    bool checks = loader->options->check_only;
    ty_error error;
    if (asset && asset->kind == TY_ASSET_RECIPE)
        entry->def.path = asset->frames;
    if (!entry->def.path)
    {
        if (asset && checks) // it will be as long as the recipe says
            ty_check_sequence_covers(loader, &entry->def, asset->recipe.generator->frame_count(asset->recipe.def),
                                     entry->place);
        return; // not made: only a check, or its own mistake is reported
    }
    if (ty_mip_texture_create(scene->texture_cache, &entry->def, texture, &error) != TY_OK ||
        (checks && ty_mip_texture_verify(*texture, &error) != TY_OK))
        ty_report_error(loader->errors, entry->place, "texture", &error);
    else if (asset && (checks || loader->options->frame_count > 0))
        ty_check_sequence_covers(loader, &entry->def, ty_mip_texture_frame_count(*texture), entry->place);
}

void ty_set_texture_times(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    ty_error error;
    for (int i = 0; i < scene->surface_texture_count; ++i)
        if (scene->surface_textures[i] &&
            ty_mip_texture_set_time(scene->surface_textures[i], scene->seconds, &error) != TY_OK)
            ty_report_error(loader->errors, loader->surface_textures[i].place, "texture", &error);
}

static bool create_cache(ty_loader* loader)
{
    char folder[TY_PATH_MAX];
    const ty_scene_options* options = loader->options;
    ty_error error;
    bool keeps =
        !options->check_only && ty_scene_cache_folder(options->cache_folder, folder, &error) == TY_OK && folder[0];
    const ty_mip_cache_def def = {keeps ? folder : NULL,
                                  options->texture_bytes ? options->texture_bytes : TY_MIP_CACHE_BYTES};
    if (ty_mip_cache_create(&def, loader->scene->color, &loader->scene->texture_cache, &error) == TY_OK)
        return true;
    ty_error_list_add(loader->errors, &error);
    return false;
}

void ty_load_surface_textures(ty_loader* loader)
{
    ty_scene* scene = loader->scene;
    int before = loader->errors->count;
    for (int i = 0; i < loader->asset_count && loader->options->check_only; ++i)
        if (!loader->assets[i].is_texture &&
            (loader->assets[i].kind == TY_ASSET_TEXTURE || loader->assets[i].kind == TY_ASSET_FRAMES))
            (void)ty_surface_texture_of_asset(loader, i, loader->asset_map->items[i], NULL, false);
    scene->surface_textures = TY_ARENA_ALLOC(loader->arena, ty_mip_texture*, scene->surface_texture_count);
    if (scene->surface_texture_count == 0 || !create_cache(loader))
        return;
    for (int i = 0; i < scene->surface_texture_count; ++i)
        load_texture(loader, i);
    if (loader->errors->count == before && !loader->options->check_only)
        ty_set_texture_times(loader);
}
