// SPDX-License-Identifier: Apache-2.0
// A row of Gray–Scott. Included by one file an instruction set; GS_KERNEL names it. One loop serves all kinds of runs
// and both stencils: what a run does not need is gone when the compiler has folded `how`.
#include "gray_scott_field.h"
#include "gray_scott_lanes.h"
#include <string.h>

#define GS_INLINE static inline __attribute__((always_inline))

typedef struct how
{
    bool nine;     // points, else five
    bool marks;    // looked up, else the run's
    bool barriers; // what is behind one is as the cell itself
    bool vary;     // rates have planes
    bool scaled;   // the time step is not 1
} how;

// Where the row's pointers stand, and what every cell of it shares.
typedef struct row
{
    const float *above[2], *at[2], *below[2]; // u and v
    float* out[2];
    const uint8_t* marks; // of the row; rows above and below lie a stride away
    size_t marks_stride;
    const float *feed, *kill; // planes; NULL without
    const gs_rates* rates;
    uint8_t mark; // of the run
} row;

// What is closed around the cells.
typedef struct fences
{
    gs_flags at, up, down, left, right, up_left, up_right, down_left, down_right;
} fences;

typedef struct near_sums
{
    gs_lanes edges, corners;
} near_sums;

GS_INLINE fences fences_find(const how h, const row* r, int x)
{
    const uint8_t *at = r->marks + x, *up = at - r->marks_stride, *down = at + r->marks_stride;
    fences f = {.at = gs_closed(at),
                .up = gs_closed(up),
                .down = gs_closed(down),
                .left = gs_closed(at - 1),
                .right = gs_closed(at + 1)};
    if (h.nine) // a corner is closed too where both of its edges are
    {
        f.up_left = gs_or(gs_closed(up - 1), gs_and(f.up, f.left));
        f.up_right = gs_or(gs_closed(up + 1), gs_and(f.up, f.right));
        f.down_left = gs_or(gs_closed(down - 1), gs_and(f.down, f.left));
        f.down_right = gs_or(gs_closed(down + 1), gs_and(f.down, f.right));
    }
    return f;
}

GS_INLINE gs_lanes neighbour(const how h, gs_flags closed, const float* p, gs_lanes self)
{
    return h.barriers ? gs_select(closed, self, gs_load(p)) : gs_load(p);
}

// A plane's cells before those at x, at x and after, and the same of what lies above and below added up. A row is read
// once and shifted in registers: loads that cross cache lines are what the loop would wait for.
typedef struct window
{
    gs_lanes before, at, after;
    gs_lanes column_before, column_at, column_after;
} window;

GS_INLINE bool slides(const how h)
{
    return GS_SLIDES && !h.barriers;
}

GS_INLINE gs_lanes column(const row* r, int plane, int x)
{
    return gs_add(gs_load(r->above[plane] + x), gs_load(r->below[plane] + x));
}

GS_INLINE window window_begin(const row* r, int plane, int x)
{
    return (window){.at = gs_load(r->at[plane] + x - GS_LANES),
                    .after = gs_load(r->at[plane] + x),
                    .column_at = column(r, plane, x - GS_LANES),
                    .column_after = column(r, plane, x)};
}

GS_INLINE void window_move(const row* r, int plane, int x, window* w)
{
    w->before = w->at;
    w->at = w->after;
    w->after = gs_load(r->at[plane] + x + GS_LANES);
    w->column_before = w->column_at;
    w->column_at = w->column_after;
    w->column_after = column(r, plane, x + GS_LANES);
}

// edges: (up + down) + (left + right); corners: (left up + left down) + (right up + right down).
GS_INLINE near_sums sum_near(const how h, const row* r, const fences* f, const window* w, int plane, int x,
                             gs_lanes self)
{
    const float *up = r->above[plane] + x, *at = r->at[plane] + x, *down = r->below[plane] + x;
    if (slides(h))
        return (near_sums){gs_add(w->column_at, gs_add(gs_before(w->before, w->at), gs_after(w->at, w->after))),
                           gs_add(gs_before(w->column_before, w->column_at), gs_after(w->column_at, w->column_after))};
    near_sums s;
    s.edges = gs_add(gs_add(neighbour(h, f->up, up, self), neighbour(h, f->down, down, self)),
                     gs_add(neighbour(h, f->left, at - 1, self), neighbour(h, f->right, at + 1, self)));
    s.corners = s.edges;
    if (h.nine)
        s.corners =
            gs_add(gs_add(neighbour(h, f->up_left, up - 1, self), neighbour(h, f->down_left, down - 1, self)),
                   gs_add(neighbour(h, f->up_right, up + 1, self), neighbour(h, f->down_right, down + 1, self)));
    return s;
}

