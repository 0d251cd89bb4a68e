// SPDX-License-Identifier: Apache-2.0
// Runs of the Turing filter: moments, sequences, threads, stops, mistakes.
#include "filter_frames.h"

// --- time ---

static void frames_are_moments_of_one_reaction(void** state)
{
    (void)state;
    write_image(in_folder("grey.png"), 96, 96, even_grey);
    frames series = {0}, alone = {0};
    ty_filter_recipe recipe = small(in_folder("grey.png"));
    recipe.time = 100.0f;
    recipe.time_per_frame = 33.0f;
    recipe.frames = 4;
    make(&recipe, &series);
    assert_int_equal(series.count, 4);
    recipe.frames = 1;
    recipe.time = 199.0f;
    make(&recipe, &alone);
    assert_equal_images(&series.images[4], &alone.images[1]);
    assert_true(memcmp(series.images[3].pixels, alone.images[1].pixels, 96 * 96 * sizeof(float)) != 0);
    forget(&series);
    forget(&alone);
}

static void sequences_go_in_and_out(void** state)
{
    (void)state;
    write_image(in_folder("in.0004.png"), 96, 96, even_grey);
    write_image(in_folder("in.0005.png"), 96, 96, step_picture);
    write_image(in_folder("in.0006.png"), 96, 96, even_grey);
    ty_filter_recipe recipe = small(in_folder("in.####.png"));
    recipe.first_frame = 4;
    for (int mode = TY_FILTER_TONE; mode <= TY_FILTER_PLAIN; mode++)
    {
        frames out = {0};
        recipe.mode = mode;
        assert_int_equal(ty_filter_generator.frame_count(&recipe), 3);
        make(&recipe, &out);
        assert_int_equal(out.count, 3);
        // A tone goes on from what there is, a start does not.
        size_t size = 96 * 96 * sizeof(float);
        int same = memcmp(out.images[1].pixels, out.images[3].pixels, size);
        assert_int_equal(same == 0, mode == TY_FILTER_PLAIN);
        assert_true(memcmp(out.images[1].pixels, out.images[2].pixels, size) != 0);
        frames alone = {0};
        ty_filter_recipe second = small(NULL);
        second.image = in_folder("in.0005.png");
        second.mode = mode;
        second.time = mode == TY_FILTER_TONE ? recipe.time + recipe.time_per_frame : recipe.time;
        make(&second, &alone);
        same = memcmp(alone.images[1].pixels, out.images[2].pixels, size);
        assert_int_equal(same == 0, mode == TY_FILTER_PLAIN);
        forget(&alone);
        forget(&out);
    }
    recipe.first_frame = 1;
    refused(&recipe, TY_BAD_INPUT, "lacks 3 of the frames 1..6: 1-3");
    recipe.first_frame = 5;
    recipe.frames = 3;
    refused(&recipe, TY_BAD_INPUT, "image: '");
    write_image(in_folder("in.0005.png"), 96, 80, step_picture);
    recipe.first_frame = 4;
    refused(&recipe, TY_BAD_INPUT, "96 x 80");
}

static void workers_change_no_bit(void** state)
{
    (void)state;
    ty_filter_recipe recipe = photo();
    ty_filter_region region = {SCENES "/filter_seed/hare.png", false, 1, {5.0f, 0.0f}, 0.06f};
    recipe.regions = (ty_param_list){&region, 1};
    recipe.time = 150.0f;
    recipe.color = TY_FILTER_CHANNELS;
    recipe.along.strength = 0.5f;
    recipe.contours.threshold = 0.1f;
    recipe.scale = 2;
    frames reference = {0};
    make(&recipe, &reference);
    for (int n = 1; n <= 3; n++)
    {
        frames out = {0};
        ty_error error = {0};
        ty_workers* workers;
        assert_int_equal(ty_workers_create(n, &workers, &error), TY_OK);
        assert_int_equal(try_make(&recipe, workers, &out, &error), TY_OK);
        assert_equal_images(&reference.images[1], &out.images[1]);
        ty_workers_destroy(workers);
        forget(&out);
    }
    forget(&reference);
}

// --- stop and resume ---

typedef struct stopping
{
    frames frames;
    int stop_after; // frames; 0 = not at all
    bool kept;
} stopping;

