// SPDX-License-Identifier: Apache-2.0
// The film of a pile as it settles: the same instances in every frame, each where it is by then.
#include "kit.h"

typedef struct film
{
    kit* k;
    ty_aggregate* first; // the fill before it moves: prototypes, ids and attributes of every frame
    ty_yolk* yolks;      // [count]
    ty_vec3* before;     // [count] velocities a substep ago
} film;

static ty_status film_show(film* f, int frame, const ty_aggregate_sink* sink, ty_error* error)
{
    kit* k = f->k;
    ty_pile_metrics metrics;
    ty_pile_measure(k->pile, &metrics, NULL);
    ty_aggregate shown = *f->first; // lends what does not change; its own transforms are moved along
    shown.recipe = shown.hash = NULL;
    shown.metrics = kit_metrics(k, &metrics);
    mixture_move(&k->mix, k->recipe->seed, ty_pile_bodies(k->pile), f->yolks, (uint32_t)ty_pile_count(k->pile), &shown);
    f->first->velocities = shown.velocities; // made by the first frame
    f->first->spins = shown.spins;
    ty_status status = sink->put(sink->context, frame, &shown, error);
    ty_free(shown.metrics);
    ty_free(shown.recipe);
    ty_free(shown.hash);
    return status;
}

// One substep of the pile, and of the yolks within the eggs.
static void film_step(film* f)
{
    kit* k = f->k;
    float gravity = ty_length(ty_pile_gravity(k->pile));
    ty_pile_step(k->pile, k->workers);
    const ty_body* bodies = ty_pile_bodies(k->pile);
    float seconds = 1.0f / k->recipe->settle.rate;
    for (int i = 0; i < ty_pile_count(k->pile); i++)
    {
        const ty_body* b = &bodies[i];
        if (!mixture_is_roe(&k->mix, b->grain))
            continue;
        const ty_element_def* def = &k->mix.kinds[k->mix.kind_of[b->grain]].def;
        ty_roe_float(def, k->recipe->seed, b, (uint32_t)i, ty_sub(b->velocity, f->before[i]), gravity, seconds,
                     &f->yolks[i]);
        f->before[i] = b->velocity;
    }
}

static ty_status film_run(film* f, const ty_aggregate_sink* sink, ty_error* error)
{
    const ty_animate_def* animate = &f->k->recipe->animate;
    double rate = (double)f->k->recipe->settle.rate / (double)animate->fps;
    int64_t step = 0;
    ty_status status = TY_OK;
    for (int frame = 1; frame <= animate->frames && status == TY_OK; frame++)
    {
        for (int64_t until = (int64_t)((frame - 1) * rate + 0.5); step < until && !ty_cancel_requested(); step++)
            film_step(f);
        status = ty_cancel_requested() ? ty_error_set(error, TY_INTERRUPTED, "interrupted before frame %d", frame)
                                       : film_show(f, frame, sink, error);
    }
    return status;
}

ty_status kit_film(kit* k, const ty_aggregate_sink* sink, ty_error* error)
{
    if (k->recipe->settle.solver == TY_SOLVER_XPBD || k->recipe->press.strain > 0.0f)
        return ty_error_set(error, TY_BAD_INPUT,
                            "animate.frames: a film shows how rigid grains settle: take solver impulse and no press");
    ty_status status = kit_pile(k, error);
    if (status == TY_OK)
        status = kit_fill(k, error);
    film f = {.k = k};
    ty_pile_metrics metrics = {0};
    if (status == TY_OK)
        status = kit_write(k, &metrics, &f.first, error);
    if (status == TY_OK)
    {
        f.yolks = TY_ALLOC(ty_yolk, ty_pile_count(k->pile)); // in the middle
        f.before = TY_ALLOC(ty_vec3, ty_pile_count(k->pile));
        status = film_run(&f, sink, error);
    }
    ty_free(f.yolks);
    ty_free(f.before);
    ty_aggregate_destroy(f.first);
    return status;
}
