// SPDX-License-Identifier: Apache-2.0
// Dispatch over the closed set of bsdf kinds, and the rays that leave them.
#include "matte.h"

bool ty_bsdf_is_delta(const ty_bsdf* bsdf)
{
    switch (bsdf->kind)
    {
    case TY_BSDF_SURFACE:
        return ty_surface_is_delta(bsdf);
    case TY_BSDF_MATTE: // black: there is nothing to light
        return ty_matte_is_black(bsdf);
    case TY_BSDF_CDRF_COAT:
        return bsdf->coat_alpha == 0.0f;
    case TY_BSDF_CDRF:
    case TY_BSDF_SUBSURFACE: // nothing can be evaluated before it is resolved
        return true;
    case TY_BSDF_CDRF_LOCAL:
    case TY_BSDF_CDRF_EXIT:
        break;
    }
    return false;
}

static ty_rgb eval_local(const ty_bsdf* bsdf, ty_vec3 wo, ty_vec3 wi, float* pdf)
{
    *pdf = 0.0f;
    switch (bsdf->kind)
    {
    case TY_BSDF_SURFACE:
        return ty_surface_eval(bsdf, wo, wi, pdf);
    case TY_BSDF_MATTE:
        return ty_matte_eval(bsdf, wi.z, pdf);
    case TY_BSDF_CDRF_LOCAL:
        return ty_local_eval(bsdf, wo, wi, pdf);
    case TY_BSDF_CDRF_EXIT:
        return ty_exit_eval(bsdf, wi, pdf);
    case TY_BSDF_CDRF_COAT:
        return ty_coat_eval(bsdf, wo, wi, pdf);
    case TY_BSDF_CDRF:
    case TY_BSDF_SUBSURFACE:
        break;
    }
    return ty_rgb_grey(0.0f);
}

// A normal from a map makes lobes reach to the wrong side of the surface. What would go there is mirrored in the true
// tangent plane, so that nothing leaks and nothing is lost: a direction is met as itself and as its mirror image.
static ty_vec3 mirror_image(const ty_bsdf* bsdf, ty_vec3 w)
{
    return ty_mad(w, bsdf->point.ng, -2.0f * ty_dot(w, bsdf->point.ng));
}

static bool is_above(const ty_bsdf* bsdf, ty_vec3 w)
{
    return (ty_dot(w, bsdf->point.ng) > 0.0f) == bsdf->entering;
}

static ty_rgb eval_bent(const ty_bsdf* bsdf, ty_vec3 wo, ty_vec3 wi_world, float* pdf)
{
    bool above = is_above(bsdf, wi_world);
    ty_vec3 wi = ty_to_local(bsdf->frame, wi_world), image = ty_to_local(bsdf->frame, mirror_image(bsdf, wi_world));
    float image_pdf = 0.0f;
    ty_rgb f = {0};
    *pdf = 0.0f;
    if ((wi.z > 0.0f) == above)
        f = eval_local(bsdf, wo, wi, pdf);
    if ((image.z > 0.0f) == above)
        f = ty_rgb_add(f, eval_local(bsdf, wo, image, &image_pdf));
    *pdf += image_pdf;
    return f;
}

static __attribute__((noinline)) ty_rgb eval_any(const ty_bsdf* bsdf, ty_vec3 wi_world, float* pdf)
{
    ty_vec3 wo = ty_to_local(bsdf->frame, bsdf->wo);
    if (bsdf->bent)
        return eval_bent(bsdf, wo, wi_world, pdf);
    return eval_local(bsdf, wo, ty_to_local(bsdf->frame, wi_world), pdf);
}

ty_rgb ty_bsdf_eval(const ty_bsdf* bsdf, ty_vec3 wi, float* pdf)
{
    return ty_matte_is_plain(bsdf) ? ty_matte_eval(bsdf, ty_dot(wi, bsdf->frame.n), pdf) : eval_any(bsdf, wi, pdf);
}

// Towards a direction in the frame; what is no part of the others is glossy.
static ty_bsdf_parts local_parts(const ty_bsdf* bsdf, ty_vec3 wo, ty_vec3 wi)
{
    ty_bsdf_parts parts = {0};
    float pdf;
    ty_rgb f = eval_local(bsdf, wo, wi, &pdf);
    if (bsdf->kind == TY_BSDF_SURFACE && wi.z < 0.0f)
    {
        parts.f[2] = f;
        parts.pdf[2] = pdf;
        return parts;
    }
    if (bsdf->kind == TY_BSDF_SURFACE)
        parts.f[0] = ty_surface_eval_diffuse(bsdf, wo, wi, &parts.pdf[0]);
    else if (bsdf->kind == TY_BSDF_CDRF_LOCAL)
        parts.f[0] = ty_local_eval_diffuse(bsdf, wo, wi, &parts.pdf[0]);
    else if (bsdf->kind == TY_BSDF_CDRF_EXIT || bsdf->kind == TY_BSDF_MATTE)
    {
        parts.f[0] = f;
        parts.pdf[0] = pdf;
    }
    parts.f[1] =
        (ty_rgb){ty_max(f.r - parts.f[0].r, 0.0f), ty_max(f.g - parts.f[0].g, 0.0f), ty_max(f.b - parts.f[0].b, 0.0f)};
    parts.pdf[1] = ty_max(pdf - parts.pdf[0], 0.0f);
    return parts;
}

