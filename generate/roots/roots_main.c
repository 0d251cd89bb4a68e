// SPDX-License-Identifier: Apache-2.0
// Where roots begin: main ones as strands of the trunk or about the host's top, aerial ones on main roots over free
// air.
#include "roots_march.h"

static ty_vec3 host_top(const growth* g)
{
    ty_bounds b = g->host->mesh->bounds;
    ty_vec3 foot = ty_mul(ty_add(b.low, b.high), 0.5f);
    foot.y = b.high.y;
    return foot;
}

// --- the trunk ---

// The heart of the trunk, which the main roots run down along: it thins out above the host, where they part.
static void heart_add(const march* m)
{
    const ty_roots_trunk_def* def = &m->g->recipe->trunk;
    enum
    {
        PIECES = 24
    };
    roots_network* network = m->g->network;
    roots_line line = {.first = network->point_count,
                       .count = PIECES + 1,
                       .kind = ROOTS_TRUNK,
                       .parent = -1,
                       .parent_point = -1,
                       .end = -1,
                       .end_point = -1};
    float length = ty_length(ty_sub(m->top, m->foot));
    for (int i = 0; i <= PIECES; i++)
    {
        float along = (float)i / PIECES;
        ty_vec3 direction, p = march_trunk(m, along, &direction);
        roots_point point = {.p = p,
                             .n = ty_frame_from_normal(direction).t,
                             .r = def->radius * ty_lerp(0.85f, 0.55f, along),
                             .flat = 1.0f,
                             .s = along * length};
        roots_network_add_point(network, &point);
    }
    roots_network_add_line(network, &line);
    network->requested[ROOTS_TRUNK]++;
    network->grown[ROOTS_TRUNK]++;
}

// --- main roots ---

static tip tip_make(const march* m, int i, float radius)
{
    const ty_roots_recipe* recipe = m->g->recipe;
    ty_rng rng = ty_rng_make(recipe->seed, 0x726f6f74, (uint64_t)i); // a stream of its own
    float thick = ty_rng_range(&rng, -1.0f, 1.0f);
    tip t = {.r = radius * (1.0f + recipe->variation * thick), .flat = 1.0f, .kind = ROOTS_MAIN, .along = 1.0f};
    t.twist = ty_rng_range(&rng, -0.6f, 0.6f);
    t.turn = ty_rng_range(&rng, -0.3f, 0.3f); // jitter of the angle, of the mean between roots
    t.key = ty_mix64((uint64_t)i + 1);
    t.parent = t.parent_point = -1;
    return t;
}

// Around the trunk's cut, or around the highest place of the host where there is no trunk.
static void tips_begin(march* m)
{
    const ty_roots_recipe* recipe = m->g->recipe;
    ty_rng rng = ty_rng_make(recipe->seed, 0x7472756e, 0);
    float turn = ty_rng_range(&rng, 0.0f, 2.0f * TY_PI);
    bool trunk = recipe->trunk.height > 0.0f;
    for (int i = 0; i < recipe->count; i++)
    {
        tip t = tip_make(m, i, recipe->radius);
        float sine, cosine;
        t.turn = turn + 2.0f * TY_PI * ((float)i + t.turn) / (float)recipe->count;
        ty_sincos(t.turn, &sine, &cosine);
        ty_vec3 out = {cosine, 0.0f, sine}, around = {-sine, 0.0f, cosine}, n = out;
        t.p = ty_mad(m->top, out, ty_max(recipe->trunk.radius - 0.5f * t.r, 0.2f * recipe->trunk.radius));
        t.along = trunk ? 0.0f : 1.0f;
        if (!trunk)
        {
            t.flat = recipe->growth.flatten;
            t.p = roots_host_project(m->g->host, t.p, (t.flat - recipe->growth.sink) * t.r, &n);
        }
        t.n = n;
        t.across = around;
        t.t = ty_normalize(ty_add(trunk ? (ty_vec3){0.0f, -1.0f, 0.0f} : out, ty_mul(around, 0.5f * t.twist)));
        if (!trunk)
            t.t = ty_normalize(growth_without(t.t, n));
        march_add(m, t);
    }
}

// From given or painted places; where there are more roots than places, several set out from each, to all sides.
static void starts_begin(march* m)
{
    const growth* g = m->g;
    const ty_roots_recipe* recipe = g->recipe;
    int each = (recipe->count + g->start_count - 1) / g->start_count;
    float extent = ty_length(ty_sub(g->host->mesh->bounds.high, g->host->mesh->bounds.low));
    for (int i = 0; i < recipe->count; i++)
    {
        const roots_start* start = &g->starts[i % g->start_count];
        tip t = tip_make(m, i, recipe->radius);
        ty_frame frame = ty_frame_from_normal(start->n);
        float sine, cosine;
        ty_sincos(2.0f * TY_PI * ((float)(i / g->start_count) + t.turn) / (float)each, &sine, &cosine);
        ty_vec3 way = ty_add(ty_mul(frame.t, cosine), ty_mul(frame.b, sine));
        if (each == 1) // downhill
            way = ty_mad((ty_vec3){0.0f, -1.0f, 0.0f}, way, 0.4f);
        way = growth_without(way, start->n);
        t.flat = recipe->growth.flatten;
        t.n = start->n;
        t.t = ty_length(way) > 1e-3f ? ty_normalize(way) : frame.t;
        t.p = roots_host_project(g->host, start->p, (t.flat - recipe->growth.sink) * t.r, &t.n);
        // its own side of the host is where it starts, and over the top where it goes to
        ty_vec3 out = ty_mad(t.t, ty_sub(t.p, m->foot), 4.0f / ty_max(extent, 1e-9f));
        out.y = 0.0f;
        out = ty_length(out) > 1e-3f ? ty_normalize(out) : (ty_vec3){1.0f, 0.0f, 0.0f};
        t.across = (ty_vec3){-out.z, 0.0f, out.x};
        march_add(m, t);
    }
}

