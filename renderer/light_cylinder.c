// SPDX-License-Identifier: Apache-2.0
// Cylinder lights: the round side of a tube, from outside. Sampled evenly over the arc that faces the point.
#include "light.h"

void ty_light_cylinder_init(ty_light* light, const ty_light_def* def)
{
    ty_vec3 axis = ty_normalize(def->axis);
    light->frame = ty_frame_from_normal(ty_length_sqr(axis) > 0.0f ? axis : ty_vec3_make(1.0f, 0.0f, 0.0f));
    light->half_size[0] = 0.5f * def->length;
}

// Half the arc seen from a distance of the axis; 0 = the side is not seen.
static float half_arc(const ty_light* light, float distance)
{
    return distance > light->radius ? ty_acos(light->radius / distance) : 0.0f;
}

// Density of an evenly chosen point q of the arc, per solid angle at p (both in the light's frame).
static float density(const ty_light* light, ty_vec3 p, ty_vec3 q, float arc)
{
    ty_vec3 d = ty_sub(p, q);
    float distance_sqr = ty_length_sqr(d), towards = q.x * d.x + q.y * d.y; // radius * distance * cosine
    float strip = 2.0f * arc * 2.0f * light->half_size[0];                  // area over radius
    return towards > 0.0f ? distance_sqr * sqrtf(distance_sqr) / (towards * strip) : 0.0f;
}

bool ty_light_cylinder_sample(const ty_light* light, ty_vec3 from, ty_vec2 u, ty_light_sample* out)
{
    ty_vec3 p = ty_to_local(light->frame, ty_sub(from, light->center));
    float distance = sqrtf(p.x * p.x + p.y * p.y), arc = half_arc(light, distance), s, c;
    if (!(arc > 0.0f))
        return false;
    ty_sincos((2.0f * u.x - 1.0f) * arc, &s, &c);
    float x = p.x / distance, y = p.y / distance; // towards p
    ty_vec3 q = {light->radius * (c * x - s * y), light->radius * (s * x + c * y),
                 (2.0f * u.y - 1.0f) * light->half_size[0]};
    ty_vec3 d = ty_sub(q, p);
    out->distance = ty_length(d);
    out->wi = ty_to_world(light->frame, ty_mul(d, 1.0f / out->distance));
    out->radiance = light->value;
    out->pdf = density(light, p, q, arc);
    out->delta = false;
    return out->pdf > 0.0f && isfinite(out->pdf);
}

// The point of the side where a ray from outside enters, in the light's frame.
static bool enter(const ty_light* light, ty_vec3 o, ty_vec3 d, ty_vec3* q, float* t)
{
    float flat_sqr = d.x * d.x + d.y * d.y, along = -(o.x * d.x + o.y * d.y);
    if (!(along > 0.0f) || o.x * o.x + o.y * o.y <= ty_sqr(light->radius))
        return false;
    // By the nearest point to the axis: no cancellation for a far thin tube.
    float nearest = along / flat_sqr, x = o.x + d.x * nearest, y = o.y + d.y * nearest;
    float half_chord_sqr = ty_sqr(light->radius) - x * x - y * y;
    if (half_chord_sqr < 0.0f)
        return false;
    *t = nearest - sqrtf(half_chord_sqr / flat_sqr);
    *q = ty_mad(o, d, *t);
    return *t > 0.0f && fabsf(q->z) <= light->half_size[0];
}

bool ty_light_cylinder_meet(const ty_light* light, const ty_ray* ray, float* t)
{
    ty_vec3 q;
    return enter(light, ty_to_local(light->frame, ty_sub(ray->origin, light->center)),
                 ty_to_local(light->frame, ray->direction), &q, t);
}

float ty_light_cylinder_pdf(const ty_light* light, ty_vec3 from, ty_vec3 wi)
{
    ty_vec3 p = ty_to_local(light->frame, ty_sub(from, light->center)), q;
    float t;
    if (!enter(light, p, ty_to_local(light->frame, wi), &q, &t))
        return 0.0f;
    return density(light, p, q, half_arc(light, sqrtf(p.x * p.x + p.y * p.y)));
}
