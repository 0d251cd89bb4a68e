// SPDX-License-Identifier: Apache-2.0
// Gray–Scott: what is conserved and what walls keep apart, the bound on the step, what is refused.
#include "base/cmocka_all.h"
#include <string.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/generate/gray_scott.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

static ty_gray_scott* make(const ty_gray_scott_def* def)
{
    ty_gray_scott* field;
    ty_error error;
    assert_int_equal(ty_gray_scott_create(def, &field, &error), TY_OK);
    return field;
}

// Without feed and kill nothing comes or goes, over wrapped edges and closed ones.
static void amounts_are_kept(void** state)
{
    (void)state;
    for (int edges = 0; edges < 4; edges++)
    {
        ty_gray_scott_def def = ty_gray_scott_def_default();
        def.width = 37;
        def.height = 19;
        def.rates[0] = (ty_gray_scott_rates){0.0f, 0.0f};
        def.wrap_x = edges & 1;
        def.wrap_y = edges >> 1;
        ty_gray_scott* field = make(&def);
        ty_rng rng = ty_rng_make((ty_seed){2}, 0, 0);
        ty_gray_scott_drop(field, 1.0f, 1.0f, 6.0f, &rng); // reaches over the edges
        double before = 0.0, after = 0.0, far = 0.0;
        for (int pass = 0; pass < 2; pass++)
        {
            double sum = 0.0;
            for (int y = 0; y < def.height; y++)
                for (int x = 0; x < def.width; x++)
                    sum += (double)(ty_gray_scott_u(field, y)[x] + ty_gray_scott_v(field, y)[x]);
            *(pass ? &after : &before) = sum;
            far = (double)ty_gray_scott_v(field, 9)[def.width - 1];
            ty_gray_scott_step(field, 40, NULL);
        }
        assert_float_equal((float)(after / before), 1.0f, 1e-6f);
        assert_true(def.wrap_x ? far > 1e-3 : far < 1e-6); // the far side is the neighbour, or is not
        ty_gray_scott_destroy(field);
    }
}

// A chamber of barriers in the middle and a slanted wall one cell thick: what is on either side keeps its own.
static double sum_where(ty_gray_scott* field, int n, const uint8_t* side, uint8_t which)
{
    double sum = 0.0;
    for (int y = 0; y < n; y++)
        for (int x = 0; x < n; x++)
            if (side[y * n + x] == which)
                sum += (double)ty_gray_scott_v(field, y)[x];
    return sum;
}

static void barriers_let_nothing_through(void** state)
{
    enum
    {
        N = 61,
        LEFT = 1,
        RIGHT = 2
    };
    (void)state;
    for (int stencil = 5; stencil <= 9; stencil += 4)
    {
        static uint8_t side[N * N];
        ty_gray_scott_def def = ty_gray_scott_def_default();
        def.width = def.height = N;
        def.stencil = stencil;
        def.rates[0] = (ty_gray_scott_rates){0.0f, 0.0f};
        def.wrap_x = def.wrap_y = false;
        ty_gray_scott* field = make(&def);
        for (int y = 0; y < N; y++)
            for (int x = 0; x < N; x++)
            {
                bool wall = x + y == N - 1;
                side[y * N + x] = wall ? 0 : x + y < N - 1 ? LEFT : RIGHT;
                ty_gray_scott_marks(field, y)[x] = wall ? TY_GRAY_SCOTT_BARRIER : 0;
                ty_gray_scott_u(field, y)[x] = 0.0f; // no reaction
                ty_gray_scott_v(field, y)[x] = wall ? 7.0f : x + y < N - 1 ? (float)(x % 3) / 3.0f : 0.0f;
            }
        double before = sum_where(field, N, side, LEFT);
        ty_gray_scott_step(field, 400, NULL);
        assert_float_equal((float)(sum_where(field, N, side, LEFT) / before), 1.0f, 2e-6f);
        assert_true(sum_where(field, N, side, RIGHT) == 0.0);
        assert_true(ty_gray_scott_v(field, 0)[N - 1] == 7.0f); // a barrier's cell is left as it is
        ty_gray_scott_destroy(field);
    }
}

