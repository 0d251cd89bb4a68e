// SPDX-License-Identifier: Apache-2.0
// What steers the cells of a Turing filter: tones, masks, contours, the directions of a structure tensor.
#include "filter_run.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/memory.h>

// --- slopes ---

// Central differences of the blurred first tone. x and y: [height][width].
static void gradient(const ty_filter_run* run, float sigma, float* x, float* y, float* scratch)
{
    int w = run->width, h = run->height;
    size_t size = (size_t)w * (size_t)h;
    memcpy(y, run->picture.tone[0], size * sizeof *y);
    ty_filter_blur(y, x, w, h, sigma, run->workers);
    memcpy(scratch, y, size * sizeof *y);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
        {
            const float* row = scratch + (size_t)j * (size_t)w;
            int up = j > 0 ? -w : 0, down = j + 1 < h ? w : 0;
            x[(size_t)j * (size_t)w + (size_t)i] = 0.5f * (row[i + 1 < w ? i + 1 : i] - row[i > 0 ? i - 1 : 0]);
            y[(size_t)j * (size_t)w + (size_t)i] = 0.5f * (row[i + down] - row[i + up]);
        }
}

// Planes of scratch, or NULL with the error set.
static float* planes_alloc(const ty_filter_run* run, int count, ty_error* error)
{
    float* planes = TY_TRY_ALLOC(float, (size_t)count*(size_t)run->width*(size_t)run->height);
    if (!planes)
        ty_error_set(error, TY_NO_MEMORY, "no memory for %d x %d cells", run->width, run->height);
    return planes;
}

// --- tones ---

static ty_status tone_guide(ty_filter_run* run, ty_error* error)
{
    const float* range = run->recipe->tone.range;
    for (int f = 0; f < run->field_count && run->recipe->mode == TY_FILTER_TONE; f++)
    {
        ty_status status = ty_turing_need(run->fields[f], TY_TURING_CONSTANT, error);
        if (status != TY_OK)
            return status;
        for (int y = 0; y < run->height; y++)
        {
            float* row = ty_turing_row(run->fields[f], TY_TURING_CONSTANT, y);
            const float* tone = run->picture.tone[f] + (size_t)y * (size_t)run->width;
            for (int x = 0; x < run->width; x++)
                row[x] = ty_lerp(range[0], range[1], tone[x]);
        }
    }
    return TY_OK;
}

// --- what is held ---

static ty_status hold_need(ty_turing* field, ty_error* error)
{
    return ty_turing_need(field, TY_TURING_HOLD, error);
}

// The faster pull wins.
static void hold(ty_turing* field, int x, int y, float rate, const float value[2])
{
    float* at = ty_turing_row(field, TY_TURING_HOLD, y) + x;
    if (rate <= *at)
        return;
    *at = rate;
    ty_turing_row(field, TY_TURING_HOLD_U, y)[x] = value[0];
    ty_turing_row(field, TY_TURING_HOLD_V, y)[x] = value[1];
}

static void region_row(ty_filter_run* run, const ty_filter_region* region, const float* mask, int y)
{
    for (int x = 0; x < run->width; x++)
    {
        float m = ty_clamp(mask[x], 0.0f, 1.0f);
        m = region->inverted ? 1.0f - m : m;
        run->alive[(size_t)y * (size_t)run->width + (size_t)x] *= m;
        for (int f = 0; f < run->field_count; f++)
        {
            if (region->boundary == 0)
                ty_turing_row(run->fields[f], TY_TURING_OPEN, y)[x] *= m;
            if (m == 0.0f)
                hold(run->fields[f], x, y, INFINITY, region->value);
            else if (region->boundary == 1)
                hold(run->fields[f], x, y, region->softness * (1.0f - m) / m, region->value);
        }
    }
}

