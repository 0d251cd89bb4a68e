// SPDX-License-Identifier: Apache-2.0
// Conversion of images for lookups, and their reductions by box filters.
#include "mip_build.h"
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/half.h>

void ty_mip_levels_term(ty_mip_levels* levels)
{
    for (int i = 0; i < levels->count; i++)
        ty_free(levels->levels[i]);
    *levels = (ty_mip_levels){0};
}

// A lookup cannot fail, so a texel may not be infinite or NaN.
static uint16_t storable(float value)
{
    if (isfinite(value))
        return ty_half_from_float(value);
    return value > 0.0f ? ty_half_from_float(TY_HALF_MAX) : 0;
}

typedef struct conversion
{
    const ty_color* color;
    const char* space;
    bool raw;
    int channels; // 1..4 of the result
} conversion;

static bool has_alpha(int channels)
{
    return channels == 2 || channels == 4;
}

// Numbers keep one channel where the file has one; a grey colour may be tinted by its space, so that it takes three.
static int channels_of(int in_file, bool raw)
{
    int most = in_file > 4 ? 4 : in_file;
    return raw || most > 2 ? most : has_alpha(most) ? 4 : 3;
}

// The first four channels of a row, interleaved as the result wants them.
static void take_row(const ty_image* image, int y, int channels, float* to)
{
    const float* from = image->pixels + (size_t)y * (size_t)image->width * (size_t)image->channels;
    bool spread = image->channels < 3 && channels > 2; // grey becomes colour
    for (int x = 0; x < image->width; x++, from += image->channels, to += channels)
    {
        for (int c = 0; c < channels; c++)
            to[c] = from[spread ? 0 : c];
        if (spread && channels == 4)
            to[3] = from[1];
    }
}

static ty_status convert_rows(const ty_image* image, const conversion* c, float* row, uint16_t* texels, ty_error* error)
{
    size_t row_size = (size_t)image->width * (size_t)c->channels;
    ty_status status = TY_OK;
    for (int y = 0; y < image->height && !status; y++)
    {
        take_row(image, y, c->channels, row);
        if (!c->raw)
            status = ty_color_convert(c->color, c->space, "ACEScg", row, image->width, c->channels, error);
        for (size_t i = 0; i < row_size; i++)
            texels[(size_t)y * row_size + i] = storable(row[i]);
    }
    return status;
}

// Which texels of a side of n a texel of the next smaller side covers, and their weights: two, or three where n is odd.
// That way every texel counts as much as any other.
static int reduce_taps(int n, int i, float weight[3])
{
    if (n == 1)
    {
        weight[0] = 1.0f;
        return 1;
    }
    if (n % 2 == 0)
    {
        weight[0] = weight[1] = 0.5f;
        return 2;
    }
    int m = n / 2;
    weight[0] = (float)(m - i) / (float)n;
    weight[1] = (float)m / (float)n;
    weight[2] = (float)(i + 1) / (float)n;
    return 3;
}

static void reduce_texel(const uint16_t* from, int width, int channels, int x_taps, const float* wx, int y_taps,
                         const float* wy, uint16_t* to)
{
    for (int c = 0; c < channels; c++)
    {
        float sum = 0.0f;
        for (int j = 0; j < y_taps; j++)
            for (int i = 0; i < x_taps; i++)
                sum += wy[j] * wx[i] *
                       ty_half_to_float(from[((size_t)j * (size_t)width + (size_t)i) * (size_t)channels + (size_t)c]);
        to[c] = ty_half_from_float(sum);
    }
}

static void reduce(const uint16_t* from, int width, int height, int channels, uint16_t* to)
{
    int to_width = width > 1 ? width / 2 : 1, to_height = height > 1 ? height / 2 : 1;
    for (int y = 0; y < to_height; y++)
    {
        float wx[3], wy[3];
        int y_taps = reduce_taps(height, y, wy);
        for (int x = 0; x < to_width; x++, to += channels)
        {
            int x_taps = reduce_taps(width, x, wx);
            size_t corner = (size_t)(2 * y) * (size_t)width + (size_t)(2 * x);
            reduce_texel(from + corner * (size_t)channels, width, channels, x_taps, wx, y_taps, wy, to);
        }
    }
}

static ty_status no_memory(ty_error* error)
{
    return ty_error_set(error, TY_NO_MEMORY, "not enough memory for a texture");
}

static uint16_t* add_level(ty_mip_levels* levels, int width, int height)
{
    uint16_t* texels = TY_TRY_ALLOC(uint16_t, (size_t)width * (size_t)height * (size_t)levels->channels);
    if (texels)
        levels->levels[levels->count++] = texels;
    return texels;
}

static ty_status build_first(ty_image* image, const conversion* c, ty_mip_levels* out, ty_error* error)
{
    *out = (ty_mip_levels){.width = image->width, .height = image->height, .channels = c->channels};
    uint16_t* texels = add_level(out, image->width, image->height);
    float* row = TY_TRY_ALLOC(float, (size_t)image->width*(size_t)c->channels);
    ty_status status = texels && row ? convert_rows(image, c, row, texels, error) : no_memory(error);
    ty_free(row);
    return status;
}

ty_status ty_mip_levels_build(ty_image* image, const char* space, const ty_color* color, ty_mip_levels* out,
                              ty_error* error)
{
    conversion c = {.color = color, .space = space};
    if (!space)
        c.space = ty_color_guess_space(color, image->is_float, image->color_space);
    c.raw = strcmp(c.space, "raw") == 0;
    c.channels = channels_of(image->channels, c.raw);
    ty_status status = build_first(image, &c, out, error);
    ty_image_term(image);
    int width = out->width, height = out->height;
    while (!status && (width > 1 || height > 1))
    {
        const uint16_t* from = out->levels[out->count - 1];
        int to_width = width > 1 ? width / 2 : 1, to_height = height > 1 ? height / 2 : 1;
        uint16_t* to = add_level(out, to_width, to_height);
        if (to)
            reduce(from, width, height, out->channels, to);
        else
            status = no_memory(error);
        width = to_width;
        height = to_height;
    }
    if (status)
        ty_mip_levels_term(out);
    return status;
}
