// SPDX-License-Identifier: Apache-2.0
// Layers of an aggregate: each falls onto what lies at rest below, and what is lost of one comes again.
#include "kit.h"
#include <stdio.h>
#include <tsuya/base/log.h>

ty_status layers_check(const ty_aggregate_recipe* r, ty_error* error)
{
    if (r->layers.count == 0)
        return TY_OK;
    if (r->settle.solver == TY_SOLVER_XPBD)
        return ty_error_set(error, TY_BAD_INPUT, "layers: they settle as rigid elements; take solver impulse");
    return TY_OK;
}

// Selects the layer and lets it fall onto the pile.
static ty_status layer_fall(kit* k, int layer, ty_error* error)
{
    char place[32];
    (void)snprintf(place, sizeof place, "layers[%d].", layer - 1);
    if (!ty_container_is_open(k->container))
        return ty_error_set(error, TY_BAD_INPUT, "%sfill: it falls from above; the container has no opening", place);
    kit_layer_select(k, layer);
    float inset = kit_inset(k);
    int count;
    ty_status status = kit_count(k, place, inset, &count, error);
    if (status != TY_OK)
        return status;
    double volume = (double)count * (double)k->mix.volume / (double)k->fill->density, capacity;
    status = ty_fill_plan(k->container, k->spread + volume, k->fill->heap, inset, &k->top, &capacity, error);
    if (status != TY_OK)
    {
        int most = (int)((capacity - k->spread) / volume * (double)count);
        return ty_error_set(error, status,
                            "%sfill.count: %d elements at a density of %g; the container holds at most %d over what "
                            "lies below",
                            place, count, (double)k->fill->density, most > 0 ? most : 0);
    }
    ty_log(TY_LOG_INFO, "aggregate: layer %d, %d elements onto %d", layer, count, k->count);
    k->spread += volume;
    k->wanted[layer] = count;
    k->below = ty_pile_count(k->pile);
    k->count += count;
    kit_drop(k, count);
    return TY_OK;
}

ty_status kit_layers(kit* k, ty_error* error)
{
    ty_status status = TY_OK;
    for (int layer = k->layer + 1; layer <= k->recipe->layers.count && status == TY_OK; layer++)
    {
        status = kit_rest(k, error);
        if (status == TY_OK)
            status = layer_fall(k, layer, error);
    }
    return status;
}

void kit_refill(kit* k)
{
    int missing[MIXTURE_KINDS];
    for (int layer = 0; layer <= k->layer; layer++)
        missing[layer] = k->wanted[layer];
    for (int i = 0; i < ty_pile_count(k->pile); i++)
        missing[k->mix.kinds[k->mix.kind_of[ty_pile_bodies(k->pile)[i].grain]].layer]--;
    for (int layer = 0; layer <= k->layer; layer++) // ends with the one that is selected
    {
        mixture_select(&k->mix, layer);
        kit_drop(k, missing[layer]);
    }
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
