// SPDX-License-Identifier: Apache-2.0
// Guided flights: their directions, lengths and densities, beside those of the matter (balance heuristic).
#include "guide.h"
#include <tsuya/shading/sampling.h>

// Of flights that are guided. More are shorter walks, but light that goes against the guide then weighs too much: on a
// heap of grains .5 to .75 differ by a tenth to a fifth in mean squared error, and .9 is worse than .5.
#define SHARE 0.6f

ty_guide ty_guide_make(const ty_scattering* matter, ty_vec3 normal)
{
    ty_guide g = {.share = 0.0f};
    float albedo = ty_rgb_max(matter->albedo);
    // White matter has no diffusion length; with little albedo there is hardly a second flight.
    if (matter->anisotropy != 0.0f || albedo > 0.9999f || albedo < 0.3f)
        return g;
    g.frame = ty_frame_from_normal(normal);
    g.share = SHARE;
    // A fit of E. d'Eon and J. Krivanek 2020, "Zero-variance theory for efficient subsurface scattering", eq. 67.
    g.fall = sqrtf(1.0f - ty_exp(ty_ln(albedo) * (2.44294f - 0.0215813f * albedo + 0.578637f / albedo)));
    g.log = ty_ln((1.0f + g.fall) / (1.0f - g.fall));
    return g;
}

ty_guided ty_guide_first(const ty_guide* g, ty_vec3 direction, ty_rng* rng)
{
    ty_guided way = {.direction = direction, .stretch = 1.0f, .ratio = 1.0f};
    if (g->share > 0.0f)
    {
        way.guided = ty_rng_float(rng) < g->share;
        way.stretch = 1.0f - g->fall * ty_dot(direction, g->frame.n);
    }
    return way;
}

ty_guided ty_guide_next(const ty_guide* g, const ty_scattering* matter, ty_vec3 direction, ty_rng* rng)
{
    ty_guided way = {.stretch = 1.0f, .ratio = 1.0f};
    float u = ty_rng_float(rng), v = ty_rng_float(rng);
    if (!(g->share > 0.0f))
    {
        way.direction = ty_phase_sample(matter->anisotropy, direction, (ty_vec2){u, v});
        return way;
    }
    way.guided = ty_rng_float(rng) < g->share;
    if (way.guided)
    {
        // 1 - fall c falls from 1 + fall to 1 - fall as a power of u.
        float sine, cosine, c = (1.0f - (1.0f + g->fall) * ty_exp(-u * g->log)) / g->fall,
                            s = ty_safe_sqrt(1.0f - c * c);
        ty_sincos(2.0f * TY_PI * v, &sine, &cosine);
        way.direction = ty_to_world(g->frame, ty_vec3_make(s * cosine, s * sine, c));
    }
    else
        way.direction = ty_phase_sample(matter->anisotropy, direction, (ty_vec2){u, v});
    way.stretch = 1.0f - g->fall * ty_dot(way.direction, g->frame.n);
    way.ratio = 2.0f * g->fall / (way.stretch * g->log);
    return way;
}

// Of a flight over a distance by both ways, that by the guide relative to that of the matter, for one extinction.
static float gain(const ty_guide* g, const ty_guided* way, float extinction, float distance, float stretch)
{
    return 1.0f - g->share + g->share * way->ratio * stretch * ty_exp(extinction * distance * (1.0f - way->stretch));
}

// The same times that of the matter, which would be 0 times infinity where the way is long.
static float density(const ty_guide* g, const ty_guided* way, float extinction, float distance, float stretch)
{
    float guided = g->share * way->ratio * stretch * ty_exp(-extinction * distance * way->stretch);
    return (1.0f - g->share) * ty_exp(-extinction * distance) + guided;
}

static void weigh_channels(const ty_guide* g, const ty_scattering* m, const ty_guided* way, float distance,
                           bool scattered, ty_rgb* beta)
{
    const ty_rgb e = m->extinction, per_length = scattered ? e : ty_rgb_grey(1.0f);
    float stretch = scattered ? way->stretch : 1.0f;
    ty_rgb f = ty_rgb_mul(ty_flight_transmittance(e, distance), per_length);
    float pdf = beta->r * per_length.r * density(g, way, e.r, distance, stretch) +
                beta->g * per_length.g * density(g, way, e.g, distance, stretch) +
                beta->b * per_length.b * density(g, way, e.b, distance, stretch);
    float sum = beta->r + beta->g + beta->b;
    *beta = pdf > 0.0f ? ty_rgb_scale(ty_rgb_mul(*beta, f), sum / pdf) : ty_rgb_grey(0.0f);
}

void ty_guide_weigh(const ty_guide* g, const ty_scattering* m, const ty_guided* way, float distance, bool scattered,
                    ty_rgb* beta)
{
    if (!(g->share > 0.0f))
    {
        if (scattered)
            ty_flight_scatter(m, distance, beta);
        else
            ty_flight_pass(m, distance, beta);
        return;
    }
    const ty_rgb e = m->extinction;
    if (e.r == e.g && e.g == e.b)
        *beta = ty_rgb_scale(*beta, 1.0f / gain(g, way, e.r, distance, scattered ? way->stretch : 1.0f));
    else
        weigh_channels(g, m, way, distance, scattered, beta);
    if (scattered)
        *beta = ty_rgb_mul(*beta, m->albedo);
}