static ty_status put_and_stop(void* context, int frame, ty_exr* image, ty_error* error)
{
    stopping* s = context;
    ty_status status = keep(&s->frames, frame, image, error);
    if (s->frames.count == s->stop_after)
        ty_cancel_request(0);
    return status;
}

static ty_status keep_state(void* context, ty_exr* state, ty_error* error)
{
    stopping* s = context;
    assert_false(s->kept);
    s->kept = true;
    return ty_exr_write(in_folder("state.exr"), state, error);
}

static ty_status make_from(const ty_filter_recipe* recipe, stopping* s, const char* from, ty_error* error)
{
    const ty_frame_sink sink = {put_and_stop, keep_state, s};
    ty_bytes state = {0};
    if (from)
        assert_int_equal(ty_file_read(from, 1 << 24, &state, error), TY_OK);
    ty_status status = ty_filter_make(recipe, NULL, &sink, from ? &state : NULL, error);
    ty_bytes_term(&state);
    ty_cancel_clear();
    return status;
}

static void a_stop_changes_no_bit(void** state)
{
    (void)state;
    ty_error error = {0};
    write_image(in_folder("grey.png"), 96, 96, even_grey);
    ty_filter_recipe recipe = small(in_folder("grey.png"));
    recipe.time = 100.0f;
    recipe.frames = 4;
    recipe.color = TY_FILTER_CHANNELS;
    frames whole = {0};
    make(&recipe, &whole);
    stopping first = {.stop_after = 2}, rest = {0}, further = {0};
    assert_int_equal(make_from(&recipe, &first, NULL, &error), TY_INTERRUPTED);
    assert_true(first.kept);
    assert_int_equal(first.frames.count, 2);
    assert_int_equal(make_from(&recipe, &rest, in_folder("state.exr"), &error), TY_OK);
    assert_int_equal(rest.frames.count, 2);
    for (int i = 1; i <= 4; i++)
        assert_equal_images(&whole.images[i], i <= 2 ? &first.frames.images[i] : &rest.frames.images[i]);
    // In the middle of a frame: from an earlier end, and before the first step.
    ty_filter_recipe early = recipe;
    early.time = 50.0f;
    early.frames = 1;
    forget(&first.frames);
    first = (stopping){0};
    assert_int_equal(make_from(&early, &first, NULL, &error), TY_OK);
    forget(&rest.frames);
    rest = (stopping){0};
    assert_int_equal(make_from(&recipe, &rest, in_folder("state.exr"), &error), TY_OK);
    assert_int_equal(rest.frames.count, 4);
    assert_equal_images(&whole.images[1], &rest.frames.images[1]);
    ty_cancel_request(0);
    forget(&first.frames);
    first = (stopping){0};
    assert_int_equal(make_from(&recipe, &first, NULL, &error), TY_INTERRUPTED);
    forget(&rest.frames);
    rest = (stopping){0};
    assert_int_equal(make_from(&recipe, &rest, in_folder("state.exr"), &error), TY_OK);
    assert_equal_images(&whole.images[4], &rest.frames.images[4]);
    // From its end to a later one.
    recipe.frames = 6;
    forget(&whole);
    make(&recipe, &whole);
    assert_int_equal(make_from(&recipe, &further, in_folder("state.exr"), &error), TY_OK);
    for (int i = 4; i <= 6; i++)
        assert_equal_images(&whole.images[i], &further.frames.images[i]);
    forget(&whole);
    forget(&first.frames);
    forget(&rest.frames);
    forget(&further.frames);
}

