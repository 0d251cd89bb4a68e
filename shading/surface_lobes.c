// SPDX-License-Identifier: Apache-2.0
// `surface`: evaluation and sampling of its lobes.
#include "diffuse.h"
#include "fresnel.h"
#include "fuzz.h"
#include "material_private.h"
#include "microfacet.h"
#include "surface_private.h"

// From within, the inner side of the layers sends back a part of what the boundary lets out: of f, the share that
// reaches the outside all the same.
static float sent_back(const ty_bsdf* b, float cos_h)
{
    if (!b->inside || !(b->coat_weight > 0.0f || b->fuzz_weight > 0.0f))
        return 0.0f;
    float outside = ty_safe_sqrt(1.0f - (1.0f - cos_h * cos_h) / (b->eta * b->eta));
    return 1.0f - ty_layers_left(b, outside);
}

float ty_surface_boundary(const ty_bsdf* b, float cos_h)
{
    float f = ty_fresnel_weighted(cos_h, b->eta, b->shine);
    return f < 1.0f ? f + (1.0f - f) * sent_back(b, cos_h) : f;
}

// A boundary reflects alike on both sides where light is refracted from one into the other, with a film on it, too.
static ty_rgb film_boundary(const ty_bsdf* b, float cos_h)
{
    float sine_sqr = (1.0f - cos_h * cos_h) / (b->eta * b->eta);
    if (b->eta < 1.0f && sine_sqr >= 1.0f)
        return ty_rgb_grey(1.0f);
    return b->inside ? ty_thin_film_over_dielectric(&b->film, ty_safe_sqrt(1.0f - sine_sqr), 1.0f / b->shine)
                     : ty_thin_film_over_dielectric(&b->film, cos_h, b->shine);
}

ty_rgb ty_surface_boundary_color(const ty_bsdf* b, float cos_h)
{
    if (!(b->film.weight > 0.0f))
        return ty_rgb_grey(ty_surface_boundary(b, cos_h));
    ty_rgb f = film_boundary(b, cos_h);
    return ty_rgb_lerp(f, ty_rgb_grey(1.0f), sent_back(b, cos_h));
}

ty_rgb ty_surface_metal(const ty_bsdf* b, float cos_h)
{
    ty_rgb f = ty_metal_fresnel(b->color, b->metal_dip, cos_h);
    return b->film.weight > 0.0f ? ty_thin_film_over_metal(&b->film, cos_h, f) : f;
}

// All orders of reflection between its sides.
static float sheet_transmits(float f, float c)
{
    float back = c * f;
    return f < 1.0f ? c * ty_sqr(1.0f - f) / (1.0f - back * back) : 0.0f;
}

ty_sheet ty_surface_sheet(const ty_bsdf* b, float cos_h)
{
    ty_rgb f = ty_surface_boundary_color(b, cos_h), c = b->transmission;
    if (b->film.weight > 0.0f && b->shine == 1.0f) // nothing but the film
        return (ty_sheet){.reflected = f, .transmitted = {c.r * (1.0f - f.r), c.g * (1.0f - f.g), c.b * (1.0f - f.b)}};
    ty_rgb t = {sheet_transmits(f.r, c.r), sheet_transmits(f.g, c.g), sheet_transmits(f.b, c.b)};
    return (ty_sheet){.reflected = {f.r + f.r * c.r * t.r, f.g + f.g * c.g * t.g, f.b + f.b * c.b * t.b},
                      .transmitted = t};
}

static ty_rgb dielectric_reflectance(const ty_bsdf* b, float cos_h)
{
    ty_rgb f = ty_surface_boundary_color(b, cos_h);
    float opaque = ty_surface_diffuse(b);
    if (b->thin && b->transmission_weight > 0.0f)
        return ty_rgb_add(ty_rgb_scale(ty_surface_sheet(b, cos_h).reflected, ty_surface_clear(b)),
                          ty_rgb_scale(f, opaque));
    // From within only the clear share of the base is a boundary.
    return ty_rgb_scale(f, (1.0f - b->metalness) * (b->inside ? b->transmission_weight : 1.0f));
}

