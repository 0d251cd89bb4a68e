// SPDX-License-Identifier: Apache-2.0
// How a sweep is shown: rows and columns, their words, and the pictures of cells.
#pragma once
#include "sweep.h"
#include <tsuya/image/image.h>

#define TY_SWEEP_LABEL_MAX 256

// Cells row by row. A grid has its last axis across and the others down; what has one value a cell (one axis, or --zip)
// flows, and every cell has its own words.
typedef struct ty_sweep_layout
{
    int rows, columns;
    bool grid;
} ty_sweep_layout;

ty_sweep_layout ty_sweep_layout_of(const ty_sweep* sweep);

// Names of what varies down and across, and values; "" where there is nothing to say.
void ty_sweep_row_title(const ty_sweep_job* job, const ty_sweep_layout* layout, char out[TY_SWEEP_LABEL_MAX]);
void ty_sweep_column_title(const ty_sweep_job* job, const ty_sweep_layout* layout, char out[TY_SWEEP_LABEL_MAX]);
void ty_sweep_row_label(const ty_sweep_job* job, const ty_sweep_layout* layout, int row, char out[TY_SWEEP_LABEL_MAX]);
void ty_sweep_column_label(const ty_sweep_job* job, const ty_sweep_layout* layout, int column,
                           char out[TY_SWEEP_LABEL_MAX]);
void ty_sweep_cell_label(const ty_sweep_job* job, int cell, char out[TY_SWEEP_LABEL_MAX]); // "moisture 0.2, vfov 20"
void ty_sweep_fixed(const ty_sweep_job* job, char out[TY_SWEEP_LABEL_MAX]); // overrides that are the same in all

// Red, green and blue of a cell's picture, scene-linear ACEScg. The caller frees out.
TY_CHECKED ty_status ty_sweep_picture(const ty_sweep_job* job, int cell, ty_image* out, ty_error* error);

// Sheet of all cells as EXR and PNG.
TY_CHECKED ty_status ty_sweep_sheet(const ty_sweep_job* job, const char* exr_path, const char* png_path,
                                    ty_error* error);
// The report of all cells as one HTML file.
TY_CHECKED ty_status ty_sweep_report(const ty_sweep_job* job, const char* path, ty_error* error);