ty_status ty_filter_masks_open(ty_filter_run* run, ty_error* error)
{
    const ty_param_list* regions = &run->recipe->regions;
    int first = run->recipe->first_frame, last = first + run->frame_count - 1;
    run->masks = TY_ALLOC(ty_filter_mask, regions->count);
    for (int i = 0; i < regions->count; i++)
    {
        const char* path = ((const ty_filter_region*)regions->items)[i].mask;
        ty_filter_mask* mask = &run->masks[i];
        snprintf(mask->key, sizeof mask->key, "regions[%d].mask", i);
        ty_status status = ty_plane_file_open(path, mask->key, first, last, &mask->file, error);
        if (status != TY_OK)
            return status;
        if (mask->file.width != run->width || mask->file.height != run->height)
            return ty_error_set(error, TY_BAD_INPUT, "%s: '%s' has %d x %d pixels; the field has %d x %d cells",
                                mask->key, path, mask->file.width, mask->file.height, run->width, run->height);
    }
    return TY_OK;
}

static ty_status region_guide(ty_filter_run* run, int number, int frame, ty_error* error)
{
    const ty_filter_region* region = (const ty_filter_region*)run->recipe->regions.items + number;
    float* mask = NULL;
    ty_status status = ty_plane_file_read_channel(&run->masks[number].file, run->recipe->first_frame + frame - 1,
                                                  TY_PLANE_LUMINANCE, &mask, error);
    for (int f = 0; f < run->field_count && status == TY_OK; f++)
    {
        status = hold_need(run->fields[f], error);
        if (status == TY_OK && region->boundary == 0)
            status = ty_turing_need(run->fields[f], TY_TURING_OPEN, error);
    }
    for (int y = 0; y < run->height && status == TY_OK; y++)
        region_row(run, region, mask + (size_t)y * (size_t)run->width, y);
    ty_free(mask);
    return status;
}

// --- contours ---

// Whether the gradient there is as large as at both neighbours along it (Canny 1986), and large enough.
static bool is_ridge(const float* x, const float* y, int w, size_t i, float threshold)
{
    float size = sqrtf(ty_sqr(x[i]) + ty_sqr(y[i])), ax = fabsf(x[i]), ay = fabsf(y[i]);
    if (!(size >= threshold))
        return false;
    // To the nearest of eight neighbours: beyond 22.5 degrees of an axis both coordinates step.
    int dx = ax > 0.41421356f * ay ? (x[i] > 0.0f ? 1 : -1) : 0,
        dy = ay > 0.41421356f * ax ? (y[i] > 0.0f ? 1 : -1) : 0;
    size_t ahead = i + (size_t)(dy * w + dx), behind = i - (size_t)(dy * w + dx);
    // Of two that are equal, one.
    return size > sqrtf(ty_sqr(x[ahead]) + ty_sqr(y[ahead])) && size >= sqrtf(ty_sqr(x[behind]) + ty_sqr(y[behind]));
}

static void contour_draw(ty_filter_run* run, int x, int y)
{
    const ty_filter_contours* c = &run->recipe->contours;
    float radius = 0.5f * c->width;
    int reach = (int)radius;
    for (int j = y - reach; j <= y + reach; j++)
        for (int i = x - reach; i <= x + reach; i++)
        {
            bool inside = i >= 0 && i < run->width && j >= 0 && j < run->height;
            if (!inside || ty_sqr((float)(i - x)) + ty_sqr((float)(j - y)) > radius * radius)
                continue;
            for (int f = 0; f < run->field_count; f++)
                hold(run->fields[f], i, j, INFINITY, c->value);
        }
}

static ty_status contours_guide(ty_filter_run* run, ty_error* error)
{
    const ty_filter_contours* c = &run->recipe->contours;
    if (c->threshold == 0.0f)
        return TY_OK;
    for (int f = 0; f < run->field_count; f++)
    {
        ty_status status = hold_need(run->fields[f], error);
        if (status != TY_OK)
            return status;
    }
    int w = run->width;
    size_t size = (size_t)w * (size_t)run->height;
    float* planes = planes_alloc(run, 3, error);
    if (!planes)
        return TY_NO_MEMORY;
    gradient(run, c->sigma, planes, planes + size, planes + 2 * size);
    for (int y = 1; y + 1 < run->height; y++)
        for (int x = 1; x + 1 < w; x++)
            if (is_ridge(planes, planes + size, w, (size_t)y * (size_t)w + (size_t)x, c->threshold))
                contour_draw(run, x, y);
    ty_free(planes);
    return TY_OK;
}

