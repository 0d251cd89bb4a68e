// SPDX-License-Identifier: Apache-2.0
// Slices to pictures: values, edges that cover pixels by shares, colours, moments of an open shutter.
#include "loop_frame.h"
#include "pattern_image.h"
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/color.h>

enum
{
    TILE_WIDTH = 128, // pixels that are sampled together, so that what they read stays near
    TILE_HEIGHT = 16,
    SHUTTER = 1000 // parts of a frame's time that a shutter is told in
};

struct ty_loop_painter
{
    const ty_loop_recipe* recipe;
    const ty_loop_volume* volume;
    ty_workers* workers;
    ty_loop_sample_fn* sample;
    int width, height;
    ty_rgb low, high;
    bool clear;                             // what is outside is transparent
    ty_rgb colors[TY_LOOP_COLORS];          // of the palette
    ty_rgb red[256], green[256], blue[256]; // of tints: a colour is the sum of three
    float *values, *coverage;               // [height][width]
    // Of the present moment:
    ty_loop_grid grid;
    float share;        // of the frame
    float* channels[3]; // only the first of Y; none: nobody sees them
    float* alpha;       // NULL = all is opaque
};

// --- colours ---

static ty_rgb rgb_at(const float* p)
{
    return (ty_rgb){p[0], p[1], p[2]};
}

// Codes of 8-bit images to ACEScg.
static ty_status inks_mix(ty_loop_painter* p, ty_error* error)
{
    const ty_loop_palette* palette = &p->volume->palette;
    ty_color* color;
    float all[TY_LOOP_COLORS + 1 + 3 * 256][3] = {{0.0f}}, *tints = all[TY_LOOP_COLORS + 1];
    ty_status status = ty_color_create(NULL, &color, error);
    if (status != TY_OK)
        return status;
    for (int k = 0; k < 3; k++)
    {
        for (int i = 0; i < palette->count; i++)
            all[i][k] = (float)palette->colors[i][k] / 255.0f;
        all[TY_LOOP_COLORS][k] = (float)palette->background[k] / 255.0f;
        for (int i = 0; i < 256; i++)
            tints[3 * (k * 256 + i) + k] = (float)i / 255.0f;
    }
    status = ty_color_convert(color, "srgb_texture", "ACEScg", all[0], TY_LOOP_COLORS + 1 + 3 * 256, 3, error);
    ty_color_destroy(color);
    for (int i = 0; i < TY_LOOP_COLORS; i++)
        p->colors[i] = rgb_at(all[i]);
    p->low = rgb_at(all[TY_LOOP_COLORS]);
    for (int i = 0; i < 256; i++)
    {
        p->red[i] = rgb_at(tints + 3 * i);
        p->green[i] = rgb_at(tints + 3 * (256 + i));
        p->blue[i] = rgb_at(tints + 3 * (512 + i));
    }
    return status;
}

static ty_rgb color_at(const ty_loop_painter* p, int x, int y)
{
    ty_loop_corners corners = ty_loop_corners_of(p->volume, &p->grid, p->recipe->sampling, x, y);
    if (p->volume->labels)
        return p->colors[ty_loop_label_of(p->volume, &corners)];
    uint8_t c[3] = {0, 0, 0};
    ty_loop_tint_of(p->volume, &corners, c);
    return ty_rgb_add(p->red[c[0]], ty_rgb_add(p->green[c[1]], p->blue[c[2]]));
}

// --- values ---

static void tiles_sample(void* context, int64_t begin, int64_t end, int worker)
{
    const ty_loop_painter* p = context;
    (void)worker;
    int columns = (p->width + TILE_WIDTH - 1) / TILE_WIDTH;
    for (int64_t tile = begin; tile < end; tile++)
    {
        int x = (int)(tile % columns) * TILE_WIDTH, y = (int)(tile / columns) * TILE_HEIGHT;
        int right = x + TILE_WIDTH < p->width ? x + TILE_WIDTH : p->width;
        int bottom = y + TILE_HEIGHT < p->height ? y + TILE_HEIGHT : p->height;
        for (int j = y; j < bottom; j++)
            p->sample(p->volume, &p->grid, p->recipe->sampling, j, x, right,
                      p->values + (size_t)j * (size_t)p->width + (size_t)x);
    }
}

