// SPDX-License-Identifier: Apache-2.0
// `tsuya pack` and `tsuya filter`: a recipe to a file, or to files by number.
#include "video.h"
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/geometry/aggregate_export.h>

// What a command makes and where it may go.
typedef struct product
{
    const char *command, *kind;
    const char* const* extensions; // up to NULL
    bool is_sequence, is_file;     // both: the output tells
} product;

static const char *const filter_extensions[] = {"exr", "png", "gif", "mp4", "mov", "mkv", NULL},
                         *const mesh_extensions[] = {"ply", NULL};
static const product products[] = {
    {"pack", "aggregate", ty_aggregate_endings, true, true},
    {"filter", "filter", filter_extensions, true, true},
};

static const product* find_product(const ty_command* command)
{
    const product* found = products;
    while (strcmp(found->command, command->name) != 0)
        found++;
    return found;
}

static ty_status check_output(const ty_arguments* arguments, const product* p, const char* output)
{
    const ty_command* command = arguments->command;
    const char* state = ty_argument_text(arguments, "state", NULL);
    bool film =
        output && (ty_video_is_named(output) || (ty_path_is_sequence(output) && strcmp(p->kind, "aggregate") == 0));
    if (film && ty_argument_has(arguments, "resume"))
        return ty_usage(command, "--resume goes on to one file; a film begins at its beginning");
    ty_output_form form = !p->is_sequence ? TY_OUTPUT_FILE : p->is_file ? TY_OUTPUT_EITHER : TY_OUTPUT_FRAMES;
    ty_status status = ty_film_check(command, output, p->extensions, form);
    return status == TY_OK && state ? ty_output_check(command, "state", state, ty_state_endings, TY_OUTPUT_FILE)
                                    : status;
}

// An image after the recipe: the recipe's own, found from where the command is typed.
static ty_status take_image(const ty_arguments* arguments, ty_scene_arguments* out)
{
    static char text[TY_PATH_MAX + 16];
    char path[TY_PATH_MAX], folder[TY_PATH_MAX], whole[PATH_MAX];
    if (arguments->positional_count < 2)
        return TY_OK;
    ty_path_folder(arguments->positional[1], folder);
    const char* name = strrchr(arguments->positional[1], '/');
    ty_path_join(realpath(folder, whole) ? whole : folder, name ? name + 1 : arguments->positional[1], path);
    if (strpbrk(path, "'\n"))
        return ty_usage(arguments->command, "the name of the image has a character that YAML needs: %s", path);
    snprintf(text, sizeof text, "image='%s'", path);
    out->sets[out->options.set_count++] = text;
    return TY_OK;
}

static ty_status make(const char* recipe, const product* p, const char* output, int element, double fps,
                      const ty_scene_options* options)
{
    if (ty_video_is_named(output))
        return ty_film_make(recipe, p->kind, output, fps, options);
    ty_error_list errors = {0};
    ty_status status = ty_recipe_make(recipe, p->kind, output, element, options, &errors);
    ty_errors_log(&errors);
    return status;
}

static ty_status run(const ty_arguments* arguments)
{
    static ty_scene_arguments scene_arguments;
    const product* p = find_product(arguments->command);
    const char* output = ty_argument_text(arguments, "output", NULL);
    const product one = {p->command, p->kind, mesh_extensions, false, true};
    bool alone = ty_argument_has(arguments, "element");
    long element = 0;
    double fps = 24.0;
    ty_status status = alone ? ty_argument_int(arguments, "element", 1, INT_MAX, &element) : TY_OK;
    if (status == TY_OK)
        status = check_output(arguments, alone ? &one : p, output);
    if (status == TY_OK)
        status = ty_scene_arguments_read(arguments, &scene_arguments);
    if (status == TY_OK)
        status = take_image(arguments, &scene_arguments);
    if (status == TY_OK && ty_argument_has(arguments, "fps"))
        status = ty_argument_float(arguments, "fps", 0.1, 1000.0, &fps);
    if (status != TY_OK)
        return status;
    scene_arguments.options.resume = ty_argument_text(arguments, "resume", NULL);
    scene_arguments.options.state = ty_argument_text(arguments, "state", NULL);
    double start = ty_time_now();
    status = make(arguments->positional[0], p, output, (int)element, fps, &scene_arguments.options);
    ty_scene_arguments_term(&scene_arguments);
    if (status != TY_OK && status != TY_NOT_AT_REST)
        return status;
    ty_log(TY_LOG_INFO, "made in %.1f s", ty_time_now() - start);
    printf("%s\n", output);
    ty_status printed = ty_output_finish();
    return status == TY_OK ? printed : status;
}

static const ty_option pack_options[] = {
    {"output", 'o', "OUT.glb", "the aggregate to write; also .usda (USD), .ply (points) and .obj (one mesh)"},
    {"resume", 0, "FILE.glb", "go on from the state in a file that the same recipe gave with settle.state"},
    {"element", 0, "N", "instead one of its elements alone, from 1, as a mesh: .ply"},
    TY_SCENE_OPTIONS,
};
static const ty_option filter_options[] = {
    {"output", 'o', "OUT.png",
     "the picture to write, .png or .exr; with #### the frames, from 1; or a film: .gif, .mp4, .mov, .mkv"},
    {"fps", 0, "N", "frames a second of a film (default 24)"},
    {"state", 0, "FILE.exr", "where the reaction's state is kept, at its end or when it is interrupted"},
    {"resume", 0, "FILE.exr", "go on from that state: the same picture as without a stop, or a later one"},
    TY_SCENE_OPTIONS,
};

const ty_command ty_command_pack = {
    "pack",
    "RECIPE -o OUT.glb",
    "make an aggregate from its recipe",
    "tsuya pack scenes/rice_bowl/rice_heap.yaml -o out/rice_heap.glb --set seed=2",
    1,
    1,
    pack_options,
    TY_PARAM_COUNT(pack_options),
    run,
};

const ty_command ty_command_filter = {
    "filter",
    "RECIPE [IMAGE] -o OUT.png",
    "redraw a picture by spots or stripes that keep its tones",
    "tsuya filter scenes/filter_seed/tone.yaml docs/images/roe.jpg -o out/roe.png --set size=0.7",
    1,
    2,
    filter_options,
    TY_PARAM_COUNT(filter_options),
    run,
};
