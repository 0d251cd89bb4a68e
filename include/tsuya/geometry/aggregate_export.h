// SPDX-License-Identifier: Apache-2.0
// Aggregates and meshes for other programs: USD text, PLY points, OBJ, and one realised mesh.
#pragma once
#include <tsuya/base/workers.h>
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

typedef struct ty_facet_def
{
    float close; // m: gaps up to half of it are closed, wider ones less and less up to it; 0 = none
} ty_facet_def;

ty_facet_def ty_facet_def_default(void);

typedef struct ty_facet_report
{
    uint32_t contacts;                  // pairs of instances that reached into one another, or came near
    uint32_t vertices;                  // that moved
    float deepest, left;                // m, farthest that a vertex lies within another instance, before and after
    double volume_before, volume_after; // m^3, of all instances
} ty_facet_report;

// The same with flat contact facets: where two instances reach into one another, the vertices of both move onto the
// plane midway between their surfaces (where that is no plane: onto what lies midway), then to where the other's
// surface went; afterwards no vertex lies within another instance but for some thousandths of their width. Normals
// follow, and curvature is 0 on the facets. What lies altogether within another instance (the white of an egg) is left
// alone. Prototypes must be closed: else TY_BAD_INPUT. report may be NULL. Equal bits for any number of workers.
TY_CHECKED ty_status ty_aggregate_realise_facets(const ty_aggregate* aggregate, const ty_facet_def* def,
                                                 ty_workers* workers, ty_mesh** out, ty_facet_report* report,
                                                 ty_error* error);

// A mesh by the path's ending: .glb, .ply or .obj.
TY_CHECKED ty_status ty_mesh_export(const char* path, const ty_mesh* mesh, ty_error* error);

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
