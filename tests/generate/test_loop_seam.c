// SPDX-License-Identifier: Apache-2.0
// A loop has no seam: the frame after the last is the first to the bit, the step back to it is one like all others, and
// where the recipe asks for it the least of all.
#include "base/own_folder.h"
#include "loop_frames.h"
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>

enum
{
    SETUPS = 200,
    CLOSINGS = 10000,
    FRAMES = 48,
    SIDE = 40, // voxels, and pixels
    TINY = 10,
    VOLUMES = 24 // with and without wraps; one in this many has colours
};

// --- closing ---

static void labels_draw(ty_rng* rng, ty_loop_volume* volume)
{
    volume->labels = TY_ALLOC(uint8_t, volume->count);
    volume->palette = (ty_loop_palette){.colors = {{200, 30, 40}, {20, 120, 220}}, .count = 2, .clear = true};
    for (size_t i = 0; i < volume->count; i++)
        volume->labels[i] = ty_rng_float(rng) < 0.5f;
}

// Anything a recipe may say of how a loop looks and moves.
static ty_loop_recipe setup_draw(ty_rng* rng, int i, ty_loop_key keys[3])
{
    ty_loop_recipe recipe = ty_loop_recipe_default();
    recipe.frames = 1 + (int)(ty_rng_float(rng) * 200.0f);
    recipe.size[0] = recipe.size[1] = TINY;
    recipe.plane = (ty_loop_plane){loop_any(rng, 0.5f), loop_any(rng, 3.0f), {1.2f, 0.9f}};
    recipe.axis = (ty_loop_axis){loop_any(rng, 0.5f), loop_any(rng, 1.0f)};
    recipe.motion.kind = i % 3;
    recipe.motion.easing = ty_rng_float(rng);
    recipe.motion.turns = (int)floorf(ty_rng_range(rng, -16.0f, 16.99f));
    recipe.motion.radius = ty_rng_range(rng, 0.0f, 2.0f);
    recipe.sampling = i % 5 == 0 ? TY_LOOP_NEAREST : TY_LOOP_TRILINEAR;
    recipe.show_values = i % 7 == 0;
    recipe.blur = i % 4 == 0 ? ty_rng_float(rng) : 0.0f;
    recipe.blur_samples = 3;
    recipe.high = (ty_rgb){0.9f, 0.4f, 0.1f};
    loop_keys_draw(rng, keys);
    if (i % 2)
        recipe.motion.keys = (ty_param_list){keys, 1 + i / 2 % 3};
    return recipe;
}

static bool same_frames(const ty_loop_recipe* recipe, const ty_loop_volume* volume, int a, int b)
{
    ty_loop_painter* painter;
    ty_exr* images[2];
    assert_int_equal(ty_loop_painter_create(recipe, volume, NULL, &painter, NULL), TY_OK);
    assert_int_equal(ty_loop_painter_paint(painter, a, &images[0], NULL), TY_OK);
    assert_int_equal(ty_loop_painter_paint(painter, b, &images[1], NULL), TY_OK);
    bool same = true;
    size_t bytes = (size_t)recipe->size[0] * (size_t)recipe->size[1] * sizeof(float);
    for (int c = 0; c < images[0]->channel_count; c++)
        same &= memcmp(images[0]->channels[c].pixels, images[1]->channels[c].pixels, bytes) == 0;
    ty_exr_destroy(images[0]);
    ty_exr_destroy(images[1]);
    ty_loop_painter_destroy(painter);
    return same;
}

static void frame_n_is_frame_0(void** state)
{
    (void)state;
    int closed = 0, moved = 0;
    ty_loop_volume volumes[2 * VOLUMES];
    for (int i = 0; i < 2 * VOLUMES; i++)
    {
        ty_rng rng = ty_rng_make((ty_seed){4}, (uint64_t)i, 0);
        volumes[i] = loop_waves(TINY, 5.0f, i < VOLUMES, (uint64_t)i);
        if (i % VOLUMES == 0)
            labels_draw(&rng, &volumes[i]);
    }
    for (int i = 0; i < CLOSINGS; i++)
    {
        ty_rng rng = ty_rng_make((ty_seed){6}, (uint64_t)i, 0);
        ty_loop_key keys[3];
        ty_loop_recipe recipe = setup_draw(&rng, i, keys);
        const ty_loop_volume* volume = &volumes[(recipe.motion.kind == TY_LOOP_ORBIT ? 0 : VOLUMES) + i / 3 % VOLUMES];
        int k = (int)(ty_rng_float(&rng) * (float)recipe.frames), n = recipe.frames;
        closed += same_frames(&recipe, volume, k, k + n * (1 + i % 3));
        moved += i % 101 == 0 && n > 3 && !same_frames(&recipe, volume, k, k + n / 3);
    }
    for (int i = 0; i < 2 * VOLUMES; i++)
        ty_loop_volume_term(&volumes[i]);
    print_message("frame N is frame 0 in %d of %d set-ups; frames a third of the loop apart differ in %d of %d\n",
                  closed, CLOSINGS, moved, CLOSINGS / 100);
    assert_int_equal(closed, CLOSINGS);
    assert_true(moved > CLOSINGS / 100 * 2 / 3);
}

