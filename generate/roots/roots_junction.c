// SPDX-License-Identifier: Apache-2.0
// Where lines meet: how a branch comes out of the root that it leaves, and how that gives way.
#include "roots_rest.h"

enum
{
    WINDOW = 48, // points that an end may turn over
};

#define OUT_WAY 5.0f  // on which it comes down to its own height at the latest, of the radius of what it joins
#define TURN_WAY 4.0f // on which it turns, of the same
#define TURN_SHARE 0.4f
#define ALONG 0.9063f // cosine of 25 degrees, the most between both

// Where a line meets another, seen from that end.
typedef struct meeting
{
    const roots_line* line;
    bool last;
    const roots_line* other;
    int at; // point of the other
} meeting;

static bool meeting_find(const roots_network* net, const roots_line* l, bool last, meeting* out)
{
    if (last ? l->end < 0 : !growth_leaves(l))
        return false;
    *out = (meeting){l, last, &net->lines[last ? l->end : l->parent], last ? l->end_point : l->parent_point};
    return true;
}

static int meeting_point(const meeting* m, int i)
{
    return m->last ? m->line->count - 1 - i : i;
}

// --- height ---

// How far p lies from the line that is joined, near where it is.
static float apart(const roots_network* net, const meeting* m, ty_vec3 p)
{
    const roots_line* other = m->other;
    int first = m->at - WINDOW / 2, last = m->at + WINDOW / 2, end = other->first + other->count - 1;
    float least = TY_FLOAT_MAX;
    for (int i = first < other->first ? other->first : first; i <= (last > end ? end : last); i++)
        least = ty_min(least, ty_length_sqr(ty_sub(net->points[i].p, p)));
    return sqrtf(least);
}

void rest_over(const resting* on, const roots_network* net, const roots_line* l, float* over)
{
    const roots_point* points = net->points + l->first;
    for (int i = 0; i < l->count; i++)
        over[i] = 0.0f;
    for (int end = 0; end < 2; end++)
    {
        meeting m;
        if (!meeting_find(net, l, end, &m) || net->points[m.at].sink <= 0.0f)
            continue;
        const roots_point* at = &net->points[m.at];
        ty_vec3 n;
        float top = ty_min(rest_height(on, at->p, &n), 2.0f * at->r), from = points[meeting_point(&m, 0)].s;
        for (int i = 0; i < l->count; i++)
        {
            float x = fabsf(points[i].s - from) / (OUT_WAY * at->r);
            if (x >= 1.0f || points[i].sink <= 0.0f)
                continue;
            x = ty_max(x, apart(net, &m, points[i].p) / at->r);
            float part = 1.0f - ty_smoothstep(ty_min(x, 1.0f));
            over[i] = ty_max(over[i], part * (top - growth_height(&points[i])));
        }
    }
}

// --- direction ---

// v turned towards t until no more than the angle is between them; both are unit.
static ty_vec3 within(ty_vec3 v, ty_vec3 t, float cosine)
{
    float dot = ty_dot(v, t);
    ty_vec3 side = growth_without(v, t);
    float length = ty_length(side);
    if (dot >= cosine || length < 1e-6f)
        return dot >= cosine ? v : t;
    return ty_mad(ty_mul(t, cosine), side, sqrtf(1.0f - cosine * cosine) / length);
}

// Put at its height.
static void keep_height(const resting* on, const roots_point* p, float over, ty_vec3* at)
{
    ty_vec3 n;
    float wrong = p->sink > 0.0f ? rest_height(on, *at, &n) - growth_height(p) - over : 0.0f;
    if (p->sink > 0.0f)
        *at = ty_mad(*at, n, -ty_clamp(wrong, -p->r, p->r));
}

// A cubic from the first step of a chain to its last.
static void span(ty_vec3* p, int count)
{
    ty_vec3 a = p[1], b = p[count - 2], ta = ty_normalize(ty_sub(a, p[0])), tb = ty_normalize(ty_sub(p[count - 1], b));
    float chord = ty_length(ty_sub(b, a));
    for (int i = 2; i < count - 2; i++)
    {
        float t = (float)(i - 1) / (float)(count - 3), t2 = t * t, t3 = t2 * t;
        p[i] = ty_lerp3(a, b, 3.0f * t2 - 2.0f * t3);
        p[i] = ty_mad(ty_mad(p[i], ta, chord * (t3 - 2.0f * t2 + t)), tb, chord * (t3 - t2));
    }
}

// The points of an end, as far as it may turn. Their number, 0: it is too short.
static int window_take(const roots_network* net, const meeting* m, ty_vec3 p[WINDOW])
{
    const roots_point* points = net->points + m->line->first;
    float from = points[meeting_point(m, 0)].s, way = fabsf(points[m->line->count - 1].s - points[0].s);
    way = ty_min(TURN_WAY * net->points[m->at].r, TURN_SHARE * way);
    int count = 0;
    for (; count < WINDOW && count < m->line->count; count++)
    {
        if (count > 6 && fabsf(points[meeting_point(m, count - 1)].s - from) > way)
            break;
        p[count] = points[meeting_point(m, count)].p;
    }
    return count > 6 ? count : 0;
}

static void end_turn(const resting* on, const roots_network* net, const meeting* m, const float* over)
{
    roots_point* points = net->points + m->line->first;
    ty_vec3 t = growth_tangent(net, m->other, m->at), p[WINDOW];
    int count = window_take(net, m, p);
    if (count == 0)
        return;
    ty_vec3 first = ty_sub(p[1], p[0]);
    float step = ty_length(first);
    if (ty_dot(t, ty_sub(p[count - 1], p[0])) < 0.0f)
        t = ty_neg(t);
    if (!(step > 0.0f) || ty_dot(first, t) >= ALONG * step)
        return;
    p[1] = ty_mad(p[0], within(ty_mul(first, 1.0f / step), t, ALONG), step);
    span(p, count);
    const resting about = {on->host, on->sink, false};
    for (int round = 0; round < 4; round++)
    {
        for (int i = 2; i < count - 2; i++)
            keep_height(&about, &points[meeting_point(m, i)], over[meeting_point(m, i)], &p[i]);
        roots_bend(p, count, 2.0f);
    }
    for (int i = 1; i < count - 2; i++)
    {
        keep_height(on, &points[meeting_point(m, i)], over[meeting_point(m, i)], &p[i]);
        points[meeting_point(m, i)].p = p[i];
    }
}

void rest_ends(const resting* on, const roots_network* net, const roots_line* l, const float* over)
{
    for (int end = 0; end < 2; end++)
    {
        meeting m;
        if (meeting_find(net, l, end, &m))
            end_turn(on, net, &m, over);
    }
}

ty_vec3 rest_beyond(const roots_network* net, const roots_line* l, bool last)
{
    const roots_point* points = net->points + l->first;
    meeting m = {.line = l, .last = last};
    bool meets = meeting_find(net, l, last, &m);
    ty_vec3 end = points[meeting_point(&m, 0)].p, step = ty_sub(points[meeting_point(&m, 1)].p, end);
    if (!meets)
        return ty_sub(end, step);
    ty_vec3 t = growth_tangent(net, m.other, m.at);
    return ty_mad(end, t, ty_dot(t, step) < 0.0f ? ty_length(step) : -ty_length(step));
}

// --- how the other gives way ---

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
