// SPDX-License-Identifier: Apache-2.0
// The HTML report of a sweep: its pictures, commands and measures.
#include "page.h"
#include "sweep_view.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/memory.h>

// Pixels that are compared with every cell as reference; beyond it only with the sweep's own.
#define MOST_COMPARED 20e6

// A cell's picture, scene-linear and developed; no pixels where there is none or values are not finite.
typedef struct measured_cell
{
    ty_image linear, shown;
} measured_cell;

typedef struct reporting
{
    const ty_sweep_job* job;
    ty_page page;
    ty_color* color;
    int factor;           // of the page's pictures
    bool all;             // every cell is measured against every other; else only against the reference
    measured_cell* cells; // [cell_count]
    int* pictures;        // [cell_count], of the page, -1 = none
    ty_error* error;
} reporting;

// --- measures ---

static void free_cell(measured_cell* cell)
{
    ty_image_term(&cell->linear);
    ty_image_term(&cell->shown);
}

static bool same_size(const ty_image* a, const ty_image* b)
{
    return a->pixels && b->pixels && a->width == b->width && a->height == b->height;
}

static ty_status add_measures(reporting* r, int reference, int test, double flip)
{
    ty_pixel_errors errors = {0};
    ty_status status =
        ty_pixel_errors_measure(&r->cells[reference].linear, &r->cells[test].linear, NULL, 0.0, &errors, r->error);
    if (status == TY_OK)
    {
        errors.value[TY_METRIC_FLIP] = flip;
        errors.value[TY_METRIC_HDRFLIP] = (double)NAN;
        ty_page_add_pair(&r->page, reference, test, errors.value, 0);
    }
    return status;
}

// Both ways; FLIP is the same.
static ty_status measure(reporting* r, int one, int other)
{
    const ty_image *a = &r->cells[one].shown, *b = &r->cells[other].shown;
    if (!same_size(a, b))
    {
        return TY_OK;
    }
    int64_t count = (int64_t)a->width * a->height;
    float* map = TY_TRY_ALLOC(float, count);
    ty_status status = map ? ty_flip_ldr(a, b, true, TY_FLIP_PPD, r->job->base.options.workers, map, r->error)
                           : ty_error_set(r->error, TY_NO_MEMORY, "not enough memory to compare");
    double flip = status == TY_OK ? ty_map_mean(map, NULL, count) : 0.0;
    ty_free(map);
    status = status == TY_OK ? add_measures(r, one, other, flip) : status;
    return status == TY_OK ? add_measures(r, other, one, flip) : status;
}

// --- pictures ---

static ty_status develop(reporting* r, measured_cell* cell)
{
    const ty_develop_def* def = &r->job->render.develop;
    int width = cell->linear.width, height = cell->linear.height;
    ty_status status = ty_image_shrink(&cell->linear, width, height, &cell->shown, r->error); // a copy
    return status == TY_OK ? ty_color_develop(r->color, def->display, def->view, def->exposure, cell->shown.pixels,
                                              width * height, 3, r->error)
                           : status;
}

// Reads a cell for its measures and puts it on the page.
static ty_status add_picture(reporting* r, int index)
{
    const ty_sweep_cell* cell = &r->job->cells[index];
    measured_cell* measured = &r->cells[index];
    ty_status status = ty_sweep_picture(r->job, index, &measured->linear, r->error);
    status = status == TY_OK ? ty_page_add(&r->page, &measured->linear, TY_PAGE_VIEW, r->factor, cell->corner,
                                           &r->pictures[index], r->error)
                             : status;
    if (status == TY_OK && ty_image_find_non_finite(&measured->linear).count)
    {
        free_cell(measured); // nothing to measure
        return TY_OK;
    }
    return status == TY_OK ? develop(r, measured) : status;
}

static ty_status add_cells(reporting* r)
{
    int count = r->job->sweep.cell_count, reference = r->job->reference;
    ty_status status = r->job->cells[reference].done ? add_picture(r, reference) : TY_OK;
    for (int i = 0; i < count && status == TY_OK; i++)
    {
        if (i == reference || !r->job->cells[i].done)
        {
            continue;
        }
        status = add_picture(r, i);
        status = status == TY_OK ? measure(r, reference, i) : status;
        if (!r->all)
        {
            free_cell(&r->cells[i]);
        }
    }
    for (int a = 0; a < count && r->all; a++)
    {
        for (int b = a + 1; b < count && status == TY_OK; b++)
        {
            status = a != reference && b != reference ? measure(r, a, b) : TY_OK;
        }
    }
    return status;
}

static void plan(reporting* r)
{
    int64_t pixels = 0;
    int longest = 1, done = 0;
    for (int i = 0; i < r->job->sweep.cell_count; i++)
    {
        const int* size = r->job->cells[i].size;
        pixels += r->job->cells[i].done ? (int64_t)size[0] * size[1] : 0;
        done += r->job->cells[i].done;
        longest = size[0] > longest ? size[0] : longest;
        longest = size[1] > longest ? size[1] : longest;
        r->pictures[i] = -1;
    }
    r->factor = ty_page_factor(pixels, longest);
    r->all = 0.5 * (double)pixels * done <= MOST_COMPARED;
}

// --- words ---

static json_t* text_of_labels(const ty_sweep_job* job, const ty_sweep_layout* layout, bool rows)
{
    json_t* labels = json_array();
    for (int i = 0; i < (rows ? layout->rows : layout->columns); i++)
    {
        char text[TY_SWEEP_LABEL_MAX];
        (rows ? ty_sweep_row_label : ty_sweep_column_label)(job, layout, i, text);
        json_array_append_new(labels, ty_json_from_text(text));
    }
    return labels;
}

