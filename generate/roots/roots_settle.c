// SPDX-License-Identifier: Apache-2.0
// Lines come to rest on the host: at their height over the mesh itself, without sharp turns, tied to what they join.
#include "roots_rest.h"
#include <string.h>

// --- one point ---

ty_vec3 growth_out(const roots_host* host, ty_vec3 p, float height)
{
    if (!host->has_floor || p.y > host->floor + 2.0f * height)
        return p;
    ty_vec3 n, q = p;
    q.y = ty_max(p.y, host->floor + height);
    for (int i = 0; i < 6; i++)
    {
        float lack = height - roots_host_value(host, q, &n);
        if (lack <= 0.02f * height || n.y > -0.1f)
            return i > 0 ? q : p;
        ty_vec3 away = {n.x, 0.0f, n.z};
        if (ty_length(away) < 0.3f) // flat: where the side is
        {
            roots_host_value(host, ty_mad(q, (ty_vec3){0.0f, 1.0f, 0.0f}, 4.0f * height), &n);
            away = (ty_vec3){n.x, 0.0f, n.z};
        }
        float length = ty_length(away);
        if (length < 0.1f)
            return p;
        q = ty_mad(q, away, ty_min(lack / length, 4.0f * height) / length);
    }
    return q;
}

static void point_settle(const resting* on, roots_point* p, float over)
{
    ty_vec3 n;
    if (p->sink <= 0.0f)
    {
        // a root that comes near or lets go is sunk as deep as it happens to be, and no deeper than others
        float deep = p->flat - rest_height(on, p->p, &n) / p->r;
        p->sink = ty_clamp(deep, 0.0f, on->sink);
        if (deep <= on->sink)
            return;
    }
    for (int i = 0; i < 4; i++) // between two surfaces one move leads under the other
    {
        float wrong = rest_height(on, p->p, &n) - growth_height(p) - over;
        p->p = ty_mad(p->p, n, -ty_clamp(wrong, -p->r, p->r));
        if (fabsf(wrong) < 0.01f * p->r)
            break;
    }
    p->p = growth_out(on->host, p->p, growth_height(p) + over);
}

// --- turns ---

// Points about turns of a smaller cosine than most.
static bool turns_mark(const roots_point* points, int count, int keep, float most, bool* marked)
{
    bool any = false;
    for (int i = 1; i + 1 < count; i++)
    {
        ty_vec3 a = ty_sub(points[i].p, points[i - 1].p), b = ty_sub(points[i + 1].p, points[i].p);
        if (ty_dot(a, b) >= most * ty_length(a) * ty_length(b))
            continue;
        any = true;
        for (int k = i - 2; k <= i + 2; k++)
            if (k >= keep && k < count - keep)
                marked[k] = true;
    }
    return any;
}

static void ease(const resting* on, roots_point* points, const float* over, int count, int keep)
{
    enum
    {
        HELD = 24, // rounds in which it keeps its height; of what is pushed to and fro between two sides the kinks go
                   // all the same
        ROUNDS = 64
    };
    if (count < 3)
        return;
    bool *marked = TY_ALLOC(bool, count), *ever = TY_ALLOC(bool, count);
    ty_vec3 n;
    for (int round = 0; round < ROUNDS && turns_mark(points, count, keep, round < HELD ? 0.77f : 0.17f, marked);
         round++)
        for (int i = 1; i + 1 < count; i++)
        {
            roots_point* p = &points[i];
            if (!marked[i])
                continue;
            marked[i] = false;
            ever[i] = true;
            p->p = ty_lerp3(p->p, ty_mul(ty_add(points[i - 1].p, points[i + 1].p), 0.5f), 0.6f);
            bool held = round < HELD && p->sink > 0.0f;
            float wrong = held ? rest_height(on, p->p, &n) - growth_height(p) - over[i] : 0.0f;
            if (wrong < 0.0f)
                p->p = ty_mad(p->p, n, -wrong);
        }
    for (int i = 1; i + 1 < count; i++)
        if (ever[i] && points[i].sink > 0.0f) // in a corner of the host it hangs over: less deep then
        {
            float lift = rest_height(on, points[i].p, &n) - growth_height(&points[i]) - over[i];
            points[i].sink = ty_max(0.02f, points[i].sink - ty_max(lift, 0.0f) / points[i].r);
        }
    ty_free(marked);
    ty_free(ever);
}

