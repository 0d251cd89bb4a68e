// SPDX-License-Identifier: Apache-2.0
// The field between its nodes: uniform cubic B-splines with their derivatives, and the curvature of level sets.
#include "mesh_curvature.h"
#include "voxels.h"

// Weights of the four nodes about a coordinate, and of their first and second derivatives by it in steps.
typedef struct spline
{
    int first; // may lie one before the grid, and the last one beyond it: ends repeat
    float w[4], d[4], dd[4];
} spline;

static spline spline_at(float x, int size)
{
    x = ty_clamp(x, 0.0f, (float)(size - 1));
    int i = (int)x;
    i = i > size - 2 ? (size > 1 ? size - 2 : 0) : i;
    float t = x - (float)i, u = 1.0f - t;
    spline s = {.first = i - 1};
    s.w[0] = u * u * u / 6.0f;
    s.w[1] = (4.0f - 6.0f * t * t + 3.0f * t * t * t) / 6.0f;
    s.w[2] = (4.0f - 6.0f * u * u + 3.0f * u * u * u) / 6.0f;
    s.w[3] = t * t * t / 6.0f;
    s.d[0] = -0.5f * u * u;
    s.d[1] = 0.5f * t * (3.0f * t - 4.0f);
    s.d[2] = -0.5f * u * (3.0f * u - 4.0f);
    s.d[3] = 0.5f * t * t;
    s.dd[0] = u;
    s.dd[1] = 3.0f * t - 2.0f;
    s.dd[2] = 3.0f * u - 2.0f;
    s.dd[3] = t;
    return s;
}

static int clamped(int i, int size)
{
    return i < 0 ? 0 : i >= size ? size - 1 : i;
}

typedef struct splines
{
    spline x, y, z;
    int columns[4];
} splines;

static splines splines_at(const ty_voxels* v, ty_vec3 p)
{
    ty_vec3 q = ty_mul(ty_sub(p, v->origin), 1.0f / v->step);
    splines s = {spline_at(q.x, v->size[0]), spline_at(q.y, v->size[1]), spline_at(q.z, v->size[2]), {0}};
    for (int i = 0; i < 4; i++)
        s.columns[i] = clamped(s.x.first + i, v->size[0]);
    return s;
}

static const float* row_at(const ty_voxels* v, const splines* s, int b, int c)
{
    return v->values + voxels_index(v, 0, clamped(s->y.first + b, v->size[1]), clamped(s->z.first + c, v->size[2]));
}

ty_voxel_sample ty_voxels_sample(const ty_voxels* v, ty_vec3 p)
{
    splines s = splines_at(v, p);
    ty_voxel_sample r = {0};
    for (int c = 0; c < 4; c++)
        for (int b = 0; b < 4; b++)
        {
            const float* row = row_at(v, &s, b, c);
            float f = 0.0f, fx = 0.0f, fxx = 0.0f;
            for (int a = 0; a < 4; a++)
            {
                float value = row[s.columns[a]];
                f += s.x.w[a] * value;
                fx += s.x.d[a] * value;
                fxx += s.x.dd[a] * value;
            }
            float yz = s.y.w[b] * s.z.w[c], dy = s.y.d[b] * s.z.w[c], dz = s.y.w[b] * s.z.d[c];
            r.value += yz * f;
            r.gradient = ty_add(r.gradient, ty_vec3_make(yz * fx, dy * f, dz * f));
            r.hessian[0] += yz * fxx;
            r.hessian[1] += s.y.dd[b] * s.z.w[c] * f;
            r.hessian[2] += s.y.w[b] * s.z.dd[c] * f;
            r.hessian[3] += dy * fx;
            r.hessian[4] += dz * fx;
            r.hessian[5] += s.y.d[b] * s.z.d[c] * f;
        }
    float inverse = 1.0f / v->step;
    r.gradient = ty_mul(r.gradient, inverse);
    for (int i = 0; i < 6; i++)
        r.hessian[i] *= inverse * inverse;
    return r;
}

float ty_voxels_value(const ty_voxels* v, ty_vec3 p)
{
    splines s = splines_at(v, p);
    float sum = 0.0f;
    for (int c = 0; c < 4; c++)
        for (int b = 0; b < 4; b++)
        {
            const float* row = row_at(v, &s, b, c);
            float f = 0.0f;
            for (int a = 0; a < 4; a++)
                f += s.x.w[a] * row[s.columns[a]];
            sum += s.y.w[b] * s.z.w[c] * f;
        }
    return sum;
}

// The Hessian within the tangent plane, over the length of the gradient (Goldman 2005).
void ty_voxel_curvature(const ty_voxel_sample* sample, float* k1, float* k2, ty_vec3* direction)
{
    float length = ty_length(sample->gradient);
    if (!(length > 0.0f))
    {
        *k1 = *k2 = 0.0f;
        *direction = ty_vec3_make(1.0f, 0.0f, 0.0f);
        return;
    }
    ty_frame f = ty_frame_from_normal(ty_mul(sample->gradient, 1.0f / length));
    ty_vec3 t = ty_symmetric_times(sample->hessian, f.t), b = ty_symmetric_times(sample->hessian, f.b);
    ty_curvature_tensor c = {ty_dot(f.t, t) / length, ty_dot(f.t, b) / length, ty_dot(f.b, b) / length};
    ty_curvature_decompose(c, f.t, f.b, k1, k2, direction);
}
