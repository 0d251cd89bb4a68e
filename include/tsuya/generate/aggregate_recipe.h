// SPDX-License-Identifier: Apache-2.0
// The recipe of an aggregate: which grains, in what, how many, how they settle. `kind: aggregate`.
#pragma once
#include <tsuya/generate/asset.h>
#include <tsuya/generate/pile.h>

typedef struct ty_fill_def
{
    int count;      // grains in the result, 1..200000
    float density;  // volume share of the grains when filled, 0.3..0.68; settling adds a little
    float heap;     // m, height of the crown above its own edge; rises where the vessel is full
    float tilt;     // rad, largest angle of a grain's length with the horizontal when filled, 0..pi/2
    float roll;     // rad, largest turn about its own length, 0..pi
    float sprinkle; // share of the grains that fall onto an open pile from above, 0..0.5
    int sweeps;     // of the inflation, 50..5000
} ty_fill_def;

typedef struct ty_settle_def
{
    float friction;    // Coulomb, 0..2
    float rolling;     // resistance, of half the width, 0..0.1
    float max_seconds; // simulated, 0.1..60
    float rate;        // substeps per second, 1000..20000
    int polish;        // sweeps, 0..5000
} ty_settle_def;

// The attribute `moisture` is a number in -1..1 a grain, to be scaled by the material.
typedef struct ty_wetness_def
{
    float variation; // share of chance, 0..1
    float drying;    // how much drier grains at the surface are, 0..1
} ty_wetness_def;

typedef struct ty_aggregate_recipe
{
    ty_element_def element;
    ty_container_def container;
    ty_fill_def fill;
    ty_settle_def settle;
    ty_wetness_def moisture;
    ty_seed seed;
} ty_aggregate_recipe;

ty_aggregate_recipe ty_aggregate_recipe_default(void); // 2,000 grains of cooked japonica rice in the default bowl
const ty_param_table* ty_aggregate_recipe_params(void);
// def is a ty_aggregate_recipe; on failure *out is NULL, else as ty_generator's make.
TY_CHECKED ty_status ty_aggregate_make(const void* def, ty_workers* workers, ty_aggregate** out, ty_error* error);
extern const ty_generator ty_aggregate_generator;
