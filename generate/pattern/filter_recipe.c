// SPDX-License-Identifier: Apache-2.0
// The parameter tables of a Turing filter's recipe, their defaults and presets.
#include <tsuya/base/file.h>
#include <tsuya/base/param_rows.h>
#include <tsuya/generate/filter_recipe.h>

// Presets of a clamped activator and inhibitor: what makes them differ is the activator's constant.
static const struct
{
    float constant, diffusion_u, diffusion_v;
} presets[] = {
    [TY_FILTER_STRIPES] = {0.05f, 0.08f, 1.0f},
    [TY_FILTER_SPOTS] = {0.0f, 0.04f, 0.5f},
    [TY_FILTER_INVERSE] = {0.2f, 0.04f, 0.5f},
};

ty_turing_def ty_filter_turing_def(const ty_filter_recipe* recipe)
{
    ty_turing_def def = ty_turing_def_default();
    def.u = recipe->u;
    def.v = recipe->v;
    if (recipe->preset != TY_FILTER_CUSTOM)
    {
        def = ty_turing_def_default();
        def.u.constant = presets[recipe->preset].constant;
        def.u.diffusion = presets[recipe->preset].diffusion_u;
        def.v.diffusion = presets[recipe->preset].diffusion_v;
    }
    def.u.diffusion *= recipe->size * recipe->size;
    def.v.diffusion *= recipe->size * recipe->size;
    def.time_step = recipe->time_step;
    def.edge = recipe->edges;
    def.edge_u = recipe->edge_value[0];
    def.edge_v = recipe->edge_value[1];
    def.limit = recipe->mode == TY_FILTER_LIMITED ? recipe->limit.of + 1 : TY_TURING_LIMIT_NONE;
    def.limit_slope = recipe->limit.slope;
    def.limit_conservative = recipe->limit.conservative;
    return def;
}

ty_filter_recipe ty_filter_recipe_default(void)
{
    ty_turing_def field = ty_turing_def_default();
    return (ty_filter_recipe){
        .first_frame = 1,
        .scale = 1,
        .preset = TY_FILTER_SPOTS,
        .u = field.u,
        .v = field.v,
        .size = 1.0f,
        .tone = {{0.0f, 0.2f}, true, false, 1.0f},
        .limit = {0, 4.0f, false},
        .edge_value = {5.0f, 0.0f},
        .contours = {0.0f, 1.0f, 1.0f, {5.0f, 0.0f}},
        .along = {0.0f, 1.0f, 4.0f, false},
        .time = 2000.0f,
        .time_per_frame = 40.0f,
        .high = {1.0f, 1.0f, 1.0f},
        .threshold = 3.0f,
        .softness = 0.6f,
        .seed = {7},
    };
}

static ty_filter_region region_default(void)
{
    return (ty_filter_region){.boundary = 1, .value = {5.0f, 0.0f}, .softness = 0.06f};
}

// --- reaction ---

static void set_u_table(void* def)
{
    *(ty_turing_reaction*)def = ty_turing_def_default().u;
}

static void set_v_table(void* def)
{
    *(ty_turing_reaction*)def = ty_turing_def_default().v;
}

#define OWNER ty_turing_reaction
static const ty_param reaction_rows[] = {
    FIELD("u", TY_PARAM_FLOAT, "", -10, 10, u, "a: how the rate follows U"),
    FIELD("v", TY_PARAM_FLOAT, "", -10, 10, v, "b: how it follows V"),
    FIELD("constant", TY_PARAM_FLOAT, "", -10, 10, constant, "c; of U with mode tone the image's"),
    FIELD("decay", TY_PARAM_FLOAT, "", 0, 10, decay, "d"),
    FIELD("most", TY_PARAM_FLOAT, "", 0, 100, most, "the rate stays between 0 and this"),
    FIELD("diffusion", TY_PARAM_FLOAT, "", 1e-4, 100, diffusion, "D, cells^2 per unit of time"),
};
TABLE(u_table, "filter.u", "The activator, with preset custom.", reaction_rows);
TABLE(v_table, "filter.v", "The inhibitor, with preset custom.", reaction_rows);
#undef OWNER

// --- tone ---

static void set_tone_table(void* def)
{
    *(ty_filter_tone*)def = ty_filter_recipe_default().tone;
}

