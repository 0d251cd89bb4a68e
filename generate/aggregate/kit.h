// SPDX-License-Identifier: Apache-2.0
// What the making of an aggregate hands from stage to stage.
#pragma once
#include "fill.h"
#include "mixture.h"
#include <tsuya/generate/xpbd.h>

// Rises with each change of the bytes that recipes give, or of states.
#define AGGREGATE_BUILD_ID "aggregate 8"

// What has left the mouth so far, and what is to come, in order.
typedef struct pour
{
    ty_body* bodies; // [count]; NULL = nothing is poured
    int count, poured;
    int64_t steps; // of the pile since it began
    float rate;    // 1/s
    ty_vec3 from;
} pour;

typedef struct kit
{
    const ty_aggregate_recipe* recipe; // complete
    const ty_fill_def* fill;           // of the layer that is selected in mix
    ty_mechanics mechanics;
    int layer;                 // which: 0 is the recipe's own fill
    int below;                 // bodies that lay at rest when the latest layer came
    int wanted[MIXTURE_KINDS]; // bodies of each layer so far
    double spread;             // m^3 that all so far take, with the space between them
    ty_workers* workers;
    mixture mix;
    ty_container* container;
    ty_container* ground; // what a mould leaves the pile on; else NULL
    ty_fill_top top;
    ty_pile* pile;
    pour pour;
    ty_rng rng;
    int count;        // of grains, once filled
    uint32_t* owners; // once written: [instances], the body that each is of
    int lost, replaced;
    int removed;                 // by the thesis' filling
    ty_pile_metrics start;       // of the filling, before it settles
    ty_pile_metrics settled;     // at rest, before it is polished
    float drift_mean, drift_max; // of the width, while it was watched
    float start_repeat;
    bool rest;
    struct cooking* cooking; // of a film; NULL = it shows no cooking
    float press_top;         // m, where the lid begins
    float released, stood;   // m, the topmost element over the plane below, of a mould that is taken off: then, at rest
    int round;               // of settling and looking for what floats
    ty_bytes state;          // kept for the file, or empty
    bool out_of_time;        // when it was kept
    bool resumed;            // the next settling goes on from a state
} kit;

// How rice takes up water and loses it in the minutes of a film.
typedef struct cooking
{
    float soak, cook, stand; // minutes
    float celsius;           // of the water
    float drying;            // 0..1
} cooking;

#define KIT_WET_SPREAD 0.06f // of the water: what the attribute moisture of 1 is

// cooking.c
bool cooking_is(const ty_animate_def* animate);
// Makes the recipe that of raw rice, as the film begins, and keeps what it says of the way on.
TY_CHECKED ty_status cooking_begin(ty_aggregate_recipe* recipe, cooking* out, ty_error* error);
// Of all the rice, whatever lies where.
ty_moisture cooking_state(const cooking* c, float minute);
float cooking_pore_area(const cooking* c, float minute); // m^2, mean of a pore
// Wet basis of one grain. moisture: its attribute; exposed: 1 at the surface of the heap, 0 deep in it.
float cooking_wet_basis(const cooking* c, float minute, float moisture, float exposed);

static inline const ty_layer_def* kit_layer_def(const ty_aggregate_recipe* r, int layer) // from 1
{
    return (const ty_layer_def*)r->layers.items + (layer - 1);
}

// kit.c
TY_CHECKED ty_status kit_interrupted(const char* what, ty_error* error); // while what; TY_OK unless one asks to stop
// Elements, container, and a pile of them without a body.
TY_CHECKED ty_status kit_pile(kit* k, ty_error* error);
void kit_layer_select(kit* k, int layer); // what is drawn and dropped from now on is of it
// A body of a random element, turned as the recipe allows and at most steepest off the horizontal.
ty_body kit_body(kit* k, ty_vec3 position, float steepest);
// Makes bodies those of the pile, with a push of about the speed of a fall through their width for those not held: they
// are wedged where none can be dropped.
void kit_stir(kit* k, ty_body* bodies, const bool* held);

