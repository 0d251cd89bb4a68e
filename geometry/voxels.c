// SPDX-License-Identifier: Apache-2.0
// Grids of signed distances: joining, cutting, growing and smoothing solids.
#include "voxels.h"
#include <string.h>

enum
{
    BAND = 4, // steps from the surface within which smoothing works
};

ty_status voxels_init(ty_bounds bounds, float step, float margin, ty_voxels* out, ty_error* error)
{
    *out = (ty_voxels){.step = step};
    ty_vec3 room = {margin, margin, margin}, size = ty_sub(bounds.high, bounds.low);
    out->origin = ty_sub(bounds.low, room);
    const float extent[3] = {size.x, size.y, size.z};
    double nodes = 1.0;
    for (int i = 0; i < 3; i++)
        nodes *= ceil(((double)extent[i] + 2.0 * (double)margin) / (double)step) + 1.0;
    if (!(step > 0.0f && margin >= 0.0f && nodes >= 1.0 && nodes <= VOXELS_MOST))
        return ty_error_set(error, TY_BAD_INPUT, "a grid of %.3g nodes of %g mm; there are at most %d million", nodes,
                            (double)step * 1e3, VOXELS_MOST >> 20);
    size_t count = 1;
    for (int i = 0; i < 3; i++)
    {
        out->size[i] = (int)ceil(((double)extent[i] + 2.0 * (double)margin) / (double)step) + 1;
        count *= (size_t)out->size[i];
    }
    out->values = TY_TRY_ALLOC(float, count);
    return out->values ? TY_OK : ty_error_set(error, TY_NO_MEMORY, "no memory for a grid of %zu nodes", count);
}

typedef struct rows
{
    int count; // of a layer
    voxels_row_fn* row;
    void* context;
} rows;

static void layers_run(void* context, int64_t begin, int64_t end, int worker)
{
    const rows* r = context;
    (void)worker;
    for (int k = (int)begin; k < (int)end; k++)
        for (int j = 0; j < r->count; j++)
            r->row(r->context, j, k);
}

void voxels_rows(const ty_voxels* v, ty_workers* workers, voxels_row_fn* row, void* context)
{
    rows r = {v->size[1], row, context};
    ty_parallel_all(workers, v->size[2], 2, layers_run, &r);
}

void ty_voxels_term(ty_voxels* voxels)
{
    ty_free(voxels->values);
    *voxels = (ty_voxels){0};
}

// --- solids ---

// The nodes within r of center: [low, high) on each axis.
static void box_of(const ty_voxels* v, ty_vec3 center, float r, int low[3], int high[3])
{
    ty_vec3 d = ty_sub(center, v->origin);
    const float at[3] = {d.x, d.y, d.z};
    for (int i = 0; i < 3; i++)
    {
        float most = (float)v->size[i];
        low[i] = (int)ty_clamp(ceilf((at[i] - r) / v->step), 0.0f, most);
        high[i] = (int)ty_clamp(floorf((at[i] + r) / v->step) + 1.0f, 0.0f, most);
    }
}

// side 1: union; -1: the complement of the union of the complement, which is the difference.
static void ball_join(ty_voxels* v, ty_vec3 center, float radius, float reach, float side)
{
    int low[3], high[3];
    box_of(v, center, ty_min(radius + reach, 1e6f), low, high);
    ty_vec3 from = ty_sub(v->origin, center);
    for (int k = low[2]; k < high[2]; k++)
        for (int j = low[1]; j < high[1]; j++)
        {
            float* row = v->values + voxels_index(v, 0, j, k);
            float y = from.y + v->step * (float)j, z = from.z + v->step * (float)k, across = y * y + z * z;
            for (int i = low[0]; i < high[0]; i++)
            {
                float x = from.x + v->step * (float)i, d = sqrtf(x * x + across) - radius;
                row[i] = side * ty_min(side * row[i], d);
            }
        }
}

