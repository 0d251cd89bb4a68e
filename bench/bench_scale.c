// SPDX-License-Identifier: Apache-2.0
// Heaps of many grains: bench_scale FOLDER COUNT [SAMPLES]. Writes an aggregate of one 4,096-triangle grain, turned at
// random on a jittered lattice, loads it as a scene and renders it on one thread. Prints the seconds to load and build,
// the resident bytes a grain above those of a heap of one grain, the peak, and the samples a second.
#include "cpu_time.h"
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/rng.h>
#include <tsuya/geometry/shape.h>
#include <tsuya/renderer/render.h>

#define SPACING 2.76e-3f // m: .6 of the volume are grains

static void die(const char* what)
{
    fprintf(stderr, "bench_scale: %s\n", what);
    exit(1);
}

// Resident bytes of this process now, without what is free but kept for later.
static double resident(void)
{
    malloc_trim(0);
    FILE* file = fopen("/proc/self/statm", "r");
    long pages = 0;
    if (!file || fscanf(file, "%*s %ld", &pages) != 1)
        die("/proc/self/statm cannot be read");
    fclose(file);
    return 4096.0 * (double)pages;
}

static ty_aggregate* make_heap(uint32_t count, float* half_width)
{
    ty_shape_def def = ty_shape_def_default();
    def.kind = TY_SHAPE_ELLIPSOID;
    def.size = (ty_vec3){3e-3f, 1e-3f, 1e-3f};
    def.divisions = 64;
    ty_error error;
    ty_aggregate* heap = ty_aggregate_create(count, 1);
    if (!heap || ty_shape_create(&def, &heap->prototypes[0], &error) != TY_OK)
        die("no memory for the heap");
    uint32_t across = 1;
    while (across * across * ((across + 1) / 2) < count)
        across++;
    *half_width = 0.5f * SPACING * (float)across;
    ty_rng rng = ty_rng_make((ty_seed){1}, 0, 0);
    for (uint32_t i = 0; i < count; i++)
    {
        float x = (float)(i % across), z = (float)(i / across % across), y = (float)(i / across / across);
        ty_vec3 at = {x + 0.8f * ty_rng_float(&rng), y + 0.8f * ty_rng_float(&rng), z + 0.8f * ty_rng_float(&rng)};
        float a = ty_rng_float(&rng), b = ty_rng_float(&rng);
        ty_quat turn = ty_quat_uniform(a, b, ty_rng_float(&rng));
        at = ty_sub(ty_mul(at, SPACING), (ty_vec3){*half_width, 0, *half_width});
        heap->transforms[i] = ty_affine_from_trs(at, turn, (ty_vec3){1, 1, 1});
        heap->ids[i] = i;
    }
    return heap;
}

static void write_scene(const char* folder, const char* name, float half_width)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s.yaml", folder, name);
    FILE* file = fopen(path, "w");
    if (!file)
        die("the folder cannot be written to");
    double h = (double)half_width;
    fprintf(file,
            "tsuya: 1\n"
            "film: { size: [480, 270] }\n"
            "camera: { position: [0, %g, %g], look_at: [0, %g, 0], vfov: 14 }\n"
            "render: { samples: 4, max_depth: 9 }\n"
            "assets: { heap: { aggregate: %s.glb } }\n"
            "materials: { rice: { model: surface, base_color: 0.8, specular_weight: 0 } }\n"
            "objects: [ { name: rice, aggregate: heap, material: rice } ]\n"
            "lights:\n"
            "  - { type: environment, radiance: 0.35 }\n"
            "  - { type: rectangle, center: [%g, %g, 0], target: [0, 0, 0], size: [%g, %g], radiance: 20 }\n",
            6.0 * h, 3.5 * h, h, name, -3.0 * h, 6.0 * h, 2.0 * h, 2.0 * h);
    fclose(file);
}

static ty_scene* load(const char* folder, uint32_t count, double* seconds)
{
    char name[32], path[512];
    float half_width;
    snprintf(name, sizeof name, "heap_%u", count);
    ty_aggregate* heap = make_heap(count, &half_width);
    snprintf(path, sizeof path, "%s/%s.glb", folder, name);
    ty_error error;
    if (ty_aggregate_write(path, heap, &error) != TY_OK)
        die(error.text);
    ty_aggregate_destroy(heap);
    write_scene(folder, name, half_width);
    snprintf(path, sizeof path, "%s/%s.yaml", folder, name);
    ty_scene_options options = {0};
    ty_scene* scene = NULL;
    ty_error_list errors = {0};
    double start = ty_time_now();
    if (ty_scene_load(path, &options, &scene, &errors) != TY_OK)
        die("the scene does not load");
    *seconds = ty_time_now() - start;
    return scene;
}

static double samples_per_second(const ty_scene* scene, int samples)
{
    const int* size = scene->film.size;
    ty_film_setup setup = {.size = {size[0], size[1]}, .crop = {0, 0, size[0] - 1, size[1] - 1}, .sample_end = samples};
    ty_film* film;
    ty_error error;
    ty_render_stats stats;
    ty_render_options options = {.sample_end = samples};
    if (ty_film_create(&setup, &film, &error) != TY_OK)
        die("no memory for the film");
    double start = cpu_seconds();
    if (ty_render(scene, &options, NULL, film, &stats, &error) != TY_OK)
        die(error.text);
    double seconds = cpu_seconds() - start;
    ty_film_destroy(film);
    return (double)stats.camera_rays / seconds;
}

int main(int argc, char** argv)
{
    if (argc < 3)
    {
        fprintf(stderr, "usage: bench_scale FOLDER COUNT [SAMPLES]\n");
        return 2;
    }
    uint32_t count = (uint32_t)strtoul(argv[2], NULL, 10);
    int samples = argc > 3 ? atoi(argv[3]) : 4;
    double seconds;
    ty_scene_destroy(load(argv[1], 1, &seconds)); // libraries and arenas are warm
    double empty = resident();
    ty_scene* one = load(argv[1], 1, &seconds);
    double before = resident(), prototype = before - empty;
    ty_scene* scene = load(argv[1], count, &seconds);
    double peak = (double)ty_memory_peak(), bytes = (resident() - before - prototype) / (double)count;
    printf("%u grains: loaded and built in %.2f s (trees %.2f s), %.0f B a grain (%.0f of them the world's), ", count,
           seconds, scene->build_seconds, bytes,
           (double)(ty_world_memory(scene->world) - ty_world_memory(one->world)) / (double)count);
    printf("%.3f Msamples/s, peak %.0f MB\n", 1e-6 * samples_per_second(scene, samples), 1e-6 * peak);
    ty_scene_destroy(scene);
    ty_scene_destroy(one);
    return 0;
}
