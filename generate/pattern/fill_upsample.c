// SPDX-License-Identifier: Apache-2.0
// From cells to pixels: a cubic through both axes, across edges that wrap.
#include "cubic.h"
#include "fill_show.h"
#include <string.h>
#include <tsuya/base/memory.h>

typedef struct upsampling
{
    const fill_show_state* show;
    const float* cells;
    float* pixels;
} upsampling;

// The line of cells through the middle of row y of the frame.
static void line_blend(const upsampling* u, int y, float* line)
{
    const fill_run* run = u->show->run;
    float at = ((float)y + 0.5f) / (float)run->recipe->scale - 0.5f, whole = floorf(at), weight[4];
    cubic_weights(at - whole, weight);
    memset(line, 0, (size_t)run->width * sizeof *line);
    for (int k = 0; k < 4; k++)
    {
        const float* row = u->cells + fill_cell(run, 0, cubic_neighbour((int)whole - 1 + k, run->height, run->wrap_y));
        for (int x = 0; x < run->width; x++)
            line[x] += weight[k] * row[x];
    }
}

static void rows_upsample(void* context, int64_t begin, int64_t end, int worker)
{
    const upsampling* u = context;
    const fill_run* run = u->show->run;
    (void)worker;
    float* line = TY_ALLOC(float, run->width);
    for (int y = (int)begin; y < (int)end; y++)
    {
        line_blend(u, y, line);
        for (int x = 0; x < u->show->width; x++)
        {
            float at = ((float)x + 0.5f) / (float)run->recipe->scale - 0.5f + u->show->drift, whole = floorf(at);
            float weight[4], value = 0.0f;
            cubic_weights(at - whole, weight);
            for (int k = 0; k < 4; k++)
                value += weight[k] * line[cubic_neighbour((int)whole - 1 + k, run->width, run->wrap_x)];
            u->pixels[(size_t)y * (size_t)u->show->width + (size_t)x] = value;
        }
    }
    ty_free(line);
}

bool fill_upsample(const fill_show_state* show, const float* cells, float* pixels)
{
    upsampling u = {show, cells, pixels};
    return ty_parallel_for(show->run->workers, show->height, 16, rows_upsample, &u);
}

void fill_pixel_cell(const fill_show_state* show, int x, int y, int* cell_x, int* cell_y)
{
    const fill_run* run = show->run;
    int i = (int)floorf(((float)x + 0.5f) / (float)run->recipe->scale + show->drift);
    *cell_x = cubic_neighbour(i, run->width, run->wrap_x);
    *cell_y = y / run->recipe->scale;
}
