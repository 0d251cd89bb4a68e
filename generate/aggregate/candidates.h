// SPDX-License-Identifier: Apache-2.0
// What both solvers find contacts with, and how they share the work on them: a grid over the bodies' centres, and
// blocks of pairs that lie together in space.
#pragma once
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/workers.h>

// Room for needed elements of a growing array.
void list_reserve(void** array, int* capacity, int needed, size_t size);

typedef struct body_grid
{
    ty_vec3 low;
    float cell; // m, no less than what is asked for: further where space is wide and empty
    int size[3];
    int* start;  // [cells + 1]
    int* sorted; // bodies by cell, ascending within one
    int* cell_of;
    const char* centers; // of the bodies, borrowed
    size_t stride;
    int count;
} body_grid;

// Bodies that are asked for together, of which there is no bound.
typedef struct body_list
{
    int* at;
    int count, capacity;
} body_list;

// bodies: [count] structs of stride bytes with their centre, a ty_vec3, at offset. cell > 0.
body_grid body_grid_create(const void* bodies, size_t offset, size_t stride, int count, float cell);
void body_grid_destroy(body_grid* grid);

// Bodies after body, at most a cell from it along each axis, that meet it, ascending. Any thread, own list.
typedef bool body_meet_fn(const void* owner, int a, int b);
void body_grid_after(const body_grid* grid, int body, body_meet_fn* meet, const void* owner, body_list* out);

// A body at most a cell from p along each axis that holds it, or -1.
typedef bool body_hold_fn(const void* owner, int body, ty_vec3 p);
int body_grid_find(const body_grid* grid, ty_vec3 p, body_hold_fn* hold, const void* owner);

enum
{
    BLOCK_CLASSES = 9, // of the cells of space by their eight parities, then that of the walls
};

// Pairs by where they are. A pair is in the block of the lower cell of its two bodies along each axis, so that a block
// has to do with bodies of two cells along each axis alone, and no two blocks of a class share a body.
typedef struct pair_blocks
{
    int* first; // [count + 1], of each block's pairs in the order
    int count, capacity;
    int class_first[BLOCK_CLASSES + 1]; // blocks, class by class
} pair_blocks;

// grid: whose cell is no shorter than any pair. pairs: [count] structs of stride bytes that begin with the numbers of
// two bodies, the second below 0 for a wall; walls are the last. order: [count] pairs by block, as they were within
// one.
void pair_blocks_make(pair_blocks* blocks, const body_grid* grid, const void* pairs, size_t stride, int count,
                      int* order);

// Runs fn over each block's range of the order, class after class; blocks of one class at the same time.
typedef void block_fn(void* context, int begin, int end);
void pair_blocks_sweep(const pair_blocks* blocks, ty_workers* workers, block_fn* fn, void* context);
