// SPDX-License-Identifier: Apache-2.0
// A fill from its beginning to its last frame: a run goes frame by frame with its events; the states that a loop shows
// are visited in the order of time. None is kept but the last, to go on from.
#include "fill_run.h"
#include "fill_tables.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

enum
{
    CHUNK_STEPS = 50 // between looks at the cancel flag
};

typedef struct moment
{
    int step;    // of the field
    int frame;   // from 1
    float drift; // cells
} moment;

typedef struct making
{
    fill_run run;
    const ty_frame_sink* sink;
    int step, last_step;
    ty_progress progress;
    ty_exr* state; // of the last frame that was put; NULL when nobody keeps it
} making;

static ty_status advance(making* m, int step, ty_error* error)
{
    while (m->step < step)
    {
        int steps = step - m->step < CHUNK_STEPS ? step - m->step : CHUNK_STEPS;
        ty_gray_scott_step(m->run.field, steps, m->run.workers);
        if (ty_cancel_requested())
            return ty_error_set(error, TY_INTERRUPTED, "interrupted at step %d of %d", m->step, m->last_step);
        m->step += steps;
        ty_progress_update(&m->progress, (double)m->step / m->last_step, NULL);
    }
    return TY_OK;
}

static ty_status frame_put(making* m, int frame, float drift, ty_error* error)
{
    ty_exr* image;
    ty_status status = fill_show(&m->run, frame, drift, &image, error);
    if (status == TY_OK)
        status = m->sink->put(m->sink->context, frame, image, error);
    ty_exr_destroy(image);
    return status;
}

// --- a loop ---

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

static ty_status loop_make(making* m, ty_error* error)
{
    const ty_fill_recipe* r = m->run.recipe;
    ty_status status = fill_frame_events(&m->run, 1, error); // the region
    moment* moments = moments_plan(r);
    if (!moments)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %d frames", r->loop.frames);
    m->last_step = moments[r->loop.frames - 1].step;
    for (int i = 0; i < r->loop.frames && status == TY_OK; i++)
    {
        status = advance(m, moments[i].step, error);
        fill_take_v(&m->run);
        fill_distance(&m->run);
        if (status == TY_OK)
            status = frame_put(m, moments[i].frame, moments[i].drift, error);
    }
    ty_free(moments);
    return status;
}

// --- a run ---

static int step_of(const fill_run* run, int frame)
{
    return run->recipe->run.before + (int)floor((frame - 1) * run->steps + 0.5);
}

// Frames when v was first above the threshold; between two frames by its way from one to the other.
static void trail_note(const fill_run* run, int frame, bool moved)
{
    float threshold = run->trail_threshold;
    for (int y = 0; run->trail && y < run->height; y++)
    {
        const float* v = ty_gray_scott_v(run->field, y);
        for (int x = 0; x < run->width; x++)
        {
            size_t at = fill_cell(run, x, y);
            float before = run->before[at], way = v[x] - before;
            bool on_the_way = moved && before < threshold && way > 0.0f;
            if (run->trail[at] < 0.0f && v[x] >= threshold && !run->closed[at])
                run->trail[at] = on_the_way ? (float)(frame - 1) + (threshold - before) / way : (float)frame;
            run->before[at] = v[x];
        }
    }
}

static void state_keep(making* m, int frame)
{
    if (!m->sink->keep)
        return;
    ty_exr_destroy(m->state);
    m->state = fill_state_save(&m->run, frame);
}

static ty_status frame_make(making* m, int frame, ty_error* error)
{
    ty_status status = advance(m, step_of(&m->run, frame), error);
    if (status != TY_OK)
        return status;
    if (frame > 1)
        trail_note(&m->run, frame, true);
    status = fill_frame_events(&m->run, frame, error);
    if (status != TY_OK)
        return status;
    trail_note(&m->run, frame, false);
    fill_take_v(&m->run);
    fill_distance(&m->run);
    status = fill_auto_mark(&m->run, error);
    if (status == TY_OK)
        status = frame_put(m, frame, 0.0f, error);
    if (status == TY_OK)
        state_keep(m, frame);
    return status;
}

