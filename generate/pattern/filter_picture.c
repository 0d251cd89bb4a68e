// SPDX-License-Identifier: Apache-2.0
// The picture that is filtered: read, brought to the field's size, made into tones.
#include "filter_run.h"
#include <tsuya/base/memory.h>
#include <tsuya/image/image.h>

void ty_filter_picture_term(ty_filter_picture* picture)
{
    for (int i = 0; i < 3; i++)
    {
        ty_free(picture->rgb[i]);
        ty_free(picture->tone[i]);
    }
    *picture = (ty_filter_picture){0};
}

// Between the middles of pixels; the rim is repeated.
static ty_rgb bilinear(const ty_image* image, float x, float y)
{
    float at[2] = {ty_clamp(x, 0.0f, (float)(image->width - 1)), ty_clamp(y, 0.0f, (float)(image->height - 1))};
    int i = (int)at[0], j = (int)at[1];
    int right = i + 1 < image->width ? i + 1 : i, down = j + 1 < image->height ? j + 1 : j;
    float fx = at[0] - (float)i, fy = at[1] - (float)j;
    const int corners[4][2] = {{i, j}, {right, j}, {i, down}, {right, down}};
    ty_rgb c[4];
    for (int k = 0; k < 4; k++)
    {
        const float* p = image->pixels + 3 * ((size_t)corners[k][1] * (size_t)image->width + (size_t)corners[k][0]);
        c[k] = (ty_rgb){p[0], p[1], p[2]};
    }
    return ty_rgb_lerp(ty_rgb_lerp(c[0], c[1], fx), ty_rgb_lerp(c[2], c[3], fx), fy);
}

// To width x height: means where both sides become smaller, else between pixels.
static ty_status resize(ty_image* image, int width, int height, ty_error* error)
{
    if (image->width == width && image->height == height)
        return TY_OK;
    ty_image out = {.width = width, .height = height, .channels = 3};
    if (width <= image->width && height <= image->height)
    {
        ty_status status = ty_image_shrink(image, width, height, &out, error);
        if (status != TY_OK)
            return status;
    }
    else
    {
        out.pixels = TY_TRY_ALLOC(float, 3 * (size_t)width * (size_t)height);
        if (!out.pixels)
            return ty_error_set(error, TY_NO_MEMORY, "no memory for an image of %d x %d", width, height);
        float sx = (float)image->width / (float)width, sy = (float)image->height / (float)height;
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++)
            {
                ty_rgb c = bilinear(image, ((float)x + 0.5f) * sx - 0.5f, ((float)y + 0.5f) * sy - 0.5f);
                float* to = out.pixels + 3 * ((size_t)y * (size_t)width + (size_t)x);
                to[0] = c.r;
                to[1] = c.g;
                to[2] = c.b;
            }
    }
    ty_image_term(image);
    *image = out;
    return TY_OK;
}

// Planes to pixels in linear Rec. 709.
static ty_status image_from_planes(const ty_color* color, const ty_planes* planes, ty_image* out, ty_error* error)
{
    size_t size = (size_t)planes->width * (size_t)planes->height;
    *out = (ty_image){.width = planes->width, .height = planes->height, .channels = 3};
    out->pixels = TY_TRY_ALLOC(float, 3 * size);
    if (!out->pixels)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for an image of %d x %d", planes->width, planes->height);
    for (size_t i = 0; i < 3 * size; i++)
        out->pixels[i] = planes->values[i % 3 * size + i / 3];
    return ty_color_convert(color, "ACEScg", "lin_rec709", out->pixels, planes->width * planes->height, 3, error);
}

// What sRGB shows an amount of light as (IEC 61966-2-1).
static float encoded(float x)
{
    return x <= 0.0031308f ? 12.92f * x : 1.055f * ty_pow(x, 1.0f / 2.4f) - 0.055f;
}

static float tone_of(const ty_filter_recipe* recipe, const float* rgb, int field)
{
    float light = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
    if (recipe->color == TY_FILTER_TINTED)
        light = ty_max(rgb[0], ty_max(rgb[1], rgb[2]));
    if (recipe->color == TY_FILTER_CHANNELS)
        light = rgb[field];
    light = ty_clamp(light, 0.0f, 1.0f);
    // Where a reaction starts from a picture, it is from the values that files hold.
    return recipe->mode != TY_FILTER_TONE || recipe->tone.displayed ? encoded(light) : light;
}

static ty_status planes_fill(const ty_filter_run* run, const ty_image* image, ty_filter_picture* out, ty_error* error)
{
    size_t size = (size_t)run->width * (size_t)run->height;
    for (int c = 0; c < 3; c++)
    {
        out->rgb[c] = TY_TRY_ALLOC(float, size);
        out->tone[c] = c < run->field_count ? TY_TRY_ALLOC(float, size) : NULL;
        if (!out->rgb[c] || (c < run->field_count && !out->tone[c]))
            return ty_error_set(error, TY_NO_MEMORY, "no memory for a picture of %d x %d", run->width, run->height);
    }
    static const float grey[3] = {0.5f, 0.5f, 0.5f};
    for (size_t i = 0; i < size; i++)
    {
        const float* rgb = image ? image->pixels + 3 * i : grey;
        for (int c = 0; c < 3; c++)
            out->rgb[c][i] = ty_max(rgb[c], 0.0f);
        for (int f = 0; f < run->field_count; f++)
            out->tone[f][i] = tone_of(run->recipe, rgb, f);
    }
    return TY_OK;
}

ty_status ty_filter_picture_read(const ty_filter_run* run, int frame, ty_filter_picture* out, ty_error* error)
{
    *out = (ty_filter_picture){.width = run->width, .height = run->height};
    if (!run->recipe->image)
        return planes_fill(run, NULL, out, error);
    ty_planes planes = {0};
    ty_image image = {0};
    ty_status status =
        ty_plane_file_read_color(&run->image, run->recipe->first_frame + frame - 1, run->color, &planes, error);
    if (status == TY_OK)
        status = image_from_planes(run->color, &planes, &image, error);
    ty_planes_term(&planes);
    if (status == TY_OK)
        status = resize(&image, run->width, run->height, error);
    if (status == TY_OK)
        status = planes_fill(run, &image, out, error);
    ty_image_term(&image);
    if (status != TY_OK)
        ty_filter_picture_term(out);
    return status;
}