// --- the seam ---

// Set-up i: even ones turn, odd ones have keys as well. The volume's file is `waves.raw`.
static ty_loop_recipe loop_draw(int i, bool eased, ty_loop_part* part, ty_loop_key keys[3])
{
    ty_rng rng = ty_rng_make((ty_seed){5}, (uint64_t)i, 0);
    ty_loop_recipe recipe = ty_loop_recipe_default();
    recipe.frames = FRAMES;
    recipe.size[0] = recipe.size[1] = SIDE;
    recipe.plane = (ty_loop_plane){loop_any(&rng, 0.3f), loop_any(&rng, 3.0f), {1.2f, 1.2f}};
    recipe.axis = (ty_loop_axis){loop_any(&rng, 0.3f), loop_any(&rng, 1.0f)};
    recipe.motion.easing = eased ? ty_rng_float(&rng) : 0.0f;
    if (i % 2)
    {
        loop_keys_draw(&rng, keys);
        recipe.motion.keys = (ty_param_list){keys, 3};
    }
    *part =
        (ty_loop_part){.source = TY_LOOP_RAW, .raw = {in_folder("waves.raw"), SIDE, SIDE, SIDE, TY_LOOP_U16, 0, false}};
    recipe.volume = (ty_param_list){part, 1};
    return recipe;
}

static void waves_write(const ty_loop_volume* volume)
{
    static uint16_t numbers[SIDE * SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE * SIDE; i++)
        numbers[i] = volume->values[ty_loop_voxel(volume, i % SIDE, i / SIDE % SIDE, i / (SIDE * SIDE))];
    assert_int_equal(ty_file_write(in_folder("waves.raw"), numbers, sizeof numbers, NULL), TY_OK);
}

typedef struct film
{
    uint8_t inside[FRAMES][SIDE * SIDE]; // of the channel Y, white inside
    int count;
} film;

static ty_status film_take(void* context, int frame, ty_exr* image, ty_error* error)
{
    film* f = context;
    const float* y = ty_exr_find_channel(image, "Y")->pixels;
    (void)error;
    assert_int_equal(frame, ++f->count);
    for (int p = 0; p < SIDE * SIDE; p++)
        f->inside[frame - 1][p] = y[p] >= 0.5f;
    return TY_OK;
}

// Change at the seam against the largest of all other steps. rank: how many of them are smaller.
static double seam(const film* f, int* rank)
{
    double most = 0.0, at_seam = loop_changed(f->inside[FRAMES - 1], f->inside[0], SIDE * SIDE);
    *rank = 0;
    for (int i = 0; i + 1 < FRAMES; i++)
    {
        double changed = loop_changed(f->inside[i], f->inside[i + 1], SIDE * SIDE);
        most = changed > most ? changed : most;
        *rank += changed < at_seam;
    }
    return at_seam / most;
}

static double seam_made(ty_loop_recipe* recipe, bool quiet, film* f, int* rank)
{
    const ty_frame_sink sink = {.put = film_take, .context = f};
    f->count = 0;
    recipe->quiet_start = quiet;
    assert_int_equal(ty_loop_make(recipe, NULL, &sink, NULL, NULL), TY_OK);
    assert_int_equal(f->count, FRAMES);
    return seam(f, rank);
}

