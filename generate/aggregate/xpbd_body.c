// SPDX-License-Identifier: Apache-2.0
// What holds an elastic body together: stretch, bend, volume and shape matching, one projection each a substep.
#include "xpbd_state.h"

enum
{
    POLAR_ROUNDS = 4,
};

typedef struct matrix
{
    ty_vec3 x, y, z; // columns
} matrix;

static float mass_of(const particle* p)
{
    return p->inverse_mass > 0.0f ? 1.0f / p->inverse_mass : 0.0f;
}

// --- stretch and bend ---

// The multiplier of one constraint, from 0: Macklin 2016 eq. 26 with the damping as stiffness times a time, where
// gamma = compliance * (damping time / compliance) / h. moved is the constraint's change over the substep.
static float multiplier(const ty_xpbd* x, float value, float moved, float weight, float compliance)
{
    float h = 1.0f / x->def.rate, gamma = x->def.damping * x->def.rate;
    float below = (1.0f + gamma) * weight + compliance / (h * h);
    return below > 0.0f ? -(value + gamma * moved) / below : 0.0f;
}

static void stretch_solve(ty_xpbd* x, const ty_stretch* s, particle* p)
{
    particle *a = &p[s->a], *b = &p[s->b];
    ty_vec3 d = ty_sub(a->x, b->x);
    float length = ty_length(d);
    if (length < 1e-9f)
        return;
    ty_vec3 n = ty_mul(d, 1.0f / length), move = ty_sub(a->shift, b->shift);
    float l = multiplier(x, length - s->length, ty_dot(n, move), a->inverse_mass + b->inverse_mass, s->compliance);
    particle_move(a, n, l * a->inverse_mass);
    particle_move(b, n, -l * b->inverse_mass);
}

// The combination of the particles that a bend keeps, of positions or of what they moved.
static ty_vec3 bend_vector(const ty_bend* k, const particle* p, bool moved)
{
    ty_vec3 b = moved ? p[k->b].shift : p[k->b].x;
    ty_vec3 c = moved ? p[k->c].shift : p[k->c].x;
    if (k->a < 0)
        return ty_sub(c, b);
    ty_vec3 a = moved ? p[k->a].shift : p[k->a].x;
    return ty_sub(ty_mad(ty_mul(a, k->share), c, 1.0f - k->share), b);
}

static void bend_solve(ty_xpbd* x, const soft* body, const ty_bend* k, particle* p)
{
    float share = k->a < 0 ? 0.0f : k->share, w = p[k->b].inverse_mass + ty_sqr(1.0f - share) * p[k->c].inverse_mass;
    if (k->a >= 0)
        w += ty_sqr(share) * p[k->a].inverse_mass;
    ty_vec3 value = ty_sub(bend_vector(k, p, false), ty_quat_rotate(body->rotation, k->rest));
    ty_vec3 moved = bend_vector(k, p, true), l;
    l.x = multiplier(x, value.x, moved.x, w, k->compliance);
    l.y = multiplier(x, value.y, moved.y, w, k->compliance);
    l.z = multiplier(x, value.z, moved.z, w, k->compliance);
    particle_move(&p[k->b], l, -p[k->b].inverse_mass);
    particle_move(&p[k->c], l, (1.0f - share) * p[k->c].inverse_mass);
    if (k->a >= 0)
        particle_move(&p[k->a], l, share * p[k->a].inverse_mass);
}

// --- volume ---

static float volume_of(const ty_xpbd* x, const soft* body)
{
    const particle* p = x->particles + body->first;
    float sum = 0.0f;
    for (int i = 0; i < body->triangle_count; i++)
    {
        const int* t = x->triangles[body->triangle_first + i];
        ty_vec3 a = ty_sub(p[t[0]].x, p[0].x), b = ty_sub(p[t[1]].x, p[0].x), c = ty_sub(p[t[2]].x, p[0].x);
        sum += ty_dot(a, ty_cross(b, c)) / 6.0f;
    }
    return sum;
}

float ty_xpbd_volume(const ty_xpbd* x, int body)
{
    return volume_of(x, &x->bodies[body]);
}

