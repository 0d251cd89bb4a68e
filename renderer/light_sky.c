// SPDX-License-Identifier: Apache-2.0
// A sky by three colours with its sun apart, and lights from a direction: a disc of even radiance, or a single ray.
#include "light.h"

void ty_light_directional_init(ty_light* light, ty_vec3 towards, ty_rgb irradiance, float angle)
{
    light->kind = TY_LIGHT_DIRECTIONAL;
    light->frame = ty_frame_from_normal(ty_normalize(towards));
    light->value = irradiance;
    float s = ty_sin(0.5f * angle), sine_sqr = s * s, quarter = ty_sin(0.25f * angle);
    light->one_minus_cos = 2.0f * quarter * quarter;
    light->cos_outer = 1.0f - light->one_minus_cos;
    // The integral of the cosine to the axis over the disc is pi sin^2.
    if (light->one_minus_cos > 0.0f)
        light->value = ty_rgb_scale(irradiance, TY_INV_PI / sine_sqr);
}

float ty_light_directional_pdf(const ty_light* light)
{
    return 0.5f * TY_INV_PI / light->one_minus_cos;
}

// By the distance of the ends of unit vectors: a cosine near 1 would not tell a small disc's rim.
bool ty_light_directional_covers(const ty_light* light, ty_vec3 direction)
{
    return ty_length_sqr(ty_sub(direction, light->frame.n)) <= 2.0f * light->one_minus_cos;
}

bool ty_light_directional_sample(const ty_light* light, ty_vec2 u, ty_light_sample* out)
{
    out->distance = TY_FLOAT_MAX;
    out->radiance = light->value;
    out->delta = !(light->one_minus_cos > 0.0f);
    if (out->delta)
    {
        out->wi = light->frame.n;
        out->pdf = 1.0f;
        return true;
    }
    float c = u.x * light->one_minus_cos, sine = ty_safe_sqrt(c * (2.0f - c)), s, k;
    ty_sincos(2.0f * TY_PI * u.y, &s, &k);
    out->wi = ty_to_world(light->frame, (ty_vec3){sine * k, sine * s, 1.0f - c});
    out->pdf = ty_light_directional_pdf(light);
    return true;
}

// Azimuth from -z over +x, as the columns of an environment's image.
static ty_vec3 direction_of(float elevation, float azimuth)
{
    float s, c, up, flat;
    ty_sincos(elevation, &up, &flat);
    ty_sincos(azimuth, &s, &c);
    return (ty_vec3){flat * s, up, -flat * c};
}

void ty_light_sky_init(ty_light* gradient, ty_light* sun, const ty_light_def* def)
{
    gradient->value = def->zenith;
    gradient->horizon = def->horizon;
    gradient->ground = def->ground;
    gradient->falloff = def->falloff;
    // Turning about +y takes +z towards +x, against the azimuth.
    ty_light_directional_init(sun, direction_of(def->sun_elevation, def->sun_azimuth - def->rotate),
                              def->sun_irradiance, def->sun_angle);
}

ty_rgb ty_light_sky_radiance(const ty_light* light, ty_vec3 direction)
{
    float share = ty_pow(ty_min(fabsf(direction.y), 1.0f), light->falloff);
    return ty_rgb_lerp(light->horizon, direction.y < 0.0f ? light->ground : light->value, share);
}
