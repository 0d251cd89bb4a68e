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

// Mean reflectance of a boundary to a denser medium (fit of Kulla & Conty 2017).
static inline float ty_fresnel_average(float n)
{
    return n > 1.0f ? (n - 1.0f) / (4.08567f + 1.00071f * n) : 0.0f;
}

// The index by which a boundary reflects: `weight` times as much at normal incidence as that of eta, where coat, the
// index of what covers it, is 1 (OpenPBR Surface 1.1, "Specular" and "Coat"). Neither can become total for that.
static inline float ty_shine(float eta, float weight, float coat)
{
    float n = ty_max(eta, 1.0f / eta) / coat;
    float r = fabsf((n - 1.0f) / (n + 1.0f)) * sqrtf(weight), shine = (1.0f + r) / (1.0f - r);
    return eta < 1.0f ? 1.0f / shine : shine;
}

// A boundary that bends like eta (index beyond over that on the ray's side) and reflects like shine (the same of the
// weighted index). Both sides reflect alike at directions that refract into one another, so that it is reciprocal; what
// eta reflects totally stays.
static inline float ty_fresnel_weighted(float cosine, float eta, float shine)
{
    float c = ty_min(fabsf(cosine), 1.0f);
    if (eta == shine || !(eta < 1.0f))
        return ty_fresnel(c, shine);
    float sine_sqr = (1.0f - c * c) / (eta * eta);
    return sine_sqr < 1.0f ? ty_fresnel(sqrtf(1.0f - sine_sqr), 1.0f / shine) : 1.0f;
}

// From f0 at normal incidence to 1 at grazing, with f82 of that at 82 degrees, where Schlick's form is made to bend
// (Hoffman 2023, "Generalization of Adobe's Fresnel model"; cos 82 deg is about 1/7).
// dip: what f82 takes of it.
static inline ty_rgb ty_metal_dip(ty_rgb f0, ty_rgb f82)
{
    const float m = 6.0f / 7.0f, m5 = m * m * m * m * m, scale = 7.0f / (m5 * m);
    ty_rgb schlick = ty_rgb_lerp(f0, ty_rgb_grey(1.0f), m5);
    return ty_rgb_make(schlick.r * (1.0f - f82.r) * scale, schlick.g * (1.0f - f82.g) * scale,
                       schlick.b * (1.0f - f82.b) * scale);
}

static inline ty_rgb ty_metal_fresnel(ty_rgb f0, ty_rgb dip, float cosine)
{
    float c = ty_clamp(cosine, 0.0f, 1.0f), m = 1.0f - c, m2 = m * m, m5 = m2 * m2 * m, k = c * m5 * m;
    ty_rgb f = ty_rgb_lerp(f0, ty_rgb_grey(1.0f), m5);
    return ty_rgb_make(ty_max(f.r - k * dip.r, 0.0f), ty_max(f.g - k * dip.g, 0.0f), ty_max(f.b - k * dip.b, 0.0f));
}

// Its mean over the cosine-weighted hemisphere.
static inline ty_rgb ty_metal_average(ty_rgb f0, ty_rgb dip)
{
    ty_rgb f = ty_rgb_lerp(f0, ty_rgb_grey(1.0f), 1.0f / 21.0f);
    return ty_rgb_add(f, ty_rgb_scale(dip, -1.0f / 126.0f));
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
