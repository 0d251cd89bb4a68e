// SPDX-License-Identifier: Apache-2.0
// From the balls of an element to an elastic body, and from its particles back to the frame that its mesh is seen in.
#include "xpbd_state.h"

typedef struct wiring
{
    ty_stretch stretches[4 * TY_ELEMENT_MAX_BALLS];
    ty_bend bends[4 * TY_ELEMENT_MAX_BALLS];
    float masses[TY_ELEMENT_MAX_BALLS];
    int stretch_count, bend_count;
} wiring;

// Relative neighbours (Toussaint 1980): no third ball is nearer to both than they are to each other.
static bool are_neighbours(const ty_element* e, int i, int j)
{
    float d = ty_length_sqr(ty_sub(e->balls[i].center, e->balls[j].center));
    for (int k = 0; k < e->ball_count; k++)
        if (k != i && k != j &&
            ty_max(ty_length_sqr(ty_sub(e->balls[i].center, e->balls[k].center)),
                   ty_length_sqr(ty_sub(e->balls[j].center, e->balls[k].center))) < d)
            return false;
    return d > 0.0f;
}

static void stretches_make(const ty_element* e, float modulus, wiring* w)
{
    for (int i = 0; i < e->ball_count; i++)
        for (int j = i + 1; j < e->ball_count; j++)
        {
            if (w->stretch_count == 4 * TY_ELEMENT_MAX_BALLS || !are_neighbours(e, i, j))
                continue;
            float l = ty_length(ty_sub(e->balls[i].center, e->balls[j].center));
            float r = 0.5f * (e->balls[i].radius + e->balls[j].radius);
            w->stretches[w->stretch_count++] = (ty_stretch){i, j, l, l / (modulus * TY_PI * r * r)};
        }
}

// The middle of two joined stretches that make nearly a straight line bends as a beam of the balls' section.
static void bend_make(const ty_element* e, float modulus, int a, int b, int c, wiring* w)
{
    ty_vec3 p = ty_sub(e->balls[a].center, e->balls[b].center), q = ty_sub(e->balls[c].center, e->balls[b].center);
    float lp = ty_length(p), lq = ty_length(q), l = 0.5f * (lp + lq), r = e->balls[b].radius;
    if (ty_dot(p, q) > -0.87f * lp * lq || w->bend_count == 4 * TY_ELEMENT_MAX_BALLS)
        return;
    ty_bend* k = &w->bends[w->bend_count++];
    float share = lq / (lp + lq);
    *k = (ty_bend){.a = a, .b = b, .c = c, .share = share, .rest = ty_mad(ty_mul(p, share), q, 1.0f - share)};
    k->compliance = l * l * l / (modulus * TY_PI * r * r * r * r); // l^3 / (4 E I), I = pi r^4 / 4
}

static void bends_make(const ty_element* e, float modulus, wiring* w)
{
    for (int s = 0; s < w->stretch_count; s++)
        for (int t = s + 1; t < w->stretch_count; t++)
        {
            ty_stretch u = w->stretches[s], v = w->stretches[t];
            if (u.a == v.a || u.a == v.b)
                bend_make(e, modulus, u.b, u.a, u.a == v.a ? v.b : v.a, w);
            else if (u.b == v.a || u.b == v.b)
                bend_make(e, modulus, u.a, u.b, u.b == v.a ? v.b : v.a, w);
        }
}

