// SPDX-License-Identifier: Apache-2.0
// Whole renders against formulas, and the promises: threads, tiles, crops and splits change no bit.
#include "renderer_private.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>
#include <unistd.h>

typedef struct picture
{
    ty_film* film;
    ty_render_stats stats;
} picture;

static ty_scene* scene_load(const char* yaml)
{
    char folder[] = "/tmp/tsuya_render_XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/scene.yaml", folder);
    assert_int_equal(ty_file_write(path, yaml, strlen(yaml), NULL), TY_OK);
    ty_scene* scene = NULL;
    ty_scene_options options = {.cache_folder = folder};
    ty_error_list errors = {0};
    if (ty_scene_load(path, &options, &scene, &errors))
        fail_msg("%s", errors.count ? errors.items[0].text : "the scene does not load");
    ty_error_list_term(&errors);
    unlink(path);
    rmdir(folder);
    return scene;
}

static picture render_crop(const ty_scene* scene, const int crop[4], int begin, int end, int threads)
{
    ty_film_setup setup = {.size = {scene->film.size[0], scene->film.size[1]},
                           .crop = {crop[0], crop[1], crop[2], crop[3]},
                           .sample_begin = begin,
                           .sample_end = end,
                           .aovs = TY_AOV_ALL};
    picture p;
    ty_workers* workers;
    assert_int_equal(ty_workers_create(threads, &workers, NULL), TY_OK);
    assert_int_equal(ty_film_create(&setup, &p.film, NULL), TY_OK);
    ty_render_options options = {.sample_begin = begin, .sample_end = end};
    assert_int_equal(ty_render(scene, &options, workers, p.film, &p.stats, NULL), TY_OK);
    ty_workers_destroy(workers);
    return p;
}

static picture render_all(const ty_scene* scene, int samples, int threads)
{
    int crop[4] = {0, 0, scene->film.size[0] - 1, scene->film.size[1] - 1};
    return render_crop(scene, crop, 0, samples, threads);
}

static void assert_same_pixel(const picture* a, const picture* b, int x, int y)
{
    ty_pixel_sums p = ty_film_pixel(a->film, x, y), q = ty_film_pixel(b->film, x, y);
    bool same = p.luminance_sqr == q.luminance_sqr && p.luminance == q.luminance && p.samples == q.samples &&
                p.covered == q.covered && p.first_sample == q.first_sample && p.first_instance == q.first_instance &&
                p.first_depth == q.first_depth && !memcmp(p.radiance, q.radiance, sizeof p.radiance) &&
                !memcmp(p.normal, q.normal, sizeof p.normal) && !memcmp(p.albedo, q.albedo, sizeof p.albedo) &&
                !memcmp(&p.first_position, &q.first_position, sizeof p.first_position);
    if (!same)
        fail_msg("pixel %d,%d differs", x, y);
}

