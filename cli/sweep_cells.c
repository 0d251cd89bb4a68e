// SPDX-License-Identifier: Apache-2.0
// Cells of a sweep: checked all together, then rendered one by one, each as `tsuya render` would.
#include "sweep.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

// --- what a cell is ---

void ty_sweep_set_cell(ty_sweep_job* job, int cell)
{
    ty_scene_arguments* out = &job->scene;
    const ty_scene_options* base = &job->base.options;
    out->options = *base;
    out->options.sets = out->sets;
    out->options.variables = out->variables;
    memcpy(out->sets, job->base.sets, (size_t)job->fixed_sets * sizeof *out->sets);
    memcpy(out->variables, job->base.variables, (size_t)base->variable_count * sizeof *out->variables);
    int sets = job->fixed_sets, variables = base->variable_count;
    for (int a = 0; a < job->sweep.axis_count; a++)
    {
        const char* override = ty_sweep_value_at(&job->sweep, cell, a)->override;
        if (job->sweep.axes[a].is_variable)
        {
            out->variables[variables++] = override;
        }
        else
        {
            out->sets[sets++] = override;
        }
    }
    for (int i = job->fixed_sets; i < base->set_count; i++)
    {
        out->sets[sets++] = job->base.sets[i];
    }
    out->options.set_count = sets;
    out->options.variable_count = variables;
    const ty_sweep_cell* it = &job->cells[cell];
    snprintf(job->render.output, sizeof job->render.output, "%s", it->output);
    job->render.preview[0] = '\0';
    if (job->render.develops)
    {
        snprintf(job->render.preview, sizeof job->render.preview, "%s/%s.png", job->folder, it->name);
    }
}

// --- its command ---

typedef struct words
{
    char* text;
    size_t size, capacity;
} words;

static void add_char(words* w, char c)
{
    if (w->size + 2 > w->capacity)
    {
        size_t capacity = w->capacity ? 2 * w->capacity : 256;
        w->text = ty_grow(w->text, w->capacity, capacity, 1);
        w->capacity = capacity;
    }
    w->text[w->size++] = c;
    w->text[w->size] = '\0';
}

// A word of a POSIX shell, after a blank; quoted where it has to be.
static void add_word(words* w, const char* word)
{
    bool plain = word[0] != '\0';
    for (const char* c = word; *c; c++)
    {
        plain &= isalnum((unsigned char)*c) || strchr("_./=,:+-@%", *c);
    }
    add_char(w, ' ');
    if (!plain)
    {
        add_char(w, '\'');
    }
    for (const char* c = word; *c; c++)
    {
        for (const char* part = *c == '\'' ? "'\\''" : (char[]){*c, '\0'}; *part; part++)
        {
            add_char(w, *part);
        }
    }
    if (!plain)
    {
        add_char(w, '\'');
    }
}

static void add_words(words* w, const char* option, const char* value)
{
    add_word(w, option);
    if (value)
    {
        add_word(w, value);
    }
}

// Options that `render` understands as well and that can change a bit of the picture, or what may be read.
static void add_given(words* w, const ty_given* given)
{
    static const char* const kept[] = {"ocio", "cache", "sandbox", "quick",      "spp",        "samples", "size",
                                       "crop", "seed",  "aov",     "integrator", "time-limit", "trace",   "isa"};
    char flag[64];
    snprintf(flag, sizeof flag, "--%s", given->option->name);
    for (int i = 0; i < TY_PARAM_COUNT(kept); i++)
    {
        if (strcmp(given->option->name, kept[i]) == 0)
        {
            add_words(w, flag, given->option->value ? given->text : NULL);
        }
    }
}

