// SPDX-License-Identifier: Apache-2.0
// Contacts of a substep and the impulses in them, block by block: prepared, solved and relaxed.
#include "contact_place.h"

#define DAMPING_RATIO 10.0f // of a contact
#define PUSH_OUT 0.1f       // m/s, largest speed at which an overlap is undone
#define TOUCHING 2e-6f      // m, gap at which a bridge of liquid forms
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

// The farthest that a touch without an impulse has to do with this substep: twice as far as two bodies go now.
static float farthest_free(const ty_pile* pile, const pair* p)
{
    if (pile->cohesive || pile->walls)
        return PILE_TIGHT;
    float travel = pile->poses[p->a].travel + (p->b >= 0 ? pile->poses[p->b].travel : 0.0f);
    return TOUCHING + 2.0f * travel;
}

// The contacts of a pair from slot on.
static void pair_prepare(ty_pile* pile, pair* p, int slot)
{
    bool touching = false;
    const float limit = farthest(pile, p), free = farthest_free(pile, p);
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
        if (c->gap > free && t->normal_impulse == 0.0f)
            continue;
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

// Two bodies while their contacts are worked off. A wall has no inverse mass.
typedef struct ends
{
    const motion *a, *b;
    ty_vec3 va, wa, vb, wb;
} ends;

static inline ends ends_of(const ty_pile* pile, const pair* p)
{
    static const motion wall;
    const motion *a = &pile->motions[p->a], *b = p->b >= 0 ? &pile->motions[p->b] : &wall;
    return (ends){a, b, a->v, a->w, b->v, b->w};
}

static inline void ends_store(ty_pile* pile, const pair* p, const ends* e)
{
    motion* a = &pile->motions[p->a];
    a->v = e->va;
    a->w = e->wa;
    if (p->b < 0)
        return;
    motion* b = &pile->motions[p->b];
    b->v = e->vb;
    b->w = e->wb;
}

static inline void kick(ends* e, const contact* c, ty_vec3 impulse)
{
    e->va = ty_mad(e->va, impulse, e->a->inverse_mass);
    e->wa = ty_add(e->wa, ty_symmetric_times(e->a->inverse_inertia, ty_cross(c->arm_a, impulse)));
    e->vb = ty_mad(e->vb, impulse, -e->b->inverse_mass);
    e->wb = ty_sub(e->wb, ty_symmetric_times(e->b->inverse_inertia, ty_cross(c->arm_b, impulse)));
}

static inline ty_vec3 relative_velocity(const ty_pile* pile, const pair* p, const ends* e, const contact* c)
{
    ty_vec3 u = ty_add(e->va, ty_cross(e->wa, c->arm_a));
    if (p->b < 0 && pile->walls)
    {
        ty_vec3 at = ty_add(pile->bodies[p->a].position, c->arm_a);
        return ty_sub(u, pile_wall_velocity(pile, pile->near.touches[c->touch].b, at));
    }
    return ty_sub(u, ty_add(e->vb, ty_cross(e->wb, c->arm_b)));
}

static void pair_warm_start(ty_pile* pile, const pair* p)
{
    ends e = ends_of(pile, p);
    for (int i = p->slot; i < p->slot + p->active + p->pulled; i++)
    {
        const contact* c = &pile->contacts[i];
        kick(&e, c, ty_mad(c->tangent_impulse, c->normal, c->normal_impulse));
    }
    ends_store(pile, p, &e);
}

// One contact of a Gauss-Seidel sweep: bias is a velocity to be undone, softness an inverse mass.
static inline void contact_solve(float friction, ty_vec3 u, ends* e, contact* c, float bias, float softness)
{
    float along_normal = ty_dot(u, c->normal);
    float step = (along_normal + bias + softness * c->normal_impulse) / (c->normal_weight + softness);
    float normal = ty_max(0.0f, c->normal_impulse - step), limit = friction * normal;
    ty_vec3 slip = ty_mad(u, c->normal, -along_normal);
    ty_vec3 tangent = ty_mad(c->tangent_impulse, slip, -c->tangent_mass);
    float square = ty_length_sqr(tangent);
    if (square > limit * limit)
        tangent = ty_mul(tangent, limit / sqrtf(square));
    ty_vec3 change = ty_mul(c->normal, normal - c->normal_impulse);
    change = ty_add(change, ty_sub(tangent, c->tangent_impulse));
    c->normal_impulse = normal;
    c->tangent_impulse = tangent;
    kick(e, c, change);
}

// A sleeper wakes when it is hit, or when what a bridge ties it to moves.
static inline void sleepers_wake(ty_pile* pile, const pair* p, const contact* c, ty_vec3 u, bool tied)
{
    motion *a = &pile->motions[p->a], *b = p->b >= 0 ? &pile->motions[p->b] : NULL;
    bool sleeper = a->asleep || (b && b->asleep);
    if (!sleeper || (tied ? ty_length(u) : -ty_dot(u, c->normal)) < WAKE_SPEED)
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
    ends e = ends_of(pile, p);
    for (int i = p->slot; i < p->slot + p->active; i++)
    {
        contact* c = &pile->contacts[i];
        ty_vec3 u = relative_velocity(pile, p, &e, c);
        sleepers_wake(pile, p, c, u, false);
        bool apart = c->gap > 0.0f;
        float bias = apart ? c->gap * pile->def.rate : ty_max(rate * c->gap, -PUSH_OUT);
        contact_solve(pile->def.friction, u, &e, c, bias, apart ? 0.0f : softness);
    }
    if (p->pulled)
    {
        const contact* c = &pile->contacts[p->slot + p->active];
        sleepers_wake(pile, p, c, relative_velocity(pile, p, &e, c), true);
    }
    ends_store(pile, p, &e);
}

static void pair_relax(ty_pile* pile, const pair* p)
{
    ends e = ends_of(pile, p);
    float load = 0.0f;
    for (int i = p->slot; i < p->slot + p->active; i++)
    {
        contact* c = &pile->contacts[i];
        ty_vec3 u = relative_velocity(pile, p, &e, c);
        contact_solve(pile->def.friction, u, &e, c, c->gap > 0.0f ? c->gap * pile->def.rate : 0.0f, 0.0f);
        touch* t = &pile->near.touches[c->touch];
        t->normal_impulse = c->normal_impulse;
        t->tangent_impulse = c->tangent_impulse;
        load += c->normal_impulse;
    }
    ends_store(pile, p, &e);
    pile->motions[p->a].load += load;
    if (p->b >= 0)
        pile->motions[p->b].load += load;
}

// --- blocks ---

// What a pair keeps acts before anything is solved, and its contacts are in the cache now.
static void block_prepare(void* context, int begin, int end)
{
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
        if (p->active + p->pulled > 0)
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

static void block_solve(void* context, int begin, int end)
{
    ty_pile* pile = context;
    for (int i = begin; i < end; i++)
        if (pile->near.pairs[i].active + pile->near.pairs[i].pulled > 0)
            pair_solve(pile, &pile->near.pairs[i]);
}

static void block_relax(void* context, int begin, int end)
{
    ty_pile* pile = context;
    for (int i = begin; i < end; i++)
        if (pile->near.pairs[i].active > 0)
            pair_relax(pile, &pile->near.pairs[i]);
}

void pile_contacts_prepare(ty_pile* pile, ty_workers* workers)
{
    contacts_reserve(pile);
    pair_blocks_sweep(&pile->blocks, workers, block_prepare, pile);
}

void pile_contacts_solve(ty_pile* pile, ty_workers* workers)
{
    pair_blocks_sweep(&pile->blocks, workers, block_solve, pile);
}

void pile_contacts_relax(ty_pile* pile, ty_workers* workers)
{
    pair_blocks_sweep(&pile->blocks, workers, block_relax, pile);
}
