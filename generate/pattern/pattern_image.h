// SPDX-License-Identifier: Apache-2.0
// A frame of a pattern before it is painted.
#pragma once
#include <tsuya/base/math.h>
#include <tsuya/image/exr.h>

static inline bool pattern_is_grey(ty_rgb c)
{
    return c.r == c.g && c.g == c.b;
}

// Zeros of ACEScg as R, G, B, or as Y alone: then the second and third of color are NULL. The caller's.
ty_exr* pattern_image_create(int width, int height, bool grey, float* color[3]);
