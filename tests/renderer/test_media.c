// SPDX-License-Identifier: Apache-2.0
// Clear bodies in one another, and what light goes straight through, against closed forms through the whole program.
#include "whole_program.h"
#include <math.h>

#define PI 3.14159265358979

static double render_mean(const char* text, double* error)
{
    ty_exr* exr = render_text(text);
    mean_error found = mean_over(exr, 0, 0, ty_exr_width(exr) - 1, ty_exr_height(exr) - 1);
    ty_exr_destroy(exr);
    *error = found.error;
    return found.mean;
}

// Unpolarised reflectance from index 1 to eta and the cosine beyond.
static double fresnel(double c, double eta, double* beyond)
{
    double t = sqrt(1 - (1 - c * c) / (eta * eta));
    double s = (c - eta * t) / (c + eta * t), p = (eta * c - t) / (eta * c + t);
    *beyond = t;
    return 0.5 * (s * s + p * p);
}

// What comes back and goes through a stack of layers, all orders of reflection without interference: layers are added
// from below. c: cosine above.
static double stack_sum(double c, const double* index, const double* depth, const double* absorption, int count)
{
    double r[8], way[8], before = 1.0;
    for (int i = 0; i < count; i++)
    {
        r[i] = fresnel(c, index[i] / before, &c);
        way[i] = exp(-absorption[i] * depth[i] / c);
        before = index[i];
    }
    double reflected = fresnel(c, 1.0 / before, &c), through = 1.0 - reflected;
    for (int i = count - 1; i >= 0; i--)
    {
        reflected *= way[i] * way[i];
        through *= way[i];
        double all = 1.0 / (1.0 - r[i] * reflected);
        through *= (1.0 - r[i]) * all;
        reflected = r[i] + (1.0 - r[i]) * (1.0 - r[i]) * reflected * all;
    }
    return reflected + through;
}

#define HEAD                                                                                                           \
    "tsuya: 1\n"                                                                                                       \
    "film: { size: [8, 8], filter: box, filter_width: 1, half: false }\n"                                              \
    "render: { samples: %d, max_depth: 64, roulette_depth: 64, seed: 3 }\n"

// Glass of 2 mm over water of 4 mm that reaches `overlap` into it, under a white sky all around, seen at an angle from
// above or below.
static double slab(double angle, double overlap, bool from_above, double* error)
{
    char text[2048];
    double side = from_above ? 0.1 : -0.1;
    snprintf(text, sizeof text,
             HEAD "camera: { position: [%.9f, %.9f, 0], look_at: [0, 0, 0], up: [0, 0, 1], vfov: 0.01 }\n"
                  "assets:\n"
                  "  upper: { shape: box, size: [0.5, 0.001, 0.5] }\n"
                  "  lower: { shape: box, size: [0.5, %.9f, 0.5] }\n"
                  "materials:\n"
                  "  glass: { model: surface, transmission_weight: 1, specular_roughness: 0, specular_ior: 1.5, "
                  "transmission_color: 0.5, transmission_depth: 0.01, priority: 1 }\n"
                  "  water: { model: surface, transmission_weight: 1, specular_roughness: 0, specular_ior: 1.33, "
                  "transmission_color: 0.3, transmission_depth: 0.01 }\n"
                  "objects:\n"
                  "  - { mesh: upper, material: glass, translate: [0, 0.001, 0] }\n"
                  "  - { mesh: lower, material: water, translate: [0, %.9f, 0] }\n"
                  "lights: [ { type: environment, radiance: 1 } ]\n",
             512, 0.1 * sin(angle), side * cos(angle), 0.002 + 0.5 * overlap, -0.002 + 0.5 * overlap);
    return render_mean(text, error);
}

// However far the water is modelled into the glass, the glass is there: the picture is that of bodies that touch.
static void overlapping_slabs_are_as_if_touching(void** state)
{
    (void)state;
    static const double overlaps[] = {0.00005, 0.0005, 0.0019};
    for (int i = 0; i < 12; i++)
    {
        bool above = i < 6;
        double angle = i / 3 % 2 ? 0.9 : 0.0, error;
        double index[2] = {1.5, 1.33}, depth[2] = {0.002, 0.004}, absorption[2] = {-log(0.5) / 0.01, -log(0.3) / 0.01};
        double up[2][3] = {{1.33, 0.004, absorption[1]}, {1.5, 0.002, absorption[0]}};
        for (int k = 0; k < 2 && !above; k++)
        {
            index[k] = up[k][0];
            depth[k] = up[k][1];
            absorption[k] = up[k][2];
        }
        double found = slab(angle, overlaps[i % 3], above, &error);
        double expected = stack_sum(cos(angle), index, depth, absorption, 2);
        print_message("angle %.1f overlap %.2f mm %s: %.5f +- %.5f expected %.5f\n", angle, 1e3 * overlaps[i % 3],
                      above ? "above" : "below", found, error, expected);
        assert_true(fabs(found - expected) <= 3.5 * error + 2e-4);
    }
}

