// SPDX-License-Identifier: Apache-2.0
// The recipe of a living pattern: Gray–Scott from drops, seen over a loop of frames. `kind: fill`.
#pragma once
#include <tsuya/generate/asset.h>
#include <tsuya/generate/gray_scott.h>

typedef enum ty_pattern_tile
{
    TY_PATTERN_TILE_BOTH,   // left meets right and top meets bottom
    TY_PATTERN_TILE_AROUND, // left meets right: for what is wrapped around a vase
} ty_pattern_tile;

typedef struct ty_pattern_drops
{
    int count;     // 1..100000
    float radius;  // cells, 1..100
    float area[2]; // share of the height where they fall, from the bottom, 0..1
} ty_pattern_drops;

// Frame i of n shows the pattern at step steps + span sin(2 pi i / n), moved by drift cos(2 pi i / n) around: a circle
// through the volume of all states, uniform in speed and closed.
typedef struct ty_pattern_loop
{
    int frames;  // n, 1..100000
    int span;    // steps, 0..steps
    float drift; // cells
} ty_pattern_loop;

typedef struct ty_fill_recipe
{
    ty_gray_scott_def field; // its wrap is set from tile
    int cells[2];            // width and height of the field
    int scale;               // pixels of a frame per cell, 1..8
    int tile;                // ty_pattern_tile
    float variation;         // of feed, relative, 0..0.5
    float variation_size;    // cells
    ty_pattern_drops drops;
    int steps; // to the middle of the loop
    ty_pattern_loop loop;
    float tone[2];    // of v: where low and high are reached
    ty_rgb low, high; // ACEScg; both grey: the frames have the channel Y alone
    ty_seed seed;
} ty_fill_recipe;

ty_fill_recipe ty_fill_recipe_default(void); // a labyrinth of 256 x 256 cells that tiles, 24 frames
const ty_param_table* ty_fill_recipe_params(void);
// def is a ty_fill_recipe; as ty_generator's make.
TY_CHECKED ty_status ty_fill_make(const void* def, ty_workers* workers, const ty_frame_sink* sink, ty_error* error);
extern const ty_generator ty_fill_generator;