// The same with an axis that has drifted when the loop is over, which no recipe can say.
static double seam_drifted(const ty_loop_recipe* recipe, const ty_loop_volume* volume, float drift, film* f)
{
    int rank;
    for (int i = 0; i < FRAMES; i++)
    {
        ty_loop_recipe moved = *recipe;
        moved.axis.point.z += drift * (float)i / FRAMES;
        moved.axis.point.x += drift * (float)i / FRAMES;
        moved.plane.center.z += drift * (float)i / FRAMES;
        uint8_t* now = loop_inside(&moved, volume, i);
        memcpy(f->inside[i], now, sizeof f->inside[i]);
        ty_free(now);
    }
    return seam(f, &rank);
}

// Where the frames of `quiet` stand among those of `given`; -1 = they are no rotation of it.
static int rotation_of(const film* given, const film* quiet)
{
    for (int first = 0; first < FRAMES; first++)
    {
        bool same = true;
        for (int i = 0; i < FRAMES && same; i++)
            same = memcmp(given->inside[(first + i) % FRAMES], quiet->inside[i], SIDE * SIDE) == 0;
        if (same)
            return first;
    }
    return -1;
}

static void seams_are_steps_like_others(void** state)
{
    static film given, quiet; // too large for the stack
    int above = 0, quiet_above = 0, drifted = 0, moved = 0, rank;
    double worst = 0.0, quiet_worst = 0.0;
    (void)state;
    for (int i = 0; i < SETUPS; i++)
    {
        ty_loop_key keys[3];
        ty_loop_part part;
        ty_loop_volume volume = loop_waves(SIDE, 14.0f, false, (uint64_t)i);
        ty_loop_recipe recipe = loop_draw(i, true, &part, keys);
        waves_write(&volume);
        double ratio = seam_made(&recipe, false, &given, &rank);
        worst = ratio > worst ? ratio : worst;
        above += ratio > 1.0;
        drifted += i % 8 == 0 && seam_drifted(&recipe, &volume, 0.6f, &quiet) > 1.1;
        ratio = seam_made(&recipe, true, &quiet, &rank);
        quiet_worst = ratio > quiet_worst ? ratio : quiet_worst;
        quiet_above += ratio > 1.0;
        assert_int_equal(rank, 0);
        int first = rotation_of(&given, &quiet);
        assert_true(first >= 0);
        moved += first > 0;
        ty_loop_volume_term(&volume);
    }
    print_message(
        "seam against largest other step: as given at most %.3f, above 1 in %d of %d; with a quiet start %.3f, "
        "%d (%d moved); with a drift above 1.1 in %d of %d\n",
        worst, above, SETUPS, quiet_worst, quiet_above, moved, drifted, SETUPS / 8);
    assert_true(worst <= 1.1 && above <= SETUPS / 40);
    assert_int_equal(quiet_above, 0);
    assert_true(moved > SETUPS / 2);
    assert_true(drifted >= SETUPS / 8 * 4 / 5);
}

// At uniform speed the seam has no rank of its own: it is the k-th of 48 steps as often as any other is.
static void seams_have_every_rank(void** state)
{
    static film given;
    double sum = 0.0;
    int largest = 0;
    (void)state;
    for (int i = 0; i < SETUPS; i++)
    {
        ty_loop_key keys[3];
        ty_loop_part part;
        int rank;
        ty_loop_volume volume = loop_waves(SIDE, 14.0f, false, (uint64_t)(SETUPS + i));
        ty_loop_recipe recipe = loop_draw(2 * i, false, &part, keys);
        recipe.plane.size[0] = recipe.plane.size[1] = 0.8f; // inside all the way: beyond nothing changes
        recipe.plane.center = ty_mul(recipe.plane.center, 0.4f);
        recipe.axis.point = ty_mul(recipe.axis.point, 0.4f);
        waves_write(&volume);
        largest += seam_made(&recipe, false, &given, &rank) > 1.0;
        sum += (double)rank / (FRAMES - 1);
        ty_loop_volume_term(&volume);
    }
    // The mean of so many even ranks is .5 within .02; the largest is as rare as one step of 48 is.
    print_message("rank of the seam, 0..1: %.3f in the mean; the largest in %d of %d, by chance %.1f\n", sum / SETUPS,
                  largest, SETUPS, (double)SETUPS / FRAMES);
    assert_true(fabs(sum / SETUPS - 0.5) < 0.06);
    assert_true(largest <= 12);
}

int main(void)
{
    ty_log_set_level(TY_LOG_ERROR);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frame_n_is_frame_0),
        cmocka_unit_test(seams_are_steps_like_others),
        cmocka_unit_test(seams_have_every_rank),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
