// SPDX-License-Identifier: Apache-2.0
// Branches that grow from one root into another and close the net: which to which, then each drawn over the host.
#include "roots_growth.h"
#include <tsuya/base/log.h>
#include <tsuya/base/noise.h>

enum
{
    PARTNERS = 6, // that are tried, on one side, then on the other, the nearest first
    MARGIN = 4,   // points of a line, at both ends, where none begins or ends
    CELLS = 1 << 14,
    LINES = 64, // that are looked at for one branch
};

typedef struct plan
{
    int line, point; // where it begins
    int partner_count;
    int partners[PARTNERS], partner_points[PARTNERS];
    float share;
    uint64_t key;
    bool grown;
    wrap_way how;
    int used; // partner
    float r;
    wrap* curve; // owned
} plan;

typedef struct places places;

typedef struct linking
{
    growth* g;
    const ty_roots_link_def* def;
    roots_kind from, to;
    places* places;
    plan* plans;
    int count, capacity;
} linking;

// --- where points are ---

// Points of lines that may be grown into, by the cell of a grid in a table by hash.
struct places
{
    float cell; // m
    int heads[CELLS];
    int* next; // [count]
    int* points;
    int* lines;
    int count;
};

static uint32_t cell_hash(int x, int y, int z)
{
    return ty_mix32(ty_mix32(ty_mix32((uint32_t)x) + (uint32_t)y) + (uint32_t)z) % CELLS;
}

// On the host, and not where it goes under.
static bool may_join(const linking* k, int point)
{
    float sink = k->g->network->points[point].sink;
    return sink > 0.0f && sink < k->g->recipe->growth.sink + 0.1f;
}

static places* places_create(const linking* k)
{
    const roots_network* net = k->g->network;
    float reach = k->def->reach;
    roots_kind kind = k->from;
    places* all = TY_ALLOC(places, 1);
    int most = 0;
    for (int line = 0; line < net->line_count; line++)
        most += net->lines[line].kind == kind ? net->lines[line].count : 0;
    *all = (places){.cell = 0.5f * reach, .next = TY_ALLOC(int, most), .points = TY_ALLOC(int, most)};
    all->lines = TY_ALLOC(int, most);
    for (int i = 0; i < CELLS; i++)
        all->heads[i] = -1;
    for (int line = 0; line < net->line_count; line++)
    {
        const roots_line* l = &net->lines[line];
        for (int i = l->first + MARGIN; l->kind == kind && i < l->first + l->count - MARGIN; i++)
        {
            if (!may_join(k, i))
                continue;
            ty_vec3 q = ty_mul(net->points[i].p, 1.0f / all->cell);
            int* head = &all->heads[cell_hash((int)floorf(q.x), (int)floorf(q.y), (int)floorf(q.z))];
            all->points[all->count] = i;
            all->lines[all->count] = line;
            all->next[all->count] = *head;
            *head = all->count++;
        }
    }
    return all;
}

static void places_destroy(places* all)
{
    ty_free(all->next);
    ty_free(all->points);
    ty_free(all->lines);
    ty_free(all);
}

// --- partners ---

typedef struct partner
{
    int line, point;
    float distance;
} partner;

typedef struct search
{
    const linking* k;
    const plan* plan;
    ty_vec3 side;
    partner found[LINES]; // the nearest point of each line
    int count;
} search;

static void search_meet(search* s, int line, int point)
{
    const roots_network* net = s->k->g->network;
    const roots_point *at = &net->points[s->plan->point], *to = &net->points[point];
    ty_vec3 way = ty_sub(to->p, at->p);
    float d = ty_length(way);
    if (line == s->plan->line || d > s->k->def->reach || ty_dot(way, s->side) < 0.3f * d || d < 1.5f * (at->r + to->r))
        return;
    if (ty_dot(way, at->n) > 0.7f * d || ty_dot(way, to->n) < -0.7f * d) // through the air
        return;
    int i = 0;
    while (i < s->count && s->found[i].line != line)
        i++;
    if (i == LINES || (i < s->count && (s->found[i].distance < d || (s->found[i].distance == d && // as found in order
                                                                     s->found[i].point < point))))
        return;
    s->found[i] = (partner){line, point, d};
    s->count += i == s->count;
}

