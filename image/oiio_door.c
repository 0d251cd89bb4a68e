// SPDX-License-Identifier: Apache-2.0
// The functions of image_oiio.h and tiles_oiio.h, through the module that is loaded at the first use.
#include "oiio_module.h"
#include <dlfcn.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

static _Atomic(const ty_oiio_module*) loaded;

// NULL with a reason when the module cannot be used. Two threads that come first both load it; the loader makes them
// one. It stays until the end of the program.
static const ty_oiio_module* module(char* text, size_t text_size)
{
    const ty_oiio_module* table = atomic_load_explicit(&loaded, memory_order_acquire);
    if (table)
        return table;
    void* library = dlopen(TY_OIIO_MODULE_FILE, RTLD_LAZY | RTLD_LOCAL); // beside the program: its RUNPATH
    table = library ? dlsym(library, TY_OIIO_MODULE_TABLE) : NULL;
    if (!table)
    {
        const char* reason = dlerror();
        snprintf(text, text_size, "the program's module for image files cannot be loaded: %s", reason ? reason : "");
        return NULL;
    }
    if (strcmp(table->version, TSUYA_VERSION) != 0)
    {
        snprintf(text, text_size, "the module %s is of version %s, the program of %s", TY_OIIO_MODULE_FILE,
                 table->version, TSUYA_VERSION);
        return NULL;
    }
    atomic_store_explicit(&loaded, table, memory_order_release);
    return table;
}

// For objects that the module has made: it is there.
static const ty_oiio_module* present(void)
{
    return atomic_load_explicit(&loaded, memory_order_acquire);
}

ty_oiio_result ty_oiio_open(const char* format, const char* path, ty_oiio_input** out, ty_oiio_info* info, char* text,
                            size_t text_size)
{
    *out = NULL;
    const ty_oiio_module* m = module(text, text_size);
    return m ? m->ty_oiio_open(format, path, out, info, text, text_size) : TY_OIIO_FAILED;
}

ty_oiio_result ty_oiio_read(ty_oiio_input* input, int begin, int end, float* pixels, char* text, size_t text_size)
{
    return present()->ty_oiio_read(input, begin, end, pixels, text, text_size);
}

const char* ty_oiio_channel_name(const ty_oiio_input* input, int channel)
{
    return present()->ty_oiio_channel_name(input, channel);
}

void ty_oiio_close(ty_oiio_input* input)
{
    if (input)
        present()->ty_oiio_close(input);
}

ty_oiio_result ty_oiio_encode(const char* format, int width, int height, int channels, int bits, const void* levels,
                              const char* color_space, ty_oiio_output** out, char* text, size_t text_size)
{
    *out = NULL;
    const ty_oiio_module* m = module(text, text_size);
    return m ? m->ty_oiio_encode(format, width, height, channels, bits, levels, color_space, out, text, text_size)
             : TY_OIIO_FAILED;
}

const void* ty_oiio_output_bytes(const ty_oiio_output* output, size_t* size)
{
    return present()->ty_oiio_output_bytes(output, size);
}

void ty_oiio_output_destroy(ty_oiio_output* output)
{
    if (output)
        present()->ty_oiio_output_destroy(output);
}

ty_oiio_result ty_oiio_tiles_create(uint64_t memory_bytes, ty_oiio_tiles** out, char* text, size_t text_size)
{
    *out = NULL;
    const ty_oiio_module* m = module(text, text_size);
    return m ? m->ty_oiio_tiles_create(memory_bytes, out, text, text_size) : TY_OIIO_FAILED;
}

void ty_oiio_tiles_destroy(ty_oiio_tiles* tiles)
{
    if (tiles)
        present()->ty_oiio_tiles_destroy(tiles);
}

void ty_oiio_tiles_get_stats(const ty_oiio_tiles* tiles, ty_oiio_tile_stats* out)
{
    present()->ty_oiio_tiles_get_stats(tiles, out);
}

ty_oiio_result ty_oiio_tiles_open(ty_oiio_tiles* tiles, const char* path, const char* key, ty_oiio_tile_file* out,
                                  char* text, size_t text_size)
{
    return present()->ty_oiio_tiles_open(tiles, path, key, out, text, text_size);
}

const uint16_t* ty_oiio_tile_take(ty_oiio_tiles* tiles, const ty_oiio_tile_file* file, int level, int column, int row)
{
    return present()->ty_oiio_tile_take(tiles, file, level, column, row);
}

void ty_oiio_tiles_get_error(ty_oiio_tiles* tiles, char* text, size_t text_size)
{
    present()->ty_oiio_tiles_get_error(tiles, text, text_size);
}

ty_oiio_result ty_oiio_tiled_write(const char* path, const char* key, int width, int height, int channels,
                                   const uint16_t* const* levels, int level_count, char* text, size_t text_size)
{
    const ty_oiio_module* m = module(text, text_size);
    return m ? m->ty_oiio_tiled_write(path, key, width, height, channels, levels, level_count, text, text_size)
             : TY_OIIO_FAILED;
}
