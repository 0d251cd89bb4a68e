// SPDX-License-Identifier: Apache-2.0
// Mesh files: PLY by our own bounded reader, OBJ/STL/others through assimp in a child process.
#pragma once
#include <tsuya/geometry/mesh.h>

// By extension (.ply .obj .stl .fbx .dae .off .glb .gltf; of the last two all nodes as one). Validated, with welds,
// normals (the file's, or computed) and bounds. Any fault of the file, a crash of the importer included, is TY_BAD_FILE
// with a reason (for PLY with line or byte).
TY_CHECKED ty_status ty_mesh_read(const char* path, ty_mesh** out, ty_error* error);

// A .ply file of a sequence: its vertices are those of the file, none split; normals that it lacks are smooth.
TY_CHECKED ty_status ty_mesh_read_frame(const char* path, ty_mesh** out, ty_error* error);

// PLY from memory (ascii, binary little and big endian). Keeps every scalar vertex property that is not a position,
// normal, uv or index as a named attribute; properties NAME_x NAME_y NAME_z are not joined. Polygons are fanned.
TY_CHECKED ty_status ty_ply_read_memory(const char* name, const void* bytes, size_t size, ty_mesh** out,
                                        ty_error* error);

// Binary little-endian PLY with normals, uv (s, t), curvature and attributes where present, recipe and hash as
// comments. Atomic.
TY_CHECKED ty_status ty_ply_write(const char* path, const ty_mesh* mesh, ty_error* error);
