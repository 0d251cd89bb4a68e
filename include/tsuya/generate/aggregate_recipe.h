// SPDX-License-Identifier: Apache-2.0
// The recipe of an aggregate: which grains, in what, how many, how they settle. `kind: aggregate`.
#pragma once
#include <tsuya/base/moisture.h>
#include <tsuya/generate/asset.h>
#include <tsuya/generate/pile.h>

enum
{
    TY_FILL_MOST = 2000000, // grains
};

typedef enum ty_fill_start
{
    TY_FILL_INFLATE, // grow from half the size at even distances, pushing each other apart
    TY_FILL_THESIS,  // Gan 2023: moved inwards to where a cost of overlap is least, or taken out
    TY_FILL_LATTICE, // rows of elements that all lie alike: the start of a full simulation
    TY_FILL_POUR,    // falls out of a mouth, element by element
} ty_fill_start;

typedef enum ty_fill_target
{
    TY_FILL_COUNT,   // level from count and density
    TY_FILL_LEVEL,   // count from level and density
    TY_FILL_DENSITY, // count from density, up to the rim or in the whole volume
} ty_fill_target;

// The numbers of equations 1 to 3 of Gan 2023.
typedef struct ty_thesis_def
{
    float refine; // C_refine: farthest move, of the distance between points, 0..4
    float offset; // T: overlap that does not count, m
    float remove; // D, of the farthest move: 1 takes out all that overlap, more lets some overlap stay, 0..100
} ty_thesis_def;

typedef struct ty_pour_def
{
    ty_vec3 from;  // m, middle of the mouth; all 0 = .06 m over the middle of the rim, or of the heap
    float radius;  // m, of the mouth
    float rate;    // elements a second
    float seconds; // for all of them, in place of a rate; 0 = by the rate
    float speed;   // m/s downwards at the mouth
} ty_pour_def;

typedef struct ty_fill_def
{
    int start;      // ty_fill_start
    int target;     // ty_fill_target
    int count;      // grains in the result, 1..TY_FILL_MOST
    float density;  // volume share of the grains when filled, 0.1..0.95; settling adds a little
    float level;    // m over the lowest point of the inside, with TY_FILL_LEVEL; 0 = the rim
    float heap;     // m, height of the crown above its own edge; rises where the vessel is full
    float tilt;     // rad, largest angle of a grain's length with the horizontal when filled, 0..pi/2
    float roll;     // rad, largest turn about its own length, 0..pi
    float sprinkle; // share of the grains that fall onto an open pile from above, 0..0.5
    int sweeps;     // of the inflation, 50..5000
    ty_thesis_def thesis;
    ty_pour_def pour;
} ty_fill_def;

// What comes onto a pile that is at rest already: its elements fall from above, then all settle again. Of fill: target,
// count, density, level, heap, tilt and roll.
typedef struct ty_layer_def
{
    ty_element_def element;
    ty_param_list elements; // of ty_element_def, borrowed: as the recipe's
    ty_fill_def fill;
} ty_layer_def;

typedef enum ty_solver
{
    TY_SOLVER_IMPULSE, // rigid elements, impulses kept from substep to substep: comes to rest
    TY_SOLVER_XPBD,    // elastic elements, positions: bends, and creeps
} ty_solver;

typedef struct ty_settle_def
{
    float friction;    // Coulomb, 0..2
    float rolling;     // resistance, of half the width, 0..0.1
    float max_seconds; // simulated, 0..60; 0: filled and polished, no more
    float rate;        // substeps per second, 1000..20000
    int polish;        // sweeps, 0..5000
    float watch;       // s that a pile at rest goes on, to measure how far it moves, 0..60
    bool state;        // the file holds what it takes to go on exactly
    float cohesion;    // N/m, tension of the liquid between grains; < 0: follows the moisture
    float adhesion;    // J/m^2, work of adhesion of sticky surfaces, 0..10; < 0: follows the moisture
    int solver;        // ty_solver
    float modulus;     // Pa, Young's of an elastic element, 1e3..1e8; 0: follows the moisture
    bool rest;         // elastic elements end as rigid ones, bent as they are, that come to rest
} ty_settle_def;

typedef enum ty_press_from
{
    TY_PRESS_ABOVE,  // a lid, or the container towards its lowest point
    TY_PRESS_AROUND, // a closed container from all sides towards its middle, as a hand does
} ty_press_from;

