// SPDX-License-Identifier: Apache-2.0
// The bodies of a pile: added, removed, resized.
#include "pile_state.h"
#include <string.h>

ty_pile_def ty_pile_def_default(void)
{
    return (ty_pile_def){.gravity = {0.0f, -9.81f, 0.0f},
                         .friction = 0.5f,
                         .rolling = 0.001f,
                         .rate = 2500.0f,
                         .bridge = ty_bridge_def_default()};
}

ty_pile* ty_pile_create(const ty_pile_def* def)
{
    TY_ASSERT(def->grain_count > 0 && def->rate > 0.0f);
    ty_pile* pile = TY_ALLOC(ty_pile, 1);
    pile->def = *def;
    pile->growth = 1.0f;
    pile->stale = true;
    for (int i = 0; i < def->grain_count; i++)
    {
        pile->mean_volume += def->grains[i].volume / (float)def->grain_count;
        pile->mean_width += def->grains[i].width / (float)def->grain_count;
    }
    pile_bridge_init(pile);
    return pile;
}

void ty_pile_destroy(ty_pile* pile)
{
    if (!pile)
        return;
    void* arrays[] = {pile->bodies,       pile->poses,         pile->motions,        pile->balls,
                      pile->ball_first,   pile->near.pairs,    pile->near.places,    pile->near.touches,
                      pile->former.pairs, pile->former.places, pile->former.touches, pile->contacts,
                      pile->blocks.first, pile->walls,         pile->solid,          pile->rolls,
                      pile->bends};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        ty_free(arrays[i]);
    ty_free(pile);
}

int ty_pile_count(const ty_pile* pile)
{
    return pile->count;
}

const ty_body* ty_pile_bodies(const ty_pile* pile)
{
    return pile->bodies;
}

static void bodies_reserve(ty_pile* pile, int needed)
{
    if (needed <= pile->capacity)
        return;
    size_t old = (size_t)pile->capacity, grown = (size_t)needed + (size_t)needed / 4 + 16;
    pile->bodies = ty_grow(pile->bodies, old, grown, sizeof *pile->bodies);
    if (pile->bends)
        pile->bends = ty_grow(pile->bends, old, grown, sizeof *pile->bends);
    pile->poses = ty_grow(pile->poses, old, grown, sizeof *pile->poses);
    pile->motions = ty_grow(pile->motions, old, grown, sizeof *pile->motions);
    pile->rolls = ty_grow(pile->rolls, old, grown, sizeof *pile->rolls);
    pile->ball_first = ty_grow(pile->ball_first, old ? old + 1 : 0, grown + 1, sizeof *pile->ball_first);
    pile->capacity = (int)grown;
}

// Lays out the balls of the bodies from first on; their positions are for pile_refresh.
static void balls_lay(ty_pile* pile, int first)
{
    if (first == 0)
        pile->ball_first[0] = 0;
    for (int i = first; i < pile->count; i++)
    {
        TY_ASSERT(pile->bodies[i].grain < (uint32_t)pile->def.grain_count);
        pile->ball_first[i + 1] = pile->ball_first[i] + pile->def.grains[pile->bodies[i].grain].ball_count;
    }
    list_reserve((void**)&pile->balls, &pile->ball_capacity, pile->ball_first[pile->count], sizeof(ty_ball));
}

static void body_enter(ty_pile* pile, int i)
{
    const ty_body* body = &pile->bodies[i];
    pile->poses[i] = (pose){.seen = body->position, .seen_rotation = body->rotation};
    pile->motions[i] = (motion){.v = body->velocity, .w = body->spin};
    pile->max_radius =
        ty_max(pile->max_radius, pile->def.grains[body->grain].radius * body->scale * pile_bent_reach(pile, i));
    pile_refresh(pile, i);
    pile->stale = true;
}

void ty_pile_add(ty_pile* pile, const ty_body* bodies, int count)
{
    bodies_reserve(pile, pile->count + count);
    int first = pile->count;
    if (count == 0)
        return;
    pile->pause.held = false;
    memcpy(pile->bodies + first, bodies, (size_t)count * sizeof *bodies);
    pile->count += count;
    balls_lay(pile, first);
    for (int i = first; i < pile->count; i++)
    {
        pile->rolls[i] = ty_vec3_make(0.0f, 0.0f, 0.0f);
        if (pile->bends)
            pile->bends[i] = pile_bend_none(&pile->def.grains[pile->bodies[i].grain]);
        body_enter(pile, i);
    }
}

