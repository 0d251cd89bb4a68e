// SPDX-License-Identifier: Apache-2.0
// How thick roots are, and when each part of them comes.
#include "roots_growth.h"

// Of a line's own radius.
#define THINNEST 0.75f
#define THICKEST 1.35f

// --- the pipe model ---

// What leaves or comes in at each point, as r^n; branches end on each other, so that only those of the middle count.
static float* flows_make(const growth* g)
{
    const roots_network* net = g->network;
    float* flow = TY_ALLOC(float, net->point_count);
    for (int i = 0; i < net->line_count; i++)
    {
        const roots_line* l = &net->lines[i];
        float own = ty_exp(g->recipe->exponent * ty_ln(net->points[l->first + l->count / 2].r));
        if (growth_leaves(l))
            flow[l->parent_point] += own;
        if (l->end >= 0)
            flow[l->end_point] -= own;
    }
    return flow;
}

// Shinozaki et al. 1964. A loop would feed itself: bounded, and changed over some radii.
static void line_pipe(const growth* g, const roots_line* l, const float* flow, float* ratio)
{
    roots_point* points = g->network->points + l->first;
    float n = g->recipe->exponent, sum = 0.0f;
    for (int i = l->count - 1; i >= 0; i--)
    {
        float own = ty_exp(n * ty_ln(points[i].r)), area = own + sum;
        ratio[i] = area > 0.0f ? ty_clamp(ty_exp(ty_ln(area / own) / n), THINNEST, THICKEST) : THINNEST;
        sum += flow[l->first + i];
    }
    for (int way = 0; way < 2; way++) // evened out, both ways
        for (int k = 1; k < l->count; k++)
        {
            int i = way ? l->count - 1 - k : k, before = way ? i + 1 : i - 1;
            float step = fabsf(points[i].s - points[before].s);
            ratio[i] = ty_lerp(ratio[before], ratio[i], 1.0f - ty_exp(-step / (5.0f * points[i].r)));
        }
    for (int i = 0; i < l->count; i++) // tips stay as thin as they are
    {
        float left = (points[l->count - 1].s - points[i].s) / (12.0f * points[i].r);
        points[i].r *= l->end < 0 ? ty_lerp(1.0f, ratio[i], ty_min(left, 1.0f)) : ratio[i];
    }
}

// What joins another is thinner than that where they meet.
static void end_fit(const roots_network* net, const roots_line* l, int end, float to)
{
    for (int i = 0; i < l->count; i++)
    {
        roots_point* p = &net->points[l->first + i];
        p->r = ty_min(p->r, 0.95f * to + 0.4f * fabsf(p->s - net->points[end].s));
    }
}

void growth_pipe(const growth* g)
{
    const roots_network* net = g->network;
    float *flow = flows_make(g), *ratio = TY_ALLOC(float, net->point_count);
    for (int i = 0; i < net->line_count; i++)
        if (net->lines[i].kind != ROOTS_TRUNK)
            line_pipe(g, &net->lines[i], flow, ratio);
    for (int i = 0; i < net->line_count; i++) // those that are joined come first
    {
        const roots_line* l = &net->lines[i];
        if (growth_leaves(l))
            end_fit(net, l, l->first, net->points[l->parent_point].r);
        if (l->end >= 0)
            end_fit(net, l, l->first + l->count - 1, net->points[l->end_point].r);
    }
    ty_free(flow);
    ty_free(ratio);
}

// --- births ---

// A branch sets out some time after its parent has passed, and no sooner than that it finds its partner in place.
// The last tip has done at 3/4 of the time, so that all of it grows to its full radius.
void growth_births(roots_network* net)
{
    float longest = 0.0f, last = 0.0f;
    for (int i = 0; i < net->point_count; i++)
        longest = ty_max(longest, net->points[i].s);
    for (int i = 0; i < net->line_count; i++)
    {
        const roots_line* l = &net->lines[i];
        roots_point* points = net->points + l->first;
        float start = points[0].s, length = points[l->count - 1].s - start;
        if (growth_leaves(l))
            start = net->points[l->parent_point].birth + 0.04f * longest;
        if (l->end >= 0)
            start = ty_max(start, net->points[l->end_point].birth - length);
        for (int k = 0; k < l->count; k++)
            points[k].birth = start + points[k].s - points[0].s;
        last = ty_max(last, points[l->count - 1].birth);
    }
    for (int i = 0; i < net->point_count; i++)
        net->points[i].birth = last > 0.0f ? 0.75f * net->points[i].birth / last : 0.0f;
}
