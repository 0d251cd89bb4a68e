// SPDX-License-Identifier: Apache-2.0
// Meshes and aggregates through the pipe of an importer's child: flat arrays behind small headers, in the machine's own
// byte order. Whoever receives believes nothing of it.
#pragma once
#include "aggregate_gather.h"

typedef struct ty_receiver
{
    const char* name; // of the file, for messages
    const uint8_t* at;
    size_t left;
    ty_error* error;
} ty_receiver;

TY_CHECKED ty_status ty_mesh_send(int fd, const ty_mesh* mesh, ty_error* error);

// count elements of size bytes; what is not there is TY_BAD_FILE.
TY_CHECKED ty_status ty_take(ty_receiver* r, void* out, size_t count, size_t size);
// Validated, with welds, normals and bounds; index = its number in messages. On failure *out is NULL or what was made
// so far, for the caller to destroy.
TY_CHECKED ty_status ty_mesh_take(ty_receiver* r, int index, ty_mesh** out);
TY_CHECKED ty_status ty_aggregate_take(ty_receiver* r, ty_aggregate** out);
TY_CHECKED ty_status ty_receive_end(const ty_receiver* r); // nothing may be left
