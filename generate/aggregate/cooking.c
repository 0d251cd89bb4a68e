// SPDX-License-Identifier: Apache-2.0
// Rice in water, on the fire and off it: how wet and how cooked it is after so many minutes of a film.
#include "kit.h"

#define RAW 0.145f           // wet basis
#define DRYING_MINUTES 20.0f // in which rice that stands loses all but 1/e of what it can
#define DRYING_ALL 0.03f     // of the wet basis, anywhere
#define DRYING_SURFACE 0.12f // more at the surface of the heap

bool cooking_is(const ty_animate_def* animate)
{
    return animate->soak > 0.0f || animate->cook > 0.0f || animate->stand > 0.0f;
}

ty_status cooking_begin(ty_aggregate_recipe* recipe, cooking* out, ty_error* error)
{
    const ty_animate_def* a = &recipe->animate;
    ty_wetness_def* wet = &recipe->moisture;
    if (wet->wet_basis > 0.0f || wet->soak > 0.0f || wet->cooked >= 0.0f || wet->swelling > 0.0f)
        return ty_error_set(error, TY_BAD_INPUT,
                            "moisture: wet_basis, soak, cooked and swelling follow from animate.soak, cook and stand: "
                            "give one or the other");
    *out = (cooking){a->soak, a->cook, a->stand, wet->celsius, wet->drying};
    wet->wet_basis = RAW;
    wet->cooked = 0.0f;
    wet->drying = 0.0f; // it comes with standing
    return TY_OK;
}

// Smooth at both ends: water has to get hot, and in the end there is none left.
static float cooked_share(const cooking* c, float minute)
{
    if (c->cook <= 0.0f)
        return 0.0f;
    return ty_smoothstep(ty_clamp((minute - c->soak) / c->cook, 0.0f, 1.0f));
}

ty_moisture cooking_state(const cooking* c, float minute)
{
    ty_moisture_def def = {.wet_basis = -1.0f,
                           .soak_minutes = ty_clamp(minute, 0.0f, c->soak),
                           .soak_celsius = c->celsius,
                           .cooked = cooked_share(c, minute)};
    return ty_moisture_make(&def);
}

float cooking_pore_area(const cooking* c, float minute)
{
    // Warmer water is quicker, as in the law of uptake; the measured one had 10 degrees.
    float quicker = ty_pow(1.45f, (c->celsius - 10.0f) / 10.0f);
    return ty_rice_pores_after(60.0f * quicker * ty_clamp(minute, 0.0f, c->soak), 1e-3f).area;
}

float cooking_wet_basis(const cooking* c, float minute, float moisture, float exposed)
{
    float wet = cooking_state(c, minute).wet_basis * (1.0f + KIT_WET_SPREAD * moisture);
    float stood = ty_max(minute - c->soak - c->cook, 0.0f);
    float lost = c->drying * (DRYING_ALL + DRYING_SURFACE * exposed) * (1.0f - ty_exp(-stood / DRYING_MINUTES));
    return ty_clamp(wet - lost, 0.05f, 1.0f);
}
