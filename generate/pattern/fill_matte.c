// SPDX-License-Identifier: Apache-2.0
// Mattes: each layer's share of a pixel. Layers are marks by cell; smoothed by a quartic B-spline their shares add up
// to 1 everywhere, and the lead of each over the next sharpens them to an edge of one pixel. Marks that follow the
// pattern are laid over them.
#include "fill_show.h"
#include <math.h>

// The quartic B-spline's weights of five cells, the third of which holds t, 0..1 within it.
static void spline_weights(float t, float w[5])
{
    float u = 1.0f - t;
    w[0] = u * u * u * u / 24.0f;
    w[1] = (11.0f + t * (-12.0f + t * (-6.0f + t * (12.0f - 4.0f * t)))) / 24.0f;
    w[3] = (11.0f + u * (-12.0f + u * (-6.0f + u * (12.0f - 4.0f * u)))) / 24.0f;
    w[4] = t * t * t * t / 24.0f;
    w[2] = 1.0f - w[0] - w[1] - w[3] - w[4];
}

static int near_cell(int i, int n, bool wrap)
{
    if (wrap)
        return (i + n) % n; // n is at least 8
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

// Smoothed shares of the layers about a pixel.
static void shares(const fill_show_state* show, int x, int y, int cx, int cy, float share[FILL_LAYERS])
{
    const fill_run* run = show->run;
    float scale = (float)run->recipe->scale, px = ((float)x + 0.5f) / scale + show->drift;
    float py = ((float)y + 0.5f) / scale, wx[5], wy[5];
    spline_weights(px - floorf(px), wx);
    spline_weights(py - (float)cy, wy);
    for (int j = 0; j < 5; j++)
        for (int i = 0; i < 5; i++)
        {
            size_t at = fill_cell(run, near_cell(cx + i - 2, run->width, run->wrap_x),
                                  near_cell(cy + j - 2, run->height, run->wrap_y));
            share[show->layers[at]] += wx[i] * wy[j];
        }
}

bool fill_is_single(const fill_show_state* show, int x, int y)
{
    const fill_run* run = show->run;
    uint8_t first = show->layers[fill_cell(run, x, y)];
    for (int j = -2; j <= 2; j++)
        for (int i = -2; i <= 2; i++)
            if (show->layers[fill_cell(run, near_cell(x + i, run->width, run->wrap_x),
                                       near_cell(y + j, run->height, run->wrap_y))] != first)
                return false;
    return true;
}

// A straight edge gives the lead 1.2 a cell: one pixel of it is to go from 0 to 1.
static void sharpen(const fill_show_state* show, const float share[FILL_LAYERS], float matte[FILL_LAYERS])
{
    float gain = (float)show->run->recipe->scale / 0.6f, sum = 0.0f;
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
    int cx, cy;
    fill_pixel_cell(show, x, y, &cx, &cy);
    size_t cell = fill_cell(show->run, cx, cy);
    if (show->single[cell])
        for (int k = 0; k < FILL_LAYERS; k++)
            matte[k] = k == show->layers[cell] ? 1.0f : 0.0f;
    else
    {
        float share[FILL_LAYERS] = {0};
        shares(show, x, y, cx, cy, share);
        sharpen(show, share, matte);
    }
    for (int i = 0; i < show->run->recipe->autos.count; i++)
        auto_lay(matte, show->auto_marks[i], show->auto_over[i], auto_share(show, &autos[i], x, y));
}
