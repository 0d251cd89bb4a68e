// SPDX-License-Identifier: Apache-2.0
// Scattering matter within bodies through the whole program: white stays white, spheres keep what is known of them.
#include "whole_program.h"
#include <math.h>

#define PI 3.14159265358979

// A ball of a radius against a white sky, the film as wide as 1.1 diameters.
#define BALL                                                                                                           \
    "tsuya: 1\n"                                                                                                       \
    "film: { size: [16, 16], filter: box, filter_width: 1, half: false }\n"                                            \
    "camera: { position: [0, 0, 1], look_at: [0, 0, 0], projection: orthographic, ortho_height: %g }\n"                \
    "render: { samples: %d, max_depth: 1000, roulette_depth: 1000, seed: 3 }\n"                                        \
    "assets: { ball: { shape: sphere, radius: %g, divisions: 160 } }\n"                                                \
    "lights: [ { type: environment, radiance: 1 } ]\n"                                                                 \
    "materials: { m: { %s } }\n"                                                                                       \
    "objects: [ { mesh: ball, material: m } ]\n"

// Light that a ball under a white sky sends back, over what it would if it were white, by channel.
static void albedo(const char* material, double radius, int samples, double out[3])
{
    static const char* const channel[3] = {"R", "G", "B"};
    char text[2048];
    snprintf(text, sizeof text, BALL, 2.2 * radius, samples, radius, material);
    ty_exr* exr = render_text(text);
    for (int c = 0; c < 3; c++)
    {
        double sum = 0.0;
        for (int i = 0; i < 256; i++)
            sum += (double)pixel(exr, channel[c], i % 16, i / 16);
        out[c] = 1.0 - (1.0 - sum / 256.0) / (PI / (2.2 * 2.2));
    }
    ty_exr_destroy(exr);
}

static void near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.5f is not %.5f +- %g", value, expected, tolerance);
}

static void white_stays_white(void** state)
{
    (void)state;
    static const char* const materials[] = {
        "model: walk, color: 1, mean_free_path: 0.25",
        "model: walk, color: 1, mean_free_path: 0.25, boundary: dielectric, specular_roughness: 0",
        "model: walk, color: 1, mean_free_path: 0.3, boundary: dielectric, specular_roughness: 0.4, anisotropy: 0.6",
        "model: walk, scattering: [2, 4, 8], boundary: dielectric, specular_ior: 1.5",
        "model: surface, transmission_weight: 1, transmission_depth: 0.001, transmission_scatter: 4",
    };
    for (int i = 0; i < 5; i++)
    {
        double a[3];
        albedo(materials[i], 0.001, 64, a);
        // Where channels differ their sum has the least noise.
        near((a[0] + a[1] + a[2]) / 3.0, 1.0, 0.003);
        for (int c = 0; c < 3; c++)
            near(a[c], 1.0, i == 3 ? 0.03 : 0.003);
    }
}

// Balls of R = 4 mean free paths whose surface does nothing: three ways to say the same, and three albedos at once.
static void balls_keep_what_is_known(void** state)
{
    (void)state;
    static const char* const materials[] = {
        "model: walk, specular_weight: 0, scattering: [3.92, 3.6, 4], absorption: [0.08, 0.4, 0]",
        "model: walk, specular_ior: 1, boundary: dielectric, scattering: [3.92, 3.6, 4], absorption: [0.08, 0.4, 0]",
        ("model: surface, transmission_weight: 1, specular_ior: 1, specular_roughness: 0, transmission_depth: 0.00025, "
         "transmission_color: 0.36787944, transmission_scatter: [0.98, 0.9, 1]"),
    };
    for (int i = 0; i < 3; i++)
    {
        double a[3];
        albedo(materials[i], 0.001, 1024, a);
        near(a[0], 0.905, 0.005);
        near(a[1], 0.659, 0.005);
        near(a[2], 1.0, 0.001);
    }
}

