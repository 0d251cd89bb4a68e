// SPDX-License-Identifier: Apache-2.0
// From a recipe to a field before its first step: what is asked for, planes, the start.
#include "fill_run.h"
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

enum
{
    MOST_PIXELS = 32768 // of a side: what is read back as an image
};

// --- the recipe ---

static ty_status outputs_read(fill_run* run, ty_error* error)
{
    static const char* const names[] = {"u", "v", "mark", "trail", "distance", "mattes"};
    bool* const flags[] = {&run->outputs.u,     &run->outputs.v,        &run->outputs.mark,
                           &run->outputs.trail, &run->outputs.distance, &run->outputs.mattes};
    for (int i = 0; i < run->recipe->outputs.count; i++)
    {
        int k = 0;
        const char* name = run->recipe->outputs.items[i];
        while (k < 6 && strcmp(names[k], name) != 0)
            k++;
        if (k == 6)
            return ty_error_set(error, TY_BAD_INPUT, "outputs: '%.100s' is none of u, v, mark, trail, distance, mattes",
                                name);
        *flags[k] = true;
    }
    return TY_OK;
}

static ty_status loop_check(const ty_fill_recipe* r, ty_error* error)
{
    if (r->loop.span > r->steps)
        return ty_error_set(error, TY_BAD_INPUT, "loop.span: %d; before step 0 there is nothing: at most %d",
                            r->loop.span, r->steps);
    if (r->loop.frames < 1)
        return ty_error_set(error, TY_BAD_INPUT, "loop.frames: %d; a loop has at least 1", r->loop.frames);
    if (r->events.count > 0)
        return ty_error_set(error, TY_BAD_INPUT, "events: a loop has none; they need run.frames");
    if (r->autos.count > 0)
        return ty_error_set(error, TY_BAD_INPUT, "auto: a loop has none; these marks need run.frames");
    return TY_OK;
}

static ty_status recipe_check(const fill_run* run, ty_error* error)
{
    const ty_fill_recipe* r = run->recipe;
    if (!(r->tone[1] > r->tone[0]))
        return ty_error_set(error, TY_BAD_INPUT, "tone: [%g, %g]; the second lies above the first", (double)r->tone[0],
                            (double)r->tone[1]);
    if (r->map.feed[1] > 0.0f && !(r->map.feed[1] > r->map.feed[0] && r->map.kill[1] > r->map.kill[0]))
        return ty_error_set(error, TY_BAD_INPUT, "map: feed and kill go from lower to higher numbers");
    if (r->map.feed[1] > 0.0f && r->marks.count > 1)
        return ty_error_set(error, TY_BAD_INPUT, "map: it takes the place of the table of marks, which has %d rows",
                            r->marks.count);
    if (r->stencil != 0 && r->stencil != 5 && r->stencil != 9)
        return ty_error_set(error, TY_BAD_INPUT, "stencil: %d; it has 5 or 9 points, or 0 for the convention's",
                            r->stencil);
    for (int i = 0; i < 2; i++)
        if ((int64_t)r->cells[i] * r->scale > MOST_PIXELS)
            return ty_error_set(error, TY_BAD_INPUT, "scale: %d; %d cells become more than %d pixels", r->scale,
                                r->cells[i], MOST_PIXELS);
    if (!run->quiet && r->start == TY_PATTERN_START_PLAIN && run->plain[0].y == 0.0f)
        ty_log(TY_LOG_WARNING,
               "start: plain; with feed %g there is a plain state up to kill %.5f, not with %g: it begins empty",
               (double)run->rates[0].feed, (double)fill_plain_limit(run->rates[0]), (double)run->rates[0].kill);
    return r->run.frames > 0 ? TY_OK : loop_check(r, error);
}

// --- planes ---

