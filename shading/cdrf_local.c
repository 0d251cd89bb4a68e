// SPDX-License-Identifier: Apache-2.0
// `evaluate: local`: the kernel's response at the point itself, over the whole sphere of directions, under the coat.
#include "curvature_at.h"
#include "lobes.h"
#include "material_private.h"
#include <tsuya/shading/cdrf.h>

enum
{
    LOBE_COAT,
    LOBE_COSINE,
    LOBE_UNIFORM,
};

float ty_local_curvature(const ty_bsdf* b, ty_vec3 wi)
{
    int which = b->material->cdrf.curvature;
    if (which == TY_CDRF_CURVATURE_MEAN || which == TY_CDRF_CURVATURE_MAXIMAL)
        return ty_max(b->curvature, 0.0f);
    const float* f = b->second_form;
    return ty_max(ty_form_towards((ty_form){f[0], f[1], f[2]}, wi.x, wi.y), 0.0f);
}

// Share of the response below the horizon: mean over the two principal directions, so that neither is starved, and over
// the channels.
static float share_below(const ty_bsdf* b)
{
    const float* f = b->second_form;
    ty_form form = {f[0], f[1], f[2]};
    float mean = ty_form_mean(form), high = ty_form_maximum(form), low = 2.0f * mean - high;
    int which = b->material->cdrf.curvature, count = b->grey ? 1 : 3;
    if (which == TY_CDRF_CURVATURE_MEAN || which == TY_CDRF_CURVATURE_MAXIMAL)
        high = low = b->curvature;
    int kernel = b->material->cdrf.kernel;
    float sum = 0.0f;
    for (int i = 0; i < count; i++)
        sum += ty_cdrf_spread_below(kernel, ty_cdrf_spread(b, high, i)) +
               ty_cdrf_spread_below(kernel, ty_cdrf_spread(b, low, i));
    return 0.5f * sum / (float)count;
}

void ty_local_prepare(const ty_shading_context* context, ty_bsdf* b)
{
    ty_form form = {0};
    if (context && context->world && b->entering)
        form = ty_form_world(context->world, &b->point, b->frame.t, b->frame.b);
    b->second_form[0] = form.tt;
    b->second_form[1] = form.tb;
    b->second_form[2] = form.bb;
    b->curvature =
        b->material->cdrf.curvature == TY_CDRF_CURVATURE_MAXIMAL ? ty_form_maximum(form) : ty_form_mean(form);
    float coat = ty_coat_albedo(b, ty_dot(b->wo, b->frame.n));
    float p_coat = b->coat_weight > 0.0f ? ty_clamp(coat, 0.25f, 0.9f) : 0.0f;
    float uniform = ty_min(2.0f * share_below(b), 1.0f);
    b->lobe_probability[LOBE_COAT] = p_coat;
    b->lobe_probability[LOBE_COSINE] = (1.0f - p_coat) * (1.0f - uniform);
    b->lobe_probability[LOBE_UNIFORM] = (1.0f - p_coat) * uniform;
}

static float response_of(const ty_bsdf* b, float spread, float cosine)
{
    switch (b->material->cdrf.kernel)
    {
    case TY_CDRF_POISSON:
        return ty_poisson_table_at(b->material->poisson, spread, cosine);
    case TY_CDRF_GAUSSIAN:
        return ty_cdrf_gaussian_cos(spread, cosine) * (TY_PI / ty_cdrf_gaussian_integral(spread));
    default:
        return ty_cdrf_gaussian_cos(spread, cosine);
    }
}

// Response to light from wi where a lit Lambert point is 1; integral over the sphere pi (published: I).
static ty_rgb response(const ty_bsdf* b, ty_vec3 wi)
{
    float spread[3];
    if (ty_cdrf_spreads(b, ty_local_curvature(b, wi), spread))
        return ty_rgb_grey(response_of(b, spread[0], wi.z));
    return ty_rgb_make(response_of(b, spread[0], wi.z), response_of(b, spread[1], wi.z),
                       response_of(b, spread[2], wi.z));
}

// Refraction on the way in is left at its average: with it inside the convolution the furnace would need a normaliser
// for each roughness, index and spread.
ty_rgb ty_local_eval_diffuse(const ty_bsdf* b, ty_vec3 wo, ty_vec3 wi, float* pdf)
{
    const float* p = b->lobe_probability;
    *pdf = p[LOBE_COSINE] * ty_max(wi.z, 0.0f) * TY_INV_PI + p[LOBE_UNIFORM] * (0.25f * TY_INV_PI);
    ty_rgb color = ty_rgb_scale(b->color, (1.0f - ty_coat_albedo(b, wo.z)) * TY_INV_PI);
    return ty_rgb_mul(color, response(b, wi));
}

ty_rgb ty_local_eval(const ty_bsdf* b, ty_vec3 wo, ty_vec3 wi, float* pdf)
{
    float interior_pdf, coat_pdf;
    ty_rgb interior = ty_local_eval_diffuse(b, wo, wi, &interior_pdf);
    if (b->coat_weight <= 0.0f)
    {
        *pdf = interior_pdf;
        return interior;
    }
    ty_rgb f = ty_rgb_add(interior, ty_coat_eval(b, wo, wi, &coat_pdf));
    *pdf = b->lobe_probability[LOBE_COAT] * coat_pdf + interior_pdf;
    return f;
}

bool ty_local_sample(const ty_bsdf* b, ty_vec3 wo, float u_lobe, ty_vec2 u, ty_bsdf_sample* out)
{
    const float* p = b->lobe_probability;
    if (u_lobe < p[LOBE_COAT])
    {
        if (!ty_coat_sample(b, wo, u, out))
            return false;
        if (out->delta)
        {
            out->weight = ty_rgb_scale(out->weight, 1.0f / p[LOBE_COAT]);
            return true;
        }
    }
    else
    {
        bool cosine = u_lobe < p[LOBE_COAT] + p[LOBE_COSINE];
        *out = (ty_bsdf_sample){.wi = cosine ? ty_sample_cosine(u) : ty_sample_sphere(u), .kind = TY_MASK_DIFFUSE};
    }
    ty_rgb f = ty_local_eval(b, wo, out->wi, &out->pdf);
    if (out->pdf <= 0.0f)
        return false;
    out->weight = ty_rgb_scale(f, 1.0f / out->pdf);
    return true;
}
