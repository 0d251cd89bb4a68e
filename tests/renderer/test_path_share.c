// SPDX-License-Identifier: Apache-2.0
// Shared paths: the same light with less noise, in every bit a function of pixel and sample, and only where they can
// be.
#include "renderer_private.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/renderer/render.h>
#include <unistd.h>

enum
{
    WIDTH = 37, // the last column and row of blocks are cut
    HEIGHT = 25
};

// Balls of all kinds on a floor, near each other so that light goes between them, under a lamp near enough that rays
// find it often. %s: render keys, material of one ball, lights.
static const char room[] =
    "tsuya: 1\n"
    "film: { size: [37, 25], filter: box, filter_width: 1 }\n"
    "render: { max_depth: 6, roulette_depth: 2, seed: 3, %s }\n"
    "camera: { position: [0, 0.25, 0.6], look_at: [0, 0.03, 0], vfov: 28 }\n"
    "assets:\n"
    "  floor: { shape: plane, size: [1, 0, 1] }\n"
    "  ball: { shape: sphere, radius: 0.05, divisions: 32 }\n"
    "materials:\n"
    "  clay: { model: surface, base_color: [0.9, 0.6, 0], specular_weight: 0 }\n"
    "  chalk: { model: surface, base_color: 0.8, specular_weight: 0 }\n"
    "  other: { %s }\n"
    "  glow: { model: surface, base_color: 0.5, specular_weight: 0, emission_luminance: 2, emission_color: 1 }\n"
    "objects:\n"
    "  - { mesh: floor, material: chalk }\n"
    "  - { mesh: ball, material: clay, translate: [-0.055, 0.05, 0] }\n"
    "  - { mesh: ball, material: other, translate: [0.055, 0.05, 0] }\n"
    "  - { mesh: ball, material: chalk, translate: [0, 0.05, 0.09] }\n"
    "  - { mesh: ball, material: glow, translate: [0.12, 0.05, 0.1] }\n"
    "lights:\n%s";
static const char lamps[] =
    "  - { type: environment, radiance: 0.3 }\n"
    "  - { type: rectangle, center: [-0.1, 0.2, 0.1], target: [0, 0, 0], size: [0.2, 0.2], radiance: 4, group: lamp }\n"
    "  - { type: directional, center: [1, 1, 0], target: [0, 0, 0], irradiance: 1, angle: 40 }\n";
static const char metal[] = "model: surface, base_metalness: 1, base_color: 0.9, specular_roughness: 0.3";

static ty_scene* load(const char* render, const char* material, const char* lights)
{
    char folder[] = "/tmp/tsuya_share_XXXXXX", path[64], yaml[4096];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/scene.yaml", folder);
    snprintf(yaml, sizeof yaml, room, render, material, lights);
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

static ty_film* render_part(const ty_scene* scene, const int crop[4], int begin, int end, int threads,
                            ty_render_stats* stats)
{
    ty_film_setup setup = {.size = {scene->film.size[0], scene->film.size[1]},
                           .crop = {crop[0], crop[1], crop[2], crop[3]},
                           .sample_begin = begin,
                           .sample_end = end,
                           .aovs = TY_AOV_ALL | TY_AOV_LIGHT,
                           .groups = scene->light_groups,
                           .group_count = scene->light_group_count};
    ty_film* film;
    ty_workers* workers;
    assert_int_equal(ty_workers_create(threads, &workers, NULL), TY_OK);
    assert_int_equal(ty_film_create(&setup, &film, NULL), TY_OK);
    ty_render_options options = {.sample_begin = begin, .sample_end = end};
    assert_int_equal(ty_render(scene, &options, workers, film, stats, NULL), TY_OK);
    assert_int_equal(stats->nonfinite_samples, 0);
    ty_workers_destroy(workers);
    return film;
}

static ty_film* render(const ty_scene* scene, int samples)
{
    ty_render_stats stats;
    const int whole[4] = {0, 0, scene->film.size[0] - 1, scene->film.size[1] - 1};
    return render_part(scene, whole, 0, samples, 2, &stats);
}

static double value(const ty_film* film, int x, int y, int channel)
{
    ty_pixel_sums s = ty_film_pixel(film, x, y);
    return (double)ty_fixed_mean(s.radiance[channel], s.samples);
}

// Squared differences of two seeds, halved: the noise, whatever is correlated within a picture.
static double noise(ty_scene* scene, int samples)
{
    double sum = 0.0;
    scene->render.seed.value = 11;
    ty_film* a = render(scene, samples);
    scene->render.seed.value = 12;
    ty_film* b = render(scene, samples);
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
        {
            double d = value(a, x, y, 0) - value(b, x, y, 0);
            sum += d * d / (2.0 * WIDTH * HEIGHT);
        }
    ty_film_destroy(a);
    ty_film_destroy(b);
    return sum;
}

enum
{
    SEEDS = 8,
    SIDE = 6 // pixels of a region
};

// Sums over the regions of a picture by seed.
typedef struct regions
{
    double sum[3][SIDE][SIDE + 1][SEEDS];
} regions;

static void add_regions(const ty_film* film, const int size[2], int seed, regions* r)
{
    int side = size[0] > SIDE ? SIDE : 1;
    for (int y = 0; y < size[1]; ++y)
        for (int x = 0; x < size[0]; ++x)
            for (int c = 0; c < 3; ++c)
                r->sum[c][y / side][x / side][seed] += value(film, x, y, c);
}

// Square of Welch's t.
static double deviation(const double a[SEEDS], const double b[SEEDS])
{
    double mean[2] = {0}, variance = 1e-12;
    for (int s = 0; s < SEEDS; ++s)
    {
        mean[0] += a[s] / SEEDS;
        mean[1] += b[s] / SEEDS;
    }
    for (int s = 0; s < SEEDS; ++s)
        variance +=
            ((a[s] - mean[0]) * (a[s] - mean[0]) + (b[s] - mean[1]) * (b[s] - mean[1])) / (SEEDS * (SEEDS - 1.0));
    return (mean[1] - mean[0]) * (mean[1] - mean[0]) / variance;
}

// Regions of both pictures agree within what a seed changes, in each channel; the clay has no blue at all, so that the
// light that its paths found for others must not be lost. A picture of few pixels makes neighbours of what lies far
// apart: there the densities count.
static void check_same_light(const char* sampling, int width, int height, int samples)
{
    char keys[128];
    snprintf(keys, sizeof keys, "light_sampling: %s, share_paths: true", sampling);
    ty_scene* scene = load(keys, metal, lamps);
    scene->film.size[0] = width;
    scene->film.size[1] = height;
    static regions found[2];
    memset(found, 0, sizeof found);
    for (int i = 0; i < 2 * SEEDS; ++i)
    {
        scene->render.share_paths = i % 2;
        scene->render.seed.value = (uint64_t)i;
        ty_film* film = render(scene, samples);
        add_regions(film, scene->film.size, i / 2, &found[i % 2]);
        ty_film_destroy(film);
    }
    double worst = 0.0, total = 0.0;
    int count = 0;
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < SIDE; ++y)
            for (int x = 0; x <= SIDE; ++x)
            {
                double t = deviation(found[0].sum[c][y][x], found[1].sum[c][y][x]);
                total += t;
                worst = t > worst ? t : worst;
                count += found[0].sum[c][y][x][0] > 0.0;
            }
    ty_scene_destroy(scene);
    // Squares of Student's t of 14 degrees of freedom have the mean 1.17; the channels are hardly independent.
    if (total / count > 2.0 || worst > 30.0)
        fail_msg("%s, %d pixels: squared deviations: mean %g, largest %g", sampling, width, total / count, worst);
}

