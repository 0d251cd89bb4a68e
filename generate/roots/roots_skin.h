// SPDX-License-Identifier: Apache-2.0
// What the files of the roots' surface share: segments as they are asked for distances, and the blocks they reach.
#pragma once
#include "roots.h"

// Between two points of a line, ready to be asked: all that changes along it is a + t d.
typedef struct roots_segment
{
    ty_vec3 a, d;   // m
    ty_vec3 na, nd; // about unit
    float length_1; // 1 / |d|^2, 0 where there is no length
    float ra, rd;   // m
    float ea, ed;   // 1 / flat^2 - 1
    float sink_a, sink_d;
    float fill_a, fill_d; // m, by which the lower half of the section is drawn out towards the host
    float open_a, open_d; // 0..1, how far it is out of what it grows from and into: within that it does not swell it
    int line, point;      // it goes from point to point + 1
} roots_segment;

// A ball about all of a segment's section, and what is asked before the segment itself is.
typedef struct roots_ball
{
    ty_vec3 p;    // m
    float r;      // m
    float spread; // m, by how much its root may be farther than the nearest and still count, anywhere along it
    int line;
} roots_ball;

struct roots_skin
{
    const ty_roots_recipe* recipe;
    const roots_network* network;
    const roots_host* host; // or NULL
    roots_segment* segments;
    roots_ball* balls; // of the segments
    int segment_count;
    ty_vec3 origin;
    float step;
    int blocks[3];   // of TY_NET_BLOCK nodes a side
    int32_t* begin;  // [blocks + 1] into list
    int32_t* list;   // segments, in order
    int32_t* active; // blocks with segments
    int active_count;
};

static inline float roots_segment_radius(const roots_segment* s, float t)
{
    return s->ra + t * s->rd;
}

static inline float roots_segment_fill(const roots_segment* s, float t)
{
    return s->fill_a + t * s->fill_d;
}

// The largest relief of bark, of the radius and of the recipe's `bark`.
#define ROOTS_RELIEF_MOST 1.65f

static inline float roots_segment_depth(const roots_segment* s, float t)
{
    return s->sink_a + t * s->sink_d;
}

// How far from each other two roots begin to run together there, m: in proportion to the thinner.
static inline float roots_join_width(float join, float radius_a, float radius_b, float open_a, float open_b)
{
    return ty_max(join * ty_min(radius_a, radius_b) * ty_min(open_a, open_b), 1e-9f);
}

static inline float roots_segment_open(const roots_segment* s, float t)
{
    return s->open_a + t * s->open_d;
}

// A smooth maximum; *part is how much of b there is in it.
static inline float roots_cut(float a, float b, float edge, float* part)
{
    float h = ty_clamp(0.5f - 0.5f * (a - b) / edge, 0.0f, 1.0f);
    *part = h;
    return ty_lerp(a, b, h) + edge * h * (1.0f - h);
}

// What is left of a root where it would reach deeper than `depth` under the host; p is near its surface.
static inline float roots_skin_hold(const roots_skin* skin, float distance, float depth, float radius, ty_vec3 p,
                                    float* part)
{
    float over = -(roots_host_value(skin->host, p, NULL) + depth);
    return roots_cut(distance, over, ty_max(0.15f * radius, 0.5f * skin->step), part);
}

#define ROOTS_TOP_EDGE 0.4e-3f // m, rounding of the cut at the top

// The distance where the trunk is cut off at the top.
static inline float roots_skin_top(const roots_skin* skin, float distance, float y, float* part)
{
    return roots_cut(distance, y - skin->network->top, ty_max(ROOTS_TOP_EDGE, skin->step), part);
}

typedef enum roots_block
{
    ROOTS_BLOCK_OUTSIDE,
    ROOTS_BLOCK_MIXED, // it may have nodes within two steps of the surface
    ROOTS_BLOCK_INSIDE,
} roots_block;

roots_block roots_skin_block(const roots_skin* skin, int number);
void roots_skin_fill(void* skin, const int block[3], float values[TY_NET_NODES]); // a ty_net_fill; of mixed blocks
