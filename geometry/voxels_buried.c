// SPDX-License-Identifier: Apache-2.0
// Where parts of a mesh overlap, faces of one lie within another: inside, the distance counts from the outer ones.
#include "voxels_open.h"

#define BAND 16.0f // steps from the surface; farther down it makes no difference to anyone

typedef struct burying
{
    voxels_scan* s;
    bool* buried; // [nodes] the nearest triangle lies within another part where it is nearest
    bool* any;    // [layers]
} burying;

static float value_at(const ty_voxels* v, ty_vec3 p)
{
    ty_vec3 q = ty_mul(ty_sub(p, v->origin), 1.0f / v->step);
    const float at[3] = {q.x, q.y, q.z};
    float part[3], sum = 0.0f;
    int cell[3];
    for (int i = 0; i < 3; i++)
    {
        float x = ty_clamp(at[i], 0.0f, (float)(v->size[i] - 1) - 1e-3f);
        cell[i] = (int)x;
        part[i] = x - (float)cell[i];
    }
    for (int e = 0; e < 8; e++)
    {
        float weight = (e & 1 ? part[0] : 1.0f - part[0]) * (e & 2 ? part[1] : 1.0f - part[1]) *
                       (e & 4 ? part[2] : 1.0f - part[2]);
        sum += weight * v->values[voxels_index(v, cell[0] + (e & 1), cell[1] + (e >> 1 & 1), cell[2] + (e >> 2))];
    }
    return sum;
}

// On the surface, with neighbours inside all around.
static bool is_enclosed(const ty_voxels* v, const int at[3])
{
    for (int axis = 0; axis < 3; axis++)
        for (int side = -1; side <= 1; side += 2)
        {
            int to[3] = {at[0], at[1], at[2]};
            to[axis] += side;
            if (to[axis] < 0 || to[axis] >= v->size[axis] || !signbit(v->values[voxels_index(v, to[0], to[1], to[2])]))
                return false;
        }
    return true;
}

// Beyond its nearest triangle a node that is inside comes out, or else it meets another part. Lids have no triangles.
static bool is_buried(const voxels_scan* s, size_t node, const int at[3])
{
    const ty_voxels* v = s->v;
    ty_vec3 p = voxels_place(v, at[0], at[1], at[2]);
    ty_vec3 c = voxels_scan_closest(s, s->near[node], p), way = ty_sub(c, p);
    float length = ty_length(way);
    if (!(length > 1e-3f * v->step))
        return is_enclosed(v, at);
    if (-v->values[node] < length - 0.05f * v->step)
        return false;
    return value_at(v, ty_mad(c, way, 0.75f * v->step / length)) < -0.25f * v->step;
}

static void layers_look(void* context, int64_t begin, int64_t end, int worker)
{
    burying* b = context;
    const ty_voxels* v = b->s->v;
    (void)worker;
    for (int k = (int)begin; k < (int)end; k++)
        for (int j = 0; j < v->size[1]; j++)
            for (int i = 0; i < v->size[0]; i++)
            {
                size_t node = voxels_index(v, i, j, k);
                float value = v->values[node];
                b->buried[node] = signbit(value) && value > -BAND * v->step && b->s->near[node] >= 0 &&
                                  is_buried(b->s, node, (const int[3]){i, j, k});
                b->any[k] |= b->buried[node];
                b->s->site[node] = fabsf(value) <= v->step && !b->buried[node] ? (int32_t)node : -1;
            }
}

static void layers_dig(void* context, int64_t begin, int64_t end, int worker)
{
    const burying* b = context;
    const voxels_scan* s = b->s;
    const ty_voxels* v = s->v;
    size_t first = voxels_index(v, 0, 0, (int)begin), last = voxels_index(v, 0, 0, (int)end);
    (void)worker;
    for (size_t node = first; node < last; node++)
    {
        int32_t site = s->site[node];
        if (!b->buried[node] || site < 0)
            continue;
        size_t row = (size_t)v->size[0], layer = row * (size_t)v->size[1], from = (size_t)site;
        ty_vec3 p = voxels_place(v, (int)(node % row), (int)(node % layer / row), (int)(node / layer));
        ty_vec3 q = voxels_place(v, (int)(from % row), (int)(from % layer / row), (int)(from / layer));
        float found = ty_length(ty_sub(p, voxels_scan_closest(s, s->near[from], p)));
        float by = ty_length(ty_sub(p, q)) - v->values[from]; // by way of the site
        if (found < by - 0.5f * v->step)                      // its triangle goes on under others
            found = by - 0.25f * v->step;
        v->values[node] = ty_min(v->values[node], -found);
        s->near[node] = s->near[from];
    }
}

bool voxels_buried_pass(voxels_scan* s, ty_workers* workers)
{
    int layers = s->v->size[2];
    burying b = {s, TY_TRY_ALLOC(bool, voxels_count(s->v)), TY_TRY_ALLOC(bool, layers)};
    bool held = b.buried && b.any, any = false;
    if (held)
        ty_parallel_all(workers, layers, 2, layers_look, &b);
    for (int k = 0; held && k < layers; k++)
        any |= b.any[k];
    if (any)
        held = voxels_scan_transform(s, workers);
    if (held && any)
        ty_parallel_all(workers, layers, 2, layers_dig, &b);
    ty_free(b.buried);
    ty_free(b.any);
    return held;
}
