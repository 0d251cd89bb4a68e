// SPDX-License-Identifier: Apache-2.0
// The steps of light through scattering matter: free flights by all channels together, the phase function, albedos.
#include <tsuya/shading/sampling.h>
#include <tsuya/shading/walk.h>

float ty_walk_albedo(float color, float g)
{
    float a = ty_clamp(color, 0.0f, 1.0f);
    float s = ty_max(0.0f, 4.09712f + 4.20863f * a - sqrtf(9.59217f + 41.6808f * a + 17.7126f * a * a));
    return a < 1.0f ? (1.0f - s * s) / (1.0f - g * s * s) : 1.0f;
}

float ty_walk_color(float albedo, float g)
{
    float a = ty_clamp(albedo, 0.0f, 1.0f), s = sqrtf((1.0f - a) / (1.0f - g * a));
    return (1.0f - s) * (1.0f - 0.139f * s) / (1.0f + 1.17f * s);
}

float ty_phase_cosine(float g, float u)
{
    if (fabsf(g) < 1e-3f)
        return 1.0f - 2.0f * u;
    float s = (1.0f - g * g) / (1.0f + g - 2.0f * g * u);
    return ty_clamp((1.0f + g * g - s * s) / (2.0f * g), -1.0f, 1.0f);
}

float ty_phase_pdf(float g, float cosine)
{
    float d = 1.0f + g * g - 2.0f * g * cosine;
    return (1.0f - g * g) / (4.0f * TY_PI * d * sqrtf(d));
}

ty_vec3 ty_phase_sample(float g, ty_vec3 direction, ty_vec2 u)
{
    if (g == 0.0f)
        return ty_sample_sphere(u);
    float sine, cosine, c = ty_phase_cosine(g, u.x), s = ty_safe_sqrt(1.0f - c * c);
    ty_sincos(2.0f * TY_PI * u.y, &sine, &cosine);
    return ty_normalize(ty_to_world(ty_frame_from_normal(direction), ty_vec3_make(s * cosine, s * sine, c)));
}

static bool is_grey(const ty_scattering* m)
{
    return m->extinction.r == m->extinction.g && m->extinction.g == m->extinction.b;
}

// Shares with which channels decide about the next flight: they do not sum up to more than 1.
static ty_rgb channel_shares(const ty_rgb* beta)
{
    return ty_rgb_scale(*beta, 1.0f / (beta->r + beta->g + beta->b));
}

float ty_flight_sample(const ty_scattering* m, const ty_rgb* beta, float u_channel, float u)
{
    float extinction = m->extinction.r;
    if (!is_grey(m))
    {
        ty_rgb share = channel_shares(beta);
        if (u_channel >= share.r)
            extinction = u_channel < share.r + share.g || share.b == 0.0f ? m->extinction.g : m->extinction.b;
    }
    float depth = -ty_ln(1.0f - u);
    return extinction * TY_FLOAT_MAX > depth ? depth / extinction : TY_FLOAT_MAX;
}

ty_rgb ty_flight_transmittance(ty_rgb extinction, float distance)
{
    if (ty_rgb_is_black(extinction))
        return ty_rgb_grey(1.0f);
    return ty_rgb_make(ty_exp(-extinction.r * distance), ty_exp(-extinction.g * distance),
                       ty_exp(-extinction.b * distance));
}

// beta times f over the density of f that all channels have together.
static void weigh(ty_rgb f, ty_rgb* beta)
{
    ty_rgb share = channel_shares(beta);
    float pdf = share.r * f.r + share.g * f.g + share.b * f.b;
    *beta = pdf > 0.0f ? ty_rgb_scale(ty_rgb_mul(*beta, f), 1.0f / pdf) : ty_rgb_grey(0.0f);
}

void ty_flight_scatter(const ty_scattering* m, float distance, ty_rgb* beta)
{
    if (!is_grey(m))
        weigh(ty_rgb_mul(m->extinction, ty_flight_transmittance(m->extinction, distance)), beta);
    *beta = ty_rgb_mul(*beta, m->albedo);
}

void ty_flight_pass(const ty_scattering* m, float distance, ty_rgb* beta)
{
    if (!is_grey(m))
        weigh(ty_flight_transmittance(m->extinction, distance), beta);
}

bool ty_flight_survives(float began, ty_rgb* beta, ty_rng* rng)
{
    float most = ty_rgb_max(*beta), faint = 0.25f * began;
    if (most >= faint)
        return most > 0.0f;
    if (ty_rng_float(rng) * faint >= most)
        return false;
    *beta = ty_rgb_scale(*beta, faint / most);
    return true;
}
