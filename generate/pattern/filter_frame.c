// SPDX-License-Identifier: Apache-2.0
// What a frame of a Turing filter shows: U against a threshold, calibrated by the tones that the cells were to have.
#include "cubic.h"
#include "filter_run.h"
#include "pattern_image.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/memory.h>

enum
{
    TONES = 32,
    LEVELS = 512,
    ENOUGH = 4096, // cells that tell a threshold
    CORRECTIONS = 6
};

// --- thresholds ---

typedef struct calibration
{
    float low, high;    // of U where the pattern lives
    float above[TONES]; // the threshold at the middle of each tone
    uint32_t cells[TONES][LEVELS];
} calibration;

static bool lives(const ty_filter_run* run, size_t i)
{
    return !run->alive || run->alive[i] >= 0.5f;
}

static int slot(float x, int count)
{
    int i = (int)(x * (float)count);
    return i < 0 ? 0 : i >= count ? count - 1 : i;
}

static void cells_count(const ty_filter_run* run, const float* tone, const float* u, calibration* c)
{
    size_t size = (size_t)run->width * (size_t)run->height;
    c->low = INFINITY;
    c->high = -INFINITY;
    for (size_t i = 0; i < size; i++)
        if (lives(run, i))
        {
            c->low = ty_min(c->low, u[i]);
            c->high = ty_max(c->high, u[i]);
        }
    float step = c->high > c->low ? 1.0f / (c->high - c->low) : 0.0f;
    for (size_t i = 0; i < size; i++)
        if (lives(run, i))
            c->cells[slot(tone[i], TONES)][slot((u[i] - c->low) * step, LEVELS)]++;
}

// Counts at a level of the tones up to `reach` from this one, the nearer the more.
static uint64_t pooled(const calibration* c, int tone, int reach, int level)
{
    uint64_t sum = 0;
    for (int t = tone - reach; t <= tone + reach; t++)
        if (t >= 0 && t < TONES)
            sum += (uint64_t)(reach + 1 - abs(t - tone)) * c->cells[t][level];
    return sum;
}

static uint64_t pooled_all(const calibration* c, int tone, int reach)
{
    uint64_t sum = 0;
    for (int level = 0; level < LEVELS; level++)
        sum += pooled(c, tone, reach, level);
    return sum;
}

// The U that the tone's share of cells lies above.
static float quantile(const calibration* c, int tone)
{
    int reach = 0;
    uint64_t all = pooled_all(c, tone, reach);
    while (all < (uint64_t)ENOUGH * (uint64_t)(reach + 1) && reach < TONES)
        all = pooled_all(c, tone, ++reach);
    double share = ((double)tone + 0.5) / TONES, below = (1.0 - share) * (double)all, sum = 0.0;
    for (int level = 0; level < LEVELS; level++)
    {
        double here = (double)pooled(c, tone, reach, level);
        if (sum + here >= below && here > 0.0)
            return ty_lerp(c->low, c->high, (float)((level + (below - sum) / here) / LEVELS));
        sum += here;
    }
    return c->high;
}

static float threshold_at(const calibration* c, float tone, float softness)
{
    float at = tone * TONES - 0.5f, first = c->high + softness, last = c->low - softness;
    int i = (int)floorf(at);
    float f = at - (float)i;
    if (i < 0)
        return ty_lerp(first, c->above[0], 2.0f * f - 1.0f);
    if (i >= TONES - 1)
        return ty_lerp(c->above[TONES - 1], last, ty_min(2.0f * f, 1.0f));
    return ty_lerp(c->above[i], c->above[i + 1], f);
}

// 0 = low, 1 = high, by how far U is over its threshold.
static float level_of(const ty_filter_recipe* r, float over)
{
    return ty_smoothstep(ty_clamp(0.5f + 0.5f * over / r->softness, 0.0f, 1.0f));
}

// Where the pattern of a place is brighter than its tones, thresholds rise there, and the other way.
static void correct_places(const ty_filter_run* run, const float* tone, float* over, float* scratch)
{
    const float gain = 3.0f, sigma = 4.0f * sqrtf(2.0f * ty_filter_turing_def(run->recipe).v.diffusion); // 0.4 spots
    size_t size = (size_t)run->width * (size_t)run->height;
    float* lack = scratch + size;
    for (int pass = 0; pass < CORRECTIONS; pass++)
    {
        for (size_t i = 0; i < size; i++)
            lack[i] = lives(run, i) ? tone[i] - level_of(run->recipe, over[i]) : 0.0f;
        ty_filter_blur(lack, scratch, run->width, run->height, sigma, run->workers);
        for (size_t i = 0; i < size; i++)
            over[i] += gain * lack[i];
    }
}

