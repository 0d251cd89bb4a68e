// SPDX-License-Identifier: Apache-2.0
// The settling of a pile: sequential impulses whose normal and tangential parts are kept across substeps, and a relax
// sweep. Without that memory friction acts viscously and a pile never rests. Soft contacts after Catto 2011 and 2023.
#include "pile_state.h"

#define GRAVITY_RAMP 0.05f  // s
#define SLEEP_SPEED 0.5e-3f // m/s
#define SLEEP_TIME 0.024f   // s, below that speed

// --- the substep ---

static float gravity_share(const ty_pile* pile)
{
    return ty_min(1.0f, pile->time / GRAVITY_RAMP);
}

ty_vec3 ty_pile_gravity(const ty_pile* pile)
{
    return ty_mul(pile->def.gravity, gravity_share(pile));
}

static void bodies_accelerate(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    ty_pile* pile = context;
    ty_vec3 step = ty_mul(pile->def.gravity, gravity_share(pile) / pile->def.rate);
    for (int64_t i = begin; i < end; i++)
    {
        motion* m = &pile->motions[i];
        m->load = 0.0f;
        pile->poses[i].travel = 0.0f;
        if (m->asleep)
            continue;
        m->v = ty_add(m->v, step);
        m->w = ty_add(m->w, ty_symmetric_times(m->inverse_inertia, pile->rolls[i]));
        pile->poses[i].travel = (ty_length(m->v) + ty_length(m->w) * pile_radius(pile, (int)i)) / pile->def.rate;
    }
}

// I w, by the rows of the inverse, which are scaled to their trace against overflow.
static ty_vec3 spin_momentum(const float s[6], ty_vec3 w)
{
    float unit = 1.0f / (s[0] + s[1] + s[2]);
    ty_vec3 x = ty_mul(ty_vec3_make(s[0], s[3], s[4]), unit), y = ty_mul(ty_vec3_make(s[3], s[1], s[5]), unit);
    ty_vec3 z = ty_mul(ty_vec3_make(s[4], s[5], s[2]), unit), yz = ty_cross(y, z);
    ty_vec3 l = {ty_dot(w, yz), ty_dot(w, ty_cross(z, x)), ty_dot(w, ty_cross(x, y))};
    return ty_mul(l, unit / ty_dot(x, yz));
}

// Turns a body free of torques: its momentum L stays and dw/dt = I^-1 (L x w). The spin of the middle of the substep
// turns it (midpoint rule), then its inertia there tells the spin from L.
static void body_rotate(ty_pile* pile, int i)
{
    float h = 1.0f / pile->def.rate;
    motion* m = &pile->motions[i];
    ty_vec3 l = spin_momentum(m->inverse_inertia, m->w);
    ty_vec3 middle = ty_mad(m->w, ty_symmetric_times(m->inverse_inertia, ty_cross(l, m->w)), 0.5f * h);
    pile_turn(&pile->bodies[i], ty_mul(middle, h));
    pile_refresh(pile, i);
    m->w = ty_symmetric_times(m->inverse_inertia, l);
}

static void bodies_advance(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    ty_pile* pile = context;
    float h = 1.0f / pile->def.rate;
    for (int64_t i = begin; i < end; i++)
    {
        ty_body* b = &pile->bodies[i];
        if (pile->motions[i].asleep)
            continue;
        b->position = ty_mad(b->position, pile->motions[i].v, h);
        body_rotate(pile, (int)i);
    }
}

// Rolling resistance: an impulse against the spin, at most the load times a small arm. It is kept, as friction is: what
// holds a ball on a slope has to be there before it rolls, or the ball creeps.
static void body_roll(const ty_pile* pile, motion* m, ty_vec3* kept)
{
    float limit = pile->def.rolling * 0.5f * pile->mean_width * m->load;
    ty_vec3 wanted = ty_sub(*kept, spin_momentum(m->inverse_inertia, m->w));
    float size = ty_length(wanted);
    if (size > limit)
        wanted = ty_mul(wanted, limit / size);
    m->w = ty_add(m->w, ty_symmetric_times(m->inverse_inertia, ty_sub(wanted, *kept)));
    *kept = wanted;
}

void pile_body_wake(ty_pile* pile, int i)
{
    motion* m = &pile->motions[i];
    m->asleep = m->woken = false;
    m->quiet = 0;
    pile_refresh(pile, i); // brings its mass back
}

void pile_body_sleep(motion* m)
{
    *m = (motion){.asleep = true};
}

static void bodies_roll(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    ty_pile* pile = context;
    for (int64_t i = begin; i < end; i++)
    {
        motion* m = &pile->motions[i];
        if (m->woken)
            pile_body_wake(pile, (int)i);
        if (m->asleep)
            continue;
        body_roll(pile, m, &pile->rolls[i]);
        float speed = ty_length(m->v) + ty_length(m->w) * 0.5f * pile->mean_width;
        m->quiet = speed < SLEEP_SPEED && pile->may_sleep && !pile->walls ? (uint16_t)(m->quiet + 1) : 0;
        if ((float)m->quiet > SLEEP_TIME * pile->def.rate)
            pile_body_sleep(m);
        pile->bodies[i].velocity = m->v;
        pile->bodies[i].spin = m->w;
    }
}

void pile_substep(ty_pile* pile, ty_workers* workers)
{
    pile_walls_place(pile);
    if (pile_moved(pile, workers))
        pile_detect(pile, pile->margin, workers);
    pile_each_body(pile, workers, bodies_accelerate, pile);
    pile_contacts_prepare(pile, workers);
    pile_contacts_solve(pile, workers);
    pile_each_body(pile, workers, bodies_advance, pile);
    pile_contacts_relax(pile, workers);
    pile_each_body(pile, workers, bodies_roll, pile);
    pile->time += 1.0f / pile->def.rate;
    pile->substeps++;
}

void ty_pile_step(ty_pile* pile, ty_workers* workers)
{
    pile->pause.held = false;
    pile_substep(pile, workers);
}
