// SPDX-License-Identifier: Apache-2.0
// The parameter tables of a living pattern's recipe and their defaults.
#include "fill_tables.h"
#include <stdio.h>

// --- drops ---

static void drops_set_default(void* def)
{
    *(ty_pattern_drops*)def = ty_fill_recipe_default().drops;
}

#define OWNER ty_pattern_drops
static const ty_param drops_rows[] = {
    FIELD("count", TY_PARAM_INT, "", 1, 100000, count, "how many"),
    FIELD("radius", TY_PARAM_FLOAT, "cells", 1, 100, radius, "of each; below 5 many rates do not catch"),
    FIELD("area", TY_PARAM_FLOAT2, "", 0, 1, area, "between which shares of the height they fall, from the bottom"),
};
#undef OWNER

static const ty_param_table drops_table = {
    "fill.drops", "Where the pattern starts from.", sizeof(ty_pattern_drops), drops_set_default,
    drops_rows,   TY_PARAM_COUNT(drops_rows)};

// --- loop ---

static void loop_set_default(void* def)
{
    *(ty_pattern_loop*)def = ty_fill_recipe_default().loop;
}

#define OWNER ty_pattern_loop
static const ty_param loop_rows[] = {
    FIELD("frames", TY_PARAM_INT, "", 1, 100000, frames, "of one turn: the one after the last is the first"),
    FIELD("span", TY_PARAM_INT, "steps", 0, 1e7, span, "how far the pattern goes on and back from the middle"),
    FIELD("drift", TY_PARAM_FLOAT, "cells", 0, 1e4, drift, "how far it moves sideways, a quarter of a turn later"),
};
#undef OWNER

static const ty_param_table loop_table = {
    "fill.loop",
    "A circle through all states: the frame at angle a shows step steps + span sin a, moved by drift cos a.",
    sizeof(ty_pattern_loop),
    loop_set_default,
    loop_rows,
    TY_PARAM_COUNT(loop_rows)};

// --- a map ---

static void map_set_default(void* def)
{
    *(ty_fill_map*)def = ty_fill_recipe_default().map;
}

#define OWNER ty_fill_map
static const ty_param map_rows[] = {
    FIELD("feed", TY_PARAM_FLOAT2, "", 0, 0.2, feed, "F at the bottom and at the top; [0, 0]: no map"),
    FIELD("kill", TY_PARAM_FLOAT2, "", 0, 0.2, kill, "k at the left and at the right"),
};
#undef OWNER

static const ty_param_table map_table = {"fill.map",
                                         "A field whose rates go from edge to edge: what pattern is where.",
                                         sizeof(ty_fill_map),
                                         map_set_default,
                                         map_rows,
                                         TY_PARAM_COUNT(map_rows)};

// --- the recipe ---

static const char* const tiles[] = {"both", "around", "none", NULL};
static const char* const starts[] = {"drops", "plain", "empty", NULL};

static void recipe_set_default(void* def)
{
    *(ty_fill_recipe*)def = ty_fill_recipe_default();
}