// V - k V0 with the compliance V0 / K: the energy is K (V / V0 - k)^2 V0 / 2.
static void volume_solve(ty_xpbd* x, const soft* body)
{
    ty_vec3 gradient[TY_ELEMENT_MAX_BALLS] = {{0}};
    particle* p = x->particles + body->first;
    for (int i = 0; i < body->triangle_count; i++)
    {
        const int* t = x->triangles[body->triangle_first + i];
        for (int k = 0; k < 3; k++)
        {
            ty_vec3 b = ty_sub(p[t[(k + 1) % 3]].x, p[0].x), c = ty_sub(p[t[(k + 2) % 3]].x, p[0].x);
            gradient[t[k]] = ty_mad(gradient[t[k]], ty_cross(b, c), 1.0f / 6.0f);
        }
    }
    float weight = 0.0f, moved = 0.0f;
    for (int i = 0; i < body->count; i++)
    {
        weight += p[i].inverse_mass * ty_length_sqr(gradient[i]);
        moved += ty_dot(gradient[i], p[i].shift);
    }
    float l = multiplier(x, volume_of(x, body) - body->volume, moved, weight, body->volume / body->bulk);
    for (int i = 0; i < body->count; i++)
        particle_move(&p[i], gradient[i], l * p[i].inverse_mass);
}

// --- the whole ---

static ty_vec3 center_of(const ty_xpbd* x, const soft* body)
{
    const particle* p = x->particles + body->first;
    ty_vec3 from = p[0].x, sum = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < body->count; i++)
        sum = ty_mad(sum, ty_sub(p[i].x, from), mass_of(&p[i]));
    return ty_mad(from, sum, 1.0f / body->mass);
}

// The rotation that fits best, warm-started from the last: Müller et al. 2016, "A robust method to extract the
// rotational part of deformations".
static void rotation_fit(const ty_xpbd* x, soft* body, ty_vec3 center)
{
    const particle* p = x->particles + body->first;
    matrix a = {0};
    for (int i = 0; i < body->count; i++)
    {
        ty_vec3 q = ty_sub(x->rest[body->first + i], body->rest_center), r = ty_sub(p[i].x, center);
        r = ty_mul(r, mass_of(&p[i]));
        a.x = ty_mad(a.x, r, q.x), a.y = ty_mad(a.y, r, q.y), a.z = ty_mad(a.z, r, q.z);
    }
    float least = 1e-9f * (ty_length(a.x) + ty_length(a.y) + ty_length(a.z)) + 1e-30f;
    for (int i = 0; i < POLAR_ROUNDS; i++)
    {
        ty_vec3 u = ty_quat_rotate(body->rotation, ty_vec3_make(1.0f, 0.0f, 0.0f));
        ty_vec3 v = ty_quat_rotate(body->rotation, ty_vec3_make(0.0f, 1.0f, 0.0f)), w = ty_cross(u, v);
        ty_vec3 turn = ty_add(ty_add(ty_cross(u, a.x), ty_cross(v, a.y)), ty_cross(w, a.z));
        float below = fabsf(ty_dot(u, a.x) + ty_dot(v, a.y) + ty_dot(w, a.z)) + least;
        turn = ty_mul(turn, 1.0f / below);
        float angle = ty_length(turn);
        if (angle < 1e-7f)
            return;
        ty_quat q = ty_quat_axis_angle(ty_mul(turn, 1.0f / angle), angle);
        body->rotation = ty_quat_normalize(ty_quat_multiply(q, body->rotation));
    }
}

// x_b - (c + R q_b) with stiffness shared out by mass, so that neither momentum nor spin changes.
static void shape_solve(ty_xpbd* x, const soft* body, ty_vec3 center)
{
    particle* p = x->particles + body->first;
    float share = 1.0f / (1.0f + body->mass * ty_sqr(x->def.rate) / body->match);
    for (int i = 0; i < body->count; i++)
    {
        ty_vec3 q = ty_sub(x->rest[body->first + i], body->rest_center);
        ty_vec3 goal = ty_add(center, ty_quat_rotate(body->rotation, q));
        particle_move(&p[i], ty_sub(goal, p[i].x), share);
    }
}