void ty_pile_set_bodies(ty_pile* pile, const ty_body* bodies)
{
    if (pile->count == 0)
        return;
    pile->pause.held = false;
    memmove(pile->bodies, bodies, (size_t)pile->count * sizeof *bodies);
    balls_lay(pile, 0);
    for (int i = 0; i < pile->count; i++)
        body_enter(pile, i);
}

void ty_pile_resize(ty_pile* pile, const float* scales)
{
    float most = 0.0f;
    pile->max_radius = 0.0f;
    for (int i = 0; i < pile->count; i++)
    {
        ty_body* body = &pile->bodies[i];
        float radius = pile->def.grains[body->grain].radius * pile_bent_reach(pile, i);
        most = ty_max(most, radius * (scales[i] - body->scale));
        pile->max_radius = ty_max(pile->max_radius, radius * scales[i]);
        body->scale = scales[i];
        pile_refresh(pile, i);
    }
    pile->pause.held = false;
    pile->resized += most;
    pile->stale = pile->stale || pile->resized > 0.1f * PILE_MARGIN; // bodies that move use up the rest
}

void ty_pile_set_bridge(ty_pile* pile, const ty_bridge_def* bridge)
{
    pile->pause.held = false;
    pile->def.bridge = *bridge;
    pile_bridge_init(pile);
    pile->stale = true;
}

// Drops the pairs of removed bodies and renames the others; ascending order is kept, so impulses still find their pair.
static void pairs_rename(ty_pile* pile, const int* renamed)
{
    candidates* near = &pile->near;
    pair* pairs = TY_ALLOC(pair, near->pair_count);
    int kept = 0, walls = 0;
    for (int i = 0; i < near->pair_count; i++)
    {
        pair p = near->pairs[near->places[i]];
        if (renamed[p.a] < 0 || (p.b >= 0 && renamed[p.b] < 0))
            continue;
        p.a = renamed[p.a];
        p.b = p.b >= 0 ? renamed[p.b] : p.b;
        walls += p.b < 0;
        pairs[kept++] = p;
    }
    for (int i = 0; i < kept; i++)
    {
        near->pairs[i] = pairs[i];
        near->places[i] = i;
    }
    ty_free(pairs);
    near->pair_count = kept;
    near->wall_first = kept - walls;
    pile->stale = true;
}

void ty_pile_remove(ty_pile* pile, const bool* gone)
{
    int* renamed = TY_ALLOC(int, pile->count);
    int kept = 0;
    for (int i = 0; i < pile->count; i++)
    {
        renamed[i] = gone[i] ? -1 : kept;
        if (gone[i])
            continue;
        pile->bodies[kept] = pile->bodies[i];
        if (pile->bends)
            pile->bends[kept] = pile->bends[i];
        pile->poses[kept] = pile->poses[i];
        pile->motions[kept] = pile->motions[i];
        pile->rolls[kept] = pile->rolls[i];
        int first = pile->ball_first[i], balls = pile_ball_count(pile, i);
        memmove(pile_balls(pile, kept), pile->balls + first, sizeof(ty_ball) * (size_t)balls);
        pile->ball_first[kept + 1] = pile->ball_first[kept] + balls;
        kept++;
    }
    pile->pause.held = false;
    pile->count = kept;
    pairs_rename(pile, renamed);
    ty_free(renamed);
}

void pile_turn(ty_body* body, ty_vec3 r)
{
    ty_quat q = body->rotation, half = {0.5f * r.x, 0.5f * r.y, 0.5f * r.z, 1.0f};
    body->rotation = ty_quat_normalize(ty_quat_multiply(half, q));
}

ty_vec3 ty_pile_momentum(const ty_pile* pile)
{
    ty_vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < pile->count; i++)
        sum = ty_mad(sum, pile->motions[i].v, 1.0f / pile->motions[i].inverse_mass);
    return sum;
}

void pile_each_body(ty_pile* pile, ty_workers* workers, ty_range_fn* fn, void* context)
{
    enum
    {
        WORTH_SHARING = 1024,
    };
    ty_parallel_all(pile->count >= WORTH_SHARING ? workers : NULL, pile->count, PILE_PIECE, fn, context);
}
