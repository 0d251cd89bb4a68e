// SPDX-License-Identifier: Apache-2.0
// The signed distance from any mesh, in parallel: triangles by slabs of the grid, then nodes.
#include "voxels_open.h"
#include <string.h>

enum
{
    BAND = 12, // steps from the surface within which nodes ask their neighbours
    NEAR = 5,  // and within which they search the surface
    SLAB = 4,  // layers
};

typedef struct field
{
    voxels_scan s;
    mesh_parts parts;
    uint32_t* begin; // of each slab, in items
    uint32_t* items; // triangles that reach into the slab
    bool* twice;     // [layers] rows wind about something more than once there: parts overlap
    int parity;      // of the nodes that ask now
} field;

// --- triangles by slab ---

static void slabs_of(const field* f, uint32_t triangle, int* first, int* last)
{
    const ty_voxels* v = f->s.v;
    const uint32_t* c = f->s.mesh->triangles[triangle];
    const ty_vec3* at = f->s.mesh->positions;
    float low = ty_min(at[c[0]].z, ty_min(at[c[1]].z, at[c[2]].z));
    float high = ty_max(at[c[0]].z, ty_max(at[c[1]].z, at[c[2]].z)), most = (float)(v->size[2] - 1);
    *first = (int)ty_clamp(floorf((low - v->origin.z) / v->step - 1.0f), 0.0f, most) / SLAB;
    *last = (int)ty_clamp(ceilf((high - v->origin.z) / v->step + 1.0f), 0.0f, most) / SLAB;
}

static bool slabs_fill(field* f, int slabs)
{
    int first, last;
    f->begin = TY_ALLOC(uint32_t, slabs + 1);
    uint64_t count = 0;
    for (uint32_t t = 0; t < f->s.mesh->triangle_count; t++)
    {
        slabs_of(f, t, &first, &last);
        count += (uint64_t)(last - first + 1);
        for (int i = first; i <= last; i++)
            f->begin[i + 1]++;
    }
    f->items = count < UINT32_MAX ? TY_TRY_ALLOC(uint32_t, count) : NULL;
    uint32_t* at = TY_ALLOC(uint32_t, slabs);
    for (int i = 0; i < slabs; i++)
        at[i] = f->begin[i + 1] += f->begin[i];
    for (uint32_t t = f->s.mesh->triangle_count; t-- > 0 && f->items;) // in order within each slab
    {
        slabs_of(f, t, &first, &last);
        for (int i = first; i <= last; i++)
            f->items[--at[i]] = t;
    }
    ty_free(at);
    return f->items != NULL;
}

static void slabs_scan(void* context, int64_t begin, int64_t end, int worker)
{
    field* f = context;
    voxels_scan* s = &f->s;
    (void)worker;
    for (int64_t slab = begin; slab < end; slab++)
    {
        int low = (int)slab * SLAB, high = low + SLAB < s->v->size[2] ? low + SLAB - 1 : s->v->size[2] - 1;
        size_t first = voxels_index(s->v, 0, 0, low), last = voxels_index(s->v, 0, 0, high + 1);
        for (uint32_t i = f->begin[slab]; i < f->begin[slab + 1]; i++)
        {
            uint32_t t = f->items[i];
            if (f->parts.kind[t] == MESH_PART_CLOSED)
                voxels_scan_turn(s, s->mesh->triangles[t], low, high);
            voxels_scan_spread(s, (int32_t)t, low, high, true);
        }
        for (size_t i = first; i < last; i++) // a triangle that is nearer than a step has the node in its box
            s->site[i] = s->near[i] >= 0 && s->v->values[i] <= ty_sqr(s->v->step) ? (int32_t)i : -1;
    }
}

// --- nodes ---

static void row_search(void* context, int j, int k)
{
    field* f = context;
    voxels_scan* s = &f->s;
    const ty_voxels* v = s->v;
    for (int i = 0; i < v->size[0]; i++)
    {
        size_t node = voxels_index(v, i, j, k);
        ty_vec3 p = voxels_place(v, i, j, k);
        if (s->site[node] == (int32_t)node)
            continue;
        voxels_scan_try(s, node, p, s->near[s->site[node]]);
        if (v->values[node] < ty_sqr(NEAR * v->step))
            voxels_scan_descend(s, node, p);
    }
}

