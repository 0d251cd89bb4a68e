// SPDX-License-Identifier: Apache-2.0
// What the making of an aggregate hands from stage to stage.
#pragma once
#include "fill.h"
#include "mixture.h"

typedef struct kit
{
    const ty_aggregate_recipe* recipe; // complete
    ty_workers* workers;
    mixture mix;
    ty_container* container;
    ty_fill_top top;
    ty_pile* pile;
    ty_affine* frames; // of elastic bodies, [count of the pile]; else NULL
    ty_rng rng;
    int count; // of grains, once filled
    int lost, replaced;
    int removed;           // by the thesis' filling
    ty_pile_metrics start; // of the filling, before it settles
    float start_repeat;
    bool rest;
} kit;

// make.c
// A body of a random element, turned as the recipe allows and at most steepest off the horizontal.
ty_body kit_body(kit* k, ty_vec3 position, float steepest);
ty_bridge_def kit_bridge(const ty_aggregate_recipe* r); // the liquid between the grains, or none

// make_fill.c
TY_CHECKED ty_status kit_fill(kit* k, ty_error* error);
void kit_drop(kit* k, int count); // grains fall onto the pile: in layers over its planned surface, not touching

// xpbd_settle.c: settles or presses the pile as elastic bodies for the recipe's time; k->frames is where they stand.
TY_CHECKED ty_status kit_soften(kit* k, ty_pile_metrics* metrics, ty_error* error);
