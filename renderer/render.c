// SPDX-License-Identifier: Apache-2.0
// Rendering: passes of rising length over tiles, each pixel written by one worker.
#include "path.h"
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

enum
{
    TILE = 16,
    PASS_FIRST = 4, // samples
    PASS_LONGEST = 64
};

typedef struct render
{
    ty_integrator integrator;
    ty_film* film;
    ty_counters* counters; // [workers]
    int tile_origin[2];    // tiles lie on multiples of TILE of the whole picture
    int tiles_across, tile_count;
    int pass_begin, pass_end; // global sample indices
    ty_progress* progress;    // NULL = none; worker 0 alone
    atomic_uint_fast64_t pixel_samples;
    uint64_t pixel_samples_total;
    double start;
} render;

static void integrator_init(ty_integrator* in, const ty_scene* scene, const ty_film* film)
{
    in->scene = scene;
    ty_camera_init(&in->camera, &scene->camera, film->setup.size);
    in->camera_step_count = scene->camera_step_count;
    if (in->camera_step_count > 1)
        in->camera_steps = TY_ALLOC(ty_camera, in->camera_step_count);
    for (int i = 0; in->camera_steps && i < in->camera_step_count; ++i)
        ty_camera_init(&in->camera_steps[i], &scene->camera_steps[i], film->setup.size);
    ty_pixel_filter_init(&in->filter, (ty_filter_kind)scene->film.filter, scene->film.filter_width);
    ty_light_set_init(&in->lights, scene, film->group_count > 0);
    ty_sobol_init(&in->sobol);
    in->group_count = film->group_count;
    for (int i = 0; i < scene->material_count; ++i)
    {
        unsigned traits = ty_material_traits(scene->materials[i]);
        in->has_transparent = in->has_transparent || (traits & TY_TRAIT_TRANSPARENT);
        in->has_media = in->has_media || (traits & TY_TRAIT_MEDIUM);
    }
    if (in->has_media)
        ty_path_find_media(scene, scene->camera.position, &in->media);
    in->first_instance = TY_ALLOC(uint32_t, scene->object_count);
    uint32_t next = 1;
    for (int i = 0; i < scene->object_count; ++i)
    {
        in->first_instance[i] = next;
        next += scene->objects[i].instance_count ? scene->objects[i].instance_count : 1u;
    }
}

static void integrator_term(ty_integrator* in)
{
    ty_light_set_term(&in->lights);
    ty_free(in->first_instance);
    ty_free(in->camera_steps);
}

static bool comes_before(const int a[3], const int b[3]) // in (y, x, sample) order
{
    if (a[1] != b[1])
        return a[1] < b[1];
    return a[0] != b[0] ? a[0] < b[0] : a[2] < b[2];
}

static void count_fate(ty_counters* counters, ty_sample_fate fate, int x, int y, int sample)
{
    if (fate == TY_SAMPLE_SATURATED)
        counters->saturated_samples++;
    if (fate != TY_SAMPLE_DROPPED)
        return;
    int place[3] = {x, y, sample};
    if (counters->nonfinite_samples++ == 0 || comes_before(place, counters->first_nonfinite))
        memcpy(counters->first_nonfinite, place, sizeof place);
}

// The camera that takes a sample: somewhere between its poses while it moves. moved is room for that.
static const ty_camera* camera_at(const ty_integrator* in, const ty_sampler* sampler, float* time, ty_camera* moved)
{
    *time = 0.0f;
    if (!in->scene->moves)
        return &in->camera;
    float u[4];
    ty_sampler_4d(sampler, TY_GROUP_TIME, u);
    *time = u[0];
    if (!in->camera_steps)
        return &in->camera;
    ty_camera_at(in->camera_steps, in->camera_step_count, *time, moved);
    return moved;
}

