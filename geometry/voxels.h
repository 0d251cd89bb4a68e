// SPDX-License-Identifier: Apache-2.0
// What the files about grids of distances share.
#pragma once
#include <tsuya/geometry/voxels.h>

enum
{
    VOXELS_MOST = 1 << 27, // nodes
};

// A grid of zeros about bounds. *out is zeroed but for its numbers when there is no memory.
TY_CHECKED ty_status voxels_init(ty_bounds bounds, float step, float margin, ty_voxels* out, ty_error* error);

static inline size_t voxels_index(const ty_voxels* v, int i, int j, int k)
{
    return ((size_t)k * (size_t)v->size[1] + (size_t)j) * (size_t)v->size[0] + (size_t)i;
}

static inline size_t voxels_count(const ty_voxels* v)
{
    return (size_t)v->size[0] * (size_t)v->size[1] * (size_t)v->size[2];
}

static inline ty_vec3 voxels_place(const ty_voxels* v, int i, int j, int k)
{
    return ty_mad(v->origin, ty_vec3_make((float)i, (float)j, (float)k), v->step);
}

// Every row of nodes along x, those of a layer by one worker. workers may be NULL.
typedef void voxels_row_fn(void* context, int j, int k);
void voxels_rows(const ty_voxels* v, ty_workers* workers, voxels_row_fn* row, void* context);