// Everything there is in one picture: area, environment and delta lights, lens, and every material.
static const char* const rich =
    "tsuya: 1\n"
    "film: { size: [70, 45] }\n"
    "render: { samples: 16, max_depth: 8, seed: 5 }\n"
    "camera: { position: [0, 0.25, 0.6], look_at: [0, 0.03, 0], vfov: 30, f_stop: 2 }\n"
    "assets:\n"
    "  floor: { shape: plane, size: [0.5, 0, 0.5] }\n"
    "  ball: { shape: sphere, radius: 0.04, divisions: 32 }\n"
    "materials:\n"
    "  white: { model: surface, base_color: 0.7, specular_roughness: 0.4 }\n"
    "  glass: { model: surface, transmission_weight: 1, specular_roughness: 0 }\n"
    "  wax: { model: cdrf, color: 0.8, mean_free_path: 5 }\n"
    "  skin: { model: cdrf, color: [0.8, 0.6, 0.4], mean_free_path: 5, mean_free_path_scale: [1, 0.4, 0.2] }\n"
    "  probed: { model: cdrf, color: 0.8, mean_free_path: 5, evaluate: probe }\n"
    "  local: { model: cdrf, color: 0.8, mean_free_path: 5, evaluate: local }\n"
    "  milk: { model: walk, preset: skim_milk }\n"
    "  jelly: { model: walk, boundary: dielectric, subsurface_color: [0.8, 0.6, 0.4], subsurface_radius: 3 }\n"
    "  mist: { model: surface, transmission_weight: 1, transmission_depth: 0.01, transmission_scatter: [1, 2, 3] }\n"
    "  layers: { model: surface, base_metalness: 0.3, base_diffuse_roughness: 1, coat_weight: 0.5, fuzz_weight: 0.5, "
    "specular_roughness_anisotropy: 0.5, subsurface_weight: 0.5, opacity: 0.8 }\n"
    "  leaf: { model: surface, thin_walled: true, subsurface_weight: 1, transmission_weight: 0.3 }\n"
    "objects:\n"
    "  - { mesh: floor, material: white }\n"
    "  - { mesh: ball, material: skin, translate: [-0.1, 0.1, 0], scale: [0.4, 0.3, 0.4] }\n"
    "  - { mesh: ball, material: probed, translate: [-0.06, 0.1, 0], scale: [0.4, 0.3, 0.4] }\n"
    "  - { mesh: ball, material: local, translate: [-0.02, 0.1, 0], scale: [0.4, 0.3, 0.4] }\n"
    "  - { mesh: ball, material: milk, translate: [0.02, 0.1, 0], scale: [0.4, 0.4, 0.4] }\n"
    "  - { mesh: ball, material: jelly, translate: [-0.1, 0.016, 0.06], scale: [0.4, 0.4, 0.4] }\n"
    "  - { mesh: ball, material: mist, translate: [-0.06, 0.016, 0.06], scale: [0.4, 0.4, 0.4] }\n"
    "  - { mesh: ball, material: layers, translate: [-0.02, 0.016, 0.06], scale: [0.4, 0.4, 0.4] }\n"
    "  - { mesh: ball, material: leaf, translate: [0.02, 0.016, 0.06], scale: [0.4, 0.4, 0.1] }\n"
    "  - { mesh: ball, material: glass, translate: [-0.06, 0.04, 0] }\n"
    "  - { mesh: ball, material: wax, translate: [0.06, 0.04, 0] }\n"
    "lights:\n"
    "  - { type: environment, radiance: 0.2 }\n"
    "  - { type: rectangle, center: [-0.2, 0.3, 0.1], target: [0, 0, 0], size: [0.1, 0.1], radiance: 20 }\n"
    "  - { type: sphere, center: [0.2, 0.2, -0.1], radius: 0.02, radiance: 40 }\n"
    "  - { type: point, center: [0, 0.3, 0], intensity: 0.05 }\n"
    "  - { type: directional, center: [1, 1, 0], target: [0, 0, 0], irradiance: 0.5 }\n";

static void test_threads_tiles_and_splits_change_nothing(void** state)
{
    (void)state;
    ty_scene* scene = scene_load(rich);
    picture one = render_all(scene, 16, 1), two = render_all(scene, 16, 2), three = render_all(scene, 16, 3);
    const int whole[4] = {0, 0, 69, 44}, crop[4] = {13, 7, 41, 30};
    picture part = render_crop(scene, crop, 0, 16, 2);
    picture low = render_crop(scene, whole, 0, 5, 2), high = render_crop(scene, whole, 5, 16, 2);
    for (int y = 0; y < 45; ++y)
        for (int x = 0; x < 70; ++x)
        {
            assert_same_pixel(&one, &two, x, y);
            assert_same_pixel(&one, &three, x, y);
            if (x >= 13 && x <= 41 && y >= 7 && y <= 30)
                assert_same_pixel(&one, &part, x, y);
            ty_pixel_sums sums = ty_film_pixel(high.film, x, y);
            ty_film_commit(low.film, x, y, &sums);
            assert_same_pixel(&one, &low, x, y);
        }
    assert_int_equal(one.stats.camera_rays, 70 * 45 * 16);
    assert_int_equal(one.stats.path_rays, three.stats.path_rays);
    assert_int_equal(one.stats.shadow_rays, three.stats.shadow_rays);
    assert_true(one.stats.path_rays > 0 && one.stats.shadow_rays > 0 && one.stats.interior_rays > 0);
    assert_int_equal(one.stats.nonfinite_samples, 0);
    assert_int_equal(one.stats.first_nonfinite[0], -1);
    picture* all[] = {&one, &two, &three, &part, &low, &high};
    for (int i = 0; i < 6; ++i)
        ty_film_destroy(all[i]->film);
    ty_scene_destroy(scene);
}

// Mean green over the whole film and its standard error, from the pixels' own scatter.
static void mean_of(const ty_film* film, double* mean, double* error)
{
    int n = film->width * film->height;
    double sum = 0.0, square = 0.0;
    for (int y = 0; y < film->height; ++y)
        for (int x = 0; x < film->width; ++x)
        {
            ty_pixel_sums p = ty_film_pixel(film, x, y);
            double v = (double)(int64_t)p.radiance[1] / (TY_FILM_SCALE * p.samples);
            sum += v;
            square += v * v;
        }
    *mean = sum / n;
    *error = sqrt(fmax(0.0, square / n - *mean * *mean) / (n - 1));
}