ty_status ty_loop_painter_slice(ty_loop_painter* p, int64_t i, int64_t n, const float** out, ty_error* error)
{
    p->grid = ty_loop_motion_grid(p->recipe, p->volume->size, i, n);
    int columns = (p->width + TILE_WIDTH - 1) / TILE_WIDTH, rows = (p->height + TILE_HEIGHT - 1) / TILE_HEIGHT;
    if (!ty_parallel_for(p->workers, (int64_t)columns * rows, 4, tiles_sample, p))
        return ty_error_set(error, TY_INTERRUPTED, "interrupted while a frame was made");
    *out = p->values;
    return TY_OK;
}

// --- edges ---

// How much of a pixel is inside: by the distance to the edge that value and slope tell, smooth over one pixel.
static inline float cover(float left, float v, float right, float up, float down, float iso)
{
    float gx = 0.5f * (right - left), gy = 0.5f * (down - up);
    float slope = ty_max(sqrtf(gx * gx + gy * gy), 1e-6f);
    return ty_smoothstep(ty_clamp((v - iso) / slope + 0.5f, 0.0f, 1.0f));
}

static void row_cover(const ty_loop_painter* p, int y, float* restrict out)
{
    int w = p->width;
    const float* v = p->values + (size_t)y * (size_t)w;
    const float* up = y > 0 ? v - w : v;
    const float* down = y < p->height - 1 ? v + w : v;
    const float iso = p->recipe->iso;
    if (p->recipe->show_values || p->recipe->sampling == TY_LOOP_NEAREST)
    {
        bool values = p->recipe->show_values;
        for (int x = 0; x < w; x++)
            out[x] = values ? v[x] : v[x] >= iso ? 1.0f : 0.0f;
        return;
    }
    for (int x = 0; x<w; x += w> 1 ? w - 1 : 1) // the ends, which have one neighbour
        out[x] = cover(v[x > 0 ? x - 1 : x], v[x], v[x < w - 1 ? x + 1 : x], up[x], down[x], iso);
    for (int x = 1; x < w - 1; x++)
        out[x] = cover(v[x - 1], v[x], v[x + 1], up[x], down[x], iso);
}

// low where share is 0, high where it is 1, exactly.
static inline float between(float low, float high, float share)
{
    return (1.0f - share) * low + share * high;
}

static void row_paint(const ty_loop_painter* p, int y, const float* restrict covers)
{
    const float low[3] = {p->low.r, p->low.g, p->low.b}, high[3] = {p->high.r, p->high.g, p->high.b};
    size_t first = (size_t)y * (size_t)p->width;
    for (int k = 0; k < 3; k++)
    {
        float* restrict out = p->channels[k] ? p->channels[k] + first : NULL;
        for (int x = 0; out && x < p->width; x++)
            out[x] += p->share * between(low[k], high[k], covers[x]);
    }
}

static void row_paint_colors(const ty_loop_painter* p, int y, const float* covers)
{
    size_t at = (size_t)y * (size_t)p->width;
    for (int x = 0; x < p->width; x++, at++)
    {
        ty_rgb color = covers[x] > 0.0f ? color_at(p, x, y) : p->low;
        p->channels[0][at] += p->share * between(p->low.r, color.r, covers[x]);
        p->channels[1][at] += p->share * between(p->low.g, color.g, covers[x]);
        p->channels[2][at] += p->share * between(p->low.b, color.b, covers[x]);
    }
}

static void rows_paint(void* context, int64_t begin, int64_t end, int worker)
{
    const ty_loop_painter* p = context;
    (void)worker;
    float* covers = TY_ALLOC(float, p->width);
    for (int y = (int)begin; y < (int)end; y++)
    {
        float* coverage = p->coverage + (size_t)y * (size_t)p->width;
        row_cover(p, y, covers);
        for (int x = 0; x < p->width; x++)
            coverage[x] += p->share * covers[x];
        if (!p->channels[0])
            continue;
        if (p->alpha)
            memcpy(p->alpha + (size_t)y * (size_t)p->width, coverage, (size_t)p->width * sizeof *coverage);
        if (p->volume->labels || p->volume->tints)
            row_paint_colors(p, y, covers);
        else
            row_paint(p, y, covers);
    }
    ty_free(covers);
}