static void render_pixel(render* r, int x, int y, ty_counters* counters)
{
    const ty_integrator* in = &r->integrator;
    bool debug = in->scene->render.integrator != TY_INTEGRATOR_PATH;
    ty_pixel_sums sums = ty_pixel_sums_make(r->film->group_count);
    ty_sampler sampler = ty_sampler_make(&in->sobol, in->scene->render.seed, x, y, (uint32_t)r->pass_begin);
    for (int s = r->pass_begin; s < r->pass_end; ++s)
    {
        float u[4];
        ty_sampler_set_sample(&sampler, (uint32_t)s);
        ty_sampler_4d(&sampler, TY_GROUP_CAMERA, u);
        float px = (float)x + 0.5f + ty_pixel_filter_sample(&in->filter, u[0]);
        float py = (float)y + 0.5f + ty_pixel_filter_sample(&in->filter, u[1]);
        ty_camera moved;
        float time;
        const ty_camera* camera = camera_at(in, &sampler, &time, &moved);
        ty_ray ray = ty_camera_ray(camera, px, py, (ty_vec2){u[2], u[3]});
        ray.time = time;
        ty_film_sample sample;
        ty_film_sample_begin(&sample, in->group_count);
        if (debug)
            ty_debug_sample(in, &sampler, &ray, counters, &sample);
        else
            ty_path_sample(in, &sampler, &ray, counters, &sample);
        if (sample.hit)
            sample.depth = ty_camera_depth(camera, sample.position);
        count_fate(counters, ty_pixel_sums_add(&sums, &sample, (uint32_t)s), x, y, s);
    }
    counters->camera_rays += (uint64_t)(r->pass_end - r->pass_begin);
    ty_film_commit(r->film, x, y, &sums);
}

static void show_progress(render* r, uint64_t done)
{
    char detail[64];
    double seconds = ty_time_now() - r->start;
    snprintf(detail, sizeof detail, "%.2f Msample/s %.0f MB", seconds > 0.0 ? (double)done * 1e-6 / seconds : 0.0,
             (double)ty_memory_peak() * 1e-6);
    ty_progress_update(r->progress, (double)done / (double)r->pixel_samples_total, detail);
}

static void render_tiles(void* context, int64_t begin, int64_t end, int worker)
{
    render* r = context;
    const int* crop = r->film->setup.crop;
    for (int64_t tile = begin; tile < end; ++tile)
    {
        int left = r->tile_origin[0] + TILE * (int)(tile % r->tiles_across);
        int top = r->tile_origin[1] + TILE * (int)(tile / r->tiles_across);
        uint64_t pixels = 0;
        for (int y = top < crop[1] ? crop[1] : top; y < top + TILE && y <= crop[3]; ++y)
            for (int x = left < crop[0] ? crop[0] : left; x < left + TILE && x <= crop[2]; ++x, ++pixels)
                render_pixel(r, x, y, &r->counters[worker]);
        uint64_t samples = pixels * (uint64_t)(r->pass_end - r->pass_begin);
        uint64_t done = atomic_fetch_add_explicit(&r->pixel_samples, samples, memory_order_relaxed) + samples;
        if (r->progress && worker == 0)
            show_progress(r, done);
    }
}

// 4, 4, 8, 16, 32, 64, 64 ...; shorter when the time left does not suffice for that at the speed so far.
static int pass_length(int done, int total, double seconds, double time_limit)
{
    int length = done < PASS_FIRST ? PASS_FIRST : done < PASS_LONGEST ? done : PASS_LONGEST;
    if (time_limit > 0.0 && done > 0 && seconds > 0.0)
    {
        double affordable = (time_limit - seconds) * done / seconds;
        length = affordable < 1.0 ? 1 : affordable < length ? (int)affordable : length;
    }
    return length < total - done ? length : total - done;
}

static ty_status cancelled(ty_error* error)
{
    bool terminated = ty_cancel_signal() == SIGTERM;
    return ty_error_set(error, terminated ? TY_TERMINATED : TY_INTERRUPTED, "stopped before the picture was complete");
}

