// SPDX-License-Identifier: Apache-2.0
// A ray against the sixteen boxes of a node of the wide top level.
#pragma once
#include "trace_wide.h"

// The ray for the box test: reciprocal direction, minus the origin by it, and for each axis which planes it meets
// first.
typedef struct ty_box_ray
{
    ty_f16 inverse[3], to_near[3], to_far[3];
    int near[3], far[3];
} ty_box_ray;

static inline float ty_box_reciprocal(float d)
{
    // No axis is quite parallel: this keeps infinity - infinity away, and moves nothing by more than 1e-18 of t.
    return 1.0f / (fabsf(d) > 1e-18f ? d : copysignf(1e-18f, d));
}

// A plane p is met at fma(p, i, -(o i) -+ slack). With u = 2^-24 the product o i rounds by u |o i|, its sum with the
// slack by as much, and the fma by u (|p i| + |o i|): a slack of 4 u |o i| outweighs what grows with the origin, and
// the padding of the boxes what grows with p (after T. Ize 2013, "Robust BVH ray traversal").
static inline ty_box_ray ty_box_ray_make(ty_vec3 origin, ty_vec3 direction)
{
    const float o[3] = {origin.x, origin.y, origin.z}, d[3] = {direction.x, direction.y, direction.z};
    ty_box_ray r;
    for (int i = 0; i < 3; i++)
    {
        float inverse = ty_box_reciprocal(d[i]), along = o[i] * inverse, slack = fabsf(along) * 0x1p-22f;
        r.inverse[i] = ty_f16_set(inverse);
        r.to_near[i] = ty_f16_set(-along - slack);
        r.to_far[i] = ty_f16_set(-along + slack);
        int backward = signbit(inverse) != 0; // no branch: which way a ray goes is a coin's throw
        r.near[i] = i + 3 * backward;
        r.far[i] = i + 3 - 3 * backward;
    }
    return r;
}

// Children that the ray meets between t_min and t_max, and where it enters them: no later than it does.
static inline uint32_t ty_meet_boxes(const ty_wide_node* node, const ty_box_ray* r, float t_min, float t_max,
                                     float* entry)
{
    ty_f16 near = ty_f16_set(t_min), far = ty_f16_set(t_max);
    for (int i = 0; i < 3; i++)
    {
        near = ty_f16_max(ty_f16_fma(ty_f16_load(node->plane[r->near[i]]), r->inverse[i], r->to_near[i]), near);
        far = ty_f16_min(ty_f16_fma(ty_f16_load(node->plane[r->far[i]]), r->inverse[i], r->to_far[i]), far);
    }
    ty_f16_store(entry, near);
    return ty_f16_le(near, far);
}