// Pixels of a glass ball with something in it.
static ty_exr* ball(const char* inner, const char* priority, const char* move)
{
    char text[2048];
    snprintf(text, sizeof text,
             HEAD
             "camera: { position: [0, 0.02, 0.3], look_at: [0, 0, 0], vfov: 13 }\n"
             "assets:\n"
             "  outer: { shape: sphere, radius: 0.03, divisions: 64 }\n"
             "  inner: { shape: %s, divisions: 64 }\n"
             "materials:\n"
             "  glass: { model: surface, transmission_weight: 1, specular_roughness: 0, specular_ior: 1.5 }\n"
             "  core: { model: surface, transmission_weight: 1, specular_roughness: 0, specular_ior: 1.33, "
             "transmission_color: [0.9, 0.4, 0.2], transmission_depth: 0.01 %s }\n"
             "objects: [ { mesh: outer, material: glass }, { mesh: inner, material: core, translate: %s } ]\n"
             "lights:\n"
             "  - { type: environment, radiance: 0.2 }\n"
             "  - { type: rectangle, center: [0.2, 0.3, 0.1], target: [0, 0, 0], size: [0.2, 0.2], radiance: 9 }\n",
             64, inner, priority, move);
    return render_text(text);
}

// Of equal priority the body entered last is there: a core in a ball needs no priority.
static void a_core_needs_no_priority(void** state)
{
    (void)state;
    ty_exr* plain = ball("sphere, radius: 0.02", "", "[0, 0, 0]");
    ty_exr* given = ball("sphere, radius: 0.02", ", priority: 3", "[0, 0, 0]");
    ty_exr* hidden = ball("sphere, radius: 0.02", ", priority: -3", "[0, 0, 0]");
    double difference = 0, seen = 0;
    for (int i = 0; i < 64; i++)
    {
        assert_true(pixel(plain, "R", i % 8, i / 8) == pixel(given, "R", i % 8, i / 8));
        difference += fabs((double)(pixel(plain, "B", i % 8, i / 8) - pixel(hidden, "B", i % 8, i / 8)));
        seen += (double)pixel(plain, "B", i % 8, i / 8);
    }
    assert_true(difference > 0.2 * seen);
    ty_exr_destroy(plain);
    ty_exr_destroy(given);
    // What lies in a body of higher priority is not there at all.
    ty_exr* alone = ball("sphere, radius: 0.001", ", priority: -3", "[0, 0.5, 0]");
    for (int i = 0; i < 64; i++)
        assert_true(fabsf(pixel(alone, "G", i % 8, i / 8) - pixel(hidden, "G", i % 8, i / 8)) < 1e-3f);
    ty_exr_destroy(hidden);
    ty_exr_destroy(alone);
}

// The camera in water of 40 mm, 10 mm under its surface, a plate of glass between: its medium is found, and what it
// absorbs on the first way counts.
static void camera_within(void** state)
{
    (void)state;
    for (int plate = 0; plate < 2; plate++)
    {
        char text[2048];
        double sigma = -log(0.4) / 0.01, error, c, depth = 0.04;
        snprintf(text, sizeof text,
                 HEAD
                 "camera: { position: [0, 0.01, 0], look_at: [0, 1, 0], up: [0, 0, 1], vfov: 0.01 }\n"
                 "assets:\n"
                 "  tank: { shape: box, size: [0.5, 0.02, 0.5] }\n"
                 "  plate: { shape: box, size: [0.1, 0.001, 0.1] }\n"
                 "materials:\n"
                 "  water: { model: surface, transmission_weight: 1, specular_roughness: 0, specular_ior: 1.33, "
                 "transmission_color: 0.4, transmission_depth: 0.01 }\n"
                 "  glass: { model: surface, transmission_weight: 1, specular_roughness: 0, specular_ior: 1.33 }\n"
                 "objects: [ { mesh: tank, material: water }, { mesh: plate, material: glass, translate: [%s, 0.01, 0] "
                 "} ]\n"
                 "lights: [ { type: environment, radiance: 1 } ]\n",
                 256, plate ? "0" : "3");
        double found = render_mean(text, &error);
        // A plate of the same index bends and reflects nothing: only that much of the water is not there. The camera
        // stands in its middle.
        double r = fresnel(1.0, 1.33, &c), way = exp(-sigma * (depth - (plate ? 0.002 : 0.0)));
        double first = exp(-sigma * (0.01 - (plate ? 0.001 : 0.0)));
        double expected = first * (1 - r) / (1 - r * way);
        print_message("within: %.5f +- %.5f expected %.5f\n", found, error, expected);
        assert_true(fabs(found - expected) <= 3.5 * error + 2e-4);
    }
}