ty_rgb ty_surface_reflectance(const ty_bsdf* b, float cos_h)
{
    ty_rgb sum = ty_rgb_mul(b->specular_tint, dielectric_reflectance(b, cos_h));
    if (b->metalness > 0.0f)
        sum = ty_rgb_add(sum, ty_rgb_mul(ty_surface_metal(b, cos_h), b->metal));
    return sum;
}

// The boundary's alone: the coat takes its part where the light is outside.
ty_rgb ty_surface_transmittance(const ty_bsdf* b, float cos_h)
{
    if (b->thin)
        return ty_rgb_scale(ty_surface_sheet(b, cos_h).transmitted, ty_surface_clear(b));
    if (b->film.weight > 0.0f)
    {
        ty_rgb f = film_boundary(b, cos_h), left = {1.0f - f.r, 1.0f - f.g, 1.0f - f.b};
        return ty_rgb_scale(ty_rgb_mul(b->transmission, left), ty_surface_clear(b));
    }
    float f = ty_fresnel_weighted(cos_h, b->eta, b->shine);
    return ty_rgb_scale(b->transmission, ty_surface_clear(b) * (1.0f - f));
}

// factor: what both directions have in common.
static ty_rgb diffuse_coupling(const ty_bsdf* b, ty_rgb factor, float mu_i)
{
    if (b->film_row.count == 0)
        return ty_rgb_scale(factor, b->diffuse_gain * ty_layers_diffuse(b, mu_i));
    return ty_rgb_mul(factor, ty_rgb_mul(b->film_gain, ty_layers_diffuse_color(b, mu_i)));
}

bool ty_surface_is_delta(const ty_bsdf* b)
{
    const float* p = b->lobe_probability;
    return !(p[TY_LOBE_DIFFUSE] + p[TY_LOBE_LOST_ABOVE] + p[TY_LOBE_DIFFUSE_BELOW] + p[TY_LOBE_FUZZ] > 0.0f ||
             (p[TY_LOBE_COAT] > 0.0f && b->coat_alpha > 0.0f) ||
             (b->alpha.x > 0.0f && p[TY_LOBE_SPECULAR] + p[TY_LOBE_TRANSMISSION] > 0.0f));
}

// The row by which what is lost above is sampled.
static const ty_loss_row* row_above(const ty_bsdf* b)
{
    return b->conductor_loss.slice ? &b->conductor_loss : &b->near_loss;
}

// f of what the facets pass on among themselves and reflect in the end.
static ty_rgb lost_reflectance(const ty_bsdf* b, float mu_o, float mu_i)
{
    float near = b->near_gain > 0.0f ? b->near_gain * ty_layers_clear(b, mu_i) : 0.0f;
    ty_rgb metal = b->metalness > 0.0f ? ty_rgb_scale(b->conductor_gain, ty_layers_metal(b, mu_i)) : ty_rgb_grey(0.0f);
    return ty_rgb_mul(ty_rgb_add(metal, ty_rgb_scale(b->specular_tint, near)), ty_layers_tint(b, mu_o, mu_i));
}

// Probability that a facet of a rough boundary was chosen and reflects. Where the base is clear the facet is drawn
// first and decides between reflection and refraction itself.
static float facet_reflects(const ty_bsdf* b, float cos_h)
{
    const float* p = b->lobe_probability;
    if (!(p[TY_LOBE_TRANSMISSION] > 0.0f))
        return p[TY_LOBE_SPECULAR];
    ty_rgb r = ty_surface_reflectance(b, cos_h), t = ty_surface_transmittance(b, cos_h);
    float up = r.r + r.g + r.b, down = t.r + t.g + t.b;
    return up > 0.0f ? (p[TY_LOBE_SPECULAR] + p[TY_LOBE_TRANSMISSION]) * (up / (up + down)) : 0.0f;
}