// make_write.c
TY_CHECKED ty_status kit_write(kit* k, const ty_pile_metrics* metrics, ty_aggregate** out, ty_error* error);

// film.c
TY_CHECKED ty_status kit_film(kit* k, const ty_aggregate_sink* sink, ty_error* error);

// make_metrics.c
char* kit_metrics(const kit* k, const ty_pile_metrics* m); // JSON; the caller frees it
// Polishes the pile and measures it before and after; speeds are those before. held: of after, as of ty_pile_measure.
// The bodies as they moved, for a pile that goes on, are the caller's.
ty_body* kit_polish(kit* k, ty_pile_metrics* before, ty_pile_metrics* after, bool* held);
// Goes on from rest for settle.watch seconds and measures how far bodies move; then all is as it was.
void kit_watch(kit* k, const ty_body* rest);

// make_state.c
// The state, if the recipe wants it. What is kept when time has run out is not replaced any more.
TY_CHECKED ty_status kit_keep(kit* k, bool out_of_time, ty_error* error);
TY_CHECKED ty_status kit_resume(kit* k, const void* state, size_t size, ty_error* error); // in place of a fill

// make_fill.c
TY_CHECKED ty_status kit_fill(kit* k, ty_error* error);
float kit_inset(const kit* k);    // m, how far from the walls centres begin
void kit_drop(kit* k, int count); // grains fall onto the pile: in layers over its planned surface, not touching
// The count that fill asks for in the space that is left over what lies; place is before "fill." in the recipe.
TY_CHECKED ty_status kit_count(kit* k, const char* place, float inset, int* out, ty_error* error);

// make_pour.c
TY_CHECKED ty_status kit_pour_begin(kit* k, ty_error* error); // draws all elements; none has left yet
void kit_pour_due(kit* k);                                    // once before each substep: lets those go that are due
TY_CHECKED ty_status kit_pour(kit* k, ty_error* error);       // until all have left

// make_layers.c
TY_CHECKED ty_status layers_check(const ty_aggregate_recipe* r, ty_error* error);
// Those above the one that is selected: each falls onto the pile once that is at rest. The last is still in the air.
TY_CHECKED ty_status kit_layers(kit* k, ty_error* error);
// As many new bodies of each layer fall onto the pile as are missing.
void kit_refill(kit* k);
// Settles; drops a new grain for each that is lost over the rim.
TY_CHECKED ty_status kit_rest(kit* k, ty_error* error);

// xpbd_settle.c: settles or presses the pile as elastic bodies for the recipe's time; the pile's bodies are then where
// they are, and bent.
ty_xpbd* kit_soft(kit* k); // the pile's bodies as elastic ones; the caller's
int kit_press_steps(const kit* k);
void kit_press_step(kit* k, ty_xpbd* x, int step); // from 0
// The pile's bodies where the elastic ones are, and bent as they are; without those that left an open container, or
// all.
void kit_soft_take(kit* k, const ty_xpbd* x, bool all);
TY_CHECKED ty_status kit_soften(kit* k, ty_pile_metrics* metrics, ty_error* error);

// make_stand.c
TY_CHECKED ty_status press_check(const ty_aggregate_recipe* r, ty_error* error);
bool recipe_is_mould(const ty_aggregate_recipe* r);
bool kit_stands(const kit* k); // it ends standing by itself: pressed, moulded, or elastic and to come to rest
float kit_top(const kit* k);   // m, of the topmost centre over the lowest point of the container
TY_CHECKED ty_status kit_release(kit* k, ty_error* error); // takes the mould off, if there is one that goes
// Does that, and lets the pile come to rest as it is: nothing is put anew, and only what floats is stirred.
TY_CHECKED ty_status kit_stand(kit* k, ty_pile_metrics* metrics, ty_error* error);
