// SPDX-License-Identifier: Apache-2.0
// Touching grains: paths through a heap that go on from where the material says light leaves, or from where a walk in
// the same mesh does. Seen straight from above, under a constant environment and under one directional light.
#include "report.h"
#include "subject.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/workers.h>
#include <tsuya/scene/scene.h>
#include <tsuya/shading/sampling.h>

#define SIDE 60        // pixels
#define WINDOW 0.026f  // m
#define COLOR 0.95f    // of the entered light that leaves
#define MAX_EVENTS 400 // of a path
#define MAX_STEPS 20000

typedef enum exit_model
{
    EXIT_LAMBERT,
    EXIT_PROBE,
    EXIT_DEPTH,
    EXIT_WALK, // in this file
    EXIT_MATERIAL_WALK,
    EXITS
} exit_model;

typedef struct light_sums
{
    double environment, directional;
} light_sums;

typedef struct heap_job
{
    const ty_scene* scene;
    const ty_material* material[EXITS];
    exit_model exits;
    float path; // m
    ty_vec3 light;
    int samples;
    light_sums (*pixels)[2]; // [SIDE * SIDE], halves
} heap_job;

static float next(ty_rng* rng)
{
    return ty_rng_float(rng);
}

static ty_vec3 cosine_about(ty_vec3 n, ty_rng* rng)
{
    float u = next(rng);
    return ty_to_world(ty_frame_from_normal(n), ty_sample_cosine((ty_vec2){u, next(rng)}));
}

// A white walk in the mesh of one instance, by rays that end where it scatters. False when it got out through a crack.
static bool walk_mesh(const ty_world* world, const ty_surface_point* x, float path, ty_rng* rng, ty_surface_point* exit)
{
    ty_vec3 p = ty_offset_origin(x, ty_neg(x->ng)), d = cosine_about(ty_neg(x->ng), rng);
    for (int i = 0; i < MAX_STEPS; i++)
    {
        float step = -path * ty_ln(1.0f - next(rng));
        ty_hit hit;
        if (ty_world_intersect_instance(world, x->object, x->instance, x->time, p, d, step, &hit))
        {
            hit.object = x->object;
            hit.instance = x->instance;
            hit.time = x->time;
            ty_world_surface(world, &hit, exit);
            return true;
        }
        p = ty_mad(p, d, step);
        float u = next(rng);
        d = ty_sample_sphere((ty_vec2){u, next(rng)});
        if (ty_length(ty_sub(p, x->position)) > 0.02f)
            return false;
    }
    return false;
}

// The lobe where light leaves, and the factor of the path.
static bool leave(const heap_job* job, const ty_surface_point* point, ty_vec3 wo, ty_rng* rng, ty_bsdf* b, double* beta)
{
    const ty_scene* scene = job->scene;
    bool grain = point->object == 0;
    const ty_material* material =
        grain ? job->material[job->exits] : ty_scene_material(scene, point->object, point->instance, point->triangle);
    const float u[4] = {next(rng), next(rng), next(rng), next(rng)};
    ty_rgb weight;
    ty_material_prepare(material, &scene->shading, point, wo, b);
    if (!ty_bsdf_resolve(b, &scene->shading, u, rng, &weight))
        return false;
    *beta *= (double)weight.g;
    if (grain && (job->exits == EXIT_LAMBERT || job->exits == EXIT_WALK))
    {
        b->point = *point;
        if (job->exits == EXIT_WALK && !walk_mesh(scene->world, point, job->path, rng, &b->point))
            b->point = *point;
        b->frame = ty_frame_from_normal(b->point.ns);
    }
    return true;
}

static void trace_path(const heap_job* job, ty_ray ray, ty_rng* rng, light_sums* out)
{
    const ty_world* world = job->scene->world;
    double beta = 1.0;
    for (int event = 0; event < MAX_EVENTS; event++)
    {
        ty_hit hit;
        ty_surface_point point;
        ty_bsdf b;
        ty_bsdf_sample sample;
        float pdf;
        if (!ty_world_intersect(world, &ray, &hit))
        {
            out->environment += beta;
            return;
        }
        ty_world_surface(world, &hit, &point);
        if (!leave(job, &point, ty_neg(ray.direction), rng, &b, &beta))
            return;
        double f = (double)ty_bsdf_eval(&b, job->light, &pdf).g * (double)TY_PI;
        if (f > 0.0)
        {
            ty_ray shadow;
            ty_bsdf_spawn(&b, job->light, next(rng), &shadow);
            if (!ty_world_occluded(world, &shadow))
                out->directional += beta * f;
        }
        float u = next(rng), ux = next(rng);
        if (!ty_bsdf_sample_wi(&b, u, (ty_vec2){ux, next(rng)}, &sample))
            return;
        beta *= (double)sample.weight.g;
        if (beta < 0.5)
        {
            if ((double)next(rng) >= beta * 2.0)
                return;
            beta = 0.5;
        }
        ty_bsdf_spawn(&b, sample.wi, next(rng), &ray);
    }
}

