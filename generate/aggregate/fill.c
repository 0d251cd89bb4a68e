// SPDX-License-Identifier: Apache-2.0
// The height of a fill from its volume, and Poisson-disk points within it.
#include "fill.h"
#include <stdlib.h>
#include <string.h>

#define STEEPEST_CROWN 0.42f // of the rim's radius: an edge near 40 degrees, about the angle of repose

// --- samples of the space: what level or crown takes each in ---

typedef struct sample
{
    float key; // level or crown at which the surface passes through it
    float weight;
    ty_vec3 p;
} sample;

typedef struct space
{
    const ty_container* container;
    ty_bounds bounds;
    float inset;
    sample* samples;
    int count;
} space;

static bool space_holds(const space* s, ty_vec3 p)
{
    ty_bounds interior = ty_container_interior(s->container);
    bool above = ty_container_is_open(s->container) && p.y >= interior.high.y;
    if (above && ty_container_is_turned(s->container))
    {
        if (p.x * p.x + p.z * p.z > ty_sqr(interior.high.x))
            return false;
    }
    else if ((!above || ty_container_wall_count(s->container) == 1) && !ty_container_holds(s->container, p))
        return false;
    ty_vec3 n;
    for (int w = 0; w < ty_container_wall_count(s->container); w++)
        if (ty_container_wall(s->container, w, p, &n) < s->inset)
            return false;
    return true;
}

static void space_add(space* s, ty_vec3 p, float weight)
{
    if (space_holds(s, p))
        s->samples[s->count++] = (sample){0.0f, weight, p};
}

// Samples on the half-plane of a turned container (weighted by the circumference), else on a grid.
static void space_sample(space* s)
{
    ty_vec3 low = s->bounds.low, size = ty_sub(s->bounds.high, s->bounds.low);
    bool turned = ty_container_is_turned(s->container);
    int n[3] = {turned ? 256 : 64, turned ? 256 : 64, turned ? 1 : 64};
    s->samples = TY_ALLOC(sample, (size_t)n[0] * (size_t)n[1] * (size_t)n[2]);
    s->count = 0;
    float dx = (turned ? s->bounds.high.x : size.x) / (float)n[0], dy = size.y / (float)n[1], dz = size.z / (float)n[2];
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++)
            {
                float x = dx * ((float)i + 0.5f), y = low.y + dy * ((float)j + 0.5f);
                if (turned)
                    space_add(s, ty_vec3_make(x, y, 0.0f), 2.0f * TY_PI * x * dx * dy);
                else
                    space_add(s, ty_vec3_make(low.x + x, y, low.z + dz * ((float)k + 0.5f)), dx * dy * dz);
            }
}

static int sample_order(const void* a, const void* b)
{
    const sample *p = a, *q = b;
    return (p->key > q->key) - (p->key < q->key);
}

// The key below which the samples make up volume; *total gets what they make up in all.
static float samples_cut(space* s, double volume, double* total)
{
    qsort(s->samples, (size_t)s->count, sizeof(sample), sample_order);
    float cut = TY_FLOAT_MAX;
    *total = 0.0;
    for (int i = 0; i < s->count; i++)
    {
        *total += (double)s->samples[i].weight;
        if (*total >= volume && cut == TY_FLOAT_MAX)
            cut = s->samples[i].key;
    }
    return cut;
}

static float crown_share(const ty_fill_top* top, ty_vec3 p)
{
    ty_fill_top unit = *top;
    unit.level = 0.0f;
    unit.crown = 1.0f;
    return ty_fill_top_height(&unit, p);
}

