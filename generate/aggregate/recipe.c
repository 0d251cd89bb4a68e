// SPDX-License-Identifier: Apache-2.0
// The parameter tables of an aggregate's recipe and their defaults.
#include "mixture.h"

ty_aggregate_recipe ty_aggregate_recipe_default(void)
{
    ty_pile_def pile = ty_pile_def_default();
    return (ty_aggregate_recipe){
        .element = ty_element_def_default(),
        .container = ty_container_def_default(),
        .fill = {.count = 2000,
                 .density = 0.60f,
                 .heap = 12e-3f,
                 .tilt = TY_PI / 3.0f,
                 .roll = TY_PI,
                 .sprinkle = 0.06f,
                 .sweeps = 400,
                 .thesis = {.refine = 1.0f, .offset = 0.0f, .remove = 1.0f}},
        .settle = {pile.friction, pile.rolling, 3.0f, pile.rate, 200, 0.0f, 0.0f, TY_SOLVER_IMPULSE, 3e5f},
        .press = {.strain = 0.0f, .seconds = 0.6f},
        .moisture = {.variation = 0.8f, .drying = 0.4f, .wet_basis = 0.62f},
        .animate = {.frames = 0, .fps = 24.0f},
        .seed = {7},
    };
}

#define FIELD(name, type, unit, low, high, member, help)                                                               \
    {                                                                                                                  \
        name, type, unit, low, high, NULL, NULL, offsetof(OWNER, member), help, false                                  \
    }

// --- element ---

static const char* const element_kinds[] = {"rice", "roe",  "ball",   "ice",  "grape",
                                            "bean", "tofu", "pebble", "mesh", NULL};
static const char* const cultivars[] = {"japonica", "indica", "aromatic", "glutinous", NULL};
static const char* const beans[] = {"red", "black", "white", NULL};
static const char* const roe_presets[] = {"ikura", "tobiko", "tarako", "kazunoko", NULL};

static void roe_set_default(void* def)
{
    *(ty_roe_def*)def = ty_element_def_default().roe;
}

#define OWNER ty_roe_def
static const ty_param roe_rows[] = {
    {"preset", TY_PARAM_ENUM, "", 0, 0, roe_presets, NULL, offsetof(OWNER, preset),
     "eggs of salmon, flying fish, pollock or herring", false},
    FIELD("diameter", TY_PARAM_FLOAT, "mm", 0, 50, diameter, "mean of the eggs, from 0.2; 0 = of the preset"),
    FIELD("membrane", TY_PARAM_FLOAT, "mm", 0, 5, membrane,
          "thickness, a thousandth to a tenth of the diameter; 0 = of the preset"),
    FIELD("yolk", TY_PARAM_FLOAT, "", 0, 0.5, yolk, "its share of what is within the membrane; 0 = of the preset"),
    FIELD("lean", TY_PARAM_FLOAT, "deg", 0, 180, lean, "largest angle of the yolk off the top, where it floats"),
    FIELD("press", TY_PARAM_FLOAT, "", 0, 0.05, press,
          "how much farther eggs reach than they were packed, so that they meet in small discs"),
};
#undef OWNER

static const ty_param_table roe_table = {
    "aggregate.element.roe",
    "An egg of fish: a membrane, white in it, a yolk that floats in the white. Each is a body of its own, with the "
    "material slots membrane, white and yolk.",
    sizeof(ty_roe_def),
    roe_set_default,
    roe_rows,
    TY_PARAM_COUNT(roe_rows)};

static void grain_set_default(void* def)
{
    *(ty_element_def*)def = ty_element_def_default();
}

const char* ty_element_kind_name(const ty_element_def* def)
{
    return def->kind == TY_ELEMENT_BEAN ? beans[def->bean] : element_kinds[def->kind];
}

