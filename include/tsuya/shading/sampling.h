// SPDX-License-Identifier: Apache-2.0
// Warps from the unit square, with their densities.
#pragma once
#include <tsuya/base/math.h>

ty_vec2 ty_sample_disc(ty_vec2 u);                // concentric, radius 1
ty_vec3 ty_sample_cosine(ty_vec2 u);              // around +z; pdf cos / pi
ty_vec3 ty_sample_sphere(ty_vec2 u);              // pdf 1 / (4 pi)
ty_vec3 ty_sample_cone(ty_vec2 u, float cos_max); // around +z; pdf 1 / (2 pi (1 - cos_max))

// Piecewise-constant density on the unit square, for environment images. Cell (i, j) of row j spans
// [i, i+1) / width x [j, j+1) / height. All weights zero (or unusable) = uniform.
typedef struct ty_distribution ty_distribution;
ty_distribution* ty_distribution_create(const float* weights, int width,
                                        int height); // row-major; copies; NULL = no memory
void ty_distribution_destroy(ty_distribution* distribution);
ty_vec2 ty_distribution_sample(const ty_distribution* distribution, ty_vec2 u, float* pdf); // pdf per unit square
float ty_distribution_pdf(const ty_distribution* distribution, ty_vec2 p);
