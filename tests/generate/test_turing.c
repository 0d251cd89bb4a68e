// SPDX-License-Identifier: Apache-2.0
// A Turing field: the patterns that it is known for, what edges do, what limits and masks keep, equal bits.
#include "turing_fields.h"
#include <string.h>

// The kernel a cell at a time.
#if !defined(__clang__)
#pragma GCC push_options
#pragma GCC optimize("no-tree-vectorize")
#endif
#define KERNEL one_by_one
stream_row_fn ty_turing_row_one_by_one;
#include "../../generate/pattern/turing_row_kernel.h"
#if !defined(__clang__)
#pragma GCC pop_options
#endif

typedef struct census
{
    float bright;          // share of cells above 3
    int spots, dark_spots; // pieces of either kind
} census;

static int pieces(const uint8_t* bright, int w, int h, uint8_t kind)
{
    uint8_t* seen = TY_ALLOC(uint8_t, w * h);
    int *stack = TY_ALLOC(int, w*h), count = 0;
    for (int i = 0; i < w * h; i++)
    {
        if (seen[i] || bright[i] != kind)
            continue;
        int top = 0;
        stack[top++] = i;
        seen[i] = 1;
        count++;
        while (top)
        {
            int at = stack[--top], x = at % w, y = at / w;
            const int near[4] = {x ? at - 1 : at, x + 1 < w ? at + 1 : at, y ? at - w : at, y + 1 < h ? at + w : at};
            for (int k = 0; k < 4; k++)
                if (!seen[near[k]] && bright[near[k]] == kind)
                {
                    seen[near[k]] = 1;
                    stack[top++] = near[k];
                }
        }
    }
    ty_free(stack);
    ty_free(seen);
    return count;
}

static census take_census(ty_turing* field)
{
    int w = field->def.width, h = field->def.height, sum = 0;
    uint8_t* bright = TY_ALLOC(uint8_t, w * h);
    for (int i = 0; i < w * h; i++)
        sum += bright[i] = ty_turing_u(field, i / w)[i % w] > 3.0f;
    census c = {(float)sum / (float)(w * h), pieces(bright, w, h, 1), pieces(bright, w, h, 0)};
    ty_free(bright);
    return c;
}

static census census_of(const ty_turing_def* def)
{
    ty_turing* field = create(def);
    start_by_chance(field, 4242);
    run_until(field, 2000.0f);
    census c = take_census(field);
    ty_turing_destroy(field);
    return c;
}

// Stripes are few long pieces of both kinds, spots many pieces of one on a ground in one.
static void three_presets_are_told_apart(void** state)
{
    (void)state;
    ty_turing_def stripes = preset(0.05f, 0.08f, 1.0f, 200), spots = preset(0.0f, 0.04f, 0.5f, 200);
    ty_turing_def inverse = preset(0.2f, 0.04f, 0.5f, 200);
    census a = census_of(&stripes), b = census_of(&spots), c = census_of(&inverse);
    print_message("stripes %.3f %d %d; spots %.3f %d %d; inverse %.3f %d %d\n", (double)a.bright, a.spots, a.dark_spots,
                  (double)b.bright, b.spots, b.dark_spots, (double)c.bright, c.spots, c.dark_spots);
    assert_true(a.bright > 0.38f && a.bright < 0.52f && a.spots < 60 && a.dark_spots < 60);
    assert_true(b.bright > 0.18f && b.bright < 0.3f && b.spots > 280 && b.spots < 430 && b.dark_spots < 20);
    assert_true(c.bright > 0.7f && c.bright < 0.92f && c.dark_spots > 280 && c.spots < 20);
}

static void larger_diffusion_is_coarser(void** state)
{
    (void)state;
    ty_turing_def fine = preset(0.0f, 0.04f, 0.5f, 200), coarse = preset(0.0f, 0.16f, 2.0f, 200);
    census a = census_of(&fine), b = census_of(&coarse);
    print_message("%d spots, %d at four times the diffusion\n", a.spots, b.spots);
    assert_true(b.spots * 3 < a.spots && b.spots * 5 > a.spots); // an area of four times each
}

// --- edges ---

