// SPDX-License-Identifier: Apache-2.0
// GGX in the local frame (z = normal, wo.z > 0), sampled by visible normals. alpha: along the frame's t and b.
#pragma once
#include <tsuya/base/math.h>

#define TY_SMOOTH_ROUGHNESS 0.02f // below this a lobe is a mirror

// alpha of a roughness; 0 = mirror.
float ty_ggx_alpha(float roughness);
// The same stretched by an anisotropy of 0..1 (OpenPBR Surface 1.1, "Anisotropy"): longer along t, smaller along b.
ty_vec2 ty_ggx_alpha_stretched(float roughness, float anisotropy);

static inline ty_vec2 ty_ggx_round(float alpha)
{
    return (ty_vec2){alpha, alpha};
}

float ty_ggx_d(ty_vec3 h, ty_vec2 alpha);
float ty_ggx_g1(ty_vec3 w, ty_vec2 alpha);
float ty_ggx_g2(ty_vec3 wo, ty_vec3 wi, ty_vec2 alpha); // height-correlated, both on one side

// A normal seen from wo (Heitz 2018, in the spherical-cap form of Dupuy & Benyoub 2023). Density G1(wo) (wo.h) D /
// wo.z.
ty_vec3 ty_ggx_sample(ty_vec3 wo, ty_vec2 alpha, ty_vec2 u);

// D G2 / (4 wo.z): f |cos| without Fresnel, for reflection to wi.z > 0. Sets the density of wi under ty_ggx_sample and
// cos_h = wo.h.
float ty_ggx_reflect(ty_vec3 wo, ty_vec3 wi, ty_vec2 alpha, float* pdf, float* cos_h);

// The same for refraction to wi.z < 0 (Walter et al. 2007, eq. 21, without the squared index of radiance).
float ty_ggx_refract(ty_vec3 wo, ty_vec3 wi, ty_vec2 alpha, float eta, float* pdf, float* cos_h);
