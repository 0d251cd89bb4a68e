// SPDX-License-Identifier: Apache-2.0
// A Turing field: its definition checked, its planes made when they are needed.
#include "turing_state.h"
#include <math.h>
#include <tsuya/base/cpu.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>

ty_turing_def ty_turing_def_default(void)
{
    return (ty_turing_def){
        .width = 256,
        .height = 256,
        .u = {0.08f, -0.08f, 0.05f, 0.03f, 0.2f, 0.08f},
        .v = {0.1f, 0.0f, -0.15f, 0.06f, 0.5f, 1.0f},
        .edge_u = 5.0f,
        .limit_slope = 4.0f,
    };
}

float ty_turing_step_bound(const ty_turing_def* def)
{
    return 2.0f / ty_max(8.0f * def->u.diffusion + def->u.decay, 8.0f * def->v.diffusion + def->v.decay);
}

float ty_turing_step_default(const ty_turing_def* def)
{
    return 0.9f / (4.0f * ty_max(def->u.diffusion, def->v.diffusion));
}

static bool all_finite(const ty_turing_reaction* r)
{
    return isfinite(r->u) && isfinite(r->v) && isfinite(r->constant);
}

static ty_status check(const ty_turing_def* def, ty_error* error)
{
    if (def->width < 4 || def->width > 32768 || def->height < 4 || def->height > 32768)
        return ty_error_set(error, TY_BAD_INPUT, "%d x %d cells; each side has 4..32768", def->width, def->height);
    const ty_turing_reaction *u = &def->u, *v = &def->v;
    float least = ty_min(u->diffusion, v->diffusion), most = ty_max(u->diffusion, v->diffusion);
    if (!(least > 0.0f && most <= 100.0f))
        return ty_error_set(error, TY_BAD_INPUT, "diffusion: %g and %g; both lie above 0 and up to 100",
                            (double)u->diffusion, (double)v->diffusion);
    if (!(all_finite(u) && all_finite(v) && u->decay >= 0.0f && v->decay >= 0.0f && u->decay <= 10.0f &&
          v->decay <= 10.0f && u->most >= 0.0f && v->most >= 0.0f && isfinite(u->most) && isfinite(v->most)))
        return ty_error_set(error, TY_BAD_INPUT, "reaction: all is finite, decay 0..10, the largest rate 0 or more");
    float bound = ty_turing_step_bound(def);
    if (!(def->time_step >= 0.0f && def->time_step <= bound))
        return ty_error_set(error, TY_BAD_INPUT,
                            "time_step: %g; with these diffusions it lies above 0 and up to %.4g (0: %.4g is taken)",
                            (double)def->time_step, (double)bound, (double)ty_turing_step_default(def));
    if (!(def->limit_slope >= 0.0f && def->limit_slope <= 1000.0f))
        return ty_error_set(error, TY_BAD_INPUT, "limit.slope: %g; it lies in 0..1000", (double)def->limit_slope);
    return TY_OK;
}

static ty_turing_rates rates_make(const ty_turing_def* def)
{
    const ty_turing_reaction *u = &def->u, *v = &def->v;
    float dt = def->time_step;
    return (ty_turing_rates){
        .uu = dt * u->u,
        .uv = dt * u->v,
        .u_most = dt * u->most,
        .vu = dt * v->u,
        .vv = dt * v->v,
        .v_constant = dt * v->constant,
        .v_most = dt * v->most,
        .keep_u = 1.0f - dt * u->decay,
        .keep_v = 1.0f - dt * v->decay,
        .centre_u = 1.0f - dt * (u->decay + 4.0f * u->diffusion),
        .centre_v = 1.0f - dt * (v->decay + 4.0f * v->diffusion),
        .spread_u = dt * u->diffusion,
        .spread_v = dt * v->diffusion,
        .limit = def->limit,
        .slope = def->limit_slope,
        .conservative = def->limit_conservative,
    };
}

static float* plane_alloc(const ty_turing* field)
{
    return TY_TRY_ALLOC(float, field->stream.stride*(size_t)(field->def.height + 2));
}

static bool planes_alloc(stream* s)
{
    bool good = true;
    for (int i = 0; i < s->plane_count; i++)
    {
        s->front[i] = TY_TRY_ALLOC(float, s->stride*(size_t)s->height);
        s->back[i] = TY_TRY_ALLOC(float, s->stride*(size_t)s->height);
        good = good && s->front[i] && s->back[i];
    }
    return good;
}

static bool kinds_alloc(ty_turing* field)
{
    size_t count = field->stream.stride / STREAM_GROUP * (size_t)field->def.height;
    return field->kinds || (field->kinds = TY_TRY_ALLOC(uint8_t, count));
}