static void search_cells(search* s)
{
    const places* all = s->k->places;
    ty_vec3 p = s->k->g->network->points[s->plan->point].p,
            reach = {s->k->def->reach, s->k->def->reach, s->k->def->reach};
    ty_vec3 low = ty_mul(ty_sub(p, reach), 1.0f / all->cell), high = ty_mul(ty_add(p, reach), 1.0f / all->cell);
    for (int z = (int)floorf(low.z); z <= (int)floorf(high.z); z++)
        for (int y = (int)floorf(low.y); y <= (int)floorf(high.y); y++)
            for (int x = (int)floorf(low.x); x <= (int)floorf(high.x); x++)
                for (int i = all->heads[cell_hash(x, y, z)]; i >= 0; i = all->next[i])
                    search_meet(s, all->lines[i], all->points[i]);
}

// Goes down the line by a length.
static int downstream(const linking* k, int line, int point, float way)
{
    const roots_network* net = k->g->network;
    const roots_line* l = &net->lines[line];
    float from = net->points[point].s;
    int last = l->first + l->count - 1 - MARGIN, i = point;
    while (i < last && net->points[i].s < from + way && may_join(k, i + 1))
        i++;
    while (i > l->first + MARGIN && net->points[i].s > from + way && may_join(k, i - 1))
        i--;
    return i;
}

static void plan_partners(const linking* k, plan* p, float side)
{
    const roots_network* net = k->g->network;
    const roots_point* at = &net->points[p->point];
    ty_vec3 t = growth_tangent(net, &net->lines[p->line], p->point);
    search s = {.k = k, .plan = p, .side = ty_mul(ty_cross(at->n, t), side)};
    search_cells(&s);
    for (int most = p->partner_count + PARTNERS / 2, left = s.count; left > 0 && p->partner_count < most; left--)
    {
        int best = 0; // equal ones in the order of lines
        for (int i = 1; i < s.count; i++)
            if (s.found[i].distance < s.found[best].distance ||
                (s.found[i].distance == s.found[best].distance && s.found[i].line < s.found[best].line))
                best = i;
        p->partners[p->partner_count] = s.found[best].line;
        const roots_point* b =
            &net->points[s.found[best].point]; // of what is seen of it, not of what is inside of both
        float way = k->def->slant * (s.found[best].distance + at->r + b->r);
        p->partner_points[p->partner_count] = downstream(k, s.found[best].line, s.found[best].point, way);
        s.found[best].distance = TY_FLOAT_MAX;
        p->partner_count++;
    }
}

// --- places where branches leave ---

static void plan_add(linking* k, int line, int point, uint64_t key)
{
    ty_rng rng = ty_rng_make(k->g->recipe->seed, 0x6272616e, key);
    plan p = {.line = line, .point = point, .key = key};
    p.share = ty_rng_range(&rng, k->def->share[0], k->def->share[1]);
    float side = ty_rng_float(&rng) < 0.5f ? 1.0f : -1.0f;
    plan_partners(k, &p, side);
    plan_partners(k, &p, -side);
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
            if (i >= end || order >= used)
                continue;
            if (k->g->recipe->growth.avoid > 0.0f && // where they are not wanted none sets out
                roots_host_mask(k->g->host, ROOTS_AVOID, net->points[i].p, NULL) > 0.5f)
                continue;
            if (may_join(k, i) && net->points[i].r > 1.5f * k->g->recipe->tip)
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

static void plans_report(const linking* k)
{
    int by[WRAP_WAYS] = {0}, other = 0;
    for (int i = 0; i < k->count; i++)
    {
        by[k->plans[i].how]++;
        other += k->plans[i].grown && k->plans[i].used > 0;
    }
    ty_log(TY_LOG_DEBUG, "roots: of %d %s branches %d shrink-wrapped, %d along geodesics, %d to another partner",
           k->count, k->to == ROOTS_FIRST ? "first" : "second", by[WRAP_TIGHT], by[WRAP_GEODESIC], other);
    if (by[WRAP_NONE])
        ty_log(TY_LOG_WARNING, "roots: %d of %d branches found no way over the host and were left out", by[WRAP_NONE],
               k->count);
}

bool growth_link(growth* g, const ty_roots_link_def* def, roots_kind from, roots_kind to)
{
    linking k = {.g = g, .def = def, .from = from, .to = to};
    if (def->spacing <= 0.0f || def->reach <= 0.0f)
        return true;
    k.places = places_create(&k);
    plans_make(&k);
    places_destroy(k.places);
    bool done = ty_parallel_for(g->workers, k.count, 8, plans_wrap, &k);
    g->network->requested[to] += k.count;
    if (done)
        plans_report(&k);
    for (int i = 0; i < k.count; i++)
    {
        if (done && k.plans[i].grown)
            plan_append(&k, &k.plans[i]);
        ty_free(k.plans[i].curve);
    }
    ty_free(k.plans);
    return done;
}
