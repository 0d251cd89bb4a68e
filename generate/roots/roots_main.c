// SPDX-License-Identifier: Apache-2.0
// Main roots: a tip turns towards the ground, by chance and away from others, along the host where it can hold on. All
// go on side by side, each with a chance of its own that is a function of the way it has gone.
#include "roots_growth.h"
#include <tsuya/base/noise.h>

enum
{
    MOST_STEPS = 4000, // of a root
    CELLS = 1 << 16,   // of the table of places
};

typedef struct tip
{
    ty_vec3 p, t, n; // place, direction, away from the host
    float begin_r, r, flat, s, begin_s;
    uint64_t key;
    roots_kind kind;
    int parent, parent_point;
    bool alive;
    roots_point* points;
    int count, capacity;
} tip;

// Where roots have been: lists by the cell of a grid, in a table by hash.
typedef struct trace
{
    ty_vec3 p;
    int tip, next;
} trace;

typedef struct march
{
    const growth* g;
    tip* tips;
    int tip_count;
    float cell; // m
    int heads[CELLS];
    trace* traces;
    int trace_count, trace_capacity;
} march;

static const ty_vec3 down = {0.0f, -1.0f, 0.0f};

// --- where others are ---

static uint32_t cell_hash(int x, int y, int z)
{
    uint32_t h = ty_mix32((uint32_t)x) ^ ty_mix32((uint32_t)y * 3u + 1u) ^ ty_mix32((uint32_t)z * 5u + 2u);
    return ty_mix32(h) % CELLS;
}

static void trace_add(march* m, ty_vec3 p, int whose)
{
    if (m->trace_count == m->trace_capacity)
    {
        int capacity = m->trace_capacity ? 2 * m->trace_capacity : 4096;
        m->traces = ty_grow(m->traces, (size_t)m->trace_capacity, (size_t)capacity, sizeof(trace));
        m->trace_capacity = capacity;
    }
    ty_vec3 q = ty_mul(p, 1.0f / m->cell);
    int* head = &m->heads[cell_hash((int)floorf(q.x), (int)floorf(q.y), (int)floorf(q.z))];
    m->traces[m->trace_count] = (trace){p, whose, *head};
    *head = m->trace_count++;
}

// Away from the roots that are near, at most of length 1.
static ty_vec3 repulsion(const march* m, int own, ty_vec3 p)
{
    ty_vec3 q = ty_mul(p, 1.0f / m->cell), sum = {0.0f, 0.0f, 0.0f};
    int low[3] = {(int)floorf(q.x) - 1, (int)floorf(q.y) - 1, (int)floorf(q.z) - 1};
    for (int c = 0; c < 27; c++)
    {
        uint32_t cell = cell_hash(low[0] + c % 3, low[1] + c / 3 % 3, low[2] + c / 9);
        for (int i = m->heads[cell]; i >= 0; i = m->traces[i].next)
        {
            ty_vec3 away = ty_sub(p, m->traces[i].p);
            float d = ty_length(away);
            if (m->traces[i].tip != own && d < m->cell && d > 0.0f)
                sum = ty_mad(sum, away, ty_sqr(1.0f - d / m->cell) / d);
        }
    }
    float length = ty_length(sum);
    return length > 1.0f ? ty_mul(sum, 1.0f / length) : sum;
}

// --- one step ---

static void tip_note(tip* t, const roots_point* point)
{
    if (t->count == t->capacity)
    {
        int capacity = t->capacity ? 2 * t->capacity : 256;
        t->points = ty_grow(t->points, (size_t)t->capacity, (size_t)capacity, sizeof(roots_point));
        t->capacity = capacity;
    }
    t->points[t->count++] = *point;
}

static roots_point tip_point(const march* m, const tip* t, bool holds)
{
    const ty_roots_growth_def* def = &m->g->recipe->growth;
    return (roots_point){.p = t->p, .n = t->n, .r = t->r, .flat = t->flat, .sink = holds ? def->sink : 0.0f, .s = t->s};
}

static bool tip_holds(const march* m, const tip* t, float* distance, ty_vec3* normal)
{
    const ty_roots_growth_def* def = &m->g->recipe->growth;
    *distance = roots_host_value(m->g->host, t->p, normal);
    *normal = ty_normalize(*normal);
    return *distance < (def->hold + t->flat) * t->r && normal->y > -ty_sin(def->overhang);
}