// A white floor of albedo 1/2 in the plane y = 0, seen straight from above through a narrow lens around the origin:
// radiance = irradiance / (2 pi).
static picture render_floor(const char* lights, const char* more)
{
    char yaml[4096];
    snprintf(yaml, sizeof yaml,
             "tsuya: 1\n"
             "film: { size: [32, 32], filter: box, filter_width: 1 }\n"
             "render: { samples: 64, max_depth: 1, seed: 3 }\n"
             "camera: { position: [0, 20, 0], look_at: [0, 0, 0], up: [0, 0, -1], vfov: 0.02 }\n"
             "assets: { floor: { shape: plane, size: [5, 0, 5] }, lid: { shape: plane, size: [0.1, 0, 0.1] } }\n"
             "materials:\n"
             "  grey: { model: surface, base_color: 0.5, specular_weight: 0 }\n"
             "objects:\n"
             "  - { mesh: floor, material: grey }\n%s"
             "lights:\n%s",
             more, lights);
    ty_scene* scene = scene_load(yaml);
    picture p = render_all(scene, 64, 2);
    ty_scene_destroy(scene);
    return p;
}

static void assert_irradiance(const char* what, const char* lights, double expected)
{
    picture p = render_floor(lights, "");
    double mean, error;
    mean_of(p.film, &mean, &error);
    double irradiance = mean * 2.0 * 3.14159265358979;
    error = error * 2.0 * 3.14159265358979 + 2e-5 * expected; // fixed point and float
    if (fabs(irradiance - expected) > 3.0 * error || error > 0.02 * expected)
        fail_msg("%s: irradiance %.6g +- %.2g, expected %.6g", what, irradiance, error, expected);
    ty_film_destroy(p.film);
}

// Disc-like formulas: a rectangle's corner over a point (Howell's C-11), four of them around the centre.
static double rectangle_irradiance(double half_x, double half_y, double height)
{
    double a = half_x / height, b = half_y / height, u = sqrt(1.0 + a * a), v = sqrt(1.0 + b * b);
    return 4.0 * 0.5 * (a / u * atan(b / u) + b / v * atan(a / v)); // times radiance
}

static void test_irradiance_of_lights(void** state)
{
    (void)state;
    const double pi = 3.14159265358979;
    assert_irradiance(
        "near rectangle",
        "  - { type: rectangle, center: [0, 1, 0], target: [0, 0, 0], up: [0, 0, 1], size: [2, 1], radiance: 3, "
        "camera_visible: false }\n",
        3.0 * rectangle_irradiance(1.0, 0.5, 1.0));
    assert_irradiance(
        "far rectangle",
        "  - { type: rectangle, center: [0, 4, 0], target: [0, 0, 0], up: [0, 0, 1], size: [0.5, 1], radiance: "
        "30, camera_visible: false }\n",
        30.0 * rectangle_irradiance(0.25, 0.5, 4.0));
    // A sphere at distance d, angle a off the normal and all above the horizon: pi L (r/d)^2 cos a.
    assert_irradiance("sphere", "  - { type: sphere, center: [1, 2, 0], radius: 0.5, radiance: 7 }\n",
                      pi * 7.0 * 0.25 / 5.0 * 2.0 / sqrt(5.0));
    assert_irradiance("sphere around",
                      "  - { type: sphere, center: [0, 0, 0], radius: 3, radiance: 2, camera_visible: false }\n",
                      2.0 * pi);
    assert_irradiance("point at 1 m", "  - { type: point, center: [0, 1, 0], intensity: 5 }\n", 5.0);
    assert_irradiance("point at 2 m", "  - { type: point, center: [0, 2, 0], intensity: 5 }\n", 1.25);
    assert_irradiance("point aslant", "  - { type: point, center: [0, 3, 4], intensity: 5 }\n", 5.0 / 25.0 * 0.6);
    assert_irradiance("directional", "  - { type: directional, center: [0, 1, 1], target: [0, 0, 0], irradiance: 2 }\n",
                      2.0 * sqrt(0.5));
    assert_irradiance("environment", "  - { type: environment, radiance: 0.25 }\n", 0.25 * pi);
    assert_irradiance(
        "many at once",
        "  - { type: environment, radiance: 0.25 }\n"
        "  - { type: point, center: [0, 2, 0], intensity: 5 }\n"
        "  - { type: sphere, center: [1, 2, 0], radius: 0.5, radiance: 7 }\n"
        "  - { type: rectangle, center: [0, 1, 0], target: [0, 0, 0], up: [0, 0, 1], size: [2, 1], radiance: 3, "
        "camera_visible: false }\n",
        0.25 * pi + 1.25 + pi * 7.0 * 0.25 / 5.0 * 2.0 / sqrt(5.0) + 3.0 * rectangle_irradiance(1.0, 0.5, 1.0));
}

