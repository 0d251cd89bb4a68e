// SPDX-License-Identifier: Apache-2.0
// The pixel filter, by importance sampling: samples fall by the filter's shape and all weigh the same.
#pragma once
#include <tsuya/scene/scene.h>

#define TY_FILTER_STEPS 1024

// Half of a symmetric filter: offset in pixels by the share of the half's area inside it.
typedef struct ty_pixel_filter
{
    float offset[TY_FILTER_STEPS + 1];
    float box_width; // 0 = no box
} ty_pixel_filter;

// width: full width in pixels, > 0.
void ty_pixel_filter_init(ty_pixel_filter* filter, ty_filter_kind kind, float width);

// Offset from the pixel's centre for u in [0,1); u and 1 - u give opposite offsets.
float ty_pixel_filter_sample(const ty_pixel_filter* filter, float u);
