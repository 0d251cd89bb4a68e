// SPDX-License-Identifier: Apache-2.0
// `surface`: a coat over a mixture of metal, diffuse dielectric and transmitting dielectric. Preparation at a point.
#include "fresnel.h"
#include "material_private.h"
#include "microfacet.h"
#include "surface_private.h"

static ty_rgb clamp_color(ty_rgb c)
{
    return ty_rgb_make(ty_clamp(c.r, 0, 1), ty_clamp(c.g, 0, 1), ty_clamp(c.b, 0, 1));
}

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

// Directional albedo of the dielectric reflection, exact for mirrors.
static float dielectric_albedo(const ty_bsdf* b, float mu)
{
    float share = ty_surface_boundary(b, mu);
    if (b->alpha.x == 0.0f)
        return share;
    return b->inside ? ty_clamp(share, 0.1f, 0.9f) : b->specular_weight * ty_albedo_row_at(&b->specular_row, mu);
}

// Albedos of the lobes seen from mu, as rgb.
static void lobe_albedos(const ty_bsdf* b, float mu, ty_rgb albedo[TY_LOBE_COUNT])
{
    float coat = b->inside ? 0.0f : ty_coat_albedo(b, mu), left = 1.0f - coat, reflected = dielectric_albedo(b, mu);
    float clear = ty_surface_clear(b);
    ty_rgb metal = ty_fresnel_schlick(b->color, b->specular_tint, mu);
    ty_rgb near = ty_rgb_scale(b->specular_tint, b->near_gain * TY_PI * b->near_loss.average);
    ty_rgb far = ty_rgb_scale(b->transmission, b->far_gain * TY_PI * b->far_loss.average);
    ty_rgb metal_lost = ty_rgb_scale(b->conductor_gain, TY_PI * b->conductor_loss.average);
    albedo[TY_LOBE_COAT] = ty_rgb_grey(coat);
    albedo[TY_LOBE_SPECULAR] =
        ty_rgb_scale(ty_rgb_add(ty_rgb_scale(b->specular_tint, (b->inside ? clear : 1.0f - b->metalness) * reflected),
                                ty_rgb_scale(metal, b->metalness * b->specular_weight)),
                     left);
    albedo[TY_LOBE_DIFFUSE] = ty_rgb_scale(b->color, ty_surface_through_layers(b, mu) * ty_surface_diffuse(b));
    albedo[TY_LOBE_TRANSMISSION] = ty_rgb_scale(b->transmission, left * clear * (1.0f - reflected));
    albedo[TY_LOBE_LOST_ABOVE] = ty_rgb_scale(ty_rgb_add(metal_lost, near), left);
    albedo[TY_LOBE_LOST_BELOW] = ty_rgb_scale(far, left);
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
}

static void prepare_transmission(const ty_surface_def* s, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_surface_point* p = &b->point;
    b->transmission_weight = unit_input(&s->transmission_weight, context, p);
    if (b->transmission_weight <= 0.0f || b->metalness >= 1.0f)
        return;
    b->inside = !b->entering;
    ty_rgb tint = clamp_color(ty_input_color(&s->transmission_color, context, p));
    if (s->transmission_depth <= 0.0f)
    {
        b->transmission = tint;
        return;
    }
    const float blackest = 1e-6f;
    float per_m = -1.0f / s->transmission_depth;
    b->transmission = ty_rgb_grey(1.0f);
    b->absorption = ty_rgb_make(per_m * ty_ln(ty_max(tint.r, blackest)), per_m * ty_ln(ty_max(tint.g, blackest)),
                                per_m * ty_ln(ty_max(tint.b, blackest)));
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

// Share of what is lost on wo's side of a clear boundary that goes on beyond it. Reciprocal: what one side hands over
// in a uniform light is what the other hands back, t1 l1 = t2 n^2 l2 (Kulla & Conty 2017); 1 - the mean Fresnel
// reflectance where the losses are alike.
static float far_share(const ty_bsdf* b)
{
    float near = b->near_loss.average, far = b->far_loss.average, n = ty_max(b->eta, 1.0f / b->eta);
    float through = 1.0f - b->specular_weight * (n - 1.0f) / (4.08567f + 1.00071f * n);
    through *= ty_min(near, far) / near;
    return b->eta >= 1.0f ? through : through / (n * n);
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
    if (ty_surface_clear(b) > 0.0f)
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

void ty_surface_prepare(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_surface_def* s = &material->surface;
    const ty_surface_point* p = &b->point;
    b->kind = TY_BSDF_SURFACE;
    b->color = clamp_color(ty_input_color(&s->base_color, context, p));
    b->specular_tint = clamp_color(ty_input_color(&s->specular_color, context, p));
    b->metalness = unit_input(&s->base_metalness, context, p);
    b->specular_weight = unit_input(&s->specular_weight, context, p);
    prepare_transmission(s, context, b);
    float roughness = unit_input(&s->specular_roughness, context, p);
    float ior = ty_clamp(ty_input_float(&s->specular_ior, context, p), 1.0f, 3.0f);
    // Matched indices bend nothing, and a rough boundary would have no facet to speak of.
    b->alpha = ty_ggx_round(ior < 1.001f && b->transmission_weight > 0.0f ? 0.0f : ty_ggx_alpha(roughness));
    b->eta = b->inside ? 1.0f / ior : ior;
    if (!b->inside)
        b->specular_row = ty_albedo_table_row(material->specular, roughness, ior);
    if (material->coat)
        prepare_coat(material, context, b);
    prepare_loss(material, roughness, b);
    if (b->entering)
        b->emission = ty_material_emission(material, context, p);
    b->layer_average = layer_average(b);
    choose_probabilities(b, ty_dot(b->wo, b->frame.n));
}

ty_rgb ty_surface_albedo(const ty_bsdf* b)
{
    ty_rgb albedo[TY_LOBE_COUNT], sum = {0};
    lobe_albedos(b, ty_dot(b->wo, b->frame.n), albedo);
    for (int i = 0; i < TY_LOBE_COUNT; i++)
        sum = ty_rgb_add(sum, albedo[i]);
    return sum;
}