// Tables and constants of a run, in registers.
typedef struct constants
{
    gs_table keep_u, keep_v, feed, kill;
    gs_lanes run_keep_u, run_keep_v, run_feed;
    gs_lanes edge_u, edge_v, corner_u, corner_v, base_u, base_v, time_step;
} constants;

GS_INLINE constants constants_make(const row* r)
{
    const gs_rates* g = r->rates;
    return (constants){
        .keep_u = gs_table_load(g->keep_u),
        .keep_v = gs_table_load(g->keep_v),
        .feed = gs_table_load(g->feed),
        .kill = gs_table_load(g->kill),
        .run_keep_u = gs_set(g->keep_u[r->mark]),
        .run_keep_v = gs_set(g->keep_v[r->mark]),
        .run_feed = gs_set(g->feed[r->mark]),
        .edge_u = gs_set(g->edge_u),
        .edge_v = gs_set(g->edge_v),
        .corner_u = gs_set(g->corner_u),
        .corner_v = gs_set(g->corner_v),
        .base_u = gs_set(g->base_u),
        .base_v = gs_set(g->base_v),
        .time_step = gs_set(g->time_step),
    };
}

typedef struct cell_rates
{
    gs_lanes keep_u, keep_v, feed;
} cell_rates;

GS_INLINE cell_rates rates_find(const how h, const row* r, const constants* c, int x)
{
    if (!h.marks)
        return (cell_rates){c->run_keep_u, c->run_keep_v, c->run_feed};
    gs_index mark = gs_index_load(r->marks + x);
    gs_lanes feed = gs_look_up(c->feed, mark);
    if (!h.vary)
        return (cell_rates){gs_look_up(c->keep_u, mark), gs_look_up(c->keep_v, mark), feed};
    gs_lanes kill = gs_look_up(c->kill, mark);
    if (r->feed)
        feed = gs_add(feed, gs_load(r->feed + x));
    if (r->kill)
        kill = gs_add(kill, gs_load(r->kill + x));
    return (cell_rates){gs_sub(c->base_u, feed), gs_sub(c->base_v, gs_add(feed, kill)), feed};
}

// u' = ((keep_u u + near) + feed) - u v^2, v' = (keep_v v + near) + u v^2: the order is the same everywhere.
GS_INLINE void cells_step(const how h, const row* r, const constants* c, window windows[2], int x, float* out_u,
                          float* out_v)
{
    if (slides(h))
    {
        window_move(r, 0, x, &windows[0]);
        window_move(r, 1, x, &windows[1]);
    }
    gs_lanes u = gs_load(r->at[0] + x), v = gs_load(r->at[1] + x);
    fences f = {0};
    if (h.barriers)
        f = fences_find(h, r, x);
    cell_rates rate = rates_find(h, r, c, x);
    near_sums su = sum_near(h, r, &f, &windows[0], 0, x, u), sv = sum_near(h, r, &f, &windows[1], 1, x, v);
    gs_lanes near_u = gs_mul(c->edge_u, su.edges), near_v = gs_mul(c->edge_v, sv.edges);
    if (h.nine)
    {
        near_u = gs_add(near_u, gs_mul(c->corner_u, su.corners));
        near_v = gs_add(near_v, gs_mul(c->corner_v, sv.corners));
    }
    gs_lanes reaction = gs_mul(gs_mul(u, v), v);
    if (h.scaled)
        reaction = gs_mul(c->time_step, reaction);
    gs_lanes next_u = gs_sub(gs_add(gs_add(gs_mul(rate.keep_u, u), near_u), rate.feed), reaction);
    gs_lanes next_v = gs_add(gs_add(gs_mul(rate.keep_v, v), near_v), reaction);
    if (h.barriers)
    {
        next_u = gs_select(f.at, u, next_u);
        next_v = gs_select(f.at, v, next_v);
    }
    gs_store(out_u, next_u);
    gs_store(out_v, next_v);
}

