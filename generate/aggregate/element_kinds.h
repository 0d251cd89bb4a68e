// SPDX-License-Identifier: Apache-2.0
// What elements of every kind share, and the makers of each.
#pragma once
#include <tsuya/generate/element.h>

// The blunt ellipsoid |x/a|^3 + (y/b)^2 + (z/c)^2 = 1 with taper, bend, twist, longitudinal ridges and the germ's
// dent. def is complete. On failure *out is zeroed.
TY_CHECKED ty_status ty_rice_init(const ty_element_def* def, ty_seed seed, int variant, ty_element* out,
                                  ty_error* error);

// The surface of that grain alone, at so many divisions, about its formula's origin: positions and triangles; dented or
// not. *width (m) is the variant's. On failure *out is NULL.
TY_CHECKED ty_status ty_rice_surface(const ty_element_def* def, ty_seed seed, int variant, int divisions, bool dented,
                                     ty_mesh** out, float* width, ty_error* error);
// The same grain as a solid on a grid.
TY_CHECKED ty_status ty_rice_field_init(const ty_element_def* def, ty_seed seed, int variant, ty_element* out,
                                        ty_error* error);
ty_grain_def ty_grain_def_default(void);
// What a cultivar swells by in cooking: 1.2 or 1.5 of its volume.
float ty_rice_swelling(int cultivar);

// Sizes of a mesh file; the rest as ty_element_complete.
TY_CHECKED ty_status ty_solid_complete(ty_element_def* def, const char* name, ty_error* error);
// The meshes of balls, grapes, beans, tofu, pebbles and files, with welds, normals and curvature.
TY_CHECKED ty_status ty_solid_mesh(const ty_element_def* def, ty_seed seed, int variant, ty_mesh** out,
                                   ty_error* error);
// A flake of ice: what random planes leave of a box.
TY_CHECKED ty_status ty_ice_mesh(const ty_element_def* def, ty_seed seed, int variant, ty_mesh** out, ty_error* error);

// Volume and inertia of the mesh; moves its centre of mass to the origin and returns by how much.
ty_vec3 ty_element_weigh(ty_element* element);
// The radius about the origin, of mesh and balls.
void ty_element_enclose(ty_element* element);

// Balls until no point of the surface is farther than tolerance (of the width) from their union: for the worst of
// a point outside the largest inner ball that comes near it, then all by least squares, again and again; none
// reaches farther than that out of the solid. Sets the width where it is 0 (to the middle extent), balls, capsule and
// fit.
TY_CHECKED ty_status ty_element_fit(ty_element* element, float tolerance, ty_error* error);
