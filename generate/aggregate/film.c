// SPDX-License-Identifier: Apache-2.0
// The film of a pile as it is poured, pressed or settles: the same instances in every frame, each where it is by then.
#include "film.h"

#define WAITING 1e-3f // size of an element that has not been poured yet: too small to be seen

enum
{
    RESIZE_STEPS = 8, // substeps between two sizes of grains that grow
};

// --- one moment ---

static void bodies_place(film* f)
{
    const ty_pile* pile = f->k->pile;
    int count = ty_pile_count(pile);
    for (int i = 0; i < f->count; i++)
        if (i < count)
        {
            f->bodies[i] = ty_pile_bodies(pile)[i];
            f->frames[i] = ty_pile_frame(pile, i);
        }
        else
        {
            f->bodies[i] = f->k->pour.bodies[i];
            f->bodies[i].scale *= WAITING;
        }
}

// Speeds are those that one sees in the film.
static void velocities_haste(const film* f, ty_aggregate* shown)
{
    for (uint32_t i = 0; i < shown->instance_count && f->haste != 1.0f; i++)
    {
        shown->velocities[i] = ty_mul(shown->velocities[i], f->haste);
        shown->spins[i] = ty_mul(shown->spins[i], f->haste);
    }
}

// Grains that grow press into each other: what is shown is polished, and the pile goes on from what is not.
static void bodies_polish(film* f, ty_pile_metrics* metrics)
{
    ty_pile_metrics before;
    ty_body* moving = kit_polish(f->k, &before, metrics, NULL);
    bodies_place(f);
    for (int i = 0; i < f->count; i++)
    {
        f->bodies[i].velocity = moving[i].velocity;
        f->bodies[i].spin = moving[i].spin;
    }
    ty_pile_set_bodies(f->k->pile, moving);
    ty_free(moving);
}

static ty_status film_show(film* f, int frame, const ty_aggregate_sink* sink, ty_error* error)
{
    kit* k = f->k;
    ty_pile_metrics metrics;
    if (f->soft)
        kit_soft_take(k, f->soft, true);
    k->rest = f->calm >= TY_PILE_CALM_CHECKS;
    k->stood = kit_top(k);
    if (k->cooking)
    {
        bodies_polish(f, &metrics);
        film_rice_show(f);
    }
    else
    {
        ty_pile_measure(k->pile, &metrics, NULL);
        bodies_place(f);
    }
    if (f->soft)
        ty_xpbd_speeds(f->soft, &metrics.speed_rms, &metrics.speed_max);
    ty_aggregate shown = *f->first; // lends what does not change; its own transforms are moved along
    shown.recipe = shown.hash = NULL;
    shown.metrics = kit_metrics(k, &metrics);
    mixture_move(&k->mix, k->recipe->seed, f->bodies, ty_pile_is_bent(k->pile) ? f->frames : NULL, f->yolks,
                 (uint32_t)f->count, k->owners, &shown);
    velocities_haste(f, &shown);
    f->first->velocities = shown.velocities; // made by the first frame
    f->first->spins = shown.spins;
    for (uint32_t i = 0; i < shown.instance_count && f->poured; i++)
        f->poured[i] = ty_length(shown.transforms[i].x) > 10.0f * WAITING ? 1.0f : 0.0f;
    ty_status status = sink->put(sink->context, frame, &shown, error);
    ty_free(shown.metrics);
    ty_free(shown.recipe);
    ty_free(shown.hash);
    return status;
}

// --- what happens between two ---

