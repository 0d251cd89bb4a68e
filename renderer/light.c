// SPDX-License-Identifier: Apache-2.0
// The set of lights: which one to sample, and what a ray meets of them.
#include "light.h"
#include <tsuya/base/memory.h>

static void light_init(ty_light* light, const ty_light_def* def, const ty_texture* image)
{
    *light = (ty_light){.kind = (ty_light_kind)def->kind,
                        .camera_visible = def->camera_visible,
                        .value = def->radiance,
                        .center = def->center,
                        .radius = def->radius};
    switch (light->kind)
    {
    case TY_LIGHT_ENVIRONMENT:
        ty_light_environment_init(light, def, image);
        break;
    case TY_LIGHT_RECTANGLE:
        ty_light_rectangle_init(light, def);
        break;
    case TY_LIGHT_SPHERE:
        break;
    case TY_LIGHT_POINT:
        light->value = def->intensity;
        break;
    case TY_LIGHT_DIRECTIONAL:
        light->value = def->irradiance;
        light->frame.n = ty_normalize(ty_sub(def->center, def->target));
        break;
    }
}

// What a light sends into the scene, roughly: watts of luminance. 0 = it is left to the rays.
static float light_power(const ty_light* light, float scene_radius)
{
    float y = ty_luminance(light->value), cross_section = TY_PI * scene_radius * scene_radius;
    switch (light->kind)
    {
    case TY_LIGHT_ENVIRONMENT:
        return light->distribution ? 4.0f * TY_PI * cross_section * ty_light_environment_mean(light) : 0.0f;
    case TY_LIGHT_RECTANGLE:
        return y * TY_PI * light->area;
    case TY_LIGHT_SPHERE:
        return y * TY_PI * 4.0f * TY_PI * light->radius * light->radius;
    case TY_LIGHT_POINT:
        return y * 4.0f * TY_PI;
    case TY_LIGHT_DIRECTIONAL:
        return y * cross_section;
    }
    return 0.0f;
}

// Probabilities: three quarters by power, one quarter evenly, so that a near weak light is not starved by a far strong
// one.
static void choose_probabilities(ty_light_set* set, float scene_radius)
{
    double total = 0.0;
    for (int i = 0; i < set->count; ++i)
    {
        float power = light_power(&set->lights[i], scene_radius);
        set->lights[i].probability = isfinite(power) ? power : TY_FLOAT_MAX;
        total += (double)set->lights[i].probability;
        if (power > 0.0f)
            set->chosen[set->chosen_count++] = i;
    }
    double sum = 0.0;
    for (int i = 0; i < set->chosen_count; ++i)
    {
        ty_light* light = &set->lights[set->chosen[i]];
        light->probability = (float)(0.75 * (double)light->probability / total + 0.25 / set->chosen_count);
        sum += (double)light->probability;
        set->cumulative[i] = (float)sum;
    }
}

void ty_light_set_init(ty_light_set* set, const ty_scene* scene)
{
    *set = (ty_light_set){.count = scene->light_count};
    set->lights = TY_ALLOC(ty_light, scene->light_count);
    set->chosen = TY_ALLOC(int, scene->light_count);
    set->cumulative = TY_ALLOC(float, scene->light_count);
    for (int i = 0; i < scene->light_count; ++i)
    {
        light_init(&set->lights[i], &scene->lights[i], scene->light_images ? scene->light_images[i] : NULL);
        set->has_shapes |= set->lights[i].kind == TY_LIGHT_RECTANGLE || set->lights[i].kind == TY_LIGHT_SPHERE;
    }
    ty_bounds bounds = ty_world_bounds(scene->world);
    float radius = 0.5f * ty_length(ty_sub(bounds.high, bounds.low));
    choose_probabilities(set, isfinite(radius) && radius > 0.0f ? radius : 1.0f);
}

void ty_light_set_term(ty_light_set* set)
{
    for (int i = 0; i < set->count; ++i)
        ty_distribution_destroy(set->lights[i].distribution);
    ty_free(set->lights);
    ty_free(set->chosen);
    ty_free(set->cumulative);
    *set = (ty_light_set){0};
}