int ty_xpbd_add_element(ty_xpbd* x, const ty_element* element, const ty_body* body)
{
    wiring* w = TY_ALLOC(wiring, 1);
    float sum = 0.0f;
    for (int i = 0; i < element->ball_count; i++)
        sum += ty_sqr(element->balls[i].radius) * element->balls[i].radius;
    for (int i = 0; i < element->ball_count; i++)
        w->masses[i] =
            x->def.density * element->volume * ty_sqr(element->balls[i].radius) * element->balls[i].radius / sum;
    stretches_make(element, x->def.modulus, w);
    bends_make(element, x->def.modulus, w);
    ty_soft_body made = {.balls = element->balls,
                         .masses = w->masses,
                         .ball_count = element->ball_count,
                         .stretches = w->stretches,
                         .stretch_count = w->stretch_count,
                         .bends = w->bends,
                         .bend_count = w->bend_count,
                         .match = x->def.modulus * element->width};
    int number = ty_xpbd_add(x, &made, body->position, body->rotation, body->scale, body->velocity);
    x->bodies[number].grain = body->grain;
    ty_free(w);
    return number;
}

// A = (sum m x q^T + R J) (sum m q q^T + J)^-1 with J the balls' own second moment, m r^2 / 5: balls in a row or a
// plane leave the other directions as they were.
static ty_affine bent(const ty_xpbd* x, const soft* body)
{
    const particle* p = x->particles + body->first;
    ty_affine moment = {0}, rest = moment, inverse = ty_affine_identity(), out;
    float own = 0.0f;
    for (int i = 0; i < body->count; i++)
    {
        float m = p[i].inverse_mass > 0.0f ? 1.0f / p[i].inverse_mass : 0.0f;
        ty_vec3 q = ty_sub(x->rest[body->first + i], body->rest_center), r = ty_mul(ty_sub(p[i].x, body->center), m);
        moment.x = ty_mad(moment.x, r, q.x), moment.y = ty_mad(moment.y, r, q.y), moment.z = ty_mad(moment.z, r, q.z);
        rest.x = ty_mad(rest.x, q, m * q.x), rest.y = ty_mad(rest.y, q, m * q.y), rest.z = ty_mad(rest.z, q, m * q.z);
        own += m * p[i].radius * p[i].radius / 5.0f;
    }
    ty_affine r = ty_affine_from_trs(ty_vec3_make(0.0f, 0.0f, 0.0f), body->rotation, ty_vec3_make(1.0f, 1.0f, 1.0f));
    if (own <= 0.0f)
        return r;
    float s = 1.0f / own;
    moment.x = ty_mad(r.x, moment.x, s), moment.y = ty_mad(r.y, moment.y, s), moment.z = ty_mad(r.z, moment.z, s);
    rest.x = ty_mul(rest.x, s), rest.y = ty_mul(rest.y, s), rest.z = ty_mul(rest.z, s);
    rest.x.x += 1.0f, rest.y.y += 1.0f, rest.z.z += 1.0f;
    if (!ty_affine_invert(&rest, &inverse))
        return r;
    out.x = ty_map_vector(&moment, inverse.x);
    out.y = ty_map_vector(&moment, inverse.y);
    out.z = ty_map_vector(&moment, inverse.z);
    out.t = ty_vec3_make(0.0f, 0.0f, 0.0f);
    return out;
}

void ty_xpbd_frame(const ty_xpbd* x, int number, ty_body* rigid, ty_affine* frame)
{
    const soft* body = &x->bodies[number];
    ty_vec3 offset = ty_quat_rotate(body->rotation, body->rest_center);
    *rigid = (ty_body){.position = ty_sub(body->center, offset),
                       .rotation = body->rotation,
                       .scale = body->scale,
                       .grain = body->grain};
    const particle* p = x->particles + body->first;
    for (int i = 0; i < body->count && body->mass > 0.0f; i++)
        if (p[i].inverse_mass > 0.0f)
            rigid->velocity = ty_mad(rigid->velocity, p[i].v, 1.0f / (p[i].inverse_mass * body->mass));
    *frame = bent(x, body);
    ty_vec3 moved = ty_map_vector(frame, body->rest_center);
    frame->x = ty_mul(frame->x, body->scale);
    frame->y = ty_mul(frame->y, body->scale);
    frame->z = ty_mul(frame->z, body->scale);
    frame->t = ty_sub(body->center, moved);
}
