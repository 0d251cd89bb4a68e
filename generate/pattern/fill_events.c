// SPDX-License-Identifier: Apache-2.0
// What is done to the field at a frame: cells open and close, holes, marks with what starts their patterns.
#include "fill_run.h"
#include <stdio.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

// --- opening and closing ---

static void cell_set(const fill_run* run, size_t at, float u, float v)
{
    int x = (int)(at % (size_t)run->width), y = (int)(at / (size_t)run->width);
    ty_gray_scott_u(run->field, y)[x] = u;
    ty_gray_scott_v(run->field, y)[x] = v;
}

static int cell_mark(const fill_run* run, size_t at)
{
    int x = (int)(at % (size_t)run->width), y = (int)(at / (size_t)run->width);
    return fill_mark_of(ty_gray_scott_marks_seen(run->field, y)[x]);
}

// What cells hold that were closed and are not any more: those with cover 2.
static void opened_set(const fill_run* run)
{
    const ty_fill_region* region = &run->recipe->region;
    size_t cells = fill_cells(run);
    for (size_t i = 0; i < cells; i++)
    {
        bool known = !run->closed[i] && run->cover[i] != 2.0f;
        run->near_x[i] = known ? (float)(i % (size_t)run->width) : NAN;
        run->near_y[i] = known ? (float)(i / (size_t)run->width) : NAN;
    }
    if (region->opened == TY_FILL_OPENED_NEAREST)
        fill_nearest(run);
    for (size_t i = 0; i < cells; i++)
    {
        if (run->cover[i] != 2.0f)
            continue;
        ty_vec2 plain = run->plain[cell_mark(run, i)];
        if (region->opened == TY_FILL_OPENED_PLAIN)
            cell_set(run, i, plain.x, plain.y);
        else if (region->opened == TY_FILL_OPENED_EMPTY || isnan(run->near_x[i]))
            cell_set(run, i, 1.0f, 0.0f);
        else
        {
            int x = ((int)run->near_x[i] + run->width) % run->width;
            int y = ((int)run->near_y[i] + run->height) % run->height;
            cell_set(run, i, ty_gray_scott_u(run->field, y)[x], ty_gray_scott_v(run->field, y)[x]);
        }
    }
}

// cover 1: the bit is set, 0: it is not, between: by chance is the caller's business (0 or 1 come here).
static void closed_change(const fill_run* run, uint8_t bit, bool first)
{
    const ty_fill_region* region = &run->recipe->region;
    bool opens = false;
    for (size_t i = 0; i < fill_cells(run); i++)
    {
        uint8_t was = run->closed[i];
        run->closed[i] = (uint8_t)(run->cover[i] > 0.0f ? was | bit : was & ~bit);
        bool opened = was && !run->closed[i] && !region->keep_closed;
        if (!was && run->closed[i] && !region->keep_closed && !first)
            cell_set(run, i, 1.0f, 0.0f);
        run->cover[i] = opened ? 2.0f : run->cover[i];
        opens = opens || opened;
    }
    if (opens)
        opened_set(run);
}

static ty_status region_update(const fill_run* run, int frame, ty_error* error)
{
    const ty_fill_region* region = &run->recipe->region;
    float* mask;
    if (!run->region.path || (frame > 1 && !ty_path_is_sequence(run->region.path)))
        return TY_OK;
    ty_status status = fill_mask_read(run, &run->region, region->channel, frame, &mask, error);
    if (status != TY_OK)
        return status;
    for (size_t i = 0; i < fill_cells(run); i++)
        run->cover[i] = (mask[i] >= region->threshold) == region->invert ? 1.0f : 0.0f;
    ty_free(mask);
    closed_change(run, FILL_OUTSIDE, frame == 1);
    return TY_OK;
}

// --- spots ---

static void spot_drop(const fill_run* run, const ty_fill_seeding* seeding, float x, float y, ty_rng* rng)
{
    int reach = (int)seeding->radius + 1;
    for (int j = (int)floorf(y) - reach; j <= (int)floorf(y) + reach; j++)
        for (int i = (int)floorf(x) - reach; i <= (int)floorf(x) + reach; i++)
        {
            float u = 0.5f * ty_rng_range(rng, 0.98f, 1.02f), v = 0.25f * ty_rng_range(rng, 0.98f, 1.02f);
            int cx = run->wrap_x ? (i + run->width) % run->width : i;
            int cy = run->wrap_y ? (j + run->height) % run->height : j;
            if (cx < 0 || cx >= run->width || cy < 0 || cy >= run->height ||
                ty_sqr((float)i + 0.5f - x) + ty_sqr((float)j + 0.5f - y) >= ty_sqr(seeding->radius))
                continue;
            if (run->cover[fill_cell(run, cx, cy)] > 0.0f)
                cell_set(run, fill_cell(run, cx, cy), u, v);
        }
}

