// SPDX-License-Identifier: Apache-2.0
// Errors of pixels: RMSE, relative MSE, PSNR and their kin.
#include "select.h"
#include <math.h>
#include <string.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/metrics.h>

// Rousselle, Knaus and Zwicker 2011 use this constant; it keeps black pixels from ruling the mean.
#define RELATIVE_EPSILON .01
#define TRIMMED_SHARE .001

static const char* const names[TY_METRIC_COUNT] = {"rmse", "relmse", "trelmse", "mae",
                                                   "psnr", "max",    "flip",    "hdrflip"};

const char* ty_metric_name(ty_metric metric)
{
    return names[metric];
}

bool ty_metric_find(const char* name, ty_metric* out)
{
    for (int i = 0; i < TY_METRIC_COUNT; i++)
        if (strcmp(name, names[i]) == 0)
        {
            *out = (ty_metric)i;
            return true;
        }
    return false;
}

typedef struct sums
{
    double squares, relative, absolute, largest, peak;
    int64_t pixels;
    float* relative_by_pixel; // [pixels]
} sums;

static void add_pixel(const ty_image* reference, const ty_image* test, int64_t pixel, sums* sum, ty_pixel_errors* out)
{
    double relative = 0.0;
    for (int c = 0; c < reference->channels; c++)
    {
        int64_t i = pixel * reference->channels + c;
        double r = (double)reference->pixels[i], difference = (double)test->pixels[i] - r, size = fabs(difference);
        sum->squares += difference * difference;
        relative += difference * difference / (r * r + RELATIVE_EPSILON);
        sum->absolute += size;
        sum->peak = fmax(sum->peak, fabs(r));
        if (size > sum->largest || (sum->pixels == 0 && c == 0))
        {
            sum->largest = size;
            out->x = (int)(pixel % reference->width);
            out->y = (int)(pixel / reference->width);
            out->channel = c;
            out->reference = reference->pixels[i];
            out->test = test->pixels[i];
        }
    }
    sum->relative += relative;
    sum->relative_by_pixel[sum->pixels++] = (float)(relative / reference->channels);
}

// The mean of all but the largest; reorders values.
static double trimmed_mean(float* values, int64_t count)
{
    int64_t kept = count - (int64_t)(TRIMMED_SHARE * (double)count);
    ty_select(values, count, kept - 1);
    double sum = 0.0;
    for (int64_t i = 0; i < kept; i++)
        sum += (double)values[i];
    return sum / (double)kept;
}

ty_status ty_pixel_errors_measure(const ty_image* reference, const ty_image* test, const uint8_t* mask, double peak,
                                  ty_pixel_errors* out, ty_error* error)
{
    TY_ASSERT(reference->width == test->width && reference->height == test->height);
    TY_ASSERT(reference->channels == test->channels);
    int64_t count = (int64_t)reference->width * reference->height;
    sums sum = {.relative_by_pixel = TY_TRY_ALLOC(float, count)};
    if (!sum.relative_by_pixel)
        return ty_error_set(error, TY_NO_MEMORY, "not enough memory to compare %d x %d pixels", reference->width,
                            reference->height);
    for (int64_t pixel = 0; pixel < count; pixel++)
        if (!mask || mask[pixel])
            add_pixel(reference, test, pixel, &sum, out);
    TY_ASSERT(sum.pixels > 0);
    double values = (double)sum.pixels * reference->channels;
    double rmse = sqrt(sum.squares / values);
    out->value[TY_METRIC_RMSE] = rmse;
    out->value[TY_METRIC_RELMSE] = sum.relative / values;
    out->value[TY_METRIC_TRELMSE] = trimmed_mean(sum.relative_by_pixel, sum.pixels);
    out->value[TY_METRIC_MAE] = sum.absolute / values;
    out->value[TY_METRIC_PSNR] = 20.0 * log10((peak > 0.0 ? peak : sum.peak) / rmse);
    if (!(rmse > 0.0))
        out->value[TY_METRIC_PSNR] = (double)INFINITY;
    out->value[TY_METRIC_MAX] = sum.largest;
    ty_free(sum.relative_by_pixel);
    return TY_OK;
}

ty_non_finite ty_image_find_non_finite(const ty_image* image)
{
    ty_non_finite found = {0};
    int64_t count = (int64_t)image->width * image->height * image->channels;
    for (int64_t i = 0; i < count; i++)
    {
        if (isfinite(image->pixels[i]))
            continue;
        int64_t pixel = i / image->channels;
        if (found.count++ == 0)
            found = (ty_non_finite){1, (int)(pixel % image->width), (int)(pixel / image->width),
                                    (int)(i % image->channels), image->pixels[i]};
    }
    return found;
}

double ty_map_mean(const float* map, const uint8_t* mask, int64_t count)
{
    double sum = 0.0;
    int64_t used = 0;
    for (int64_t i = 0; i < count; i++)
        if (!mask || mask[i])
        {
            sum += (double)map[i];
            used++;
        }
    return used ? sum / (double)used : 0.0;
}