// Each tone's thresholds give its share of bright cells. Grain of the picture would move them from frame to frame: they
// follow its blurred tones.
static ty_status calibrate(const ty_filter_run* run, int field, float* u, ty_error* error)
{
    const ty_filter_recipe* r = run->recipe;
    size_t size = (size_t)run->width * (size_t)run->height;
    float* tone = TY_TRY_ALLOC(float, 3 * size);
    calibration* c = TY_TRY_ALLOC(calibration, 1);
    if (tone && c)
    {
        memcpy(tone, run->picture.tone[field], size * sizeof *tone);
        if (r->tone.smoothing > 0.0f)
            ty_filter_blur(tone, tone + size, run->width, run->height, r->tone.smoothing, run->workers);
        cells_count(run, tone, u, c);
        for (int t = 0; t < TONES; t++)
            c->above[t] = quantile(c, t);
        for (size_t i = 0; i < size; i++)
        {
            float threshold = threshold_at(c, tone[i], r->softness);
            u[i] -= run->alive ? ty_lerp(r->threshold, threshold, run->alive[i]) : threshold;
        }
        correct_places(run, tone, u, tone + size);
    }
    ty_free(c);
    ty_free(tone);
    return tone && c ? TY_OK : ty_error_set(error, TY_NO_MEMORY, "no memory for a frame");
}

// U over the threshold of its cell, in place.
static ty_status over_threshold(const ty_filter_run* run, int field, float* u, ty_error* error)
{
    const ty_filter_recipe* r = run->recipe;
    size_t size = (size_t)run->width * (size_t)run->height;
    if (r->mode == TY_FILTER_TONE && r->tone.calibrated)
        return calibrate(run, field, u, error);
    for (size_t i = 0; i < size; i++)
        u[i] -= r->threshold;
    return TY_OK;
}

// --- pixels ---

typedef struct painting
{
    const ty_filter_run* run;
    const float* over[TY_FILTER_FIELDS]; // U over its threshold
    float* pixels;                       // three a pixel: linear Rec. 709, or of grey alone ACEScg
    cubic_axis across, down;
} painting;

static void pixel_set(const ty_filter_run* run, const float level[3], size_t cell, float* out)
{
    const ty_filter_recipe* r = run->recipe;
    ty_rgb grey = ty_rgb_lerp(r->low, r->high, level[0]);
    const float values[3] = {grey.r, grey.g, grey.b};
    float most = ty_max(run->picture.rgb[0][cell], ty_max(run->picture.rgb[1][cell], run->picture.rgb[2][cell]));
    for (int c = 0; c < 3; c++)
        if (r->color == TY_FILTER_GREY)
            out[c] = values[c];
        else if (r->color == TY_FILTER_CHANNELS)
            out[c] = level[c];
        else // the brightest of its hue, so that what is left out is black
            out[c] = most > 0.0f ? level[0] * run->picture.rgb[c][cell] / most : level[0];
}

static void rows_paint(void* context, int64_t begin, int64_t end, int worker)
{
    const painting* p = context;
    const ty_filter_run* run = p->run;
    (void)worker;
    int scale = run->recipe->scale, width = run->width * scale;
    float *line = TY_ALLOC(float, run->width + 2 * CUBIC_PAD), *over = TY_ALLOC(float, TY_FILTER_FIELDS*width);
    for (int y = (int)begin; y < (int)end; y++)
    {
        for (int f = 0; f < run->field_count; f++)
            cubic_row(&p->across, &p->down, p->over[f], y, line, over + (size_t)f * (size_t)width);
        for (int x = 0; x < width; x++)
        {
            float level[TY_FILTER_FIELDS] = {0};
            for (int f = 0; f < run->field_count; f++)
                level[f] = level_of(run->recipe, over[(size_t)f * (size_t)width + (size_t)x] * (float)scale);
            size_t cell = (size_t)(y / scale) * (size_t)run->width + (size_t)(x / scale);
            pixel_set(run, level, cell, p->pixels + 3 * ((size_t)y * (size_t)width + (size_t)x));
        }
    }
    ty_free(line);
    ty_free(over);
}