// Fixed edges of the grid are held, and far sides are neighbours where it wraps.
static void edges_hold_free_or_wrap(void** state)
{
    (void)state;
    ty_turing_def def = preset(0.05f, 0.04f, 0.5f, 64);
    float share[3];
    for (int edge = 0; edge < 3; edge++)
    {
        def.edge = edge;
        ty_turing* field = create(&def);
        start_by_chance(field, 1);
        run_until(field, 3000.0f);
        double seam = 0.0, near = 0.0;
        for (int x = 0; x < 64; x++)
        {
            seam += fabs((double)(ty_turing_u(field, 0)[x] - ty_turing_u(field, 63)[x]));
            near += fabs((double)(ty_turing_u(field, 30)[x] - ty_turing_u(field, 31)[x]));
        }
        share[edge] = (float)(seam / near);
        for (int x = 0; x < 64 && edge == TY_TURING_FIXED; x++)
            assert_true(ty_turing_u(field, 0)[x] > 3.0f && ty_turing_u(field, x)[63] > 3.0f);
        ty_turing_destroy(field);
    }
    assert_true(share[TY_TURING_WRAP] < 2.0f);
    assert_true(share[TY_TURING_FREE] > 2.0f);
}

// --- what is kept ---

// U in all, without reactions.
static double sum_after(ty_turing_limit limit, bool conservative, bool half_open)
{
    ty_turing_def def = preset(0.0f, 0.2f, 0.2f, 64);
    def.u.u = def.u.v = def.u.decay = def.v.u = def.v.constant = def.v.decay = 0.0f;
    def.limit = limit;
    def.limit_conservative = conservative;
    ty_turing* field = create(&def);
    if (half_open)
    {
        need(field, TY_TURING_OPEN);
        need(field, TY_TURING_HOLD);
    }
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++)
        {
            bool inside = x > 20 && x < 44;
            ty_turing_u(field, y)[x] = inside && y > 10 ? 5.0f : 0.5f;
            if (half_open && !inside)
            {
                ty_turing_row(field, TY_TURING_OPEN, y)[x] = 0.0f;
                ty_turing_row(field, TY_TURING_HOLD, y)[x] = INFINITY;
            }
        }
    double before = 0.0, after = 0.0;
    for (int i = 0; i < 64 * 64; i++)
        before += i % 64 > 20 && i % 64 < 44 ? (double)ty_turing_u(field, i / 64)[i % 64] : half_open ? 0.0 : 0.5;
    ty_turing_step(field, 500, NULL);
    for (int i = 0; i < 64 * 64; i++)
        after += (double)ty_turing_u(field, i / 64)[i % 64];
    ty_turing_destroy(field);
    return after / before - 1.0;
}

static void a_divergence_keeps_the_sum(void** state)
{
    (void)state;
    assert_true(fabs(sum_after(TY_TURING_LIMIT_NONE, false, false)) < 1e-5);
    assert_true(fabs(sum_after(TY_TURING_LIMIT_BOTH, true, false)) < 1e-5);
    assert_true(fabs(sum_after(TY_TURING_LIMIT_U, false, false)) > 1e-3);
    assert_true(fabs(sum_after(TY_TURING_LIMIT_NONE, false, true)) < 1e-5); // no-flux rims lose nothing
}

// An activator that spreads faster along x makes stripes along x (Shoji, Iwasa, Mochizuki & Kondo 2002).
static void stripes_follow_the_activators_direction(void** state)
{
    (void)state;
    ty_turing_def def = preset(0.05f, 0.04f, 0.5f, 96);
    def.edge = TY_TURING_WRAP;
    static const float angles[3][2] = {{1.0f, 0.0f}, {-1.0f, 0.0f}, {0.0f, 1.0f}};
    for (int a = 0; a < 3; a++)
    {
        ty_turing* field = create(&def);
        need(field, TY_TURING_ALONG_COS);
        for (int y = 0; y < 96; y++)
            for (int x = 0; x < 96; x++)
            {
                ty_turing_row(field, TY_TURING_ALONG_COS, y)[x] = 0.6f * angles[a][0];
                ty_turing_row(field, TY_TURING_ALONG_SIN, y)[x] = 0.6f * angles[a][1];
            }
        start_by_chance(field, 3);
        run_until(field, 2000.0f);
        double along = 0.0, across = 0.0;
        for (int y = 1; y < 95; y++)
            for (int x = 1; x < 95; x++)
            {
                float gx = ty_turing_u(field, y)[x + 1] - ty_turing_u(field, y)[x - 1];
                float gy = ty_turing_u(field, y + 1)[x] - ty_turing_u(field, y - 1)[x];
                // Rows go down: of the third, along is down to the right.
                along += (double)ty_sqr(a == 0 ? gx : a == 1 ? gy : 0.70710678f * (gx + gy));
                across += (double)ty_sqr(a == 0 ? gy : a == 1 ? gx : 0.70710678f * (gx - gy));
            }
        print_message("direction %d: gradient across / along %.2f\n", a, across / along);
        assert_true(across > 3.0 * along);
        ty_turing_destroy(field);
    }
}

