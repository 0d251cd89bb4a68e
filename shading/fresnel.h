// SPDX-License-Identifier: Apache-2.0
// Reflection and refraction at a smooth boundary.
#pragma once
#include <tsuya/base/math.h>

// Unpolarised reflectance of a dielectric boundary; eta = index beyond / index on the side of the ray. 1 = total.
static inline float ty_fresnel(float cosine, float eta)
{
    float c = ty_min(fabsf(cosine), 1.0f), sine_sqr = (1.0f - c * c) / (eta * eta);
    if (eta == 1.0f)
        return 0.0f;
    if (sine_sqr >= 1.0f || c <= 0.0f)
        return 1.0f;
    float ct = sqrtf(1.0f - sine_sqr);
    float s = (c - eta * ct) / (c + eta * ct), p = (eta * c - ct) / (eta * c + ct);
    return 0.5f * (s * s + p * p);
}

// Schlick 1994, from f0 at normal incidence to f90 at grazing.
static inline ty_rgb ty_fresnel_schlick(ty_rgb f0, ty_rgb f90, float cosine)
{
    float m = 1.0f - ty_clamp(cosine, 0.0f, 1.0f), m2 = m * m;
    return ty_rgb_lerp(f0, f90, m2 * m2 * m);
}

// w refracted through the facet h (both unit, on one side); false = total reflection.
static inline bool ty_refract(ty_vec3 w, ty_vec3 h, float eta, ty_vec3* out)
{
    float c = ty_dot(w, h), sine_sqr = (1.0f - c * c) / (eta * eta);
    if (sine_sqr >= 1.0f)
        return false;
    float ct = sqrtf(1.0f - sine_sqr);
    *out = ty_sub(ty_mul(h, c / eta - ct), ty_mul(w, 1.0f / eta));
    return true;
}
