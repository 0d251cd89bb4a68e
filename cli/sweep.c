// SPDX-License-Identifier: Apache-2.0
// `tsuya sweep`: one scene over values of its parameters.
#include "sweep_view.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

enum
{
    MOST_CELLS = 100000,
    CELLS = 400 // unless --most-cells says otherwise
};

// Whether an option of the command line sets what varies.
static ty_status check_options(const ty_sweep_job* job)
{
    static const struct
    {
        const char *option, *path;
    } pairs[] = {
        {"spp", "render.samples"}, {"seed", "render.seed"}, {"size", "film.size"}, {"integrator", "render.integrator"}};
    for (int i = 0; i < TY_PARAM_COUNT(pairs); i++)
    {
        for (int a = 0; a < job->sweep.axis_count; a++)
        {
            if (strcmp(job->sweep.axes[a].name, pairs[i].path) == 0 && ty_argument_has(job->arguments, pairs[i].option))
            {
                return ty_usage(job->arguments->command, "--%s sets %s, which varies", pairs[i].option, pairs[i].path);
            }
        }
    }
    return TY_OK;
}

static ty_status read_axes(ty_sweep_job* job)
{
    static const char* texts[TY_PARAM_COUNT(job->arguments->given)];
    ty_sweep_def def = {.arguments = texts, .zip = ty_argument_has(job->arguments, "zip")};
    long most = CELLS;
    ty_status status = TY_OK;
    for (int i = 0; i < job->arguments->given_count; i++)
    {
        const ty_given* given = &job->arguments->given[i];
        if (strcmp(given->option->name, "vary") == 0)
        {
            texts[def.argument_count++] = given->text;
        }
    }
    if (ty_argument_has(job->arguments, "most-cells"))
    {
        status = ty_argument_int(job->arguments, "most-cells", 1, MOST_CELLS, &most);
    }
    if (status != TY_OK)
    {
        return status;
    }
    if (def.argument_count == 0)
    {
        return ty_usage(job->arguments->command, "what varies? give --vary NAME=VALUES");
    }
    ty_error_list errors = {0};
    def.most_cells = (int)most;
    status = ty_sweep_parse(&def, &job->sweep, &errors);
    ty_errors_log(&errors);
    return status == TY_OK ? check_options(job) : status;
}

static ty_status read_reference(ty_sweep_job* job)
{
    const char* text = ty_argument_text(job->arguments, "reference", NULL);
    for (int i = 0; text && i < job->sweep.cell_count; i++)
    {
        if (strcmp(job->cells[i].name, text) == 0)
        {
            job->reference = i;
            return TY_OK;
        }
    }
    return text ? ty_usage(job->arguments->command, "--reference: no cell is called '%s'; the first is '%s'", text,
                           job->cells[0].name)
                : TY_OK;
}

static void name_cells(ty_sweep_job* job)
{
    job->cells = TY_ALLOC(ty_sweep_cell, job->sweep.cell_count);
    for (int i = 0; i < job->sweep.cell_count; i++)
    {
        ty_sweep_cell* cell = &job->cells[i];
        ty_sweep_name(&job->sweep, i, cell->name);
        cell->output = ty_string_format("%s/%s.exr", job->folder, cell->name);
        cell->command = ty_sweep_command(job, i, cell->output);
        cell->seconds = -1.0;
    }
}

// What can be wrong without looking at the scene.
static ty_status prepare(ty_sweep_job* job)
{
    const ty_arguments* arguments = job->arguments;
    job->folder = ty_argument_text(arguments, "output", NULL);
    if (!job->folder || !job->folder[0])
    {
        return ty_usage(arguments->command, "where to? give -o FOLDER");
    }
    if (strlen(job->folder) > TY_PATH_MAX - 2 * TY_SWEEP_NAME_MAX)
    {
        return ty_usage(arguments->command, "the name of the folder is too long");
    }
    ty_status status = read_axes(job);
    status = status == TY_OK ? ty_render_progress(arguments) : status;
    status = status == TY_OK ? ty_develop_options(arguments, &job->render.develop) : status;
    status = status == TY_OK ? ty_develop_check(&job->render.develop) : status; // the sheet at least
    status = status == TY_OK ? ty_scene_arguments_read(arguments, &job->base) : status;
    if (status == TY_OK)
    {
        job->fixed_sets = job->base.options.set_count;
        status = ty_render_overrides(arguments, &job->base);
    }
    if (status != TY_OK)
    {
        return status;
    }
    job->render.arguments = arguments;
    job->render.lists = true;
    job->render.develops = ty_argument_has(arguments, "develop");
    name_cells(job);
    return read_reference(job);
}

// The folder is there and takes every picture, before an hour of rendering.
static ty_status probe_outputs(const ty_sweep_job* job)
{
    ty_error error;
    ty_status status = ty_folder_create(job->folder, &error);
    for (int i = 0; i < job->sweep.cell_count && status == TY_OK; i++)
    {
        status = ty_output_probe(job->cells[i].output, &error);
    }
    if (status != TY_OK)
    {
        ty_log_error(&error);
    }
    return status;
}

