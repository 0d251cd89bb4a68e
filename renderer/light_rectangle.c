// SPDX-License-Identifier: Apache-2.0
// Rectangle lights, lit on one side: sampled by area from afar, by solid angle from near (Urena, Fajardo and King 2013,
// "An area-preserving parametrization for spherical rectangles").
#include "light.h"

void ty_light_rectangle_init(ty_light* light, const ty_light_def* def)
{
    ty_vec3 n = ty_normalize(ty_sub(def->target, def->center));
    if (ty_length_sqr(n) == 0.0f)
        n = ty_vec3_make(0.0f, -1.0f, 0.0f);
    ty_vec3 side = ty_cross(def->up, n);
    light->frame = ty_frame_from_normal(n);
    if (ty_length_sqr(side) > 1e-12f * ty_length_sqr(def->up))
    {
        light->frame.t = ty_normalize(side);
        light->frame.b = ty_cross(n, light->frame.t);
    }
    light->half_size[0] = 0.5f * def->size[0];
    light->half_size[1] = 0.5f * def->size[1];
    light->area = def->size[0] * def->size[1];
}

// The rectangle seen from a point on its lit side: corners (x0..x1, y0..y1, -z) in its own frame.
typedef struct view
{
    float x0, x1, y0, y1, z; // z > 0: distance of the point from the plane
    float b0, b1, k;         // of the paper
    float solid_angle;       // 0 = far: sample by area
} view;

static bool view_init(const ty_light* light, ty_vec3 p, view* v)
{
    ty_vec3 d = ty_to_local(light->frame, ty_sub(light->center, p));
    float hx = light->half_size[0], hy = light->half_size[1];
    *v = (view){.x0 = d.x - hx, .x1 = d.x + hx, .y0 = d.y - hy, .y1 = d.y + hy, .z = -d.z};
    if (!(v->z > 0.0f))
        return false;
    float gap_x = ty_max(fabsf(d.x) - hx, 0.0f), gap_y = ty_max(fabsf(d.y) - hy, 0.0f);
    float nearest_sqr = gap_x * gap_x + gap_y * gap_y + v->z * v->z;
    if (nearest_sqr > 4.0f * (hx * hx + hy * hy)) // one diagonal: beyond, the solid angle hardly varies over it
        return true;
    float z_sqr = v->z * v->z;
    float n0 = -v->y0 / sqrtf(v->y0 * v->y0 + z_sqr), n1 = v->x1 / sqrtf(v->x1 * v->x1 + z_sqr);
    float n2 = v->y1 / sqrtf(v->y1 * v->y1 + z_sqr), n3 = -v->x0 / sqrtf(v->x0 * v->x0 + z_sqr);
    float g0 = ty_acos(-n0 * n1), g1 = ty_acos(-n1 * n2), g2 = ty_acos(-n2 * n3), g3 = ty_acos(-n3 * n0);
    v->b0 = n0;
    v->b1 = n2;
    v->k = 2.0f * TY_PI - g2 - g3;
    float solid_angle = g0 + g1 - v->k;
    v->solid_angle = solid_angle > 1e-3f ? solid_angle : 0.0f; // below, cancellation spoils it
    return true;
}

// Point of the spherical rectangle, as offset from the seeing point in the light's frame.
static ty_vec3 sample_solid_angle(const view* v, ty_vec2 u)
{
    float au = u.x * v->solid_angle + v->k, sine, cosine;
    ty_sincos(au, &sine, &cosine);
    float fu = (cosine * v->b0 - v->b1) / sine;
    float cu = ty_clamp(copysignf(1.0f / sqrtf(fu * fu + v->b0 * v->b0), fu), -1.0f, 1.0f);
    float x = ty_clamp(cu * v->z / sqrtf(ty_max(1.0f - cu * cu, 1e-12f)), v->x0, v->x1);
    float d = sqrtf(x * x + v->z * v->z);
    float h0 = v->y0 / sqrtf(d * d + v->y0 * v->y0), h1 = v->y1 / sqrtf(d * d + v->y1 * v->y1);
    float h = ty_lerp(h0, h1, u.y);
    float y = h * h < 1.0f - 1e-6f ? h * d / sqrtf(1.0f - h * h) : copysignf(TY_FLOAT_MAX, h);
    return (ty_vec3){x, ty_clamp(y, v->y0, v->y1), -v->z};
}

bool ty_light_rectangle_sample(const ty_light* light, ty_vec3 p, ty_vec2 u, ty_light_sample* out)
{
    view v;
    if (!view_init(light, p, &v))
        return false;
    ty_vec3 d = v.solid_angle > 0.0f ? sample_solid_angle(&v, u)
                                     : (ty_vec3){ty_lerp(v.x0, v.x1, u.x), ty_lerp(v.y0, v.y1, u.y), -v.z};
    float distance_sqr = ty_length_sqr(d), distance = sqrtf(distance_sqr);
    out->distance = distance;
    out->wi = ty_to_world(light->frame, ty_mul(d, 1.0f / distance));
    out->radiance = light->value;
    out->pdf = v.solid_angle > 0.0f ? 1.0f / v.solid_angle : distance_sqr * distance / (light->area * v.z);
    out->delta = false;
    return true;
}

float ty_light_rectangle_pdf(const ty_light* light, ty_vec3 p, ty_vec3 wi)
{
    view v;
    float cosine = -ty_dot(wi, light->frame.n);
    if (!view_init(light, p, &v) || !(cosine > 0.0f))
        return 0.0f;
    return v.solid_angle > 0.0f ? 1.0f / v.solid_angle : v.z * v.z / (cosine * cosine * cosine * light->area);
}
