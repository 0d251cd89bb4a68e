// SPDX-License-Identifier: Apache-2.0
// `surface`: a coat over a mixture of metal, diffuse dielectric and transmitting dielectric. Preparation at a point.
#include "bark.h"
#include "diffuse.h"
#include "fresnel.h"
#include "material_private.h"
#include "microfacet.h"
#include "surface_private.h"

ty_rgb ty_surface_base_color(const ty_surface_def* def, const ty_shading_context* context,
                             const ty_surface_point* point)
{
    ty_rgb color = ty_clamp_color(ty_input_color(&def->base_color, context, point));
    return ty_rgb_scale(color, ty_unit_input(&def->base_weight, context, point));
}

// Of the dielectric.
static ty_rgb reflected_at(const ty_bsdf* b, float mu)
{
    ty_rgb share = ty_rgb_grey(ty_albedo_row_at(&b->specular_row, mu));
    return b->film_row.count > 0 ? ty_clamp_color(ty_rgb_add(share, ty_thin_film_row_at(&b->film_row, mu))) : share;
}

// Reflection of the base's boundary seen from mu, exact for mirrors.
static ty_rgb specular_albedo(const ty_bsdf* b, float mu)
{
    if (b->alpha.x == 0.0f || b->thin)
        return ty_surface_reflectance(b, mu);
    ty_rgb share = b->inside ? ty_rgb_grey(b->transmission_weight * ty_clamp(ty_surface_boundary(b, mu), 0.1f, 0.9f))
                             : reflected_at(b, mu);
    ty_rgb metal = ty_rgb_mul(b->metal, ty_surface_metal(b, mu));
    return ty_rgb_add(ty_rgb_scale(ty_rgb_mul(b->specular_tint, share), 1.0f - b->metalness), metal);
}

static ty_rgb transmission_albedo(const ty_bsdf* b, float mu)
{
    if (b->thin && b->alpha.x == 0.0f)
        return ty_rgb_grey(0.0f); // passes unbent: ty_material_transparency
    if (b->alpha.x == 0.0f || b->thin)
        return ty_surface_transmittance(b, mu);
    ty_rgb share = b->inside ? ty_rgb_grey(ty_clamp(ty_surface_boundary(b, mu), 0.1f, 0.9f)) : reflected_at(b, mu);
    share = ty_rgb_add(ty_rgb_grey(1.0f), ty_rgb_scale(share, -1.0f));
    return ty_rgb_scale(ty_rgb_mul(b->transmission, share), ty_surface_clear(b));
}

// Albedos of the lobes seen from mu, as rgb.
static void lobe_albedos(const ty_bsdf* b, float mu, ty_rgb albedo[TY_LOBE_COUNT])
{
    float left = b->layered ? ty_layers_left(b, mu) : 1.0f;
    ty_rgb tint = ty_rgb_scale(b->layered ? ty_layers_tint(b, mu, mu) : ty_rgb_grey(1.0f), left);
    ty_rgb diffuse =
        ty_rgb_scale(ty_rgb_mul(tint, ty_layers_diffuse_color(b, mu)), ty_surface_diffuse(b) / ty_max(left, 1e-6f));
    ty_rgb metal_lost = ty_rgb_scale(b->conductor_gain, TY_PI * b->conductor_mean / ty_max(left, 1e-6f));
    ty_rgb near = ty_rgb_scale(b->specular_tint, b->near_gain * TY_PI * b->near_mean / ty_max(left, 1e-6f));
    ty_rgb far = ty_rgb_scale(b->transmission, b->far_gain * TY_PI * b->far_loss.average);
    albedo[TY_LOBE_FUZZ] = albedo[TY_LOBE_COAT] = ty_rgb_grey(0.0f);
    if (b->layered)
    {
        float fuzz = 1.0f - ty_layers_over_coat(b, mu, mu);
        albedo[TY_LOBE_FUZZ] = ty_rgb_scale(b->fuzz_color, fuzz);
        albedo[TY_LOBE_COAT] = ty_rgb_grey(1.0f - fuzz - left);
    }
    albedo[TY_LOBE_SPECULAR] = ty_rgb_mul(specular_albedo(b, mu), tint);
    albedo[TY_LOBE_DIFFUSE] = ty_rgb_mul(ty_diffuse_albedo(b->diffuse, b->diffuse_roughness, mu), diffuse);
    albedo[TY_LOBE_TRANSMISSION] = ty_rgb_mul(transmission_albedo(b, mu), tint);
    albedo[TY_LOBE_LOST_ABOVE] = ty_rgb_mul(ty_rgb_add(metal_lost, near), tint);
    albedo[TY_LOBE_LOST_BELOW] = ty_rgb_mul(far, tint);
    albedo[TY_LOBE_DIFFUSE_BELOW] = ty_rgb_mul(b->diffuse_below, diffuse);
}

