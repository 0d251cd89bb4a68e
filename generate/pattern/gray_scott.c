// SPDX-License-Identifier: Apache-2.0
// Gray–Scott: u' = Du lap u - u v^2 + F (1 - u), v' = Dv lap v + u v^2 - (F + k) v. Planes with a border of one cell,
// one operation order, no FMA: the loops vectorise and give the same bits everywhere.
#include <string.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/generate/gray_scott.h>

enum
{
    ALIGNED = 16,       // floats: rows begin at cache lines
    PIECE_CELLS = 32768 // of a range: less is not worth waking a thread
};

typedef struct planes
{
    float *u, *v;
} planes;

struct ty_gray_scott
{
    ty_gray_scott_def def;
    size_t stride;      // of a row, floats
    planes front, back; // [height + 2][stride], cell (0, 0) at stride + ALIGNED
    float *feed, *kill; // the same layout
    float* memory;
};

ty_gray_scott_def ty_gray_scott_def_default(void)
{
    return (ty_gray_scott_def){
        .width = 256,
        .height = 256,
        .diffusion_u = 0.2097152f,
        .diffusion_v = 0.1048576f,
        .time_step = 1.0f,
        .feed = 0.067f,
        .kill = 0.062f,
        .wrap_x = true,
        .wrap_y = true,
    };
}

static ty_status check(const ty_gray_scott_def* def, ty_error* error)
{
    if (def->width < 8 || def->width > 32768 || def->height < 8 || def->height > 32768)
        return ty_error_set(error, TY_BAD_INPUT, "%d x %d cells; each side has 8..32768", def->width, def->height);
    float most = ty_max(def->diffusion_u, def->diffusion_v);
    if (!(def->diffusion_u > 0.0f && def->diffusion_v > 0.0f && most < 10.0f))
        return ty_error_set(error, TY_BAD_INPUT, "diffusion: %g and %g; both lie above 0 and below 10",
                            (double)def->diffusion_u, (double)def->diffusion_v);
    // Euler's bound for the fastest wave of the grid; .2 leaves room for the reaction.
    float limit = 2.0f / (8.0f * most + 0.2f);
    if (!(def->time_step > 0.0f && def->time_step < limit))
        return ty_error_set(error, TY_BAD_INPUT, "time_step: %g; with these diffusions it lies above 0 and below %.4g",
                            (double)def->time_step, (double)limit);
    return TY_OK;
}

static size_t cell(const ty_gray_scott* field, int y)
{
    return (size_t)(y + 1) * field->stride + ALIGNED;
}

// The border's copies of row y, and the border rows that copy it.
static void border_fill(const ty_gray_scott* field, float* plane, int y)
{
    const ty_gray_scott_def* def = &field->def;
    float* row = plane + cell(field, y);
    row[-1] = row[def->wrap_x ? def->width - 1 : 0];
    row[def->width] = row[def->wrap_x ? 0 : def->width - 1];
    size_t size = (size_t)def->width * sizeof(float); // corners are never read
    if (y == 0)
        memcpy(plane + cell(field, def->wrap_y ? def->height : -1), row, size);
    if (y == def->height - 1)
        memcpy(plane + cell(field, def->wrap_y ? -1 : def->height), row, size);
}

static void borders_fill(const ty_gray_scott* field)
{
    for (int y = 0; y < field->def.height; y++)
    {
        border_fill(field, field->front.u, y);
        border_fill(field, field->front.v, y);
    }
}

ty_status ty_gray_scott_create(const ty_gray_scott_def* def, ty_gray_scott** out, ty_error* error)
{
    *out = NULL;
    ty_status status = check(def, error);
    if (status != TY_OK)
        return status;
    ty_gray_scott* field = TY_ALLOC(ty_gray_scott, 1);
    field->def = *def;
    field->stride = ((size_t)def->width + 2 * ALIGNED + ALIGNED - 1) / ALIGNED * ALIGNED;
    size_t size = field->stride * ((size_t)def->height + 2);
    field->memory = TY_TRY_ALLOC(float, 6 * size);
    if (!field->memory)
    {
        ty_free(field);
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %d x %d cells", def->width, def->height);
    }
    field->front = (planes){field->memory, field->memory + size};
    field->back = (planes){field->memory + 2 * size, field->memory + 3 * size};
    field->feed = field->memory + 4 * size;
    field->kill = field->memory + 5 * size;
    for (int y = 0; y < def->height; y++)
        for (int x = 0; x < def->width; x++)
        {
            field->front.u[cell(field, y) + (size_t)x] = 1.0f;
            field->feed[cell(field, y) + (size_t)x] = def->feed;
            field->kill[cell(field, y) + (size_t)x] = def->kill;
        }
    *out = field;
    return TY_OK;
}

