// SPDX-License-Identifier: Apache-2.0
// Curvature of an instance's surface at a point, in world units.
#pragma once
#include <tsuya/geometry/trace.h>

// How much larger than its prototype the instance is: cbrt |det M|.
float ty_instance_scale(const ty_affine* to_world);

// (k1 + k2) / 2, 1/m, convex positive, as it is (may be negative). 0 where the mesh has none.
float ty_mean_curvature(const ty_world* world, const ty_surface_point* point);

// II(t,t), II(t,b), II(b,b) for the tangents of a frame about the normal. Zero where the mesh has none.
void ty_second_form(const ty_world* world, const ty_surface_point* point, ty_vec3 t, ty_vec3 b, float form[3]);