static void trace_pixels(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const heap_job* job = context;
    for (int64_t i = begin; i < end; i++)
        for (int half = 0; half < 2; half++)
        {
            // The same camera rays for every model: what differs is what is compared.
            ty_rng eye = ty_rng_make((ty_seed){50}, (uint64_t)i, (uint64_t)half);
            ty_rng rng = ty_rng_make((ty_seed){51 + (uint64_t)job->exits}, (uint64_t)i, (uint64_t)half);
            light_sums sum = {0};
            for (int k = 0; k < job->samples; k++)
            {
                float x = ((float)(i % SIDE) + next(&eye)) / SIDE - 0.5f;
                float z = ((float)(i / SIDE) + next(&eye)) / SIDE - 0.5f;
                ty_ray ray =
                    ty_ray_make(ty_vec3_make(x * WINDOW, 0.2f, z * WINDOW), ty_vec3_make(0, -1, 0), TY_FLOAT_MAX);
                ray.flags = TY_RAY_FRONT_ONLY;
                trace_path(job, ray, &rng, &sum);
            }
            job->pixels[i][half] = (light_sums){sum.environment / job->samples, sum.directional / job->samples};
        }
}

typedef struct heap_picture
{
    light_sums pixels[SIDE * SIDE][2];
    light_sums mean;
} heap_picture;

static void take_picture(heap_job* job, exit_model exits, ty_workers* workers, heap_picture* out)
{
    job->exits = exits;
    job->pixels = out->pixels;
    ty_parallel_for(workers, SIDE * SIDE, 8, trace_pixels, job);
    out->mean = (light_sums){0};
    for (int i = 0; i < 2 * SIDE * SIDE; i++)
    {
        out->mean.environment += out->pixels[i / 2][i % 2].environment / (2 * SIDE * SIDE);
        out->mean.directional += out->pixels[i / 2][i % 2].directional / (2 * SIDE * SIDE);
    }
}

typedef struct pixel_error
{
    light_sums rms;   // free of noise: the halves differ in it
    light_sums noise; // two standard errors of the mean squares
} pixel_error;

static double root_mean(double sum, double sum_sqr, double* noise)
{
    double n = SIDE * SIDE, mean = sum / n;
    *noise = 2.0 * sqrt(fmax(sum_sqr / n - mean * mean, 0) / n);
    return sqrt(fmax(mean, 0));
}

static pixel_error compare_pixels(const heap_picture* a, const heap_picture* b)
{
    light_sums sum = {0}, sqr = {0};
    pixel_error out;
    for (int i = 0; i < SIDE * SIDE; i++)
    {
        const light_sums *p = a->pixels[i], *q = b->pixels[i];
        double e = (p[0].environment - q[0].environment) * (p[1].environment - q[1].environment);
        double d = (p[0].directional - q[0].directional) * (p[1].directional - q[1].directional);
        sum.environment += e;
        sum.directional += d;
        sqr.environment += e * e;
        sqr.directional += d * d;
    }
    out.rms.environment = root_mean(sum.environment, sqr.environment, &out.noise.environment);
    out.rms.directional = root_mean(sum.directional, sqr.directional, &out.noise.directional);
    return out;
}

static void report_pixels(const char* name, const heap_picture* a, const heap_picture* b, double expected, double limit)
{
    pixel_error e = compare_pixels(a, b);
    double noise = fmax(e.noise.environment, e.noise.directional);
    report_most(name, fmax(e.rms.environment, e.rms.directional), expected, sqrt(limit * limit + noise));
}

static ty_scene* load_heap(const char* folder, double scale, ty_workers* workers)
{
    char text[1500], name[1024];
    snprintf(text, sizeof text,
             "tsuya: 1\nassets:\n  grain: { shape: ellipsoid, size: [%.7f, %.7f, %.7f], divisions: 72 }\n"
             "  heap: { aggregate: grains.ply, prototype: grain }\n  bowl: { mesh: bowl.ply }\n"
             "materials:\n  rice: { model: cdrf, color: %.3f, specular_weight: 0 }\n"
             "  clay: { model: surface, base_color: 0.5, specular_weight: 0 }\n"
             "objects:\n  - { aggregate: heap, material: rice }\n  - { mesh: bowl, material: clay }\n"
             "lights:\n  - { type: environment }\n",
             3e-3 * scale, 1.5e-3 * scale, 1.25e-3 * scale, (double)COLOR);
    snprintf(name, sizeof name, "%s/scene.yaml", folder);
    ty_scene* scene;
    ty_error_list errors = {0};
    ty_scene_options options = {.workers = workers};
    if (ty_scene_load_memory(name, text, strlen(text), &options, &scene, &errors) == TY_OK)
        return scene;
    char message[1600];
    ty_error_format(&errors.items[0], message, sizeof message);
    fprintf(stderr, "bench_shading: %s\n", message);
    ty_error_list_term(&errors);
    return NULL;
}

