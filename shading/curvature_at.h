// SPDX-License-Identifier: Apache-2.0
// Curvature of an instance's surface at a point, under any affine map.
#pragma once
#include <tsuya/geometry/trace.h>

// How much larger than its prototype the instance is: cbrt |det M|.
float ty_instance_scale(const ty_affine* to_world);

// Whether the map keeps angles, to rounding; its stretch squared.
static inline bool ty_keeps_angles(const ty_affine* m, float* stretch_sqr)
{
    float xx = ty_dot(m->x, m->x), yy = ty_dot(m->y, m->y), zz = ty_dot(m->z, m->z), least = 1e-4f * xx;
    *stretch_sqr = (xx + yy + zz) * (1.0f / 3.0f);
    return fabsf(yy - xx) < least && fabsf(zz - xx) < least && fabsf(ty_dot(m->x, m->y)) < least &&
           fabsf(ty_dot(m->y, m->z)) < least && fabsf(ty_dot(m->z, m->x)) < least;
}

// A symmetric form on the tangents of a unit normal: (t,t), (t,b), (b,b).
typedef struct ty_form
{
    float tt, tb, bb;
} ty_form;

// (k1 + k2) / 2, the larger of k1 and k2, and the normal curvature towards (x, y), any length; 1/m, convex positive.
static inline float ty_form_mean(ty_form f)
{
    return 0.5f * (f.tt + f.bb);
}
static inline float ty_form_maximum(ty_form f)
{
    return ty_form_mean(f) + sqrtf(0.25f * ty_sqr(f.tt - f.bb) + f.tb * f.tb);
}
static inline float ty_form_towards(ty_form f, float x, float y)
{
    float r = x * x + y * y;
    return r > 1e-12f ? (f.tt * x * x + 2.0f * f.tb * x * y + f.bb * y * y) / r : ty_form_mean(f);
}

// Second fundamental form of the prototype at a point, in its space, for the tangents of a frame about the prototype's
// unit normal there; interpolated, since its axes have no sign and jump. Zero where the mesh has none.
ty_form ty_form_local(const ty_mesh* mesh, const ty_surface_point* point, ty_vec3 t, ty_vec3 b);

// The same of the instance, in world units, for the tangents of a frame about its normal.
ty_form ty_form_world(const ty_world* world, const ty_surface_point* point, ty_vec3 t, ty_vec3 b);
