// SPDX-License-Identifier: Apache-2.0
// `cdrf`: preparation, the choice between coat and interior, and the lobes after that choice.
#include "curvature_at.h"
#include "fresnel.h"
#include "lobes.h"
#include "material_private.h"
#include "microfacet.h"
#include <tsuya/shading/cdrf.h>

static ty_moisture_optics optics_at(const ty_material* m, const ty_shading_context* context, const ty_surface_point* p)
{
    if (m->optics_are_constant)
        return m->optics;
    return ty_moisture_law_at(&m->cdrf.calibration, ty_moisture_at(&m->cdrf.moisture, context, p));
}

static void prepare_coat(const ty_material* material, const ty_shading_context* context,
                         const ty_moisture_optics* optics, ty_bsdf* b)
{
    const ty_cdrf_def* d = &material->cdrf;
    if (!material->coat)
        return;
    float roughness = ty_input_float(&d->specular_roughness, context, &b->point);
    roughness = roughness < 0.0f ? optics->roughness : ty_min(roughness, 1.0f);
    // A dry surface is dusty and broken: half its area shines.
    float weight = ty_clamp(ty_input_float(&d->specular_weight, context, &b->point), 0.0f, 1.0f);
    b->coat_weight = weight * (0.5f + 0.5f * optics->film);
    b->coat_alpha = ty_ggx_alpha(roughness);
    b->coat_eta = d->specular_ior;
    b->coat_row = ty_albedo_table_row(material->coat, roughness, d->specular_ior);
}

void ty_cdrf_prepare(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_cdrf_def* d = &material->cdrf;
    ty_moisture_optics optics = optics_at(material, context, &b->point);
    ty_rgb color = ty_input_color(&d->color, context, &b->point);
    b->color = ty_rgb_make(ty_moisture_color(&optics, color.r), ty_moisture_color(&optics, color.g),
                           ty_moisture_color(&optics, color.b));
    b->mean_free_path = ty_input_float(&d->mean_free_path, context, &b->point);
    if (b->mean_free_path < 0.0f)
    {
        b->mean_free_path = optics.mean_free_path;
        // Left to the moisture, the published form keeps the published law, linear in curvature.
        b->sigma_slope = d->kernel == TY_CDRF_GAUSSIAN_PUBLISHED ? optics.gaussian_sigma : 0.0f;
    }
    prepare_coat(material, context, &optics, b);
    b->kind = TY_BSDF_CDRF;
    if (d->evaluate == TY_CDRF_LOCAL)
    {
        b->kind = TY_BSDF_CDRF_LOCAL;
        ty_local_prepare(context, b);
    }
}

float ty_cdrf_spread(const ty_bsdf* b, float curvature)
{
    curvature = ty_max(curvature, 0.0f);
    if (b->sigma_slope > 0.0f)
        return b->sigma_slope * curvature;
    float x = b->mean_free_path * curvature;
    return b->material->cdrf.kernel == TY_CDRF_POISSON ? ty_cdrf_poisson_t(x) : ty_cdrf_gaussian_sigma(x);
}

// Multiplies weight by what a walk left of the light.
static bool trace_interior(ty_bsdf* b, const ty_shading_context* context, const float u[3], ty_rng* extra,
                           ty_rgb* weight, ty_surface_point* exit)
{
    if (!context || !context->world)
        return false;
    if (b->material->model == TY_MODEL_WALK)
        return ty_walk_exit(context, b, u, extra, weight, exit);
    if (b->material->cdrf.evaluate == TY_CDRF_DEPTH)
        return ty_cdrf_depth_exit(context, &b->point, b->mean_free_path, u, extra, exit);
    return ty_cdrf_probe_exit(context, b, u, exit);
}

// The published kernel is not normalised: its integral over pi is part of the weight.
static float kernel_gain(const ty_bsdf* b, const ty_shading_context* context)
{
    if (b->material->cdrf.kernel != TY_CDRF_GAUSSIAN_PUBLISHED || !context || !context->world)
        return 1.0f;
    return ty_cdrf_gaussian_integral(ty_cdrf_spread(b, b->curvature)) * TY_INV_PI;
}

// A viewer within a walk's body sees through to where light comes in.
static bool is_within(const ty_bsdf* b)
{
    return b->material->model == TY_MODEL_WALK && !b->entering && b->way > 0.0f;
}

float ty_bsdf_coat_chance(const ty_bsdf* b)
{
    if (b->kind == TY_BSDF_SUBSURFACE)
        return b->surface_chance;
    if (b->kind != TY_BSDF_CDRF || b->coat_weight <= 0.0f || is_within(b))
        return 0.0f;
    // The coat carries the highlights, which are bright where they are: never sampled less than one time in ten.
    return ty_clamp(ty_coat_albedo(b, ty_dot(b->wo, b->frame.n)), 0.1f, 0.9f);
}

void ty_bsdf_take_coat(ty_bsdf* b)
{
    TY_ASSERT(ty_bsdf_is_open(b));
    b->kind = b->kind == TY_BSDF_SUBSURFACE ? TY_BSDF_SURFACE : TY_BSDF_CDRF_COAT;
}

