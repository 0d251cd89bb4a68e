// SPDX-License-Identifier: Apache-2.0
// Texture coordinates to texels: what lies outside of 0..1, and the two neighbours of a bilinear lookup.
#pragma once
#include <tsuya/image/texture.h>

// Brings a coordinate near the image, so that the texel index below fits an int for any u, NaN included.
static inline float ty_wrap_reduce(float u, ty_wrap wrap)
{
    if (!(fabsf(u) < 1e9f))
        return 0.0f;
    switch (wrap)
    {
    case TY_WRAP_REPEAT:
        return u - floorf(u);
    case TY_WRAP_MIRROR:
        return u - 2.0f * floorf(0.5f * u);
    case TY_WRAP_CLAMP:
        break;
    }
    return ty_clamp(u, 0.0f, 1.0f);
}

// The texel in the image for one at most a row outside what reduce leaves.
static inline int ty_wrap_index(int i, int count, ty_wrap wrap)
{
    switch (wrap)
    {
    case TY_WRAP_REPEAT:
        return i < 0 ? i + count : i >= count ? i - count : i;
    case TY_WRAP_MIRROR:
        i = i < 0 ? -1 - i : i;
        i = i >= 2 * count ? i - 2 * count : i;
        return i >= count ? 2 * count - 1 - i : i;
    case TY_WRAP_CLAMP:
        break;
    }
    return i < 0 ? 0 : i >= count ? count - 1 : i;
}

// The two texels of one axis and the weight of the second.
static inline float ty_wrap_taps(float u, int count, ty_wrap wrap, int index[2])
{
    float position = ty_wrap_reduce(u, wrap) * (float)count - 0.5f, base = floorf(position);
    index[0] = ty_wrap_index((int)base, count, wrap);
    index[1] = ty_wrap_index((int)base + 1, count, wrap);
    return position - base;
}
