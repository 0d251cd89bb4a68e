// SPDX-License-Identifier: Apache-2.0
// Parameters of an element and of the container in a recipe of an aggregate.
#include "recipe_tables.h"

// --- element ---

static const char* const element_kinds[] = {"rice", "roe",  "ball",   "ice",  "grape",
                                            "bean", "tofu", "pebble", "mesh", NULL};
static const char* const cultivars[] = {"japonica", "indica", "aromatic", "glutinous", NULL};
static const char* const rice_models[] = {"formula", "field", NULL};
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
    FIELD(
        "buoyancy", TY_PARAM_FLOAT, "kg/m^3", -500, 500, buoyancy,
        "by which the white is denser than the yolk; below 0 the yolk sinks: in films, where it starts in the middle"),
    FIELD("viscosity", TY_PARAM_FLOAT, "Pa s", 1e-4, 1e3, viscosity,
          "of the white, through which the yolk rises in films: .001 is water"),
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
    *(ty_grain_def*)def = ty_element_def_default().grain;
}

#define OWNER ty_grain_def
static const ty_param grain_rows[] = {
    FIELD("voxels", TY_PARAM_INT, "", 16, 128, voxels, "across the width, of the grid that the grain is made on"),
    FIELD("swelling", TY_PARAM_FLOAT, "", 0, 1.5, swelling,
          "volume over that of the raw grain, from 1; 0 = of the cultivar: 1.2 of indica, else 1.5, as the sizes mean "
          "it"),
    FIELD("unevenness", TY_PARAM_FLOAT, "", 0, 1, unevenness,
          "of the swelling from grain to grain: standard deviation of what it adds"),
    FIELD("bumps", TY_PARAM_INT, "", 0, 1000, bumps, "balls that rise from the surface"),
    FIELD("bump_radius", TY_PARAM_FLOAT, "mm", 0.01, 5, bump_radius, "of those, mean"),
    FIELD("bump_height", TY_PARAM_FLOAT, "mm", 0, 1, bump_height, "how far they rise, at most"),
    FIELD("pores", TY_PARAM_INT, "", 0, 2000, pores, "balls that are taken out, as deep as the pores of soaking reach"),
    FIELD("pore_radius", TY_PARAM_FLOAT, "mm", 0.01, 5, pore_radius,
          "of those, mean; what is smaller than a voxel is not seen"),
    FIELD("open", TY_PARAM_FLOAT, "", 0, 1, open, "share of the pores that open at the surface"),
    FIELD("smoothing", TY_PARAM_FLOAT, "mm", 0, 1, smoothing,
          "flow by mean curvature for so long that a ball of this radius vanishes"),
    FIELD("soak", TY_PARAM_FLOAT, "min", -1, 120, soak,
          "in water before cooking: how deep the grain is porous, and the attribute pores of its vertices; below 0: "
          "that of "
          "moisture.soak, or 60"),
    FIELD("cut", TY_PARAM_FLOAT, "", 0, 0.9, cut,
          "share of the length that is cut off, so that one sees into the grain"),
};
#undef OWNER

static const ty_param_table grain_table = {
    "aggregate.element.grain",
    "A grain of rice as a field of distances (Gan 2023): a base grain with balls on it and pores in it, swollen and "
    "smoothed. Its vertices have the attributes pores (how far soaking has opened the tissue there, 0 to 1) and depth "
    "(under the skin, 1 = in the middle), for materials.",
    sizeof(ty_grain_def),
    grain_set_default,
    grain_rows,
    TY_PARAM_COUNT(grain_rows)};

static void element_set_default(void* def)
{
    *(ty_element_def*)def = ty_element_def_default();
}

const char* ty_element_kind_name(const ty_element_def* def)
{
    return def->kind == TY_ELEMENT_BEAN ? beans[def->bean] : element_kinds[def->kind];
}

#define OWNER ty_element_def
static const ty_param element_rows[] = {
    {"kind", TY_PARAM_ENUM, "", 0, 0, element_kinds, NULL, offsetof(OWNER, kind), "what one element is", false},
    FIELD("ratio", TY_PARAM_FLOAT, "", 0, 1e6, ratio, "in a list of elements: how many of these against the others"),
    {"cultivar", TY_PARAM_ENUM, "", 0, 0, cultivars, NULL, offsetof(OWNER, cultivar),
     "of rice: its sizes, where none are given", false},
    {"bean", TY_PARAM_ENUM, "", 0, 0, beans, NULL, offsetof(OWNER, bean), "of beans: the sizes, where none are given",
     false},
    FIELD("mesh", TY_PARAM_PATH, "", 0, 0, mesh, "a closed mesh, with kind mesh"),
    FIELD(
        "slot", TY_PARAM_STRING, "", 0, 0, slot,
        "name of its material slot, unless its mesh has names; of several kinds each has its kind's if none is given"),
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
    FIELD("divisions", TY_PARAM_INT, "", 0, 64, divisions,
          "cells across the width of a mesh, from 4; 0 = of the kind: 9, of rice from a field 24"),
    FIELD("fit", TY_PARAM_FLOAT, "", 0, 0.2, fit,
          "farthest that balls and surface are apart, of the width, from 0.01; 0 = of the kind: 0.03, of japonica rice "
          "ten "
          "balls"),
    {"model", TY_PARAM_ENUM, "", 0, 0, rice_models, NULL, offsetof(OWNER, model),
     "of rice: a smooth surface from a formula, or a porous solid from a field", false},
    {"grain", TY_PARAM_GROUP, "", 0, 0, NULL, &grain_table, offsetof(OWNER, grain), "of rice with model field", false},
    {"roe", TY_PARAM_GROUP, "", 0, 0, NULL, &roe_table, offsetof(OWNER, roe), "with kind roe: the egg", false},
};
#undef OWNER