#define OWNER ty_filter_tone
static const ty_param tone_rows[] = {
    FIELD("range", TY_PARAM_FLOAT2, "", -1, 1, range, "the activator's constant where the image is black, and white"),
    FIELD("calibrated", TY_PARAM_BOOL, "", 0, 0, calibrated, "each tone's threshold gives its share of bright cells"),
    FIELD("displayed", TY_PARAM_BOOL, "", 0, 0, displayed, "tones are values as shown (sRGB), not amounts of light"),
    FIELD("smoothing", TY_PARAM_FLOAT, "cells", 0, 50, smoothing,
          "of the Gaussian over tones before their thresholds, so that grain does not flicker; 0 = none"),
};
TABLE(tone_table, "filter.tone", "How the image steers the pattern, with mode tone.", tone_rows);
#undef OWNER

// --- limit ---

static void set_limit_table(void* def)
{
    *(ty_filter_limit*)def = ty_filter_recipe_default().limit;
}

static const char* const limited[] = {"u", "both", NULL};

#define OWNER ty_filter_limit
static const ty_param limit_rows[] = {
    CHOICE("of", limited, of, "whose diffusion is limited"),
    FIELD("slope", TY_PARAM_FLOAT, "", 0, 1000, slope, "s of 1 / (1 + s |grad U|)"),
    FIELD("conservative", TY_PARAM_BOOL, "", 0, 0, conservative, "div(g grad U), where nothing is lost; else g lap U"),
};
TABLE(limit_table, "filter.limit", "Where U is steep it spreads less, with mode limited.", limit_rows);
#undef OWNER

// --- regions ---

static void set_region_table(void* def)
{
    *(ty_filter_region*)def = region_default();
}

static const char* const boundaries[] = {"free", "fixed", NULL};

#define OWNER ty_filter_region
static const ty_param region_rows[] = {
    {"mask", TY_PARAM_FRAMES, "", 0, 0, NULL, NULL, offsetof(ty_filter_region, mask),
     "white where the pattern lives; an image of the field's size, or a sequence", true},
    FIELD("inverted", TY_PARAM_BOOL, "", 0, 0, inverted, "the pattern lives where the mask is black"),
    CHOICE("boundary", boundaries, boundary, "free: nothing passes the rim, stripes meet it; fixed: they go along it"),
    FIELD("value", TY_PARAM_FLOAT2, "", -100, 100, value, "U and V where the pattern does not live"),
    FIELD("softness", TY_PARAM_FLOAT, "1/time", 1e-4, 100, softness,
          "how fast half grey of a fixed mask goes to value"),
};
TABLE(region_table, "filter.region", "Where the pattern lives and what its rim is like.", region_rows);
#undef OWNER

// --- contours ---

static void set_contours_table(void* def)
{
    *(ty_filter_contours*)def = ty_filter_recipe_default().contours;
}

#define OWNER ty_filter_contours
static const ty_param contours_rows[] = {
    FIELD("threshold", TY_PARAM_FLOAT, "1/cell", 0, 10, threshold, "least gradient of the tone; 0 = no contours"),
    FIELD("sigma", TY_PARAM_FLOAT, "cells", 0.3, 50, sigma, "of the Gaussian before: what is smaller is none"),
    FIELD("width", TY_PARAM_FLOAT, "cells", 1, 50, width, "of the line"),
    FIELD("value", TY_PARAM_FLOAT2, "", -100, 100, value, "U and V on it"),
};
TABLE(contours_table, "filter.contours", "The image's edges as lines of fixed U and V.", contours_rows);
#undef OWNER

// --- along ---

static void set_along_table(void* def)
{
    *(ty_filter_along*)def = ty_filter_recipe_default().along;
}

#define OWNER ty_filter_along
static const ty_param along_rows[] = {
    FIELD("strength", TY_PARAM_FLOAT, "", 0, 0.7, strength, "how much more U spreads that way; 0 = not at all"),
    FIELD("sigma", TY_PARAM_FLOAT, "cells", 0.3, 50, sigma, "of the Gaussian before the gradient"),
    FIELD("spread", TY_PARAM_FLOAT, "cells", 0.3, 50, spread, "over which directions are averaged"),
    FIELD("across", TY_PARAM_BOOL, "", 0, 0, across, "across the image's structure, not along it"),
};
TABLE(along_table, "filter.along", "Stripes follow the image's structure tensor.", along_rows);
#undef OWNER

