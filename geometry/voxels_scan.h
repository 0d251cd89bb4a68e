// SPDX-License-Identifier: Apache-2.0
// From a mesh to a grid of distances: what is done for each triangle and each node, and the distance transform.
#pragma once
#include "voxels.h"
#include <tsuya/base/workers.h>

typedef struct voxels_scan
{
    const ty_mesh* mesh;
    ty_voxels* v;
    int32_t* site;  // the node next to the surface that is nearest, [nodes]; -1 = none yet
    int32_t* near;  // the triangle that is nearest, [nodes]; -1 = none yet
    int16_t* turns; // change of the winding number between a node and the one before it in its row
} voxels_scan;

// Layers low..high of the grid, of those that the triangle reaches. Any thread that has them to itself.
void voxels_scan_turn(voxels_scan* s, const uint32_t corners[3], int low, int high);
// All nodes of the triangle's box and one step about it; thin: of those the ones near its plane.
void voxels_scan_spread(voxels_scan* s, int32_t triangle, int low, int high, bool thin);
// Every node's site from those that are sites themselves. False: no memory.
bool voxels_scan_transform(voxels_scan* s, ty_workers* workers);
ty_vec3 voxels_scan_closest(const voxels_scan* s, int32_t triangle, ty_vec3 p);
// Takes the triangle where it is nearer than what the node has; values are squares.
void voxels_scan_try(voxels_scan* s, size_t node, ty_vec3 p, int32_t triangle);
// Goes on over the surface from the node's triangle to nearer ones.
void voxels_scan_descend(voxels_scan* s, size_t node, ty_vec3 p);
// Asks a node's neighbours for nearer triangles.
void voxels_scan_ask(voxels_scan* s, const int at[3], ty_vec3 p);
