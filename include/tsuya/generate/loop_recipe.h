// SPDX-License-Identifier: Apache-2.0
// The recipe of a looping texture: a rectangle moves through a volume on a closed path, and what it cuts are the
// frames. `kind: loop`.
#pragma once
#include <tsuya/generate/fill_recipe.h>

enum
{
    TY_LOOP_COLORS = 16,  // of a volume, the background apart
    TY_LOOP_DEPTH = 2048, // voxels of a side at most
};

typedef enum ty_loop_source
{
    TY_LOOP_REACTION, // slices of Gray–Scott in time, from drops or from a logo
    TY_LOOP_FILL,     // frames of a fill
    TY_LOOP_STACK,    // pictures by number
    TY_LOOP_STILL,    // one picture, in every slice
    TY_LOOP_RAW,      // numbers of a file
} ty_loop_source;

typedef struct ty_loop_reaction
{
    int cells[2]; // 0 = as the logo
    int depth;    // slices; odd with a logo, which is the one in the middle
    int start;    // steps before the first slice, without a logo
    int every;    // steps from slice to slice
    float feed, kill, diffusion_u, diffusion_v, time_step;
    ty_pattern_drops drops; // without a logo
    const char* logo;       // NULL = none
    float gaps;             // share of the logo, in squares of 5 cells, that the reaction does not start from, 0..0.95
    ty_seed seed;
} ty_loop_reaction;

typedef enum ty_loop_number
{
    TY_LOOP_U8,
    TY_LOOP_U16,
    TY_LOOP_F32,
} ty_loop_number;

typedef struct ty_loop_raw
{
    const char* file; // NULL = none; x fastest, then y (from the top), then z
    int width, height, depth;
    int type;   // ty_loop_number
    int header; // bytes before the first number
    bool big_endian;
} ty_loop_raw;

typedef enum ty_loop_mirror
{
    TY_LOOP_MIRROR_NONE,
    TY_LOOP_MIRROR_X, // the half above zero on both sides
    TY_LOOP_MIRROR_Y,
    TY_LOOP_MIRROR_Z,
} ty_loop_mirror;

typedef enum ty_loop_mix
{
    TY_LOOP_MIX_LARGEST, // the colour of which there is most
    TY_LOOP_MIX_BLEND,   // the mean of all, by how much there is
} ty_loop_mix;

// One volume. Numbers become 0..1 by range; then mirror, twist and rotate, about its centre.
typedef struct ty_loop_part
{
    int source; // ty_loop_source
    ty_loop_reaction reaction;
    ty_fill_recipe fill;
    const char* files; // STACK: a pattern; STILL: one; NULL = none
    int channel;       // ty_plane_channel
    int depth;         // STILL: slices
    ty_loop_raw raw;
    bool wraps;     // left meets right and top meets bottom, in what the source gives; a reaction always does
    float range[2]; // what becomes 0 and 1
    int colors;     // that are told apart in logo, stack or still, 0..TY_LOOP_COLORS; 0 = one, of the recipe
    int mix;        // ty_loop_mix
    int mirror;     // ty_loop_mirror
    float twist;    // rad about z, from the lowest to the highest slice
    ty_vec3 rotate; // rad about x, then y, then z
} ty_loop_part;

// Places and lengths in halves of the volume's width: a cube of voxels is -1..1. x right, y up, z from slice to slice.
typedef struct ty_loop_plane
{
    ty_vec3 center;
    ty_vec3 rotate; // rad about x, then y, then z; unrotated it spans x and y
    float size[2];  // all of a cube: 2, 2
} ty_loop_plane;

typedef struct ty_loop_axis
{
    ty_vec3 point, direction;
} ty_loop_axis;

typedef enum ty_loop_motion_kind
{
    TY_LOOP_TURN,  // the rectangle turns about the axis
    TY_LOOP_ORBIT, // it is carried round a circle without turning: tiles where the volume does
    TY_LOOP_REST,  // only keys move it
} ty_loop_motion_kind;

// What is added to plane and axis at a share of the loop; a closed smooth curve goes through all keys.
typedef struct ty_loop_key
{
    float at;       // share of the loop, 0 <= at < 1
    ty_vec3 move;   // of the rectangle's centre
    ty_vec3 rotate; // rad, of the rectangle about its centre
    float scale[2]; // of its size
    ty_vec3 axis_move, axis_rotate;
} ty_loop_key;

typedef struct ty_loop_motion
{
    int kind;           // ty_loop_motion_kind
    int turns;          // of the loop, -16..16
    float easing;       // 0..1: slower at 0 and 180 degrees, faster at 90 and 270
    float radius;       // of the orbit
    ty_param_list keys; // of ty_loop_key
} ty_loop_motion;

typedef enum ty_loop_sampling
{
    TY_LOOP_NEAREST,   // the voxel's own value, hard edges
    TY_LOOP_TRILINEAR, // between eight voxels; edges cover pixels by shares
} ty_loop_sampling;

typedef struct ty_loop_recipe
{
    ty_param_list volume; // of ty_loop_part: the largest value of all counts
    ty_loop_plane plane;
    ty_loop_axis axis;
    ty_loop_motion motion;
    int frames;       // of the loop
    float start;      // share of the path at which frame 1 is, 0..1, to the nearest frame
    bool quiet_start; // instead after the step that changes least
    int size[2];      // pixels
    int sampling;     // ty_loop_sampling
    bool show_values; // the values as they are between low and high, instead of what lies above iso
    float iso;        // of 0..1
    float blur;       // share of a frame that the shutter is open, 0..1
    int blur_samples; // moments in it
    float wavelength; // voxels, for the warning of steps; 0 = measured
    ty_rgb low, high; // ACEScg: outside and inside; both grey, and no colours: the channel Y alone
    bool clear;       // outside is transparent, as it is where a logo's background is: a channel A
} ty_loop_recipe;

ty_loop_recipe ty_loop_recipe_default(void); // a volume is missing
extern const ty_param_table ty_loop_recipe_table;
// def is a ty_loop_recipe; as ty_generator's make. *report (NULL = not wanted): a JSON object as text, the caller's.
TY_CHECKED ty_status ty_loop_make(const void* def, ty_workers* workers, const ty_frame_sink* sink, char** report,
                                  ty_error* error);
extern const ty_generator ty_loop_generator;
