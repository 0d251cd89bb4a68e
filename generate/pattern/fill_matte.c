// SPDX-License-Identifier: Apache-2.0
// Mattes: each layer's share of a pixel. Layers are marks by cell; smoothed by a quartic B-spline their shares add up
// to 1 everywhere, and the lead of each over the next sharpens them to an edge of one pixel. Marks that follow the
// pattern are laid over them.
#include "fill_show.h"
#include <math.h>
#include <string.h>
#include <tsuya/base/memory.h>

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
            size_t at = fill_cell(run, cubic_neighbour(cx + i - 2, run->width, run->wrap_x),
                                  cubic_neighbour(cy + j - 2, run->height, run->wrap_y));
            share[run->layers[at]] += wx[i] * wy[j];
        }
}

// --- layers ---

static void rows_take(void* context, int64_t begin, int64_t end, int worker)
{
    const fill_run* run = *(const fill_run* const*)context;
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
    {
        const uint8_t *marks = ty_gray_scott_marks_seen(run->field, y), *closed = run->closed + fill_cell(run, 0, y);
        uint8_t* layers = run->layers + fill_cell(run, 0, y);
        for (int x = 0; x < run->width; x++)
            layers[x] = closed[x] ? FILL_CLOSED : fill_mark_of(marks[x]);
    }
}

// Where a row's cells have neighbours of another layer within two cells: bits that differ, 0 = none.
static void rows_compare(void* context, int64_t begin, int64_t end, int worker)
{
    const fill_run* run = *(const fill_run* const*)context;
    (void)worker;
    int w = run->width;
    uint8_t* wide = TY_ALLOC(uint8_t, w + 4);
    for (int y = (int)begin; y < (int)end; y++)
    {
        const uint8_t* layers = run->layers + fill_cell(run, 0, y);
        uint8_t* mixed = run->mixed + fill_cell(run, 0, y);
        memset(mixed, 0, (size_t)w);
        for (int j = -2; j <= 2; j++)
        {
            const uint8_t* row = run->layers + fill_cell(run, 0, cubic_neighbour(y + j, run->height, run->wrap_y));
            memcpy(wide + 2, row, (size_t)w);
            for (int k = 1; k <= 2; k++)
            {
                wide[2 - k] = row[cubic_neighbour(-k, w, run->wrap_x)];
                wide[w + 1 + k] = row[cubic_neighbour(w - 1 + k, w, run->wrap_x)];
            }
            for (int x = 0; x < w; x++)
                mixed[x] |= (uint8_t)((wide[x] ^ layers[x]) | (wide[x + 1] ^ layers[x]) | (wide[x + 2] ^ layers[x]) |
                                      (wide[x + 3] ^ layers[x]) | (wide[x + 4] ^ layers[x]));
        }
    }
    ty_free(wide);
}

void fill_layers_take(const fill_run* run)
{
    ty_parallel_all(run->workers, run->height, 32, rows_take, &run);
    ty_parallel_all(run->workers, run->height, 32, rows_compare, &run);
}

// --- mattes ---

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

static float coverage_of(float left, float right, float above, float below, float here, float level)
{
    float dx = 0.5f * (right - left), dy = 0.5f * (below - above), slope = sqrtf(dx * dx + dy * dy);
    float over = here - level;
    return slope > 1e-6f ? ty_clamp(0.5f + over / slope, 0.0f, 1.0f) : over >= 0.0f ? 1.0f : 0.0f;
}

void fill_coverage_row(const fill_show_state* show, int y, float* restrict out)
{
    const fill_run* run = show->run;
    size_t w = (size_t)show->width;
    const float* row = show->v + (size_t)y * w;
    const float* above = show->v + (size_t)cubic_neighbour(y - 1, show->height, run->wrap_y) * w;
    const float* below = show->v + (size_t)cubic_neighbour(y + 1, show->height, run->wrap_y) * w;
    float level = run->level, before = run->wrap_x ? row[w - 1] : row[0], behind = run->wrap_x ? row[0] : row[w - 1];
    for (size_t x = 1; x + 1 < w; x++)
        out[x] = coverage_of(row[x - 1], row[x + 1], above[x], below[x], row[x], level);
    out[0] = coverage_of(before, row[1], above[0], below[0], row[0], level);
    out[w - 1] = coverage_of(row[w - 2], behind, above[w - 1], below[w - 1], row[w - 1], level);
}

// How much of a pixel a rule takes.
static float auto_share(const fill_show_state* show, const ty_fill_auto* a, int x, int y, const float* coverage)
{
    const fill_run* run = show->run;
    float scale = (float)run->recipe->scale;
    if (a->where == TY_FILL_WHERE_FILLED)
        return coverage[x];
    if (a->where == TY_FILL_WHERE_HOLE)
        return 1.0f - coverage[x];
    if (a->where == TY_FILL_WHERE_BAND)
    {
        float d = show->distance[(size_t)y * (size_t)show->width + (size_t)x];
        return ty_clamp(0.5f + scale * (d - a->reach[0]), 0.0f, 1.0f) *
               ty_clamp(0.5f + scale * (a->reach[1] - d), 0.0f, 1.0f);
    }
    return run->trail[fill_cell(run, show->cell_x[x], y / run->recipe->scale)] >= 0.0f ? 1.0f : 0.0f;
}

bool fill_is_ruled(const fill_show_state* show, int x, int y, const float* coverage)
{
    const ty_fill_auto* autos = show->run->recipe->autos.items;
    for (int i = 0; i < show->run->recipe->autos.count; i++)
        if (auto_share(show, &autos[i], x, y, coverage) > 0.0f)
            return true;
    return false;
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

void fill_matte(const fill_show_state* show, int x, int y, const float* coverage, float matte[FILL_LAYERS])
{
    const fill_run* run = show->run;
    const ty_fill_auto* autos = run->recipe->autos.items;
    int cx = show->cell_x[x], cy = y / run->recipe->scale;
    size_t cell = fill_cell(run, cx, cy);
    if (!run->mixed[cell])
        for (int k = 0; k < FILL_LAYERS; k++)
            matte[k] = k == run->layers[cell] ? 1.0f : 0.0f;
    else
    {
        float share[FILL_LAYERS] = {0};
        shares(show, x, y, cx, cy, share);
        sharpen(show, share, matte);
    }
    for (int i = 0; i < run->recipe->autos.count; i++)
        auto_lay(matte, show->auto_marks[i], show->auto_over[i], auto_share(show, &autos[i], x, y, coverage));
}
