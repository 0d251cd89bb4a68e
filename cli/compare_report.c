// SPDX-License-Identifier: Apache-2.0
// `tsuya compare --html`: reference, test and error of every layer on the page that sweeps have, too.
#include "comparison.h"
#include "page.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum
{
    SIDES = 3 // reference, test, error
};

static const char* const side_names[SIDES] = {"reference", "test", "error"};

static ty_status add_layer(ty_page* page, const ty_comparison* comparison, const ty_compared_layer* layer, int factor,
                           int indices[SIDES], ty_error* error)
{
    ty_image heat;
    ty_status status = TY_OK;
    for (int s = 0; s < 2 && status == TY_OK; s++)
    {
        const ty_image* light = &layer->light[s];
        bool views = light->pixels != NULL, color = ty_layer_is_color(&layer->layer);
        status = ty_page_add(page, views ? light : &layer->shown[s],
                             views   ? TY_PAGE_VIEW
                             : color ? TY_PAGE_DISPLAY
                                     : TY_PAGE_FIXED,
                             factor, comparison->window, &indices[s], error);
    }
    if (status == TY_OK)
    {
        status = ty_comparison_heat(layer, &heat, error);
        status = status == TY_OK
                     ? ty_page_add(page, &heat, TY_PAGE_FIXED, factor, comparison->window, &indices[2], error)
                     : status;
        ty_image_term(&heat);
    }
    return status;
}

static json_t* cell_json(const ty_compared_layer* layer, int side, int picture, bool only)
{
    return json_pack("{s:o, s:[o], s:i}", "label",
                     only ? json_string(side_names[side])
                          : ty_json_format("%s, %s", layer->layer.name, side_names[side]),
                     "values", ty_json_from_text(layer->layer.name), "picture", picture);
}

static ty_status add_layers(ty_page* page, const ty_report_entry* entry, ty_error* error)
{
    const ty_comparison* comparison = entry->comparison;
    json_t *cells = json_array(), *rows = json_array();
    const int* w = comparison->window;
    int width = w[2] - w[0] + 1, height = w[3] - w[1] + 1;
    int factor =
        ty_page_factor((int64_t)width * height * SIDES * comparison->layer_count, width > height ? width : height);
    ty_status status = TY_OK;
    for (int i = 0; i < comparison->layer_count && status == TY_OK; i++)
    {
        const ty_compared_layer* layer = &comparison->layers[i];
        int indices[SIDES] = {0};
        status = add_layer(page, comparison, layer, factor, indices, error);
        for (int s = 0; s < SIDES; s++)
        {
            json_array_append_new(cells, cell_json(layer, s, indices[s], comparison->layer_count == 1));
        }
        json_array_append_new(rows, ty_json_from_text(layer->layer.name));
        ty_page_add_pair(page, SIDES * i, SIDES * i + 1, layer->value,
                         ty_limits_broken(entry->limits, entry->limit_count, layer));
    }
    json_object_set_new(page->data, "cells", cells);
    json_object_set_new(page->data, "layout",
                        json_pack("{s:i, s:i, s:b, s:s, s:s, s:o, s:[s, s, s]}", "rows", comparison->layer_count,
                                  "columns", SIDES, "grid", true, "rowTitle", "layer", "columnTitle", "", "rowLabels",
                                  rows, "columnLabels", side_names[0], side_names[1], side_names[2]));
    return status;
}

// Where each layer is farthest off, and the limits.
static json_t* hint_json(const ty_report_entry* entry)
{
    char text[4096] = "";
    size_t used = 0;
    for (int i = 0; i < entry->comparison->layer_count && used < sizeof text - 256; i++)
    {
        const ty_compared_layer* layer = &entry->comparison->layers[i];
        used += (size_t)snprintf(text + used, sizeof text - used, "%s: farthest apart at %d,%d: %.5g and %.5g. ",
                                 layer->layer.name, layer->worst.x, layer->worst.y, (double)layer->worst.reference,
                                 (double)layer->worst.test);
    }
    for (int i = 0; i < entry->limit_count && used < sizeof text - 256; i++)
    {
        const ty_limit* limit = &entry->limits[i];
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s at %s %g",
                                 i ? ", " : "Limits: ", ty_metric_name(limit->metric), limit->below ? "least" : "most",
                                 limit->bound);
    }
    return ty_json_from_text(text);
}

static const char* base_name(const char* path)
{
    const char* slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

ty_status ty_compare_report(const char* path, const ty_report_entry* entry, const ty_develop_def* view, ty_error* error)
{
    static const bool all[TY_METRIC_COUNT] = {true, true, true, true, true, true, true, true};
    ty_page page;
    char title[1024];
    snprintf(title, sizeof title, "%.500s against %.500s", base_name(entry->test), base_name(entry->reference));
    ty_page_begin(&page, "compare", title, view, all);
    json_object_set_new(page.data, "facts", ty_json_format("Reference %s, test %s.", entry->reference, entry->test));
    json_object_set_new(page.data, "verdict", json_string(entry->failed ? "differs" : "passed"));
    json_object_set_new(page.data, "failed", json_boolean(entry->failed));
    json_object_set_new(page.data, "fault", entry->fault ? ty_json_from_text(entry->fault) : json_null());
    json_object_set_new(page.data, "hint",
                        json_string("Click: as B. Shift and click, or r: as A. Exposure leaves errors and layers that "
                                    "are no colours as they are."));
    json_object_set_new(page.data, "metricHint", hint_json(entry));
    json_object_set_new(page.data, "footer", json_sprintf("tsuya %s", TSUYA_VERSION));
    json_object_set_new(page.data, "axes", json_pack("[s]", "layer"));
    json_object_set_new(page.data, "first", json_pack("[i, i]", 0, 1));
    ty_status status = add_layers(&page, entry, error);
    status = status == TY_OK ? ty_page_write(&page, path, error) : status;
    ty_page_term(&page);
    return status;
}
