// SPDX-License-Identifier: Apache-2.0
// How tips find their way: towards the ground, by chance and away from others, along the host where they can hold on.
// All go on side by side, each with a chance of its own that is a function of the way it has gone.
#include "roots_march.h"
#include <tsuya/base/noise.h>

enum
{
    MOST_STEPS = 4000, // of a root
};

static const ty_vec3 down = {0.0f, -1.0f, 0.0f};

// --- where others are ---

static uint32_t cell_hash(int x, int y, int z)
{
    uint32_t h = ty_mix32((uint32_t)x) ^ ty_mix32((uint32_t)y * 3u + 1u) ^ ty_mix32((uint32_t)z * 5u + 2u);
    return ty_mix32(h) % MARCH_CELLS;
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
    if (t->s - t->begin_s < t->free)
        return false;
    return *distance < (def->hold + t->flat) * t->r && normal->y > -ty_sin(def->overhang);
}

// The next shorter length of a ladder with four rungs to the doubling, so that slightly other radii lead to the same
// steps and the same chance.
static float rung(float length)
{
    return ty_exp(0.25f * ty_ln(2.0f) * floorf(4.0f * ty_ln(length) / ty_ln(2.0f)));
}

static float tip_stride(const march* m, const tip* t)
{
    return rung(ty_max(0.55f * t->r, 0.75f * m->g->recipe->tip));
}

// Chance as a function of the way: -1..1, much the same over about `wave` radii.
static float chance(const march* m, const tip* t, int which)
{
    const ty_roots_recipe* recipe = m->g->recipe;
    float x = (t->s - t->begin_s) / rung(1.1f * recipe->growth.wave * recipe->radius);
    uint32_t seed = (uint32_t)ty_mix64(recipe->seed.value ^ t->key);
    return ty_value_noise(ty_vec3_make(x, 0.5f + (float)which * 13.0f, 0.5f), seed);
}

// Horizontally away from the foot of the trunk.
static ty_vec3 outwards(const march* m, ty_vec3 p)
{
    ty_vec3 away = ty_sub(p, m->foot);
    away.y = 0.0f;
    float length = ty_length(away);
    return length > 1e-9f ? ty_mul(away, 1.0f / length) : (ty_vec3){0.0f, 0.0f, 0.0f};
}

// What is painted on the host, felt over some radii; and obstacles, which nothing outweighs.
static ty_vec3 painted(const march* m, const tip* t)
{
    const ty_roots_growth_def* def = &m->g->recipe->growth;
    const roots_host* host = m->g->host;
    ty_vec3 sum = {0.0f, 0.0f, 0.0f}, g;
    const float weights[ROOTS_MASKS] = {[ROOTS_AVOID] = -def->avoid, [ROOTS_ATTRACT] = def->attract};
    for (int k = 0; k < ROOTS_MASKS; k++)
    {
        roots_host_mask(host, (roots_mask)k, t->p, &g);
        g = ty_mul(g, 6.0f * t->r);
        sum = ty_mad(sum, g, weights[k] / ty_max(ty_length(g), 1.0f));
    }
    float keep = def->clear * t->r, clear = roots_host_clear(host, t->p, &g);
    if (clear < 3.0f * keep && ty_length_sqr(g) > 0.0f)
        sum = ty_mad(sum, ty_normalize(g), 4.0f * ty_clamp(1.5f - 0.5f * clear / keep, 0.0f, 1.0f));
    return sum;
}

// Out of the way of obstacles.
static void tip_clear(const march* m, tip* t)
{
    ty_vec3 g;
    float lack = m->g->recipe->growth.clear * t->r - roots_host_clear(m->g->host, t->p, &g);
    if (lack > 0.0f && ty_length_sqr(g) > 0.0f)
        t->p = ty_mad(t->p, ty_normalize(g), ty_min(lack, 0.5f * t->r));
}

