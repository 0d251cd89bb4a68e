// SPDX-License-Identifier: Apache-2.0
// Disk lights, lit on one side: sampled by area.
#include "light.h"

void ty_light_disk_init(ty_light* light, const ty_light_def* def)
{
    ty_vec3 n = ty_normalize(ty_sub(def->target, def->center));
    light->frame = ty_frame_from_normal(ty_length_sqr(n) > 0.0f ? n : ty_vec3_make(0.0f, -1.0f, 0.0f));
    light->area = TY_PI * ty_sqr(def->radius);
}

bool ty_light_disk_sample(const ty_light* light, ty_vec3 p, ty_vec2 u, ty_light_sample* out)
{
    ty_vec2 q = ty_sample_disc(u);
    ty_vec3 d = ty_sub(
        ty_mad(ty_mad(light->center, light->frame.t, light->radius * q.x), light->frame.b, light->radius * q.y), p);
    float distance_sqr = ty_length_sqr(d), height = -ty_dot(ty_sub(light->center, p), light->frame.n);
    if (!(height > 0.0f))
        return false;
    out->distance = sqrtf(distance_sqr);
    out->wi = ty_mul(d, 1.0f / out->distance);
    out->radiance = light->value;
    out->pdf = distance_sqr * out->distance / (height * light->area);
    out->delta = false;
    return true;
}

bool ty_light_disk_meet(const ty_light* light, const ty_ray* ray, float* t)
{
    float cosine = -ty_dot(ray->direction, light->frame.n);
    if (!(cosine > 0.0f))
        return false;
    ty_vec3 d = ty_sub(ray->origin, light->center);
    *t = ty_dot(d, light->frame.n) / cosine;
    return *t > 0.0f && ty_length_sqr(ty_mad(d, ray->direction, *t)) <= ty_sqr(light->radius);
}

float ty_light_disk_pdf(const ty_light* light, ty_vec3 p, ty_vec3 wi)
{
    float cosine = -ty_dot(wi, light->frame.n), height = -ty_dot(ty_sub(light->center, p), light->frame.n);
    if (!(cosine > 0.0f) || !(height > 0.0f))
        return 0.0f;
    return height * height / (cosine * cosine * cosine * light->area);
}
