// SPDX-License-Identifier: Apache-2.0
// Growth of the network: main roots, what links them, and when each part comes.
#include "roots_growth.h"

ty_vec3 growth_tangent(const roots_network* network, const roots_line* line, int point)
{
    int before = point > line->first ? point - 1 : point, last = line->first + line->count - 1;
    int after = point < last ? point + 1 : point;
    return ty_normalize(ty_sub(network->points[after].p, network->points[before].p));
}

typedef struct settling
{
    const growth* g;
    int first; // line
} settling;

static void lines_settle(void* context, int64_t begin, int64_t end, int worker)
{
    const settling* s = context;
    const roots_network* net = s->g->network;
    (void)worker;
    for (int64_t i = begin; i < end; i++)
    {
        const roots_line* l = &net->lines[s->first + i];
        for (int k = l->parent >= 0; k < l->count - (l->end >= 0); k++)
        {
            roots_point* p = &net->points[l->first + k];
            ty_vec3 n;
            if (p->sink <= 0.0f)
                continue;
            float wrong = roots_host_exact(s->g->host, p->p, 3.0f * p->r, &n) - growth_height(p);
            p->p = ty_mad(p->p, n, -ty_clamp(wrong, -p->r, p->r));
        }
    }
}

void growth_settle(const growth* g, int first)
{
    settling s = {g, first};
    ty_parallel_all(g->workers, g->network->line_count - first, 4, lines_settle, &s);
}

// When the tip passes each point, as a share of the longest way; the rest of the time is for growing thicker.
static void births_set(roots_network* network)
{
    float longest = 0.0f;
    for (int i = 0; i < network->point_count; i++)
        longest = ty_max(longest, network->points[i].s);
    for (int i = 0; i < network->point_count; i++)
        network->points[i].birth = longest > 0.0f ? network->points[i].s / longest : 0.0f;
}

ty_status roots_grow(const ty_roots_recipe* recipe, const roots_host* host, ty_workers* workers, roots_network* out,
                     ty_error* error)
{
    growth g = {.recipe = recipe, .host = host, .workers = workers, .network = out};
    *out = (roots_network){0};
    bool done = growth_main(&g);
    growth_settle(&g, 0);
    done = done && growth_link(&g, &recipe->first, ROOTS_MAIN, ROOTS_FIRST);
    done = done && growth_link(&g, &recipe->second, ROOTS_FIRST, ROOTS_SECOND);
    births_set(out);
    if (!done)
        return ty_error_set(error, TY_INTERRUPTED, "interrupted while roots grew");
    return TY_OK;
}
