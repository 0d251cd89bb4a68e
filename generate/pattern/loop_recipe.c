// SPDX-License-Identifier: Apache-2.0
// The parameter tables of a looping texture's recipe and their defaults.
#include "plane_file.h"
#include <tsuya/base/param_rows.h>
#include <tsuya/generate/loop_recipe.h>

ty_loop_recipe ty_loop_recipe_default(void)
{
    return (ty_loop_recipe){
        .plane = {.size = {2.0f, 2.0f}},
        .axis = {.direction = {0.0f, 1.0f, 0.0f}},
        .motion = {.turns = 1, .radius = 0.25f},
        .frames = 180,
        .size = {512, 512},
        .sampling = TY_LOOP_TRILINEAR,
        .iso = 0.5f,
        .blur_samples = 8,
        .high = {1.0f, 1.0f, 1.0f},
    };
}

static ty_loop_part part_default(void)
{
    return (ty_loop_part){
        .reaction = {.cells = {0, 0},
                     .depth = 129,
                     .start = 2000,
                     .every = 40,
                     .feed = 0.0265f,
                     .kill = 0.0605f,
                     .diffusion_u = 0.2097152f,
                     .diffusion_v = 0.1048576f,
                     .time_step = 1.0f,
                     .drops = {60, 5.5f, {0.0f, 1.0f}},
                     .seed = {7}},
        .fill = ty_fill_recipe_default(),
        .depth = 129,
        .raw = {.type = TY_LOOP_U8},
    };
}

// --- reaction ---

static void set_drops_table(void* def)
{
    *(ty_pattern_drops*)def = part_default().reaction.drops;
}

#define OWNER ty_pattern_drops
static const ty_param drops_rows[] = {
    FIELD("count", TY_PARAM_INT, "", 1, 100000, count, "how many"),
    FIELD("radius", TY_PARAM_FLOAT, "cells", 1, 100, radius, "of each; below 5 many rates do not catch"),
    FIELD("area", TY_PARAM_FLOAT2, "", 0, 1, area, "between which shares of the height they fall, from the bottom"),
};
TABLE(drops_table, "loop.reaction.drops", "Where a pattern without a logo starts from.", drops_rows);
#undef OWNER

static void set_reaction_table(void* def)
{
    *(ty_loop_reaction*)def = part_default().reaction;
}

#define OWNER ty_loop_reaction
static const ty_param reaction_rows[] = {
    FIELD("logo", TY_PARAM_PATH, "", 0, 0, logo,
          "an image: the slice in the middle is this, and it spreads both ways from there. What is transparent, or of "
          "the colour along its rim, is the background"),
    FIELD("gaps", TY_PARAM_FLOAT, "", 0, 0.95, gaps,
          "share of the logo that the reaction does not start from, in squares of 5 cells: else wide areas die out and "
          "leave their outline"),
    FIELD("cells", TY_PARAM_INT2, "", 0, 2048, cells, "width and height; 0 = as the logo, without one 256"),
    FIELD("depth", TY_PARAM_INT, "slices", 1, 2048, depth, "odd with a logo, so that it lies in the middle exactly"),
    FIELD("start", TY_PARAM_INT, "steps", 0, 1e7, start, "before the first slice, without a logo"),
    FIELD("every", TY_PARAM_INT, "steps", 1, 1e6, every, "from a slice to the next"),
    FIELD("feed", TY_PARAM_FLOAT, "", 0, 0.2, feed, "F; .025 with kill .0525 keeps changing"),
    FIELD("kill", TY_PARAM_FLOAT, "", 0, 0.2, kill, "k; feed .0265 with .0605 are spots that divide"),
    FIELD("diffusion_u", TY_PARAM_FLOAT, "", 1e-3, 2, diffusion_u, "Du, cells^2 per unit of time"),
    FIELD("diffusion_v", TY_PARAM_FLOAT, "", 1e-3, 2, diffusion_v, "Dv; half of Du in all known tables"),
    FIELD("time_step", TY_PARAM_FLOAT, "", 1e-3, 10, time_step, "below 2 / (8 Du + .2)"),
    GROUP("drops", &drops_table, drops, "where it starts without a logo"),
    FIELD("seed", TY_PARAM_SEED, "", 0, 0, seed, "where drops fall and gaps are"),
};
TABLE(reaction_table, "loop.reaction", "Slices of one Gray-Scott pattern in time, which wraps both ways.",
      reaction_rows);
#undef OWNER

// --- raw ---

static const char* const numbers[] = {"u8", "u16", "f32", NULL};

static void set_raw_table(void* def)
{
    *(ty_loop_raw*)def = part_default().raw;
}

