// SPDX-License-Identifier: Apache-2.0
// The Turing filter: pictures stay, masks hold, colours keep their means, sequences follow, mistakes are named.
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

static ty_status keep(void* context, int frame, ty_exr* exr, ty_error* error)
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

static void forget(frames* f)
{
    for (int i = 0; i <= MOST; i++)
        ty_image_term(&f->images[i]);
    *f = (frames){0};
}

static ty_status try_make(const ty_filter_recipe* recipe, ty_workers* workers, frames* out, ty_error* error)
{
    const ty_frame_sink sink = {keep, NULL, out};
    return ty_filter_make(recipe, workers, &sink, NULL, error);
}

static void make(const ty_filter_recipe* recipe, frames* out)
{
    ty_error error = {0};
    if (try_make(recipe, NULL, out, &error) != TY_OK)
        fail_msg("%s", error.text);
}

static void refused(const ty_filter_recipe* recipe, ty_status status, const char* text)
{
    frames out = {0};
    ty_error error = {0};
    assert_int_equal(try_make(recipe, NULL, &out, &error), status);
    if (!strstr(error.text, text))
        fail_msg("'%s' is not in: %s", text, error.text);
    assert_int_equal(out.count, 0);
}

static void write_image(const char* path, int width, int height, float (*value)(int x, int y, int c))
{
    ty_image image = {.width = width, .height = height, .channels = 3};
    image.pixels = TY_ALLOC(float, 3 * width * height);
    for (int i = 0; i < 3 * width * height; i++)
        image.pixels[i] = value(i / 3 % width, i / 3 / width, i % 3);
    ty_error error;
    assert_int_equal(ty_image_write(path, &image, 8, &error), TY_OK);
    ty_image_term(&image);
}

// --- how much of a picture is there ---

// Means over a binomial window of 18 passes of three cells: a standard deviation of 3.5.
static void blur(double* plane, int w, int h)
{
    double* scratch = TY_ALLOC(double, w* h);
    for (int pass = 0; pass < 18; pass++)
    {
        for (int i = 0; i < w * h; i++)
            scratch[i] = (plane[i % w ? i - 1 : i] + plane[i] + plane[i % w + 1 < w ? i + 1 : i]) / 3.0;
        for (int i = 0; i < w * h; i++)
            plane[i] = (scratch[i >= w ? i - w : i] + scratch[i] + scratch[i + w < w * h ? i + w : i]) / 3.0;
    }
    ty_free(scratch);
}

static double correlation(const double* a, const double* b, int n)
{
    double ma = 0.0, mb = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    for (int i = 0; i < n; i++)
    {
        ma += a[i] / n;
        mb += b[i] / n;
    }
    for (int i = 0; i < n; i++)
    {
        aa += (a[i] - ma) * (a[i] - ma);
        bb += (b[i] - mb) * (b[i] - mb);
        ab += (a[i] - ma) * (b[i] - mb);
    }
    return ab / sqrt(aa * bb + 1e-30);
}

static float light_of(float shown)
{
    return shown <= 0.04045f ? shown / 12.92f : powf((shown + 0.055f) / 1.055f, 2.4f);
}

// Between local means of the light in an image file and of what a frame shows: cells above the middle are white.
static double tone_correlation(const char* path, const ty_image* frame)
{
    ty_image image;
    ty_error error;
    assert_int_equal(ty_image_read(path, &image, &error), TY_OK);
    int n = image.width * image.height;
    assert_int_equal(n, frame->width * frame->height);
    double *a = TY_ALLOC(double, n), *b = TY_ALLOC(double, n);
    for (int i = 0; i < n; i++)
    {
        static const float weights[3] = {0.2126f, 0.7152f, 0.0722f};
        for (int c = 0; c < 3; c++)
            a[i] += (double)(weights[c] * light_of(image.pixels[i * image.channels + c]));
        b[i] = frame->pixels[i * frame->channels] > 0.5f;
    }
    blur(a, image.width, image.height);
    blur(b, image.width, image.height);
    double r = correlation(a, b, n);
    ty_free(a);
    ty_free(b);
    ty_image_term(&image);
    return r;
}

static ty_filter_recipe photo(void)
{
    ty_filter_recipe recipe = ty_filter_recipe_default();
    recipe.image = SCENES "/filter_seed/photo.jpg";
    return recipe;
}

