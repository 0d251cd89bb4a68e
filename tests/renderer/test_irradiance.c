// SPDX-License-Identifier: Apache-2.0
// Every kind of light against the irradiance that it has in closed form.
#include "irradiance.h"
#include <stdlib.h>
#include <tsuya/base/rng.h>

static void rectangles(void** state)
{
    (void)state;
    // Centred rectangle 0.4 x 0.2: four quarters.
    check_irradiance(
        "{ type: rectangle, center: [0, 0.3, 0], target: [0, 0, 0], up: [0, 0, 1], size: [0.4, 0.2], radiance: 5 }",
        5 * PI * 4 * corner_factor(0.2, 0.1, 0.3));
    check_irradiance(
        "{ type: rectangle, center: [0, 0.02, 0], target: [0, 0, 0], up: [0, 0, 1], size: [0.4, 0.2], radiance: 5 }",
        5 * PI * 4 * corner_factor(0.2, 0.1, 0.02));
    // By its power: radiance is that over pi and the area; two stops and a colour make 4 x 0.5.
    check_irradiance("{ type: rectangle, center: [0, 0.3, 0], target: [0, 0, 0], up: [0, 0, 1], size: [0.4, 0.2], "
                     "power: 3, exposure: 2, color: 0.5 }",
                     2 * 3 / 0.08 * 4 * corner_factor(0.2, 0.1, 0.3));
}

// View factor of a parallel disc of radius r at height h, its centre a off the axis (Naraghi & Chung 1982).
static double disc_factor(double r, double h, double a)
{
    double b = h * h + a * a + r * r;
    return 0.5 * (1 - (b - 2 * r * r) / sqrt(b * b - 4 * a * a * r * r));
}

static void disks(void** state)
{
    (void)state;
    check_irradiance("{ type: disk, center: [0, 0.3, 0], target: [0, 0, 0], radius: 0.1, radiance: 5 }",
                     5 * PI * disc_factor(0.1, 0.3, 0));
    check_irradiance("{ type: disk, center: [0, 0.05, 0], target: [0, 0, 0], radius: 0.1, radiance: 5 }",
                     5 * PI * disc_factor(0.1, 0.05, 0));
    check_irradiance("{ type: disk, center: [0.2, 0.15, 0.1], target: [0.2, 0, 0.1], radius: 0.12, power: 2 }",
                     2 / (PI * 0.12 * 0.12) * disc_factor(0.12, 0.15, sqrt(0.05)));
    // Its back is dark.
    mean_error behind = irradiance_on(&(stage){
        .lights = "{ type: disk, center: [0, 0.3, 0], target: [0, 1, 0], radius: 0.1, camera_visible: false }"});
    assert_true(behind.mean == 0.0);
}

static void spheres(void** state)
{
    (void)state;
    // Radius r at distance d, wholly above the horizon: E = pi L (r/d)^2 cos.
    check_irradiance("{ type: sphere, center: [0, 0.3, 0.4], radius: 0.1, radiance: 7, camera_visible: false }",
                     PI * 7 * 0.01 / 0.25 * 0.6);
    check_irradiance("{ type: sphere, center: [0, 0.06, 0], radius: 0.05, radiance: 7, camera_visible: false }",
                     PI * 7 * 25.0 / 36.0);
    check_irradiance("{ type: sphere, center: [0, 0.3, 0.4], radius: 0.1, power: 10, visible: { camera: false } }",
                     10 / (4 * PI * 0.25) * 0.6);
}

// E over L of the round side of a cylinder along x by quadrature: centre (cx, h, cz).
static double cylinder_factor(double r, double length, double cx, double h, double cz)
{
    enum
    {
        N = 2000
    };
    double sum = 0;
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
        {
            double a = 2 * PI * (i + 0.5) / N, x = cx + length * ((j + 0.5) / N - 0.5);
            double y = h + r * cos(a), z = cz + r * sin(a), d = sqrt(x * x + y * y + z * z);
            double facing = -(cos(a) * y + sin(a) * z) / d; // normal (0, cos, sin) towards the origin
            if (facing > 0 && y > 0)
                sum += facing * (y / d) / (d * d);
        }
    return sum * 2 * PI * r / N * length / N;
}

