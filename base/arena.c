// SPDX-License-Identifier: Apache-2.0
// A bump allocator over a list of blocks. Blocks after the current one are always empty.
#include "exhaustion.h"
#include "sanitize.h"
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/arena.h>

typedef struct arena_block
{
    uint8_t* data;
    size_t size, used;
} arena_block;

struct ty_arena
{
    arena_block* blocks;
    int count, capacity;
    int current; // blocks[0..current] may be in use
    size_t block_size;
};

enum
{
    arena_alignment = 16,
    // A poisoned gap between allocations, so that AddressSanitizer sees an overrun.
    arena_gap = TY_ASAN ? 16 : 0,
    arena_default_block = 64 * 1024
};

ty_arena* ty_arena_create(size_t block_size)
{
    ty_arena* arena = TY_ALLOC(ty_arena, 1);
    arena->block_size = block_size ? block_size : arena_default_block;
    arena->current = -1;
    return arena;
}

void ty_arena_destroy(ty_arena* arena)
{
    if (!arena)
        return;
    for (int i = 0; i < arena->count; i++)
    {
        TY_UNPOISON(arena->blocks[i].data, arena->blocks[i].size);
        ty_free(arena->blocks[i].data);
    }
    ty_free(arena->blocks);
    ty_free(arena);
}

static void block_rewind(arena_block* block, size_t used)
{
    block->used = used;
    TY_POISON(block->data + used, block->size - used);
}

void ty_arena_reset(ty_arena* arena)
{
    ty_arena_end(arena, (ty_arena_mark){-1, 0});
}

static void block_append(ty_arena* arena, size_t size)
{
    if (arena->count == arena->capacity)
    {
        int capacity = arena->capacity ? 2 * arena->capacity : 8;
        arena->blocks = ty_grow(arena->blocks, (size_t)arena->count, (size_t)capacity, sizeof(arena_block));
        arena->capacity = capacity;
    }
    arena_block* block = &arena->blocks[arena->count++];
    *block = (arena_block){ty_alloc(size, 1), size, 0};
    TY_POISON(block->data, block->size);
}

// Makes a block with at least size free bytes current: an empty one that is kept, or a new one.
static void block_advance(ty_arena* arena, size_t size)
{
    int next = arena->current + 1, found = next;
    while (found < arena->count && arena->blocks[found].size < size)
        found++;
    if (found == arena->count)
        block_append(arena, size > arena->block_size ? size : arena->block_size);
    arena_block block = arena->blocks[found];
    arena->blocks[found] = arena->blocks[next];
    arena->blocks[next] = block;
    arena->current = next;
}

void* ty_arena_alloc(ty_arena* arena, size_t count, size_t size)
{
    size_t bytes, room;
    if (__builtin_mul_overflow(count, size, &bytes) ||
        __builtin_add_overflow(bytes, (size_t)arena_alignment - 1 + arena_gap, &room))
        ty_memory_exhausted(count, size);
    room &= ~(size_t)(arena_alignment - 1);
    if (arena->current < 0 || arena->blocks[arena->current].size - arena->blocks[arena->current].used < room)
        block_advance(arena, room);
    arena_block* block = &arena->blocks[arena->current];
    uint8_t* memory = block->data + block->used;
    block->used += room;
    TY_UNPOISON(memory, bytes);
    return memset(memory, 0, bytes);
}

char* ty_arena_string(ty_arena* arena, const char* text)
{
    size_t size = strlen(text) + 1;
    return memcpy(ty_arena_alloc(arena, size, 1), text, size);
}

char* ty_arena_format(ty_arena* arena, const char* format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    TY_ASSERT(length >= 0);
    char* text = ty_arena_alloc(arena, (size_t)length + 1, 1);
    va_start(arguments, format);
    vsnprintf(text, (size_t)length + 1, format, arguments);
    va_end(arguments);
    return text;
}

ty_arena_mark ty_arena_begin(const ty_arena* arena)
{
    return (ty_arena_mark){arena->current, arena->current < 0 ? 0 : arena->blocks[arena->current].used};
}

void ty_arena_end(ty_arena* arena, ty_arena_mark mark)
{
    TY_ASSERT(mark.block <= arena->current);
    for (int i = mark.block + 1; i <= arena->current; i++)
        block_rewind(&arena->blocks[i], 0);
    if (mark.block >= 0)
        block_rewind(&arena->blocks[mark.block], mark.used);
    arena->current = mark.block;
}
