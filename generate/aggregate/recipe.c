// SPDX-License-Identifier: Apache-2.0
// The parameter tables of an aggregate's recipe and their defaults.
#include "recipe_tables.h"

// --- fill and layers ---

static const char* const fill_starts[] = {"inflate", "thesis", "lattice", "pour", NULL};
static const char* const fill_targets[] = {"count", "level", "density", NULL};

static void thesis_set_default(void* def)
{
    *(ty_thesis_def*)def = ty_aggregate_recipe_default().fill.thesis;
}

#define OWNER ty_thesis_def
static const ty_param thesis_rows[] = {
    FIELD("refine", TY_PARAM_FLOAT, "", 0, 4, refine, "farthest move inwards, of the distance between points"),
    FIELD("offset", TY_PARAM_FLOAT, "mm", 0, 100, offset, "overlap that does not count"),
    FIELD("remove", TY_PARAM_FLOAT, "", 0, 100, remove,
          "cost above which an element goes, of the farthest move: 1 = all that overlap, more = some overlap stays"),
};
#undef OWNER

static const ty_param_table thesis_table = {"aggregate.fill.thesis",
                                            "The filling of Gan 2023, with start thesis.",
                                            sizeof(ty_thesis_def),
                                            thesis_set_default,
                                            thesis_rows,
                                            TY_PARAM_COUNT(thesis_rows)};

static void pour_set_default(void* def)
{
    *(ty_pour_def*)def = ty_aggregate_recipe_default().fill.pour;
}

#define OWNER ty_pour_def
static const ty_param pour_rows[] = {
    FIELD("from", TY_PARAM_FLOAT3, "m", -1e4, 1e4, from,
          "middle of the mouth; [0, 0, 0]: 0.06 over the middle of the rim, or of the heap"),
    FIELD("radius", TY_PARAM_FLOAT, "mm", 0, 1e6, radius, "of the mouth"),
    FIELD("rate", TY_PARAM_FLOAT, "1/s", 0.1, 1e6, rate, "elements a second, as far as the mouth lets them through"),
    FIELD("seconds", TY_PARAM_FLOAT, "s", 0, 600, seconds, "for all of them, in place of a rate; 0 = by the rate"),
    FIELD("speed", TY_PARAM_FLOAT, "m/s", 0, 20, speed, "downwards at the mouth"),
};
#undef OWNER

static const ty_param_table pour_table = {
    "aggregate.fill.pour",
    "Elements fall out of a round mouth, one after the other, into an open container.",
    sizeof(ty_pour_def),
    pour_set_default,
    pour_rows,
    TY_PARAM_COUNT(pour_rows)};

static void fill_set_default(void* def)
{
    *(ty_fill_def*)def = ty_aggregate_recipe_default().fill;
}

#define OWNER ty_fill_def
static const ty_param fill_rows[] = {
    {"start", TY_PARAM_ENUM, "", 0, 0, fill_starts, NULL, offsetof(OWNER, start),
     "how the elements are placed: grown in place; moved and taken out by the cost of Gan 2023; in a lattice; poured",
     false},
    {"target", TY_PARAM_ENUM, "", 0, 0, fill_targets, NULL, offsetof(OWNER, target),
     "what is asked for: a count; or a level or a density, which give the count", false},
    FIELD("count", TY_PARAM_INT, "", 1, TY_FILL_MOST, count, "grains in the result, with target count"),
    FIELD("density", TY_PARAM_FLOAT, "", 0.1, 0.95, density, "volume share of the grains before they settle"),
    FIELD("level", TY_PARAM_FLOAT, "mm", 0, 1e6, level,
          "with target level: height over the lowest point inside; 0 = the rim, or the whole volume"),
    FIELD("heap", TY_PARAM_FLOAT, "mm", 0, 1000, heap, "height of the crown; rises further when the vessel is full"),
    FIELD("tilt", TY_PARAM_FLOAT, "deg", 0, 90, tilt, "largest angle of a grain with the horizontal, as filled"),
    FIELD("roll", TY_PARAM_FLOAT, "deg", 0, 180, roll, "largest turn about its own length, as filled"),
    FIELD("sprinkle", TY_PARAM_FLOAT, "", 0, 0.5, sprinkle,
          "share of the grains that fall onto an open pile from above"),
    FIELD("sweeps", TY_PARAM_INT, "", 50, 5000, sweeps, "of the inflation"),
    {"thesis", TY_PARAM_GROUP, "", 0, 0, NULL, &thesis_table, offsetof(OWNER, thesis), "with start thesis", false},
    {"pour", TY_PARAM_GROUP, "", 0, 0, NULL, &pour_table, offsetof(OWNER, pour), "with start pour", false},
};
#undef OWNER

