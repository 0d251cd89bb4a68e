// SPDX-License-Identifier: Apache-2.0
// Parameter tables of marks, region, events, marks that follow the pattern, and the run.
#include "fill_tables.h"
#include "plane_file.h"

const char* const fill_preset_names[] = {"stripes",  "plain",    "slow",   "dying", "spots",  "mitosis",
                                         "worms",    "coral",    "maze",   "holes", "pulses", "chaos",
                                         "restless", "solitons", "moving", "waves", NULL};
const char* const fill_convention_names[] = {"pearson", "munafo", "sims", "processing", NULL};
static const char* const op_names[] = {"mark", "unmark", "hole", "fill", "seed", "barrier", "unbarrier", NULL};

// --- marks ---

static void seeding_set_default(void* def)
{
    *(ty_fill_seeding*)def = (ty_fill_seeding){.radius = 5.0f, .seed = {1}};
}

#define OWNER ty_fill_seeding
static const ty_param seeding_rows[] = {
    FIELD("spacing", TY_PARAM_FLOAT, "cells", 0, 1000, spacing, "from one spot that is dropped to the next; 0: none"),
    FIELD("radius", TY_PARAM_FLOAT, "cells", 1, 100, radius, "of a spot"),
    FIELD("jitter", TY_PARAM_FLOAT, "", 0, 0.5, jitter, "how much feed differs from cell to cell, relative"),
    FIELD("rough", TY_PARAM_FLOAT, "cells", 0, 100, rough, "how far the outlines of its holes and marks go in and out"),
    FIELD("seed", TY_PARAM_SEED, "", 0, 0, seed, "equal seeds, equal places"),
};
#undef OWNER

static const ty_param_table seeding_table = {
    "fill.mark.seed",
    "What starts a pattern where a mark is set: at a smooth outline most do not begin by themselves.",
    sizeof(ty_fill_seeding),
    seeding_set_default,
    seeding_rows,
    TY_PARAM_COUNT(seeding_rows)};

static void mark_set_default(void* def)
{
    ty_fill_mark mark = {.preset = 1, .color = {0.8f, 0.8f, 0.8f}, .opacity = 1.0f, .ground_opacity = 1.0f};
    seeding_set_default(&mark.seed);
    *(ty_fill_mark*)def = mark;
}

#define OWNER ty_fill_mark
static const ty_param mark_rows[] = {
    FIELD("name", TY_PARAM_STRING, "", 0, 0, name, "by which events call it; else by its number, from 0"),
    CHOICE("preset", fill_preset_names, preset, "its rates by name"),
    FIELD("feed", TY_PARAM_FLOAT, "", 0, 0.2, feed, "F; 0: the preset's"),
    FIELD("kill", TY_PARAM_FLOAT, "", 0, 0.2, kill, "k; 0: the preset's"),
    FIELD("color", TY_PARAM_RGB, "", 0, 1000, color, "where v is high"),
    FIELD("ground", TY_PARAM_RGB, "", 0, 1000, ground, "where v is low"),
    FIELD("image", TY_PARAM_FRAMES, "", 0, 0, image, "in place of color: of the frames' size"),
    FIELD("beneath", TY_PARAM_FRAMES, "", 0, 0, beneath, "in place of ground: what is seen through a hole"),
    FIELD("opacity", TY_PARAM_FLOAT, "", 0, 1, opacity, "of color or image, over what stands behind"),
    FIELD("ground_opacity", TY_PARAM_FLOAT, "", 0, 1, ground_opacity, "of ground or beneath"),
    GROUP("seed", &seeding_table, seed, "what starts the pattern where this mark is set"),
};
#undef OWNER

const ty_param_table fill_mark_table = {"fill.mark",
                                        "A row of the table of marks: rates and looks of the cells that have it.",
                                        sizeof(ty_fill_mark),
                                        mark_set_default,
                                        mark_rows,
                                        TY_PARAM_COUNT(mark_rows)};

// --- region ---

static const char* const opened_names[] = {"nearest", "plain", "empty", NULL};

static void region_set_default(void* def)
{
    *(ty_fill_region*)def = ty_fill_recipe_default().region;
}

#define OWNER ty_fill_region
static const ty_param region_rows[] = {
    FIELD("mask", TY_PARAM_FRAMES, "", 0, 0, mask,
          "an image of as many pixels as cells, or as a frame; still or by frame"),
    CHOICE("channel", ty_plane_channel_names, channel, "of the mask"),
    FIELD("threshold", TY_PARAM_FLOAT, "", 0, 0, threshold, "inside is what is at least that bright"),
    FIELD("invert", TY_PARAM_BOOL, "", 0, 0, invert, "inside is what is darker"),
    CHOICE("opened", opened_names, opened,
           "what cells hold that open: as the nearest open one, the plain state, u 1 and v 0"),
    FIELD("keep_closed", TY_PARAM_BOOL, "", 0, 0, keep_closed,
          "closed cells keep what they hold, and go on with it when they open"),
};
#undef OWNER

const ty_param_table fill_region_table = {"fill.region",
                                          "Where the pattern may be. Nothing passes the outline.",
                                          sizeof(ty_fill_region),
                                          region_set_default,
                                          region_rows,
                                          TY_PARAM_COUNT(region_rows)};

// --- events ---

static const char* const shape_names[] = {"circle", "rectangle", "polygon", "brush", "image", "all", NULL};

static void event_set_default(void* def)
{
    *(ty_fill_event*)def = (ty_fill_event){
        .at = 1, .size = {16.0f, 16.0f}, .to = {-1.0f, -1.0f}, .radius = 8.0f, .radius_to = -1.0f, .threshold = 0.5f};
}

