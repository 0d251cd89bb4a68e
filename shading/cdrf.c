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

static void prepare_coat(const ty_material* material, const ty_shading_context* context, const ty_surface_point* p,
                         const ty_moisture_optics* optics, ty_cdrf_optics* out)
{
    const ty_cdrf_def* d = &material->cdrf;
    if (!material->coat)
        return;
    float roughness = ty_input_float(&d->specular_roughness, context, p);
    roughness = roughness < 0.0f ? optics->roughness : ty_min(roughness, 1.0f);
    // A dry surface is dusty and broken: half its area shines.
    float weight = ty_clamp(ty_input_float(&d->specular_weight, context, p), 0.0f, 1.0f);
    out->coat_weight = weight * (0.5f + 0.5f * optics->film);
    out->coat_alpha = ty_ggx_alpha(roughness);
    out->coat_row = ty_albedo_table_row(material->coat, roughness, d->specular_ior);
}

// What the boundary sends back of diffuse light from within: 1 - (1 - F_e) / ior^2, with the mean reflectance from
// outside fitted (Kulla & Conty 2017).
static float internal_reflectance(float ior, float weight)
{
    float outside = (ior - 1.0f) / (4.08567f + 1.00071f * ior);
    return weight * (1.0f - (1.0f - outside) / (ior * ior));
}

// Returns whether all channels are alike.
static bool set_channels(float path, ty_rgb scale, ty_rgb color, float internal, float l[3], float loss[3])
{
    const float scales[3] = {scale.r, scale.g, scale.b}, colors[3] = {color.r, color.g, color.b};
    for (int i = 0; i < 3; i++)
    {
        l[i] = ty_max(path * scales[i], 0.0f);
        loss[i] = ty_cdrf_loss(colors[i], internal);
    }
    return l[0] == l[1] && l[1] == l[2] && loss[0] == loss[1] && loss[1] == loss[2];
}

static void prepare_medium(const ty_material* material, const ty_shading_context* context, const ty_surface_point* p,
                           const ty_moisture_optics* optics, ty_cdrf_optics* out)
{
    const ty_cdrf_def* d = &material->cdrf;
    ty_rgb scale = ty_input_color(&d->mean_free_path_scale, context, p);
    float path = ty_input_float(&d->mean_free_path, context, p);
    out->sigma_slope = 0.0f;
    if (path < 0.0f)
    {
        path = optics->mean_free_path;
        // Left to the moisture, the published form keeps the published law, linear in curvature.
        out->sigma_slope = d->kernel == TY_CDRF_GAUSSIAN_PUBLISHED ? optics->gaussian_sigma : 0.0f;
    }
    float internal = internal_reflectance(d->specular_ior, out->coat_weight);
    out->grey = set_channels(path, scale, out->color, internal, out->mean_free_path, out->loss);
}

static ty_cdrf_optics make_optics(const ty_material* material, const ty_shading_context* context,
                                  const ty_surface_point* p)
{
    const ty_cdrf_def* d = &material->cdrf;
    ty_cdrf_optics out = {0};
    ty_moisture_optics optics = optics_at(material, context, p);
    ty_rgb color = ty_input_color(&d->color, context, p);
    out.color = ty_rgb_make(ty_moisture_color(&optics, color.r), ty_moisture_color(&optics, color.g),
                            ty_moisture_color(&optics, color.b));
    prepare_coat(material, context, p, &optics, &out);
    prepare_medium(material, context, p, &optics, &out);
    return out;
}

void ty_cdrf_begin(ty_material* material)
{
    const ty_cdrf_def* d = &material->cdrf;
    material->spread = ty_spread_table_create(d->kernel);
    if (d->evaluate == TY_CDRF_LOCAL && d->kernel == TY_CDRF_POISSON)
        material->poisson = ty_poisson_table_create();
    if (material->cdrf_is_constant)
        material->cdrf_optics = make_optics(material, NULL, NULL);
}

