// SPDX-License-Identifier: Apache-2.0
// A Turing filter at work: the picture, what it steers, the fields, the frames.
#pragma once
#include "plane_file.h"
#include <tsuya/base/log.h>
#include <tsuya/generate/filter_recipe.h>

enum
{
    TY_FILTER_FIELDS = 3 // at most: one for each of red, green and blue
};

// Of the field's size, top row first.
typedef struct ty_filter_picture
{
    int width, height;
    float* rgb[3];                 // linear Rec. 709; NULL where colours do not matter
    float* tone[TY_FILTER_FIELDS]; // 0..1; the further ones NULL where there is one field
} ty_filter_picture;

typedef struct ty_filter_mask
{
    ty_plane_file file;
    char key[32]; // of messages
} ty_filter_mask;

typedef struct ty_filter_run
{
    const ty_filter_recipe* recipe;
    ty_workers* workers;
    ty_color* color;
    ty_plane_file image;
    ty_filter_mask* masks; // of the regions
    bool moves, sequence;  // the image is one; it is, or a mask
    int width, height, frame_count;
    ty_filter_picture picture; // of the frame
    float* alive;              // how much the pattern lives in each cell, 0..1; NULL = everywhere
    ty_turing* fields[TY_FILTER_FIELDS];
    int field_count;
    bool begun;                    // the fields hold a state of `frame`
    int frame;                     // that is made, or was last; 0 = none yet
    int64_t step;                  // of the reaction since it began, with the frame or before
    int64_t steps_done, steps_all; // for the progress
    ty_progress progress;
} ty_filter_run;

// filter_make.c: the step of its reaction that a frame shows.
int64_t ty_filter_steps(const ty_filter_run* run, int frame);

// filter_state.c: what a run goes on from, and into the run; the caller's.
ty_exr* ty_filter_state_save(const ty_filter_run* run);
TY_CHECKED ty_status ty_filter_state_load(ty_filter_run* run, const ty_bytes* bytes, ty_error* error);

// filter_picture.c: the image of a frame (from 1) at the field's size.
TY_CHECKED ty_status ty_filter_picture_read(const ty_filter_run* run, int frame, ty_filter_picture* out,
                                            ty_error* error);
void ty_filter_picture_term(ty_filter_picture* picture); // zeroed ones are allowed

// filter_guide.c: the masks of all frames are looked at, once the field has its size.
TY_CHECKED ty_status ty_filter_masks_open(ty_filter_run* run, ty_error* error);
// What masks and the picture set in the fields for a frame; into alive as well.
TY_CHECKED ty_status ty_filter_guide(ty_filter_run* run, int frame, ty_error* error);

// filter_blur.c: a Gaussian over [height][width], its rim repeated. scratch: of the same size.
void ty_filter_blur(float* plane, float* scratch, int width, int height, float sigma, ty_workers* workers);

// filter_frame.c: the frame that the fields show now. *out is the caller's.
TY_CHECKED ty_status ty_filter_frame(const ty_filter_run* run, ty_exr** out, ty_error* error);
