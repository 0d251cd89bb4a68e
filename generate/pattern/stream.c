// SPDX-License-Identifier: Apache-2.0
// Row streaming: a tile (a strip of a band) goes down its rows once, a block of rows a tick; level n, the n-th moment,
// lags a row behind level n - 1, whose rows lie in a ring of few. Tiles make what they need of their neighbours' cells
// themselves, so that none waits for another.
#include "stream.h"
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>

enum
{
    BLOCK = 2,                     // rows a level makes at a tick, one after the other
    RING = BLOCK + 2,              // rows kept of a level: a power of two
    DEPTH = 16,                    // steps of a pass: two rings of 1024 cells' width in the second cache
    STRIP = 1024,                  // cells: wider fields are cut
    TASK_CELLS = 1 << 17,          // cell steps that are worth a thread
    SLACK = 2 * STREAM_GROUP + 16, // cells of a ring's row beside those of its tile and what that needs
};

typedef struct pass
{
    const stream* s;
    int depth, strip, strips, bands;
    size_t ring_stride, worker_size; // floats
} pass;

typedef struct tile
{
    const pass* p;
    int x0, x1, y0, y1; // what it is to make
    float* ring;        // [depth - 1][RING][plane][ring_stride]
} tile;

static int modulo(int i, int n)
{
    int r = i % n;
    return r < 0 ? r + n : r;
}

// The row of the field that row y of the plane over all repetitions is.
static int row_of(const stream* s, int y)
{
    return s->wrap_y ? modulo(y, s->height) : y < 0 ? 0 : y >= s->height ? s->height - 1 : y;
}

// Row y of plane i at a level below depth: where x = 0 would lie.
static float* level_row(const tile* t, int level, int y, int i)
{
    const pass* p = t->p;
    const stream* s = p->s;
    if (level == 0)
        return s->front[i] + stream_cell(s, row_of(s, y));
    if (!s->wrap_y)
        y = row_of(s, y);
    size_t row = ((size_t)(level - 1) * RING + ((unsigned)y & (RING - 1))) * (size_t)s->plane_count + (size_t)i;
    return t->ring + row * p->ring_stride + (p->depth + SLACK) - t->x0;
}

// Cells beside the field's first and last, where [lo, hi) is what was made. With a wrap that is in several strips they
// are made like others.
static void edges_copy(const stream* s, float* row, int lo, int hi)
{
    int w = s->width;
    bool first = lo <= 0, last = hi >= w;
    if (!s->wrap_x && first)
        row[-1] = row[0];
    if (!s->wrap_x && last)
        row[w] = row[w - 1];
    if (s->wrap_x && first && last)
    {
        row[-1] = row[w - 1];
        row[w] = row[0];
    }
}

// The finished row's: each of them is written by one tile.
static void edges_finish(const tile* t, float* row)
{
    const stream* s = t->p->s;
    int w = s->width;
    if (t->x0 == 0)
        row[s->wrap_x ? w : -1] = row[0];
    if (t->x1 == w)
        row[s->wrap_x ? -1 : w] = row[w - 1];
}

// The part of [lo, hi) that lies in the copy of the field `turn` widths to the right.
static void piece_make(const tile* t, int level, int y, int lo, int hi, int turn)
{
    const stream* s = t->p->s;
    int shift = turn * s->width, begin = lo - shift, end = hi - shift;
    begin = begin < 0 ? 0 : begin / STREAM_GROUP * STREAM_GROUP;
    end = end > s->width ? s->width : (end + STREAM_GROUP - 1) / STREAM_GROUP * STREAM_GROUP;
    end = end > s->width ? s->width : end;
    if (begin >= end)
        return;
    stream_rows rows;
    int in = level == 1 ? 0 : shift; // planes are whole, rings go on beyond the edge
    for (int i = 0; i < s->plane_count; i++)
    {
        rows.above[i] = level_row(t, level - 1, y - 1, i) + in;
        rows.at[i] = level_row(t, level - 1, y, i) + in;
        rows.below[i] = level_row(t, level - 1, y + 1, i) + in;
        rows.out[i] = level == t->p->depth ? s->back[i] + stream_cell(s, y) : level_row(t, level, y, i) + shift;
    }
    s->row(s->context, &rows, row_of(s, y), begin, end);
}

