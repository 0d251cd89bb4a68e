// SPDX-License-Identifier: Apache-2.0
// `surface`: a coat over a mixture of metal, diffuse dielectric and transmitting dielectric. Preparation at a point.
#include "fresnel.h"
#include "material_private.h"
#include "microfacet.h"
#include "surface_private.h"

static float unit_input(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point)
{
    return ty_clamp(ty_input_float(input, context, point), 0.0f, 1.0f);
}

// Coupling of the Lambert base with the reflecting layers above it (Kelemen & Szirmay-Kalos 2001), with the average of
// both together: white stays white.
static float layer_average(const ty_bsdf* b)
{
    if (b->inside)
        return 1.0f;
    float coat = b->coat_weight * b->coat_row.average, base = b->specular_weight * b->specular_row.average,
          common = 0.0f;
    if (coat > 0.0f && base > 0.0f)
        common = b->coat_weight * b->specular_weight * ty_albedo_row_common(&b->coat_row, &b->specular_row);
    return 1.0f - coat - base + common;
}

// Reflection of the base's boundary seen from mu, exact for mirrors.
static ty_rgb specular_albedo(const ty_bsdf* b, float mu)
{
    if (b->alpha.x == 0.0f || b->thin)
        return ty_surface_reflectance(b, mu);
    float share = b->inside ? b->transmission_weight * ty_clamp(ty_surface_boundary(b, mu), 0.1f, 0.9f)
                            : b->specular_weight * ty_albedo_row_at(&b->specular_row, mu);
    ty_rgb metal = ty_fresnel_schlick(b->color, b->specular_tint, mu);
    return ty_rgb_add(ty_rgb_scale(b->specular_tint, (1.0f - b->metalness) * share),
                      ty_rgb_scale(metal, b->metalness * b->specular_weight));
}

static ty_rgb transmission_albedo(const ty_bsdf* b, float mu)
{
    if (b->thin && b->alpha.x == 0.0f)
        return ty_rgb_grey(0.0f); // passes unbent: ty_material_transparency
    if (b->alpha.x == 0.0f || b->thin)
        return ty_surface_transmittance(b, mu);
    float share = b->inside ? ty_clamp(ty_surface_boundary(b, mu), 0.1f, 0.9f)
                            : b->specular_weight * ty_albedo_row_at(&b->specular_row, mu);
    return ty_rgb_scale(b->transmission, ty_surface_clear(b) * (1.0f - share));
}

// Albedos of the lobes seen from mu, as rgb. through: what the layers let through from there.
static void lobe_albedos(const ty_bsdf* b, float mu, float through, ty_rgb albedo[TY_LOBE_COUNT])
{
    float coat = b->inside ? 0.0f : ty_coat_albedo(b, mu), left = 1.0f - coat;
    float diffuse = through * ty_surface_diffuse(b);
    ty_rgb metal_lost = ty_rgb_scale(b->conductor_gain, TY_PI * b->conductor_loss.average);
    ty_rgb near = ty_rgb_scale(b->specular_tint, b->near_gain * TY_PI * b->near_loss.average);
    ty_rgb far = ty_rgb_scale(b->transmission, b->far_gain * TY_PI * b->far_loss.average);
    albedo[TY_LOBE_COAT] = ty_rgb_grey(coat);
    albedo[TY_LOBE_SPECULAR] = ty_rgb_scale(specular_albedo(b, mu), left);
    albedo[TY_LOBE_DIFFUSE] = ty_rgb_scale(b->diffuse, diffuse);
    albedo[TY_LOBE_TRANSMISSION] = ty_rgb_scale(transmission_albedo(b, mu), left);
    albedo[TY_LOBE_LOST_ABOVE] = ty_rgb_scale(ty_rgb_add(metal_lost, near), left);
    albedo[TY_LOBE_LOST_BELOW] = ty_rgb_scale(far, left);
    albedo[TY_LOBE_DIFFUSE_BELOW] = ty_rgb_scale(b->diffuse_below, diffuse);
}

static void choose_probabilities(ty_bsdf* b, float mu, float through)
{
    ty_rgb albedo[TY_LOBE_COUNT];
    float sum = 0.0f;
    lobe_albedos(b, mu, through, albedo);
    for (int i = 0; i < TY_LOBE_COUNT; i++)
    {
        b->lobe_probability[i] = (albedo[i].r + albedo[i].g + albedo[i].b) * (1.0f / 3.0f);
        sum += b->lobe_probability[i];
    }
    for (int i = 0; i < TY_LOBE_COUNT && sum > 0.0f; i++)
        b->lobe_probability[i] /= sum;
}

static void prepare_transmission(const ty_surface_def* s, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_surface_point* p = &b->point;
    b->transmission_weight = unit_input(&s->transmission_weight, context, p);
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
    if (!b->thin)
        return;
    float weight = unit_input(&s->subsurface_weight, context, &b->point);
    ty_rgb color = ty_clamp_color(ty_input_color(&s->subsurface_color, context, &b->point));
    float through = 0.5f * (1.0f + s->subsurface_anisotropy);
    b->diffuse = ty_rgb_lerp(b->color, ty_rgb_scale(color, 1.0f - through), weight);
    b->diffuse_below = ty_rgb_scale(color, through * weight);
}

// The mean of Schlick's form over the cosine-weighted hemisphere.
static float schlick_average(float f0, float f90)
{
    return f0 + (f90 - f0) * (1.0f / 21.0f);
}

// Of light that metal facets pass on among themselves each meeting takes its part: deeper colour where it is rough
// (Kulla & Conty 2017, "Revisiting physically based shading at Imageworks", in Hill's correction).
static float conductor_share(float f, float loss)
{
    return f * f * (1.0f - loss) / (1.0f - f * loss);
}

