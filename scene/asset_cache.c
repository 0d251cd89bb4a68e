// SPDX-License-Identifier: Apache-2.0
// Made assets on disk, named by the hash of everything that went into them. What is cached and what was just made are
// both read back from the file, so that they cannot differ.
#include "loader.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <unistd.h>

ty_status ty_scene_cache_folder(const char* given, char* out, ty_error* error)
{
    const char *own = getenv("TSUYA_CACHE"), *xdg = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
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

// A file that is there but cannot be read as what it should be is made anew.
static bool read_cached(const char* path, const char* key, const char* name, ty_aggregate** out)
{
    ty_error error;
    if (!ty_file_exists(path))
        return false;
    if (ty_aggregate_read(path, NULL, out, &error) == TY_OK)
    {
        if ((*out)->hash && strcmp((*out)->hash, key) == 0)
            return true;
        ty_aggregate_destroy(*out);
        *out = NULL;
        (void)ty_error_set(&error, TY_BAD_FILE, "it holds another asset");
    }
    ty_log(TY_LOG_WARNING, "asset '%s': the cached file is damaged and is made again: %s", name, error.text);
    return false;
}

static ty_status make(const ty_recipe* recipe, const char* name, const char* key, const char* path, ty_workers* workers,
                      ty_error* error)
{
    ty_aggregate* made = NULL;
    ty_status status = ty_recipe_run(recipe, key, workers, &made, error);
    if (status == TY_NOT_AT_REST && made)
    {
        ty_log(TY_LOG_WARNING, "asset '%s' did not come to rest: %s", name, error->text);
        status = TY_OK;
    }
    if (status == TY_OK)
        status = ty_aggregate_write(path, made, error);
    ty_aggregate_destroy(made);
    return status;
}

// Where the file of an asset goes. A cache that cannot be written costs time, not the picture: then the file lives in a
// folder of its own, removed after it was read.
static ty_status asset_path(const ty_scene_options* options, const char* key, char path[TY_PATH_MAX], char passing[64],
                            ty_error* error)
{
    char folder[TY_PATH_MAX], file[64];
    ty_error reason = {0}; // of a warning: not the caller's
    passing[0] = 0;
    if (ty_scene_cache_folder(options->cache_folder, folder, &reason) != TY_OK || access(folder, W_OK) != 0)
    {
        snprintf(passing, 64, "/tmp/tsuya-XXXXXX");
        if (!mkdtemp(passing))
            return ty_error_set(error, TY_BAD_FILE, "neither the folder of made assets nor /tmp can be written");
        ty_log(TY_LOG_WARNING, "made assets cannot be kept (%s)", reason.text[0] ? reason.text : "read-only folder");
        snprintf(folder, sizeof(folder), "%s", passing);
    }
    snprintf(file, sizeof(file), "%s.glb", key);
    ty_path_join(folder, file, path);
    return TY_OK;
}

ty_status ty_asset_cache_get(ty_loader* loader, const char* name, const ty_recipe* recipe, ty_aggregate** out,
                             ty_error* error)
{
    char path[TY_PATH_MAX], passing[64], key[33];
    double start = ty_time_now();
    ty_status status = ty_recipe_key(recipe, &loader->files, key, error);
    if (status == TY_OK)
        status = asset_path(loader->options, key, path, passing, error);
    if (status != TY_OK)
        return status;
    if (read_cached(path, key, name, out))
    {
        ++loader->scene->assets_cached;
        ty_log(TY_LOG_INFO, "asset '%s': %u instances from the cache, %.1f s", name, (*out)->instance_count,
               ty_time_now() - start);
        return TY_OK;
    }
    status = make(recipe, name, key, path, loader->options->workers, error);
    if (status == TY_OK)
        status = ty_aggregate_read(path, NULL, out, error);
    if (passing[0])
    {
        unlink(path);
        rmdir(passing);
    }
    if (status != TY_OK)
        return status;
    ++loader->scene->assets_made;
    ty_log(TY_LOG_INFO, "asset '%s': %u instances made, %.1f s (%s%s)", name, (*out)->instance_count,
           ty_time_now() - start, passing[0] ? "not kept" : "kept as ", passing[0] ? "" : path);
    return TY_OK;
}
