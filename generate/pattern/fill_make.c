// SPDX-License-Identifier: Apache-2.0
// Drops, time, frames: the states that a loop shows are visited in the order of time, so that none is kept.
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/generate/fill_recipe.h>
#include <tsuya/image/color.h>

enum
{
    CHUNK_STEPS = 50,   // between looks at the cancel flag
    MOST_PIXELS = 32768 // of a side: what is read back as an image
};

typedef struct moment
{
    int step;    // of the field
    int frame;   // from 1
    float drift; // cells
} moment;

typedef struct picture
{
    const ty_fill_recipe* recipe;
    ty_gray_scott* field;
    float drift;
    float* channels[3]; // of the frame; only the first for Y, the others NULL
} picture;

typedef struct run
{
    const ty_fill_recipe* recipe;
    ty_gray_scott* field;
    ty_workers* workers;
    moment* moments; // in the order of time
    int step;
    ty_progress progress;
} run;

// --- the field ---

// Values of a lattice that wraps, blended by cubics: -1..1, smooth.
static float noise(const float* lattice, int nx, int ny, float x, float y)
{
    int i = (int)floorf(x), j = (int)floorf(y);
    float fx = ty_smoothstep(x - (float)i), fy = ty_smoothstep(y - (float)j);
    const float *row = lattice + (j % ny) * nx, *next = lattice + ((j + 1) % ny) * nx;
    int a = i % nx, b = (i + 1) % nx;
    return ty_lerp(ty_lerp(row[a], row[b], fx), ty_lerp(next[a], next[b], fx), fy);
}

static ty_status feed_vary(const ty_fill_recipe* recipe, ty_gray_scott* field, ty_error* error)
{
    int w = recipe->cells[0], h = recipe->cells[1];
    int nx = (int)ty_max(1.0f, floorf((float)w / recipe->variation_size + 0.5f));
    int ny = (int)ty_max(1.0f, floorf((float)h / recipe->variation_size + 0.5f));
    float* feed = TY_TRY_ALLOC(float, (size_t)w*(size_t)h);
    if (!feed)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %d x %d cells", w, h);
    float* lattice = TY_ALLOC(float, nx* ny);
    ty_rng rng = ty_rng_make(recipe->seed, 0x66656564, 0);
    for (int i = 0; i < nx * ny; i++)
        lattice[i] = ty_rng_range(&rng, -1.0f, 1.0f);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
        {
            float n = noise(lattice, nx, ny, (float)(x * nx) / (float)w, (float)(y * ny) / (float)h);
            feed[(size_t)y * (size_t)w + (size_t)x] = recipe->field.rates[0].feed * recipe->variation * n;
        }
    ty_status status = ty_gray_scott_vary(field, feed, NULL, error);
    ty_free(lattice);
    ty_free(feed);
    return status;
}

static void drops_fall(const ty_fill_recipe* recipe, ty_gray_scott* field)
{
    float w = (float)recipe->cells[0], h = (float)recipe->cells[1];
    ty_rng place = ty_rng_make(recipe->seed, 0x64726f70, 0);
    for (int i = 0; i < recipe->drops.count; i++)
    {
        ty_rng rng = ty_rng_make(recipe->seed, 0x64726f70, 1 + (uint64_t)i);
        float x = ty_rng_range(&place, 0.0f, w);
        float up = ty_lerp(recipe->drops.area[0], recipe->drops.area[1], ty_rng_float(&place));
        ty_gray_scott_drop(field, x, (1.0f - up) * (h - 1.0f), recipe->drops.radius, &rng);
    }
}

static ty_status field_make(const ty_fill_recipe* recipe, ty_gray_scott** out, ty_error* error)
{
    ty_gray_scott_def def = recipe->field;
    def.width = recipe->cells[0];
    def.height = recipe->cells[1];
    def.wrap_x = true;
    def.wrap_y = recipe->tile == TY_PATTERN_TILE_BOTH;
    ty_status status = ty_gray_scott_create(&def, out, error);
    if (status != TY_OK)
        return status;
    if (recipe->variation > 0.0f)
        status = feed_vary(recipe, *out, error);
    if (status == TY_OK)
        drops_fall(recipe, *out);
    return status;
}

