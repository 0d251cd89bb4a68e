// SPDX-License-Identifier: Apache-2.0
// What one measures on a pile: speeds, overlaps, contacts, grains that float, depth below the surface, packing
// fraction.

#include "pile_state.h"

#define NEAR_SHARE 0.02f // of the width: a gap up to here counts as a contact

void pile_speeds(const ty_pile* pile, float* rms, float* largest)
{
    double sum = 0.0;
    float most = 0.0f;
    for (int i = 0; i < pile->count; i++)
        for (int k = 0; k < pile_ball_count(pile, i); k++)
        {
            const motion* m = &pile->motions[i];
            ty_vec3 arm = ty_sub(pile_balls(pile, i)[k].center, pile->bodies[i].position);
            float square = ty_length_sqr(ty_add(m->v, ty_cross(m->w, arm)));
            sum += (double)square;
            most = ty_max(most, square);
        }
    *rms = pile->count > 0 ? (float)sqrt(sum / (double)pile->ball_first[pile->count]) : 0.0f;
    *largest = sqrtf(most);
}

// What holds a body.
typedef struct support
{
    int points, neighbours;
    bool wall;
} support;

typedef struct overlaps
{
    double sum;
    int count;
    float largest;
} overlaps;

static float touch_gap(const ty_pile* pile, const pair* p, const touch* t)
{
    const ty_ball* a = &pile_balls(pile, p->a)[t->a];
    ty_vec3 n;
    if (p->b < 0)
        return pile_wall(pile, t->b, a->center, &n) - a->radius;
    const ty_ball* b = &pile_balls(pile, p->b)[t->b];
    return ty_length(ty_sub(a->center, b->center)) - a->radius - b->radius;
}

static void pair_measure(const ty_pile* pile, const pair* p, support* supports, overlaps* o)
{
    float near = NEAR_SHARE * pile->mean_width, least = TY_FLOAT_MAX;
    int points = 0;
    for (int i = p->first; i < p->first + p->count; i++)
    {
        float gap = touch_gap(pile, p, &pile->touches[i]);
        points += gap <= near;
        least = ty_min(least, gap);
    }
    if (points > 0 && p->b < 0)
        supports[p->a].wall = true;
    if (points > 0 && p->b >= 0)
    {
        int ends[2] = {p->a, p->b};
        for (int e = 0; e < 2; e++)
        {
            supports[ends[e]].points += points;
            supports[ends[e]].neighbours++;
        }
    }
    o->largest = ty_max(o->largest, -least);
    if (least < 1e-6f && p->b >= 0)
    {
        o->sum += (double)ty_max(0.0f, -least);
        o->count++;
    }
}

static float phi_measure(const ty_pile* pile);

void ty_pile_measure(ty_pile* pile, ty_pile_metrics* out, bool* held)
{
    pile_refresh_all(pile);
    if (pile_moved(pile))
        pile_detect(pile, pile->margin, NULL);
    support* supports = TY_ALLOC(support, pile->count);
    overlaps o = {0};
    for (int i = 0; i < pile->pair_count; i++)
        pair_measure(pile, &pile->pairs[i], supports, &o);
    *out = (ty_pile_metrics){.count = pile->count, .substeps = pile->substeps};
    double neighbours = 0.0;
    for (int i = 0; i < pile->count; i++)
    {
        const support* s = &supports[i];
        bool is_held = s->wall || (s->points >= 3 && s->neighbours >= 2);
        out->floating += !is_held;
        neighbours += s->neighbours;
        if (held)
            held[i] = is_held;
    }
    ty_free(supports);
    out->contacts = pile->count > 0 ? (float)(neighbours / pile->count) : 0.0f;
    out->overlap_max = o.largest / pile->mean_width;
    out->overlap_mean = o.count > 0 ? (float)(o.sum / o.count) / pile->mean_width : 0.0f;
    pile_speeds(pile, &out->speed_rms, &out->speed_max);
    out->phi = phi_measure(pile);
}

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

// Share of points that lie in a ball, among points two widths below the surface and one off the walls.
static float phi_measure(const ty_pile* pile)
{
    if (pile->count < 100)
        return 0.0f;
    heights h = heights_create(pile);
    ty_rng rng = ty_rng_make((ty_seed){0}, 0x706869, (uint64_t)pile->count);
    body_grid grid = body_grid_create(pile->bodies, offsetof(ty_body, position), sizeof(ty_body), pile->count,
                                      1.01f * pile->max_radius);
    const int tries = 40000;
    int in = 0, all = 0;
    for (int i = 0; i < tries; i++)
    {
        float x = h.low.x + (float)h.size[0] * h.cell * ty_rng_float(&rng);
        float z = h.low.z + (float)h.size[1] * h.cell * ty_rng_float(&rng);
        float low = h.low.y + 0.5f * pile->mean_width;
        float high = h.y[heights_index(&h, x, z)] - 2.0f * pile->mean_width;
        ty_vec3 p = {x, low + (high - low) * ty_rng_float(&rng), z};
        if (high <= low || !clear_of_walls(pile, p))
            continue;
        all++;
        in += body_grid_any(&grid, p, body_holds, pile);
    }
    ty_free(h.y);
    body_grid_destroy(&grid);
    return all > 200 ? (float)in / (float)all : 0.0f;
}
