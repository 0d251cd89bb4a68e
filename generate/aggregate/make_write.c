// SPDX-License-Identifier: Apache-2.0
// A pile written down as an aggregate, with what the renderer wants to know of each element.
#include "kit.h"

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
