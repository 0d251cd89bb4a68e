// SPDX-License-Identifier: Apache-2.0
// Textures: texels in ACEScg by the right space, bilinear values by hand, and what lies outside of 0..1.
#include "base/cmocka_all.h"
#include "image_folder.h"
#include <math.h>
#include <tsuya/base/file.h>
#include <tsuya/image/exr.h>
#include <tsuya/image/image.h>
#include <tsuya/image/texture.h>

static ty_color* color;

static int setup(void** state)
{
    if (ty_color_create(NULL, &color, NULL) != TY_OK)
        return -1;
    return folder_setup(state);
}

static int teardown(void** state)
{
    ty_color_destroy(color);
    return folder_teardown(state);
}

static ty_texture* load(const char* path, const char* space, ty_wrap wrap)
{
    ty_texture_def def = ty_texture_def_default();
    assert_int_equal(def.wrap, TY_WRAP_REPEAT);
    def.path = path;
    def.color_space = space;
    def.wrap = wrap;
    ty_texture* texture = NULL;
    ty_error error = {0};
    if (ty_texture_create(&def, color, &texture, &error) != TY_OK)
        fail_msg("%s", error.text);
    return texture;
}

static void assert_rgb(ty_rgb value, float r, float g, float b, float tolerance)
{
    if (!(fabsf(value.r - r) <= tolerance && fabsf(value.g - g) <= tolerance && fabsf(value.b - b) <= tolerance))
        fail_msg("%g %g %g, expected %g %g %g", (double)value.r, (double)value.g, (double)value.b, (double)r, (double)g,
                 (double)b);
}

// 3 x 2 texels, top row 1 2 3, bottom row 4 5 6 in each channel, times 1, 10, 100.
static const char* small_exr(void)
{
    const int window[4] = {0, 0, 2, 1};
    ty_exr* exr = ty_exr_create(window, window);
    static const char* const names[] = {"R", "G", "B"};
    float scale = 1.0f;
    for (int c = 0; c < 3; c++, scale *= 10.0f)
    {
        float* pixels = ty_exr_add_channel(exr, names[c], TY_EXR_FLOAT);
        for (int i = 0; i < 6; i++)
            pixels[i] = (float)(i + 1) * scale;
    }
    const char* path = in_folder("small.exr");
    assert_int_equal(ty_exr_write(path, exr, NULL), TY_OK);
    ty_exr_destroy(exr);
    return path;
}

static float sample(const ty_texture* texture, float u, float v)
{
    ty_rgb value = ty_texture_sample(texture, (ty_vec2){u, v});
    assert_rgb(value, value.r, value.r * 10.0f, value.r * 100.0f, 1e-3f);
    return value.r;
}

static void assert_sample(const ty_texture* texture, float u, float v, float expected)
{
    float value = sample(texture, u, v);
    if (!(fabsf(value - expected) < 1e-4f))
        fail_msg("at %g %g: %g, expected %g", (double)u, (double)v, (double)value, (double)expected);
}

static void test_bilinear_values(void** state)
{
    (void)state;
    ty_texture* texture = load(small_exr(), "raw", TY_WRAP_CLAMP);
    assert_int_equal(ty_texture_width(texture), 3);
    assert_int_equal(ty_texture_height(texture), 2);
    for (int y = 0; y < 2; y++)
        for (int x = 0; x < 3; x++)
        {
            float expected = (float)(y * 3 + x + 1);
            assert_rgb(ty_texture_texel(texture, x, y), expected, expected * 10, expected * 100, 0);
            assert_sample(texture, ((float)x + 0.5f) / 3.0f, 1.0f - ((float)y + 0.5f) / 2.0f, expected);
        }
    assert_sample(texture, 0.5f, 0.5f, 3.5f);
    assert_sample(texture, 1.0f / 3.0f, 0.25f, 4.5f); // v = 0 is the bottom
    assert_sample(texture, 0.5f / 3.0f + 0.25f / 3.0f, 0.75f, 1.25f);
    ty_texture_destroy(texture);
    ty_texture_destroy(NULL);
}

static void test_wraps(void** state)
{
    (void)state;
    const float far = 1e30f;
    for (int wrap = TY_WRAP_REPEAT; wrap <= TY_WRAP_MIRROR; wrap++)
    {
        ty_texture* texture = load(small_exr(), "raw", (ty_wrap)wrap);
        for (int i = -7; i < 9; i++) // texel centres in a row, then by definition of the wrap
        {
            int repeat = ((i % 3) + 3) % 3, mirror = ((i % 6) + 6) % 6, clamp = i < 0 ? 0 : i > 2 ? 2 : i;
            mirror = mirror > 2 ? 5 - mirror : mirror;
            int x = wrap == TY_WRAP_REPEAT ? repeat : wrap == TY_WRAP_MIRROR ? mirror : clamp;
            assert_sample(texture, ((float)i + 0.5f) / 3.0f, 0.75f, (float)(x + 1));
        }
        // the border between the last texel and what follows it; above the top row
        float past = wrap == TY_WRAP_REPEAT ? 2.0f : 3.0f, over = wrap == TY_WRAP_REPEAT ? 2.5f : 1.0f;
        assert_sample(texture, 1.0f, 0.75f, past);
        assert_sample(texture, 0.5f / 3.0f, 1.0f, over);
        assert_sample(texture, -1e-9f, 0.75f, wrap == TY_WRAP_REPEAT ? 2.0f : 1.0f);
        static const float odd[] = {NAN, INFINITY, -INFINITY, 1e9f, -1e9f};
        for (int i = 0; i < 5; i++)
            assert_true(isfinite(sample(texture, odd[i], odd[i])));
        assert_true(isfinite(sample(texture, far, -far)));
        ty_texture_destroy(texture);
    }
}

