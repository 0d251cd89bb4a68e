// SPDX-License-Identifier: Apache-2.0
// Oren-Nayar in Fujii's form with its multiple scattering.
#include "diffuse.h"

static const float mean_loss = 0.5f - 2.0f / (3.0f * TY_PI);          // of A
static const float mean_gain = 2.0f / 3.0f - 28.0f / (15.0f * TY_PI); // of the mean albedo

static float factor_a(float roughness)
{
    return 1.0f / (1.0f + mean_loss * roughness);
}

// Albedo of single scattering from mu; exact.
static float single_albedo(float roughness, float mu)
{
    float a = factor_a(roughness), sine = ty_safe_sqrt(1.0f - mu * mu);
    float g = sine * (ty_acos(mu) - sine * mu);
    // (s / mu)(1 - s^3) - s without the division: 1 - s^3 = (1 - s)(1 + s + s^2), 1 - s = mu^2 / (1 + s).
    g += (2.0f / 3.0f) * sine * (mu * (1.0f + sine + sine * sine) / (1.0f + sine) - 1.0f);
    return a * (1.0f + roughness * g * TY_INV_PI);
}

static float single_mean(float roughness)
{
    return factor_a(roughness) * (1.0f + mean_gain * roughness);
}

static float repeated(float color, float mean)
{
    return color * color * mean / (1.0f - color * (1.0f - mean));
}

ty_rgb ty_diffuse_value(ty_rgb color, float roughness, ty_vec3 wo, ty_vec3 wi)
{
    if (!(roughness > 0.0f))
        return ty_rgb_scale(color, TY_INV_PI);
    float s = wo.x * wi.x + wo.y * wi.y, mean = single_mean(roughness);
    float t = s > 0.0f ? s / ty_max(wo.z, wi.z) : s;
    float once = TY_INV_PI * factor_a(roughness) * (1.0f + roughness * t);
    float rest = (1.0f - single_albedo(roughness, wo.z)) * (1.0f - single_albedo(roughness, wi.z));
    rest *= TY_INV_PI / (1.0f - mean);
    return ty_rgb_make(color.r * once + repeated(color.r, mean) * rest, color.g * once + repeated(color.g, mean) * rest,
                       color.b * once + repeated(color.b, mean) * rest);
}

ty_rgb ty_diffuse_albedo(ty_rgb color, float roughness, float mu)
{
    if (!(roughness > 0.0f))
        return color;
    float once = single_albedo(roughness, mu), mean = single_mean(roughness), lost = 1.0f - once;
    return ty_rgb_make(color.r * once + repeated(color.r, mean) * lost, color.g * once + repeated(color.g, mean) * lost,
                       color.b * once + repeated(color.b, mean) * lost);
}

const ty_mu_node ty_mu_nodes[TY_MU_NODES] = {
    {0.00039422f, 0.00000158f, 0.28766790f}, {0.01033613f, 0.00046737f, 0.28448815f},
    {0.05627988f, 0.00837690f, 0.26945594f}, {0.16669475f, 0.04936748f, 0.23157006f},
    {0.35012939f, 0.15027993f, 0.16626145f}, {0.58181228f, 0.27843769f, 0.08785222f},
    {0.80700261f, 0.32243350f, 0.02715563f}, {0.96068408f, 0.19063554f, 0.00239003f},
};

// pi times what it reflects between two cosines, over all azimuths, less that of Lambert.
static float preference(float roughness, float mean, float mu, float lost, const ty_mu_node* node)
{
    float a = factor_a(roughness), sines = ty_safe_sqrt((1.0f - mu * mu) * (1.0f - node->mu * node->mu));
    float once = a * (1.0f + roughness * sines * TY_INV_PI * (1.0f / ty_max(mu, node->mu) - 1.0f));
    return once + lost * (1.0f - a * (1.0f + roughness * node->rough)) / (1.0f - mean) - 1.0f;
}

static float excess(float roughness, const float x[TY_MU_NODES], float mu, float lost)
{
    float mean = single_mean(roughness), sum = 0.0f, all = 0.0f;
    for (int i = 0; i < TY_MU_NODES; i++)
    {
        sum += x[i] * preference(roughness, mean, mu, lost, &ty_mu_nodes[i]);
        all += x[i];
    }
    return all > 0.0f ? sum / all : 0.0f;
}

float ty_diffuse_excess(float roughness, const float x[TY_MU_NODES], float mu)
{
    return excess(roughness, x, mu, 1.0f - single_albedo(roughness, mu));
}

float ty_diffuse_excess_mean(float roughness, const float x[TY_MU_NODES])
{
    float sum = 0.0f, all = 0.0f, a = factor_a(roughness);
    for (int i = 0; i < TY_MU_NODES; i++)
    {
        const ty_mu_node* node = &ty_mu_nodes[i];
        sum += x[i] * excess(roughness, x, node->mu, 1.0f - a * (1.0f + roughness * node->rough));
        all += x[i];
    }
    return all > 0.0f ? sum / all : 0.0f;
}
