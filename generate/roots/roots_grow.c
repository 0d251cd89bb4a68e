// SPDX-License-Identifier: Apache-2.0
// Growth of the network: main roots, what hangs from them, what links them, what covers the rest, and how thick all is.
#include "roots_growth.h"

// Nothing grows thinner by it than roots end.
static void radii_shape(const growth* g)
{
    const ty_roots_recipe* recipe = g->recipe;
    for (int l = 0; l < g->network->line_count; l++)
    {
        const roots_line* line = &g->network->lines[l];
        roots_point* p = g->network->points + line->first;
        for (int i = 0; i < line->count && line->kind != ROOTS_TRUNK; i++)
            p[i].r = ty_max(p[i].r * growth_ramp(&recipe->radius_by_length, (p[i].s - p[0].s) / recipe->length),
                            ty_min(p[i].r, recipe->tip));
    }
}

static bool wrap_grow(growth* g)
{
    const ty_roots_recipe* recipe = g->recipe;
    bool done = growth_main(g) && growth_aerial(g);
    radii_shape(g);
    growth_settle(g, 0, false);
    int first = g->network->line_count;
    done = done && growth_link(g, &recipe->first, ROOTS_MAIN, ROOTS_FIRST);
    growth_part(g, first);
    growth_settle(g, 0, false);
    done = done && growth_link(g, &recipe->second, ROOTS_FIRST, ROOTS_SECOND);
    growth_pipe(g);
    growth_clear(g);
    growth_settle(g, 0, true);
    return done && growth_cover(g);
}

ty_status roots_grow(const ty_roots_recipe* recipe, const roots_host* host, ty_workers* workers, roots_network* out,
                     ty_error* error)
{
    growth g = {.recipe = recipe, .host = host, .workers = workers, .network = out};
    *out = (roots_network){0};
    ty_status status = roots_host_starts(host, recipe, recipe->count, &g.starts, &g.start_count, error);
    if (status != TY_OK)
        return status;
    bool done = recipe->method == TY_ROOTS_SEED ? growth_seed(&g) : wrap_grow(&g);
    growth_births(out);
    ty_free(g.starts);
    if (!done)
        return ty_error_set(error, TY_INTERRUPTED, "interrupted while roots grew");
    return TY_OK;
}
