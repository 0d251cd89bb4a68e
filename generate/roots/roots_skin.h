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
    int line, point; // it goes from point to point + 1
} roots_segment;

struct roots_skin
{
    const ty_roots_recipe* recipe;
    const roots_network* network;
    const roots_host* host; // or NULL
    roots_segment* segments;
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

// Height of the relief of bark over the smooth surface of a segment's root, m.
float roots_skin_relief(const roots_skin* skin, const roots_segment* segment, float t, ty_vec3 p);
// The largest that it gets, of the radius.
#define ROOTS_RELIEF_MOST 1.65f

static inline float roots_segment_depth(const roots_segment* s, float t)
{
    return s->sink_a + t * s->sink_d;
}

// The distance of what is left of a root where it would reach deeper than `depth` under the host; p is near its
// surface.
float roots_skin_hold(const roots_skin* skin, float distance, float depth, float radius, ty_vec3 p);
// The distance where the trunk is cut off at the top.
float roots_skin_cut(const roots_skin* skin, float distance, float y);
void roots_skin_fill(void* skin, const int block[3], float values[TY_NET_NODES]); // a ty_net_fill