// A lid on the way takes all the light, one beyond the lamp none, and a lamp under the floor lights nothing above it.
static void test_shadows(void** state)
{
    (void)state;
    const char* lamp = "  - { type: point, center: [1, 1, 0], intensity: 5 }\n";
    const struct
    {
        const char *light, *lid;
        double expected;
    } cases[] = {
        {lamp, "  - { mesh: lid, material: grey, translate: [0.5, 0.5, 0] }\n", 0.0},
        {lamp, "  - { mesh: lid, material: grey, translate: [2, 2, 0] }\n", 5.0 / 2.0 * sqrt(0.5)},
        {lamp, "  - { mesh: lid, material: grey, translate: [0, 0.5, 0] }\n",
         5.0 / 1.25 * 0.5 / sqrt(1.25)}, // on the lid
        {"  - { type: point, center: [0, -2, 0], intensity: 5 }\n", "", 0.0},
    };
    for (int i = 0; i < 4; ++i)
    {
        picture p = render_floor(cases[i].light, cases[i].lid);
        double mean, error;
        mean_of(p.film, &mean, &error);
        if (fabs(mean * 2.0 * 3.14159265358979 - cases[i].expected) > 1e-3)
            fail_msg("case %d: irradiance %g, expected %g", i, mean * 2.0 * 3.14159265358979, cases[i].expected);
        ty_film_destroy(p.film);
    }
}

// A wall in a lamp's own plane takes none of its light, from whichever sampling.
static void test_lamp_in_a_wall(void** state)
{
    (void)state;
    const char* lamp =
        "  - { type: rectangle, center: [-1, 1.5, 0], target: [0, 1.5, 0], size: [3, 3], radiance: 4 }\n";
    const char* wall = "  - { mesh: floor, material: grey, translate: [-1, 1.5, 0], rotate: [0, 20, -90] }\n";
    double mean[2], error[2];
    for (int i = 0; i < 2; ++i)
    {
        picture p = render_floor(lamp, i ? wall : "");
        mean_of(p.film, &mean[i], &error[i]);
        ty_film_destroy(p.film);
    }
    if (fabs(mean[0] - mean[1]) > 1e-3 * mean[0])
        fail_msg("radiance %g alone, %g in the wall", mean[0], mean[1]);
}

static picture render_yaml(const char* yaml, int samples)
{
    ty_scene* scene = scene_load(yaml);
    picture p = render_all(scene, samples, 2);
    ty_scene_destroy(scene);
    return p;
}

// Inside a closed, glowing box of albedo 1/2 the light is Le (1 + 1/2 + 1/4 + ...), by roulette or without.
static void test_roulette_is_unbiased(void** state)
{
    (void)state;
    const int roulette_depths[] = {1, 4, 64};
    for (int i = 0; i < 3; ++i)
    {
        char yaml[2048];
        snprintf(
            yaml, sizeof yaml,
            "tsuya: 1\n"
            "film: { size: [32, 32] }\n"
            "render: { max_depth: 64, roulette_depth: %d, seed: 4 }\n"
            "camera: { position: [0, 0, 0], look_at: [0, 0, -1], vfov: 60 }\n"
            "assets: { wall: { shape: plane, size: [1.1, 0, 1.1] } }\n"
            "materials:\n"
            "  m: { model: surface, base_color: 0.5, specular_weight: 0, emission_luminance: 3, emission_color: 1 }\n"
            "objects:\n"
            "  - { mesh: wall, material: m, translate: [0, -1, 0] }\n"
            "  - { mesh: wall, material: m, translate: [0, 1, 0], rotate: [180, 0, 0] }\n"
            "  - { mesh: wall, material: m, translate: [0, 0, -1], rotate: [90, 0, 0] }\n"
            "  - { mesh: wall, material: m, translate: [0, 0, 1], rotate: [-90, 0, 0] }\n"
            "  - { mesh: wall, material: m, translate: [-1, 0, 0], rotate: [0, 0, -90] }\n"
            "  - { mesh: wall, material: m, translate: [1, 0, 0], rotate: [0, 0, 90] }\n",
            roulette_depths[i]);
        picture p = render_yaml(yaml, 64);
        double mean, error;
        mean_of(p.film, &mean, &error);
        if (fabs(mean - 6.0) > 3.0 * error + 1e-4 || error > 0.02)
            fail_msg("roulette from %d: %g +- %g, expected 6", roulette_depths[i], mean, error);
        // No path ends before the roulette begins, and few go on for long after.
        uint64_t certain = p.stats.camera_rays * (uint64_t)(roulette_depths[i] - 1);
        assert_true(p.stats.path_rays >= certain && (i == 2 || p.stats.path_rays < 12 * p.stats.camera_rays));
        ty_film_destroy(p.film);
    }
}

