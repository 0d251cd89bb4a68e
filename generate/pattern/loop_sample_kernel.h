// SPDX-License-Identifier: Apache-2.0
// A row of samples of a volume. Included by one file an instruction set; KERNEL names the set.
#include "loop_volume.h"
#include <tsuya/base/simd_gather.h>

#define JOIN(a, b) a##_##b
#define NAME(a, b) JOIN(a, b)

typedef struct lanes
{
    ty_f16 whole[3], part[3]; // floor of the place along each axis, and what is beyond
    uint32_t inside;          // one bit a lane
} lanes;

// Where sixteen pixels look: clamped to the volume, or wrapped.
static inline lanes lanes_find(const ty_loop_volume* volume, const ty_loop_grid* grid, int sampling, ty_f16 i, ty_f16 j)
{
    const float origin[3] = {grid->origin.x, grid->origin.y, grid->origin.z};
    const float across[3] = {grid->across.x, grid->across.y, grid->across.z};
    const float down[3] = {grid->down.x, grid->down.y, grid->down.z};
    const ty_f16 zero = ty_f16_set(0.0f), half = ty_f16_set(0.5f);
    lanes at = {.inside = 0xffff};
    for (int k = 0; k < 3; k++)
    {
        ty_f16 start = ty_f16_fma(j, ty_f16_set(down[k]), ty_f16_set(origin[k]));
        ty_f16 p = ty_f16_fma(i, ty_f16_set(across[k]), start);
        if (sampling == TY_LOOP_NEAREST)
            p = ty_f16_floor(ty_f16_add(p, half));
        const ty_f16 size = ty_f16_set((float)volume->size[k]);
        if (volume->wrap[k])
        {
            // The quotient may round to a whole number: then the rest is the size, or just below 0.
            p = ty_f16_fnma(size, ty_f16_floor(ty_f16_div(p, size)), p);
            p = ty_f16_max(p, zero);
            at.whole[k] = ty_f16_min(ty_f16_floor(p), ty_f16_sub(size, ty_f16_set(1.0f)));
        }
        else
        {
            const ty_f16 edge = ty_f16_sub(size, half), last = ty_f16_sub(size, ty_f16_set(1.0f));
            at.inside &= ty_f16_le(ty_f16_set(-0.5f), p) & ty_f16_le(p, edge);
            p = ty_f16_min(ty_f16_max(p, zero), last);
            at.whole[k] = ty_f16_floor(p);
        }
        at.part[k] = ty_f16_sub(p, at.whole[k]);
    }
    return at;
}

static inline ty_f16 blend(ty_f16 a, ty_f16 b, ty_f16 share)
{
    return ty_f16_fma(share, ty_f16_sub(b, a), a);
}

// Four pairs along x, blended along x, y, z.
static inline ty_f16 lanes_read(const ty_loop_volume* volume, const lanes* at)
{
    const ty_i16 row = ty_i16_set((int32_t)volume->row), slice = ty_i16_set((int32_t)volume->slice);
    ty_i16 index = ty_i16_add(ty_f16_to_int(at->whole[0]), ty_i16_mul(ty_f16_to_int(at->whole[1]), row));
    index = ty_i16_add(index, ty_i16_mul(ty_f16_to_int(at->whole[2]), slice));
    const ty_i16 below = ty_i16_add(index, row);
    ty_f16 first, second, sum[2];
    ty_u16_gather_pairs(volume->values, index, &first, &second);
    ty_f16 upper = blend(first, second, at->part[0]);
    ty_u16_gather_pairs(volume->values, below, &first, &second);
    sum[0] = blend(upper, blend(first, second, at->part[0]), at->part[1]);
    ty_u16_gather_pairs(volume->values, ty_i16_add(index, slice), &first, &second);
    upper = blend(first, second, at->part[0]);
    ty_u16_gather_pairs(volume->values, ty_i16_add(below, slice), &first, &second);
    sum[1] = blend(upper, blend(first, second, at->part[0]), at->part[1]);
    return ty_f16_div(blend(sum[0], sum[1], at->part[2]), ty_f16_set(TY_LOOP_ONE));
}

void NAME(ty_loop_sample, KERNEL)(const ty_loop_volume* volume, const ty_loop_grid* grid, int sampling, int j, int from,
                                  int to, float* out)
{
    _Alignas(64) float pixels[TY_LANES], values[TY_LANES];
    const ty_f16 row = ty_f16_set((float)j);
    for (int i = from; i < to; i += TY_LANES)
    {
        for (int k = 0; k < TY_LANES; k++)
            pixels[k] = (float)(i + k);
        const lanes at = lanes_find(volume, grid, sampling, ty_f16_load(pixels), row);
        ty_f16_store(values, lanes_read(volume, &at));
        for (int k = 0; at.inside != 0xffff && k < TY_LANES; k++)
            if (!(at.inside >> k & 1))
                values[k] = 0.0f;
        int count = to - i < TY_LANES ? to - i : TY_LANES;
        for (int k = 0; k < count; k++)
            out[i - from + k] = values[k];
    }
}
