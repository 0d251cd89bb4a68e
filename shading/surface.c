// SPDX-License-Identifier: Apache-2.0
// `surface`: a coat over a mixture of metal, diffuse dielectric and transmitting dielectric.
#include "fresnel.h"
#include "lobes.h"
#include "material_private.h"
#include "microfacet.h"

enum
{
    LOBE_COAT,
    LOBE_SPECULAR,
    LOBE_DIFFUSE,
    LOBE_TRANSMISSION,
    LOBE_COUNT
};

static ty_rgb clamp_color(ty_rgb c)
{
    return ty_rgb_make(ty_clamp(c.r, 0, 1), ty_clamp(c.g, 0, 1), ty_clamp(c.b, 0, 1));
}

static float unit_input(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point)
{
    return ty_clamp(ty_input_float(input, context, point), 0.0f, 1.0f);
}

// Share the dielectric boundary reflects. A lowered specular weight cannot undo total reflection.
static float dielectric_share(const ty_bsdf* b, float cos_h)
{
    float f = ty_fresnel(cos_h, b->eta);
    return f < 1.0f ? f * b->specular_weight : 1.0f;
}

// Reflectance of the base's specular lobe at a facet.
static ty_rgb specular_reflectance(const ty_bsdf* b, float cos_h)
{
    float dielectric = (1.0f - b->metalness) * dielectric_share(b, cos_h);
    if (b->inside) // from within only the clear share of the base is a boundary
        dielectric *= b->transmission_weight;
    ty_rgb sum = ty_rgb_scale(b->specular_tint, dielectric);
    if (b->metalness > 0.0f)
    {
        ty_rgb metal = ty_fresnel_schlick(b->color, b->specular_tint, cos_h);
        sum = ty_rgb_add(sum, ty_rgb_scale(metal, b->metalness * b->specular_weight));
    }
    return sum;
}

static ty_rgb transmittance(const ty_bsdf* b, float cos_h)
{
    float share = (1.0f - b->metalness) * b->transmission_weight * (1.0f - dielectric_share(b, cos_h));
    return ty_rgb_scale(b->transmission, share);
}

// What the coat leaves to a specular lobe beneath. The smaller of both passages is reciprocal, exact for a mirror, and
// cannot create energy.
static float through_coat(const ty_bsdf* b, float mu_o, float mu_i)
{
    if (b->coat_weight <= 0.0f)
        return 1.0f;
    return 1.0f - ty_max(ty_coat_albedo(b, mu_o), ty_coat_albedo(b, mu_i));
}

static float base_share(const ty_bsdf* b, float mu)
{
    return b->specular_weight * ty_albedo_row_at(&b->specular_row, mu);
}

// What both layers let through to or from the base.
static float through_layers(const ty_bsdf* b, float mu)
{
    return (1.0f - ty_coat_albedo(b, mu)) * (1.0f - base_share(b, mu));
}

// Coupling of the Lambert base with the reflecting layers above it (Kelemen & Szirmay-Kalos 2001), with the average of
// both together: white stays white.
static float layer_average(const ty_bsdf* b)
{
    float coat = b->coat_weight * b->coat_row.average, base = b->specular_weight * b->specular_row.average,
          common = 0.0f;
    if (coat > 0.0f && base > 0.0f)
        common = b->coat_weight * b->specular_weight * ty_albedo_row_common(&b->coat_row, &b->specular_row);
    return 1.0f - coat - base + common;
}

static float diffuse_coupling(const ty_bsdf* b, float mu_o, float mu_i)
{
    return through_layers(b, mu_o) * through_layers(b, mu_i) / b->layer_average;
}

static float diffuse_weight(const ty_bsdf* b)
{
    return (1.0f - b->metalness) * (1.0f - b->transmission_weight);
}

// Directional albedo of the dielectric reflection, exact for mirrors.
static float dielectric_albedo(const ty_bsdf* b, float mu)
{
    if (b->alpha == 0.0f)
        return dielectric_share(b, mu);
    return b->inside ? ty_clamp(dielectric_share(b, mu), 0.1f, 0.9f) : base_share(b, mu);
}

