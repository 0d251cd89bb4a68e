// SPDX-License-Identifier: Apache-2.0
// The parameter tables of a root recipe and their defaults.
#include <tsuya/base/param_rows.h>
#include <tsuya/generate/roots_recipe.h>

ty_roots_recipe ty_roots_recipe_default(void)
{
    ty_roots_recipe recipe = {
        .thesis = {.unit = 0.5f, .fall = 1.0f},
        .host = {.kind = TY_ROOTS_HOST_SPHERE,
                 .shape = ty_shape_def_default(),
                 .floor = true,
                 .resolution = 256,
                 .avoid = {.channel = "r"},
                 .attract = {.channel = "r"}},
        .trunk = {0.03f, 0.012f, {0.0f, 0.0f, 0.0f}},
        .count = 11,
        .radius = 4.2e-3f,
        .variation = 0.3f,
        .tip = 0.7e-3f,
        .taper = 0.2f,
        .length = 0.35f,
        .growth = {.gravity = 0.6f,
                   .wander = 0.9f,
                   .repel = 0.5f,
                   .keep = 4.0f,
                   .stiffness = 4.0f,
                   .wave = 9.0f,
                   .distance = 5.0f,
                   .hold = 1.5f,
                   .overhang = ty_radians(35.0f),
                   .sink = 0.25f,
                   .flatten = 0.75f,
                   .avoid = 1.0f,
                   .attract = 1.0f,
                   .clear = 1.5f},
        .first = {.spacing = 0.02f, .reach = 0.05f, .slant = 1.5f, .share = {0.4f, 0.75f}, .wander = 0.12f},
        .second = {.spacing = 0.03f, .reach = 0.04f, .slant = 1.4f, .share = {0.5f, 0.8f}, .wander = 0.1f},
        .aerial = {.count = 0, .share = {0.3f, 0.5f}},
        .cover = {.spacing = 0.0f, .radius = 0.8e-3f},
        .exponent = 2.3f,
        .flare = 0.5f,
        .join = 0.8f,
        .bark = 0.08f,
        .detail = 0.6e-3f,
        .tubes = {.divisions = 16, .color = {0.32f, 0.25f, 0.18f}, .junction = 1.0f},
        .levels = 1,
        .grow = {.frames = 1},
        .seed = {7},
    };
    recipe.host.shape.radius = 0.04f;
    return recipe;
}

// --- shapes ---

static const char* const host_kinds[] = {"sphere", "ellipsoid", "box", "cylinder", "stone", "block", "mesh", NULL};

#define SHAPE_ROWS                                                                                                     \
    {"shape", TY_PARAM_ENUM, "", 0, 0, host_kinds, NULL, offsetof(OWNER, kind), "what it is", false},                  \
        FIELD("mesh", TY_PARAM_PATH, "", 0, 0, mesh, "a mesh, with shape mesh; it may be open, and hold instances"),   \
        FIELD("radius", TY_PARAM_FLOAT, "m", 0, 1e4, shape.radius, "of sphere and cylinder"),                          \
        FIELD("size", TY_PARAM_FLOAT3, "m", 0, 1e4, shape.size,                                                        \
              "semi-axes of ellipsoid and stone, half extents of box and block"),                                      \
        FIELD("height", TY_PARAM_FLOAT, "m", 0, 1e4, shape.height, "of the cylinder"),                                 \
        FIELD("rounding", TY_PARAM_FLOAT, "m", 0, 1e4, shape.rounding, "edges of box and cylinder"),                   \
        FIELD("relief", TY_PARAM_FLOAT, "", 0, 0.5, shape.relief, "of stone and block"),                               \
        FIELD("variant", TY_PARAM_INT, "", 0, 1000000, shape.variant, "which stone or block"),                         \
        FIELD("divisions", TY_PARAM_INT, "", 8, 4096, shape.divisions, "segments around; roots feel facets")

// The table of a part of the recipe, whose defaults are the recipe's.
#define PART(name, member, heading, help, rows)                                                                        \
    static void set_##name(void* def)                                                                                  \
    {                                                                                                                  \
        *(OWNER*)def = ty_roots_recipe_default().member;                                                               \
    }                                                                                                                  \
    TABLE(name, heading, help, rows)

// --- masks ---

static void set_mask_table(void* def)
{
    *(ty_roots_mask_def*)def = (ty_roots_mask_def){.channel = "r"};
}

#define OWNER ty_roots_mask_def
static const ty_param mask_rows[] = {
    FIELD("attribute", TY_PARAM_STRING, "", 0, 0, attribute, "of the vertices, or a channel of it as color.g"),
    FIELD("texture", TY_PARAM_PATH, "", 0, 0, texture, "in place of it: a picture, looked up at the host's uv"),
    FIELD("channel", TY_PARAM_STRING, "", 0, 0, channel,
          "of the texture: r, g, b, a, luminance, or the name of a further channel of the file"),
};
TABLE(mask_table, "roots.mask", "What is painted on a host, 0 to 1; brief: an attribute.", mask_rows);
#undef OWNER