bool ty_bsdf_take_interior(ty_bsdf* b, const ty_shading_context* context, const float u[3], ty_rng* extra,
                           ty_rgb* weight)
{
    if (b->kind == TY_BSDF_SUBSURFACE)
        return ty_surface_take_interior(b, context, u, extra, weight);
    if (b->material->cdrf.evaluate == TY_CDRF_PROBE && context && context->world)
        b->curvature = ty_mean_curvature(context->world, &b->point);
    float coat = is_within(b) ? 0.0f : ty_coat_albedo(b, ty_dot(b->wo, b->frame.n));
    float through = (1.0f - coat) / (1.0f - b->coat_weight * b->coat_row.average);
    *weight = ty_rgb_scale(b->color, through * kernel_gain(b, context));
    ty_surface_point exit;
    if (trace_interior(b, context, u, extra, weight, &exit))
        b->point = exit;
    b->kind = TY_BSDF_CDRF_EXIT;
    b->bent = false; // the map is the coat's
    b->frame = ty_frame_from_normal(b->point.ns);
    return !ty_rgb_is_black(*weight);
}

bool ty_bsdf_resolve(ty_bsdf* b, const ty_shading_context* context, const float u[4], ty_rng* extra, ty_rgb* weight)
{
    *weight = ty_rgb_grey(1.0f);
    if (!ty_bsdf_is_open(b))
        return true;
    float chance = ty_bsdf_coat_chance(b);
    if (u[0] < chance)
    {
        ty_bsdf_take_coat(b);
        *weight = ty_rgb_grey(1.0f / chance);
        return true;
    }
    bool lit = ty_bsdf_take_interior(b, context, u + 1, extra, weight);
    *weight = ty_rgb_scale(*weight, 1.0f / (1.0f - chance));
    return lit;
}

float ty_coat_albedo(const ty_bsdf* b, float mu)
{
    return b->coat_weight > 0.0f ? b->coat_weight * ty_albedo_row_at(&b->coat_row, mu) : 0.0f;
}

ty_rgb ty_coat_eval(const ty_bsdf* b, ty_vec3 wo, ty_vec3 wi, float* pdf)
{
    *pdf = 0.0f;
    if (wi.z <= 0.0f || wo.z <= 0.0f || b->coat_alpha == 0.0f)
        return ty_rgb_grey(0.0f);
    float cos_h, d = ty_ggx_reflect(wo, wi, ty_ggx_round(b->coat_alpha), pdf, &cos_h);
    return ty_rgb_grey(b->coat_weight * ty_fresnel(cos_h, b->coat_eta) * d);
}

bool ty_coat_sample(const ty_bsdf* b, ty_vec3 wo, ty_vec2 u, ty_bsdf_sample* out)
{
    if (b->coat_alpha == 0.0f)
    {
        *out = (ty_bsdf_sample){.wi = ty_vec3_make(-wo.x, -wo.y, wo.z), .delta = true, .kind = TY_MASK_GLOSSY};
        out->weight = ty_rgb_grey(b->coat_weight * ty_fresnel(wo.z, b->coat_eta));
        return true;
    }
    *out = (ty_bsdf_sample){.wi = ty_reflect(wo, ty_ggx_sample(wo, ty_ggx_round(b->coat_alpha), u)),
                            .kind = TY_MASK_GLOSSY};
    ty_rgb f = ty_coat_eval(b, wo, out->wi, &out->pdf);
    if (out->pdf <= 0.0f)
        return false;
    out->weight = ty_rgb_scale(f, 1.0f / out->pdf);
    return true;
}

ty_rgb ty_exit_eval(const ty_bsdf* b, ty_vec3 wi, float* pdf)
{
    *pdf = ty_max(wi.z, 0.0f) * TY_INV_PI;
    if (b->material->model == TY_MODEL_SURFACE)
        return ty_rgb_scale(ty_surface_eval_exit(b, ty_max(wi.z, 0.0f)), *pdf);
    return ty_rgb_grey(*pdf * (1.0f - ty_coat_albedo(b, wi.z)));
}

bool ty_exit_sample(const ty_bsdf* b, ty_vec2 u, ty_bsdf_sample* out)
{
    *out = (ty_bsdf_sample){.wi = ty_sample_cosine(u), .kind = TY_MASK_DIFFUSE};
    ty_rgb f = ty_exit_eval(b, out->wi, &out->pdf);
    if (out->pdf <= 0.0f)
        return false;
    out->weight = ty_rgb_scale(f, 1.0f / out->pdf);
    return true;
}

ty_rgb ty_cdrf_albedo(const ty_bsdf* b)
{
    if (b->kind == TY_BSDF_CDRF_EXIT)
        return b->color;
    ty_rgb color =
        b->material->model == TY_MODEL_WALK ? ty_rgb_mul(b->color, ty_walk_reflectance(&b->matter)) : b->color;
    float coat = ty_coat_albedo(b, ty_dot(b->wo, b->frame.n));
    return ty_rgb_add(ty_rgb_grey(coat), ty_rgb_scale(color, 1.0f - coat));
}
