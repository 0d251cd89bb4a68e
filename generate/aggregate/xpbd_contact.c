// SPDX-License-Identifier: Apache-2.0
// Contacts of elastic bodies: found on a grid in id order, put into blocks, and projected once a substep with friction
// and the pull of water. Multipliers begin at 0 each time: friction undoes the slip of that substep alone.
#include "xpbd_state.h"

#define PULL_STEP 0.01e-3f // m, farthest that a pull moves a particle in a substep

// --- walls ---

float xpbd_wall(const ty_xpbd* x, int wall, ty_vec3 p, ty_vec3* normal)
{
    if (wall == XPBD_LID)
    {
        *normal = ty_vec3_make(0.0f, -1.0f, 0.0f);
        return x->lid - p.y;
    }
    if (x->squeeze.x == 1.0f && x->squeeze.y == 1.0f && x->squeeze.z == 1.0f)
        return ty_container_wall(x->def.container, wall, p, normal);
    // The distance to first order: value over gradient.
    ty_vec3 inverse = {1.0f / x->squeeze.x, 1.0f / x->squeeze.y, 1.0f / x->squeeze.z};
    ty_vec3 from = ty_add(x->squeeze_center, ty_mul3(ty_sub(p, x->squeeze_center), inverse));
    float gap = ty_container_wall(x->def.container, wall, from, normal);
    *normal = ty_mul3(*normal, inverse);
    float steepness = ty_length(*normal);
    *normal = ty_mul(*normal, 1.0f / steepness);
    return gap / steepness;
}

// --- candidates ---

static bool bodies_meet(const void* owner, int i, int j)
{
    const ty_xpbd* x = owner;
    const soft *a = &x->bodies[i], *b = &x->bodies[j];
    return ty_length_sqr(ty_sub(a->center, b->center)) <= ty_sqr(a->radius + b->radius + x->margin);
}

static void near_push(ty_xpbd* x, int a, int b)
{
    list_reserve((void**)&x->nears, &x->near_capacity, x->near_count + 1, sizeof(near));
    x->nears[x->near_count++] = (near){.a = a, .b = b};
}

static void couple_push(ty_xpbd* x, int a, int b, int first)
{
    if (x->near_count == first)
        return;
    list_reserve((void**)&x->couples, &x->couple_capacity, x->couple_count + 1, sizeof(couple));
    x->couples[x->couple_count++] = (couple){.a = a, .b = b, .first = first, .count = x->near_count - first};
}

static void bodies_near(ty_xpbd* x, int i, int j)
{
    const soft *a = &x->bodies[i], *b = &x->bodies[j];
    int first = x->near_count;
    for (int s = a->first; s < a->first + a->count; s++)
    {
        const particle *p = &x->particles[s], *q = x->particles;
        if (ty_length_sqr(ty_sub(p->x, b->center)) > ty_sqr(p->radius + b->radius + x->margin))
            continue;
        for (int t = b->first; t < b->first + b->count; t++)
            if (ty_length_sqr(ty_sub(p->x, q[t].x)) < ty_sqr(p->radius + q[t].radius + x->margin))
                near_push(x, s, t);
    }
    couple_push(x, i, j, first);
}

static body_grid couples_find(ty_xpbd* x)
{
    float widest = 0.0f;
    for (int i = 0; i < x->body_count; i++)
        widest = ty_max(widest, x->bodies[i].radius);
    body_grid grid =
        body_grid_create(x->bodies, offsetof(soft, center), sizeof(soft), x->body_count, x->margin + 2.0f * widest);
    body_list near_ones = {0};
    for (int i = 0; i < x->body_count; i++)
    {
        body_grid_after(&grid, i, bodies_meet, x, &near_ones);
        for (int n = 0; n < near_ones.count; n++)
            bodies_near(x, i, near_ones.at[n]);
    }
    ty_free(near_ones.at);
    return grid;
}