static float facet_transmits(const ty_bsdf* b, float cos_h)
{
    const float* p = b->lobe_probability;
    return p[TY_LOBE_SPECULAR] + p[TY_LOBE_TRANSMISSION] - facet_reflects(b, cos_h);
}

ty_rgb ty_surface_eval_diffuse(const ty_bsdf* b, ty_vec3 wo, ty_vec3 wi, float* pdf)
{
    *pdf = 0.0f;
    if (!(b->lobe_probability[TY_LOBE_DIFFUSE] > 0.0f) || !(wi.z > 0.0f))
        return ty_rgb_grey(0.0f);
    *pdf = b->lobe_probability[TY_LOBE_DIFFUSE] * wi.z * TY_INV_PI;
    ty_rgb f = ty_diffuse_value(b->diffuse, b->diffuse_roughness, wo, wi);
    if (b->excessive)
    {
        float excess = b->diffuse_excess + ty_diffuse_excess(b->diffuse_roughness, b->diffuse_left, wi.z);
        f = ty_rgb_add(f, ty_rgb_scale(b->diffuse, -excess * TY_INV_PI));
    }
    f = diffuse_coupling(b, ty_rgb_scale(f, ty_surface_diffuse(b) * wi.z), wi.z);
    return b->tinted && b->layered ? ty_rgb_mul(f, ty_layers_tint(b, wo.z, wi.z)) : f;
}

// Between the base's frame and that of the coat.
static ty_vec3 turned(const ty_bsdf* b, ty_vec3 w, float sine)
{
    return ty_vec3_make(b->coat_cosine * w.x + sine * w.y, b->coat_cosine * w.y - sine * w.x, w.z);
}

static ty_rgb eval_coat(const ty_bsdf* b, ty_vec3 wo, ty_vec3 wi, float* pdf)
{
    if (!b->coat_stretched)
        return ty_coat_eval(b, wo, wi, pdf);
    float cos_h,
        d = ty_ggx_reflect(turned(b, wo, b->coat_sine), turned(b, wi, b->coat_sine), b->coat_stretch, pdf, &cos_h);
    return ty_rgb_grey(b->coat_weight * ty_fresnel(cos_h, b->coat_eta) * d);
}

static ty_vec3 sample_coat(const ty_bsdf* b, ty_vec3 wo, ty_vec2 u)
{
    ty_vec3 h = b->coat_stretched
                    ? turned(b, ty_ggx_sample(turned(b, wo, b->coat_sine), b->coat_stretch, u), -b->coat_sine)
                    : ty_ggx_sample(wo, ty_ggx_round(b->coat_alpha), u);
    ty_vec3 wi = ty_reflect(wo, h);
    return wi.z > 0.0f ? wi : (ty_vec3){0};
}

static ty_rgb eval_reflection(const ty_bsdf* b, ty_vec3 wo, ty_vec3 wi, float* pdf)
{
    const float* p = b->lobe_probability;
    ty_rgb f = {0};
    if (p[TY_LOBE_COAT] > 0.0f && b->coat_alpha > 0.0f)
    {
        float coat_pdf;
        f = ty_rgb_scale(eval_coat(b, wo, wi, &coat_pdf), ty_layers_over_coat(b, wo.z, wi.z));
        *pdf += p[TY_LOBE_COAT] * coat_pdf;
    }
    if (p[TY_LOBE_FUZZ] > 0.0f)
    {
        float fuzz = b->fuzz_weight * wi.z * ty_fuzz_value(b->fuzz_roughness, wo, wi);
        f = ty_rgb_add(f, ty_rgb_scale(b->fuzz_color, fuzz));
        *pdf += p[TY_LOBE_FUZZ] * 0.5f * TY_INV_PI;
    }
    if (p[TY_LOBE_SPECULAR] + p[TY_LOBE_TRANSMISSION] > 0.0f && b->alpha.x > 0.0f)
    {
        float lobe_pdf, cos_h, d = ty_ggx_reflect(wo, wi, b->alpha, &lobe_pdf, &cos_h);
        ty_rgb kept = ty_rgb_scale(ty_layers_over_base(b, wo.z, wi.z), d);
        f = ty_rgb_add(f, ty_rgb_mul(ty_surface_reflectance(b, cos_h), kept));
        *pdf += facet_reflects(b, cos_h) * lobe_pdf;
    }
    if (p[TY_LOBE_DIFFUSE] > 0.0f)
    {
        float diffuse_pdf;
        f = ty_rgb_add(f, ty_surface_eval_diffuse(b, wo, wi, &diffuse_pdf));
        *pdf += diffuse_pdf;
    }
    if (p[TY_LOBE_LOST_ABOVE] > 0.0f)
    {
        f = ty_rgb_add(f, ty_rgb_scale(lost_reflectance(b, wo.z, wi.z), wi.z));
        *pdf += p[TY_LOBE_LOST_ABOVE] * ty_loss_row_pdf(row_above(b), wi.z);
    }
    return f;
}

