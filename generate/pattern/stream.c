// SPDX-License-Identifier: Apache-2.0
// Row streaming: a tile (a strip of a band) goes down its rows once, a block of rows a tick; level n, the n-th moment,
// lags a row behind level n - 1, whose rows lie in a ring of few. Tiles make what they need of their neighbours' cells
// themselves, so that none waits for another.
#include "stream.h"
#include <tsuya/base/memory.h>
#include <unistd.h>

enum
{
    BLOCK = 2,            // rows a level makes at a tick, one after the other
    RING = BLOCK + 2,     // rows kept of a level: a power of two
    DEPTH_LEAST = 16,     // steps of a pass
    DEPTH_MOST = 24,      // deeper ones make more rows twice
    STRIP_LEAST = 256,    // cells: of narrower strips the beginnings of rows count
    TASK_CELLS = 1 << 17, // cell steps that are worth a thread
    PIECES = 2 + 2 * ((STREAM_DEPTH + STREAM_GROUP - 1) / STREAM_GROUP),
    SLACK = 2 * STREAM_GROUP + 16 // cells of a ring's row beside those of its tile and what that needs
};

typedef struct pass
{
    const stream* s;
    int depth, strip, strips, bands;
    int slack; // cells of a ring's row left and right of the tile's: rows keep to cache lines
    size_t ring_stride, row_size, worker_size; // floats: of a plane's row, of all planes', of all levels
} pass;

// Cells [begin, end) of a row, which a ring holds `shift` to the right of their place: those over the edge lie beyond
// it.
typedef struct piece
{
    int begin, end, shift;
} piece;

// What a tile makes at a level: less from level to level.
typedef struct level_plan
{
    int first, last; // rows
    int piece_count;
    piece pieces[PIECES];
} level_plan;

typedef struct tile
{
    const pass* p;
    int x0, x1, y0, y1; // what it is to make
    float* ring;        // [depth - 1][RING][plane][ring_stride]
    level_plan levels[STREAM_DEPTH + 1];
} tile;

// --- where rows lie ---

// The row of the field that row y of the plane over all repetitions is.
static inline int row_of(const stream* s, int y)
{
    if (!s->wrap_y)
        return y < 0 ? 0 : y >= s->height ? s->height - 1 : y;
    while (y < 0)
        y += s->height;
    while (y >= s->height)
        y -= s->height;
    return y;
}

// Row y of the first plane in a level's ring: where x = 0 would lie. The next plane is a ring_stride away.
static inline float* ring_row(const tile* t, int level, int y)
{
    const pass* p = t->p;
    size_t row = (size_t)(level - 1) * RING + ((unsigned)y & (RING - 1));
    return t->ring + row * p->row_size + p->slack - t->x0;
}

// --- columns ---

// The part of [lo, hi) that lies in the copy of the field `turn` widths to the right.
static void piece_add(level_plan* plan, int width, int lo, int hi, int turn)
{
    int shift = turn * width, begin = lo - shift, end = hi - shift;
    begin = begin < 0 ? 0 : begin / STREAM_GROUP * STREAM_GROUP;
    end = (end + STREAM_GROUP - 1) / STREAM_GROUP * STREAM_GROUP;
    end = end > width ? width : end;
    if (begin < end)
        plan->pieces[plan->piece_count++] = (piece){begin, end, shift};
}

static level_plan level_make(const tile* t, int level)
{
    const stream* s = t->p->s;
    int rest = t->p->depth - level, w = s->width, lo = t->x0 - rest, hi = t->x1 + rest;
    level_plan plan = {.first = t->y0 - rest, .last = t->y1 + rest};
    if (!s->wrap_y)
    {
        plan.first = plan.first < 0 ? 0 : plan.first;
        plan.last = plan.last > s->height ? s->height : plan.last;
    }
    if (!s->wrap_x || t->p->strips == 1)
        piece_add(&plan, w, lo < 0 ? 0 : lo, hi > w ? w : hi, 0);
    else
        for (int turn = lo < 0 ? -((w - 1 - lo) / w) : 0; turn * w < hi; turn++)
            piece_add(&plan, w, lo, hi, turn);
    return plan;
}

// Beside a ring's row, where a row ends at the field's edge and does not go on beyond it.
static inline void edges_copy(const stream* s, const piece* made, bool whole, float* row)
{
    int w = s->width;
    if (s->wrap_x && !whole)
        return;
    if (made->begin == 0)
        row[-1] = row[s->wrap_x ? w - 1 : 0];
    if (made->end == w)
        row[w] = row[s->wrap_x ? 0 : w - 1];
}

// Beside a row of a plane: each is written by one tile.
static inline void edges_finish(const tile* t, float* row)
{
    const stream* s = t->p->s;
    int w = s->width;
    if (t->x0 == 0)
        row[s->wrap_x ? w : -1] = row[0];
    if (t->x1 == w)
        row[s->wrap_x ? -1 : w] = row[w - 1];
}

// --- rows ---