#define MASK(name, member, help)                                                                                       \
    {                                                                                                                  \
        name, TY_PARAM_BRIEF_GROUP, "", 0, 0, NULL, &mask_table, offsetof(OWNER, member), help, false                  \
    }

// --- objects ---

#define OBJECT_ROWS                                                                                                    \
    SHAPE_ROWS, FIELD("translate", TY_PARAM_FLOAT3, "m", -1e5, 1e5, translate, "where it stands, after turning"),      \
        FIELD("rotate", TY_PARAM_FLOAT3, "deg", -36000, 36000, rotate, "about x, then y, then z"),                     \
        FIELD("scale", TY_PARAM_FLOAT3, "", -1e5, 1e5, scale, "before turning; none is 0")

static void set_object_table(void* def)
{
    *(ty_roots_object_def*)def = (ty_roots_object_def){.shape = ty_shape_def_default(), .scale = {1.0f, 1.0f, 1.0f}};
}

static void set_part_table(void* def)
{
    set_object_table(def);
    set_mask_table(&((ty_roots_object_def*)def)->avoid);
    set_mask_table(&((ty_roots_object_def*)def)->attract);
}

#define OWNER ty_roots_object_def
static const ty_param object_rows[] = {OBJECT_ROWS};
TABLE(object_table, "roots.object", "What roots keep clear of.", object_rows);
static const ty_param part_rows[] = {
    OBJECT_ROWS,
    MASK("avoid", avoid, "painted on it alone, in place of what the host says"),
    MASK("attract", attract, "the same"),
};
TABLE(part_table, "roots.part", "Part of a host.", part_rows);
#undef OWNER

// --- host ---

#define OWNER ty_roots_host_def
static const ty_param host_rows[] = {
    SHAPE_ROWS,
    LIST("objects", &part_table, objects, "several, in place of shape: they may overlap"),
    FIELD("floor", TY_PARAM_BOOL, "", 0, 0, floor, "it stands on a plane; roots go on over it"),
    FIELD("floor_height", TY_PARAM_FLOAT, "m", -1e4, 1e4, floor_height, "of the plane above the host's lowest point"),
    FIELD("resolution", TY_PARAM_INT, "", 16, 448, resolution, "steps of its field of distance along the longest side"),
    MASK("avoid", avoid, "roots keep from where it is 1"),
    MASK("attract", attract, "roots are drawn to where it is 1"),
};
PART(host_table, host, "roots.host", "What the roots hold on to; it is no part of the result.", host_rows);
#undef OWNER

// --- start ---

static void set_start_table(void* def)
{
    *(ty_roots_start_def*)def = (ty_roots_start_def){0};
}

#define OWNER ty_roots_start_def
static const ty_param start_rows[] = {
    FIELD("points", TY_PARAM_POINTS, "m", -1e5, 1e5, points, "places on the host, or near it"),
    FIELD("attribute", TY_PARAM_STRING, "", 0, 0, attribute,
          "of the host's vertices, or a channel as color.r: places apart from one another where it is above 0.5"),
};
TABLE(start_table, "roots.start", "Where main roots start, in place of the trunk.", start_rows);
#undef OWNER

// --- trunk ---

#define OWNER ty_roots_trunk_def
static const ty_param trunk_rows[] = {
    FIELD("height", TY_PARAM_FLOAT, "m", 0, 1e3, height,
          "of its cut above the highest point of the host; 0 = no trunk"),
    FIELD("radius", TY_PARAM_FLOAT, "mm", 0.1, 1e6, radius, "where the main roots leave it"),
    FIELD("lean", TY_PARAM_FLOAT3, "m", -1e3, 1e3, lean, "the place of its cut against that above the host's middle"),
};
PART(trunk_table, trunk, "roots.trunk", "Where the main roots come from.", trunk_rows);
#undef OWNER

// --- growth ---