// What is rough under a root is bridged: lines are smoothed over about their own width, and come down again only where
// they would be deeper than they may.
static void bridge(const resting* on, roots_point* points, const float* over, int count)
{
    enum
    {
        ROUNDS = 4
    };
    ty_vec3 n;
    for (int round = 0; round < ROUNDS; round++)
    {
        ty_vec3 last = points[0].p;
        for (int i = 1; i + 1 < count; i++)
        {
            ty_vec3 own = points[i].p, middle = ty_mul(ty_add(last, points[i + 1].p), 0.5f);
            points[i].p = ty_lerp3(own, middle, points[i].sink > 0.0f ? 0.5f : 0.0f);
            last = own;
        }
    }
    for (int i = 1; i + 1 < count; i++)
        for (int k = 0; k < 6; k++)
        {
            roots_point* p = &points[i];
            float wrong = p->sink > 0.0f ? rest_height(on, p->p, &n) - growth_height(p) - over[i] : 0.0f;
            float most = 0.4f * p->sink * p->r; // still in touch
            if (wrong >= -0.01f * p->r && wrong <= most)
                break;
            p->p = ty_mad(p->p, n, -(wrong < 0.0f ? wrong : wrong - most));
            p->p = growth_out(on->host, p->p, growth_height(p) + over[i]);
        }
}

// --- lines ---

typedef struct settling
{
    const growth* g;
    int first; // line
    bool exact;
} settling;

// Moves the first or last point to `to`, and what is within some radii of it part of the way.
static void end_move(const roots_network* net, const roots_line* l, bool last, const roots_point* to)
{
    int end = last ? l->first + l->count - 1 : l->first, way = last ? -1 : 1;
    ty_vec3 by = ty_sub(to->p, net->points[end].p);
    float from = net->points[end].s;
    for (int i = 0; i < l->count / 2; i++)
    {
        roots_point* p = &net->points[end + way * i];
        p->p = ty_mad(p->p, by, ty_exp(-fabsf(p->s - from) / (3.0f * to->r)));
    }
    net->points[end].p = to->p;
    net->points[end].sink = ty_max(net->points[end].sink, to->sink);
}

// Once more, with the turns onto what it joins.
static void ease_joined(const resting* on, const roots_network* net, const roots_line* l, const float* over)
{
    roots_point* chain = TY_ALLOC(roots_point, l->count + 2);
    float* chain_over = TY_ALLOC(float, l->count + 2);
    memcpy(chain + 1, net->points + l->first, (size_t)l->count * sizeof *chain);
    memcpy(chain_over + 1, over, (size_t)l->count * sizeof *over);
    chain[0] = (roots_point){.p = rest_beyond(net, l, false)};
    chain[l->count + 1] = (roots_point){.p = rest_beyond(net, l, true)};
    chain_over[0] = chain_over[l->count + 1] = 0.0f;
    ease(on, chain, chain_over, l->count + 2, 2);
    memcpy(net->points + l->first, chain + 1, (size_t)l->count * sizeof *chain);
    ty_free(chain);
    ty_free(chain_over);
}

void growth_settle_line(const growth* g, int line, bool exact)
{
    resting on = {g->host, g->recipe->growth.sink, exact};
    const roots_network* net = g->network;
    const roots_line* l = &net->lines[line];
    if (l->kind == ROOTS_TRUNK)
        return;
    roots_point* points = net->points + l->first;
    float* over = TY_ALLOC(float, l->count);
    if (growth_leaves(l))
        end_move(net, l, false, &net->points[l->parent_point]);
    if (l->end >= 0)
        end_move(net, l, true, &net->points[l->end_point]);
    rest_over(&on, net, l, over);
    for (int k = growth_leaves(l); k < l->count - (l->end >= 0); k++)
        point_settle(&on, &points[k], over[k]);
    bridge(&on, points, over, l->count);
    ease(&on, points, over, l->count, 1);
    rest_ends(&on, net, l, over);
    ease_joined(&on, net, l, over);
    for (int k = 0; k < l->count && exact; k++) // within what it joins: less deep there
    {
        ty_vec3 n;
        float lift = over[k] > 0.0f ? rest_height(&on, points[k].p, &n) - growth_height(&points[k]) : 0.0f;
        if (lift > 0.0f)
            points[k].sink = ty_max(0.02f, points[k].sink - lift / points[k].r);
    }
    ty_free(over);
}

static void lines_settle(void* context, int64_t begin, int64_t end, int worker)
{
    const settling* s = context;
    (void)worker;
    for (int64_t i = begin; i < end; i++)
        growth_settle_line(s->g, s->first + (int)i, s->exact);
}

// Lines of a kind stand one after another and are tied to those of kinds before: kind by kind.
void growth_settle(const growth* g, int first, bool exact)
{
    const roots_network* net = g->network;
    for (int line = first, end; line < net->line_count; line = end)
    {
        for (end = line; end < net->line_count && net->lines[end].kind == net->lines[line].kind; end++)
            ;
        settling s = {g, line, exact};
        ty_parallel_all(g->workers, end - line, 4, lines_settle, &s);
    }
}
