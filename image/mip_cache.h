// SPDX-License-Identifier: Apache-2.0
// Converted files: found by what went into them, or made.
#pragma once
#include "tiles_oiio.h"
#include <stdatomic.h>
#include <tsuya/image/mip_texture.h>

typedef struct ty_mip_image
{
    char key[33];
    ty_oiio_tile_file file;
} ty_mip_image;

struct ty_mip_cache
{
    ty_oiio_tiles* tiles;
    const ty_color* color; // borrowed
    char* folder;          // NULL = nothing is kept
    ty_mip_image** images; // owned, each where it is until the end
    int image_count, image_capacity;
    int* temporary; // descriptors of files without a name
    int temporary_count, temporary_capacity;
    ty_mip_cache_stats stats;
    atomic_uint_fast64_t failures; // tiles that could not be read
    atomic_flag has_reason;
    char reason[256]; // of the first failure
};

// The image of a file by its content and of what is asked for (path, color_space and channel of what count); lives as
// long as the cache.
TY_CHECKED ty_status ty_mip_cache_get(ty_mip_cache* cache, const ty_mip_texture_def* what, const char* path,
                                      const ty_mip_image** out, ty_error* error);
