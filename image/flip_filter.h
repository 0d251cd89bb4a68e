// SPDX-License-Identifier: Apache-2.0
// What an eye keeps of a picture: contrast sensitivity filters, edges and points.
#pragma once
#include <tsuya/base/workers.h>

typedef enum ty_flip_plane
{
    TY_FLIP_LIGHTNESS, // L*a*b* after the filters, a and b times .01 L (Hunt)
    TY_FLIP_RED_GREEN,
    TY_FLIP_BLUE_YELLOW,
    TY_FLIP_EDGE, // magnitudes of the gradient and of the second derivative
    TY_FLIP_POINT,
    TY_FLIP_PLANE_COUNT
} ty_flip_plane;

enum
{
    TY_FLIP_PASS_COUNT = 7,     // planes between the horizontal and the vertical pass
    TY_FLIP_RADIUS_MAX = 160,   // of kernels, px
    TY_FLIP_PPD_MAX = 1000,     // gives radii below it
    TY_FLIP_OPPONENT_COUNT = 3, // planes of a picture in YCxCz
    TY_FLIP_KERNEL_COUNT = 7    // see flip_filter.c
};

typedef struct ty_flip_kernels
{
    int contrast_radius, feature_radius; // px
    float weights[TY_FLIP_KERNEL_COUNT][2 * TY_FLIP_RADIUS_MAX + 1];
    float blue_yellow[2]; // shares of its two Gaussians
} ty_flip_kernels;

// ppd = pixels a degree of visual angle.
void ty_flip_kernels_make(float ppd, ty_flip_kernels* out);

typedef struct ty_flip_filter
{
    const ty_flip_kernels* kernels;
    int width, height;
    const float* opponent[TY_FLIP_OPPONENT_COUNT]; // YCxCz
    float* passes[TY_FLIP_PASS_COUNT];             // scratch
    float* planes[TY_FLIP_PLANE_COUNT];            // the result
} ty_flip_filter;

// All planes are [height][width]. Outside the picture its border goes on.
void ty_flip_filter_run(const ty_flip_filter* filter, ty_workers* workers);

// Linear Rec.709 to YCxCz, a linear opponent space relative to D65, and to Hunt-adjusted L*a*b*.
void ty_flip_opponent(const float rgb[3], float out[3]);
void ty_flip_lab(const float opponent[3], float out[3]);