// Chance as a function of the way: -1..1, much the same over `wave` radii.
static float chance(const march* m, const tip* t, int which)
{
    const ty_roots_recipe* recipe = m->g->recipe;
    float x = (t->s - t->begin_s) / (recipe->growth.wave * t->begin_r);
    uint32_t seed = (uint32_t)ty_mix64(recipe->seed.value ^ t->key);
    return ty_value_noise(ty_vec3_make(x, 0.5f + (float)which * 13.0f, 0.5f), seed);
}

static void tip_turn(march* m, int index, bool holds, ty_vec3 n, float step)
{
    const ty_roots_growth_def* def = &m->g->recipe->growth;
    tip* t = &m->tips[index];
    ty_vec3 side = ty_normalize(ty_cross(holds ? n : t->n, t->t)), up = ty_cross(t->t, side);
    float free = holds ? 1.0f : 0.35f;
    ty_vec3 force = ty_mul(down, holds ? def->gravity : 1.5f * def->gravity);
    force = ty_mad(force, side, free * def->wander * chance(m, t, 0));
    force = ty_mad(force, up, holds ? 0.0f : free * def->wander * chance(m, t, 1));
    if (holds && def->repel != 0.0f)
        force = ty_mad(force, repulsion(m, index, t->p), def->repel);
    if (holds)
        force = growth_without(force, n);
    ty_vec3 direction = ty_mad(t->t, force, step / (def->stiffness * t->r));
    if (holds)
        direction = growth_without(direction, n);
    if (ty_length(direction) > 1e-4f)
        t->t = ty_normalize(direction);
}

// Moves the centre to its height over the host, by no more than half a step so that it comes down gently.
static void tip_settle(const march* m, tip* t, float step)
{
    ty_vec3 n = t->n;
    for (int i = 0; i < 3; i++)
    {
        float wrong = roots_host_value(m->g->host, t->p, &n) - (t->flat - m->g->recipe->growth.sink) * t->r;
        n = ty_normalize(n);
        t->p = ty_mad(t->p, n, -ty_clamp(wrong, -step, 0.5f * step));
    }
    t->n = ty_normalize(ty_lerp3(t->n, n, 0.5f));
}

static void tip_step(march* m, int index)
{
    const ty_roots_recipe* recipe = m->g->recipe;
    tip* t = &m->tips[index];
    float step = ty_max(0.5f * t->r, 0.75f * recipe->tip), distance;
    ty_vec3 n;
    bool holds = tip_holds(m, t, &distance, &n);
    tip_turn(m, index, holds, n, step);
    t->p = ty_mad(t->p, t->t, step);
    t->flat = ty_lerp(t->flat, holds ? recipe->growth.flatten : 1.0f, 0.15f);
    if (holds)
        tip_settle(m, t, step);
    ty_vec3 upright = growth_without(t->n, t->t);
    t->n = ty_length(upright) > 1e-3f ? ty_normalize(upright) : ty_frame_from_normal(t->t).t;
    t->s += step;
    bool lies = m->g->host->has_floor && t->p.y < m->g->host->floor + 2.0f * t->r; // on the floor it thins out sooner
    t->r *= ty_exp(-step * (lies ? 2.5f : 1.0f) / recipe->taper);
    roots_point point = tip_point(m, t, holds);
    tip_note(t, &point);
    if (holds)
        trace_add(m, t->p, index);
    t->alive = t->r > recipe->tip && t->s < t->begin_s + recipe->length && t->count < MOST_STEPS;
}

// --- beginnings ---

static tip* tip_add(march* m, tip t)
{
    m->tips = ty_grow(m->tips, (size_t)m->tip_count, (size_t)m->tip_count + 1, sizeof(tip));
    t.begin_r = t.r;
    t.begin_s = t.s;
    t.alive = true;
    m->tips[m->tip_count] = t;
    return &m->tips[m->tip_count++];
}

static ty_vec3 host_top(const growth* g)
{
    ty_bounds b = g->host->mesh->bounds;
    ty_vec3 foot = ty_mul(ty_add(b.low, b.high), 0.5f);
    foot.y = b.high.y;
    return foot;
}

