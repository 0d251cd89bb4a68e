// SPDX-License-Identifier: Apache-2.0
// Gray–Scott: the patterns, speeds and times known for its rates, measured. The table is that of an independent program
// in double precision from the same beginning.
#include "base/cmocka_all.h"
#include <string.h>
#include <tsuya/base/math.h>
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

static double noise(uint64_t* state) // Marsaglia's xorshift
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) * (1.0 / 9007199254740992.0);
}

// A square of 20 cells in the middle, with a little noise.
static ty_gray_scott* begun(float feed, float kill, int stencil)
{
    ty_gray_scott_def def = ty_gray_scott_def_default();
    def.width = def.height = N;
    def.stencil = stencil;
    def.diffusion_u = 0.2097f;
    def.diffusion_v = 0.10486f;
    def.rates[0] = (ty_gray_scott_rates){feed, kill};
    ty_gray_scott* field = make(&def);
    uint64_t random = 12345;
    for (int y = 54; y < 74; y++)
        for (int x = 54; x < 74; x++)
        {
            ty_gray_scott_u(field, y)[x] = (float)(0.5 + 0.02 * (noise(&random) - 0.5));
            ty_gray_scott_v(field, y)[x] = (float)(0.25 + 0.02 * (noise(&random) - 0.5));
        }
    return field;
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

static float spread(ty_gray_scott* field)
{
    float low = 1.0f, high = 0.0f;
    for (int y = 0; y < N; y++)
        for (int x = 0; x < N; x++)
        {
            low = ty_min(low, ty_gray_scott_v(field, y)[x]);
            high = ty_max(high, ty_gray_scott_v(field, y)[x]);
        }
    return high - low;
}

// The most that v moves in 200 steps.
static float change(ty_gray_scott* field)
{
    static float before[N][N];
    float most = 0.0f;
    for (int y = 0; y < N; y++)
        memcpy(before[y], ty_gray_scott_v(field, y), sizeof before[y]);
    ty_gray_scott_step(field, 200, NULL);
    for (int y = 0; y < N; y++)
        for (int x = 0; x < N; x++)
            most = ty_max(most, fabsf(ty_gray_scott_v(field, y)[x] - before[y][x]));
    return most;
}

// Steps, by twenties, until all but a thousandth is covered.
static int full_after(ty_gray_scott* field, int most)
{
    for (int step = 20; step <= most; step += 20)
    {
        ty_gray_scott_step(field, 20, NULL);
        if (cover(field) >= 0.999f)
            return step;
    }
    return -1;
}

typedef struct known
{
    float feed, kill;
    float cover[2]; // after 20,000 steps, of v > .15
    int regions[2]; // connected
    bool even;      // the same everywhere
    bool restless;  // and still moving
    float u, v;     // where even
} known;

static const known table[] = {
    {0.072f, 0.059f, {1.0f, 1.0f}, {1, 1}, true, false, 0.392f, 0.334f},
    {0.052f, 0.079f, {0.0f, 0.0f}, {0, 0}, true, false, 1.0f, 0.0f},
    {0.072f, 0.060f, {1.0f, 1.0f}, {1, 1}, true, false, 0.411f, 0.322f},
    {0.0265f, 0.0605f, {0.25f, 0.32f}, {60, 95}, false, false, 0, 0}, // spots
    {0.067f, 0.062f, {0.52f, 0.58f}, {1, 1}, false, false, 0, 0},     // a labyrinth
    {0.025f, 0.0525f, {0.55f, 0.80f}, {1, 40}, false, true, 0, 0},
    {0.025f, 0.055f, {0.45f, 0.55f}, {1, 60}, false, true, 0, 0},
};

static void rates_give_their_patterns(void** state)
{
    (void)state;
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++)
    {
        const known* k = &table[i];
        ty_gray_scott* field = begun(k->feed, k->kill, 5);
        ty_gray_scott_step(field, 20000, NULL);
        int count = regions(field);
        float covered = cover(field), uneven = spread(field), moved = change(field);
        assert_true(covered >= k->cover[0] && covered <= k->cover[1]);
        assert_true(count >= k->regions[0] && count <= k->regions[1]);
        assert_int_equal(uneven < 1e-3f, k->even);
        assert_true(!k->restless || moved > 0.02f);
        assert_true(!k->even || moved < 1e-6f);
        if (k->even)
        {
            assert_float_equal(ty_gray_scott_u(field, 3)[5], k->u, 1e-3f);
            assert_float_equal(ty_gray_scott_v(field, 3)[5], k->v, 1e-3f);
        }
        ty_gray_scott_destroy(field);
    }
}

