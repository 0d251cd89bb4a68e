// SPDX-License-Identifier: Apache-2.0
// Light gathered at a vertex of a path: by a sample of a light, or along a sampled direction of a lobe.
#include "path.h"
#include <tsuya/shading/walk.h>

// Light from below matters to what transmits or is lit through its body.
static ty_vec3 lit_side(const ty_bsdf* bsdf)
{
    bool one_side =
        bsdf->kind == TY_BSDF_CDRF_EXIT || bsdf->kind == TY_BSDF_CDRF_COAT ||
        (bsdf->kind == TY_BSDF_MATTE && !bsdf->bent) ||
        (bsdf->kind == TY_BSDF_SURFACE && !(bsdf->transmission_weight > 0.0f) && !bsdf->thin && !bsdf->bent);
    return one_side ? bsdf->frame.n : (ty_vec3){0};
}

ty_light_point ty_path_light_point(const ty_integrator* in, const ty_bsdf* bsdf)
{
    return (ty_light_point){bsdf->point.position, lit_side(bsdf), bsdf->point.time,
                            in->scene->objects[bsdf->point.object].light_link};
}

void ty_path_turn(const ty_integrator* in, const ty_bsdf* bsdf, const ty_bsdf_sample* sample, ty_light_view* view)
{
    view->pdf = sample->pdf;
    view->full = sample->delta;
    view->done = false;
    view->seen = sample->kind;
    if (in->lights.restricted && !sample->delta)
        view->parts = ty_bsdf_eval_parts(bsdf, sample->wi);
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

// f |cos| of the lobes that see the light, and their density.
static ty_rgb visible_value(const ty_bsdf* bsdf, const ty_light_sample* light, float* pdf)
{
    if ((light->visible | TY_MASK_CAMERA) == TY_MASK_SEEN)
        return ty_bsdf_eval(bsdf, light->wi, pdf);
    ty_bsdf_parts parts = ty_bsdf_eval_parts(bsdf, light->wi);
    return ty_light_parts_value(&parts, light->visible, pdf);
}

void ty_path_add(const ty_integrator* in, bool indirect, int group, ty_rgb light, ty_film_sample* out)
{
    float limit = in->scene->render.indirect_clamp, most = ty_rgb_max(light);
    if (indirect && limit > 0.0f && most > limit)
        light = ty_rgb_scale(light, limit / most);
    ty_film_sample_add(out, group, light);
}

void ty_path_add_limited(const ty_integrator* in, const ty_film_sample* met, ty_film_sample* out)
{
    float limit = in->scene->render.indirect_clamp, most = ty_rgb_max(met->radiance);
    float scale = most > limit ? limit / most : 1.0f;
    out->radiance = ty_rgb_add(out->radiance, ty_rgb_scale(met->radiance, scale));
    for (uint32_t i = 0; i < in->group_count; ++i)
        out->group[i] = ty_rgb_add(out->group[i], ty_rgb_scale(met->group[i], scale));
}

// A ray that begins beside its point would meet a small glowing body before the place that was sampled: it is turned
// to end there.
static void aim(const ty_light_sample* light, ty_ray* shadow)
{
    if (light->distance < TY_FLOAT_MAX)
        shadow->t_max = light->distance * TY_LIGHT_REACH;
    if (!light->solid)
        return;
    ty_vec3 way = ty_sub(light->target, shadow->origin);
    float length = ty_length(way);
    shadow->t_max = ty_dot(way, light->wi) > 0.0f ? length : 0.0f;
    if (shadow->t_max > 0.0f)
        shadow->direction = ty_mul(way, 1.0f / length);
}

void ty_path_direct_light(const ty_integrator* in, const ty_path* p, const ty_bsdf* bsdf, const ty_light_point* at,
                          const float u[4], const ty_rgb* beta, ty_film_sample* out, ty_counters* counters)
{
    ty_light_sample light;
    if (ty_bsdf_is_delta(bsdf) || !ty_light_set_sample(&in->lights, at, u[2], (ty_vec2){u[0], u[1]}, &light))
        return;
    // Within such a body there are no lights, and no shadow ray tells of its far side.
    if (bsdf->kind == TY_BSDF_SURFACE && bsdf->alone && ty_dot(light.wi, bsdf->point.ng) < 0.0f)
        return;
    float pdf = 0.0f;
    ty_rgb value = ty_rgb_mul(visible_value(bsdf, &light, &pdf), light.radiance);
    float weight = sample_weight(in, &light, pdf) / light.pdf;
    if (ty_rgb_is_black(value) || !(weight > 0.0f))
        return;
    ty_ray shadow;
    ty_bsdf_spawn(bsdf, light.wi, u[3], &shadow);
    aim(&light, &shadow);
    bool beyond = (ty_dot(light.wi, bsdf->point.ng) > 0.0f) != bsdf->entering;
    ty_rgb absorption = p->absorption[beyond];
    value = ty_rgb_mul(value, light.shadows ? ty_path_transmittance(in, &shadow, absorption, light.distance, counters)
                                            : ty_flight_transmittance(absorption, light.distance));
    if (ty_rgb_is_black(value))
        return;
    ty_path_add(in, p->soft, light.group, ty_rgb_scale(ty_rgb_mul(*beta, value), weight), out);
}

// The rest of beta beyond a surface that light goes straight through. False = it ends there.
static bool look_through(const ty_scene* scene, const ty_hit* hit, ty_ray* ray, ty_rgb* beta)
{
    const ty_material* material = ty_scene_material(scene, hit->object, hit->instance, hit->triangle);
    if (!(ty_material_traits(material) & TY_TRAIT_TRANSPARENT))
        return false;
    ty_surface_point point;
    ty_world_surface(scene->world, hit, &point);
    ty_vec3 wo = ty_neg(ray->direction);
    *beta = ty_rgb_mul(*beta, ty_material_transparency(material, &scene->shading, &point, wo).through);
    ty_path_pass(&point, hit->t, ray);
    return !ty_rgb_is_black(*beta);
}

void ty_path_light_along(const ty_integrator* in, const ty_path* p, const ty_bsdf* bsdf, const ty_light_point* at,
                         const ty_bsdf_sample* sample, float u, ty_film_sample* out, ty_counters* counters)
{
    // a reflection stays on wo's side
    ty_light_view view = {.from = *at, .absorption = p->absorption[0]};
    ty_path_turn(in, bsdf, sample, &view);
    ty_ray ray;
    ty_bsdf_spawn(bsdf, sample->wi, u, &ray);
    ray.mask = TY_MASK_GLOSSY;
    if (!ty_light_set_shines(&in->lights, &ray, &view))
        return;
    ty_film_sample limited, *sum = p->soft && in->scene->render.indirect_clamp > 0.0f ? &limited : out;
    ty_film_sample_begin(&limited, in->group_count);
    ty_rgb beta = ty_rgb_mul(p->beta, sample->weight);
    for (int i = 0; i < TY_PATH_MAX_PASSED; ++i)
    {
        ty_hit hit;
        counters->path_rays++;
        bool found = ty_world_intersect(in->scene->world, &ray, &hit);
        (void)ty_light_set_along(&in->lights, &ray, found ? hit.t : TY_FLOAT_MAX, &view, &beta, sum);
        if (!found || !look_through(in->scene, &hit, &ray, &beta))
            break;
    }
    if (sum == &limited)
        ty_path_add_limited(in, &limited, out);
}