// One spot at a random place in each square of the spacing, where the cell there is covered. What is not covered stays
// as it is.
static void spots_drop(const fill_run* run, const ty_fill_seeding* seeding)
{
    int nx = (int)ceilf((float)run->width / seeding->spacing), ny = (int)ceilf((float)run->height / seeding->spacing);
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++)
        {
            ty_rng rng = ty_rng_make(seeding->seed, 0x73706f74 + (uint64_t)j, (uint64_t)i);
            float x = ((float)i + ty_rng_float(&rng)) * seeding->spacing;
            float y = ((float)j + ty_rng_float(&rng)) * seeding->spacing;
            if (x < (float)run->width && y < (float)run->height && run->cover[fill_cell(run, (int)x, (int)y)] > 0.0f)
                spot_drop(run, seeding, x, y, &rng);
        }
}

// --- events ---

// Soft edges of what is or is not: by chance, the same for equal cells and events. Sharp ones: by the cell's middle.
static void cover_decide(const fill_run* run, int event)
{
    const ty_fill_event* e = (const ty_fill_event*)run->recipe->events.items + event;
    ty_seed seed = {run->recipe->seed.value};
    for (size_t i = 0; i < fill_cells(run); i++)
        if (run->cover[i] > 0.0f && run->cover[i] < 1.0f)
        {
            ty_rng rng = ty_rng_make(seed, 0x65646765 + (uint64_t)event, (uint64_t)i);
            float threshold = e->feather > 0.0f ? ty_rng_float(&rng) : 0.5f;
            run->cover[i] = threshold < run->cover[i] ? 1.0f : 0.0f;
        }
}

static void state_blend(const fill_run* run, const ty_vec2* state, int mark)
{
    for (int y = 0; y < run->height; y++)
    {
        float *u = ty_gray_scott_u(run->field, y), *v = ty_gray_scott_v(run->field, y);
        const uint8_t* marks = ty_gray_scott_marks_seen(run->field, y);
        for (int x = 0; x < run->width; x++)
        {
            float c = run->cover[fill_cell(run, x, y)];
            ty_vec2 to = state ? *state : run->plain[mark >= 0 ? mark : fill_mark_of(marks[x])];
            if (c == 0.0f)
                continue;
            u[x] = ty_lerp(u[x], to.x, c);
            v[x] = ty_lerp(v[x], to.y, c);
        }
    }
}

// Leaves in cover the cells whose mark was another.
static void mark_set(const fill_run* run, int mark)
{
    for (int y = 0; y < run->height; y++)
    {
        uint8_t* marks = ty_gray_scott_marks(run->field, y);
        for (int x = 0; x < run->width; x++)
        {
            float* c = &run->cover[fill_cell(run, x, y)];
            bool same = fill_mark_of(marks[x]) == mark;
            if (*c > 0.0f)
                marks[x] = (uint8_t)((marks[x] & TY_GRAY_SCOTT_BARRIER) | mark);
            *c = same ? 0.0f : *c;
        }
    }
}

static void barrier_set(const fill_run* run, bool on)
{
    for (size_t i = 0; i < fill_cells(run); i++)
    {
        bool was = run->closed[i] & FILL_BARRIER;
        run->cover[i] = (run->cover[i] > 0.0f) ? (on ? 1.0f : 0.0f) : (was ? 1.0f : 0.0f);
    }
    closed_change(run, FILL_BARRIER, false);
}

static void event_do(const fill_run* run, int index, int mark)
{
    static const ty_vec2 empty = {1.0f, 0.0f};
    const ty_fill_event* e = (const ty_fill_event*)run->recipe->events.items + index;
    const ty_fill_seeding* seeding = &run->marks[mark < 0 ? 0 : mark].seed;
    if (e->op == TY_FILL_HOLE)
        state_blend(run, &empty, mark);
    if (e->op == TY_FILL_FILL)
        state_blend(run, NULL, mark);
    cover_decide(run, index);
    if (e->op == TY_FILL_BARRIER || e->op == TY_FILL_UNBARRIER)
    {
        barrier_set(run, e->op == TY_FILL_BARRIER);
        return;
    }
    if (e->op == TY_FILL_SEED && seeding->spacing > 0.0f)
        spots_drop(run, seeding);
    else if (e->op == TY_FILL_SEED)
    {
        ty_rng rng = ty_rng_make(run->recipe->seed, 0x73656564, (uint64_t)index);
        for (size_t i = 0; i < fill_cells(run); i++)
            if (run->cover[i] > 0.0f)
                cell_set(run, i, 0.5f * ty_rng_range(&rng, 0.98f, 1.02f), 0.25f * ty_rng_range(&rng, 0.98f, 1.02f));
    }
    if (e->op == TY_FILL_UNMARK)
        mark_set(run, 0);
    else if (mark >= 0)
    {
        mark_set(run, mark);
        if (e->op != TY_FILL_SEED && e->op != TY_FILL_FILL && seeding->spacing > 0.0f)
            spots_drop(run, seeding);
    }
}

