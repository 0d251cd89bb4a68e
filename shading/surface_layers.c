// SPDX-License-Identifier: Apache-2.0
// `surface`: what fuzz and coat let through to and from what lies beneath them.
#include "albedo_table.h"
#include "diffuse.h"
#include "loss_table.h"
#include "surface_private.h"
#include "thin_film.h"

static float fuzz_albedo(const ty_bsdf* b, float mu)
{
    return b->fuzz_weight > 0.0f ? b->fuzz_weight * ty_albedo_row_at(&b->fuzz_row, mu) : 0.0f;
}

static float kept(float weight, const ty_albedo_row* row, float mu)
{
    return weight > 0.0f ? 1.0f - weight * ty_albedo_row_at(row, mu) : 1.0f;
}

float ty_layers_left(const ty_bsdf* b, float mu)
{
    float coat = ty_coat_albedo(b, mu) * kept(b->fuzz_weight, &b->coat_under_fuzz, mu);
    return 1.0f - fuzz_albedo(b, mu) - coat;
}

// Of a reflection at the base towards all directions.
static float base_kept(const ty_bsdf* b, float mu)
{
    return kept(b->coat_weight, &b->base_under_coat, mu) * kept(b->fuzz_weight, &b->base_under_fuzz, mu);
}

float ty_layers_diffuse(const ty_bsdf* b, float mu)
{
    if (b->inside)
        return 1.0f;
    float reflected = ty_albedo_row_at(&b->specular_row, mu);
    if (!b->layered)
        return 1.0f - reflected;
    return ty_max(ty_layers_left(b, mu) - reflected * base_kept(b, mu), 0.0f);
}

ty_rgb ty_layers_diffuse_color(const ty_bsdf* b, float mu)
{
    if (b->film_row.count == 0 || b->inside)
        return ty_rgb_grey(ty_layers_diffuse(b, mu));
    ty_rgb film = ty_thin_film_row_at(&b->film_row, mu);
    float reflected = ty_albedo_row_at(&b->specular_row, mu), left = 1.0f, under = 1.0f;
    if (b->layered)
    {
        left = ty_layers_left(b, mu);
        under = base_kept(b, mu);
    }
    return ty_rgb_make(ty_max(left - (reflected + film.r) * under, 0.0f),
                       ty_max(left - (reflected + film.g) * under, 0.0f),
                       ty_max(left - (reflected + film.b) * under, 0.0f));
}

float ty_layers_metal(const ty_bsdf* b, float mu)
{
    float lost = ty_loss_row_at(&b->conductor_loss, mu);
    if (!b->layered)
        return lost;
    return ty_max(ty_layers_left(b, mu) - (1.0f - lost) * base_kept(b, mu), 0.0f);
}

float ty_layers_clear(const ty_bsdf* b, float mu)
{
    float lost = b->near_share * ty_loss_row_at(&b->near_loss, mu);
    if (!b->layered)
        return lost;
    float left = ty_layers_left(b, mu), reflected = ty_albedo_row_at(&b->specular_row, mu);
    if (b->film_row.count > 0)
    {
        ty_rgb film = ty_thin_film_row_at(&b->film_row, mu);
        reflected = ty_clamp(reflected + (film.r + film.g + film.b) * (1.0f / 3.0f), 0.0f, 1.0f);
    }
    if (b->thin)
        reflected = 2.0f * reflected / (1.0f + reflected);
    return left * lost + reflected * ty_max(left - base_kept(b, mu), 0.0f);
}

float ty_layers_over_coat(const ty_bsdf* b, float mu_o, float mu_i)
{
    return 1.0f - ty_max(fuzz_albedo(b, mu_o), fuzz_albedo(b, mu_i));
}

static float inverse_cosine_within(const ty_bsdf* b, float mu)
{
    return 1.0f / sqrtf(1.0f - (1.0f - mu * mu) / (b->coat_eta * b->coat_eta));
}

// The colour is that of the straight way there and back, half of it one way.
static ty_rgb tint_over(const ty_bsdf* b, float way)
{
    ty_rgb c = {ty_exp(way * b->coat_log.r), ty_exp(way * b->coat_log.g), ty_exp(way * b->coat_log.b)};
    return ty_rgb_lerp(ty_rgb_grey(1.0f), c, b->coat_weight);
}

ty_rgb ty_layers_tint(const ty_bsdf* b, float mu_o, float mu_i)
{
    if (!b->tinted)
        return ty_rgb_grey(1.0f);
    return tint_over(b, 0.5f * (inverse_cosine_within(b, mu_o) + inverse_cosine_within(b, mu_i)));
}

ty_rgb ty_layers_tint_one(const ty_bsdf* b, float mu)
{
    return b->tinted ? tint_over(b, 0.5f * inverse_cosine_within(b, mu)) : ty_rgb_grey(1.0f);
}

ty_rgb ty_layers_over_base(const ty_bsdf* b, float mu_o, float mu_i)
{
    if (!b->layered)
        return ty_rgb_grey(1.0f);
    float coat = 1.0f - ty_max(ty_coat_albedo(b, mu_o), ty_coat_albedo(b, mu_i));
    return ty_rgb_scale(ty_layers_tint(b, mu_o, mu_i), coat * ty_layers_over_coat(b, mu_o, mu_i));
}

ty_rgb ty_layers_across(const ty_bsdf* b, float mu_o, float mu_i)
{
    float mu = b->inside ? mu_i : mu_o;
    if (!(b->coat_weight > 0.0f || b->fuzz_weight > 0.0f))
        return ty_rgb_grey(1.0f);
    return ty_rgb_scale(ty_layers_tint_one(b, mu), ty_layers_left(b, mu));
}

float ty_layers_mean(const ty_bsdf* b, float (*what)(const ty_bsdf*, float))
{
    float sum = 0.0f;
    for (int i = 0; i < TY_MU_NODES; i++)
        sum += ty_mu_nodes[i].weight * what(b, ty_mu_nodes[i].mu);
    return sum;
}
