// SPDX-License-Identifier: Apache-2.0
// Warps from the unit square and the piecewise-constant density of environment images.
#include <tsuya/base/memory.h>
#include <tsuya/shading/sampling.h>

// Shirley & Chiu 1997: squares become rings, which keeps the stratification. With a and b the distances
// from the axes over the larger of them, the angle in a quarter is pi/4 (1 - a + b) on both sides of its diagonal, so
// that these need not be told apart: that branch would be foretold wrongly every other time.
static inline ty_vec2 concentric(ty_vec2 u, float* radius)
{
    float x = 2.0f * u.x - 1.0f, y = 2.0f * u.y - 1.0f, ax = fabsf(x), ay = fabsf(y), r = ty_max(ax, ay);
    float d = (ax - ay) / ty_max(r, 0x1p-60f), s = d * d;
    // cos and sin of d pi/4 over the root of 2: Chebyshev fits, errors below 2e-8.
    float c = 0.70710676f + s * (-0.21808888f + s * (0.011207579f + s * -0.00022548042f));
    float t = d * (0.55536037f + s * (-0.057095644f + s * (0.0017607007f + s * -2.5423523e-05f)));
    *radius = r;
    return (ty_vec2){copysignf(r * (c + t), x), copysignf(r * (c - t), y)};
}

ty_vec2 ty_sample_disc(ty_vec2 u)
{
    float radius;
    return concentric(u, &radius);
}

ty_vec3 ty_sample_cosine(ty_vec2 u)
{
    float radius;
    ty_vec2 d = concentric(u, &radius);
    return (ty_vec3){d.x, d.y, sqrtf(1.0f - radius * radius)};
}

ty_vec3 ty_sample_sphere(ty_vec2 u)
{
    return ty_sample_cone(u, -1.0f);
}

ty_vec3 ty_sample_cone(ty_vec2 u, float cos_max)
{
    // 1 - cos is formed first: narrow cones keep their precision.
    float height = u.x * (1.0f - cos_max), radius = ty_safe_sqrt(height * (2.0f - height)), sine, cosine;
    ty_sincos(2.0f * TY_PI * u.y, &sine, &cosine);
    return (ty_vec3){radius * cosine, radius * sine, 1.0f - height};
}

struct ty_distribution
{
    int width, height;
    float* rows;    // [height + 1] cumulative over rows
    float* columns; // [height][width + 1] cumulative within a row
};

// Cumulative sums of n non-negative weights, from 0 to exactly 1; returns the total. Zero total: uniform.
static double accumulate(const float* weights, int n, float* cumulative)
{
    double total = 0.0, sum = 0.0;
    for (int i = 0; i < n; i++)
        total += weights[i] > 0.0f && weights[i] <= TY_FLOAT_MAX ? (double)weights[i] : 0.0;
    cumulative[0] = 0.0f;
    for (int i = 0; i < n; i++)
    {
        sum += weights[i] > 0.0f && weights[i] <= TY_FLOAT_MAX ? (double)weights[i] : 0.0;
        cumulative[i + 1] = total > 0.0 ? (float)(sum / total) : (float)(i + 1) / (float)n;
    }
    cumulative[n] = 1.0f;
    return total;
}

ty_distribution* ty_distribution_create(const float* weights, int width, int height)
{
    size_t w = (size_t)width + 1, h = (size_t)height;
    ty_distribution* d = TY_TRY_ALLOC(ty_distribution, 1);
    float* rows = TY_TRY_ALLOC(float, h + 1);
    float* columns = TY_TRY_ALLOC(float, w* h);
    double* totals = TY_TRY_ALLOC(double, h);
    float* shares = TY_TRY_ALLOC(float, h);
    if (!d || !rows || !columns || !totals || !shares)
    {
        ty_free(d);
        ty_free(rows);
        ty_free(columns);
        d = NULL;
    }
    else
    {
        double largest = 0.0;
        for (size_t y = 0; y < h; y++)
        {
            totals[y] = accumulate(weights + y * (size_t)width, width, columns + y * w);
            largest = totals[y] > largest ? totals[y] : largest;
        }
        for (size_t y = 0; y < h; y++)
            shares[y] = largest > 0.0 ? (float)(totals[y] / largest) : 0.0f;
        accumulate(shares, height, rows);
        *d = (ty_distribution){width, height, rows, columns};
    }
    ty_free(totals);
    ty_free(shares);
    return d;
}

void ty_distribution_destroy(ty_distribution* distribution)
{
    if (!distribution)
        return;
    ty_free(distribution->rows);
    ty_free(distribution->columns);
    ty_free(distribution);
}

// The cell i with cumulative[i] <= u < cumulative[i + 1]; never one of width zero.
static int find_cell(const float* cumulative, int n, float u)
{
    int low = 0, high = n;
    while (high - low > 1)
    {
        int middle = (low + high) / 2;
        if (cumulative[middle] <= u)
            low = middle;
        else
            high = middle;
    }
    return low;
}

// Picks a cell, returns the position in [0, 1) and multiplies *pdf by the density there.
static float sample_cells(const float* cumulative, int n, float u, int* cell, float* pdf)
{
    int i = find_cell(cumulative, n, u);
    float width = cumulative[i + 1] - cumulative[i], inside = width > 0.0f ? (u - cumulative[i]) / width : 0.5f;
    *cell = i;
    *pdf *= width * (float)n;
    return ty_min(((float)i + inside) / (float)n, TY_ONE_MINUS_EPSILON);
}

ty_vec2 ty_distribution_sample(const ty_distribution* d, ty_vec2 u, float* pdf)
{
    int row, column;
    *pdf = 1.0f;
    float y = sample_cells(d->rows, d->height, u.y, &row, pdf);
    float x = sample_cells(d->columns + (size_t)row * ((size_t)d->width + 1), d->width, u.x, &column, pdf);
    return (ty_vec2){x, y};
}

float ty_distribution_pdf(const ty_distribution* d, ty_vec2 p)
{
    int column = (int)ty_clamp(p.x * (float)d->width, 0.0f, (float)(d->width - 1));
    int row = (int)ty_clamp(p.y * (float)d->height, 0.0f, (float)(d->height - 1));
    const float* c = d->columns + (size_t)row * ((size_t)d->width + 1) + column;
    return (d->rows[row + 1] - d->rows[row]) * (float)d->height * (c[1] - c[0]) * (float)d->width;
}
