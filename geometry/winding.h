// SPDX-License-Identifier: Apache-2.0
// Generalised winding numbers of parts of meshes that may be open: a tree of dipoles (Barill, Dickson, Schmidt, Levin
// and Jacobson 2018), and which parts there are.
#pragma once
#include <tsuya/geometry/mesh.h>

typedef struct winding winding; // opaque

// Of `count` triangles of the mesh, by their numbers; side[triangle] -1 turns one round, NULL: none. Borrows the mesh
// until winding_destroy. NULL: no memory.
TY_CHECKED winding* winding_create(const ty_mesh* mesh, const uint32_t* triangles, uint32_t count, const int8_t* side);
void winding_destroy(winding* w); // NULL is allowed
// 1 inside of a closed outward surface, 0 outside, between them about what is open; within a hundredth but next to the
// surface, where it is exact. Any thread.
float winding_at(const winding* w, ty_vec3 p);

// What a triangle's part is: triangles that share welded corners are of one part.
typedef enum mesh_part_kind
{
    MESH_PART_CLOSED, // edges cancel: the winding number is whole everywhere
    MESH_PART_OPEN,   // open, but holds a space in
    MESH_PART_SHEET,  // open, and the winding number is nowhere clearly more than one half: no side is the inside
} mesh_part_kind;

typedef struct mesh_parts
{
    uint8_t* kind;  // mesh_part_kind, [triangle_count]
    int8_t* side;   // -1 where an open part is inside out, [triangle_count]
    uint32_t* open; // triangles of open parts
    uint32_t open_count;
    bool closed; // all parts are
} mesh_parts;

// The mesh has welds. False: no memory; *out is zeroed then.
TY_CHECKED bool mesh_parts_find(const ty_mesh* mesh, mesh_parts* out);
void mesh_parts_term(mesh_parts* parts);
