// SPDX-License-Identifier: Apache-2.0
// HDR-FLIP: the worst of what a viewer sees at any sensible exposure.
#include "flip_run.h"
#include "select.h"
#include <math.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/metrics.h>

// The filmic curve (a x^2 + b x) / (c x^2 + d x + e), Narkowicz's fit of ACES with its exposure of .6 in the numbers.
#define CURVE_A (0.6 * 0.6 * 2.51)
#define CURVE_B (0.6 * 0.03)
#define CURVE_C (0.6 * 0.6 * 2.43)
#define CURVE_D (0.6 * 0.59)
#define CURVE_E 0.14
// The display value that the brightest and the median luminance are brought to.
#define SHOWN 0.85

typedef struct exposed
{
    const ty_image* image;
    float scale;
} exposed;

static void exposed_pixel(const void* context, int64_t i, float rgb[3])
{
    const exposed* from = context;
    for (int c = 0; c < 3; c++)
    {
        float x = from->image->pixels[3 * i + c] * from->scale;
        x = ty_clamp(x, 0.0f, 1e9f); // its square is still finite
        float curve = x * ((float)CURVE_A * x + (float)CURVE_B);
        rgb[c] = ty_clamp(curve / (x * ((float)CURVE_C * x + (float)CURVE_D) + (float)CURVE_E), 0.0f, 1.0f);
    }
}

// The x that the curve takes to SHOWN: the positive root of its quadratic.
static double curve_inverse(void)
{
    double a = CURVE_A - SHOWN * CURVE_C, b = CURVE_B - SHOWN * CURVE_D, c = -SHOWN * CURVE_E;
    return (-b + sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
}

// First and last exposure in stops: the brightest and the median luminance of the reference at SHOWN. Where more than
// half is black, the median is that of the lit pixels; a picture without any is looked at as it is.
static ty_status exposure_range(const ty_image* reference, double range[2], ty_error* error)
{
    int64_t count = (int64_t)reference->width * reference->height;
    float* luminance = TY_TRY_ALLOC(float, count);
    if (!luminance)
        return ty_error_set(error, TY_NO_MEMORY, "not enough memory for HDR-FLIP");
    float brightest = 0.0f;
    for (int64_t i = 0; i < count; i++)
    {
        const float* p = &reference->pixels[3 * i];
        luminance[i] = ty_max(0.0f, 0.2126729f * p[0] + 0.7151522f * p[1] + 0.0721750f * p[2]);
        brightest = ty_max(brightest, luminance[i]);
    }
    float median = ty_select(luminance, count, count / 2);
    int64_t lit = 0;
    for (int64_t i = 0; i < count; i++)
        if (luminance[i] > 0.0f)
            luminance[lit++] = luminance[i];
    if (median <= 0.0f && lit > 0)
        median = ty_select(luminance, lit, lit / 2);
    ty_free(luminance);
    range[0] = lit ? log2(curve_inverse() / (double)brightest) : 0.0;
    range[1] = lit ? log2(curve_inverse() / (double)median) : 0.0;
    return TY_OK;
}

ty_status ty_flip_hdr(const ty_image* reference, const ty_image* test, float ppd, ty_workers* workers, float* map,
                      ty_error* error)
{
    TY_ASSERT(reference->width == test->width && reference->height == test->height);
    TY_ASSERT(reference->channels == 3 && test->channels == 3);
    double range[2] = {0};
    ty_status status = exposure_range(reference, range, error);
    ty_flip_run* run = NULL;
    if (status == TY_OK)
        status = ty_flip_run_create(reference->width, reference->height, ppd, workers, &run, error);
    if (status != TY_OK)
        return status;
    int count = (int)fmax(2.0, ceil(range[1] - range[0]));
    for (int i = 0; i < count; i++)
    {
        double stops = range[0] + (range[1] - range[0]) * i / (count - 1);
        exposed side[2] = {{reference, (float)exp2(stops)}, {test, (float)exp2(stops)}};
        for (int k = 0; k < 2; k++)
            ty_flip_run_picture(run, k, exposed_pixel, &side[k]);
        ty_flip_run_errors(run, i > 0, map);
    }
    ty_flip_run_destroy(run);
    return TY_OK;
}
