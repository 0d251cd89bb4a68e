// SPDX-License-Identifier: Apache-2.0
// Colour numbers against published ones: the grey of ACES SDR, primaries and curves, and the names one may use.
#include "base/cmocka_all.h"
#include "base/process.h"
#include "image_folder.h"
#include <math.h>
#include <tsuya/base/file.h>
#include <tsuya/base/workers.h>
#include <tsuya/image/color.h>

static ty_color* color;

static int load_embedded(void** state)
{
    (void)state;
    setenv("OCIO_LOGGING_LEVEL", "debug", 1); // looked at once; test_nothing_is_printed
    return ty_color_create(NULL, &color, NULL) == TY_OK ? 0 : -1;
}

static int unload(void** state)
{
    (void)state;
    ty_color_destroy(color);
    ty_color_destroy(NULL);
    return 0;
}

static void converted(const char* from, const char* to, float pixel[3])
{
    ty_error error = {0};
    if (ty_color_convert(color, from, to, pixel, 1, 3, &error) != TY_OK)
        fail_msg("%s", error.text);
}

static void developed(const char* display, const char* view, float exposure, float pixel[3])
{
    ty_error error = {0};
    if (ty_color_develop(color, display, view, exposure, pixel, 1, 3, &error) != TY_OK)
        fail_msg("%s", error.text);
}

static void assert_pixel(const float pixel[3], double r, double g, double b, double tolerance)
{
    if (fabs(pixel[0] - r) > tolerance || fabs(pixel[1] - g) > tolerance || fabs(pixel[2] - b) > tolerance)
        fail_msg("%g %g %g, expected %g %g %g", (double)pixel[0], (double)pixel[1], (double)pixel[2], r, g, b);
}

static void test_middle_grey_is_91(void** state)
{
    (void)state;
    float grey[3] = {0.18f, 0.18f, 0.18f}, named[3] = {0.18f, 0.18f, 0.18f};
    developed(NULL, NULL, 0.0f, grey);
    for (int i = 0; i < 3; i++)
        assert_int_equal(lround(255.0 * grey[i]), 91);
    developed("sRGB", "ACES 1.0 SDR", 0.0f, named);
    assert_memory_equal(grey, named, sizeof grey);
    developed("Rec.1886", NULL, 0.0f, named);
    assert_true(fabsf(named[0] - grey[0]) > 0.01f);
}

static void test_views_do_what_they_say(void** state)
{
    (void)state;
    float pixel[4] = {0.18f, 0.18f, 0.18f, 0.3f};
    ty_error error = {0};
    assert_int_equal(ty_color_develop(color, "sRGB", "Untonemapped", 0.0f, pixel, 1, 4, &error), TY_OK);
    double srgb = 1.055 * pow(0.18, 1 / 2.4) - 0.055;
    assert_pixel(pixel, srgb, srgb, srgb, 1e-4);
    assert_true(pixel[3] == 0.3f); // alpha is left alone
    float red[3] = {1, 0, 0};
    converted("lin_rec709", "ACEScg", red);
    developed("sRGB", "Untonemapped", 0.0f, red);
    assert_pixel(red, 1, 0, 0, 2e-3);
    float bt1886[3] = {0.18f, 0.18f, 0.18f}, gamma = powf(0.18f, 1.0f / 2.4f);
    developed("Rec.1886", "Untonemapped", 0.0f, bt1886);
    assert_pixel(bt1886, gamma, gamma, gamma, 1e-4);
    float raw[3] = {0.25f, -1.0f, 7.0f};
    developed("sRGB", "Raw", 1.0f, raw);
    assert_pixel(raw, 0.5, 0, 1, 1e-6); // a stop brighter, and 0..1
    float odd[3] = {NAN, INFINITY, -INFINITY};
    developed(NULL, NULL, 0.0f, odd);
    for (int i = 0; i < 3; i++)
        assert_true(odd[i] >= 0.0f && odd[i] <= 1.0f);
}

