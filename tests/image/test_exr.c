// SPDX-License-Identifier: Apache-2.0
// EXR files: what is written comes back bit for bit, the same image gives the same bytes, every scan-line compression.
#include "base/cmocka_all.h"
#include "image_folder.h"
#include <math.h>
#include <tsuya/base/file.h>
#include <tsuya/image/exr.h>
#include <tsuya/image/half.h>

static const int crop_window[4] = {-3, 5, 33, 45}, whole_window[4] = {-10, 0, 99, 79};

static char* long_text(size_t size)
{
    char* text = TY_ALLOC(char, size + 1);
    for (size_t i = 0; i < size; i++)
        text[i] = i % 61 == 60 ? '\n' : (char)(' ' + i * 7 % 90);
    return text;
}

// All pixel types, out of order, over several blocks of lines; all attribute types.
static ty_exr* sample_image(void)
{
    ty_exr* exr = ty_exr_create(crop_window, whole_window);
    float* depth = ty_exr_add_channel(exr, "Z", TY_EXR_FLOAT);
    float* red = ty_exr_add_channel(exr, "R", TY_EXR_HALF);
    uint32_t* id = ty_exr_add_channel(exr, "id.instance_of_a_name_longer_than_31_bytes", TY_EXR_UINT);
    float* green = ty_exr_add_channel(exr, "G", TY_EXR_HALF);
    uint32_t random = 7;
    for (int i = 0; i < 37 * 41; i++)
    {
        random = random * 1664525u + 1013904223u;
        id[i] = random;
        uint32_t bits = (random & 0x807fffffu) | 0x3f000000u; // any sign, +-0.5 to +-1
        memcpy(&depth[i], &bits, sizeof bits);
        red[i] = ty_half_to_float((uint16_t)(random >> 17));
        green[i] = (float)i * 0.125f;
    }
    depth[0] = INFINITY;
    depth[1] = -0.0f;
    depth[2] = 1e-42f;
    char* recipe = long_text(200000);
    ty_exr_add_string(exr, "tsuya/recipe", recipe);
    ty_free(recipe);
    ty_exr_add_string(exr, "tsuya/empty", "");
    ty_exr_add_float(exr, "tsuya/a_name_that_is_longer_than_31_bytes", -0.1f);
    ty_exr_add_int(exr, "tsuya/seed", -2147483647);
    float matrix[16], primaries[8] = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    for (int i = 0; i < 16; i++)
        matrix[i] = (float)i / 3.0f;
    ty_exr_add_matrix(exr, "worldToCamera", matrix);
    ty_exr_add_chromaticities(exr, primaries);
    ty_exr_add_rational(exr, "framesPerSecond", 24000, 1001u);
    return exr;
}

static void assert_same_attributes(const ty_exr* a, const ty_exr* b)
{
    assert_int_equal(a->attribute_count, b->attribute_count);
    for (int i = 0; i < a->attribute_count; i++)
    {
        const ty_exr_attribute *x = &a->attributes[i], *y = ty_exr_find_attribute(b, x->name);
        assert_non_null(y);
        assert_int_equal(x->type, y->type);
        assert_memory_equal(x->value, y->value, sizeof x->value);
        assert_memory_equal(x->integer, y->integer, sizeof x->integer);
        if (x->type == TY_EXR_STRING)
            assert_string_equal(x->text, y->text);
    }
}

static void assert_same(const ty_exr* a, const ty_exr* b)
{
    assert_memory_equal(a->data_window, b->data_window, sizeof a->data_window);
    assert_memory_equal(a->display_window, b->display_window, sizeof a->display_window);
    assert_int_equal(a->channel_count, b->channel_count);
    for (int i = 0; i < a->channel_count; i++)
    {
        const ty_exr_channel *x = &a->channels[i], *y = ty_exr_find_channel(b, x->name);
        assert_non_null(y);
        assert_int_equal(x->type, y->type);
        size_t count = (size_t)ty_exr_width(a) * (size_t)ty_exr_height(a);
        for (size_t k = 0; k < count; k++)
            if (memcmp((const float*)x->pixels + k, (const float*)y->pixels + k, 4) != 0)
                assert_true(isnan(((const float*)x->pixels)[k]) && isnan(((const float*)y->pixels)[k]));
    }
    assert_same_attributes(a, b);
}

static void write_ok(const char* path, const ty_exr* exr)
{
    ty_error error = {0};
    if (ty_exr_write(path, exr, &error) != TY_OK)
        fail_msg("%s", error.text);
}

static ty_exr* read_ok(const char* path)
{
    ty_error error = {0};
    ty_exr* exr = NULL;
    if (ty_exr_read(path, &exr, &error) != TY_OK)
        fail_msg("%s: %s", path, error.text);
    return exr;
}

static void test_everything_comes_back(void** state)
{
    (void)state;
    ty_exr* exr = sample_image();
    write_ok(in_folder("a.exr"), exr);
    ty_exr* back = read_ok(in_folder("a.exr"));
    assert_same(exr, back);
    for (int i = 1; i < back->channel_count; i++)
        assert_true(strcmp(back->channels[i - 1].name, back->channels[i].name) < 0);
    assert_int_equal(folder_count(0), 1); // no temporary
    ty_exr_destroy(back);
    ty_exr_destroy(exr);
}

