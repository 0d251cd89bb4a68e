// SPDX-License-Identifier: Apache-2.0
// The angle of repose rises with friction; it rises with water between the grains and falls when they are saturated.
#include "heap_slope.h"
#include <stdio.h>

enum
{
    GRAINS = 600,
    SEEDS = 2,
};

static int group_setup(void** state)
{
    (void)state;
    heap_grains_make();
    return 0;
}

static int group_teardown(void** state)
{
    (void)state;
    heap_grains_free();
    return 0;
}

static double mean_slope(float friction, float wet_basis)
{
    double sum = 0.0;
    for (uint64_t seed = 1; seed <= SEEDS; seed++)
        sum += heap_slope(&(heap_case){GRAINS, friction, wet_basis, seed}) / SEEDS;
    print_message("friction %.1f, wet basis %.2f: %.1f degrees\n", (double)friction, (double)wet_basis, sum);
    return sum;
}

static void test_friction(void** state)
{
    (void)state;
    const float frictions[] = {0.1f, 0.3f, 0.5f, 0.8f};
    double last = 0.0;
    for (int i = 0; i < 4; i++)
    {
        double slope = mean_slope(frictions[i], 0.0f);
        assert_true(slope > last + 1.0);
        last = slope;
    }
    assert_true(last > 15.0 && last < 50.0);
}

static void test_moisture(void** state)
{
    (void)state;
    const float wet[] = {0.3f, 0.38f, 0.45f, 0.6f, 0.72f, 0.8f};
    double slope[6];
    for (int i = 0; i < 6; i++)
        slope[i] = mean_slope(0.5f, wet[i]);
    assert_true(slope[1] > slope[0] && slope[2] > slope[0] + 3.0 && slope[3] > slope[0] + 3.0);
    assert_true(slope[4] < slope[3] && slope[5] < slope[3] - 3.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_friction),
        cmocka_unit_test(test_moisture),
    };
    return cmocka_run_group_tests(tests, group_setup, group_teardown);
}