ty_status ty_fill_plan(const ty_container* container, double volume, float heap, float inset, ty_fill_top* top,
                       double* capacity, ty_error* error)
{
    ty_bounds interior = ty_container_interior(container);
    bool open = ty_container_is_open(container);
    float rx = 0.5f * (interior.high.x - interior.low.x), rz = 0.5f * (interior.high.z - interior.low.z);
    float steepest = open ? STEEPEST_CROWN * ty_min(rx, rz) : 0.0f;
    *top = (ty_fill_top){0.0f, ty_min(heap, steepest), rx, rz, ty_container_is_turned(container)};
    space s = {.container = container, .bounds = interior, .inset = inset};
    s.bounds.high.y += steepest;
    space_sample(&s);
    // First the level, with the crown as asked for; then, at a full vessel, the crown.
    for (int i = 0; i < s.count; i++)
        s.samples[i].key = s.samples[i].p.y + inset - top->crown * crown_share(top, s.samples[i].p);
    float rim = open ? interior.high.y - inset : TY_FLOAT_MAX;
    top->level = samples_cut(&s, volume, capacity);
    if (open && top->level > rim)
    {
        top->level = rim;
        for (int i = 0; i < s.count; i++)
        {
            float share = crown_share(top, s.samples[i].p), above = s.samples[i].p.y + inset - rim;
            s.samples[i].key = above <= 0.0f ? 0.0f : share > 1e-6f ? above / share : 1e3f;
        }
        top->crown = samples_cut(&s, volume, capacity);
        *capacity = 0.0;
        for (int i = 0; i < s.count && s.samples[i].key <= steepest; i++)
            *capacity += (double)s.samples[i].weight;
    }
    ty_free(s.samples);
    if (top->level < TY_FLOAT_MAX && top->crown <= ty_max(steepest, heap))
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "the container holds %.4g cm^3 of grains and space, not %.4g",
                        *capacity * 1e6, volume * 1e6);
}

double ty_fill_space(const ty_container* container, float level, float heap, float inset)
{
    ty_bounds interior = ty_container_interior(container);
    bool open = ty_container_is_open(container);
    float rx = 0.5f * (interior.high.x - interior.low.x), rz = 0.5f * (interior.high.z - interior.low.z);
    float crown = open ? ty_min(heap, STEEPEST_CROWN * ty_min(rx, rz)) : 0.0f;
    float top = level > 0.0f ? ty_min(interior.low.y + level, interior.high.y) : interior.high.y;
    ty_fill_top surface = {top, crown, rx, rz, ty_container_is_turned(container)};
    space s = {.container = container, .bounds = interior, .inset = inset};
    s.bounds.high.y += crown;
    space_sample(&s);
    double sum = 0.0;
    for (int i = 0; i < s.count; i++)
        if (s.samples[i].p.y + inset <= ty_fill_top_height(&surface, s.samples[i].p))
            sum += (double)s.samples[i].weight;
    ty_free(s.samples);
    return sum;
}

// --- Poisson-disk points ---

typedef struct darts
{
    space space;
    const ty_fill_top* top;
    float radius, cell;
    int size[3];
    int* at; // point of each cell, -1 = none: a cell is too small for two
    ty_vec3* points;
    int count;
    int64_t tries; // darts of a round
} darts;

static void dart_cell(const darts* d, ty_vec3 p, int c[3])
{
    ty_vec3 q = ty_sub(p, d->space.bounds.low);
    c[0] = (int)(q.x / d->cell), c[1] = (int)(q.y / d->cell), c[2] = (int)(q.z / d->cell);
}

static bool dart_is_clear(const darts* d, ty_vec3 p)
{
    int c[3];
    dart_cell(d, p, c);
    for (int k = c[2] - 2; k <= c[2] + 2; k++)
        for (int j = c[1] - 2; j <= c[1] + 2; j++)
            for (int i = c[0] - 2; i <= c[0] + 2; i++)
            {
                if (i < 0 || j < 0 || k < 0 || i >= d->size[0] || j >= d->size[1] || k >= d->size[2])
                    continue;
                int at = d->at[(k * d->size[1] + j) * d->size[0] + i];
                if (at >= 0 && ty_length_sqr(ty_sub(d->points[at], p)) < ty_sqr(d->radius))
                    return false;
            }
    return true;
}

static void dart_place(darts* d, int index)
{
    int c[3];
    dart_cell(d, d->points[index], c);
    d->at[(c[2] * d->size[1] + c[1]) * d->size[0] + c[0]] = index;
}

