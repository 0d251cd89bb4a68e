// SPDX-License-Identifier: Apache-2.0
// What moisture does to grains: how stiff they are, what holds them together, how large they are. Each follows from one
// state unless the recipe says otherwise.
#include <tsuya/base/math.h>
#include <tsuya/generate/aggregate_recipe.h>

#define RAW 0.145f          // wet basis
#define COOKED 0.62f        // sizes of rice are those of cooked grains
#define DRY_DENSITY 1.45f   // of the matter without water, against water
#define STARCH 1.0f         // J/m^2, work of adhesion of cooked grains at its best: viscous losses, not surface energy
#define DRY_MODULUS 3e5f    // Pa, where no state is given
#define RAW_MODULUS 1e8f    // Pa
#define COOKED_MODULUS 3e5f // Pa

// A state is given by any of the three.
static bool is_given(const ty_wetness_def* def)
{
    return def->wet_basis > 0.0f || def->soak > 0.0f || def->cooked >= 0.0f;
}

// Volume of a grain of unit dry mass.
static float volume_of(float wet_basis)
{
    float wet = ty_min(wet_basis, 0.9f); // a gruel beyond that
    return 1.0f / DRY_DENSITY + wet / (1.0f - wet);
}

// Raw grains lose four fifths of their stiffness up to saturation, cooked ones two thirds with each .14 of water.
// Grains that were soaked are softer when cooked (Tomita et al. 2015), by .6 when it was long.
static float modulus_of(ty_moisture state, float soaked)
{
    float raw = RAW_MODULUS * ty_exp(-1.609f * (state.wet_basis - RAW) / 0.165f);
    float cooked = COOKED_MODULUS * ty_exp(-1.099f * (state.wet_basis - COOKED) / 0.14f - 0.5f * soaked);
    float modulus = ty_exp((1.0f - state.cooked) * ty_ln(ty_max(raw, 1.0f)) + state.cooked * ty_ln(cooked));
    return ty_clamp(modulus, 1e4f, RAW_MODULUS);
}

float ty_moisture_swelling(float wet_basis)
{
    return ty_pow(volume_of(wet_basis) / volume_of(COOKED), 1.0f / 3.0f);
}

ty_bridge_def ty_bridge_of_state(ty_moisture state)
{
    ty_bridge_def bridge = ty_bridge_of_moisture(state.wet_basis);
    bridge.adhesion = STARCH * state.cooked * ty_bridge_strength(state.wet_basis);
    return bridge;
}

ty_mechanics ty_mechanics_of(const ty_aggregate_recipe* recipe)
{
    const ty_wetness_def* wet = &recipe->moisture;
    const ty_settle_def* settle = &recipe->settle;
    ty_mechanics m = {
        .given = is_given(wet), .bridge = ty_bridge_def_default(), .modulus = DRY_MODULUS, .swelling = 1.0f};
    if (m.given)
    {
        ty_moisture_def def = {.wet_basis = wet->wet_basis > 0.0f ? wet->wet_basis : -1.0f,
                               .soak_minutes = wet->soak,
                               .soak_celsius = wet->celsius,
                               .cooked = wet->cooked};
        m.state = ty_moisture_make(&def);
        m.bridge = ty_bridge_of_state(m.state);
        // The limit of the uptake, of an endless soak.
        m.modulus = modulus_of(m.state, ty_moisture_uptake(wet->soak, wet->celsius) / ty_moisture_uptake(1e9f, 60.0f));
        m.swelling = ty_moisture_swelling(m.state.wet_basis);
    }
    if (settle->cohesion >= 0.0f)
    {
        float adhesion = m.bridge.adhesion;
        m.bridge = ty_bridge_of_moisture(0.5f); // bridges of full size
        m.bridge.tension = settle->cohesion;
        m.bridge.adhesion = adhesion;
    }
    if (settle->adhesion >= 0.0f)
        m.bridge.adhesion = settle->adhesion;
    if (settle->modulus > 0.0f)
        m.modulus = settle->modulus;
    if (wet->swelling > 0.0f)
        m.swelling = wet->swelling;
    return m;
}

ty_status ty_mechanics_check(const ty_aggregate_recipe* recipe, ty_error* error)
{
    const ty_wetness_def* wet = &recipe->moisture;
    if (wet->wet_basis != 0.0f && !(wet->wet_basis >= 0.05f && wet->wet_basis <= 1.0f))
        return ty_error_set(error, TY_BAD_INPUT,
                            "moisture.wet_basis: %g; it lies in 0.05..1, or is 0 and follows soak and cooked",
                            (double)wet->wet_basis);
    if (wet->swelling != 0.0f && !(wet->swelling >= 0.5f && wet->swelling <= 2.0f))
        return ty_error_set(error, TY_BAD_INPUT,
                            "moisture.swelling: %g; it lies in 0.5..2, or is 0 and follows the state",
                            (double)wet->swelling);
    if (recipe->settle.modulus != 0.0f && !(recipe->settle.modulus >= 1e3f && recipe->settle.modulus <= 1e8f))
        return ty_error_set(error, TY_BAD_INPUT,
                            "settle.modulus: %g; it lies in 1e3..1e8, or is 0 and follows the state",
                            (double)recipe->settle.modulus);
    return TY_OK;
}
