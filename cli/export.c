// SPDX-License-Identifier: Apache-2.0
// `tsuya export`: an aggregate for other programs.
#include "cli.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/geometry/aggregate_export.h>
#include <tsuya/geometry/mesh_file.h>

static ty_status check(const ty_arguments* arguments, const char* output)
{
    if (!output)
        return ty_usage(arguments->command, "where to? give -o %s", arguments->command->options[0].value);
    bool is_points = strcmp(ty_path_extension(arguments->positional[0]), "ply") == 0;
    if (is_points != ty_argument_has(arguments, "prototype"))
        return ty_usage(arguments->command,
                        is_points ? "points (.ply) need their mesh: give --prototype MESH"
                                  : "--prototype goes with points (.ply): '%s' has its own",
                        arguments->positional[0]);
    bool facets = ty_argument_has(arguments, "facets");
    if (!facets && (ty_argument_has(arguments, "close") || ty_argument_has(arguments, "threads")))
        return ty_usage(arguments->command, "--close and --threads go with --facets");
    return ty_output_check_ending(arguments->command, output, ty_aggregate_endings);
}

static ty_status read_input(const ty_arguments* arguments, ty_aggregate** out, ty_error* error)
{
    const char* prototype = ty_argument_text(arguments, "prototype", NULL);
    ty_mesh* mesh = NULL;
    ty_status status = prototype ? ty_mesh_read(prototype, &mesh, error) : TY_OK;
    if (status == TY_OK)
        status = ty_aggregate_read(arguments->positional[0], mesh, out, error);
    ty_mesh_destroy(mesh);
    ty_error none; // most hold no state
    if (status == TY_OK && !prototype &&
        strcmp(ty_path_extension(ty_argument_text(arguments, "output", "")), "glb") == 0 &&
        ty_aggregate_read_state(arguments->positional[0], &(*out)->state, &none) != TY_OK)
        (*out)->state = (ty_bytes){0};
    return status;
}

// One mesh with contact facets; what became of it is told.
static ty_status export_facets(const ty_arguments* arguments, const char* output, const ty_aggregate* aggregate,
                               ty_error* error)
{
    ty_facet_def def = ty_facet_def_default();
    ty_facet_report report;
    ty_mesh* mesh = NULL;
    double close_mm = 0.0, start = ty_time_now();
    ty_workers* workers = NULL;
    long threads = 0;
    ty_status status = TY_OK;
    if (ty_argument_has(arguments, "close"))
        status = ty_argument_float(arguments, "close", 0.0, 10.0, &close_mm);
    if (status == TY_OK && ty_argument_has(arguments, "threads"))
        status = ty_argument_int(arguments, "threads", 1, 256, &threads);
    if (status != TY_OK)
        return TY_USAGE;
    def.close = (float)(close_mm * 1e-3);
    status = ty_workers_create((int)threads, &workers, error);
    if (status == TY_OK)
        status = ty_aggregate_realise_facets(aggregate, &def, workers, &mesh, &report, error);
    if (status == TY_OK)
    {
        ty_log(TY_LOG_INFO,
               "facets: %u contacts, %u of %u vertices moved, at most %.3g mm within another before and %.2g mm after, "
               "%.1f s",
               report.contacts, report.vertices, mesh->vertex_count, (double)report.deepest * 1e3,
               (double)report.left * 1e3, ty_time_now() - start);
        ty_log(TY_LOG_INFO, "facets: the volume changes by %.3f %%",
               100.0 * (report.volume_after / report.volume_before - 1.0));
        status = ty_mesh_export(output, mesh, error);
    }
    ty_mesh_destroy(mesh);
    ty_workers_destroy(workers);
    return status;
}

static ty_status run(const ty_arguments* arguments)
{
    const char* output = ty_argument_text(arguments, "output", NULL);
    ty_status status = check(arguments, output);
    if (status != TY_OK)
        return status;
    ty_error error;
    ty_aggregate* aggregate = NULL;
    status = ty_output_probe(output, &error);
    if (status == TY_OK)
        status = read_input(arguments, &aggregate, &error);
    if (status == TY_OK && ty_argument_has(arguments, "facets"))
        status = export_facets(arguments, output, aggregate, &error);
    else if (status == TY_OK)
        status = ty_aggregate_export(output, aggregate, ty_argument_has(arguments, "realise"), &error);
    ty_aggregate_destroy(aggregate);
    if (status != TY_OK)
    {
        ty_log_error(&error);
        return status;
    }
    printf("%s\n", output);
    return ty_output_finish();
}

static const ty_option options[] = {
    {"output", 'o', "OUT", "where to, by its ending: .usda (PointInstancer), .ply (points), .obj (one mesh), .glb"},
    {"realise", 0, NULL, "one mesh of all instances, for programs without instancing (.glb, .ply, .obj)"},
    {"facets", 0, NULL, "the same with flat facets where elements touch, so that none reaches into another"},
    {"close", 0, "MM", "with --facets: also closes gaps, as sticky rice does; wider ones less and less up to MM"},
    {"threads", 0, "N", "with --facets: the threads to use; all cores unless given"},
    {"prototype", 0, "MESH", "the mesh of points (IN.ply)"},
};

const ty_command ty_command_export = {
    "export",
    "IN -o OUT",
    "convert an aggregate for other programs",
    "tsuya export out/rice_heap.glb -o out/rice_heap.usda",
    1,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
