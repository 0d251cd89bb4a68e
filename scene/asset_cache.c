// SPDX-License-Identifier: Apache-2.0
// Made assets on disk, named by the hash of everything that went into them. What is cached and what was just made are
// both read back from the file, so that they cannot differ.
#include "loader.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/geometry/mesh_file.h>
#include <unistd.h>

ty_status ty_scene_cache_folder(const char* given, char* out, ty_error* error)
{
    const char *own = getenv("TSUYA_CACHE"), *xdg = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    const char* said = given ? given : own;
    out[0] = '\0';
    if (said && strcmp(said, "none") == 0)
        return TY_OK;
    if (given)
        ty_path_join(".", given, out);
    else if (own && own[0])
        ty_path_join(".", own, out);
    else if (xdg && xdg[0])
        ty_path_join(xdg, "tsuya", out);
    else if (home && home[0])
        ty_path_join(home, ".cache/tsuya", out);
    else
        return ty_error_set(error, TY_BAD_FILE, "no folder for made assets: set TSUYA_CACHE");
    return ty_folder_create(out, error);
}

typedef struct entry
{
    char path[TY_PATH_MAX];    // the file, or the folder of frames
    char pattern[TY_PATH_MAX]; // of frames
    char folder[TY_PATH_MAX];  // where it is kept, empty when it is not
    char passing[64];          // folder that goes when the scene has been read; "" = kept
    char key[33];
} entry;

static const char* frame_name(const ty_asset* asset)
{
    return asset->recipe.generator->product == TY_PRODUCT_MESH ? "frame.####.ply" : "frame.####.exr";
}

static ty_status read_mesh_hash(const char* path, char hash[33], ty_error* error)
{
    ty_mesh* mesh = NULL;
    ty_status status = ty_mesh_read_frame(path, &mesh, error);
    if (status == TY_OK && mesh->hash)
        snprintf(hash, 33, "%s", mesh->hash);
    ty_mesh_destroy(mesh);
    return status;
}

// Every frame is there, and the first is of this recipe.
static ty_status read_frames(const ty_asset* asset, const entry* e, char hash[33], ty_error* error)
{
    char path[TY_PATH_MAX];
    int count = ty_recipe_frames(&asset->recipe);
    for (int frame = 1; frame <= count; ++frame)
    {
        ty_path_frame(e->pattern, frame, path);
        if (!ty_file_exists(path))
            return ty_error_set(error, TY_BAD_FILE, "there is no '%s'", path);
    }
    ty_exr* exr = NULL;
    ty_path_frame(e->pattern, 1, path);
    if (asset->recipe.generator->product == TY_PRODUCT_MESH)
        return read_mesh_hash(path, hash, error);
    ty_status status = ty_exr_read(path, &exr, error);
    const ty_exr_attribute* attribute = exr ? ty_exr_find_attribute(exr, "tsuya/hash") : NULL;
    if (attribute && attribute->text)
        snprintf(hash, 33, "%s", attribute->text);
    ty_exr_destroy(exr);
    return status;
}

static void forget(ty_asset* asset)
{
    ty_aggregate_destroy(asset->aggregate);
    ty_mesh_destroy(asset->mesh);
    asset->aggregate = NULL;
    asset->mesh = NULL;
}

static ty_status read_made(ty_asset* asset, const entry* e, ty_error* error)
{
    char hash[33] = "";
    const char* claim = hash;
    ty_status status;
    bool frames = ty_recipe_frames(&asset->recipe) > 0;
    switch (frames ? TY_PRODUCT_FRAMES : asset->recipe.generator->product)
    {
    case TY_PRODUCT_AGGREGATE:
        status = ty_aggregate_read(e->path, NULL, &asset->aggregate, error);
        claim = status == TY_OK ? asset->aggregate->hash : NULL;
        break;
    case TY_PRODUCT_MESH:
        status = ty_mesh_read(e->path, &asset->mesh, error);
        claim = status == TY_OK ? asset->mesh->hash : NULL;
        break;
    default:
        status = read_frames(asset, e, hash, error);
        break;
    }
    if (status != TY_OK || (claim && strcmp(claim, e->key) == 0))
        return status;
    forget(asset);
    return ty_error_set(error, TY_BAD_FILE, "it holds another asset");
}

// What is there but cannot be read as what it should be is made anew.
static bool read_cached(ty_asset* asset, const entry* e)
{
    ty_error error;
    if (!ty_file_exists(e->path) && !ty_folder_exists(e->path))
        return false;
    if (read_made(asset, e, &error) == TY_OK)
        return true;
    ty_log(TY_LOG_WARNING, "asset '%s': what was kept is damaged and is made again: %s", asset->name, error.text);
    return false;
}

