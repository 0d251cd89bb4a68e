// SPDX-License-Identifier: Apache-2.0
// Loading and rendering as the command line does.
#include "picture.h"
#include "cpu_time.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void leave(const ty_error* error)
{
    char message[1600];
    ty_error_format(error, message, sizeof message);
    fprintf(stderr, "bench_shading: %s\n", message);
    exit(1);
}

static ty_scene* load(const picture_def* def)
{
    char size[64], seed[64];
    const char* sets[16];
    int count = 0;
    for (; count < def->set_count && count < 14; count++)
        sets[count] = def->sets[count];
    snprintf(seed, sizeof seed, "render.seed=%llu", (unsigned long long)def->seed);
    sets[count++] = seed;
    if (def->size[0] > 0)
    {
        snprintf(size, sizeof size, "film.size=[%d, %d]", def->size[0], def->size[1]);
        sets[count++] = size;
    }
    ty_error_list errors = {0};
    ty_scene* scene = NULL;
    ty_scene_options options = {.workers = def->workers, .sets = sets, .set_count = count};
    ty_status status = def->text
                           ? ty_scene_load_memory(def->path, def->text, strlen(def->text), &options, &scene, &errors)
                           : ty_scene_load(def->path, &options, &scene, &errors);
    if (status != TY_OK)
        leave(&errors.items[0]);
    return scene;
}

ty_exr* picture_render(const picture_def* def, double* seconds)
{
    ty_scene* scene = load(def);
    ty_error error = {0};
    ty_film_setup setup = {.size = {scene->film.size[0], scene->film.size[1]},
                           .crop = {0, 0, scene->film.size[0] - 1, scene->film.size[1] - 1},
                           .sample_end = def->samples,
                           .aovs = TY_AOV_ALL};
    ty_film* film = NULL;
    ty_exr* exr = NULL;
    ty_render_options how = {.sample_end = def->samples};
    ty_render_stats stats;
    ty_film_write write = {.scene = scene, .sample_end = def->samples};
    if (ty_film_create(&setup, &film, &error) != TY_OK)
        leave(&error);
    double start = cpu_seconds();
    if (ty_render(scene, &how, def->workers, film, &stats, &error) != TY_OK)
        leave(&error);
    *seconds = cpu_seconds() - start;
    if (ty_film_to_exr(film, &write, &exr, &error) != TY_OK)
        leave(&error);
    ty_film_destroy(film);
    ty_scene_destroy(scene);
    return exr;
}

const float* picture_channel(const ty_exr* exr, const char* name)
{
    const ty_exr_channel* c = ty_exr_find_channel(exr, name);
    if (!c)
    {
        fprintf(stderr, "bench_shading: no channel %s\n", name);
        exit(1);
    }
    return c->pixels;
}
