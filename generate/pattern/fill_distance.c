// SPDX-License-Identifier: Apache-2.0
// Distances on a grid whose edges may wrap, from points that lie between cells.
#include "fill_run.h"
#include <string.h>
#include <tsuya/base/math.h>

// Takes the point (px, py) for (x, y) if it is nearer than (*nx, *ny); NaN is farther than any.
static inline void take_nearer(float px, float py, float x, float y, float* nx, float* ny)
{
    float now = ty_sqr(*nx - x) + ty_sqr(*ny - y), other = ty_sqr(px - x) + ty_sqr(py - y);
    bool nearer = other < now || (isnan(now) && !isnan(other));
    *nx = nearer ? px : *nx;
    *ny = nearer ? py : *ny;
}

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
    take_nearer(run->near_x[from] + shift_x, run->near_y[from] + shift_y, (float)x, (float)y, &run->near_x[at],
                &run->near_y[at]);
}

// Looks from a cell to its three neighbours of the row before, or behind.
static void cell_look(const fill_run* run, int x, int y, int from_row)
{
    for (int k = -1; k <= 1; k++)
        look(run, x, y, k, from_row);
}

// The same from all cells of row y but the first and the last, which may look over an edge.
static void row_look(const fill_run* run, int y, int from_row)
{
    int j = y + from_row;
    float shift = j < 0 ? (float)-run->height : j >= run->height ? (float)run->height : 0.0f;
    if (shift != 0.0f && !run->wrap_y)
        return;
    j -= (int)shift;
    float* restrict nx = run->near_x + fill_cell(run, 0, y), * restrict ny = run->near_y + fill_cell(run, 0, y);
    const float *fx = run->near_x + fill_cell(run, 0, j), *fy = run->near_y + fill_cell(run, 0, j);
    for (int x = 1; x < run->width - 1; x++)
    {
        float px = nx[x], py = ny[x];
        for (int k = -1; k <= 1; k++)
            take_nearer(fx[x + k], fy[x + k] + shift, (float)x, (float)y, &px, &py);
        nx[x] = px;
        ny[x] = py;
    }
}

static void row_sweep(const fill_run* run, int y, int from_row)
{
    int last = run->width - 1;
    float *nx = run->near_x + fill_cell(run, 0, y), *ny = run->near_y + fill_cell(run, 0, y);
    row_look(run, y, from_row);
    cell_look(run, 0, y, from_row);
    look(run, 0, y, -1, 0);
    for (int x = 1; x < last; x++)
        take_nearer(nx[x - 1], ny[x - 1], (float)x, (float)y, &nx[x], &ny[x]);
    cell_look(run, last, y, from_row);
    look(run, last, y, -1, 0);
    look(run, last, y, 1, 0);
    for (int x = last - 1; x >= 0; x--)
        take_nearer(nx[x + 1], ny[x + 1], (float)x, (float)y, &nx[x], &ny[x]);
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

static void rows_cross(void* context, int64_t begin, int64_t end, int worker)
{
    const fill_run* run = *(const fill_run* const*)context;
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < run->width; x++)
        {
            run->near_x[fill_cell(run, x, y)] = run->near_y[fill_cell(run, x, y)] = NAN;
            crossing(run, x, y, 1, 0);
            crossing(run, x, y, -1, 0);
            crossing(run, x, y, 0, 1);
            crossing(run, x, y, 0, -1);
        }
}

static void rows_measure(void* context, int64_t begin, int64_t end, int worker)
{
    const fill_run* run = *(const fill_run* const*)context;
    float far = (float)(run->width + run->height);
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < run->width; x++)
        {
            size_t at = fill_cell(run, x, y);
            float ox = run->near_x[at] - (float)x, oy = run->near_y[at] - (float)y;
            float d = isnan(ox) ? far : sqrtf(ox * ox + oy * oy);
            run->distance[at] = run->v[at] < run->level ? d : -d;
        }
}

void fill_distance(const fill_run* run)
{
    if (!run->distance)
        return;
    ty_parallel_all(run->workers, run->height, 32, rows_cross, &run);
    fill_nearest(run);
    ty_parallel_all(run->workers, run->height, 32, rows_measure, &run);
}

// --- v of the field ---

typedef struct extension
{
    const fill_run* run;
    float* v;
    const float* from;
} extension;

// The mean of the neighbours with a value, for those without; what was found comes into force when all have looked.
static void rows_extend(void* context, int64_t begin, int64_t end, int worker)
{
    static const int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    const extension* e = context;
    const fill_run* run = e->run;
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < run->width; x++)
        {
            float sum = 0.0f, count = 0.0f;
            if (!isnan(e->from[fill_cell(run, x, y)]))
                continue;
            for (int k = 0; k < 4; k++)
            {
                int i = x + steps[k][0], j = y + steps[k][1];
                if (i < 0 || i >= run->width || j < 0 || j >= run->height || isnan(e->from[fill_cell(run, i, j)]))
                    continue;
                sum += e->from[fill_cell(run, i, j)];
                count += 1.0f;
            }
            if (count > 0.0f)
                e->v[fill_cell(run, x, y)] = sum / count;
        }
}

static void rows_take(void* context, int64_t begin, int64_t end, int worker)
{
    const fill_run* run = *(const fill_run* const*)context;
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
    {
        float* v = run->v + fill_cell(run, 0, y);
        const uint8_t* closed = run->closed + fill_cell(run, 0, y);
        memcpy(v, ty_gray_scott_v(run->field, y), (size_t)run->width * sizeof(float));
        for (int x = 0; x < run->width; x++)
            v[x] = closed[x] ? NAN : v[x];
    }
}

void fill_take_v(const fill_run* run)
{
    size_t cells = fill_cells(run);
    uint8_t any = 0;
    for (size_t i = 0; i < cells; i++)
        any |= run->closed[i];
    ty_parallel_all(run->workers, run->height, 32, rows_take, &run);
    for (int pass = 0; pass < 2 && any; pass++)
    {
        extension e = {run, run->v, run->near_x};
        memcpy(run->near_x, run->v, cells * sizeof(float));
        ty_parallel_all(run->workers, run->height, 32, rows_extend, &e);
    }
    for (size_t i = 0; i < cells && any; i++)
        run->v[i] = isnan(run->v[i]) ? 0.0f : run->v[i];
}