static ty_material* grain_material(exit_model exits, float path)
{
    ty_walk_def d = ty_walk_def_default();
    ty_material* material = NULL;
    ty_error error;
    d.common.color = ty_input_scalar(COLOR);
    d.common.specular_weight = ty_input_scalar(0);
    d.common.mean_free_path = ty_input_scalar(path);
    d.common.evaluate = exits == EXIT_PROBE ? TY_CDRF_PROBE : TY_CDRF_DEPTH;
    ty_status status = exits == EXIT_MATERIAL_WALK ? ty_material_create_walk(&d, &material, &error)
                                                   : ty_material_create_cdrf(&d.common, &material, &error);
    if (status != TY_OK)
    {
        fprintf(stderr, "bench_shading: %s\n", error.text);
        exit(1);
    }
    return material;
}

static void report_path(heap_job* job, double scale, double mm, ty_workers* workers)
{
    static const char* const names[EXITS] = {"lambert", "probe", "depth", "walk", "material walk"};
    heap_picture* pictures = TY_ALLOC(heap_picture, EXITS);
    char name[80];
    for (int e = 0; e < EXITS; e++)
    {
        job->material[e] = grain_material((exit_model)e, job->path);
        take_picture(job, (exit_model)e, workers, &pictures[e]);
    }
    const heap_picture *depth = &pictures[EXIT_DEPTH], *walk = &pictures[EXIT_WALK];
    for (int e = 0; e < EXITS; e++)
    {
        light_sums rms = compare_pixels(&pictures[e], walk).rms;
        const light_sums *m = &pictures[e].mean, *w = &walk->mean;
        printf("  %4.2f  %4.2f  %-13s %8.4f %8.4f    %+6.2f %% %+6.2f %%     %6.4f %6.4f\n", scale, mm, names[e],
               m->environment, m->directional, 100 * (m->environment / w->environment - 1),
               100 * (m->directional / w->directional - 1), rms.environment, rms.directional);
    }
    snprintf(name, sizeof name, "size %.2f, l %.2f mm: mean, environment, %%", scale, mm);
    report_near(name, 100 * (depth->mean.environment / walk->mean.environment - 1), 0, 0.5);
    snprintf(name, sizeof name, "size %.2f, l %.2f mm: mean, directional, %%", scale, mm);
    report_near(name, 100 * (depth->mean.directional / walk->mean.directional - 1), 0, 0.5);
    snprintf(name, sizeof name, "size %.2f, l %.2f mm: pixel RMS", scale, mm);
    report_pixels(name, depth, walk, 0.012, 0.015);
    snprintf(name, sizeof name, "size %.2f, l %.2f mm: material walk, mean, %%", scale, mm);
    report_near(name, 100 * (pictures[EXIT_MATERIAL_WALK].mean.environment / walk->mean.environment - 1), 0, 0.3);
    snprintf(name, sizeof name, "size %.2f, l %.2f mm: material walk, pixel RMS", scale, mm);
    report_pixels(name, &pictures[EXIT_MATERIAL_WALK], walk, 0, 0.005);
    for (int e = 0; e < EXITS; e++)
        ty_material_destroy((ty_material*)job->material[e]);
    ty_free(pictures);
}

void bench_heap(const bench_options* options)
{
    static const double scales[] = {1.0, 1.03}, paths[] = {0.05, 0.2, 0.4, 0.7};
    ty_workers* workers;
    ty_error error;
    if (ty_workers_create(options->threads, &workers, &error) != TY_OK)
        workers = NULL;
    report_title(
        "A heap of ellipsoids, touching (size 1) and overlapping (1.03), colour .95, from above: mean radiance "
        "under an environment / one light",
        "  size  l mm  model          environ. direct.     against the walk        pixel RMS");
    for (int s = 0; s < 2; s++)
    {
        ty_scene* scene = load_heap("build/bench/heap", scales[s], workers);
        if (!scene)
        {
            report_holds("the heap loads (bench/shading/run packs it)", false);
            break;
        }
        for (int i = 0; i < 4; i++)
        {
            heap_job job = {.scene = scene,
                            .path = (float)paths[i] * MILLIMETRE,
                            .light = ty_normalize(ty_vec3_make(0.5f, 0.81f, 0.3f)),
                            .samples = options->quick ? 16 : 96};
            report_path(&job, scales[s], paths[i], workers);
        }
        ty_scene_destroy(scene);
    }
    ty_workers_destroy(workers);
}
