// SPDX-License-Identifier: Apache-2.0
// Fuzz by a sheen of microfacets.
#include "fuzz.h"

// The curve of -Lambda's exponent for mu <= 1/2, between its fits for alpha 0 and 1 (Estevez & Kulla 2017, table 1).
static float shadow_curve(float x, float share)
{
    float a = ty_lerp(21.5473f, 25.3245f, share), b = ty_lerp(3.82987f, 3.32435f, share),
          c = ty_lerp(0.19823f, 0.16801f, share), d = ty_lerp(-1.97760f, -1.27393f, share),
          e = ty_lerp(-4.32054f, -4.85967f, share);
    return a / (1.0f + b * ty_pow(x, c)) + d * x + e;
}

static float shadow(float mu, float roughness)
{
    float share = ty_sqr(1.0f - roughness);
    if (mu < 0.5f)
        return ty_exp(shadow_curve(mu, share));
    return ty_exp(2.0f * shadow_curve(0.5f, share) - shadow_curve(1.0f - mu, share));
}

static float distribution(float sine, float roughness)
{
    float k = 1.0f / roughness;
    return (2.0f + k) * ty_pow(sine, k) * (0.5f * TY_INV_PI);
}

// Below this the fibres would stand so upright that nothing but grazing light meets them.
static float kept(float roughness)
{
    return ty_clamp(roughness, 0.07f, 1.0f);
}

float ty_fuzz_value(float roughness, ty_vec3 wo, ty_vec3 wi)
{
    roughness = kept(roughness);
    ty_vec3 h = ty_normalize(ty_add(wo, wi));
    float sine = sqrtf(ty_min(h.x * h.x + h.y * h.y, 1.0f));
    float g = 1.0f / (1.0f + shadow(wo.z, roughness) + shadow(wi.z, roughness));
    return distribution(sine, roughness) * g / (4.0f * wo.z * wi.z);
}

float ty_fuzz_albedo(float roughness, float mu)
{
    enum
    {
        RINGS = 48,
        SPOKES = 32 // of half a turn: it is symmetric
    };
    ty_vec3 wo = ty_vec3_make(ty_safe_sqrt(1.0f - mu * mu), 0.0f, mu);
    float sum = 0.0f;
    for (int j = 0; j < RINGS; j++)
        for (int i = 0; i < SPOKES; i++)
        {
            // In the root of the cosine: steep at grazing.
            float t = ((float)j + 0.5f) / RINGS, z = t * t, radius = ty_safe_sqrt(1.0f - z * z), sine, cosine;
            ty_sincos(TY_PI * ((float)i + 0.5f) / SPOKES, &sine, &cosine);
            sum += 2.0f * t * z * ty_fuzz_value(roughness, wo, ty_vec3_make(radius * cosine, radius * sine, z));
        }
    return ty_min(2.0f * TY_PI * sum / (RINGS * SPOKES), 1.0f);
}