const ty_param_table recipe_element = {"aggregate.element",    "What an aggregate is made of.",
                                       sizeof(ty_element_def), element_set_default,
                                       element_rows,           TY_PARAM_COUNT(element_rows)};

const ty_param_table* ty_element_params(void)
{
    return &recipe_element;
}

// --- container ---

static const char* const container_kinds[] = {"bowl", "box", "sphere", "dome", "mesh", "ground", "onigiri", NULL};
static const char* const container_roles[] = {"volume", "vessel", "mould", NULL};
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

static void onigiri_set_default(void* def)
{
    *(ty_onigiri_def*)def = ty_container_def_default().onigiri;
}

#define OWNER ty_onigiri_def
static const ty_param onigiri_rows[] = {
    FIELD("side", TY_PARAM_FLOAT, "mm", 1, 1e6, side, "of the triangle, before its corners are rounded"),
    FIELD("thickness", TY_PARAM_FLOAT, "mm", 1, 1e6, thickness, "from face to face"),
    FIELD("corner", TY_PARAM_FLOAT, "mm", 0, 1e6, corner, "radius of the triangle's corners"),
    FIELD("edge", TY_PARAM_FLOAT, "mm", 0, 1e6, edge, "radius between faces and sides"),
};
#undef OWNER

static const ty_param_table onigiri_table = {"aggregate.container.onigiri",
                                             "A triangle with round corners and edges that stands on its side.",
                                             sizeof(ty_onigiri_def),
                                             onigiri_set_default,
                                             onigiri_rows,
                                             TY_PARAM_COUNT(onigiri_rows)};

static void container_set_default(void* def)
{
    *(ty_container_def*)def = ty_container_def_default();
}

#define OWNER ty_container_def
static const ty_param container_rows[] = {
    {"shape", TY_PARAM_ENUM, "", 0, 0, container_kinds, NULL, offsetof(OWNER, kind),
     "bowl and box are open at the top; sphere, dome and onigiri are closed; ground is a plane for a heap", false},
    FIELD("mesh", TY_PARAM_PATH, "", 0, 0, mesh, "a closed mesh, with shape mesh"),
    {"role", TY_PARAM_ENUM, "", 0, 0, container_roles, NULL, offsetof(OWNER, role),
     "volume, vessel: a mesh is the surface of the space that is filled, or of the wall about a hollow open at the "
     "top; "
     "mould: a closed form, of box, sphere, dome, onigiri or mesh, that is taken off at the end",
     false},
    {"onigiri", TY_PARAM_GROUP, "", 0, 0, NULL, &onigiri_table, offsetof(OWNER, onigiri), "with shape onigiri", false},
    {"cut", TY_PARAM_GROUP, "", 0, 0, NULL, &cut_table, offsetof(OWNER, cut), "what is left out at the end", false},
    FIELD("radius", TY_PARAM_FLOAT, "m", 0, 1e4, shape.radius,
          "of bowl (rim, outside), sphere, dome; of the heap's foot on ground, as filled"),
    FIELD("size", TY_PARAM_FLOAT3, "m", 0, 1e4, shape.size, "half extents of the box"),
    FIELD("height", TY_PARAM_FLOAT, "m", 0, 1e4, shape.height, "of bowl and dome; 0 = the radius"),
    FIELD("thickness", TY_PARAM_FLOAT, "m", 0, 1e4, shape.thickness,
          "wall of the bowl; 0 = .05 of the radius, at most .1 of the height"),
    FIELD("foot_radius", TY_PARAM_FLOAT, "m", 0, 1e4, shape.foot_radius,
          "of the bowl's foot ring; 0 = .4 of the radius"),
    FIELD("foot_height", TY_PARAM_FLOAT, "m", 0, 1e4, shape.foot_height,
          "of the bowl's foot ring; 0 = 7/60 of the height"),
    FIELD("curve", TY_PARAM_FLOAT, "", 1, 12, shape.curve,
          "profile of the bowl: 1 = cone, 2 = parabola, more = fuller"),
    FIELD("rounding", TY_PARAM_FLOAT, "m", 0, 1e4, shape.rounding, "radius of edges"),
    FIELD("divisions", TY_PARAM_INT, "", 8, 4096, shape.divisions, "cells around"),
};
#undef OWNER

const ty_param_table recipe_container = {"aggregate.container",
                                         "What the grains lie in. The fields of bowl, box, sphere and dome are "
                                         "those of the shapes of a scene: give both the "
                                         "same numbers.",
                                         sizeof(ty_container_def),
                                         container_set_default,
                                         container_rows,
                                         TY_PARAM_COUNT(container_rows)};

const ty_param_table* ty_container_params(void)
{
    return &recipe_container;
}
