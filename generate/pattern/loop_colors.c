// SPDX-License-Identifier: Apache-2.0
// Colours that the reaction itself carries: v = sum of v_c, each v_c' = Dv lap v_c + u v v_c - (F + k) v_c, so that the
// sum obeys Gray–Scott whatever the colours are.
#include "loop_volume.h"

typedef struct carriage
{
    ty_gray_scott* field;
    const ty_loop_reaction* def;
    int width, height;
    const float* from;
    float* to;
} carriage;

// Rows [begin, end) of all planes, one after another.
static void rows_step(void* context, int64_t begin, int64_t end, int worker)
{
    const carriage* r = context;
    (void)worker;
    int w = r->width, h = r->height;
    size_t width = (size_t)w, plane = width * (size_t)h;
    float dt = r->def->time_step, dv = r->def->diffusion_v, loss = r->def->feed + r->def->kill;
    for (int64_t row = begin; row < end; row++)
    {
        int y = (int)(row % h);
        const float *u = ty_gray_scott_u(r->field, y), *v = ty_gray_scott_v(r->field, y);
        const float* all = r->from + (size_t)(row / h) * plane;
        const float *c = all + (size_t)y * width, *up = all + (size_t)((y + h - 1) % h) * width,
                    *down = all + (size_t)((y + 1) % h) * width;
        float* restrict out = r->to + (size_t)row * width;
        for (int x = 0; x < w; x += w - 1) // the ends, which are neighbours
        {
            float lap = c[(x + w - 1) % w] + c[(x + 1) % w] + (up[x] + down[x]) - 4.0f * c[x];
            out[x] = c[x] + dt * (dv * lap + (u[x] * v[x] - loss) * c[x]);
        }
        for (int x = 1; x < w - 1; x++)
        {
            float lap = c[x - 1] + c[x + 1] + (up[x] + down[x]) - 4.0f * c[x];
            out[x] = c[x] + dt * (dv * lap + (u[x] * v[x] - loss) * c[x]);
        }
    }
}

bool ty_loop_colors_step(ty_gray_scott* field, const ty_loop_reaction* def, const int size[2], int colors,
                         const float* from, float* to, ty_workers* workers)
{
    carriage r = {field, def, size[0], size[1], from, to};
    return ty_parallel_for(workers, (int64_t)colors * size[1], 16, rows_step, &r);
}