// Of the light that enters a thick body of colour C the share C leaves, its inner reflection included.
static void colour_counts_inner_reflection(void** state)
{
    (void)state;
    double a[3];
    albedo("model: walk, boundary: dielectric, specular_ior: 1.38, specular_roughness: 0, subsurface_color: [0.6, 0.9, "
           "0.2], subsurface_radius: 0.3",
           0.1, 512, a);
    const double outer = 0.074, colors[3] = {0.6, 0.9, 0.2};
    for (int c = 0; c < 3; c++)
        near(a[c], 1.0 - (1.0 - outer) * (1.0 - colors[c]), 0.008);
}

static double mean_of(const char* text)
{
    ty_exr* exr = render_text(text);
    double mean = mean_over(exr, 0, 0, ty_exr_width(exr) - 1, ty_exr_height(exr) - 1).mean;
    ty_exr_destroy(exr);
    return mean;
}

// Bodies that reach into each other lose nothing, with the camera outside or within.
static void overlapping_and_from_within(void** state)
{
    (void)state;
    static const char* const boundary[2] = {"diffuse", "dielectric"};
    for (int i = 0; i < 4; i++)
    {
        char text[2048];
        snprintf(
            text, sizeof text,
            "tsuya: 1\n"
            "film: { size: [12, 12], filter: box, filter_width: 1, half: false }\n"
            "camera: { position: [0.0003, 0, %g], look_at: [0, 0, 0], vfov: 12 }\n"
            "render: { samples: 128, max_depth: 1000, roulette_depth: 1000, seed: 5 }\n"
            "assets: { ball: { shape: sphere, radius: 0.001, divisions: 96 } }\n"
            "lights: [ { type: environment, radiance: 1 } ]\n"
            "materials: { m: { model: walk, color: 1, mean_free_path: 0.4, specular_roughness: 0.2, boundary: %s } }\n"
            "objects: [ { mesh: ball, material: m, translate: [-0.0005, 0, 0] }, { mesh: ball, material: m, "
            "translate: [0.0006, 0.0002, 0] } ]\n",
            i < 2 ? 0.01 : 0.0003, boundary[i % 2]);
        near(mean_of(text), 1.0, 0.004);
    }
}

// Matter that scatters nothing dims by Beer's law as well: nothing comes through twenty lengths of it, and what is left
// is the reflection of the boundary.
static void pure_absorption_is_dark(void** state)
{
    (void)state;
    double clear[3], dark[3], mist[3];
    albedo("model: walk, boundary: dielectric, specular_roughness: 0, scattering: 0, absorption: 0", 0.001, 64, clear);
    albedo("model: walk, boundary: dielectric, specular_roughness: 0, scattering: 0, absorption: 100", 0.001, 64, dark);
    albedo("model: walk, boundary: dielectric, specular_roughness: 0, scattering: 1e-4, absorption: 100", 0.001, 64,
           mist);
    near(clear[0], 1.0, 0.003);
    assert_true(dark[0] < 0.12);
    near(dark[0], mist[0], 1e-4);
}

// Under a lamp a rough boundary shows the same whether the lamp is sampled or only met.
static void lamps_are_met_or_sampled(void** state)
{
    (void)state;
    double mean[2];
    for (int i = 0; i < 2; i++)
    {
        char text[2048];
        snprintf(text, sizeof text,
                 "tsuya: 1\n"
                 "film: { size: [12, 12], filter: box, filter_width: 1, half: false }\n"
                 "camera: { position: [0, 0, 0.01], look_at: [0, 0, 0], vfov: 9 }\n"
                 "render: { samples: 1024, max_depth: 1000, roulette_depth: 1000, seed: 5, light_sampling: %s }\n"
                 "assets: { ball: { shape: sphere, radius: 0.001, divisions: 96 } }\n"
                 "lights: [ { type: rectangle, center: [0.004, 0.005, 0.003], target: [0, 0, 0], size: [0.006, 0.006], "
                 "radiance: 5 } ]\n"
                 "materials: { m: { model: walk, color: 0.9, mean_free_path: 0.3, specular_roughness: 0.3, boundary: "
                 "dielectric } }\n"
                 "objects: [ { mesh: ball, material: m } ]\n",
                 i ? "bsdf" : "mis");
        mean[i] = mean_of(text);
    }
    assert_true(mean[0] > 0.1);
    near(mean[1] / mean[0], 1.0, 0.015);
}

