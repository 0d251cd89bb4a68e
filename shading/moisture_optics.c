// SPDX-License-Identifier: Apache-2.0
// From a moisture state to optics. The constants are ours, see docs: the paper gives the form and leaves them out.
#include <tsuya/shading/cdrf.h>

static const float raw_wet_basis = 0.145f, soaked_wet_basis = 0.31f, cooked_wet_basis = 0.62f;
static const float driest_wet_basis = 0.05f;
static const float dry_roughness = 0.45f, film_roughness = 0.17f, water_roughness = 0.08f;
static const float water_range = 0.18f; // of wet basis above saturation, until the surface is water all over

static float smoothstep(float low, float high, float x)
{
    return ty_smoothstep(ty_clamp((x - low) / (high - low), 0.0f, 1.0f));
}

ty_moisture_law ty_moisture_law_default(void)
{
    return (ty_moisture_law){
        .cooked_constant = 0.0736f,
        .cooked_exponent = 0.9f,
        .raw_length = 0.19e-3f,
        .soaked_length = 0.10e-3f,
        .sigma_constant = 0.34f,
        .sigma_exponent = 0.52f,
    };
}

ty_moisture_optics ty_moisture_optics_make(ty_moisture state)
{
    ty_moisture_law law = ty_moisture_law_default();
    return ty_moisture_law_at(&law, state);
}

// A film of water darkens and saturates: colour^exponent. The colour of a material is that
// of its cooked state, so that at the default moisture it is what the scene says. White stays white.
float ty_moisture_color(const ty_moisture_optics* optics, float color)
{
    float c = ty_clamp(color, 0.0f, 1.0f);
    return c < 1.0f && optics->color_exponent != 1.0f ? ty_pow(c, optics->color_exponent) : c;
}

ty_moisture_optics ty_moisture_law_at(const ty_moisture_law* law, ty_moisture state)
{
    float w = ty_clamp(state.wet_basis, driest_wet_basis, 1.0f), log_w = ty_ln(w);
    float cooked = ty_clamp(state.cooked, 0.0f, 1.0f);
    // A soaked raw grain turns whiter.
    float soaking = ty_clamp((w - raw_wet_basis) / (soaked_wet_basis - raw_wet_basis), 0.0f, 1.0f);
    float log_raw = ty_lerp(ty_ln(1e3f * law->raw_length), ty_ln(1e3f * law->soaked_length), soaking);
    float log_cooked = law->cooked_constant + law->cooked_exponent * log_w;
    // Water stays on the surface once the grain is near saturation: the film fills the roughness.
    float film = smoothstep(0.10f, cooked_wet_basis, w);
    // What the grain does not hold any more lies on it.
    float saturated = ty_lerp(soaked_wet_basis, cooked_wet_basis, cooked);
    float water = ty_clamp((w - saturated) / water_range, 0.0f, 1.0f);
    return (ty_moisture_optics){
        .mean_free_path = 1e-3f * ty_exp(ty_lerp(log_raw, log_cooked, cooked)),
        .gaussian_sigma = 1e-3f * ty_exp(law->sigma_constant + law->sigma_exponent * log_w),
        .film = film,
        .water = water,
        .roughness = ty_lerp(ty_lerp(dry_roughness, film_roughness, film), water_roughness, water),
        .color_exponent = 1.0f + 0.15f * (film - 1.0f) + 0.1f * water,
    };
}