static const char* write_png(const char* name, int channels, const float* pixels)
{
    ty_image image = {.width = 1, .height = 1, .channels = channels, .pixels = (float*)pixels};
    const char* path = in_folder(name);
    assert_int_equal(ty_image_write(path, &image, 8, NULL), TY_OK);
    return path;
}

static void test_spaces_are_guessed_from_the_type(void** state)
{
    (void)state;
    const float pixel[4] = {128.0f / 255.0f, 128.0f / 255.0f, 128.0f / 255.0f, 0.25f};
    ty_texture* texture = load(write_png("a.png", 4, pixel), NULL, TY_WRAP_REPEAT); // alpha does not count
    assert_rgb(ty_texture_texel(texture, 0, 0), 0.2158605f, 0.2158605f, 0.2158605f, 2e-4f);
    ty_texture_destroy(texture);
    texture = load(write_png("a.png", 3, pixel), "lin_rec709", TY_WRAP_REPEAT);
    assert_rgb(ty_texture_texel(texture, 0, 0), pixel[0], pixel[0], pixel[0], 5e-4f);
    ty_texture_destroy(texture);
    texture = load(write_png("a.png", 1, pixel), "raw", TY_WRAP_REPEAT); // one channel is grey
    assert_rgb(ty_texture_texel(texture, 0, 0), pixel[0], pixel[0], pixel[0], 2.5e-4f);
    ty_texture_destroy(texture);
    const float red[3] = {1, 0, 0};
    texture = load(write_png("a.png", 3, red), NULL, TY_WRAP_REPEAT);
    assert_rgb(ty_texture_texel(texture, 0, 0), 0.6130974f, 0.0701937f, 0.0206156f, 4e-4f);
    ty_texture_destroy(texture);
}

static const char* one_exr(const float* values, const char* const* names, int count, const float* primaries)
{
    const int window[4] = {0, 0, 0, 0};
    ty_exr* exr = ty_exr_create(window, window);
    for (int i = 0; i < count; i++)
        *(float*)ty_exr_add_channel(exr, names[i], TY_EXR_FLOAT) = values[i];
    if (primaries)
        ty_exr_add_chromaticities(exr, primaries);
    const char* path = in_folder("one.exr");
    assert_int_equal(ty_exr_write(path, exr, NULL), TY_OK);
    ty_exr_destroy(exr);
    return path;
}

static void test_float_files(void** state)
{
    (void)state;
    static const char* const rgb[] = {"R", "G", "B"};
    static const char* const grey_alpha[] = {"Y", "A"};
    const float red[3] = {1, 0, 0}, grey[2] = {0.75f, 0.5f}, odd[3] = {INFINITY, NAN, -INFINITY};
    ty_texture* texture = load(one_exr(red, rgb, 3, NULL), NULL, TY_WRAP_REPEAT); // linear Rec.709 when nobody says
    assert_rgb(ty_texture_texel(texture, 0, 0), 0.6130974f, 0.0701937f, 0.0206156f, 4e-4f);
    ty_texture_destroy(texture);
    const float ap1[8] = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    texture = load(one_exr(red, rgb, 3, ap1), NULL, TY_WRAP_REPEAT); // its chromaticities say
    assert_rgb(ty_texture_texel(texture, 0, 0), 1, 0, 0, 0);
    ty_texture_destroy(texture);
    texture = load(one_exr(grey, grey_alpha, 2, NULL), "raw", TY_WRAP_REPEAT);
    assert_rgb(ty_texture_texel(texture, 0, 0), 0.75f, 0.75f, 0.75f, 0);
    ty_texture_destroy(texture);
    texture = load(one_exr(odd, rgb, 3, NULL), "raw", TY_WRAP_REPEAT); // nothing that a lookup could trip over
    assert_rgb(ty_texture_texel(texture, 0, 0), 65504.0f, 0, 0, 0);
    ty_texture_destroy(texture);
}

static void test_failures_leave_nothing(void** state)
{
    (void)state;
    ty_texture_def def = ty_texture_def_default();
    ty_texture* texture = (ty_texture*)&def;
    ty_error error = {0};
    def.path = in_folder("missing.png");
    assert_int_equal(ty_texture_create(&def, color, &texture, &error), TY_BAD_FILE);
    assert_null(texture);
    def.path = small_exr();
    def.color_space = "lin_rec700";
    texture = (ty_texture*)&def;
    assert_int_equal(ty_texture_create(&def, color, &texture, &error), TY_BAD_INPUT);
    assert_null(texture);
    assert_non_null(strstr(error.text, "did you mean 'lin_rec709'"));
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_bilinear_values),
        TEST(test_wraps),
        TEST(test_spaces_are_guessed_from_the_type),
        TEST(test_float_files),
        TEST(test_failures_leave_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
