// SPDX-License-Identifier: Apache-2.0
// The Turing filter on a picture, for thousands of time units: the picture stays in tone mode, edges stay for a while.
#include "filter_frames.h"
#include "plane_compare.h"
#include <tsuya/image/color.h>

// --- how much of a picture is there ---

// Weighted means, a standard deviation of 3.5 cells.
static void blur(double* plane, int w, int h)
{
    double* scratch = TY_ALLOC(double, w* h);
    local_means(plane, w, h, 18, scratch);
    ty_free(scratch);
}

static float light_of(float shown)
{
    return shown <= 0.04045f ? shown / 12.92f : powf((shown + 0.055f) / 1.055f, 2.4f);
}

// Between local means of the light in an image file and of what a frame shows: cells above the middle are white.
// channel: of both, or -1 of the luminance and the first.
static double tone_correlation(const char* path, const ty_image* frame, int channel)
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
            a[i] += (channel < 0 ? (double)weights[c] : (double)(channel == c)) *
                    (double)light_of(image.pixels[i * image.channels + c]);
        b[i] = frame->pixels[i * frame->channels + (channel < 0 ? 0 : channel)] > 0.5f;
    }
    blur(a, image.width, image.height);
    blur(b, image.width, image.height);
    double r = correlation(a, b, n);
    ty_free(a);
    ty_free(b);
    ty_image_term(&image);
    return r;
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
        double early = tone_correlation(recipe.image, &out.images[1], -1);
        double late = tone_correlation(recipe.image, &out.images[3], -1);
        print_message("calibrated %d: %.4f at 2000, %.4f at 6000\n", c, early, late);
        assert_true(early > (c ? 0.98 : 0.88) && late > (c ? 0.98 : 0.88));
        assert_true(early < (c ? 1.0 : 0.95)); // it is the calibration that does it
        forget(&out);
    }
}

static void each_channel_of_a_picture_stays(void** state)
{
    (void)state;
    ty_color* color;
    ty_error error;
    frames out = {0};
    ty_filter_recipe recipe = photo();
    recipe.color = TY_FILTER_CHANNELS;
    recipe.frames = 2;
    recipe.time_per_frame = 4000.0f;
    make(&recipe, &out);
    assert_int_equal(ty_color_create(NULL, &color, &error), TY_OK);
    for (int f = 1; f <= 2; f++)
    {
        ty_image* image = &out.images[f];
        assert_int_equal(
            ty_color_convert(color, "ACEScg", "lin_rec709", image->pixels, image->width * image->height, 3, &error),
            TY_OK);
        for (int c = 0; c < 3; c++)
        {
            double r = tone_correlation(recipe.image, image, c);
            print_message("channel %d: %.4f at %d\n", c, r, f == 1 ? 2000 : 6000);
            assert_true(r > 0.95 && r < 1.0);
        }
    }
    ty_color_destroy(color);
    forget(&out);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_stays_in_tone_mode),
        cmocka_unit_test(each_channel_of_a_picture_stays),
        cmocka_unit_test(limits_keep_edges_at_first),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