static void a_picture_stays_in_tone_mode(void** state)
{
    (void)state;
    ty_filter_recipe recipe = photo();
    recipe.frames = 3;
    recipe.time_per_frame = 2000.0f;
    for (int c = 0; c < 2; c++)
    {
        frames out = {0};
        recipe.tone.calibrated = c;
        make(&recipe, &out);
        double early = tone_correlation(recipe.image, &out.images[1]);
        double late = tone_correlation(recipe.image, &out.images[3]);
        print_message("calibrated %d: %.4f at 2000, %.4f at 6000\n", c, early, late);
        assert_true(early > (c ? 0.98 : 0.88) && late > (c ? 0.98 : 0.88));
        assert_true(early < (c ? 1.0 : 0.95)); // it is the calibration that does it
        forget(&out);
    }
}

// Of a frame's first channel: how steep it is, blurred, against how steep the picture is.
static double edge_correlation(const char* path, const ty_image* frame)
{
    ty_image image;
    ty_error error;
    assert_int_equal(ty_image_read(path, &image, &error), TY_OK);
    int w = image.width, n = w * image.height;
    double* edges[2] = {TY_ALLOC(double, n), TY_ALLOC(double, n)};
    for (int k = 0; k < 2; k++)
    {
        const ty_image* from = k ? frame : &image;
        for (int i = w + 1; i < n - w - 1; i++)
        {
            const float* p = from->pixels + (size_t)i * (size_t)from->channels + (k ? 0 : 1);
            edges[k][i] = hypot((double)(p[from->channels] - p[-from->channels]),
                                (double)(p[w * from->channels] - p[-w * from->channels]));
        }
        blur(edges[k], w, image.height);
    }
    double r = correlation(edges[0], edges[1], n);
    ty_free(edges[0]);
    ty_free(edges[1]);
    ty_image_term(&image);
    return r;
}

// Limited diffusion keeps edges for a while, and only for a while.
static void limits_keep_edges_at_first(void** state)
{
    (void)state;
    double kept[4][2];
    for (int k = 0; k < 4; k++)
    {
        frames out = {0};
        ty_filter_recipe recipe = photo();
        recipe.mode = k == 0 ? TY_FILTER_PLAIN : TY_FILTER_LIMITED;
        recipe.preset = TY_FILTER_STRIPES;
        recipe.limit.of = k == 2;
        recipe.limit.conservative = k == 3;
        recipe.time = 90.0f;
        recipe.time_per_frame = 1410.0f;
        recipe.frames = 2;
        recipe.softness = 3.0f;
        recipe.fields = true;
        make(&recipe, &out);
        assert_int_equal(out.images[1].channels, 3); // Y, U, V
        for (int t = 0; t < 2; t++)
            kept[k][t] = edge_correlation(recipe.image, &out.images[t + 1]);
        print_message("%s: edges %.3f at 90, %.3f at 1500\n",
                      k == 0   ? "plain"
                      : k == 1 ? "limit of u"
                      : k == 2 ? "limit of both"
                               : "conservative",
                      kept[k][0], kept[k][1]);
        forget(&out);
    }
    for (int k = 1; k < 4; k++)
        assert_true(kept[k][0] > kept[0][0] + 0.03);
}

// --- colours ---

static float even_color(int x, int y, int c)
{
    static const float color[3] = {0.8f, 0.5f, 0.3f};
    (void)x;
    (void)y;
    return color[c];
}

static float even_grey(int x, int y, int c)
{
    (void)c;
    return 0.4f + 0.3f * (float)x / 96.0f + (y > 48 ? 0.1f : 0.0f);
}

static ty_filter_recipe small(const char* image)
{
    ty_filter_recipe recipe = ty_filter_recipe_default();
    static char kept[200]; // in_folder forgets
    if (image)
        recipe.image = strcpy(kept, image);
    recipe.time = 600.0f;
    return recipe;
}

static void means_of_colours_are_kept(void** state)
{
    (void)state;
    // sRGB 0.8, 0.5, 0.3 in ACEScg.
    static const float expected[3] = {0.4464f, 0.2395f, 0.0994f};
    write_image(in_folder("color.png"), 96, 96, even_color);
    for (int kind = TY_FILTER_TINTED; kind <= TY_FILTER_CHANNELS; kind++)
    {
        frames out = {0};
        ty_filter_recipe recipe = small(in_folder("color.png"));
        recipe.color = kind;
        recipe.time = 1500.0f;
        make(&recipe, &out);
        const ty_image* image = &out.images[1];
        assert_int_equal(image->channels, 3);
        double mean[3] = {0};
        for (int i = 0; i < 3 * 96 * 96; i++)
            mean[i % 3] += (double)image->pixels[i] / (96 * 96);
        print_message("kind %d: mean %.4f %.4f %.4f\n", kind, mean[0], mean[1], mean[2]);
        for (int c = 0; c < 3; c++)
            assert_float_equal((float)mean[c], expected[c], 0.03f);
        forget(&out);
    }
}

