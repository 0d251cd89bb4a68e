// SPDX-License-Identifier: Apache-2.0
// Textures averaged over ray cones: less noise for the same mean, in the camera's view, in mirrors and through glass.
#include "whole_program.h"
#include <math.h>
#include <stdlib.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/image.h>

#define SIDE 256

// Squares of 8 texels.
static void write_checker(void)
{
    static float pixels[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++)
        pixels[i] = (float)(((i % SIDE) / 8 + (i / SIDE) / 8) & 1);
    ty_image image = {.width = SIDE, .height = SIDE, .channels = 1, .pixels = pixels};
    assert_int_equal(ty_image_write("checker.png", &image, 8, NULL), TY_OK);
}

#define SCENE(width, height, depth, camera, assets, materials, objects)                                                \
    "tsuya: 1\n"                                                                                                       \
    "film: { size: [" #width ", " #height "], half: false, filter: box, filter_width: 1 }\n"                           \
    "render: { samples: %d, max_depth: " #depth ", texture_filter: %s }\n"                                             \
    "camera: " camera "\n"                                                                                             \
    "assets:\n  plane: { shape: plane, size: [10, 1, 10] }\n" assets                                                   \
    "materials:\n  checker: { model: surface, base_color: 0, specular_weight: 0, emission_luminance: 1,\n"             \
    "    emission_color: { texture: ./checker.png, uv: { scale: 6 } } }\n" materials                                   \
    "objects:\n  - { mesh: plane, material: checker }\n" objects

static ty_exr* render(const char* scene, int samples, bool filter)
{
    char text[2000];
    snprintf(text, sizeof text, scene, samples, filter ? "true" : "false");
    return render_text(text);
}

static double difference(const ty_exr* a, const ty_exr* b, double* bias)
{
    double sum = 0.0;
    int width = ty_exr_width(a), height = ty_exr_height(a);
    *bias = 0.0;
    for (int i = 0; i < width * height; i++)
    {
        double d = (double)pixel(a, "G", i % width, i / width) - (double)pixel(b, "G", i % width, i / width);
        sum += d * d;
        *bias += d / (width * height);
    }
    return sqrt(sum / (width * height));
}

typedef struct comparison
{
    double filtered, unfiltered, many; // rmse of few samples with and without filter, of four times as many without
    double bias;                       // of the filtered ones
} comparison;

static comparison compare(const char* name, const char* scene, int few, int reference_samples)
{
    comparison c;
    double ignored;
    write_checker();
    ty_exr* reference = render(scene, reference_samples, false);
    ty_exr *filtered = render(scene, few, true), *unfiltered = render(scene, few, false);
    ty_exr* many = render(scene, 4 * few, false);
    c.filtered = difference(filtered, reference, &c.bias);
    c.unfiltered = difference(unfiltered, reference, &ignored);
    c.many = difference(many, reference, &ignored);
    print_message("  %s: %d samples: rmse %.5f filtered, %.5f not; %d samples not: %.5f; bias %.5f\n", name, few,
                  c.filtered, c.unfiltered, 4 * few, c.many, c.bias);
    ty_exr_destroy(reference);
    ty_exr_destroy(filtered);
    ty_exr_destroy(unfiltered);
    ty_exr_destroy(many);
    return c;
}

static void checker_at_grazing_angle(void** state)
{
    (void)state;
    comparison c = compare(
        "grazing", SCENE(64, 40, 1, "{ position: [0, .5, 9], look_at: [.3, 0, 5], vfov: 30 }", "", "", ""), 16, 4096);
    assert_true(c.filtered <= 1.2 * c.many);
    assert_true(c.filtered < 0.7 * c.unfiltered);
    assert_true(fabs(c.bias) < 2e-3);
}

#define BALL(look) "{ position: [0, 2, 6], look_at: [0, 1, 0], vfov: " look " }"

// The ball turns the mirrored floor's squares into ever smaller ones towards its edge.
static void checker_in_a_curved_mirror(void** state)
{
    (void)state;
    comparison c =
        compare("mirror",
                SCENE(40, 40, 2, BALL("19"), "  ball: { shape: sphere, radius: 1, divisions: 128 }\n",
                      "  mirror: { model: surface, base_metalness: 1, base_color: 1, specular_roughness: 0 }\n",
                      "  - { mesh: ball, material: mirror, translate: [0, 1, 0] }\n"),
                16, 512);
    assert_true(c.filtered <= 1.3 * c.many);
    assert_true(fabs(c.bias) < 4e-3);
}

// Seen through a wall of glass without absorption, and on a matt wall: the floor's light is the same on average.
static void checker_through_glass_and_on_a_wall(void** state)
{
    (void)state;
    comparison c = compare("glass",
                           SCENE(40, 40, 4, BALL("19"), "  ball: { shape: sphere, radius: 1, divisions: 128 }\n",
                                 "  glass: { model: surface, transmission_weight: 1, specular_roughness: 0 }\n",
                                 "  - { mesh: ball, material: glass, translate: [0, 1, 0] }\n"),
                           16, 512);
    assert_true(c.filtered < c.unfiltered);
    assert_true(fabs(c.bias) < 4e-3);
    c = compare("wall",
                SCENE(24, 24, 2, BALL("19"), "  wall: { shape: box, size: [1, 1, .1] }\n",
                      "  matt: { model: surface, base_color: .8, specular_weight: 0 }\n",
                      "  - { mesh: wall, material: matt, translate: [0, 1, 0] }\n"),
                16, 512);
    assert_true(c.filtered < c.unfiltered);
    assert_true(fabs(c.bias) < 4e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(checker_at_grazing_angle),
        cmocka_unit_test(checker_in_a_curved_mirror),
        cmocka_unit_test(checker_through_glass_and_on_a_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
