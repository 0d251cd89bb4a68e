// SPDX-License-Identifier: Apache-2.0
// Signed distances to the space inside the built-in shapes.
#include "shape_build.h"

// Box with round edges about the origin (Quilez, "Distance functions").
static float box_distance(ty_vec3 p, ty_vec3 size, float rounding)
{
    ty_vec3 q = {fabsf(p.x) - size.x + rounding, fabsf(p.y) - size.y + rounding, fabsf(p.z) - size.z + rounding};
    ty_vec3 outside = ty_max3(q, (ty_vec3){0, 0, 0});
    return ty_length(outside) + ty_min(ty_max(q.x, ty_max(q.y, q.z)), 0.0f) - rounding;
}

static float cylinder_distance(ty_vec3 p, const ty_shape_def* def)
{
    float r = sqrtf(p.x * p.x + p.z * p.z) - def->radius + def->rounding;
    float y = fabsf(p.y) - 0.5f * def->height + def->rounding;
    float outside = sqrtf(ty_sqr(ty_max(r, 0.0f)) + ty_sqr(ty_max(y, 0.0f)));
    return outside + ty_min(ty_max(r, y), 0.0f) - def->rounding;
}

// The nearest point of the ellipsoid is x_i = s_i^2 p_i / (t + s_i^2), with t the largest root of
// sum (s_i p_i / (t + s_i^2))^2 = 1 (Eberly, "Distance from a point to an ellipse, an ellipsoid"). Newton's method
// rises to that root from the left, since the sum is convex and falling there.
static float ellipsoid_distance(ty_vec3 point, ty_vec3 size)
{
    double s[3] = {(double)size.x, (double)size.y, (double)size.z};
    double p[3] = {fabs((double)point.x), fabs((double)point.y), fabs((double)point.z)};
    int least = s[0] < s[1] ? (s[0] < s[2] ? 0 : 2) : (s[1] < s[2] ? 1 : 2);
    // On the plane of symmetry across the shortest axis the root can leave the bracket; a hair beside it nothing
    // changes.
    p[least] = fmax(p[least], 1e-9 * s[least]);
    double t = s[least] * (p[least] - s[least]), level = -1.0;
    for (int k = 0; k < 3; k++)
        level += (p[k] / s[k]) * (p[k] / s[k]);
    for (int i = 0; i < 100; i++)
    {
        double value = -1.0, slope = 0.0;
        for (int k = 0; k < 3; k++)
        {
            double d = t + s[k] * s[k], x = s[k] * p[k] / d;
            value += x * x;
            slope -= 2.0 * x * x / d;
        }
        double step = value / slope;
        t -= step;
        if (fabs(step) <= 1e-14 * s[least] * s[least])
            break;
    }
    double sum = 0.0;
    for (int k = 0; k < 3; k++)
    {
        double d = p[k] * t / (t + s[k] * s[k]); // p - x
        sum += d * d;
    }
    return (float)(level < 0.0 ? -sqrt(sum) : sqrt(sum));
}

float ty_shape_interior_distance(const ty_shape_def* given, ty_vec3 p)
{
    const ty_shape_def complete = ty_shape_def_complete(given), *def = &complete;
    switch ((ty_shape_kind)def->kind)
    {
    case TY_SHAPE_SPHERE:
        return ty_length(p) - def->radius;
    case TY_SHAPE_ELLIPSOID:
        return ellipsoid_distance(p, def->size);
    case TY_SHAPE_BOX:
        return box_distance(p, def->size, def->rounding);
    case TY_SHAPE_CYLINDER:
        return cylinder_distance(p, def);
    case TY_SHAPE_TORUS:
        return sqrtf(ty_sqr(sqrtf(p.x * p.x + p.z * p.z) - def->radius) + p.y * p.y) - def->tube;
    case TY_SHAPE_BOWL:
        return ty_shape_bowl_distance(def, p);
    case TY_SHAPE_DOME:
        return ty_max(ellipsoid_distance(p, (ty_vec3){def->radius, def->height, def->radius}), -p.y);
    case TY_SHAPE_PLANE:
    case TY_SHAPE_DISC:
    case TY_SHAPE_STONE:
    case TY_SHAPE_BLOCK:
    case TY_SHAPE_LATHE:
    case TY_SHAPE_TUBE:
    case TY_SHAPE_SWEEP:
        break;
    }
    return TY_FLOAT_MAX;
}