// --- directions ---

// The structure tensor xx, yy, xy of the tone (Foerstner & Guelch 1987).
static void structure_tensor(const ty_filter_run* run, float* xx, float* yy, float* xy, float* scratch)
{
    const ty_filter_along* a = &run->recipe->along;
    size_t size = (size_t)run->width * (size_t)run->height;
    gradient(run, a->sigma, xx, yy, scratch);
    for (size_t i = 0; i < size; i++)
    {
        float x = xx[i], y = yy[i];
        xx[i] = x * x;
        yy[i] = y * y;
        xy[i] = x * y;
    }
    ty_filter_blur(xx, scratch, run->width, run->height, a->spread, run->workers);
    ty_filter_blur(yy, scratch, run->width, run->height, a->spread, run->workers);
    ty_filter_blur(xy, scratch, run->width, run->height, a->spread, run->workers);
}

static ty_status along_guide(ty_filter_run* run, ty_error* error)
{
    const ty_filter_along* a = &run->recipe->along;
    const float quiet = 1e-5f; // squared gradient of what is noise
    size_t size = (size_t)run->width * (size_t)run->height;
    if (a->strength == 0.0f)
        return TY_OK;
    for (int f = 0; f < run->field_count; f++)
    {
        ty_status status = ty_turing_need(run->fields[f], TY_TURING_ALONG_COS, error);
        if (status != TY_OK)
            return status;
    }
    float* planes = planes_alloc(run, 4, error);
    if (!planes)
        return TY_NO_MEMORY;
    float *xx = planes, *yy = planes + size, *xy = planes + 2 * size;
    structure_tensor(run, xx, yy, xy, planes + 3 * size);
    for (size_t i = 0; i < size; i++)
    {
        // Of the gradient's double angle; what lies along the structure points the other way.
        float c = xx[i] - yy[i], s = 2.0f * xy[i], length = sqrtf(c * c + s * s), all = xx[i] + yy[i];
        float k = a->strength * (a->across ? 1.0f : -1.0f) * length / ((all + quiet) * (length + 1e-12f));
        for (int f = 0; f < run->field_count; f++)
        {
            int y = (int)(i / (size_t)run->width), x = (int)(i % (size_t)run->width);
            ty_turing_row(run->fields[f], TY_TURING_ALONG_COS, y)[x] = k * c;
            ty_turing_row(run->fields[f], TY_TURING_ALONG_SIN, y)[x] = k * s;
        }
    }
    ty_free(planes);
    return TY_OK;
}

// --- all of it ---

// Nothing is closed or held; everything lives.
static ty_status guides_clear(ty_filter_run* run, ty_error* error)
{
    size_t size = (size_t)run->width * (size_t)run->height;
    if (run->recipe->regions.count > 0 && !run->alive && !(run->alive = planes_alloc(run, 1, error)))
        return TY_NO_MEMORY;
    for (size_t i = 0; i < size && run->alive; i++)
        run->alive[i] = 1.0f;
    for (int f = 0; f < run->field_count; f++)
        for (int y = 0; y < run->height; y++)
        {
            if (ty_turing_has(run->fields[f], TY_TURING_HOLD))
                memset(ty_turing_row(run->fields[f], TY_TURING_HOLD, y), 0, (size_t)run->width * sizeof(float));
            for (int x = 0; ty_turing_has(run->fields[f], TY_TURING_OPEN) && x < run->width; x++)
                ty_turing_row(run->fields[f], TY_TURING_OPEN, y)[x] = 1.0f;
        }
    return TY_OK;
}

ty_status ty_filter_guide(ty_filter_run* run, int frame, ty_error* error)
{
    ty_status status = guides_clear(run, error);
    if (status == TY_OK)
        status = tone_guide(run, error);
    for (int i = 0; i < run->recipe->regions.count && status == TY_OK; i++)
        status = region_guide(run, i, frame, error);
    if (status == TY_OK)
        status = contours_guide(run, error);
    return status == TY_OK ? along_guide(run, error) : status;
}
