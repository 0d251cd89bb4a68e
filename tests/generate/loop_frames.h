// SPDX-License-Identifier: Apache-2.0
// Volumes and recipes of looping textures for tests, and their frames as inside and outside.
#pragma once
#include "../../generate/pattern/loop_frame.h"
#include "../../generate/pattern/loop_report.h"
#include "base/cmocka_all.h"
#include <string.h>
#include <tsuya/base/memory.h>

// Waves of random directions, about `wave` voxels long, that wrap along x and y where told.
static inline ty_loop_volume loop_waves(int size, float wave, bool wraps, uint64_t seed)
{
    ty_loop_volume v;
    const int sizes[3] = {size, size, size};
    assert_int_equal(ty_loop_volume_create(sizes, false, false, &v, NULL), TY_OK);
    ty_rng rng = ty_rng_make((ty_seed){seed}, 1, 2);
    float k[12][4];
    for (int i = 0; i < 12; i++)
        for (int c = 0; c < 4; c++)
            k[i][c] = floorf((float)size / wave * ty_rng_range(&rng, -1.0f, 1.0f) + 0.5f);
    for (int z = 0; z < size; z++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++)
            {
                float sum = 0.0f;
                for (int i = 0; i < 12; i++)
                    sum += ty_sin(2.0f * TY_PI / (float)size *
                                      (k[i][0] * (float)x + k[i][1] * (float)y + k[i][2] * (float)z) +
                                  k[i][3]);
                v.values[ty_loop_voxel(&v, x, y, z)] = ty_loop_number_of(0.5f + 0.12f * sum);
            }
    v.wrap[0] = v.wrap[1] = wraps;
    ty_loop_volume_close(&v);
    return v;
}

// Which pixels of frame i are inside: [height][width], the caller's.
static inline uint8_t* loop_inside(const ty_loop_recipe* recipe, const ty_loop_volume* volume, int i)
{
    ty_loop_painter* painter;
    ty_exr* image;
    assert_int_equal(ty_loop_painter_create(recipe, volume, NULL, &painter, NULL), TY_OK);
    assert_int_equal(ty_loop_painter_paint(painter, i, &image, NULL), TY_OK);
    int n = recipe->size[0] * recipe->size[1];
    uint8_t* inside = TY_ALLOC(uint8_t, n);
    for (int p = 0; p < n; p++)
        inside[p] = ty_loop_painter_coverage(painter)[p] >= 0.5f;
    ty_exr_destroy(image);
    ty_loop_painter_destroy(painter);
    return inside;
}

static inline double loop_changed(const uint8_t* a, const uint8_t* b, int pixels)
{
    int changed = 0;
    for (int i = 0; i < pixels; i++)
        changed += a[i] != b[i];
    return (double)changed / pixels;
}

static inline ty_vec3 loop_any(ty_rng* rng, float most)
{
    float x = ty_rng_range(rng, -most, most), y = ty_rng_range(rng, -most, most);
    return (ty_vec3){x, y, ty_rng_range(rng, -most, most)};
}

// Three keys of a path that wanders a little.
static inline void loop_keys_draw(ty_rng* rng, ty_loop_key keys[3])
{
    for (int k = 0; k < 3; k++)
        keys[k] = (ty_loop_key){.at = (float)k / 3.0f + ty_rng_range(rng, 0.0f, 0.2f),
                                .move = loop_any(rng, 0.1f),
                                .rotate = loop_any(rng, 0.3f),
                                .scale = {ty_rng_range(rng, 0.9f, 1.1f), 1.0f},
                                .axis_move = loop_any(rng, 0.1f),
                                .axis_rotate = loop_any(rng, 0.2f)};
}
