// SPDX-License-Identifier: Apache-2.0
// The Turing filter: colours keep their means, masks and lines hold.
#include "filter_frames.h"
#include <tsuya/image/color.h>

// --- colours ---

static float even_color(int x, int y, int c)
{
    static const float color[3] = {0.8f, 0.5f, 0.3f};
    (void)x;
    (void)y;
    return color[c];
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(means_of_colours_are_kept),
        cmocka_unit_test(channels_of_a_grey_picture_are_grey),
        cmocka_unit_test(masks_hold_their_values),
        cmocka_unit_test(contours_are_lines_of_fixed_values),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
