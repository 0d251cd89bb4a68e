// SPDX-License-Identifier: Apache-2.0
// What a recipe for aggregates is where it says nothing.
#include "mixture.h"

ty_aggregate_recipe ty_aggregate_recipe_default(void)
{
    ty_pile_def pile = ty_pile_def_default();
    return (ty_aggregate_recipe){
        .element = ty_element_def_default(),
        .container = ty_container_def_default(),
        .fill = {.count = 2000,
                 .density = 0.60f,
                 .heap = 12e-3f,
                 .tilt = TY_PI / 3.0f,
                 .roll = TY_PI,
                 .sprinkle = 0.06f,
                 .sweeps = 200,
                 .thesis = {.refine = 1.0f, .offset = 0.0f, .remove = 1.0f},
                 .pour = {.radius = 0.015f, .rate = 500.0f, .speed = 0.5f}},
        .settle = {.friction = pile.friction,
                   .rolling = pile.rolling,
                   .max_seconds = 3.0f,
                   .rate = pile.rate,
                   .polish = 100,
                   .solver = TY_SOLVER_IMPULSE,
                   .cohesion = -1.0f,
                   .adhesion = -1.0f},
        .press = {.strain = 0.0f, .seconds = 0.6f, .from = TY_PRESS_ABOVE, .release = true},
        .moisture = {.variation = 0.8f, .drying = 0.4f, .celsius = 10.0f, .cooked = -1.0f},
        .animate = {.frames = 0, .fps = 24.0f},
        .seed = {7},
    };
}
