// SPDX-License-Identifier: Apache-2.0
// What the files that plan branches share.
#pragma once
#include "roots_growth.h"

enum
{
    PARTNERS = 6, // that are tried, on one side, then on the other, the nearest first
    MARGIN = 4,   // points of a line, at both ends, where none begins or ends
};

typedef struct plan
{
    int line, point; // where it begins
    int partner_count;
    int partners[PARTNERS], partner_points[PARTNERS];
    float share;
    uint64_t key;
    bool grown;
    wrap_way how;
    int used; // partner
    float r;
    wrap* curve; // owned
} plan;

typedef struct places places; // opaque
typedef struct crowd crowd;   // opaque

typedef struct linking
{
    growth* g;
    const ty_roots_link_def* def;
    roots_kind from, to;
    places* places;
    plan* plans;
    int count, capacity;
} linking;

// On the host, and not where it goes under.
bool link_may_join(const linking* k, int point);
// Where points are that may be grown into.
places* link_places_create(const linking* k);
void link_places_destroy(places* all);
// Adds partners on one side of the line that the plan leaves, the nearest first, up to half of all. steepest is the
// least cosine between either root and the way over.
void link_partners(const linking* k, plan* p, float side, float steepest);
// What is there already, but for the trunk.
crowd* link_crowd_create(const roots_network* net);
void link_crowd_add(crowd* c, const roots_network* net, const roots_line* line);
void link_crowd_destroy(crowd* c);
// Runs most of a curve within what is there?
bool link_crowd_hides(crowd* c, const wrap* w);