// Matrices of the Academy (S-2014-004) and, for Rec.709, with Bradford adaptation from D65.
static void test_primaries(void** state)
{
    (void)state;
    float ap0[3] = {1, 0, 0};
    converted("ACEScg", "ACES2065-1", ap0);
    assert_pixel(ap0, 0.6954522414, 0.0447945634, -0.0055258826, 1e-5);
    float red[3] = {1, 0, 0}, green[3] = {0, 1, 0}, blue[3] = {0, 0, 1}, white[3] = {1, 1, 1};
    converted("lin_rec709", "ACEScg", red);
    assert_pixel(red, 0.6130974, 0.0701937, 0.0206156, 1e-4);
    converted("lin_rec709", "ACEScg", green);
    assert_pixel(green, 0.3395231, 0.9163540, 0.1095698, 1e-4);
    converted("lin_rec709", "ACEScg", blue);
    assert_pixel(blue, 0.0473795, 0.0134523, 0.8698146, 1e-4);
    converted("lin_rec709", "ACEScg", white);
    assert_pixel(white, 1, 1, 1, 1e-5);
}

static void test_conversions_undo_each_other(void** state)
{
    (void)state;
    static const char* const spaces[] = {"lin_rec709", "ACES2065-1", "srgb_texture", "rec1886_texture", "raw"};
    // The slope of a power is infinite at black.
    static const double tolerance[] = {2e-6, 2e-6, 2e-5, 1e-3, 0};
    for (size_t i = 0; i < sizeof spaces / sizeof *spaces; i++)
        for (int k = 0; k < 50; k++)
        {
            float value[3] = {(float)(k % 7) / 6.0f, (float)(k % 11) / 10.0f, (float)(k % 5) / 4.0f}, pixel[3];
            memcpy(pixel, value, sizeof pixel);
            converted(spaces[i], "ACEScg", pixel);
            converted("ACEScg", spaces[i], pixel);
            assert_pixel(pixel, value[0], value[1], value[2], tolerance[i]);
        }
}

static void test_curves(void** state)
{
    (void)state;
    for (int level = 0; level < 256; level++)
    {
        double encoded = level / 255.0;
        double srgb = encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
        float pixel[3] = {(float)encoded, (float)encoded, (float)encoded};
        converted("srgb_texture", "lin_rec709", pixel);
        assert_pixel(pixel, srgb, srgb, srgb, 1e-5);
        float video[3] = {(float)encoded, (float)encoded, (float)encoded}, gamma = powf((float)encoded, 2.4f);
        converted("rec1886_texture", "lin_rec709", video);
        assert_pixel(video, gamma, gamma, gamma, 1e-5);
    }
    ty_rgb grey = {0.5f, 0.5f, 0.5f};
    assert_int_equal(ty_color_to_acescg(color, "sRGB", &grey, NULL), TY_OK);
    assert_true(fabsf(grey.g - 0.2140411f) < 1e-4f);
}

static void test_raw_is_untouched(void** state)
{
    (void)state;
    float pixel[3] = {-3.0f, 0.123456789f, 1e6f}, same[3];
    memcpy(same, pixel, sizeof pixel);
    converted("raw", "ACEScg", pixel);
    assert_memory_equal(pixel, same, sizeof pixel);
}

static void test_aliases_and_guesses(void** state)
{
    (void)state;
    static const char* const same[][2] = {{"linear sRGB", "lin_rec709"}, {"Linear Rec.709 (sRGB)", "lin_rec709"},
                                          {"sRGB", "srgb_texture"},      {"sRGB - Texture", "srgb_texture"},
                                          {"scene_linear", "ACEScg"},    {"aces_interchange", "ACES2065-1"}};
    for (size_t i = 0; i < sizeof same / sizeof *same; i++)
    {
        float a[3] = {0.1f, 0.4f, 0.7f}, b[3] = {0.1f, 0.4f, 0.7f};
        converted(same[i][0], "ACES2065-1", a);
        converted(same[i][1], "ACES2065-1", b);
        assert_memory_equal(a, b, sizeof a);
    }
    assert_string_equal(ty_color_guess_space(color, true, ""), "lin_rec709");
    assert_string_equal(ty_color_guess_space(color, true, NULL), "lin_rec709");
    assert_string_equal(ty_color_guess_space(color, false, "GammaCorrected2.2"), "srgb_texture");
    assert_string_equal(ty_color_guess_space(color, true, "ACES2065-1"), "ACES2065-1");
}