// --- bits ---

// A field that uses everything.
static ty_turing* rich(int limit, bool conservative, ty_turing_edge edge, bool planes)
{
    ty_turing_def def = preset(0.05f, 0.04f, 0.5f, 150);
    def.width = 317; // neither a multiple of a vector nor of a segment
    def.limit = limit;
    def.limit_conservative = conservative;
    def.edge = edge;
    ty_turing* field = create(&def);
    start_by_chance(field, 9);
    for (int p = 0; p < TY_TURING_PLANES && planes; p++)
        need(field, p);
    ty_rng rng = ty_rng_make((ty_seed){5}, 2, 0);
    for (int y = 0; y < 150 && planes; y++)
        for (int x = 0; x < 317; x++)
        {
            float m = ty_rng_float(&rng);
            ty_turing_row(field, TY_TURING_CONSTANT, y)[x] = 0.2f * ty_rng_float(&rng);
            ty_turing_row(field, TY_TURING_OPEN, y)[x] = m < 0.2f ? 0.0f : m;
            ty_turing_row(field, TY_TURING_HOLD, y)[x] = m < 0.2f ? INFINITY : m > 0.9f ? 0.1f : 0.0f;
            ty_turing_row(field, TY_TURING_HOLD_U, y)[x] = 5.0f;
            ty_turing_row(field, TY_TURING_ALONG_COS, y)[x] = ty_rng_range(&rng, -0.4f, 0.4f);
            ty_turing_row(field, TY_TURING_ALONG_SIN, y)[x] = ty_rng_range(&rng, -0.4f, 0.4f);
        }
    return field;
}

static void assert_equal_fields(ty_turing* a, ty_turing* b)
{
    for (int y = 0; y < a->def.height; y++)
    {
        size_t size = (size_t)a->def.width * sizeof(float);
        assert_memory_equal(ty_turing_u(a, y), ty_turing_u(b, y), size);
        assert_memory_equal(ty_turing_v(a, y), ty_turing_v(b, y), size);
    }
}

static void threads_kernels_and_chunks_give_the_same_bits(void** state)
{
    (void)state;
    ty_error error;
    ty_workers* workers[4] = {NULL};
    for (int i = 1; i < 4; i++)
        assert_int_equal(ty_workers_create(i, &workers[i], &error), TY_OK);
    for (int kind = 0; kind < 6; kind++)
    {
        ty_turing_limit limit = kind < 2 ? TY_TURING_LIMIT_NONE : kind % 2 + 1;
        ty_turing* reference = rich(limit, kind == 4, kind % 3, kind > 0);
        reference->stream.row = ty_turing_row_base;
        reference->stream.depth = reference->stream.bands = 1;
        for (int i = 0; i < 70; i++)
            ty_turing_step(reference, 1, NULL);
        for (int i = 0; i < 4; i++)
        {
            ty_turing* field = rich(limit, kind == 4, kind % 3, kind > 0);
            if (i < 2)
                field->stream.row = i == 0 ? ty_turing_row_base : ty_turing_row_one_by_one;
            field->stream.depth = i == 1 ? 11 : 0;
            field->stream.strip = i == 2 ? 48 : 0;
            field->stream.bands = i == 3 ? 5 : 0;
            ty_turing_step(field, 33, workers[i]);
            ty_turing_step(field, 37, workers[i]);
            assert_equal_fields(reference, field);
            ty_turing_destroy(field);
        }
        ty_turing_destroy(reference);
    }
    for (int i = 1; i < 4; i++)
        ty_workers_destroy(workers[i]);
}

// A field of the shared disc with a limit, directions, or neither.
static ty_turing* disc_with(bool fixed, float soft, int kind)
{
    ty_turing* field = disc(fixed, soft);
    field->rates.limit = kind % 3;
    field->rates.conservative = kind == 4;
    if (kind == 3)
    {
        need(field, TY_TURING_ALONG_COS);
        for (int y = 0; y < 200; y++)
            ty_turing_row(field, TY_TURING_ALONG_COS, y)[100] = 0.5f;
    }
    start_by_chance(field, 7);
    return field;
}

