// SPDX-License-Identifier: Apache-2.0
// Textures: an image file as halves in ACEScg, and bilinear lookups in it.
#include "texel_wrap.h"
#include <tsuya/base/memory.h>
#include <tsuya/image/half.h>
#include <tsuya/image/image.h>
#include <tsuya/image/texture.h>

struct ty_texture
{
    int width, height;
    ty_wrap wrap;
    uint16_t* texels; // [height][width][3], top row first
};

ty_texture_def ty_texture_def_default(void)
{
    return (ty_texture_def){.wrap = TY_WRAP_REPEAT};
}

// One row as RGB; one or two channels are grey (and alpha).
static void take_row(const ty_image* image, int y, float* rgb)
{
    const float* from = image->pixels + (size_t)y * (size_t)image->width * (size_t)image->channels;
    int green = image->channels > 2 ? 1 : 0, blue = image->channels > 2 ? 2 : 0;
    for (int x = 0; x < image->width; x++, from += image->channels, rgb += 3)
    {
        rgb[0] = from[0];
        rgb[1] = from[green];
        rgb[2] = from[blue];
    }
}

// A lookup cannot fail, so a texel may not be infinite or NaN.
static uint16_t storable(float value)
{
    if (isfinite(value))
        return ty_half_from_float(value);
    return value > 0.0f ? ty_half_from_float(TY_HALF_MAX) : 0;
}

static ty_status fill(ty_texture* texture, const ty_image* image, const char* space, const ty_color* color,
                      ty_error* error)
{
    size_t row_size = (size_t)image->width * 3;
    float* row = TY_TRY_ALLOC(float, row_size);
    if (!row)
        return ty_error_set(error, TY_NO_MEMORY, "not enough memory for a texture");
    bool raw = strcmp(space, "raw") == 0;
    ty_status status = TY_OK;
    for (int y = 0; y < image->height && !status; y++)
    {
        take_row(image, y, row);
        if (!raw)
            status = ty_color_convert(color, space, "ACEScg", row, image->width, 3, error);
        for (size_t i = 0; i < row_size; i++)
            texture->texels[(size_t)y * row_size + i] = storable(row[i]);
    }
    ty_free(row);
    return status;
}

ty_status ty_texture_create(const ty_texture_def* def, const ty_color* color, ty_texture** out, ty_error* error)
{
    *out = NULL;
    ty_image image;
    ty_status status = ty_image_read_channel(def->path, NULL, &image, error);
    if (status)
        return status;
    const char* space =
        def->color_space ? def->color_space : ty_color_guess_space(color, image.is_float, image.color_space);
    ty_texture* texture = TY_ALLOC(ty_texture, 1);
    *texture = (ty_texture){.width = image.width, .height = image.height, .wrap = def->wrap};
    texture->texels = TY_TRY_ALLOC(uint16_t, (size_t)image.width * (size_t)image.height * 3);
    if (texture->texels)
        status = fill(texture, &image, space, color, error);
    else
        status = ty_error_set_at(error, TY_NO_MEMORY, def->path, 0, 0, "not enough memory for the texture");
    ty_image_term(&image);
    if (status)
        ty_texture_destroy(texture);
    else
        *out = texture;
    return status;
}

void ty_texture_destroy(ty_texture* texture)
{
    if (!texture)
        return;
    ty_free(texture->texels);
    ty_free(texture);
}

int ty_texture_width(const ty_texture* texture)
{
    return texture->width;
}

int ty_texture_height(const ty_texture* texture)
{
    return texture->height;
}

ty_rgb ty_texture_texel(const ty_texture* texture, int x, int y)
{
    const uint16_t* texel = texture->texels + ((size_t)y * (size_t)texture->width + (size_t)x) * 3;
    return ty_rgb_make(ty_half_to_float(texel[0]), ty_half_to_float(texel[1]), ty_half_to_float(texel[2]));
}

ty_rgb ty_texture_sample(const ty_texture* texture, ty_vec2 uv)
{
    int x[2], y[2];
    float s = ty_wrap_taps(uv.x, texture->width, texture->wrap, x);
    float t = ty_wrap_taps(1.0f - uv.y, texture->height, texture->wrap, y);
    ty_rgb top = ty_rgb_lerp(ty_texture_texel(texture, x[0], y[0]), ty_texture_texel(texture, x[1], y[0]), s);
    ty_rgb bottom = ty_rgb_lerp(ty_texture_texel(texture, x[0], y[1]), ty_texture_texel(texture, x[1], y[1]), s);
    return ty_rgb_lerp(top, bottom, t);
}
