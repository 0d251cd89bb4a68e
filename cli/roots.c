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
    static const struct
    {
        const char* option;
        const char* const* endings;
    } beside[] = {
        {"curves", curve_endings}, {"host", mesh_endings}, {"report", report_endings}, {"preview", picture_endings}};
    ty_status status = ty_output_check(arguments->command, "output", ty_argument_text(arguments, "output", NULL),
                                       mesh_endings, TY_OUTPUT_EITHER);
    for (int i = 0; i < TY_PARAM_COUNT(beside) && status == TY_OK; i++)
    {
        const char* path = ty_argument_text(arguments, beside[i].option, NULL);
        if (path)
            status = ty_output_check(arguments->command, beside[i].option, path, beside[i].endings, TY_OUTPUT_FILE);
    }
    return status;
}

// --- the report ---

static double number(const json_t* report, const char* key)
{
    return json_number_value(json_object_get(report, key));
}

static void report_print(const json_t* report)
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

static ty_status report_give(const ty_arguments* arguments, const char* output, const char* text)
{
    const char* file = ty_argument_text(arguments, "report", NULL);
    json_t* report = json_loads(text, 0, NULL);
    if (!report)
    {
        ty_log(TY_LOG_ERROR, "the report is no JSON");
        return TY_INTERNAL;
    }
    json_object_set_new(report, "output", ty_json_from_text(output));
    ty_status status = file ? ty_json_write(file, json_incref(report)) : TY_OK;
    if (status == TY_OK && ty_argument_has(arguments, "json"))
        return ty_json_print(report);
    if (status == TY_OK)
    {
        printf("%s\n", output);
        report_print(report);
        methods_print(report);
        status = ty_output_finish();
    }
    json_decref(report);
    return status;
}

// --- the making ---

// A picture needs the host, too: of its own where none is asked for.
static void host_place(const ty_arguments* arguments, char path[TY_PATH_MAX])
{
    const char* host = ty_argument_text(arguments, "host", NULL);
    const char* preview = ty_argument_text(arguments, "preview", NULL);
    path[0] = '\0';
    if (host)
        snprintf(path, TY_PATH_MAX, "%s", host);
    else if (preview)
        snprintf(path, TY_PATH_MAX, "%.4000s.host.ply", preview);
}

static ty_status make(const ty_arguments* arguments, ty_scene_arguments* scene_arguments)
{
    static char host[TY_PATH_MAX];
    const char* output = ty_argument_text(arguments, "output", NULL);
    const char* preview = ty_argument_text(arguments, "preview", NULL);
    ty_scene_options* options = &scene_arguments->options;
    char* report = NULL;
    bool wants_report = ty_argument_has(arguments, "report") || ty_argument_has(arguments, "json");
    host_place(arguments, host);
    options->report = wants_report ? &report : NULL;
    options->curves = ty_argument_text(arguments, "curves", NULL);
    options->host = host[0] ? host : NULL;
    ty_error_list errors = {0};
    double start = ty_time_now();
    ty_status status = ty_recipe_make(arguments->positional[0], "roots", output, 0, options, &errors);
    ty_errors_log(&errors);
    if (status == TY_OK)
        ty_log(TY_LOG_INFO, "made in %.1f s", ty_time_now() - start);
    if (status == TY_OK && preview)
        status = ty_roots_picture(preview, output, host, options);
    if (preview && !ty_argument_has(arguments, "host"))
        remove(host);
    if (status == TY_OK && report)
        status = report_give(arguments, output, report);
    else if (status == TY_OK)
    {
        printf("%s\n", output);
        status = ty_output_finish();
    }
    ty_free(report);
    return status;
}

static ty_status run(const ty_arguments* arguments)
{
    static ty_scene_arguments scene_arguments;
    ty_status status = check_outputs(arguments);
    if (status == TY_OK)
        status = ty_scene_arguments_read(arguments, &scene_arguments);
    if (status != TY_OK)
        return status;
    status = make(arguments, &scene_arguments);
    ty_scene_arguments_term(&scene_arguments);
    return status;
}

static const ty_option options[] = {
    {"output", 'o', "OUT.ply",
     "the mesh: .ply, .obj or .glb; with `levels` OUT.lod1.ply ... beside it; with #### its growth as frames"},
    {"curves", 0, "FILE.ply", "centre lines as text that can be edited and given back as the recipe's `curves`"},
    {"host", 0, "FILE.ply", "what they hold on to as a mesh, in its place: .ply, .obj or .glb"},
    {"report", 0, "FILE.json", "figures: roots asked for and grown, hold, gaps, corners, bends, coverage, times"},
    {"json", 0, NULL, "print them instead of a summary"},
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