#if defined(__SSE__)
// Every value below the smallest normal one: such arithmetic takes the processor twenty times as long, so that it must
// not happen. Seen in the outcome: they are nothing, on each thread; and afterwards they are something again.
static void the_smallest_values_are_flushed(void** state)
{
    (void)state;
    ty_gray_scott_def def = ty_gray_scott_def_default();
    def.width = 64;
    def.height = 600;
    const unsigned mode = _mm_getcsr();
    for (int threads = 1; threads <= 3; threads++)
    {
        ty_workers* crew;
        ty_error error;
        assert_int_equal(ty_workers_create(threads, &crew, &error), TY_OK);
        ty_gray_scott* field = make(&def);
        assert_true(ty_gray_scott_tune(field, (ty_gray_scott_tuning){.bands = 12}));
        for (int y = 0; y < def.height; y++)
            for (int x = 0; x < def.width; x++)
                ty_gray_scott_v(field, y)[x] = 1e-39f;
        ty_gray_scott_step(field, 1, threads == 1 ? NULL : crew);
        for (int y = 0; y < def.height; y++)
            for (int x = 0; x < def.width; x++)
                assert_true(ty_gray_scott_v(field, y)[x] == 0.0f);
        assert_int_equal(_mm_getcsr(), mode);
        ty_gray_scott_destroy(field);
        ty_workers_destroy(crew);
    }
}
#endif

// Just below the bound a field of the fastest wave calms down.
static void the_bound_is_where_waves_grow(void** state)
{
    (void)state;
    for (int stencil = 5; stencil <= 9; stencil += 4)
    {
        ty_gray_scott_def def = ty_gray_scott_def_default();
        def.width = def.height = 64;
        def.stencil = stencil;
        float limit = ty_gray_scott_time_limit(&def);
        def.time_step = 0.999f * limit;
        ty_gray_scott* field = make(&def);
        for (int y = 0; y < 64; y++)
            for (int x = 0; x < 64; x++)
                ty_gray_scott_u(field, y)[x] = (x + y) % 2 ? 1.2f : 0.8f;
        ty_gray_scott_step(field, 400, NULL);
        for (int x = 0; x < 64; x++)
            assert_float_equal(ty_gray_scott_u(field, 5)[x], 1.0f, 1e-3f);
        ty_gray_scott_destroy(field);
        def.time_step = 1.001f * limit;
        ty_error error;
        assert_int_equal(ty_gray_scott_create(&def, &field, &error), TY_BAD_INPUT);
    }
}

static void impossible_ones_are_refused(void** state)
{
    (void)state;
    ty_gray_scott* field;
    ty_error error;
    ty_gray_scott_def def = ty_gray_scott_def_default();
    def.width = 7;
    assert_int_equal(ty_gray_scott_create(&def, &field, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "8..32768"));
    def = ty_gray_scott_def_default();
    def.diffusion_u = 0.25f; // diverges at time_step 1
    assert_int_equal(ty_gray_scott_create(&def, &field, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "time_step: 1; with these diffusions it lies above 0 and below 0.9091"));
    def.stencil = 9; // 16/3 instead of 8
    assert_int_equal(ty_gray_scott_create(&def, &field, &error), TY_OK);
    ty_gray_scott_destroy(field);
    def.stencil = 7;
    assert_int_equal(ty_gray_scott_create(&def, &field, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "there are 5 and 9"));
    def = ty_gray_scott_def_default();
    def.rate_count = 17;
    assert_int_equal(ty_gray_scott_create(&def, &field, &error), TY_BAD_INPUT);
    def.rate_count = 1;
    def.rates[0].kill = -0.1f;
    assert_int_equal(ty_gray_scott_create(&def, &field, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "mark 0"));
    def = ty_gray_scott_def_default();
    def.diffusion_v = NAN;
    assert_int_equal(ty_gray_scott_create(&def, &field, &error), TY_BAD_INPUT);
    def = ty_gray_scott_def_default();
    ty_memory_fail_after(0);
    assert_int_equal(ty_gray_scott_create(&def, &field, &error), TY_NO_MEMORY);
    assert_null(field);
    ty_memory_fail_after(-1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(amounts_are_kept),
        cmocka_unit_test(barriers_let_nothing_through),
#if defined(__SSE__)
        cmocka_unit_test(the_smallest_values_are_flushed),
#endif
        cmocka_unit_test(the_bound_is_where_waves_grow),
        cmocka_unit_test(impossible_ones_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
