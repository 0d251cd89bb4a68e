// SPDX-License-Identifier: Apache-2.0
// `tsuya check`: every mistake of a scene, without rendering.
#include "frames.h"
#include <stdio.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

static json_t* errors_json(const ty_error_list* errors)
{
    json_t* array = json_array();
    for (int i = 0; i < errors->count; i++)
    {
        const ty_error* error = &errors->items[i];
        json_array_append_new(array,
                              json_pack("{s:o, s:i, s:i, s:o}", "file", ty_json_from_text(error->file), "line",
                                        error->line, "column", error->column, "text", ty_json_from_text(error->text)));
    }
    return array;
}

static ty_status report(const ty_arguments* arguments, ty_scene* scene, ty_error_list* errors, ty_status status)
{
    if (ty_argument_has(arguments, "json"))
    {
        json_t* root = json_object();
        json_object_set_new(root, "ok", json_boolean(status == TY_OK));
        json_object_set_new(root, "mistakes", errors_json(errors));
        ty_error_list_term(errors);
        ty_status printed = ty_json_print(root);
        return status == TY_OK ? printed : status;
    }
    ty_errors_log(errors);
    if (status == TY_OK)
    {
        ty_scene_warn(scene);
        printf("%s: no mistakes; %d objects, %d materials, %d lights, %dx%d, %d samples\n", scene->path,
               scene->object_count, scene->material_count, scene->light_count, scene->film.size[0], scene->film.size[1],
               scene->render.samples);
        return ty_output_finish();
    }
    return status;
}

static ty_status run(const ty_arguments* arguments)
{
    static ty_scene_arguments scene_arguments;
    ty_status status = ty_scene_arguments_read(arguments, &scene_arguments);
    if (status != TY_OK)
    {
        return status;
    }
    scene_arguments.options.check_only = true;
    ty_frame_list list = {0};
    status =
        ty_argument_has(arguments, "frames") ? ty_frame_list_read(arguments, &scene_arguments.options, &list) : TY_OK;
    if (status != TY_OK)
    {
        ty_scene_arguments_term(&scene_arguments);
        return status;
    }
    double first = list.count > 0 ? list.frames[0] : 0.0;
    scene_arguments.options.frame = list.count > 0 ? &first : NULL;
    scene_arguments.options.frames = list.frames;
    scene_arguments.options.frame_count = list.count;
    ty_scene* scene = NULL;
    ty_error_list errors = {0};
    status = ty_scene_load(arguments->positional[0], &scene_arguments.options, &scene, &errors);
    status = report(arguments, scene, &errors, status);
    ty_scene_destroy(scene);
    ty_scene_arguments_term(&scene_arguments);
    ty_frame_list_term(&list);
    return status;
}

static const ty_option options[] = {
    {"frames", 'f', "LIST",
     "that sequences and keys cover these, e.g. 1-24:2,40 (default: that sequences cover the timeline)"},
    TY_SCENE_OPTIONS,
    {"json", 0, NULL, "the mistakes as JSON on standard output"},
};

const ty_command ty_command_check = {
    "check",
    "SCENE [options]",
    "find every mistake of a scene without rendering it",
    "tsuya check scenes/rice_bowl",
    1,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