#define OWNER ty_loop_raw
static const ty_param raw_rows[] = {
    FIELD("file", TY_PARAM_PATH, "", 0, 0, file, "numbers, x fastest, then y from the top, then z"),
    FIELD("width", TY_PARAM_INT, "", 0, 2048, width, "voxels along x"),
    FIELD("height", TY_PARAM_INT, "", 0, 2048, height, "along y"),
    FIELD("depth", TY_PARAM_INT, "", 0, 2048, depth, "along z"),
    CHOICE("type", numbers, type, "of a number; whole ones are shares of their largest"),
    FIELD("header", TY_PARAM_INT, "bytes", 0, 1e6, header, "before the first number"),
    FIELD("big_endian", TY_PARAM_BOOL, "", 0, 0, big_endian, "the high byte comes first"),
};
TABLE(raw_table, "loop.raw", "A volume of the user's own as it lies in a file.", raw_rows);
#undef OWNER

// --- part ---

static const char* const sources[] = {"reaction", "fill", "stack", "still", "raw", NULL};
static const char* const mirrors[] = {"none", "x", "y", "z", NULL};
static const char* const mixes[] = {"largest", "blend", NULL};

static void set_part_table(void* def)
{
    *(ty_loop_part*)def = part_default();
}

#define OWNER ty_loop_part
static const ty_param part_rows[] = {
    CHOICE("source", sources, source,
           "a reaction in time, the frames of a fill, a stack of pictures, one picture in every slice, a raw file"),
    GROUP("reaction", &reaction_table, reaction, "of source reaction"),
    GROUP("fill", &ty_fill_recipe_table, fill, "of source fill: its frames, of colours the luminance"),
    FIELD("files", TY_PARAM_FRAMES, "", 0, 0, files, "of stack (with #### for the number) and still"),
    CHOICE("channel", ty_plane_channel_names, channel, "of the pictures, where they have no colors"),
    FIELD("depth", TY_PARAM_INT, "slices", 1, 2048, depth, "of source still"),
    GROUP("raw", &raw_table, raw, "of source raw"),
    FIELD("wraps", TY_PARAM_BOOL, "", 0, 0, wraps, "left meets right, top meets bottom; a reaction always does"),
    FIELD("range", TY_PARAM_FLOAT2, "", -1e30, 1e30, range,
          "which numbers become 0 and 1; 0, 0: of a reaction 0 and .4, of others 0 and 1"),
    FIELD("colors", TY_PARAM_INT, "", 0, TY_LOOP_COLORS, colors,
          "that a logo, stack or still keeps, its background apart; 0 = it is high and low of the recipe"),
    CHOICE("mix", mixes, mix, "where colours meet: the one of which there is most, or their mean"),
    CHOICE("mirror", mirrors, mirror, "the half of positive x, y or z on both sides"),
    FIELD("twist", TY_PARAM_FLOAT, "deg", -36000, 36000, twist, "about z, from the first slice to the last; 0 amid"),
    FIELD("rotate", TY_PARAM_FLOAT3, "deg", -360, 360, rotate, "about x, then y, then z, after the twist"),
};
TABLE(part_table, "loop.volume",
      "One volume, x right, y up, z from slice to slice. Its numbers become 0..1, then it is mirrored, twisted and "
      "turned "
      "about its centre.",
      part_rows);
#undef OWNER

// --- plane and axis ---

static void set_plane_table(void* def)
{
    *(ty_loop_plane*)def = ty_loop_recipe_default().plane;
}

#define OWNER ty_loop_plane
static const ty_param plane_rows[] = {
    FIELD("center", TY_PARAM_FLOAT3, "", -100, 100, center, "of the rectangle, in halves of the volume's width"),
    FIELD("rotate", TY_PARAM_FLOAT3, "deg", -360, 360, rotate, "about x, then y, then z; without, it spans x and y"),
    FIELD("size", TY_PARAM_FLOAT2, "", 1e-4, 100, size, "width and height, the same; all of a cube: 2"),
};
TABLE(plane_table, "loop.plane", "The rectangle that cuts the volume, as it lies at the first frame.", plane_rows);
#undef OWNER

static void set_axis_table(void* def)
{
    *(ty_loop_axis*)def = ty_loop_recipe_default().axis;
}

#define OWNER ty_loop_axis
static const ty_param axis_rows[] = {
    FIELD("point", TY_PARAM_FLOAT3, "", -100, 100, point, "on it, in halves of the volume's width"),
    FIELD("direction", TY_PARAM_FLOAT3, "", -1e6, 1e6, direction, "of any length but zero"),
};
TABLE(axis_table, "loop.axis",
      "What the rectangle turns about. Where it meets the rectangle, nothing changes: a plane beside it changes more.",
      axis_rows);
#undef OWNER

// --- motion ---

static void set_key_table(void* def)
{
    *(ty_loop_key*)def = (ty_loop_key){.scale = {1.0f, 1.0f}};
}