char* ty_sweep_command(const ty_sweep_job* job, int cell, const char* output)
{
    words w = {0};
    for (const char* c = "tsuya render"; *c; c++)
    {
        add_char(&w, *c);
    }
    if (job->arguments->positional[0][0] == '-')
    {
        add_word(&w, "--");
    }
    add_word(&w, job->arguments->positional[0]);
    for (int i = 0; i < job->base.options.variable_count; i++)
    {
        add_words(&w, "-D", job->base.variables[i]);
    }
    for (int i = 0; i < job->fixed_sets; i++)
    {
        add_words(&w, "--set", job->base.sets[i]);
    }
    for (int a = 0; a < job->sweep.axis_count; a++)
    {
        add_words(&w, job->sweep.axes[a].is_variable ? "-D" : "--set",
                  ty_sweep_value_at(&job->sweep, cell, a)->override);
    }
    for (int i = 0; i < job->arguments->given_count; i++)
    {
        add_given(&w, &job->arguments->given[i]);
    }
    if (output)
    {
        add_words(&w, "-o", output);
    }
    return w.text;
}

// --- checks ---

static bool is_told(const ty_error_list* told, const ty_error* error)
{
    for (int i = 0; i < told->count; i++)
    {
        const ty_error* other = &told->items[i];
        if (other->line == error->line && other->column == error->column && strcmp(other->file, error->file) == 0 &&
            strcmp(other->text, error->text) == 0)
        {
            return true;
        }
    }
    return false;
}

// Mistakes of a cell that no cell before had.
static void gather(const ty_sweep_job* job, int cell, ty_error_list* found, ty_error_list* told)
{
    for (int i = 0; i < found->count; i++)
    {
        (void)ty_sweep_place_error(&job->sweep, cell, &found->items[i]);
        if (!is_told(told, &found->items[i]))
        {
            ty_error_list_add(told, &found->items[i]);
        }
    }
    ty_error_list_term(found);
}

// Also whether its picture is there: the hash is known without making an asset.
static ty_status check_cell(ty_sweep_job* job, int index, ty_error_list* told)
{
    ty_sweep_cell* cell = &job->cells[index];
    ty_error_list found = {0};
    ty_scene* scene = NULL;
    ty_sweep_set_cell(job, index);
    job->scene.options.check_only = true;
    job->render.preview[0] = '\0';
    ty_status status = ty_scene_load(job->arguments->positional[0], &job->scene.options, &scene, &found);
    gather(job, index, &found, told);
    if (status == TY_OK)
    {
        ty_error error;
        memcpy(cell->hash, scene->hash, sizeof cell->hash);
        status = ty_render_plan(&job->render, scene);
        const int* window = job->render.setup.crop;
        cell->corner[0] = window[0];
        cell->corner[1] = window[1];
        cell->size[0] = window[2] - window[0] + 1;
        cell->size[1] = window[3] - window[1] + 1;
        status = status == TY_OK ? ty_render_find(&job->render, scene, &cell->found, &error) : status;
    }
    ty_scene_destroy(scene);
    return status;
}

ty_status ty_sweep_check(ty_sweep_job* job)
{
    ty_error_list told = {0};
    ty_status first = TY_OK;
    ty_log_level level = ty_log_get_level();
    ty_log_set_level(TY_LOG_ERROR); // warnings come when the cell is rendered
    for (int i = 0; i < job->sweep.cell_count; i++)
    {
        ty_status status = ty_cancel_requested() ? TY_INTERRUPTED : check_cell(job, i, &told);
        first = first == TY_OK ? status : first;
        if (status == TY_USAGE || status == TY_INTERRUPTED) // the same for every cell
        {
            break;
        }
    }
    ty_log_set_level(level);
    ty_errors_log(&told);
    return first;
}

// --- rendering ---

static void fail(ty_sweep_cell* cell, ty_status status, const ty_error* error)
{
    cell->status = status;
    if (error->text[0])
    {
        ty_error_format(error, cell->fault, sizeof cell->fault);
    }
}

static ty_status load_cell(ty_sweep_job* job, int index, ty_scene** scene)
{
    ty_error_list found = {0}, told = {0};
    ty_status status = ty_scene_load(job->arguments->positional[0], &job->scene.options, scene, &found);
    gather(job, index, &found, &told);
    if (status != TY_OK)
    {
        fail(&job->cells[index], status, told.count ? &told.items[0] : &(ty_error){0});
    }
    ty_errors_log(&told);
    return status;
}