// --- when ---

// sin(2 pi i / n) for whole i from its first quarter, so that equal angles give equal bits.
static float turn_sin(int64_t i, int64_t n)
{
    i = (i % n + n) % n;
    if (2 * i > n)
        return -turn_sin(n - i, n);
    if (4 * i > n)
        i = n - 2 * i; // of 2 n: pi - angle
    else
        i = 2 * i;
    return ty_sin(TY_PI * (float)((double)i / (double)n));
}

static int moment_order(const void* a, const void* b)
{
    const moment *p = a, *q = b;
    return p->step != q->step ? (p->step > q->step) - (p->step < q->step) : p->frame - q->frame;
}

static moment* moments_plan(const ty_fill_recipe* recipe)
{
    int n = recipe->loop.frames;
    moment* moments = TY_TRY_ALLOC(moment, n);
    for (int i = 0; moments && i < n; i++)
    {
        float sine = turn_sin(i, n), cosine = turn_sin(4 * (int64_t)i + n, 4 * (int64_t)n);
        int step = recipe->steps + (int)floorf((float)recipe->loop.span * sine + 0.5f);
        moments[i] = (moment){step > 0 ? step : 0, i + 1, recipe->loop.drift * cosine};
    }
    if (moments)
        qsort(moments, (size_t)n, sizeof *moments, moment_order);
    return moments;
}

// --- what a frame shows ---

// The cubic through the four neighbours (Catmull & Rom 1974) at t past the second.
static void cubic_weights(float t, float w[4])
{
    w[0] = 0.5f * t * (t * (2.0f - t) - 1.0f);
    w[1] = 0.5f * (t * t * (3.0f * t - 5.0f) + 2.0f);
    w[2] = 0.5f * t * (t * (4.0f - 3.0f * t) + 1.0f);
    w[3] = 0.5f * t * t * (t - 1.0f);
}

