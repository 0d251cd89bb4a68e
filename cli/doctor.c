// SPDX-License-Identifier: Apache-2.0
// `tsuya doctor`: whether this machine can render, and with what.
#include "cli.h"
#include "video.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/generate/asset.h>
#include <tsuya/geometry/shape.h>

static const char* cpu_level(void)
{
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512f") ? "avx512" : __builtin_cpu_supports("avx2") ? "avx2" : "sse4.2";
#else
    return "portable";
#endif
}

static void add(json_t* root, const char* name, bool ok, const char* text)
{
    json_object_set_new(root, name, json_pack("{s:b, s:s}", "ok", ok, "text", text));
}

// Traces one ray against one sphere: Embree, the mesh floor and the query floor work together.
static void check_trace(json_t* root)
{
    ty_error error = {.text = "a ray hits a sphere where it should"};
    ty_shape_def shape = ty_shape_def_default();
    shape.kind = TY_SHAPE_SPHERE;
    shape.radius = 1.0f;
    ty_mesh* mesh = NULL;
    ty_world* world = NULL;
    ty_world_def def = ty_world_def_default();
    ty_affine identity = ty_affine_identity();
    uint32_t prototype = 0, object = 0;
    bool ok = ty_shape_create(&shape, &mesh, &error) == TY_OK && ty_world_create(&def, &world, &error) == TY_OK &&
              ty_world_add_prototype(world, mesh, &prototype, &error) == TY_OK &&
              ty_world_add_object(world, prototype, ty_motion_at_rest(&identity),
                                  (ty_object_flags){.mask = TY_MASK_OPAQUE}, &object, &error) == TY_OK &&
              ty_world_commit(world, &error) == TY_OK;
    if (ok)
    {
        ty_ray ray = ty_ray_make((ty_vec3){0.01f, 0.02f, 3}, (ty_vec3){0, 0, -1}, TY_FLOAT_MAX);
        ty_hit hit;
        ok = ty_world_intersect(world, &ray, &hit) && fabsf(hit.t - 2.0f) < 0.01f;
    }
    add(root, "embree", ok, error.text);
    ty_world_destroy(world);
    ty_mesh_destroy(mesh);
}

static void check_color(json_t* root)
{
    ty_error error = {0};
    const char* source;
    const char* path = ty_color_choose(NULL, NULL, &source);
    ty_color* color;
    if (ty_color_create(path, &color, &error) != TY_OK)
    {
        add(root, "color", false, error.text);
        return;
    }
    char text[600], views[500];
    ty_color_describe(color, views, sizeof views);
    snprintf(text, sizeof text, "configuration: %s (%s); %s", path ? path : "embedded", source, views);
    for (char* c = text; *c; c++)
    {
        *c = *c == '\n' ? ';' : *c;
    }
    add(root, "color", true, text);
    ty_color_destroy(color);
}

static void check_cache(json_t* root)
{
    char folder[TY_PATH_MAX] = "", probe[TY_PATH_MAX], text[TY_PATH_MAX + 1100];
    ty_error error = {0};
    bool ok = ty_scene_cache_folder(NULL, folder, &error) == TY_OK;
    if (ok && folder[0])
    {
        ty_path_join(folder, ".probe", probe);
        ok = ty_file_write(probe, "", 0, &error) == TY_OK;
        remove(probe);
    }
    snprintf(text, sizeof text, "%s%s%s", ok && !folder[0] ? "none" : folder, ok ? "" : ": ", ok ? "" : error.text);
    add(root, "cache", ok, text);
}

static ty_status run(const ty_arguments* arguments)
{
    json_t* root = json_object();
    char text[160];
    ty_workers* workers = NULL;
    ty_error error = {0};
    bool started = ty_workers_create(0, &workers, &error) == TY_OK;
    snprintf(text, sizeof text, "tsuya %s, %s, %d threads", TSUYA_VERSION, cpu_level(),
             started ? ty_workers_count(workers) : 0);
    add(root, "program", started, started ? text : error.text);
    ty_workers_destroy(workers);
    check_trace(root);
    check_color(root);
    check_cache(root);
    add(root, "video", true, ty_video_available() ? "ffmpeg is there" : "no ffmpeg in PATH: --video makes none");
    bool all = true;
    const char* name;
    json_t* item;
    json_object_foreach(root, name, item)
    {
        bool ok = json_is_true(json_object_get(item, "ok"));
        all = all && ok;
        if (!ty_argument_has(arguments, "json"))
        {
            printf("%-8s %s %s\n", name, ok ? "ok  " : "FAIL", json_string_value(json_object_get(item, "text")));
        }
    }
    if (ty_argument_has(arguments, "json"))
    {
        ty_status status = ty_json_print(root);
        return all ? status : TY_BAD_FILE;
    }
    json_decref(root);
    return all ? ty_output_finish() : TY_BAD_FILE;
}

static const ty_option options[] = {
    {"json", 0, NULL, "as JSON"},
};

const ty_command ty_command_doctor = {
    "doctor",
    "",
    "check that this machine can render, and say with what",
    "tsuya doctor",
    0,
    0,
    options,
    TY_PARAM_COUNT(options),
    run,
};
