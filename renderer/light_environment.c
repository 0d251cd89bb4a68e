// SPDX-License-Identifier: Apache-2.0
// Environment lights: constant, or a latitude-longitude image.
// The image's centre lies towards -z and its right half towards +x; the top row is +y.
#include "light.h"

static ty_vec3 direction_from_image(const ty_light* light, ty_vec2 p, float* sine)
{
    float s, c, azimuth_s, azimuth_c;
    ty_sincos(TY_PI * p.y, &s, &c);
    ty_sincos(2.0f * TY_PI * (p.x - 0.5f), &azimuth_s, &azimuth_c);
    *sine = s;
    return ty_to_world(light->frame, (ty_vec3){s * azimuth_s, c, -s * azimuth_c});
}

static ty_vec2 image_from_direction(const ty_light* light, ty_vec3 direction)
{
    ty_vec3 d = ty_to_local(light->frame, direction);
    float x = 0.5f + ty_atan2(d.x, -d.z) * (0.5f * TY_INV_PI);
    return (ty_vec2){ty_clamp(x, 0.0f, TY_ONE_MINUS_EPSILON),
                     ty_clamp(ty_acos(d.y) * TY_INV_PI, 0.0f, TY_ONE_MINUS_EPSILON)};
}

// Rows are not wrapped over the poles, whatever the texture's wrapping.
static ty_rgb image_lookup(const ty_light* light, ty_vec2 p)
{
    float margin = 0.5f / (float)ty_texture_height(light->image);
    return ty_texture_sample(light->image, (ty_vec2){p.x, ty_clamp(1.0f - p.y, margin, 1.0f - margin)});
}

ty_rgb ty_light_environment_radiance(const ty_light* light, ty_vec3 direction)
{
    if (!light->image)
        return light->value;
    return ty_rgb_mul(light->value, image_lookup(light, image_from_direction(light, direction)));
}

void ty_light_environment_init(ty_light* light, const ty_light_def* def, const ty_texture* image,
                               const ty_environment_table* table)
{
    ty_quat turn = ty_quat_multiply(ty_quat_axis_angle(ty_vec3_make(0.0f, 1.0f, 0.0f), def->rotate),
                                    ty_quat_euler(def->orientation));
    light->frame = (ty_frame){ty_quat_rotate(turn, ty_vec3_make(1.0f, 0.0f, 0.0f)),
                              ty_quat_rotate(turn, ty_vec3_make(0.0f, 1.0f, 0.0f)),
                              ty_quat_rotate(turn, ty_vec3_make(0.0f, 0.0f, 1.0f))};
    light->image = image;
    light->image_mean = table ? table->mean : 0.0f;
    light->distribution = table ? table->distribution : NULL;
}

float ty_light_environment_mean(const ty_light* light)
{
    return ty_luminance(light->value) * (light->image ? light->image_mean : 1.0f);
}

bool ty_light_environment_sample(const ty_light* light, ty_vec2 u, ty_light_sample* out)
{
    float pdf, sine;
    ty_vec2 p = ty_distribution_sample(light->distribution, u, &pdf);
    *out = (ty_light_sample){.wi = direction_from_image(light, p, &sine), .distance = TY_FLOAT_MAX};
    if (!(sine > 0.0f))
        return false;
    out->radiance = ty_rgb_mul(light->value, image_lookup(light, p));
    out->pdf = pdf / (2.0f * TY_PI * TY_PI * sine);
    return true;
}

float ty_light_environment_pdf(const ty_light* light, ty_vec3 wi)
{
    ty_vec2 p = image_from_direction(light, wi);
    float sine = ty_sin(TY_PI * p.y);
    return sine > 0.0f ? ty_distribution_pdf(light->distribution, p) / (2.0f * TY_PI * TY_PI * sine) : 0.0f;
}
