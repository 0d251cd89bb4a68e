// SPDX-License-Identifier: Apache-2.0
// Makes an aggregate from its recipe: fill, settle, take away what is too much, polish until nothing floats.
#include "kit.h"
#include "start.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>

enum
{
    ROUNDS = 12, // of settling and looking for grains that float
};

// --- checks ---

static ty_status fill_check(const ty_fill_def* fill, const char* place, ty_error* error)
{
    if (fill->count < 1 || fill->count > TY_FILL_MOST)
        return ty_error_set(error, TY_BAD_INPUT, "%sfill.count: %d; it lies in 1..%d", place, fill->count,
                            TY_FILL_MOST);
    if (!(fill->density >= 0.1f && fill->density <= 0.95f))
        return ty_error_set(error, TY_BAD_INPUT, "%sfill.density: %g; it lies in 0.1..0.95", place,
                            (double)fill->density);
    return TY_OK;
}

static ty_status recipe_check(const ty_aggregate_recipe* r, ty_error* error)
{
    ty_status status = fill_check(&r->fill, "", error);
    for (int i = 0; i < r->layers.count && status == TY_OK; i++)
    {
        char place[32];
        (void)snprintf(place, sizeof place, "layers[%d].", i);
        status = fill_check(&((const ty_layer_def*)r->layers.items)[i].fill, place, error);
    }
    if (status == TY_OK)
        status = press_check(r, error);
    if (status == TY_OK)
        status = ty_mechanics_check(r, error);
    return status == TY_OK ? layers_check(r, error) : status;
}

// --- until nothing floats ---

// Takes out what floats in a vessel that one can drop new grains into.
static void floating_replace(kit* k, bool* held)
{
    int count = ty_pile_count(k->pile);
    for (int i = 0; i < count; i++)
        held[i] = !held[i];
    ty_pile_remove(k->pile, held);
    k->replaced += count - ty_pile_count(k->pile);
    kit_refill(k);
}

// Goes on from moving, with new elements for those not held, or with these stirred.
static void pile_mend(kit* k, ty_body* moving, bool* held)
{
    ty_pile_set_bodies(k->pile, moving);
    if (ty_container_is_open(k->container))
        floating_replace(k, held);
    else
        kit_stir(k, moving, held);
}

// Such piles creep for long: they end by time.
static bool is_slippery(const kit* k)
{
    return k->recipe->settle.friction < 0.05f;
}

// Polishes a copy; where a grain floats after that, the unpolished pile settles on with that grain replaced or stirred.
static ty_status pile_finish(kit* k, ty_pile_metrics* metrics, ty_error* error)
{
    bool *held = TY_ALLOC(bool, k->count), last = false;
    ty_status status = TY_OK;
    for (; status == TY_OK; k->round++)
    {
        status = kit_rest(k, error);
        if (status != TY_OK)
            break;
        ty_body* moving = kit_polish(k, &k->settled, metrics, held);
        ty_log(TY_LOG_DEBUG,
               "aggregate: %d float after %d substeps, overlap %.2f %% before polishing and %.2f %% after",
               metrics->floating, metrics->substeps, (double)k->settled.overlap_max * 100.0,
               (double)metrics->overlap_max * 100.0);
        last = metrics->floating == 0 || k->round == ROUNDS - 1 || (!k->rest && !is_slippery(k));
        if (last)
            kit_watch(k, moving);
        status = kit_interrupted("polishing", error); // which then is not complete
        if (!last && status == TY_OK)
            pile_mend(k, moving, held);
        ty_free(moving);
        if (last)
            break;
    }
    ty_free(held);
    return status;
}

// --- the result ---

// Leaves out what lies in the cut, now that nothing moves any more.
static ty_status pile_cut(kit* k, ty_error* error)
{
    const ty_cut_def* cut = &k->recipe->container.cut;
    if (cut->kind == TY_CUT_NONE)
        return TY_OK;
    int count = ty_pile_count(k->pile), taken = 0;
    bool* gone = TY_ALLOC(bool, count);
    for (int i = 0; i < count; i++)
    {
        gone[i] = ty_cut_takes(cut, ty_pile_bodies(k->pile)[i].position);
        taken += gone[i];
    }
    ty_pile_remove(k->pile, gone);
    ty_free(gone);
    if (taken < count)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "container.cut: it takes all %d elements away", count);
}

// Interrupted: the pile as it stands, if its state is kept, so that one can go on.
static ty_status kit_stop(kit* k, ty_aggregate** out, ty_error* error)
{
    ty_pile_metrics metrics;
    ty_error ignored;
    if (!k->state.data)
        return TY_INTERRUPTED;
    ty_pile_measure(k->pile, &metrics, NULL);
    ty_status status = kit_write(k, &metrics, out, &ignored);
    return status == TY_OK ? ty_error_set(error, TY_INTERRUPTED, "interrupted while settling; pack --resume goes on")
                           : TY_INTERRUPTED;
}

