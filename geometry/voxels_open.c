// SPDX-License-Identifier: Apache-2.0
// Winding numbers about open parts: between places four steps apart where there is no surface, from there up to it by
// their mean value property; and the lids over the openings.
#include "voxels_open.h"
#include <string.h>

enum
{
    COARSE = 4,  // steps between places
    ROUNDS = 10, // of means
};

#define UNKNOWN (-1e30f)

typedef struct opening
{
    voxels_scan* s;
    const winding* w;
    float* wound;   // winding number at each node
    float* next;    // after a round
    float* lattice; // at every fourth
    int size[3];    // of the lattice
} opening;

static size_t lattice_index(const opening* o, int a, int b, int c)
{
    return ((size_t)c * (size_t)o->size[1] + (size_t)b) * (size_t)o->size[0] + (size_t)a;
}

// The last place may lie beyond the grid.
static void lattice_fill(void* context, int64_t begin, int64_t end, int worker)
{
    const opening* o = context;
    (void)worker;
    for (int64_t row = begin; row < end; row++)
    {
        int b = (int)(row % o->size[1]), c = (int)(row / o->size[1]);
        for (int a = 0; a < o->size[0]; a++)
            o->lattice[lattice_index(o, a, b, c)] =
                winding_at(o->w, voxels_place(o->s->v, COARSE * a, COARSE * b, COARSE * c));
    }
}

// The surface passes within a step of a node of the block, if it does at all.
static bool block_clean(const opening* o, const int low[3], const int high[3])
{
    const ty_voxels* v = o->s->v;
    for (int k = low[2]; k <= high[2]; k++)
        for (int j = low[1]; j <= high[1]; j++)
            for (int i = low[0]; i <= high[0]; i++)
                if (fabsf(v->values[voxels_index(v, i, j, k)]) < v->step)
                    return false;
    return true;
}

static float between(const opening* o, int a, int b, int c, float x, float y, float z)
{
    float rows[4];
    for (int r = 0; r < 4; r++)
    {
        size_t i = lattice_index(o, a, b + (r & 1), c + (r >> 1));
        rows[r] = ty_lerp(o->lattice[i], o->lattice[i + 1], x);
    }
    return ty_lerp(ty_lerp(rows[0], rows[1], y), ty_lerp(rows[2], rows[3], y), z);
}

static void block_fill(const opening* o, int a, int b, int c)
{
    const ty_voxels* v = o->s->v;
    const int low[3] = {COARSE * a, COARSE * b, COARSE * c};
    int high[3], end[3];
    for (int i = 0; i < 3; i++)
    {
        high[i] = low[i] + COARSE < v->size[i] ? low[i] + COARSE : v->size[i] - 1;
        end[i] = low[i] + COARSE < v->size[i] ? low[i] + COARSE : v->size[i];
    }
    bool clean = block_clean(o, low, high);
    const float part = 1.0f / COARSE;
    for (int k = low[2]; k < end[2]; k++)
        for (int j = low[1]; j < end[1]; j++)
            for (int i = low[0]; i < end[0]; i++)
            {
                size_t node = voxels_index(v, i, j, k);
                float x = part * (float)(i - low[0]), y = part * (float)(j - low[1]), z = part * (float)(k - low[2]);
                o->s->turns[node] = clean; // stays as it is
                o->wound[node] = clean ? between(o, a, b, c, x, y, z) : UNKNOWN;
            }
}

static void blocks_fill(void* context, int64_t begin, int64_t end, int worker)
{
    const opening* o = context;
    (void)worker;
    for (int64_t row = begin; row < end; row++)
        for (int a = 0; a < o->size[0] - 1; a++)
            block_fill(o, a, (int)(row % (o->size[1] - 1)), (int)(row / (o->size[1] - 1)));
}

// The number is harmonic off the surface: that of a node is the mean of its neighbours' but for those behind the
// surface, which is between two nodes only where their distances are no more than a step together.
static float mean_of(const opening* o, int i, int j, int k)
{
    const ty_voxels* v = o->s->v;
    const int at[3] = {i, j, k};
    const size_t stride[3] = {1, (size_t)v->size[0], (size_t)v->size[0] * (size_t)v->size[1]};
    size_t node = voxels_index(v, i, j, k);
    float sum = 0.0f, count = 0.0f;
    for (int e = 0; e < 6; e++)
    {
        int axis = e >> 1, to = at[axis] + (e & 1 ? 1 : -1);
        if (to < 0 || to >= v->size[axis])
            continue;
        size_t other = e & 1 ? node + stride[axis] : node - stride[axis];
        if (o->wound[other] == UNKNOWN || fabsf(v->values[node]) + fabsf(v->values[other]) <= 1.01f * v->step)
            continue;
        sum += o->wound[other];
        count += 1.0f;
    }
    return count > 0.0f ? sum / count : o->wound[node];
}

static void row_mean(void* context, int j, int k)
{
    const opening* o = context;
    const ty_voxels* v = o->s->v;
    for (int i = 0; i < v->size[0]; i++)
    {
        size_t node = voxels_index(v, i, j, k);
        o->next[node] = o->s->turns[node] ? o->wound[node] : mean_of(o, i, j, k);
    }
}

// Nodes on the surface itself, and in gaps too narrow for places.
static void row_rest(void* context, int j, int k)
{
    const opening* o = context;
    const ty_voxels* v = o->s->v;
    for (int i = 0; i < v->size[0]; i++)
    {
        float* wound = &o->wound[voxels_index(v, i, j, k)];
        *wound = *wound == UNKNOWN ? winding_at(o->w, voxels_place(v, i, j, k)) : *wound;
    }
}