static ty_rgb body_albedo(const ty_bsdf* b, float mu)
{
    ty_rgb share = ty_rgb_scale(ty_layers_diffuse_color(b, mu), ty_surface_body(b));
    return ty_rgb_mul(ty_rgb_mul(b->body_color, ty_layers_tint(b, mu, mu)), share);
}

static void choose_probabilities(ty_bsdf* b, float mu)
{
    ty_rgb albedo[TY_LOBE_COUNT];
    float sum = 0.0f;
    lobe_albedos(b, mu, albedo);
    for (int i = 0; i < TY_LOBE_COUNT; i++)
    {
        b->lobe_probability[i] = (albedo[i].r + albedo[i].g + albedo[i].b) * (1.0f / 3.0f);
        sum += b->lobe_probability[i];
    }
    for (int i = 0; i < TY_LOBE_COUNT && sum > 0.0f; i++)
        b->lobe_probability[i] /= sum;
    if (b->kind != TY_BSDF_SUBSURFACE)
        return;
    ty_rgb within = body_albedo(b, mu);
    float rest = sum / ty_max(sum + (within.r + within.g + within.b) * (1.0f / 3.0f), 1e-6f);
    // Highlights are bright where they are: never sampled less than one time in ten.
    b->surface_chance = sum > 0.0f ? ty_clamp(rest, 0.1f, 0.9f) : 0.0f;
}

// A body's share: where its light goes within.
static void prepare_body(const ty_surface_def* s, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_surface_point* p = &b->point;
    b->body = ty_unit_input(&s->subsurface_weight, context, p);
    if (!(ty_surface_body(b) > 0.0f))
        return;
    ty_rgb color = ty_clamp_color(ty_input_color(&s->subsurface_color, context, p));
    ty_rgb scale = ty_input_color(&s->subsurface_radius_scale, context, p);
    float radius = ty_input_float(&s->subsurface_radius, context, p), g = s->subsurface_anisotropy;
    b->kind = TY_BSDF_SUBSURFACE;
    b->body_color = color;
    if (s->subsurface_evaluate == TY_SUBSURFACE_WALK)
        b->matter = ty_walk_matter(color, radius, scale, g);
    else
        ty_cdrf_set_medium(b, radius / (1.0f - g), scale, color, 0.0f);
}

static void prepare_transmission(const ty_surface_def* s, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_surface_point* p = &b->point;
    b->transmission_weight = ty_unit_input(&s->transmission_weight, context, p);
    if (b->transmission_weight <= 0.0f || b->metalness >= 1.0f)
        return;
    b->inside = !b->entering && !b->thin;
    ty_rgb tint = ty_clamp_color(ty_input_color(&s->transmission_color, context, p));
    // Over a depth the tint is the medium's, not the boundary's.
    b->transmission = s->transmission_depth <= 0.0f || b->thin ? tint : ty_rgb_grey(1.0f);
}

// The share of the base that is a thin sheet of scattering matter sends light to both sides (OpenPBR Surface 1.1,
// "Thin-walled case").
static void prepare_diffuse(const ty_surface_def* s, const ty_shading_context* context, ty_bsdf* b)
{
    b->diffuse = b->color;
    b->diffuse_roughness = ty_unit_input(&s->base_diffuse_roughness, context, &b->point);
    if (!b->thin)
        return;
    float weight = ty_unit_input(&s->subsurface_weight, context, &b->point);
    ty_rgb color = ty_clamp_color(ty_input_color(&s->subsurface_color, context, &b->point));
    float through = 0.5f * (1.0f + s->subsurface_anisotropy);
    b->diffuse = ty_rgb_lerp(b->color, ty_rgb_scale(color, 1.0f - through), weight);
    b->diffuse_below = ty_rgb_scale(color, through * weight);
}

// Of light that metal facets pass on among themselves each meeting takes its part: deeper colour where it is rough
// (Kulla & Conty 2017, "Revisiting physically based shading at Imageworks", in Hill's correction).
static float conductor_share(float f, float loss)
{
    return f * f * (1.0f - loss) / (1.0f - f * loss);
}

