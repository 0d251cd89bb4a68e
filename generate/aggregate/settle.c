// SPDX-License-Identifier: Apache-2.0
// The settling of a pile: sequential impulses whose normal and tangential parts are kept across substeps, and a relax
// sweep. Without that memory friction acts viscously and a pile never rests. Soft contacts after Catto 2011 and 2023.
#include "pile_state.h"

#define GRAVITY_RAMP 0.05f  // s
#define DAMPING_RATIO 10.0f // of a contact
#define PUSH_OUT 0.1f       // m/s, largest speed at which an overlap is undone
#define TOUCHING 2e-6f      // m, gap at which a bridge of liquid forms
#define SLEEP_SPEED 0.5e-3f // m/s
#define SLEEP_TIME 0.024f   // s, below that speed
#define WAKE_SPEED 5e-3f    // m/s, of a hit

// --- contacts of the substep ---

// Inverse effective masses of a body along the normal and the two tangents, and across these.
typedef struct inverse_mass
{
    float nn, ss, tt, st;
} inverse_mass;

static inline inverse_mass arm_mass(const motion* m, ty_vec3 arm, const ty_frame* f, ty_vec3 normal)
{
    ty_vec3 n = ty_cross(arm, normal), s = ty_cross(arm, f->t), t = ty_cross(arm, f->b);
    ty_vec3 js = ty_symmetric_times(m->inverse_inertia, s);
    return (inverse_mass){m->inverse_mass + ty_dot(n, ty_symmetric_times(m->inverse_inertia, n)),
                          m->inverse_mass + ty_dot(s, js),
                          m->inverse_mass + ty_dot(t, ty_symmetric_times(m->inverse_inertia, t)), ty_dot(js, t)};
}

// Inverse effective mass along the normal, and the mass below that of any tangential direction.
static inline void contact_masses(contact* c, const motion* a, const motion* b)
{
    ty_frame f = ty_frame_from_normal(c->normal);
    inverse_mass sum = arm_mass(a, c->arm_a, &f, c->normal);
    if (b)
    {
        inverse_mass more = arm_mass(b, c->arm_b, &f, c->normal);
        sum = (inverse_mass){sum.nn + more.nn, sum.ss + more.ss, sum.tt + more.tt, sum.st + more.st};
    }
    float half = 0.5f * (sum.ss - sum.tt);
    c->normal_weight = sum.nn;
    c->tangent_mass = 1.0f / (0.5f * (sum.ss + sum.tt) + sqrtf(half * half + sum.st * sum.st));
}

bool pile_contact_place(const ty_pile* pile, const pair* p, const touch* t, float limit, contact* c)
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

static bool is_still(const ty_pile* pile, int body)
{
    return body < 0 || pile->motions[body].asleep;
}

// The most that the gap of a touch was when candidates were found, if it is to be a contact now.
static float farthest(const ty_pile* pile, const pair* p)
{
    if (p->b < 0 && pile->walls)
        return TY_FLOAT_MAX;
    float moved = pile->poses[p->a].moved + (p->b >= 0 ? pile->poses[p->b].moved : 0.0f);
    return (PILE_TIGHT + moved + 2.0f * pile->resized) * (1.0f / PILE_GAP_UNIT) + 0.1f;
}

static void touch_unload(touch* t)
{
    if (t->normal_impulse == 0.0f) // most are: what is not written stays clean in the cache
        return;
    t->normal_impulse = 0.0f;
    t->tangent_impulse = ty_vec3_make(0.0f, 0.0f, 0.0f);
}