// Through the centre of a glass ball: F + (1-F)^2 t (1 + F t + ...), t = 1/4 over twice the tint's depth.
static void test_glass_absorbs_along_the_way(void** state)
{
    (void)state;
    picture p = render_yaml("tsuya: 1\n"
                            "film: { size: [8, 8] }\n"
                            "render: { max_depth: 32, roulette_depth: 32 }\n"
                            "camera: { position: [0, 0, 1], look_at: [0, 0, 0], vfov: 0.05 }\n"
                            "assets: { ball: { shape: sphere, radius: 0.05, divisions: 128 } }\n"
                            "materials:\n"
                            "  m: { model: surface, transmission_weight: 1, transmission_color: 0.5,\n"
                            "       transmission_depth: 0.05, specular_roughness: 0, specular_ior: 1.5 }\n"
                            "objects: [ { mesh: ball, material: m, rotate: [10, 20, 30] } ]\n"
                            "lights: [ { type: environment, radiance: 1 } ]\n",
                            256);
    double mean, error, expected = 0.04 + 0.96 * 0.96 * 0.25 / (1.0 - 0.04 * 0.25);
    mean_of(p.film, &mean, &error);
    if (fabs(mean - expected) > 3.0 * error + 1e-3 || error > 0.003)
        fail_msg("%g +- %g, expected %g", mean, error, expected);
    ty_film_destroy(p.film);
}

// Under a wide roof 5 cm above the floor: open to rays of 4 cm, closed to rays of 5 m.
static void test_ambient_occlusion_knows_its_distance(void** state)
{
    (void)state;
    ty_scene* scene = scene_load("tsuya: 1\n"
                                 "film: { size: [8, 8] }\n"
                                 "render: { integrator: ao }\n"
                                 "camera: { position: [0, 0.04, 0], look_at: [0, 0, 0], up: [0, 0, -1], vfov: 1 }\n"
                                 "assets: { plane: { shape: plane, size: [100, 0, 100] } }\n"
                                 "materials: { m: { model: surface } }\n"
                                 "objects:\n"
                                 "  - { mesh: plane, material: m }\n"
                                 "  - { mesh: plane, material: m, translate: [0, 0.05, 0] }\n");
    const float distances[] = {0.04f, 5.0f}, expected[] = {1.0f, 0.0f};
    for (int i = 0; i < 2; ++i)
    {
        scene->render.ao_distance = distances[i];
        picture p = render_all(scene, 16, 1);
        double mean, error;
        mean_of(p.film, &mean, &error);
        assert_true(fabs(mean - (double)expected[i]) < 0.01); // the lowest rays miss the roof within 5 m
        ty_film_destroy(p.film);
    }
    ty_scene_destroy(scene);
}

// A tiny sun in an image over a dim sky: light sampling and rays share it without bias.
static void test_environment_image_with_a_sun(void** state)
{
    (void)state;
    enum
    {
        WIDTH = 128,
        HEIGHT = 64,
        SUN_X = 40,
        SUN_Y = 20
    };
    const double pi = 3.14159265358979, sun = 20000.0, sky = 0.1;
    char path[] = "/tmp/tsuya_sun_XXXXXX.exr", light[256];
    int file = mkstemps(path, 4);
    assert_true(file >= 0);
    close(file);
    int window[4] = {0, 0, WIDTH - 1, HEIGHT - 1};
    ty_exr* exr = ty_exr_create(window, window);
    const char* names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c)
    {
        float* pixels = ty_exr_add_channel(exr, names[c], TY_EXR_FLOAT);
        for (int i = 0; i < WIDTH * HEIGHT; ++i)
            pixels[i] = (float)sky;
        pixels[SUN_Y * WIDTH + SUN_X] = (float)sun;
    }
    assert_int_equal(ty_exr_write(path, exr, NULL), TY_OK);
    ty_exr_destroy(exr);
    // The bilinear tent of one texel: integral of tent * cos * sin over the angle from above, by quadrature.
    double vertical = 0.0;
    int steps = 2000;
    for (int i = 0; i < steps; ++i)
    {
        double offset = 2.0 * (i + 0.5) / steps - 1.0, theta = pi * (SUN_Y + 0.5 + offset) / HEIGHT;
        vertical += (1.0 - fabs(offset)) * sin(theta) * cos(theta) * (2.0 / steps) * pi / HEIGHT;
    }
    double expected = sky * pi + (sun - sky) * vertical * 2.0 * pi / WIDTH;
    snprintf(light, sizeof light, "  - { type: environment, image: %s, color_space: raw, rotate: 25 }\n", path);
    assert_irradiance("sky with a sun", light, expected);
    unlink(path);
}