static void assert_says(const ty_error* error, const char* a, const char* b)
{
    if (!strstr(error->text, a) || !strstr(error->text, b))
        fail_msg("'%s' does not say '%s' and '%s'", error->text, a, b);
}

static void test_unknown_names_list_the_known(void** state)
{
    (void)state;
    float pixel[3] = {0};
    ty_error error = {0};
    assert_int_equal(ty_color_convert(color, "ACEScq", "raw", pixel, 1, 3, &error), TY_BAD_INPUT);
    assert_says(&error, "unknown colour space 'ACEScq'; did you mean 'ACEScg'?", "srgb_texture");
    assert_int_equal(ty_color_develop(color, "sRBG", NULL, 0.0f, pixel, 1, 3, &error), TY_BAD_INPUT);
    assert_says(&error, "unknown display 'sRBG'; did you mean 'sRGB'?", "known: sRGB, Rec.1886");
    assert_int_equal(ty_color_develop(color, NULL, "Untonmapped", 0.0f, pixel, 1, 3, &error), TY_BAD_INPUT);
    assert_says(&error, "unknown view 'Untonmapped'; did you mean 'Untonemapped'?", "Raw");
    assert_int_equal(ty_color_develop(color, NULL, "something else", 0.0f, pixel, 1, 3, &error), TY_BAD_INPUT);
    assert_says(&error, "unknown view 'something else'; known: ACES 1.0 SDR, Untonemapped, Raw", "");
}

static void test_description(void** state)
{
    (void)state;
    char text[200];
    ty_color_describe(color, text, sizeof text);
    assert_string_equal(text, "sRGB: ACES 1.0 SDR, Untonemapped, Raw\nRec.1886: ACES 1.0 SDR, Untonemapped, Raw\n");
    ty_color_describe(color, text, 9);
    assert_string_equal(text, "sRGB: AC");
    ty_color_describe(color, NULL, 0);
}

static void test_precedence(void** state)
{
    (void)state;
    const char* source = NULL;
    setenv("OCIO", "env.ocio", 1);
    assert_string_equal(ty_color_choose("a", "b", &source), "a");
    assert_string_equal(source, "--ocio");
    assert_string_equal(ty_color_choose(NULL, "b", &source), "b");
    assert_string_equal(source, "scene");
    assert_string_equal(ty_color_choose(NULL, NULL, &source), "env.ocio");
    assert_string_equal(source, "$OCIO");
    setenv("OCIO", "", 1);
    assert_null(ty_color_choose(NULL, "", &source));
    assert_string_equal(source, "embedded");
    unsetenv("OCIO");
    assert_null(ty_color_choose(NULL, NULL, &source));
}

// Someone's own configuration, where our names are missing: the working space is its scene_linear.
static const char foreign[] = "ocio_profile_version: 1\n"
                              "roles: {default: linear, scene_linear: linear, color_picking: video, data: nothing}\n"
                              "displays:\n"
                              "  screen:\n"
                              "    - !<View> {name: Film, colorspace: video}\n"
                              "colorspaces:\n"
                              "  - !<ColorSpace> {name: linear, isdata: false}\n"
                              "  - !<ColorSpace> {name: nothing, isdata: true}\n"
                              "  - !<ColorSpace>\n"
                              "    name: video\n"
                              "    isdata: false\n"
                              "    to_reference: !<ExponentTransform> {value: [2, 2, 2, 1]}\n";

