// SPDX-License-Identifier: Apache-2.0
// The weights of pixels between cells, once for all rows, and rows by them.
#include "cubic.h"
#include <math.h>
#include <tsuya/base/memory.h>

bool cubic_axis_init(cubic_axis* axis, int cells, int scale, float shift, bool wraps)
{
    int pixels = cells * scale;
    *axis = (cubic_axis){.cells = cells, .pixels = pixels, .wraps = wraps, .whole = scale == 1 && shift == 0.0f};
    axis->first = TY_TRY_ALLOC(int, pixels);
    axis->w0 = ty_try_alloc((size_t)pixels, 4 * sizeof(float));
    if (!axis->first || !axis->w0)
        return false;
    axis->w1 = axis->w0 + pixels;
    axis->w2 = axis->w1 + pixels;
    axis->w3 = axis->w2 + pixels;
    for (int x = 0; x < pixels; x++)
    {
        float at = ((float)x + 0.5f) / (float)scale - 0.5f + shift, second = floorf(at), t = at - second;
        int i = (int)second;
        if (wraps)
            i = cubic_neighbour(i, cells, true);
        else if (i < -2 || i > cells)
            i = i < 0 ? -2 : cells; // all four are the last cell of that side
        axis->first[x] = i - 1 + CUBIC_PAD;
        axis->w0[x] = 0.5f * t * (t * (2.0f - t) - 1.0f);
        axis->w1[x] = 0.5f * (t * t * (3.0f * t - 5.0f) + 2.0f);
        axis->w2[x] = 0.5f * t * (t * (4.0f - 3.0f * t) + 1.0f);
        axis->w3[x] = 0.5f * t * t * (t - 1.0f);
    }
    return true;
}

void cubic_axis_term(cubic_axis* axis)
{
    ty_free(axis->first);
    ty_free(axis->w0);
}

void cubic_row(const cubic_axis* across, const cubic_axis* down, const float* plane, int y, float* restrict line,
               float* restrict out)
{
    int n = across->cells, begin = down->first[y] - CUBIC_PAD;
    const float* rows[4];
    for (int k = 0; k < 4; k++)
        rows[k] = plane + (size_t)cubic_neighbour(begin + k, down->cells, down->wraps) * (size_t)n;
    if (across->whole && down->whole)
    {
        for (int x = 0; x < n; x++)
            out[x] = rows[1][x] + 0.0f; // no negative zeros
        return;
    }
    const float *r0 = rows[0], *r1 = rows[1], *r2 = rows[2], *r3 = rows[3];
    float w0 = down->w0[y], w1 = down->w1[y], w2 = down->w2[y], w3 = down->w3[y], *middle = line + CUBIC_PAD;
    for (int x = 0; x < n; x++)
        middle[x] = 0.0f + w0 * r0[x] + w1 * r1[x] + w2 * r2[x] + w3 * r3[x];
    for (int k = 1; k <= CUBIC_PAD; k++)
    {
        middle[-k] = middle[cubic_neighbour(-k, n, across->wraps)];
        middle[n - 1 + k] = middle[cubic_neighbour(n - 1 + k, n, across->wraps)];
    }
    for (int x = 0; x < across->pixels; x++)
    {
        const float* four = line + across->first[x];
        out[x] = 0.0f + across->w0[x] * four[0] + across->w1[x] * four[1] + across->w2[x] * four[2] +
                 across->w3[x] * four[3];
    }
}