// The kernel's bytes say what is closed.
static void barriers_tell(const fill_run* run)
{
    for (int y = 0; y < run->height; y++)
    {
        uint8_t* marks = ty_gray_scott_marks(run->field, y);
        for (int x = 0; x < run->width; x++)
            marks[x] =
                (uint8_t)(fill_mark_of(marks[x]) | (run->closed[fill_cell(run, x, y)] ? TY_GRAY_SCOTT_BARRIER : 0));
    }
}

ty_status fill_frame_events(fill_run* run, int frame, ty_error* error)
{
    const ty_fill_event* events = run->recipe->events.items;
    ty_status status = region_update(run, frame, error);
    bool any = run->region.path != NULL;
    for (int i = 0; i < run->recipe->events.count && status == TY_OK; i++)
    {
        const ty_fill_event* e = &events[i];
        if (frame < e->at || frame > fill_event_end(e))
            continue;
        int mark = e->mark ? fill_mark_find(run, e->mark, "events", error) : -1;
        status = fill_shape_cover(run, i, frame, error);
        if (status == TY_OK)
            event_do(run, i, mark);
        any = true;
    }
    if (status != TY_OK || !any)
        return status;
    barriers_tell(run);
    return fill_vary(run, error);
}

// --- checks ---

static ty_status event_check(const fill_run* run, int index, ty_error* error)
{
    const ty_fill_event* e = (const ty_fill_event*)run->recipe->events.items + index;
    char key[FILL_KEY];
    snprintf(key, sizeof key, "events[%d].mark", index);
    int mark = e->mark ? fill_mark_find(run, e->mark, key, error) : -1;
    if (e->mark && mark < 0)
        return TY_BAD_INPUT;
    if (e->op == TY_FILL_MARK && !e->mark)
        return ty_error_set(error, TY_BAD_INPUT, "events[%d].op: mark; which one? give `mark`", index);
    if (e->at > run->recipe->run.frames || e->until > run->recipe->run.frames)
        return ty_error_set(error, TY_BAD_INPUT, "events[%d].%s: %d lies after the run: it has frames 1..%d", index,
                            e->at > run->recipe->run.frames ? "at" : "until",
                            e->at > run->recipe->run.frames ? e->at : e->until, run->recipe->run.frames);
    if (e->until > 0 && e->until < e->at)
        return ty_error_set(error, TY_BAD_INPUT, "events[%d].until: %d lies before `at`, %d", index, e->until, e->at);
    if (e->shape == TY_FILL_IMAGE && !e->image)
        return ty_error_set(error, TY_BAD_INPUT, "events[%d].shape: image; which one? give `image`", index);
    int least = e->shape == TY_FILL_POLYGON ? 3 : e->shape == TY_FILL_BRUSH ? 1 : 0;
    if (e->points.count < least)
        return ty_error_set(error, TY_BAD_INPUT, "events[%d].points: %d; this shape has at least %d", index,
                            e->points.count, least);
    if (e->close > 0 && e->op != TY_FILL_HOLE)
        return ty_error_set(error, TY_BAD_INPUT, "events[%d].close: only a hole closes", index);
    int of = mark < 0 ? 0 : mark;
    if (!run->quiet && e->op == TY_FILL_FILL && run->plain[of].y == 0.0f)
        ty_log(TY_LOG_WARNING,
               "events[%d]: fill; with feed %g there is a plain state up to kill %.5f, not with %g: u 1 and v 0", index,
               (double)run->rates[of].feed, (double)fill_plain_limit(run->rates[of]), (double)run->rates[of].kill);
    return TY_OK;
}

ty_status fill_events_check(const fill_run* run, ty_error* error)
{
    ty_status status = TY_OK;
    const ty_fill_auto* autos = run->recipe->autos.items;
    for (int i = 0; i < run->recipe->events.count && status == TY_OK; i++)
        status = event_check(run, i, error);
    for (int i = 0; i < run->recipe->autos.count && status == TY_OK; i++)
    {
        char key[FILL_KEY];
        snprintf(key, sizeof key, "auto[%d].mark", i);
        if (fill_mark_find(run, autos[i].mark, key, error) < 0)
            return TY_BAD_INPUT;
        snprintf(key, sizeof key, "auto[%d].over", i);
        if (autos[i].over && fill_mark_find(run, autos[i].over, key, error) < 0)
            return TY_BAD_INPUT;
        if (!(autos[i].reach[1] > autos[i].reach[0]))
            return ty_error_set(error, TY_BAD_INPUT, "auto[%d].reach: [%g, %g]; the second lies above the first", i,
                                (double)autos[i].reach[0], (double)autos[i].reach[1]);
    }
    return status;
}
