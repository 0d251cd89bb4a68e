// SPDX-License-Identifier: Apache-2.0
// The state of a run as an EXR file: u, v, marks with what is closed, and the trail.
#include "fill_run.h"
#include "fill_tables.h"
#include "pattern_state.h"
#include <string.h>
#include <tsuya/base/memory.h>

// --- whose it is ---

// What only shows; the size is told by itself, and names of rates stand in the numbers that they mean.
static const char* const free_rows[] = {"cells",
                                        "scale",
                                        "preset",
                                        "convention",
                                        "marks.name",
                                        "marks.preset",
                                        "marks.color",
                                        "marks.ground",
                                        "marks.image",
                                        "marks.beneath",
                                        "marks.opacity",
                                        "marks.ground_opacity",
                                        "steps",
                                        "loop",
                                        "run.frames",
                                        "sharp",
                                        "tone",
                                        "low",
                                        "high",
                                        "over",
                                        "outside",
                                        "outputs",
                                        NULL};

static const pattern_state_kind kind = {"tsuya fill state 2", "a fill", &ty_fill_recipe_table, free_rows};

static void marks_resolve(const fill_run* run, ty_fill_mark* marks)
{
    memcpy(marks, run->recipe->marks.items, (size_t)run->recipe->marks.count * sizeof *marks);
    for (int i = 0; i < run->recipe->marks.count; i++)
    {
        marks[i].feed = run->rates[i].feed;
        marks[i].kill = run->rates[i].kill;
    }
}

// Events up to the frame, in their places, as those behind them draw chances by their number.
static int events_past(const ty_fill_recipe* recipe, int frame, ty_fill_event* events)
{
    const ty_fill_event* all = recipe->events.items;
    int count = 0;
    for (int i = 0; i < recipe->events.count; i++)
        if (all[i].at <= frame)
        {
            events[i] = all[i];
            count = i + 1;
        }
    return count;
}

// Rules that the field or the trail follows.
static int autos_felt(const ty_fill_recipe* recipe, ty_fill_auto* autos, bool* levels)
{
    const ty_fill_auto* all = recipe->autos.items;
    int count = 0;
    for (int i = 0; i < recipe->autos.count; i++)
        if (all[i].rates || all[i].where == TY_FILL_WHERE_TRAIL)
        {
            *levels = *levels || all[i].where != TY_FILL_WHERE_TRAIL;
            autos[count++] = all[i];
        }
    return count;
}

// A recipe that tells all that made the field as it is at a frame, and nothing else.
typedef struct past
{
    ty_fill_recipe recipe;
    ty_fill_mark marks[TY_GRAY_SCOTT_MARKS];
    ty_fill_event* events;
    ty_fill_auto* autos;
} past;

static void past_init(past* p, const fill_run* run, int frame)
{
    const ty_fill_recipe* r = run->recipe;
    bool levels = false;
    p->recipe = *r;
    p->events = TY_ALLOC(ty_fill_event, r->events.count);
    p->autos = TY_ALLOC(ty_fill_auto, r->autos.count);
    marks_resolve(run, p->marks);
    p->recipe.feed = r->marks.count > 0 ? 0.0f : run->rates[0].feed;
    p->recipe.kill = r->marks.count > 0 ? 0.0f : run->rates[0].kill;
    p->recipe.diffusion_u = run->def.diffusion_u;
    p->recipe.diffusion_v = run->def.diffusion_v;
    p->recipe.time_step = run->def.time_step;
    p->recipe.stencil = run->def.stencil;
    p->recipe.run.steps = (float)run->steps;
    p->recipe.marks = (ty_param_list){p->marks, r->marks.count};
    p->recipe.events = (ty_param_list){p->events, events_past(r, frame, p->events)};
    p->recipe.autos = (ty_param_list){p->autos, autos_felt(r, p->autos, &levels)};
    p->recipe.level = levels ? run->level : 0.0f;
}

static void past_term(past* p)
{
    ty_free(p->events);
    ty_free(p->autos);
}

// --- keeping ---