#define OWNER ty_element_def
static const ty_param grain_rows[] = {
    {"kind", TY_PARAM_ENUM, "", 0, 0, element_kinds, NULL, offsetof(OWNER, kind), "what one element is", false},
    FIELD("ratio", TY_PARAM_FLOAT, "", 0, 1e6, ratio, "in a list of elements: how many of these against the others"),
    {"cultivar", TY_PARAM_ENUM, "", 0, 0, cultivars, NULL, offsetof(OWNER, cultivar),
     "of rice: its sizes, where none are given", false},
    {"bean", TY_PARAM_ENUM, "", 0, 0, beans, NULL, offsetof(OWNER, bean), "of beans: the sizes, where none are given",
     false},
    FIELD("mesh", TY_PARAM_PATH, "", 0, 0, mesh, "a closed mesh, with kind mesh"),
    FIELD("length", TY_PARAM_FLOAT, "mm", 0, 500, length,
          "mean length; 0 = of the kind, of a mesh as its file has it. But for rice, sizes of 0 follow those given"),
    FIELD("width", TY_PARAM_FLOAT, "mm", 0, 500, width, "mean width, at most the length; 0 = of the kind"),
    FIELD("thickness", TY_PARAM_FLOAT, "mm", 0, 500, thickness,
          "mean thickness, to the width, of rice from half of it, else from a fifth; 0 = of the kind"),
    FIELD("variation", TY_PARAM_FLOAT, "", 0, 0.2, variation, "standard deviation of the sizes, relative"),
    FIELD("variants", TY_PARAM_INT, "", 1, TY_ELEMENT_MAX_VARIANTS, variants,
          "how many different meshes are made; of ball, roe and mesh there is one"),
    FIELD("notch", TY_PARAM_FLOAT, "", 0, 0.3, notch,
          "depth of the dent of a germ, a hilum or a stem (a third of it), of the width"),
    FIELD("divisions", TY_PARAM_INT, "", 4, 64, divisions, "cells across the width of a mesh"),
    FIELD("fit", TY_PARAM_FLOAT, "", 0.01, 0.2, fit,
          "farthest that balls and surface are apart, of the width; rice has ten balls whatever it is"),
    {"roe", TY_PARAM_GROUP, "", 0, 0, NULL, &roe_table, offsetof(OWNER, roe), "with kind roe: the egg", false},
};
#undef OWNER

static const ty_param_table grain_table = {
    "aggregate.element", "What an aggregate is made of.", sizeof(ty_element_def), grain_set_default,
    grain_rows,          TY_PARAM_COUNT(grain_rows)};

const ty_param_table* ty_element_params(void)
{
    return &grain_table;
}

// --- container ---

static const char* const container_kinds[] = {"bowl", "box", "sphere", "dome", "mesh", "ground", NULL};
static const char* const container_roles[] = {"volume", "vessel", NULL};
static const char* const cut_kinds[] = {"none", "sphere", "plane", NULL};

static void cut_set_default(void* def)
{
    *(ty_cut_def*)def = ty_container_def_default().cut;
}

#define OWNER ty_cut_def
static const ty_param cut_rows[] = {
    {"shape", TY_PARAM_ENUM, "", 0, 0, cut_kinds, NULL, offsetof(OWNER, kind),
     "a sphere takes what is in it, a plane what is beyond it", false},
    FIELD("center", TY_PARAM_FLOAT3, "m", -1e4, 1e4, center, "of the sphere, or a point of the plane"),
    FIELD("radius", TY_PARAM_FLOAT, "m", 0, 1e4, radius, "of the sphere"),
    FIELD("normal", TY_PARAM_FLOAT3, "", -1, 1, normal, "of the plane, towards what is taken"),
};
#undef OWNER

static const ty_param_table cut_table = {
    "aggregate.container.cut",
    "What is left out after settling, so that one sees into the pile: each element whose centre lies in the cut.",
    sizeof(ty_cut_def),
    cut_set_default,
    cut_rows,
    TY_PARAM_COUNT(cut_rows)};

static void container_set_default(void* def)
{
    *(ty_container_def*)def = ty_container_def_default();
}

#define OWNER ty_container_def
static const ty_param container_rows[] = {
    {"shape", TY_PARAM_ENUM, "", 0, 0, container_kinds, NULL, offsetof(OWNER, kind),
     "bowl and box are open at the top; sphere and dome are closed; ground is a plane for a heap", false},
    FIELD("mesh", TY_PARAM_PATH, "", 0, 0, mesh, "a closed mesh, with shape mesh"),
    {"role", TY_PARAM_ENUM, "", 0, 0, container_roles, NULL, offsetof(OWNER, role),
     "of a mesh: the surface of the space that is filled, or of the wall about a hollow open at the top", false},
    {"cut", TY_PARAM_GROUP, "", 0, 0, NULL, &cut_table, offsetof(OWNER, cut), "what is left out at the end", false},
    FIELD("radius", TY_PARAM_FLOAT, "m", 0, 1e4, shape.radius,
          "of bowl (rim, outside), sphere, dome; of the heap's foot on ground, as filled"),
    FIELD("size", TY_PARAM_FLOAT3, "m", 0, 1e4, shape.size, "half extents of the box"),
    FIELD("height", TY_PARAM_FLOAT, "m", 0, 1e4, shape.height, "of bowl and dome"),
    FIELD("thickness", TY_PARAM_FLOAT, "m", 0, 1e4, shape.thickness, "wall of the bowl"),
    FIELD("foot_radius", TY_PARAM_FLOAT, "m", 0, 1e4, shape.foot_radius, "of the bowl's foot ring"),
    FIELD("foot_height", TY_PARAM_FLOAT, "m", 0, 1e4, shape.foot_height, "of the bowl's foot ring"),
    FIELD("curve", TY_PARAM_FLOAT, "", 1, 12, shape.curve,
          "profile of the bowl: 1 = cone, 2 = parabola, more = fuller"),
    FIELD("rounding", TY_PARAM_FLOAT, "m", 0, 1e4, shape.rounding, "radius of edges"),
    FIELD("divisions", TY_PARAM_INT, "", 8, 4096, shape.divisions, "cells around"),
};
#undef OWNER

