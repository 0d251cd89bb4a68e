// SPDX-License-Identifier: Apache-2.0
// A small picture of roots on their host: a scene made in memory around the two meshes.
#include "cli.h"
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/base/sink.h>
#include <tsuya/geometry/mesh_file.h>
#include <tsuya/renderer/render.h>

// A name as YAML takes it, whatever stands in it.
static void put_quoted(ty_sink* text, const char* path)
{
    char whole[PATH_MAX];
    const char* c = realpath(path, whole) ? whole : path;
    ty_sink_put(text, "'", 1);
    for (; *c; c++)
        ty_sink_put(text, *c == '\'' ? "''" : c, *c == '\'' ? 2 : 1);
    ty_sink_put(text, "'", 1);
}

static void put_light(ty_sink* text, ty_vec3 middle, float size, ty_vec3 from, float side, ty_rgb radiance)
{
    const float center[] = {middle.x + from.x * size, middle.y + from.y * size, middle.z + from.z * size};
    ty_sink_format(text, "  - { type: rectangle, center: [%g, %g, %g], target: [%g, %g, %g], ", (double)center[0],
                   (double)center[1], (double)center[2], (double)middle.x, (double)middle.y, (double)middle.z);
    ty_sink_format(text, "size: [%g, %g], radiance: [%g, %g, %g], camera_visible: false }\n", (double)(side * size),
                   (double)(side * size), (double)radiance.r, (double)radiance.g, (double)radiance.b);
}

// Roots and host from the front and a little above, warm light from the left, a cool rim from behind.
static void put_scene(ty_sink* text, const char* roots, const char* host, ty_bounds all)
{
    ty_vec3 middle = ty_mul(ty_add(all.low, all.high), 0.5f), extent = ty_sub(all.high, all.low);
    float size = ty_max(0.5f * ty_length(extent), 1e-6f), far = 4.2f * size;
    ty_sink_format(text, "tsuya: 1\nfilm: { size: [480, 480] }\nrender: { samples: 24, max_depth: 4 }\ncamera:\n");
    ty_sink_format(text, "  position: [%g, %g, %g]\n", (double)(middle.x + 0.35f * far),
                   (double)(middle.y + 0.24f * far), (double)(middle.z + 0.91f * far));
    ty_sink_format(text, "  look_at: [%g, %g, %g]\n  vfov: 29\nassets:\n  roots: { mesh: ", (double)middle.x,
                   (double)middle.y, (double)middle.z);
    put_quoted(text, roots);
    ty_sink_format(text, " }\n  host: { mesh: ");
    put_quoted(text, host);
    ty_sink_format(text, " }\n  ground: { shape: box, size: [%g, %g, %g], divisions: 8 }\n", (double)(40.0f * size),
                   (double)(0.02f * size), (double)(40.0f * size));
    ty_sink_format(text, "materials:\n"
                         "  bark: { model: surface, base_color: [0.30, 0.23, 0.17], specular_roughness: 0.55 }\n"
                         "  stone: { model: surface, base_color: [0.42, 0.41, 0.38], specular_roughness: 0.6 }\n"
                         "  ground: { model: surface, base_color: [0.24, 0.23, 0.215], specular_roughness: 0.6 }\n");
    ty_sink_format(text, "objects:\n  - { mesh: roots, material: bark }\n  - { mesh: host, material: stone }\n");
    ty_sink_format(text, "  - { mesh: ground, material: ground, translate: [%g, %g, %g] }\n", (double)middle.x,
                   (double)(all.low.y - 0.021f * size), (double)middle.z);
    ty_sink_format(text, "lights:\n  - { type: environment, radiance: [0.3, 0.32, 0.35] }\n");
    put_light(text, middle, size, ty_vec3_make(-3.2f, 3.0f, 1.6f), 2.0f, (ty_rgb){27.0f, 24.0f, 20.5f});
    put_light(text, middle, size, ty_vec3_make(2.6f, 2.2f, -2.6f), 1.6f, (ty_rgb){11.0f, 13.0f, 16.0f});
}

static ty_status render(const ty_scene* scene, const char* output, ty_workers* workers, ty_error* error)
{
    ty_film_setup setup = {.sample_end = scene->render.samples};
    ty_render_options options = {.sample_end = scene->render.samples};
    ty_develop_def develop = {.bits = 8};
    ty_render_stats stats;
    ty_film* film;
    ty_exr* exr = NULL;
    memcpy(setup.size, scene->film.size, sizeof setup.size);
    setup.crop[2] = setup.size[0] - 1;
    setup.crop[3] = setup.size[1] - 1;
    ty_status status = ty_film_create(&setup, &film, error);
    if (status != TY_OK)
        return status;
    ty_film_write write = {.scene = scene, .sample_end = setup.sample_end};
    status = ty_render(scene, &options, workers, film, &stats, error);
    if (status == TY_OK)
        status = ty_film_to_exr(film, &write, &exr, error);
    if (status == TY_OK)
        status = ty_develop(exr, &develop, output, error);
    ty_exr_destroy(exr);
    ty_film_destroy(film);
    return status;
}

static ty_status bounds_read(const char* path, ty_bounds* all, ty_error* error)
{
    ty_mesh* mesh;
    ty_status status = ty_mesh_read(path, &mesh, error);
    if (status != TY_OK)
        return status;
    all->low = ty_min3(all->low, mesh->bounds.low);
    all->high = ty_max3(all->high, mesh->bounds.high);
    ty_mesh_destroy(mesh);
    return TY_OK;
}

// Of a growth its last frame.
static ty_status mesh_find(const char* pattern, char path[TY_PATH_MAX], ty_error* error)
{
    ty_frame_numbers frames;
    snprintf(path, TY_PATH_MAX, "%s", pattern);
    if (!ty_path_is_sequence(pattern))
        return TY_OK;
    ty_status status = ty_frame_numbers_find(pattern, &frames, error);
    if (status != TY_OK)
        return status;
    ty_path_frame(pattern, frames.numbers[frames.count - 1], path);
    ty_frame_numbers_term(&frames);
    return TY_OK;
}

ty_status ty_roots_picture(const char* output, const char* roots, const char* host, const ty_scene_options* options)
{
    static char mesh[TY_PATH_MAX];
    ty_error error;
    ty_bounds all = ty_bounds_empty();
    double start = ty_time_now();
    ty_status status = mesh_find(roots, mesh, &error);
    if (status == TY_OK)
        status = bounds_read(mesh, &all, &error);
    if (status == TY_OK)
        status = bounds_read(host, &all, &error);
    if (status == TY_OK)
    {
        ty_sink text = {0};
        ty_error_list errors = {0};
        ty_scene* scene = NULL;
        const ty_scene_options own = {.workers = options->workers, .ocio = options->ocio, .isa = options->isa};
        put_scene(&text, mesh, host, all);
        status = ty_scene_load_memory("preview", text.bytes, text.size, &own, &scene, &errors);
        ty_errors_log(&errors);
        ty_sink_term(&text);
        if (status != TY_OK)
            return status;
        status = render(scene, output, options->workers, &error);
        ty_scene_destroy(scene);
    }
    if (status != TY_OK)
        ty_log_error(&error);
    else
        ty_log(TY_LOG_INFO, "%s in %.1f s", output, ty_time_now() - start);
    return status;
}