static void cylinders(void** state)
{
    (void)state;
    check_irradiance("{ type: cylinder, center: [0, 0.3, 0], axis: [1, 0, 0], length: 0.5, radius: 0.05, radiance: 6, "
                     "camera_visible: false }",
                     6 * cylinder_factor(0.05, 0.5, 0, 0.3, 0));
    check_irradiance("{ type: cylinder, center: [0.2, 0.3, 0.1], axis: [-2, 0, 0], length: 0.5, radius: 0.2, power: 4, "
                     "camera_visible: false }",
                     4 / (2 * PI * 0.2 * 0.5 * PI) * cylinder_factor(0.2, 0.5, 0.2, 0.3, 0.1));
    // Endless, parallel to the plane: E = pi L r / h. What lies beyond 40 heights is 6e-6 of it.
    check_stage(&(stage){.lights = "{ type: cylinder, center: [0, 0.05, 0], axis: [1, 0, 0], length: 4, radius: 0.02, "
                                   "radiance: 6, camera_visible: false }"},
                PI * 6 * 0.4, 0.03);
}

static void points_and_spots(void** state)
{
    (void)state;
    check_irradiance("{ type: point, center: [0, 0.5, 0], intensity: 2 }", 2 / 0.25);
    check_irradiance("{ type: point, center: [0, 0.3, 0.4], intensity: 2 }", 2 / 0.25 * 0.6);
    check_irradiance("{ type: point, center: [0, 0.3, 0.4], power: 5 }", 5 / (4 * PI) / 0.25 * 0.6);
    check_irradiance("{ type: spot, center: [0, 0.3, 0.4], target: [0, 0, 0], cone: 20, intensity: 2 }",
                     2 / 0.25 * 0.6);
    // 6 degrees off the axis of a cone of 10 degrees (half angle) that fades from 5: a smooth step in the cosine. Over
    // the disc's picture it bends by 5e-5.
    double s = (cos(6 * PI / 180) - cos(10 * PI / 180)) / (cos(5 * PI / 180) - cos(10 * PI / 180));
    char light[256];
    snprintf(light, sizeof light,
             "{ type: spot, center: [0, 0.5, 0], target: [%.9f, 0, 0], cone: 20, penumbra: 0.5, intensity: 2 }",
             0.5 * tan(6 * PI / 180));
    assert_true(fabs(irradiance_on(&(stage){.lights = light}).mean / (8 * s * s * (3 - 2 * s)) - 1) < 1e-4);
    // Its power is what leaves it: without a fade, an even cone.
    check_irradiance("{ type: spot, center: [0, 0.5, 0], target: [0, 0, 0], cone: 40, penumbra: 0, power: 3 }",
                     3 / (2 * PI * (1 - cos(20 * PI / 180))) / 0.25);
    mean_error outside = irradiance_on(
        &(stage){.lights = "{ type: spot, center: [0, 0.5, 0], target: [0.5, 0, 0], cone: 80, penumbra: 0.1 }"});
    assert_true(outside.mean == 0.0);
}

static void distant_lights_and_skies(void** state)
{
    (void)state;
    check_irradiance("{ type: directional, center: [0, 3, 4], target: [0, 0, 0], irradiance: 3 }", 3 * 0.6);
    // A disc of any size gives the irradiance of its middle, while it is above the horizon.
    check_irradiance("{ type: directional, center: [0, 3, 4], target: [0, 0, 0], irradiance: 3, angle: 0.53 }",
                     3 * 0.6);
    check_irradiance("{ type: directional, center: [0, 3, 4], target: [0, 0, 0], irradiance: 3, angle: 60 }", 3 * 0.6);
    check_irradiance("{ type: environment, radiance: 0.7 }", 0.7 * PI);
    // Integral of (h + (z - h) mu^f) mu over the upper half: pi h + 2 pi (z - h) / (f + 2).
    check_irradiance("{ type: sky, zenith: 0.5, horizon: 2, ground: 9, falloff: 0.5, sun_irradiance: 0 }",
                     PI * 2 + 2 * PI * (0.5 - 2) / 2.5);
    check_irradiance("{ type: sky, zenith: 0, horizon: 0, ground: 9, sun_irradiance: 40, sun_elevation: 30, "
                     "sun_azimuth: 70, rotate: 20 }",
                     40 * 0.5);
    check_irradiance("{ type: sky, zenith: 0.5, horizon: 2, ground: 9, falloff: 0.5, sun_irradiance: 40, "
                     "sun_elevation: 90 }",
                     PI * 2 + 2 * PI * (0.5 - 2) / 2.5 + 40);
}

