// SPDX-License-Identifier: Apache-2.0
// The recipe of a Turing filter: a picture, or a sequence of them, redrawn by an activator and its inhibitor.
// `kind: filter`.
#pragma once
#include <tsuya/base/rng.h>
#include <tsuya/generate/asset.h>
#include <tsuya/generate/turing.h>

typedef enum ty_filter_mode
{
    TY_FILTER_TONE,    // the picture steers cu: bright places become bright patterns and stay so
    TY_FILTER_PLAIN,   // the picture is the U that the reaction starts from, and is forgotten
    TY_FILTER_LIMITED, // the same, with diffusion limited where U is steep: forgotten later
} ty_filter_mode;

typedef enum ty_filter_preset
{
    TY_FILTER_STRIPES,
    TY_FILTER_SPOTS,
    TY_FILTER_INVERSE, // dark spots
    TY_FILTER_CUSTOM,
} ty_filter_preset;

typedef enum ty_filter_color
{
    TY_FILTER_GREY,     // tone by luminance; low and high
    TY_FILTER_TINTED,   // one pattern of black and the picture's own hues; their mean is the picture's colour
    TY_FILTER_CHANNELS, // a pattern for each of red, green and blue
} ty_filter_color;

typedef struct ty_filter_tone
{
    float range[2];  // cu of black and of white
    bool calibrated; // each tone gets the threshold that gives its share of bright cells
    bool displayed;  // the tone is the value shown, encoded as sRGB is; else its light
    float smoothing; // cells: of the Gaussian over tones before their thresholds
} ty_filter_tone;

typedef struct ty_filter_limit
{
    int of; // ty_turing_limit less one
    float slope;
    bool conservative;
} ty_filter_limit;

typedef struct ty_filter_region
{
    const char* mask; // white: where the pattern lives
    bool inverted;
    int boundary;   // 0 = free, 1 = fixed
    float value[2]; // U and V where it does not live
    float softness; // 1/time: how fast a grey cell of a fixed region goes to value
} ty_filter_region;

typedef struct ty_filter_contours
{
    float threshold; // of the gradient a cell; 0 = none
    float sigma;     // cells: what is smaller is no contour
    float width;     // cells
    float value[2];  // U and V on them
} ty_filter_contours;

typedef struct ty_filter_along
{
    float strength; // 0..0.7
    float sigma;    // cells, of the gradient
    float spread;   // cells, over which directions are averaged
    bool across;
} ty_filter_along;

typedef struct ty_filter_recipe
{
    const char* image;       // a file, or a pattern with ####; NULL = none: an even grey
    int first_frame;         // of a sequence
    int cells[2];            // 0: of the image
    int scale;               // pixels of a frame per cell, 1..8
    int mode, preset;        // ty_filter_mode, ty_filter_preset
    ty_turing_reaction u, v; // with TY_FILTER_CUSTOM
    float size;              // of the pattern, times
    ty_filter_tone tone;
    ty_filter_limit limit;
    ty_param_list regions; // of ty_filter_region
    int edges;             // ty_turing_edge
    float edge_value[2];
    ty_filter_contours contours;
    ty_filter_along along;
    float time, time_per_frame; // of the reaction
    int frames;                 // 0: as many as the sequence has, of an image 1
    float time_step;            // 0: .9 / (4 Dv)
    int color;                  // ty_filter_color
    ty_rgb low, high;           // ACEScg
    float threshold, softness;  // of U: middle and half width of the step from low to high
    bool fields;                // U and V as channels
    ty_seed seed;
} ty_filter_recipe;

ty_filter_recipe ty_filter_recipe_default(void);
extern const ty_param_table ty_filter_recipe_table;
// The field's definition that a recipe comes to, but for its size.
ty_turing_def ty_filter_turing_def(const ty_filter_recipe* recipe);
// def is a ty_filter_recipe; as ty_generator's make. Goes on from what sink->keep was given, as a file, where there is
// a state: in the middle of a frame as well; `time` and `frames` may be larger than they were.
TY_CHECKED ty_status ty_filter_make(const void* def, ty_workers* workers, const ty_frame_sink* sink,
                                    const ty_bytes* state, ty_error* error);
extern const ty_generator ty_filter_generator;