static void row_make(const tile* t, int level, int y)
{
    const stream* s = t->p->s;
    int rest = t->p->depth - level, lo = t->x0, hi = t->x1;
    bool whole = t->p->strips == 1;
    if (!whole)
    {
        lo -= rest;
        hi += rest;
    }
    if (!s->wrap_x || whole)
    {
        lo = lo < 0 ? 0 : lo;
        hi = hi > s->width ? s->width : hi;
        piece_make(t, level, y, lo, hi, 0);
    }
    else
        for (int turn = -((s->width - 1 - lo) / s->width); turn * s->width < hi; turn++)
            piece_make(t, level, y, lo, hi, turn);
    for (int i = 0; i < s->plane_count; i++)
        if (rest == 0)
            edges_finish(t, s->back[i] + stream_cell(s, y));
        else if (!s->wrap_x || whole)
            edges_copy(s, level_row(t, level, y, i), lo, hi);
}

static void tile_make(const tile* t)
{
    const stream* s = t->p->s;
    int depth = t->p->depth;
    for (int head = t->y0 - (depth - 1); head - (depth - 1) < t->y1; head += BLOCK)
        for (int level = 1; level <= depth; level++)
        {
            int rest = depth - level, first = t->y0 - rest, last = t->y1 + rest; // rows that are needed
            if (!s->wrap_y)
            {
                first = first < 0 ? 0 : first;
                last = last > s->height ? s->height : last;
            }
            for (int y = head - (level - 1); y < head - (level - 1) + BLOCK; y++)
                if (y >= first && y < last)
                    row_make(t, level, y);
        }
}

static void tiles_make(void* context, int64_t begin, int64_t end, int worker)
{
    const pass* p = context;
    const stream* s = p->s;
    for (int64_t i = begin; i < end; i++)
    {
        int strip = (int)(i % p->strips), band = (int)(i / p->strips);
        int x0 = strip * p->strip, x1 = x0 + p->strip;
        const tile t = {
            .p = p,
            .x0 = x0,
            .x1 = x1 < s->width ? x1 : s->width,
            .y0 = (int)((int64_t)s->height * band / p->bands),
            .y1 = (int)((int64_t)s->height * (band + 1) / p->bands),
            .ring = s->scratch + (size_t)worker * p->worker_size,
        };
        tile_make(&t);
    }
}

static pass pass_plan(const stream* s, int steps, int workers)
{
    pass p = {.s = s};
    int most = s->depth ? s->depth : DEPTH;
    if (!s->depth && most > s->height / 2)
        most = s->height > 2 ? s->height / 2 : 1; // rows made twice would outweigh it
    most = most > STREAM_DEPTH ? STREAM_DEPTH : most;
    int passes = (steps + most - 1) / most;
    p.depth = (steps + passes - 1) / passes; // all about equally deep
    int strips = (s->width + STRIP - 1) / STRIP;
    int strip = s->strip ? s->strip : (s->width + strips - 1) / strips;
    p.strip = (strip + STREAM_GROUP - 1) / STREAM_GROUP * STREAM_GROUP;
    p.strips = (s->width + p.strip - 1) / p.strip;
    int64_t cells = (int64_t)s->width * s->height * p.depth;
    p.bands = cells < TASK_CELLS ? 1 : workers;
    if (s->bands)
        p.bands = s->bands;
    p.bands = p.bands > s->height ? s->height : p.bands;
    int across = p.strips == 1 ? s->width : p.strip;
    p.ring_stride = (size_t)(across + 2 * (p.depth + SLACK));
    p.worker_size = (size_t)p.depth * RING * (size_t)s->plane_count * p.ring_stride;
    return p;
}

static void scratch_reserve(stream* s, size_t size)
{
    if (size <= s->scratch_size)
        return;
    ty_free(s->scratch);
    s->scratch = TY_ALLOC(float, size);
    s->scratch_size = size;
}

bool stream_steps(stream* s, int step_count, ty_workers* workers)
{
    int crew = workers ? ty_workers_count(workers) : 1;
    for (int y = 0; y < s->height; y++)
        for (int i = 0; i < s->plane_count; i++)
        {
            float* row = s->front[i] + stream_cell(s, y);
            edges_copy(s, row, 0, s->width);
        }
    while (step_count > 0)
    {
        pass p = pass_plan(s, step_count, crew);
        scratch_reserve(s, p.worker_size * (size_t)crew);
        int64_t tiles = (int64_t)p.strips * p.bands;
        if (s->whole)
            ty_parallel_all(workers, tiles, 1, tiles_make, &p);
        else if (!ty_parallel_for(workers, tiles, 1, tiles_make, &p))
            return false;
        for (int i = 0; i < s->plane_count; i++)
        {
            float* done = s->back[i];
            s->back[i] = s->front[i];
            s->front[i] = done;
        }
        step_count -= p.depth;
    }
    return true;
}

void stream_release(stream* s)
{
    ty_free(s->scratch);
    s->scratch = NULL;
    s->scratch_size = 0;
}
