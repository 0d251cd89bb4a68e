// SPDX-License-Identifier: Apache-2.0
// Reports: packed pictures, the view as a table, and JSON within the page of cli/page/.
#include "page.h"
#include "markup.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/pack.h>

// The view's table: so many points a side over log2 of light.
enum
{
    VIEW_SIZE = 49,
    VIEW_LOW = -12,
    VIEW_HIGH = 7,
};

enum
{
    MOST_SIDE = 1280,     // of a picture in the page
    MOST_PIXELS = 8000000 // of all of them: 48 MB before they are packed
};

extern const char ty_page_html[], ty_page_css[], ty_page_js[];

void ty_page_begin(ty_page* page, const char* kind, const char* title, const ty_develop_def* view,
                   const bool metrics[TY_METRIC_COUNT])
{
    static const char* const shown[TY_METRIC_COUNT] = {"RMSE",     "relMSE", "trimmed relMSE", "MAE",
                                                       "PSNR, dB", "max",    "FLIP",           "HDR-FLIP"};
    *page = (ty_page){.data = json_object(), .view = *view, .title = title};
    json_t *list = json_array(), *names = json_object();
    for (int m = 0; m < TY_METRIC_COUNT; m++)
    {
        if (metrics[m])
        {
            json_array_append_new(list, json_string(ty_metric_name((ty_metric)m)));
            json_object_set_new(names, ty_metric_name((ty_metric)m), json_string(shown[m]));
        }
    }
    json_object_set_new(page->data, "kind", json_string(kind));
    json_object_set_new(page->data, "metrics", list);
    json_object_set_new(page->data, "metricNames", names);
    json_object_set_new(page->data, "pictures", json_array());
    json_object_set_new(page->data, "pairs", json_array());
}

void ty_page_term(ty_page* page)
{
    for (int i = 0; i < page->picture_count; i++)
    {
        ty_bytes_term(&page->pictures[i]);
    }
    ty_free(page->pictures);
    json_decref(page->data);
    *page = (ty_page){0};
}

int ty_page_factor(int64_t pixels_of_all, int longest_side)
{
    int factor = 1;
    while (longest_side / factor > MOST_SIDE || pixels_of_all / ((int64_t)factor * factor) > MOST_PIXELS)
    {
        factor++;
    }
    return factor;
}

static void to_light(ty_image* image)
{
    for (int64_t i = 0; i < (int64_t)image->width * image->height * 3; i++)
    {
        double v = (double)image->pixels[i];
        image->pixels[i] = (float)(v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4));
    }
}

ty_status ty_page_add(ty_page* page, const ty_image* image, ty_page_kind kind, int factor, const int corner[2],
                      int* index, ty_error* error)
{
    static const char* const kinds[] = {"view", "display", "fixed"};
    TY_ASSERT(image->channels == 3);
    int width = image->width / factor, height = image->height / factor;
    ty_image small = {0};
    ty_status status = ty_image_shrink(image, width > 0 ? width : 1, height > 0 ? height : 1, &small, error);
    if (status == TY_OK && kind != TY_PAGE_VIEW)
    {
        to_light(&small);
    }
    page->pictures =
        ty_grow(page->pictures, (size_t)page->picture_count, (size_t)page->picture_count + 1, sizeof *page->pictures);
    status = status == TY_OK ? ty_pack_halves(&small, &page->pictures[page->picture_count], error) : status;
    if (status == TY_OK)
    {
        json_array_append_new(json_object_get(page->data, "pictures"),
                              json_pack("{s:i, s:i, s:[i, i], s:[i, i], s:i, s:s}", "width", small.width, "height",
                                        small.height, "full", image->width, image->height, "corner", corner[0],
                                        corner[1], "factor", factor, "kind", kinds[kind]));
        page->views |= kind == TY_PAGE_VIEW;
        *index = page->picture_count++;
    }
    ty_image_term(&small);
    return status;
}

