// SPDX-License-Identifier: Apache-2.0
// A frame of a fill while it is painted: planes of the frame's size, and what each layer looks like.
#pragma once
#include "fill_run.h"

typedef struct fill_show_state
{
    const fill_run* run;
    int frame, width, height;    // of the frame, pixels
    float drift;                 // cells
    float *u, *v, *distance;     // [height][width], NULL where nobody asks
    uint8_t* layers;             // by cell: the mark, or FILL_CLOSED
    bool* single;                // by cell: all layers within two cells are the same
    int *auto_marks, *auto_over; // by rule; over -1: all
    ty_planes images[TY_GRAY_SCOTT_MARKS][2], over;
    float* color[3]; // channels of the frame; the second and third NULL for Y
    float* alpha;    // NULL: opaque
    float *mark, *trail, *mattes[FILL_LAYERS];
} fill_show_state;

// fill_upsample.c: cubic (Catmull & Rom 1974), [run height][run width] to the frame's size.
bool fill_upsample(const fill_show_state* show, const float* cells, float* pixels);
// The cell that holds the middle of a pixel.
void fill_pixel_cell(const fill_show_state* show, int x, int y, int* cell_x, int* cell_y);

// fill_matte.c: how much of pixel (x, y) each layer has: they add up to 1.
void fill_matte(const fill_show_state* show, int x, int y, float matte[FILL_LAYERS]);
bool fill_is_single(const fill_show_state* show, int x, int y); // of the cell, for `single`
// 0 below the level, 1 above it, the share of the pixel between.
float fill_coverage(const fill_show_state* show, int x, int y);