static void prepare_conductor_loss(const ty_material* material, float roughness, float mu, ty_bsdf* b)
{
    b->conductor_loss = ty_loss_table_row(material->conductor, roughness, 1.0f);
    float loss = b->conductor_loss.average, w = b->specular_weight;
    if (!(loss > 0.0f))
        return;
    float scale = b->metalness * ty_loss_row_at(&b->conductor_loss, mu) / (TY_PI * loss);
    ty_rgb f0 = b->color, f90 = b->specular_tint;
    b->conductor_gain = ty_rgb_make(scale * conductor_share(w * schlick_average(f0.r, f90.r), loss),
                                    scale * conductor_share(w * schlick_average(f0.g, f90.g), loss),
                                    scale * conductor_share(w * schlick_average(f0.b, f90.b), loss));
}

// Mean reflectance of a boundary to a denser medium (fit of Kulla & Conty 2017).
static float boundary_average(float n)
{
    return n > 1.0f ? (n - 1.0f) / (4.08567f + 1.00071f * n) : 0.0f;
}

// Share of what is lost on wo's side of a clear boundary that goes on beyond it. Reciprocal: what one side hands over
// in a uniform light is what the other hands back, t1 l1 = t2 n^2 l2 (Kulla & Conty 2017); 1 - the mean Fresnel
// reflectance where the losses are alike.
static float far_share(const ty_bsdf* b)
{
    float near = b->near_loss.average, far = b->far_loss.average, n = ty_max(b->eta, 1.0f / b->eta);
    float through = (1.0f - b->specular_weight * boundary_average(n)) * ty_min(near, far) / near;
    return b->eta >= 1.0f ? through : through / (n * n);
}

// Of a sheet both lobes are those of a reflection, so that it loses what a metal loses.
static void prepare_sheet_loss(const ty_material* material, float roughness, float mu, ty_bsdf* b)
{
    b->near_loss = b->far_loss = ty_loss_table_row(material->conductor, roughness, 1.0f);
    float loss = b->near_loss.average;
    if (!(loss > 0.0f))
        return;
    float f = b->specular_weight * boundary_average(b->eta), scale = ty_loss_row_at(&b->near_loss, mu);
    scale *= ty_surface_clear(b) / (TY_PI * loss);
    b->near_gain = scale * 2.0f * f / (1.0f + f);
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
    b->near_gain = scale * (1.0f - t) / (TY_PI * near);
    b->far_gain = far > 0.0f ? scale * t / (TY_PI * far) : 0.0f;
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
}

static void prepare_coat(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_surface_def* s = &material->surface;
    b->coat_weight = unit_input(&s->coat_weight, context, &b->point);
    if (b->coat_weight <= 0.0f)
        return;
    float roughness = unit_input(&s->coat_roughness, context, &b->point);
    b->coat_alpha = ty_ggx_alpha(roughness);
    b->coat_eta = s->coat_ior;
    b->coat_row = ty_albedo_table_row(material->coat, roughness, s->coat_ior);
}

// Roughness, index and what follows from them. b->outside is the index of what is around the body.
static void prepare_boundary(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_surface_def* s = &material->surface;
    const ty_surface_point* p = &b->point;
    float roughness = unit_input(&s->specular_roughness, context, p);
    float ior = ty_clamp(ty_input_float(&s->specular_ior, context, p), 1.0f, 3.0f);
    // Opaque bases keep the index of air: what lies beneath is coupled by a table for that.
    float relative = b->transmission_weight > 0.0f ? ior / b->outside : ior;
    b->eta = b->inside ? 1.0f / relative : relative;
    // Matched indices bend nothing, and a rough boundary would have no facet to speak of.
    if (fabsf(relative - 1.0f) < 0.001f && b->transmission_weight > 0.0f)
        b->alpha = ty_ggx_round(0.0f);
    else if (material->anisotropic)
        b->alpha = ty_ggx_alpha_stretched(roughness, unit_input(&s->specular_roughness_anisotropy, context, p));
    else
        b->alpha = ty_ggx_round(ty_ggx_alpha(roughness));
    if (!b->inside)
        b->specular_row = ty_albedo_table_row(material->specular, roughness, ior);
    // Stretching keeps the mean square of the slopes, and with it about what is lost.
    prepare_loss(material, roughness, b);
}

void ty_surface_prepare(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_surface_def* s = &material->surface;
    const ty_surface_point* p = &b->point;
    b->kind = TY_BSDF_SURFACE;
    b->thin = s->thin_walled;
    b->color = ty_clamp_color(ty_input_color(&s->base_color, context, p));
    if (material->emissive && b->entering)
        b->emission = ty_material_emission(material, context, p);
    b->specular_tint = ty_clamp_color(ty_input_color(&s->specular_color, context, p));
    b->metalness = unit_input(&s->base_metalness, context, p);
    b->specular_weight = unit_input(&s->specular_weight, context, p);
    prepare_transmission(s, context, b);
    prepare_diffuse(s, context, b);
    prepare_boundary(material, context, b);
    if (material->coat)
        prepare_coat(material, context, b);
    float mu = ty_dot(b->wo, b->frame.n), through = ty_surface_through_layers(b, mu);
    b->layers_passed = through / layer_average(b);
    choose_probabilities(b, mu, through);
}

ty_rgb ty_surface_albedo(const ty_bsdf* b)
{
    ty_rgb albedo[TY_LOBE_COUNT], sum = {0};
    float mu = ty_dot(b->wo, b->frame.n);
    lobe_albedos(b, mu, ty_surface_through_layers(b, mu), albedo);
    for (int i = 0; i < TY_LOBE_COUNT; i++)
        sum = ty_rgb_add(sum, albedo[i]);
    return sum;
}