#define OWNER ty_fill_event
static const ty_param event_rows[] = {
    FIELD("at", TY_PARAM_INT, "", 1, 1e6, at, "the frame that shows it first"),
    FIELD("until", TY_PARAM_INT, "", 0, 1e6, until, "done again at each frame up to this; 0: at one alone"),
    {"op", TY_PARAM_ENUM, "", 0, 0, op_names, NULL, offsetof(OWNER, op),
     "mark, unmark (mark 0), hole (u 1, v 0), fill (the plain state), seed (spots), barrier, unbarrier", true},
    FIELD("mark", TY_PARAM_STRING, "", 0, 0, mark,
          "name or number: what mark sets, and hole, fill, seed if it is given"),
    CHOICE("shape", shape_names, shape, "where"),
    FIELD("center", TY_PARAM_FLOAT2, "cells", -32768, 32768, center, "of circle and rectangle, from the upper left"),
    FIELD("to", TY_PARAM_FLOAT2, "cells", -32768, 32768, to, "where the centre is at `until`; [-1, -1]: it stays"),
    FIELD("size", TY_PARAM_FLOAT2, "cells", 0, 65536, size, "of a rectangle"),
    FIELD("angle", TY_PARAM_FLOAT, "deg", -360, 360, angle, "of a rectangle, clockwise"),
    FIELD("radius", TY_PARAM_FLOAT, "cells", 0, 32768, radius, "of a circle; of a brush"),
    FIELD("radius_to", TY_PARAM_FLOAT, "cells", -1, 32768, radius_to, "at `until`; -1: as it is"),
    FIELD("points", TY_PARAM_POINTS2, "cells", -32768, 65536, points,
          "of a polygon; of a brush, which gets to the last of them at `until`"),
    FIELD("image", TY_PARAM_FRAMES, "", 0, 0, image, "with shape image: as a region's mask"),
    CHOICE("channel", ty_plane_channel_names, channel, "of the image"),
    FIELD("threshold", TY_PARAM_FLOAT, "", 0, 0, threshold, "inside is what is at least that bright"),
    FIELD("invert", TY_PARAM_BOOL, "", 0, 0, invert, "all but the shape"),
    FIELD("feather", TY_PARAM_FLOAT, "cells", 0, 1000, feather,
          "width of the edge: u and v go over, marks and barriers thin out by chance"),
    FIELD("close", TY_PARAM_INT, "", 0, 1e6, close,
          "of one hole: frames within which it closes; tells the steps of all frames"),
};
#undef OWNER

const ty_param_table fill_event_table = {"fill.event",
                                         "What is done to the field before a frame is shown.",
                                         sizeof(ty_fill_event),
                                         event_set_default,
                                         event_rows,
                                         TY_PARAM_COUNT(event_rows)};

// --- marks that follow ---

static const char* const where_names[] = {"hole", "filled", "band", "trail", NULL};

static void auto_set_default(void* def)
{
    *(ty_fill_auto*)def = (ty_fill_auto){.where = TY_FILL_WHERE_BAND, .reach = {0.0f, 6.0f}, .threshold = 0.1f};
}

#define OWNER ty_fill_auto
static const ty_param auto_rows[] = {
    {"mark", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(OWNER, mark), "name or number of the mark that is shown",
     true},
    CHOICE("where", where_names, where, "v below the level, above it, near the front, where v has ever been"),
    FIELD("reach", TY_PARAM_FLOAT2, "cells", -1000, 1000, reach, "of a band: from and to, positive in the hole"),
    FIELD("threshold", TY_PARAM_FLOAT, "", 1e-3, 1, threshold, "of v, for the trail"),
    FIELD("over", TY_PARAM_STRING, "", 0, 0, over, "only where this mark is set"),
    FIELD("rates", TY_PARAM_BOOL, "", 0, 0, rates, "the cells become marked: feed and kill change too, frame by frame"),
};
#undef OWNER

const ty_param_table fill_auto_table = {
    "fill.auto", "A mark that follows the pattern.", sizeof(ty_fill_auto), auto_set_default,
    auto_rows,   TY_PARAM_COUNT(auto_rows)};

// --- the run ---

static void run_set_default(void* def)
{
    *(ty_fill_run*)def = ty_fill_recipe_default().run;
}

#define OWNER ty_fill_run
static const ty_param run_rows[] = {
    FIELD("frames", TY_PARAM_INT, "", 0, 1e6, frames, "how many; 0: `loop` instead"),
    FIELD("steps", TY_PARAM_FLOAT, "", 0, 1e6, steps, "from frame to frame; parts of a step add up"),
    FIELD("before", TY_PARAM_INT, "steps", 0, 1e7, before, "of time before the first frame"),
    FIELD("first", TY_PARAM_INT, "", -1e6, 1e6, first, "number of the first frame in sequences of masks and images"),
};
#undef OWNER

const ty_param_table fill_run_table = {"fill.run",
                                       "Frames in time, with events. Frame 1 shows the beginning, after its events.",
                                       sizeof(ty_fill_run),
                                       run_set_default,
                                       run_rows,
                                       TY_PARAM_COUNT(run_rows)};

ty_fill_recipe ty_fill_recipe_default(void)
{
    return (ty_fill_recipe){
        .cells = {256, 256},
        .scale = 2,
        .tile = TY_PATTERN_TILE_BOTH,
        .variation_size = 64.0f,
        .drops = {24, 10.0f, {0.0f, 1.0f}},
        .region = {.threshold = 0.5f},
        .steps = 8000,
        .loop = {24, 2000, 3.0f},
        .run = {.steps = 60.0f, .first = 1},
        .tone = {0.12f, 0.28f},
        .high = {1.0f, 1.0f, 1.0f},
        .seed = {7},
    };
}