// Through a sheet goes what a reflection would send up.
static float transmit(const ty_bsdf* b, ty_vec3 wo, ty_vec3 wi, float* pdf, float* cos_h)
{
    if (!b->thin)
        return ty_ggx_refract(wo, wi, b->alpha, b->eta, pdf, cos_h);
    return ty_ggx_reflect(wo, ty_vec3_make(wi.x, wi.y, -wi.z), b->alpha, pdf, cos_h);
}

static ty_rgb eval_transmission(const ty_bsdf* b, ty_vec3 wo, ty_vec3 wi, float* pdf)
{
    const float* p = b->lobe_probability;
    ty_rgb kept = ty_layers_across(b, wo.z, -wi.z), f = {0};
    if (p[TY_LOBE_TRANSMISSION] > 0.0f && b->alpha.x > 0.0f)
    {
        float lobe_pdf, cos_h, d = transmit(b, wo, wi, &lobe_pdf, &cos_h);
        f = ty_rgb_mul(ty_surface_transmittance(b, cos_h), ty_rgb_scale(kept, d));
        *pdf += facet_transmits(b, cos_h) * lobe_pdf;
    }
    if (p[TY_LOBE_LOST_BELOW] > 0.0f)
    {
        float lost = b->far_gain * ty_loss_row_at(&b->far_loss, -wi.z) * -wi.z;
        f = ty_rgb_add(f, ty_rgb_mul(b->transmission, ty_rgb_scale(kept, lost)));
        *pdf += p[TY_LOBE_LOST_BELOW] * ty_loss_row_pdf(&b->far_loss, -wi.z);
    }
    if (p[TY_LOBE_DIFFUSE_BELOW] > 0.0f)
    {
        ty_rgb below = ty_rgb_scale(b->diffuse_below, ty_surface_diffuse(b) * -wi.z * TY_INV_PI);
        f = ty_rgb_add(f, diffuse_coupling(b, below, -wi.z));
        *pdf += p[TY_LOBE_DIFFUSE_BELOW] * -wi.z * TY_INV_PI;
    }
    return f;
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
    *out = (ty_bsdf_sample){.wi = ty_vec3_make(-wo.x, -wo.y, wo.z), .delta = true, .kind = TY_MASK_GLOSSY};
    if (lobe == TY_LOBE_COAT)
        out->weight = ty_rgb_grey(ty_layers_over_coat(b, wo.z, wo.z) * b->coat_weight * ty_fresnel(wo.z, b->coat_eta) /
                                  probability);
    else if (lobe == TY_LOBE_SPECULAR)
        out->weight = ty_rgb_mul(ty_surface_reflectance(b, wo.z),
                                 ty_rgb_scale(ty_layers_over_base(b, wo.z, wo.z), 1.0f / probability));
    else
    {
        if (!ty_refract(wo, ty_vec3_make(0, 0, 1), b->eta, &out->wi))
            return false;
        out->transmitted = true;
        out->kind = TY_MASK_TRANSMISSION;
        ty_rgb kept = ty_layers_across(b, wo.z, -out->wi.z);
        out->weight = ty_rgb_mul(ty_surface_transmittance(b, wo.z), ty_rgb_scale(kept, 1.0f / probability));
    }
    return true;
}