static ty_rgb metal_average(const ty_bsdf* b)
{
    if (!(b->film.weight > 0.0f))
        return ty_metal_average(b->color, b->metal_dip);
    ty_rgb sum = {0};
    for (int i = 0; i < TY_MU_NODES; i++)
        sum = ty_rgb_add(sum, ty_rgb_scale(ty_surface_metal(b, ty_mu_nodes[i].mu), ty_mu_nodes[i].weight));
    return sum;
}

static void prepare_conductor_loss(const ty_material* material, float roughness, float mu, ty_bsdf* b)
{
    b->conductor_loss = ty_loss_table_row(material->conductor, roughness, 1.0f);
    float loss = b->conductor_loss.average, w = b->specular_weight;
    b->conductor_mean = b->layered ? ty_layers_mean(b, ty_layers_metal) : loss;
    if (!(b->conductor_mean > 0.0f))
        return;
    float scale = b->metalness * ty_layers_metal(b, mu) / (TY_PI * b->conductor_mean);
    ty_rgb f = ty_rgb_scale(metal_average(b), w);
    b->conductor_gain = ty_rgb_make(scale * conductor_share(f.r, loss), scale * conductor_share(f.g, loss),
                                    scale * conductor_share(f.b, loss));
}

// Share of what is lost on wo's side of a clear boundary that goes on beyond it. Reciprocal: what one side hands over
// in a uniform light is what the other hands back, t1 l1 = t2 n^2 l2 (Kulla & Conty 2017); 1 - the mean Fresnel
// reflectance where the losses are alike.
static float far_share(const ty_bsdf* b)
{
    float near = b->near_loss.average, far = b->far_loss.average, n = ty_max(b->eta, 1.0f / b->eta);
    float through = (1.0f - ty_fresnel_average(ty_max(b->shine, 1.0f / b->shine))) * ty_min(near, far) / near;
    return b->eta >= 1.0f ? through : through / (n * n);
}

// Of a sheet both lobes are those of a reflection, so that it loses what a metal loses.
static void prepare_sheet_loss(const ty_material* material, float roughness, float mu, ty_bsdf* b)
{
    b->near_loss = b->far_loss = ty_loss_table_row(material->conductor, roughness, 1.0f);
    float loss = b->near_loss.average;
    if (!(loss > 0.0f))
        return;
    float f = ty_fresnel_average(b->shine), scale = ty_loss_row_at(&b->near_loss, mu);
    scale *= ty_surface_clear(b) / (TY_PI * loss);
    b->near_share = 2.0f * f / (1.0f + f);
    b->far_gain = scale * (1.0f - f) / (1.0f + f);
}

static void prepare_dielectric_loss(const ty_material* material, float roughness, float mu, ty_bsdf* b)
{
    b->near_loss = ty_loss_table_row(material->dielectric, roughness, b->eta);
    b->far_loss = ty_loss_table_row(material->dielectric, roughness, 1.0f / b->eta);
    float near = b->near_loss.average, far = b->far_loss.average;
    if (!(near > 0.0f))
        return;
    float scale = ty_surface_clear(b) * ty_loss_row_at(&b->near_loss, mu), t = far > 0.0f ? far_share(b) : 0.0f;
    b->near_share = 1.0f - t;
    b->far_gain = far > 0.0f ? scale * t / (TY_PI * far) : 0.0f;
}

// The lobe of what a clear boundary sends up late.
static void couple_near_loss(float mu, ty_bsdf* b)
{
    b->near_mean = b->layered ? ty_layers_mean(b, ty_layers_clear) : b->near_share * b->near_loss.average;
    if (b->near_mean > 0.0f)
        b->near_gain = ty_surface_clear(b) * ty_layers_clear(b, mu) / (TY_PI * b->near_mean);
}

static void prepare_loss(const ty_material* material, float roughness, ty_bsdf* b)
{
    if (b->alpha.x == 0.0f)
        return;
    float mu = ty_dot(b->wo, b->frame.n);
    if (b->metalness > 0.0f)
        prepare_conductor_loss(material, roughness, mu, b);
    if (ty_surface_clear(b) > 0.0f && b->thin)
        prepare_sheet_loss(material, roughness, mu, b);
    else if (ty_surface_clear(b) > 0.0f)
        prepare_dielectric_loss(material, roughness, mu, b);
    if (b->near_share > 0.0f)
        couple_near_loss(mu, b);
}