// Main roots belong to the trunk, or to the first of those that set out from the same place.
static void mains_tie(const growth* g)
{
    const roots_network* net = g->network;
    bool trunk = net->lines[0].kind == ROOTS_TRUNK;
    for (int i = 0; i < net->line_count; i++)
    {
        int parent = trunk ? 0 : g->start_count > 0 ? i % g->start_count : i;
        if (parent == i)
            continue;
        net->lines[i].parent = parent;
        net->lines[i].parent_point = net->lines[parent].first;
    }
}

bool growth_main(growth* g)
{
    const ty_roots_recipe* recipe = g->recipe;
    march* m = march_create(g);
    bool trunk = recipe->trunk.height > 0.0f && g->start_count == 0;
    m->foot = host_top(g);
    m->top = m->foot;
    if (trunk)
    {
        m->top = ty_add(m->foot, recipe->trunk.lean);
        m->top.y += recipe->trunk.height;
        ty_vec3 n;
        float height = roots_host_value(g->host, m->foot, &n);
        m->foot.y -= ty_clamp(height, 0.0f, 2.0f * recipe->radius); // a round top may lie lower in its middle
    }
    g->network->top = trunk ? m->top.y : TY_FLOAT_MAX;
    if (trunk)
        heart_add(m);
    if (g->start_count > 0)
        starts_begin(m);
    else
        tips_begin(m);
    march_run(m);
    march_destroy(m);
    mains_tie(g);
    return !ty_cancel_requested();
}

// --- aerial roots ---

// How well a place of a main root is fit for one to hang from: high up, and free air below.
static float hanging(const growth* g, const roots_point* p)
{
    ty_bounds b = g->host->mesh->bounds;
    float high = (p->p.y - b.low.y) / ty_max(b.high.y - b.low.y, 1e-9f);
    ty_vec3 out = {p->n.x, 0.0f, p->n.z}, n;
    float wide = ty_length(out);
    if (wide < 0.2f || high < 0.3f || p->sink <= 0.0f)
        return 0.0f;
    for (int i = 1; i <= 6; i++) // a place some radii out and further down
    {
        ty_vec3 q = ty_mad(p->p, out, 6.0f * p->r / wide);
        q.y -= (float)i * 0.12f * (b.high.y - b.low.y);
        if (q.y > b.low.y && roots_host_value(g->host, q, &n) < 2.0f * p->r)
            return 0.0f;
    }
    return high * (0.3f + wide);
}

static void aerial_add(march* m, int line, int point, uint64_t key)
{
    const ty_roots_recipe* recipe = m->g->recipe;
    const roots_point* at = &m->g->network->points[point];
    ty_rng rng = ty_rng_make(recipe->seed, 0x61697220, key);
    float share = ty_rng_range(&rng, recipe->aerial.share[0], recipe->aerial.share[1]);
    tip t = {.p = at->p, .n = at->n, .s = at->s, .flat = 1.0f, .kind = ROOTS_AERIAL, .along = 1.0f, .key = key};
    t.r = ty_max(ty_min(share * recipe->radius, 0.9f * at->r), 1.2f * recipe->tip);
    t.t = growth_tangent(m->g->network, &m->g->network->lines[line], point); // melts into its parent, then leaves it
    t.t = ty_normalize(ty_mad(t.t, at->n, 1.0f));
    t.free = 5.0f * at->r;
    t.parent = line;
    t.parent_point = point;
    march_add(m, t);
}

bool growth_aerial(growth* g)
{
    const roots_network* net = g->network;
    int wanted = g->recipe->aerial.count;
    march* m = wanted > 0 ? march_create(g) : NULL;
    if (!m)
        return true;
    m->foot = m->top = host_top(g);
    for (int i = 0; i < wanted; i++)
    {
        // the best of some places drawn by its own stream
        ty_rng rng = ty_rng_make(g->recipe->seed, 0x68616e67, (uint64_t)i);
        float best = 0.0f;
        int line = -1, point = -1;
        for (int k = 0; k < 16; k++)
        {
            int one = (int)(ty_rng_float(&rng) * (float)net->line_count);
            const roots_line* l = &net->lines[one];
            int at = l->first + 8 + (int)(ty_rng_float(&rng) * (float)(l->count - 16));
            if (l->kind != ROOTS_MAIN || l->count < 20)
                continue;
            float fit = hanging(g, &net->points[at]);
            if (fit > best)
            {
                best = fit;
                line = one;
                point = at;
            }
        }
        if (line >= 0)
            aerial_add(m, line, point, ty_mix64(0x61657269ull + (uint64_t)i));
        else
            g->network->requested[ROOTS_AERIAL]++;
    }
    march_run(m);
    march_destroy(m);
    return !ty_cancel_requested();
}
