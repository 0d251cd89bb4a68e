// SPDX-License-Identifier: Apache-2.0
// The grid over a pile's bodies, built by counting; its cells stay within a few for each body.
#include "grid.h"
#include <string.h>

enum
{
    CELLS_EACH = 8, // of a body, at most
    CELLS_LEAST = 1 << 15,
};

static int coordinate(const body_grid* g, float x, float low, int axis)
{
    return (int)ty_clamp((x - low) / g->cell, 0.0f, (float)(g->size[axis] - 1));
}

// A body far off makes the space wide: then cells grow, which is right but slower.
static int64_t size_choose(body_grid* g, ty_vec3 extent, int count)
{
    int64_t most = (int64_t)CELLS_EACH * count + CELLS_LEAST;
    for (;; g->cell *= 1.25f)
    {
        const float along[3] = {extent.x, extent.y, extent.z};
        double cells = 1.0;
        for (int axis = 0; axis < 3; axis++)
        {
            g->size[axis] = (int)ty_clamp(along[axis] / g->cell + 1.0f, 1.0f, 1e6f);
            cells *= (double)g->size[axis];
        }
        if (cells <= (double)most)
            return (int64_t)cells;
    }
}

body_grid body_grid_create(const ty_pile* pile, float cell)
{
    body_grid g = {.cell = cell};
    ty_bounds b = ty_bounds_empty();
    for (int i = 0; i < pile->count; i++)
        b = ty_bounds_add(b, pile->bodies[i].position);
    if (pile->count == 0)
        b = ty_bounds_add(b, ty_vec3_make(0.0f, 0.0f, 0.0f));
    g.low = b.low;
    int64_t cells = size_choose(&g, ty_sub(b.high, b.low), pile->count);
    g.start = TY_ALLOC(int, cells + 1);
    g.sorted = TY_ALLOC(int, pile->count);
    g.cell_of = TY_ALLOC(int, pile->count);
    for (int i = 0; i < pile->count; i++)
    {
        ty_vec3 p = pile->bodies[i].position;
        int x = coordinate(&g, p.x, g.low.x, 0), y = coordinate(&g, p.y, g.low.y, 1);
        g.cell_of[i] = (coordinate(&g, p.z, g.low.z, 2) * g.size[1] + y) * g.size[0] + x;
        g.start[g.cell_of[i] + 1]++;
    }
    for (int64_t c = 0; c < cells; c++)
        g.start[c + 1] += g.start[c];
    for (int i = pile->count - 1; i >= 0; i--) // fills each cell from its end, and moves its end to its start
        g.sorted[--g.start[g.cell_of[i] + 1]] = i;
    memmove(g.start, g.start + 1, (size_t)cells * sizeof(int));
    g.start[cells] = pile->count;
    return g;
}

void body_grid_destroy(body_grid* g)
{
    ty_free(g->start);
    ty_free(g->sorted);
    ty_free(g->cell_of);
}

static bool spheres_meet(const ty_pile* pile, int i, int j)
{
    const ty_body *a = &pile->bodies[i], *b = &pile->bodies[j];
    float reach = pile->def.grains[a->grain].radius * a->scale + pile->def.grains[b->grain].radius * b->scale;
    reach = reach * pile->growth + 0.5f * (pile->poses[i].reach + pile->poses[j].reach);
    return ty_length_sqr(ty_sub(a->position, b->position)) <= reach * reach;
}

static void list_insert(body_list* out, int j)
{
    pile_reserve((void**)&out->at, &out->capacity, out->count + 1, sizeof(int));
    int at = out->count++;
    for (; at > 0 && out->at[at - 1] > j; at--)
        out->at[at] = out->at[at - 1];
    out->at[at] = j;
}

void body_grid_after(const ty_pile* pile, const body_grid* g, int i, body_list* out)
{
    int c = g->cell_of[i], x = c % g->size[0], y = c / g->size[0] % g->size[1], z = c / (g->size[0] * g->size[1]);
    out->count = 0;
    for (int k = z > 0 ? z - 1 : 0; k <= z + 1 && k < g->size[2]; k++)
        for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < g->size[1]; j++)
        {
            // Neighbours along x lie one after the other.
            int row = (k * g->size[1] + j) * g->size[0];
            int begin = g->start[row + (x > 0 ? x - 1 : 0)], end = g->start[row + (x + 1 < g->size[0] ? x + 1 : x) + 1];
            for (int s = begin; s < end; s++)
                if (g->sorted[s] > i && spheres_meet(pile, i, g->sorted[s]))
                    list_insert(out, g->sorted[s]);
        }
}

static bool body_holds(const ty_pile* pile, int i, ty_vec3 p)
{
    if (ty_length_sqr(ty_sub(p, pile->bodies[i].position)) > ty_sqr(pile->max_radius))
        return false;
    const int count = pile_ball_count(pile, i);
    for (int k = 0; k < count; k++)
    {
        const ty_ball* b = &pile_balls(pile, i)[k];
        if (ty_length_sqr(ty_sub(p, b->center)) < ty_sqr(b->radius))
            return true;
    }
    return false;
}

bool body_grid_inside(const ty_pile* pile, const body_grid* g, ty_vec3 p)
{
    int x = coordinate(g, p.x, g->low.x, 0), y = coordinate(g, p.y, g->low.y, 1), z = coordinate(g, p.z, g->low.z, 2);
    for (int k = z > 0 ? z - 1 : 0; k <= z + 1 && k < g->size[2]; k++)
        for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < g->size[1]; j++)
        {
            int row = (k * g->size[1] + j) * g->size[0];
            int begin = g->start[row + (x > 0 ? x - 1 : 0)], end = g->start[row + (x + 1 < g->size[0] ? x + 1 : x) + 1];
            for (int s = begin; s < end; s++)
                if (body_holds(pile, g->sorted[s], p))
                    return true;
        }
    return false;
}
