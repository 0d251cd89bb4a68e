// SPDX-License-Identifier: Apache-2.0
// Which side of open parts of a mesh the nodes of a grid are on.
#pragma once
#include "voxels_scan.h"
#include "winding.h"

// Nodes about which open parts wind more than one half become inside; where that ends with no surface near there is a
// lid, from which the distance counts as from the surface. Values are signed distances from all of the mesh already;
// sites are lost. False: no memory.
bool voxels_open_fill(voxels_scan* s, const mesh_parts* parts, ty_workers* workers);
// Nodes whose nearest triangle is within another part of the mesh get the distance to what is not, some 16 steps down.
// Values are signed; sites are lost. False: no memory.
bool voxels_buried_pass(voxels_scan* s, ty_workers* workers);
