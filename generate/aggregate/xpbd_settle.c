// SPDX-License-Identifier: Apache-2.0
// A fill that settles, or a settled pile that is pressed, as elastic bodies; poses and bends come back.
#include "kit.h"
#include <string.h>
#include <tsuya/base/log.h>

// Share of the press's depth at a share of its time: down, held, up again, and left alone; a mould stays where it is
// until it is taken off.
static float press_depth(const kit* k, float t)
{
    bool stays = recipe_is_mould(k->recipe);
    float s = ty_min(ty_clamp(t / 0.4f, 0.0f, 1.0f), stays ? 1.0f : ty_clamp((0.8f - t) / 0.3f, 0.0f, 1.0f));
    return ty_smoothstep(s);
}

static float top_of(const ty_xpbd* x, const kit* k)
{
    float top = ty_container_interior(k->container).low.y, reach = 0.5f * k->mix.thickness;
    for (int i = 0; i < ty_xpbd_particle_count(x); i++)
        top = ty_max(top, ty_xpbd_position(x, i).y + reach);
    return top;
}

// A closed container is squeezed, into an open one comes a flat lid, from the top of the pile.
static void press_place(ty_xpbd* x, const kit* k, float top, float t)
{
    const ty_press_def* press = &k->recipe->press;
    float depth = press->strain * press_depth(k, t), share = 1.0f - depth;
    ty_bounds inside = ty_container_interior(k->container);
    ty_vec3 middle = ty_mul(ty_add(inside.low, inside.high), 0.5f);
    if (ty_container_is_open(k->container))
        ty_xpbd_lid(x, t < 0.8f ? top - depth * (top - inside.low.y) : TY_FLOAT_MAX);
    else if (press->from == TY_PRESS_AROUND)
        ty_xpbd_squeeze(x, middle, ty_vec3_make(share, share, share));
    else
        ty_xpbd_squeeze(x, ty_vec3_make(middle.x, inside.low.y, middle.z), ty_vec3_make(1.0f, share, 1.0f));
}

ty_xpbd* kit_soft(kit* k)
{
    ty_xpbd_def def = ty_xpbd_def_default();
    def.rate = k->recipe->settle.rate;
    def.friction = k->recipe->settle.friction;
    def.modulus = k->mechanics.modulus;
    def.bridge = k->mechanics.bridge;
    def.container = k->container;
    if (recipe_is_mould(k->recipe) && k->recipe->press.from == TY_PRESS_AROUND)
        def.gravity = ty_vec3_make(0.0f, 0.0f, 0.0f); // a hand turns what it presses: nothing sinks in it
    ty_xpbd* x = ty_xpbd_create(&def);
    for (int i = 0; i < ty_pile_count(k->pile); i++)
    {
        const ty_body* body = &ty_pile_bodies(k->pile)[i];
        ty_xpbd_add_element(x, &k->mix.grains[body->grain], body);
    }
    k->press_top = top_of(x, k);
    return x;
}

int kit_press_steps(const kit* k)
{
    return (int)(k->recipe->press.seconds * k->recipe->settle.rate);
}

void kit_press_step(kit* k, ty_xpbd* x, int step)
{
    press_place(x, k, k->press_top, (float)(step + 1) / (float)kit_press_steps(k));
    ty_xpbd_step(x, k->workers);
}

void kit_soft_take(kit* k, const ty_xpbd* x, bool all)
{
    int count = ty_pile_count(k->pile), lost = 0;
    ty_body* bodies = TY_ALLOC(ty_body, count);
    ty_affine* bends = TY_ALLOC(ty_affine, count);
    bool* gone = TY_ALLOC(bool, count);
    for (int i = 0; i < count; i++)
    {
        ty_affine frame;
        ty_xpbd_frame(x, i, &bodies[i], &frame);
        ty_quat q = bodies[i].rotation, back = {-q.x, -q.y, -q.z, q.w};
        float size = 1.0f / bodies[i].scale;
        bends[i] = ty_affine_from_trs(ty_vec3_make(0.0f, 0.0f, 0.0f), back, ty_vec3_make(size, size, size));
        bends[i] = ty_affine_multiply(&bends[i], &frame);
        bodies[i].position = frame.t;
        gone[i] = !all && ty_container_is_open(k->container) && ty_container_lost(k->container, bodies[i].position);
        lost += gone[i];
    }
    ty_pile_set_bodies(k->pile, bodies);
    for (int i = 0; i < count; i++)
        ty_pile_bend(k->pile, i, &bends[i]);
    if (lost > 0)
        ty_pile_remove(k->pile, gone);
    k->lost += lost;
    k->count = ty_pile_count(k->pile);
    ty_free(bodies);
    ty_free(bends);
    ty_free(gone);
}

ty_status kit_soften(kit* k, ty_pile_metrics* metrics, ty_error* error)
{
    const ty_settle_def* settle = &k->recipe->settle;
    ty_xpbd* x = kit_soft(k);
    int steps = settle->solver == TY_SOLVER_XPBD ? (int)(settle->max_seconds * settle->rate) : 0;
    for (int i = 0; i < steps && !ty_cancel_requested(); i++)
        ty_xpbd_step(x, k->workers);
    steps = k->recipe->press.strain > 0.0f ? kit_press_steps(k) : 0;
    k->press_top = top_of(x, k);
    for (int i = 0; i < steps && !ty_cancel_requested(); i++)
        kit_press_step(k, x, i);
    kit_soft_take(k, x, false);
    ty_pile_measure(k->pile, metrics, NULL);
    ty_xpbd_speeds(x, &metrics->speed_rms, &metrics->speed_max);
    k->settled = *metrics;
    k->rest = ty_pile_speeds_are_calm(metrics->speed_rms, metrics->speed_max);
    ty_xpbd_destroy(x);
    return kit_interrupted("settling", error);
}
