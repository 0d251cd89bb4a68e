// SPDX-License-Identifier: Apache-2.0
// Gray–Scott: u' = Du lap u - u v^2 + F (1 - u), v' = Dv lap v + u v^2 - (F + k) v. The field, its cells and constants.
#include "gray_scott_field.h"
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>

ty_gray_scott_def ty_gray_scott_def_default(void)
{
    return (ty_gray_scott_def){
        .width = 256,
        .height = 256,
        .diffusion_u = 0.2097152f,
        .diffusion_v = 0.1048576f,
        .time_step = 1.0f,
        .stencil = 5,
        .wrap_x = true,
        .wrap_y = true,
        .rates = {{0.067f, 0.062f}},
        .rate_count = 1,
    };
}

float ty_gray_scott_time_limit(const ty_gray_scott_def* def)
{
    // The fastest wave of the grid; in u the reaction adds F + v^2 to it, in v F + k. v^2 stays below .13, F counts
    // from .07.
    float wave = def->stencil == 9 ? 16.0f / 3.0f : 8.0f, u = 0.07f, v = 0.0f;
    for (int i = 0; i < def->rate_count && i < TY_GRAY_SCOTT_MARKS; i++)
    {
        u = ty_max(u, def->rates[i].feed);
        v = ty_max(v, def->rates[i].feed + def->rates[i].kill);
    }
    return 2.0f / ty_max(wave * def->diffusion_u + u + 0.13f, wave * def->diffusion_v + v);
}

static ty_status check_rates(const ty_gray_scott_def* def, ty_error* error)
{
    if (def->rate_count < 1 || def->rate_count > TY_GRAY_SCOTT_MARKS)
        return ty_error_set(error, TY_BAD_INPUT, "%d marks; a field has 1..%d", def->rate_count, TY_GRAY_SCOTT_MARKS);
    for (int i = 0; i < def->rate_count; i++)
    {
        ty_gray_scott_rates r = def->rates[i];
        if (!(r.feed >= 0.0f && r.feed <= 1.0f && r.kill >= 0.0f && r.kill <= 1.0f))
            return ty_error_set(error, TY_BAD_INPUT, "mark %d: feed %g and kill %g; both lie between 0 and 1", i,
                                (double)r.feed, (double)r.kill);
    }
    return TY_OK;
}

static ty_status check(const ty_gray_scott_def* def, ty_error* error)
{
    if (def->width < 8 || def->width > 32768 || def->height < 8 || def->height > 32768)
        return ty_error_set(error, TY_BAD_INPUT, "%d x %d cells; each side has 8..32768", def->width, def->height);
    if (def->stencil != 5 && def->stencil != 9)
        return ty_error_set(error, TY_BAD_INPUT, "stencil: %d points; there are 5 and 9", def->stencil);
    float most = ty_max(def->diffusion_u, def->diffusion_v);
    if (!(def->diffusion_u > 0.0f && def->diffusion_v > 0.0f && most < 10.0f))
        return ty_error_set(error, TY_BAD_INPUT, "diffusion: %g and %g; both lie above 0 and below 10",
                            (double)def->diffusion_u, (double)def->diffusion_v);
    ty_status status = check_rates(def, error);
    float limit = ty_gray_scott_time_limit(def);
    if (status == TY_OK && !(def->time_step > 0.0f && def->time_step < limit))
        return ty_error_set(error, TY_BAD_INPUT, "time_step: %g; with these diffusions it lies above 0 and below %.4g",
                            (double)def->time_step, (double)limit);
    return status;
}

// To a multiple of 2^-24: keep, feed and four edges then add up to 1 exactly, and what is even stays even.
static float round_to_grid(double a)
{
    return (float)(floor(a * 0x1p24 + 0.5) * 0x1p-24);
}

static gs_rates rates_make(const ty_gray_scott_def* def)
{
    gs_rates r = {.time_step = def->time_step};
    double dt = (double)def->time_step, u = dt * (double)def->diffusion_u, v = dt * (double)def->diffusion_v;
    bool nine = def->stencil == 9;
    r.edge_u = round_to_grid(nine ? u * 2.0 / 3.0 : u);
    r.edge_v = round_to_grid(nine ? v * 2.0 / 3.0 : v);
    r.corner_u = nine ? round_to_grid(u / 6.0) : 0.0f;
    r.corner_v = nine ? round_to_grid(v / 6.0) : 0.0f;
    r.base_u = (float)(1.0 - 4.0 * (double)r.edge_u - 4.0 * (double)r.corner_u);
    r.base_v = (float)(1.0 - 4.0 * (double)r.edge_v - 4.0 * (double)r.corner_v);
    for (int i = 0; i < TY_GRAY_SCOTT_MARKS; i++)
    {
        const ty_gray_scott_rates* of = &def->rates[i < def->rate_count ? i : 0];
        r.feed[i] = round_to_grid(dt * (double)of->feed);
        r.kill[i] = round_to_grid(dt * (double)of->kill);
        r.keep_u[i] = r.base_u - r.feed[i];
        r.keep_v[i] = r.base_v - (r.feed[i] + r.kill[i]);
    }
    return r;
}

