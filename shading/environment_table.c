// SPDX-License-Identifier: Apache-2.0
// Environment images as densities over directions: luminance times solid angle.
#include <tsuya/base/memory.h>
#include <tsuya/shading/environment_table.h>

// Finest grid of directions. Every texel of an 8k image has its own cell, so that a sun of few texels is not lost in
// the sky around it.
enum
{
    GRID_WIDTH = 8192,
    GRID_HEIGHT = 4096
};

// Above this mean of L^2 over squared mean of L, sampling the image beats waiting for rays to find its bright places.
#define SMOOTH_CONTRAST 2.0f

static float* texel_luminances(const ty_texture* image, int width, int height)
{
    float* out = TY_ALLOC(float, (size_t)width*(size_t)height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
        {
            float luminance = ty_luminance(ty_texture_texel(image, x, y));
            out[(size_t)y * (size_t)width + (size_t)x] = isfinite(luminance) && luminance > 0.0f ? luminance : 0.0f;
        }
    return out;
}

// Mean of the bilinear image over a texel: 3/4 of its own value and 1/8 of each neighbour's, in both directions.
static float texel_mean(const float* luminances, int width, int height, int x, int y)
{
    static const float weights[3] = {0.125f, 0.75f, 0.125f};
    float sum = 0.0f;
    for (int j = -1; j <= 1; ++j)
    {
        int row = y + j < 0 ? 0 : y + j < height ? y + j : height - 1;
        const float* r = luminances + (size_t)row * (size_t)width;
        sum += weights[j + 1] *
               (weights[0] * r[x ? x - 1 : width - 1] + weights[1] * r[x] + weights[2] * r[x + 1 < width ? x + 1 : 0]);
    }
    return sum;
}

// Mean luminance of each cell of the grid; texels count for the cell that holds their centre.
static float* cell_luminances(const ty_texture* image, int width, int height)
{
    int from_width = ty_texture_width(image), from_height = ty_texture_height(image);
    float* texels = texel_luminances(image, from_width, from_height);
    float* cells = TY_ALLOC(float, (size_t)width*(size_t)height);
    for (int y = 0; y < from_height; ++y)
        for (int x = 0; x < from_width; ++x)
        {
            size_t row = (size_t)((int64_t)y * height / from_height),
                   column = (size_t)((int64_t)x * width / from_width);
            cells[row * (size_t)width + column] += texel_mean(texels, from_width, from_height, x, y);
        }
    ty_free(texels);
    float share = (float)width / (float)from_width * ((float)height / (float)from_height);
    for (size_t i = 0; i < (size_t)width * (size_t)height; ++i)
        cells[i] *= share;
    return cells;
}

// Luminances become shares of the light: times the solid angle.
static void set_distribution(ty_environment_table* table, float* cells, int width, int height)
{
    double sum = 0.0, sum_sqr = 0.0;
    for (int y = 0; y < height; ++y)
    {
        // The share of the sphere in this row, exactly: half the difference of the cosines at its borders.
        float share =
            0.5f * (ty_cos(TY_PI * (float)y / (float)height) - ty_cos(TY_PI * (float)(y + 1) / (float)height));
        float* row = cells + (size_t)y * (size_t)width;
        for (int x = 0; x < width; ++x)
        {
            sum += (double)row[x] * (double)share / width;
            sum_sqr += (double)row[x] * (double)row[x] * (double)share / width;
            row[x] *= share;
        }
    }
    table->mean = (float)sum;
    if (sum > 0.0 && sum_sqr > (double)SMOOTH_CONTRAST * sum * sum)
        table->distribution = ty_distribution_create(cells, width, height);
}

void ty_environment_table_init(ty_environment_table* table, const ty_texture* image)
{
    *table = (ty_environment_table){0};
    int width = ty_texture_width(image), height = ty_texture_height(image);
    width = width < GRID_WIDTH ? width : GRID_WIDTH;
    height = height < GRID_HEIGHT ? height : GRID_HEIGHT;
    float* cells = cell_luminances(image, width, height);
    set_distribution(table, cells, width, height);
    ty_free(cells);
}

void ty_environment_table_term(ty_environment_table* table)
{
    ty_distribution_destroy(table->distribution);
    *table = (ty_environment_table){0};
}
