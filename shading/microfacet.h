// SPDX-License-Identifier: Apache-2.0
// Isotropic GGX in the local frame (z = normal, wo.z > 0), sampled by visible normals.
#pragma once
#include <tsuya/base/math.h>

#define TY_SMOOTH_ROUGHNESS 0.02f // below this a lobe is a mirror

// alpha of a roughness; 0 = mirror.
float ty_ggx_alpha(float roughness);

float ty_ggx_d(ty_vec3 h, float alpha);
float ty_ggx_g1(ty_vec3 w, float alpha);
float ty_ggx_g2(ty_vec3 wo, ty_vec3 wi, float alpha); // height-correlated, both on one side

// A normal seen from wo (Heitz 2018, in the spherical-cap form of Dupuy & Benyoub 2023). Density G1(wo) (wo.h) D /
// wo.z.
ty_vec3 ty_ggx_sample(ty_vec3 wo, float alpha, ty_vec2 u);

// D G2 / (4 wo.z): f |cos| without Fresnel, for reflection to wi.z > 0. Sets the density of wi under ty_ggx_sample and
// cos_h = wo.h.
float ty_ggx_reflect(ty_vec3 wo, ty_vec3 wi, float alpha, float* pdf, float* cos_h);

// The same for refraction to wi.z < 0 (Walter et al. 2007, eq. 21, without the squared index of radiance).
float ty_ggx_refract(ty_vec3 wo, ty_vec3 wi, float alpha, float eta, float* pdf, float* cos_h);