#define OWNER ty_loop_key
static const ty_param key_rows[] = {
    {"at", TY_PARAM_FLOAT, "", 0, 0.999999, NULL, NULL, offsetof(ty_loop_key, at), "share of the loop, rising", true},
    FIELD("move", TY_PARAM_FLOAT3, "", -100, 100, move, "of the rectangle, added to its centre"),
    FIELD("rotate", TY_PARAM_FLOAT3, "deg", -360, 360, rotate, "of the rectangle about its centre"),
    FIELD("scale", TY_PARAM_FLOAT2, "", 1e-3, 1e3, scale, "of its size"),
    FIELD("axis_move", TY_PARAM_FLOAT3, "", -100, 100, axis_move, "added to the axis' point"),
    FIELD("axis_rotate", TY_PARAM_FLOAT3, "deg", -360, 360, axis_rotate, "of the axis' direction"),
};
TABLE(key_table, "loop.motion.key",
      "Where plane and axis are at a share of the loop, beside where the recipe puts them.", key_rows);
#undef OWNER

static const char* const motions[] = {"turn", "orbit", "rest", NULL};

static void set_motion_table(void* def)
{
    *(ty_loop_motion*)def = ty_loop_recipe_default().motion;
}

#define OWNER ty_loop_motion
static const ty_param motion_rows[] = {
    CHOICE("kind", motions, kind,
           "the rectangle turns about the axis; or is carried round a circle across itself, so that frames tile; or "
           "rests but for its keys"),
    FIELD("turns", TY_PARAM_INT, "", -16, 16, turns, "in a loop; below 0 the other way round"),
    FIELD("easing", TY_PARAM_FLOAT, "", 0, 1, easing, "slower at 0 and 180 degrees, faster at 90 and 270"),
    FIELD("radius", TY_PARAM_FLOAT, "", 0, 100, radius, "of the orbit, in halves of the volume's width"),
    {"keys", TY_PARAM_LIST, "", 0, 0, NULL, &key_table, offsetof(ty_loop_motion, keys),
     "of a closed smooth path of plane and axis", false},
};
TABLE(motion_table, "loop.motion", "How plane and axis move in a loop.", motion_rows);
#undef OWNER

// --- the recipe ---

static const char* const samplings[] = {"nearest", "trilinear", NULL};

static void set_recipe(void* def)
{
    *(ty_loop_recipe*)def = ty_loop_recipe_default();
}

#define OWNER ty_loop_recipe
static const ty_param recipe_rows[] = {
    {"volume", TY_PARAM_LIST, "", 0, 0, NULL, &part_table, offsetof(ty_loop_recipe, volume),
     "one part, or several of which the largest value counts; the first gives the size", true},
    GROUP("plane", &plane_table, plane, "the rectangle"),
    GROUP("axis", &axis_table, axis, "what it turns about"),
    GROUP("motion", &motion_table, motion, "how it moves"),
    FIELD("frames", TY_PARAM_INT, "", 1, 100000, frames, "of the loop: the one after the last is the first"),
    FIELD("start", TY_PARAM_FLOAT, "", 0, 1, start, "share of the path at which frame 1 is, to the nearest frame"),
    FIELD("quiet_start", TY_PARAM_BOOL, "", 0, 0, quiet_start,
          "instead the loop begins after the step that changes least, which becomes its seam"),
    FIELD("size", TY_PARAM_INT2, "px", 1, 16384, size, "of a frame"),
    CHOICE("sampling", samplings, sampling, "of voxels: hard edges, or edges that cover pixels by shares"),
    FIELD("show_values", TY_PARAM_BOOL, "", 0, 0, show_values, "values from low to high, instead of what is above iso"),
    FIELD("iso", TY_PARAM_FLOAT, "", 1e-3, 0.999, iso, "where the inside begins, of 0..1"),
    FIELD("blur", TY_PARAM_FLOAT, "", 0, 1, blur, "share of a frame's time that is averaged"),
    FIELD("blur_samples", TY_PARAM_INT, "", 2, 64, blur_samples, "moments of that time"),
    FIELD("wavelength", TY_PARAM_FLOAT, "voxels", 0, 4096, wavelength,
          "of the pattern, for the warning of long steps; 0 = measured"),
    FIELD("low", TY_PARAM_RGB, "", 0, 100, low, "outside; a volume with colours has its own"),
    FIELD("high", TY_PARAM_RGB, "", 0, 100, high, "inside; grey ones give frames of the channel Y"),
    FIELD("clear", TY_PARAM_BOOL, "", 0, 0, clear,
          "what is outside is transparent; with colors it also is where a logo's background is"),
};
const ty_param_table ty_loop_recipe_table = {
    "loop",        "A looping texture: a rectangle moves through a volume on a closed path.",
    sizeof(OWNER), set_recipe,
    recipe_rows,   TY_PARAM_COUNT(recipe_rows)};
#undef OWNER

static int frame_count(const void* def)
{
    return ((const ty_loop_recipe*)def)->frames;
}

static ty_status make(const void* def, ty_workers* workers, ty_made* out, ty_error* error)
{
    return ty_loop_make(def, workers, &out->frames, &out->report, error);
}

const ty_generator ty_loop_generator = {
    .kind = "loop",
    .build_id = "loop 2",
    .product = TY_PRODUCT_FRAMES,
    .params = &ty_loop_recipe_table,
    .frame_count = frame_count,
    .make = make,
};