ty_exr* fill_state_save(const fill_run* run, int frame)
{
    size_t row = (size_t)run->width * sizeof(float);
    past made_by;
    past_init(&made_by, run, frame);
    ty_exr* state = pattern_state_create(&kind, &made_by.recipe, run->width, run->height);
    past_term(&made_by);
    float *u = ty_exr_add_channel(state, "u", TY_EXR_FLOAT), *v = ty_exr_add_channel(state, "v", TY_EXR_FLOAT);
    uint32_t* cells = ty_exr_add_channel(state, "cell", TY_EXR_UINT);
    for (int y = 0; y < run->height; y++)
    {
        size_t at = fill_cell(run, 0, y);
        const uint8_t* marks = ty_gray_scott_marks_seen(run->field, y);
        memcpy(u + at, ty_gray_scott_u(run->field, y), row);
        memcpy(v + at, ty_gray_scott_v(run->field, y), row);
        for (int x = 0; x < run->width; x++)
            cells[at + (size_t)x] = fill_mark_of(marks[x]) | (uint32_t)run->closed[at + (size_t)x] << 8;
    }
    if (run->trail)
        memcpy(ty_exr_add_channel(state, "trail", TY_EXR_FLOAT), run->trail, fill_cells(run) * sizeof(float));
    ty_exr_add_int(state, "tsuya/frame", frame);
    return state;
}

// --- going on ---

static ty_status state_check(const fill_run* run, const ty_exr* state, int* frame, ty_error* error)
{
    past now;
    const uint32_t* cells = pattern_state_plane(state, "cell", TY_EXR_UINT);
    if (!pattern_state_number(state, "tsuya/frame", frame) || !pattern_state_plane(state, "u", TY_EXR_FLOAT) ||
        !pattern_state_plane(state, "v", TY_EXR_FLOAT) || !cells)
        return ty_error_set(error, TY_BAD_FILE, "the state to go on from is not whole: it lacks planes");
    past_init(&now, run, *frame);
    ty_status status = pattern_state_check(&kind, state, &now.recipe, run->width, run->height, error);
    past_term(&now);
    if (status != TY_OK)
        return status;
    if (*frame < 1 || *frame >= run->recipe->run.frames)
        return ty_error_set(error, TY_BAD_INPUT,
                            "run.frames: %d; the state is that of frame %d: there is nothing to go on to",
                            run->recipe->run.frames, *frame);
    if (run->trail && !pattern_state_plane(state, "trail", TY_EXR_FLOAT))
        return ty_error_set(error, TY_BAD_INPUT,
                            "outputs: trail; the state to go on from was made without: it does not know the past");
    for (size_t i = 0; i < fill_cells(run); i++)
        if ((cells[i] & 0xff) >= (uint32_t)run->mark_count || cells[i] >> 8 > (FILL_OUTSIDE | FILL_BARRIER))
            return ty_error_set(error, TY_BAD_INPUT, "marks: %d rows; a cell of the state has mark %u", run->mark_count,
                                cells[i] & 0xff);
    return TY_OK;
}

static void cells_take(fill_run* run, const ty_exr* state)
{
    const float* u = pattern_state_plane(state, "u", TY_EXR_FLOAT);
    const float* v = pattern_state_plane(state, "v", TY_EXR_FLOAT);
    const float* trail = pattern_state_plane(state, "trail", TY_EXR_FLOAT);
    const uint32_t* cells = pattern_state_plane(state, "cell", TY_EXR_UINT);
    for (int y = 0; y < run->height; y++)
    {
        uint8_t* marks = ty_gray_scott_marks(run->field, y);
        size_t at = fill_cell(run, 0, y), row = (size_t)run->width * sizeof(float);
        memcpy(ty_gray_scott_u(run->field, y), u + at, row);
        memcpy(ty_gray_scott_v(run->field, y), v + at, row);
        for (int x = 0; x < run->width; x++)
        {
            uint32_t cell = cells[at + (size_t)x];
            run->closed[at + (size_t)x] = (uint8_t)(cell >> 8);
            marks[x] = (uint8_t)((cell & 0xff) | (cell >> 8 ? TY_GRAY_SCOTT_BARRIER : 0));
        }
        if (run->trail)
            memcpy(run->trail + at, trail + at, row);
        if (run->before)
            memcpy(run->before + at, v + at, row);
    }
}

ty_status fill_state_load(fill_run* run, const ty_bytes* bytes, int* frame, ty_error* error)
{
    ty_exr* state;
    ty_status status = pattern_state_read(&kind, bytes, &state, error);
    if (status != TY_OK)
        return status;
    status = state_check(run, state, frame, error);
    if (status == TY_OK)
        cells_take(run, state);
    ty_exr_destroy(state);
    return status == TY_OK ? fill_vary(run, error) : status;
}
