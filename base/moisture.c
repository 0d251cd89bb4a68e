// SPDX-License-Identifier: Apache-2.0
// Soaking and cooking of rice: from minutes and degrees to a moisture state.
#include <tsuya/base/math.h>
#include <tsuya/base/moisture.h>

static const float raw_wet_basis = 0.145f;
static const float cooked_wet_basis = 0.62f;
static const float least_wet_basis = 0.05f;
static const float uptake_limit = 0.24f;

ty_moisture_def ty_moisture_def_default(void)
{
    return (ty_moisture_def){.wet_basis = cooked_wet_basis, .soak_minutes = 0, .soak_celsius = 10, .cooked = 1};
}

float ty_moisture_uptake(float minutes, float celsius)
{
    float tau = 17.0f * ty_pow(1.45f, (10.0f - celsius) / 10.0f);
    return uptake_limit * (1.0f - ty_exp(-ty_max(minutes, 0.0f) / tau));
}

float ty_moisture_wet_basis(float uptake)
{
    return ty_max((raw_wet_basis + uptake) / (1.0f + uptake), least_wet_basis);
}

float ty_moisture_uptake_of(float wet_basis)
{
    return (wet_basis - raw_wet_basis) / (1.0f - wet_basis);
}

ty_moisture ty_moisture_make(const ty_moisture_def* def)
{
    if (def->wet_basis >= 0.0f)
    {
        float wet = ty_clamp(def->wet_basis, least_wet_basis, 1.0f);
        float guess = ty_clamp((wet - 0.31f) / (0.45f - 0.31f), 0.0f, 1.0f);
        return (ty_moisture){wet, def->cooked < 0.0f ? guess : ty_min(def->cooked, 1.0f)};
    }
    // Below 60 degrees soaking alone gelatinises nothing.
    float cooked = ty_clamp(def->cooked, 0.0f, 1.0f);
    float uptake = ty_moisture_uptake(def->soak_minutes, def->soak_celsius);
    uptake = ty_lerp(uptake, ty_moisture_uptake_of(cooked_wet_basis), cooked);
    return (ty_moisture){ty_moisture_wet_basis(uptake), cooked};
}
