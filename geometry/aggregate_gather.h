// SPDX-License-Identifier: Apache-2.0
// From the importer's model to an aggregate, and an aggregate through a pipe: the child's and the parent's halves.
#pragma once
#include "gltf_shim.h"
#include <tsuya/base/file.h>
#include <tsuya/geometry/aggregate.h>

// Meshes become prototypes, instanced nodes their instances (a node with a mesh and no instances is one instance). The
// order is _ORDER's where given, else the nodes'. Meshes without normals have normals == NULL afterwards.
TY_CHECKED ty_status ty_aggregate_gather(const char* name, const ty_gltf* gltf, ty_aggregate** out, ty_error* error);

// The instances of one node in its own space, without a prototype.
TY_CHECKED ty_status ty_aggregate_gather_node(const char* name, const ty_gltf* gltf, int node, ty_aggregate** out,
                                              ty_error* error);

// Placements regular, numbers finite, prototypes there: else TY_BAD_FILE that names the instance.
TY_CHECKED ty_status ty_aggregate_validate(const char* path, const ty_aggregate* aggregate, ty_error* error);

TY_CHECKED ty_status ty_aggregate_send(int output_fd, const ty_aggregate* aggregate, ty_error* error);
// Bounded by size: what does not add up is TY_BAD_FILE. Recipe, hash and metrics do not travel.
TY_CHECKED ty_status ty_aggregate_receive(const char* name, const void* bytes, size_t size, ty_aggregate** out,
                                          ty_error* error);
