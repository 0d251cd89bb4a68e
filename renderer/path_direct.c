// SPDX-License-Identifier: Apache-2.0
// Light gathered at a vertex of a path: by a sample of a light, or along a sampled direction of a lobe.
#include "path.h"

ty_rgb ty_path_direct_light(const ty_integrator* in, const ty_bsdf* bsdf, const float u[4], ty_counters* counters)
{
    ty_light_sample light;
    if (ty_bsdf_is_delta(bsdf) ||
        !ty_light_set_sample(&in->lights, bsdf->point.position, u[2], (ty_vec2){u[0], u[1]}, &light))
        return (ty_rgb){0};
    float pdf = 0.0f;
    ty_rgb value = ty_rgb_mul(ty_bsdf_eval(bsdf, light.wi, &pdf), light.radiance);
    if (ty_rgb_is_black(value))
        return value;
    ty_ray shadow;
    ty_bsdf_spawn(bsdf, light.wi, u[3], &shadow);
    shadow.mask = TY_MASK_SHADOW;
    if (light.distance < TY_FLOAT_MAX)
        shadow.t_max = light.distance * TY_LIGHT_REACH;
    counters->shadow_rays++;
    if (ty_world_occluded(in->scene->world, &shadow))
        return (ty_rgb){0};
    return ty_rgb_scale(value, (light.delta ? 1.0f : ty_power_heuristic(light.pdf, pdf)) / light.pdf);
}

ty_rgb ty_path_light_along(const ty_integrator* in, const ty_bsdf* bsdf, const ty_bsdf_sample* sample, float u,
                           ty_counters* counters)
{
    ty_light_view view = {.from = bsdf->point.position, .pdf = sample->pdf, .full = sample->delta};
    ty_ray ray;
    bool covered;
    ty_bsdf_spawn(bsdf, sample->wi, u, &ray);
    ray.mask = TY_MASK_GLOSSY;
    if (ty_rgb_is_black(ty_light_set_along(&in->lights, &ray, TY_FLOAT_MAX, &view, &covered)))
        return (ty_rgb){0};
    ty_hit hit;
    counters->path_rays++;
    bool found = ty_world_intersect(in->scene->world, &ray, &hit);
    ty_rgb met = ty_light_set_along(&in->lights, &ray, found ? hit.t : TY_FLOAT_MAX, &view, &covered);
    return ty_rgb_mul(met, sample->weight);
}
