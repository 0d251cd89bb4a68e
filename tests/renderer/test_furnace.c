// SPDX-License-Identifier: Apache-2.0
// White furnace through the whole program: what keeps energy cannot be told from the light around it.
#include "whole_program.h"
#include <tsuya/shading/cdrf.h>

static const char furnace[] = "tsuya: 1\n"
                              "film: { size: [24, 24], filter: box, filter_width: 1, half: false }\n"
                              "render: { samples: %d, max_depth: 256, roulette_depth: 256, seed: 5 }\n"
                              "camera: { position: [0, 0, 0.4], look_at: [0, 0, 0], vfov: 10 }\n"
                              "assets: { ball: { shape: sphere, radius: 0.03, divisions: 96 }, floor: { shape: plane, "
                              "size: [2, 0, 2] } }\n"
                              "materials: { m: { %s }, white: { model: surface, base_color: 1, "
                              "specular_weight: 0 } }\n"
                              "objects: [ { mesh: ball, material: m }%s ]\n"
                              "lights: [ { type: environment, radiance: 0.5 } ]\n";

// Mean over the disc of the ball, relative to the light. more: other objects, with a comma before.
static double gain_among(const char* material, const char* more, int samples)
{
    char text[2048];
    snprintf(text, sizeof text, furnace, samples, material, more);
    ty_exr* exr = render_text(text);
    assert_true(pixel(exr, "A", 12, 12) > 0.0f); // sheets let the sky through
    mean_error centre = mean_over(exr, 6, 6, 17, 17);
    ty_exr_destroy(exr);
    return centre.mean / 0.5;
}

static double gain(const char* material, int samples)
{
    return gain_among(material, "", samples);
}

static void check_vanishes(const char* material, int samples)
{
    double value = gain(material, samples);
    print_message("%-100s %.5f\n", material, value);
    assert_true(fabs(value - 1.0) < 0.005);
}

static void white_things_vanish(void** state)
{
    (void)state;
    check_vanishes("model: surface, base_color: 1, specular_weight: 0", 16);
    check_vanishes("model: surface, base_color: 1, specular_weight: 1, specular_roughness: 0.3", 256);
    check_vanishes("model: surface, transmission_weight: 1, specular_roughness: 0, specular_ior: 1.5", 64);
    check_vanishes("model: surface, base_metalness: 1, base_color: 1, specular_roughness: 0", 16);
    check_vanishes("model: surface, thin_walled: true, transmission_weight: 1, specular_roughness: 0", 64);
    check_vanishes("model: surface, thin_walled: true, transmission_weight: 1, specular_roughness: 0.4", 256);
    check_vanishes("model: surface, thin_walled: true, subsurface_weight: 1, subsurface_color: 1", 256);
    check_vanishes("model: surface, base_color: 1, opacity: 0.4", 256);
    check_vanishes("model: cdrf, color: 1, specular_weight: 0, mean_free_path: 7.5, evaluate: depth", 64);
    check_vanishes("model: cdrf, color: 1, specular_weight: 0, mean_free_path: 30, evaluate: depth", 64);
    check_vanishes("model: cdrf, color: 1, specular_weight: 0, mean_free_path: 7.5, evaluate: probe", 64);
    check_vanishes("model: cdrf, color: 1, specular_weight: 0, mean_free_path: 7.5, evaluate: probe, kernel: gaussian",
                   64);
    check_vanishes("model: cdrf, color: 1, specular_weight: 0, mean_free_path: 7.5, evaluate: local", 1024);
    check_vanishes("model: cdrf, color: 1, specular_weight: 0, mean_free_path: 7.5, evaluate: local, kernel: gaussian",
                   1024);
    check_vanishes("model: cdrf, color: 1, specular_weight: 1, specular_roughness: 0.2, mean_free_path: 7.5", 512);
}

// What a coat reflects of a floor is lit like all else: only what its ray met straight away has been counted before.
static void coats_reflect_a_lit_floor(void** state)
{
    (void)state;
    double value = gain_among("model: cdrf, color: 1, specular_weight: 1, specular_roughness: 0.2, mean_free_path: 7.5",
                              ", { mesh: floor, material: white, translate: [0, -0.031, 0] }", 512);
    print_message("over a white floor: %.5f\n", value);
    assert_true(fabs(value - 1.0) < 0.005);
}

// The negative control: the Gaussian as published gains I(sigma) / pi, and the test above can tell.
static void published_kernel_gains(void** state)
{
    (void)state;
    float sigma = ty_cdrf_gaussian_sigma(7.5f / 30.0f, 0);
    double expected = (double)ty_cdrf_gaussian_integral(sigma) / 3.14159265358979;
    double local = gain("model: cdrf, color: 1, specular_weight: 0, mean_free_path: 7.5, evaluate: local, kernel: "
                        "gaussian_published",
                        1024);
    double probe = gain("model: cdrf, color: 1, specular_weight: 0, mean_free_path: 7.5, evaluate: probe, kernel: "
                        "gaussian_published",
                        64);
    print_message("published: local %.4f probe %.4f, expected %.4f\n", local, probe, expected);
    assert_true(expected > 1.05);
    assert_true(fabs(local - expected) < 0.005 && fabs(probe - expected) < 0.005);
}

// Facets that are met once only would lose up to 65 %.
static void rough_things_vanish(void** state)
{
    (void)state;
    static const double roughness[] = {0.1, 0.3, 0.5, 0.8, 1.0};
    for (int i = 0; i < 5; i++)
    {
        char metal[128], glass[128];
        snprintf(metal, sizeof metal, "model: surface, base_metalness: 1, base_color: 1, specular_roughness: %g",
                 roughness[i]);
        snprintf(glass, sizeof glass,
                 "model: surface, transmission_weight: 1, specular_ior: 1.5, specular_roughness: %g", roughness[i]);
        double values[2] = {gain(metal, 256), gain(glass, 2048)};
        print_message("roughness %.2f: metal %.4f, dielectric %.4f\n", roughness[i], values[0], values[1]);
        assert_true(fabs(values[0] - 1.0) < 0.003);
        assert_true(fabs(values[1] - 1.0) < 0.003);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_things_vanish),
        cmocka_unit_test(coats_reflect_a_lit_floor),
        cmocka_unit_test(published_kernel_gains),
        cmocka_unit_test(rough_things_vanish),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
