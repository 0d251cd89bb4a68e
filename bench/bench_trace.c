// SPDX-License-Identifier: Apache-2.0
// Rays of paths over a scene, recorded once and traced again in turn: plain Embree instances, the fast path, and the
// integrator itself. bench_trace SCENE [ROUNDS]: medians over the rounds, CPU time of one thread.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/rng.h>
#include <tsuya/renderer/render.h>
#include <tsuya/shading/material.h>
#include <tsuya/shading/sampling.h>

#define MAX_RAYS 400000
#define MAX_ROUNDS 101

typedef struct record
{
    ty_ray ray;
    bool shadow;
} record;

typedef struct bench
{
    ty_scene* scene[2]; // by ty_trace_path
    record* rays;
    int count;
    ty_affine camera;
    float half_width, half_height;
} bench;

static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static ty_scene* load(const char* path, ty_trace_path trace_path)
{
    ty_scene_options options = {.trace_path = trace_path};
    ty_scene* scene = NULL;
    ty_error_list errors = {0};
    if (ty_scene_load(path, &options, &scene, &errors) != TY_OK)
    {
        fprintf(stderr, "bench_trace: %s does not load\n", path);
        exit(1);
    }
    return scene;
}

static void keep(bench* b, const ty_ray* ray, bool shadow)
{
    if (b->count < MAX_RAYS)
        b->rays[b->count++] = (record){*ray, shadow};
}

static void keep_shadow(bench* b, const ty_bsdf* bsdf, ty_rng* rng)
{
    const ty_scene* scene = b->scene[0];
    for (int i = 0; i < scene->light_count; i++)
    {
        const ty_light_def* light = &scene->lights[i];
        if ((ty_light_kind)light->kind != TY_LIGHT_RECTANGLE)
            continue;
        ty_frame frame = ty_frame_from_normal(ty_normalize(ty_sub(light->target, light->center)));
        float x = light->size[0] * (ty_rng_float(rng) - 0.5f), y = light->size[1] * (ty_rng_float(rng) - 0.5f);
        ty_vec3 to = ty_sub(ty_mad(ty_mad(light->center, frame.t, x), frame.b, y), bsdf->point.position);
        ty_vec3 wi = ty_normalize(to);
        float pdf;
        if (ty_dot(wi, frame.n) >= 0.0f || ty_rgb_is_black(ty_bsdf_eval(bsdf, wi, &pdf)))
            continue;
        ty_ray ray;
        ty_bsdf_spawn(bsdf, wi, ty_rng_float(rng), &ray);
        ray.t_max = 0.9999f * ty_length(to);
        ray.mask = TY_MASK_SHADOW;
        keep(b, &ray, true);
        return;
    }
}

static void record_path(bench* b, ty_ray ray, ty_rng* rng)
{
    const ty_scene* scene = b->scene[0];
    float beta = 1.0f;
    for (int bounce = 0; bounce <= scene->render.max_depth; bounce++)
    {
        ty_hit hit;
        keep(b, &ray, false);
        if (!ty_world_intersect(scene->world, &ray, &hit))
            return;
        ty_surface_point point;
        ty_bsdf bsdf;
        ty_bsdf_sample sample;
        ty_world_surface(scene->world, &hit, &point);
        ty_material_prepare(ty_scene_material(scene, hit.object, hit.instance, hit.triangle), &scene->shading, &point,
                            ty_neg(ray.direction), &bsdf);
        ty_rgb weight = {1, 1, 1};
        const float u[4] = {ty_rng_float(rng), ty_rng_float(rng), ty_rng_float(rng), ty_rng_float(rng)};
        if (!ty_bsdf_resolve(&bsdf, &scene->shading, u, rng, &weight))
            return;
        keep_shadow(b, &bsdf, rng);
        ty_vec2 uv = {ty_rng_float(rng), ty_rng_float(rng)};
        if (!ty_bsdf_sample_wi(&bsdf, ty_rng_float(rng), uv, &sample))
            return;
        beta *= ty_rgb_max(sample.weight) * ty_rgb_max(weight);
        float survival = bounce + 1 < scene->render.roulette_depth ? 1.0f : ty_min(1.0f, sqrtf(beta));
        if (!(ty_rng_float(rng) < survival))
            return;
        beta /= survival;
        ty_bsdf_spawn(&bsdf, sample.wi, ty_rng_float(rng), &ray);
        ray.mask = sample.transmitted ? TY_MASK_TRANSMISSION : sample.delta ? TY_MASK_GLOSSY : TY_MASK_DIFFUSE;
    }
}

// Pixels in scan order, as the integrator takes them.
static void record_rays(bench* b)
{
    const ty_camera_def* camera = &b->scene[0]->camera;
    const int* size = b->scene[0]->film.size;
    float s, c;
    ty_sincos(0.5f * camera->vfov, &s, &c);
    b->half_height = s / c;
    b->half_width = b->half_height * (float)size[0] / (float)size[1];
    b->camera = ty_affine_look_at(camera->position, camera->look_at, camera->up);
    b->rays = TY_ALLOC(record, MAX_RAYS);
    ty_rng rng = ty_rng_make((ty_seed){1}, 0, 0);
    int step = 1 + size[1] / 140;
    for (int y = 0; y < size[1]; y += step)
        for (int x = 0; x < size[0]; x += step)
        {
            float px = (2.0f * ((float)x + ty_rng_float(&rng)) / (float)size[0] - 1.0f) * b->half_width;
            float py = (1.0f - 2.0f * ((float)y + ty_rng_float(&rng)) / (float)size[1]) * b->half_height;
            ty_vec3 d = ty_normalize(ty_map_vector(&b->camera, (ty_vec3){px, py, -1.0f}));
            ty_ray ray = ty_ray_make(b->camera.t, d, TY_FLOAT_MAX);
            ray.mask = TY_MASK_CAMERA;
            record_path(b, ray, &rng);
        }
}

