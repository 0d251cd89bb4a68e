// SPDX-License-Identifier: Apache-2.0
// Texts in pictures and pictures made smaller.
#include "base/cmocka_all.h"
#include <math.h>
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/label.h>

static ty_image blank(int width, int height)
{
    ty_image image = {.width = width, .height = height, .channels = 1};
    image.pixels = TY_ALLOC(float, (int64_t)width* height);
    return image;
}

static ty_image draw(float x, float y, const char* text, float size)
{
    ty_image image = blank(64, 32);
    ty_label_draw(&image, x, y, text, size, &(float){1.0f});
    return image;
}

static double ink(const ty_image* image, int x0, int y0, int x1, int y1)
{
    double sum = 0.0;
    for (int y = y0; y < y1; y++)
    {
        for (int x = x0; x < x1; x++)
        {
            sum += (double)image->pixels[y * image->width + x];
        }
    }
    return sum;
}

static void test_letters_differ(void** state)
{
    (void)state;
    ty_image shown[95];
    for (int i = 0; i < 95; i++)
    {
        shown[i] = draw(20.0f, 20.0f, (char[]){(char)(' ' + i), '\0'}, 16.0f);
        assert_true(i == 0 || ink(&shown[i], 0, 0, 64, 32) > 3.0);
        for (int k = 0; k < i; k++)
        {
            assert_memory_not_equal(shown[i].pixels, shown[k].pixels, 64 * 32 * sizeof(float));
        }
    }
    for (int i = 0; i < 95; i++)
    {
        ty_image_term(&shown[i]);
    }
}

// Capitals stand on the baseline and are as high as asked for; descenders go below; nothing is wider than told.
static void test_measure(void** state)
{
    (void)state;
    ty_image image = draw(10.0f, 24.0f, "H", 18.0f);
    assert_true(ink(&image, 0, 6, 64, 24) > 0.9 * ink(&image, 0, 0, 64, 32));
    assert_true(ink(&image, 0, 6, 64, 8) > 1.0);
    assert_true(ink(&image, 0, 0, 64, 4) == 0.0 && ink(&image, 0, 26, 64, 32) == 0.0);
    ty_image_term(&image);
    image = draw(10.0f, 24.0f, "p", 18.0f);
    assert_true(ink(&image, 0, 26, 64, 32) > 3.0);
    ty_image_term(&image);
    float width = ty_label_width("Wq8~", 12.0f);
    image = draw(3.0f, 20.0f, "Wq8~", 12.0f);
    assert_true(ink(&image, 0, 0, 2, 32) == 0.0 && ink(&image, 5 + (int)width, 0, 64, 32) == 0.0);
    assert_true(ink(&image, (int)width - 2, 0, 64, 32) > 0.1);
    ty_image_term(&image);
    assert_true(ty_label_width("", 12.0f) == 0.0f);
    assert_true(fabsf(ty_label_width("ab", 24.0f) - 2.0f * ty_label_width("ab", 12.0f)) < 1e-4f);
}

// A stroke covers its area: "I" is two bars and a stem of known length.
static void test_coverage(void** state)
{
    (void)state;
    ty_image image = draw(20.25f, 24.5f, "|", 18.0f); // 7 units of 3 pixels and two half discs, .8 units wide
    double expected = 21.0 * 2.4 + 3.14159265 * 1.2 * 1.2;
    assert_true(fabs(ink(&image, 0, 0, 64, 32) - expected) < 0.03 * expected);
    ty_image_term(&image);
}

// What lies outside is left out, and what text is not ASCII is one box a character.
static void test_edges(void** state)
{
    (void)state;
    ty_image image = blank(8, 8);
    const char* const text = "long text that goes on and on";
    ty_label_draw(&image, -20.0f, 4.0f, text, 20.0f, &(float){1.0f});
    ty_label_draw(&image, 1e6f, -1e6f, text, 20.0f, &(float){1.0f});
    ty_image_term(&image);
    assert_true(ty_label_width("\xc3\xa9", 10.0f) == ty_label_width("\x01", 10.0f));
    char out[16];
    ty_label_fit("short", 10.0f, 1000.0f, out, sizeof out);
    assert_string_equal(out, "short");
    ty_label_fit("much longer", 10.0f, 0.6f * ty_label_width("much longer", 10.0f), out, sizeof out);
    assert_true(strlen(out) < 10 && strcmp(out + strlen(out) - 2, "..") == 0);
    assert_true(ty_label_width(out, 10.0f) <= 0.6f * ty_label_width("much longer", 10.0f));
}

static void test_shrink(void** state)
{
    (void)state;
    ty_error error;
    ty_image image = {.width = 7, .height = 5, .channels = 2}, small;
    image.pixels = TY_ALLOC(float, 70);
    double mean[2] = {0.0, 0.0};
    for (int i = 0; i < 70; i++)
    {
        image.pixels[i] = (float)(i % 2 ? -1 : 1) * (float)(i * i % 17) + 0.0f; // no minus in front of zero
        mean[i % 2] += (double)image.pixels[i] / 35.0;
    }
    static const int sizes[][2] = {{1, 1}, {3, 2}, {7, 1}, {7, 5}, {4, 4}};
    for (int s = 0; s < 5; s++) // every size keeps the mean of each channel
    {
        int count = sizes[s][0] * sizes[s][1];
        double now[2] = {0.0, 0.0};
        assert_int_equal(ty_image_shrink(&image, sizes[s][0], sizes[s][1], &small, &error), TY_OK);
        for (int i = 0; i < 2 * count; i++)
        {
            now[i % 2] += (double)small.pixels[i] / count;
        }
        assert_true(fabs(now[0] - mean[0]) < 1e-5 && fabs(now[1] - mean[1]) < 1e-5);
        ty_image_term(&small);
    }
    assert_int_equal(ty_image_shrink(&image, 7, 5, &small, &error), TY_OK);
    assert_memory_equal(small.pixels, image.pixels, 70 * sizeof(float));
    ty_image_term(&small);
    for (int call = 0; call < 2; call++)
    {
        ty_memory_fail_after(call);
        assert_int_equal(ty_image_shrink(&image, 3, 3, &small, &error), TY_NO_MEMORY);
        assert_null(small.pixels);
    }
    ty_memory_fail_after(-1);
    ty_image_term(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_letters_differ), cmocka_unit_test(test_measure), cmocka_unit_test(test_coverage),
        cmocka_unit_test(test_edges),          cmocka_unit_test(test_shrink),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