// Albedos of the lobes seen from mu, as rgb.
static void lobe_albedos(const ty_bsdf* b, float mu, ty_rgb albedo[LOBE_COUNT])
{
    float coat = ty_coat_albedo(b, mu), left = 1.0f - coat, reflected = dielectric_albedo(b, mu);
    float clear = (1.0f - b->metalness) * b->transmission_weight;
    ty_rgb metal = ty_fresnel_schlick(b->color, b->specular_tint, mu);
    albedo[LOBE_COAT] = ty_rgb_grey(coat);
    albedo[LOBE_SPECULAR] =
        ty_rgb_scale(ty_rgb_add(ty_rgb_scale(b->specular_tint, (b->inside ? clear : 1.0f - b->metalness) * reflected),
                                ty_rgb_scale(metal, b->metalness * b->specular_weight)),
                     left);
    albedo[LOBE_DIFFUSE] = ty_rgb_scale(b->color, through_layers(b, mu) * diffuse_weight(b));
    albedo[LOBE_TRANSMISSION] = ty_rgb_scale(b->transmission, left * clear * (1.0f - reflected));
}

static void choose_probabilities(ty_bsdf* b, float mu)
{
    ty_rgb albedo[LOBE_COUNT];
    float sum = 0.0f;
    lobe_albedos(b, mu, albedo);
    for (int i = 0; i < LOBE_COUNT; i++)
    {
        b->lobe_probability[i] = (albedo[i].r + albedo[i].g + albedo[i].b) * (1.0f / 3.0f);
        sum += b->lobe_probability[i];
    }
    for (int i = 0; i < LOBE_COUNT && sum > 0.0f; i++)
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
    b->alpha = ior < 1.001f && b->transmission_weight > 0.0f ? 0.0f : ty_ggx_alpha(roughness);
    b->eta = b->inside ? 1.0f / ior : ior;
    if (!b->inside)
    {
        b->specular_row = ty_albedo_table_row(material->specular, roughness, ior);
        b->coat_weight = unit_input(&s->coat_weight, context, p);
        float coat_roughness = unit_input(&s->coat_roughness, context, p);
        b->coat_alpha = ty_ggx_alpha(coat_roughness);
        b->coat_eta = s->coat_ior;
        b->coat_row = ty_albedo_table_row(b->coat_weight > 0.0f ? material->coat : NULL, coat_roughness, s->coat_ior);
    }
    if (b->entering && ty_material_is_emissive(material))
        b->emission = ty_rgb_scale(ty_input_color(&s->emission_color, context, p),
                                   ty_max(ty_input_float(&s->emission_luminance, context, p), 0.0f));
    b->layer_average = layer_average(b);
    choose_probabilities(b, ty_dot(b->wo, b->frame.n));
}

bool ty_surface_is_delta(const ty_bsdf* b)
{
    const float* p = b->lobe_probability;
    return !(p[LOBE_DIFFUSE] > 0.0f || (p[LOBE_COAT] > 0.0f && b->coat_alpha > 0.0f) ||
             (b->alpha > 0.0f && p[LOBE_SPECULAR] + p[LOBE_TRANSMISSION] > 0.0f));
}

static ty_rgb eval_reflection(const ty_bsdf* b, ty_vec3 wo, ty_vec3 wi, float* pdf)
{
    const float* p = b->lobe_probability;
    ty_rgb f = {0};
    if (p[LOBE_COAT] > 0.0f && b->coat_alpha > 0.0f)
    {
        float coat_pdf;
        f = ty_coat_eval(b, wo, wi, &coat_pdf);
        *pdf += p[LOBE_COAT] * coat_pdf;
    }
    if (p[LOBE_SPECULAR] > 0.0f && b->alpha > 0.0f)
    {
        float lobe_pdf, cos_h, d = ty_ggx_reflect(wo, wi, b->alpha, &lobe_pdf, &cos_h);
        float scale = d * through_coat(b, wo.z, wi.z);
        f = ty_rgb_add(f, ty_rgb_scale(specular_reflectance(b, cos_h), scale));
        *pdf += p[LOBE_SPECULAR] * lobe_pdf;
    }
    if (p[LOBE_DIFFUSE] > 0.0f)
    {
        float k = diffuse_coupling(b, wo.z, wi.z) * diffuse_weight(b);
        f = ty_rgb_add(f, ty_rgb_scale(b->color, k * wi.z * TY_INV_PI));
        *pdf += p[LOBE_DIFFUSE] * wi.z * TY_INV_PI;
    }
    return f;
}