static void tip_turn(march* m, int index, bool holds, float distance, ty_vec3 n, float step)
{
    const ty_roots_growth_def* def = &m->g->recipe->growth;
    tip* t = &m->tips[index];
    ty_vec3 side = ty_normalize(ty_cross(holds ? n : t->n, t->t)), up = ty_cross(t->t, side);
    float free = holds ? 1.0f : 0.3f, level = holds ? ty_sqr(ty_max(n.y, 0.0f)) : 0.0f;
    ty_vec3 force = ty_mul(down, holds ? def->gravity : 1.5f * def->gravity);
    force = ty_mad(force, side, free * def->wander * chance(m, t, 0));
    force = ty_mad(force, up, holds ? 0.0f : free * def->wander * chance(m, t, 1));
    force = ty_mad(force, outwards(m, t->p), def->gravity * level); // where down says nothing
    if (holds && def->repel != 0.0f)
        force = ty_mad(force, repulsion(m, index, t->p), def->repel);
    force = ty_add(force, painted(m, t));
    if (holds)
        force = growth_without(force, n);
    ty_vec3 direction = ty_mad(t->t, force, step / (def->stiffness * t->r));
    if (holds) // what comes down upon it bends before it gets there
    {
        float near = ty_clamp(1.5f - 0.5f * distance / t->r, 0.25f, 1.0f);
        direction = ty_mad(direction, n, -near * ty_dot(direction, n));
    }
    if (ty_length(direction) > 1e-4f)
        t->t = ty_normalize(direction);
}