// What rows leave out, far from rims and in what is held, changes nothing.
static void what_is_left_out_changes_no_bit(void** state)
{
    (void)state;
    for (int i = 0; i < 20; i++)
    {
        ty_turing* short_cut = disc_with(i % 2, i / 2 % 2 ? 3.0f : 0.0f, i / 4);
        ty_turing* all = disc_with(i % 2, i / 2 % 2 ? 3.0f : 0.0f, i / 4);
        ty_free(all->kinds);
        all->kinds = NULL;
        ty_turing_step(short_cut, 40, NULL);
        ty_turing_step(all, 40, NULL);
        assert_equal_fields(short_cut, all);
        int count[3] = {0};
        for (int k = 0; k < 200 * 12; k++)
            count[ty_turing_kinds(short_cut, k / 12)[k % 12]]++;
        assert_true(count[TY_TURING_MIXED] > 20 && count[TY_TURING_EVEN] > 1000 && count[TY_TURING_STILL] > 300);
        ty_turing_destroy(short_cut);
        ty_turing_destroy(all);
    }
}

// --- mistakes ---

static void the_step_has_a_bound(void** state)
{
    (void)state;
    ty_error error;
    ty_turing* field;
    ty_turing_def def = preset(0.05f, 0.08f, 1.0f, 64);
    assert_float_equal(ty_turing_step_default(&def), 0.225f, 1e-6f);
    assert_float_equal(ty_turing_step_bound(&def), 2.0f / 8.06f, 1e-6f);
    def.time_step = 0.25f;
    assert_int_equal(ty_turing_create(&def, &field, &error), TY_BAD_INPUT);
    assert_null(field);
    assert_non_null(strstr(error.text, "up to 0.2481"));
    // It is no other: just below, nothing grows; the wave of the grid is the fastest.
    def.time_step = 0.248f;
    field = create(&def);
    start_by_chance(field, 2);
    ty_turing_step(field, 3000, NULL);
    for (int i = 0; i < 64 * 64; i++)
        assert_true(fabsf(ty_turing_v(field, i / 64)[i % 64]) < 10.0f);
    ty_turing_destroy(field);
    for (int i = 0; i < 5; i++)
    {
        def = preset(0.05f, 0.08f, 1.0f, 64);
        *(i == 0   ? &def.v.diffusion
          : i == 1 ? &def.u.constant
          : i == 2 ? &def.limit_slope
                   : &def.u.decay) = i == 1 ? NAN : -1.0f;
        if (i == 4)
            def.width = 3;
        assert_int_equal(ty_turing_create(&def, &field, &error), TY_BAD_INPUT);
    }
}

static void memory_that_is_refused_leaves_nothing(void** state)
{
    (void)state;
    ty_error error;
    ty_turing* field;
    ty_turing_def def = preset(0.05f, 0.08f, 1.0f, 64);
    for (int i = 0; i < 5; i++)
    {
        ty_memory_fail_after(i);
        assert_int_equal(ty_turing_create(&def, &field, &error), TY_NO_MEMORY);
        assert_null(field);
    }
    ty_memory_fail_after(-1);
    field = create(&def);
    for (int i = 0; i < 6; i++)
    {
        ty_memory_fail_after(0);
        assert_int_equal(ty_turing_need(field, TY_TURING_HOLD, &error), TY_NO_MEMORY);
        assert_false(ty_turing_has(field, TY_TURING_HOLD_V));
        need(field, i % 2 ? TY_TURING_CONSTANT : TY_TURING_ALONG_SIN);
    }
    ty_memory_fail_after(-1);
    need(field, TY_TURING_HOLD);
    ty_turing_step(field, 2, NULL);
    ty_turing_destroy(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_presets_are_told_apart),
        cmocka_unit_test(larger_diffusion_is_coarser),
        cmocka_unit_test(edges_hold_free_or_wrap),
        cmocka_unit_test(a_divergence_keeps_the_sum),
        cmocka_unit_test(stripes_follow_the_activators_direction),
        cmocka_unit_test(threads_kernels_and_chunks_give_the_same_bits),
        cmocka_unit_test(what_is_left_out_changes_no_bit),
        cmocka_unit_test(the_step_has_a_bound),
        cmocka_unit_test(memory_that_is_refused_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