// A lamp in the same water as the floor it lights, found by its own samples or by the floor's.
static void lamps_within_are_dimmed(void** state)
{
    (void)state;
    static const char* const sampling[] = {"light", "bsdf", "mis"};
    for (int i = 0; i < 3; i++)
    {
        char text[2048];
        double error, sigma = -log(0.5) / 0.1;
        snprintf(
            text, sizeof text,
            "tsuya: 1\n"
            "film: { size: [8, 8], filter: box, filter_width: 1, half: false }\n"
            "render: { samples: 1024, max_depth: 1, seed: 3, light_sampling: %s }\n"
            "camera: { position: [0, 0.05, 0.0001], look_at: [0, 0, 0], vfov: 0.1 }\n"
            "assets: { floor: { shape: disc, radius: 0.01 }, tank: { shape: box, size: [1, 1, 1] } }\n"
            "materials:\n"
            "  white: { model: surface, base_color: 1, specular_weight: 0 }\n"
            "  water: { model: surface, transmission_weight: 1, specular_roughness: 0, specular_ior: 1.33, "
            "transmission_color: 0.5, transmission_depth: 0.1 }\n"
            "objects: [ { mesh: floor, material: white }, { mesh: tank, material: water } ]\n"
            "lights: [ { type: sphere, center: [0, 0.3, 0], radius: 0.03, radiance: 40, camera_visible: false } ]\n",
            sampling[i]);
        double found = render_mean(text, &error);
        // The way to the lamp's near side is .27 m on the axis and .298 m at its rim: the mean over its disc, seen from
        // the floor, by midpoints.
        double expected = 0;
        for (int k = 0; k < 1000; k++)
        {
            double s = (k + 0.5) / 1000 * 0.01, c = sqrt(1 - s), t = 0.3 * c - sqrt(0.0009 - 0.09 * s);
            expected += 40 * 0.01 / 1000 * exp(-sigma * t);
        }
        expected *= exp(-sigma * 0.05);
        print_message("lamp in water, %s: %.5f +- %.5f expected %.5f\n", sampling[i], found, error, expected);
        assert_true(fabs(found - expected) <= 3.5 * error + 1e-4 * expected);
    }
}

// The same lamp above the water, whose surface is there for half of the light: past it nothing is absorbed.
static void water_ends_at_its_open_surface(void** state)
{
    (void)state;
    static const char* const sampling[] = {"light", "bsdf", "mis"};
    for (int i = 0; i < 3; i++)
    {
        char text[2048];
        double error, sigma = -log(0.5) / 0.1, expected = 0;
        snprintf(
            text, sizeof text,
            "tsuya: 1\n"
            "film: { size: [8, 8], filter: box, filter_width: 1, half: false }\n"
            "render: { samples: 1024, max_depth: 1, seed: 3, light_sampling: %s }\n"
            "camera: { position: [0, 0.05, 0.0001], look_at: [0, 0, 0], vfov: 0.1 }\n"
            "assets: { floor: { shape: disc, radius: 0.01 }, tank: { shape: box, size: [1, 0.1, 1] } }\n"
            "materials:\n"
            "  white: { model: surface, base_color: 1, specular_weight: 0 }\n"
            "  water: { model: surface, transmission_weight: 1, specular_roughness: 0, specular_ior: 1.33, "
            "transmission_color: 0.5, transmission_depth: 0.1, opacity: 0.5 }\n"
            "objects: [ { mesh: floor, material: white }, { mesh: tank, material: water } ]\n"
            "lights: [ { type: sphere, center: [0, 0.3, 0], radius: 0.03, radiance: 40, camera_visible: false } ]\n",
            sampling[i]);
        double found = render_mean(text, &error);
        for (int k = 0; k < 1000; k++)
            expected += 0.5 * 40 * 0.01 / 1000 * exp(-sigma * 0.1 / sqrt(1 - (k + 0.5) / 1000 * 0.01));
        expected *= exp(-sigma * 0.05);
        print_message("lamp above water, %s: %.5f +- %.5f expected %.5f\n", sampling[i], found, error, expected);
        assert_true(fabs(found - expected) <= 3.5 * error + 1e-4 * expected);
    }
}

