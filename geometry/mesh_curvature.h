// SPDX-License-Identifier: Apache-2.0
// Symmetric curvature tensors in a tangent plane and their principal values.
#pragma once
#include <tsuya/base/math.h>

// The second fundamental form on an orthonormal pair (t, b), convex positive: tt t t + tb (t b + b t) + bb b b.
typedef struct ty_curvature_tensor
{
    float tt, tb, bb;
} ty_curvature_tensor;

// k1 >= k2; direction (unit, in the plane of t and b) belongs to k1; it is t where both are equal.
static inline void ty_curvature_decompose(ty_curvature_tensor c, ty_vec3 t, ty_vec3 b, float* k1, float* k2,
                                          ty_vec3* direction)
{
    float mean = 0.5f * (c.tt + c.bb), half = 0.5f * (c.tt - c.bb);
    float radius = sqrtf(half * half + c.tb * c.tb);
    *k1 = mean + radius;
    *k2 = mean - radius;
    // Of the two forms of the eigenvector the one without cancellation.
    float x = half >= 0.0f ? half + radius : c.tb, y = half >= 0.0f ? c.tb : radius - half;
    ty_vec3 d = ty_add(ty_mul(t, x), ty_mul(b, y));
    *direction = radius > 0.0f && ty_length_sqr(d) > 0.0f ? ty_normalize(d) : t;
}
