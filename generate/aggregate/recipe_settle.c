// SPDX-License-Identifier: Apache-2.0
// Parameters of what happens to the elements: settling, pressing, moisture, a film of it.
#include "recipe_tables.h"

static const char* const solvers[] = {"impulse", "xpbd", NULL};

static void settle_set_default(void* def)
{
    *(ty_settle_def*)def = ty_aggregate_recipe_default().settle;
}

#define OWNER ty_settle_def
static const ty_param settle_rows[] = {
    FIELD("friction", TY_PARAM_FLOAT, "", 0, 2, friction, "Coulomb coefficient, between grains and at walls"),
    FIELD("rolling", TY_PARAM_FLOAT, "", 0, 0.1, rolling, "rolling resistance, of half the width"),
    FIELD("max_seconds", TY_PARAM_FLOAT, "s", 0, 60, max_seconds,
          "simulated time after which a pile is not at rest; 0: it stays as it was filled, polished"),
    FIELD("rate", TY_PARAM_FLOAT, "1/s", 1000, 20000, rate, "substeps per second; deep piles want more"),
    FIELD("polish", TY_PARAM_INT, "", 0, 5000, polish, "sweeps that take out what overlap is left"),
    FIELD("watch", TY_PARAM_FLOAT, "s", 0, 60, watch,
          "simulated time that it goes on at rest, to tell how far the elements move; the result is the same"),
    FIELD("state", TY_PARAM_BOOL, "", 0, 0, state,
          "the file holds the whole state of the pile before it is polished, so that pack --resume goes on from it"),
    FIELD("cohesion", TY_PARAM_FLOAT, "N/m", -1, 1, cohesion,
          "surface tension of the liquid between grains; below 0: follows moisture, 0 where no state is given"),
    FIELD("adhesion", TY_PARAM_FLOAT, "J/m^2", -1, 10, adhesion,
          "work of adhesion of sticky grains; below 0: of starch, follows moisture, 0 where no state is given"),
    {"solver", TY_PARAM_ENUM, "", 0, 0, solvers, NULL, offsetof(OWNER, solver),
     "impulse: rigid elements that come to rest; xpbd: elastic ones that bend, run for max_seconds, and creep", false},
    FIELD("modulus", TY_PARAM_FLOAT, "Pa", 0, 1e8, modulus,
          "Young's, of elastic elements: with xpbd, or pressed; 0: follows moisture, 3e5 where no state is given"),
    FIELD("rest", TY_PARAM_BOOL, "", 0, 0, rest,
          "with xpbd: at the end the elements are rigid, as they are bent, and come to rest by impulses"),
};
#undef OWNER

const ty_param_table recipe_settle = {"aggregate.settle",    "How the grains come to rest.",
                                      sizeof(ty_settle_def), settle_set_default,
                                      settle_rows,           TY_PARAM_COUNT(settle_rows)};

static const char* const press_from[] = {"above", "around", NULL};

static void press_set_default(void* def)
{
    *(ty_press_def*)def = ty_aggregate_recipe_default().press;
}

#define OWNER ty_press_def
static const ty_param press_rows[] = {
    FIELD("strain", TY_PARAM_FLOAT, "", 0, 0.5, strain, "how far, of height or extents; 0 = not at all"),
    FIELD("seconds", TY_PARAM_FLOAT, "s", 0.05, 10, seconds,
          "simulated: down over .4 of it, up from .5 to .8, then left; a mould stays down until it is taken off"),
    {"from", TY_PARAM_ENUM, "", 0, 0, press_from, NULL, offsetof(OWNER, from),
     "above: a lid, or a closed container towards its lowest point; around: a closed one towards its middle", false},
    FIELD("release", TY_PARAM_BOOL, "", 0, 0, release,
          "a container with role mould is taken off at the end, and the heap stands on the plane below"),
};
#undef OWNER

const ty_param_table recipe_press = {
    "aggregate.press",
    "A closed container is squeezed, into an open one comes a lid; then both open again. The elements are elastic in "
    "it; then they are rigid, bent and sheared as they are, and come to rest.",
    sizeof(ty_press_def),
    press_set_default,
    press_rows,
    TY_PARAM_COUNT(press_rows)};

static void wetness_set_default(void* def)
{
    *(ty_wetness_def*)def = ty_aggregate_recipe_default().moisture;
}

#define OWNER ty_wetness_def
static const ty_param wetness_rows[] = {
    FIELD("variation", TY_PARAM_FLOAT, "", 0, 1, variation, "share of chance in the attribute moisture (-1..1)"),
    FIELD("drying", TY_PARAM_FLOAT, "", 0, 1, drying, "how much drier the grains at the surface are"),
    FIELD("wet_basis", TY_PARAM_FLOAT, "", 0, 1, wet_basis,
          "water of the mass of wet grains, from 0.05: raw 0.145, soaked 0.31, cooked 0.62; 0: of soak and cooked"),
    FIELD("soak", TY_PARAM_FLOAT, "", 0, 100000, soak, "minutes in water, before cooking"),
    FIELD("celsius", TY_PARAM_FLOAT, "", 0, 60, celsius, "temperature of that water"),
    FIELD("cooked", TY_PARAM_FLOAT, "", -1, 1, cooked,
          "how far the starch is gelatinised; below 0: as wet_basis tells, after soaking alone not at all"),
    FIELD("swelling", TY_PARAM_FLOAT, "", 0, 2, swelling,
          "size of rice against its sizes, which are those at 0.62, from 0.5; 0: of the state"),
};
#undef OWNER

const ty_param_table recipe_moisture = {"aggregate.moisture",
                                        "The state of the grains: any of wet_basis, soak and cooked gives one. "
                                        "Cohesion, adhesion, stiffness and swelling follow "
                                        "it. Variation and drying are those of the attribute moisture.",
                                        sizeof(ty_wetness_def),
                                        wetness_set_default,
                                        wetness_rows,
                                        TY_PARAM_COUNT(wetness_rows)};

static void animate_set_default(void* def)
{
    *(ty_animate_def*)def = ty_aggregate_recipe_default().animate;
}

#define OWNER ty_animate_def
static const ty_param animate_rows[] = {
    FIELD("frames", TY_PARAM_INT, "", 0, 10000, frames, "of the film that pack writes to OUT.####.glb; 0 = none"),
    FIELD("fps", TY_PARAM_FLOAT, "1/s", 1, 1000, fps, "frames per second of simulated time"),
    FIELD("soak", TY_PARAM_FLOAT, "", 0, 100000, soak,
          "minutes in water of moisture.celsius; with any of soak, cook and stand the film begins with raw grains at "
          "rest, and the minutes of all three pass in its frames"),
    FIELD("cook", TY_PARAM_FLOAT, "", 0, 100000, cook, "minutes on the fire, in which rice becomes cooked and swells"),
    FIELD("stand", TY_PARAM_FLOAT, "", 0, 100000, stand,
          "minutes off it, in which rice dries from the surface by moisture.drying, and shrinks"),
};
#undef OWNER

const ty_param_table recipe_animate = {
    "aggregate.animate",    "The pile as it settles, or as its rice is soaked and cooked, frame by frame.",
    sizeof(ty_animate_def), animate_set_default,
    animate_rows,           TY_PARAM_COUNT(animate_rows)};