static bool point_sample(const ty_light* light, ty_vec3 p, ty_light_sample* out)
{
    ty_vec3 d = ty_sub(light->center, p);
    float distance_sqr = ty_length_sqr(d);
    if (!(distance_sqr > 0.0f))
        return false;
    out->distance = sqrtf(distance_sqr);
    out->wi = ty_mul(d, 1.0f / out->distance);
    out->radiance = ty_rgb_scale(light->value, 1.0f / distance_sqr);
    out->pdf = 1.0f;
    out->delta = true;
    return true;
}

static bool directional_sample(const ty_light* light, ty_light_sample* out)
{
    *out = (ty_light_sample){light->frame.n, TY_FLOAT_MAX, light->value, 1.0f, true};
    return true;
}

static bool light_sample(const ty_light* light, ty_vec3 p, ty_vec2 u, ty_light_sample* out)
{
    switch (light->kind)
    {
    case TY_LIGHT_ENVIRONMENT:
        return ty_light_environment_sample(light, u, out);
    case TY_LIGHT_RECTANGLE:
        return ty_light_rectangle_sample(light, p, u, out);
    case TY_LIGHT_SPHERE:
        return ty_light_sphere_sample(light, p, u, out);
    case TY_LIGHT_POINT:
        return point_sample(light, p, out);
    case TY_LIGHT_DIRECTIONAL:
        return directional_sample(light, out);
    }
    return false;
}

bool ty_light_set_sample(const ty_light_set* set, ty_vec3 p, float u_choice, ty_vec2 u, ty_light_sample* out)
{
    if (set->chosen_count == 0)
        return false;
    int i = 0;
    while (i < set->chosen_count - 1 && u_choice >= set->cumulative[i])
        ++i;
    const ty_light* light = &set->lights[set->chosen[i]];
    if (!light_sample(light, p, u, out))
        return false;
    out->pdf *= light->probability;
    return out->pdf > 0.0f;
}

static float view_weight(const ty_light* light, const ty_light_view* view, float pdf)
{
    return view->full ? 1.0f : ty_power_heuristic(view->pdf, light->probability * pdf);
}

static ty_rgb shape_along(const ty_light* light, const ty_ray* ray, float t_max, const ty_light_view* view,
                          bool* covered)
{
    bool rectangle = light->kind == TY_LIGHT_RECTANGLE;
    float t;
    bool met = rectangle ? ty_light_rectangle_meet(light, ray, &t) : ty_light_sphere_meet(light, ray, &t);
    if (!met || t < ray->t_min || t * TY_LIGHT_REACH >= t_max)
        return (ty_rgb){0};
    *covered = true;
    if (view->full)
        return light->value;
    float pdf =
        rectangle ? ty_light_rectangle_pdf(light, view->from, ray->direction) : ty_light_sphere_pdf(light, view->from);
    return ty_rgb_scale(light->value, view_weight(light, view, pdf));
}

static ty_rgb environment_along(const ty_light* light, const ty_ray* ray, const ty_light_view* view)
{
    ty_rgb radiance = ty_light_environment_radiance(light, ray->direction);
    if (view->full || !light->distribution)
        return radiance;
    return ty_rgb_scale(radiance, view_weight(light, view, ty_light_environment_pdf(light, ray->direction)));
}

ty_rgb ty_light_set_along(const ty_light_set* set, const ty_ray* ray, float t, const ty_light_view* view, bool* covered)
{
    ty_rgb sum = {0};
    if (t < TY_FLOAT_MAX && !set->has_shapes)
        return sum;
    for (int i = 0; i < set->count; ++i)
    {
        const ty_light* light = &set->lights[i];
        if (view->camera && !light->camera_visible)
            continue;
        if (light->kind == TY_LIGHT_RECTANGLE || light->kind == TY_LIGHT_SPHERE)
            sum = ty_rgb_add(sum, shape_along(light, ray, t, view, covered));
        else if (light->kind == TY_LIGHT_ENVIRONMENT && t == TY_FLOAT_MAX)
            sum = ty_rgb_add(sum, environment_along(light, ray, view));
    }
    return sum;
}
