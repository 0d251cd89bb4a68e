// SPDX-License-Identifier: Apache-2.0
// Between the cells of a plane.
#pragma once
#include <stdbool.h>

// The cubic through the four neighbours (Catmull & Rom 1974) at t past the second.
static inline void cubic_weights(float t, float w[4])
{
    w[0] = 0.5f * t * (t * (2.0f - t) - 1.0f);
    w[1] = 0.5f * (t * t * (3.0f * t - 5.0f) + 2.0f);
    w[2] = 0.5f * t * (t * (4.0f - 3.0f * t) + 1.0f);
    w[3] = 0.5f * t * t * (t - 1.0f);
}

static inline int cubic_neighbour(int i, int n, bool wrap)
{
    if (wrap)
        return (i % n + n) % n;
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}
