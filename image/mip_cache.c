// SPDX-License-Identifier: Apache-2.0
// The cache of converted textures: keys, files, and files without a name where nothing can be kept.
#include "mip_cache.h"
#include "mip_build.h"
#include "mip_seal.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/hash.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>
#include <unistd.h>

#define FORMAT "tsuya texture 3" // in the key: what another version made is something else

enum
{
    TEXT = 512,
};

static ty_status shim_status(ty_oiio_result result, const char* path, const char* doing, const char* text,
                             ty_error* error)
{
    if (result == TY_OIIO_NO_MEMORY)
        return ty_error_set_at(error, TY_NO_MEMORY, path, 0, 0, "not enough memory for the texture");
    return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "%s: %s", doing, text);
}

ty_status ty_mip_cache_create(const ty_mip_cache_def* def, const ty_color* color, ty_mip_cache** out, ty_error* error)
{
    char text[TEXT];
    *out = NULL;
    ty_oiio_tiles* tiles = NULL;
    ty_oiio_result result = ty_oiio_tiles_create(def->memory_bytes, &tiles, text, sizeof text);
    if (result != TY_OIIO_OK)
        return shim_status(result, NULL, "cannot make a texture cache", text, error);
    ty_mip_cache* cache = TY_ALLOC(ty_mip_cache, 1);
    cache->tiles = tiles;
    cache->color = color;
    if (def->folder && ty_folder_exists(def->folder) && access(def->folder, W_OK) == 0)
        cache->folder = ty_string_copy(def->folder);
    *out = cache;
    return TY_OK;
}

void ty_mip_cache_destroy(ty_mip_cache* cache)
{
    if (!cache)
        return;
    ty_oiio_tiles_destroy(cache->tiles);
    for (int i = 0; i < cache->temporary_count; i++)
        close(cache->temporary[i]);
    for (int i = 0; i < cache->image_count; i++)
        ty_free(cache->images[i]);
    ty_free(cache->temporary);
    ty_free(cache->images);
    ty_free(cache->folder);
    ty_free(cache);
}

void ty_mip_cache_get_stats(const ty_mip_cache* cache, ty_mip_cache_stats* out)
{
    ty_oiio_tile_stats tiles;
    ty_oiio_tiles_get_stats(cache->tiles, &tiles);
    *out = cache->stats;
    out->bytes_now = tiles.bytes_now;
    out->tiles_read = tiles.tiles_read;
    out->tiles_peak = tiles.tiles_peak;
    out->bytes_read = tiles.bytes_read;
}

ty_status ty_mip_cache_check(ty_mip_cache* cache, ty_error* error)
{
    unsigned long long failures = atomic_load(&cache->failures);
    if (!failures)
        return TY_OK;
    return ty_error_set(error, TY_BAD_FILE, "%llu lookups in textures found a tile that cannot be read: %s", failures,
                        cache->reason);
}

// One channel by itself is numbers.
static const char* space_of(const ty_mip_texture_def* what)
{
    return what->channel ? "raw" : what->color_space;
}

static ty_status make_key(const ty_mip_cache* cache, const ty_mip_texture_def* what, const char* path, char key[33],
                          ty_error* error)
{
    ty_hasher* hasher = ty_hasher_create();
    ty_hasher_add_string(hasher, FORMAT);
    const char* space = space_of(what);
    ty_hasher_add_string(hasher, space ? space : "");
    ty_hasher_add_string(hasher, what->channel ? what->channel : "");
    if (!space || strcmp(space, "raw") != 0)
        ty_hasher_add_string(hasher, ty_color_identity(cache->color));
    ty_status status = ty_file_hash(path, UINT64_MAX, hasher, error);
    ty_hash_hex(ty_hasher_end(hasher), key);
    return status;
}

static ty_status convert(ty_mip_cache* cache, const ty_mip_texture_def* what, const char* path, const char* key,
                         const char* target, ty_error* error)
{
    ty_image image;
    ty_mip_levels levels;
    double start = ty_time_now();
    ty_status status = ty_image_read_channel(path, what->channel, &image, error);
    if (status)
        return status;
    status = ty_mip_levels_build(&image, space_of(what), cache->color, &levels, error);
    ty_image_term(&image);
    if (status)
        return status;
    char text[TEXT];
    ty_oiio_result result = ty_oiio_tiled_write(target, key, levels.width, levels.height, levels.channels,
                                                (const uint16_t* const*)levels.levels, levels.count, text, sizeof text);
    ty_mip_levels_term(&levels);
    if (result != TY_OIIO_OK)
        return shim_status(result, target, "cannot keep the converted texture", text, error);
    cache->stats.files_converted++;
    cache->stats.convert_seconds += ty_time_now() - start;
    return TY_OK;
}