static bool is_grey(const ty_filter_recipe* r)
{
    return r->color == TY_FILTER_GREY && pattern_is_grey(r->low) && pattern_is_grey(r->high);
}

// --- the frame ---

// U and V of the cells, of each pixel.
static void fields_add(const ty_filter_run* run, ty_exr* frame)
{
    static const char* const names[2][TY_FILTER_FIELDS] = {{"U", "U.G", "U.B"}, {"V", "V.G", "V.B"}};
    int scale = run->recipe->scale, width = run->width * scale;
    for (int k = 0; k < 2 * run->field_count; k++)
    {
        ty_turing* field = run->fields[k / 2];
        float* out = ty_exr_add_channel(frame, names[k % 2][k / 2], TY_EXR_FLOAT);
        for (int y = 0; y < run->height * scale; y++)
        {
            const float* row = k % 2 ? ty_turing_v(field, y / scale) : ty_turing_u(field, y / scale);
            for (int x = 0; x < width; x++)
                out[(size_t)y * (size_t)width + (size_t)x] = row[x / scale];
        }
    }
}

static ty_exr* frame_pack(const ty_filter_run* run, const float* pixels)
{
    int scale = run->recipe->scale, width = run->width * scale, height = run->height * scale;
    float* color[3];
    ty_exr* frame = pattern_image_create(width, height, is_grey(run->recipe), color);
    size_t size = (size_t)width * (size_t)height;
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; color[c] && i < size; i++)
            color[c][i] = pixels[3 * i + (size_t)c];
    if (run->recipe->fields)
        fields_add(run, frame);
    return frame;
}

static ty_status paint(painting* p, ty_exr** out, ty_error* error)
{
    const ty_filter_run* run = p->run;
    int scale = run->recipe->scale, width = run->width * scale, height = run->height * scale;
    ty_status status = TY_OK;
    if (!ty_parallel_for(run->workers, height, 16, rows_paint, p))
        return ty_error_set(error, TY_INTERRUPTED, "interrupted while a frame was made");
    if (run->recipe->color != TY_FILTER_GREY)
        status = ty_color_convert(run->color, "lin_rec709", "ACEScg", p->pixels, width * height, 3, error);
    if (status == TY_OK)
        *out = frame_pack(run, p->pixels);
    return status;
}

ty_status ty_filter_frame(const ty_filter_run* run, ty_exr** out, ty_error* error)
{
    size_t size = (size_t)run->width * (size_t)run->height, scale = (size_t)run->recipe->scale;
    float* over = TY_TRY_ALLOC(float, size*(size_t)run->field_count);
    painting p = {.run = run, .pixels = over ? TY_TRY_ALLOC(float, 3 * size * scale * scale) : NULL};
    bool wraps = run->recipe->edges == TY_TURING_WRAP;
    bool good = p.pixels && cubic_axis_init(&p.across, run->width, run->recipe->scale, 0.0f, wraps) &&
                cubic_axis_init(&p.down, run->height, run->recipe->scale, 0.0f, wraps);
    ty_status status =
        good ? TY_OK : ty_error_set(error, TY_NO_MEMORY, "no memory for a frame of %d x %d", run->width, run->height);
    for (int f = 0; f < run->field_count && status == TY_OK; f++)
    {
        float* plane = over + (size_t)f * size;
        for (int y = 0; y < run->height; y++)
            memcpy(plane + (size_t)y * (size_t)run->width, ty_turing_u(run->fields[f], y),
                   (size_t)run->width * sizeof(float));
        p.over[f] = plane;
        status = over_threshold(run, f, plane, error);
    }
    if (status == TY_OK)
        status = paint(&p, out, error);
    cubic_axis_term(&p.across);
    cubic_axis_term(&p.down);
    ty_free(p.pixels);
    ty_free(over);
    return status;
}

int64_t ty_filter_steps(const ty_filter_run* run, int frame)
{
    const ty_filter_recipe* r = run->recipe;
    bool anew = run->sequence && r->mode != TY_FILTER_TONE;
    double end = (double)r->time + (anew ? 0.0 : (frame - 1) * (double)r->time_per_frame);
    return (int64_t)floor(end / (double)ty_turing_time_step(run->fields[0]) + 0.5);
}
