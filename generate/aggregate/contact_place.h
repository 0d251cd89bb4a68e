// SPDX-License-Identifier: Apache-2.0
// Where two balls, or a ball and a wall, touch: for contacts and for the water between them.
#pragma once
#include "pile_state.h"

// Gap, normal and arms of a touch; false when its gap is above limit.
static inline bool pile_contact_place(const ty_pile* pile, const pair* p, const touch* t, float limit, contact* c)
{
    const ty_ball* ball = &pile_balls(pile, p->a)[t->a];
    ty_vec3 from = ball->center;
    if (p->b >= 0)
    {
        const ty_ball* other = &pile_balls(pile, p->b)[t->b];
        ty_vec3 d = ty_sub(from, other->center);
        float reach = ball->radius + other->radius, square = ty_length_sqr(d);
        if (square > ty_sqr(reach + limit))
            return false;
        float length = sqrtf(square);
        c->gap = length - reach;
        c->normal = length > 1e-9f ? ty_mul(d, 1.0f / length) : ty_vec3_make(0.0f, 1.0f, 0.0f);
        c->arm_b = ty_sub(ty_mad(other->center, c->normal, other->radius), pile->bodies[p->b].position);
    }
    else
    {
        c->gap = pile_wall(pile, t->b, from, &c->normal) - ball->radius;
        if (c->gap > limit)
            return false;
        c->arm_b = ty_vec3_make(0.0f, 0.0f, 0.0f);
    }
    c->arm_a = ty_sub(ty_mad(from, c->normal, -ball->radius), pile->bodies[p->a].position);
    return true;
}