// --- frames ---

ty_status ty_loop_painter_create(const ty_loop_recipe* recipe, const ty_loop_volume* volume, ty_workers* workers,
                                 ty_loop_painter** out, ty_error* error)
{
    *out = NULL;
    ty_loop_painter* p = TY_ALLOC(ty_loop_painter, 1);
    *p = (ty_loop_painter){.recipe = recipe,
                           .volume = volume,
                           .workers = workers,
                           .sample = ty_loop_sampler(),
                           .width = recipe->size[0],
                           .height = recipe->size[1],
                           .low = recipe->low,
                           .high = recipe->high};
    size_t pixels = (size_t)p->width * (size_t)p->height;
    p->values = TY_TRY_ALLOC(float, pixels);
    p->coverage = TY_TRY_ALLOC(float, pixels);
    ty_status status = TY_OK;
    if (!p->values || !p->coverage)
        status = ty_error_set(error, TY_NO_MEMORY, "no memory for %d x %d pixels", p->width, p->height);
    if (status == TY_OK && (volume->labels || volume->tints))
        status = inks_mix(p, error);
    p->clear = recipe->clear || volume->palette.clear;
    if (p->clear)
        p->low = (ty_rgb){0.0f, 0.0f, 0.0f};
    if (status == TY_OK)
        *out = p;
    else
        ty_loop_painter_destroy(p);
    return status;
}

void ty_loop_painter_destroy(ty_loop_painter* painter)
{
    if (!painter)
        return;
    ty_free(painter->values);
    ty_free(painter->coverage);
    ty_free(painter);
}

const float* ty_loop_painter_coverage(const ty_loop_painter* painter)
{
    return painter->coverage;
}

static ty_exr* image_make(ty_loop_painter* p)
{
    bool grey = !p->volume->labels && !p->volume->tints && pattern_is_grey(p->low) && pattern_is_grey(p->high);
    ty_exr* image = pattern_image_create(p->width, p->height, grey, p->channels);
    p->alpha = p->clear ? ty_exr_add_channel(image, "A", TY_EXR_HALF) : NULL;
    return image;
}

// The moments of frame i, into coverage and channels.
static ty_status moments_add(ty_loop_painter* p, int i, ty_error* error)
{
    const ty_loop_recipe* recipe = p->recipe;
    int open = (int)(recipe->blur * (float)SHUTTER + 0.5f), moments = open > 0 ? recipe->blur_samples : 1;
    int64_t parts = (int64_t)moments * SHUTTER, n = parts * recipe->frames;
    ty_status status = TY_OK;
    memset(p->coverage, 0, (size_t)p->width * (size_t)p->height * sizeof *p->coverage);
    p->share = 1.0f / (float)moments;
    for (int m = 0; m < moments && status == TY_OK; m++)
    {
        const float* values;
        status = ty_loop_painter_slice(p, parts * i + (int64_t)open * m, n, &values, error);
        if (status == TY_OK && !ty_parallel_for(p->workers, p->height, 16, rows_paint, p))
            status = ty_error_set(error, TY_INTERRUPTED, "interrupted while a frame was made");
    }
    return status;
}

ty_status ty_loop_painter_paint(ty_loop_painter* p, int i, ty_exr** out, ty_error* error)
{
    ty_exr* image = image_make(p);
    ty_status status = moments_add(p, i, error);
    if (status != TY_OK)
        ty_exr_destroy(image);
    *out = status == TY_OK ? image : NULL;
    return status;
}

ty_status ty_loop_painter_cover(ty_loop_painter* p, int i, ty_error* error)
{
    memset(p->channels, 0, sizeof p->channels);
    return moments_add(p, i, error);
}
