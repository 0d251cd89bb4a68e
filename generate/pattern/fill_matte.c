// SPDX-License-Identifier: Apache-2.0
// Mattes: each layer's share of a pixel. Layers are marks by cell; smoothed by a quadratic B-spline their shares add up
// to 1 everywhere, and the lead of each over the next sharpens them to an edge of one pixel. Marks that follow the
// pattern are laid over them.
#include "fill_show.h"
#include <math.h>

// The quadratic B-spline's weights of the cells before, at and after the one that holds t, 0..1 within it.
static void spline_weights(float t, float w[3])
{
    w[0] = 0.5f * (1.0f - t) * (1.0f - t);
    w[2] = 0.5f * t * t;
    w[1] = 1.0f - w[0] - w[2];
}

static int near_cell(int i, int n, bool wrap)
{
    if (wrap)
        return (i + n) % n;
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

// Smoothed shares of the layers about a pixel; the layer, when there is but one, else -1.
static int shares(const fill_show_state* show, int x, int y, float share[FILL_LAYERS])
{
    const fill_run* run = show->run;
    float scale = (float)run->recipe->scale, px = ((float)x + 0.5f) / scale + show->drift;
    float py = ((float)y + 0.5f) / scale, wx[3], wy[3];
    int cx, cy;
    fill_pixel_cell(show, x, y, &cx, &cy);
    spline_weights(px - floorf(px), wx);
    spline_weights(py - (float)cy, wy);
    int first = show->layers[fill_cell(run, cx, cy)];
    bool single = true;
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
        {
            size_t at = fill_cell(run, near_cell(cx + i - 1, run->width, run->wrap_x),
                                  near_cell(cy + j - 1, run->height, run->wrap_y));
            single = single && show->layers[at] == first;
            share[show->layers[at]] += wx[i] * wy[j];
        }
    return single ? first : -1;
}

// A straight edge gives the lead 1.5 a cell: one pixel of it is to go from 0 to 1.
static void sharpen(const fill_show_state* show, const float share[FILL_LAYERS], float matte[FILL_LAYERS])
{
    float gain = 4.0f * (float)show->run->recipe->scale / 3.0f, sum = 0.0f;
    float first = 0.0f, second = 0.0f;
    for (int k = 0; k < FILL_LAYERS; k++)
    {
        second = share[k] > first ? first : ty_max(second, share[k]);
        first = ty_max(first, share[k]);
    }
    for (int k = 0; k < FILL_LAYERS; k++)
    {
        float lead = share[k] - (share[k] == first ? second : first);
        matte[k] = share[k] > 0.0f ? ty_clamp(0.5f + 0.5f * gain * lead, 0.0f, 1.0f) : 0.0f;
        sum += matte[k];
    }
    for (int k = 0; k < FILL_LAYERS; k++)
        matte[k] /= sum;
}

static float pixel_at(const fill_show_state* show, const float* plane, int x, int y)
{
    x = near_cell(x, show->width, show->run->wrap_x);
    y = near_cell(y, show->height, show->run->wrap_y);
    return plane[(size_t)y * (size_t)show->width + (size_t)x];
}

float fill_coverage(const fill_show_state* show, int x, int y)
{
    float dx = 0.5f * (pixel_at(show, show->v, x + 1, y) - pixel_at(show, show->v, x - 1, y));
    float dy = 0.5f * (pixel_at(show, show->v, x, y + 1) - pixel_at(show, show->v, x, y - 1));
    float slope = sqrtf(dx * dx + dy * dy), over = pixel_at(show, show->v, x, y) - show->run->level;
    return slope > 1e-6f ? ty_clamp(0.5f + over / slope, 0.0f, 1.0f) : over >= 0.0f ? 1.0f : 0.0f;
}

// How much of a pixel a rule takes.
static float auto_share(const fill_show_state* show, const ty_fill_auto* a, int x, int y)
{
    float scale = (float)show->run->recipe->scale;
    int cx, cy;
    if (a->where == TY_FILL_WHERE_FILLED)
        return fill_coverage(show, x, y);
    if (a->where == TY_FILL_WHERE_HOLE)
        return 1.0f - fill_coverage(show, x, y);
    if (a->where == TY_FILL_WHERE_BAND)
    {
        float d = pixel_at(show, show->distance, x, y);
        return ty_clamp(0.5f + scale * (d - a->reach[0]), 0.0f, 1.0f) *
               ty_clamp(0.5f + scale * (a->reach[1] - d), 0.0f, 1.0f);
    }
    fill_pixel_cell(show, x, y, &cx, &cy);
    return show->run->trail[fill_cell(show->run, cx, cy)] >= 0.0f ? 1.0f : 0.0f;
}

static void auto_lay(float matte[FILL_LAYERS], int mark, int over, float share)
{
    if (over >= 0)
    {
        float taken = share * matte[over];
        matte[over] -= taken;
        matte[mark] += taken;
        return;
    }
    float open = 0.0f;
    for (int k = 0; k < FILL_CLOSED; k++)
    {
        open += matte[k];
        matte[k] *= 1.0f - share;
    }
    matte[mark] += share * open;
}

void fill_matte(const fill_show_state* show, int x, int y, float matte[FILL_LAYERS])
{
    const ty_fill_auto* autos = show->run->recipe->autos.items;
    float share[FILL_LAYERS] = {0};
    int single = shares(show, x, y, share);
    if (single < 0)
        sharpen(show, share, matte);
    for (int k = 0; k < FILL_LAYERS && single >= 0; k++)
        matte[k] = k == single ? 1.0f : 0.0f;
    for (int i = 0; i < show->run->recipe->autos.count; i++)
        auto_lay(matte, show->auto_marks[i], show->auto_over[i], auto_share(show, &autos[i], x, y));
}
