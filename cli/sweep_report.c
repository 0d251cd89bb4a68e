// SPDX-License-Identifier: Apache-2.0
// The HTML report of a sweep: its pictures, commands and measures.
#include "page.h"
#include "sweep_view.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/memory.h>

// Pixels that are compared with every cell as reference; beyond it only with the sweep's own.
#define MOST_COMPARED 40e6

typedef struct reporting
{
    const ty_sweep_job* job;
    ty_page page;
    ty_image* linear; // [cell_count], NULL pixels = no picture, or not finite
    ty_image* shown;  // the same, developed
    ty_error* error;
} reporting;

// --- measures ---

static bool same_size(const ty_image* a, const ty_image* b)
{
    return a->pixels && b->pixels && a->width == b->width && a->height == b->height;
}

static ty_status measure(reporting* r, int reference, int test, double* flip)
{
    const ty_image *a = &r->linear[reference], *b = &r->linear[test];
    ty_pixel_errors errors = {0};
    ty_status status = ty_pixel_errors_measure(a, b, NULL, 0.0, &errors, r->error);
    if (status == TY_OK && isnan(*flip)) // the same both ways
    {
        int64_t count = (int64_t)a->width * a->height;
        float* map = TY_TRY_ALLOC(float, count);
        status = map ? ty_flip_ldr(&r->shown[reference], &r->shown[test], true, TY_FLIP_PPD,
                                   r->job->base.options.workers, map, r->error)
                     : ty_error_set(r->error, TY_NO_MEMORY, "not enough memory to compare");
        *flip = status == TY_OK ? ty_map_mean(map, NULL, count) : *flip;
        ty_free(map);
    }
    if (status == TY_OK)
    {
        errors.value[TY_METRIC_FLIP] = *flip;
        errors.value[TY_METRIC_HDRFLIP] = (double)NAN;
        ty_page_add_pair(&r->page, reference, test, errors.value, 0);
    }
    return status;
}

static ty_status measure_all(reporting* r)
{
    int count = r->job->sweep.cell_count;
    double pixels = 0.0;
    for (int i = 0; i < count; i++)
    {
        pixels += (double)r->linear[i].width * r->linear[i].height * (r->linear[i].pixels ? 1 : 0);
    }
    bool all = 0.5 * pixels * count <= MOST_COMPARED;
    ty_status status = TY_OK;
    for (int a = 0; a < count && status == TY_OK; a++)
    {
        for (int b = a + 1; b < count && status == TY_OK; b++)
        {
            bool wanted = all || a == r->job->reference || b == r->job->reference;
            double flip = (double)NAN;
            if (wanted && same_size(&r->linear[a], &r->linear[b]))
            {
                status = measure(r, a, b, &flip);
                status = status == TY_OK ? measure(r, b, a, &flip) : status;
            }
        }
    }
    return status;
}

// --- pictures ---

static ty_status develop(reporting* r)
{
    const ty_develop_def* def = &r->job->render.develop;
    const char* source;
    ty_color* color = NULL;
    ty_status status = ty_color_create(ty_color_choose(def->ocio, NULL, &source), &color, r->error);
    for (int i = 0; i < r->job->sweep.cell_count && status == TY_OK; i++)
    {
        const ty_image* from = &r->linear[i];
        if (from->pixels)
        {
            status = ty_image_shrink(from, from->width, from->height, &r->shown[i], r->error); // a copy
            status = status == TY_OK ? ty_color_develop(color, def->display, def->view, def->exposure,
                                                        r->shown[i].pixels, from->width * from->height, 3, r->error)
                                     : status;
        }
    }
    ty_color_destroy(color);
    return status;
}

static ty_status add_pictures(reporting* r, int indices[])
{
    int64_t pixels = 0;
    int longest = 1;
    for (int i = 0; i < r->job->sweep.cell_count; i++)
    {
        const int* size = r->job->cells[i].size;
        pixels += r->job->cells[i].done ? (int64_t)size[0] * size[1] : 0;
        longest = size[0] > longest ? size[0] : size[1] > longest ? size[1] : longest;
    }
    int factor = ty_page_factor(pixels, longest);
    ty_status status = TY_OK;
    for (int i = 0; i < r->job->sweep.cell_count && status == TY_OK; i++)
    {
        indices[i] = -1;
        if (!r->job->cells[i].done)
        {
            continue;
        }
        status = ty_sweep_picture(r->job, i, &r->linear[i], r->error);
        status = status == TY_OK ? ty_page_add(&r->page, &r->linear[i], TY_PAGE_VIEW, factor, r->job->cells[i].corner,
                                               &indices[i], r->error)
                                 : status;
        if (status == TY_OK && ty_image_find_non_finite(&r->linear[i]).count)
        {
            ty_image_term(&r->linear[i]); // nothing to measure
        }
    }
    json_object_set_new(r->page.data, "metricHint",
                        json_sprintf("Of the whole pictures, scene-linear; FLIP as the view shows them.%s",
                                     factor > 1 ? " Pictures of this page are smaller: see above." : ""));
    json_object_set_new(r->page.data, "factor", json_integer(factor));
    return status;
}

// --- words ---