static int wrap_or_clamp(int i, int n, bool wrap)
{
    if (wrap)
        return (i % n + n) % n;
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

// The field's line through the middle of row y of the frame.
static void line_blend(const picture* p, int y, float* line)
{
    int w = p->recipe->cells[0], h = p->recipe->cells[1];
    bool wraps = p->recipe->tile == TY_PATTERN_TILE_BOTH;
    float at = ((float)y + 0.5f) / (float)p->recipe->scale - 0.5f, whole = floorf(at), weight[4];
    cubic_weights(at - whole, weight);
    memset(line, 0, (size_t)w * sizeof *line);
    for (int k = 0; k < 4; k++)
    {
        const float* row = ty_gray_scott_v(p->field, wrap_or_clamp((int)whole - 1 + k, h, wraps));
        for (int x = 0; x < w; x++)
            line[x] += weight[k] * row[x];
    }
}

static void pixel_set(const picture* p, size_t at, float v)
{
    const ty_fill_recipe* r = p->recipe;
    float t = ty_smoothstep(ty_clamp((v - r->tone[0]) / (r->tone[1] - r->tone[0]), 0.0f, 1.0f));
    ty_rgb color = ty_rgb_lerp(r->low, r->high, t);
    const float values[3] = {color.r, color.g, color.b};
    for (int c = 0; c < 3; c++)
        if (p->channels[c])
            p->channels[c][at] = values[c];
}

static void rows_paint(void* context, int64_t begin, int64_t end, int worker)
{
    const picture* p = context;
    (void)worker;
    int w = p->recipe->cells[0], width = w * p->recipe->scale;
    float* line = TY_ALLOC(float, w);
    for (int y = (int)begin; y < (int)end; y++)
    {
        line_blend(p, y, line);
        for (int x = 0; x < width; x++)
        {
            float at = ((float)x + 0.5f) / (float)p->recipe->scale - 0.5f + p->drift, whole = floorf(at), weight[4];
            float v = 0.0f;
            cubic_weights(at - whole, weight);
            for (int k = 0; k < 4; k++)
                v += weight[k] * line[wrap_or_clamp((int)whole - 1 + k, w, true)];
            pixel_set(p, (size_t)y * (size_t)width + (size_t)x, v);
        }
    }
    ty_free(line);
}

static bool is_grey(ty_rgb c)
{
    return c.r == c.g && c.g == c.b;
}

static ty_status frame_put(run* r, const moment* m, const ty_frame_sink* sink, ty_error* error)
{
    static const char* const names[] = {"R", "G", "B"};
    static const float ap1[8] = TY_ACESCG_CHROMATICITIES;
    const ty_fill_recipe* recipe = r->recipe;
    int window[4] = {0, 0, recipe->cells[0] * recipe->scale - 1, recipe->cells[1] * recipe->scale - 1};
    ty_exr* image = ty_exr_create(window, window);
    picture p = {.recipe = recipe, .field = r->field, .drift = m->drift};
    bool grey = is_grey(recipe->low) && is_grey(recipe->high);
    for (int c = 0; c < (grey ? 1 : 3); c++)
        p.channels[c] = ty_exr_add_channel(image, grey ? "Y" : names[c], TY_EXR_HALF);
    if (!grey)
        ty_exr_add_chromaticities(image, ap1);
    ty_status status = TY_OK;
    if (!ty_parallel_for(r->workers, window[3] + 1, 16, rows_paint, &p))
        status = ty_error_set(error, TY_INTERRUPTED, "interrupted while a frame was made");
    if (status == TY_OK)
        status = sink->put(sink->context, m->frame, image, error);
    ty_exr_destroy(image);
    return status;
}

// --- all of it ---

static ty_status recipe_check(const ty_fill_recipe* r, ty_error* error)
{
    if (r->loop.span > r->steps)
        return ty_error_set(error, TY_BAD_INPUT, "loop.span: %d; before step 0 there is nothing: at most %d",
                            r->loop.span, r->steps);
    if (!(r->tone[1] > r->tone[0]))
        return ty_error_set(error, TY_BAD_INPUT, "tone: [%g, %g]; the second lies above the first", (double)r->tone[0],
                            (double)r->tone[1]);
    for (int i = 0; i < 2; i++)
        if ((int64_t)r->cells[i] * r->scale > MOST_PIXELS)
            return ty_error_set(error, TY_BAD_INPUT, "scale: %d; %d cells become more than %d pixels", r->scale,
                                r->cells[i], MOST_PIXELS);
    if (r->loop.frames < 1)
        return ty_error_set(error, TY_BAD_INPUT, "loop.frames: %d; a loop has at least 1", r->loop.frames);
    return TY_OK;
}

static ty_status advance(run* r, int step, ty_error* error)
{
    int last = r->moments[r->recipe->loop.frames - 1].step;
    while (r->step < step)
    {
        int steps = step - r->step < CHUNK_STEPS ? step - r->step : CHUNK_STEPS;
        ty_gray_scott_step(r->field, steps, r->workers);
        if (ty_cancel_requested())
            return ty_error_set(error, TY_INTERRUPTED, "interrupted at step %d of %d", r->step, last);
        r->step += steps;
        ty_progress_update(&r->progress, (double)r->step / last, NULL);
    }
    return TY_OK;
}

static ty_status run_frames(run* r, const ty_frame_sink* sink, ty_error* error)
{
    ty_status status = TY_OK;
    ty_progress_begin(&r->progress, "fill");
    for (int i = 0; i < r->recipe->loop.frames && status == TY_OK; i++)
    {
        status = advance(r, r->moments[i].step, error);
        if (status == TY_OK)
            status = frame_put(r, &r->moments[i], sink, error);
    }
    ty_progress_end(&r->progress);
    return status;
}

ty_status ty_fill_make(const void* def, ty_workers* workers, const ty_frame_sink* sink, ty_error* error)
{
    run r = {.recipe = def, .workers = workers};
    ty_status status = recipe_check(def, error);
    if (status == TY_OK)
        status = field_make(def, &r.field, error);
    if (status != TY_OK)
    {
        ty_gray_scott_destroy(r.field);
        return status;
    }
    r.moments = moments_plan(def);
    status = r.moments ? run_frames(&r, sink, error)
                       : ty_error_set(error, TY_NO_MEMORY, "no memory for %d frames", r.recipe->loop.frames);
    ty_free(r.moments);
    ty_gray_scott_destroy(r.field);
    return status;
}
