// SPDX-License-Identifier: Apache-2.0
// What the files that grow the network share.
#pragma once
#include "roots.h"

typedef struct growth
{
    const ty_roots_recipe* recipe;
    const roots_host* host;
    ty_workers* workers;
    roots_network* network;
    roots_start* starts; // of main roots, in place of the trunk
    int start_count;
} growth;

// The part of v across a unit vector.
static inline ty_vec3 growth_without(ty_vec3 v, ty_vec3 unit)
{
    return ty_mad(v, unit, -ty_dot(v, unit));
}

// Does it begin on its parent's line? Main roots run beside what they belong to.
static inline bool growth_leaves(const roots_line* line)
{
    return line->parent >= 0 && line->kind != ROOTS_MAIN;
}

// The recipe's ramp at x: straight from point to point, level beyond the ends; 1 without any.
static inline float growth_ramp(const ty_param_list* ramp, float x)
{
    const ty_vec2* p = ramp->items;
    int i = 0, last = ramp->count - 1;
    if (last < 0)
        return 1.0f;
    while (i < last && p[i + 1].x < x)
        i++;
    if (i == last || x <= p[i].x)
        return p[i].y;
    return ty_lerp(p[i].y, p[i + 1].y, (x - p[i].x) / (p[i + 1].x - p[i].x));
}

// How high over the host the centre of a section lies, m.
static inline float growth_height(const roots_point* p)
{
    return (p->flat - p->sink) * p->r;
}

// Puts what lies on the host at its height over the mesh itself (or, for the time being, by the field): all lines from
// the first on. Turns of more than 40 degrees are rounded off. Ends on other lines go where those are, and what is near
// them goes along.
void growth_settle(const growth* g, int first, bool exact);
void growth_settle_line(const growth* g, int line, bool exact); // one alone
// Main roots bend away from what leaves them, on the first half dozen radii after it: for all lines from the first on.
void growth_part(const growth* g, int first);
// Radii by the pipe model, r^n = sum of those after it: what leaves takes away, what comes in gives back.
void growth_pipe(const growth* g);
// Bends lines out of the way of obstacles, as far as these keep clear for the radii that they have.
void growth_clear(const growth* g);
// When the tip passes each point.
void growth_births(roots_network* network);
// The direction of a line at a point, unit.
ty_vec3 growth_tangent(const roots_network* network, const roots_line* line, int point);

// The whole network by the thesis' method. false: cancelled.
bool growth_seed(growth* g);
// Main roots, then those that hang from them. false: cancelled.
bool growth_main(growth* g);
bool growth_aerial(growth* g);
// Branches between lines of one kind, by the recipe's `link`; they become lines of the other. false: cancelled.
bool growth_link(growth* g, const ty_roots_link_def* link, roots_kind from, roots_kind to);
// Fine roots over what is left, by the recipe's `cover`. false: cancelled.
bool growth_cover(growth* g);

// Where an overhanging side of the host comes down to the floor: p moved out along that until there is room for the
// height between both; elsewhere p.
ty_vec3 growth_out(const roots_host* host, ty_vec3 p, float height);

// --- shrink-wrap ---

// One round, forwards and back, of relaxing a spline in tension that bends over about `stiff` points. Two points at
// either end stay where they are.
void roots_bend(ty_vec3* p, int count, float stiff);

enum
{
    WRAP_MOST = 512, // points
};

typedef struct wrap_def
{
    roots_point a, b;    // where it begins and ends
    ty_vec3 ta, tb;      // directions of the roots there
    float r, flat, sink; // its own
    float wander;        // of the way across
    bool strict;         // no kinks, and ends that go along the roots they join
    uint64_t key;
} wrap_def;

typedef struct wrap
{
    ty_vec3 p[WRAP_MOST], n[WRAP_MOST];
    int count;
    float length; // m
} wrap;

typedef enum wrap_way
{
    WRAP_NONE,     // there is none, it would be too long, or it kinks
    WRAP_TIGHT,    // drawn tight from far outside of the host
    WRAP_GEODESIC, // the shortest way over nodes near the surface, smoothed
    WRAP_WAYS,
} wrap_way;

// A curve from a to b that lies on the host.
wrap_way roots_wrap(const growth* g, const wrap_def* def, wrap* out);
// A way from a to b over nodes of a grid near the surface, at most `longest` (m), by A*: up to `most` points, their
// number, 0 where there is none.
int roots_geodesic(const roots_host* host, ty_vec3 a, ty_vec3 b, float height, float longest, ty_vec3* out, int most);