static void numbers_find(opening* o, ty_workers* workers)
{
    ty_parallel_all(workers, (int64_t)o->size[1] * o->size[2], 4, lattice_fill, o);
    ty_parallel_all(workers, (int64_t)(o->size[1] - 1) * (o->size[2] - 1), 4, blocks_fill, o);
    for (int round = 0; round < ROUNDS; round++)
    {
        voxels_rows(o->s->v, workers, row_mean, o);
        float* done = o->next;
        o->next = o->wound;
        o->wound = done;
    }
    voxels_rows(o->s->v, workers, row_rest, o);
}

static void nodes_sign(void* context, int64_t begin, int64_t end, int worker)
{
    const opening* o = context;
    float* values = o->s->v->values;
    (void)worker;
    for (int64_t i = begin; i < end; i++)
        if (o->wound[i] > 0.5f && values[i] > 0.0f)
            values[i] = -values[i];
}

// --- lids ---

// How far the lid is from node (i, j, k), m: where a neighbour is on the other side and the surface is on neither's.
// < 0: it is not next to a lid.
static float lid_distance(const opening* o, int i, int j, int k)
{
    const ty_voxels* v = o->s->v;
    size_t node = voxels_index(v, i, j, k);
    float own = v->values[node], best = -1.0f;
    if (fabsf(own) <= v->step)
        return -1.0f;
    for (int e = 0; e < 6; e++)
    {
        int to[3] = {i, j, k};
        to[e >> 1] += e & 1 ? 1 : -1;
        if (to[e >> 1] < 0 || to[e >> 1] >= v->size[e >> 1])
            continue;
        size_t other = voxels_index(v, to[0], to[1], to[2]);
        if ((v->values[other] < 0.0f) == (own < 0.0f) || fabsf(v->values[other]) <= v->step)
            continue;
        float change = fabsf(o->wound[other] - o->wound[node]), off = fabsf(o->wound[node] - 0.5f);
        float d = v->step * (change > 0.0f ? ty_clamp(off / change, 0.0f, 1.0f) : 0.5f);
        best = best < 0.0f ? d : ty_min(best, d);
    }
    return best;
}

// A lid node is a site; its turns are 1 + thousandths of a step to the lid, below 0 inside.
static void row_mark_lids(void* context, int j, int k)
{
    const opening* o = context;
    const ty_voxels* v = o->s->v;
    for (int i = 0; i < v->size[0]; i++)
    {
        size_t node = voxels_index(v, i, j, k);
        float d = lid_distance(o, i, j, k);
        o->s->site[node] = d < 0.0f ? -1 : (int32_t)node;
        int whole = 1 + (int)(1e3f * d / v->step);
        o->s->turns[node] = (int16_t)(v->values[node] < 0.0f ? -whole : whole);
    }
}

// Lids are no surface that anything is seen of: a part of a step will do.
static void row_apply_lids(void* context, int j, int k)
{
    const opening* o = context;
    const ty_voxels* v = o->s->v;
    for (int i = 0; i < v->size[0]; i++)
    {
        size_t node = voxels_index(v, i, j, k);
        int32_t site = o->s->site[node];
        int x = site % v->size[0] - i, y = site / v->size[0] % v->size[1] - j;
        int z = site / v->size[0] / v->size[1] - k, turns = o->s->turns[site];
        bool same = (turns < 0) == (v->values[node] < 0.0f);
        float off = v->step * 1e-3f * ((float)(turns < 0 ? -turns : turns) - 1.0f);
        float d = v->step * sqrtf((float)(x * x + y * y + z * z)) + (same ? off : -off);
        v->values[node] = copysignf(ty_min(fabsf(v->values[node]), ty_max(d, 0.0f)), v->values[node]);
    }
}

static bool lids_close(opening* o, ty_workers* workers)
{
    bool any = false;
    voxels_rows(o->s->v, workers, row_mark_lids, o);
    for (size_t i = 0; i < voxels_count(o->s->v) && !any; i++)
        any = o->s->site[i] >= 0;
    if (!any)
        return true;
    if (!voxels_scan_transform(o->s, workers))
        return false;
    voxels_rows(o->s->v, workers, row_apply_lids, o);
    return true;
}

bool voxels_open_fill(voxels_scan* s, const mesh_parts* parts, ty_workers* workers)
{
    opening o = {.s = s};
    size_t places = 1, count = voxels_count(s->v);
    for (int i = 0; i < 3; i++)
        places *= (size_t)(o.size[i] = (s->v->size[i] + COARSE - 1) / COARSE + 1);
    o.lattice = TY_TRY_ALLOC(float, places);
    o.wound = TY_TRY_ALLOC(float, count);
    o.next = TY_TRY_ALLOC(float, count);
    winding* w = winding_create(s->mesh, parts->open, parts->open_count, parts->side);
    o.w = w;
    bool held = o.lattice && o.wound && o.next && w;
    if (held)
    {
        numbers_find(&o, workers);
        ty_parallel_all(workers, (int64_t)count, 1 << 16, nodes_sign, &o);
        held = lids_close(&o, workers);
    }
    winding_destroy(w);
    ty_free(o.lattice);
    ty_free(o.wound);
    ty_free(o.next);
    return held;
}
