// SPDX-License-Identifier: Apache-2.0
// Makes an aggregate from its recipe: fill, settle, take away what is too much, polish until nothing floats, write
// down.
#include "kit.h"
#include "start.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>

enum
{
    ROUNDS = 12, // of settling and looking for grains that float
};

// --- bodies ---

static ty_quat rotation_draw(const ty_fill_def* fill, float steepest, ty_rng* rng)
{
    ty_quat heading = ty_quat_axis_angle(ty_vec3_make(0.0f, 1.0f, 0.0f), ty_rng_range(rng, 0.0f, 2.0f * TY_PI));
    float sine = ty_rng_range(rng, -1.0f, 1.0f) * ty_sin(steepest); // even over the sphere at a tilt of 90 degrees
    ty_quat tilt = ty_quat_axis_angle(ty_vec3_make(0.0f, 0.0f, 1.0f), 0.5f * TY_PI - ty_acos(sine));
    ty_quat roll = ty_quat_axis_angle(ty_vec3_make(1.0f, 0.0f, 0.0f), ty_rng_range(rng, -1.0f, 1.0f) * fill->roll);
    return ty_quat_multiply(heading, ty_quat_multiply(tilt, roll));
}

ty_body kit_body(kit* k, ty_vec3 position, float steepest)
{
    ty_body body = {.position = position, .rotation = rotation_draw(k->fill, steepest, &k->rng)};
    mixture_draw(&k->mix, &k->rng, &body);
    return body;
}

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

static ty_status container_check(const kit* k, ty_error* error)
{
    ty_bounds b = ty_container_interior(k->container);
    ty_vec3 size = ty_sub(b.high, b.low);
    float least = 2.0f * ty_container_widest(k->container), most = ty_max(size.x, ty_max(size.y, size.z));
    float width = k->mix.widest, length = k->mix.longest;
    if (least >= 1.5f * width && most >= 1.5f * length)
        return TY_OK;
    return ty_error_set(
        error, TY_BAD_INPUT,
        "container: its inside is %.3g x %.3g x %.3g mm; grains of %.3g x %.3g mm need at least %.3g by "
        "%.3g mm",
        (double)size.x * 1e3, (double)size.y * 1e3, (double)size.z * 1e3, (double)length * 1e3, (double)width * 1e3,
        (double)length * 1.5e3, (double)width * 1.5e3);
}

// --- adjust ---

ty_status kit_interrupted(const char* what, ty_error* error)
{
    return ty_cancel_requested() ? ty_error_set(error, TY_INTERRUPTED, "interrupted while %s", what) : TY_OK;
}

ty_status kit_rest(kit* k, ty_error* error)
{
    int allowed = 20 + k->count / 4;
    ty_pile_end end = TY_PILE_LOST;
    while (end == TY_PILE_LOST && k->lost <= allowed)
    {
        int lost;
        end = k->resumed ? ty_pile_settle_on(k->pile, k->recipe->settle.max_seconds, k->workers, &lost)
                         : ty_pile_settle(k->pile, k->recipe->settle.max_seconds, k->workers, &lost);
        k->resumed = false;
        k->rest = end == TY_PILE_REST;
        ty_status status = end == TY_PILE_LOST ? TY_OK : kit_keep(k, end != TY_PILE_REST, error);
        if (status != TY_OK)
            return status;
        k->lost += lost;
        k->replaced += lost;
        kit_refill(k);
    }
    if (end == TY_PILE_CANCELED)
        return kit_interrupted("settling", error);
    if (end == TY_PILE_LOST)
        return ty_error_set(error, TY_BAD_INPUT,
                            "fill.count: %d grains do not stay in the container: %d fell over its rim", k->count,
                            k->lost);
    return TY_OK;
}

void kit_stir(kit* k, ty_body* bodies, const bool* held)
{
    float speed = sqrtf(2.0f * 9.81f * k->mix.width);
    for (int i = 0; i < ty_pile_count(k->pile); i++)
    {
        ty_vec3 push;
        push.x = speed * ty_element_bell(&k->rng);
        push.y = speed * ty_element_bell(&k->rng);
        push.z = speed * ty_element_bell(&k->rng);
        if (!held[i])
            bodies[i].velocity = push;
    }
    ty_pile_set_bodies(k->pile, bodies);
}

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