// Throws darts at one radius; keeps what is there.
static ty_status darts_round(darts* d, ty_rng* rng, int count, ty_error* error)
{
    ty_vec3 low = d->space.bounds.low, size = ty_sub(d->space.bounds.high, low);
    d->cell = d->radius / 1.7320508f;
    d->size[0] = (int)(size.x / d->cell) + 1, d->size[1] = (int)(size.y / d->cell) + 1;
    d->size[2] = (int)(size.z / d->cell) + 1;
    size_t cells = (size_t)d->size[0] * (size_t)d->size[1] * (size_t)d->size[2];
    d->at = cells < INT32_MAX ? TY_TRY_ALLOC(int, cells) : NULL;
    if (!d->at)
        return ty_error_set(error, TY_NO_MEMORY, "no memory to place %d grains", count);
    memset(d->at, 0xff, cells * sizeof(int));
    for (int i = 0; i < d->count; i++)
        dart_place(d, i);
    for (int64_t tries = d->tries; tries > 0 && d->count < count; tries--)
    {
        float u = ty_rng_float(rng), v = ty_rng_float(rng), w = ty_rng_float(rng);
        ty_vec3 p = ty_add(low, ty_mul3(size, ty_vec3_make(u, v, w)));
        if (p.y > ty_fill_top_height(d->top, p) - d->space.inset || !dart_is_clear(d, p) || !space_holds(&d->space, p))
            continue;
        d->points[d->count] = p;
        dart_place(d, d->count++);
    }
    ty_free(d->at);
    return TY_OK;
}

typedef struct sort_key
{
    uint64_t code;
    ty_vec3 p;
} sort_key;

static int sort_order(const void* a, const void* b)
{
    const sort_key *p = a, *q = b;
    if (p->code != q->code)
        return p->code < q->code ? -1 : 1;
    if (p->p.y != q->p.y)
        return p->p.y < q->p.y ? -1 : 1;
    return p->p.x != q->p.x ? (p->p.x > q->p.x) - (p->p.x < q->p.x) : (p->p.z > q->p.z) - (p->p.z < q->p.z);
}

// Every third bit.
static uint64_t bits_spread(uint64_t x)
{
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

// Along a curve through cells on which neighbours in space are neighbours in memory (Morton 1966).
static void points_sort(ty_vec3* points, int count, ty_vec3 low, float cell)
{
    sort_key* keys = TY_ALLOC(sort_key, count);
    for (int i = 0; i < count; i++)
    {
        ty_vec3 at = ty_mul(ty_sub(points[i], low), 1.0f / cell);
        uint64_t x = bits_spread((uint64_t)ty_clamp(at.x, 0.0f, 65535.0f));
        uint64_t y = bits_spread((uint64_t)ty_clamp(at.y, 0.0f, 65535.0f));
        uint64_t z = bits_spread((uint64_t)ty_clamp(at.z, 0.0f, 65535.0f));
        keys[i] = (sort_key){x | z << 1 | y << 2, points[i]};
    }
    qsort(keys, (size_t)count, sizeof *keys, sort_order);
    for (int i = 0; i < count; i++)
        points[i] = keys[i].p;
    ty_free(keys);
}

ty_status ty_fill_seeds(const ty_container* container, const ty_fill_top* top, float inset, double volume, ty_seed seed,
                        int count, ty_vec3* out, ty_error* error)
{
    darts d = {.space = {.container = container, .bounds = ty_container_interior(container), .inset = inset},
               .top = top,
               .points = out};
    d.space.bounds.high.y = ty_min(d.space.bounds.high.y, top->level) + top->crown;
    // A saturated set has about .73 / r^3 points a volume; at nine tenths of that radius few darts are wasted.
    double each = volume / (double)count;
    d.radius = 0.9f * ty_pow((float)(0.73 * each), 1.0f / 3.0f);
    float cell = 2.0f * d.radius;
    ty_vec3 box = ty_sub(d.space.bounds.high, d.space.bounds.low);
    double hits = ty_max(1e-4f, (float)volume / (box.x * box.y * box.z)); // share of the darts that fall into the space
    d.tries = (int64_t)(60.0 * (double)count / hits);
    ty_rng rng = ty_rng_make(seed, 0x6461727473, 0);
    for (int round = 0; round < 14 && d.count < count; round++, d.radius *= 0.94f)
    {
        ty_status status = darts_round(&d, &rng, count, error);
        if (status != TY_OK)
            return status;
    }
    if (d.count < count)
        return ty_error_set(error, TY_BAD_INPUT, "only %d of %d grains find a place in the container", d.count, count);
    points_sort(out, count, d.space.bounds.low, cell);
    return TY_OK;
}
