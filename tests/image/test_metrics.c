// SPDX-License-Identifier: Apache-2.0
// Errors of pixels against sums done by hand, FLIP against its properties and against the authors' program.
#include "../../image/select.h"
#include "base/cmocka_all.h"
#include "image_folder.h"
#include <math.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/rng.h>
#include <tsuya/image/metrics.h>

enum
{
    WIDTH = 96,
    HEIGHT = 64,
};

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g is not %.9g", value, expected);
}

static ty_image make_image(int width, int height, int channels, float value)
{
    ty_image image = {.width = width, .height = height, .channels = channels};
    image.pixels = TY_ALLOC(float, width* height* channels);
    for (int i = 0; i < width * height * channels; i++)
        image.pixels[i] = value;
    return image;
}

static ty_pixel_errors measure(const ty_image* reference, const ty_image* test, const uint8_t* mask, double peak)
{
    ty_pixel_errors errors = {0};
    ty_error error;
    assert_int_equal(ty_pixel_errors_measure(reference, test, mask, peak, &errors, &error), TY_OK);
    return errors;
}

static void test_errors_are_the_sums_done_by_hand(void** state)
{
    (void)state;
    ty_image a = make_image(2, 3, 3, 0.5f), b = make_image(2, 3, 3, 0.5f);
    b.pixels[3 * 4 + 1] = 0.9f; // pixel 0,2, green: +.4
    a.pixels[3 * 1] = 2.0f;     // pixel 1,0, red: -1.5
    ty_pixel_errors e = measure(&a, &b, NULL, 0.0);
    double squares = 0.4 * 0.4 + 1.5 * 1.5;
    assert_near(e.value[TY_METRIC_RMSE], sqrt(squares / 18.0), 1e-7);
    assert_near(e.value[TY_METRIC_MAE], 1.9 / 18.0, 1e-7);
    assert_near(e.value[TY_METRIC_RELMSE], (0.16 / 0.26 + 2.25 / 4.01) / 18.0, 1e-7);
    assert_near(e.value[TY_METRIC_PSNR], 20.0 * log10(2.0 / sqrt(squares / 18.0)), 1e-5);
    assert_near(measure(&a, &b, NULL, 1.0).value[TY_METRIC_PSNR], -10.0 * log10(squares / 18.0), 1e-5);
    assert_near(e.value[TY_METRIC_MAX], 1.5, 0);
    assert_int_equal(e.x, 1);
    assert_int_equal(e.y, 0);
    assert_int_equal(e.channel, 0);
    assert_near(e.reference, 2.0, 0);
    assert_near(e.test, 0.5, 0);
    const uint8_t lower[6] = {0, 0, 0, 0, 1, 1};
    e = measure(&a, &b, lower, 0.0);
    assert_near(e.value[TY_METRIC_RMSE], sqrt(0.16 / 6.0), 1e-7);
    assert_int_equal(e.y, 2);
    assert_int_equal(e.channel, 1);
    ty_image_term(&a);
    ty_image_term(&b);
}

static void test_equal_pictures_have_no_error(void** state)
{
    (void)state;
    ty_image a = make_image(5, 4, 1, 0.25f);
    ty_pixel_errors e = measure(&a, &a, NULL, 0.0);
    for (int i = TY_METRIC_RMSE; i <= TY_METRIC_MAX; i++)
        assert_true(i == TY_METRIC_PSNR ? isinf(e.value[i]) && e.value[i] > 0 : e.value[i] == 0.0);
    ty_image_term(&a);
}