#define OWNER ty_roots_growth_def
static const ty_param growth_rows[] = {
    FIELD("gravity", TY_PARAM_FLOAT, "", 0, 10, gravity, "weight of down in how a tip turns"),
    FIELD("wander", TY_PARAM_FLOAT, "", 0, 10, wander, "weight of chance"),
    FIELD("repel", TY_PARAM_FLOAT, "", -10, 10, repel, "weight of keeping away from other main roots; < 0: of joining"),
    FIELD("keep", TY_PARAM_FLOAT, "", 0, 10, keep,
          "weight of its own course about the host, which it comes back to; less: it strays, and small changes grow"),
    FIELD("stiffness", TY_PARAM_FLOAT, "", 1, 100, stiffness, "length in which a root turns, of its radius"),
    FIELD("wave", TY_PARAM_FLOAT, "", 1, 1000, wave, "length in which chance changes, of the radius"),
    FIELD("distance", TY_PARAM_FLOAT, "", 1, 100, distance, "how far other main roots are felt, of the radius"),
    FIELD("hold", TY_PARAM_FLOAT, "", 0, 100, hold, "how far from the host a root still takes to it, of its radius"),
    FIELD("overhang", TY_PARAM_FLOAT, "deg", 0, 90, overhang, "undersides steeper than this are let go; 90 = none"),
    FIELD("sink", TY_PARAM_FLOAT, "", 0, 0.9, sink, "depth under the surface of the host, of the radius"),
    FIELD("flatten", TY_PARAM_FLOAT, "", 0.3, 1, flatten, "height of a section that lies on the host, of its width"),
    FIELD("avoid", TY_PARAM_FLOAT, "", 0, 10, avoid, "weight of keeping from where host.avoid is painted"),
    FIELD("attract", TY_PARAM_FLOAT, "", 0, 10, attract, "weight of going to where host.attract is painted"),
    FIELD("clear", TY_PARAM_FLOAT, "", 1, 100, clear, "how far from obstacles roots keep, of the radius"),
};
PART(growth_table, growth, "roots.growth", "How a tip finds its way.", growth_rows);
#undef OWNER

// --- branches ---

#define OWNER ty_roots_link_def
static const ty_param link_rows[] = {
    FIELD("spacing", TY_PARAM_FLOAT, "mm", 0, 1e6, spacing, "mean length of the parent between them; 0 = none"),
    FIELD("density_by_height", TY_PARAM_POINTS2, "", 0, 1, density_by_height,
          "[height, share]: which share of them leaves, from the host's lowest point, 0, to its highest, 1"),
    FIELD("reach", TY_PARAM_FLOAT, "mm", 0, 1e6, reach, "how far a partner may be"),
    FIELD("slant", TY_PARAM_FLOAT, "", 0, 4, slant, "how much farther down they end, of the way across"),
    FIELD("share", TY_PARAM_FLOAT2, "", 0.1, 0.95, share, "radius against the thinner of both: from, to"),
    FIELD("wander", TY_PARAM_FLOAT, "", 0, 1, wander, "how far they swing to the side, of the way across"),
};
PART(first_table, first, "roots.first", "Branches from a main root to the next.", link_rows);
PART(second_table, second, "roots.second", "Branches between first branches.", link_rows);
#undef OWNER

#define OWNER ty_roots_aerial_def
static const ty_param aerial_rows[] = {
    FIELD("count", TY_PARAM_INT, "", 0, 1000, count, "of roots that hang from the host"),
    FIELD("share", TY_PARAM_FLOAT2, "", 0.02, 1, share, "radius against a main root's: from, to"),
};
PART(aerial_table, aerial, "roots.aerial", "Roots that hang free until they find ground.", aerial_rows);
#undef OWNER

#define OWNER ty_roots_cover_def
static const ty_param cover_rows[] = {
    FIELD("spacing", TY_PARAM_FLOAT, "mm", 0, 1e6, spacing, "between places that fine roots grow towards; 0 = none"),
    FIELD("radius", TY_PARAM_FLOAT, "mm", 0.05, 1e6, radius, "of a fine root"),
};
PART(cover_table, cover, "roots.cover", "Fine roots over what is left of the host, by space colonisation.", cover_rows);
#undef OWNER

// --- the thesis' own method ---

#define OWNER ty_roots_thesis_def
static const ty_param thesis_rows[] = {
    FIELD("unit", TY_PARAM_FLOAT, "", 0.01, 100, unit, "unit of the thesis' lengths, of the radius"),
    FIELD("fall", TY_PARAM_FLOAT, "", 0, 1e6, fall, "weight of down in the way of a main root; 1 as printed"),
};
PART(thesis_table, thesis, "roots.thesis", "What only method seed has.", thesis_rows);
#undef OWNER

// --- tubes ---

#define OWNER ty_roots_tubes_def
static const ty_param tubes_rows[] = {
    FIELD("divisions", TY_PARAM_INT, "", 4, 128, divisions, "sides of a section, an even number"),
    FIELD("color", TY_PARAM_RGB, "", 0, 1, color, "of the vertices"),
    FIELD("junction", TY_PARAM_FLOAT, "", 0, 4, junction,
          "how far branches spread along the roots that they meet, 1 as in the thesis; 0 = not at all"),
};
PART(tubes_table, tubes, "roots.tubes", "A tube for each root, not welded, with uv as strips.", tubes_rows);
#undef OWNER

// --- growth by time ---

