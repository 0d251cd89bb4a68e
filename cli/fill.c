// SPDX-License-Identifier: Apache-2.0
// `tsuya fill`: the frames of a living pattern, with pictures and the state beside them.
#include "cli.h"
#include "fill_pages.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>

static const char *const frame_endings[] = {"exr", "png", NULL}, *const picture_endings[] = {"png", NULL};
static const char* const page_endings[] = {"html", NULL};

static const char* const volume_endings[] = {"raw", "nrrd", NULL};

static ty_status check_outputs(const ty_arguments* arguments)
{
    const char* output = ty_argument_text(arguments, "output", NULL);
    const char* png = ty_argument_text(arguments, "png", NULL);
    const char* state = ty_argument_text(arguments, "state", NULL);
    const char* sheet = ty_argument_text(arguments, "sheet", NULL);
    const char* page = ty_argument_text(arguments, "page", NULL);
    const char* volume = ty_argument_text(arguments, "volume", NULL);
    const ty_command* command = arguments->command;
    ty_status status = ty_output_check(command, "output", output, frame_endings, TY_OUTPUT_FRAMES);
    if (status == TY_OK && png)
        status = ty_output_check(command, "output", png, picture_endings, TY_OUTPUT_FRAMES);
    if (status == TY_OK && state)
        status = ty_output_check(command, "state", state, ty_state_endings, TY_OUTPUT_FILE);
    if (status == TY_OK && sheet)
        status = ty_output_check(command, "sheet", sheet, picture_endings, TY_OUTPUT_FILE);
    if (status == TY_OK && page)
        status = ty_output_check(command, "page", page, page_endings, TY_OUTPUT_FILE);
    if (status == TY_OK && volume)
        status = ty_output_check(command, "volume", volume, volume_endings, TY_OUTPUT_FILE);
    if (status == TY_OK && volume && ty_argument_has(arguments, "resume"))
        status = ty_usage(command, "--volume holds all frames; with --resume there are only the last");
    if (status == TY_OK && page && strcmp(ty_path_extension(output), "exr") != 0)
        status = ty_usage(command, "--page reads what the frames tell: they must end in .exr");
    return status;
}

// What is made of the frames once they are there.
static ty_status write_pages(const ty_arguments* arguments, const char* output)
{
    ty_error error;
    long every = 0;
    const char* sheet = ty_argument_text(arguments, "sheet", NULL);
    const char* page = ty_argument_text(arguments, "page", NULL);
    ty_status status = TY_OK;
    if (ty_argument_has(arguments, "every"))
        status = ty_argument_int(arguments, "every", 1, 1000000, &every);
    if (status != TY_OK)
        return status;
    if (sheet)
        status = ty_contact_sheet_write(sheet, output, (int)every, &error);
    if (status == TY_OK && page)
        status = ty_map_page_write(page, output, &error);
    if (status != TY_OK)
        ty_log_error(&error);
    return status;
}

static ty_status run(const ty_arguments* arguments)
{
    static ty_scene_arguments scene_arguments;
    const char* output = ty_argument_text(arguments, "output", NULL);
    ty_status status = check_outputs(arguments);
    if (status == TY_OK)
        status = ty_scene_arguments_read(arguments, &scene_arguments);
    if (status != TY_OK)
        return status;
    ty_scene_options* options = &scene_arguments.options;
    options->resume = ty_argument_text(arguments, "resume", NULL);
    options->state = ty_argument_text(arguments, "state", NULL);
    options->picture = ty_argument_text(arguments, "png", NULL);
    options->volume = ty_argument_text(arguments, "volume", NULL);
    if (ty_argument_has(arguments, "also"))
        ty_scene_arguments_set(&scene_arguments, "outputs=[%.70s]", ty_argument_text(arguments, "also", ""));
    ty_error_list errors = {0};
    double start = ty_time_now();
    status = ty_recipe_make(arguments->positional[0], "fill", output, 0, options, &errors);
    ty_errors_log(&errors);
    ty_scene_arguments_term(&scene_arguments);
    if (status == TY_OK)
        status = write_pages(arguments, output);
    if (status != TY_OK)
        return status;
    ty_log(TY_LOG_INFO, "made in %.1f s", ty_time_now() - start);
    printf("%s\n", output);
    return ty_output_finish();
}

static const ty_option options[] = {
    {"output", 'o', "OUT.####.exr", "the frames to write, from 1; .png for pictures alone"},
    {"png", 0, "OUT.####.png", "the same as pictures beside them, encoded for an sRGB display"},
    {"also", 0, "NAMES", "more channels, as the recipe's `outputs`: u,v,mark,trail,distance,mattes"},
    {"state", 0, "FILE.exr", "where a run keeps its state, at its end or when it is interrupted"},
    {"resume", 0, "FILE.exr", "go on after the frame whose state that is: the same frames as without a stop"},
    {"volume", 0, "FILE.nrrd", "the frames as slices: v where it is among the channels, else what they show; or .raw"},
    {"sheet", 0, "FILE.png", "a contact sheet of the frames"},
    {"every", 0, "N", "with --sheet: of every N-th frame (default: 24 of them at most)"},
    {"page", 0, "FILE.html", "of a recipe with `map`: a page on which rates are picked with a click"},
    TY_SCENE_OPTIONS,
};

const ty_command ty_command_fill = {
    "fill",
    "RECIPE -o OUT.####.exr",
    "make the frames of a living pattern from its recipe",
    "tsuya fill scenes/still_life/fill.yaml -o 'out/fill.####.exr' --set seed=2",
    1,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
