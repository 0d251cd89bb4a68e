// SPDX-License-Identifier: Apache-2.0
// Samples of a volume for what every machine of the build has.
#define KERNEL base
#include "loop_sample_kernel.h"

// As the kernel for one axis; false = outside.
static bool find(float place, int size, bool wrap, int sampling, int* whole, float* part)
{
    float n = (float)size;
    if (sampling == TY_LOOP_NEAREST)
        place = floorf(place + 0.5f);
    if (!wrap && !(place >= -0.5f && place <= n - 0.5f))
        return false;
    if (wrap)
        place = ty_max(fmaf(-n, floorf(place / n), place), 0.0f);
    else
        place = ty_clamp(place, 0.0f, n - 1.0f);
    *whole = (int)ty_min(floorf(place), n - 1.0f);
    *part = place - (float)*whole;
    return true;
}

ty_loop_corners ty_loop_corners_of(const ty_loop_volume* volume, const ty_loop_grid* grid, int sampling, int i, int j)
{
    const float x = (float)i, y = (float)j;
    const float place[3] = {fmaf(x, grid->across.x, fmaf(y, grid->down.x, grid->origin.x)),
                            fmaf(x, grid->across.y, fmaf(y, grid->down.y, grid->origin.y)),
                            fmaf(x, grid->across.z, fmaf(y, grid->down.z, grid->origin.z))};
    ty_loop_corners corners = {0};
    int whole[3] = {0, 0, 0};
    float part[3] = {0.0f, 0.0f, 0.0f};
    bool inside = true;
    for (int k = 0; k < 3; k++)
        inside &= find(place[k], volume->size[k], volume->wrap[k], sampling, &whole[k], &part[k]);
    size_t first = inside ? ty_loop_voxel(volume, whole[0], whole[1], whole[2]) : 0;
    for (int c = 0; c < 8; c++)
    {
        size_t right = c & 1, below = c >> 1 & 1, next = c >> 2;
        corners.at[c] = first + right + below * volume->row + next * volume->slice;
        corners.weight[c] = !inside ? 0.0f
                                    : (right ? part[0] : 1.0f - part[0]) * (below ? part[1] : 1.0f - part[1]) *
                                          (next ? part[2] : 1.0f - part[2]);
    }
    return corners;
}
