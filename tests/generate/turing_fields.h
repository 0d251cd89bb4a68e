// SPDX-License-Identifier: Apache-2.0
// Turing fields for tests: made, started, run, and discs cut out of them.
#pragma once
#include "../../generate/pattern/turing_state.h"
#include "base/cmocka_all.h"
#include <math.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/rng.h>

static inline ty_turing* create(const ty_turing_def* def)
{
    ty_turing* field;
    ty_error error;
    assert_int_equal(ty_turing_create(def, &field, &error), TY_OK);
    return field;
}

static inline void need(ty_turing* field, ty_turing_plane plane)
{
    ty_error error;
    assert_int_equal(ty_turing_need(field, plane, &error), TY_OK);
}

static inline void start_by_chance(ty_turing* field, uint64_t seed)
{
    ty_rng rng = ty_rng_make((ty_seed){seed}, 1, 0);
    for (int y = 0; y < field->def.height; y++)
        for (int x = 0; x < field->def.width; x++)
        {
            ty_turing_u(field, y)[x] = ty_rng_float(&rng);
            ty_turing_v(field, y)[x] = ty_rng_float(&rng);
        }
}

// The numbers that the known figures come from (xorshift64: Marsaglia 2003).
static inline double xorshift(uint64_t* state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) * (1.0 / 9007199254740992.0);
}

static inline void start_by_xorshift(ty_turing* field, int start)
{
    uint64_t state = 4242u + 7919u * (uint64_t)start;
    for (int i = 0; i < 20 && start; i++)
        xorshift(&state);
    for (int y = 0; y < field->def.height; y++)
        for (int x = 0; x < field->def.width; x++)
        {
            ty_turing_u(field, y)[x] = (float)xorshift(&state);
            ty_turing_v(field, y)[x] = (float)xorshift(&state);
        }
}

static inline void run_until(ty_turing* field, float time)
{
    ty_turing_step(field, (int)(time / ty_turing_time_step(field) + 0.5f), NULL);
}

static inline ty_turing_def preset(float constant, float du, float dv, int size)
{
    ty_turing_def def = ty_turing_def_default();
    def.width = def.height = size;
    def.u.constant = constant;
    def.u.diffusion = du;
    def.v.diffusion = dv;
    return def;
}

static inline float distance(int x, int y)
{
    return sqrtf(ty_sqr((float)x - 100.0f) + ty_sqr((float)y - 100.0f));
}

// Share of the gradient's energy along the radius, between two radii.
static inline float normal_share(ty_turing* field, float low, float high)
{
    double normal = 0.0, all = 0.0;
    for (int y = 1; y < 199; y++)
        for (int x = 1; x < 199; x++)
        {
            float d = distance(x, y);
            if (d < low || d > high)
                continue;
            float gx = ty_turing_u(field, y)[x + 1] - ty_turing_u(field, y)[x - 1];
            float gy = ty_turing_u(field, y + 1)[x] - ty_turing_u(field, y - 1)[x];
            float along = (gx * ((float)x - 100.0f) + gy * ((float)y - 100.0f)) / d;
            normal += (double)ty_sqr(along);
            all += (double)(gx * gx + gy * gy);
        }
    return (float)(normal / all);
}

// A disc of radius 85 in 200 x 200 cells, to be started: its rim held at U 5, V 0, or nothing passes it; `soft` cells
// wide.
static inline ty_turing* disc(bool fixed, float soft)
{
    ty_turing_def def = preset(0.05f, 0.04f, 0.5f, 200);
    ty_turing* field = create(&def);
    need(field, TY_TURING_HOLD);
    if (!fixed)
        need(field, TY_TURING_OPEN);
    for (int y = 0; y < 200; y++)
        for (int x = 0; x < 200; x++)
        {
            float inside = soft > 0.0f ? ty_clamp((85.0f - distance(x, y)) / soft + 0.5f, 0.0f, 1.0f)
                                       : (distance(x, y) < 85.0f ? 1.0f : 0.0f);
            float rate = inside > 0.0f ? fixed ? 0.06f * (1.0f - inside) / inside : 0.0f : INFINITY;
            ty_turing_row(field, TY_TURING_HOLD, y)[x] = rate;
            ty_turing_row(field, TY_TURING_HOLD_U, y)[x] = 5.0f;
            if (!fixed)
                ty_turing_row(field, TY_TURING_OPEN, y)[x] = inside;
        }
    return field;
}
