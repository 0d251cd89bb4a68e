// SPDX-License-Identifier: Apache-2.0
// Series of filtered pictures: what moves slowly does not flicker, what stands still is read once.
#include "filter_frames.h"
#include <stdio.h>
#include <unistd.h>

enum
{
    SIDE = 96,
    FRAMES = 8
};

// --- flicker ---

static struct
{
    float shift, grain; // cells; of displayed values, standard deviation
    ty_rng rng;
} shot;

// A ramp with a disc and a dark bar, moved to the left.
static float shot_at(int x, int y, int c)
{
    static float noise;
    float at = (float)x + shot.shift, value = 0.25f + 0.4f * at / SIDE;
    float disc = sqrtf(ty_sqr(at - 40.0f) + ty_sqr((float)y - 40.0f)), bar = fabsf(at - 70.0f);
    value = ty_lerp(value, 0.85f, ty_clamp(20.5f - disc, 0.0f, 1.0f));
    value = ty_lerp(value, 0.2f, ty_clamp(6.5f - bar, 0.0f, 1.0f));
    if (c == 0) // grey; the sum of twelve has the variance of 1
    {
        noise = -6.0f;
        for (int i = 0; i < 12; i++)
            noise += ty_rng_float(&shot.rng);
    }
    return ty_clamp(value + shot.grain * noise, 0.0f, 1.0f);
}

typedef struct steadiness
{
    float changed; // share of the cells that are bright where they were dark, or the other way, of a frame
    float blinked; // that change and change back
    float drift;   // of the bright share, the largest from frame to frame
} steadiness;

static steadiness measure(float speed, float grain, const ty_filter_tone* tone)
{
    shot.grain = grain;
    shot.rng = ty_rng_make((ty_seed){3}, 0, 0);
    for (int i = 1; i <= FRAMES; i++)
    {
        char name[24];
        snprintf(name, sizeof name, "shot.%d.png", i);
        shot.shift = speed * (float)i;
        write_image(in_folder(name), SIDE, SIDE, shot_at);
    }
    frames out = {0};
    ty_filter_recipe recipe = small(in_folder("shot.#.png"));
    recipe.time = 1500.0f;
    recipe.tone = *tone;
    make(&recipe, &out);
    assert_int_equal(out.count, FRAMES);
    steadiness s = {0};
    float bright[FRAMES + 1] = {0};
    for (int f = 1; f <= FRAMES; f++)
        for (int i = 0; i < SIDE * SIDE; i++)
        {
            const float size = SIDE * SIDE;
            bool now = out.images[f].pixels[i] > 0.5f;
            bool before = f > 1 ? out.images[f - 1].pixels[i] > 0.5f : now;
            bool first = f > 2 ? out.images[f - 2].pixels[i] > 0.5f : before;
            bright[f] += (float)now / size;
            s.changed += (float)(now != before) / size / (FRAMES - 1);
            s.blinked += (float)(now != before && now == first) / size / (FRAMES - 2);
        }
    for (int f = 2; f <= FRAMES; f++)
        s.drift = ty_max(s.drift, fabsf(bright[f] - bright[f - 1]));
    forget(&out);
    return s;
}

static void what_moves_slowly_does_not_flicker(void** state)
{
    (void)state;
    static const struct
    {
        const char* name;
        float speed, grain;
    } cases[] = {{"still", 0.0f, 0.0f}, {"a quarter of a cell a frame", 0.25f, 0.0f}, {"grain of .02", 0.0f, 0.02f}};
    ty_filter_tone fixed = ty_filter_recipe_default().tone, raw = fixed, smooth = fixed;
    fixed.calibrated = false;
    raw.smoothing = 0.0f;
    for (int i = 0; i < 3; i++)
    {
        steadiness a = measure(cases[i].speed, cases[i].grain, &fixed);
        steadiness b = measure(cases[i].speed, cases[i].grain, &raw);
        steadiness c = measure(cases[i].speed, cases[i].grain, &smooth);
        print_message("%s: one threshold changes %.4f, blinks %.5f, drifts %.4f; by tone %.4f, %.5f, %.4f; smoothed "
                      "%.4f, %.5f, %.4f\n",
                      cases[i].name, (double)a.changed, (double)a.blinked, (double)a.drift, (double)b.changed,
                      (double)b.blinked, (double)b.drift, (double)c.changed, (double)c.blinked, (double)c.drift);
        assert_true(c.drift <= 2.0f * a.drift + 0.003f); // of 80 spots one is .012
        assert_true(c.blinked <= 2.5f * a.blinked + 1e-4f);
        assert_true(c.changed <= 1.5f * a.changed + 1e-3f);
        assert_true(i < 2 || c.blinked < 0.6f * b.blinked); // it is the smoothing that does it
    }
}

// --- what is read ---

static ty_status put_and_remove(void* context, int frame, ty_exr* image, ty_error* error)
{
    (void)remove(in_folder("picture.png"));
    return keep(context, frame, image, error);
}

// A picture that stands still behind masks that move is read for the first frame alone.
static void a_still_picture_is_read_once(void** state)
{
    (void)state;
    write_image(in_folder("mask.1.png"), SIDE, SIDE, half_mask);
    write_image(in_folder("mask.2.png"), SIDE, SIDE, step_picture);
    write_image(in_folder("picture.png"), SIDE, SIDE, even_grey);
    char mask[200];
    strcpy(mask, in_folder("mask.#.png"));
    ty_filter_region region = {mask, false, 1, {5.0f, 0.0f}, 0.06f};
    ty_filter_recipe recipe = small(in_folder("picture.png"));
    recipe.regions = (ty_param_list){&region, 1};
    recipe.time = 100.0f;
    recipe.frames = 2;
    frames whole = {0}, removed = {0};
    ty_error error = {0};
    make(&recipe, &whole);
    const ty_frame_sink sink = {put_and_remove, NULL, &removed};
    assert_int_equal(ty_filter_make(&recipe, NULL, &sink, NULL, &error), TY_OK);
    for (int i = 1; i <= 2; i++)
        assert_equal_images(&whole.images[i], &removed.images[i]);
    assert_true(memcmp(whole.images[1].pixels, whole.images[2].pixels, SIDE * SIDE * sizeof(float)) != 0);
    forget(&whole);
    forget(&removed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_moves_slowly_does_not_flicker),
        cmocka_unit_test(a_still_picture_is_read_once),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