// A tinted block that bends nothing under a white sky: what comes in through its surface is absorbed to the far side,
// whether it leaves through the surface or where that lets pass; what came in where it lets pass is not.
static void no_medium_follows_a_ray_out(void** state)
{
    (void)state;
    char text[1024];
    double error, expected = 0.5 + 0.5 * 0.3;
    snprintf(text, sizeof text,
             HEAD "camera: { position: [0, 0, 0.3], look_at: [0, 0, 0], vfov: 0.01 }\n"
                  "assets: { block: { shape: box, size: [0.2, 0.2, 0.005] } }\n"
                  "materials: { m: { model: surface, transmission_weight: 1, specular_roughness: 0, specular_ior: 1, "
                  "transmission_color: 0.3, transmission_depth: 0.01, opacity: 0.5 } }\n"
                  "objects: [ { mesh: block, material: m } ]\n"
                  "lights: [ { type: environment, radiance: 1 } ]\n",
             512);
    double found = render_mean(text, &error);
    print_message("block of half a surface: %.5f +- %.5f expected %.5f\n", found, error, expected);
    assert_true(fabs(found - expected) <= 3.5 * error + 1e-4);
}

// The gloss of a translucent body under water, which the camera's path gathers by a ray of its own.
static void gloss_under_water_is_dimmed(void** state)
{
    (void)state;
    static const char* const sampling[] = {"light", "mis", "bsdf"};
    double found[3], error[3];
    for (int i = 0; i < 3; i++)
    {
        char text[2048];
        snprintf(
            text, sizeof text,
            "tsuya: 1\n"
            "film: { size: [8, 8], filter: box, filter_width: 1, half: false }\n"
            "render: { samples: 1024, max_depth: 1, seed: 3, light_sampling: %s }\n"
            "camera: { position: [0, 0.45, 0.7], look_at: [0, 0.05, 0.06], vfov: 8 }\n"
            "assets: { ball: { shape: sphere, radius: 0.15, divisions: 48 }, tank: { shape: box, size: [3, 3, 3] } }\n"
            "materials:\n"
            "  berry: { model: cdrf, color: 0.01, specular_roughness: 0.3, specular_ior: 2 }\n"
            "  water: { model: surface, transmission_weight: 1, specular_roughness: 0, specular_ior: 1.33, "
            "transmission_color: 0.4, transmission_depth: 0.25 }\n"
            "objects: [ { mesh: ball, material: berry }, { mesh: tank, material: water } ]\n"
            "lights: [ { type: rectangle, center: [0, 1, -0.2], target: [0, 0, 0], size: [0.6, 0.6], radiance: 8 } ]\n",
            sampling[i]);
        found[i] = render_mean(text, &error[i]);
        print_message("gloss under water, %s: %.6f +- %.6f\n", sampling[i], found[i], error[i]);
        assert_true(found[i] > 5 * error[i] && fabs(found[i] - found[0]) <= 3.5 * (error[i] + error[0]));
    }
}

// --- straight through ---

static double shaded_floor(const char* material, const char* height, const char* light, const char* sampling,
                           double* error)
{
    char text[2048];
    snprintf(text, sizeof text,
             "tsuya: 1\n"
             "film: { size: [8, 8], filter: box, filter_width: 1, half: false }\n"
             "render: { samples: 512, max_depth: 2, seed: 3, light_sampling: %s }\n"
             "camera: { position: [0, 0.05, 0.0001], look_at: [0, 0, 0], vfov: 0.1 }\n"
             "assets: { floor: { shape: disc, radius: 0.01 }, roof: { shape: plane, size: [2, 0, 2] } }\n"
             "materials:\n"
             "  white: { model: surface, base_color: 1, specular_weight: 0 }\n"
             "  roof: { model: surface, base_color: 0, %s }\n"
             "objects:\n"
             "  - { mesh: floor, material: white }\n"
             "  - { mesh: roof, material: roof, translate: [0, %s, 0] }\n"
             "  - { mesh: roof, material: roof, translate: [0, 0.2, 0] }\n"
             "lights: [ %s ]\n",
             sampling, material, height, light);
    return render_mean(text, error) * PI;
}