ty_status ty_gray_scott_create(const ty_gray_scott_def* def, ty_gray_scott** out, ty_error* error)
{
    *out = NULL;
    ty_status status = check(def, error);
    if (status != TY_OK)
        return status;
    ty_gray_scott* field = TY_ALLOC(ty_gray_scott, 1);
    field->def = *def;
    field->rates = rates_make(def);
    size_t stride = stream_stride(def->width), size = stride * (size_t)def->height;
    field->run_stride = stride / STREAM_GROUP;
    field->memory = TY_TRY_ALLOC(float, 4 * size);
    field->marks = TY_TRY_ALLOC(uint8_t, size + 2 * stride);
    field->runs = TY_TRY_ALLOC(uint16_t, field->run_stride * (size_t)def->height);
    if (!field->memory || !field->marks || !field->runs)
    {
        ty_gray_scott_destroy(field);
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %d x %d cells", def->width, def->height);
    }
    field->stream = (stream){
        .width = def->width,
        .height = def->height,
        .wrap_x = def->wrap_x,
        .wrap_y = def->wrap_y,
        .plane_count = 2,
        .stride = stride,
        .front = {field->memory, field->memory + size},
        .back = {field->memory + 2 * size, field->memory + 3 * size},
        .row = gs_row_choose(TY_GRAY_SCOTT_BEST),
        .context = field,
    };
    for (int y = 0; y < def->height; y++)
        for (int x = 0; x < def->width; x++)
            ty_gray_scott_u(field, y)[x] = 1.0f;
    *out = field;
    return TY_OK;
}

void ty_gray_scott_destroy(ty_gray_scott* field)
{
    if (!field)
        return;
    stream_release(&field->stream);
    ty_free(field->memory);
    ty_free(field->runs);
    ty_free(field->feed);
    ty_free(field->kill);
    ty_free(field->marks);
    ty_free(field);
}

float* ty_gray_scott_u(ty_gray_scott* field, int y)
{
    return field->stream.front[0] + gs_cell(field, y);
}

float* ty_gray_scott_v(ty_gray_scott* field, int y)
{
    return field->stream.front[1] + gs_cell(field, y);
}

uint8_t* ty_gray_scott_marks(ty_gray_scott* field, int y)
{
    field->runs_valid = false;
    return field->marks + gs_cell(field, y + 1);
}

const uint8_t* ty_gray_scott_marks_seen(const ty_gray_scott* field, int y)
{
    return field->marks + gs_cell(field, y + 1);
}

// Times dt, in the layout of the cells; NULL for NULL.
static ty_status plane_copy(const ty_gray_scott* field, const float* from, float** out, ty_error* error)
{
    int w = field->def.width, h = field->def.height;
    *out = from ? TY_TRY_ALLOC(float, field->stream.stride*(size_t)h) : NULL;
    if (from && !*out)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for the rates of %d x %d cells", w, h);
    for (int y = 0; from && y < h; y++)
        for (int x = 0; x < w; x++)
            (*out)[gs_cell(field, y) + (size_t)x] = field->def.time_step * from[(size_t)y * (size_t)w + (size_t)x];
    return TY_OK;
}

ty_status ty_gray_scott_vary(ty_gray_scott* field, const float* feed, const float* kill, ty_error* error)
{
    float *new_feed = NULL, *new_kill = NULL;
    ty_status status = plane_copy(field, feed, &new_feed, error);
    if (status == TY_OK)
        status = plane_copy(field, kill, &new_kill, error);
    if (status != TY_OK)
    {
        ty_free(new_feed);
        return status;
    }
    ty_free(field->feed);
    ty_free(field->kill);
    field->feed = new_feed;
    field->kill = new_kill;
    field->runs_valid = false;
    return TY_OK;
}

// The cell that (x, y) means across wrapped edges; NULL outside.
static float* find_cell(const ty_gray_scott* field, float* plane, int x, int y)
{
    int w = field->def.width, h = field->def.height;
    if (field->def.wrap_x)
        x = (x % w + w) % w;
    if (field->def.wrap_y)
        y = (y % h + h) % h;
    return x >= 0 && x < w && y >= 0 && y < h ? plane + gs_cell(field, y) + x : NULL;
}

void ty_gray_scott_drop(ty_gray_scott* field, float x, float y, float radius, ty_rng* rng)
{
    int reach = (int)radius + 1, cx = (int)floorf(x), cy = (int)floorf(y);
    for (int j = cy - reach; j <= cy + reach; j++)
        for (int i = cx - reach; i <= cx + reach; i++)
        {
            float u = 0.5f * ty_rng_range(rng, 0.98f, 1.02f), v = 0.25f * ty_rng_range(rng, 0.98f, 1.02f);
            float* at = find_cell(field, field->stream.front[0], i, j);
            if (!at || ty_sqr((float)i - x) + ty_sqr((float)j - y) >= radius * radius)
                continue;
            *at = u;
            *find_cell(field, field->stream.front[1], i, j) = v;
        }
}