static void stripes_have_their_width(void** state)
{
    (void)state;
    ty_gray_scott* field = begun(0.067f, 0.062f, 5);
    ty_gray_scott_step(field, 24000, NULL);
    assert_float_equal(wavelength(field), 12.4f, 0.5f); // 12.2 grows fastest out of the plain state
    ty_gray_scott_destroy(field);
}

static void plain_ones_fill_in_their_time(void** state)
{
    (void)state;
    ty_gray_scott* field = begun(0.072f, 0.059f, 5);
    assert_in_range(full_after(field, 6000), 5320 - 60, 5320 + 60);
    ty_gray_scott_destroy(field);
    field = begun(0.072f, 0.060f, 5);
    ty_gray_scott_step(field, 12000, NULL);
    assert_float_equal(cover(field), 0.97f, 0.01f); // small holes close late
    assert_in_range(full_after(field, 6000), 16520 - 12000 - 300, 16520 - 12000 + 300);
    ty_gray_scott_destroy(field);
}

// A plain state obeys u v^2 = F (1 - u) = (F + k) v.
static void plain_states_stand_still(void** state)
{
    (void)state;
    ty_gray_scott* field = begun(0.072f, 0.059f, 9);
    ty_gray_scott_step(field, 20000, NULL);
    float u = ty_gray_scott_u(field, 3)[5], v = ty_gray_scott_v(field, 3)[5], f = 0.072f, k = 0.059f;
    assert_float_equal(u * v * v, f * (1.0f - u), 1e-6f);
    assert_float_equal(u * v * v, (f + k) * v, 1e-6f);
    ty_gray_scott_destroy(field);
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
    assert_float_equal(slow / fast, 0.64f, 0.64f * 0.01f);
}

// Steps until a round hole in the plain state is gone.
static int closing_time(int radius, int stencil)
{
    ty_gray_scott_def def = ty_gray_scott_def_default();
    int n = def.width = def.height = 2 * radius + 64, steps = 0;
    def.stencil = stencil;
    def.rates[0] = (ty_gray_scott_rates){0.072f, 0.059f};
    ty_gray_scott* field = make(&def);
    for (int y = 0; y < n; y++)
        for (int x = 0; x < n; x++)
        {
            bool hole = ty_sqr((float)(x - n / 2)) + ty_sqr((float)(y - n / 2)) < ty_sqr((float)radius);
            ty_gray_scott_u(field, y)[x] = hole ? 1.0f : 0.392f;
            ty_gray_scott_v(field, y)[x] = hole ? 0.0f : 0.334f;
        }
    while (ty_gray_scott_v(field, n / 2)[n / 2] < 0.15f)
    {
        ty_gray_scott_step(field, 4, NULL);
        steps += 4;
    }
    ty_gray_scott_destroy(field);
    return steps;
}

static void holes_close_in_72_steps_a_cell(void** state)
{
    (void)state;
    for (int radius = 24; radius <= 54; radius += 15)
        for (int stencil = 5; stencil <= 9; stencil += 4)
            assert_float_equal((float)closing_time(radius, stencil) / (float)radius, 72.0f, 72.0f * 0.03f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rates_give_their_patterns),     cmocka_unit_test(stripes_have_their_width),
        cmocka_unit_test(plain_ones_fill_in_their_time), cmocka_unit_test(plain_states_stand_still),
        cmocka_unit_test(fronts_have_their_speeds),      cmocka_unit_test(holes_close_in_72_steps_a_cell),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
