// SPDX-License-Identifier: Apache-2.0
// GGX: distribution, masking, visible-normal sampling, reflection and refraction densities.
#include "microfacet.h"

float ty_ggx_alpha(float roughness)
{
    return roughness < TY_SMOOTH_ROUGHNESS ? 0.0f : ty_sqr(ty_min(roughness, 1.0f));
}

ty_vec2 ty_ggx_alpha_stretched(float roughness, float anisotropy)
{
    float alpha = ty_ggx_alpha(roughness), across = 1.0f - ty_clamp(anisotropy, 0.0f, 1.0f);
    if (alpha == 0.0f || across == 1.0f)
        return ty_ggx_round(alpha);
    float along = alpha * sqrtf(2.0f / (1.0f + across * across));
    return (ty_vec2){along, ty_max(along * across, ty_sqr(TY_SMOOTH_ROUGHNESS))};
}

float ty_ggx_d(ty_vec3 h, ty_vec2 alpha)
{
    // sin^2 from x and y: 1 - cos^2 would lose all digits for small alpha.
    float a2 = alpha.x * alpha.y, x = h.x * alpha.y, y = h.y * alpha.x, s = x * x + y * y + ty_sqr(a2 * h.z);
    return h.z > 0.0f ? a2 * a2 * a2 / (TY_PI * s * s) : 0.0f;
}

// 1 + 2 Lambda = sqrt(1 + alpha^2 tan^2), times |cos|.
static float masked(ty_vec3 w, ty_vec2 alpha)
{
    return sqrtf(w.z * w.z + ty_sqr(alpha.x * w.x) + ty_sqr(alpha.y * w.y));
}

float ty_ggx_g1(ty_vec3 w, ty_vec2 alpha)
{
    float z = fabsf(w.z);
    return z > 0.0f ? 2.0f * z / (z + masked(w, alpha)) : 0.0f;
}

float ty_ggx_g2(ty_vec3 wo, ty_vec3 wi, ty_vec2 alpha)
{
    float o = fabsf(wo.z), i = fabsf(wi.z), sum = o * masked(wi, alpha) + i * masked(wo, alpha);
    return sum > 0.0f ? 2.0f * o * i / sum : 0.0f;
}

ty_vec3 ty_ggx_sample(ty_vec3 wo, ty_vec2 alpha, ty_vec2 u)
{
    ty_vec3 v = ty_normalize(ty_vec3_make(alpha.x * wo.x, alpha.y * wo.y, wo.z));
    float z = (1.0f - u.y) * (1.0f + v.z) - v.z, radius = ty_safe_sqrt(1.0f - z * z), sine, cosine;
    ty_sincos(2.0f * TY_PI * u.x, &sine, &cosine);
    ty_vec3 h = ty_vec3_make(radius * cosine + v.x, radius * sine + v.y, z + v.z);
    return ty_normalize(ty_vec3_make(alpha.x * h.x, alpha.y * h.y, ty_max(h.z, 1e-12f)));
}

float ty_ggx_reflect(ty_vec3 wo, ty_vec3 wi, ty_vec2 alpha, float* pdf, float* cos_h)
{
    ty_vec3 h = ty_normalize(ty_add(wo, wi));
    float d = ty_ggx_d(h, alpha) / (4.0f * wo.z);
    *cos_h = ty_dot(wo, h);
    *pdf = ty_ggx_g1(wo, alpha) * d;
    return ty_ggx_g2(wo, wi, alpha) * d;
}

float ty_ggx_refract(ty_vec3 wo, ty_vec3 wi, ty_vec2 alpha, float eta, float* pdf, float* cos_h)
{
    ty_vec3 h = ty_normalize(ty_mad(wo, wi, eta));
    h = h.z < 0.0f ? ty_neg(h) : h;
    float co = ty_dot(wo, h), ci = ty_dot(wi, h), denominator = ty_sqr(co + eta * ci);
    *pdf = 0.0f;
    *cos_h = co;
    if (co <= 0.0f || ci >= 0.0f || denominator <= 0.0f)
        return 0.0f;
    float visible = ty_ggx_g1(wo, alpha) * co * ty_ggx_d(h, alpha) / wo.z;
    *pdf = visible * eta * eta * -ci / denominator;
    // Separable masking: the far side of the surface is shadowed on its own.
    return *pdf * ty_ggx_g1(wi, alpha);
}