// A convex body in a constant environment shows its albedo times that, and with albedo 1 cannot be told from it.
static void test_furnace(void** state)
{
    (void)state;
    const struct
    {
        const char* material;
        double expected, tolerance;
    } cases[] = {{"model: surface, base_color: 1, specular_weight: 0", 0.5, 1e-5},
                 {"model: cdrf, color: 0.6, specular_weight: 0, mean_free_path: 5", 0.3, 0.05}};
    for (int i = 0; i < 2; ++i)
    {
        char yaml[1024];
        snprintf(yaml, sizeof yaml,
                 "tsuya: 1\n"
                 "film: { size: [24, 24] }\n"
                 "render: { max_depth: 64, roulette_depth: 3, seed: 2 }\n"
                 "camera: { position: [0, 0, 1], look_at: [0, 0, 0], vfov: 4 }\n"
                 "assets: { ball: { shape: sphere, radius: 0.03, divisions: 64 } }\n"
                 "materials: { m: { %s } }\n"
                 "objects: [ { mesh: ball, material: m } ]\n"
                 "lights: [ { type: environment, radiance: 0.5 } ]\n",
                 cases[i].material);
        picture p = render_yaml(yaml, 16);
        int covered = 0;
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x)
            {
                ty_pixel_sums sums = ty_film_pixel(p.film, x, y);
                double value = (double)ty_fixed_mean(sums.radiance[1], sums.samples);
                double expected = sums.covered == 16 ? cases[i].expected : 0.5;
                covered += sums.covered == 16;
                if ((sums.covered == 16 || sums.covered == 0) && fabs(value - expected) > cases[i].tolerance)
                    fail_msg("case %d, pixel %d,%d: %g, expected %g", i, x, y, value, expected);
            }
        assert_true(covered > 100 && covered < 24 * 24);
        ty_film_destroy(p.film);
    }
}

// P, Z, N, instance and coverage of what the camera sees agree with its matrices.
static void test_channels_describe_the_scene(void** state)
{
    (void)state;
    ty_scene* scene =
        scene_load("tsuya: 1\n"
                   "film: { size: [40, 30], filter: box, filter_width: 0.02 }\n"
                   "camera: { position: [0.3, 0.4, 1], look_at: [0, 0, 0], vfov: 12 }\n"
                   "assets: { ball: { shape: sphere, radius: 0.05, divisions: 64 } }\n"
                   "materials: { red: { model: surface, base_color: [0.8, 0.2, 0.1], specular_weight: 0 } }\n"
                   "objects:\n"
                   "  - { mesh: ball, material: red, translate: [-0.06, 0, 0] }\n"
                   "  - { mesh: ball, material: red, translate: [0.06, 0, 0] }\n"
                   "lights: [ { type: environment, radiance: 1 } ]\n");
    picture p = render_all(scene, 4, 2);
    ty_camera camera;
    ty_camera_init(&camera, &scene->camera, scene->film.size);
    float m[16];
    ty_camera_world_to_ndc(&camera, m);
    int seen[3] = {0};
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x)
        {
            ty_pixel_sums s = ty_film_pixel(p.film, x, y);
            assert_true(s.first_instance <= 2);
            seen[s.first_instance]++;
            if (s.first_sample == TY_FILM_NO_SAMPLE)
            {
                assert_true(s.covered == 0 && s.first_depth == TY_FILM_Z_NONE);
                continue;
            }
            ty_vec3 q = s.first_position;
            float w = q.x * m[3] + q.y * m[7] + q.z * m[11] + m[15];
            assert_true(fabsf((q.x * m[0] + q.y * m[4] + q.z * m[8] + m[12]) / w * 40.0f - (float)x - 0.5f) < 0.02f);
            assert_true(fabsf((q.x * m[1] + q.y * m[5] + q.z * m[9] + m[13]) / w * 30.0f - (float)y - 0.5f) < 0.02f);
            assert_true(fabsf(w - s.first_depth) < 1e-5f);
            ty_vec3 centre = {s.first_instance == 1 ? -0.06f : 0.06f, 0.0f, 0.0f};
            assert_true(fabsf(ty_length(ty_sub(q, centre)) - 0.05f) < 5e-4f);
            if (s.covered < 4)
                continue;
            ty_vec3 n = {ty_fixed_mean(s.normal[0], 4), ty_fixed_mean(s.normal[1], 4), ty_fixed_mean(s.normal[2], 4)};
            assert_true(ty_dot(n, ty_normalize(ty_sub(q, centre))) > 0.99f);
            assert_true(fabsf(ty_fixed_mean(s.albedo[0], 4) - 0.8f) < 1e-5f);
        }
    assert_true(seen[0] > 100 && seen[1] > 100 && seen[2] > 100);
    ty_film_destroy(p.film);
    ty_scene_destroy(scene);
}