static bool hold_alloc(ty_turing* field)
{
    float** const all[] = {&field->weight, &field->pull_u, &field->pull_v};
    bool good = true;
    for (int i = 0; i < 3 && !field->weight; i++)
        good = good && (*all[2 - i] = plane_alloc(field)) != NULL; // weight last: it says that there is all
    return good && kinds_alloc(field);
}

// The widest kernel of this CPU; both give the same bits.
static stream_row_fn* row_choose(void)
{
#if defined(__x86_64__)
    if (ty_cpu_has_avx512())
        return ty_turing_row_avx512;
#endif
    return ty_turing_row_base;
}

ty_status ty_turing_create(const ty_turing_def* def, ty_turing** out, ty_error* error)
{
    *out = NULL;
    ty_status status = check(def, error);
    if (status != TY_OK)
        return status;
    ty_turing* field = TY_ALLOC(ty_turing, 1);
    field->def = *def;
    if (field->def.time_step == 0.0f)
        field->def.time_step = ty_turing_step_default(def);
    field->rates = rates_make(&field->def);
    bool wraps = def->edge == TY_TURING_WRAP;
    field->stream = (stream){.width = def->width,
                             .height = def->height,
                             .wrap_x = wraps,
                             .wrap_y = wraps,
                             .plane_count = 2,
                             .stride = stream_stride(def->width),
                             .row = row_choose(),
                             .context = field,
                             .whole = true};
    field->constant = plane_alloc(field);
    if (!planes_alloc(&field->stream) || !field->constant || (def->edge == TY_TURING_FIXED && !hold_alloc(field)))
    {
        ty_turing_destroy(field);
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %d x %d cells", def->width, def->height);
    }
    *out = field;
    return TY_OK;
}

void ty_turing_destroy(ty_turing* field)
{
    if (!field)
        return;
    float* const all[] = {field->stream.front[0], field->stream.front[1], field->stream.back[0],
                          field->stream.back[1],  field->constant,        field->inverse,
                          field->weight,          field->pull_u,          field->pull_v};
    for (int i = 0; i < (int)(sizeof all / sizeof *all); i++)
        ty_free(all[i]);
    for (int i = 0; i < TY_TURING_PLANES; i++)
        ty_free(field->planes[i]);
    ty_free(field->kinds);
    stream_release(&field->stream);
    ty_free(field);
}

float ty_turing_time_step(const ty_turing* field)
{
    return field->def.time_step;
}

float* ty_turing_u(ty_turing* field, int y)
{
    return field->stream.front[0] + stream_cell(&field->stream, y);
}

float* ty_turing_v(ty_turing* field, int y)
{
    return field->stream.front[1] + stream_cell(&field->stream, y);
}

// What comes with a plane: those of one thing are there together.
static void plane_range(ty_turing_plane plane, int* first, int* last)
{
    bool held = plane >= TY_TURING_HOLD && plane <= TY_TURING_HOLD_V, along = plane >= TY_TURING_ALONG_COS;
    *first = held ? TY_TURING_HOLD : along ? TY_TURING_ALONG_COS : plane;
    *last = held ? TY_TURING_HOLD_V : along ? TY_TURING_ALONG_SIN : plane;
}

// What a plane is made into, beside itself.
static bool derived_alloc(ty_turing* field, ty_turing_plane plane)
{
    if (plane == TY_TURING_OPEN)
        return kinds_alloc(field) && (field->inverse || (field->inverse = plane_alloc(field)));
    return plane != TY_TURING_HOLD || hold_alloc(field);
}

ty_status ty_turing_need(ty_turing* field, ty_turing_plane plane, ty_error* error)
{
    const float neutral[TY_TURING_PLANES] = {[TY_TURING_CONSTANT] = field->def.u.constant, [TY_TURING_OPEN] = 1.0f};
    float* made[TY_TURING_PLANES] = {NULL};
    int first, last;
    if (field->planes[plane])
        return TY_OK;
    plane_range(plane, &first, &last);
    bool good = derived_alloc(field, first);
    for (int p = first; p <= last && good; p++)
        good = (made[p] = plane_alloc(field)) != NULL;
    for (int p = first; p <= last && !good; p++)
        ty_free(made[p]);
    if (!good)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %d x %d cells", field->def.width, field->def.height);
    for (int p = first; p <= last; p++)
    {
        field->planes[p] = made[p];
        for (size_t i = 0; neutral[p] != 0.0f && i < field->stream.stride * (size_t)(field->def.height + 2); i++)
            made[p][i] = neutral[p];
    }
    return TY_OK;
}

bool ty_turing_has(const ty_turing* field, ty_turing_plane plane)
{
    return field->planes[plane] != NULL;
}

float* ty_turing_row(ty_turing* field, ty_turing_plane plane, int y)
{
    TY_ASSERT(field->planes[plane]);
    return field->planes[plane] + ty_turing_cell(field, y);
}