// What does not hold goes past the host, never into it.
static void tip_avoid(const march* m, tip* t)
{
    ty_vec3 n;
    float inside = t->flat * t->r - roots_host_value(m->g->host, t->p, &n);
    if (inside <= 0.0f || t->s - t->begin_s < t->free)
        return;
    n = ty_normalize(n);
    t->p = ty_mad(t->p, n, ty_min(inside, 0.5f * t->r));
    if (ty_dot(t->t, n) < 0.0f)
        t->t = ty_normalize(ty_mad(t->t, n, -ty_dot(t->t, n) + 1e-3f));
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

static float tip_taper(const march* m, const tip* t, bool holds)
{
    const ty_roots_recipe* recipe = m->g->recipe;
    bool lies = m->g->host->has_floor && t->p.y < m->g->host->floor + 2.0f * t->r; // there it thins out sooner
    float speed = (lies ? 2.5f : holds || t->kind == ROOTS_MAIN ? 1.0f : 0.3f) / recipe->taper;
    float left = recipe->length - (t->s - t->begin_s); // it comes to a tip, however long it may be
    if (left < 0.4f * recipe->length)
        speed = ty_max(speed, ty_ln(t->r / recipe->tip) / ty_max(left, recipe->tip));
    return ty_exp(-tip_stride(m, t) * speed);
}

// Down the trunk as one of its strands, wider where it stands.
static void tip_descend(march* m, tip* t, float step)
{
    const ty_roots_trunk_def* def = &m->g->recipe->trunk;
    ty_vec3 axis, was = t->p;
    float length = ty_length(ty_sub(m->top, m->foot));
    t->along = ty_min(1.0f, t->along + step / ty_max(length, step));
    ty_vec3 middle = march_trunk(m, t->along, &axis);
    float angle = t->turn + t->twist * t->along + 0.25f * chance(m, t, 0), sine, cosine;
    ty_sincos(angle, &sine, &cosine);
    ty_vec3 out = ty_normalize(growth_without((ty_vec3){cosine, 0.0f, sine}, axis));
    float foot = ty_sqr(t->along) * t->along, wide = ty_max(def->radius - 0.5f * t->r, 0.2f * def->radius);
    t->p = ty_mad(middle, out, wide * (1.0f + 0.8f * foot));
    ty_vec3 way = ty_sub(t->p, was);
    t->t = ty_length(way) > 0.0f ? ty_normalize(way) : axis;
    t->n = out;
    ty_vec3 n;
    float distance = roots_host_value(m->g->host, t->p, &n);
    if (t->along >= 1.0f || distance < 1.6f * t->r)
    {
        t->along = 1.0f;
        t->t = ty_normalize(ty_mad(t->t, outwards(m, t->p), 0.6f));
    }
}

static void tip_step(march* m, int index)
{
    const ty_roots_recipe* recipe = m->g->recipe;
    tip* t = &m->tips[index];
    float step = tip_stride(m, t), distance;
    ty_vec3 n;
    bool descends = t->along < 1.0f, holds = !descends && tip_holds(m, t, &distance, &n);
    if (descends)
        tip_descend(m, t, step);
    else
    {
        tip_turn(m, index, holds, holds ? distance : 0.0f, n, step);
        t->p = ty_mad(t->p, t->t, step);
        tip_clear(m, t);
    }
    t->flat = ty_lerp(t->flat, holds ? recipe->growth.flatten : 1.0f, 0.15f);
    if (holds)
        tip_settle(m, t, step);
    else if (!descends)
        tip_avoid(m, t);
    ty_vec3 upright = growth_without(t->n, t->t);
    t->n = ty_length(upright) > 1e-3f ? ty_normalize(upright) : ty_frame_from_normal(t->t).t;
    t->s += step;
    t->r *= descends ? 1.0f : tip_taper(m, t, holds);
    bool inside = !descends && t->s - t->begin_s > t->free && roots_host_value(m->g->host, t->p, NULL) < 0.0f;
    if (inside || ty_length(ty_sub(t->p, t->points[t->count - 1].p)) < 0.1f * step)
    {
        t->alive = false; // in a gap that is too narrow for it
        return;
    }
    roots_point point = tip_point(m, t, holds);
    tip_note(t, &point);
    if (holds)
        trace_add(m, t->p, index);
    t->alive = t->r > recipe->tip && t->s < t->begin_s + recipe->length && t->count < MOST_STEPS;
}

// --- ends ---

// A root that stops at its longest still ends in a tip; on the ground it sinks in.
static void end_taper(const march* m, tip* t)
{
    roots_point* last = &t->points[t->count - 1];
    float thinnest = m->g->recipe->tip, end = last->s;
    float reach = 20.0f * ty_max(last->r - thinnest, 0.0f) + 1e-9f, under = 20.0f * last->r;
    bool lies = m->g->host->has_floor && last->sink > 0.0f && last->p.y < m->g->host->floor + 2.0f * last->r;
    for (int i = 0; i < t->count; i++)
    {
        roots_point* p = &t->points[i];
        float left = ty_clamp((end - p->s) / reach, 0.0f, 1.0f);
        float deep = ty_smoothstep(ty_clamp(1.0f - (end - p->s) / under, 0.0f, 1.0f));
        p->r = ty_max(ty_min(p->r, thinnest), p->r * sqrtf(left));
        if (lies && p->sink > 0.0f)
            p->sink = ty_lerp(p->sink, ty_max(p->sink, 0.55f), deep);
    }
}

static void tip_finish(march* m, tip* t)
{
    roots_network* network = m->g->network;
    end_taper(m, t);
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

// --- all of them ---

march* march_create(const growth* g)
{
    march* m = TY_ALLOC(march, 1);
    m->g = g;
    m->cell = g->recipe->growth.distance * g->recipe->radius;
    for (int i = 0; i < MARCH_CELLS; i++)
        m->heads[i] = -1;
    return m;
}

void march_destroy(march* m)
{
    for (int i = 0; i < m->tip_count; i++)
        ty_free(m->tips[i].points);
    ty_free(m->tips);
    ty_free(m->traces);
    ty_free(m);
}

void march_add(march* m, tip t)
{
    m->tips = ty_grow(m->tips, (size_t)m->tip_count, (size_t)m->tip_count + 1, sizeof(tip));
    t.begin_r = t.r;
    t.begin_s = t.s;
    t.alive = true;
    roots_point point = tip_point(m, &t, t.kind == ROOTS_MAIN && t.along >= 1.0f);
    m->tips[m->tip_count] = t;
    tip_note(&m->tips[m->tip_count++], &point);
}

void march_run(march* m)
{
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
        tip_finish(m, &m->tips[i]);
}
