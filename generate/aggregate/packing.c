// SPDX-License-Identifier: Apache-2.0
// How deep the grains of a pile lie below its upper surface, and what share of the space they take.
#include "pile_state.h"

// --- the upper surface, as heights over cells of half a width ---

typedef struct heights
{
    float* y;
    ty_vec3 low;
    float cell;
    int size[2];
} heights;

static int heights_index(const heights* h, float x, float z)
{
    int i = (int)ty_clamp((x - h->low.x) / h->cell, 0.0f, (float)(h->size[0] - 1));
    int k = (int)ty_clamp((z - h->low.z) / h->cell, 0.0f, (float)(h->size[1] - 1));
    return k * h->size[0] + i;
}

static void heights_mark(heights* h, const ty_ball* ball)
{
    float reach = 0.7f * ball->radius;
    for (int s = -1; s <= 1; s++)
        for (int t = -1; t <= 1; t++)
        {
            int at = heights_index(h, ball->center.x + (float)s * reach, ball->center.z + (float)t * reach);
            h->y[at] = ty_max(h->y[at], ball->center.y + ball->radius);
        }
}

static heights heights_create(const ty_pile* pile)
{
    ty_bounds b = ty_bounds_empty();
    for (int i = 0; i < pile->ball_first[pile->count]; i++)
        b = ty_bounds_add(b, pile->balls[i].center);
    heights h = {.low = b.low, .cell = 0.5f * pile->mean_width};
    h.cell = ty_max(h.cell, ty_max(b.high.x - b.low.x, b.high.z - b.low.z) / 2048.0f);
    h.size[0] = (int)((b.high.x - b.low.x) / h.cell) + 1;
    h.size[1] = (int)((b.high.z - b.low.z) / h.cell) + 1;
    h.y = TY_ALLOC(float, h.size[0] * h.size[1]);
    for (int i = 0; i < h.size[0] * h.size[1]; i++)
        h.y[i] = b.low.y;
    for (int i = 0; i < pile->ball_first[pile->count]; i++)
        heights_mark(&h, &pile->balls[i]);
    return h;
}

void ty_pile_depth(const ty_pile* pile, float* depth)
{
    if (pile->count == 0)
        return;
    heights h = heights_create(pile);
    for (int i = 0; i < pile->count; i++)
    {
        depth[i] = TY_FLOAT_MAX;
        for (int k = 0; k < pile_ball_count(pile, i); k++)
        {
            const ty_ball* b = &pile_balls(pile, i)[k];
            float below = h.y[heights_index(&h, b->center.x, b->center.z)] - b->center.y - b->radius;
            depth[i] = ty_min(depth[i], ty_max(0.0f, below));
        }
    }
    ty_free(h.y);
}

// Inside of the container and a width off its walls.
static bool clear_of_walls(const ty_pile* pile, ty_vec3 p)
{
    const ty_container* c = pile->def.container;
    int walls = c ? ty_container_wall_count(c) : 0;
    ty_vec3 n;
    ty_vec3 inside = c ? pile_in_wall(pile, 0, p) : p;
    if (c && inside.y < ty_container_interior(c).high.y && !ty_container_holds(c, inside))
        return false;
    for (int w = 0; w < walls; w++)
        if (pile_wall(pile, w, p, &n) < pile->mean_width)
            return false;
    return true;
}

// --- packing fraction ---

// Volume of a grain's mesh over that of the union of its balls, by points on a grid about these.
static float solid_share(const ty_element* grain)
{
    enum
    {
        ACROSS = 24,
    };
    ty_bounds b = ty_bounds_empty();
    for (int k = 0; k < grain->ball_count; k++)
    {
        float r = grain->balls[k].radius;
        b = ty_bounds_add(b, ty_sub(grain->balls[k].center, ty_vec3_make(r, r, r)));
        b = ty_bounds_add(b, ty_add(grain->balls[k].center, ty_vec3_make(r, r, r)));
    }
    ty_vec3 step = ty_mul(ty_sub(b.high, b.low), 1.0f / (float)ACROSS);
    int in = 0;
    for (int i = 0; i < ACROSS * ACROSS * ACROSS; i++)
    {
        ty_vec3 at = {(float)(i % ACROSS), (float)(i / ACROSS % ACROSS), (float)(i / (ACROSS * ACROSS))};
        ty_vec3 p = ty_add(b.low, ty_mul3(step, ty_add(at, ty_vec3_make(0.5f, 0.5f, 0.5f))));
        bool held = false;
        for (int k = 0; k < grain->ball_count && !held; k++)
            held = ty_length_sqr(ty_sub(p, grain->balls[k].center)) < ty_sqr(grain->balls[k].radius);
        in += held;
    }
    return in > 0 ? grain->volume / ((float)in * step.x * step.y * step.z) : 1.0f;
}

static bool body_holds(const void* owner, int i, ty_vec3 p)
{
    const ty_pile* pile = owner;
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

// Shares of points that lie in a ball and in a grain, among points two widths below the surface and one off the walls.
// A ball counts for as much of its grain's mesh as the mesh has of the union of balls.
static void points_count(const ty_pile* pile, const heights* h, const body_grid* grid, ty_pile_metrics* out)
{
    ty_rng rng = ty_rng_make((ty_seed){0}, 0x706869, (uint64_t)pile->count);
    const int tries = 40000;
    int in = 0, all = 0;
    double solid = 0.0;
    for (int i = 0; i < tries; i++)
    {
        float x = h->low.x + (float)h->size[0] * h->cell * ty_rng_float(&rng);
        float z = h->low.z + (float)h->size[1] * h->cell * ty_rng_float(&rng);
        float low = h->low.y + 0.5f * pile->mean_width;
        float high = h->y[heights_index(h, x, z)] - 2.0f * pile->mean_width;
        ty_vec3 p = {x, low + (high - low) * ty_rng_float(&rng), z};
        if (high <= low || !clear_of_walls(pile, p))
            continue;
        int body = body_grid_find(grid, p, body_holds, pile);
        all++;
        in += body >= 0;
        solid += body >= 0 ? (double)pile->solid[pile->bodies[body].grain] : 0.0;
    }
    out->phi = all > 200 ? (float)(solid / all) : 0.0f;
    out->phi_balls = all > 200 ? (float)in / (float)all : 0.0f;
}

void pile_packing(ty_pile* pile, ty_pile_metrics* out)
{
    if (pile->count < 100)
        return;
    if (!pile->solid)
    {
        pile->solid = TY_ALLOC(float, pile->def.grain_count);
        for (int i = 0; i < pile->def.grain_count; i++)
            pile->solid[i] = solid_share(&pile->def.grains[i]);
    }
    heights h = heights_create(pile);
    body_grid grid = body_grid_create(pile->bodies, offsetof(ty_body, position), sizeof(ty_body), pile->count,
                                      1.01f * pile->max_radius);
    points_count(pile, &h, &grid, out);
    ty_free(h.y);
    body_grid_destroy(&grid);
}
