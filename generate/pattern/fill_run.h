// SPDX-License-Identifier: Apache-2.0
// A fill while it runs: the field, what its marks mean, what is closed, and where the files are.
#pragma once
#include "plane_file.h"
#include <tsuya/generate/fill_recipe.h>

enum
{
    FILL_OUTSIDE = 1, // of the region
    FILL_BARRIER = 2, // by an event
    FILL_LAYERS = TY_GRAY_SCOTT_MARKS + 1,
    FILL_CLOSED = TY_GRAY_SCOTT_MARKS, // the layer of closed cells
    FILL_KEY = 48
};

typedef struct fill_outputs
{
    bool u, v, mark, trail, distance, mattes;
} fill_outputs;

typedef struct fill_run
{
    const ty_fill_recipe* recipe;
    ty_workers* workers;
    ty_gray_scott_def def;
    ty_gray_scott* field;
    int width, height;
    bool wrap_x, wrap_y;
    const ty_fill_mark* marks; // the recipe's, or `own`
    int mark_count;
    ty_fill_mark own;
    ty_gray_scott_rates rates[TY_GRAY_SCOTT_MARKS];
    ty_vec2 plain[TY_GRAY_SCOTT_MARKS]; // u, v of the plain state; v 0: there is none
    float level;                        // of v: a front
    double steps;                       // of a frame
    uint8_t* closed;                    // [height][width], FILL_OUTSIDE and FILL_BARRIER
    float *trail, *before;              // [height][width]; frame of the first time, v at the frame before; or NULL
    float* v;                           // [height][width], what fill_take_v took
    float* distance;                    // [height][width], cells from the front at this frame; NULL: nobody asks
    float *cover, *near_x, *near_y;     // [height][width], for whoever works
    uint8_t *layers, *mixed;            // [height][width], what a frame shows of marks and closed cells
    float* noise;                       // [height][width], -1..1: the recipe's variation; NULL without
    float trail_threshold;
    bool varies; // feed differs within a mark
    bool quiet;  // set before init: warnings come another time
    fill_outputs outputs;
    ty_plane_file region, over;
    ty_plane_file* events;                                // by event; path NULL = no image
    ty_plane_file images[TY_GRAY_SCOTT_MARKS][2];         // image and beneath
    ty_planes still_over, stills[TY_GRAY_SCOTT_MARKS][2]; // of files that are no sequences
    char (*keys)[FILL_KEY];                               // what the files' messages begin with
    ty_color* color;                                      // where images are
} fill_run;

// fill_setup.c
// TY_BAD_INPUT names what is wrong; afterwards the run is as before its first step. run is zeroed before; term on
// failure too.
TY_CHECKED ty_status fill_run_init(fill_run* run, const ty_fill_recipe* recipe, ty_workers* workers, ty_error* error);
void fill_run_term(fill_run* run);
// fill_marks.c
// Marks, their rates and plain states, and the level of the front, from the recipe.
void fill_marks_take(fill_run* run);
TY_CHECKED ty_status fill_marks_check(const fill_run* run, ty_error* error);
// Number of the mark; -1 and an error that begins with key.
int fill_mark_find(const fill_run* run, const char* name, const char* key, ty_error* error);
// The feed of each cell, after marks have changed.
TY_CHECKED ty_status fill_vary(const fill_run* run, ty_error* error);
// The noise of the recipe's variation, -1..1, into run->noise.
void fill_noise(fill_run* run);

// fill_files.c
TY_CHECKED ty_status fill_files_open(fill_run* run, ty_error* error);
// A mask by cells, 0..1: the mean where it has the pixels of a frame. The caller frees it.
TY_CHECKED ty_status fill_mask_read(const fill_run* run, const ty_plane_file* file, int channel, int frame, float** out,
                                    ty_error* error);

// fill_shape.c: how much of each cell an event covers at a frame, into run->cover.
TY_CHECKED ty_status fill_shape_cover(const fill_run* run, int event, int frame, ty_error* error);

// fill_events.c: region and events of that frame.
TY_CHECKED ty_status fill_frame_events(fill_run* run, int frame, ty_error* error);
// Whether events name marks, shapes and frames that there are.
TY_CHECKED ty_status fill_events_check(const fill_run* run, ty_error* error);

// fill_close.c: steps of a frame, solved where a hole says in how many frames it closes.
TY_CHECKED ty_status fill_solve_steps(fill_run* run, ty_error* error);

// fill_distance.c
// Nearest points by sweeps (Danielsson 1980), within a fraction of a cell: near_x and near_y hold the point of a cell
// or NaN before, the nearest of all points after (beyond wrapped edges where it lies there), NaN without any.
void fill_nearest(const fill_run* run);
// Signed distance from where v crosses the level, cells, positive where v is lower; far without a front. From run->v
// into run->distance by near_x and near_y, where anybody asks.
void fill_distance(const fill_run* run);
// v of the field into run->v; in closed cells, two deep, what is next to them, so that no edge of theirs shows.
void fill_take_v(const fill_run* run);

// fill_auto.c: marks that follow the pattern and count for feed and kill, after fill_take_v and fill_distance.
bool fill_needs_distance(const fill_run* run);
TY_CHECKED ty_status fill_auto_mark(fill_run* run, ty_error* error);

// fill_show.c: the frame as an image, whose owner the caller is.
TY_CHECKED ty_status fill_show(const fill_run* run, int frame, float drift, ty_exr** out, ty_error* error);

// fill_state.c: all that is needed to go on after a frame.
ty_exr* fill_state_save(const fill_run* run, int frame);
TY_CHECKED ty_status fill_state_load(fill_run* run, const ty_bytes* state, int* frame, ty_error* error);

// A number of the recipe that is 0 where another is meant.
static inline float fill_or(float value, float otherwise)
{
    return value > 0.0f ? value : otherwise;
}
static inline size_t fill_cell(const fill_run* run, int x, int y)
{
    return (size_t)y * (size_t)run->width + (size_t)x;
}
static inline int fill_event_end(const ty_fill_event* e)
{
    return e->until > e->at ? e->until : e->at;
}
// The kill up to which there is a plain state.
static inline float fill_plain_limit(ty_gray_scott_rates rates)
{
    return 0.5f * sqrtf(rates.feed) - rates.feed;
}
// Of a cell's byte.
static inline uint8_t fill_mark_of(uint8_t cell)
{
    return cell & (TY_GRAY_SCOTT_MARKS - 1);
}
static inline size_t fill_cells(const fill_run* run)
{
    return (size_t)run->width * (size_t)run->height;
}
