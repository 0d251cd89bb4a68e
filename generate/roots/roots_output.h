// SPDX-License-Identifier: Apache-2.0
// What becomes of grown roots besides their mesh: a file of centre lines, a report, frames of their growth.
#pragma once
#include "roots.h"
#include <tsuya/base/sink.h>

// All that was made. Borrowed.
typedef struct roots_result
{
    const ty_roots_recipe* recipe;
    const roots_host* host;
    const roots_network* network;
    const roots_skin* skin;  // NULL: the mesh is tubes
    const roots_point* axes; // [vertex_count] where each vertex of tubes belongs; else NULL
    const ty_mesh* mesh;
    double host_seconds, grow_seconds, surface_seconds;
} roots_result;

// The surface of a network with all that stands at its vertices; *skin is the caller's too, on failure NULL as *out.
TY_CHECKED ty_status roots_surface(const ty_roots_recipe* recipe, const roots_network* network, const roots_host* host,
                                   ty_workers* workers, roots_skin** skin, ty_mesh** out, ty_error* error);

// Tubes about all lines, with all that stands at their vertices, held against the host by our method. level: 0 or
// coarser. axes (NULL: not wanted): as of a result, the caller frees it with ty_free. On failure *out is NULL.
TY_CHECKED ty_status roots_tubes_make(const ty_roots_recipe* recipe, const roots_network* network,
                                      const roots_host* host, int level, ty_workers* workers, ty_mesh** out,
                                      roots_point** axes, ty_error* error);

// The mesh of the recipe's kind.
typedef struct roots_shape
{
    ty_mesh* mesh;
    roots_skin* skin;  // or NULL
    roots_point* axes; // or NULL
} roots_shape;

// On failure *out is zeroed.
TY_CHECKED ty_status roots_shape_make(const ty_roots_recipe* recipe, const roots_network* network,
                                      const roots_host* host, ty_workers* workers, roots_shape* out, ty_error* error);
void roots_shape_term(roots_shape* shape);
// Levels 1 and up of the recipe's kind of mesh, each once, in order.
TY_CHECKED ty_status roots_levels_make(const roots_result* result, const ty_mesh_sink* sink, ty_workers* workers,
                                       ty_error* error);

// --- centre lines as a file ---

// An ASCII PLY with the elements vertex, edge (for other programs) and line: docs/roots.md. Nine digits bring every
// number back. The caller frees it with ty_free.
char* roots_curves_text(const roots_network* network);
// The same, perhaps edited. Counts of lines by kind are those of the file. On failure *out is zeroed and the error has
// line and column.
TY_CHECKED ty_status roots_curves_read(const char* path, roots_network* out, ty_error* error);

// --- report ---

// Figures of network and mesh as a JSON object; the caller frees it with ty_free.
char* roots_report(const roots_result* result, ty_workers* workers);
// `, "methods": {...}`: what failed of the network, and by the thesis' method beside it what fails of ours on the same
// host.
void roots_compare(const roots_result* result, ty_workers* workers, ty_sink* out);

// --- growth by time ---

// How thick a part is at t, 0..1, of its radius in the end. It never falls; 1 everywhere at t = 1.
float roots_growth_at(float birth, float t);
// A root lies on its host from the beginning: the centre of its section rises as it thickens.
ty_vec3 roots_center_at(const roots_point* p, float grown);
// Which roots run together in the end. join: of the thinner radius; detail: m, the surface's cells. NULL: no memory.
typedef struct roots_carry roots_carry; // opaque
roots_carry* roots_carry_create(const roots_network* network, const roots_host* host, float join, float detail);
void roots_carry_destroy(roots_carry* carry); // NULL is allowed
// Where the points of the centre lines are at t: [point_count]. At t = 1 they are where the network has them.
void roots_carry_at(const roots_carry* carry, float t, ty_vec3* places);
// Frames 1..count of the growing mesh, the last the same as the still one bit for bit.
TY_CHECKED ty_status roots_growth_frames(const roots_result* result, const ty_mesh_sink* sink, ty_workers* workers,
                                         ty_error* error);