// What the row needs some groups on: it lies in the second cache, and processors foresee no more than a page.
GS_INLINE void fetch_ahead(const row* r, int x)
{
    enum
    {
        AHEAD = 8 * STREAM_GROUP
    };
    for (int i = 0; i < 2; i++)
    {
        __builtin_prefetch(r->above[i] + x + AHEAD);
        __builtin_prefetch(r->at[i] + x + AHEAD);
        __builtin_prefetch(r->below[i] + x + AHEAD);
        __builtin_prefetch(r->out[i] + x + AHEAD, 1);
    }
}

GS_INLINE void run_step(const how h, const row* r, int begin, int end)
{
    const row own = *r; // in registers: what is stored might be the row itself for all that the compiler knows
    const constants c = constants_make(&own);
    float* restrict out_u = own.out[0], * restrict out_v = own.out[1];
    window windows[2] = {0};
    if (slides(h))
    {
        windows[0] = window_begin(&own, 0, begin);
        windows[1] = window_begin(&own, 1, begin);
    }
    int x = begin;
    for (; x + GS_LANES <= end; x += GS_LANES)
    {
        if ((int)GS_LANES == (int)STREAM_GROUP) // else it would be asked for more than once
            fetch_ahead(&own, x);
        cells_step(h, &own, &c, windows, x, out_u + x, out_v + x);
    }
    if (x < end)
    {
        float u[GS_LANES], v[GS_LANES];
        size_t size = (size_t)(end - x) * sizeof(float);
        cells_step(h, &own, &c, windows, x, u, v);
        memcpy(out_u + x, u, size);
        memcpy(out_v + x, v, size);
    }
}

GS_INLINE void runs_step(bool nine, bool scaled, const ty_gray_scott* field, row* r, int y, int begin, int end)
{
    const how even = {nine, false, false, false, scaled}, mixed = {nine, true, false, false, scaled};
    const how barriers = {nine, true, true, false, scaled};
    const how varied = {nine, true, false, true, scaled}, both = {nine, true, true, true, scaled};
    const uint16_t* runs = field->runs + (size_t)y * field->run_stride;
    for (int x = begin, stop; x < end; x = stop)
    {
        unsigned run = runs[x / STREAM_GROUP], kind = run % GS_RUN_LENGTH;
        stop = x + (int)(run / GS_RUN_LENGTH) * STREAM_GROUP;
        stop = stop < end ? stop : end;
        r->mark = (uint8_t)(kind % TY_GRAY_SCOTT_MARKS);
        if (kind < TY_GRAY_SCOTT_MARKS)
            run_step(even, r, x, stop);
        else if (kind == GS_RUN_MIXED)
            run_step(mixed, r, x, stop);
        else if (kind == GS_RUN_BARRIERS)
            run_step(barriers, r, x, stop);
        else if (kind == GS_RUN_VARIED)
            run_step(varied, r, x, stop);
        else
            run_step(both, r, x, stop);
    }
}

// In a context of its own each: twenty loops in one function leave no registers for any.
#define GS_RUNS(name, nine, scaled)                                                                                    \
    static __attribute__((noinline)) void name(const ty_gray_scott* field, row* r, int y, int begin, int end)          \
    {                                                                                                                  \
        runs_step(nine, scaled, field, r, y, begin, end);                                                              \
    }
GS_RUNS(runs_5, false, false)
GS_RUNS(runs_5_scaled, false, true)
GS_RUNS(runs_9, true, false)
GS_RUNS(runs_9_scaled, true, true)

void GS_KERNEL(const void* context, const stream_rows* rows, int y, int begin, int end)
{
    const ty_gray_scott* field = context;
    size_t at = gs_cell(field, y);
    row r = {
        .above = {rows->above[0], rows->above[1]},
        .at = {rows->at[0], rows->at[1]},
        .below = {rows->below[0], rows->below[1]},
        .out = {rows->out[0], rows->out[1]},
        .marks = field->marks + gs_cell(field, y + 1),
        .marks_stride = field->stream.stride,
        .feed = field->feed ? field->feed + at : NULL,
        .kill = field->kill ? field->kill + at : NULL,
        .rates = &field->rates,
    };
    bool nine = field->def.stencil == 9, scaled = field->def.time_step != 1.0f;
    (nine ? scaled ? runs_9_scaled : runs_9 : scaled ? runs_5_scaled : runs_5)(field, &r, y, begin, end);
}
