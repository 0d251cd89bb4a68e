// SPDX-License-Identifier: Apache-2.0
// What rims do to stripes of a Turing field, and how long limited diffusion keeps a picture, against figures of an
// independent program in double precision.
#include "plane_compare.h"
#include "turing_fields.h"

// --- rims ---

static void stripes_go_along_a_fixed_rim_and_meet_a_free_one(void** state)
{
    (void)state;
    for (int i = 0; i < 2; i++)
    {
        float soft = i ? 3.0f : 0.0f;
        ty_turing *fixed = disc(true, soft), *open = disc(false, soft);
        start_by_chance(fixed, 4242);
        start_by_chance(open, 4242);
        run_until(fixed, 3000.0f);
        run_until(open, 3000.0f);
        float along = normal_share(fixed, 75.0f, 81.0f), meeting = 1.0f - normal_share(open, 75.0f, 81.0f);
        print_message("soft %g: fixed %.3f normal, free %.3f tangential\n", (double)soft, (double)along,
                      (double)meeting);
        assert_true(along > 0.95f);
        assert_true(meeting > 0.57f);                          // half were no direction
        assert_true(normal_share(fixed, 20.0f, 60.0f) > 0.6f); // it orders the inside too
        assert_float_equal(ty_turing_u(fixed, 0)[0], 5.0f, 0.0f);
        ty_turing_destroy(fixed);
        ty_turing_destroy(open);
    }
}

// From one start more, from another less: what the other program finds from the same, ours finds as well.
static void a_free_rim_is_met_as_in_double_precision(void** state)
{
    (void)state;
    static const float known[] = {0.6467f, 0.6114f, 0.6625f, 0.8247f, 0.6161f};
    for (int i = 0; i < 5; i++)
    {
        ty_turing* field = disc(false, 0.0f);
        start_by_xorshift(field, i);
        run_until(field, 6000.0f);
        float tangential = 1.0f - normal_share(field, 75.0f, 82.0f);
        print_message("start %d: %.4f tangential, %.4f there\n", i, (double)tangential, (double)known[i]);
        assert_float_equal(tangential, known[i], 0.005f);
        ty_turing_destroy(field);
    }
}

// --- limits ---

// A ramp with three discs and a rectangle, 200 x 200.
static double test_picture(int x, int y)
{
    double value = 0.2 + 0.5 * x / 200.0;
    value = hypot(x - 70, y - 80) < 40.0 ? 0.9 : value;
    value = x > 120 && x < 175 && y > 100 && y < 180 ? 0.1 : value;
    value = hypot(x - 150, y - 50) < 22.0 ? 0.55 : value;
    return hypot(x - 70, y - 80) < 14.0 ? 0.15 : value;
}

// How steep U is, three times the mean of 3 x 3 cells.
static void steepness(ty_turing* field, double* out, double* scratch)
{
    enum
    {
        N = 200
    };
    for (int i = 0; i < N * N; i++)
    {
        int x = i % N, y = i / N;
        const float* row = ty_turing_u(field, y);
        float gx = row[x + 1 < N ? x + 1 : x] - row[x ? x - 1 : x];
        float gy = ty_turing_u(field, y + 1 < N ? y + 1 : y)[x] - ty_turing_u(field, y ? y - 1 : y)[x];
        out[i] = hypot((double)gx, (double)gy);
    }
    local_means(out, N, N, 3, scratch);
}

// Edges of U at 90, 500 and 1500 against those it started from.
static void edges_kept(const ty_turing_def* def, double kept[3])
{
    const int steps[] = {200, 1112, 3334}, n = 200 * 200; // whole ones of .45
    double *before = TY_ALLOC(double, n), *after = TY_ALLOC(double, n), *scratch = TY_ALLOC(double, n);
    ty_turing* field = create(def);
    for (int i = 0; i < n; i++)
    {
        ty_turing_u(field, i / 200)[i % 200] = (float)test_picture(i % 200, i / 200);
        ty_turing_v(field, i / 200)[i % 200] = 1.0f;
    }
    steepness(field, before, scratch);
    for (int t = 0; t < 3; t++)
    {
        ty_turing_step(field, steps[t] - (t ? steps[t - 1] : 0), NULL);
        steepness(field, after, scratch);
        kept[t] = correlation(before, after, n);
    }
    ty_turing_destroy(field);
    ty_free(before);
    ty_free(after);
    ty_free(scratch);
}

// A limit sharpens edges while the pattern is weak, and loses them in it later.
static void limits_keep_edges_as_in_double_precision(void** state)
{
    (void)state;
    static const struct
    {
        const char* name;
        ty_turing_limit limit;
        bool conservative;
        double known[3]; // none of a divergence
    } cases[] = {
        {"plain", TY_TURING_LIMIT_NONE, false, {0.31, 0.46, 0.19}},
        {"both", TY_TURING_LIMIT_BOTH, false, {0.47, 0.47, 0.41}},
        {"u", TY_TURING_LIMIT_U, false, {0.65, 0.37, 0.12}},
        {"both, conservative", TY_TURING_LIMIT_BOTH, true, {0}},
        {"u, conservative", TY_TURING_LIMIT_U, true, {0}},
    };
    for (int i = 0; i < 5; i++)
    {
        double kept[3];
        ty_turing_def def = preset(0.05f, 0.04f, 0.5f, 200);
        def.limit = cases[i].limit;
        def.limit_conservative = cases[i].conservative;
        edges_kept(&def, kept);
        print_message("%s: edges %.3f at 90, %.3f at 500, %.3f at 1500\n", cases[i].name, kept[0], kept[1], kept[2]);
        for (int t = 0; t < 3 && !cases[i].conservative; t++)
            assert_true(fabs(kept[t] - cases[i].known[t]) < 0.012);
        assert_true(!cases[i].conservative || kept[0] > cases[0].known[0] + 0.05);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stripes_go_along_a_fixed_rim_and_meet_a_free_one),
        cmocka_unit_test(a_free_rim_is_met_as_in_double_precision),
        cmocka_unit_test(limits_keep_edges_as_in_double_precision),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
