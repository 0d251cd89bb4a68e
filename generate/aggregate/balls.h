// SPDX-License-Identifier: Apache-2.0
// Fits the balls that stand for a grain.
#pragma once
#include <tsuya/generate/element.h>

// points lie on the surface, about evenly; half_size and bend give the start. Writes balls, fit_rms and fit_max.
void ty_balls_fit(const ty_vec3* points, uint32_t count, ty_vec3 half_size, float bend, ty_element* grain);