// Half of the nodes, as those of a chessboard: their neighbours are all of the other half.
static void row_ask(void* context, int j, int k)
{
    field* f = context;
    voxels_scan* s = &f->s;
    const ty_voxels* v = s->v;
    for (int i = (j + k + f->parity) & 1; i < v->size[0]; i += 2)
    {
        size_t node = voxels_index(v, i, j, k);
        if (s->site[node] != (int32_t)node && v->values[node] < ty_sqr(BAND * v->step))
            voxels_scan_ask(s, (const int[3]){i, j, k}, voxels_place(v, i, j, k));
    }
}

// Bodies may overlap and may be inside out: what counts is that rows wind about something.
static void row_sign(void* context, int j, int k)
{
    field* f = context;
    const ty_voxels* v = f->s.v;
    int turns = 0;
    size_t row = voxels_index(v, 0, j, k);
    for (size_t i = row; i < row + (size_t)v->size[0]; i++)
    {
        turns += f->s.turns[i];
        f->twice[k] |= turns > 1 || turns < -1;
        v->values[i] = turns != 0 ? -sqrtf(v->values[i]) : sqrtf(v->values[i]);
    }
}

static bool field_run(field* f, ty_workers* workers)
{
    int layers = f->s.v->size[2], slabs = (layers + SLAB - 1) / SLAB;
    memset(f->s.near, 0xff, voxels_count(f->s.v) * sizeof(int32_t));
    f->twice = TY_ALLOC(bool, layers);
    if (!mesh_parts_find(f->s.mesh, &f->parts) || !slabs_fill(f, slabs))
        return false;
    ty_parallel_all(workers, slabs, 1, slabs_scan, f);
    if (!voxels_scan_transform(&f->s, workers))
        return false;
    voxels_rows(f->s.v, workers, row_search, f);
    for (f->parity = 0; f->parity < 2; f->parity++)
        voxels_rows(f->s.v, workers, row_ask, f);
    voxels_rows(f->s.v, workers, row_sign, f);
    if (f->parts.open_count > 0 && !voxels_open_fill(&f->s, &f->parts, workers))
        return false;
    bool overlap = f->parts.open_count > 0 && !f->parts.closed;
    for (int k = 0; k < layers; k++)
        overlap |= f->twice[k];
    return !overlap || voxels_buried_pass(&f->s, workers);
}

ty_status ty_voxels_around_mesh(const ty_mesh* mesh, float step, float margin, ty_workers* workers, ty_voxels* out,
                                int32_t** nearest, ty_error* error)
{
    *out = (ty_voxels){0};
    TY_ASSERT(mesh->welds);
    if (mesh->triangle_count == 0)
        return ty_error_set(error, TY_BAD_INPUT, "a mesh without triangles has no surface");
    ty_bounds bounds = ty_bounds_empty();
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        bounds = ty_bounds_add(bounds, mesh->positions[i]);
    ty_status status = voxels_init(bounds, step, margin, out, error);
    if (status != TY_OK)
        return status;
    size_t count = voxels_count(out);
    field f = {
        .s = {mesh, out, TY_TRY_ALLOC(int32_t, count), TY_TRY_ALLOC(int32_t, count), TY_TRY_ALLOC(int16_t, count)}};
    if (!f.s.site || !f.s.near || !f.s.turns || !field_run(&f, workers))
        status = ty_error_set(error, TY_NO_MEMORY, "no memory for a grid of %zu nodes", count);
    mesh_parts_term(&f.parts);
    ty_free(f.begin);
    ty_free(f.items);
    ty_free(f.twice);
    ty_free(f.s.site);
    ty_free(f.s.turns);
    if (status == TY_OK && nearest)
        *nearest = f.s.near;
    else
        ty_free(f.s.near);
    if (status != TY_OK)
        ty_voxels_term(out);
    return status;
}