static void test_a_foreign_configuration(void** state)
{
    (void)state;
    ty_color* other = NULL;
    ty_error error = {0};
    assert_int_equal(ty_file_write(in_folder("a.ocio"), foreign, sizeof foreign - 1, NULL), TY_OK);
    if (ty_color_create(in_folder("a.ocio"), &other, &error) != TY_OK)
        fail_msg("%s", error.text);
    float pixel[3] = {0.25f, 0.5f, 1.0f};
    assert_int_equal(ty_color_develop(other, NULL, NULL, 0.0f, pixel, 1, 3, &error), TY_OK);
    assert_pixel(pixel, 0.5, sqrt(0.5), 1, 1e-5);
    ty_rgb value = {0.5f, 0.5f, 0.5f};
    assert_int_equal(ty_color_to_acescg(other, "srgb_texture", &value, &error), TY_OK);
    assert_true(fabsf(value.r - 0.25f) < 1e-6f);
    assert_string_equal(ty_color_guess_space(other, false, "sRGB"), "color_picking");
    ty_color_destroy(other);
    assert_int_equal(ty_color_create(in_folder("none.ocio"), &other, &error), TY_BAD_FILE);
    assert_null(other);
    assert_int_equal(ty_file_write(in_folder("a.ocio"), "roles: [", 8, NULL), TY_OK);
    assert_int_equal(ty_color_create(in_folder("a.ocio"), &other, &error), TY_BAD_FILE);
    assert_null(other);
}

static void make_noise(void* context)
{
    float pixel[3] = {1, 2, 3};
    ty_color* other = NULL;
    if (ty_color_create("a_config_that_is_not_there", &other, NULL) == TY_OK ||
        ty_color_create(context, &other, NULL) != TY_OK ||
        ty_color_develop(other, NULL, NULL, 0.0f, pixel, 1, 3, NULL) != TY_OK)
        _exit(1);
    ty_color_destroy(other);
}

static void test_nothing_is_printed(void** state)
{
    (void)state;
    char text[sizeof foreign + 40]; // an unknown key is worth a warning to the library
    int size = snprintf(text, sizeof text, "%sunknown_key: 1\n", foreign);
    assert_int_equal(ty_file_write(in_folder("a.ocio"), text, (size_t)size, NULL), TY_OK);
    process_end end = process_run(make_noise, (void*)in_folder("a.ocio"));
    assert_int_equal(end.exit_status, 0);
    assert_string_equal(end.text, "");
}

static void develop_range(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    float* pixels = context;
    for (int64_t i = begin; i < end; i++)
    {
        const char* space = i % 3 == 0 ? "srgb_texture" : i % 3 == 1 ? "lin_rec709" : "ACES2065-1";
        if (ty_color_convert(color, space, "ACEScg", pixels + i * 3, 1, 3, NULL) != TY_OK ||
            ty_color_develop(color, NULL, i % 2 ? "Untonemapped" : NULL, 0.0f, pixels + i * 3, 1, 3, NULL) != TY_OK)
            pixels[i * 3] = -1.0f;
    }
}

static void test_threads_share_a_configuration(void** state)
{
    (void)state;
    enum
    {
        COUNT = 600
    };
    static float one[COUNT * 3], many[COUNT * 3];
    for (int i = 0; i < COUNT * 3; i++)
        one[i] = many[i] = (float)(i % 97) / 96.0f;
    ty_workers* workers = NULL;
    assert_int_equal(ty_workers_create(4, &workers, NULL), TY_OK);
    assert_true(ty_parallel_for(workers, COUNT, 1, develop_range, many));
    ty_workers_destroy(workers);
    develop_range(one, 0, COUNT, 0);
    assert_memory_equal(one, many, sizeof one);
    assert_true(one[0] >= 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads_share_a_configuration),
        cmocka_unit_test(test_middle_grey_is_91),
        cmocka_unit_test(test_views_do_what_they_say),
        cmocka_unit_test(test_primaries),
        cmocka_unit_test(test_conversions_undo_each_other),
        cmocka_unit_test(test_curves),
        cmocka_unit_test(test_raw_is_untouched),
        cmocka_unit_test(test_aliases_and_guesses),
        cmocka_unit_test(test_unknown_names_list_the_known),
        cmocka_unit_test(test_description),
        cmocka_unit_test(test_precedence),
        cmocka_unit_test_setup_teardown(test_a_foreign_configuration, folder_setup, folder_teardown),
        cmocka_unit_test_setup_teardown(test_nothing_is_printed, folder_setup, folder_teardown),
    };
    return cmocka_run_group_tests(tests, load_embedded, unload);
}
