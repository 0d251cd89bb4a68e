// SPDX-License-Identifier: Apache-2.0
// Ray cones: how wide the bundle is that one path stands for, so that textures are averaged over it.
#pragma once
#include "integrator.h"

// Nothing happens to a cone that is not active: scenes without textures need none.
typedef struct ty_cone
{
    float width;  // m, diameter at the ray's origin
    float spread; // rise of the width over the distance; negative where a curved surface has focused
    bool active;
} ty_cone;

// Of a camera ray: a pixel, less the more samples share it.
ty_cone ty_cone_begin(const ty_integrator* in, const ty_ray* ray);
// The ray has met the point after `distance`: sets its footprint, and the origin of the next ray lies there.
void ty_cone_arrive(ty_cone* cone, ty_vec3 direction, float distance, ty_surface_point* point);
// It goes on by a sample of the surface that it met.
void ty_cone_scatter(const ty_integrator* in, const ty_bsdf* bsdf, const ty_bsdf_sample* sample, ty_cone* cone);
