// SPDX-License-Identifier: Apache-2.0
// The thesis' method, its branches: Bezier curves between neighbouring main roots that turn about the vertical where
// they meet the host (3.3.1, 3.3.2), main roots that bend away (3.3.3), curves between first branches (3.3.4).
#include "roots_seed.h"

// I(-a, a) of the thesis: one of the two.
static float either(ty_rng* rng, float a)
{
    return ty_rng_float(rng) < 0.5f ? -a : a;
}

// --- first branches ---

// (3.11), from a to the curve's end.
static void controls_set(const seed_run* run, seed_curve* c, ty_vec3 a, ty_rng* rng)
{
    ty_vec3 across = ty_sub(c->control[3], a);
    c->control[0] = a;
    for (int i = 1; i <= 2; i++)
    {
        c->control[i] = ty_mad(a, across, (float)i / 3.0f);
        c->control[i].y += either(rng, 15.0f) * run->unit;
    }
}

// p turned about the vertical through `about` by a degree at a time, one way by chance, until it is free (3.13).
static bool turn_free(const seed_run* run, ty_vec3 about, ty_vec3* p, ty_rng* rng)
{
    float way = either(rng, 1.0f);
    ty_vec3 d = ty_sub(*p, about);
    for (int degrees = 1; degrees < 360; degrees++)
    {
        float sine, cosine;
        ty_sincos(way * ty_radians((float)degrees), &sine, &cosine);
        *p = ty_add(about, (ty_vec3){cosine * d.x + sine * d.z, d.y, cosine * d.z - sine * d.x});
        if (!seed_meets(run, *p))
            return true;
    }
    return false;
}

// One curve to the end, or to where it had to turn: that is where the next one begins. false: nothing is free.
static bool curve_go(const seed_run* run, seed_curve* c, bool* arrived, ty_rng* rng)
{
    ty_vec3 before = c->control[0];
    *arrived = false;
    for (int i = 1; i <= SEED_SAMPLES && c->count < SEED_POINTS; i++)
    {
        ty_vec3 p = c->control[3];
        if (i < SEED_SAMPLES) // ends stay where they meet the main roots
        {
            p = seed_bezier(c->control, (float)i / SEED_SAMPLES);
            p.y += ty_rng_range(rng, -1.5f, 1.5f) * run->unit; // (3.12)
        }
        bool meets = i < SEED_SAMPLES && seed_meets(run, p);
        if (meets && !turn_free(run, before, &p, rng))
            return false;
        c->places[c->count++] = before = p;
        if (meets)
        {
            controls_set(run, c, p, rng);
            return true;
        }
        *arrived = i == SEED_SAMPLES;
    }
    return true;
}

roots_failure seed_curve_find(const seed_run* run, ty_vec3 a, ty_vec3 b, ty_rng* rng, seed_curve* c)
{
    bool arrived = false;
    c->control[3] = b;
    c->places[0] = a;
    c->count = 1;
    controls_set(run, c, a, rng);
    for (int i = 0; i < SEED_RESTARTS; i++)
    {
        if (!curve_go(run, c, &arrived, rng))
            return ROOTS_NO_ANGLE;
        if (arrived)
            return ROOTS_FAILURES;
        if (c->count >= SEED_POINTS)
            return ROOTS_POINTS;
    }
    return ROOTS_RESTARTS;
}

// The main root goes off to the other side of what leaves it (3.14).
static void main_bend(const seed_run* run, const roots_line* line, int b, ty_vec3 first)
{
    roots_point* m = &run->g->network->points[line->first + b];
    if (b + SEED_EVERY >= line->count)
        return;
    ty_vec3 away = ty_sub(m[1].p, first);
    const ty_vec3 control[4] = {m[0].p, ty_mad(first, away, 2.0f), m[2].p, m[SEED_EVERY].p};
    for (int i = 1; i < SEED_EVERY; i++)
        m[i].p = seed_bezier(control, (float)i / SEED_EVERY);
}