#define OWNER ty_fill_recipe
static const ty_param recipe_rows[] = {
    FIELD("cells", TY_PARAM_INT2, "", 8, 8192, cells, "width and height; a stripe is about 12 cells from the next"),
    FIELD("scale", TY_PARAM_INT, "", 1, 32, scale, "pixels of a frame per cell"),
    CHOICE("tile", tiles, tile,
           "both ways, or around alone (top and bottom are edges that stripes meet at right angles), or not at all"),
    CHOICE("convention", fill_convention_names, convention, "whose diffusions, time step and stencil"),
    FIELD("diffusion_u", TY_PARAM_FLOAT, "", 0, 2, diffusion_u, "Du, cells^2 per unit of time; 0: the convention's"),
    FIELD("diffusion_v", TY_PARAM_FLOAT, "", 0, 2, diffusion_v,
          "Dv; half of Du in all conventions; 0: the convention's"),
    FIELD("time_step", TY_PARAM_FLOAT, "", 0, 10, time_step, "below about 2 / (8 Du + .2); 0: the convention's"),
    FIELD("stencil", TY_PARAM_INT, "", 0, 9, stencil, "points of the Laplacian, 5 or 9; 0: the convention's"),
    CHOICE("preset", fill_preset_names, preset, "rates by name, where there is no table of marks"),
    FIELD("feed", TY_PARAM_FLOAT, "", 0, 0.2, feed, "F in place of the preset's"),
    FIELD("kill", TY_PARAM_FLOAT, "", 0, 0.2, kill, "k in place of the preset's"),
    GROUP("map", &map_table, map, "rates that go from edge to edge instead"),
    FIELD("variation", TY_PARAM_FLOAT, "", 0, 0.5, variation, "how much feed differs from place to place, relative"),
    FIELD("variation_size", TY_PARAM_FLOAT, "cells", 8, 8192, variation_size, "from one place to another"),
    LIST("marks", &fill_mark_table, marks, "rates and looks by mark, at most 16; all cells begin with the first"),
    CHOICE("start", starts, start, "u 1 and v 0 with drops in it, the plain state of the first mark, or u 1 and v 0"),
    GROUP("drops", &drops_table, drops, "where it starts"),
    GROUP("region", &fill_region_table, region, "where it may be"),
    FIELD("steps", TY_PARAM_INT, "", 0, 1e7, steps, "of time until the middle of the loop"),
    GROUP("loop", &loop_table, loop, "what the frames show"),
    GROUP("run", &fill_run_table, run, "frames in time instead of a loop"),
    LIST("events", &fill_event_table, events, "what is done in a run, and when"),
    LIST("auto", &fill_auto_table, autos, "marks that follow the pattern, later ones over earlier ones"),
    FIELD("level", TY_PARAM_FLOAT, "", 0, 1, level,
          "the v of a front; 0: half of the first mark's plain state, else .15"),
    FIELD("sharp", TY_PARAM_BOOL, "", 0, 0, sharp,
          "colours meet at the level, within a pixel, instead of over the tone"),
    FIELD("tone", TY_PARAM_FLOAT2, "", 0, 1, tone, "the v that becomes low and the v that becomes high"),
    FIELD("low", TY_PARAM_RGB, "", 0, 100, low, "the ground, where there is no table of marks"),
    FIELD("high", TY_PARAM_RGB, "", 0, 100, high, "the pattern; grey ones give frames of the channel Y"),
    FIELD("over", TY_PARAM_FRAMES, "", 0, 0, over,
          "what stands behind and around: an image of the frames' size, or one a frame"),
    FIELD("outside", TY_PARAM_RGB, "", 0, 100, outside, "colour of closed cells, where nothing stands behind"),
    FIELD("outputs", TY_PARAM_STRINGS, "", 0, 0, outputs, "more channels: u, v, mark, trail, distance, mattes"),
    FIELD("seed", TY_PARAM_SEED, "", 0, 0, seed, "another seed, other drops"),
};
#undef OWNER

const ty_param_table ty_fill_recipe_table = {
    "fill",
    "A living pattern: Gray-Scott reaction-diffusion on cells with marks, as a loop of frames or as a run with events.",
    sizeof(ty_fill_recipe),
    recipe_set_default,
    recipe_rows,
    TY_PARAM_COUNT(recipe_rows)};

void fill_matte_name(const char* mark, int number, char name[64])
{
    if (mark)
        snprintf(name, 64, "matte.%.56s", mark);
    else
        snprintf(name, 64, "matte.%d", number);
}

bool fill_has_closed_cells(const ty_fill_recipe* recipe)
{
    const ty_fill_event* events = recipe->events.items;
    bool any = recipe->region.mask != NULL;
    for (int i = 0; i < recipe->events.count; i++)
        any = any || events[i].op == TY_FILL_BARRIER;
    return any;
}
