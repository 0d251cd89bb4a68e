// SPDX-License-Identifier: Apache-2.0
// Points of a triangle.
#pragma once
#include <tsuya/base/math.h>

// Closest point of a triangle as barycentric weights u, v of b and c (Ericson 2004, Real-Time Collision
// Detection, 5.1.5).
static inline ty_vec2 ty_triangle_closest(ty_vec3 p, ty_vec3 a, ty_vec3 b, ty_vec3 c)
{
    ty_vec3 ab = ty_sub(b, a), ac = ty_sub(c, a), ap = ty_sub(p, a), bp = ty_sub(p, b), cp = ty_sub(p, c);
    float d1 = ty_dot(ab, ap), d2 = ty_dot(ac, ap), d3 = ty_dot(ab, bp), d4 = ty_dot(ac, bp);
    float d5 = ty_dot(ab, cp), d6 = ty_dot(ac, cp);
    if (d1 <= 0.0f && d2 <= 0.0f)
        return (ty_vec2){0.0f, 0.0f};
    if (d3 >= 0.0f && d4 <= d3)
        return (ty_vec2){1.0f, 0.0f};
    if (d6 >= 0.0f && d5 <= d6)
        return (ty_vec2){0.0f, 1.0f};
    float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f)
        return (ty_vec2){d1 / (d1 - d3), 0.0f};
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f)
        return (ty_vec2){0.0f, d2 / (d2 - d6)};
    if (va <= 0.0f && d4 >= d3 && d5 >= d6)
    {
        float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (ty_vec2){1.0f - w, w};
    }
    float inverse = 1.0f / (va + vb + vc);
    return (ty_vec2){vb * inverse, vc * inverse};
}

static inline ty_vec3 ty_triangle_at(ty_vec3 a, ty_vec3 b, ty_vec3 c, ty_vec2 weights)
{
    return ty_mad(ty_mad(a, ty_sub(b, a), weights.x), ty_sub(c, a), weights.y);
}