static json_t* text_of_labels(const ty_sweep_job* job, const ty_sweep_layout* layout, bool rows)
{
    json_t* labels = json_array();
    for (int i = 0; i < (rows ? layout->rows : layout->columns); i++)
    {
        char text[TY_SWEEP_LABEL_MAX];
        (rows ? ty_sweep_row_label : ty_sweep_column_label)(job, layout, i, text);
        json_array_append_new(labels, json_string(text));
    }
    return labels;
}

static json_t* layout_json(const ty_sweep_job* job)
{
    ty_sweep_layout layout = ty_sweep_layout_of(&job->sweep);
    char rows[TY_SWEEP_LABEL_MAX], columns[TY_SWEEP_LABEL_MAX];
    ty_sweep_row_title(job, &layout, rows);
    ty_sweep_column_title(job, &layout, columns);
    return json_pack("{s:i, s:i, s:b, s:s, s:s, s:o, s:o}", "rows", layout.rows, "columns", layout.columns, "grid",
                     layout.grid, "rowTitle", rows, "columnTitle", columns, "rowLabels",
                     text_of_labels(job, &layout, true), "columnLabels", text_of_labels(job, &layout, false));
}

static json_t* cell_json(const ty_sweep_job* job, int index, int picture)
{
    const ty_sweep_cell* cell = &job->cells[index];
    char label[TY_SWEEP_LABEL_MAX];
    json_t *root = json_object(), *values = json_array();
    ty_sweep_cell_label(job, index, label);
    for (int a = 0; a < job->sweep.axis_count; a++)
    {
        json_array_append_new(values, json_string(ty_sweep_value_at(&job->sweep, index, a)->text));
    }
    json_object_set_new(root, "label", json_string(label));
    json_object_set_new(root, "values", values);
    json_object_set_new(root, "picture", picture >= 0 ? json_integer(picture) : json_null());
    json_object_set_new(root, "command", json_string(cell->command));
    json_object_set_new(root, "fault", cell->fault[0] ? json_string(cell->fault) : json_null());
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
        json_array_append_new(axes, json_string(job->sweep.axes[a].name));
    }
    for (int i = 0; i < job->sweep.cell_count; i++)
    {
        done += job->cells[i].done;
        seconds += job->cells[i].seconds > 0.0 ? job->cells[i].seconds : 0.0;
    }
    const int* size = job->cells[job->reference].size;
    int factor = (int)json_integer_value(json_object_get(r->page.data, "factor"));
    char share[64] = "", fixed[TY_SWEEP_LABEL_MAX];
    ty_sweep_fixed(job, fixed);
    if (factor > 1)
    {
        snprintf(share, sizeof share, ", here at 1/%d of their width", factor);
    }
    json_object_set_new(r->page.data, "facts",
                        json_sprintf("%d of %d cells, %d × %d pixels%s, rendered in %.1f s%s%s", done,
                                     job->sweep.cell_count, size[0], size[1], share, seconds,
                                     fixed[0] ? "; in all of them " : "", fixed));
    json_object_set_new(r->page.data, "hint",
                        json_string("Click: as B. Shift and click, or r: as A. Arrow keys go from cell to cell."));
    json_object_set_new(r->page.data, "footer", json_sprintf("tsuya %s · %s", TSUYA_VERSION, r->page.title));
    json_array_append_new(first, json_integer(job->reference));
    json_array_append_new(first,
                          json_integer(job->reference == job->sweep.cell_count - 1 ? 0 : job->sweep.cell_count - 1));
    json_object_set_new(r->page.data, "first", first);
    json_object_set_new(r->page.data, "axes", axes);
    json_object_set_new(r->page.data, "layout", layout_json(job));
}

static ty_status fill(reporting* r)
{
    int count = r->job->sweep.cell_count;
    int* indices = TY_ALLOC(int, count);
    json_t* cells = json_array();
    ty_status status = add_pictures(r, indices);
    for (int i = 0; i < count; i++)
    {
        json_array_append_new(cells, cell_json(r->job, i, indices[i]));
    }
    json_object_set_new(r->page.data, "cells", cells);
    ty_free(indices);
    describe(r);
    status = status == TY_OK ? develop(r) : status;
    return status == TY_OK ? measure_all(r) : status;
}

ty_status ty_sweep_report(const ty_sweep_job* job, const char* path, ty_error* error)
{
    int count = job->sweep.cell_count;
    reporting r = {.job = job, .error = error};
    r.linear = TY_ALLOC(ty_image, count);
    r.shown = TY_ALLOC(ty_image, count);
    static const bool metrics[TY_METRIC_COUNT] = {[TY_METRIC_RMSE] = true,
                                                  [TY_METRIC_RELMSE] = true,
                                                  [TY_METRIC_MAE] = true,
                                                  [TY_METRIC_PSNR] = true,
                                                  [TY_METRIC_FLIP] = true};
    ty_page_begin(&r.page, "sweep", job->arguments->positional[0], &job->render.develop, metrics);
    ty_status status = fill(&r);
    status = status == TY_OK ? ty_page_write(&r.page, path, error) : status;
    for (int i = 0; i < count; i++)
    {
        ty_image_term(&r.linear[i]);
        ty_image_term(&r.shown[i]);
    }
    ty_free(r.linear);
    ty_free(r.shown);
    ty_page_term(&r.page);
    return status;
}