#define OWNER ty_roots_grow_def
static const ty_param grow_rows[] = {
    FIELD("frames", TY_PARAM_INT, "", 1, 100000, frames, "from the sprout to the still mesh, which is the last"),
    FIELD("remesh", TY_PARAM_BOOL, "", 0, 0, remesh,
          "a surface of its own for each frame; else one topology, which can be blurred by motion"),
};
PART(grow_table, grow, "roots.grow", "The same roots as they come about.", grow_rows);
#undef OWNER

// --- the recipe ---

static const char* const methods[] = {"wrap", "seed", NULL};
static const char* const meshes[] = {"surface", "tubes", NULL};

static void set_recipe_table(void* def)
{
    *(ty_roots_recipe*)def = ty_roots_recipe_default();
}

#define OWNER ty_roots_recipe
static const ty_param recipe_rows[] = {
    CHOICE("method", methods, method, "wrap: led by the host's field; seed: as in Homma's thesis of 2011, to compare"),
    GROUP("thesis", &thesis_table, thesis, "what only method seed has"),
    GROUP("host", &host_table, host, "what they hold on to"),
    LIST("obstacles", &object_table, obstacles, "what they keep clear of but do not hold to"),
    GROUP("start", &start_table, start, "where they start, in place of the trunk"),
    GROUP("trunk", &trunk_table, trunk, "where they come from"),
    FIELD("count", TY_PARAM_INT, "", 1, 500, count, "main roots"),
    FIELD("radius", TY_PARAM_FLOAT, "mm", 0.1, 1e6, radius, "of a main root at the trunk"),
    FIELD("variation", TY_PARAM_FLOAT, "", 0, 0.8, variation, "of the radii, relative"),
    FIELD("tip", TY_PARAM_FLOAT, "mm", 0.05, 1e6, tip, "radius at which a root ends"),
    FIELD("taper", TY_PARAM_FLOAT, "m", 1e-3, 1e6, taper, "length over which a radius falls to 37 %"),
    FIELD("length", TY_PARAM_FLOAT, "m", 1e-3, 1e6, length, "of a main root at most"),
    FIELD(
        "radius_by_length", TY_PARAM_POINTS2, "", 0, 10, radius_by_length,
        "[way, factor]: what radii are multiplied by, from the trunk, 0, to `length`, 1; branches follow their roots"),
    GROUP("growth", &growth_table, growth, "how they find their way"),
    GROUP("first", &first_table, first, "branches from a main root to the next"),
    GROUP("second", &second_table, second, "branches between first branches"),
    GROUP("aerial", &aerial_table, aerial, "roots that hang free"),
    GROUP("cover", &cover_table, cover, "fine roots over what is left"),
    FIELD("exponent", TY_PARAM_FLOAT, "", 1.5, 3, exponent, "n of the pipe model: r^n is the sum of those after it"),
    FIELD("flare", TY_PARAM_FLOAT, "", 0, 2, flare, "how much thicker branches begin, of their radius"),
    FIELD("join", TY_PARAM_FLOAT, "", 0, 2, join, "over which distance roots run together, of the thinner's radius"),
    FIELD("bark", TY_PARAM_FLOAT, "", 0, 0.4, bark, "depth of flutes and swellings, of the radius"),
    FIELD("detail", TY_PARAM_FLOAT, "mm", 0.02, 1e6, detail, "size of the surface's cells, at most the tip"),
    CHOICE("mesh", meshes, mesh, "surface: one, closed; tubes: one for each root, each closed, for other programs"),
    GROUP("tubes", &tubes_table, tubes, "with mesh tubes"),
    FIELD("levels", TY_PARAM_INT, "", 1, 6, levels,
          "of detail, each of about a quarter of the triangles: besides OUT.ply OUT.lod1.ply, OUT.lod2.ply ..."),
    FIELD("curves", TY_PARAM_PATH, "", 0, 0, curves,
          "centre lines, perhaps edited, in place of those that would grow: what `tsuya roots --curves` wrote"),
    GROUP("grow", &grow_table, grow, "frames of their growth, for an output with ####"),
    FIELD("seed", TY_PARAM_SEED, "", 0, 0, seed, "another seed, other roots"),
};
TABLE(recipe_table, "roots", "Roots that come down over a host, hold on to it, branch and grow together.", recipe_rows);
#undef OWNER

const ty_param_table* ty_roots_recipe_params(void)
{
    return &recipe_table;
}

static int frame_count(const void* def)
{
    return ((const ty_roots_recipe*)def)->grow.frames;
}

const ty_generator ty_roots_generator = {
    .kind = "roots",
    .build_id = "roots 11",
    .product = TY_PRODUCT_MESH,
    .params = &recipe_table,
    .frame_count = frame_count,
    .make = ty_roots_make_all,
};
