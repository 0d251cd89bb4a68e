// SPDX-License-Identifier: Apache-2.0
// Light gathered at a vertex of a path: by a sample of a light, or along a sampled direction of a lobe.
#include "path.h"

// Light from below matters to what transmits or is lit through its body.
static ty_vec3 lit_side(const ty_bsdf* bsdf)
{
    bool one_side = bsdf->kind == TY_BSDF_CDRF_EXIT || bsdf->kind == TY_BSDF_CDRF_COAT ||
                    (bsdf->kind == TY_BSDF_SURFACE && !(bsdf->transmission_weight > 0.0f));
    return one_side ? bsdf->frame.n : (ty_vec3){0};
}

ty_light_point ty_path_light_point(const ty_integrator* in, const ty_bsdf* bsdf)
{
    return (ty_light_point){bsdf->point.position, lit_side(bsdf), bsdf->point.time,
                            in->scene->objects[bsdf->point.object].light_link};
}

// Weight of a light's sample against the surface's own sampling of its direction.
static float sample_weight(const ty_integrator* in, const ty_light_sample* light, float pdf)
{
    if (light->delta)
        return 1.0f;
    switch ((ty_light_sampling)in->scene->render.light_sampling)
    {
    case TY_LIGHT_SAMPLING_LIGHT:
        return 1.0f;
    case TY_LIGHT_SAMPLING_BSDF:
        return 0.0f;
    case TY_LIGHT_SAMPLING_MIS:
        break;
    }
    return ty_power_heuristic(light->pdf, pdf);
}

void ty_path_direct_light(const ty_integrator* in, const ty_bsdf* bsdf, const float u[4], ty_rgb beta,
                          ty_film_sample* out, ty_counters* counters)
{
    ty_light_sample light;
    ty_light_point at = ty_path_light_point(in, bsdf);
    if (ty_bsdf_is_delta(bsdf) || !ty_light_set_sample(&in->lights, &at, u[2], (ty_vec2){u[0], u[1]}, &light))
        return;
    float pdf = 0.0f;
    ty_rgb value = ty_rgb_mul(ty_bsdf_eval(bsdf, light.wi, &pdf), light.radiance);
    float weight = sample_weight(in, &light, pdf) / light.pdf;
    if (ty_rgb_is_black(value) || !(weight > 0.0f))
        return;
    ty_ray shadow;
    ty_bsdf_spawn(bsdf, light.wi, u[3], &shadow);
    shadow.mask = TY_MASK_SHADOW;
    if (light.distance < TY_FLOAT_MAX)
        shadow.t_max = light.distance * TY_LIGHT_REACH;
    counters->shadow_rays += light.shadows;
    if (light.shadows && ty_world_occluded(in->scene->world, &shadow))
        return;
    ty_film_sample_add(out, light.group, ty_rgb_scale(ty_rgb_mul(beta, value), weight));
}

void ty_path_light_along(const ty_integrator* in, const ty_bsdf* bsdf, const ty_bsdf_sample* sample, float u,
                         ty_rgb beta, ty_film_sample* out, ty_counters* counters)
{
    ty_light_view view = {
        .from = ty_path_light_point(in, bsdf), .pdf = sample->pdf, .full = sample->delta, .seen = TY_MASK_GLOSSY};
    ty_ray ray;
    ty_bsdf_spawn(bsdf, sample->wi, u, &ray);
    ray.mask = TY_MASK_GLOSSY;
    if (!ty_light_set_shines(&in->lights, &ray, &view))
        return;
    ty_hit hit;
    counters->path_rays++;
    bool found = ty_world_intersect(in->scene->world, &ray, &hit);
    (void)ty_light_set_along(&in->lights, &ray, found ? hit.t : TY_FLOAT_MAX, &view, ty_rgb_mul(beta, sample->weight),
                             out);
}
