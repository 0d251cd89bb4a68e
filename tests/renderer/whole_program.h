// SPDX-License-Identifier: Apache-2.0
// A picture of a scene given as text, for tests that ask physics of the whole program.
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/renderer/render.h>
#include <unistd.h>

// All channels of the scene's picture. The caller destroys it.
static inline ty_exr* render_text(const char* text)
{
    static int counter;
    char path[64];
    snprintf(path, sizeof path, "scene_%d_%d.yaml", (int)getpid(), counter++);
    ty_error error = {0};
    assert_int_equal(ty_file_write(path, text, strlen(text), &error), TY_OK);
    ty_scene_options options = {.cache_folder = "cache"};
    assert_int_equal(ty_workers_create(0, &options.workers, &error), TY_OK);
    ty_error_list errors = {0};
    ty_scene* scene;
    if (ty_scene_load(path, &options, &scene, &errors) != TY_OK)
    {
        char message[1600];
        ty_error_format(&errors.items[0], message, sizeof message);
        fail_msg("%s", message);
    }
    ty_film_setup setup = {.size = {scene->film.size[0], scene->film.size[1]},
                           .crop = {0, 0, scene->film.size[0] - 1, scene->film.size[1] - 1},
                           .sample_end = scene->render.samples,
                           .aovs = TY_AOV_ALL | (scene->light_group_count > 1 ? TY_AOV_LIGHT : 0u),
                           .groups = scene->light_groups,
                           .group_count = scene->light_group_count};
    ty_film* film;
    assert_int_equal(ty_film_create(&setup, &film, &error), TY_OK);
    ty_render_options render = {.sample_end = scene->render.samples};
    ty_render_stats stats;
    assert_int_equal(ty_render(scene, &render, options.workers, film, &stats, &error), TY_OK);
    assert_int_equal(stats.nonfinite_samples, 0);
    ty_film_write write = {.scene = scene, .sample_end = scene->render.samples};
    ty_exr* exr;
    assert_int_equal(ty_film_to_exr(film, &write, &exr, &error), TY_OK);
    ty_film_destroy(film);
    ty_scene_destroy(scene);
    ty_workers_destroy(options.workers);
    remove(path);
    return exr;
}

static inline float pixel(const ty_exr* exr, const char* channel, int x, int y)
{
    const ty_exr_channel* found = ty_exr_find_channel(exr, channel);
    assert_non_null(found);
    return ((const float*)found->pixels)[y * ty_exr_width(exr) + x];
}

typedef struct mean_error
{
    double mean, error; // of R over the pixels; standard error from the variance channel
} mean_error;

// Over the inclusive pixels {x0, y0, x1, y1}. The variance channel is of the luminance: scenes are grey here.
static inline mean_error mean_over(const ty_exr* exr, int x0, int y0, int x1, int y1)
{
    double sum = 0.0, variance = 0.0;
    int count = 0;
    for (int y = y0; y <= y1; y++)
    {
        for (int x = x0; x <= x1; x++, count++)
        {
            sum += (double)pixel(exr, "R", x, y);
            variance += (double)pixel(exr, "variance.Y", x, y);
        }
    }
    return (mean_error){sum / count, sqrt(variance) / count};
}