static void walls_near(ty_xpbd* x)
{
    int walls = x->def.container ? ty_container_wall_count(x->def.container) : 0;
    ty_vec3 n;
    for (int i = 0; i < x->body_count; i++)
    {
        int first = x->near_count;
        for (int s = x->bodies[i].first; s < x->bodies[i].first + x->bodies[i].count; s++)
        {
            ty_vec3 p = x->particles[s].x;
            float reach = x->particles[s].radius + x->margin;
            for (int w = 0; w < walls; w++)
                if (xpbd_wall(x, w, p, &n) < reach)
                    near_push(x, s, w);
            if (x->lid - p.y < reach)
                near_push(x, s, XPBD_LID);
        }
        couple_push(x, i, XPBD_WALL, first);
    }
}

// Both lists ascend in (a, b): bridges are found again in one pass.
static void bridges_keep(ty_xpbd* x)
{
    int old = 0;
    for (int i = 0; i < x->wall_first; i++)
    {
        couple* c = &x->couples[i];
        while (old < x->old_couple_count && x->old_couples[old].b >= 0 &&
               (x->old_couples[old].a < c->a || (x->old_couples[old].a == c->a && x->old_couples[old].b < c->b)))
            old++;
        const couple* o = old < x->old_couple_count ? &x->old_couples[old] : NULL;
        c->wet = o && o->a == c->a && o->b == c->b && o->wet;
    }
}

#define SWAP(type, a, b)                                                                                               \
    do                                                                                                                 \
    {                                                                                                                  \
        type swapped = (a);                                                                                            \
        (a) = (b);                                                                                                     \
        (b) = swapped;                                                                                                 \
    } while (false)

void xpbd_detect(ty_xpbd* x)
{
    SWAP(couple*, x->couples, x->old_couples);
    SWAP(int, x->couple_capacity, x->old_couple_capacity);
    x->old_couple_count = x->couple_count;
    x->near_count = x->couple_count = 0;
    body_grid grid = couples_find(x);
    x->wall_first = x->couple_count;
    bridges_keep(x);
    walls_near(x);
    list_reserve((void**)&x->order, &x->order_capacity, x->couple_count, sizeof(int));
    pair_blocks_make(&x->blocks, &grid, x->couples, sizeof(couple), x->couple_count, x->order);
    body_grid_destroy(&grid);
    x->moved = 0.0f;
    x->stale = false;
}

// --- projection ---

typedef struct contact
{
    particle *a, *b; // b NULL = a wall
    ty_vec3 normal, moved;
    float gap, weight, compliance;
} contact;

// Hertz's law as a spring: its secant at a flattening of 2 % of the radius, for two bodies of the same modulus.
static float contact_compliance(const ty_xpbd* x, float r, float s)
{
    const float poisson = 0.4f;
    float modulus = x->def.modulus / (2.0f * (1.0f - poisson * poisson)), radius = r * s / (r + s);
    return 0.75f / (modulus * sqrtf(radius * 0.02f * radius));
}

// The overlap is undone at push_out at most. Returns the multiplier.
static float normal_solve(const ty_xpbd* x, contact* c)
{
    float h = 1.0f / x->def.rate, gamma = c->compliance > 0.0f ? x->def.damping * x->def.rate : 0.0f;
    float along = ty_dot(c->moved, c->normal), before = c->gap - along;
    float l = -(c->gap + gamma * along) / ((1.0f + gamma) * c->weight + c->compliance * ty_sqr(x->def.rate));
    if (before < 0.0f)
        l = ty_min(l, (ty_max(before + x->def.push_out * h, before) - c->gap) / c->weight);
    return ty_max(l, 0.0f);
}

// Cancels the slip since the substep began, as far as friction carries: mu lambda_n, where lambda_n bears the load and
// the pull of water.
static void contact_move(const ty_xpbd* x, contact* c, float l)
{
    ty_vec3 step = ty_mul(c->normal, l);
    ty_vec3 slip = ty_mad(c->moved, c->normal, -ty_dot(c->moved, c->normal));
    float length = ty_length(slip), budget = x->def.friction * l;
    if (length > 0.0f)
        step = ty_mad(step, slip, -ty_min(1.0f / c->weight, budget / length));
    particle_move(c->a, step, c->a->inverse_mass);
    if (c->b)
        particle_move(c->b, step, -c->b->inverse_mass);
}

