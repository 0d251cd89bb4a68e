// SPDX-License-Identifier: Apache-2.0
// What choosing a light needs to know of it: where it is, where it shines to, how much light it sends.
#include "light.h"

static ty_vec3 absolute(ty_vec3 v)
{
    return (ty_vec3){fabsf(v.x), fabsf(v.y), fabsf(v.z)};
}

// Half the extent of a disc of radius 1 with normal n.
static ty_vec3 disc_extent(ty_vec3 n)
{
    return (ty_vec3){ty_safe_sqrt(1.0f - n.x * n.x), ty_safe_sqrt(1.0f - n.y * n.y), ty_safe_sqrt(1.0f - n.z * n.z)};
}

static ty_vec3 half_extent(const ty_light* light)
{
    const ty_frame* f = &light->frame;
    switch (light->kind)
    {
    case TY_LIGHT_RECTANGLE:
        return ty_mad(ty_mul(absolute(f->t), light->half_size[0]), absolute(f->b), light->half_size[1]);
    case TY_LIGHT_DISK:
        return ty_mul(disc_extent(f->n), light->radius);
    case TY_LIGHT_CYLINDER:
        return ty_mad(ty_mul(disc_extent(f->n), light->radius), absolute(f->n), light->half_size[0]);
    case TY_LIGHT_SPHERE:
        return (ty_vec3){light->radius, light->radius, light->radius};
    case TY_LIGHT_ENVIRONMENT:
    case TY_LIGHT_SKY:
    case TY_LIGHT_POINT:
    case TY_LIGHT_SPOT:
    case TY_LIGHT_DIRECTIONAL:
        break;
    }
    return (ty_vec3){0};
}

// Radiant intensity (luminance) in the direction where it is largest.
static float intensity(const ty_light* light)
{
    float y = ty_luminance(light->value);
    switch (light->kind)
    {
    case TY_LIGHT_RECTANGLE:
    case TY_LIGHT_DISK:
        return y * light->area;
    case TY_LIGHT_SPHERE:
        return y * TY_PI * ty_sqr(light->radius);
    case TY_LIGHT_CYLINDER:
        return y * 4.0f * light->radius * light->half_size[0];
    case TY_LIGHT_POINT:
    case TY_LIGHT_SPOT:
        return y;
    case TY_LIGHT_ENVIRONMENT:
    case TY_LIGHT_SKY:
    case TY_LIGHT_DIRECTIONAL:
        break;
    }
    return 0.0f;
}

static bool has_place(const ty_light* light)
{
    return ty_light_is_shape(light) || light->kind == TY_LIGHT_POINT || light->kind == TY_LIGHT_SPOT;
}

bool ty_light_leaf(const ty_light_set* set, int emitter, ty_light_node* out)
{
    if (emitter >= set->light_count)
        return ty_light_mesh_leaf(set, &set->meshes[emitter - set->light_count], out);
    const ty_light* light = &set->lights[emitter];
    if (!has_place(light))
        return false;
    ty_vec3 half = half_extent(light);
    bool flat = light->kind == TY_LIGHT_RECTANGLE || light->kind == TY_LIGHT_DISK;
    bool cone = light->kind == TY_LIGHT_SPOT;
    *out = (ty_light_node){.low = ty_sub(light->center, half),
                           .high = ty_add(light->center, half),
                           .axis = flat || cone ? light->frame.n : ty_vec3_make(0.0f, 0.0f, 1.0f),
                           .cos_o = flat || cone ? 1.0f : -1.0f,
                           .cos_e = cone ? ty_max(light->cos_outer, 0.0f) : 0.0f,
                           .energy = intensity(light),
                           .even = flat || cone ? 0.0f : 1.0f,
                           .mean = flat || cone ? light->frame.n : (ty_vec3){0}};
    return true;
}

float ty_light_irradiance(const ty_light* light)
{
    if (light->kind == TY_LIGHT_ENVIRONMENT)
        return light->distribution ? TY_PI * ty_light_environment_mean(light) : 0.0f;
    float y = ty_luminance(light->value);
    if (light->kind != TY_LIGHT_DIRECTIONAL)
        return 0.0f;
    return light->one_minus_cos > 0.0f ? y / ty_light_directional_pdf(light) : y;
}

float ty_light_power(const ty_light_set* set, int emitter, float scene_radius)
{
    ty_light_node leaf;
    const ty_light* light = emitter < set->light_count ? &set->lights[emitter] : NULL;
    if (light && light->kind == TY_LIGHT_ENVIRONMENT)
        return 4.0f * TY_PI * scene_radius * scene_radius * ty_light_irradiance(light);
    if (!ty_light_leaf(set, emitter, &leaf))
        return TY_PI * scene_radius * scene_radius * ty_light_irradiance(light);
    // Lambert's law over one side, or every direction alike.
    bool even = light && !ty_light_is_shape(light);
    bool round = light && (light->kind == TY_LIGHT_SPHERE || light->kind == TY_LIGHT_CYLINDER);
    return leaf.energy * (even || round ? 4.0f * TY_PI : TY_PI);
}
