// SPDX-License-Identifier: Apache-2.0
// A frame of a fill while it is painted: planes of the frame's size, and what each layer looks like.
#pragma once
#include "cubic.h"
#include "fill_run.h"

typedef struct fill_show_state
{
    const fill_run* run;
    int frame, width, height; // of the frame, pixels
    float drift;              // cells
    cubic_axis across, down;
    int* cell_x;                  // by pixel: the cell that holds its middle
    const float *v, *distance;    // [height][width], NULL where nobody asks
    float *u_out, *v_out, *d_out; // what is made of them; NULL: nobody asks, or they are the cells'
    int *auto_marks, *auto_over;  // by rule; over -1: all
    bool rules_cover;             // a rule asks for coverage
    const ty_planes* over;        // NULL: nothing
    const ty_planes* images[TY_GRAY_SCOTT_MARKS][2];
    ty_planes read[TY_GRAY_SCOTT_MARKS][2], read_over; // of sequences, for this frame
    float* color[3];                                   // channels of the frame; the second and third NULL for Y
    float* alpha;                                      // NULL: opaque
    float *mark, *trail, *mattes[FILL_LAYERS];
} fill_show_state;

// fill_paint.c: all pixels of the frame. False: interrupted.
bool fill_paint(fill_show_state* show);

// fill_matte.c: layers by cell into run->layers, and whether there are others within two cells into run->mixed.
void fill_layers_take(const fill_run* run);
// How much of pixel (x, y) each layer has: they add up to 1. coverage: of its row, where a rule asks for it.
void fill_matte(const fill_show_state* show, int x, int y, const float* coverage, float matte[FILL_LAYERS]);
// Whether a rule takes some of the pixel.
bool fill_is_ruled(const fill_show_state* show, int x, int y, const float* coverage);
// Of a row: 0 below the level, 1 above it, the share of the pixel between.
void fill_coverage_row(const fill_show_state* show, int y, float* restrict out);
