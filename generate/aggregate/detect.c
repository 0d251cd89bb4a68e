// SPDX-License-Identifier: Apache-2.0
// When candidates for contacts are found again, and how far they are looked for.
#include "pile_state.h"
#include <stdatomic.h>

#define REACH_SHARE 0.08f // of a body's radius, mean distance that a pile is looked ahead

// m/s, of a point of the body at most.
static float body_speed(const ty_pile* pile, int i)
{
    const motion* m = &pile->motions[i];
    return ty_length(m->v) + ty_length(m->w) * pile->def.grains[pile->bodies[i].grain].radius;
}

// Seconds that a body's speed is looked ahead: twelve substeps each way, or fewer when the whole pile is fast, for
// candidates grow with the cube of the reach. Single fast bodies reach far and keep the others from being searched.
static float look_ahead(const ty_pile* pile)
{
    const float longest = 24.0f / pile->def.rate;
    float speeds = 0.0f, radii = 0.0f;
    for (int i = 0; i < pile->count; i++)
    {
        speeds += body_speed(pile, i);
        radii += pile->def.grains[pile->bodies[i].grain].radius * pile->bodies[i].scale;
    }
    return speeds * longest > REACH_SHARE * radii ? REACH_SHARE * radii / speeds : longest;
}

void pile_detect(ty_pile* pile, float margin, ty_workers* workers)
{
    const float ahead = look_ahead(pile);
    for (int i = 0; i < pile->count; i++)
    {
        float radius = pile->def.grains[pile->bodies[i].grain].radius;
        pile->poses[i].reach = ty_min(ty_max(margin, ahead * body_speed(pile, i)), margin + radius);
        pile->poses[i].seen = pile->bodies[i].position;
        pile->poses[i].seen_rotation = pile->bodies[i].rotation;
        pile->poses[i].moved = 0.0f;
    }
    pile_walls_see(pile);
    pile_detect_again(pile, workers);
}

typedef struct look
{
    ty_pile* pile;
    atomic_bool far; // a body moved too far
} look;

// Each of two balls may come nearer by .45 of the margin. An angle is at most 2.1 times the distance of its
// quaternions.
static void moved_range(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    look* l = context;
    const ty_pile* pile = l->pile;
    bool far = false;
    for (int i = (int)begin; i < (int)end; i++)
    {
        const ty_body* b = &pile->bodies[i];
        pose* at = &pile->poses[i];
        ty_quat p = b->rotation, q = at->seen_rotation;
        float turn = ty_sqr(p.x - q.x) + ty_sqr(p.y - q.y) + ty_sqr(p.z - q.z) + ty_sqr(p.w - q.w);
        float lever = 2.1f * pile_radius(pile, i);
        at->moved = ty_length(ty_sub(b->position, at->seen)) + lever * sqrtf(turn);
        far |= at->moved > 0.45f * at->reach;
    }
    if (far)
        atomic_store(&l->far, true);
}

bool pile_moved(ty_pile* pile, ty_workers* workers)
{
    if (pile->stale || pile_walls_moved(pile))
        return true;
    look l = {.pile = pile};
    pile_each_body(pile, workers, moved_range, &l);
    return atomic_load(&l.far);
}