void ty_page_add_pair(ty_page* page, int reference, int test, const double* values, unsigned broken)
{
    json_t *known = json_object(), *bad = json_array(), *pair = json_object();
    for (int m = 0; m < TY_METRIC_COUNT; m++)
    {
        const char* name = ty_metric_name((ty_metric)m);
        if (isfinite(values[m])) // JSON has neither NaN nor infinity
        {
            json_object_set_new(known, name, json_real(values[m]));
        }
        if (broken & 1u << m)
        {
            json_array_append_new(bad, json_string(name));
        }
    }
    json_object_set_new(pair, "reference", json_integer(reference));
    json_object_set_new(pair, "test", json_integer(test));
    json_object_set_new(pair, "values", known);
    json_object_set_new(pair, "broken", bad);
    json_array_append_new(json_object_get(page->data, "pairs"), pair);
}

// --- the file ---

// The view at every point of a cube of light, red changing fastest.
static ty_status pack_view(const ty_page* page, ty_bytes* out, ty_error* error)
{
    const int n = VIEW_SIZE, count = n * n * n;
    ty_image cube = {.width = n * n, .height = n, .channels = 3, .pixels = TY_ALLOC(float, 3 * count)};
    for (int i = 0; i < 3 * count; i++)
    {
        int at = i / 3 / (i % 3 == 0 ? 1 : i % 3 == 1 ? n : n * n) % n;
        cube.pixels[i] = (float)exp2(VIEW_LOW + (VIEW_HIGH - VIEW_LOW) * (double)at / (n - 1));
    }
    ty_status status = ty_develop_pixels(&page->view, cube.pixels, count, 3, error);
    status = status == TY_OK ? ty_pack_halves(&cube, out, error) : status;
    ty_image_term(&cube);
    return status;
}

static void put_packed(FILE* file, const char* id, const ty_bytes* bytes)
{
    fprintf(file, "<script type=\"text/plain\" id=\"%s\">", id);
    ty_markup_base64(file, bytes);
    fputs("</script>\n", file);
}

// JSON within a script element: no character there begins a tag.
static ty_status put_json(FILE* file, const json_t* value, ty_error* error)
{
    char* text = json_dumps(value, JSON_COMPACT | JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(9));
    if (!text)
    {
        return ty_error_set(error, TY_INTERNAL, "cannot format the report's data");
    }
    fputs("<script type=\"application/json\" id=\"data\">", file);
    for (const char* c = text; *c; c++)
    {
        if (*c == '<')
        {
            fputs("\\u003c", file);
        }
        else
        {
            fputc(*c, file);
        }
    }
    fputs("</script>\n", file);
    free(text); // jansson's own allocation
    return TY_OK;
}

static ty_status put_data(FILE* file, const ty_page* page, ty_error* error)
{
    ty_status status = TY_OK;
    if (page->views)
    {
        ty_bytes view = {0};
        status = pack_view(page, &view, error);
        if (status == TY_OK)
        {
            put_packed(file, "view", &view);
        }
        ty_bytes_term(&view);
        json_object_set_new(page->data, "view",
                            json_pack("{s:i, s:i, s:i}", "size", VIEW_SIZE, "low", VIEW_LOW, "high", VIEW_HIGH));
    }
    for (int i = 0; i < page->picture_count; i++)
    {
        char id[32];
        snprintf(id, sizeof id, "picture-%d", i);
        put_packed(file, id, &page->pictures[i]);
    }
    return status == TY_OK ? put_json(file, page->data, error) : status;
}

// The template with what its marks stand for; it has no other @.
static ty_status put_page(FILE* file, const void* context, ty_error* error)
{
    const ty_page* page = context;
    ty_status status = TY_OK;
    const char* at = ty_page_html;
    for (const char* mark; (mark = strchr(at, '@')) && status == TY_OK;)
    {
        fwrite(at, 1, (size_t)(mark - at), file);
        switch (mark[1])
        {
        case 'T':
            ty_markup_text(file, page->title);
            break;
        case 'S':
            fputs(mark[2] == 'T' ? ty_page_css : ty_page_js, file);
            break;
        default:
            status = put_data(file, page, error);
        }
        at = strchr(mark + 1, '@') + 1;
    }
    fputs(at, file);
    return status;
}

ty_status ty_page_write(const ty_page* page, const char* path, ty_error* error)
{
    return ty_output_write(path, put_page, page, error);
}
