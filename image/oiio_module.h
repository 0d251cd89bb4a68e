// SPDX-License-Identifier: Apache-2.0
// OpenImageIO brings two hundred libraries and a fifth of a second at start-up: it lives in a module of its own, which
// is loaded when the first image file of its kinds is met. The module exports one table; oiio_door.c calls through it.
#pragma once
#include "image_oiio.h"
#include "tiles_oiio.h"

#define TY_OIIO_MODULE_FILE "libtsuya_oiio.so"
#define TY_OIIO_MODULE_TABLE "ty_oiio_module_table"

// Every function of both headers.
#define TY_OIIO_FUNCTIONS(X)                                                                                           \
    X(ty_oiio_open)                                                                                                    \
    X(ty_oiio_read)                                                                                                    \
    X(ty_oiio_channel_name)                                                                                            \
    X(ty_oiio_close)                                                                                                   \
    X(ty_oiio_encode)                                                                                                  \
    X(ty_oiio_output_bytes)                                                                                            \
    X(ty_oiio_output_destroy)                                                                                          \
    X(ty_oiio_tiles_create)                                                                                            \
    X(ty_oiio_tiles_destroy)                                                                                           \
    X(ty_oiio_tiles_get_stats)                                                                                         \
    X(ty_oiio_tiles_open)                                                                                              \
    X(ty_oiio_tile_take)                                                                                               \
    X(ty_oiio_tiles_get_error)                                                                                         \
    X(ty_oiio_tiled_write)

#define TY_OIIO_MEMBER(name) __typeof__(&name) name;
typedef struct ty_oiio_module
{
    const char* version; // of the program that the module was built with
    TY_OIIO_FUNCTIONS(TY_OIIO_MEMBER)
} ty_oiio_module;
#undef TY_OIIO_MEMBER
