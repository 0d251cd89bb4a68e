// SPDX-License-Identifier: Apache-2.0
// Point and spot lights: all light from one point, within a cone that fades at its rim and may project an image.
#include "light.h"

#define NO_CONE (-2.0f)

void ty_light_spot_init(ty_light* light, const ty_light_def* def, const ty_texture* image)
{
    light->value = def->intensity;
    light->cos_outer = NO_CONE;
    if (light->kind == TY_LIGHT_POINT)
        return;
    ty_vec3 n = ty_normalize(ty_sub(def->target, def->center));
    n = ty_length_sqr(n) > 0.0f ? n : ty_vec3_make(0.0f, -1.0f, 0.0f);
    ty_vec3 side = ty_cross(def->up, n);
    light->frame = ty_frame_from_normal(n);
    if (ty_length_sqr(side) > 1e-12f * ty_length_sqr(def->up))
    {
        light->frame.t = ty_normalize(side);
        light->frame.b = ty_cross(n, light->frame.t);
    }
    light->cos_outer = ty_cos(0.5f * def->cone);
    float inner = ty_cos(0.5f * def->cone * (1.0f - def->penumbra));
    light->fade = inner > light->cos_outer ? 1.0f / (inner - light->cos_outer) : TY_FLOAT_MAX;
    light->image = image;
}

// The image fills the square around the cone, upright for one who looks from the light.
static ty_rgb projected(const ty_light* light, ty_vec3 d)
{
    float tangent = ty_safe_sqrt(1.0f - ty_sqr(light->cos_outer)) / light->cos_outer, scale = 0.5f / (d.z * tangent);
    return ty_texture_sample(light->image, (ty_vec2){0.5f - d.x * scale, 0.5f + d.y * scale});
}

// Intensity towards a direction; the fade is a smooth step in the cosine.
static ty_rgb intensity(const ty_light* light, ty_vec3 direction)
{
    if (light->cos_outer == NO_CONE)
        return light->value;
    ty_vec3 d = ty_to_local(light->frame, direction);
    float s = ty_clamp((d.z - light->cos_outer) * light->fade, 0.0f, 1.0f);
    ty_rgb value = ty_rgb_scale(light->value, ty_smoothstep(s));
    return light->image && s > 0.0f ? ty_rgb_mul(value, projected(light, d)) : value;
}

bool ty_light_spot_sample(const ty_light* light, ty_vec3 p, ty_light_sample* out)
{
    ty_vec3 d = ty_sub(light->center, p);
    float distance_sqr = ty_length_sqr(d);
    if (!(distance_sqr > 0.0f))
        return false;
    out->distance = sqrtf(distance_sqr);
    out->wi = ty_mul(d, 1.0f / out->distance);
    out->radiance = ty_rgb_scale(intensity(light, ty_neg(out->wi)), 1.0f / distance_sqr);
    out->pdf = 1.0f;
    out->delta = true;
    return !ty_rgb_is_black(out->radiance);
}