static ty_status print_plan(const ty_sweep_job* job)
{
    int found = 0;
    for (int i = 0; i < job->sweep.cell_count; i++)
    {
        found += job->cells[i].found;
        printf("%s\n", job->cells[i].command);
    }
    ty_log(TY_LOG_INFO, "%d cells, %d of them up to date", job->sweep.cell_count, found);
    return ty_output_finish();
}

// The first failure among the cells decides the status of all.
static ty_status judge(const ty_sweep_job* job)
{
    int done = 0, failed = 0;
    ty_status status = TY_OK;
    for (int i = 0; i < job->sweep.cell_count; i++)
    {
        const ty_sweep_cell* cell = &job->cells[i];
        done += cell->done;
        failed += cell->status != TY_OK;
        status = status == TY_OK ? cell->status : status;
    }
    ty_log(failed ? TY_LOG_WARNING : TY_LOG_INFO, "%d of %d cells are complete%s", done, job->sweep.cell_count,
           done < job->sweep.cell_count ? "; the same command goes on from there" : "");
    return status;
}

static ty_status write_overview(const ty_sweep_job* job)
{
    ty_error error;
    char* paths[3];
    static const char* const names[] = {"sheet.exr", "sheet.png", "index.html"};
    for (int i = 0; i < 3; i++)
    {
        paths[i] = ty_string_format("%s/%s", job->folder, names[i]);
    }
    ty_status status = ty_sweep_sheet(job, paths[0], paths[1], &error);
    status = status == TY_OK ? ty_sweep_report(job, paths[2], &error) : status;
    if (status != TY_OK)
    {
        ty_log_error(&error);
    }
    else
    {
        printf("%s\n%s\n%s\n", paths[0], paths[1], paths[2]);
        status = ty_output_finish();
    }
    for (int i = 0; i < 3; i++)
    {
        ty_free(paths[i]);
    }
    return status;
}

static ty_status run_cells(ty_sweep_job* job)
{
    ty_status status = ty_sweep_check(job);
    if (status != TY_OK || ty_argument_has(job->arguments, "dry-run"))
    {
        return status == TY_OK ? print_plan(job) : status;
    }
    status = probe_outputs(job);
    if (status != TY_OK)
    {
        return status;
    }
    ty_status rendered = ty_sweep_render(job);
    status = ty_sweep_record_write(job);
    status = status == TY_OK && rendered == TY_OK ? write_overview(job) : status;
    ty_status judged = judge(job);
    return rendered != TY_OK ? rendered : status != TY_OK ? status : judged;
}

static ty_status run(const ty_arguments* arguments)
{
    static ty_sweep_job job; // paths: too large for the stack
    job = (ty_sweep_job){.arguments = arguments};
    ty_status status = prepare(&job);
    status = status == TY_OK ? run_cells(&job) : status;
    for (int i = 0; job.cells && i < job.sweep.cell_count; i++)
    {
        ty_free(job.cells[i].output);
        ty_free(job.cells[i].command);
    }
    ty_free(job.cells);
    json_decref(job.record);
    ty_scene_arguments_term(&job.base);
    ty_sweep_term(&job.sweep);
    return status;
}

static const ty_option options[] = {
    {"vary", 'v', "NAME=VALUES",
     "a path as in --set, or a variable as in -D: a,b,c | FROM:TO:COUNT[:log] (repeatable)"},
    {"zip", 0, NULL, "first values together, then second ones ..., instead of every combination"},
    {"output", 'o', "FOLDER", "pictures, sheet.exr and .png, the report index.html, sweep.json"},
    {"most-cells", 0, "N", "refuse more (default 400)"},
    {"reference", 0, "CELL", "the cell that the others are measured against (default: the first)"},
    {"develop", 0, NULL, "also a PNG of every cell"},
    {"display", 0, "D", "display of the OCIO configuration (default: sRGB)"},
    {"view", 0, "V", "view (default: ACES 1.0 SDR)"},
    {"exposure", 'e', "EV", "of PNGs and sheet: stops, before the view"},
    {"bits", 0, "8|16", "of PNGs: bits a channel (default 8)"},
    TY_SCENE_OPTIONS,
    TY_PICTURE_OPTIONS,
    {"progress", 0, "M", "auto, bar, lines, none"},
    {"dry-run", 0, NULL, "check every cell, print the commands, render nothing"},
};

const ty_command ty_command_sweep = {
    "sweep",
    "SCENE --vary NAME=VALUES... -o FOLDER [options]",
    "render a scene over values of its parameters",
    "tsuya sweep scenes/rice_bowl --vary moisture=0.15:0.75:4 --vary camera.vfov=13,20 -o out/wet --quick\n"
    "         tsuya sweep SCENE --vary materials.rice.mean_free_path=0.05:0.8:5:log -o out/path   # equal ratios\n"
    "         tsuya sweep SCENE --vary 'materials.rice.color=[0.8, 0.8, 0.7],[0.5, 0.4, 0.2]' -o out/color\n"
    "         tsuya sweep SCENE --zip --vary camera.vfov=13,26 --vary camera.f_stop=8,4 -o out/lens   # two cells",
    1,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
