// SPDX-License-Identifier: Apache-2.0
// Branches that grow from one root into another and close the net: which to which, then each drawn over the host.
#include "roots_growth.h"
#include <string.h>

enum
{
    PARTNERS = 3, // that are tried, the nearest first
    MARGIN = 4,   // points of a line, at both ends, where none begins or ends
};

typedef struct plan
{
    int line, point; // where it begins
    int partner_count;
    int partners[PARTNERS], partner_points[PARTNERS];
    float share;
    uint64_t key;
    bool grown;
    int used; // partner
    float r;
    wrap* curve; // owned
} plan;

typedef struct linking
{
    growth* g;
    const ty_roots_link_def* def;
    roots_kind from, to;
    plan* plans;
    int count, capacity;
} linking;

// --- partners ---

typedef struct partner
{
    int line, point;
    float distance;
} partner;

// Its nearest point that lies on the given side.
static partner line_nearest(const roots_network* net, int line, const roots_point* p, ty_vec3 side, float reach)
{
    partner best = {line, -1, reach};
    const roots_line* l = &net->lines[line];
    for (int i = l->first + MARGIN; i < l->first + l->count - MARGIN; i++)
    {
        ty_vec3 way = ty_sub(net->points[i].p, p->p);
        float d = ty_length(way);
        if (net->points[i].sink > 0.0f && d < best.distance && ty_dot(way, side) > 0.3f * d &&
            d > 1.5f * (p->r + net->points[i].r))
            best = (partner){line, i, d};
    }
    return best;
}

// Goes down the line by a length.
static int downstream(const roots_network* net, int line, int point, float way)
{
    const roots_line* l = &net->lines[line];
    float from = net->points[point].s;
    int last = l->first + l->count - 1 - MARGIN, i = point;
    while (i < last && net->points[i].s < from + way && net->points[i + 1].sink > 0.0f)
        i++;
    while (i > l->first + MARGIN && net->points[i].s > from + way && net->points[i - 1].sink > 0.0f)
        i--;
    return i;
}

static void plan_partners(const linking* k, plan* p, float side)
{
    const roots_network* net = k->g->network;
    const roots_point* at = &net->points[p->point];
    ty_vec3 t = growth_tangent(net, &net->lines[p->line], p->point), across = ty_mul(ty_cross(at->n, t), side);
    partner best[PARTNERS];
    for (int line = 0; line < net->line_count; line++)
    {
        if (line == p->line || net->lines[line].kind != k->from)
            continue;
        partner one = line_nearest(net, line, at, across, k->def->reach);
        for (int i = 0; one.point >= 0 && i < PARTNERS; i++)
            if (i >= p->partner_count || one.distance < best[i].distance)
            {
                int moved = p->partner_count < PARTNERS ? p->partner_count : PARTNERS - 1;
                memmove(best + i + 1, best + i, (size_t)(moved - i) * sizeof(partner));
                best[i] = one;
                p->partner_count += p->partner_count < PARTNERS;
                break;
            }
    }
    for (int i = 0; i < p->partner_count; i++)
    {
        p->partners[i] = best[i].line;
        p->partner_points[i] = downstream(net, best[i].line, best[i].point, k->def->slant * best[i].distance);
    }
}

static void plan_add(linking* k, int line, int point, ty_rng* rng)
{
    uint64_t key = ty_mix64(k->g->network->lines[line].key ^ (uint64_t)(point - k->g->network->lines[line].first) << 8 ^
                            (uint64_t)k->to);
    plan p = {.line = line, .point = point, .key = key};
    p.share = ty_rng_range(rng, k->def->share[0], k->def->share[1]);
    plan_partners(k, &p, ty_rng_float(rng) < 0.85f ? 1.0f : -1.0f);
    if (p.partner_count == 0)
        return;
    if (k->count == k->capacity)
    {
        int capacity = k->capacity ? 2 * k->capacity : 256;
        k->plans = ty_grow(k->plans, (size_t)k->capacity, (size_t)capacity, sizeof(plan));
        k->capacity = capacity;
    }
    k->plans[k->count++] = p;
}

