// SPDX-License-Identifier: Apache-2.0
// The sampler: stratified in every prefix, pure, and independent from pixel to pixel.
#include "renderer_private.h"
#include <stdlib.h>
#include <string.h>

static ty_sobol sobol;
static const ty_seed seed = {7};

static int setup(void** state)
{
    (void)state;
    ty_sobol_init(&sobol);
    return 0;
}

static void fetch(int x, int y, uint32_t sample, uint32_t group, float u[8])
{
    ty_sampler sampler = ty_sampler_make(&sobol, seed, x, y, sample);
    ty_sampler_8d(&sampler, group, u);
}

static float sobol_value(uint32_t index, int dimension)
{
    uint32_t byte = 0, digits = 0;
    for (int bit = 0; bit < 8; ++bit)
        byte |= (index >> bit & 1u) << (7 - bit);
    for (int bit = 0; bit < 32; ++bit)
        digits |= (sobol.points[0][byte][dimension] >> bit & 1u) << (31 - bit);
    return (float)digits * 0x1p-32f;
}

// Joe and Kuo's published points 5 and 9; their Gray code order makes them indices 6 and 12 here.
static void test_points_are_those_of_joe_and_kuo(void** state)
{
    (void)state;
    const float fifth[4] = {0.375f, 0.375f, 0.625f, 0.875f}, ninth[4] = {0.1875f, 0.3125f, 0.9375f, 0.4375f};
    for (int d = 0; d < 4; ++d)
    {
        assert_true(sobol_value(6, d) == fifth[d]);
        assert_true(sobol_value(12, d) == ninth[d]);
    }
}

// Every elementary interval of area 2^-k holds exactly one of the first 2^k points.
static void check_net(int x, int y, uint32_t group, int a, int b, int k)
{
    int n = 1 << k;
    for (int split = 0; split <= k; ++split)
    {
        char* taken = calloc((size_t)n, 1);
        for (int i = 0; i < n; ++i)
        {
            float u[8];
            fetch(x, y, (uint32_t)i, group, u);
            int column = (int)(u[a] * (float)(1 << split)), row = (int)(u[b] * (float)(1 << (k - split)));
            int cell = column << (k - split) | row;
            if (taken[cell]++)
                fail_msg("pixel %d,%d group %u dimensions %d,%d: cell %d of split %d/%d taken twice", x, y, group, a, b,
                         cell, split, k);
        }
        free(taken);
    }
}

static void test_pairs_are_nets(void** state)
{
    (void)state;
    for (int bounce = 0; bounce < 6; ++bounce)
        for (int k = 0; k <= 10; k += 1)
        {
            check_net(3 + bounce, 40, ty_group_scatter(bounce), 0, 1, k); // direction
            check_net(3 + bounce, 40, ty_group_scatter(bounce), 4, 5, k); // light
            check_net(3 + bounce, 40, ty_group_interior(bounce), 0, 1, k);
        }
    for (int k = 0; k <= 12; ++k)
        check_net(100, 0, TY_GROUP_CAMERA, 0, 1, k); // filter
}

static void test_single_dimensions_are_stratified(void** state)
{
    (void)state;
    for (int d = 0; d < 8; ++d)
        for (int k = 0; k <= 10; ++k)
        {
            char taken[1024] = {0};
            for (int i = 0; i < 1 << k; ++i)
            {
                float u[8];
                fetch(1, 2, (uint32_t)i, 4, u);
                assert_true(u[d] >= 0.0f && u[d] < 1.0f);
                assert_int_equal(taken[(int)(u[d] * (float)(1 << k))]++, 0);
            }
        }
}

// Aligned blocks are nets too, so that later passes are stratified in themselves.
static void test_later_blocks_are_nets(void** state)
{
    (void)state;
    char taken[64] = {0};
    for (uint32_t i = 0; i < 64; ++i)
    {
        float u[8];
        fetch(9, 9, 64 + i, 1, u);
        assert_int_equal(taken[(int)(u[0] * 8.0f) * 8 + (int)(u[1] * 8.0f)]++, 0);
    }
}

static void test_is_a_pure_function(void** state)
{
    (void)state;
    float first[8], again[8], four[4];
    fetch(5, 6, 77, 13, first);
    for (uint32_t i = 0; i < 100; ++i)
        fetch((int)i, 3, i, i, again);
    fetch(5, 6, 77, 13, again);
    assert_memory_equal(first, again, sizeof first);
    ty_sampler sampler = ty_sampler_make(&sobol, seed, 5, 6, 77);
    ty_sampler_4d(&sampler, 13, four);
    assert_memory_equal(first, four, sizeof four);
    ty_sampler_4d(&sampler, 14, four);
    assert_memory_equal(first + 4, four, sizeof four);
}

