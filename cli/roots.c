// SPDX-License-Identifier: Apache-2.0
// `tsuya roots`: the mesh of roots on a host, or its growth as frames; centre lines, figures and a picture beside it.
#include "cli.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>

static const char *const mesh_endings[] = {"ply", "obj", "glb", NULL}, *const curve_endings[] = {"ply", NULL},
                         *const picture_endings[] = {"png", NULL}, *const report_endings[] = {"json", NULL};

static ty_status check_outputs(const ty_arguments* arguments)
{
    static const char* const names[] = {"output", "curves", "host", "report", "preview"};
    static const char* const* const endings[] = {mesh_endings, curve_endings, mesh_endings, report_endings,
                                                 picture_endings};
    const char* paths[TY_PARAM_COUNT(names)];
    ty_status status = TY_OK;
    for (int i = 0; i < TY_PARAM_COUNT(names) && status == TY_OK; i++)
    {
        paths[i] = ty_argument_text(arguments, names[i], NULL);
        if (i == 0 || paths[i])
            status = ty_output_check(arguments->command, names[i], paths[i], endings[i],
                                     i == 0 ? TY_OUTPUT_EITHER : TY_OUTPUT_FILE);
    }
    return status == TY_OK ? ty_output_check_apart(arguments->command, names, paths, TY_PARAM_COUNT(names)) : status;
}

// --- the report ---

static double number(const json_t* report, const char* key)
{
    return json_number_value(json_object_get(report, key));
}

static void figures_print(const json_t* report)
{
    const char* kind;
    json_t* counts;
    printf("grown   ");
    json_object_foreach(json_object_get(report, "roots"), kind, counts)
        printf(" %s %d of %d ", kind, (int)number(counts, "grown"), (int)number(counts, "requested"));
    printf("\njoined   %d lines in %d part%s\n", (int)number(report, "lines"), (int)number(report, "parts"),
           number(report, "parts") > 1.0 ? "s" : "");
    printf(
        "host     at most %.2f radii under it (%+.3f against sink); gap below %.3f radii for 99 %%; %.1f %% covered\n",
        number(report, "deepest"), number(report, "deeper_than_sink"), number(report, "gap_p99"),
        100.0 * number(report, "coverage"));
    printf("mesh     %d triangles, %d shell%s, %s; corners from %.1f degrees, 99.9 %% above %.1f\n",
           (int)number(report, "triangles"), (int)number(report, "shells"), number(report, "shells") > 1.0 ? "s" : "",
           json_is_true(json_object_get(report, "closed")) ? "closed" : "open", number(report, "corner_least"),
           number(report, "corner_p01"));
    printf("lines    bend to %.0f degrees at most, 99 %% above %.0f\n", number(report, "bend_least"),
           number(report, "bend_p1"));
}

// Both methods on the same host, where the thesis' is asked for.
static void methods_print(const json_t* report)
{
    const char* name;
    json_t *method, *methods = json_object_get(report, "methods");
    if (!json_object_get(methods, "seed"))
        return;
    json_object_foreach(methods, name, method)
    {
        printf("%-8s %d of %d branches failed (%d no angle, %d restarts, %d points, %d no partner); %d kinked, ", name,
               (int)number(method, "failed"), (int)number(method, "branches"), (int)number(method, "no_angle"),
               (int)number(method, "restarts"), (int)number(method, "points"), (int)number(method, "no_partner"),
               (int)number(method, "kinked"));
        printf("%.2f radii too deep, %.0f %% held\n", number(method, "deepest"), 100.0 * number(method, "held"));
    }
}

static void report_print(const json_t* report)
{
    figures_print(report);
    methods_print(report);
}

// --- the making ---

// Mesh and what is beside it. The figures are the caller's.
static ty_status make(const ty_arguments* arguments, const ty_scene_options* options)
{
    ty_error_list errors = {0};
    double start = ty_time_now();
    ty_status status = ty_recipe_make(arguments->positional[0], "roots", ty_argument_text(arguments, "output", NULL), 0,
                                      options, &errors);
    ty_errors_log(&errors);
    if (status == TY_OK)
        ty_log(TY_LOG_INFO, "made in %.1f s", ty_time_now() - start);
    return status;
}

// The picture needs the host, too: where none is asked for, in a file that goes again.
static ty_status make_with_picture(const ty_arguments* arguments, ty_scene_options* options)
{
    static ty_atomic_file passing; // paths: too large for the stack
    char name[TY_PATH_MAX];
    ty_error error;
    const char *output = ty_argument_text(arguments, "output", NULL),
               *preview = ty_argument_text(arguments, "preview", NULL);
    bool passes = preview && !options->host;
    ty_status status = TY_OK;
    if (passes)
    {
        snprintf(name, sizeof name, "%.4000s.ply", preview);
        status = ty_atomic_begin(&passing, name, &error);
        if (status != TY_OK)
        {
            ty_log_error(&error);
            return status;
        }
        options->host = passing.temporary;
    }
    status = make(arguments, options);
    if (status == TY_OK && preview)
        status = ty_roots_picture(preview, output, options->host, options);
    if (passes)
        ty_atomic_abort(&passing);
    return status;
}

static ty_status run(const ty_arguments* arguments)
{
    static ty_scene_arguments scene_arguments;
    ty_scene_options* options = &scene_arguments.options;
    const char* output = ty_argument_text(arguments, "output", NULL);
    char* report = NULL;
    ty_status status = check_outputs(arguments);
    if (status == TY_OK)
        status = ty_scene_arguments_read(arguments, &scene_arguments);
    if (status != TY_OK)
        return status;
    if (ty_argument_has(arguments, "report") || ty_argument_has(arguments, "json"))
        options->report = &report;
    options->curves = ty_argument_text(arguments, "curves", NULL);
    options->host = ty_argument_text(arguments, "host", NULL);
    status = make_with_picture(arguments, options);
    ty_scene_arguments_term(&scene_arguments);
    if (status == TY_OK && report)
        status = ty_report_give(arguments, output, report, report_print);
    else if (status == TY_OK)
    {
        printf("%s\n", output);
        status = ty_output_finish();
    }
    ty_free(report);
    return status;
}

static const ty_option options[] = {
    {"output", 'o', "OUT.ply",
     "the mesh: .ply, .obj or .glb; with `levels` OUT.lod1.ply ... beside it; with #### its growth as frames"},
    {"curves", 0, "FILE.ply", "centre lines as text that can be edited and given back as the recipe's `curves`"},
    {"host", 0, "FILE.ply", "what they hold on to as a mesh, in its place: .ply, .obj or .glb"},
    {"report", 0, "FILE.json", "figures: roots asked for and grown, hold, gaps, corners, bends, coverage, times"},
    {"json", 0, NULL, "print them, in place of the name of the mesh"},
    {"preview", 0, "FILE.png", "a small picture of the roots on their host"},
    TY_SCENE_OPTIONS,
};

const ty_command ty_command_roots = {
    "roots",
    "RECIPE -o OUT.ply",
    "make the mesh of roots on a host from its recipe",
    "tsuya roots scenes/still_life/roots.yaml -o out/roots.ply --preview out/roots.png",
    1,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