// Along each line, `spacing` apart, where it lies on the host.
static void plans_make(linking* k)
{
    const roots_network* net = k->g->network;
    for (int line = 0; line < net->line_count; line++)
    {
        const roots_line* l = &net->lines[line];
        if (l->kind != k->from)
            continue;
        ty_rng rng = ty_rng_make(k->g->recipe->seed, 0x6c696e6b + (uint64_t)k->to, l->key);
        float next = -1.0f;
        for (int i = l->first + MARGIN; i < l->first + l->count - MARGIN; i++)
        {
            const roots_point* p = &net->points[i];
            if (p->sink <= 0.0f || p->r < 1.5f * k->g->recipe->tip)
                continue;
            if (next < 0.0f)
                next = p->s + k->def->spacing * ty_rng_range(&rng, 0.2f, 0.8f);
            if (p->s < next)
                continue;
            next = p->s + k->def->spacing * ty_rng_range(&rng, 0.7f, 1.3f);
            plan_add(k, line, i, &rng);
        }
    }
}

// --- growing ---

static void plans_wrap(void* context, int64_t begin, int64_t end, int worker)
{
    const linking* k = context;
    const roots_network* net = k->g->network;
    (void)worker;
    for (int64_t i = begin; i < end; i++)
    {
        plan* p = &k->plans[i];
        wrap_def def = {.a = net->points[p->point],
                        .ta = growth_tangent(net, &net->lines[p->line], p->point),
                        .flat = k->g->recipe->growth.flatten,
                        .sink = k->g->recipe->growth.sink,
                        .wander = k->def->wander,
                        .key = p->key};
        p->curve = TY_ALLOC(wrap, 1);
        for (int n = 0; n < p->partner_count && !p->grown; n++)
        {
            def.b = net->points[p->partner_points[n]];
            def.tb = growth_tangent(net, &net->lines[p->partners[n]], p->partner_points[n]);
            def.r = p->r = ty_max(p->share * ty_min(def.a.r, def.b.r), k->g->recipe->tip);
            p->grown = roots_wrap(k->g, &def, p->curve);
            p->used = n;
        }
    }
}

static void plan_append(linking* k, plan* p)
{
    roots_network* net = k->g->network;
    const ty_roots_recipe* recipe = k->g->recipe;
    const roots_point a = net->points[p->point], b = net->points[p->partner_points[p->used]];
    roots_line line = {.first = net->point_count,
                       .count = p->curve->count,
                       .kind = k->to,
                       .parent = p->line,
                       .parent_point = p->point,
                       .end = p->partners[p->used],
                       .end_point = p->partner_points[p->used],
                       .key = p->key};
    float s = 0.0f;
    for (int i = 0; i < p->curve->count; i++)
    {
        s += i ? ty_length(ty_sub(p->curve->p[i], p->curve->p[i - 1])) : 0.0f;
        float from_a = ty_exp(-s / (1.5f * a.r)), from_b = ty_exp(-(p->curve->length - s) / (1.5f * b.r));
        float thick = 1.0f + recipe->flare * (from_a + 0.6f * from_b);
        roots_point point = {.p = p->curve->p[i],
                             .n = p->curve->n[i],
                             .r = ty_min(p->r * thick, 0.95f * ty_max(a.r, b.r)),
                             .flat = recipe->growth.flatten,
                             .sink = recipe->growth.sink,
                             .s = a.s + s};
        roots_network_add_point(net, &point);
    }
    roots_network_add_line(net, &line);
    net->grown[k->to]++;
}

bool growth_link(growth* g, const ty_roots_link_def* def, roots_kind from, roots_kind to)
{
    linking k = {.g = g, .def = def, .from = from, .to = to};
    if (def->spacing <= 0.0f || def->reach <= 0.0f)
        return true;
    plans_make(&k);
    bool done = ty_parallel_for(g->workers, k.count, 8, plans_wrap, &k);
    int first = g->network->line_count;
    g->network->requested[to] += k.count;
    for (int i = 0; i < k.count; i++)
    {
        if (done && k.plans[i].grown)
            plan_append(&k, &k.plans[i]);
        ty_free(k.plans[i].curve);
    }
    ty_free(k.plans);
    growth_settle(g, first);
    return done;
}
