// SPDX-License-Identifier: Apache-2.0
// Small piles of rice and of roe come to rest and stay there; long_rest holds the large ones to the same bounds.
#include "rest_rows.h"

static void test_rice(void** state)
{
    (void)state;
    const rest_bounds bounds = {{0.55, 0.68}, {4.0, 7.0}};
    ty_aggregate_recipe r = rice_bowl(300);
    r.element.variants = 4;
    r.element.divisions = 6;
    ty_aggregate* a = rest_made(&r, NULL);
    assert_at_rest("rice bowl", a, &bounds);
    ty_aggregate_destroy(a);
}

static void test_roe(void** state)
{
    (void)state;
    const rest_bounds bounds = {{0.0, 0.66}, {2.0, 7.0}}; // too few for phi
    ty_aggregate_recipe r = roe_bowl(60);
    ty_aggregate* a = rest_made(&r, NULL);
    assert_at_rest("roe bowl", a, &bounds);
    ty_aggregate_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rice),
        cmocka_unit_test(test_roe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
