// SPDX-License-Identifier: Apache-2.0
// Radiance with a closed form, through the whole program: Fresnel, the cdrf terminator.
#include "whole_program.h"
#include <math.h>

#define PI 3.14159265358979

static double fresnel(double cosine, double eta)
{
    double sine = sqrt(1 - cosine * cosine) / eta, t = sqrt(1 - sine * sine);
    double s = (cosine - eta * t) / (cosine + eta * t), p = (eta * cosine - t) / (eta * cosine + t);
    return 0.5 * (s * s + p * p);
}

// A smooth pane seen at five angles in a constant environment: what is mirrored is F, the rest is black behind.
static void fresnel_reflectance_at_five_angles(void** state)
{
    (void)state;
    static const double angles[] = {5, 30, 56.3, 70, 82};
    for (int i = 0; i < 5; i++)
    {
        double angle = angles[i] * PI / 180, expected = fresnel(cos(angle), 1.5);
        char text[2048];
        snprintf(text, sizeof text,
                 "tsuya: 1\nfilm: { size: [8, 8], filter: box, filter_width: 1, half: false }\n"
                 "render: { samples: 1024, max_depth: 2, roulette_depth: 8, seed: 2 }\n"
                 "camera: { position: [0, %.9f, %.9f], look_at: [0, 0, 0], vfov: 0.1 }\n"
                 "assets: { pane: { shape: plane, size: [0.1, 0, 0.1] } }\n"
                 "materials: { m: { model: surface, base_color: 0, specular_roughness: 0, specular_ior: 1.5 } }\n"
                 "objects: [ { mesh: pane, material: m } ]\nlights: [ { type: environment, radiance: 1 } ]\n",
                 cos(angle), sin(angle));
        ty_exr* exr = render_text(text);
        mean_error found = mean_over(exr, 0, 0, 7, 7);
        ty_exr_destroy(exr);
        print_message("angle %.1f: F %.5f +- %.5f expected %.5f\n", angles[i], found.mean, found.error, expected);
        assert_true(fabs(found.mean - expected) <= 3 * found.error + 1e-4);
    }
}

// E(angle) on a sphere with R / l = 4 under one directional light, normalised so that a lit Lambert point is 1.
// Seen orthogonally enough (from 40 radii) along a direction that shows the wanted angle in the picture's centre.
static double sphere_response(const char* material, double angle_deg)
{
    double angle = angle_deg * PI / 180;
    char text[2048];
    snprintf(text, sizeof text,
             "tsuya: 1\nfilm: { size: [8, 8], filter: box, filter_width: 1, half: false }\n"
             "render: { samples: 4096, max_depth: 2, roulette_depth: 8, seed: 3 }\n"
             "camera: { position: [0, 0, 0.4], look_at: [0, 0, 0.01], vfov: 0.05 }\n"
             "assets: { ball: { shape: sphere, radius: 0.01, divisions: 256 } }\n"
             "materials: { m: { model: cdrf, color: 1, specular_weight: 0, mean_free_path: 2.5, %s } }\n"
             "objects: [ { mesh: ball, material: m } ]\n"
             "lights: [ { type: directional, center: [%.9f, 0, %.9f], target: [0, 0, 0], irradiance: 3.14159265 } ]\n",
             material, sin(angle), cos(angle));
    ty_exr* exr = render_text(text);
    mean_error found = mean_over(exr, 0, 0, 7, 7);
    ty_exr_destroy(exr);
    print_message("%-40s E(%.0f) = %.4f +- %.4f\n", material, angle_deg, found.mean, found.error);
    return found.mean;
}

static void terminator_of_a_translucent_sphere(void** state)
{
    (void)state;
    static const char* const poisson[] = {"evaluate: depth", "evaluate: probe", "evaluate: local"};
    for (int i = 0; i < 3; i++)
    {
        assert_true(fabs(sphere_response(poisson[i], 90) - 0.148) <= 0.003);
        assert_true(fabs(sphere_response(poisson[i], 180) - 0.0284) <= 0.002);
    }
    assert_true(fabs(sphere_response("evaluate: local, kernel: gaussian", 90) - 0.172) <= 0.003);
    assert_true(fabs(sphere_response("evaluate: probe, kernel: gaussian", 90) - 0.172) <= 0.006);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fresnel_reflectance_at_five_angles),
        cmocka_unit_test(terminator_of_a_translucent_sphere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