// From the planes: of the moment that is.
static void rows_from_planes(const stream* s, int y, stream_rows* rows)
{
    size_t above = stream_cell(s, row_of(s, y - 1)), at = stream_cell(s, row_of(s, y)),
           below = stream_cell(s, row_of(s, y + 1));
    for (int i = 0; i < s->plane_count; i++)
    {
        rows->above[i] = s->front[i] + above;
        rows->at[i] = s->front[i] + at;
        rows->below[i] = s->front[i] + below;
    }
}

static void rows_from_ring(const tile* t, int level, int y, int shift, stream_rows* rows)
{
    const stream* s = t->p->s;
    size_t step = t->p->ring_stride;
    bool top = !s->wrap_y && y == 0, bottom = !s->wrap_y && y == s->height - 1;
    const float *above = ring_row(t, level, top ? y : y - 1) + shift, *at = ring_row(t, level, y) + shift;
    const float* below = ring_row(t, level, bottom ? y : y + 1) + shift;
    for (int i = 0; i < s->plane_count; i++, above += step, at += step, below += step)
    {
        rows->above[i] = above;
        rows->at[i] = at;
        rows->below[i] = below;
    }
}

static void row_make(const tile* t, int level, int y)
{
    const pass* p = t->p;
    const stream* s = p->s;
    const level_plan* plan = &t->levels[level];
    bool done = level == p->depth;
    for (int k = 0; k < plan->piece_count; k++)
    {
        const piece* at = &plan->pieces[k];
        stream_rows rows;
        if (level == 1) // planes are whole, rings go on beyond the edge
            rows_from_planes(s, y, &rows);
        else
            rows_from_ring(t, level - 1, y, at->shift, &rows);
        for (int i = 0; i < s->plane_count; i++)
            rows.out[i] =
                done ? s->back[i] + stream_cell(s, y) : ring_row(t, level, y) + (size_t)i * p->ring_stride + at->shift;
        s->row(s->context, &rows, row_of(s, y), at->begin, at->end);
        for (int i = 0; i < s->plane_count; i++)
            if (done)
                edges_finish(t, rows.out[i]);
            else
                edges_copy(s, at, p->strips == 1, rows.out[i]);
    }
}

static void tile_make(tile* t)
{
    int depth = t->p->depth;
    for (int level = 1; level <= depth; level++)
        t->levels[level] = level_make(t, level);
    for (int head = t->y0 - (depth - 1); head - (depth - 1) < t->y1; head += BLOCK)
        for (int level = 1; level <= depth; level++)
        {
            const level_plan* plan = &t->levels[level];
            int y = head - (level - 1), stop = y + BLOCK;
            y = y > plan->first ? y : plan->first;
            for (stop = stop < plan->last ? stop : plan->last; y < stop; y++)
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
        tile t = {
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

// Of a core's second cache the half that rings may take, bytes.
static size_t ring_budget(void)
{
    long size = sysconf(_SC_LEVEL2_CACHE_SIZE);
    return size > 0 ? (size_t)size / 2 : (size_t)1 << 19;
}

static int at_least(int a, int b)
{
    return a > b ? a : b;
}

static int at_most(int a, int b)
{
    return a < b ? a : b;
}

static int strip_choose(const stream* s, size_t budget)
{
    size_t column = (size_t)DEPTH_LEAST * RING * (size_t)s->plane_count * sizeof(float);
    int most = at_least((int)at_most((int)(budget / column), 1 << 15), STRIP_LEAST);
    int strips = (s->width + most - 1) / most;
    return (s->width + strips - 1) / strips;
}

static int depth_choose(const stream* s, int across, size_t budget)
{
    size_t level = (size_t)RING * (size_t)s->plane_count * sizeof(float) * (size_t)across;
    int depth = at_most(at_least((int)(budget / level), DEPTH_LEAST), DEPTH_MOST);
    return at_least(at_most(depth, s->height / 2), 1); // of low fields rows made twice would outweigh it
}

static pass pass_plan(const stream* s, int steps, int workers)
{
    size_t budget = ring_budget();
    pass p = {.s = s, .strip = s->strip ? s->strip : strip_choose(s, budget)};
    p.strip = (p.strip + STREAM_GROUP - 1) / STREAM_GROUP * STREAM_GROUP;
    p.strips = (s->width + p.strip - 1) / p.strip;
    int most = at_most(s->depth ? s->depth : depth_choose(s, p.strip, budget), STREAM_DEPTH);
    int passes = (steps + most - 1) / most;
    p.depth = (steps + passes - 1) / passes; // all about equally deep
    p.bands = (int64_t)s->width * s->height * p.depth < TASK_CELLS ? 1 : workers;
    p.bands = at_most(s->bands ? s->bands : p.bands, s->height);
    p.slack = (p.depth + STREAM_GROUP - 1) / STREAM_GROUP * STREAM_GROUP + SLACK;
    p.ring_stride = (size_t)p.strip + 2 * (size_t)p.slack;
    p.row_size = (size_t)s->plane_count * p.ring_stride;
    p.worker_size = (size_t)p.depth * RING * p.row_size;
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
    const piece all = {0, s->width, 0};
    int crew = workers ? ty_workers_count(workers) : 1;
    for (int y = 0; y < s->height; y++)
        for (int i = 0; i < s->plane_count; i++)
        {
            float* row = s->front[i] + stream_cell(s, y);
            edges_copy(s, &all, true, row);
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
