// SPDX-License-Identifier: Apache-2.0
// Warps from the unit square and the piecewise-constant density of environment images.
#include <tsuya/base/memory.h>
#include <tsuya/shading/sampling.h>

ty_vec2 ty_sample_disc(ty_vec2 u)
{
    // Shirley & Chiu 1997: keeps the stratification of the square.
    float x = 2.0f * u.x - 1.0f, y = 2.0f * u.y - 1.0f, r, phi, sine, cosine;
    if (x == 0.0f && y == 0.0f)
        return (ty_vec2){0, 0};
    if (fabsf(x) > fabsf(y))
    {
        r = x;
        phi = (TY_PI / 4) * (y / x);
    }
    else
    {
        r = y;
        phi = TY_PI / 2 - (TY_PI / 4) * (x / y);
    }
    ty_sincos(phi, &sine, &cosine);
    return (ty_vec2){r * cosine, r * sine};
}

ty_vec3 ty_sample_cosine(ty_vec2 u)
{
    ty_vec2 d = ty_sample_disc(u);
    return (ty_vec3){d.x, d.y, ty_safe_sqrt(1.0f - d.x * d.x - d.y * d.y)};
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
