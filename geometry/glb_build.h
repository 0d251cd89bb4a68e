// SPDX-License-Identifier: Apache-2.0
// Puts a GLB file together: arrays into the BIN chunk, each with its view and accessor, then the JSON around them.
#pragma once
#include "glb.h"

typedef struct ty_glb_builder
{
    uint8_t* bytes; // of the BIN chunk, owned
    size_t size, capacity;
    json_t *views, *accessors;
} ty_glb_builder;

void ty_glb_builder_init(ty_glb_builder* builder);
void ty_glb_builder_term(ty_glb_builder* builder);

// Appends bytes of any kind, padded to a multiple of four, and returns the view's index.
int ty_glb_add_bytes(ty_glb_builder* builder, const void* bytes, size_t size);
// Appends count elements of `width` 32-bit components (1..4) and returns the accessor's index. target: 34962 for
// vertices, 34963 for indices, 0 for neither.
int ty_glb_add(ty_glb_builder* builder, const void* values, size_t count, int component, int width, int target);
// The same for whole numbers: as floats when all are exact as such, else as unsigned integers.
int ty_glb_add_integers(ty_glb_builder* builder, const uint32_t* values, size_t count);

// Adds buffer, views and accessors to root and writes the file. root is borrowed.
TY_CHECKED ty_status ty_glb_write(ty_glb_builder* builder, json_t* root, const char* path, ty_error* error);

// JSON text with sorted keys and nine digits: the same value gives the same bytes. Freed with ty_free.
char* ty_json_text(const json_t* value);