void ty_cdrf_prepare(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_cdrf_def* d = &material->cdrf;
    const ty_cdrf_optics* o = &material->cdrf_optics;
    ty_cdrf_optics made;
    if (!material->cdrf_is_constant)
    {
        made = make_optics(material, context, &b->point);
        o = &made;
    }
    b->kind = TY_BSDF_CDRF;
    b->flights = 0;
    b->walk_end = TY_WALK_LEFT;
    b->color = o->color;
    b->grey = o->grey;
    b->sigma_slope = o->sigma_slope;
    for (int i = 0; i < 3; i++)
    {
        b->mean_free_path[i] = o->mean_free_path[i];
        b->loss[i] = o->loss[i];
    }
    b->coat_weight = o->coat_weight;
    if (o->coat_weight > 0.0f)
    {
        b->coat_alpha = o->coat_alpha;
        b->coat_eta = d->specular_ior;
        b->coat_row = o->coat_row;
    }
    if (d->evaluate == TY_CDRF_LOCAL)
    {
        b->kind = TY_BSDF_CDRF_LOCAL;
        ty_local_prepare(context, b);
    }
}

void ty_cdrf_set_medium(ty_bsdf* b, float mean_free_path, ty_rgb scale, ty_rgb color, float internal)
{
    b->grey = set_channels(mean_free_path, scale, color, internal, b->mean_free_path, b->loss);
    b->sigma_slope = 0.0f;
}

float ty_cdrf_spread(const ty_bsdf* b, float curvature, int channel)
{
    curvature = ty_max(curvature, 0.0f);
    if (b->sigma_slope > 0.0f)
        return b->sigma_slope * curvature;
    return ty_spread_table_at(b->material->spread, b->mean_free_path[channel] * curvature, b->loss[channel]);
}

bool ty_cdrf_spreads(const ty_bsdf* b, float curvature, float spread[3])
{
    spread[0] = ty_cdrf_spread(b, curvature, 0);
    if (b->grey)
        return true;
    spread[1] = ty_cdrf_spread(b, curvature, 1);
    spread[2] = ty_cdrf_spread(b, curvature, 2);
    float low = ty_min(spread[0], ty_min(spread[1], spread[2])), high = ty_max(spread[0], ty_max(spread[1], spread[2]));
    if (high > 1.1f * low)
        return false;
    spread[0] = (spread[0] + spread[1] + spread[2]) * (1.0f / 3.0f);
    return true;
}

// Multiplies weight by what a walk left of the light, or by what the way out is worth to each channel.
static bool trace_interior(ty_bsdf* b, const ty_shading_context* context, const float u[3], ty_rng* extra,
                           ty_rgb* weight, ty_surface_point* exit)
{
    if (!context || !context->world)
    {
        if (b->material->model == TY_MODEL_WALK)
            *weight = ty_rgb_mul(*weight, ty_walk_reflectance(&b->matter));
        return false;
    }
    if (b->material->model == TY_MODEL_WALK)
        return ty_walk_exit(context, b, u, extra, weight, exit);
    if (b->material->cdrf.evaluate == TY_CDRF_DEPTH)
        return ty_cdrf_depth_exit(context, b, u, extra, weight, exit);
    return ty_cdrf_probe_exit(context, b, u, weight, exit);
}

// The published kernel is not normalised: its integral over pi is part of the weight.
static ty_rgb kernel_gain(const ty_bsdf* b, const ty_shading_context* context)
{
    if (b->material->cdrf.kernel != TY_CDRF_GAUSSIAN_PUBLISHED || !context || !context->world)
        return ty_rgb_grey(1.0f);
    float gain[3];
    for (int i = 0; i < 3; i++)
        gain[i] = ty_cdrf_gaussian_integral(ty_cdrf_spread(b, b->curvature, i)) * TY_INV_PI;
    return ty_rgb_make(gain[0], gain[1], gain[2]);
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
        ty_probe_prepare(context, b);
    *weight = ty_rgb_mul(b->color, kernel_gain(b, context));
    if (b->coat_weight > 0.0f)
    {
        float coat = is_within(b) ? 0.0f : ty_coat_albedo(b, ty_dot(b->wo, b->frame.n));
        *weight = ty_rgb_scale(*weight, (1.0f - coat) / (1.0f - b->coat_weight * b->coat_row.average));
    }
    ty_surface_point exit;
    if (trace_interior(b, context, u, extra, weight, &exit))
        b->point = exit;
    b->kind = TY_BSDF_CDRF_EXIT;
    b->bent = false; // the map is the coat's
    if (b->coat_weight <= 0.0f)
    {
        b->kind = TY_BSDF_MATTE;
        b->color = ty_rgb_grey(1.0f);
    }
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