// The contacts of a pair from slot on.
static void pair_prepare(ty_pile* pile, pair* p, int slot)
{
    bool touching = false;
    const float limit = farthest(pile, p);
    p->slot = slot;
    if (p->gap > limit && !p->loaded && !p->bridged)
        return;
    contact* c = &pile->contacts[slot];
    for (int i = p->first; i < p->first + p->count; i++)
    {
        touch* t = &pile->near.touches[i];
        if (t->gap > limit || !pile_contact_place(pile, p, t, PILE_TIGHT, c))
        {
            touch_unload(t);
            continue;
        }
        touching |= c->gap <= TOUCHING;
        contact_masses(c, &pile->motions[p->a], p->b >= 0 ? &pile->motions[p->b] : NULL);
        c->normal_impulse = t->normal_impulse;
        c->tangent_impulse = ty_mad(t->tangent_impulse, c->normal, -ty_dot(t->tangent_impulse, c->normal));
        c->touch = i;
        c++;
    }
    p->active = (uint16_t)(c - &pile->contacts[slot]);
    p->loaded = p->active > 0;
    if (pile->cohesive)
        pile_bridge_prepare(pile, p, touching);
}

// --- impulses ---

static inline void kick(motion* m, ty_vec3 arm, ty_vec3 impulse, float sign)
{
    m->v = ty_mad(m->v, impulse, sign * m->inverse_mass);
    m->w = ty_mad(m->w, ty_symmetric_times(m->inverse_inertia, ty_cross(arm, impulse)), sign);
}

static void pair_kick(ty_pile* pile, const pair* p, const contact* c, ty_vec3 impulse)
{
    kick(&pile->motions[p->a], c->arm_a, impulse, 1.0f);
    if (p->b >= 0)
        kick(&pile->motions[p->b], c->arm_b, impulse, -1.0f);
}

static void pair_warm_start(ty_pile* pile, const pair* p)
{
    for (int i = p->slot; i < p->slot + p->active + p->pulled; i++)
    {
        const contact* c = &pile->contacts[i];
        pair_kick(pile, p, c, ty_mad(c->tangent_impulse, c->normal, c->normal_impulse));
    }
}

static ty_vec3 relative_velocity(const ty_pile* pile, const pair* p, const contact* c)
{
    const motion* a = &pile->motions[p->a];
    ty_vec3 u = ty_add(a->v, ty_cross(a->w, c->arm_a));
    if (p->b < 0)
    {
        ty_vec3 at = ty_add(pile->bodies[p->a].position, c->arm_a);
        return pile->walls ? ty_sub(u, pile_wall_velocity(pile, pile->near.touches[c->touch].b, at)) : u;
    }
    const motion* b = &pile->motions[p->b];
    return ty_sub(u, ty_add(b->v, ty_cross(b->w, c->arm_b)));
}

// One contact of a Gauss-Seidel sweep: bias is a velocity to be undone, softness an inverse mass.
static void contact_solve(ty_pile* pile, const pair* p, contact* c, float bias, float softness)
{
    ty_vec3 u = relative_velocity(pile, p, c);
    float along_normal = ty_dot(u, c->normal);
    float step = (along_normal + bias + softness * c->normal_impulse) / (c->normal_weight + softness);
    float normal = ty_max(0.0f, c->normal_impulse - step), limit = pile->def.friction * normal;
    ty_vec3 slip = ty_mad(u, c->normal, -along_normal);
    ty_vec3 tangent = ty_mad(c->tangent_impulse, slip, -c->tangent_mass);
    float square = ty_length_sqr(tangent);
    if (square > limit * limit)
        tangent = ty_mul(tangent, limit / sqrtf(square));
    ty_vec3 change = ty_mul(c->normal, normal - c->normal_impulse);
    change = ty_add(change, ty_sub(tangent, c->tangent_impulse));
    c->normal_impulse = normal;
    c->tangent_impulse = tangent;
    pair_kick(pile, p, c, change);
}

// A sleeper wakes when it is hit, or when what a bridge ties it to moves.
static void sleepers_wake(ty_pile* pile, const pair* p, const contact* c, bool tied)
{
    motion *a = &pile->motions[p->a], *b = p->b >= 0 ? &pile->motions[p->b] : NULL;
    bool sleeper = a->asleep || (b && b->asleep);
    if (!sleeper)
        return;
    ty_vec3 u = relative_velocity(pile, p, c);
    if ((tied ? ty_length(u) : -ty_dot(u, c->normal)) < WAKE_SPEED)
        return;
    a->woken = a->asleep;
    if (b)
        b->woken = b->asleep;
}

