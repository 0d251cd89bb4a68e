// SPDX-License-Identifier: Apache-2.0
// Branches that grow from one root into another and close the net: where they leave, then each drawn over the host.
#include "roots_link.h"
#include <tsuya/base/log.h>
#include <tsuya/base/noise.h>

// --- places where branches leave ---

static void plan_add(linking* k, int line, int point, uint64_t key)
{
    ty_rng rng = ty_rng_make(k->g->recipe->seed, 0x6272616e, key);
    plan p = {.line = line, .point = point, .key = key};
    p.share = ty_rng_range(&rng, k->def->share[0], k->def->share[1]);
    float side = ty_rng_float(&rng) < 0.5f ? 1.0f : -1.0f;
    const float steepest[] = {0.35f, 0.1f}; // aslant, or else across
    for (int i = 0; i < 2 && p.partner_count == 0; i++)
    {
        link_partners(k, &p, side, steepest[i]);
        link_partners(k, &p, -side, steepest[i]);
    }
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

// Bits in reverse, as a share of 1: the radical inverse in base 2 (van der Corput 1935).
static float reversed(uint32_t i)
{
    uint32_t x = 0;
    for (int k = 0; k < 32; k++, i >>= 1)
        x = x << 1 | (i & 1u);
    return ty_u32_to_float(x);
}

// The share of branches that the recipe lets leave at this height.
static float density_at(const linking* k, float y)
{
    ty_bounds b = k->g->host->mesh->bounds;
    float size = b.high.y - b.low.y;
    return growth_ramp(&k->def->density_by_height, size > 0.0f ? (y - b.low.y) / size : 0.0f);
}

// Along each line, `spacing` apart on average, where it lies on the host. Places are those of a ruler whose marks do
// not depend on the spacing, each with a number that says how soon it is used: a slightly closer spacing adds few and
// moves none.
static void plans_make(linking* k)
{
    const roots_network* net = k->g->network;
    float mark = 1.0f;
    while (mark > 0.5f * k->def->spacing)
        mark *= 0.5f;
    float used = mark / k->def->spacing;
    for (int line = 0; line < net->line_count; line++)
    {
        const roots_line* l = &net->lines[line];
        if (l->kind != k->from)
            continue;
        uint32_t turn = (uint32_t)ty_mix64(l->key + (uint64_t)k->to);
        int i = l->first + MARGIN, end = l->first + l->count - MARGIN;
        for (uint32_t n = 1; i < end; n++)
        {
            uint64_t key = ty_mix64(l->key ^ (uint64_t)n << 8 ^ (uint64_t)k->to);
            float jitter = 0.6f * (ty_u32_to_float((uint32_t)key) - 0.5f);
            float at = net->points[l->first].s + mark * ((float)n + jitter);
            while (i < end && net->points[i].s < at)
                i++;
            float order = reversed(n) + ty_u32_to_float(turn);
            order -= order >= 1.0f ? 1.0f : 0.0f;
            if (i >= end || order >= used * density_at(k, net->points[i].p.y))
                continue;
            if (k->g->recipe->growth.avoid > 0.0f && // where they are not wanted none sets out
                roots_host_mask(k->g->host, ROOTS_AVOID, net->points[i].p, NULL) > 0.5f)
                continue;
            if (link_may_join(k, i) && net->points[i].r > 1.5f * k->g->recipe->tip)
                plan_add(k, line, i, key);
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
        for (int pass = 0; pass < 2 * p->partner_count && !p->grown; pass++)
        {
            int n = pass % p->partner_count;
            def.strict = pass < p->partner_count;
            def.b = net->points[p->partner_points[n]];
            def.tb = growth_tangent(net, &net->lines[p->partners[n]], p->partner_points[n]);
            if (ty_dot(def.tb, ty_sub(def.b.p, def.a.p)) < 0.0f) // it flows towards this one
                def.tb = ty_neg(def.tb);
            def.r = p->r = ty_max(p->share * ty_min(def.a.r, def.b.r), k->g->recipe->tip);
            p->how = roots_wrap(k->g, &def, p->curve);
            p->grown = p->how != WRAP_NONE;
            p->used = n;
        }
    }
}

// Thicker near both ends, to a tenth more than half of what it joins at least.
static float flared(const linking* k, const plan* p, const roots_point* a, const roots_point* b, float s)
{
    const ty_roots_recipe* recipe = k->g->recipe;
    float from_a = ty_exp(-s / (1.8f * a->r)), from_b = ty_exp(-(p->curve->length - s) / (1.8f * b->r));
    float x = s / (recipe->growth.wave * p->r);
    float swell = 0.4f * recipe->variation * ty_value_noise(ty_vec3_make(x, 0.5f, 7.5f), (uint32_t)p->key);
    float thick = (1.0f + swell) * (1.0f + recipe->flare * (from_a + 0.7f * from_b));
    return ty_min(p->r * thick, 0.95f * ty_max(a->r, b->r));
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
        roots_point point = {.p = p->curve->p[i],
                             .n = p->curve->n[i],
                             .r = flared(k, p, &a, &b, s),
                             .flat = recipe->growth.flatten,
                             .sink = recipe->growth.sink,
                             .s = a.s + s};
        roots_network_add_point(net, &point);
    }
    roots_network_add_line(net, &line);
    net->grown[k->to]++;
}

// In their order; what would run within others is none to ask for: roots that close to each other are one already.
static int plans_append(linking* k)
{
    int fused = 0;
    crowd* c = link_crowd_create(k->g->network);
    for (int i = 0; i < k->count; i++)
    {
        plan* p = &k->plans[i];
        if (!p->grown)
            continue;
        if (link_crowd_hides(c, p->curve))
        {
            fused++;
            continue;
        }
        plan_append(k, p);
        link_crowd_add(c, k->g->network, &k->g->network->lines[k->g->network->line_count - 1]);
    }
    link_crowd_destroy(c);
    return fused;
}

static void plans_report(const linking* k, int fused)
{
    int by[WRAP_WAYS] = {0}, other = 0;
    for (int i = 0; i < k->count; i++)
    {
        by[k->plans[i].how]++;
        other += k->plans[i].grown && k->plans[i].used > 0;
    }
    ty_log(TY_LOG_DEBUG,
           "roots: of %d %s branches %d shrink-wrapped, %d along geodesics, %d to another partner, %d fused", k->count,
           k->to == ROOTS_FIRST ? "first" : "second", by[WRAP_TIGHT], by[WRAP_GEODESIC], other, fused);
    if (by[WRAP_NONE])
        ty_log(TY_LOG_WARNING, "roots: %d of %d branches found no way over the host and were left out", by[WRAP_NONE],
               k->count);
}

bool growth_link(growth* g, const ty_roots_link_def* def, roots_kind from, roots_kind to)
{
    linking k = {.g = g, .def = def, .from = from, .to = to};
    if (def->spacing <= 0.0f || def->reach <= 0.0f)
        return true;
    k.places = link_places_create(&k);
    plans_make(&k);
    link_places_destroy(k.places);
    bool done = ty_parallel_for(g->workers, k.count, 8, plans_wrap, &k);
    int fused = done ? plans_append(&k) : 0;
    g->network->requested[to] += k.count - fused;
    if (done)
        plans_report(&k, fused);
    for (int i = 0; i < k.count; i++)
        ty_free(k.plans[i].curve);
    ty_free(k.plans);
    return done;
}