static void a_state_of_something_else_is_refused(void** state)
{
    (void)state;
    ty_error error = {0};
    stopping s = {0};
    write_image(in_folder("grey.png"), 96, 96, even_grey);
    ty_filter_recipe recipe = small(in_folder("grey.png"));
    recipe.time = 20.0f;
    recipe.frames = 2;
    assert_int_equal(make_from(&recipe, &s, NULL, &error), TY_OK);
    forget(&s.frames);
    static const char* const texts[] = {"not one of a filter", "cells: [50, 96]; the state to go on from has 96 x 96",
                                        "1 fields for 3", "frames: 1; the state is in frame 2",
                                        "frame 2 ends at step 111 and the state is at step 133"};
    for (int i = 0; i < 5; i++)
    {
        ty_filter_recipe other = recipe;
        s.kept = false;
        other.cells[0] = i == 1 ? 50 : 0;
        other.cells[1] = i == 1 ? 96 : 0;
        other.color = i == 2 ? TY_FILTER_CHANNELS : TY_FILTER_GREY;
        other.frames = i == 3 ? 1 : 2;
        other.time = i == 4 ? 10.0f : 20.0f;
        if (i == 0)
        {
            const int window[4] = {0, 0, 95, 95};
            ty_exr* exr = ty_exr_create(window, window);
            ty_exr_add_channel(exr, "u0", TY_EXR_FLOAT);
            assert_int_equal(ty_exr_write(in_folder("other.exr"), exr, &error), TY_OK);
            ty_exr_destroy(exr);
        }
        ty_status status = make_from(&other, &s, in_folder(i ? "state.exr" : "other.exr"), &error);
        assert_int_equal(status, i ? TY_BAD_INPUT : TY_BAD_FILE);
        if (!strstr(error.text, texts[i]))
            fail_msg("'%s' is not in: %s", texts[i], error.text);
        assert_false(s.kept);
        assert_int_equal(s.frames.count, 0);
    }
}

// --- mistakes ---

static void mistakes_are_named(void** state)
{
    (void)state;
    write_image(in_folder("grey.png"), 96, 96, even_grey);
    ty_filter_recipe recipe = small(in_folder("grey.png"));
    recipe.time_step = 0.6f;
    refused(&recipe, TY_BAD_INPUT, "time_step: 0.6; with these diffusions it lies above 0 and up to 0.4926");
    recipe = small(in_folder("nothing.png"));
    refused(&recipe, TY_BAD_FILE, "cannot open");
    recipe = small(in_folder("grey.png"));
    ty_filter_region region = {SCENES "/filter_seed/disc.png", false, 1, {5.0f, 0.0f}, 0.06f};
    recipe.regions = (ty_param_list){&region, 1};
    refused(&recipe, TY_BAD_INPUT, "200 x 200 pixels; the field has 96 x 96 cells");
    refused(&recipe, TY_BAD_INPUT, "regions[0].mask: ");
    recipe = small(NULL);
    refused(&recipe, TY_BAD_INPUT, "cells: without an image");
    recipe.cells[0] = 50;
    refused(&recipe, TY_BAD_INPUT, "cells: [50, 0]");
    recipe.cells[1] = 3;
    refused(&recipe, TY_BAD_INPUT, "cells: 50 x 3");
    recipe.cells[1] = 16000;
    recipe.scale = 8;
    refused(&recipe, TY_BAD_INPUT, "scale: 8; 16000 cells become more than 32768 pixels");
}

static void memory_that_is_refused_is_said(void** state)
{
    (void)state;
    write_image(in_folder("grey.png"), 96, 96, even_grey);
    write_image(in_folder("mask.png"), 96, 96, half_mask);
    ty_filter_recipe recipe = small(in_folder("grey.png"));
    ty_filter_region region = {in_folder("mask.png"), false, 0, {5.0f, 0.0f}, 0.06f};
    recipe.regions = (ty_param_list){&region, 1};
    recipe.time = 1.0f;
    recipe.along.strength = 0.5f;
    recipe.contours.threshold = 0.1f;
    int refusals = 0;
    for (int i = 0; i < 200; i++)
    {
        frames out = {0};
        ty_error error = {0};
        ty_memory_fail_after(i);
        ty_status status = try_make(&recipe, NULL, &out, &error);
        ty_memory_fail_after(-1);
        forget(&out);
        if (status == TY_OK)
            break;
        assert_int_equal(status, TY_NO_MEMORY);
        refusals++;
    }
    assert_in_range(refusals, 20, 199);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_moments_of_one_reaction),
        cmocka_unit_test(sequences_go_in_and_out),
        cmocka_unit_test(workers_change_no_bit),
        cmocka_unit_test(a_stop_changes_no_bit),
        cmocka_unit_test(a_state_of_something_else_is_refused),
        cmocka_unit_test(mistakes_are_named),
        cmocka_unit_test(memory_that_is_refused_is_said),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