// relative: index of the base; cover: of the coat on average, where it is.
static void prepare_film(const ty_material* material, const ty_shading_context* context, float roughness,
                         float relative, float cover, ty_bsdf* b)
{
    const ty_surface_def* s = &material->surface;
    float weight = ty_unit_input(&s->thin_film_weight, context, &b->point);
    float thickness = ty_input_float(&s->thin_film_thickness, context, &b->point);
    if (!(weight > 0.0f) || !(thickness > 0.0f))
        return;
    float outside = b->transmission_weight > 0.0f ? b->outside : 1.0f;
    b->film = ty_thin_film_make(material->film_bands, weight, thickness, s->thin_film_ior, outside, cover, relative);
    if (!b->inside)
        b->film_row = ty_thin_film_table_row(material->film, roughness, thickness, weight);
}

// Roughness, index and what follows from them. b->outside is the index of what is around the body.
static void prepare_boundary(const ty_material* material, const ty_shading_context* context, float roughness,
                             ty_bsdf* b)
{
    const ty_surface_def* s = &material->surface;
    const ty_surface_point* p = &b->point;
    float ior = ty_clamp(ty_input_float(&s->specular_ior, context, p), 1.0f, 3.0f);
    float cover = b->coat_weight > 0.0f ? ty_lerp(1.0f, b->coat_eta, b->coat_weight) : 1.0f;
    // Opaque bases keep the index of air: what lies beneath is coupled by a table for that.
    float relative = b->transmission_weight > 0.0f ? ior / b->outside : ior;
    b->eta = b->inside ? 1.0f / relative : relative;
    b->shine = ty_shine(b->eta, b->specular_weight, cover);
    if (material->film_bands)
        prepare_film(material, context, roughness, relative, cover, b);
    // Matched indices bend nothing, and a rough boundary would have no facet to speak of.
    if (fabsf(relative - 1.0f) < 0.001f && b->transmission_weight > 0.0f && !(b->thin && b->film.weight > 0.0f))
        b->alpha = ty_ggx_round(0.0f);
    else if (material->anisotropic)
        b->alpha = ty_ggx_alpha_stretched(roughness, ty_unit_input(&s->specular_roughness_anisotropy, context, p));
    else
        b->alpha = ty_ggx_round(ty_ggx_alpha(roughness));
    if (!b->inside)
        b->specular_row = ty_albedo_table_row(material->specular, roughness, ty_shine(ior, b->specular_weight, cover));
    if (b->coat_weight > 0.0f)
        b->base_under_coat = ty_albedo_table_row(material->base_under_coat, roughness, b->coat_roughness);
    if (b->fuzz_weight > 0.0f)
        b->base_under_fuzz = ty_albedo_table_row(material->base_under_fuzz, roughness, b->fuzz_roughness);
    // Stretching keeps the mean square of the slopes, and with it about what is lost.
    prepare_loss(material, roughness, b);
}

// The same by channels.
static void couple_film(float mu, ty_bsdf* b)
{
    ty_rgb mean = {0}, left = ty_layers_diffuse_color(b, mu);
    for (int i = 0; i < TY_MU_NODES && b->layered; i++)
        mean = ty_rgb_add(mean, ty_rgb_scale(ty_layers_diffuse_color(b, ty_mu_nodes[i].mu), ty_mu_nodes[i].weight));
    if (!b->layered)
        mean = ty_rgb_add(ty_rgb_grey(1.0f - b->specular_row.average), ty_rgb_scale(b->film_row.average, -1.0f));
    b->film_gain =
        ty_rgb_make(left.r / ty_max(mean.r, 1e-6f), left.g / ty_max(mean.g, 1e-6f), left.b / ty_max(mean.b, 1e-6f));
}

// Light to and from the diffuse base is what the layers leave, over its mean, so that white stays white (Kelemen &
// Szirmay-Kalos 2001).
static void couple_diffuse(float mu, ty_bsdf* b)
{
    if (b->inside || !(ty_surface_diffuse(b) + ty_surface_body(b) > 0.0f))
    {
        b->diffuse_gain = 1.0f;
        return;
    }
    float mean = b->layered ? ty_layers_mean(b, ty_layers_diffuse) : 1.0f - b->specular_row.average;
    b->diffuse_gain = mean > 0.0f ? ty_layers_diffuse(b, mu) / mean : 0.0f;
    if (b->film_row.count > 0)
        couple_film(mu, b);
    if (!(b->diffuse_roughness > 0.0f) || !(b->layered || b->specular_row.count > 0 || b->film_row.count > 0))
        return;
    for (int i = 0; i < TY_MU_NODES; i++)
    {
        ty_rgb left = ty_layers_diffuse_color(b, ty_mu_nodes[i].mu);
        b->diffuse_left[i] = ty_mu_nodes[i].weight * (left.r + left.g + left.b) * (1.0f / 3.0f);
    }
    b->diffuse_excess = ty_diffuse_excess(b->diffuse_roughness, b->diffuse_left, mu) -
                        ty_diffuse_excess_mean(b->diffuse_roughness, b->diffuse_left);
    b->excessive = true;
}