ty_bsdf_parts ty_bsdf_eval_parts(const ty_bsdf* bsdf, ty_vec3 wi)
{
    ty_vec3 wo = ty_to_local(bsdf->frame, bsdf->wo), local = ty_to_local(bsdf->frame, wi);
    if (!bsdf->bent)
        return local_parts(bsdf, wo, local);
    bool above = is_above(bsdf, wi);
    ty_vec3 image = ty_to_local(bsdf->frame, mirror_image(bsdf, wi));
    ty_bsdf_parts parts = {0}, other = {0};
    if ((local.z > 0.0f) == above)
        parts = local_parts(bsdf, wo, local);
    if ((image.z > 0.0f) == above)
        other = local_parts(bsdf, wo, image);
    for (int k = 0; k < 3; ++k)
    {
        parts.f[k] = ty_rgb_add(parts.f[k], other.f[k]);
        parts.pdf[k] += other.pdf[k];
    }
    return parts;
}

// The direction that a lobe sent, on the side where it belongs, with the density of both ways to it.
static bool straighten(const ty_bsdf* bsdf, ty_vec3 wo, ty_bsdf_sample* out)
{
    if (is_above(bsdf, out->wi) == out->transmitted)
        out->wi = mirror_image(bsdf, out->wi);
    if (out->delta)
        return true;
    ty_rgb f = eval_bent(bsdf, wo, out->wi, &out->pdf);
    if (!(out->pdf > 0.0f))
        return false;
    out->weight = ty_rgb_scale(f, 1.0f / out->pdf);
    return true;
}

static __attribute__((noinline)) bool sample_any(const ty_bsdf* bsdf, float u_lobe, ty_vec2 u, ty_bsdf_sample* out)
{
    ty_vec3 wo = ty_to_local(bsdf->frame, bsdf->wo);
    bool kept = false;
    switch (bsdf->kind)
    {
    case TY_BSDF_SURFACE:
        kept = ty_surface_sample(bsdf, wo, u_lobe, u, out);
        break;
    case TY_BSDF_MATTE:
        kept = ty_matte_sample(bsdf, u, out);
        break;
    case TY_BSDF_CDRF_LOCAL:
        kept = ty_local_sample(bsdf, wo, u_lobe, u, out);
        break;
    case TY_BSDF_CDRF_EXIT:
        kept = ty_exit_sample(bsdf, u, out);
        break;
    case TY_BSDF_CDRF_COAT:
        kept = ty_coat_sample(bsdf, wo, u, out);
        break;
    case TY_BSDF_CDRF:
    case TY_BSDF_SUBSURFACE:
        break;
    }
    if (kept)
        out->wi = ty_normalize(ty_to_world(bsdf->frame, out->wi));
    return kept && (!bsdf->bent || straighten(bsdf, wo, out));
}

bool ty_bsdf_sample_wi(const ty_bsdf* bsdf, float u_lobe, ty_vec2 u, ty_bsdf_sample* out)
{
    if (!ty_matte_is_plain(bsdf))
        return sample_any(bsdf, u_lobe, u, out);
    bool lit = ty_matte_sample(bsdf, u, out);
    out->wi = ty_to_world(bsdf->frame, out->wi);
    return lit;
}

ty_rgb ty_bsdf_albedo(const ty_bsdf* bsdf)
{
    if (bsdf->kind == TY_BSDF_MATTE)
        return bsdf->color;
    bool surface = bsdf->kind == TY_BSDF_SURFACE || bsdf->kind == TY_BSDF_SUBSURFACE;
    return surface ? ty_surface_albedo(bsdf) : ty_cdrf_albedo(bsdf);
}

// Light of `local` that comes from below the horizon has passed through the object itself.
static void skip_attached_shadow(const ty_bsdf* bsdf, ty_vec3 wi, float u, ty_ray* ray)
{
    float cosine = ty_dot(wi, bsdf->frame.n), k = ty_local_curvature(bsdf, ty_to_local(bsdf->frame, wi));
    ray->skip_object = bsdf->point.object;
    ray->skip_instance = bsdf->point.instance;
    // Three chords 2|cos|/k of the osculating sphere, +-30 % so that no edge shows.
    float distance = -6.0f * cosine * (0.7f + 0.6f * u);
    ray->skip_distance = k * TY_FLOAT_MAX > distance ? distance / k : TY_FLOAT_MAX;
}

void ty_bsdf_spawn(const ty_bsdf* bsdf, ty_vec3 wi, float u, ty_ray* ray)
{
    const ty_surface_point* p = &bsdf->point;
    bool local = bsdf->kind == TY_BSDF_CDRF_LOCAL;
    float side = ty_dot(wi, p->ng), distance = ty_offset_distance(p);
    // What leaves above the horizon of its triangle cannot meet the instance again; nor can what leaves a convex body
    // on its outer side, the facets of its mesh apart.
    bool leaves = side > p->horizon || (p->convex && (local || ty_dot(wi, p->ns) > 0.0f));
    ray->origin = ty_mad(p->position, p->ng, side >= 0.0f ? distance : -distance);
    ray->t_min = 0.0f;
    ray->direction = wi;
    ray->t_max = TY_FLOAT_MAX;
    ray->flags = TY_RAY_FRONT_ONLY;
    ray->skip_object = leaves ? p->object : TY_NONE;
    ray->skip_instance = leaves ? p->instance : TY_NONE;
    ray->skip_distance = TY_FLOAT_MAX;
    ray->mask = TY_MASK_ALL;
    ray->time = p->time;
    if (local && !leaves && ty_dot(wi, bsdf->frame.n) < 0.0f)
        skip_attached_shadow(bsdf, wi, u, ray);
}