// Inertia about center, a thousandth of its trace added, so that a straight row can be inverted; inverse times v.
static ty_vec3 inertia_solve(const ty_xpbd* x, const soft* body, ty_vec3 center, ty_vec3 v)
{
    const particle* p = x->particles + body->first;
    float xx = 0.0f, yy = 0.0f, zz = 0.0f, xy = 0.0f, xz = 0.0f, yz = 0.0f;
    for (int i = 0; i < body->count; i++)
    {
        ty_vec3 r = ty_sub(p[i].x, center);
        float m = mass_of(&p[i]);
        xx += m * (r.y * r.y + r.z * r.z), yy += m * (r.x * r.x + r.z * r.z), zz += m * (r.x * r.x + r.y * r.y);
        xy -= m * r.x * r.y, xz -= m * r.x * r.z, yz -= m * r.y * r.z;
    }
    float trace = xx + yy + zz;
    if (trace <= 0.0f)
        return ty_vec3_make(0.0f, 0.0f, 0.0f);
    float s = 1.0f / trace, e = 1e-3f;
    ty_affine i = {
        {xx * s + e, xy * s, xz * s}, {xy * s, yy * s + e, yz * s}, {xz * s, yz * s, zz * s + e}, {0.0f, 0.0f, 0.0f}};
    ty_affine inverse = ty_affine_identity();
    return ty_affine_invert(&i, &inverse) ? ty_mul(ty_map_vector(&inverse, v), s) : ty_vec3_make(0.0f, 0.0f, 0.0f);
}

// Spin of the body's motion over the substep about its centre.
static ty_vec3 turning(const ty_xpbd* x, const soft* body, ty_vec3 center)
{
    const particle* p = x->particles + body->first;
    ty_vec3 sum = {0.0f, 0.0f, 0.0f}, drift = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < body->count; i++)
        drift = ty_mad(drift, p[i].shift, mass_of(&p[i]) / body->mass);
    for (int i = 0; i < body->count; i++)
        sum = ty_mad(sum, ty_cross(ty_sub(p[i].x, center), ty_sub(p[i].shift, drift)), mass_of(&p[i]));
    return sum;
}

void xpbd_body_solve(ty_xpbd* x, soft* body)
{
    particle* p = x->particles + body->first;
    if (body->count < 2)
        return;
    ty_vec3 center = center_of(x, body), before = turning(x, body, center);
    if (!body->fixed)
        rotation_fit(x, body, center);
    for (int i = 0; i < body->stretch_count; i++)
        stretch_solve(x, &x->stretches[body->stretch_first + i], p);
    for (int i = 0; i < body->bend_count; i++)
        bend_solve(x, body, &x->bends[body->bend_first + i], p);
    if (body->triangle_count > 0)
        volume_solve(x, body);
    if (body->fixed)
        return;
    if (body->match > 0.0f)
        shape_solve(x, body, center_of(x, body));
    // Rest vectors that turn with the body, and damping, may leave a spin behind: it is taken out again.
    center = center_of(x, body);
    ty_vec3 extra = ty_sub(before, turning(x, body, center)), turn = inertia_solve(x, body, center, extra);
    for (int i = 0; i < body->count; i++)
        particle_move(&p[i], ty_cross(turn, ty_sub(p[i].x, center)), 1.0f);
}

void xpbd_body_measure(ty_xpbd* x, soft* body)
{
    const particle* p = x->particles + body->first;
    body->center = body->fixed ? p[0].x : center_of(x, body);
    body->radius = body->fastest = 0.0f;
    for (int i = 0; i < body->count; i++)
    {
        body->radius = ty_max(body->radius, ty_length(ty_sub(p[i].x, body->center)) + p[i].radius);
        body->fastest = ty_max(body->fastest, ty_length_sqr(p[i].v));
    }
    body->fastest = sqrtf(body->fastest);
}

double xpbd_body_energy(const ty_xpbd* x, const soft* body)
{
    const particle* p = x->particles + body->first;
    double sum = 0.0;
    for (int i = 0; i < body->stretch_count; i++)
    {
        const ty_stretch* s = &x->stretches[body->stretch_first + i];
        float c = ty_length(ty_sub(p[s->a].x, p[s->b].x)) - s->length;
        sum += 0.5 * (double)(c * c / s->compliance);
    }
    for (int i = 0; i < body->bend_count; i++)
    {
        const ty_bend* k = &x->bends[body->bend_first + i];
        ty_vec3 c = ty_sub(bend_vector(k, p, false), ty_quat_rotate(body->rotation, k->rest));
        sum += 0.5 * (double)(ty_length_sqr(c) / k->compliance);
    }
    if (body->triangle_count > 0)
        sum += 0.5 * (double)(ty_sqr(volume_of(x, body) - body->volume) * body->bulk / body->volume);
    for (int i = 0; i < body->count && body->match > 0.0f; i++)
    {
        ty_vec3 q = ty_sub(x->rest[body->first + i], body->rest_center);
        ty_vec3 d = ty_sub(p[i].x, ty_add(body->center, ty_quat_rotate(body->rotation, q)));
        sum += 0.5 * (double)(body->match * mass_of(&p[i]) / body->mass * ty_length_sqr(d));
    }
    return sum;
}
