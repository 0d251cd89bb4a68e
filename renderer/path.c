// SPDX-License-Identifier: Apache-2.0
// Path tracing: light sampling at each surface, weighted against the surface's own sampling; roulette from a depth on.
#include "integrator.h"

typedef struct path
{
    ty_ray ray;
    ty_rgb beta; // throughput
    ty_light_view view;
    int bounce; // surfaces passed before the present one
} path;

// One light sample at a surface. u: two for the light's surface, one to choose it, one for the ray's start.
static ty_rgb direct_light(const ty_integrator* in, const ty_bsdf* bsdf, const float u[4], ty_counters* counters)
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
    if (light.distance < TY_FLOAT_MAX) // a little short, so that a surface in the lamp's own plane does not shade it
        shadow.t_max = light.distance * 0.9999f;
    counters->shadow_rays++;
    if (ty_world_occluded(in->scene->world, &shadow))
        return (ty_rgb){0};
    return ty_rgb_scale(value, (light.delta ? 1.0f : ty_power_heuristic(light.pdf, pdf)) / light.pdf);
}

// The square root keeps more of the dim paths than the throughput itself: less noise for its rays. Scales beta and
// makes *u uniform again. False = the path ends.
static bool survives(const ty_render_def* def, path* p, float* u)
{
    float probability = ty_min(1.0f, sqrtf(ty_rgb_max(p->beta)));
    if (p->bounce + 1 < def->roulette_depth || !(probability < 1.0f))
        return !ty_rgb_is_black(p->beta);
    if (*u >= probability)
        return false;
    p->beta = ty_rgb_scale(p->beta, 1.0f / probability);
    *u = ty_min(*u / probability, TY_ONE_MINUS_EPSILON);
    return true;
}

// Light at a surface and the next ray from it. False = the path ends.
static bool scatter(const ty_integrator* in, const ty_sampler* sampler, ty_bsdf* bsdf, path* p, ty_rgb* radiance,
                    ty_counters* counters)
{
    if (bsdf->kind == TY_BSDF_CDRF)
    {
        // The resolving draws a direction from its second and third number: they get the group's best pair.
        float pair[4];
        ty_rgb weight = {1.0f, 1.0f, 1.0f};
        ty_rng extra = ty_sampler_extra(sampler, p->bounce);
        ty_sampler_4d(sampler, ty_group_interior(p->bounce), pair);
        const float interior[4] = {pair[2], pair[0], pair[1], pair[3]};
        if (!ty_bsdf_resolve(bsdf, &in->scene->shading, interior, &extra, &weight))
            return false;
        p->beta = ty_rgb_mul(p->beta, weight);
        counters->interior_rays += bsdf->kind == TY_BSDF_CDRF_EXIT;
    }
    float u[8]; // direction 2, lobe, roulette and start; light's surface 2, choice, start of the shadow ray
    ty_sampler_8d(sampler, ty_group_scatter(p->bounce), u);
    *radiance = ty_rgb_add(*radiance, ty_rgb_mul(p->beta, direct_light(in, bsdf, u + 4, counters)));
    ty_bsdf_sample sample;
    if (!ty_bsdf_sample_wi(bsdf, u[2], (ty_vec2){u[0], u[1]}, &sample))
        return false;
    p->beta = ty_rgb_mul(p->beta, sample.weight);
    if (!survives(&in->scene->render, p, &u[3]))
        return false;
    p->view = (ty_light_view){.from = bsdf->point.position, .pdf = sample.pdf, .full = sample.delta};
    ty_bsdf_spawn(bsdf, sample.wi, u[3], &p->ray);
    return true;
}

// Beer's law over a way through the medium behind a surface.
static void absorb(path* p, ty_rgb absorption, float distance)
{
    if (ty_rgb_is_black(absorption))
        return;
    p->beta = ty_rgb_mul(p->beta, (ty_rgb){ty_exp(-absorption.r * distance), ty_exp(-absorption.g * distance),
                                           ty_exp(-absorption.b * distance)});
}

void ty_path_sample(const ty_integrator* in, const ty_sampler* sampler, ty_ray ray, ty_counters* counters,
                    ty_film_sample* out)
{
    const ty_scene* scene = in->scene;
    path p = {.ray = ray, .beta = {1.0f, 1.0f, 1.0f}, .view = {.full = true, .camera = true}};
    for (;; p.bounce++)
    {
        ty_hit hit;
        bool covered = false, found = ty_world_intersect(scene->world, &p.ray, &hit);
        ty_rgb met = ty_light_set_along(&in->lights, &p.ray, found ? hit.t : TY_FLOAT_MAX, &p.view, &covered);
        out->radiance = ty_rgb_add(out->radiance, ty_rgb_mul(p.beta, met));
        if (p.bounce == 0)
            out->covered = found || covered;
        if (!found)
            return;
        ty_surface_point point;
        ty_bsdf bsdf;
        ty_world_surface(scene->world, &hit, &point);
        ty_material_prepare(scene->materials[scene->objects[hit.object].material], &scene->shading, &point,
                            ty_neg(p.ray.direction), &bsdf);
        counters->path_vertices++;
        if (!bsdf.entering)
            absorb(&p, ty_bsdf_absorption(&bsdf), hit.t);
        out->radiance = ty_rgb_add(out->radiance, ty_rgb_mul(p.beta, bsdf.emission));
        if (p.bounce == 0)
            ty_integrator_record(in, &bsdf, out);
        if (p.bounce == scene->render.max_depth || !scatter(in, sampler, &bsdf, &p, &out->radiance, counters))
            return;
        counters->path_rays++;
    }
}
