// SPDX-License-Identifier: Apache-2.0
// Frames of a living pattern: they close, they tile, they follow the circle, and no thread changes a bit.
#include "base/cmocka_all.h"
#include <string.h>
#include <tsuya/base/hash.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/generate/fill_recipe.h>

enum
{
    MOST = 32
};

typedef struct frames
{
    float* pixels[MOST + 1]; // by frame, the first channel
    int width, height, channels, count;
    int refuse; // the frame that cannot be written
} frames;

static ty_status keep(void* context, int frame, ty_exr* image, ty_error* error)
{
    frames* f = context;
    if (frame == f->refuse)
        return ty_error_set(error, TY_BAD_FILE, "the disk is full");
    assert_in_range(frame, 1, MOST);
    assert_null(f->pixels[frame]);
    f->width = ty_exr_width(image);
    f->height = ty_exr_height(image);
    f->channels = image->channel_count;
    size_t size = (size_t)f->width * (size_t)f->height;
    f->pixels[frame] = TY_ALLOC(float, size);
    memcpy(f->pixels[frame], image->channels[0].pixels, size * sizeof(float));
    f->count++;
    return TY_OK;
}

static void forget(frames* f)
{
    for (int i = 0; i <= MOST; i++)
        ty_free(f->pixels[i]);
    *f = (frames){0};
}

static void make(const ty_fill_recipe* recipe, ty_workers* workers, frames* out)
{
    ty_error error = {0};
    const ty_frame_sink sink = {keep, NULL, out};
    ty_status status = ty_fill_make(recipe, workers, &sink, &error);
    if (status != TY_OK)
        print_message("%s\n", error.text);
    assert_int_equal(status, TY_OK);
    assert_int_equal(out->count, recipe->loop.frames);
}

static ty_fill_recipe small(void)
{
    ty_fill_recipe recipe = ty_fill_recipe_default();
    recipe.cells[0] = 80;
    recipe.cells[1] = 56;
    recipe.scale = 1;
    recipe.drops.count = 5;
    recipe.steps = 2000;
    recipe.loop = (ty_pattern_loop){12, 900, 3.0f};
    return recipe;
}

static double difference(const frames* f, int a, int b)
{
    double sum = 0.0;
    for (int i = 0; i < f->width * f->height; i++)
        sum += fabs((double)(f->pixels[a][i] - f->pixels[b][i]));
    return sum / (f->width * f->height);
}

static void the_seam_is_a_step_like_others(void** state)
{
    (void)state;
    ty_fill_recipe recipe = small();
    frames f = {0};
    make(&recipe, NULL, &f);
    double most = 0.0, least = 1.0;
    for (int i = 1; i < 12; i++)
    {
        double step = difference(&f, i, i + 1);
        most = step > most ? step : most;
        least = step < least ? step : least;
    }
    double seam = difference(&f, 12, 1);
    assert_true(least > 1e-3); // it moves
    assert_true(seam <= 1.05 * most && seam > 0.5 * least);
    assert_true(difference(&f, 1, 7) > seam); // and goes somewhere
    forget(&f);
}

static void the_circle_is_followed(void** state)
{
    (void)state;
    ty_fill_recipe recipe = small();
    frames f = {0};
    recipe.loop.drift = 0.0f; // time alone: up and down through the same states, to the bit
    make(&recipe, NULL, &f);
    for (int i = 0; i <= 6; i++)
        assert_memory_equal(f.pixels[1 + i], f.pixels[1 + (18 - i) % 12], 80 * 56 * sizeof(float));
    forget(&f);
    recipe.loop = (ty_pattern_loop){4, 0, 3.0f}; // sideways alone: over the seam too
    make(&recipe, NULL, &f);
    for (int y = 0; y < 56; y++)
        for (int x = 0; x < 80; x++)
        {
            assert_true(f.pixels[1][y * 80 + x] == f.pixels[3][y * 80 + (x + 6) % 80]);
            assert_float_equal(f.pixels[2][y * 80 + x], f.pixels[1][y * 80 + (x + 77) % 80], 1e-4f);
        }
    forget(&f);
}

// The first frame of a loop that stands still is the state at `steps`, whatever the others see.
static void frames_show_their_step(void** state)
{
    (void)state;
    ty_fill_recipe recipe = small();
    recipe.loop = (ty_pattern_loop){4, 700, 0.0f};
    frames loop = {0}, one = {0};
    make(&recipe, NULL, &loop);
    recipe.steps = 2700;
    recipe.loop = (ty_pattern_loop){1, 0, 0.0f};
    make(&recipe, NULL, &one);
    assert_memory_equal(loop.pixels[2], one.pixels[1], 80 * 56 * sizeof(float));
    forget(&loop);
    forget(&one);
}

