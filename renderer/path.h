// SPDX-License-Identifier: Apache-2.0
// What one path carries from vertex to vertex, and the light that is gathered at a vertex.
#pragma once
#include "integrator.h"

typedef struct ty_path
{
    ty_ray ray;
    ty_rgb beta; // throughput
    ty_light_view view;
    int bounce; // surfaces passed before the present one
} ty_path;

// One light sample at a surface. u: two for the light's surface, one to choose it, one for the ray's start.
ty_rgb ty_path_direct_light(const ty_integrator* in, const ty_bsdf* bsdf, const float u[4], ty_counters* counters);

// What the sampled direction of a lobe meets of the lights, the scene between. u: for the ray's start.
ty_rgb ty_path_light_along(const ty_integrator* in, const ty_bsdf* bsdf, const ty_bsdf_sample* sample, float u,
                           ty_counters* counters);
