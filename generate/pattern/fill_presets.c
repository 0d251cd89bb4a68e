// SPDX-License-Identifier: Apache-2.0
// Rates and conventions with names. Which rates give which pattern: Pearson 1993 and Munafo's table of the plane of
// feed and kill; each has been run here (docs/patterns.md shows them).
#include <tsuya/base/params.h>
#include <tsuya/generate/fill_recipe.h>

static const ty_fill_preset presets[] = {
    {"stripes", 0.067f, 0.062f, "a labyrinth of even width"},
    {"plain", 0.072f, 0.059f, "fills evenly; a hole of radius r closes in 72 r of time"},
    {"slow", 0.072f, 0.060f, "the same at .64 of the speed"},
    {"dying", 0.052f, 0.079f, "nothing lasts: its place stays empty"},
    {"spots", 0.0265f, 0.0605f, "spots that divide until they are everywhere"},
    {"mitosis", 0.0367f, 0.0649f, "cells that divide and stay apart"},
    {"worms", 0.058f, 0.0645f, "worms that grow at their ends and keep apart"},
    {"coral", 0.0545f, 0.062f, "branches that grow outwards"},
    {"maze", 0.029f, 0.057f, "a dense maze"},
    {"holes", 0.039f, 0.058f, "a plain with holes"},
    {"pulses", 0.020f, 0.056f, "spots that flare up, divide and vanish"},
    {"chaos", 0.025f, 0.0525f, "holes that come and go, never at rest"},
    {"restless", 0.025f, 0.055f, "a labyrinth that keeps on moving"},
    {"solitons", 0.030f, 0.062f, "spots that move apart and stay"},
    {"moving", 0.014f, 0.054f, "spots that wander"},
    {"waves", 0.018f, 0.050f, "waves that roll on and break up"},
};

static const ty_fill_convention conventions[] = {
    {"pearson", 0.2097152f, 0.1048576f, 1.0f, 5},
    {"munafo", 0.409f, 0.2045f, 0.5f, 5},
    {"sims", 0.3f, 0.15f, 1.0f, 9}, // its kernel .2, .05, -1 with 1 and .5 is .3 of the isotropic one
    {"processing", 0.16f, 0.08f, 1.0f, 5},
};

const ty_fill_preset* ty_fill_presets(int* count)
{
    *count = TY_PARAM_COUNT(presets);
    return presets;
}

const ty_fill_convention* ty_fill_conventions(int* count)
{
    *count = TY_PARAM_COUNT(conventions);
    return conventions;
}