// Around the trunk's cut, or around the highest place of the host where there is no trunk.
static void tips_begin(march* m, ty_vec3 top)
{
    const ty_roots_recipe* recipe = m->g->recipe;
    ty_rng rng = ty_rng_make(recipe->seed, 0x7472756e, 0);
    float turn = ty_rng_range(&rng, 0.0f, 2.0f * TY_PI);
    bool trunk = recipe->trunk.height > 0.0f;
    for (int i = 0; i < recipe->count; i++)
    {
        float jitter = ty_rng_range(&rng, -0.3f, 0.3f), thick = ty_rng_range(&rng, -1.0f, 1.0f);
        float twist = ty_rng_range(&rng, -0.35f, 0.35f);
        float angle = turn + 2.0f * TY_PI * ((float)i + jitter) / (float)recipe->count, sine, cosine;
        ty_sincos(angle, &sine, &cosine);
        ty_vec3 out = {cosine, 0.0f, sine}, around = {-sine, 0.0f, cosine}, n = out;
        tip t = {.r = recipe->radius * (1.0f + recipe->variation * thick), .flat = 1.0f, .kind = ROOTS_MAIN};
        t.p = ty_mad(top, out, ty_max(recipe->trunk.radius - 0.5f * t.r, 0.2f * recipe->trunk.radius));
        if (!trunk)
        {
            t.flat = recipe->growth.flatten;
            t.p = roots_host_project(m->g->host, t.p, (t.flat - recipe->growth.sink) * t.r, &n);
        }
        t.n = n;
        t.t = ty_normalize(ty_add(ty_mad(trunk ? down : ty_mul(out, 0.8f), out, 0.2f), ty_mul(around, twist)));
        t.key = ty_mix64((uint64_t)i + 1);
        t.parent = t.parent_point = -1;
        roots_point point = tip_point(m, &t, !trunk);
        tip_note(tip_add(m, t), &point);
    }
}

// --- ends ---

// A root that stops at its longest still ends in a tip.
static void end_taper(tip* t, float thinnest)
{
    roots_point* last = &t->points[t->count - 1];
    float reach = 12.0f * last->r, end = last->s;
    for (int i = 0; i < t->count; i++)
    {
        float left = ty_clamp((end - t->points[i].s) / reach, 0.0f, 1.0f);
        t->points[i].r = ty_max(ty_min(t->points[i].r, thinnest), t->points[i].r * sqrtf(left));
    }
}

static void tip_finish(march* m, tip* t)
{
    roots_network* network = m->g->network;
    end_taper(t, m->g->recipe->tip);
    roots_line line = {.first = network->point_count,
                       .count = t->count,
                       .kind = t->kind,
                       .parent = t->parent,
                       .parent_point = t->parent_point,
                       .end = -1,
                       .end_point = -1,
                       .key = t->key};
    for (int i = 0; i < t->count; i++)
        roots_network_add_point(network, &t->points[i]);
    roots_network_add_line(network, &line);
    network->requested[t->kind]++;
    network->grown[t->kind]++;
}

// The heart of the trunk, from its cut to a little below the host's top: what the main roots run down along.
static void heart_add(growth* g, ty_vec3 foot, ty_vec3 top)
{
    const ty_roots_trunk_def* def = &g->recipe->trunk;
    enum
    {
        PIECES = 8
    };
    roots_line line = {.first = g->network->point_count,
                       .count = PIECES + 1,
                       .kind = ROOTS_TRUNK,
                       .parent = -1,
                       .parent_point = -1,
                       .end = -1,
                       .end_point = -1};
    for (int i = 0; i <= PIECES; i++)
    {
        float along = (float)i / PIECES;
        roots_point point = {.p = ty_lerp3(top, foot, along),
                             .n = {1.0f, 0.0f, 0.0f},
                             .r = 0.8f * def->radius,
                             .flat = 1.0f,
                             .s = along * def->height};
        roots_network_add_point(g->network, &point);
    }
    roots_network_add_line(g->network, &line);
}

bool growth_main(growth* g)
{
    const ty_roots_recipe* recipe = g->recipe;
    march* m = TY_ALLOC(march, 1);
    ty_vec3 foot = host_top(g), top = ty_add(foot, recipe->trunk.lean);
    m->g = g;
    m->cell = recipe->growth.distance * recipe->radius;
    for (int i = 0; i < CELLS; i++)
        m->heads[i] = -1;
    top.y += recipe->trunk.height;
    g->network->top = recipe->trunk.height > 0.0f ? top.y : TY_FLOAT_MAX;
    if (recipe->trunk.height > 0.0f)
        heart_add(g, ty_mad(foot, down, 0.5f * recipe->trunk.radius), top);
    tips_begin(m, top);
    for (bool alive = true; alive && !ty_cancel_requested();)
    {
        alive = false;
        for (int i = 0; i < m->tip_count; i++)
        {
            if (m->tips[i].alive)
                tip_step(m, i);
            alive |= m->tips[i].alive;
        }
    }
    for (int i = 0; i < m->tip_count; i++)
    {
        tip_finish(m, &m->tips[i]);
        ty_free(m->tips[i].points);
    }
    ty_free(m->tips);
    ty_free(m->traces);
    ty_free(m);
    return !ty_cancel_requested();
}
