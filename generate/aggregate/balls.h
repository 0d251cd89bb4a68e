// SPDX-License-Identifier: Apache-2.0
// Fits the balls that stand for a grain.
#pragma once
#include <tsuya/generate/element.h>

// Moves and sizes the element's balls to the points, each point counting for the ball whose surface is nearest.
// goal > 0: points farther than that from the union weigh much more, so that the worst improves. Writes fit_rms and
// fit_max.
void ty_balls_refine(const ty_vec3* points, uint32_t count, int rounds, float goal, ty_element* element);

// The radius of the balls' hull about the line between the first and the last: for quick rejection.
float ty_balls_capsule(const ty_ball* balls, int count);

// For grains of rice. points lie on the surface, about evenly; half_size and bend give the start. Writes balls, fit_rms
// and fit_max.
void ty_balls_fit(const ty_vec3* points, uint32_t count, ty_vec3 half_size, float bend, ty_element* grain);