// --- what materials emit ---

static const char glowing[] = ", glow: { model: surface, base_color: 0, specular_weight: 0, emission_luminance: 5 }";

static void glowing_meshes_are_lights(void** state)
{
    (void)state;
    // The rectangle of before, as a plane turned over.
    stage plane = {.assets = ", plane: { shape: plane, size: [0.2, 0, 0.1] }",
                   .materials = glowing,
                   .objects = ", { mesh: plane, material: glow, visible: { camera: false }, rotate: [180, 0, 0], "
                              "translate: [0, 0.3, 0] }",
                   .lights = ""};
    check_stage(&plane, 5 * PI * 4 * corner_factor(0.2, 0.1, 0.3), 0.005);
    // Stretched and mirrored: the same.
    plane.assets = ", plane: { shape: plane, size: [0.05, 0, 0.05] }";
    plane.objects = ", { mesh: plane, material: glow, visible: { camera: false }, scale: [-4, 1, 2], rotate: [180, 0, "
                    "0], translate: [0, 0.3, 0] }";
    check_stage(&plane, 5 * PI * 4 * corner_factor(0.2, 0.1, 0.3), 0.005);
    // The outer side alone gives light.
    plane.objects = ", { mesh: plane, material: glow, visible: { camera: false }, scale: 2, translate: [0, 0.3, 0] }";
    assert_true(irradiance_on(&plane).mean == 0.0);
    // A ball of 50,000 triangles is a sphere to 1e-4.
    stage ball = {.assets = ", ball: { shape: sphere, radius: 0.1, divisions: 160 }",
                  .materials = glowing,
                  .objects = ", { mesh: ball, material: glow, translate: [0, 0.3, 0.4] }",
                  .lights = ""};
    mean_error found = irradiance_on(&ball);
    double expected = PI * 5 * 0.01 / 0.25 * 0.6;
    print_message("ball E %.6f +- %.6f expected %.6f\n", found.mean, found.error, expected);
    assert_true(fabs(found.mean - expected) <= 3 * found.error + 3e-4 * expected && found.error < 0.005 * expected);
}

// A picture that glows on one half: two columns of texels, the lookups between them left out by a sharp border.
static void write_half_bright(const char* path)
{
    enum
    {
        N = 1024
    };
    const int window[4] = {0, 0, N - 1, 0};
    ty_exr* exr = ty_exr_create(window, window);
    for (int c = 0; c < 3; c++)
    {
        const char name[2] = {"RGB"[c], 0};
        float* pixels = ty_exr_add_channel(exr, name, TY_EXR_FLOAT);
        for (int i = 0; i < N; i++)
            pixels[i] = i < N / 2 ? 1.0f : 0.0f;
    }
    assert_int_equal(ty_exr_write(path, exr, NULL), TY_OK);
    ty_exr_destroy(exr);
}

static void textured_emission(void** state)
{
    (void)state;
    write_half_bright("half_bright.exr");
    stage plane = {.assets = ", plane: { shape: plane, size: [0.2, 0, 0.1] }, half: { texture: half_bright.exr, "
                             "color_space: raw, wrap: clamp }",
                   .materials = ", glow: { model: surface, base_color: 0, specular_weight: 0, emission_luminance: 5, "
                                "emission_color: { texture: half } }",
                   .objects = ", { mesh: plane, material: glow, visible: { camera: false }, rotate: [180, 0, 0], "
                              "translate: [0, 0.3, 0] }",
                   .lights = ""};
    check_stage(&plane, 5 * PI * 2 * corner_factor(0.2, 0.1, 0.3), 0.02);
    plane.render = ", light_sampling: light";
    check_stage(&plane, 5 * PI * 2 * corner_factor(0.2, 0.1, 0.3), 0.02);
    remove("half_bright.exr");
}

// --- many ---

