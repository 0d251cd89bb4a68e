// SPDX-License-Identifier: Apache-2.0
// The exact Euclidean distance transform of the nodes next to a surface (Felzenszwalb and Huttenlocher 2012).
#include "voxels_scan.h"

// The lower envelope of parabolas along one line of n nodes, stride apart: site[q] lies at squared distance height[q]
// from its own node across the line.
typedef struct envelope
{
    int* at;        // lowest parabola, [n]
    double* begin;  // where it begins to be lowest, [n + 1]
    double* height; // [n], < 0: no site
    int32_t* site;  // [n]
} envelope;

static void line_transform(const envelope* e, int32_t* site, size_t stride, int n)
{
    int top = -1;
    for (int q = 0; q < n; q++)
    {
        e->site[q] = site[(size_t)q * stride];
        if (e->height[q] < 0.0)
            continue;
        double from = -1e30;
        while (top >= 0)
        {
            int r = e->at[top];
            from = ((e->height[q] + (double)q * q) - (e->height[r] + (double)r * r)) / (2.0 * (q - r));
            if (from > e->begin[top])
                break;
            top--;
            from = -1e30;
        }
        e->at[++top] = q;
        e->begin[top] = from;
    }
    if (top < 0)
        return;
    e->begin[top + 1] = 1e30;
    for (int q = 0, t = 0; q < n; q++)
    {
        while (e->begin[t + 1] < (double)q)
            t++;
        site[(size_t)q * stride] = e->site[e->at[t]];
    }
}

// How far the site is from node (i, j, k) across the axis, squared: what earlier axes have found.
static double across(const ty_voxels* v, int32_t site, const int node[3], int axis)
{
    if (site < 0 || axis == 0)
        return site < 0 ? -1.0 : 0.0;
    int x = site % v->size[0], y = site / v->size[0] % v->size[1], z = site / v->size[0] / v->size[1];
    const int d[3] = {x - node[0], y - node[1], z - node[2]};
    double sum = 0.0;
    for (int i = 0; i < axis; i++)
        sum += (double)d[i] * d[i];
    return sum;
}

typedef struct transform
{
    voxels_scan* s;
    envelope* envelopes; // of each worker
    int axis, across;    // of the lines, and of those beside one another
} transform;

static void lines_run(void* context, int64_t begin, int64_t end, int worker)
{
    const transform* t = context;
    const ty_voxels* v = t->s->v;
    const envelope* e = &t->envelopes[worker];
    const size_t stride[3] = {1, (size_t)v->size[0], (size_t)v->size[0] * (size_t)v->size[1]};
    int axis = t->axis, b = t->across, c = 3 - axis - b, at[3];
    for (int64_t line = begin; line < end; line++)
    {
        at[axis] = 0;
        at[b] = (int)(line % v->size[b]);
        at[c] = (int)(line / v->size[b]);
        int32_t* first = t->s->site + voxels_index(v, at[0], at[1], at[2]);
        for (int q = 0; q < v->size[axis]; q++)
        {
            at[axis] = q;
            e->height[q] = across(v, first[(size_t)q * stride[axis]], at, axis);
        }
        line_transform(e, first, stride[axis], v->size[axis]);
    }
}

bool voxels_scan_transform(voxels_scan* s, ty_workers* workers)
{
    const int* size = s->v->size;
    int n = size[0], count = workers ? ty_workers_count(workers) : 1;
    n = size[1] > n ? size[1] : n;
    n = size[2] > n ? size[2] : n;
    envelope* e = TY_ALLOC(envelope, count);
    bool held = true;
    for (int i = 0; i < count; i++)
    {
        e[i] = (envelope){TY_TRY_ALLOC(int, n), TY_TRY_ALLOC(double, n + 1), TY_TRY_ALLOC(double, n),
                          TY_TRY_ALLOC(int32_t, n)};
        held = held && e[i].at && e[i].begin && e[i].height && e[i].site;
    }
    for (int axis = 0; axis < 3 && held; axis++)
    {
        // lines that lie beside one another in memory come one after another
        transform t = {s, e, axis, axis == 0 ? 1 : 0};
        int64_t lines = (int64_t)size[(axis + 1) % 3] * size[(axis + 2) % 3];
        ty_parallel_all(workers, lines, 256, lines_run, &t);
    }
    for (int i = 0; i < count; i++)
    {
        ty_free(e[i].at);
        ty_free(e[i].begin);
        ty_free(e[i].height);
        ty_free(e[i].site);
    }
    ty_free(e);
    return held;
}