static void test_lights_seen_by_the_camera(void** state)
{
    (void)state;
    const char* yaml = "tsuya: 1\n"
                       "film: { size: [16, 16] }\n"
                       "camera: { position: [0, 0, 1], look_at: [0, 0, 0], vfov: 10 }\n"
                       "assets: { ball: { shape: sphere, radius: 0.01, divisions: 16 } }\n"
                       "materials: { white: { model: surface } }\n"
                       "objects: [ { mesh: ball, material: white, translate: [0, 9, 0] } ]\n"
                       "lights:\n"
                       "  - { type: rectangle, center: [0, 0, 0], target: [0, 0, 1], size: [1, 1], radiance: 4 }\n"
                       "  - { type: rectangle, center: [0, 0, 0.1], target: [0, 0, 0], size: [1, 1], radiance: 100 }\n";
    ty_scene* scene = scene_load(yaml);
    picture p = render_all(scene, 4, 1); // the second one faces away: its back is dark
    ty_pixel_sums s = ty_film_pixel(p.film, 8, 8);
    assert_true(fabsf(ty_fixed_mean(s.radiance[0], 4) - 4.0f) < 1e-5f);
    assert_true(s.covered == 4 && s.first_sample == TY_FILM_NO_SAMPLE);
    ty_film_destroy(p.film);
    scene->lights[0].camera_visible = false;
    p = render_all(scene, 4, 1);
    s = ty_film_pixel(p.film, 8, 8);
    assert_true(s.radiance[0] == 0 && s.covered == 0);
    ty_film_destroy(p.film);
    ty_scene_destroy(scene);
}

static void test_nonfinite_samples_are_reported_alike(void** state)
{
    (void)state;
    ty_scene* scene = scene_load(rich);
    scene->lights[3].intensity.g = INFINITY; // past the scene's own range check
    picture one = render_all(scene, 8, 1), three = render_all(scene, 8, 3);
    assert_true(one.stats.nonfinite_samples > 0);
    assert_int_equal(one.stats.nonfinite_samples, three.stats.nonfinite_samples);
    assert_memory_equal(one.stats.first_nonfinite, three.stats.first_nonfinite, sizeof one.stats.first_nonfinite);
    // In (y, x, sample) order: no earlier pixel has a bad sample.
    const int* first = one.stats.first_nonfinite;
    int crop[4] = {first[0], first[1], first[0], first[1]};
    picture alone = render_crop(scene, crop, first[2], first[2] + 1, 1);
    assert_int_equal(alone.stats.nonfinite_samples, 1);
    if (first[1] > 0)
    {
        picture above = render_crop(scene, (int[4]){0, 0, 69, first[1] - 1}, 0, 8, 2);
        assert_int_equal(above.stats.nonfinite_samples, 0);
        ty_film_destroy(above.film);
    }
    ty_film_destroy(alone.film);
    ty_film_destroy(one.film);
    ty_film_destroy(three.film);
    ty_scene_destroy(scene);
}

// --- passes, stopping ---

typedef struct pass_log
{
    int passes, samples[32];
    int stop_after; // passes
    bool cancel;
} pass_log;

static bool on_pass(void* context, const ty_film* film, int sample_end, double seconds)
{
    pass_log* log = context;
    assert_true(seconds >= 0.0);
    for (int x = 0; x < 70; x += 23)
        assert_int_equal(ty_film_pixel(film, x, 20).samples, sample_end - 10);
    log->samples[log->passes++] = sample_end - 10;
    if (log->cancel && log->passes == log->stop_after)
        ty_cancel_request(15);
    return log->cancel || log->passes != log->stop_after;
}