// A mould that closes on the elastic elements by strain and opens again: over .4 of the time down, .1 held, .3 up.
// After that they are rigid, as they are bent, and come to rest; of a container that is a mould once it is gone.
typedef struct ty_press_def
{
    float strain;  // of the extents, 0..0.5; 0 = none
    float seconds; // 0.05..10
    int from;      // ty_press_from
    bool release;  // a mould is taken away in the end
} ty_press_def;

// The attribute `moisture` is a number in -1..1 a grain, to be scaled by the material.
typedef struct ty_wetness_def
{
    float variation; // share of chance, 0..1
    float drying;    // how much drier grains at the surface are, 0..1
    float wet_basis; // kg of water a kg of wet grains, 0.05..1; 0: follows soak and cooked
    float soak;      // minutes, >= 0
    float celsius;   // of the water for soaking, 0..60
    float cooked;    // 0..1; < 0: not said, as in ty_moisture_def
    float swelling;  // size of rice against its size when cooked, 0.5..2; 0: follows the state
} ty_wetness_def;

// What follows from the state of moisture, and from what the recipe gives in its place.
typedef struct ty_mechanics
{
    bool given;           // there is a state: one of wet_basis, soak and cooked
    ty_moisture state;    // if given
    ty_bridge_def bridge; // of water, and of starch
    float modulus;        // Pa
    float swelling;       // of the lengths of rice
} ty_mechanics;

// A film of the pile as it settles: the same bodies in every frame, those that fall over a rim too. With any of the
// phases it begins with raw grains at rest, and all minutes pass in its frames.
typedef struct ty_animate_def
{
    int frames;  // 0 = none, ..10000
    float fps;   // frames a second of simulated time, 1..1000
    float soak;  // minutes in water, >= 0
    float cook;  // minutes on the fire after that, >= 0
    float stand; // minutes off it: rice dries from the surface and shrinks, >= 0
} ty_animate_def;

typedef struct ty_aggregate_recipe
{
    ty_element_def element;
    ty_param_list elements; // of ty_element_def, borrowed: kinds by ratio, in place of element where there are any
    ty_container_def container;
    ty_fill_def fill;
    ty_param_list layers; // of ty_layer_def, borrowed: what comes onto the fill, from below to the top
    ty_settle_def settle;
    ty_press_def press;
    ty_wetness_def moisture;
    ty_animate_def animate;
    ty_seed seed;
} ty_aggregate_recipe;

ty_aggregate_recipe ty_aggregate_recipe_default(void); // 2,000 grains of cooked japonica rice in the default bowl
extern const ty_param_table ty_aggregate_recipe_table;
const ty_param_table* ty_layer_params(void);
ty_mechanics ty_mechanics_of(const ty_aggregate_recipe* recipe);
float ty_moisture_swelling(float wet_basis);         // lengths of rice against those when cooked
ty_bridge_def ty_bridge_of_state(ty_moisture state); // of water, and of starch where it is cooked
TY_CHECKED ty_status ty_mechanics_check(const ty_aggregate_recipe* recipe, ty_error* error);
// def is a ty_aggregate_recipe; on failure *out is NULL, else as ty_generator's make.
TY_CHECKED ty_status ty_aggregate_make(const void* def, ty_workers* workers, ty_aggregate** out, ty_error* error);
// Goes on from the state that such an aggregate holds (aggregate->state), made with settle.state: that of the moment at
// which time first ran out or it was interrupted, else of rest. What comes out is, to the bit, what one run of this
// recipe gives. TY_BAD_FILE: damaged, or of another program; TY_BAD_INPUT: of another recipe. May differ: settle's
// max_seconds, state and watch, container.cut.
TY_CHECKED ty_status ty_aggregate_resume(const void* def, const void* state, size_t size, ty_workers* workers,
                                         ty_aggregate** out, ty_error* error);
// Frame by frame instead: the first is the fill before it moves. recipe.animate.frames is at least 1; nothing is
// replaced, stirred or polished. The aggregate that put gets is lent; prototypes, ids and the order of the instances
// are the same in all.
TY_CHECKED ty_status ty_aggregate_film(const void* def, ty_workers* workers, const ty_aggregate_sink* sink,
                                       ty_error* error);
extern const ty_generator ty_aggregate_generator;
