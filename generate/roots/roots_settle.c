// SPDX-License-Identifier: Apache-2.0
// Lines come to rest on the host: at their height over the mesh itself, without sharp turns, tied to what they join.
#include "roots_growth.h"

typedef struct resting
{
    const roots_host* host;
    float sink; // of the recipe
    bool exact;
} resting;

// --- one point ---

// Over the mesh itself, or by the field where that will do. reach follows from the field, so that few triangles are
// asked.
static float height_of(const resting* on, const roots_point* p, ty_vec3* n)
{
    float value = roots_host_value(on->host, p->p, n);
    if (on->exact)
        return roots_host_exact(on->host, p->p, fabsf(value) + 2.0f * on->host->field.step, n);
    *n = ty_normalize(*n);
    return value;
}

static void point_settle(const resting* on, roots_point* p)
{
    ty_vec3 n;
    if (p->sink <= 0.0f)
    {
        // a root that comes near or lets go is sunk as deep as it happens to be, and no deeper than others
        float deep = p->flat - height_of(on, p, &n) / p->r;
        p->sink = ty_clamp(deep, 0.0f, on->sink);
        if (deep <= on->sink)
            return;
    }
    for (int i = 0; i < 3; i++) // between two surfaces one move leads under the other
    {
        float wrong = height_of(on, p, &n) - growth_height(p);
        p->p = ty_mad(p->p, n, -ty_clamp(wrong, -p->r, p->r));
        if (fabsf(wrong) < 0.01f * p->r)
            break;
    }
}

// --- turns ---

static bool turns_mark(const roots_point* points, int count, bool* marked)
{
    const float most = 0.77f; // cosine
    bool any = false;
    for (int i = 1; i + 1 < count; i++)
    {
        ty_vec3 a = ty_sub(points[i].p, points[i - 1].p), b = ty_sub(points[i + 1].p, points[i].p);
        if (ty_dot(a, b) >= most * ty_length(a) * ty_length(b))
            continue;
        any = true;
        for (int k = i - 2; k <= i + 2; k++)
            if (k > 0 && k < count - 1)
                marked[k] = true;
    }
    return any;
}

static void ease(const resting* on, roots_point* points, int count)
{
    enum
    {
        ROUNDS = 24
    };
    if (count < 3)
        return;
    bool *marked = TY_ALLOC(bool, count), *ever = TY_ALLOC(bool, count);
    ty_vec3 n;
    for (int round = 0; round < ROUNDS && turns_mark(points, count, marked); round++)
        for (int i = 1; i + 1 < count; i++)
        {
            roots_point* p = &points[i];
            if (!marked[i])
                continue;
            marked[i] = false;
            ever[i] = true;
            p->p = ty_lerp3(p->p, ty_mul(ty_add(points[i - 1].p, points[i + 1].p), 0.5f), 0.6f);
            float wrong = p->sink > 0.0f ? height_of(on, p, &n) - growth_height(p) : 0.0f;
            if (wrong < 0.0f)
                p->p = ty_mad(p->p, n, -wrong);
        }
    for (int i = 1; i + 1 < count; i++)
        if (ever[i] && points[i].sink > 0.0f) // in a corner of the host it hangs over: less deep then
        {
            float lift = height_of(on, &points[i], &n) - growth_height(&points[i]);
            points[i].sink = ty_max(0.02f, points[i].sink - ty_max(lift, 0.0f) / points[i].r);
        }
    ty_free(marked);
    ty_free(ever);
}

// What is rough under a root is bridged: lines are smoothed over about their own width, and come down again only where
// they would be deeper than they may.
static void bridge(const resting* on, roots_point* points, int count)
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
        for (int k = 0; k < 3; k++)
        {
            roots_point* p = &points[i];
            float wrong = p->sink > 0.0f ? height_of(on, p, &n) - growth_height(p) : 0.0f;
            float most = 0.4f * p->sink * p->r; // still in touch
            if (wrong >= -0.01f * p->r && wrong <= most)
                break;
            p->p = ty_mad(p->p, n, -(wrong < 0.0f ? wrong : wrong - most));
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

void growth_settle_line(const growth* g, int line, bool exact)
{
    resting on = {g->host, g->recipe->growth.sink, exact};
    const roots_network* net = g->network;
    const roots_line* l = &net->lines[line];
    if (l->kind == ROOTS_TRUNK)
        return;
    if (growth_leaves(l))
        end_move(net, l, false, &net->points[l->parent_point]);
    if (l->end >= 0)
        end_move(net, l, true, &net->points[l->end_point]);
    for (int k = growth_leaves(l); k < l->count - (l->end >= 0); k++)
        point_settle(&on, &net->points[l->first + k]);
    bridge(&on, net->points + l->first, l->count);
    ease(&on, net->points + l->first, l->count);
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

// --- junctions ---

static void branch_part(const roots_network* net, const roots_line* branch)
{
    const roots_line* l = &net->lines[branch->parent];
    const roots_point *at = &net->points[branch->parent_point], *out = &net->points[branch->first];
    int ahead = branch->count / 2;
    while (ahead > 1 && out[ahead].s - out[0].s > 4.0f * at->r)
        ahead--;
    ty_vec3 t = growth_tangent(net, l, branch->parent_point);
    ty_vec3 side = growth_without(growth_without(ty_sub(out[ahead].p, at->p), t), at->n);
    float length = ty_length(side), r = net->points[branch->first + branch->count / 2].r;
    if (length < 1e-3f * at->r)
        return;
    for (int i = branch->parent_point; i < l->first + l->count; i++)
    {
        float x = (net->points[i].s - at->s) / (7.0f * at->r);
        if (x >= 1.0f)
            break;
        float bump = 6.75f * x * ty_sqr(1.0f - x); // 1 at a third
        net->points[i].p = ty_mad(net->points[i].p, side, -0.7f * r * bump / length);
    }
}

void growth_part(const growth* g, int first)
{
    for (int line = first; line < g->network->line_count; line++)
        branch_part(g->network, &g->network->lines[line]);
}