static ty_status render_logged(const ty_scene* scene, pass_log* log, ty_film** film, ty_render_stats* stats)
{
    ty_film_setup setup = {
        .size = {70, 45}, .crop = {0, 0, 69, 44}, .sample_begin = 10, .sample_end = 60, .half = true};
    assert_int_equal(ty_film_create(&setup, film, NULL), TY_OK);
    ty_render_options options = {.sample_begin = 10, .sample_end = 60, .on_pass = on_pass, .pass_context = log};
    ty_error error;
    return ty_render(scene, &options, NULL, *film, stats, &error);
}

static void test_passes_and_stops(void** state)
{
    (void)state;
    ty_scene* scene = scene_load(rich);
    ty_film* film;
    ty_render_stats stats;
    pass_log log = {0};
    assert_int_equal(render_logged(scene, &log, &film, &stats), TY_OK);
    const int expected[] = {4, 8, 16, 32, 50};
    assert_int_equal(log.passes, 5);
    assert_memory_equal(log.samples, expected, sizeof expected);
    assert_int_equal(stats.samples_done, 50);
    ty_film_destroy(film);
    log = (pass_log){.stop_after = 2};
    assert_int_equal(render_logged(scene, &log, &film, &stats), TY_OK);
    assert_int_equal(stats.samples_done, 8);
    ty_film_destroy(film);
    log = (pass_log){.stop_after = 3, .cancel = true};
    assert_int_equal(render_logged(scene, &log, &film, &stats), TY_TERMINATED);
    ty_cancel_clear();
    assert_int_equal(stats.samples_done, 16);
    assert_int_equal(ty_film_pixel(film, 69, 44).samples, 16);
    ty_film_destroy(film);
    ty_scene_destroy(scene);
}

static void test_debug_integrators(void** state)
{
    (void)state;
    ty_scene* scene =
        scene_load("tsuya: 1\n"
                   "film: { size: [9, 9], filter: box, filter_width: 0.1 }\n"
                   "render: { ao_distance: 0.1, curvature_scale: 0.01 }\n"
                   "camera: { position: [0, 0, 1], look_at: [0, 0, 0], vfov: 8 }\n"
                   "assets: { ball: { shape: sphere, radius: 0.05, divisions: 96 } }\n"
                   "materials: { m: { model: surface, base_color: [0.6, 0.3, 0.2], specular_weight: 0 } }\n"
                   "objects: [ { mesh: ball, material: m, scale: 2 } ]\n"
                   "lights: [ { type: environment, radiance: 1 } ]\n");
    const struct
    {
        int integrator;
        float r, g, b;
    } cases[] = {{TY_INTEGRATOR_ALBEDO, 0.6f, 0.3f, 0.2f},
                 {TY_INTEGRATOR_NORMAL, 0.5f, 0.5f, 1.0f},
                 {TY_INTEGRATOR_CURVATURE, 0.6f, 0.6f, 0.6f}, // 10/m times 10 mm around one half
                 {TY_INTEGRATOR_AO, 1.0f, 1.0f, 1.0f}};
    for (int i = 0; i < 4; ++i)
    {
        scene->render.integrator = cases[i].integrator;
        picture p = render_all(scene, 8, 1);
        ty_pixel_sums s = ty_film_pixel(p.film, 4, 4);
        float r = ty_fixed_mean(s.radiance[0], 8), g = ty_fixed_mean(s.radiance[1], 8),
              b = ty_fixed_mean(s.radiance[2], 8);
        if (fabsf(r - cases[i].r) > 0.005f || fabsf(g - cases[i].g) > 0.005f || fabsf(b - cases[i].b) > 0.005f)
            fail_msg("integrator %d: %g %g %g", cases[i].integrator, (double)r, (double)g, (double)b);
        ty_film_destroy(p.film);
    }
    ty_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads_tiles_and_splits_change_nothing),
        cmocka_unit_test(test_irradiance_of_lights),
        cmocka_unit_test(test_shadows),
        cmocka_unit_test(test_lamp_in_a_wall),
        cmocka_unit_test(test_roulette_is_unbiased),
        cmocka_unit_test(test_glass_absorbs_along_the_way),
        cmocka_unit_test(test_ambient_occlusion_knows_its_distance),
        cmocka_unit_test(test_environment_image_with_a_sun),
        cmocka_unit_test(test_furnace),
        cmocka_unit_test(test_channels_describe_the_scene),
        cmocka_unit_test(test_lights_seen_by_the_camera),
        cmocka_unit_test(test_nonfinite_samples_are_reported_alike),
        cmocka_unit_test(test_passes_and_stops),
        cmocka_unit_test(test_debug_integrators),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
