// SPDX-License-Identifier: Apache-2.0
// One row of one step, compiled once for each set of instructions: plain loops whose operations and their order are
// the same, so that their bits are.
#include "turing_state.h"
#include <math.h>
#include <string.h>

#define JOIN2(a, b) a##b
#define JOIN(a, b) JOIN2(a, b)

#if defined(__GNUC__) && !defined(__clang__) && defined(__AVX512F__)
#define WIDE __attribute__((target("prefer-vector-width=512")))
#else
#define WIDE
#endif

// Rows that are read and written never overlap.
#if defined(__clang__)
#pragma clang diagnostic ignored "-Wpass-failed" // with sanitizers it makes no vectors
#define SIDE_BY_SIDE _Pragma("clang loop vectorize(assume_safety)")
#else
#define SIDE_BY_SIDE _Pragma("GCC ivdep")
#endif

enum
{
    SEGMENT = 256 // cells whose weights are at hand at a time
};

// Rows above, here and below from the first cell to be made, with their neighbours; NULL where a plane is not needed.
typedef struct cells
{
    const float *u[3], *v[3], *open[3];
    const float *constant, *inverse, *weight, *pull_u, *pull_v, *along_cos, *along_sin;
    float *out_u, *out_v;
} cells;

// Left, right, up, down; left up, right up, left down, right down.
typedef struct weights
{
    float u[8][SEGMENT], v[4][SEGMENT];
} weights;

static inline float clamp(float x, float most)
{
    x = x > 0.0f ? x : 0.0f;
    return x < most ? x : most;
}

static inline float steep(float slope, float a)
{
    return 1.0f / (1.0f + slope * a);
}

WIDE static void row_plain(const ty_turing_rates* k, const cells* r, int width)
{
    const float *u = r->u[1], *uu = r->u[0], *ud = r->u[2], *c = r->constant;
    const float *v = r->v[1], *vu = r->v[0], *vd = r->v[2];
    float *out_u = r->out_u, *out_v = r->out_v;
    const ty_turing_rates q = *k;
    SIDE_BY_SIDE
    for (int x = 0; x < width; x++)
    {
        float a = u[x], b = v[x];
        float around_u = (u[x - 1] + u[x + 1]) + (uu[x] + ud[x]);
        float around_v = (v[x - 1] + v[x + 1]) + (vu[x] + vd[x]);
        float f = clamp((q.uu * a + q.uv * b) + c[x], q.u_most);
        float g = clamp((q.vu * a + q.vv * b) + q.v_constant, q.v_most);
        out_u[x] = (q.centre_u * a + f) + q.spread_u * around_u;
        out_v[x] = (q.centre_v * b + g) + q.spread_v * around_v;
    }
}

// The same as weighted_step with weights of 1, bit for bit.
WIDE static void row_open(const ty_turing_rates* k, const cells* r, int width)
{
    const float *u = r->u[1], *uu = r->u[0], *ud = r->u[2], *c = r->constant;
    const float *v = r->v[1], *vu = r->v[0], *vd = r->v[2];
    float *out_u = r->out_u, *out_v = r->out_v;
    const ty_turing_rates q = *k;
    SIDE_BY_SIDE
    for (int x = 0; x < width; x++)
    {
        float a = u[x], b = v[x];
        float flow_u = ((u[x - 1] - a) + (u[x + 1] - a)) + ((uu[x] - a) + (ud[x] - a));
        float flow_v = ((v[x - 1] - b) + (v[x + 1] - b)) + ((vu[x] - b) + (vd[x] - b));
        float f = clamp((q.uu * a + q.uv * b) + c[x], q.u_most);
        float g = clamp((q.vu * a + q.vv * b) + q.v_constant, q.v_most);
        out_u[x] = (q.keep_u * a + f) + q.spread_u * flow_u;
        out_v[x] = (q.keep_v * b + g) + q.spread_v * flow_v;
    }
}

// The same as weighted_step with the weights of weights_limit where all is open, bit for bit.
WIDE static void row_limited(const ty_turing_rates* k, const cells* r, int width)
{
    const float *u = r->u[1], *uu = r->u[0], *ud = r->u[2], *c = r->constant;
    const float *v = r->v[1], *vu = r->v[0], *vd = r->v[2];
    float *out_u = r->out_u, *out_v = r->out_v;
    const ty_turing_rates q = *k;
    const bool both = k->limit == TY_TURING_LIMIT_BOTH;
    SIDE_BY_SIDE
    for (int x = 0; x < width; x++)
    {
        float a = u[x], b = v[x], right = u[x + 1] - a, down = ud[x] - a;
        float s = steep(q.slope, sqrtf(right * right + down * down)), t = both ? s : 1.0f;
        float flow_u = (s * (u[x - 1] - a) + s * right) + (s * (uu[x] - a) + s * down);
        float flow_v = (t * (v[x - 1] - b) + t * (v[x + 1] - b)) + (t * (vu[x] - b) + t * (vd[x] - b));
        float f = clamp((q.uu * a + q.uv * b) + c[x], q.u_most);
        float g = clamp((q.vu * a + q.vv * b) + q.v_constant, q.v_most);
        out_u[x] = (q.keep_u * a + f) + q.spread_u * flow_u;
        out_v[x] = (q.keep_v * b + g) + q.spread_v * flow_v;
    }
}

