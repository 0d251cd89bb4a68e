// SPDX-License-Identifier: Apache-2.0
// Distances on a grid whose edges may wrap, from points that lie between cells.
#include "fill_run.h"
#include <string.h>
#include <tsuya/base/math.h>

// The point of cell (x + dx, y + dy), if it is nearer to (x, y) than the one that is known.
static void look(const fill_run* run, int x, int y, int dx, int dy)
{
    int i = x + dx, j = y + dy;
    float shift_x = 0.0f, shift_y = 0.0f;
    if (i < 0 || i >= run->width)
    {
        if (!run->wrap_x)
            return;
        shift_x = (float)(i < 0 ? -run->width : run->width);
        i -= (int)shift_x;
    }
    if (j < 0 || j >= run->height)
    {
        if (!run->wrap_y)
            return;
        shift_y = (float)(j < 0 ? -run->height : run->height);
        j -= (int)shift_y;
    }
    size_t at = fill_cell(run, x, y), from = fill_cell(run, i, j);
    if (isnan(run->near_x[from]))
        return;
    float px = run->near_x[from] + shift_x, py = run->near_y[from] + shift_y;
    float ox = run->near_x[at] - (float)x, oy = run->near_y[at] - (float)y;
    if (isnan(ox) || ty_sqr(px - (float)x) + ty_sqr(py - (float)y) < ox * ox + oy * oy)
    {
        run->near_x[at] = px;
        run->near_y[at] = py;
    }
}

static void row_sweep(const fill_run* run, int y, int from_row)
{
    for (int x = 0; x < run->width; x++)
    {
        look(run, x, y, -1, from_row);
        look(run, x, y, 0, from_row);
        look(run, x, y, 1, from_row);
        look(run, x, y, -1, 0);
    }
    for (int x = run->width - 1; x >= 0; x--)
        look(run, x, y, 1, 0);
}

void fill_nearest(const fill_run* run)
{
    int passes = run->wrap_x || run->wrap_y ? 2 : 1;
    for (int pass = 0; pass < passes; pass++)
    {
        for (int y = 0; y < run->height; y++)
            row_sweep(run, y, -1);
        for (int y = run->height - 1; y >= 0; y--)
            row_sweep(run, y, 1);
    }
}

// Where v crosses the level between (x, y) and its neighbour at (dx, dy), if that is nearer than what is known.
static void crossing(const fill_run* run, int x, int y, int dx, int dy)
{
    int i = x + dx, j = y + dy;
    if (run->wrap_x)
        i = (i + run->width) % run->width;
    if (run->wrap_y)
        j = (j + run->height) % run->height;
    if (i < 0 || i >= run->width || j < 0 || j >= run->height)
        return;
    size_t at = fill_cell(run, x, y), next = fill_cell(run, i, j);
    float a = run->v[at] - run->level, b = run->v[next] - run->level;
    if ((a < 0.0f) == (b < 0.0f) || run->closed[at] || run->closed[next])
        return;
    float t = a / (a - b), ox = run->near_x[at] - (float)x, oy = run->near_y[at] - (float)y;
    if (isnan(ox) || t * t < ox * ox + oy * oy)
    {
        run->near_x[at] = (float)x + t * (float)dx;
        run->near_y[at] = (float)y + t * (float)dy;
    }
}

void fill_distance(const fill_run* run, float* distance)
{
    for (int y = 0; y < run->height; y++)
        for (int x = 0; x < run->width; x++)
        {
            run->near_x[fill_cell(run, x, y)] = run->near_y[fill_cell(run, x, y)] = NAN;
            crossing(run, x, y, 1, 0);
            crossing(run, x, y, -1, 0);
            crossing(run, x, y, 0, 1);
            crossing(run, x, y, 0, -1);
        }
    fill_nearest(run);
    float far = (float)(run->width + run->height);
    for (int y = 0; y < run->height; y++)
        for (int x = 0; x < run->width; x++)
        {
            size_t at = fill_cell(run, x, y);
            float ox = run->near_x[at] - (float)x, oy = run->near_y[at] - (float)y;
            float d = isnan(ox) ? far : sqrtf(ox * ox + oy * oy);
            distance[at] = run->v[at] < run->level ? d : -d;
        }
}

// The mean of the neighbours with a value, for those without; what was found comes into force when all have looked.
static void extend(const fill_run* run, float* v, const float* from)
{
    for (int y = 0; y < run->height; y++)
        for (int x = 0; x < run->width; x++)
        {
            static const int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
            float sum = 0.0f, count = 0.0f;
            if (!isnan(from[fill_cell(run, x, y)]))
                continue;
            for (int k = 0; k < 4; k++)
            {
                int i = x + steps[k][0], j = y + steps[k][1];
                if (i < 0 || i >= run->width || j < 0 || j >= run->height || isnan(from[fill_cell(run, i, j)]))
                    continue;
                sum += from[fill_cell(run, i, j)];
                count += 1.0f;
            }
            if (count > 0.0f)
                v[fill_cell(run, x, y)] = sum / count;
        }
}

void fill_take_v(const fill_run* run)
{
    size_t cells = fill_cells(run);
    bool any = false;
    for (int y = 0; y < run->height; y++)
        memcpy(run->v + fill_cell(run, 0, y), ty_gray_scott_v(run->field, y), (size_t)run->width * sizeof(float));
    for (size_t i = 0; i < cells; i++)
        if (run->closed[i])
        {
            run->v[i] = NAN;
            any = true;
        }
    for (int pass = 0; pass < 2 && any; pass++)
    {
        memcpy(run->near_x, run->v, cells * sizeof(float));
        extend(run, run->v, run->near_x);
    }
    for (size_t i = 0; i < cells && any; i++)
        if (isnan(run->v[i]))
            run->v[i] = 0.0f;
}
