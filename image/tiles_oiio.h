// SPDX-License-Identifier: Apache-2.0
// The C face of OpenImageIO's image cache: tiled, MIP-mapped half files, of which only the tiles in use are in memory.
#pragma once
#include "image_oiio.h"
#include <stdint.h>

#ifdef __cplusplus
extern "C"
{
#endif

    enum
    {
        TY_TILE_BITS = 6,
        TY_TILE_SIZE = 1 << TY_TILE_BITS, // texels a side
        TY_LEVELS_MAX = 16,
    };

    typedef struct ty_oiio_tiles ty_oiio_tiles; // opaque: the cache

    typedef struct ty_oiio_tile_file
    {
        void* handle;
        int order;                                // in which files were opened
        int width, height, channels, level_count; // a level is half the one before, rounded down, at least 1
    } ty_oiio_tile_file;

    typedef struct ty_oiio_tile_stats
    {
        uint64_t bytes_now;  // in memory
        uint64_t tiles_read; // from files, since the beginning
        uint64_t tiles_peak; // in memory at a time
        uint64_t bytes_read; // unpacked
    } ty_oiio_tile_stats;

    // Tiles that no thread looks at are dropped when all together exceed memory_bytes (at least 16 MiB).
    ty_oiio_result ty_oiio_tiles_create(uint64_t memory_bytes, ty_oiio_tiles** out, char* text, size_t text_size);
    void ty_oiio_tiles_destroy(ty_oiio_tiles* tiles); // NULL is allowed
    void ty_oiio_tiles_get_stats(const ty_oiio_tiles* tiles, ty_oiio_tile_stats* out);

    // Only what ty_oiio_tiled_write has written with the same key is accepted. The path must keep its meaning as long
    // as the cache lives.
    ty_oiio_result ty_oiio_tiles_open(ty_oiio_tiles* tiles, const char* path, const char* key, ty_oiio_tile_file* out,
                                      char* text, size_t text_size);

    // A tile of a level, by its column and row: [TY_TILE_SIZE][TY_TILE_SIZE][channels] halves, there until this thread
    // takes its next. Any thread; each keeps hold of a few that it took last. NULL = it cannot be read.
    const uint16_t* ty_oiio_tile_take(ty_oiio_tiles* tiles, const ty_oiio_tile_file* file, int level, int column,
                                      int row);
    // The last reason for a NULL of this thread.
    void ty_oiio_tiles_get_error(ty_oiio_tiles* tiles, char* text, size_t text_size);

    // levels[i] holds the halves of level i, interleaved. Everything has reached the file when this returns well.
    ty_oiio_result ty_oiio_tiled_write(const char* path, const char* key, int width, int height, int channels,
                                       const uint16_t* const* levels, int level_count, char* text, size_t text_size);

#ifdef __cplusplus
}
#endif
