// SPDX-License-Identifier: Apache-2.0
// What one path carries from vertex to vertex, and the light that is gathered at a vertex.
#pragma once
#include "cone.h"

typedef struct ty_path
{
    ty_ray ray;
    ty_rgb beta; // throughput
    ty_light_view view;
    ty_cone cone;
    int bounce; // surfaces passed before the present one
} ty_path;

// Where a surface gathers light, for choosing a light there.
ty_light_point ty_path_light_point(const ty_integrator* in, const ty_bsdf* bsdf);

// One light sample at a surface, times beta to out. u: two for the light's surface, one to choose it, one for the ray's
// start.
void ty_path_direct_light(const ty_integrator* in, const ty_bsdf* bsdf, const float u[4], ty_rgb beta,
                          ty_film_sample* out, ty_counters* counters);

// What the sampled direction of a coat meets of the lights, the scene between, times beta to out. u: for the ray's
// start.
void ty_path_light_along(const ty_integrator* in, const ty_bsdf* bsdf, const ty_bsdf_sample* sample, float u,
                         ty_rgb beta, ty_film_sample* out, ty_counters* counters);