// The share of each neighbour that comes through its side.
WIDE static void weights_open(const cells* r, bool corners, int x0, int n, weights* w)
{
    static const int row[8] = {1, 1, 0, 2, 0, 0, 2, 2}, step[8] = {-1, 1, 0, 0, -1, 1, -1, 1};
    for (int j = 0; j < (corners ? 8 : 4); j++)
    {
        float* out = w->u[j];
        if (!r->inverse)
        {
            SIDE_BY_SIDE
            for (int i = 0; i < n; i++)
                out[i] = 1.0f;
            continue;
        }
        const float *open = r->open[row[j]] + x0 + step[j], *inverse = r->inverse + x0;
        SIDE_BY_SIDE
        for (int i = 0; i < n; i++)
        {
            float share = open[i] * inverse[i];
            out[i] = share < 1.0f ? share : 1.0f;
        }
    }
    for (int j = 0; j < 4; j++)
        SIDE_BY_SIDE
    for (int i = 0; i < n; i++)
        w->v[j][i] = w->u[j][i];
}

// The tensor a, b; b, c by eight neighbours with no negative weight: a - |b| beside, c - |b| above and below, b or
// nothing along each diagonal (Weickert 1998, nonnegativity discretisation).
WIDE static void weights_along(const cells* r, int x0, int n, weights* w)
{
    const float *cosine = r->along_cos + x0, *sine = r->along_sin + x0;
    SIDE_BY_SIDE
    for (int i = 0; i < n; i++)
    {
        float b = sine[i], size = fabsf(b), falling = 0.5f * (size + b), rising = 0.5f * (size - b);
        float beside = (1.0f + cosine[i]) - size, over = (1.0f - cosine[i]) - size;
        w->u[0][i] *= beside;
        w->u[1][i] *= beside;
        w->u[2][i] *= over;
        w->u[3][i] *= over;
        w->u[4][i] *= falling; // rows go down
        w->u[5][i] *= rising;
        w->u[6][i] *= rising;
        w->u[7][i] *= falling;
    }
}

WIDE static void weights_limit_faces(const ty_turing_rates* k, const cells* r, int x0, int n, weights* w)
{
    static const int row[4] = {1, 1, 0, 2}, step[4] = {-1, 1, 0, 0};
    const float* u = r->u[1] + x0;
    for (int j = 0; j < 4; j++)
    {
        const float* next = r->u[row[j]] + x0 + step[j];
        SIDE_BY_SIDE
        for (int i = 0; i < n; i++)
        {
            float g = steep(k->slope, fabsf(next[i] - u[i]));
            w->u[j][i] *= g;
            w->v[j][i] *= k->limit == TY_TURING_LIMIT_BOTH ? g : 1.0f;
        }
    }
}

// |grad U| by the differences to the right and down, over open sides alone.
WIDE static void weights_limit(const ty_turing_rates* k, const cells* r, bool corners, int x0, int n, weights* w)
{
    const float *u = r->u[1] + x0, *down = r->u[2] + x0;
    float g[SEGMENT];
    SIDE_BY_SIDE
    for (int i = 0; i < n; i++)
    {
        float a = w->v[1][i] * (u[i + 1] - u[i]), b = w->v[3][i] * (down[i] - u[i]);
        g[i] = steep(k->slope, sqrtf(a * a + b * b));
    }
    for (int j = 0; j < (corners ? 8 : 4); j++)
        SIDE_BY_SIDE
    for (int i = 0; i < n; i++)
        w->u[j][i] *= g[i];
    for (int j = 0; j < (k->limit == TY_TURING_LIMIT_BOTH ? 4 : 0); j++)
        SIDE_BY_SIDE
    for (int i = 0; i < n; i++)
        w->v[j][i] *= g[i];
}

WIDE static void corners_add(const ty_turing_rates* k, const cells* r, int x0, int n, const weights* w)
{
    const float *u = r->u[1] + x0, *up = r->u[0] + x0, *down = r->u[2] + x0;
    float* out = r->out_u + x0;
    SIDE_BY_SIDE
    for (int i = 0; i < n; i++)
    {
        float above = w->u[4][i] * (up[i - 1] - u[i]) + w->u[5][i] * (up[i + 1] - u[i]);
        float below = w->u[6][i] * (down[i - 1] - u[i]) + w->u[7][i] * (down[i + 1] - u[i]);
        out[i] += k->spread_u * (above + below);
    }
}