static ty_rgb eval_transmission(const ty_bsdf* b, ty_vec3 wo, ty_vec3 wi, float* pdf)
{
    if (b->alpha == 0.0f || b->lobe_probability[LOBE_TRANSMISSION] <= 0.0f)
        return ty_rgb_grey(0.0f);
    float lobe_pdf, cos_h, d = ty_ggx_refract(wo, wi, b->alpha, b->eta, &lobe_pdf, &cos_h);
    *pdf = b->lobe_probability[LOBE_TRANSMISSION] * lobe_pdf;
    return ty_rgb_scale(transmittance(b, cos_h), d * (1.0f - ty_coat_albedo(b, wo.z)));
}

ty_rgb ty_surface_eval(const ty_bsdf* b, ty_vec3 wo, ty_vec3 wi, float* pdf)
{
    *pdf = 0.0f;
    if (wi.z > 0.0f)
        return eval_reflection(b, wo, wi, pdf);
    return wi.z < 0.0f ? eval_transmission(b, wo, wi, pdf) : ty_rgb_grey(0.0f);
}

// A mirror-like lobe was chosen. False = nothing goes there.
static bool sample_delta(const ty_bsdf* b, ty_vec3 wo, int lobe, ty_bsdf_sample* out)
{
    float probability = b->lobe_probability[lobe];
    *out = (ty_bsdf_sample){.wi = ty_vec3_make(-wo.x, -wo.y, wo.z), .delta = true};
    if (lobe == LOBE_COAT)
        out->weight = ty_rgb_grey(b->coat_weight * ty_fresnel(wo.z, b->coat_eta) / probability);
    else if (lobe == LOBE_SPECULAR)
        out->weight = ty_rgb_scale(specular_reflectance(b, wo.z), through_coat(b, wo.z, wo.z) / probability);
    else
    {
        if (!ty_refract(wo, ty_vec3_make(0, 0, 1), b->eta, &out->wi))
            return false;
        out->transmitted = true;
        out->weight = ty_rgb_scale(transmittance(b, wo.z), (1.0f - ty_coat_albedo(b, wo.z)) / probability);
    }
    return true;
}

// A direction of a lobe that is no mirror, or z = 0 where the facet sends it nowhere.
static ty_vec3 sample_lobe(const ty_bsdf* b, ty_vec3 wo, int lobe, ty_vec2 u)
{
    if (lobe == LOBE_DIFFUSE)
        return ty_sample_cosine(u);
    ty_vec3 h = ty_ggx_sample(wo, lobe == LOBE_COAT ? b->coat_alpha : b->alpha, u), wi;
    if (lobe != LOBE_TRANSMISSION)
    {
        wi = ty_reflect(wo, h);
        return wi.z > 0.0f ? wi : (ty_vec3){0};
    }
    return ty_refract(wo, h, b->eta, &wi) && wi.z < 0.0f ? wi : (ty_vec3){0};
}

bool ty_surface_sample(const ty_bsdf* b, ty_vec3 wo, float u_lobe, ty_vec2 u, ty_bsdf_sample* out)
{
    int lobe = -1;
    for (int i = 0; i < LOBE_COUNT; i++)
    {
        if (b->lobe_probability[i] <= 0.0f)
            continue;
        lobe = i;
        if (u_lobe < b->lobe_probability[i])
            break;
        u_lobe -= b->lobe_probability[i];
    }
    if (lobe < 0)
        return false;
    if ((lobe == LOBE_COAT && b->coat_alpha == 0.0f) || (lobe % 2 == 1 && b->alpha == 0.0f))
        return sample_delta(b, wo, lobe, out);
    *out = (ty_bsdf_sample){.wi = sample_lobe(b, wo, lobe, u), .transmitted = lobe == LOBE_TRANSMISSION};
    if (out->wi.z == 0.0f)
        return false;
    ty_rgb f = ty_surface_eval(b, wo, out->wi, &out->pdf);
    if (out->pdf <= 0.0f)
        return false;
    out->weight = ty_rgb_scale(f, 1.0f / out->pdf);
    return true;
}

ty_rgb ty_surface_albedo(const ty_bsdf* b)
{
    ty_rgb albedo[LOBE_COUNT], sum = {0};
    lobe_albedos(b, ty_dot(b->wo, b->frame.n), albedo);
    for (int i = 0; i < LOBE_COUNT; i++)
        sum = ty_rgb_add(sum, albedo[i]);
    return sum;
}
