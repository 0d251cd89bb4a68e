// SPDX-License-Identifier: Apache-2.0
// Integrators for looking at things: what the camera sees first, as colour.
#include "path.h"

void ty_integrator_record(const ty_integrator* in, const ty_bsdf* bsdf, ty_film_sample* out)
{
    const ty_surface_point* point = &bsdf->point;
    out->hit = true;
    out->albedo = ty_bsdf_albedo(bsdf);
    out->normal = bsdf->frame.n;
    out->position = point->position;
    out->instance = in->first_instance[point->object] + point->instance;
}

static float ambient_occlusion(const ty_integrator* in, const ty_sampler* sampler, const ty_bsdf* bsdf,
                               ty_counters* counters)
{
    float u[4];
    ty_sampler_4d(sampler, ty_group_scatter(0), u);
    ty_vec3 wi = ty_to_world(bsdf->frame, ty_sample_cosine((ty_vec2){u[0], u[1]}));
    ty_vec3 ng = ty_dot(bsdf->point.ng, bsdf->wo) < 0.0f ? ty_neg(bsdf->point.ng) : bsdf->point.ng;
    if (!(ty_dot(wi, ng) > 0.0f))
        return 0.0f;
    ty_ray ray = ty_ray_make(ty_offset_origin(&bsdf->point, ng), wi, in->scene->render.ao_distance);
    ray.mask = TY_MASK_SHADOW;
    ray.time = bsdf->point.time;
    counters->shadow_rays++;
    return ty_world_occluded(in->scene->world, &ray) ? 0.0f : 1.0f;
}

static ty_rgb shown(const ty_integrator* in, const ty_sampler* sampler, const ty_bsdf* bsdf, ty_counters* counters)
{
    const ty_scene* scene = in->scene;
    ty_vec3 n = bsdf->frame.n;
    switch ((ty_integrator_kind)scene->render.integrator)
    {
    case TY_INTEGRATOR_ALBEDO:
        return ty_bsdf_albedo(bsdf);
    case TY_INTEGRATOR_NORMAL:
        return (ty_rgb){0.5f + 0.5f * n.x, 0.5f + 0.5f * n.y, 0.5f + 0.5f * n.z};
    case TY_INTEGRATOR_CURVATURE:
        return ty_rgb_grey(0.5f + ty_integrator_curvature(scene->world, &bsdf->point) * scene->render.curvature_scale);
    case TY_INTEGRATOR_AO:
        return ty_rgb_grey(ambient_occlusion(in, sampler, bsdf, counters));
    case TY_INTEGRATOR_PATH:
        break;
    }
    return (ty_rgb){0};
}

// The material seen first, past what is more transparent than not. NULL = none.
static const ty_material* find_shown(const ty_integrator* in, ty_ray* ray, ty_surface_point* point)
{
    const ty_scene* scene = in->scene;
    ty_cone cone = ty_cone_begin(in, ray);
    ty_hit hit;
    for (int i = 0; i < TY_PATH_MAX_PASSED && ty_world_intersect(scene->world, ray, &hit); ++i)
    {
        ty_world_surface(scene->world, &hit, point);
        ty_cone_arrive(&cone, ray->direction, hit.t, point);
        const ty_material* material = ty_scene_material(scene, hit.object, hit.instance, hit.triangle);
        ty_vec3 wo = ty_neg(ray->direction);
        if (ty_rgb_max(ty_material_transparency(material, &scene->shading, point, wo).through) < 0.5f)
            return material;
        ty_path_pass(point, hit.t, ray);
    }
    return NULL;
}

void ty_debug_sample(const ty_integrator* in, const ty_sampler* sampler, const ty_ray* begin, ty_counters* counters,
                     ty_film_sample* out)
{
    const ty_scene* scene = in->scene;
    ty_ray ray = *begin;
    ty_surface_point point;
    ty_bsdf bsdf;
    const ty_material* material = find_shown(in, &ray, &point);
    if (!material)
        return;
    ty_material_prepare(material, &scene->shading, &point, ty_neg(ray.direction), &bsdf);
    counters->path_vertices++;
    out->covered = true;
    ty_integrator_record(in, &bsdf, out);
    out->radiance = shown(in, sampler, &bsdf, counters);
}