static void channels_of_a_grey_picture_are_grey(void** state)
{
    (void)state;
    frames out = {0};
    write_image(in_folder("grey.png"), 96, 96, even_grey);
    ty_filter_recipe recipe = small(in_folder("grey.png"));
    recipe.color = TY_FILTER_CHANNELS;
    make(&recipe, &out);
    int bright = 0;
    for (int i = 0; i < 96 * 96; i++)
    {
        const float* p = out.images[1].pixels + 3 * (size_t)i;
        assert_true(fabsf(p[0] - p[1]) < 2e-3f && fabsf(p[1] - p[2]) < 2e-3f);
        bright += p[0] > 0.5f;
    }
    assert_in_range(bright, 1000, 6000);
    forget(&out);
}

// --- masks and lines ---

static float half_mask(int x, int y, int c)
{
    (void)y;
    (void)c;
    return x < 40 ? 0.0f : 1.0f;
}

static float step_picture(int x, int y, int c)
{
    (void)y;
    (void)c;
    return x < 48 ? 0.3f : 0.6f;
}

// Cells that a mask takes out are what its region says; those of an inverted one are the others.
static void masks_hold_their_values(void** state)
{
    (void)state;
    write_image(in_folder("mask.png"), 96, 96, half_mask);
    for (int k = 0; k < 4; k++)
    {
        frames out = {0};
        ty_filter_recipe recipe = small(NULL);
        ty_filter_region region = {in_folder("mask.png"), k % 2, k / 2, {5.0f, 1.5f}, 0.06f};
        recipe.cells[0] = recipe.cells[1] = 96;
        recipe.regions = (ty_param_list){&region, 1};
        recipe.fields = true;
        make(&recipe, &out);
        int held = 0;
        for (int i = 0; i < 96 * 96; i++)
        {
            const float* p = out.images[1].pixels + 3 * (size_t)i; // Y, U, V
            bool is_held = p[1] == 5.0f && p[2] == 1.5f;
            held += is_held;
            assert_int_equal(is_held, (i % 96 < 40) != (k % 2 == 1));
        }
        assert_int_equal(held, k % 2 ? 56 * 96 : 40 * 96);
        forget(&out);
    }
}

// The one edge of the picture becomes the one line, one cell wide or as wide as is asked.
static void contours_are_lines_of_fixed_values(void** state)
{
    (void)state;
    write_image(in_folder("step.png"), 96, 96, step_picture);
    for (int k = 0; k < 3; k++)
    {
        frames out = {0};
        ty_filter_recipe recipe = small(in_folder("step.png"));
        recipe.contours.threshold = k == 2 ? 0.9f : 0.02f;
        recipe.contours.width = k ? 3.0f : 1.0f;
        recipe.fields = true;
        make(&recipe, &out);
        int held = 0;
        for (int i = 0; i < 96 * 96; i++)
        {
            const float* p = out.images[1].pixels + 3 * (size_t)i;
            bool is_held = p[1] == 5.0f && p[2] == 0.0f;
            held += is_held;
            assert_true(!is_held || abs(i % 96 - 48) <= 2);
        }
        print_message("width %g: %d cells held\n", (double)recipe.contours.width, held);
        assert_in_range(held, k == 2 ? 0 : k ? 3 * 90 : 90, k == 2 ? 0 : k ? 3 * 96 : 96);
        forget(&out);
    }
}

// --- time ---

static void assert_equal_images(const ty_image* a, const ty_image* b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->channels, b->channels);
    size_t size = (size_t)a->width * (size_t)a->height * (size_t)a->channels;
    assert_memory_equal(a->pixels, b->pixels, size * sizeof(float));
}

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
        cmocka_unit_test(a_picture_stays_in_tone_mode),
        cmocka_unit_test(limits_keep_edges_at_first),
        cmocka_unit_test(means_of_colours_are_kept),
        cmocka_unit_test(channels_of_a_grey_picture_are_grey),
        cmocka_unit_test(masks_hold_their_values),
        cmocka_unit_test(contours_are_lines_of_fixed_values),
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