static ty_status convert_kept(ty_mip_cache* cache, const ty_mip_texture_def* what, const char* path, const char* key,
                              const char* target, ty_error* error)
{
    ty_atomic_file file;
    ty_status status = ty_atomic_begin(&file, target, error);
    if (status)
        return status;
    status = convert(cache, what, path, key, file.temporary, error);
    status = status ? status : ty_mip_seal(file.temporary, error);
    if (!status)
        return ty_atomic_commit(&file, error);
    ty_atomic_abort(&file);
    return status;
}

// A file that nobody else sees and that is gone with the process, whatever ends it.
static ty_status convert_passing(ty_mip_cache* cache, const ty_mip_texture_def* what, const char* path, const char* key,
                                 char target[TY_PATH_MAX], ty_error* error)
{
    char name[] = "/tmp/tsuya-XXXXXX";
    int fd = mkostemp(name, O_CLOEXEC);
    if (fd < 0)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0,
                               "no place for the converted texture: neither the cache nor /tmp can be written: %s",
                               strerror(errno));
    unlink(name);
    if (cache->temporary_count == 0)
        ty_log(TY_LOG_WARNING, "converted textures cannot be kept (%s): they lie in /tmp until the end",
               cache->folder ? cache->folder : "no folder that can be written");
    if (cache->temporary_count == cache->temporary_capacity)
    {
        int capacity = cache->temporary_capacity ? 2 * cache->temporary_capacity : 16;
        cache->temporary = ty_grow(cache->temporary, (size_t)cache->temporary_count, (size_t)capacity, sizeof(int));
        cache->temporary_capacity = capacity;
    }
    cache->temporary[cache->temporary_count++] = fd;
    snprintf(target, TY_PATH_MAX, "/proc/self/fd/%d", fd);
    return convert(cache, what, path, key, target, error);
}

static void add_image(ty_mip_cache* cache, ty_mip_image* image)
{
    if (cache->image_count == cache->image_capacity)
    {
        int capacity = cache->image_capacity ? 2 * cache->image_capacity : 16;
        cache->images = ty_grow(cache->images, (size_t)cache->image_count, (size_t)capacity, sizeof(*cache->images));
        cache->image_capacity = capacity;
    }
    cache->images[cache->image_count++] = image;
}

// A file that an earlier run has kept. What is there but is not what it should be is made anew.
static bool open_kept(ty_mip_cache* cache, const char* kept, ty_mip_image* image)
{
    char text[TEXT];
    if (!ty_file_exists(kept))
        return false;
    if (!ty_mip_is_sealed(kept))
        snprintf(text, sizeof text, "it is cut off or changed");
    else if (ty_oiio_tiles_open(cache->tiles, kept, image->key, &image->file, text, sizeof text) == TY_OIIO_OK)
    {
        cache->stats.files_found++;
        return true;
    }
    ty_log(TY_LOG_WARNING, "%s: the converted texture is damaged and is made again: %s", kept, text);
    return false;
}

static ty_status open_image(ty_mip_cache* cache, const ty_mip_texture_def* what, const char* path, ty_mip_image* image,
                            ty_error* error)
{
    char target[TY_PATH_MAX] = "", name[64], text[TEXT];
    snprintf(name, sizeof name, "%s.exr", image->key);
    if (cache->folder)
        ty_path_join(cache->folder, name, target);
    if (cache->folder && open_kept(cache, target, image))
        return TY_OK;
    ty_status status = cache->folder ? convert_kept(cache, what, path, image->key, target, error)
                                     : convert_passing(cache, what, path, image->key, target, error);
    if (status)
        return status;
    ty_oiio_result result = ty_oiio_tiles_open(cache->tiles, target, image->key, &image->file, text, sizeof text);
    return result == TY_OIIO_OK ? TY_OK : shim_status(result, path, "cannot read the converted texture", text, error);
}

ty_status ty_mip_cache_get(ty_mip_cache* cache, const ty_mip_texture_def* what, const char* path,
                           const ty_mip_image** out, ty_error* error)
{
    char key[33];
    ty_status status = make_key(cache, what, path, key, error);
    if (status)
        return status;
    for (int i = 0; i < cache->image_count; i++)
        if (strcmp(cache->images[i]->key, key) == 0)
        {
            *out = cache->images[i];
            return TY_OK;
        }
    ty_mip_image* image = TY_ALLOC(ty_mip_image, 1);
    memcpy(image->key, key, sizeof key);
    status = open_image(cache, what, path, image, error);
    if (status)
    {
        ty_free(image);
        return status;
    }
    add_image(cache, image);
    *out = image;
    return TY_OK;
}