static ty_status planes_make(fill_run* run, ty_error* error)
{
    size_t cells = fill_cells(run);
    int keys = run->recipe->events.count + 2 * TY_GRAY_SCOTT_MARKS;
    bool trail = run->outputs.trail;
    const ty_fill_auto* autos = run->recipe->autos.items;
    run->trail_threshold = 0.1f;
    for (int i = run->recipe->autos.count - 1; i >= 0; i--)
        if (autos[i].where == TY_FILL_WHERE_TRAIL)
        {
            run->trail_threshold = autos[i].threshold;
            trail = true;
        }
    run->closed = TY_TRY_ALLOC(uint8_t, cells);
    run->v = TY_TRY_ALLOC(float, cells);
    run->distance = fill_needs_distance(run) ? TY_TRY_ALLOC(float, cells) : NULL;
    run->cover = TY_TRY_ALLOC(float, cells);
    run->layers = TY_TRY_ALLOC(uint8_t, cells);
    run->mixed = TY_TRY_ALLOC(uint8_t, cells);
    run->near_x = TY_TRY_ALLOC(float, cells);
    run->near_y = TY_TRY_ALLOC(float, cells);
    run->trail = trail ? TY_TRY_ALLOC(float, cells) : NULL;
    run->before = trail ? TY_TRY_ALLOC(float, cells) : NULL;
    run->noise = run->recipe->variation > 0.0f ? TY_TRY_ALLOC(float, cells) : NULL;
    run->events = TY_TRY_ALLOC(ty_plane_file, run->recipe->events.count);
    run->keys = ty_try_alloc((size_t)keys, FILL_KEY);
    bool complete = run->closed && run->v && run->cover && run->near_x && run->near_y && run->events && run->keys;
    complete = complete && run->layers && run->mixed && (!fill_needs_distance(run) || run->distance);
    complete = complete && (!trail || (run->trail && run->before)) && (run->recipe->variation == 0.0f || run->noise);
    for (size_t i = 0; complete && trail && i < cells; i++)
        run->trail[i] = -1.0f;
    return complete ? TY_OK : ty_error_set(error, TY_NO_MEMORY, "no memory for %d x %d cells", run->width, run->height);
}

// --- the field ---

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

static ty_status field_make(fill_run* run, ty_error* error)
{
    const ty_fill_recipe* r = run->recipe;
    int count;
    const ty_fill_convention* convention = &ty_fill_conventions(&count)[r->convention];
    ty_gray_scott_def def = ty_gray_scott_def_default();
    def.width = run->width;
    def.height = run->height;
    def.diffusion_u = fill_or(r->diffusion_u, convention->diffusion_u);
    def.diffusion_v = fill_or(r->diffusion_v, convention->diffusion_v);
    def.time_step = fill_or(r->time_step, convention->time_step);
    def.stencil = r->stencil ? r->stencil : convention->stencil;
    def.wrap_x = run->wrap_x;
    def.wrap_y = run->wrap_y;
    memcpy(def.rates, run->rates, sizeof def.rates);
    def.rate_count = run->mark_count;
    run->def = def;
    return ty_gray_scott_create(&def, &run->field, error);
}

static void field_start(const fill_run* run)
{
    if (run->recipe->start == TY_PATTERN_START_DROPS)
        drops_fall(run->recipe, run->field);
    if (run->recipe->start != TY_PATTERN_START_PLAIN)
        return;
    for (int y = 0; y < run->height; y++)
    {
        float *u = ty_gray_scott_u(run->field, y), *v = ty_gray_scott_v(run->field, y);
        for (int x = 0; x < run->width; x++)
        {
            u[x] = run->plain[0].x;
            v[x] = run->plain[0].y;
        }
    }
}

ty_status fill_run_init(fill_run* run, const ty_fill_recipe* recipe, ty_workers* workers, ty_error* error)
{
    *run = (fill_run){.recipe = recipe,
                      .workers = workers,
                      .quiet = run->quiet,
                      .width = recipe->cells[0],
                      .height = recipe->cells[1],
                      .wrap_x = recipe->tile != TY_PATTERN_TILE_NONE,
                      .wrap_y = recipe->tile == TY_PATTERN_TILE_BOTH,
                      .steps = (double)recipe->run.steps};
    fill_marks_take(run);
    ty_status status = fill_marks_check(run, error);
    if (status == TY_OK)
        status = recipe_check(run, error);
    if (status == TY_OK)
        status = outputs_read(run, error);
    if (status == TY_OK)
        status = field_make(run, error);
    if (status == TY_OK)
        status = planes_make(run, error);
    if (status == TY_OK)
        status = fill_events_check(run, error);
    if (status == TY_OK)
        status = fill_files_open(run, error);
    if (status == TY_OK)
        status = fill_solve_steps(run, error);
    if (status != TY_OK)
        return status;
    field_start(run);
    if (run->noise)
        fill_noise(run);
    return fill_vary(run, error);
}

void fill_run_term(fill_run* run)
{
    ty_gray_scott_destroy(run->field);
    ty_color_destroy(run->color);
    void* const owned[] = {run->closed, run->v,      run->trail,  run->before, run->cover,  run->distance, run->layers,
                           run->mixed,  run->near_x, run->near_y, run->noise,  run->events, run->keys};
    for (int i = 0; i < 2 * TY_GRAY_SCOTT_MARKS; i++)
        ty_planes_term(&run->stills[i / 2][i % 2]);
    ty_planes_term(&run->still_over);
    for (int i = 0; i < (int)(sizeof owned / sizeof *owned); i++)
        ty_free(owned[i]);
}