// A contact is a damped spring per unit mass, k = omega^2 / 2 and c = zeta omega at a quarter of the substep rate:
// softness gamma = 1 / (h (c + h k)), bias rate b = k / (c + h k).
static void pair_solve(ty_pile* pile, const pair* p)
{
    float h = 1.0f / pile->def.rate, omega = 0.5f * TY_PI * pile->def.rate;
    float k = 0.5f * omega * omega, damping = DAMPING_RATIO * omega;
    float softness = 1.0f / (h * (damping + h * k)), rate = k / (damping + h * k);
    for (int i = p->slot; i < p->slot + p->active; i++)
    {
        contact* c = &pile->contacts[i];
        sleepers_wake(pile, p, c, false);
        if (c->gap > 0.0f)
            contact_solve(pile, p, c, c->gap / h, 0.0f);
        else
            contact_solve(pile, p, c, ty_max(rate * c->gap, -PUSH_OUT), softness);
    }
    if (p->pulled)
        sleepers_wake(pile, p, &pile->contacts[p->slot + p->active], true);
}

static void pair_relax(ty_pile* pile, const pair* p)
{
    for (int i = p->slot; i < p->slot + p->active; i++)
    {
        contact* c = &pile->contacts[i];
        contact_solve(pile, p, c, c->gap > 0.0f ? c->gap * pile->def.rate : 0.0f, 0.0f);
        pile->near.touches[c->touch].normal_impulse = c->normal_impulse;
        pile->near.touches[c->touch].tangent_impulse = c->tangent_impulse;
        pile->motions[p->a].load += c->normal_impulse;
        if (p->b >= 0)
            pile->motions[p->b].load += c->normal_impulse;
    }
}

// --- blocks ---

// What a pair keeps acts before anything is solved, and its contacts are in the cache now.
static void block_prepare(void* context, int block, int begin, int end)
{
    (void)block;
    ty_pile* pile = context;
    int slot = pile->near.pairs[begin].first + begin; // room for each touch, and a pull of each pair
    for (int i = begin; i < end; i++)
    {
        pair* p = &pile->near.pairs[i];
        p->active = 0;
        p->pulled = false;
        if (is_still(pile, p->a) && is_still(pile, p->b))
            continue; // the impulses stay for when one of them wakes
        pair_prepare(pile, p, slot);
        pair_warm_start(pile, p);
        slot += p->active + p->pulled;
    }
}

// For as many contacts as there can be. What is not used of it is never touched.
static void contacts_reserve(ty_pile* pile)
{
    int needed = pile->near.touch_count + pile->near.pair_count + 1;
    if (needed <= pile->contact_capacity)
        return;
    ty_free(pile->contacts);
    pile->contact_capacity = needed + needed / 4;
    pile->contacts = ty_grow(NULL, 0, (size_t)pile->contact_capacity, sizeof(contact));
}

static void block_solve(void* context, int block, int begin, int end)
{
    (void)block;
    ty_pile* pile = context;
    for (int i = begin; i < end; i++)
        pair_solve(pile, &pile->near.pairs[i]);
}

static void block_relax(void* context, int block, int begin, int end)
{
    (void)block;
    ty_pile* pile = context;
    for (int i = begin; i < end; i++)
        pair_relax(pile, &pile->near.pairs[i]);
}

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
        if (m->asleep)
            continue;
        m->v = ty_add(m->v, step);
        m->w = ty_add(m->w, ty_symmetric_times(m->inverse_inertia, pile->rolls[i]));
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
    contacts_reserve(pile);
    pair_blocks_sweep(&pile->blocks, workers, block_prepare, pile);
    pair_blocks_sweep(&pile->blocks, workers, block_solve, pile);
    pile_each_body(pile, workers, bodies_advance, pile);
    pair_blocks_sweep(&pile->blocks, workers, block_relax, pile);
    pile_each_body(pile, workers, bodies_roll, pile);
    pile->time += 1.0f / pile->def.rate;
    pile->substeps++;
}

void ty_pile_step(ty_pile* pile, ty_workers* workers)
{
    pile->pause.held = false;
    pile_substep(pile, workers);
}
