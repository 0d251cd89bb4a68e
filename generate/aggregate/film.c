// SPDX-License-Identifier: Apache-2.0
// The film of a pile as it settles: the same instances in every frame, each where it is by then.
#include "kit.h"

static ty_affine body_transform(const ty_body* b)
{
    return ty_affine_from_trs(b->position, b->rotation, ty_vec3_make(b->scale, b->scale, b->scale));
}

static ty_status film_show(kit* k, int frame, const ty_aggregate* first, const ty_aggregate_sink* sink, ty_error* error)
{
    ty_pile_metrics metrics;
    ty_pile_measure(k->pile, &metrics, NULL);
    ty_aggregate shown = *first; // lends its prototypes, ids and attributes
    shown.recipe = shown.hash = NULL;
    shown.metrics = kit_metrics(k, &metrics);
    uint32_t count = (uint32_t)ty_pile_count(k->pile);
    const ty_body* bodies = ty_pile_bodies(k->pile);
    shown.transforms = TY_ALLOC(ty_affine, count);
    shown.velocities = TY_ALLOC(ty_vec3, count);
    shown.spins = TY_ALLOC(ty_vec3, count);
    for (uint32_t i = 0; i < count; i++)
    {
        shown.transforms[i] = body_transform(&bodies[i]);
        shown.velocities[i] = bodies[i].velocity;
        shown.spins[i] = bodies[i].spin;
    }
    ty_status status = sink->put(sink->context, frame, &shown, error);
    ty_free(shown.transforms);
    ty_free(shown.velocities);
    ty_free(shown.spins);
    ty_free(shown.metrics);
    ty_free(shown.recipe);
    ty_free(shown.hash);
    return status;
}

ty_status kit_film(kit* k, const ty_aggregate_sink* sink, ty_error* error)
{
    const ty_animate_def* animate = &k->recipe->animate;
    if (mixture_holds_roe(k->recipe))
        return ty_error_set(error, TY_BAD_INPUT, "animate.frames: eggs of fish have no film; take other elements");
    if (k->recipe->settle.solver == TY_SOLVER_XPBD || k->recipe->press.strain > 0.0f)
        return ty_error_set(error, TY_BAD_INPUT,
                            "animate.frames: a film shows how rigid grains settle: take solver impulse and no press");
    ty_status status = kit_pile(k, error);
    if (status == TY_OK)
        status = kit_fill(k, error);
    ty_aggregate* first = NULL;
    ty_pile_metrics metrics = {0};
    if (status == TY_OK)
        status = kit_write(k, &metrics, &first, error);
    double rate = (double)k->recipe->settle.rate / (double)animate->fps;
    int64_t step = 0;
    for (int frame = 1; frame <= animate->frames && status == TY_OK; frame++)
    {
        for (int64_t until = (int64_t)((frame - 1) * rate + 0.5); step < until && !ty_cancel_requested(); step++)
            ty_pile_step(k->pile, k->workers);
        status = ty_cancel_requested() ? ty_error_set(error, TY_INTERRUPTED, "interrupted before frame %d", frame)
                                       : film_show(k, frame, first, sink, error);
    }
    ty_aggregate_destroy(first);
    return status;
}