typedef struct crowd
{
    char lights[1 << 15];
    double points, spheres; // irradiance as points of intensity 1, or spheres of radius .004 and radiance 30
} crowd;

// 200 places in a shell around the disc, half of them below its horizon.
static crowd* crowd_make(bool spheres)
{
    crowd* c = calloc(1, sizeof *c);
    int length = 0;
    for (int i = 0; i < 200; i++)
    {
        ty_rng rng = ty_rng_make((ty_seed){8}, 1, (uint64_t)i);
        double p[3], d = 0;
        for (int k = 0; k < 3; k++)
            p[k] = (double)ty_rng_range(&rng, -0.5f, 0.5f);
        p[1] += p[1] > 0 ? 0.05 : -0.05;
        for (int k = 0; k < 3; k++)
            d += p[k] * p[k];
        length += snprintf(c->lights + length, sizeof c->lights - (size_t)length,
                           spheres ? "%s{ type: sphere, center: [%.6f, %.6f, %.6f], radius: 0.004, radiance: 30 }"
                                   : "%s{ type: point, center: [%.6f, %.6f, %.6f] }",
                           i ? ", " : "", p[0], p[1], p[2]);
        double cosine = p[1] > 0 ? p[1] / sqrt(d) : 0;
        c->points += cosine / d;
        c->spheres += PI * 30 * 0.004 * 0.004 / d * cosine;
    }
    assert_true(length < (int)sizeof c->lights);
    return c;
}

static void two_hundred_lights(void** state)
{
    (void)state;
    crowd* points = crowd_make(false);
    check_stage(&(stage){.lights = points->lights}, points->points, 0.01);
    free(points);
    crowd* spheres = crowd_make(true);
    check_stage(&(stage){.lights = spheres->lights}, spheres->spheres, 0.01);
    check_stage(&(stage){.lights = spheres->lights, .render = ", light_sampling: light"}, spheres->spheres, 0.01);
    free(spheres);
}

// Instances of a glowing prototype, twice as bright each as its attribute says.
static void glowing_aggregates_are_lights(void** state)
{
    (void)state;
    enum
    {
        N = 300
    };
    char* ply = malloc(1 << 16);
    int length =
        snprintf(ply, 1 << 16,
                 "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float "
                 "z\nproperty float glow\nend_header\n",
                 N);
    double expected = 0;
    for (int i = 0; i < N; i++)
    {
        ty_rng rng = ty_rng_make((ty_seed){9}, 1, (uint64_t)i);
        double x = (double)ty_rng_range(&rng, -0.5f, 0.5f), y = (double)ty_rng_range(&rng, 0.05f, 0.5f);
        double z = (double)ty_rng_range(&rng, -0.5f, 0.5f), glow = i % 3 ? 0.2 : 3, d = x * x + y * y + z * z;
        length += snprintf(ply + length, (1 << 16) - (size_t)length, "%.6f %.6f %.6f %.6f\n", x, y, z, glow);
        expected += PI * 2 * glow * 0.004 * 0.004 / d * y / sqrt(d);
    }
    assert_int_equal(ty_file_write("lamps.ply", ply, (size_t)length, NULL), TY_OK);
    free(ply);
    stage lamps = {.assets = ", lamp: { shape: sphere, radius: 0.004, divisions: 32 }, "
                             "lamps: { aggregate: lamps.ply, prototype: lamp }",
                   .materials = ", glow: { model: surface, base_color: 0, specular_weight: 0, "
                                "emission_luminance: { value: 2, attribute: glow } }",
                   .objects = ", { aggregate: lamps, material: glow, visible: { camera: false, shadow: false } }",
                   .lights = ""};
    mean_error found = irradiance_on(&lamps);
    print_message("lamps E %.6f +- %.6f expected %.6f\n", found.mean, found.error, expected);
    // Facets take up to 1.5 % of a ball of 32 divisions.
    assert_true(fabs(found.mean - 0.993 * expected) <= 3 * found.error + 0.007 * expected);
    assert_true(found.error < 0.02 * expected);
    remove("lamps.ply");
}

