// SPDX-License-Identifier: Apache-2.0
// Radiance with a closed form, through the whole program: area, point and directional lights, Fresnel, the cdrf
// terminator.
#include "whole_program.h"
#include <math.h>

#define PI 3.14159265358979

// A small white Lambert disc at the origin seen from above: its radiance is E / pi.
static const char disc_scene[] = "tsuya: 1\n"
                                 "film: { size: [8, 8], filter: box, filter_width: 1, half: false }\n"
                                 "render: { samples: %d, max_depth: 4, seed: 11 }\n"
                                 "camera: { position: [0, 1, 0.0001], look_at: [0, 0, 0], vfov: 0.04 }\n"
                                 "assets: { disc: { shape: disc, radius: 0.02 } }\n"
                                 "materials: { m: { model: surface, base_color: 1, specular_weight: 0 } }\n"
                                 "objects: [ { mesh: disc, material: m } ]\n"
                                 "lights: [ %s ]\n";

static void check_irradiance(const char* light, double expected)
{
    char text[2048];
    snprintf(text, sizeof text, disc_scene, 256, light);
    ty_exr* exr = render_text(text);
    mean_error found = mean_over(exr, 0, 0, 7, 7);
    ty_exr_destroy(exr);
    double irradiance = found.mean * PI, error = found.error * PI;
    print_message("%-110s E %.6f +- %.6f expected %.6f\n", light, irradiance, error, expected);
    // The disc is seen through a cone of 0.04 degrees: E varies over it by less than 1e-6 of itself.
    assert_true(fabs(irradiance - expected) <= 3.0 * error + 3e-6 * expected);
}

// Irradiance at the origin, normal +y, from a parallel rectangle with one corner over it: sides a, b at height h.
static double corner_factor(double a, double b, double h)
{
    double x = a / h, y = b / h;
    return (x / sqrt(1 + x * x) * atan(y / sqrt(1 + x * x)) + y / sqrt(1 + y * y) * atan(x / sqrt(1 + y * y))) /
           (2 * PI);
}

static void area_lights_give_their_irradiance(void** state)
{
    (void)state;
    // Centred rectangle 0.4 x 0.2 at height 0.3: four quarters.
    check_irradiance(
        "{ type: rectangle, center: [0, 0.3, 0], target: [0, 0, 0], up: [0, 0, 1], size: [0.4, 0.2], radiance: 5 }",
        5 * PI * 4 * corner_factor(0.2, 0.1, 0.3));
    check_irradiance(
        "{ type: rectangle, center: [0, 0.02, 0], target: [0, 0, 0], up: [0, 0, 1], size: [0.4, 0.2], radiance: 5 }",
        5 * PI * 4 * corner_factor(0.2, 0.1, 0.02));
    // Sphere of radius r at distance d, wholly above the horizon: E = pi L (r/d)^2 cos.
    check_irradiance("{ type: sphere, center: [0, 0.3, 0.4], radius: 0.1, radiance: 7, camera_visible: false }",
                     PI * 7 * 0.01 / 0.25 * 0.6);
    check_irradiance("{ type: sphere, center: [0, 0.06, 0], radius: 0.05, radiance: 7, camera_visible: false }",
                     PI * 7 * 25.0 / 36.0);
}

static void distant_and_point_lights(void** state)
{
    (void)state;
    check_irradiance("{ type: point, center: [0, 0.5, 0], intensity: 2 }", 2 / 0.25);
    check_irradiance("{ type: point, center: [0, 1.0, 0.0], intensity: 2 }", 2.0);
    check_irradiance("{ type: point, center: [0, 0.3, 0.4], intensity: 2 }", 2 / 0.25 * 0.6);
    check_irradiance("{ type: directional, center: [0, 3, 4], target: [0, 0, 0], irradiance: 3 }", 3 * 0.6);
    check_irradiance("{ type: environment, radiance: 0.7 }", 0.7 * PI);
}

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
        cmocka_unit_test(area_lights_give_their_irradiance),
        cmocka_unit_test(distant_and_point_lights),
        cmocka_unit_test(fresnel_reflectance_at_five_angles),
        cmocka_unit_test(terminator_of_a_translucent_sphere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