// What a floor gets back from a ball close above it, without indirect walks: as from a matte one of the same colour.
static void indirect_walks_can_be_left_out(void** state)
{
    (void)state;
    static const char scene[] =
        "tsuya: 1\n"
        "film: { size: [16, 16], filter: box, filter_width: 1, half: false }\n"
        "camera: { position: [0, 0.4, 0.01], look_at: [0, 0, 0], projection: orthographic, ortho_height: 0.8 }\n"
        "render: { samples: 256, max_depth: 40, seed: 3, indirect_subsurface: %s }\n"
        "assets: { ball: { shape: sphere, radius: 1 }, floor: { shape: plane, size: [40, 0, 40] } }\n"
        "lights: [ { type: environment, radiance: 1 } ]\n"
        "materials: { m: { %s }, white: { model: surface, base_color: 1, specular_weight: 0 } }\n"
        "objects: [ { mesh: ball, material: m, translate: [0, 1.5, 0] }, { mesh: floor, material: white } ]\n";
    static const char walk[] = "model: walk, subsurface_color: 0.5, subsurface_radius: 1000, specular_weight: 0";
    static const char* const cases[3][2] = {
        {"true", "model: surface, base_color: 0.5, specular_weight: 0"}, {"false", walk}, {"true", walk}};
    double mean[3];
    for (int i = 0; i < 3; i++)
    {
        char text[2048];
        snprintf(text, sizeof text, scene, cases[i][0], cases[i][1]);
        mean[i] = mean_of(text);
    }
    print_message("matte %.4f, no indirect walks %.4f, all walks %.4f\n", mean[0], mean[1], mean[2]);
    near(mean[1] / mean[0], 1.0, 0.01);
    assert_true(mean[2] > 1.2 * mean[0]); // so thin a ball absorbs little
}

// Mean free paths of a few roundings of the coordinates: the surface is as bright as with longer ones, wherever it is,
// and walks that met their bound keep their light.
static void short_paths_are_no_darker(void** state)
{
    (void)state;
    static const char* const colors[2] = {"subsurface_color: 0.8, subsurface_radius: 0.006",
                                          "color: 1, mean_free_path: 0.001"};
    for (int i = 0; i < 4; i++)
    {
        char text[2048];
        double height = i < 2 ? 0.0 : 2.0;
        snprintf(text, sizeof text,
                 "tsuya: 1\n"
                 "film: { size: [16, 16], filter: box, filter_width: 1, half: false }\n"
                 "camera: { position: [0, %g, 1], look_at: [0, %g, 0], projection: orthographic, ortho_height: 0.0022 "
                 "}\n"
                 "render: { samples: 64, max_depth: 1000, roulette_depth: 1000, seed: 3 }\n"
                 "assets: { ball: { shape: sphere, radius: 0.001, divisions: 160 } }\n"
                 "lights: [ { type: environment, radiance: 1 } ]\n"
                 "materials: { m: { model: walk, boundary: %s, %s, specular_roughness: 0 } }\n"
                 "objects: [ { mesh: ball, material: m, translate: [0, %g, 0] } ]\n",
                 height, height, i == 1 ? "diffuse" : "dielectric", colors[i % 2], height);
        double kept = 1.0 - (1.0 - mean_of(text)) / (PI / (2.2 * 2.2));
        near(kept, i % 2 ? 1.0 : 0.832, i % 2 ? 0.003 : 0.012);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_stays_white),
        cmocka_unit_test(balls_keep_what_is_known),
        cmocka_unit_test(colour_counts_inner_reflection),
        cmocka_unit_test(overlapping_and_from_within),
        cmocka_unit_test(pure_absorption_is_dark),
        cmocka_unit_test(short_paths_are_no_darker),
        cmocka_unit_test(lamps_are_met_or_sampled),
        cmocka_unit_test(indirect_walks_can_be_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