static void test_trimming_forgets_fireflies_alone(void** state)
{
    (void)state;
    ty_image a = make_image(100, 30, 3, 1.0f), b = make_image(100, 30, 3, 1.1f);
    double plain = measure(&a, &b, NULL, 0.0).value[TY_METRIC_TRELMSE];
    assert_near(plain, 0.01 / 1.01, 1e-6);
    for (int i = 0; i < 3; i++) // three of 3,000 pixels: just what is trimmed
        b.pixels[3 * (700 * i + 5)] = 1000.0f;
    ty_pixel_errors e = measure(&a, &b, NULL, 0.0);
    assert_near(e.value[TY_METRIC_TRELMSE], plain, 1e-6);
    assert_true(e.value[TY_METRIC_RELMSE] > 100.0);
    b.pixels[3 * 2900] = 1000.0f;
    assert_true(measure(&a, &b, NULL, 0.0).value[TY_METRIC_TRELMSE] > 100.0);
    ty_image_term(&a);
    ty_image_term(&b);
}

static void test_what_is_not_finite_is_found_where_it_stands(void** state)
{
    (void)state;
    ty_image a = make_image(7, 5, 3, 1.0f);
    assert_int_equal(ty_image_find_non_finite(&a).count, 0);
    a.pixels[3 * (7 * 2 + 4) + 1] = (float)NAN;
    a.pixels[3 * (7 * 4 + 6)] = -(float)INFINITY;
    ty_non_finite found = ty_image_find_non_finite(&a);
    assert_int_equal(found.count, 2);
    assert_int_equal(found.x, 4);
    assert_int_equal(found.y, 2);
    assert_int_equal(found.channel, 1);
    assert_true(isnan(found.value));
    ty_image_term(&a);
}

static int by_value(const void* a, const void* b)
{
    float x = *(const float*)a, y = *(const float*)b;
    return (x > y) - (x < y);
}

static void test_selection_agrees_with_sorting(void** state)
{
    (void)state;
    for (int count = 1; count < 200; count += 7)
        for (int kinds = 1; kinds <= 256; kinds *= 16)
        {
            float values[200], sorted[200];
            for (int i = 0; i < count; i++)
                values[i] = sorted[i] = (float)(ty_mix64((uint64_t)(i + 977 * count)) % (uint64_t)kinds);
            qsort(sorted, (size_t)count, sizeof *sorted, by_value);
            int k = (int)(ty_mix64((uint64_t)count) % (uint64_t)count);
            assert_near(ty_select(values, count, k), sorted[k], 0);
            for (int i = 0; i < count; i++)
                assert_true(i < k ? values[i] <= sorted[k] : i > k ? values[i] >= sorted[k] : true);
        }
}

// Levels of an 8-bit picture: gradients, a checker that fades to the right, a bright disk.
static int level(int x, int y, int c)
{
    int value = (x * 2 + y * (c + 1)) % 256;
    if ((x / 4 + y / 4) % 2)
        value = (value + 60 + 20 * c) % 256;
    bool inside = (x - 60) * (x - 60) + (y - 30) * (y - 30) < 150;
    return inside ? 250 - 40 * c : value;
}

// The same with a tint, a shifted disk and a few wrong pixels.
static int changed_level(int x, int y, int c)
{
    int value = level(x + (x > 40), y, c) + (c == 1 ? 9 : -5);
    if ((x * 7 + y * 13) % 101 == 0)
        value = 255 - value;
    return value < 0 ? 0 : value > 255 ? 255 : value;
}

// peak 1: display values; more: scene-linear with a range of peak : 1.
static ty_image pattern(int (*at)(int, int, int), float peak)
{
    ty_image image = make_image(WIDTH, HEIGHT, 3, 0.0f);
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
    {
        float value = (float)at(i / 3 % WIDTH, i / 3 / WIDTH, i % 3) / 255.0f;
        image.pixels[i] = peak > 1.0f ? 0.01f + peak * value * value * value : value;
    }
    return image;
}

static double flip(const ty_image* a, const ty_image* b, bool hdr, float ppd, ty_workers* workers, float* map)
{
    static float own[WIDTH * HEIGHT];
    map = map ? map : own;
    ty_error error = {0};
    ty_status status =
        hdr ? ty_flip_hdr(a, b, ppd, workers, map, &error) : ty_flip_ldr(a, b, true, ppd, workers, map, &error);
    if (status != TY_OK)
        fail_msg("%s", error.text);
    int64_t count = (int64_t)a->width * a->height;
    for (int64_t i = 0; i < count; i++)
        assert_true(map[i] >= 0.0f && map[i] <= 1.0f);
    return ty_map_mean(map, NULL, count);
}

