// SPDX-License-Identifier: Apache-2.0
// Inverse distribution functions of the pixel filters, tabulated once.
#include "pixel_filter.h"

// Shape at s = |offset| / half width, 0..1.
static double filter_shape(ty_filter_kind kind, double s)
{
    const double pi = 3.14159265358979323846;
    switch (kind)
    {
    case TY_FILTER_GAUSSIAN: // cut at three standard deviations
        return exp(-4.5 * s * s);
    case TY_FILTER_BLACKMAN_HARRIS: // Harris 1978, the minimum four-term window
        return 0.35875 + 0.48829 * cos(pi * s) + 0.14128 * cos(2.0 * pi * s) + 0.01168 * cos(3.0 * pi * s);
    case TY_FILTER_BOX:
        break;
    }
    return 1.0;
}

void ty_pixel_filter_init(ty_pixel_filter* filter, ty_filter_kind kind, float width)
{
    enum
    {
        CELLS = 1 << 14
    };
    filter->box_width = kind == TY_FILTER_BOX ? width : 0.0f;
    double total = 0.0;
    for (int i = 0; i < CELLS; ++i)
        total += filter_shape(kind, (i + 0.5) / CELLS);
    double below = 0.0, half_width = 0.5 * (double)width;
    int step = 0;
    for (int i = 0; i < CELLS; ++i)
    {
        double mass = filter_shape(kind, (i + 0.5) / CELLS) / total;
        for (; step < TY_FILTER_STEPS && below + mass > (double)step / TY_FILTER_STEPS; ++step)
        {
            double within = ((double)step / TY_FILTER_STEPS - below) / mass;
            filter->offset[step] = (float)(half_width * (i + within) / CELLS);
        }
        below += mass;
    }
    for (; step <= TY_FILTER_STEPS; ++step)
        filter->offset[step] = 0.5f * width;
}

float ty_pixel_filter_sample(const ty_pixel_filter* filter, float u)
{
    if (filter->box_width > 0.0f)
        return filter->box_width * (u - 0.5f);
    float s = 2.0f * u - 1.0f;
    float x = fabsf(s) * (float)TY_FILTER_STEPS;
    int step = x < (float)TY_FILTER_STEPS ? (int)x : TY_FILTER_STEPS - 1;
    return copysignf(ty_lerp(filter->offset[step], filter->offset[step + 1], x - (float)step), s);
}