void ty_gray_scott_destroy(ty_gray_scott* field)
{
    if (!field)
        return;
    ty_free(field->memory);
    ty_free(field);
}

float* ty_gray_scott_u(ty_gray_scott* field, int y)
{
    return field->front.u + cell(field, y);
}

float* ty_gray_scott_v(ty_gray_scott* field, int y)
{
    return field->front.v + cell(field, y);
}

float* ty_gray_scott_feed(ty_gray_scott* field, int y)
{
    return field->feed + cell(field, y);
}

float* ty_gray_scott_kill(ty_gray_scott* field, int y)
{
    return field->kill + cell(field, y);
}

// The cell that (x, y) means across wrapped edges; NULL outside.
static float* find_cell(const ty_gray_scott* field, float* plane, int x, int y)
{
    int w = field->def.width, h = field->def.height;
    if (field->def.wrap_x)
        x = (x % w + w) % w;
    if (field->def.wrap_y)
        y = (y % h + h) % h;
    return x >= 0 && x < w && y >= 0 && y < h ? plane + cell(field, y) + x : NULL;
}

void ty_gray_scott_drop(ty_gray_scott* field, float x, float y, float radius, ty_rng* rng)
{
    int reach = (int)radius + 1, cx = (int)floorf(x), cy = (int)floorf(y);
    for (int j = cy - reach; j <= cy + reach; j++)
        for (int i = cx - reach; i <= cx + reach; i++)
        {
            float u = 0.5f * ty_rng_range(rng, 0.98f, 1.02f), v = 0.25f * ty_rng_range(rng, 0.98f, 1.02f);
            float* at = find_cell(field, field->front.u, i, j);
            if (!at || ty_sqr((float)i - x) + ty_sqr((float)j - y) >= radius * radius)
                continue;
            *at = u;
            *find_cell(field, field->front.v, i, j) = v;
        }
}

// One row from itself and its neighbours, borders included.
static void row_step(const ty_gray_scott_def* def, const float* restrict u, const float* restrict v,
                     const float* restrict feed, const float* restrict kill, size_t stride, float* restrict out_u,
                     float* restrict out_v)
{
    const float *uu = u - stride, *ud = u + stride, *vu = v - stride, *vd = v + stride;
    float du = def->diffusion_u, dv = def->diffusion_v, dt = def->time_step;
    for (int x = 0; x < def->width; x++)
    {
        float a = u[x], b = v[x], f = feed[x], reaction = a * b * b;
        float lap_u = (u[x - 1] + u[x + 1]) + (uu[x] + ud[x]) - 4.0f * a;
        float lap_v = (v[x - 1] + v[x + 1]) + (vu[x] + vd[x]) - 4.0f * b;
        out_u[x] = a + dt * (du * lap_u - reaction + f * (1.0f - a));
        out_v[x] = b + dt * (dv * lap_v + reaction - (f + kill[x]) * b);
    }
}

static void rows_step(void* context, int64_t begin, int64_t end, int worker)
{
    const ty_gray_scott* field = context;
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
    {
        size_t at = cell(field, y);
        row_step(&field->def, field->front.u + at, field->front.v + at, field->feed + at, field->kill + at,
                 field->stride, field->back.u + at, field->back.v + at);
        border_fill(field, field->back.u, y);
        border_fill(field, field->back.v, y);
    }
}

void ty_gray_scott_step(ty_gray_scott* field, int step_count, ty_workers* workers)
{
    borders_fill(field); // cells may have been set from outside
    int64_t rows = PIECE_CELLS / field->def.width + 1;
    for (int i = 0; i < step_count; i++)
    {
        if (!ty_parallel_for(workers, field->def.height, rows, rows_step, field))
            return;
        planes done = field->back;
        field->back = field->front;
        field->front = done;
    }
}