// The authors' program (version 1.6) over these very pictures.
static void test_flip_is_what_its_authors_compute(void** state)
{
    (void)state;
    ty_image a = pattern(level, 1), b = pattern(changed_level, 1);
    assert_near(flip(&a, &b, false, TY_FLIP_PPD, NULL, NULL), 0.329062, 2e-6);
    assert_near(flip(&a, &b, false, 20.0f, NULL, NULL), 0.421705, 2e-6);
    ty_image_term(&a);
    ty_image_term(&b);
    a = pattern(level, 40);
    b = pattern(changed_level, 40);
    assert_near(flip(&a, &b, true, TY_FLIP_PPD, NULL, NULL), 0.342169, 1e-5);
    ty_image_term(&a);
    ty_image_term(&b);
}

static void test_flip_of_extremes(void** state)
{
    (void)state;
    ty_image black = make_image(WIDTH, HEIGHT, 3, 0.0f), white = make_image(WIDTH, HEIGHT, 3, 1.0f);
    assert_near(flip(&black, &black, false, TY_FLIP_PPD, NULL, NULL), 0.0, 0);
    assert_near(flip(&white, &white, true, TY_FLIP_PPD, NULL, NULL), 0.0, 0);
    assert_near(flip(&black, &black, true, TY_FLIP_PPD, NULL, NULL), 0.0, 0);
    double far = flip(&black, &white, false, TY_FLIP_PPD, NULL, NULL);
    assert_true(far > 0.95 && far <= 1.0);
    ty_image_term(&black);
    ty_image_term(&white);
}

static void test_flip_is_symmetric_and_grows(void** state)
{
    (void)state;
    ty_image a = pattern(level, 1), b = pattern(changed_level, 1), c = pattern(level, 1);
    assert_near(flip(&a, &b, false, TY_FLIP_PPD, NULL, NULL), flip(&b, &a, false, TY_FLIP_PPD, NULL, NULL), 0);
    double last = 0.0;
    for (int step = 1; step <= 4; step++)
    {
        for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
            c.pixels[i] = ty_clamp(a.pixels[i] + 0.04f * (float)step, 0.0f, 1.0f);
        double error = flip(&a, &c, false, TY_FLIP_PPD, NULL, NULL);
        assert_true(error > last + 0.01);
        last = error;
    }
    ty_image_term(&a);
    ty_image_term(&b);
    ty_image_term(&c);
}

// A checker of single pixels against its mean: from far away (many pixels a degree) nobody sees the difference.
static void test_flip_forgives_what_is_too_fine_to_see(void** state)
{
    (void)state;
    ty_image a = make_image(WIDTH, HEIGHT, 3, 0.735357f), b = make_image(WIDTH, HEIGHT, 3, 0.0f); // .5 linear
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
        b.pixels[i] = (i / 3 % WIDTH + i / 3 / WIDTH) % 2 ? 1.0f : 0.0f;
    double near = flip(&a, &b, false, 10.0f, NULL, NULL), away = flip(&a, &b, false, 300.0f, NULL, NULL);
    assert_true(near > 0.5);
    assert_true(away < 0.1);
    ty_image_term(&a);
    ty_image_term(&b);
}

static void test_hdr_flip_does_not_care_about_exposure(void** state)
{
    (void)state;
    ty_image a = pattern(level, 40), b = pattern(changed_level, 40);
    double before = flip(&a, &b, true, TY_FLIP_PPD, NULL, NULL);
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
    {
        a.pixels[i] *= 32.0f;
        b.pixels[i] *= 32.0f;
    }
    assert_near(flip(&a, &b, true, TY_FLIP_PPD, NULL, NULL), before, 1e-5);
    // More than half in the dark: the exposures are those of what is lit.
    for (int i = 0; i < WIDTH * HEIGHT * 2; i++)
        a.pixels[i] = b.pixels[i] = 0.0f;
    double dark = flip(&a, &b, true, TY_FLIP_PPD, NULL, NULL);
    assert_true(dark > 0.01 && dark < 0.5 * before);
    ty_image_term(&a);
    ty_image_term(&b);
}

