// SPDX-License-Identifier: Apache-2.0
// How tips move: along the host where they can hold on, else falling past it. All go on side by side, as far one as the
// other.
#include "roots_march.h"

#define WEDGE 4.0f // what leads back from wedges, as a weight

enum
{
    MOST_STEPS = 4000, // of a root
};

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
    float most = (def->hold + t->flat) * t->r, over = t->p.y - m->g->host->floor;
    if (normal->y <= -ty_sin(def->overhang) && m->g->host->has_floor && over < most) // under the host, but on the floor
    {
        *distance = over;
        *normal = (ty_vec3){0.0f, 1.0f, 0.0f};
    }
    // what hangs takes hold where it can stand
    return *distance < most && normal->y > (t->kind == ROOTS_AERIAL ? 0.7f : -ty_sin(def->overhang));
}

// The normal over which a tip moves on: between that where it is and that of what comes up before it, so that it
// rounds inner corners. *out leads back from wedges, where both look at each other.
static ty_vec3 normal_ahead(const march* m, const tip* t, ty_vec3 n, ty_vec3* out)
{
    ty_vec3 before, p = ty_mad(ty_mad(t->p, t->t, 1.5f * t->r), n, 0.75f * t->r);
    float distance = roots_host_value(m->g->host, p, &before);
    before = ty_normalize(before);
    float near = ty_clamp(1.5f - distance / t->r, 0.0f, 1.0f), against = ty_dot(n, before);
    ty_vec3 aside = growth_without(before, n), sum = ty_mad(n, before, near * ty_min(1.0f + against, 1.0f));
    *out = ty_mul(aside, near * ty_max(-against, 0.0f) / ty_max(ty_length(aside), 0.1f));
    return ty_length(sum) > 1e-3f ? ty_normalize(sum) : n;
}

static float tip_stride(const march* m, const tip* t)
{
    return ty_min(m->step, ty_max(0.55f * t->r, 0.75f * m->g->recipe->tip));
}

static void tip_turn(march* m, int index, bool holds, float distance, ty_vec3 n, float step)
{
    tip* t = &m->tips[index];
    ty_vec3 out = {0.0f, 0.0f, 0.0f};
    if (holds)
        n = normal_ahead(m, t, n, &out);
    ty_vec3 force = ty_mad(course_force(m, index, holds, n), out, WEDGE);
    ty_vec3 direction = ty_mad(t->t, force, step / (m->g->recipe->growth.stiffness * t->r));
    direction = ty_mad(direction, out, -ty_min(ty_dot(direction, out), 0.0f)); // no farther in
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
    float angle = t->turn + t->twist * t->along + 0.25f * course_chance(m, t, 0, 1, t->s, 0.5f), sine, cosine;
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
        t->t = ty_normalize(ty_mad(t->t, course_outwards(m, t->p), 0.6f));
    }
}

// Notes the points of a ruler that lie on the last step, and where it ends. Marks are multiples of a power of two,
// about half a radius apart, so that they stay where they are when radii change a little.
static void tip_mark(const march* m, tip* t, const roots_point* now, ty_vec3 was, float step)
{
    float apart = ty_max(0.55f * t->r, 0.75f * m->g->recipe->tip), end = t->s - t->begin_s;
    float mark = ty_exp(ty_ln(2.0f) * floorf(ty_ln(apart) / ty_ln(2.0f) + 1e-3f));
    float last = t->points[t->count - 1].s - t->begin_s;
    for (float at = mark * (floorf(last / mark + 1e-3f) + 1.0f); at <= end; at += mark)
    {
        roots_point point = *now;
        point.s = t->begin_s + at;
        point.p = ty_lerp3(now->p, was, ty_clamp((end - at) / step, 0.0f, 1.0f));
        tip_note(t, &point);
        last = at;
    }
    if (t->alive || end - last < 0.01f * mark)
        return;
    if (end - last < 0.5f * mark && t->count > 1)
        t->count--;
    tip_note(t, now);
}

static void tip_step(march* m, int index)
{
    const ty_roots_recipe* recipe = m->g->recipe;
    tip* t = &m->tips[index];
    float step = tip_stride(m, t), distance;
    ty_vec3 n, was = t->p;
    bool descends = t->along < 1.0f, holds = !descends && tip_holds(m, t, &distance, &n);
    if (descends)
        tip_descend(m, t, step);
    else
    {
        tip_turn(m, index, holds, holds ? distance : 0.0f, n, step);
        t->p = ty_mad(t->p, t->t, step);
        course_clear(m, t);
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
    if (inside || ty_length(ty_sub(t->p, was)) < 0.1f * step)
    {
        t->alive = false; // in a gap that is too narrow for it
        return;
    }
    t->alive = t->r > recipe->tip && t->s < t->begin_s + recipe->length && t->count < MOST_STEPS;
    roots_point point = tip_point(m, t, holds);
    tip_mark(m, t, &point, was, step);
    if (holds)
        course_pass(m, index, step);
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
    ty_bounds b = g->host->mesh->bounds;
    m->cell = g->recipe->growth.distance * g->recipe->radius;
    m->step = ty_max(0.2f * g->recipe->radius, 0.75f * g->recipe->tip);
    float round = TY_PI * 0.5f * (b.high.x - b.low.x + b.high.z - b.low.z); // about the host
    m->wide = ty_max(0.5f * round / (float)(g->recipe->count > 8 ? g->recipe->count : 8), 1.5f * g->recipe->radius);
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
    float way = 0.0f;
    for (bool alive = true; alive && !ty_cancel_requested();)
    {
        alive = false;
        way += m->step;
        for (int i = 0; i < m->tip_count; i++)
        {
            while (m->tips[i].alive && m->tips[i].s - m->tips[i].begin_s < way)
                tip_step(m, i);
            alive |= m->tips[i].alive;
        }
    }
    for (int i = 0; i < m->tip_count; i++)
        tip_finish(m, &m->tips[i]);
}

// It comes down straight and leans over where it stands: a Bezier curve of second order.
ty_vec3 march_trunk(const march* m, float along, ty_vec3* direction)
{
    ty_vec3 bend = {m->top.x, ty_lerp(m->top.y, m->foot.y, 0.6f), m->top.z};
    bend = ty_lerp3(bend, ty_lerp3(m->top, m->foot, 0.6f), 0.5f);
    ty_vec3 a = ty_lerp3(m->top, bend, along), b = ty_lerp3(bend, m->foot, along);
    *direction = ty_normalize(ty_sub(b, a));
    return ty_lerp3(a, b, along);
}
