// SPDX-License-Identifier: Apache-2.0
// Gray–Scott: what is conserved, which states stand still, the patterns and fronts known for its rates.
#include "base/cmocka_all.h"
#include <string.h>
#include <tsuya/base/hash.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/generate/gray_scott.h>

enum
{
    N = 128
};

static ty_gray_scott* make(const ty_gray_scott_def* def)
{
    ty_gray_scott* field;
    ty_error error;
    assert_int_equal(ty_gray_scott_create(def, &field, &error), TY_OK);
    return field;
}

static ty_gray_scott* grown(float feed, float kill, int steps)
{
    ty_gray_scott_def def = ty_gray_scott_def_default();
    def.width = def.height = N;
    def.rates[0] = (ty_gray_scott_rates){feed, kill};
    ty_gray_scott* field = make(&def);
    ty_rng rng = ty_rng_make((ty_seed){2}, 0, 0);
    ty_gray_scott_drop(field, 64.0f, 64.0f, 11.0f, &rng);
    ty_gray_scott_step(field, steps, NULL);
    return field;
}

static double mean_v(ty_gray_scott* field)
{
    double sum = 0.0;
    for (int y = 0; y < N; y++)
        for (int x = 0; x < N; x++)
            sum += (double)ty_gray_scott_v(field, y)[x];
    return sum / (N * N);
}

static float cover(ty_gray_scott* field)
{
    int count = 0;
    for (int y = 0; y < N; y++)
        for (int x = 0; x < N; x++)
            count += ty_gray_scott_v(field, y)[x] > 0.15f;
    return (float)count / (float)(N * N);
}

// Connected regions of v > .15 over the wrapped edges.
static int regions(ty_gray_scott* field)
{
    static bool seen[N][N];
    static int stack[N * N];
    int count = 0;
    memset(seen, 0, sizeof seen);
    for (int start = 0; start < N * N; start++)
    {
        int top = 0;
        if (seen[start / N][start % N] || ty_gray_scott_v(field, start / N)[start % N] <= 0.15f)
            continue;
        count++;
        seen[start / N][start % N] = true;
        stack[top++] = start;
        while (top > 0)
        {
            int at = stack[--top], x = at % N, y = at / N;
            int near[4][2] = {{(x + 1) % N, y}, {(x + N - 1) % N, y}, {x, (y + 1) % N}, {x, (y + N - 1) % N}};
            for (int k = 0; k < 4; k++)
                if (!seen[near[k][1]][near[k][0]] && ty_gray_scott_v(field, near[k][1])[near[k][0]] > 0.15f)
                {
                    seen[near[k][1]][near[k][0]] = true;
                    stack[top++] = near[k][1] * N + near[k][0];
                }
        }
    }
    return count;
}

// Length of the mean wave by power over rows and columns, cells.
static float wavelength(ty_gray_scott* field)
{
    double sum = 0.0, moment = 0.0;
    for (int k = 2; k < N / 4; k++)
    {
        double power = 0.0;
        for (int line = 0; line < N; line++)
        {
            double c[2] = {0, 0}, s[2] = {0, 0};
            for (int i = 0; i < N; i++)
            {
                float angle = 2.0f * TY_PI * (float)((k * i) % N) / N;
                float row = ty_gray_scott_v(field, line)[i], column = ty_gray_scott_v(field, i)[line];
                c[0] += (double)(row * ty_cos(angle)), s[0] += (double)(row * ty_sin(angle));
                c[1] += (double)(column * ty_cos(angle)), s[1] += (double)(column * ty_sin(angle));
            }
            power += c[0] * c[0] + s[0] * s[0] + c[1] * c[1] + s[1] * s[1];
        }
        // a stripe at angle a shows k cos a along x: the sum of squares over both axes is that of the wave
        moment += power * k * k;
        sum += power;
    }
    return (float)(N / sqrt(2.0 * moment / sum));
}

static void rates_give_their_patterns(void** state)
{
    (void)state;
    ty_gray_scott* field = grown(0.052f, 0.079f, 20000); // dies
    assert_true(mean_v(field) < 1e-6);
    ty_gray_scott_destroy(field);
    field = grown(0.0265f, 0.0605f, 20000); // spots apart from each other
    assert_in_range(regions(field), 70, 90);
    assert_float_equal(cover(field), 0.287f, 0.015f);
    ty_gray_scott_destroy(field);
    field = grown(0.067f, 0.062f, 20000); // stripes, joined to one labyrinth
    assert_int_equal(regions(field), 1);
    assert_float_equal(cover(field), 0.55f, 0.02f);
    assert_float_equal(wavelength(field), 12.4f, 0.5f);
    ty_gray_scott_destroy(field);
}

