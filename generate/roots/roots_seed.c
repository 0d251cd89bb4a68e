// SPDX-License-Identifier: Apache-2.0
// The thesis' method, its main roots: balls that move outwards and down, five times for each growth point, until they
// meet the host (3.2).
#include "roots_seed.h"

enum
{
    MOVES = 5,          // of the ball, from one growth point to the next
    STUCK = 50,         // vain tries after which a main root has ended
    MOST_POINTS = 4000, // of a main root
};

#define FARTHEST 4.0f // units of a move, ahead and to either side

// --- main roots ---

// Where it is on host or floor a root creeps away from the middle, else it goes down as well.
static ty_vec3 way_of(const seed_run* run, ty_vec3 s)
{
    ty_vec3 way = {s.x - run->middle.x, 0.0f, s.z - run->middle.z}, below = s;
    below.y -= FARTHEST * run->unit;
    if (!seed_meets(run, below))
        way.y -= run->g->recipe->thesis.fall * run->unit;
    return ty_length_sqr(way) > 0.0f ? ty_normalize(way) : (ty_vec3){0.0f, -1.0f, 0.0f};
}

// From one growth point to the next (3.1): the last place of the ball before it meets something.
static ty_vec3 move_on(const seed_run* run, ty_vec3 s, ty_rng* rng)
{
    for (int i = 0; i < MOVES; i++)
    {
        ty_vec3 way = way_of(run, s);
        float ahead = ty_rng_range(rng, 0.0f, FARTHEST), aside = ty_rng_range(rng, -FARTHEST, FARTHEST);
        ty_vec3 next = ty_mad(s, way, ahead * run->unit);
        next = ty_mad(next, ty_cross(way, (ty_vec3){0.0f, 1.0f, 0.0f}), aside * run->unit);
        if (seed_meets(run, next))
            return s;
        s = next;
    }
    return s;
}

static void main_add(const seed_run* run, int number, ty_vec3* places)
{
    const ty_roots_recipe* recipe = run->g->recipe;
    roots_network* net = run->g->network;
    ty_rng rng = ty_rng_make(recipe->seed, 0x74686d61, (uint64_t)number);
    float turn = 2.0f * TY_PI * (float)number / (float)recipe->count, sine, cosine, length = 0.0f;
    float out = MOVES * 0.5f * FARTHEST * run->unit; // as far as one growth point is from the next, on the mean
    int count = 1, vain = 0;
    ty_sincos(turn, &sine, &cosine);
    ty_vec3 s = ty_mad(run->middle, (ty_vec3){cosine, 0.0f, sine}, out);
    places[0] = run->middle;
    while (seed_meets(run, s) && out > 0.1f * run->unit) // a place that is free, nearer to the middle
        s = ty_mad(run->middle, (ty_vec3){cosine, 0.0f, sine}, out *= 0.5f);
    places[count++] = s;
    while (length < recipe->length && vain < STUCK && count < MOST_POINTS)
    {
        ty_vec3 next = move_on(run, s, &rng);
        float moved = ty_length(ty_sub(next, s));
        vain = moved > 0.0f ? 0 : vain + 1;
        if (moved == 0.0f)
            continue;
        length += moved;
        s = places[count++] = next;
    }
    net->stuck += vain == STUCK;
    net->requested[ROOTS_MAIN]++;
    int above = number > 0 ? 0 : -1, point = number > 0 ? net->lines[0].first : -1;
    seed_add_line(run,
                  (roots_line){.kind = ROOTS_MAIN,
                               .parent = above,
                               .parent_point = point,
                               .end = -1,
                               .end_point = -1,
                               .key = ty_mix64((uint64_t)number + 1)},
                  places, count, 0.0f);
}

// Over the middle of the host's top, or the first place where roots may start.
static ty_vec3 middle_of(const growth* g, float r)
{
    ty_bounds b = g->host->mesh->bounds;
    ty_vec3 n, p = {0.5f * (b.low.x + b.high.x), b.high.y, 0.5f * (b.low.z + b.high.z)};
    p = g->start_count > 0 ? g->starts[0].p : p;
    p.y += 1.01f * r;
    return roots_host_value(g->host, p, NULL) < r ? roots_host_project(g->host, p, 1.01f * r, &n) : p;
}

bool growth_seed(growth* g)
{
    const ty_roots_recipe* recipe = g->recipe;
    seed_run run = {.g = g, .unit = recipe->thesis.unit * recipe->radius, .r = recipe->radius};
    ty_vec3* places = TY_ALLOC(ty_vec3, MOST_POINTS);
    run.middle = middle_of(g, run.r);
    g->network->top = TY_FLOAT_MAX;
    for (int i = 0; i < recipe->count; i++)
        main_add(&run, i, places);
    ty_free(places);
    return seed_branch(&run);
}