static ty_status run_passes(render* r, const ty_render_options* options, ty_workers* workers, ty_render_stats* stats,
                            ty_error* error)
{
    int total = options->sample_end - options->sample_begin, done = 0;
    while (done < total)
    {
        r->pass_begin = options->sample_begin + done;
        r->pass_end = r->pass_begin + pass_length(done, total, ty_time_now() - r->start, options->time_limit);
        if (!ty_parallel_for(workers, r->tile_count, 1, render_tiles, r))
            return cancelled(error);
        done = r->pass_end - options->sample_begin;
        stats->samples_done = done;
        double seconds = ty_time_now() - r->start;
        if (options->on_pass && !options->on_pass(options->pass_context, r->film, r->pass_end, seconds))
            break;
        if (options->time_limit > 0.0 && seconds >= options->time_limit)
            break;
    }
    return TY_OK;
}

static void sum_counters(const ty_counters* counters, int count, ty_render_stats* stats)
{
    for (int i = 0; i < count; ++i)
    {
        const ty_counters* c = &counters[i];
        stats->camera_rays += c->camera_rays;
        stats->path_rays += c->path_rays;
        stats->shadow_rays += c->shadow_rays;
        stats->interior_rays += c->interior_rays;
        stats->path_vertices += c->path_vertices;
        stats->walks_lost += c->walks_lost;
        stats->walks_cut += c->walks_cut;
        stats->saturated_samples += c->saturated_samples;
        if (c->nonfinite_samples &&
            (!stats->nonfinite_samples || comes_before(c->first_nonfinite, stats->first_nonfinite)))
            memcpy(stats->first_nonfinite, c->first_nonfinite, sizeof c->first_nonfinite);
        stats->nonfinite_samples += c->nonfinite_samples;
    }
}

static void place_tiles(render* r, const int crop[4])
{
    for (int axis = 0; axis < 2; ++axis)
        r->tile_origin[axis] = crop[axis] / TILE * TILE;
    r->tiles_across = (crop[2] - r->tile_origin[0]) / TILE + 1;
    r->tile_count = r->tiles_across * ((crop[3] - r->tile_origin[1]) / TILE + 1);
}

ty_status ty_render(const ty_scene* scene, const ty_render_options* options, ty_workers* workers, ty_film* film,
                    ty_render_stats* stats, ty_error* error)
{
    *stats = (ty_render_stats){.first_nonfinite = {-1, -1, -1}};
    const ty_film_setup* setup = &film->setup;
    if (options->sample_begin < setup->sample_begin || options->sample_end > setup->sample_end ||
        options->sample_end <= options->sample_begin)
        return ty_error_set(error, TY_USAGE, "samples %d-%d are not in the film's range %d-%d", options->sample_begin,
                            options->sample_end - 1, setup->sample_begin, setup->sample_end - 1);
    int worker_count = workers ? ty_workers_count(workers) : 1;
    uint64_t pixels = (uint64_t)film->width * (uint64_t)film->height;
    render* r = TY_ALLOC(render, 1);
    ty_progress progress;
    integrator_init(&r->integrator, scene, film);
    r->film = film;
    r->counters = TY_ALLOC(ty_counters, worker_count);
    r->pixel_samples_total = pixels * (uint64_t)(options->sample_end - options->sample_begin);
    r->start = ty_time_now();
    place_tiles(r, setup->crop);
    if (options->progress)
    {
        r->progress = &progress;
        ty_progress_begin(&progress, "render");
    }
    ty_status status = run_passes(r, options, workers, stats, error);
    if (options->progress)
    {
        if (status == TY_OK && stats->samples_done == options->sample_end - options->sample_begin)
            ty_progress_update(&progress, 1.0, NULL); // the last report of worker 0 was before the last tiles
        ty_progress_end(&progress);
    }
    // A picture with holes in its textures is no picture.
    if (status == TY_OK && scene->texture_cache)
        status = ty_mip_cache_check(scene->texture_cache, error);
    sum_counters(r->counters, worker_count, stats);
    stats->seconds = ty_time_now() - r->start;
    integrator_term(&r->integrator);
    ty_free(r->counters);
    ty_free(r);
    return status;
}
