// SPDX-License-Identifier: Apache-2.0
// Position projection: overlaps are pushed apart without velocities, to fill a space and to polish a settled pile.
#include "pile_state.h"

#define OVER_RELAXATION 1.4f // of each correction: thirty times less is left after as many sweeps

static ty_vec3 ball_center(const ty_pile* pile, int body, int ball)
{
    return ty_map_point(&pile->poses[body].frame, pile->def.grains[pile->bodies[body].grain].balls[ball].center);
}

// Moves a body by a position impulse at arm, and its frame with it.
static void body_push(ty_pile* pile, int i, ty_vec3 arm, ty_vec3 impulse)
{
    const motion* m = &pile->motions[i];
    ty_body* body = &pile->bodies[i];
    body->position = ty_mad(body->position, impulse, m->inverse_mass);
    pile_turn(body, ty_symmetric_times(m->inverse_inertia, ty_cross(arm, impulse)));
    pile->poses[i].frame = ty_pile_frame(pile, i);
}

static float weight(const motion* m, ty_vec3 arm, ty_vec3 n)
{
    ty_vec3 u = ty_cross(arm, n);
    return m->inverse_mass + ty_dot(u, ty_symmetric_times(m->inverse_inertia, u));
}

// Whether the touch of the ball at from had to be corrected.
static bool touch_project_wall(ty_pile* pile, const pair* p, const touch* t, ty_vec3 from, float radius)
{
    ty_vec3 n;
    float gap = pile_wall(pile, t->b, from, &n) - radius;
    if (gap >= 0.0f)
        return false;
    ty_vec3 arm = ty_sub(ty_mad(from, n, -radius), pile->bodies[p->a].position);
    body_push(pile, p->a, arm, ty_mul(n, -OVER_RELAXATION * gap / weight(&pile->motions[p->a], arm, n)));
    return true;
}

static bool touch_project(ty_pile* pile, const pair* p, const touch* t, ty_vec3 from, float radius)
{
    float other = pile_balls(pile, p->b)[t->b].radius;
    ty_vec3 to = ball_center(pile, p->b, t->b), d = ty_sub(from, to);
    float square = ty_length_sqr(d);
    if (square >= ty_sqr(radius + other))
        return false;
    float length = sqrtf(square);
    ty_vec3 n = length > 1e-9f ? ty_mul(d, 1.0f / length) : ty_vec3_make(0.0f, 1.0f, 0.0f);
    ty_vec3 arm_a = ty_sub(ty_mad(from, n, -radius), pile->bodies[p->a].position);
    ty_vec3 arm_b = ty_sub(ty_mad(to, n, other), pile->bodies[p->b].position);
    float sum = weight(&pile->motions[p->a], arm_a, n) + weight(&pile->motions[p->b], arm_b, n);
    ty_vec3 impulse = ty_mul(n, OVER_RELAXATION * (radius + other - length) / sum);
    body_push(pile, p->a, arm_a, impulse);
    body_push(pile, p->b, arm_b, ty_neg(impulse));
    return true;
}

static void pair_project(ty_pile* pile, const pair* p)
{
    ty_vec3 from = {0.0f, 0.0f, 0.0f};
    for (int i = p->first, last = -1; i < p->first + p->count; i++)
    {
        const touch* t = &pile->near.touches[i];
        if (t->a != last) // several touches of a ball follow each other
            from = ball_center(pile, p->a, t->a);
        float radius = pile_balls(pile, p->a)[t->a].radius;
        bool moved = p->b >= 0 ? touch_project(pile, p, t, from, radius) : touch_project_wall(pile, p, t, from, radius);
        last = moved ? -1 : t->a;
    }
}

static void block_project(void* context, int begin, int end)
{
    ty_pile* pile = context;
    for (int i = begin; i < end; i++)
        pair_project(pile, &pile->near.pairs[i]);
}

void pile_project(ty_pile* pile, ty_workers* workers)
{
    pair_blocks_sweep(&pile->blocks, workers, block_project, pile);
}

static void refresh_range(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    for (int64_t i = begin; i < end; i++)
        pile_refresh(context, (int)i);
}

void pile_refresh_all(ty_pile* pile, ty_workers* workers)
{
    pile_each_body(pile, workers, refresh_range, pile);
}

static void stop(ty_pile* pile)
{
    for (int i = 0; i < pile->count; i++)
    {
        pile->bodies[i].velocity = pile->bodies[i].spin = ty_vec3_make(0.0f, 0.0f, 0.0f);
        pile->motions[i].v = pile->motions[i].w = ty_vec3_make(0.0f, 0.0f, 0.0f);
    }
}

void ty_pile_inflate(ty_pile* pile, const ty_fill_top* top, int sweeps, ty_workers* workers)
{
    float grow = 0.6f * (float)sweeps;
    pile->pause.held = false;
    pile->lid = top;
    for (int k = 0; k < sweeps && !ty_cancel_requested(); k++)
    {
        bool growing = (float)k < grow;
        pile->growth = growing ? 0.5f + 0.5f * (float)k / grow : 1.0f;
        if (k % (growing ? 4 : 8) == 0)
        {
            pile_refresh_all(pile, workers);
            pile_detect(pile, 0.25e-3f * pile->growth, workers);
        }
        pile_project(pile, workers);
    }
    pile->growth = 1.0f;
    pile->lid = NULL;
    stop(pile);
    pile_refresh_all(pile, workers);
    pile->stale = true;
}

void ty_pile_polish(ty_pile* pile, int sweeps, ty_workers* workers)
{
    pile->pause.held = false;
    stop(pile);
    for (int k = 0; k < sweeps && !ty_cancel_requested(); k++)
    {
        if (pile_moved(pile, workers))
        {
            pile_refresh_all(pile, workers);
            pile_detect(pile, pile->margin, workers);
        }
        pile_project(pile, workers);
    }
    pile_refresh_all(pile, workers);
}
