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
    light->far_sqr = 9.0f * (ty_sqr(light->half_size[0]) + ty_sqr(light->half_size[1]));
}

// Further than one diagonal from the nearest point: beyond, the solid angle hardly varies over it. d: the rectangle's
// centre from the seeing point, in its own frame. One and a half diagonals from the centre are always enough.
static inline bool is_far(const ty_light* light, ty_vec3 d)
{
    if (ty_length_sqr(d) > light->far_sqr)
        return true;
    float hx = light->half_size[0], hy = light->half_size[1];
    float gap_x = ty_max(fabsf(d.x) - hx, 0.0f), gap_y = ty_max(fabsf(d.y) - hy, 0.0f);
    return gap_x * gap_x + gap_y * gap_y + d.z * d.z > 4.0f * (hx * hx + hy * hy);
}

// The rectangle seen from a point on its lit side: corners (x0..x1, y0..y1, -z) in its own frame.
typedef struct view
{
    float x0, x1, y0, y1, z; // z > 0: distance of the point from the plane
    float b0, b1, k;         // of the paper
    float solid_angle;
} view;

static view view_make(const ty_light* light, ty_vec3 d)
{
    float hx = light->half_size[0], hy = light->half_size[1];
    view v = {.x0 = d.x - hx, .x1 = d.x + hx, .y0 = d.y - hy, .y1 = d.y + hy, .z = -d.z};
    float z_sqr = v.z * v.z;
    float n0 = -v.y0 / sqrtf(v.y0 * v.y0 + z_sqr), n1 = v.x1 / sqrtf(v.x1 * v.x1 + z_sqr);
    float n2 = v.y1 / sqrtf(v.y1 * v.y1 + z_sqr), n3 = -v.x0 / sqrtf(v.x0 * v.x0 + z_sqr);
    float g0 = ty_acos(-n0 * n1), g1 = ty_acos(-n1 * n2), g2 = ty_acos(-n2 * n3), g3 = ty_acos(-n3 * n0);
    v.b0 = n0;
    v.b1 = n2;
    v.k = 2.0f * TY_PI - g2 - g3;
    v.solid_angle = g0 + g1 - v.k;
    return v;
}

// 0 = it is to be sampled by area: cancellation spoils the angle where it is small.
static float usable(float solid_angle)
{
    return solid_angle > 1e-3f ? solid_angle : 0.0f;
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

// The same from near, where it can be; *solid_angle = 0 else. Kept out of the way of the simple case.
static __attribute__((noinline)) void sample_near(const ty_light* light, ty_vec2 u, ty_vec3* d, float* solid_angle)
{
    view v = view_make(light, *d);
    *solid_angle = usable(v.solid_angle);
    if (*solid_angle > 0.0f)
        *d = sample_solid_angle(&v, u);
}

bool ty_light_rectangle_sample(const ty_light* light, ty_vec3 p, ty_vec2 u, ty_light_sample* out)
{
    ty_vec3 d = ty_to_local(light->frame, ty_sub(light->center, p));
    if (!(d.z < 0.0f))
        return false;
    float solid_angle = 0.0f, z = -d.z, hx = light->half_size[0], hy = light->half_size[1];
    if (!is_far(light, d))
        sample_near(light, u, &d, &solid_angle);
    if (!(solid_angle > 0.0f))
        d = (ty_vec3){ty_lerp(d.x - hx, d.x + hx, u.x), ty_lerp(d.y - hy, d.y + hy, u.y), d.z};
    float distance_sqr = ty_length_sqr(d), distance = sqrtf(distance_sqr);
    out->distance = distance;
    out->wi = ty_to_world(light->frame, ty_mul(d, 1.0f / distance));
    out->radiance = light->value;
    out->pdf = solid_angle > 0.0f ? 1.0f / solid_angle : distance_sqr * distance / (light->area * z);
    out->delta = false;
    return true;
}

float ty_light_rectangle_pdf(const ty_light* light, ty_vec3 p, ty_vec3 wi)
{
    ty_vec3 d = ty_to_local(light->frame, ty_sub(light->center, p));
    float cosine = -ty_dot(wi, light->frame.n);
    if (!(d.z < 0.0f) || !(cosine > 0.0f))
        return 0.0f;
    float solid_angle = is_far(light, d) ? 0.0f : usable(view_make(light, d).solid_angle);
    return solid_angle > 0.0f ? 1.0f / solid_angle : d.z * d.z / (cosine * cosine * cosine * light->area);
}
