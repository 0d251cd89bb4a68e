// SPDX-License-Identifier: Apache-2.0
// Soaking times, wet bases and cooking of rice.
#include "cmocka_all.h"
#include <math.h>
#include <tsuya/base/moisture.h>

static void assert_near(float value, double expected, double tolerance)
{
    if (!(fabs((double)value - expected) <= tolerance))
        fail_msg("%.6g is not %.6g", (double)value, expected);
}

static ty_moisture made(float wet_basis, float minutes, float celsius, float cooked)
{
    ty_moisture_def def = {wet_basis, minutes, celsius, cooked};
    return ty_moisture_make(&def);
}

static void test_uptake(void** state)
{
    (void)state;
    // At 10 degrees 69, 97 and 99.9 % of .24 after 20, 60 and 120 minutes.
    assert_near(ty_moisture_uptake(20, 10) / 0.24f, 0.69, 0.005);
    assert_near(ty_moisture_uptake(60, 10) / 0.24f, 0.97, 0.002);
    assert_near(ty_moisture_uptake(120, 10) / 0.24f, 0.999, 0.0005);
    assert_near(ty_moisture_uptake(0, 10), 0.0, 0.0);
    assert_near(ty_moisture_uptake(-5, 10), 0.0, 0.0);
    assert_near(ty_moisture_uptake(100000, 10), 0.24, 1e-6);
    // Ten degrees warmer is 1.45 times faster.
    assert_near(ty_moisture_uptake(20, 20), (double)ty_moisture_uptake(29, 10), 1e-6);
    assert_near(ty_moisture_uptake(29, 0), (double)ty_moisture_uptake(20, 10), 1e-6);
}

static void test_wet_basis(void** state)
{
    (void)state;
    assert_near(ty_moisture_wet_basis(0.0f), 0.145, 1e-6);
    assert_near(ty_moisture_wet_basis(0.24f), 0.31, 0.001);
    assert_near(ty_moisture_wet_basis(1.25f), 0.62, 1e-4);
    assert_near(ty_moisture_wet_basis(-0.14f), 0.05, 1e-7); // dried no further than .05
}

static void test_default_is_cooked(void** state)
{
    (void)state;
    ty_moisture_def def = ty_moisture_def_default();
    ty_moisture m = ty_moisture_make(&def);
    assert_near(m.wet_basis, 0.62, 1e-6);
    assert_near(m.cooked, 1.0, 0.0);
}

static void test_outright(void** state)
{
    (void)state;
    assert_near(made(0.4f, 60, 10, 0.3f).wet_basis, 0.4, 1e-6); // neither soaking nor cooking moves it
    assert_near(made(0.4f, 60, 10, 0.3f).cooked, 0.3, 1e-6);
    assert_near(made(0.0f, 0, 0, 0).wet_basis, 0.05, 1e-7);
    assert_near(made(1.5f, 0, 0, 0).wet_basis, 1.0, 0.0);
    // Cooked where not said: 0 below .31, 1 above .45, linear between.
    assert_near(made(0.145f, 0, 0, -1).cooked, 0.0, 0.0);
    assert_near(made(0.31f, 0, 0, -1).cooked, 0.0, 1e-6);
    assert_near(made(0.38f, 0, 0, -1).cooked, 0.5, 1e-5);
    assert_near(made(0.45f, 0, 0, -1).cooked, 1.0, 1e-6);
    assert_near(made(0.62f, 0, 0, -1).cooked, 1.0, 0.0);
}

static void test_soaked(void** state)
{
    (void)state;
    ty_moisture raw = made(-1, 0, 10, -1);
    assert_near(raw.wet_basis, 0.145, 1e-6);
    assert_near(raw.cooked, 0.0, 0.0);
    ty_moisture soaked = made(-1, 120, 10, -1);
    assert_near(soaked.wet_basis, 0.31, 0.001);
    assert_near(soaked.cooked, 0.0, 0.0);
    assert_near(made(-1, 120, 10, 0).wet_basis, (double)soaked.wet_basis, 0.0);
}

static void test_soaked_and_cooked(void** state)
{
    (void)state;
    assert_near(made(-1, 60, 10, 1).wet_basis, 0.62, 1e-5);
    assert_near(made(-1, 0, 10, 1).wet_basis, 0.62, 1e-5);
    assert_near(made(-1, 60, 10, 1).cooked, 1.0, 0.0);
    assert_near(made(-1, 60, 10, 5).wet_basis, 0.62, 1e-5);
    // Half cooked from raw: half of the 1.25 of water, (.145 + .625) / 1.625.
    assert_near(made(-1, 0, 10, 0.5f).wet_basis, 0.77 / 1.625, 1e-5);
    for (float cooked = 0.0f; cooked < 1.0f; cooked += 0.1f)
        assert_true(made(-1, 30, 10, cooked).wet_basis < made(-1, 30, 10, cooked + 0.1f).wet_basis);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_uptake),   cmocka_unit_test(test_wet_basis), cmocka_unit_test(test_default_is_cooked),
        cmocka_unit_test(test_outright), cmocka_unit_test(test_soaked),    cmocka_unit_test(test_soaked_and_cooked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
