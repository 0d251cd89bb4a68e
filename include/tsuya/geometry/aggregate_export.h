// SPDX-License-Identifier: Apache-2.0
// Aggregates and meshes for other programs: USD text, PLY points, OBJ, and one realised mesh.
#pragma once
#include <tsuya/geometry/aggregate.h>

// USD text: a PointInstancer with its prototypes as Mesh prims beneath it; ids, every attribute as a primvar, recipe
// and hash as customData. It holds position, orientation and scale alone: of a sheared instance the nearest. Atomic.
TY_CHECKED ty_status ty_aggregate_write_usd(const char* path, const ty_aggregate* aggregate, ty_error* error);

// Binary PLY points: x y z, orient_x .. orient_w, pscale (with scale_x .. scale_z where an instance is stretched), id,
// prototype where there are several, and every attribute. No prototype meshes, and no shear. Atomic.
TY_CHECKED ty_status ty_aggregate_write_points(const char* path, const ty_aggregate* aggregate, ty_error* error);

// All instances as one mesh, in their order: the prototypes' attributes, slots and curvature where all have them; the
// instances' id and attributes on each of their vertices (those that a prototype has on its vertices stay the
// prototype's). The caller owns *out. Instances that need more than 2^32 - 2 vertices or triangles are TY_BAD_INPUT.
TY_CHECKED ty_status ty_aggregate_realise(const ty_aggregate* aggregate, ty_mesh** out, ty_error* error);

// OBJ text: positions, normals, uv, and one group a slot (usemtl). Atomic.
TY_CHECKED ty_status ty_obj_write(const char* path, const ty_mesh* mesh, ty_error* error);
// GLB with one mesh and one node, a primitive a slot, no extension. Atomic.
TY_CHECKED ty_status ty_glb_write_mesh(const char* path, const ty_mesh* mesh, ty_error* error);

// The endings that ty_aggregate_export knows: "glb", "usda", "ply", "obj", then NULL.
extern const char* const ty_aggregate_endings[];

// Writes by the path's ending: .glb and .usda with instances, .ply points; realised a .glb or .ply of one mesh. An .obj
// is always realised; a .usda never.
TY_CHECKED ty_status ty_aggregate_export(const char* path, const ty_aggregate* aggregate, bool realised,
                                         ty_error* error);
