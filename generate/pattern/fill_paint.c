// SPDX-License-Identifier: Apache-2.0
// Pixels of a fill's frame, row by row: stretches of one layer at once, edges between layers through their mattes.
#include "fill_show.h"
#include <tsuya/base/memory.h>

// --- a layer ---

static ty_rgb planes_at(const ty_planes* planes, size_t at)
{
    size_t size = (size_t)planes->width * (size_t)planes->height;
    return (ty_rgb){planes->values[at], planes->values[at + size], planes->values[at + 2 * size]};
}

static ty_rgb layer_color(const fill_show_state* show, int mark, int part, size_t at)
{
    const ty_planes* image = show->images[mark][part];
    if (image)
        return planes_at(image, at);
    return part ? show->run->marks[mark].ground : show->run->marks[mark].color;
}

static bool is_opaque(const ty_fill_mark* mark)
{
    return mark->opacity == 1.0f && mark->ground_opacity == 1.0f;
}

// Adds a layer's colour times its share; how much it covers.
static float layer_add(const fill_show_state* show, int layer, float share, float tone, size_t at, ty_rgb* sum)
{
    const fill_run* run = show->run;
    if (layer == FILL_CLOSED)
    {
        if (show->over)
            return 0.0f;
        *sum = ty_rgb_add(*sum, ty_rgb_scale(run->recipe->outside, share));
        return share;
    }
    const ty_fill_mark* mark = &run->marks[layer];
    float high = tone * mark->opacity, low = (1.0f - tone) * mark->ground_opacity;
    ty_rgb color = layer_color(show, layer, 0, at), ground = layer_color(show, layer, 1, at);
    if (is_opaque(mark))
        color = ty_rgb_lerp(ground, color, tone);
    else
        color = ty_rgb_add(ty_rgb_scale(color, high), ty_rgb_scale(ground, low));
    *sum = ty_rgb_add(*sum, ty_rgb_scale(color, share));
    return share * (high + low);
}

static void pixel_set(const fill_show_state* show, size_t at, ty_rgb sum, float covered)
{
    if (show->over)
        sum = ty_rgb_add(sum, ty_rgb_scale(planes_at(show->over, at), 1.0f - covered));
    const float values[3] = {sum.r, sum.g, sum.b};
    for (int c = 0; c < 3; c++)
        if (show->color[c])
            show->color[c][at] = values[c];
    if (show->alpha)
        show->alpha[at] = covered;
}

// --- stretches of a row ---

// A mark of two colours, alone.
static void plain_paint(const fill_show_state* show, const ty_fill_mark* mark, size_t at, int count, const float* tone)
{
    const float high[3] = {mark->color.r, mark->color.g, mark->color.b};
    const float low[3] = {mark->ground.r, mark->ground.g, mark->ground.b};
    for (int c = 0; c < 3 && show->color[c]; c++)
    {
        float* restrict out = show->color[c] + at;
        for (int i = 0; i < count; i++)
            out[i] = 0.0f + ty_lerp(low[c], high[c], tone[i]);
    }
}

static void stretch_paint(const fill_show_state* show, int layer, size_t at, int count, const float* tone)
{
    bool mark = layer != FILL_CLOSED;
    bool plain = mark && !show->over && !show->alpha && is_opaque(&show->run->marks[layer]);
    if (plain && !show->images[layer][0] && !show->images[layer][1])
        plain_paint(show, &show->run->marks[layer], at, count, tone);
    else
        for (int i = 0; i < count; i++)
        {
            ty_rgb sum = {0.0f, 0.0f, 0.0f};
            float covered = layer_add(show, layer, 1.0f, tone[i], at + (size_t)i, &sum);
            pixel_set(show, at + (size_t)i, sum, covered);
        }
    for (int i = 0; i < count && show->mattes[layer]; i++)
        show->mattes[layer][at + (size_t)i] = 1.0f;
}

static void edge_paint(const fill_show_state* show, int x, int y, const float* tone, const float* coverage)
{
    float matte[FILL_LAYERS], covered = 0.0f;
    ty_rgb sum = {0.0f, 0.0f, 0.0f};
    size_t at = (size_t)y * (size_t)show->width + (size_t)x;
    fill_matte(show, x, y, coverage, matte);
    for (int k = 0; k < FILL_LAYERS; k++)
        if (matte[k] > 0.0f)
            covered += layer_add(show, k, matte[k], tone[x], at, &sum);
    pixel_set(show, at, sum, covered);
    for (int k = 0; k < FILL_LAYERS; k++)
        if (show->mattes[k])
            show->mattes[k][at] = matte[k];
}

// --- rows ---

static void tone_row(const fill_show_state* show, int y, float* restrict out)
{
    const ty_fill_recipe* r = show->run->recipe;
    const float* v = show->v + (size_t)y * (size_t)show->width;
    float low = r->tone[0], range = r->tone[1] - r->tone[0];
    for (int x = 0; x < show->width; x++)
        out[x] = ty_smoothstep(ty_clamp((v[x] - low) / range, 0.0f, 1.0f));
}

// How many pixels from x on have one layer and nothing else; 0: this one has several.
static int stretch(const fill_show_state* show, int x, int y, const float* coverage)
{
    const fill_run* run = show->run;
    size_t row = fill_cell(run, 0, y / run->recipe->scale);
    const uint8_t *mixed = run->mixed + row, *layers = run->layers + row;
    uint8_t layer = layers[show->cell_x[x]];
    bool rules = run->recipe->autos.count > 0;
    int end = x;
    while (end < show->width && !mixed[show->cell_x[end]] && layers[show->cell_x[end]] == layer &&
           !(rules && fill_is_ruled(show, end, y, coverage)))
        end++;
    return end - x;
}

static void numbers_put(const fill_show_state* show, int y)
{
    const fill_run* run = show->run;
    size_t at = (size_t)y * (size_t)show->width;
    for (int x = 0; x < show->width; x++)
    {
        size_t cell = fill_cell(run, show->cell_x[x], y / run->recipe->scale);
        if (show->mark)
            show->mark[at + (size_t)x] = run->layers[cell] == FILL_CLOSED ? -1.0f : (float)run->layers[cell];
        if (show->trail)
            show->trail[at + (size_t)x] = run->trail[cell];
    }
}

static void rows_paint(void* context, int64_t begin, int64_t end, int worker)
{
    const fill_show_state* show = context;
    const fill_run* run = show->run;
    (void)worker;
    float *tone = TY_ALLOC(float, 2 * show->width), *coverage = tone + show->width;
    for (int y = (int)begin; y < (int)end; y++)
    {
        size_t row = fill_cell(run, 0, y / run->recipe->scale);
        if (run->recipe->sharp)
            fill_coverage_row(show, y, tone);
        else
            tone_row(show, y, tone);
        if (show->rules_cover)
            fill_coverage_row(show, y, coverage);
        for (int x = 0, count; x < show->width; x += count)
        {
            count = stretch(show, x, y, coverage);
            if (count > 0)
                stretch_paint(show, run->layers[row + (size_t)show->cell_x[x]],
                              (size_t)y * (size_t)show->width + (size_t)x, count, tone + x);
            else
            {
                edge_paint(show, x, y, tone, coverage);
                count = 1;
            }
        }
        if (show->mark || show->trail)
            numbers_put(show, y);
    }
    ty_free(tone);
}

bool fill_paint(fill_show_state* show)
{
    return ty_parallel_for(show->run->workers, show->height, 16, rows_paint, show);
}
