// SPDX-License-Identifier: Apache-2.0
// What the files of the thesis' method share (Homma 2011, graduation thesis, Tokyo University of Technology: roots that
// strangle, by Bezier curves that dodge boxes). Sections and formulas are named by its numbers.
#pragma once
#include "roots_growth.h"

enum
{
    SEED_FIRST = 4,      // growth point of a main root that the first branch leaves (3.3.1)
    SEED_EVERY = 5,      // from one to the next: four lie between
    SEED_SAMPLES = 20,   // of a first branch's curve: t in steps of 0.05
    SEED_SECOND = 5,     // of a second branch's: 0.2
    SEED_RESTARTS = 200, // new curves of one branch at most, of which the thesis says nothing
    SEED_POINTS = 2000,  // the same
};

typedef struct seed_run
{
    const growth* g;
    float unit;     // m
    float r;        // m, of all roots
    ty_vec3 middle; // G, where main roots begin
} seed_run;

// Whether a ball of the roots' radius about p meets host or floor (3.2).
bool seed_meets(const seed_run* run, ty_vec3 p);
// Bezier curve of third order, by its four control points (3.10).
ty_vec3 seed_bezier(const ty_vec3* control, float t);
// A line of the network through count places, `s` m from the trunk on; its number.
int seed_add_line(const seed_run* run, roots_line line, const ty_vec3* places, int count, float s);
typedef struct seed_curve
{
    ty_vec3 control[4];
    ty_vec3 places[SEED_POINTS];
    int count;
} seed_curve;

// A first branch from a to b that dodges what it meets (3.3.1, 3.3.2). ROOTS_FAILURES: it has arrived; else what
// stopped it, and places lead there.
roots_failure seed_curve_find(const seed_run* run, ty_vec3 a, ty_vec3 b, ty_rng* rng, seed_curve* c);
// First branches with the turns that they give to main roots, then second ones. false: cancelled.
bool seed_branch(seed_run* run);