WIDE static void weighted_step(const ty_turing_rates* k, const cells* r, int x0, int n, const weights* w)
{
    const float *u = r->u[1] + x0, *uu = r->u[0] + x0, *ud = r->u[2] + x0;
    const float *v = r->v[1] + x0, *vu = r->v[0] + x0, *vd = r->v[2] + x0;
    const float* c = r->constant + x0;
    float *out_u = r->out_u + x0, *out_v = r->out_v + x0;
    const ty_turing_rates q = *k;
    SIDE_BY_SIDE
    for (int i = 0; i < n; i++)
    {
        float a = u[i], b = v[i];
        float flow_u = (w->u[0][i] * (u[i - 1] - a) + w->u[1][i] * (u[i + 1] - a)) +
                       (w->u[2][i] * (uu[i] - a) + w->u[3][i] * (ud[i] - a));
        float flow_v = (w->v[0][i] * (v[i - 1] - b) + w->v[1][i] * (v[i + 1] - b)) +
                       (w->v[2][i] * (vu[i] - b) + w->v[3][i] * (vd[i] - b));
        float f = clamp((q.uu * a + q.uv * b) + c[i], q.u_most);
        float g = clamp((q.vu * a + q.vv * b) + q.v_constant, q.v_most);
        out_u[i] = (q.keep_u * a + f) + q.spread_u * flow_u;
        out_v[i] = (q.keep_v * b + g) + q.spread_v * flow_v;
    }
}

static void row_weighted(const ty_turing_rates* k, const cells* r, int width)
{
    bool corners = r->along_cos != NULL;
    weights w;
    for (int x0 = 0; x0 < width; x0 += SEGMENT)
    {
        int n = width - x0 < SEGMENT ? width - x0 : SEGMENT;
        weights_open(r, corners, x0, n, &w);
        if (corners)
            weights_along(r, x0, n, &w);
        if (k->limit != TY_TURING_LIMIT_NONE && k->conservative)
            weights_limit_faces(k, r, x0, n, &w);
        else if (k->limit != TY_TURING_LIMIT_NONE)
            weights_limit(k, r, corners, x0, n, &w);
        weighted_step(k, r, x0, n, &w);
        if (corners)
            corners_add(k, r, x0, n, &w);
    }
}

WIDE static void row_hold(const cells* r, int width)
{
    const float *weight = r->weight, *pull_u = r->pull_u, *pull_v = r->pull_v;
    float *out_u = r->out_u, *out_v = r->out_v;
    SIDE_BY_SIDE
    for (int x = 0; x < width; x++)
    {
        out_u[x] = weight[x] * out_u[x] + pull_u[x];
        out_v[x] = weight[x] * out_v[x] + pull_v[x];
    }
}

static const float* plane_at(const float* plane, size_t at)
{
    return plane ? plane + at : NULL;
}

static cells cells_at(const ty_turing* field, const stream_rows* rows, int y, int begin)
{
    size_t at = ty_turing_cell(field, y) + (size_t)begin, stride = field->stream.stride;
    const float* open = field->planes[TY_TURING_OPEN];
    return (cells){
        .u = {rows->above[0] + begin, rows->at[0] + begin, rows->below[0] + begin},
        .v = {rows->above[1] + begin, rows->at[1] + begin, rows->below[1] + begin},
        .open = {plane_at(open, at - stride), plane_at(open, at), plane_at(open, at + stride)},
        .constant = field->constant + at,
        .inverse = open ? field->inverse + at : NULL,
        .weight = plane_at(field->weight, at),
        .pull_u = plane_at(field->pull_u, at),
        .pull_v = plane_at(field->pull_v, at),
        .along_cos = plane_at(field->planes[TY_TURING_ALONG_COS], at),
        .along_sin = plane_at(field->planes[TY_TURING_ALONG_SIN], at),
        .out_u = rows->out[0] + begin,
        .out_v = rows->out[1] + begin,
    };
}

static void run_make(const ty_turing* field, const stream_rows* rows, int y, int begin, int end, int kind)
{
    cells c = cells_at(field, rows, y, begin);
    int n = end - begin;
    bool masked = c.inverse != NULL;
    if (kind == TY_TURING_STILL)
    {
        memcpy(c.out_u, c.pull_u, (size_t)n * sizeof *c.out_u);
        memcpy(c.out_v, c.pull_v, (size_t)n * sizeof *c.out_v);
        return;
    }
    if (kind == TY_TURING_EVEN)
        c.inverse = c.weight = NULL;
    if (c.inverse || c.along_cos || (field->rates.limit != TY_TURING_LIMIT_NONE && field->rates.conservative))
        row_weighted(&field->rates, &c, n);
    else if (field->rates.limit != TY_TURING_LIMIT_NONE)
        row_limited(&field->rates, &c, n);
    else if (masked)
        row_open(&field->rates, &c, n);
    else
        row_plain(&field->rates, &c, n);
    if (c.weight)
        row_hold(&c, n);
}

void JOIN(ty_turing_row_, KERNEL)(const void* context, const stream_rows* rows, int y, int begin, int end)
{
    const ty_turing* field = context;
    const uint8_t* kinds = field->kinds ? ty_turing_kinds(field, y) : NULL;
    for (int x = begin, stop; x < end; x = stop)
    {
        int kind = kinds ? kinds[x / STREAM_GROUP] : TY_TURING_MIXED;
        stop = kinds ? x + STREAM_GROUP : end;
        while (stop < end && kinds[stop / STREAM_GROUP] == kind)
            stop += STREAM_GROUP;
        stop = stop < end ? stop : end;
        run_make(field, rows, y, x, stop, kind);
    }
}
