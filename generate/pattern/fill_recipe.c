// SPDX-License-Identifier: Apache-2.0
// The parameter tables of a living pattern's recipe and their defaults.
#include <tsuya/generate/fill_recipe.h>

ty_fill_recipe ty_fill_recipe_default(void)
{
    return (ty_fill_recipe){
        .field = ty_gray_scott_def_default(),
        .cells = {256, 256},
        .scale = 2,
        .tile = TY_PATTERN_TILE_BOTH,
        .variation_size = 64.0f,
        .drops = {24, 10.0f, {0.0f, 1.0f}},
        .steps = 8000,
        .loop = {24, 2000, 3.0f},
        .tone = {0.12f, 0.28f},
        .high = {1.0f, 1.0f, 1.0f},
        .seed = {7},
    };
}

#define FIELD(name, type, unit, low, high, member, help)                                                               \
    {                                                                                                                  \
        name, type, unit, low, high, NULL, NULL, offsetof(OWNER, member), help, false                                  \
    }
#define GROUP(name, table, member, help)                                                                               \
    {                                                                                                                  \
        name, TY_PARAM_GROUP, "", 0, 0, NULL, table, offsetof(OWNER, member), help, false                              \
    }

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

// --- the recipe ---

static const char* const tiles[] = {"both", "around", NULL};

static void recipe_set_default(void* def)
{
    *(ty_fill_recipe*)def = ty_fill_recipe_default();
}

#define OWNER ty_fill_recipe
static const ty_param recipe_rows[] = {
    FIELD("cells", TY_PARAM_INT2, "", 8, 8192, cells, "width and height; a stripe is about 12 cells from the next"),
    FIELD("scale", TY_PARAM_INT, "", 1, 8, scale, "pixels of a frame per cell"),
    {"tile", TY_PARAM_ENUM, "", 0, 0, tiles, NULL, offsetof(OWNER, tile),
     "both ways, or around alone (top and bottom are edges that stripes meet at right angles)", false},
    FIELD("feed", TY_PARAM_FLOAT, "", 0, 0.2, field.rates[0].feed, "F; .067 with kill .062 is a labyrinth"),
    FIELD("kill", TY_PARAM_FLOAT, "", 0, 0.2, field.rates[0].kill, "k; feed .0265 with .0605 are spots that divide"),
    FIELD("variation", TY_PARAM_FLOAT, "", 0, 0.5, variation, "how much feed differs from place to place, relative"),
    FIELD("variation_size", TY_PARAM_FLOAT, "cells", 8, 8192, variation_size, "from one place to another"),
    FIELD("diffusion_u", TY_PARAM_FLOAT, "", 1e-3, 2, field.diffusion_u, "Du, cells^2 per unit of time"),
    FIELD("diffusion_v", TY_PARAM_FLOAT, "", 1e-3, 2, field.diffusion_v, "Dv; half of Du in all known tables"),
    FIELD("time_step", TY_PARAM_FLOAT, "", 1e-3, 10, field.time_step, "below 2 / (8 Du + .2)"),
    GROUP("drops", &drops_table, drops, "where it starts"),
    FIELD("steps", TY_PARAM_INT, "", 0, 1e7, steps, "of time until the middle of the loop"),
    GROUP("loop", &loop_table, loop, "what the frames show"),
    FIELD("tone", TY_PARAM_FLOAT2, "", 0, 1, tone, "the v that becomes low and the v that becomes high"),
    FIELD("low", TY_PARAM_RGB, "", 0, 100, low, "the ground"),
    FIELD("high", TY_PARAM_RGB, "", 0, 100, high, "the pattern; grey ones give frames of the channel Y"),
    FIELD("seed", TY_PARAM_SEED, "", 0, 0, seed, "another seed, other drops"),
};
#undef OWNER

static const ty_param_table recipe_table = {
    "fill",
    "A living pattern: Gray-Scott reaction-diffusion from drops, over a loop of frames.",
    sizeof(ty_fill_recipe),
    recipe_set_default,
    recipe_rows,
    TY_PARAM_COUNT(recipe_rows)};

const ty_param_table* ty_fill_recipe_params(void)
{
    return &recipe_table;
}

static int frame_count(const void* def)
{
    return ((const ty_fill_recipe*)def)->loop.frames;
}

static ty_status make(const void* def, ty_workers* workers, ty_made* out, ty_error* error)
{
    return ty_fill_make(def, workers, &out->frames, error);
}

const ty_generator ty_fill_generator = {
    .kind = "fill",
    .build_id = "fill 2",
    .product = TY_PRODUCT_FRAMES,
    .params = &recipe_table,
    .frame_count = frame_count,
    .make = make,
};