static void near_solve(ty_xpbd* x, const near* n)
{
    particle *a = &x->particles[n->a], *b = &x->particles[n->b];
    ty_vec3 d = ty_sub(a->x, b->x);
    float reach = a->radius + b->radius, square = ty_length_sqr(d);
    contact c = {.a = a, .b = b, .weight = a->inverse_mass + b->inverse_mass};
    if (square >= reach * reach || c.weight <= 0.0f)
        return;
    float length = sqrtf(square);
    c.gap = length - reach;
    c.normal = length > 1e-9f ? ty_mul(d, 1.0f / length) : ty_vec3_make(0.0f, 1.0f, 0.0f);
    c.compliance = contact_compliance(x, a->radius, b->radius);
    c.moved = ty_sub(a->shift, b->shift);
    contact_move(x, &c, normal_solve(x, &c));
}

// Water and stickiness pull at the nearest balls of two bodies. A bridge forms at contact, and pulls until it breaks.
static void couple_pull(ty_xpbd* x, couple* c)
{
    const ty_bridge_def* def = &x->def.bridge;
    particle *a = NULL, *b = NULL;
    float gap = TY_FLOAT_MAX, h = 1.0f / x->def.rate;
    for (int k = c->first; k < c->first + c->count; k++)
    {
        particle *p = &x->particles[x->nears[k].a], *q = &x->particles[x->nears[k].b];
        float own = ty_length(ty_sub(p->x, q->x)) - p->radius - q->radius;
        a = own < gap ? p : a;
        b = own < gap ? q : b;
        gap = ty_min(gap, own);
    }
    float radius = ty_min(a->radius, b->radius), mean = 2.0f * a->radius * b->radius / (a->radius + b->radius);
    c->wet = def->tension > 0.0f && def->volume > 0.0f && (gap <= 0.0f || c->wet) && gap < ty_bridge_end(def, radius);
    float force = ty_adhesion_force(def, mean, gap) + (c->wet ? ty_bridge_pull(def, radius, mean, gap) : 0.0f);
    // A pull that carried a particle through most of the reach of stickiness at once would shake the pile apart.
    float lightest = ty_max(a->inverse_mass, b->inverse_mass);
    force = ty_min(force, lightest > 0.0f ? PULL_STEP / (h * h * lightest) : 0.0f);
    ty_vec3 n = ty_normalize(ty_sub(a->x, b->x));
    particle_move(a, n, -force * h * h * a->inverse_mass);
    particle_move(b, n, force * h * h * b->inverse_mass);
}

static void wall_solve(ty_xpbd* x, const near* n)
{
    particle* a = &x->particles[n->a];
    contact c = {.a = a, .weight = a->inverse_mass};
    c.gap = xpbd_wall(x, n->b, a->x, &c.normal) - a->radius;
    if (c.gap >= 0.0f || c.weight <= 0.0f)
        return;
    c.moved = a->shift;
    contact_move(x, &c, normal_solve(x, &c));
}

double xpbd_contacts_energy(const ty_xpbd* x)
{
    double sum = 0.0;
    for (int i = 0; i < x->wall_first; i++)
        for (int k = x->couples[i].first; k < x->couples[i].first + x->couples[i].count; k++)
        {
            const particle *a = &x->particles[x->nears[k].a], *b = &x->particles[x->nears[k].b];
            float overlap = ty_max(0.0f, a->radius + b->radius - ty_length(ty_sub(a->x, b->x)));
            sum += 0.5 * (double)(overlap * overlap / contact_compliance(x, a->radius, b->radius));
        }
    return sum;
}

static void block_solve(void* context, int begin, int end)
{
    ty_xpbd* x = context;
    for (int i = begin; i < end; i++)
    {
        couple* c = &x->couples[x->order[i]];
        if (c->b >= 0 && x->cohesive)
            couple_pull(x, c);
        for (int k = c->first; k < c->first + c->count; k++)
            if (c->b >= 0)
                near_solve(x, &x->nears[k]);
            else
                wall_solve(x, &x->nears[k]);
    }
}

void xpbd_contacts_solve(ty_xpbd* x, ty_workers* workers)
{
    pair_blocks_sweep(&x->blocks, workers, block_solve, x);
}