static void yolks_step(film* f)
{
    kit* k = f->k;
    float gravity = ty_length(ty_pile_gravity(k->pile));
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

static void film_look(film* f)
{
    bool pouring = f->k->pour.poured < f->k->pour.count;
    f->calm = !f->soft && !pouring && ty_pile_is_calm(f->k->pile) ? f->calm + 1 : 0;
}

static ty_status film_step(film* f, ty_error* error)
{
    kit* k = f->k;
    ty_status status = TY_OK;
    if (f->soft)
    {
        kit_press_step(k, f->soft, (int)f->step);
        if (f->step + 1 == kit_press_steps(k))
        {
            kit_soft_take(k, f->soft, true);
            ty_xpbd_destroy(f->soft);
            f->soft = NULL;
            status = kit_release(k, error);
        }
    }
    else
    {
        if (k->pour.bodies)
            kit_pour_due(k);
        if (k->cooking && f->step % RESIZE_STEPS == 0)
            film_cook(f);
        ty_pile_step(k->pile, k->workers);
        yolks_step(f);
    }
    f->step++;
    if (f->step % (int)(TY_PILE_CHECK_TIME * k->recipe->settle.rate + 0.5f) == 0)
        film_look(f);
    return status;
}

// To a frame: by the clock, or for as long as rice grows.
static ty_status film_go(film* f, int frame, ty_error* error)
{
    const ty_animate_def* animate = &f->k->recipe->animate;
    double clock = (double)f->k->recipe->settle.rate / (double)animate->fps;
    int64_t count = (int64_t)((frame - 1) * clock + 0.5) - f->step;
    if (f->k->cooking)
        count = film_rice_steps(f, frame, (int64_t)(clock + 0.5));
    ty_status status = TY_OK;
    for (int64_t i = 1; i <= count && status == TY_OK && !ty_cancel_requested(); i++)
    {
        f->moment = (double)(frame - 2) + (double)i / (double)count;
        status = film_step(f, error);
    }
    f->haste = f->k->cooking ? (float)((double)count / clock) : 1.0f;
    return status;
}

static ty_status film_run(film* f, const ty_aggregate_sink* sink, ty_error* error)
{
    ty_status status = TY_OK;
    f->haste = 1.0f;
    for (int frame = 1; frame <= f->k->recipe->animate.frames && status == TY_OK; frame++)
    {
        if (frame > 1)
            status = film_go(f, frame, error);
        if (status == TY_OK)
            status = ty_cancel_requested() ? ty_error_set(error, TY_INTERRUPTED, "interrupted before frame %d", frame)
                                           : film_show(f, frame, sink, error);
    }
    return status;
}

// Those of eggs that have lain for long are up.
static void yolks_init(film* f)
{
    const ty_body* bodies = ty_pile_bodies(f->k->pile);
    for (int i = 0; i < f->k->below; i++)
    {
        if (!mixture_is_roe(&f->k->mix, bodies[i].grain))
            continue;
        const ty_element_def* def = &f->k->mix.kinds[f->k->mix.kind_of[bodies[i].grain]].def;
        for (int k = 0; k < 2000; k++)
            ty_roe_float(def, f->k->recipe->seed, &bodies[i], (uint32_t)i, (ty_vec3){0, 0, 0}, 9.81f, 0.005f,
                         &f->yolks[i]);
    }
}

// What is pressed lies already, but in a mould, where the press packs it; a mould that does not press is off at once.
static ty_status film_begin(film* f, ty_error* error)
{
    kit* k = f->k;
    const ty_press_def* press = &k->recipe->press;
    ty_status status = kit_pile(k, error);
    if (status == TY_OK)
        status = kit_fill(k, error);
    if (status == TY_OK)
        status = kit_layers(k, error); // the film shows how the last one falls
    if (status == TY_OK && k->cooking)
        status = kit_rest(k, error);
    if (status == TY_OK && kit_stands(k) && !(recipe_is_mould(k->recipe) && press->strain > 0.0f))
        status = kit_rest(k, error);
    ty_pile_metrics metrics = {0};
    if (status == TY_OK)
        status = kit_write(k, &metrics, &f->first, error);
    if (status != TY_OK)
        return status;
    f->count = k->pour.bodies ? k->pour.count : ty_pile_count(k->pile);
    f->bodies = TY_ALLOC(ty_body, f->count);
    f->frames = TY_ALLOC(ty_affine, f->count);
    f->yolks = TY_ALLOC(ty_yolk, f->count); // in the middle
    f->before = TY_ALLOC(ty_vec3, f->count);
    yolks_init(f);
    if (k->pour.bodies)
        f->poured = ty_aggregate_add_attribute(f->first, "poured");
    if (k->cooking)
        film_rice_init(f);
    if (press->strain > 0.0f)
        f->soft = kit_soft(k);
    else if (recipe_is_mould(k->recipe))
        return kit_release(k, error);
    return TY_OK;
}

static ty_status film_check(const ty_aggregate_recipe* r, ty_error* error)
{
    if (r->settle.solver == TY_SOLVER_XPBD)
        return ty_error_set(error, TY_BAD_INPUT,
                            "animate.frames: a film shows how rigid grains settle: take solver impulse");
    if (r->fill.start == TY_FILL_POUR && r->press.strain > 0.0f)
        return ty_error_set(error, TY_BAD_INPUT, "animate.frames: a film shows pouring or pressing, not both");
    if (r->layers.count > 0 && (r->fill.start == TY_FILL_POUR || r->press.strain > 0.0f || recipe_is_mould(r)))
        return ty_error_set(error, TY_BAD_INPUT,
                            "animate.frames: a film shows how the last of the layers falls, and no pouring or "
                            "pressing");
    if (cooking_is(&r->animate) && (r->fill.start == TY_FILL_POUR || r->press.strain > 0.0f || recipe_is_mould(r)))
        return ty_error_set(error, TY_BAD_INPUT,
                            "animate: a film shows cooking (soak, cook, stand) or pouring or pressing, not both");
    return TY_OK;
}

ty_status kit_film(kit* k, const ty_aggregate_sink* sink, ty_error* error)
{
    film f = {.k = k};
    ty_status status = film_check(k->recipe, error);
    if (status == TY_OK)
        status = film_begin(&f, error);
    if (status == TY_OK)
        status = film_run(&f, sink, error);
    ty_xpbd_destroy(f.soft);
    film_rice_term(&f);
    ty_free(f.bodies);
    ty_free(f.frames);
    ty_free(f.yolks);
    ty_free(f.before);
    ty_aggregate_destroy(f.first);
    return status;
}