static const ty_param_table container_table = {"aggregate.container",
                                               "What the grains lie in. The fields of bowl, box, sphere and dome are "
                                               "those of the shapes of a scene: give both the "
                                               "same numbers.",
                                               sizeof(ty_container_def),
                                               container_set_default,
                                               container_rows,
                                               TY_PARAM_COUNT(container_rows)};

const ty_param_table* ty_container_params(void)
{
    return &container_table;
}

// --- fill, settle, moisture ---

static const char* const fill_starts[] = {"inflate", "thesis", "lattice", NULL};
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

static void fill_set_default(void* def)
{
    *(ty_fill_def*)def = ty_aggregate_recipe_default().fill;
}

#define OWNER ty_fill_def
static const ty_param fill_rows[] = {
    {"start", TY_PARAM_ENUM, "", 0, 0, fill_starts, NULL, offsetof(OWNER, start),
     "how the elements are placed: grown in place; moved and taken out by the cost of Gan 2023; in a lattice", false},
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
    {"element", TY_PARAM_GROUP, "", 0, 0, NULL, &grain_table, offsetof(OWNER, element), "what comes", false},
    {"elements", TY_PARAM_LIST, "", 0, 0, NULL, &grain_table, offsetof(OWNER, elements),
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

static const char* const solvers[] = {"impulse", "xpbd", NULL};

static void settle_set_default(void* def)
{
    *(ty_settle_def*)def = ty_aggregate_recipe_default().settle;
}

#define OWNER ty_settle_def
static const ty_param settle_rows[] = {
    FIELD("friction", TY_PARAM_FLOAT, "", 0, 2, friction, "Coulomb coefficient, between grains and at walls"),
    FIELD("rolling", TY_PARAM_FLOAT, "", 0, 0.1, rolling, "rolling resistance, of half the width"),
    FIELD("max_seconds", TY_PARAM_FLOAT, "s", 0.1, 60, max_seconds, "simulated time after which a pile is not at rest"),
    FIELD("rate", TY_PARAM_FLOAT, "1/s", 1000, 20000, rate, "substeps per second; deep piles want more"),
    FIELD("polish", TY_PARAM_INT, "", 0, 5000, polish, "sweeps that take out what overlap is left"),
    FIELD("cohesion", TY_PARAM_FLOAT, "N/m", -1, 1, cohesion,
          "surface tension of the liquid between grains; below 0: water, as much as moisture.wet_basis gives"),
    FIELD("adhesion", TY_PARAM_FLOAT, "J/m^2", 0, 10, adhesion, "work of adhesion of sticky grains, starch about 0.1"),
    {"solver", TY_PARAM_ENUM, "", 0, 0, solvers, NULL, offsetof(OWNER, solver),
     "impulse: rigid elements that come to rest; xpbd: elastic ones that bend, run for max_seconds, and creep", false},
    FIELD("modulus", TY_PARAM_FLOAT, "Pa", 1e3, 1e8, modulus, "Young's, of elastic elements: with xpbd, or pressed"),
};
#undef OWNER

static const ty_param_table settle_table = {"aggregate.settle",    "How the grains come to rest.",
                                            sizeof(ty_settle_def), settle_set_default,
                                            settle_rows,           TY_PARAM_COUNT(settle_rows)};

static void press_set_default(void* def)
{
    *(ty_press_def*)def = ty_aggregate_recipe_default().press;
}

#define OWNER ty_press_def
static const ty_param press_rows[] = {
    FIELD("strain", TY_PARAM_FLOAT, "", 0, 0.5, strain, "how far, of the height; 0 = not at all"),
    FIELD("seconds", TY_PARAM_FLOAT, "s", 0.05, 10, seconds,
          "simulated: down over .4 of it, up from .5 to .8, then left"),
};
#undef OWNER

static const ty_param_table press_table = {
    "aggregate.press",
    "A closed container is squeezed towards its lowest point, into an open one comes a lid; then both open "
    "again. The elements are elastic in it, and stay bent and sheared as they lie at the end.",
    sizeof(ty_press_def),
    press_set_default,
    press_rows,
    TY_PARAM_COUNT(press_rows)};

static void wetness_set_default(void* def)
{
    *(ty_wetness_def*)def = ty_aggregate_recipe_default().moisture;
}

#define OWNER ty_wetness_def
static const ty_param wetness_rows[] = {
    FIELD("variation", TY_PARAM_FLOAT, "", 0, 1, variation, "share of chance in the attribute moisture (-1..1)"),
    FIELD("drying", TY_PARAM_FLOAT, "", 0, 1, drying, "how much drier the grains at the surface are"),
    FIELD("wet_basis", TY_PARAM_FLOAT, "", 0.05, 1, wet_basis,
          "water of the mass of wet grains: cooked 0.62; bridges hold them together from 0.35 on, up to 0.76"),
};
#undef OWNER

static const ty_param_table wetness_table = {"aggregate.moisture",   "The attribute moisture of the grains.",
                                             sizeof(ty_wetness_def), wetness_set_default,
                                             wetness_rows,           TY_PARAM_COUNT(wetness_rows)};

static void animate_set_default(void* def)
{
    *(ty_animate_def*)def = ty_aggregate_recipe_default().animate;
}

#define OWNER ty_animate_def
static const ty_param animate_rows[] = {
    FIELD("frames", TY_PARAM_INT, "", 0, 10000, frames, "of the film that pack writes to OUT.####.glb; 0 = none"),
    FIELD("fps", TY_PARAM_FLOAT, "1/s", 1, 1000, fps, "frames per second of simulated time"),
};
#undef OWNER

static const ty_param_table animate_table = {"aggregate.animate",    "The pile as it settles, frame by frame.",
                                             sizeof(ty_animate_def), animate_set_default,
                                             animate_rows,           TY_PARAM_COUNT(animate_rows)};

// --- the whole ---

static void recipe_set_default(void* def)
{
    *(ty_aggregate_recipe*)def = ty_aggregate_recipe_default();
}

#define OWNER ty_aggregate_recipe
#define GROUP(member, table, help)                                                                                     \
    {                                                                                                                  \
#member, TY_PARAM_GROUP, "", 0, 0, NULL, table, offsetof(OWNER, member), help, false                           \
    }
static const ty_param recipe_rows[] = {
    GROUP(element, &grain_table, "what is packed"),
    {"elements", TY_PARAM_LIST, "", 0, 0, NULL, &grain_table, offsetof(OWNER, elements),
     "kinds that are mixed by ratio, at most 16, in place of element; a mesh without slots has one of its kind's name",
     false},
    GROUP(container, &container_table, "what the grains lie in"),
    GROUP(fill, &fill_table, "how many, how dense, how high"),
    {"layers", TY_PARAM_LIST, "", 0, 0, NULL, &layer_table, offsetof(OWNER, layers),
     "what comes onto that in an open container, one after the other; with element, at most 16 kinds in all", false},
    GROUP(settle, &settle_table, "how they come to rest"),
    GROUP(press, &press_table, "a mould that closes on them"),
    GROUP(moisture, &wetness_table, "the attribute moisture"),
    GROUP(animate, &animate_table, "a film of it"),
    FIELD("seed", TY_PARAM_SEED, "", 0, 0, seed, "one seed, one result"),
};
#undef GROUP
#undef OWNER

static const ty_param_table recipe_table = {"aggregate",
                                            "Grains that lie in a vessel, at rest.",
                                            sizeof(ty_aggregate_recipe),
                                            recipe_set_default,
                                            recipe_rows,
                                            TY_PARAM_COUNT(recipe_rows)};

const ty_param_table* ty_aggregate_recipe_params(void)
{
    return &recipe_table;
}

static ty_status make(const void* def, ty_workers* workers, ty_made* out, ty_error* error)
{
    if (out->film.put)
        return ty_aggregate_film(def, workers, &out->film, error);
    return ty_aggregate_make(def, workers, &out->aggregate, error);
}

static ty_status element(const void* def, int number, ty_mesh** out, ty_error* error)
{
    mixture m;
    *out = NULL;
    ty_status status = mixture_init(def, &m, error);
    if (status != TY_OK)
        return status;
    if (number < 1 || number > m.grain_count)
        status =
            ty_error_set(error, TY_BAD_INPUT, "there is no element %d: the recipe has 1..%d", number, m.grain_count);
    else
    {
        *out = m.grains[number - 1].mesh;
        m.grains[number - 1].mesh = NULL;
    }
    mixture_term(&m);
    return status;
}

const ty_generator ty_aggregate_generator = {
    .kind = "aggregate",
    .build_id = "aggregate 3",
    .product = TY_PRODUCT_AGGREGATE,
    .params = &recipe_table,
    .make = make,
    .element = element,
};