static ty_vec3 around_normal(float mu, float turn)
{
    float sine, cosine, radius = ty_safe_sqrt(1.0f - mu * mu);
    ty_sincos(2.0f * TY_PI * turn, &sine, &cosine);
    return ty_vec3_make(radius * cosine, radius * sine, mu);
}

// A facet of the base's boundary: reflects or refracts. u_share: where in the choice of both lobes the number lay.
static ty_vec3 sample_boundary(const ty_bsdf* b, ty_vec3 wo, float u_share, ty_vec2 u)
{
    const float* p = b->lobe_probability;
    ty_vec3 h = ty_ggx_sample(wo, b->alpha, u), wi;
    if (u_share < facet_reflects(b, ty_dot(wo, h)) || !(p[TY_LOBE_TRANSMISSION] > 0.0f))
    {
        wi = ty_reflect(wo, h);
        return wi.z > 0.0f ? wi : (ty_vec3){0};
    }
    if (b->thin)
    {
        wi = ty_reflect(wo, h);
        return wi.z > 0.0f ? ty_vec3_make(wi.x, wi.y, -wi.z) : (ty_vec3){0};
    }
    return ty_refract(wo, h, b->eta, &wi) && wi.z < 0.0f ? wi : (ty_vec3){0};
}

// A direction of a lobe that is no mirror, or z = 0 where the facet sends it nowhere.
static ty_vec3 sample_lobe(const ty_bsdf* b, ty_vec3 wo, int lobe, float u_rest, ty_vec2 u)
{
    switch ((ty_surface_lobe)lobe)
    {
    case TY_LOBE_COAT:
        return sample_coat(b, wo, u);
    case TY_LOBE_SPECULAR:
        return sample_boundary(b, wo, u_rest, u);
    case TY_LOBE_TRANSMISSION:
        return sample_boundary(b, wo, b->lobe_probability[TY_LOBE_SPECULAR] + u_rest, u);
    case TY_LOBE_LOST_ABOVE:
        return around_normal(ty_loss_row_sample(row_above(b), u.x), u.y);
    case TY_LOBE_LOST_BELOW:
        return ty_neg(around_normal(ty_loss_row_sample(&b->far_loss, u.x), u.y));
    case TY_LOBE_DIFFUSE_BELOW:
        return ty_neg(ty_sample_cosine(u));
    case TY_LOBE_FUZZ: // even: fibres send light everywhere
        return around_normal(ty_max(1.0f - u.x, 1e-6f), u.y);
    case TY_LOBE_DIFFUSE:
    case TY_LOBE_COUNT:
        break;
    }
    return ty_sample_cosine(u);
}

bool ty_surface_sample(const ty_bsdf* b, ty_vec3 wo, float u_lobe, ty_vec2 u, ty_bsdf_sample* out)
{
    int lobe = -1;
    for (int i = 0; i < TY_LOBE_COUNT; i++)
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
    bool boundary = lobe == TY_LOBE_SPECULAR || lobe == TY_LOBE_TRANSMISSION;
    if ((lobe == TY_LOBE_COAT && b->coat_alpha == 0.0f) || (boundary && b->alpha.x == 0.0f))
        return sample_delta(b, wo, lobe, out);
    *out = (ty_bsdf_sample){.wi = sample_lobe(b, wo, lobe, u_lobe, u)};
    out->transmitted = out->wi.z < 0.0f;
    out->kind = out->transmitted ? TY_MASK_TRANSMISSION : lobe == TY_LOBE_DIFFUSE ? TY_MASK_DIFFUSE : TY_MASK_GLOSSY;
    if (out->wi.z == 0.0f)
        return false;
    ty_rgb f = ty_surface_eval(b, wo, out->wi, &out->pdf);
    if (out->pdf <= 0.0f)
        return false;
    out->weight = ty_rgb_scale(f, 1.0f / out->pdf);
    return true;
}
