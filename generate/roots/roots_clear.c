// SPDX-License-Identifier: Apache-2.0
// Lines keep clear of obstacles when all has its place and its width: they bend out of the way over the host.
#include "roots_growth.h"

enum
{
    SPREAD = 40, // rounds in which neighbours go along
};

// What moves a point out of the way over the surface that it lies on, or through the air.
static ty_vec3 way_out(const growth* g, const roots_point* p)
{
    ty_vec3 away, none = {0.0f, 0.0f, 0.0f};
    float lack = g->recipe->growth.clear * p->r - roots_host_clear(g->host, p->p, &away);
    if (lack <= 0.0f || ty_length_sqr(away) <= 0.0f)
        return none;
    away = ty_normalize(away);
    ty_vec3 over = p->sink > 0.0f ? growth_without(away, p->n) : away;
    float length = ty_length(over);
    return ty_mul(length > 0.3f ? ty_mul(over, 1.0f / ty_sqr(length)) : away, ty_min(lack, p->r));
}

// false: nothing was in the way.
static bool line_clear(const growth* g, const roots_line* l, ty_vec3* by)
{
    roots_point* points = g->network->points + l->first;
    bool any = false;
    for (int i = 0; i < l->count; i++)
    {
        by[i] = way_out(g, &points[i]);
        any |= ty_length_sqr(by[i]) > 0.0f;
    }
    for (int round = 0; any && round < SPREAD; round++)
        for (int i = 1; i + 1 < l->count; i++)
        {
            ty_vec3 middle = ty_mul(ty_add(by[i - 1], by[i + 1]), 0.5f);
            by[i] = ty_length_sqr(middle) > ty_length_sqr(by[i]) ? middle : by[i];
        }
    for (int i = 0; any && i < l->count; i++)
        points[i].p = ty_add(points[i].p, by[i]);
    return any;
}

void growth_clear(const growth* g)
{
    enum
    {
        ROUNDS = 4
    };
    const roots_network* net = g->network;
    if (!g->host->obstacles.values)
        return;
    ty_vec3* by = TY_ALLOC(ty_vec3, net->point_count);
    for (int i = 0; i < net->line_count; i++)
        for (int round = 0; net->lines[i].kind != ROOTS_TRUNK && round < ROUNDS; round++)
            if (!line_clear(g, &net->lines[i], by))
                break;
    ty_free(by);
}
