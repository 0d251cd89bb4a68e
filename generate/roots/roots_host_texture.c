// SPDX-License-Identifier: Apache-2.0
// One channel of a picture in memory, for masks of a host: bilinear, repeated, v upwards, as textures of materials are.
#include "roots_host.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/image/image.h>

// Which number of a pixel a letter means; -1: none that the picture has. Of grey all colours are the same.
static int number_of(char letter, int channels)
{
    if (letter == 'a')
        return channels == 2 || channels == 4 ? channels - 1 : -1;
    return channels < 3 ? 0 : letter == 'r' ? 0 : letter == 'g' ? 1 : 2;
}

static float luminance_of(const float* pixel, int channels)
{
    return channels < 3 ? pixel[0] : 0.2126f * pixel[0] + 0.7152f * pixel[1] + 0.0722f * pixel[2];
}

static ty_status channel_take(const char* key, const ty_roots_mask_def* def, const ty_image* image, host_texture* out,
                              ty_error* error)
{
    size_t count = (size_t)image->width * (size_t)image->height, step = (size_t)image->channels;
    bool letter = def->channel[0] && !def->channel[1] && strchr("rgba", def->channel[0]);
    bool luminance = strcmp(def->channel, "luminance") == 0;
    int number = letter ? number_of(def->channel[0], image->channels) : 0;
    if (number < 0)
        return ty_error_set(error, TY_BAD_INPUT, "%s.channel: a; '%.300s' has no alpha, its channels are %s", key,
                            def->texture, image->channels < 3 ? "r and luminance" : "r, g, b and luminance");
    *out = (host_texture){image->width, image->height, TY_TRY_ALLOC(float, count)};
    if (!out->values)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for a texture of %d x %d", image->width, image->height);
    for (size_t i = 0; i < count; i++)
        out->values[i] = luminance ? luminance_of(image->pixels + i * step, image->channels)
                                   : image->pixels[i * step + (size_t)number];
    return TY_OK;
}

ty_status host_texture_read(const char* key, const ty_roots_mask_def* def, host_texture* out, ty_error* error)
{
    static const char* const of_pictures[] = {"r", "g", "b", "a", "luminance"};
    ty_image image;
    ty_error inner = {0};
    bool further = true;
    for (int i = 0; i < 5; i++)
        further = further && strcmp(def->channel, of_pictures[i]) != 0;
    ty_status status = ty_image_read_channel(def->texture, further ? def->channel : NULL, &image, &inner);
    if (status == TY_BAD_INPUT)
        return ty_error_set(error, status, "%s.channel: %s: %.500s; or r, g, b, a, luminance", key, inner.file,
                            inner.text);
    if (status != TY_OK)
    {
        char text[900];
        ty_error_format(&inner, text, sizeof text);
        return ty_error_set(error, status, "%s.texture: %s", key, text);
    }
    status = channel_take(key, def, &image, out, error);
    ty_image_term(&image);
    return status;
}

void host_texture_term(host_texture* texture)
{
    ty_free(texture->values);
    *texture = (host_texture){0};
}

// The two texels on either side of a place, 0..1 of the picture and around, and the weight of the second.
static float taps(float u, int count, int index[2])
{
    float within = fabsf(u) < 1e9f ? u - floorf(u) : 0.0f, place = within * (float)count - 0.5f, base = floorf(place);
    index[0] = ((int)base + count) % count;
    index[1] = (index[0] + 1) % count;
    return place - base;
}

float host_texture_at(const host_texture* t, ty_vec2 uv)
{
    int x[2], y[2];
    float a = taps(uv.x, t->width, x), b = taps(1.0f - uv.y, t->height, y);
    const float *top = t->values + (size_t)y[0] * (size_t)t->width, *low = t->values + (size_t)y[1] * (size_t)t->width;
    return ty_lerp(ty_lerp(top[x[0]], top[x[1]], a), ty_lerp(low[x[0]], low[x[1]], a), b);
}
