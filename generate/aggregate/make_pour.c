// SPDX-License-Identifier: Apache-2.0
// Elements that are poured: they fall out of a round mouth, one after the other at the rate given, onto what lies
// there.
#include "kit.h"
#include "start.h"
#include <tsuya/base/log.h>

enum
{
    POUR_EVERY = 8,  // substeps between two lots: each lot costs a search of all candidates
    POUR_TRIES = 24, // places that are tried for an element; if none is free it waits
};

#define OVER_RIM 0.06f // m, of the mouth where none is given

static float length_most(const kit* k)
{
    return 1.05f * k->mix.longest * (1.0f + 2.0f * k->mix.variation);
}

ty_status kit_pour_begin(kit* k, ty_error* error)
{
    const ty_pour_def* def = &k->recipe->fill.pour;
    ty_bounds inside = ty_container_interior(k->container);
    if (!ty_container_is_open(k->container))
        return ty_error_set(error, TY_BAD_INPUT, "fill.start: pour needs an open container");
    pour* p = &k->pour;
    p->bodies = TY_TRY_ALLOC(ty_body, k->count);
    if (!p->bodies)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %d grains", k->count);
    p->count = k->count;
    p->rate = def->seconds > 0.0f ? (float)k->count / def->seconds : def->rate;
    p->from = def->from;
    if (ty_length_sqr(p->from) == 0.0f)
    {
        p->from = ty_mul(ty_add(inside.low, inside.high), 0.5f);
        p->from.y = ty_max(inside.high.y, k->top.level + k->top.crown) + OVER_RIM;
    }
    if (p->from.y <= inside.low.y + length_most(k))
        return ty_error_set(error, TY_BAD_INPUT, "fill.pour.from: %.3g m high; it is above %.3g, the floor and a grain",
                            (double)p->from.y, (double)(inside.low.y + length_most(k)));
    for (int i = 0; i < k->count; i++)
        p->bodies[i] = kit_body(k, p->from, k->recipe->fill.tilt);
    return TY_OK;
}

static bool is_free(const kit* k, ty_vec3 at)
{
    const ty_body* bodies = ty_pile_bodies(k->pile);
    float apart = length_most(k);
    for (int i = ty_pile_count(k->pile) - 1; i >= 0; i--)
        if (ty_length_sqr(ty_sub(bodies[i].position, at)) < apart * apart)
            return false;
    return true;
}

// One element that left the mouth some seconds ago; false when no place is free.
static bool pour_one(kit* k, float seconds)
{
    const ty_pour_def* def = &k->recipe->fill.pour;
    pour* p = &k->pour;
    float fallen = seconds * (def->speed + 0.5f * 9.81f * seconds);
    for (int tries = 0; tries < POUR_TRIES; tries++)
    {
        float r = def->radius * sqrtf(ty_rng_float(&k->rng)), angle = ty_rng_range(&k->rng, 0.0f, 2.0f * TY_PI);
        ty_vec3 at = {p->from.x + r * ty_cos(angle), p->from.y - fallen, p->from.z + r * ty_sin(angle)};
        if (!is_free(k, at))
            continue;
        ty_body body = p->bodies[p->poured];
        body.position = at;
        body.velocity.y = -def->speed - 9.81f * seconds;
        ty_pile_add(k->pile, &body, 1);
        p->poured++;
        return true;
    }
    return false;
}

void kit_pour_due(kit* k)
{
    pour* p = &k->pour;
    if (p->poured < p->count && p->steps % POUR_EVERY == 0)
    {
        float now = (float)p->steps / k->recipe->settle.rate;
        float lot = (float)POUR_EVERY / k->recipe->settle.rate;
        while (p->poured < p->count && (float)p->poured <= now * p->rate)
        {
            float late = now - (float)p->poured / p->rate; // those that had to wait leave now
            if (!pour_one(k, late < lot ? late : 0.0f))
                break;
        }
    }
    p->steps++;
}

ty_status kit_pour(kit* k, ty_error* error)
{
    pour* p = &k->pour;
    double most = 4.0 * (double)p->count / (double)p->rate + 10.0; // s: a mouth may be too small for its rate
    while (p->poured < p->count && !ty_cancel_requested())
    {
        kit_pour_due(k);
        ty_pile_step(k->pile, k->workers);
        if ((double)p->steps > most * (double)k->recipe->settle.rate)
            return ty_error_set(
                error, TY_BAD_INPUT,
                "fill.pour: %d of %d grains found no way out in %.3g s: a wider radius, a higher source "
                "or a lower rate",
                p->count - p->poured, p->count, most);
    }
    ty_status status = kit_interrupted("pouring", error);
    if (status == TY_OK)
        ty_log(TY_LOG_INFO, "aggregate: %d grains poured in %.2f s", p->poured,
               (double)p->steps / (double)k->recipe->settle.rate);
    return status;
}