static void shadows_are_as_transparent(void** state)
{
    (void)state;
    static const char rectangle[] =
        "{ type: rectangle, center: [0, 0.5, 0], target: [0, 0, 0], up: [0, 0, 1], size: [0.4, 0.4], radiance: 4 }";
    static const char* const lights[] = {"{ type: directional, center: [0, 1, 0], target: [0, 0, 0], irradiance: 2 }",
                                         "{ type: point, center: [0, 0.5, 0], intensity: 0.5 }", rectangle,
                                         "{ type: environment, radiance: 0.7 }"};
    double error, open;
    for (int i = 0; i < 4; i++)
    {
        double none = shaded_floor("specular_weight: 0, opacity: 0", "0.1", lights[i], "mis", &open);
        double two = shaded_floor("specular_weight: 0, opacity: 0.3", "0.1", lights[i], "mis", &error);
        print_message("%-100s %.5f, under two sheets of .7: %.5f +- %.5f\n", lights[i], none, two, PI * error);
        assert_true(fabs(two - 0.49 * none) <= 3.5 * PI * (error + open) + 1e-4 * none);
        if (i < 3) // the sky is seen past the roof's edge
            assert_true(shaded_floor("specular_weight: 0, opacity: 1", "0.1", lights[i], "mis", &error) == 0.0);
    }
    // All ways to find a lamp through the sheets agree.
    double mis = shaded_floor("specular_weight: 0, opacity: 0.3", "0.1", rectangle, "mis", &error), e[2];
    double by_light = shaded_floor("specular_weight: 0, opacity: 0.3", "0.1", rectangle, "light", &e[0]);
    double by_surface = shaded_floor("specular_weight: 0, opacity: 0.3", "0.1", rectangle, "bsdf", &e[1]);
    assert_true(fabs(by_light - mis) <= 3.5 * PI * (error + e[0]));
    assert_true(fabs(by_surface - mis) <= 3.5 * PI * (error + e[1]));
}

static void panes_cast_clear_shadows(void** state)
{
    (void)state;
    double error, open, beyond;
    static const char light[] = "{ type: directional, center: [0, 1, 1], target: [0, 0, 0], irradiance: 2 }";
    double f = fresnel(sqrt(0.5), 1.5, &beyond), c = 0.8, pane = c * (1 - f) * (1 - f) / (1 - c * c * f * f);
    double none = shaded_floor("specular_weight: 0, opacity: 0", "0.1", light, "mis", &open);
    double found = shaded_floor("thin_walled: true, transmission_weight: 1, specular_roughness: 0, "
                                "transmission_color: 0.8",
                                "0.1", light, "mis", &error);
    // Each pane's own orders of reflection, but not those between the two, which no shadow ray takes.
    print_message("two panes: %.5f expected %.5f\n", found / none, pane * pane);
    assert_true(fabs(found - none * pane * pane) <= 3.5 * PI * (error + open) + 1e-5);
}

static void alpha_is_the_share_that_stops(void** state)
{
    (void)state;
    char text[1024];
    snprintf(text, sizeof text,
             HEAD "camera: { position: [0, 0, 0.3], look_at: [0, 0, 0], vfov: 5 }\n"
                  "assets: { wall: { shape: box, size: [0.2, 0.2, 0.01] } }\n"
                  "materials: { m: { model: surface, base_color: 0.5, opacity: 0.4 } }\n"
                  "objects: [ { mesh: wall, material: m } ]\n"
                  "lights: [ { type: point, center: [0, 0, 1], intensity: 1 } ]\n",
             256);
    ty_exr* exr = render_text(text);
    double sum = 0;
    for (int i = 0; i < 64; i++)
        sum += (double)pixel(exr, "A", i % 8, i / 8) / 64;
    // Two sides of .6 each.
    print_message("alpha %.4f\n", sum);
    assert_true(fabs(sum - 0.64) < 0.005);
    ty_exr_destroy(exr);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(overlapping_slabs_are_as_if_touching),
        cmocka_unit_test(a_core_needs_no_priority),
        cmocka_unit_test(camera_within),
        cmocka_unit_test(lamps_within_are_dimmed),
        cmocka_unit_test(water_ends_at_its_open_surface),
        cmocka_unit_test(no_medium_follows_a_ray_out),
        cmocka_unit_test(gloss_under_water_is_dimmed),
        cmocka_unit_test(shadows_are_as_transparent),
        cmocka_unit_test(panes_cast_clear_shadows),
        cmocka_unit_test(alpha_is_the_share_that_stops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
