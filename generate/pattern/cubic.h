// SPDX-License-Identifier: Apache-2.0
// From cells to finer pixels: the cubic through the four neighbours along both axes (Catmull & Rom 1974).
#pragma once
#include <stdbool.h>

enum
{
    CUBIC_PAD = 3 // cells beyond each end of a line
};

typedef struct cubic_axis
{
    int cells, pixels;
    bool wraps, whole;        // whole: each pixel is a cell
    int* first;               // by pixel: the first of its four cells, counted from CUBIC_PAD before cell 0
    float *w0, *w1, *w2, *w3; // by pixel: the weights of the four
} cubic_axis;

// Of scale pixels a cell, shift cells on. False: there is no memory. Term on failure too.
bool cubic_axis_init(cubic_axis* axis, int cells, int scale, float shift, bool wraps);
void cubic_axis_term(cubic_axis* axis); // zeroed ones are allowed

// Row y of down's pixels, across's of them, from plane: [down cells][across cells]. line: room for the cells and two
// pads.
void cubic_row(const cubic_axis* across, const cubic_axis* down, const float* plane, int y, float* restrict line,
               float* restrict out);

static inline int cubic_neighbour(int i, int n, bool wrap)
{
    if (wrap)
        return (i % n + n) % n;
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}