static void test_equal_images_give_equal_bytes(void** state)
{
    (void)state;
    for (int i = 0; i < 2; i++)
    {
        ty_exr* exr = sample_image();
        write_ok(in_folder(i ? "b.exr" : "a.exr"), exr);
        ty_exr_destroy(exr);
    }
    ty_bytes a, b;
    assert_int_equal(ty_file_read(in_folder("a.exr"), 1 << 30, &a, NULL), TY_OK);
    assert_int_equal(ty_file_read(in_folder("b.exr"), 1 << 30, &b, NULL), TY_OK);
    assert_int_equal(a.size, b.size);
    assert_memory_equal(a.data, b.data, a.size);
    ty_bytes_term(&a);
    ty_bytes_term(&b);
}

static void test_halves_are_rounded_and_saturated_in_the_file(void** state)
{
    (void)state;
    const int window[4] = {0, 0, 3, 0};
    ty_exr* exr = ty_exr_create(window, window);
    float* y = ty_exr_add_channel(exr, "Y", TY_EXR_HALF);
    y[0] = 1.0f + 0x1p-11f; // the middle between 1 and its neighbour: to even
    y[1] = 1.0f + 0x3p-11f;
    y[2] = 1e6f;
    y[3] = -INFINITY;
    write_ok(in_folder("a.exr"), exr);
    ty_exr* back = read_ok(in_folder("a.exr"));
    const float* pixels = back->channels[0].pixels;
    assert_true(pixels[0] == 1.0f);
    assert_true(pixels[1] == 1.0f + 0x4p-11f);
    assert_true(pixels[2] == 65504.0f);
    assert_true(pixels[3] == -INFINITY);
    ty_exr_destroy(back);
    ty_exr_destroy(exr);
}

static void test_setting_an_attribute_again_replaces_it(void** state)
{
    (void)state;
    const int window[4] = {0, 0, 0, 0};
    ty_exr* exr = ty_exr_create(window, window);
    ty_exr_add_string(exr, "a", "one");
    ty_exr_add_string(exr, "a", ty_exr_find_attribute(exr, "a")->text);
    assert_string_equal(ty_exr_find_attribute(exr, "a")->text, "one");
    ty_exr_add_int(exr, "a", 5);
    assert_int_equal(exr->attribute_count, 1);
    assert_int_equal(ty_exr_find_attribute(exr, "a")->integer[0], 5);
    assert_null(ty_exr_find_attribute(exr, "b"));
    assert_null(ty_exr_find_channel(exr, "R"));
    ty_exr_destroy(exr);
    ty_exr_destroy(NULL);
}

// What another writer made: 24 x h, half, R G B A with R = (x + y / 2) / 16 and G, B two and three times as much.
static void test_other_compressions_are_read(void** state)
{
    (void)state;
    static const struct
    {
        const char* name;
        float tolerance; // relative
    } files[] = {{"none.exr", 0},  {"rle.exr", 0},     {"zips.exr", 0},    {"piz.exr", 0},
                 {"pxr24.exr", 0}, {"b44.exr", 0.07f}, {"b44a.exr", 0.07f}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
    {
        ty_exr* exr = read_ok(fixture(files[i].name));
        assert_int_equal(exr->channel_count, 4);
        assert_int_equal(ty_exr_width(exr), 24);
        const float* red = ty_exr_find_channel(exr, "R")->pixels;
        const float* blue = ty_exr_find_channel(exr, "B")->pixels;
        for (int y = 0; y < ty_exr_height(exr); y++)
            for (int x = 0; x < 24; x++)
            {
                float expected = ((float)x + 0.5f * (float)y) / 16.0f, r = red[y * 24 + x], b = blue[y * 24 + x];
                if (!(fabsf(r - expected) <= files[i].tolerance * (expected + 0.5f)))
                    fail_msg("%s at %d, %d: %g, expected %g", files[i].name, x, y, (double)r, (double)expected);
                float rounded = ty_half_to_float(ty_half_from_float(3.0f * expected));
                assert_true(fabsf(b - rounded) <= files[i].tolerance * 3.0f * (expected + 0.5f));
            }
        ty_exr_destroy(exr);
    }
}

// Attributes that the format makes itself do not appear, so that a read image can be written again.
static void test_a_read_image_can_be_written_again(void** state)
{
    (void)state;
    ty_exr* exr = read_ok(fixture("zips.exr"));
    assert_null(ty_exr_find_attribute(exr, "pixelAspectRatio"));
    assert_non_null(ty_exr_find_attribute(exr, "chromaticities"));
    write_ok(in_folder("a.exr"), exr);
    ty_exr* back = read_ok(in_folder("a.exr"));
    assert_same(exr, back);
    ty_exr_destroy(exr);
    ty_exr_destroy(back);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, folder_setup, folder_teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_everything_comes_back),
        TEST(test_equal_images_give_equal_bytes),
        TEST(test_halves_are_rounded_and_saturated_in_the_file),
        TEST(test_setting_an_attribute_again_replaces_it),
        TEST(test_other_compressions_are_read),
        TEST(test_a_read_image_can_be_written_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