// The number of its line; -1: there is none, or none that has arrived.
static int first_add(const seed_run* run, int a, int b, seed_curve* c)
{
    roots_network* net = run->g->network;
    const roots_line main = net->lines[a], next = net->lines[(a + 1) % run->g->recipe->count];
    uint64_t key = ty_mix64((uint64_t)a << 32 | (uint64_t)b);
    ty_rng rng = ty_rng_make(run->g->recipe->seed, 0x74686669, key);
    net->requested[ROOTS_FIRST]++;
    if (b >= next.count)
    {
        net->failed[ROOTS_NO_PARTNER]++;
        return -1;
    }
    const roots_point from = net->points[main.first + b], to = net->points[next.first + b];
    roots_failure failure = seed_curve_find(run, from.p, to.p, &rng, c);
    if (failure < ROOTS_FAILURES)
        net->failed[failure]++;
    if (c->count < 2 || failure == ROOTS_RESTARTS || failure == ROOTS_POINTS) // given up: it goes round and round
        return -1;
    bool arrived = failure == ROOTS_FAILURES;
    int line = seed_add_line(run,
                             (roots_line){.kind = ROOTS_FIRST,
                                          .parent = a,
                                          .parent_point = main.first + b,
                                          .end = arrived ? (a + 1) % run->g->recipe->count : -1,
                                          .end_point = arrived ? next.first + b : -1,
                                          .key = key},
                             c->places, c->count, from.s);
    main_bend(run, &main, b, c->places[1]);
    return arrived ? line : -1;
}

// --- second branches ---

// (3.15): to the side as seen from the middle, and no dodging.
static void second_add(const seed_run* run, int from, int to)
{
    roots_network* net = run->g->network;
    net->requested[ROOTS_SECOND]++;
    if (from < 0 || to < 0)
    {
        net->failed[ROOTS_NO_PARTNER]++;
        return;
    }
    uint64_t key = ty_mix64((uint64_t)from << 32 | (uint64_t)to);
    ty_rng rng = ty_rng_make(run->g->recipe->seed, 0x74687365, net->lines[from].key);
    int a = net->lines[from].first + net->lines[from].count / 2, b = net->lines[to].first + net->lines[to].count / 2;
    ty_vec3 control[4], places[SEED_SECOND + 1];
    control[0] = net->points[a].p;
    control[3] = net->points[b].p;
    for (int i = 1; i <= 2; i++)
    {
        control[i] = ty_lerp3(control[0], control[3], (float)i / 3.0f);
        ty_vec3 w = {control[i].x - run->middle.x, 0.0f, control[i].z - run->middle.z};
        w = ty_length_sqr(w) > 0.0f ? ty_normalize(w) : (ty_vec3){1.0f, 0.0f, 0.0f};
        control[i] = ty_mad(control[i], ty_cross(w, (ty_vec3){0.0f, 1.0f, 0.0f}), either(&rng, 20.0f) * run->unit);
    }
    for (int i = 0; i <= SEED_SECOND; i++)
        places[i] = seed_bezier(control, (float)i / SEED_SECOND);
    places[SEED_SECOND] = control[3];
    seed_add_line(
        run,
        (roots_line){.kind = ROOTS_SECOND, .parent = from, .parent_point = a, .end = to, .end_point = b, .key = key},
        places, SEED_SECOND + 1, net->points[a].s);
}

// --- all of them ---

bool seed_branch(seed_run* run)
{
    roots_network* net = run->g->network;
    int mains = run->g->recipe->count, most = 0;
    for (int a = 0; a < mains; a++)
        most = net->lines[a].count > most ? net->lines[a].count : most;
    int rows = mains > 1 && most > SEED_FIRST ? (most - 1 - SEED_FIRST) / SEED_EVERY + 1 : 0;
    int* firsts = TY_ALLOC(int, (int64_t)rows* mains + 1);
    seed_curve* c = TY_ALLOC(seed_curve, 1);
    for (int row = 0; row < rows && !ty_cancel_requested(); row++)
        for (int a = 0; a < mains; a++)
        {
            int b = SEED_FIRST + row * SEED_EVERY;
            firsts[row * mains + a] = b < net->lines[a].count ? first_add(run, a, b, c) : -2;
        }
    for (int row = 0; row + 1 < rows && !ty_cancel_requested(); row++)
        for (int a = 0; a < mains; a++)
            if (firsts[(row + 1) * mains + a] > -2) // both have been asked for
                second_add(run, firsts[row * mains + a], firsts[(row + 1) * mains + a]);
    ty_free(firsts);
    ty_free(c);
    return !ty_cancel_requested();
}