// A plain state obeys u v^2 = F (1 - u) = (F + k) v; for F = .072 there is one up to k = .06216.
static void plain_states_stand_still(void** state)
{
    (void)state;
    ty_gray_scott* field = grown(0.072f, 0.059f, 20000);
    float u = ty_gray_scott_u(field, 3)[5], v = ty_gray_scott_v(field, 3)[5], f = 0.072f, k = 0.059f;
    assert_float_equal(u, 0.392f, 1e-3f);
    assert_float_equal(v, 0.334f, 1e-3f);
    assert_float_equal(u * v * v, f * (1.0f - u), 1e-6f);
    assert_float_equal(u * v * v, (f + k) * v, 1e-6f);
    ty_gray_scott_destroy(field);
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

// Where v falls through .15 to the right of the middle, cells.
static float front_place(ty_gray_scott* field, int width)
{
    const float* v = ty_gray_scott_v(field, 2);
    for (int x = width / 2; x + 1 < width; x++)
        if (v[x] >= 0.15f && v[x + 1] < 0.15f)
            return (float)x + (v[x] - 0.15f) / (v[x] - v[x + 1]);
    return 0.0f;
}

static float front_speed(float kill)
{
    ty_gray_scott_def def = ty_gray_scott_def_default();
    def.width = 640;
    def.height = 8;
    def.rates[0] = (ty_gray_scott_rates){0.072f, kill};
    ty_gray_scott* field = make(&def);
    for (int y = 0; y < def.height; y++)
        for (int x = 300; x < 340; x++)
        {
            ty_gray_scott_u(field, y)[x] = 0.4f;
            ty_gray_scott_v(field, y)[x] = 0.33f;
        }
    ty_gray_scott_step(field, 4000, NULL);
    float begin = front_place(field, def.width);
    ty_gray_scott_step(field, 8000, NULL);
    float speed = (front_place(field, def.width) - begin) / 8000.0f;
    ty_gray_scott_destroy(field);
    return speed;
}

static void fronts_have_their_speeds(void** state)
{
    (void)state;
    float fast = front_speed(0.059f), slow = front_speed(0.060f);
    assert_float_equal(fast, 0.01456f, 0.01456f * 0.02f);
    assert_float_equal(slow, 0.00930f, 0.00930f * 0.02f);
}

static void workers_change_no_bit(void** state)
{
    (void)state;
    ty_gray_scott_def def = ty_gray_scott_def_default();
    def.width = 1000;
    def.height = 131;
    ty_hash first = {0};
    for (int threads = 1; threads <= 3; threads++)
    {
        ty_workers* crew;
        ty_error error;
        assert_int_equal(ty_workers_create(threads, &crew, &error), TY_OK);
        ty_gray_scott* field = make(&def);
        ty_rng rng = ty_rng_make((ty_seed){3}, 0, 0);
        for (int i = 0; i < 20; i++)
            ty_gray_scott_drop(field, ty_rng_range(&rng, 0, 1000), ty_rng_range(&rng, 0, 131), 9.0f, &rng);
        ty_gray_scott_step(field, 200, crew);
        ty_hasher* hasher = ty_hasher_create();
        for (int y = 0; y < def.height; y++)
            ty_hasher_add(hasher, ty_gray_scott_v(field, y), sizeof(float) * (size_t)def.width);
        ty_hash hash = ty_hasher_end(hasher);
        first = threads == 1 ? hash : first;
        assert_memory_equal(&hash, &first, sizeof hash);
        ty_gray_scott_destroy(field);
        ty_workers_destroy(crew);
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
    assert_non_null(strstr(error.text, "time_step: 1"));
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
        cmocka_unit_test(rates_give_their_patterns), cmocka_unit_test(plain_states_stand_still),
        cmocka_unit_test(amounts_are_kept),          cmocka_unit_test(fronts_have_their_speeds),
        cmocka_unit_test(workers_change_no_bit),     cmocka_unit_test(impossible_ones_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
