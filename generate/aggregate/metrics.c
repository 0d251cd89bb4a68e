// SPDX-License-Identifier: Apache-2.0
// What one measures on a pile: speeds, overlaps, contacts, grains that float.
#include "pile_state.h"

#define NEAR_SHARE 0.02f // of the width: neighbours hold each other up to this gap
#define LOADED 0.01f     // of the weight of a mean grain: what presses by more is a contact that carries
#define TOUCH_GAP 1e-6f  // m: up to here they touch

void ty_pile_speeds(const ty_pile* pile, float* rms, float* largest)
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
    int count, loaded; // pairs
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
    float load = 0.0f, weight = ty_length(pile->def.gravity) / pile->def.rate; // impulses a substep
    int points = 0;
    for (int i = p->first; i < p->first + p->count; i++)
    {
        float gap = touch_gap(pile, p, &pile->near.touches[i]);
        points += gap <= near;
        least = ty_min(least, gap);
        load += pile->near.touches[i].normal_impulse;
    }
    o->loaded += p->b >= 0 && load > LOADED * weight;
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
    if (least < TOUCH_GAP && p->b >= 0)
    {
        o->sum += (double)ty_max(0.0f, -least);
        o->count++;
    }
}

void ty_pile_measure(ty_pile* pile, ty_pile_metrics* out, bool* held)
{
    *out = (ty_pile_metrics){.substeps = pile->substeps};
    if (pile->count == 0)
        return;
    pile_refresh_all(pile, NULL);
    if (pile_moved(pile, NULL))
        pile_detect(pile, pile->margin, NULL);
    support* supports = TY_ALLOC(support, pile->count);
    overlaps o = {0};
    for (int i = 0; i < pile->near.pair_count; i++)
        pair_measure(pile, &pile->near.pairs[i], supports, &o);
    *out = (ty_pile_metrics){.count = pile->count, .substeps = pile->substeps};
    double neighbours = 0.0;
    for (int i = 0; i < pile->count; i++)
    {
        const support* s = &supports[i];
        bool is_held = s->wall || (pile->cohesive ? s->points >= 1 : s->points >= 3 && s->neighbours >= 2);
        out->floating += !is_held;
        neighbours += s->neighbours;
        if (held)
            held[i] = is_held;
    }
    ty_free(supports);
    out->contacts = 2.0f * (float)o.count / (float)pile->count;
    out->loaded = 2.0f * (float)o.loaded / (float)pile->count;
    out->neighbours = (float)(neighbours / pile->count);
    out->overlap_max = o.largest / pile->mean_width;
    out->overlap_mean = o.count > 0 ? (float)(o.sum / o.count) / pile->mean_width : 0.0f;
    ty_pile_speeds(pile, &out->speed_rms, &out->speed_max);
    pile_packing(pile, out);
}
