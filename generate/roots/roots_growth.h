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
} growth;

// The part of v across a unit vector.
static inline ty_vec3 growth_without(ty_vec3 v, ty_vec3 unit)
{
    return ty_mad(v, unit, -ty_dot(v, unit));
}

// How high over the host the centre of a section lies, m.
static inline float growth_height(const roots_point* p)
{
    return (p->flat - p->sink) * p->r;
}

// Puts what lies on the host at its height over the mesh itself: all lines from the first on, but for ends on others.
void growth_settle(const growth* g, int first);
// The direction of a line at a point, unit.
ty_vec3 growth_tangent(const roots_network* network, const roots_line* line, int point);

// Main roots, and those that hang. false: cancelled.
bool growth_main(growth* g);
// Branches between lines of one kind, by the recipe's `link`; they become lines of the other. false: cancelled.
bool growth_link(growth* g, const ty_roots_link_def* link, roots_kind from, roots_kind to);

// --- shrink-wrap ---

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
    uint64_t key;
} wrap_def;

typedef struct wrap
{
    ty_vec3 p[WRAP_MOST], n[WRAP_MOST];
    int count;
    float length; // m
} wrap;

// A curve from a to b that lies on the host: drawn tight from far outside of it. false: there is none, it would be too
// long, or it kinks.
bool roots_wrap(const growth* g, const wrap_def* def, wrap* out);