void ty_voxels_add_ball(ty_voxels* voxels, ty_vec3 center, float radius, float reach)
{
    ball_join(voxels, center, radius, reach, 1.0f);
}

void ty_voxels_take_ball(ty_voxels* voxels, ty_vec3 center, float radius, float reach)
{
    ball_join(voxels, center, radius, reach, -1.0f);
}

void ty_voxels_cut(ty_voxels* v, ty_vec3 unit_normal, float height)
{
    for (int k = 0; k < v->size[2]; k++)
        for (int j = 0; j < v->size[1]; j++)
        {
            float* row = v->values + voxels_index(v, 0, j, k);
            float start = ty_dot(unit_normal, voxels_place(v, 0, j, k)) - height;
            for (int i = 0; i < v->size[0]; i++)
                row[i] = ty_max(row[i], start + unit_normal.x * v->step * (float)i);
        }
}

void ty_voxels_offset(ty_voxels* v, float by)
{
    for (size_t i = 0; i < voxels_count(v); i++)
        v->values[i] -= by;
}

void ty_voxels_scale(ty_voxels* v, float factor)
{
    v->origin = ty_mul(v->origin, factor);
    v->step *= factor;
    for (size_t i = 0; i < voxels_count(v); i++)
        v->values[i] *= factor;
}

// --- smoothing ---

// |grad| times the sum of the principal curvatures of the level set, by central differences.
static float curvature_speed(const float* f, ptrdiff_t dy, ptrdiff_t dz, float inverse_step)
{
    float s = 0.5f * inverse_step, w = inverse_step * inverse_step, q = 0.25f * w;
    float x = s * (f[1] - f[-1]), y = s * (f[dy] - f[-dy]), z = s * (f[dz] - f[-dz]);
    float xx = w * (f[1] - 2.0f * f[0] + f[-1]), yy = w * (f[dy] - 2.0f * f[0] + f[-dy]);
    float zz = w * (f[dz] - 2.0f * f[0] + f[-dz]);
    float xy = q * (f[1 + dy] - f[1 - dy] - f[-1 + dy] + f[-1 - dy]);
    float xz = q * (f[1 + dz] - f[1 - dz] - f[-1 + dz] + f[-1 - dz]);
    float yz = q * (f[dy + dz] - f[dy - dz] - f[-dy + dz] + f[-dy - dz]);
    float along = x * x * xx + y * y * yy + z * z * zz + 2.0f * (x * y * xy + x * z * xz + y * z * yz);
    return xx + yy + zz - along / (x * x + y * y + z * z + 1e-6f);
}

static void smooth_step(const ty_voxels* v, const float* from, float* to, float time)
{
    ptrdiff_t dy = v->size[0], dz = dy * v->size[1];
    float band = BAND * v->step, inverse = 1.0f / v->step;
    for (int k = 1; k + 1 < v->size[2]; k++)
        for (int j = 1; j + 1 < v->size[1]; j++)
            for (int i = 1; i + 1 < v->size[0]; i++)
            {
                size_t at = voxels_index(v, i, j, k);
                if (fabsf(from[at]) < band)
                    to[at] = from[at] + time * curvature_speed(from + at, dy, dz, inverse);
            }
}

ty_status ty_voxels_smooth(ty_voxels* v, float time, ty_error* error)
{
    int steps = (int)ceilf(6.0f * time / ty_sqr(v->step));
    if (steps < 1)
        return TY_OK;
    size_t count = voxels_count(v);
    float* other = TY_TRY_ALLOC(float, count);
    if (!other)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for a grid of %zu nodes", count);
    memcpy(other, v->values, count * sizeof(float));
    for (int s = 0; s < steps; s++)
    {
        smooth_step(v, v->values, other, time / (float)steps);
        float* done = other;
        other = v->values;
        v->values = done;
        if (s + 1 < steps)
            memcpy(other, done, count * sizeof(float));
    }
    ty_free(other);
    return TY_OK;
}
