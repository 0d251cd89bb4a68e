// SPDX-License-Identifier: Apache-2.0
// `tsuya pack`: an aggregate recipe to a GLB of instances.
#include "cli.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>

static ty_status run(const ty_arguments* arguments)
{
    static ty_scene_arguments scene_arguments;
    const char* output = ty_argument_text(arguments, "output", NULL);
    if (!output)
    {
        return ty_usage(arguments->command, "where to? give -o OUT.glb");
    }
    if (strcmp(ty_path_extension(output), "glb") != 0)
    {
        return ty_usage(arguments->command, "the output '%s' must end in .glb", output);
    }
    ty_error error;
    ty_status status = ty_output_probe(output, &error); // before minutes of packing
    if (status != TY_OK)
    {
        ty_log_error(&error);
        return status;
    }
    status = ty_scene_arguments_read(arguments, &scene_arguments);
    if (status != TY_OK)
    {
        return status;
    }
    ty_error_list errors = {0};
    double start = ty_time_now();
    status = ty_recipe_make(arguments->positional[0], output, &scene_arguments.options, &errors);
    ty_errors_log(&errors);
    ty_scene_arguments_term(&scene_arguments);
    if (status == TY_OK || status == TY_NOT_AT_REST)
    {
        ty_log(TY_LOG_INFO, "made in %.1f s", ty_time_now() - start);
        printf("%s\n", output);
        ty_status printed = ty_output_finish();
        return status == TY_OK ? printed : status;
    }
    return status;
}

static const ty_option options[] = {
    {"output", 'o', "OUT.glb", "the aggregate to write"},
    TY_SCENE_OPTIONS,
};

const ty_command ty_command_pack = {
    "pack",
    "RECIPE -o OUT.glb",
    "make an aggregate from its recipe",
    "tsuya pack scenes/rice_bowl/rice_heap.yaml -o out/rice_heap.glb --set seed=2",
    1,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