static ty_status run_make(making* m, const ty_bytes* state, ty_error* error)
{
    int frames = m->run.recipe->run.frames, first = 0;
    ty_status status = state ? fill_state_load(&m->run, state, &first, error) : TY_OK, kept = TY_OK;
    ty_error keep_error;
    if (status != TY_OK)
        return status;
    m->step = first > 0 ? step_of(&m->run, first) : 0;
    m->last_step = step_of(&m->run, frames) > 0 ? step_of(&m->run, frames) : 1;
    for (int frame = first + 1; frame <= frames && status == TY_OK; frame++)
        status = frame_make(m, frame, error);
    if (m->state)
        kept = m->sink->keep(m->sink->context, m->state, &keep_error);
    if (kept != TY_OK && error)
        *error = keep_error;
    return kept != TY_OK ? kept : status;
}

ty_status ty_fill_size(const ty_fill_recipe* recipe, int size[2], ty_error* error)
{
    fill_run run = {.quiet = true};
    ty_status status = fill_run_init(&run, recipe, NULL, error);
    size[0] = run.width * recipe->scale;
    size[1] = run.height * recipe->scale;
    fill_run_term(&run);
    return status;
}

ty_status ty_fill_make(const void* def, ty_workers* workers, const ty_frame_sink* sink, ty_error* error)
{
    return ty_fill_make_from(def, workers, sink, NULL, error);
}

ty_status ty_fill_make_from(const void* def, ty_workers* workers, const ty_frame_sink* sink, const ty_bytes* state,
                            ty_error* error)
{
    making m = {.sink = sink};
    const ty_fill_recipe* recipe = def;
    ty_status status = TY_OK;
    if (state && recipe->run.frames < 1)
        status = ty_error_set(error, TY_BAD_INPUT, "run.frames: 0; a loop does not go on from a state");
    if (status == TY_OK)
        status = fill_run_init(&m.run, recipe, workers, error);
    if (status == TY_OK)
    {
        ty_progress_begin(&m.progress, "fill");
        status = recipe->run.frames > 0 ? run_make(&m, state, error) : loop_make(&m, error);
        ty_progress_end(&m.progress);
    }
    ty_exr_destroy(m.state);
    fill_run_term(&m.run);
    return status;
}

// --- the generator ---

static int channels(const void* def, ty_frame_channel out[TY_FRAME_CHANNELS])
{
    static const char* const planes[] = {"u", "v", "mark", "trail", "distance"};
    const ty_fill_recipe* recipe = def;
    const ty_fill_mark* marks = recipe->marks.items;
    int count = 0;
    for (; count < (int)(sizeof planes / sizeof *planes); count++)
    {
        snprintf(out[count].name, sizeof out->name, "%s", planes[count]);
        out[count].output = planes[count];
    }
    for (int i = 0; i < TY_GRAY_SCOTT_MARKS && (i == 0 || i < recipe->marks.count); i++)
        fill_matte_name(recipe->marks.count > 0 ? marks[i].name : NULL, i, out[count++].name);
    if (fill_has_closed_cells(recipe))
        fill_matte_name("closed", 0, out[count++].name);
    for (int i = (int)(sizeof planes / sizeof *planes); i < count; i++)
        out[i].output = "mattes";
    return count;
}

static int frame_count(const void* def)
{
    const ty_fill_recipe* recipe = def;
    return recipe->run.frames > 0 ? recipe->run.frames : recipe->loop.frames;
}

static ty_status make(const void* def, ty_workers* workers, ty_made* out, ty_error* error)
{
    return ty_fill_make_from(def, workers, &out->frames, out->state, error);
}

const ty_generator ty_fill_generator = {
    .kind = "fill",
    .build_id = "fill 3",
    .product = TY_PRODUCT_FRAMES,
    .params = &ty_fill_recipe_table,
    .frame_count = frame_count,
    .channels = channels,
    .make = make,
};