// --- the recipe ---

static const char *const modes[] = {"tone", "plain", "limited", NULL},
                         *const preset_names[] = {"stripes", "spots", "inverse", "custom", NULL},
                         *const edge_names[] = {"free", "fixed", "wrap", NULL},
                         *const color_names[] = {"grey", "tinted", "channels", NULL};

static void set_recipe(void* def)
{
    *(ty_filter_recipe*)def = ty_filter_recipe_default();
}

#define OWNER ty_filter_recipe
static const ty_param recipe_rows[] = {
    {"image", TY_PARAM_FRAMES, "", 0, 0, NULL, NULL, offsetof(ty_filter_recipe, image),
     "what is filtered: a file, or a sequence with ####; none: an even grey", false},
    FIELD("first_frame", TY_PARAM_INT, "", -999999, 999999, first_frame, "of a sequence"),
    FIELD("cells", TY_PARAM_INT2, "", 0, 16384, cells, "width and height of the field; 0: the image's"),
    FIELD("scale", TY_PARAM_INT, "", 1, 8, scale, "pixels of a frame per cell"),
    CHOICE("mode", modes, mode, "tone: the image stays; plain, limited: the image is where the reaction starts"),
    CHOICE("preset", preset_names, preset, "stripes 15 cells apart, spots 11, dark spots, or what u and v say"),
    GROUP("u", &u_table, u, "the activator"),
    GROUP("v", &v_table, v, "the inhibitor"),
    FIELD("size", TY_PARAM_FLOAT, "", 0.25, 8, size, "of the pattern, times: both D times its square"),
    GROUP("tone", &tone_table, tone, "how the image steers the pattern"),
    GROUP("limit", &limit_table, limit, "of diffusion where U is steep"),
    {"regions", TY_PARAM_LIST, "", 0, 0, NULL, &region_table, offsetof(ty_filter_recipe, regions),
     "the pattern lives where all of them let it", false},
    CHOICE("edges", edge_names, edges, "of the picture: nothing passes, edge_value stands there, or it tiles"),
    FIELD("edge_value", TY_PARAM_FLOAT2, "", -100, 100, edge_value, "U and V beyond fixed edges"),
    GROUP("contours", &contours_table, contours, "the image's edges held"),
    GROUP("along", &along_table, along, "stripes that follow the image"),
    FIELD("time", TY_PARAM_FLOAT, "", 0, 1e6, time, "of the reaction until the first frame; patterns need 500 to 2000"),
    FIELD("time_per_frame", TY_PARAM_FLOAT, "", 0, 1e6, time_per_frame, "from one frame to the next"),
    FIELD("frames", TY_PARAM_INT, "", 0, 100000, frames, "how many; 0: as many as the sequence has, of an image 1"),
    FIELD("time_step", TY_PARAM_FLOAT, "", 0, 100, time_step, "0: .9 / (4 D); at most 2 / (8 D + decay)"),
    CHOICE("color", color_names, color, "grey: low and high; tinted: the image's hues; channels: red, green and blue"),
    FIELD("low", TY_PARAM_RGB, "", 0, 100, low, "of grey: where U is low"),
    FIELD("high", TY_PARAM_RGB, "", 0, 100, high, "of grey: where U is high"),
    FIELD("threshold", TY_PARAM_FLOAT, "", -100, 100, threshold,
          "the U between low and high, where tones are not calibrated"),
    FIELD("softness", TY_PARAM_FLOAT, "", 1e-3, 100, softness, "of that step, U to both sides; 3 shows all of U"),
    FIELD("fields", TY_PARAM_BOOL, "", 0, 0, fields, "U and V as further channels of EXR files"),
    FIELD("seed", TY_PARAM_SEED, "", 0, 0, seed, "another seed, another pattern"),
};
const ty_param_table ty_filter_recipe_table = {
    "filter",      "A picture redrawn by Turing's activator and inhibitor: spots and stripes that keep its tones.",
    sizeof(OWNER), set_recipe,
    recipe_rows,   TY_PARAM_COUNT(recipe_rows)};
#undef OWNER
