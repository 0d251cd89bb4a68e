// SPDX-License-Identifier: Apache-2.0
// A Gaussian over a plane, rows side by side on all threads.
#include "filter_run.h"
#include <math.h>
#include <string.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>

enum
{
    REACH = 200, // the most: 4 sigma of 50 cells
    ROWS = 16    // of a range
};

typedef struct blurring
{
    const float* in;
    float* out;
    int width, height, reach;
    float weights[REACH + 1];
} blurring;

static void rows_across(void* context, int64_t begin, int64_t end, int worker)
{
    const blurring* b = context;
    int w = b->width;
    float *padded = TY_ALLOC(float, w + 2 * b->reach), *line = padded + b->reach;
    (void)worker;
    for (int64_t y = begin; y < end; y++)
    {
        float* out = b->out + (size_t)y * (size_t)w;
        memcpy(line, b->in + (size_t)y * (size_t)w, (size_t)w * sizeof *line);
        for (int k = 1; k <= b->reach; k++)
        {
            line[-k] = line[0];
            line[w - 1 + k] = line[w - 1];
        }
        for (int x = 0; x < w; x++)
            out[x] = b->weights[0] * line[x];
        for (int k = 1; k <= b->reach; k++)
            for (int x = 0; x < w; x++)
                out[x] += b->weights[k] * (line[x - k] + line[x + k]);
    }
    ty_free(padded);
}

static void rows_down(void* context, int64_t begin, int64_t end, int worker)
{
    const blurring* b = context;
    int w = b->width;
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
    {
        float* out = b->out + (size_t)y * (size_t)w;
        const float* at = b->in + (size_t)y * (size_t)w;
        for (int x = 0; x < w; x++)
            out[x] = b->weights[0] * at[x];
        for (int k = 1; k <= b->reach; k++)
        {
            const float* above = b->in + (size_t)(y > k ? y - k : 0) * (size_t)w;
            const float* below = b->in + (size_t)(y + k < b->height ? y + k : b->height - 1) * (size_t)w;
            for (int x = 0; x < w; x++)
                out[x] += b->weights[k] * (above[x] + below[x]);
        }
    }
}

void ty_filter_blur(float* plane, float* scratch, int width, int height, float sigma, ty_workers* workers)
{
    blurring b = {.in = plane, .out = scratch, .width = width, .height = height};
    b.reach = (int)ceilf(ty_min(4.0f * sigma, (float)REACH));
    float sum = 0.0f;
    for (int k = 0; k <= b.reach; k++)
    {
        b.weights[k] = ty_exp(-0.5f * ty_sqr((float)k / sigma));
        sum += k ? 2.0f * b.weights[k] : b.weights[k];
    }
    for (int k = 0; k <= b.reach; k++)
        b.weights[k] /= sum;
    ty_parallel_all(workers, height, ROWS, rows_across, &b);
    b.in = scratch;
    b.out = plane;
    ty_parallel_all(workers, height, ROWS, rows_down, &b);
}