static ty_status kit_make(kit* k, const ty_bytes* state, ty_aggregate** out, ty_error* error)
{
    double start = ty_time_now();
    ty_status status = kit_pile(k, error);
    if (status != TY_OK)
        return status;
    double prepared = ty_time_now();
    status = state ? kit_resume(k, state->data, state->size, error) : kit_fill(k, error);
    if (status == TY_OK)
        status = kit_interrupted("filling", error); // an inflation ends early
    if (status == TY_OK && !state)
        status = kit_keep(k, false, error);
    double filled = ty_time_now();
    ty_pile_metrics metrics = {0};
    bool elastic = k->recipe->settle.solver == TY_SOLVER_XPBD;
    if (status == TY_OK)
        status = kit_layers(k, error);
    if (status == TY_OK && !elastic)
    {
        bool moulded = recipe_is_mould(k->recipe) && k->recipe->press.strain > 0.0f; // the press packs what is filled
        if (!kit_stands(k))
            status = pile_finish(k, &metrics, error);
        else if (!moulded)
            status = kit_rest(k, error);
    }
    if (status == TY_OK && (elastic || k->recipe->press.strain > 0.0f))
        status = kit_soften(k, &metrics, error);
    if (status == TY_OK && kit_stands(k))
        status = kit_stand(k, &metrics, error);
    if (status == TY_OK)
        status = kit_interrupted("settling", error); // polishing ends early
    if (status == TY_INTERRUPTED)
        return kit_stop(k, out, error);
    if (status == TY_OK)
        status = pile_cut(k, error);
    if (status == TY_OK)
        status = kit_write(k, &metrics, out, error);
    if (status != TY_OK)
        return status;
    ty_log(TY_LOG_INFO,
           "aggregate: %d grains, prepared %.1f s, filled %.1f s, settled and polished %.1f s; %d lost, %d replaced",
           metrics.count, prepared - start, filled - prepared, ty_time_now() - filled, k->lost, k->replaced);
    ty_log(TY_LOG_INFO, "aggregate: phi %.3f, %.1f contacts, %d float, overlap %.3f %% of the width at most",
           (double)metrics.phi, (double)k->settled.contacts, metrics.floating, (double)metrics.overlap_max * 100.0);
    if (k->recipe->settle.max_seconds <= 0.0f) // nobody asked for rest
        return TY_OK;
    if ((!k->rest && !is_slippery(k)) || metrics.floating > 0)
        return ty_error_set(error, TY_NOT_AT_REST, "the pile is not at rest: %.3g mm/s, %d grains float",
                            (double)metrics.speed_rms * 1e3, metrics.floating);
    return TY_OK;
}

// --- from a recipe ---

static ty_status recipe_make(const void* def, const ty_bytes* state, ty_workers* workers, ty_aggregate** out,
                             const ty_aggregate_sink* sink, ty_error* error)
{
    ty_aggregate_recipe recipe = *(const ty_aggregate_recipe*)def;
    ty_status status = recipe_check(&recipe, error);
    if (status != TY_OK)
        return status;
    cooking way;
    bool cooks = sink && cooking_is(&recipe.animate);
    if (cooks)
        status = cooking_begin(&recipe, &way, error);
    if (status != TY_OK)
        return status;
    kit* k = TY_ALLOC(kit, 1);
    k->cooking = cooks ? &way : NULL;
    k->recipe = &recipe;
    k->fill = &recipe.fill;
    k->mechanics = ty_mechanics_of(&recipe);
    k->workers = workers;
    k->rng = ty_rng_make(recipe.seed, 0x626f6479, 0);
    status = sink ? kit_film(k, sink, error) : kit_make(k, state, out, error);
    ty_bytes_term(&k->state);
    ty_free(k->pour.bodies);
    ty_free(k->owners);
    ty_pile_destroy(k->pile);
    ty_container_destroy(k->container);
    ty_container_destroy(k->ground);
    mixture_term(&k->mix);
    ty_free(k);
    return status;
}

ty_status ty_aggregate_make(const void* def, ty_workers* workers, ty_aggregate** out, ty_error* error)
{
    *out = NULL;
    return recipe_make(def, NULL, workers, out, NULL, error);
}

ty_status ty_aggregate_resume(const void* def, const void* state, size_t size, ty_workers* workers, ty_aggregate** out,
                              ty_error* error)
{
    const ty_bytes bytes = {(uint8_t*)state, size}; // read only
    *out = NULL;
    return recipe_make(def, &bytes, workers, out, NULL, error);
}

ty_status ty_aggregate_film(const void* def, ty_workers* workers, const ty_aggregate_sink* sink, ty_error* error)
{
    if (((const ty_aggregate_recipe*)def)->animate.frames < 1)
        return ty_error_set(error, TY_BAD_INPUT, "animate.frames is 0: say how many frames the film has");
    return recipe_make(def, NULL, workers, NULL, sink, error);
}

// --- the generator ---

static ty_status make(const void* def, ty_workers* workers, ty_made* out, ty_error* error)
{
    if (out->film.put)
        return ty_aggregate_film(def, workers, &out->film, error);
    if (out->state)
        return ty_aggregate_resume(def, out->state->data, out->state->size, workers, &out->aggregate, error);
    return ty_aggregate_make(def, workers, &out->aggregate, error);
}

static ty_status element(const void* def, int number, ty_mesh** out, ty_error* error)
{
    mixture m;
    *out = NULL;
    ty_status status = mixture_init(def, &m, error);
    if (status != TY_OK)
        return status;
    if (number < 1 || number > m.grain_count)
        status =
            ty_error_set(error, TY_BAD_INPUT, "there is no element %d: the recipe has 1..%d", number, m.grain_count);
    else
    {
        *out = m.grains[number - 1].mesh;
        m.grains[number - 1].mesh = NULL;
    }
    mixture_term(&m);
    return status;
}

const ty_generator ty_aggregate_generator = {
    .kind = "aggregate",
    .build_id = AGGREGATE_BUILD_ID,
    .product = TY_PRODUCT_AGGREGATE,
    .params = &ty_aggregate_recipe_table,
    .make = make,
    .element = element,
};