// Seconds of the last frame that was rendered.
static double take_seconds(ty_sweep_job* job)
{
    size_t count = json_array_size(job->render.results);
    json_t* stats = count ? json_array_get(job->render.results, count - 1) : NULL;
    double seconds = stats ? json_number_value(json_object_get(stats, "render_seconds")) : -1.0;
    json_array_clear(job->render.results);
    return seconds;
}

static ty_status render_cell(ty_sweep_job* job, int index)
{
    ty_sweep_cell* cell = &job->cells[index];
    ty_scene* scene = NULL;
    ty_error error = {0};
    ty_sweep_set_cell(job, index);
    job->scene.options.check_only = false;
    ty_status status = load_cell(job, index, &scene);
    if (status == TY_OK)
    {
        char* repeat = ty_sweep_command(job, index, NULL);
        job->render.repeat = repeat;
        status = ty_render_plan(&job->render, scene);
        status = status == TY_OK ? ty_render_frame(&job->render, scene, job->base.options.workers, &error) : status;
        memcpy(cell->hash, scene->hash, sizeof cell->hash);
        cell->done = status == TY_OK || status == TY_NON_FINITE;
        cell->seconds = take_seconds(job);
        job->render.repeat = NULL;
        ty_free(repeat);
        if (status != TY_OK)
        {
            fail(cell, status, &error);
        }
    }
    ty_scene_destroy(scene);
    if (error.text[0])
    {
        ty_log_error(&error);
    }
    return status;
}

// A PNG does not tell how it was developed: it is made again.
static ty_status develop_cell(ty_sweep_job* job, int index)
{
    ty_sweep_cell* cell = &job->cells[index];
    ty_exr* exr = NULL;
    ty_error error = {0};
    ty_sweep_set_cell(job, index);
    if (!job->render.develops)
    {
        return TY_OK;
    }
    ty_status status = ty_exr_read(cell->output, &exr, &error);
    status = status == TY_OK ? ty_develop(exr, &job->render.develop, job->render.preview, &error) : status;
    ty_exr_destroy(exr);
    if (status != TY_OK)
    {
        fail(cell, status, &error);
        ty_log_error(&error);
    }
    return status;
}

static void tell(const ty_sweep_job* job, int index, int rendered, int left, double start)
{
    const ty_sweep_cell* cell = &job->cells[index];
    double seconds = ty_time_now() - start;
    const char* what = cell->status != TY_OK ? "failed" : cell->found ? "up to date" : "done";
    ty_log(TY_LOG_INFO, "cell %d of %d, %s: %s; %.1f s so far, about %.0f s to go", index + 1, job->sweep.cell_count,
           cell->name, what, seconds, rendered ? seconds / rendered * left : 0.0);
}

// What is there counts from the beginning: a stop ahead of it does not lose it. Returns how many are not.
static int take_found(ty_sweep_job* job)
{
    int missing = 0;
    ty_sweep_record_read(job);
    for (int i = 0; i < job->sweep.cell_count; i++)
    {
        ty_sweep_cell* cell = &job->cells[i];
        missing += !cell->found;
        cell->done = cell->found;
        cell->seconds = cell->found ? ty_sweep_record_seconds(job, cell) : cell->seconds;
    }
    return missing;
}

ty_status ty_sweep_render(ty_sweep_job* job)
{
    double start = ty_time_now();
    int left = take_found(job), rendered = 0;
    job->render.results = json_array();
    ty_status status = TY_OK;
    for (int i = 0; i < job->sweep.cell_count; i++)
    {
        bool found = job->cells[i].found;
        status = ty_cancel_requested() ? TY_INTERRUPTED : found ? develop_cell(job, i) : render_cell(job, i);
        rendered += !found;
        left -= !found;
        if (status == TY_INTERRUPTED || status == TY_TERMINATED)
        {
            break;
        }
        status = TY_OK; // the cell's own is kept with it
        tell(job, i, rendered, left, start);
    }
    json_decref(job->render.results);
    job->render.results = NULL;
    return status;
}
