// SPDX-License-Identifier: Apache-2.0
// The recipe of a living pattern: Gray–Scott on cells with marks, as a loop of one pattern or as a run of frames with
// events. `kind: fill`.
#pragma once
#include <tsuya/generate/asset.h>
#include <tsuya/generate/gray_scott.h>

// --- names of numbers ---

// Rates with a name; every table of diffusions gives the same pattern for them, at another scale.
typedef struct ty_fill_preset
{
    const char* name;
    float feed, kill;
    const char* help;
} ty_fill_preset;

// What a grid cell and a unit of time are, by whose table.
typedef struct ty_fill_convention
{
    const char* name;
    float diffusion_u, diffusion_v, time_step;
    int stencil; // points of the Laplacian
} ty_fill_convention;

const ty_fill_preset* ty_fill_presets(int* count);
const ty_fill_convention* ty_fill_conventions(int* count);

// --- parts of the recipe ---

typedef enum ty_pattern_tile
{
    TY_PATTERN_TILE_BOTH,   // left meets right and top meets bottom
    TY_PATTERN_TILE_AROUND, // left meets right: for what is wrapped around a vase
    TY_PATTERN_TILE_NONE,   // edges all around
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

// What a place gets when an event gives it a mark, because smooth outlines keep most patterns out.
typedef struct ty_fill_seeding
{
    float spacing; // cells from one spot to the next, 0 = none
    float radius;  // of a spot, cells
    float jitter;  // of feed, relative, standing, cell by cell
    float rough;   // cells by which outlines go in and out
    ty_seed seed;
} ty_fill_seeding;

typedef struct ty_fill_mark
{
    const char* name;
    int preset;                  // of ty_fill_presets
    float feed, kill;            // 0 = the preset's
    ty_rgb color, ground;        // ACEScg, where v is high and where it is low
    const char *image, *beneath; // in their places: a file or a pattern; NULL = none
    float opacity;               // of color or image, over what is behind the whole
    float ground_opacity;
    ty_fill_seeding seed;
} ty_fill_mark;

typedef enum ty_fill_op
{
    TY_FILL_MARK,
    TY_FILL_UNMARK, // mark 0 again
    TY_FILL_HOLE,   // u = 1, v = 0; with a mark, marked as well
    TY_FILL_FILL,   // the plain state of the mark
    TY_FILL_SEED,   // spots, or one as large as the shape
    TY_FILL_BARRIER,
    TY_FILL_UNBARRIER,
} ty_fill_op;

typedef enum ty_fill_shape
{
    TY_FILL_CIRCLE,
    TY_FILL_RECTANGLE,
    TY_FILL_POLYGON,
    TY_FILL_BRUSH, // a stroke along points
    TY_FILL_IMAGE,
    TY_FILL_ALL,
} ty_fill_shape;

// Cells are counted from the upper left corner: the first has its middle at .5.
typedef struct ty_fill_event
{
    int at, until; // frames, from 1; until 0 = at alone
    int op;        // ty_fill_op
    const char* mark;
    int shape; // ty_fill_shape
    float center[2], size[2];
    float to[2]; // where the centre is at `until`; negative = it stays
    float radius;
    float radius_to;      // at `until`; negative = as it is
    float angle;          // radians, clockwise
    ty_param_list points; // ty_vec2
    const char* image;
    int channel; // ty_plane_channel
    float threshold;
    bool invert;
    float feather; // cells
    int close;     // frames within which this hole closes; tells the steps of a frame; 0 = they are told
} ty_fill_event;

typedef enum ty_fill_opened
{
    TY_FILL_OPENED_NEAREST,
    TY_FILL_OPENED_PLAIN,
    TY_FILL_OPENED_EMPTY,
} ty_fill_opened;

// Outside nothing is and nothing passes.
typedef struct ty_fill_region
{
    const char* mask; // a file or a pattern; NULL = everywhere
    int channel;
    float threshold;
    bool invert;
    int opened;       // ty_fill_opened: of cells that the mask opens, or `unbarrier`
    bool keep_closed; // cells that close keep what they hold until they open; else u = 1, v = 0
} ty_fill_region;

typedef enum ty_fill_where
{
    TY_FILL_WHERE_HOLE,
    TY_FILL_WHERE_FILLED,
    TY_FILL_WHERE_BAND,  // by distance from the front
    TY_FILL_WHERE_TRAIL, // wherever v has been above the threshold
} ty_fill_where;

// A mark that follows the pattern, over those that are set.
typedef struct ty_fill_auto
{
    const char* mark;
    int where;        // ty_fill_where
    float reach[2];   // BAND: cells from the front, positive in the hole
    float threshold;  // TRAIL: of v
    const char* over; // only where this is the mark; NULL = on all
    bool rates;       // it counts for feed and kill as well, from frame to frame
} ty_fill_auto;

typedef struct ty_fill_run
{
    int frames;  // 0 = the loop instead
    float steps; // of a frame; parts of a step add up
    int before;  // steps before the first frame
    int first;   // number that masks and images of sequences have at frame 1
} ty_fill_run;

// Feed from the lowest row to the highest and kill from the left to the right, for a picture of all patterns.
typedef struct ty_fill_map
{
    float feed[2], kill[2]; // feed[1] 0 = no map
} ty_fill_map;

typedef enum ty_pattern_start
{
    TY_PATTERN_START_DROPS,
    TY_PATTERN_START_PLAIN,
    TY_PATTERN_START_EMPTY,
} ty_pattern_start;

typedef struct ty_fill_recipe
{
    int cells[2]; // width and height of the field
    int scale;    // pixels of a frame per cell, 1..32
    int tile;     // ty_pattern_tile
    int convention;
    float diffusion_u, diffusion_v, time_step; // 0 = the convention's
    int stencil;                               // 0 = the convention's, else 5 or 9
    int preset;
    float feed, kill; // of all cells without a table of marks; 0 = the preset's
    ty_fill_map map;
    float variation;      // of feed, relative, 0..0.5
    float variation_size; // cells
    ty_param_list marks;  // ty_fill_mark, at most TY_GRAY_SCOTT_MARKS
    int start;            // ty_pattern_start
    ty_pattern_drops drops;
    ty_fill_region region;
    int steps; // to the middle of the loop
    ty_pattern_loop loop;
    ty_fill_run run;
    ty_param_list events; // ty_fill_event, in the order of the recipe where their frames are equal
    ty_param_list autos;  // ty_fill_auto, each over those before
    float level;          // of v: where a front is; 0 = half of the plain state's
    bool sharp;           // colours meet at the level within a pixel instead of over `tone`
    float tone[2];        // of v: where low and high are reached
    ty_rgb low, high;     // ACEScg; all grey: the frames have the channel Y alone
    const char* over;     // what stands behind and around: a file or a pattern; NULL = nothing
    ty_rgb outside;       // colour of closed cells without it
    ty_param_strings outputs;
    ty_seed seed;
} ty_fill_recipe;

ty_fill_recipe ty_fill_recipe_default(void); // a labyrinth of 256 x 256 cells that tiles, 24 frames
extern const ty_param_table ty_fill_recipe_table;
// def is a ty_fill_recipe; as ty_generator's make. Frames have Y or R, G, B (and A where something is not opaque), and
// the outputs as float channels: u, v, mark, trail (frame when v passed the threshold first, -1 = not yet), distance
// (cells from the front, positive in the hole), matte.NAME for each mark and matte.closed, which add up to 1.
TY_CHECKED ty_status ty_fill_make(const void* def, ty_workers* workers, const ty_frame_sink* sink, ty_error* error);
// Width and height of its frames, and its mistakes, before any step; no warnings.
TY_CHECKED ty_status ty_fill_size(const ty_fill_recipe* recipe, int size[2], ty_error* error);
// The same, but a run goes on after the frame whose state that is (what sink->keep was given, as a file); NULL: from
// the beginning. The same recipe then gives the very frames that it would have given without a stop.
TY_CHECKED ty_status ty_fill_make_from(const void* def, ty_workers* workers, const ty_frame_sink* sink,
                                       const ty_bytes* state, ty_error* error);
extern const ty_generator ty_fill_generator;
