// SPDX-License-Identifier: Apache-2.0
// Sphere lights: the cone they fill, or every direction from inside.
#include "light.h"

// 1 - cosine of the half angle seen from p; 0 = p is inside.
static float one_minus_cos(const ty_light* light, ty_vec3 p)
{
    float sine_sqr = ty_sqr(light->radius) / ty_length_sqr(ty_sub(light->center, p));
    return sine_sqr < 0.9999f ? sine_sqr / (1.0f + sqrtf(1.0f - sine_sqr)) : 0.0f;
}

float ty_light_sphere_pdf(const ty_light* light, ty_vec3 p)
{
    float m = one_minus_cos(light, p);
    return m > 0.0f ? 1.0f / (2.0f * TY_PI * m) : 1.0f / (4.0f * TY_PI);
}

bool ty_light_sphere_meet(const ty_light* light, const ty_ray* ray, float* t)
{
    ty_vec3 d = ty_sub(light->center, ray->origin);
    float along = ty_dot(d, ray->direction);
    // The distance from the axis by the perpendicular part: no cancellation for a far light.
    float half_chord_sqr = ty_sqr(light->radius) - ty_length_sqr(ty_mad(d, ray->direction, -along));
    if (half_chord_sqr < 0.0f)
        return false;
    float half_chord = sqrtf(half_chord_sqr);
    *t = along - half_chord >= ray->t_min ? along - half_chord : along + half_chord;
    return true;
}

bool ty_light_sphere_sample(const ty_light* light, ty_vec3 p, ty_vec2 u, ty_light_sample* out)
{
    ty_vec3 d = ty_sub(light->center, p);
    float m = one_minus_cos(light, p);
    if (m > 0.0f)
    {
        float c = u.x * m, sine = ty_safe_sqrt(c * (2.0f - c)), s, k; // c = 1 - cosine
        ty_sincos(2.0f * TY_PI * u.y, &s, &k);
        out->wi = ty_to_world(ty_frame_from_normal(ty_normalize(d)), (ty_vec3){sine * k, sine * s, 1.0f - c});
        float along = ty_dot(d, out->wi);
        float perpendicular_sqr = ty_length_sqr(ty_mad(d, out->wi, -along));
        out->distance = along - ty_safe_sqrt(ty_sqr(light->radius) - perpendicular_sqr);
    }
    else
    {
        out->wi = ty_sample_sphere(u);
        float along = ty_dot(d, out->wi);
        out->distance = along + ty_safe_sqrt(ty_sqr(light->radius) - ty_length_sqr(d) + ty_sqr(along));
    }
    out->radiance = light->value;
    out->pdf = ty_light_sphere_pdf(light, p);
    out->delta = false;
    return out->distance > 0.0f;
}