static void test_flip_has_the_same_bits_on_any_number_of_threads(void** state)
{
    (void)state;
    static float maps[2][WIDTH * HEIGHT];
    ty_image a = pattern(level, 1), b = pattern(changed_level, 1);
    ty_workers* workers;
    assert_int_equal(ty_workers_create(3, &workers, NULL), TY_OK);
    flip(&a, &b, false, TY_FLIP_PPD, NULL, maps[0]);
    flip(&a, &b, false, TY_FLIP_PPD, workers, maps[1]);
    assert_memory_equal(maps[0], maps[1], sizeof maps[0]);
    ty_workers_destroy(workers);
    ty_image_term(&a);
    ty_image_term(&b);
}

static void test_flip_says_what_it_cannot_do(void** state)
{
    (void)state;
    static float map[WIDTH * HEIGHT];
    ty_image a = pattern(level, 1);
    ty_error error = {0};
    assert_int_equal(ty_flip_ldr(&a, &a, true, 0.5f, NULL, map, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "1 to 1000"));
    int failures = 0;
    for (ty_status status = TY_NO_MEMORY; status == TY_NO_MEMORY; failures++)
    {
        ty_memory_fail_after(failures);
        status = ty_flip_hdr(&a, &a, TY_FLIP_PPD, NULL, map, &error);
        assert_true(status == TY_NO_MEMORY || status == TY_OK);
    }
    ty_memory_fail_after(-1);
    assert_int_equal(failures, 22); // 21 allocations, and the time without a failure
    ty_image_term(&a);
}

// CIE lightness of the colour map.
static double lightness(const float srgb[3])
{
    double linear[3];
    for (int c = 0; c < 3; c++)
        linear[c] = srgb[c] <= 0.04045f ? (double)srgb[c] / 12.92 : pow(((double)srgb[c] + 0.055) / 1.055, 2.4);
    double y = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
    return y > 0.008856 ? 116.0 * cbrt(y) - 16.0 : 903.3 * y;
}

static void test_the_heat_map_grows_lighter_throughout(void** state)
{
    (void)state;
    double last = -1.0;
    for (int i = 0; i <= 100; i++)
    {
        float color[3];
        ty_heat_color((float)i / 100.0f, color);
        double now = lightness(color);
        assert_true(now > last);
        assert_true(i == 0 || now - last < 2.5);
        last = now;
    }
    assert_true(last > 90.0);
}

static void test_names_of_metrics(void** state)
{
    (void)state;
    ty_metric metric;
    for (int i = 0; i < TY_METRIC_COUNT; i++)
    {
        assert_true(ty_metric_find(ty_metric_name((ty_metric)i), &metric));
        assert_int_equal(metric, i);
    }
    assert_false(ty_metric_find("ssim", &metric));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_errors_are_the_sums_done_by_hand),
        cmocka_unit_test(test_equal_pictures_have_no_error),
        cmocka_unit_test(test_trimming_forgets_fireflies_alone),
        cmocka_unit_test(test_what_is_not_finite_is_found_where_it_stands),
        cmocka_unit_test(test_selection_agrees_with_sorting),
        cmocka_unit_test(test_flip_is_what_its_authors_compute),
        cmocka_unit_test(test_flip_of_extremes),
        cmocka_unit_test(test_flip_is_symmetric_and_grows),
        cmocka_unit_test(test_flip_forgives_what_is_too_fine_to_see),
        cmocka_unit_test(test_hdr_flip_does_not_care_about_exposure),
        cmocka_unit_test(test_flip_has_the_same_bits_on_any_number_of_threads),
        cmocka_unit_test(test_flip_says_what_it_cannot_do),
        cmocka_unit_test(test_the_heat_map_grows_lighter_throughout),
        cmocka_unit_test(test_names_of_metrics),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
