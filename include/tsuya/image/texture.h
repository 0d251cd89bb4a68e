// SPDX-License-Identifier: Apache-2.0
// A texture in memory: half floats in ACEScg (or raw), bilinear lookups.
#pragma once
#include <tsuya/base/math.h>
#include <tsuya/base/status.h>
#include <tsuya/image/color.h>

typedef struct ty_texture ty_texture; // opaque, const after creation

typedef enum ty_wrap
{
    TY_WRAP_REPEAT,
    TY_WRAP_CLAMP,
    TY_WRAP_MIRROR,
} ty_wrap;

typedef struct ty_texture_def
{
    const char* path;        // borrowed during create
    const char* color_space; // NULL = guess; "raw" = data, untouched
    ty_wrap wrap;
} ty_texture_def;

ty_texture_def ty_texture_def_default(void);
TY_CHECKED ty_status ty_texture_create(const ty_texture_def* def, const ty_color* color, ty_texture** out,
                                       ty_error* error);
void ty_texture_destroy(ty_texture* texture); // NULL is allowed

int ty_texture_width(const ty_texture* texture);
int ty_texture_height(const ty_texture* texture);
// Texel (x, y), top row first, inside the image.
ty_rgb ty_texture_texel(const ty_texture* texture, int x, int y);
// Bilinear at uv; v = 0 is the bottom row (glTF files are flipped on load). Texel centres at (i + .5) / width.
ty_rgb ty_texture_sample(const ty_texture* texture, ty_vec2 uv);
