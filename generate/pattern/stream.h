// SPDX-License-Identifier: Apache-2.0
// Many steps of a local rule in one pass over memory. The rule makes a row of the next moment from three rows of this
// one; rows stream through `depth` moments, of which each keeps the few rows that the next one needs (wavefronts of
// rows: temporal blocking after Nguyen et al. 2010). Every cell is computed by the rule from the same neighbours as in
// plain stepping: the same bits for any depth, strip, number of bands and workers.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <tsuya/base/workers.h>

enum
{
    STREAM_PLANES = 4,  // the most of one field
    STREAM_MARGIN = 16, // cells left and right of a row of a plane
    STREAM_GROUP = 16,  // cells: where `begin` of a row may lie
    STREAM_DEPTH = 64   // the most
};

// Of every plane three rows of this moment and the row to make. Indexed by x of the field.
typedef struct stream_rows
{
    const float* above[STREAM_PLANES];
    const float* at[STREAM_PLANES];
    const float* below[STREAM_PLANES];
    float* out[STREAM_PLANES];
} stream_rows;

// Makes the cells [begin, end) of row y, 0..height - 1, and writes no others. begin is a multiple of STREAM_GROUP, end
// is one or the width; pointers need not be aligned. In the rows that are read, begin - 1 and end hold the neighbours
// (beyond an edge that does not wrap: copies of the cells at it, as the rows above the first and below the last are
// copies of those). Of whole groups STREAM_GROUP cells more may be read on either side; their values mean nothing.
// Cells may be made more than once, on several threads: the rule depends on nothing but what it is given, the place and
// what does not change during the pass.
typedef void stream_row_fn(const void* context, const stream_rows* rows, int y, int begin, int end);

typedef struct stream
{
    int width, height;           // cells, at least 1
    bool wrap_x, wrap_y;         // the far side is the neighbour
    int plane_count;             // 1..STREAM_PLANES
    size_t stride;               // of a row, floats: stream_stride(width) or more
    float* front[STREAM_PLANES]; // [height][stride], cell (0, 0) at STREAM_MARGIN: the moment that is
    float* back[STREAM_PLANES];  // the same for the moment to come; swapped after a pass
    stream_row_fn* row;
    const void* context;
    bool whole; // all steps are done, cancelled or not: for few at a time
    int depth, strip,
        bands;      // of a pass: steps, cells across, parts of the height; 0: chosen. For measurements and tests
    float* scratch; // the stream's own
    size_t scratch_size;
} stream;

static inline size_t stream_stride(int width)
{
    size_t groups = ((size_t)width + STREAM_GROUP - 1) / STREAM_GROUP;
    return groups * STREAM_GROUP + 2 * STREAM_MARGIN;
}

// The cell (x, 0) of row y in a plane.
static inline size_t stream_cell(const stream* s, int y)
{
    return (size_t)y * s->stride + STREAM_MARGIN;
}

// Takes the field step_count steps on; the outcome is in front. Cells of front may have been set from outside before.
// Flush-to-zero is set on every thread while it works. False when cancelled: the values are of no use then.
bool stream_steps(stream* s, int step_count, ty_workers* workers);

// Frees what the stream keeps for itself. The planes are the caller's.
void stream_release(stream* s);