// A lamp of two millimetres, five centimetres away on a floor of metres: rays begin above the floor by more than the
// lamp's own precision and must not meet it before they should.
static void a_small_lamp_does_not_hide_itself(void** state)
{
    (void)state;
    static const char* const strategies[] = {"mis", "light"};
    for (int i = 0; i < 2; i++)
    {
        char text[2048];
        snprintf(text, sizeof text,
                 "tsuya: 1\nfilm: { size: [8, 8], filter: box, filter_width: 1, half: false }\n"
                 "render: { samples: 256, max_depth: 1, seed: 2, light_sampling: %s }\n"
                 "camera: { position: [0, 1, 0.0001], look_at: [0, 0, 0], vfov: 0.04 }\n"
                 "assets: { floor: { shape: plane, size: [20, 0, 20] }, lamp: { shape: sphere, radius: 0.002, "
                 "divisions: 128 } }\n"
                 "materials: { m: { model: surface, base_color: 1, specular_weight: 0 }%s }\n"
                 "objects: [ { mesh: floor, material: m }, { mesh: lamp, material: glow, translate: [0.05, 0.004, 0] } "
                 "]\n",
                 strategies[i], glowing);
        ty_exr* exr = render_text(text);
        mean_error found = mean_over(exr, 0, 0, 7, 7);
        ty_exr_destroy(exr);
        double d = sqrt(0.05 * 0.05 + 0.004 * 0.004), expected = 5 * 0.002 * 0.002 / (d * d) * 0.004 / d;
        print_message("%s: %.4e +- %.1e expected %.4e\n", strategies[i], found.mean, found.error, expected);
        assert_true(fabs(found.mean - expected) <= 3 * found.error + 3e-3 * expected);
    }
}

// --- a sun of half a degree in a picture of the sky, 4096 x 2048 ---

static double write_sky_with_sun(const char* path, double sky, double sun)
{
    enum
    {
        W = 4096,
        H = 2048
    };
    const int window[4] = {0, 0, W - 1, H - 1};
    ty_exr* exr = ty_exr_create(window, window);
    float* planes[3];
    for (int c = 0; c < 3; c++)
    {
        const char name[2] = {"RGB"[c], 0};
        planes[c] = ty_exr_add_channel(exr, name, TY_EXR_FLOAT);
        for (int i = 0; i < W * H; i++)
            planes[c][i] = (float)sky;
    }
    // Towards 50 degrees from above; the integral of a bilinear image is that of its texels, to the square of their
    // size.
    double irradiance = PI * sky, theta0 = 50 * PI / 180;
    for (int y = 0; y < H / 2; y++)
        for (int x = 0; x < W; x++)
        {
            double theta = PI * (y + 0.5) / H, phi = 2 * PI * ((x + 0.5) / W - 0.3);
            double c = cos(theta) * cos(theta0) + sin(theta) * sin(theta0) * cos(phi);
            if (c < cos(0.25 * PI / 180))
                continue;
            for (int k = 0; k < 3; k++)
                planes[k][y * W + x] = (float)sun;
            irradiance += (sun - sky) * cos(theta) * sin(theta) * PI / H * 2 * PI / W;
        }
    assert_int_equal(ty_exr_write(path, exr, NULL), TY_OK);
    ty_exr_destroy(exr);
    return irradiance;
}

static void a_small_bright_sun_converges(void** state)
{
    (void)state;
    double expected = write_sky_with_sun("sun.exr", 0.05, 60000);
    stage sun = {.lights = "{ type: environment, image: sun.exr, rotate: 77 }"};
    check_stage(&sun, expected, 0.01);
    sun.render = ", light_sampling: light";
    check_stage(&sun, expected, 0.01);
    remove("sun.exr");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rectangles),
        cmocka_unit_test(disks),
        cmocka_unit_test(spheres),
        cmocka_unit_test(cylinders),
        cmocka_unit_test(points_and_spots),
        cmocka_unit_test(distant_lights_and_skies),
        cmocka_unit_test(glowing_meshes_are_lights),
        cmocka_unit_test(textured_emission),
        cmocka_unit_test(two_hundred_lights),
        cmocka_unit_test(glowing_aggregates_are_lights),
        cmocka_unit_test(a_small_lamp_does_not_hide_itself),
        cmocka_unit_test(a_small_bright_sun_converges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