void ty_surface_prepare(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_surface_def* s = &material->surface;
    const ty_surface_point* p = &b->point;
    b->kind = TY_BSDF_SURFACE;
    b->thin = s->thin_walled;
    ty_bark_look look;
    if (material->is_bark)
        look = ty_bark_look_at(&material->bark, context, p);
    else
        look = (ty_bark_look){ty_surface_base_color(s, context, p), ty_unit_input(&s->specular_roughness, context, p)};
    b->color = look.color;
    b->specular_tint = ty_clamp_color(ty_input_color(&s->specular_color, context, p));
    b->metalness = ty_unit_input(&s->base_metalness, context, p);
    b->specular_weight = ty_unit_input(&s->specular_weight, context, p);
    b->metal = ty_rgb_grey(b->metalness * b->specular_weight);
    if (b->metalness > 0.0f)
        b->metal_dip = ty_metal_dip(b->color, b->specular_tint);
    float roughness = look.roughness, mu = ty_dot(b->wo, b->frame.n);
    prepare_transmission(s, context, b);
    ty_surface_prepare_layers(material, context, b);
    if (material->emissive && b->entering)
        b->emission = ty_rgb_mul(ty_material_emission(material, context, p), ty_layers_across(b, mu, mu));
    prepare_diffuse(s, context, b);
    if (material->body && b->entering)
        prepare_body(s, context, b);
    prepare_boundary(material, context, roughness, b);
    if (b->coat_weight > 0.0f)
        ty_surface_prepare_darkening(s, context, roughness, b);
    couple_diffuse(mu, b);
    choose_probabilities(b, mu);
}

ty_rgb ty_surface_albedo(const ty_bsdf* b)
{
    ty_rgb albedo[TY_LOBE_COUNT], sum = {0};
    float mu = ty_dot(b->wo, b->frame.n);
    lobe_albedos(b, mu, albedo);
    for (int i = 0; i < TY_LOBE_COUNT; i++)
        sum = ty_rgb_add(sum, albedo[i]);
    return b->kind == TY_BSDF_SUBSURFACE ? ty_rgb_add(sum, body_albedo(b, mu)) : sum;
}

bool ty_surface_take_interior(ty_bsdf* b, const ty_shading_context* context, const float u[3], ty_rng* extra,
                              ty_rgb* weight)
{
    const ty_surface_def* s = &b->material->surface;
    float mu = ty_dot(b->wo, b->frame.n);
    bool walks = s->subsurface_evaluate == TY_SUBSURFACE_WALK, traced = context && context->world, left = false;
    *weight = ty_rgb_scale(ty_rgb_mul(ty_layers_tint_one(b, mu), ty_surface_gain(b)), ty_surface_body(b));
    ty_surface_point exit;
    if (walks && traced)
    {
        // Darkened where a coat sends light back; the colour itself comes of the walk.
        ty_rgb color = ty_walk_reflectance(&b->matter);
        const float least = 1e-6f;
        *weight = ty_rgb_mul(*weight, ty_rgb_make(b->body_color.r / ty_max(color.r, least),
                                                  b->body_color.g / ty_max(color.g, least),
                                                  b->body_color.b / ty_max(color.b, least)));
        left = ty_walk_exit(context, b, u, extra, weight, &exit);
    }
    else
    {
        *weight = ty_rgb_mul(*weight, b->body_color);
        left = traced && ty_cdrf_depth_exit(context, b, u, extra, weight, &exit);
    }
    if (left)
        b->point = exit;
    b->kind = TY_BSDF_CDRF_EXIT;
    b->color = b->body_color;
    b->bent = false; // the map is the surface's
    b->frame = ty_frame_from_normal(b->point.ns);
    return !ty_rgb_is_black(*weight);
}

ty_rgb ty_surface_eval_exit(const ty_bsdf* b, float mu)
{
    return ty_rgb_mul(ty_layers_tint_one(b, mu), ty_layers_diffuse_color(b, mu));
}
