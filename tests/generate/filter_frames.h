// SPDX-License-Identifier: Apache-2.0
// Frames of filters kept in memory, and small pictures to filter.
#pragma once
#include "base/cmocka_all.h"
#include "base/own_folder.h"
#include <math.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/generate/filter_recipe.h>
#include <tsuya/image/image.h>

enum
{
    MOST = 8
};

typedef struct frames
{
    ty_image images[MOST + 1]; // by frame; channels as in the file, sorted as they were added
    int count;
} frames;

static inline ty_status keep(void* context, int frame, ty_exr* exr, ty_error* error)
{
    frames* f = context;
    assert_in_range(frame, 1, MOST);
    ty_image* image = &f->images[frame];
    *image = (ty_image){.width = ty_exr_width(exr), .height = ty_exr_height(exr), .channels = exr->channel_count};
    size_t size = (size_t)image->width * (size_t)image->height;
    image->pixels = TY_ALLOC(float, size*(size_t)exr->channel_count);
    for (int c = 0; c < exr->channel_count; c++)
        for (size_t i = 0; i < size; i++)
            image->pixels[i * (size_t)exr->channel_count + (size_t)c] = ((const float*)exr->channels[c].pixels)[i];
    f->count++;
    return f->count > MOST ? ty_error_set(error, TY_INTERNAL, "too many frames") : TY_OK;
}

static inline void forget(frames* f)
{
    for (int i = 0; i <= MOST; i++)
        ty_image_term(&f->images[i]);
    *f = (frames){0};
}

static inline ty_status try_make(const ty_filter_recipe* recipe, ty_workers* workers, frames* out, ty_error* error)
{
    const ty_frame_sink sink = {keep, NULL, out};
    return ty_filter_make(recipe, workers, &sink, NULL, error);
}

static inline void make(const ty_filter_recipe* recipe, frames* out)
{
    ty_error error = {0};
    if (try_make(recipe, NULL, out, &error) != TY_OK)
        fail_msg("%s", error.text);
}

static inline void refused(const ty_filter_recipe* recipe, ty_status status, const char* text)
{
    frames out = {0};
    ty_error error = {0};
    assert_int_equal(try_make(recipe, NULL, &out, &error), status);
    if (!strstr(error.text, text))
        fail_msg("'%s' is not in: %s", text, error.text);
    assert_int_equal(out.count, 0);
}

static inline void write_image(const char* path, int width, int height, float (*value)(int x, int y, int c))
{
    ty_image image = {.width = width, .height = height, .channels = 3};
    image.pixels = TY_ALLOC(float, 3 * width * height);
    for (int i = 0; i < 3 * width * height; i++)
        image.pixels[i] = value(i / 3 % width, i / 3 / width, i % 3);
    ty_error error;
    assert_int_equal(ty_image_write(path, &image, 8, &error), TY_OK);
    ty_image_term(&image);
}

static inline ty_filter_recipe photo(void)
{
    ty_filter_recipe recipe = ty_filter_recipe_default();
    recipe.image = SCENES "/filter_seed/photo.jpg";
    return recipe;
}

static inline float even_grey(int x, int y, int c)
{
    (void)c;
    return 0.4f + 0.3f * (float)x / 96.0f + (y > 48 ? 0.1f : 0.0f);
}

static inline float half_mask(int x, int y, int c)
{
    (void)y;
    (void)c;
    return x < 40 ? 0.0f : 1.0f;
}

static inline float step_picture(int x, int y, int c)
{
    (void)y;
    (void)c;
    return x < 48 ? 0.3f : 0.6f;
}

static inline ty_filter_recipe small(const char* image)
{
    ty_filter_recipe recipe = ty_filter_recipe_default();
    static char kept[200]; // in_folder forgets
    if (image)
        recipe.image = strcpy(kept, image);
    recipe.time = 600.0f;
    return recipe;
}

static inline void assert_equal_images(const ty_image* a, const ty_image* b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->channels, b->channels);
    size_t size = (size_t)a->width * (size_t)a->height * (size_t)a->channels;
    assert_memory_equal(a->pixels, b->pixels, size * sizeof(float));
}
