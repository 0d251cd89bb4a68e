// SPDX-License-Identifier: Apache-2.0
// Memory that is given back all at once. One arena a lifetime: scene, render, per-worker scratch.
#pragma once
#include <tsuya/base/memory.h>

typedef struct ty_arena ty_arena; // opaque; one thread at a time
typedef struct ty_arena_mark
{
    int block;
    size_t used;
} ty_arena_mark;

ty_arena* ty_arena_create(size_t block_size); // bytes; 0 = 64 KiB. Cannot fail.
void ty_arena_destroy(ty_arena* arena);       // NULL is allowed
void ty_arena_reset(ty_arena* arena);         // everything is given back, blocks are kept (ASan: poisoned)

// Zeroed, 16-byte aligned. Valid until reset, rewind past it, or destroy.
void* ty_arena_alloc(ty_arena* arena, size_t count, size_t size);
char* ty_arena_string(ty_arena* arena, const char* text);
char* ty_arena_format(ty_arena* arena, const char* format, ...) TY_PRINTF(2, 3);

ty_arena_mark ty_arena_begin(const ty_arena* arena);
void ty_arena_end(ty_arena* arena, ty_arena_mark mark); // gives back what came after the mark

#define TY_ARENA_ALLOC(arena, type, count) ((type*)ty_arena_alloc(arena, (size_t)(count), sizeof(type)))