// Eight numbers side by side are those of two groups one by one, and a sampler that was set to a sample is one made
// for it.
static void test_both_widths_agree(void** state)
{
    (void)state;
    ty_sampler walking = ty_sampler_make(&sobol, seed, 12, 34, 0);
    for (uint32_t i = 0; i < 4096; ++i)
    {
        float eight[8], four[8];
        uint32_t group = i * 2654435761u >> 12;
        fetch(12, 34, 15 * i, group, eight);
        ty_sampler_set_sample(&walking, 15 * i);
        ty_sampler_4d(&walking, group, four);
        ty_sampler_4d(&walking, group + 1, four + 4);
        assert_memory_equal(eight, four, sizeof eight);
    }
}

static double correlation(const double* a, const double* b, int n)
{
    double ab = 0.0;
    for (int i = 0; i < n; ++i)
        ab += (a[i] - 0.5) * (b[i] - 0.5);
    return 12.0 * ab / n;
}

// Sample 0 of neighbouring pixels, of other groups, seeds and samples: uncorrelated within 4 standard errors.
static void test_neighbours_are_independent(void** state)
{
    (void)state;
    enum
    {
        N = 20000
    };
    double *here = calloc(N, sizeof(double)), *right = calloc(N, sizeof(double)), *below = calloc(N, sizeof(double)),
           *group = calloc(N, sizeof(double)), *pair = calloc(N, sizeof(double)), mean = 0.0;
    for (int i = 0; i < N; ++i)
    {
        float u[8];
        int x = 2 * (i % 200), y = 2 * (i / 200);
        fetch(x, y, 0, 1, u);
        here[i] = (double)u[0];
        pair[i] = (double)u[1];
        group[i] = (double)u[4];
        mean += (double)u[0] / N;
        fetch(x + 1, y, 0, 1, u);
        right[i] = (double)u[0];
        fetch(x, y + 1, 0, 1, u);
        below[i] = (double)u[0];
    }
    double bound = 4.0 / sqrt((double)N);
    assert_true(fabs(mean - 0.5) < bound * sqrt(1.0 / 12.0));
    assert_true(fabs(correlation(here, right, N)) < bound);
    assert_true(fabs(correlation(here, below, N)) < bound);
    assert_true(fabs(correlation(here, group, N)) < bound);
    assert_true(fabs(correlation(here, pair, N)) < bound);
    free(here);
    free(right);
    free(below);
    free(group);
    free(pair);
}

// Dimensions are scrambled on their own: where their unscrambled digits agree, the results do not.
static void test_dimensions_are_scrambled_apart(void** state)
{
    (void)state;
    int equal = 0;
    for (int i = 0; i < 1 << 20; ++i)
    {
        float u[8];
        fetch(i & 1023, i >> 10, 0, 1, u);
        equal += u[0] == u[1];
    }
    assert_true(equal <= 3); // 2^20 / 2^24 by chance; with one scrambling 2 of 2^16 indices give equal numbers
}

// The scrambling is Owen's: the mean of f over 2^k points varies far less than that of independent points.
static void test_smooth_integrals_converge_fast(void** state)
{
    (void)state;
    double error_sqr = 0.0;
    for (int pixel = 0; pixel < 64; ++pixel)
    {
        double sum = 0.0;
        for (uint32_t i = 0; i < 256; ++i)
        {
            float u[8];
            fetch(pixel, 1, i, 1, u);
            sum += (double)(u[0] * u[0] * u[1]) / 256.0;
        }
        error_sqr += (sum - 1.0 / 6.0) * (sum - 1.0 / 6.0) / 64.0;
    }
    // Independent points: variance (1/15 - 1/36) / 256 = 1.5e-4. Scrambled nets: about n^-3.
    assert_true(error_sqr < 1.5e-4 / 1000.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pairs_are_nets),
        cmocka_unit_test(test_single_dimensions_are_stratified),
        cmocka_unit_test(test_later_blocks_are_nets),
        cmocka_unit_test(test_is_a_pure_function),
        cmocka_unit_test(test_both_widths_agree),
        cmocka_unit_test(test_neighbours_are_independent),
        cmocka_unit_test(test_points_are_those_of_joe_and_kuo),
        cmocka_unit_test(test_dimensions_are_scrambled_apart),
        cmocka_unit_test(test_smooth_integrals_converge_fast),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
