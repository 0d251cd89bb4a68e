// SPDX-License-Identifier: Apache-2.0
// Pressed rice balls over the whole range of moisture: in the middle band they keep their form, dry and soaked ones
// slump.
#include "recipe_made.h"

static ty_aggregate_recipe rice_ball(float wet_basis, uint64_t seed)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.seed.value = seed;
    r.element.variants = 4;
    r.container.kind = TY_CONTAINER_ONIGIRI;
    r.container.role = TY_CONTAINER_MOULD;
    r.container.onigiri = (ty_onigiri_def){0.056f, 0.025f, 0.011f, 0.008f};
    r.fill.target = TY_FILL_DENSITY;
    r.fill.density = 0.6f;
    r.press.strain = 0.06f;
    r.press.seconds = 0.3f;
    r.press.from = TY_PRESS_AROUND;
    r.settle.rolling = 0.01f;
    r.settle.max_seconds = 6.0f;
    r.moisture.wet_basis = wet_basis;
    r.moisture.cooked = 1.0f;
    r.moisture.swelling = 1.0f; // the same grains in all
    return r;
}

static void test_bands(void** state)
{
    (void)state;
    const struct
    {
        float wet_basis, least, most;
    } states[] = {{0.30f, 0.0f, 0.6f},  {0.37f, 0.0f, 0.95f}, {0.42f, 0.85f, 1.05f}, {0.50f, 0.9f, 1.05f},
                  {0.62f, 0.9f, 1.05f}, {0.68f, 0.9f, 1.05f}, {0.74f, 0.0f, 0.95f},  {0.78f, 0.0f, 0.6f}};
    for (size_t s = 0; s < sizeof states / sizeof *states; s++)
    {
        double sum = 0.0;
        for (uint64_t seed = 1; seed <= 3; seed++)
        {
            ty_aggregate_recipe r = rice_ball(states[s].wet_basis, seed);
            ty_aggregate* a = made(&r, NULL);
            double kept = metric(a, "height_mm") / metric(a, "released_height_mm");
            print_message("wet basis %.2f, seed %d: %u grains keep %.3f of %.1f mm, %.4f mm/s\n",
                          (double)states[s].wet_basis, (int)seed, a->instance_count, kept,
                          metric(a, "released_height_mm"), metric(a, "speed_rms_mm_s"));
            assert_non_null(strstr(a->metrics, "\"rest\": true"));
            assert_true(kept >= (double)states[s].least && kept <= (double)states[s].most);
            sum += kept / 3.0;
            ty_aggregate_destroy(a);
        }
        print_message("wet basis %.2f: %.3f of its height\n", (double)states[s].wet_basis, sum);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_bands)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
