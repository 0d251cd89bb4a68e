// SPDX-License-Identifier: Apache-2.0
// Which light reaches what: linking, visibility by kind of ray, groups, strategies of sampling; through the whole
// program.
#include "irradiance.h"

static const char pair[] = "{ name: a, type: point, center: [0, 0.5, 0], intensity: 2, group: key }, "
                           "{ name: b, type: rectangle, center: [0, 0.3, 0], target: [0, 0, 0], up: [0, 0, 1], "
                           "size: [0.4, 0.2], radiance: 5, camera_visible: false }";
static const char glow[] = ", glow: { model: surface, base_color: 0, specular_weight: 0, emission_luminance: 5 }";
static const char plane[] = ", plane: { shape: plane, size: [0.2, 0, 0.1] }";

static double rectangle_irradiance(void)
{
    return 5 * PI * 4 * corner_factor(0.2, 0.1, 0.3);
}

static void objects_name_their_lights(void** state)
{
    (void)state;
    static const struct
    {
        const char* disc;
        bool a, b;
    } cases[] = {
        {"", true, true},
        {", lights: [a]", true, false},
        {", lights: b", false, true},
        {", exclude_lights: [a]", false, true},
        {", lights: [key]", true, false}, // by its group
        {", lights: []", false, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    {
        double expected = (cases[i].a ? 8 : 0) + (cases[i].b ? rectangle_irradiance() : 0);
        for (int strategy = 0; strategy < 3; strategy++)
        {
            static const char* const names[] = {"", ", light_sampling: light", ", light_sampling: bsdf"};
            mean_error found =
                irradiance_on(&(stage){.lights = pair, .disc = cases[i].disc, .render = names[strategy]});
            if (fabs(found.mean - expected) > 3.0 * found.error + 1e-5 * expected)
                fail_msg("%s%s: %f +- %f expected %f", cases[i].disc, names[strategy], found.mean, found.error,
                         expected);
        }
    }
}

static void glowing_objects_are_linked_too(void** state)
{
    (void)state;
    stage s = {.assets = plane,
               .materials = glow,
               .objects = ", { name: lamp, mesh: plane, material: glow, visible: { camera: false }, rotate: [180, 0, "
                          "0], translate: [0, 0.3, 0] }",
               .lights = "{ name: a, type: point, center: [0, 0.2, 0], intensity: 0.08 }"};
    check_stage(&s, rectangle_irradiance() + 2, 0.01);
    s.disc = ", exclude_lights: [lamp]";
    check_stage(&s, 2, 0.01);
    s.disc = ", lights: [lamp]";
    check_stage(&s, rectangle_irradiance(), 0.01);
}

// A light that glossy surfaces alone see gives a matt disc nothing; and one that only matt ones see gives it all.
static void lights_are_visible_by_kind_of_ray(void** state)
{
    (void)state;
    static const char light[] = "{ type: sphere, center: [0, 0.3, 0.4], radius: 0.1, radiance: 7, "
                                "visible: { camera: false, diffuse: %s, glossy: %s, transmission: false } }";
    char text[256];
    for (int matt = 0; matt < 2; matt++)
    {
        snprintf(text, sizeof text, light, matt ? "true" : "false", matt ? "false" : "true");
        check_stage(&(stage){.lights = text}, matt ? PI * 7 * 0.01 / 0.25 * 0.6 : 0.0, 0.02);
    }
}

// Both lobes of a polished surface under a light: what each sees adds up to what both see, however light is found.
static void lobes_divide_a_light_among_them(void** state)
{
    (void)state;
    static const char* const strategies[] = {"mis", "light", "bsdf"};
    double seen[3][3];
    for (int which = 0; which < 3; which++)
        for (int s = 0; s < 3; s++)
        {
            char text[2048];
            snprintf(text, sizeof text,
                     "tsuya: 1\nfilm: { size: [8, 8], filter: box, filter_width: 1, half: false }\n"
                     "render: { samples: 1024, max_depth: 1, seed: 2, light_sampling: %s }\n"
                     "camera: { position: [0, 0.6, 0.8], look_at: [0, 0, 0], vfov: 1 }\n"
                     "assets: { pane: { shape: plane, size: [0.1, 0, 0.1] } }\n"
                     "materials: { m: { model: surface, base_color: 0.5, specular_roughness: 0.4 } }\n"
                     "objects: [ { mesh: pane, material: m } ]\n"
                     "lights: [ { type: sphere, center: [0, 0.6, -0.8], radius: 0.2, radiance: 3, "
                     "visible: { diffuse: %s, glossy: %s } } ]\n",
                     strategies[s], which == 1 ? "false" : "true", which == 2 ? "false" : "true");
            ty_exr* exr = render_text(text);
            mean_error found = mean_over(exr, 0, 0, 7, 7);
            ty_exr_destroy(exr);
            print_message("%s, %d: %.5f +- %.5f\n", strategies[s], which, found.mean, found.error);
            seen[which][s] = found.mean;
            if (s > 0)
                assert_true(fabs(found.mean - seen[which][0]) < 4 * found.error + 0.002 * found.mean);
        }
    assert_true(fabs(seen[1][0] + seen[2][0] - seen[0][0]) < 0.004 * seen[0][0]);
    assert_true(seen[1][0] > 0.1 * seen[0][0] && seen[2][0] > 0.1 * seen[0][0]);
}

static void objects_cast_shadows_unless_told(void** state)
{
    (void)state;
    stage s = {.assets = plane,
               .objects = ", { mesh: plane, material: m, visible: { camera: false }, translate: [0, 0.2, 0] }",
               .lights = "{ type: point, center: [0, 0.5, 0], intensity: 2 }"};
    assert_true(irradiance_on(&s).mean == 0.0);
    s.objects = ", { mesh: plane, material: m, visible: { camera: false, shadow: false }, translate: [0, 0.2, 0] }";
    check_stage(&s, 8, 0.01);
    // The other way round: this light is stopped by nothing.
    s.objects = ", { mesh: plane, material: m, visible: { camera: false }, translate: [0, 0.2, 0] }";
    s.lights = "{ type: point, center: [0, 0.5, 0], intensity: 2, shadows: false }";
    check_stage(&s, 8, 0.01);
    s.lights = "{ type: rectangle, center: [0, 0.3, 0], target: [0, 0, 0], up: [0, 0, 1], size: [0.4, 0.2], radiance: "
               "5, shadows: false, camera_visible: false }";
    check_stage(&s, rectangle_irradiance(), 0.01);
    s.lights = "{ type: environment, radiance: 2, shadows: false }";
    check_stage(&s, 2 * PI, 0.01);
    s.lights = "{ type: environment, radiance: 2, shadows: false }, { type: environment, radiance: 3 }";
    check_stage(&s, 2 * PI + 3 * PI * (1 - 4 * corner_factor(0.2, 0.1, 0.2)), 0.01);
}

static void groups_are_the_lights_alone(void** state)
{
    (void)state;
    char text[4096];
    snprintf(text, sizeof text, disc_scene, "", plane, glow, "",
             ", { mesh: plane, material: glow, light_group: lamp, visible: { camera: false }, rotate: [180, 0, 0], "
             "translate: [0, 0.3, 0] }",
             "{ type: point, center: [0, 0.2, 0], intensity: 0.08, group: key }, { type: environment, radiance: 0.2 }");
    ty_exr* exr = render_text(text);
    double key = 0, lamp = 0, rest = 0, whole = 0;
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
        {
            double k = (double)pixel(exr, "light.key.R", x, y), l = (double)pixel(exr, "light.lamp.R", x, y);
            double r = (double)pixel(exr, "light.default.R", x, y), all = (double)pixel(exr, "R", x, y);
            assert_true(fabs(k + l + r - all) < 1e-6 * all);
            key += k * PI / 64;
            lamp += l * PI / 64;
            rest += r * PI / 64;
            whole += all * PI / 64;
        }
    ty_exr_destroy(exr);
    assert_true(fabs(key / 2 - 1) < 0.01); // which light is sampled is left to chance
    assert_true(fabs(lamp / rectangle_irradiance() - 1) < 0.01);
    // The plane stands before a part of the sky.
    double open = 0.2 * PI * (1 - 4 * corner_factor(0.2, 0.1, 0.3));
    assert_true(fabs(rest / open - 1) < 0.02 && whole > key + lamp);
}

// Limited light keeps its groups: between two planes, where the limit takes most of what they throw to each other.
static void groups_are_limited_together(void** state)
{
    (void)state;
    double mean[2];
    for (int limited = 0; limited < 2; limited++)
    {
        char text[2048];
        snprintf(text, sizeof text,
                 "tsuya: 1\nfilm: { size: [8, 8], filter: box, filter_width: 1, half: false }\n"
                 "render: { samples: 256, max_depth: 6, seed: 7, indirect_clamp: %s }\n"
                 "camera: { position: [0, 0.02, 0.3], look_at: [0, 0, 0], vfov: 10 }\n"
                 "assets: { plane: { shape: plane, size: [0.2, 0, 0.1] } }\n"
                 "materials: { m: { model: surface, base_color: 0.9, specular_weight: 0 } }\n"
                 "objects: [ { mesh: plane, material: m }, { mesh: plane, material: m, rotate: [180, 0, 0], "
                 "translate: [0, 0.05, 0] } ]\n"
                 "lights: [ { type: environment, radiance: 0.6, group: sky }, { type: sphere, center: [0.05, 0.02, 0], "
                 "radius: 0.01, radiance: 30 } ]\n",
                 limited ? "0.2" : "0");
        ty_exr* exr = render_text(text);
        double sky = 0.0, whole = 0.0;
        for (int y = 0; y < 8; y++)
            for (int x = 0; x < 8; x++)
            {
                double all = (double)pixel(exr, "R", x, y), of_sky = (double)pixel(exr, "light.sky.R", x, y);
                assert_true(fabs(of_sky + (double)pixel(exr, "light.default.R", x, y) - all) < 1e-6 * all);
                sky += of_sky / 64;
                whole += all / 64;
            }
        ty_exr_destroy(exr);
        print_message("%s: %.5f, of the sky %.5f\n", limited ? "limited" : "unlimited", whole, sky);
        assert_true(sky > 0.1 * whole && sky < 0.9 * whole);
        mean[limited] = whole;
    }
    assert_true(mean[1] < 0.95 * mean[0]);
}

// A polished floor under a large dim and a small bright light: each strategy is bad at one of them.
static void strategies_agree_and_together_are_best(void** state)
{
    (void)state;
    static const char* const names[] = {"mis", "light", "bsdf"};
    mean_error found[3];
    for (int s = 0; s < 3; s++)
    {
        char text[2048];
        snprintf(text, sizeof text,
                 "tsuya: 1\nfilm: { size: [24, 24], filter: box, filter_width: 1, half: false }\n"
                 "render: { samples: 256, max_depth: 1, seed: 5, light_sampling: %s }\n"
                 "camera: { position: [0, 0.5, 1], look_at: [0, 0, 0], vfov: 20 }\n"
                 "assets: { floor: { shape: plane, size: [2, 0, 2] } }\n"
                 "materials: { m: { model: surface, base_color: 0.3, specular_roughness: 0.12 } }\n"
                 "objects: [ { mesh: floor, material: m } ]\n"
                 "lights:\n"
                 "  - { type: rectangle, center: [0, 0.8, -1.4], target: [0, 0, 0], size: [1.6, 1], radiance: 4 }\n"
                 "  - { type: sphere, center: [0.2, 0.3, 0.3], radius: 0.01, radiance: 800, camera_visible: false }\n",
                 names[s]);
        ty_exr* exr = render_text(text);
        found[s] = mean_over(exr, 0, 0, 23, 23);
        ty_exr_destroy(exr);
        print_message("%-6s %.5f +- %.5f\n", names[s], found[s].mean, found[s].error);
    }
    for (int s = 1; s < 3; s++)
    {
        double error = sqrt(found[0].error * found[0].error + found[s].error * found[s].error);
        assert_true(fabs(found[s].mean - found[0].mean) < 3 * error);
        assert_true(found[0].error < 0.8 * found[s].error);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(objects_name_their_lights),         cmocka_unit_test(glowing_objects_are_linked_too),
        cmocka_unit_test(lights_are_visible_by_kind_of_ray), cmocka_unit_test(lobes_divide_a_light_among_them),
        cmocka_unit_test(objects_cast_shadows_unless_told),  cmocka_unit_test(groups_are_the_lights_alone),
        cmocka_unit_test(groups_are_limited_together),       cmocka_unit_test(strategies_agree_and_together_are_best),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