static ty_status make_frames(const ty_asset* asset, const entry* e, ty_workers* workers, ty_error* error)
{
    ty_atomic_folder folder;
    char pattern[TY_PATH_MAX];
    ty_status status = ty_atomic_folder_begin(&folder, e->path, error);
    if (status != TY_OK)
        return status;
    ty_path_join(folder.temporary, frame_name(asset), pattern);
    status = ty_recipe_write(&asset->recipe, e->key, pattern, e->folder[0] ? e->folder : NULL, workers, error);
    if (status == TY_OK)
        return ty_atomic_folder_commit(&folder, error);
    ty_atomic_folder_abort(&folder);
    return status;
}

static ty_status make(const ty_asset* asset, const entry* e, ty_workers* workers, ty_error* error)
{
    if (ty_recipe_frames(&asset->recipe) > 0)
        return make_frames(asset, e, workers, error);
    const char* cache = e->folder[0] ? e->folder : NULL;
    ty_status status = ty_recipe_write(&asset->recipe, e->key, e->path, cache, workers, error);
    if (status != TY_NOT_AT_REST)
        return status;
    ty_log(TY_LOG_WARNING, "asset '%s' did not come to rest: %s", asset->name, error->text);
    return TY_OK;
}

// Where an asset goes. A cache that cannot be written costs time, not the picture: then it lives in a folder of its
// own, as without a cache.
static ty_status entry_place(const ty_scene_options* options, const ty_asset* asset, entry* e, ty_error* error)
{
    static const char* const extensions[] = {"glb", "ply", "frames"};
    char file[64];
    const char* folder = e->folder;
    ty_error reason = {0}; // of a warning: not the caller's
    bool there = ty_scene_cache_folder(options->cache_folder, e->folder, &reason) == TY_OK;
    if (!there || !e->folder[0] || access(e->folder, W_OK) != 0)
    {
        if (!there || e->folder[0])
            ty_log(TY_LOG_WARNING, "made assets cannot be kept (%s)", there ? "read-only folder" : reason.text);
        snprintf(e->passing, sizeof(e->passing), TY_SCENE_PASSING);
        if (!mkdtemp(e->passing))
            return ty_error_set(error, TY_BAD_FILE, "neither the folder of made assets nor /tmp can be written");
        e->folder[0] = '\0';
        folder = e->passing;
    }
    snprintf(file, sizeof(file), "%s.%s", e->key,
             extensions[ty_recipe_frames(&asset->recipe) > 0 ? TY_PRODUCT_FRAMES : asset->recipe.generator->product]);
    ty_path_join(folder, file, e->path);
    ty_path_join(e->path, frame_name(asset), e->pattern);
    return TY_OK;
}

// Files have been read; frames are read while the scene lives.
static void pass(ty_loader* loader, const ty_asset* asset, const entry* e, ty_status status)
{
    struct ty_scene_resources* resources = loader->scene->resources;
    if (!e->passing[0])
        return;
    if (status == TY_OK && ty_recipe_frames(&asset->recipe) > 0)
    {
        resources->passing[resources->passing_count++] = ty_arena_string(loader->arena, e->path);
        return;
    }
    unlink(e->path);
    rmdir(e->passing);
}

static void log_asset(const ty_asset* asset, const entry* e, bool made, double start)
{
    char what[64];
    const ty_generator* generator = asset->recipe.generator;
    if (generator->product == TY_PRODUCT_AGGREGATE)
        snprintf(what, sizeof(what), "%u instances", asset->aggregate->instance_count);
    else if (ty_recipe_frames(&asset->recipe) == 0)
        snprintf(what, sizeof(what), "%u triangles", asset->mesh->triangle_count);
    else
        snprintf(what, sizeof(what), "%d frames", ty_recipe_frames(&asset->recipe));
    if (made)
        ty_log(TY_LOG_INFO, "asset '%s': %s made, %.1f s (%s%s)", asset->name, what, ty_time_now() - start,
               e->passing[0] ? "not kept" : "kept as ", e->passing[0] ? "" : e->path);
    else
        ty_log(TY_LOG_INFO, "asset '%s': %s from the cache, %.1f s", asset->name, what, ty_time_now() - start);
}

ty_status ty_asset_cache_get(ty_loader* loader, ty_asset* asset, ty_error* error)
{
    entry e = {.passing = ""};
    double start = ty_time_now();
    ty_status status = ty_recipe_key(&asset->recipe, &loader->files, e.key, error);
    if (status == TY_OK)
        status = entry_place(loader->options, asset, &e, error);
    if (status != TY_OK)
        return status;
    bool cached = read_cached(asset, &e);
    if (!cached)
    {
        status = make(asset, &e, loader->options->workers, error);
        if (status == TY_OK)
            status = read_made(asset, &e, error);
        pass(loader, asset, &e, status);
    }
    if (status != TY_OK)
        return status;
    asset->frames = ty_arena_string(loader->arena, e.pattern);
    *(cached ? &loader->scene->assets_cached : &loader->scene->assets_made) += 1;
    log_asset(asset, &e, !cached, start);
    return TY_OK;
}
