// SPDX-License-Identifier: Apache-2.0
// What has been pressed or moulded comes to rest by itself: the mould goes, the bodies stay as they are bent.
#include "kit.h"
#include <tsuya/base/log.h>

enum
{
    ROUNDS = 12, // of settling and looking for what floats
};

#define STILL 0.08e-3f // m/s, rms: drifts by less than .05 % of the width in a second

bool recipe_is_mould(const ty_aggregate_recipe* r)
{
    return r->container.role == TY_CONTAINER_MOULD;
}

ty_status press_check(const ty_aggregate_recipe* r, ty_error* error)
{
    bool closes = r->container.kind == TY_CONTAINER_SPHERE || r->container.kind == TY_CONTAINER_DOME ||
                  r->container.kind == TY_CONTAINER_ONIGIRI || recipe_is_mould(r) ||
                  (r->container.kind == TY_CONTAINER_MESH && r->container.role == TY_CONTAINER_VOLUME);
    if (r->press.strain > 0.0f && r->press.from == TY_PRESS_AROUND && !closes)
        return ty_error_set(error, TY_BAD_INPUT,
                            "press.from: around needs a closed container; into an open one a lid comes from above");
    return TY_OK;
}

bool kit_stands(const kit* k)
{
    const ty_aggregate_recipe* r = k->recipe;
    bool elastic = r->settle.solver == TY_SOLVER_XPBD;
    return recipe_is_mould(r) || (elastic ? r->settle.rest : r->press.strain > 0.0f);
}

float kit_top(const kit* k)
{
    float top = 0.0f, low = ty_container_interior(k->container).low.y;
    for (int i = 0; i < ty_pile_count(k->pile); i++)
        top = ty_max(top, ty_pile_bodies(k->pile)[i].position.y - low);
    return top;
}

// The plane at the mould's lowest point takes its place.
ty_status kit_release(kit* k, ty_error* error)
{
    k->released = kit_top(k);
    if (!recipe_is_mould(k->recipe) || !k->recipe->press.release)
        return TY_OK;
    ty_bounds inside = ty_container_interior(k->container);
    ty_vec3 size = ty_sub(inside.high, inside.low);
    ty_container_def def = ty_container_def_default();
    def.kind = TY_CONTAINER_GROUND;
    def.ground = inside.low.y;
    def.shape.radius = ty_max(size.x, ty_max(size.y, size.z)); // bodies that roll six times as far are lost
    ty_status status = ty_container_create(&def, k->workers, &k->ground, error);
    if (status == TY_OK)
        ty_pile_set_container(k->pile, k->ground);
    return status;
}

// To rest, and on while it is calm but not still: what sticks gives way slowly.
static ty_pile_end stand_still(kit* k)
{
    ty_pile_end end = TY_PILE_REST;
    float speed = TY_FLOAT_MAX;
    for (int round = 0; end == TY_PILE_REST && speed > STILL && round < ROUNDS; round++)
    {
        end = TY_PILE_LOST;
        for (int lost = 0; end == TY_PILE_LOST && ty_pile_count(k->pile) > 0; k->lost += lost)
            end = ty_pile_settle(k->pile, k->recipe->settle.max_seconds, k->workers, &lost);
        float largest;
        ty_pile_speeds(k->pile, &speed, &largest);
    }
    return end;
}

static ty_status stand_settle(kit* k, ty_error* error)
{
    ty_pile_end end = stand_still(k);
    k->rest = end == TY_PILE_REST;
    k->count = ty_pile_count(k->pile);
    if (end == TY_PILE_CANCELED)
        return kit_interrupted("settling", error);
    if (k->count > 0)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "container: nothing stays where the mould was");
}

// Polishes a copy; whether nothing floats after that, else the unpolished pile goes on with that stirred: a grain that
// balances on another.
static bool stand_finish(kit* k, bool last, ty_pile_metrics* metrics)
{
    bool* held = TY_ALLOC(bool, ty_pile_count(k->pile));
    ty_body* rest = kit_polish(k, &k->settled, metrics, held);
    bool done = last || metrics->floating == 0 || !k->rest;
    if (done)
        kit_watch(k, rest);
    else
        kit_stir(k, rest, held);
    ty_free(rest);
    ty_free(held);
    return done;
}

ty_status kit_stand(kit* k, ty_pile_metrics* metrics, ty_error* error)
{
    double start = ty_time_now();
    ty_status status = kit_release(k, error);
    bool done = false;
    for (int round = 1; status == TY_OK && !done; round++)
    {
        status = stand_settle(k, error);
        done = status == TY_OK && stand_finish(k, round == ROUNDS, metrics);
    }
    k->stood = kit_top(k);
    if (status == TY_OK)
        ty_log(TY_LOG_INFO, "aggregate: stands by itself after %.1f s, top element %.1f mm high, %.1f before",
               ty_time_now() - start, (double)k->stood * 1e3, (double)k->released * 1e3);
    return status;
}