// Chance and drying in one number: mean about 0, within -1..1, less at the surface.
static void attributes_write(const kit* k, uint32_t count, ty_aggregate* out)
{
    float* moisture = ty_aggregate_add_attribute(out, "moisture");
    float* tint = ty_aggregate_add_attribute(out, "tint");
    float* depth = ty_aggregate_add_attribute(out, "depth");
    float* wet_basis = k->mechanics.given ? ty_aggregate_add_attribute(out, "wet_basis") : NULL;
    for (uint32_t i = 0; i < count; i++)
        depth[i] = 1.05f * k->mix.length; // of those that are poured yet: as wet as the mean
    ty_pile_depth(k->pile, depth);
    const ty_wetness_def* wet = &k->recipe->moisture;
    for (uint32_t i = 0; i < count; i++)
    {
        ty_rng rng = ty_rng_make(k->recipe->seed, 0x6d6f6973, i);
        float exposed = ty_exp(-depth[i] / k->mix.length);
        float m = 0.45f * wet->variation * ty_element_bell(&rng) + wet->drying * (0.35f - exposed);
        moisture[i] = ty_clamp(m, -1.0f, 1.0f);
        tint[i] = ty_clamp(0.5f * ty_element_bell(&rng), -1.0f, 1.0f);
    }
    for (uint32_t i = count; i < out->instance_count; i++) // further bodies of the same elements
    {
        moisture[i] = moisture[k->owners[i]];
        tint[i] = tint[k->owners[i]];
        depth[i] = depth[k->owners[i]];
    }
    for (uint32_t i = 0; i < out->instance_count && wet_basis; i++)
        wet_basis[i] = ty_clamp(k->mechanics.state.wet_basis * (1.0f + KIT_WET_SPREAD * moisture[i]), 0.05f, 1.0f);
}

ty_status kit_write(kit* k, const ty_pile_metrics* metrics, ty_aggregate** out, ty_error* error)
{
    mixture_select(&k->mix, 0);                  // what is relative to a size is so to that of the lowest layer
    bool waits = k->pour.poured < k->pour.count; // a film of it begins: there are as many in all its files
    uint32_t count = (uint32_t)(waits ? k->pour.count : ty_pile_count(k->pile));
    const ty_body* bodies = waits ? k->pour.bodies : ty_pile_bodies(k->pile);
    ty_affine* frames = ty_pile_is_bent(k->pile) ? TY_TRY_ALLOC(ty_affine, count) : NULL;
    for (uint32_t i = 0; i < count && frames; i++)
        frames[i] = ty_pile_frame(k->pile, (int)i);
    ty_aggregate* a = NULL;
    if (frames || !ty_pile_is_bent(k->pile))
        a = mixture_write(&k->mix, k->recipe->seed, bodies, frames, count, &k->owners);
    ty_free(frames);
    if (!a)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %u grains", count);
    attributes_write(k, count, a);
    a->metrics = kit_metrics(k, metrics);
    a->state = k->state; // now the aggregate's
    k->state = (ty_bytes){0};
    *out = a;
    return TY_OK;
}

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

ty_status kit_pile(kit* k, ty_error* error)
{
    ty_status status = mixture_init(k->recipe, &k->mix, error);
    if (status == TY_OK)
        status = ty_container_create(&k->recipe->container, k->workers, &k->container, error);
    for (int layer = k->recipe->layers.count; layer >= 0 && status == TY_OK; layer--)
    {
        mixture_select(&k->mix, layer); // layer 0 in the end
        status = container_check(k, error);
    }
    if (status != TY_OK)
        return status;
    ty_pile_def def = ty_pile_def_default();
    def.friction = k->recipe->settle.friction;
    def.rolling = k->recipe->settle.rolling;
    def.rate = k->recipe->settle.rate;
    def.bridge = k->mechanics.bridge;
    def.grains = k->mix.grains;
    def.grain_count = k->mix.grain_count;
    def.container = k->container;
    k->pile = ty_pile_create(&def);
    return TY_OK;
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