// Seconds of CPU time for the rays; plain: without what only the integrator asks for.
static double trace(const bench* b, ty_trace_path path, bool plain, int kinds, uint64_t* sum)
{
    const ty_world* world = b->scene[path]->world;
    double start = cpu_seconds();
    for (int i = 0; i < b->count; i++)
    {
        if (!(kinds >> b->rays[i].shadow & 1))
            continue;
        ty_ray ray = b->rays[i].ray;
        if (plain)
        {
            ray.flags = TY_RAY_PLAIN;
            ray.skip_instance = TY_NONE;
        }
        ty_hit hit;
        if (b->rays[i].shadow)
            *sum += ty_world_occluded(world, &ray);
        else if (ty_world_intersect(world, &ray, &hit))
            *sum += hit.triangle;
    }
    return cpu_seconds() - start;
}

static double integrate(const bench* b, ty_film* film, int sample, double* rays)
{
    ty_error error;
    ty_render_stats stats;
    ty_render_options options = {.sample_begin = sample, .sample_end = sample + 1};
    double start = cpu_seconds();
    if (ty_render(b->scene[0], &options, NULL, film, &stats, &error) != TY_OK)
        exit(1);
    *rays = (double)(stats.camera_rays + stats.path_rays + stats.shadow_rays + stats.interior_rays);
    return cpu_seconds() - start;
}

static int compare(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

static double median(double* values, int count)
{
    qsort(values, (size_t)count, sizeof *values, compare);
    return values[count / 2];
}

enum
{
    BARE,
    BARE_NEAREST,
    BARE_SHADOW,
    FAST,
    FAST_NEAREST,
    FAST_SHADOW,
    INTEGRATOR,
    BARE_OVER_INTEGRATOR,
    SAMPLE,
    COLUMNS
};

static void report(double column[COLUMNS][MAX_ROUNDS], int rounds)
{
    double m[COLUMNS];
    for (int i = 0; i < COLUMNS; i++)
        m[i] = median(column[i], rounds);
    printf("ns a ray               all  nearest   shadow\n");
    printf("plain instances    %7.1f  %7.1f  %7.1f\n", m[BARE], m[BARE_NEAREST], m[BARE_SHADOW]);
    printf("fast path          %7.1f  %7.1f  %7.1f   %.2f times as fast\n", m[FAST], m[FAST_NEAREST], m[FAST_SHADOW],
           m[BARE] / m[FAST]);
    printf("integrator, in all %7.1f                     %.2f times the rays/s of plain instances\n", m[INTEGRATOR],
           m[BARE_OVER_INTEGRATOR]);
    printf("integrator         %7.3f Msamples/s\n", 1.0 / m[SAMPLE]);
}

int main(int argc, char** argv)
{
    if (argc < 2)
    {
        fprintf(stderr, "usage: bench_trace SCENE [ROUNDS]\n");
        return 2;
    }
    int rounds = argc > 2 ? atoi(argv[2]) : 11;
    rounds = rounds < 1 ? 1 : rounds > MAX_ROUNDS ? MAX_ROUNDS : rounds;
    bench b = {.scene = {load(argv[1], TY_TRACE_FAST), load(argv[1], TY_TRACE_REFERENCE)}};
    record_rays(&b);
    const int* size = b.scene[0]->film.size;
    ty_film_setup setup = {
        .size = {size[0], size[1]}, .crop = {0, 0, size[0] - 1, size[1] - 1}, .sample_end = rounds, .aovs = 0};
    ty_film* film;
    ty_error error;
    if (ty_film_create(&setup, &film, &error) != TY_OK)
        return 1;
    int shadows = 0;
    for (int i = 0; i < b.count; i++)
        shadows += b.rays[i].shadow;
    double nearest = b.count - shadows, column[COLUMNS][MAX_ROUNDS], rays;
    uint64_t sum = 0;
    for (int i = 0; i < rounds; i++)
    {
        double slow = trace(&b, TY_TRACE_REFERENCE, true, 1, &sum), fast = trace(&b, TY_TRACE_FAST, false, 1, &sum);
        double slow_shadow = trace(&b, TY_TRACE_REFERENCE, true, 2, &sum);
        double fast_shadow = trace(&b, TY_TRACE_FAST, false, 2, &sum), all = integrate(&b, film, i, &rays);
        column[BARE_NEAREST][i] = 1e9 * slow / nearest;
        column[BARE_SHADOW][i] = 1e9 * slow_shadow / shadows;
        column[BARE][i] = 1e9 * (slow + slow_shadow) / b.count;
        column[FAST_NEAREST][i] = 1e9 * fast / nearest;
        column[FAST_SHADOW][i] = 1e9 * fast_shadow / shadows;
        column[FAST][i] = 1e9 * (fast + fast_shadow) / b.count;
        column[INTEGRATOR][i] = 1e9 * all / rays;
        column[BARE_OVER_INTEGRATOR][i] = column[BARE][i] / column[INTEGRATOR][i];
        column[SAMPLE][i] = 1e6 * all / ((double)size[0] * (double)size[1]);
    }
    printf("%d rays, %d of them shadow rays; kernels %s; check sum %llu\n", b.count, shadows,
           ty_world_isa(b.scene[0]->world), (unsigned long long)sum);
    report(column, rounds);
    ty_film_destroy(film);
    ty_free(b.rays);
    ty_scene_destroy(b.scene[0]);
    ty_scene_destroy(b.scene[1]);
    return 0;
}