static void pixels_are_finer_than_cells(void** state)
{
    (void)state;
    ty_fill_recipe recipe = small();
    recipe.loop = (ty_pattern_loop){1, 0, 0.0f};
    frames coarse = {0}, fine = {0};
    make(&recipe, NULL, &coarse);
    recipe.scale = 3;
    make(&recipe, NULL, &fine);
    assert_int_equal(fine.width, 240);
    assert_int_equal(fine.height, 168);
    for (int y = 0; y < 56; y++)
        for (int x = 0; x < 80; x++) // the pixel in the middle of a cell is the cell
            assert_float_equal(fine.pixels[1][(3 * y + 1) * 240 + 3 * x + 1], coarse.pixels[1][y * 80 + x], 1e-5f);
    assert_int_equal(fine.channels, 1);
    forget(&coarse);
    forget(&fine);
    recipe.low = ty_rgb_make(0.2f, 0.3f, 0.4f);
    recipe.high = ty_rgb_make(0.6f, 0.5f, 0.4f);
    recipe.scale = 1;
    make(&recipe, NULL, &fine);
    assert_int_equal(fine.channels, 3);
    for (int i = 0; i < 80 * 56; i++) // between the two colours
        assert_true(fine.pixels[1][i] >= 0.2f && fine.pixels[1][i] <= 0.6f);
    forget(&fine);
}

static void area_and_edges_are_kept(void** state)
{
    (void)state;
    ty_fill_recipe recipe = small();
    recipe.tile = TY_PATTERN_TILE_AROUND;
    recipe.drops.area[1] = 0.05f; // at the bottom, which is the last row
    recipe.drops.radius = 5.0f;
    recipe.steps = 600;
    recipe.loop = (ty_pattern_loop){1, 0, 0.0f};
    frames f = {0};
    make(&recipe, NULL, &f);
    float top = 0.0f, bottom = 0.0f;
    for (int x = 0; x < 80; x++)
    {
        top += f.pixels[1][x];
        bottom += f.pixels[1][53 * 80 + x];
    }
    assert_true(top == 0.0f && bottom > 1.0f);
    forget(&f);
}

static void workers_change_no_bit(void** state)
{
    (void)state;
    ty_fill_recipe recipe = small();
    recipe.cells[0] = 600;
    recipe.cells[1] = 120;
    recipe.variation = 0.1f;
    recipe.steps = 300;
    recipe.loop = (ty_pattern_loop){3, 100, 2.5f};
    ty_hash first = {0};
    for (int threads = 1; threads <= 3; threads++)
    {
        ty_workers* workers;
        ty_error error;
        frames f = {0};
        assert_int_equal(ty_workers_create(threads, &workers, &error), TY_OK);
        make(&recipe, workers, &f);
        ty_hasher* hasher = ty_hasher_create();
        for (int i = 1; i <= 3; i++)
            ty_hasher_add(hasher, f.pixels[i], 600 * 120 * sizeof(float));
        ty_hash hash = ty_hasher_end(hasher);
        first = threads == 1 ? hash : first;
        assert_memory_equal(&hash, &first, sizeof hash);
        forget(&f);
        ty_workers_destroy(workers);
    }
    frames f = {0}, other = {0};
    recipe.variation = 0.0f; // which was no ornament
    make(&recipe, NULL, &f);
    recipe.seed.value++;
    make(&recipe, NULL, &other);
    assert_memory_not_equal(f.pixels[1], other.pixels[1], 600 * 120 * sizeof(float));
    forget(&f);
    forget(&other);
}

static void impossible_ones_are_refused(void** state)
{
    (void)state;
    ty_error error;
    frames f = {0};
    const ty_frame_sink sink = {keep, NULL, &f};
    ty_fill_recipe recipe = small();
    recipe.loop.span = 2001;
    assert_int_equal(ty_fill_make(&recipe, NULL, &sink, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "loop.span: 2001"));
    recipe = small();
    recipe.tone[1] = recipe.tone[0];
    assert_int_equal(ty_fill_make(&recipe, NULL, &sink, &error), TY_BAD_INPUT);
    recipe = small();
    recipe.time_step = 1.2f;
    assert_int_equal(ty_fill_make(&recipe, NULL, &sink, &error), TY_BAD_INPUT);
    recipe = small();
    recipe.loop.frames = 0;
    assert_int_equal(ty_fill_make(&recipe, NULL, &sink, &error), TY_BAD_INPUT);
    recipe = small();
    recipe.cells[1] = 8192;
    recipe.scale = 5;
    assert_int_equal(ty_fill_make(&recipe, NULL, &sink, &error), TY_BAD_INPUT);
    recipe = small();
    f.refuse = 5;
    assert_int_equal(ty_fill_make(&recipe, NULL, &sink, &error), TY_BAD_FILE);
    assert_string_equal(error.text, "the disk is full");
    forget(&f);
    ty_cancel_request(0);
    ty_status status = ty_fill_make(&recipe, NULL, &sink, &error);
    ty_cancel_clear();
    assert_int_equal(status, TY_INTERRUPTED);
    for (long i = 0; i < 14; i++) // the field, its planes, the plan, the frame
    {
        ty_memory_fail_after(i);
        assert_int_equal(ty_fill_make(&recipe, NULL, &sink, &error), TY_NO_MEMORY);
    }
    ty_memory_fail_after(-1);
    forget(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_seam_is_a_step_like_others), cmocka_unit_test(the_circle_is_followed),
        cmocka_unit_test(frames_show_their_step),         cmocka_unit_test(pixels_are_finer_than_cells),
        cmocka_unit_test(area_and_edges_are_kept),        cmocka_unit_test(workers_change_no_bit),
        cmocka_unit_test(impossible_ones_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