static void test_light_is_the_same(void** state)
{
    (void)state;
    check_same_light("mis", WIDTH, HEIGHT, 64);
    check_same_light("mis", 4, 4, 16384);
    check_same_light("bsdf", 4, 4, 2048);
    check_same_light("light", 4, 4, 2048);
}

static void test_noise_is_less(void** state)
{
    (void)state;
    ty_scene* scene = load("share_paths: false", "model: surface, base_color: 0.8, specular_weight: 0", lamps);
    double alone = noise(scene, 16);
    scene->render.share_paths = true;
    double shared = noise(scene, 16);
    ty_scene_destroy(scene);
    if (shared > 0.75 * alone)
        fail_msg("mean squared error %g, %g without", shared, alone);
}

static void assert_same(const ty_film* a, const ty_film* b, int x, int y)
{
    ty_pixel_sums p = ty_film_pixel(a, x, y), q = ty_film_pixel(b, x, y);
    if (memcmp(p.radiance, q.radiance, sizeof p.radiance) || p.luminance_sqr != q.luminance_sqr ||
        p.samples != q.samples || p.first_depth != q.first_depth)
        fail_msg("pixel %d,%d differs", x, y);
}

static void test_threads_and_crops_change_nothing(void** state)
{
    (void)state;
    ty_render_stats stats;
    ty_scene* scene = load("share_paths: true", metal, lamps);
    const int whole[4] = {0, 0, WIDTH - 1, HEIGHT - 1}, crop[4] = {11, 3, 36, 20};
    ty_film *all = render(scene, 12), *one = render_part(scene, whole, 0, 12, 1, &stats),
            *part = render_part(scene, crop, 0, 12, 2, &stats);
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
        {
            assert_same(all, one, x, y);
            if (x >= crop[0] && x <= crop[2] && y >= crop[1] && y <= crop[3])
                assert_same(all, part, x, y);
        }
    ty_film_destroy(all);
    ty_film_destroy(one);
    ty_film_destroy(part);
    ty_scene_destroy(scene);
}

// Where paths cannot be shared the switch does nothing.
static void test_other_scenes_are_left_alone(void** state)
{
    (void)state;
    const struct
    {
        const char *render, *material, *lights;
    } cases[] = {
        {"share_paths: true", "model: surface, opacity: 0.5", lamps},
        {"share_paths: true", "model: surface, transmission_weight: 1, specular_roughness: 0", lamps},
        {"share_paths: true, indirect_clamp: 1", metal, lamps},
        {"share_paths: true", metal, "  - { type: environment, radiance: 0.3, visible: { diffuse: false } }\n"},
    };
    for (int i = 0; i < 4; ++i)
    {
        ty_scene* scene = load(cases[i].render, cases[i].material, cases[i].lights);
        ty_film* with = render(scene, 2);
        scene->render.share_paths = false;
        ty_film* without = render(scene, 2);
        for (int y = 0; y < HEIGHT; ++y)
            for (int x = 0; x < WIDTH; ++x)
                assert_same(with, without, x, y);
        ty_film_destroy(with);
        ty_film_destroy(without);
        ty_scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_light_is_the_same),
        cmocka_unit_test(test_noise_is_less),
        cmocka_unit_test(test_threads_and_crops_change_nothing),
        cmocka_unit_test(test_other_scenes_are_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
