// SPDX-License-Identifier: Apache-2.0
// The wide top level over instances at rest: boxes in nodes of sixteen, instances in leaves of sixteen as maps to the
// unit sphere of their prototypes' bounding ellipsoids.
#pragma once
#include "trace_world.h"
#include <tsuya/base/simd.h>

#define TY_WIDE_LEAF 0x80000000u // in a child: the rest is the index of a leaf
#define TY_WIDE_STACK 1088       // 15 waiting children a level; the builder goes at most 70 levels deep

typedef struct ty_wide_node
{
    _Alignas(64) float plane[6][TY_LANES]; // low x, y, z, high x, y, z; no child: low above high
    uint32_t child[TY_LANES];
} ty_wide_node;

typedef struct ty_wide_leaf
{
    _Alignas(64) float map[12][TY_LANES]; // by row: the world's x, y, z and 1 to the sphere's x, then to y, then to z
    uint32_t instance[TY_LANES];          // of the world's numbering; TY_NONE = none
    uint32_t prototype[TY_LANES];
} ty_wide_leaf;

struct ty_trace_wide
{
    ty_wide_node* nodes;
    ty_wide_leaf* leaves;
    uint32_t root; // as a child
    uint32_t node_count, leaf_count;
    uint32_t common_mask; // bits that every object has: a ray with one of them meets all
    bool has_subsurface;
};

// One ray on its way through: in the space of the wide level, which is not the world's for moving objects.
typedef struct ty_wide_query
{
    ty_vec3 origin, direction;
    float t_min, t_max; // t_max shrinks to the nearest hit
    const ty_ray* ray;  // flags, mask and skips
    uint32_t pass;      // the world's number of the instance that the ray skips altogether, or TY_NONE
    uint32_t skip;      // of one that it skips up to skip_distance, or TY_NONE
    bool meets_all;     // every other instance, from both sides: no need to look at any
    float u, v;         // of the hit
    uint32_t triangle, instance;
} ty_wide_query;

// The box of an instance as nodes hold it: grown by sixteen units in the last place of its largest coordinate. Half of
// that is for maps that round differently for rays and for points, the rest for the box test.
static inline ty_bounds ty_wide_padded(ty_bounds box)
{
    ty_vec3 reach = ty_max3(ty_max3(box.high, ty_neg(box.high)), ty_max3(box.low, ty_neg(box.low)));
    float pad = 1e-6f * ty_max(reach.x, ty_max(reach.y, reach.z));
    ty_vec3 pad3 = {pad, pad, pad};
    return (ty_bounds){ty_sub(box.low, pad3), ty_add(box.high, pad3)};
}

// A ray in the space of an instance's bounding sphere, to the bit as the kernels see it there.
void ty_wide_to_sphere(const ty_affine* map, ty_vec3* origin, ty_vec3* direction);

// The kernels: same bits, other width.
bool ty_wide_intersect_base(const ty_world* world, const ty_trace_wide* wide, ty_wide_query* query);
bool ty_wide_occluded_base(const ty_world* world, const ty_trace_wide* wide, const ty_wide_query* query);
bool ty_wide_intersect_avx512(const ty_world* world, const ty_trace_wide* wide, ty_wide_query* query);
bool ty_wide_occluded_avx512(const ty_world* world, const ty_trace_wide* wide, const ty_wide_query* query);