static const ty_param_table fill_table = {"aggregate.fill",    "How many grains, how dense, how high.",
                                          sizeof(ty_fill_def), fill_set_default,
                                          fill_rows,           TY_PARAM_COUNT(fill_rows)};

static void layer_fill_set_default(void* def)
{
    ty_fill_def fill = ty_aggregate_recipe_default().fill;
    fill.count = 100;
    *(ty_fill_def*)def = fill;
}

#define OWNER ty_fill_def
static const ty_param layer_fill_rows[] = {
    {"target", TY_PARAM_ENUM, "", 0, 0, fill_targets, NULL, offsetof(OWNER, target),
     "what is asked for: a count; or a level or a density, which give the count", false},
    FIELD("count", TY_PARAM_INT, "", 1, TY_FILL_MOST, count, "elements of this layer, with target count"),
    FIELD("density", TY_PARAM_FLOAT, "", 0.1, 0.95, density, "volume share of the elements once they lie"),
    FIELD("level", TY_PARAM_FLOAT, "mm", 0, 1e6, level,
          "with target level: up to where, over the lowest point inside; 0 = the rim"),
    FIELD("heap", TY_PARAM_FLOAT, "mm", 0, 1000, heap, "height of the crown of all that lies by then"),
    FIELD("tilt", TY_PARAM_FLOAT, "deg", 0, 90, tilt, "largest angle with the horizontal as they fall, at most 14.3"),
    FIELD("roll", TY_PARAM_FLOAT, "deg", 0, 180, roll, "largest turn about its own length as they fall"),
};
#undef OWNER

static const ty_param_table layer_fill_table = {"aggregate.layers.fill", "How many come, or how high they lie.",
                                                sizeof(ty_fill_def),     layer_fill_set_default,
                                                layer_fill_rows,         TY_PARAM_COUNT(layer_fill_rows)};

static void layer_set_default(void* def)
{
    ty_layer_def layer = {.element = ty_element_def_default()};
    layer_fill_set_default(&layer.fill);
    *(ty_layer_def*)def = layer;
}

#define OWNER ty_layer_def
static const ty_param layer_rows[] = {
    {"element", TY_PARAM_GROUP, "", 0, 0, NULL, &recipe_element, offsetof(OWNER, element), "what comes", false},
    {"elements", TY_PARAM_LIST, "", 0, 0, NULL, &recipe_element, offsetof(OWNER, elements),
     "kinds that are mixed by ratio, in place of element", false},
    {"fill", TY_PARAM_GROUP, "", 0, 0, NULL, &layer_fill_table, offsetof(OWNER, fill), "how many, how high", false},
};
#undef OWNER

static const ty_param_table layer_table = {
    "aggregate.layers",
    "What comes onto the fill when that is at rest: the elements fall from above, and all settle again. A mesh without "
    "slots has one of its kind's name, so that each kind can have its own material.",
    sizeof(ty_layer_def),
    layer_set_default,
    layer_rows,
    TY_PARAM_COUNT(layer_rows)};

const ty_param_table* ty_layer_params(void)
{
    return &layer_table;
}

// --- the whole ---

static void recipe_set_default(void* def)
{
    *(ty_aggregate_recipe*)def = ty_aggregate_recipe_default();
}

#define OWNER ty_aggregate_recipe
static const ty_param recipe_rows[] = {
    GROUP("element", &recipe_element, element, "what is packed"),
    {"elements", TY_PARAM_LIST, "", 0, 0, NULL, &recipe_element, offsetof(OWNER, elements),
     "kinds that are mixed by ratio, at most 16, in place of element; a mesh without slots has one of its kind's name",
     false},
    GROUP("container", &recipe_container, container, "what the grains lie in"),
    GROUP("fill", &fill_table, fill, "how many, how dense, how high"),
    {"layers", TY_PARAM_LIST, "", 0, 0, NULL, &layer_table, offsetof(OWNER, layers),
     "what comes onto that in an open container, one after the other; with element, at most 16 kinds in all", false},
    GROUP("settle", &recipe_settle, settle, "how they come to rest"),
    GROUP("press", &recipe_press, press, "a mould that closes on them"),
    GROUP("moisture", &recipe_moisture, moisture, "the attribute moisture"),
    GROUP("animate", &recipe_animate, animate, "a film of it"),
    FIELD("seed", TY_PARAM_SEED, "", 0, 0, seed, "one seed, one result"),
};
#undef OWNER

const ty_param_table ty_aggregate_recipe_table = {"aggregate",
                                                  "Grains that lie in a vessel, at rest.",
                                                  sizeof(ty_aggregate_recipe),
                                                  recipe_set_default,
                                                  recipe_rows,
                                                  TY_PARAM_COUNT(recipe_rows)};