static json_t* layout_json(const ty_sweep_job* job)
{
    ty_sweep_layout layout = ty_sweep_layout_of(&job->sweep);
    char rows[TY_SWEEP_LABEL_MAX], columns[TY_SWEEP_LABEL_MAX];
    ty_sweep_row_title(job, &layout, rows);
    ty_sweep_column_title(job, &layout, columns);
    return json_pack("{s:i, s:i, s:b, s:o, s:o, s:o, s:o}", "rows", layout.rows, "columns", layout.columns, "grid",
                     layout.grid, "rowTitle", ty_json_from_text(rows), "columnTitle", ty_json_from_text(columns),
                     "rowLabels", text_of_labels(job, &layout, true), "columnLabels",
                     text_of_labels(job, &layout, false));
}

static json_t* cell_json(const ty_sweep_job* job, int index, int picture)
{
    const ty_sweep_cell* cell = &job->cells[index];
    char label[TY_SWEEP_LABEL_MAX];
    json_t *root = json_object(), *values = json_array();
    ty_sweep_cell_label(job, index, label);
    for (int a = 0; a < job->sweep.axis_count; a++)
    {
        json_array_append_new(values, ty_json_from_text(ty_sweep_value_at(&job->sweep, index, a)->text));
    }
    json_object_set_new(root, "label", ty_json_from_text(label));
    json_object_set_new(root, "values", values);
    json_object_set_new(root, "picture", picture >= 0 ? json_integer(picture) : json_null());
    json_object_set_new(root, "command", ty_json_from_text(cell->command));
    json_object_set_new(root, "fault", cell->fault[0] ? ty_json_from_text(cell->fault) : json_null());
    json_object_set_new(root, "seconds", cell->seconds >= 0.0 ? json_real(cell->seconds) : json_null());
    return root;
}

static void describe(reporting* r)
{
    const ty_sweep_job* job = r->job;
    json_t *axes = json_array(), *first = json_array();
    int done = 0;
    double seconds = 0.0;
    for (int a = 0; a < job->sweep.axis_count; a++)
    {
        json_array_append_new(axes, ty_json_from_text(job->sweep.axes[a].name));
    }
    for (int i = 0; i < job->sweep.cell_count; i++)
    {
        done += job->cells[i].done;
        seconds += job->cells[i].seconds > 0.0 ? job->cells[i].seconds : 0.0;
    }
    const int* size = job->cells[job->reference].size;
    char share[64] = "", fixed[TY_SWEEP_LABEL_MAX];
    ty_sweep_fixed(job, fixed);
    if (r->factor > 1)
    {
        snprintf(share, sizeof share, ", here at 1/%d of their width", r->factor);
    }
    json_object_set_new(r->page.data, "facts",
                        ty_json_format("%d of %d cells, %d × %d pixels%s, rendered in %.1f s%s%s", done,
                                       job->sweep.cell_count, size[0], size[1], share, seconds,
                                       fixed[0] ? "; in all of them " : "", fixed));
    json_object_set_new(r->page.data, "hint",
                        json_string("Click: as B. Shift and click, or r: as A. Arrow keys go from cell to cell."));
    json_object_set_new(r->page.data, "metricHint",
                        json_sprintf("Of the whole pictures, scene-linear; FLIP as the view shows them.%s",
                                     r->all ? "" : " Measured against the first reference alone."));
    json_object_set_new(r->page.data, "footer", ty_json_format("tsuya %s · %s", TSUYA_VERSION, r->page.title));
    json_array_append_new(first, json_integer(job->reference));
    json_array_append_new(first,
                          json_integer(job->reference == job->sweep.cell_count - 1 ? 0 : job->sweep.cell_count - 1));
    json_object_set_new(r->page.data, "first", first);
    json_object_set_new(r->page.data, "axes", axes);
    json_object_set_new(r->page.data, "layout", layout_json(job));
}

static ty_status fill(reporting* r)
{
    const char* source;
    plan(r);
    ty_status status =
        ty_color_create(ty_color_choose(r->job->render.develop.ocio, NULL, &source), &r->color, r->error);
    status = status == TY_OK ? add_cells(r) : status;
    json_t* cells = json_array();
    for (int i = 0; i < r->job->sweep.cell_count; i++)
    {
        json_array_append_new(cells, cell_json(r->job, i, r->pictures[i]));
    }
    json_object_set_new(r->page.data, "cells", cells);
    describe(r);
    return status;
}

ty_status ty_sweep_report(const ty_sweep_job* job, const char* path, ty_error* error)
{
    static const bool metrics[TY_METRIC_COUNT] = {[TY_METRIC_RMSE] = true,
                                                  [TY_METRIC_RELMSE] = true,
                                                  [TY_METRIC_MAE] = true,
                                                  [TY_METRIC_PSNR] = true,
                                                  [TY_METRIC_FLIP] = true};
    reporting r = {.job = job, .error = error};
    r.cells = TY_ALLOC(measured_cell, job->sweep.cell_count);
    r.pictures = TY_ALLOC(int, job->sweep.cell_count);
    ty_page_begin(&r.page, "sweep", job->arguments->positional[0], &job->render.develop, metrics);
    ty_status status = fill(&r);
    status = status == TY_OK ? ty_page_write(&r.page, path, error) : status;
    for (int i = 0; i < job->sweep.cell_count; i++)
    {
        free_cell(&r.cells[i]);
    }
    ty_free(r.cells);
    ty_free(r.pictures);
    ty_color_destroy(r.color);
    ty_page_term(&r.page);
    return status;
}
