// SPDX-License-Identifier: Apache-2.0
// One state of moisture gives stiffness, cohesion, stickiness and size; each can be given in its place.
#include "recipe_made.h"

static ty_mechanics of(float wet_basis, float cooked)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.moisture.wet_basis = wet_basis;
    r.moisture.cooked = cooked;
    return ty_mechanics_of(&r);
}

static ty_mechanics soaked(float minutes, float cooked)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.moisture.soak = minutes;
    r.moisture.cooked = cooked;
    return ty_mechanics_of(&r);
}

static void test_no_state(void** state)
{
    (void)state;
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    ty_mechanics m = ty_mechanics_of(&r);
    assert_false(m.given);
    assert_true(m.bridge.tension == 0.0f && m.bridge.adhesion == 0.0f);
    assert_true(m.modulus == 3e5f && m.swelling == 1.0f);
}

static void test_law(void** state)
{
    (void)state;
    ty_mechanics raw = of(0.145f, 0.0f), cooked = of(0.62f, 1.0f), wet = of(0.80f, 1.0f), soft = of(0.5f, 1.0f);
    assert_true(raw.given && cooked.given);
    assert_float_equal(cooked.modulus, 3e5f, 1.0f);
    assert_float_equal(raw.modulus, 1e8f, 1e3f);
    assert_true(of(0.31f, 0.0f).modulus < 0.25f * raw.modulus && of(0.31f, 0.0f).modulus > 0.15f * raw.modulus);
    assert_float_equal(of(0.76f, 1.0f).modulus, 1e5f, 1e3f);
    // Only cooked starch sticks; both pulls are there in the middle band alone.
    assert_true(raw.bridge.tension == 0.0f && raw.bridge.adhesion == 0.0f);
    assert_true(wet.bridge.tension == 0.0f && wet.bridge.adhesion == 0.0f);
    assert_float_equal(soft.bridge.adhesion, 1.0f, 1e-6f);
    assert_float_equal(cooked.bridge.adhesion, 1.0f, 1e-6f);
    assert_true(cooked.bridge.tension > 0.07f);
    assert_true(of(0.62f, 0.0f).bridge.adhesion == 0.0f && of(0.62f, 0.0f).bridge.tension > 0.07f);
    assert_float_equal(of(0.62f, 0.5f).bridge.adhesion, 0.5f, 1e-6f);
    assert_float_equal(of(0.7087f, 1.0f).bridge.adhesion, 0.5f, 0.01f); // .875 of saturation
    // Volumes of .69 + w / (1 - w): .860, 1.139 and 2.321.
    assert_float_equal(cooked.swelling, 1.0f, 1e-6f);
    assert_float_equal(raw.swelling, 0.7183f, 1e-3f);
    assert_float_equal(of(0.31f, 0.0f).swelling, 0.7887f, 1e-3f);
}

// Soaking makes raw grains softer, and cooked ones too.
static void test_soaking(void** state)
{
    (void)state;
    const float minutes[] = {0.0f, 10.0f, 30.0f, 120.0f};
    for (int i = 1; i < 4; i++)
    {
        assert_true(soaked(minutes[i], 0.0f).modulus < soaked(minutes[i - 1], 0.0f).modulus);
        assert_true(soaked(minutes[i], 1.0f).modulus < soaked(minutes[i - 1], 1.0f).modulus);
        assert_true(soaked(minutes[i], 0.0f).swelling > soaked(minutes[i - 1], 0.0f).swelling);
        assert_float_equal(soaked(minutes[i], 1.0f).swelling, 1.0f, 1e-5f);
    }
    assert_float_equal(soaked(0.0f, 0.0f).state.wet_basis, 0.145f, 1e-6f);
    assert_float_equal(soaked(120.0f, 1.0f).modulus, 3e5f * 0.6065f, 1e3f);
}

static void test_given_instead(void** state)
{
    (void)state;
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.moisture.wet_basis = 0.62f;
    r.settle.cohesion = 0.0f;
    ty_mechanics m = ty_mechanics_of(&r);
    assert_true(m.bridge.tension == 0.0f && m.bridge.adhesion == 1.0f);
    r.settle.adhesion = 0.25f;
    r.settle.modulus = 7e5f;
    r.moisture.swelling = 1.25f;
    m = ty_mechanics_of(&r);
    assert_true(m.bridge.adhesion == 0.25f && m.modulus == 7e5f && m.swelling == 1.25f);
    r.moisture.wet_basis = 0.0f;
    m = ty_mechanics_of(&r);
    assert_false(m.given);
    assert_true(m.bridge.adhesion == 0.25f && m.modulus == 7e5f && m.swelling == 1.25f);
}

static float length_of(const ty_aggregate* a)
{
    return a->prototypes[0]->bounds.high.x - a->prototypes[0]->bounds.low.x;
}

// In the file: sizes, the wet basis of each grain, and what the metrics tell.
static void test_file(void** state)
{
    (void)state;
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.element.variants = 1;
    set_bowl(&r.container.shape, 0.015f, 0.015f, 0.0015f, 0.007f, 0.002f);
    r.fill.count = 50;
    ty_aggregate* none = made(&r, NULL);
    assert_null(ty_aggregate_find_attribute(none, "wet_basis"));
    assert_null(strstr(none->metrics, "wet_basis"));
    r.moisture.soak = 120.0f;
    r.moisture.cooked = 0.0f;
    ty_aggregate* raw = made(&r, NULL);
    const ty_instance_attribute *wet = ty_aggregate_find_attribute(raw, "wet_basis"),
                                *moisture = ty_aggregate_find_attribute(raw, "moisture");
    assert_non_null(wet);
    float expected = (float)metric(raw, "wet_basis");
    assert_float_equal(expected, 0.31f, 2e-3f);
    for (uint32_t i = 0; i < raw->instance_count; i++)
        assert_float_equal(wet->values[i], expected * (1.0f + 0.06f * moisture->values[i]), 1e-4f);
    assert_float_equal(length_of(raw) / length_of(none), metric(raw, "swelling"), 0.01f);
    assert_true(metric(raw, "swelling") < 0.8);
    ty_aggregate_destroy(none);
    ty_aggregate_destroy(raw);
}

static void test_refused(void** state)
{
    (void)state;
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.moisture.wet_basis = 0.02f;
    assert_refused(&r, "moisture.wet_basis", "0.05..1");
    r.moisture.wet_basis = 1.5f;
    assert_refused(&r, "moisture.wet_basis", "0.05..1");
    r = ty_aggregate_recipe_default();
    r.moisture.swelling = 3.0f;
    assert_refused(&r, "moisture.swelling", "0.5..2");
    r = ty_aggregate_recipe_default();
    r.settle.modulus = 10.0f;
    assert_refused(&r, "settle.modulus", "1e3..1e8");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_state),      cmocka_unit_test(test_law),  cmocka_unit_test(test_soaking),
        cmocka_unit_test(test_given_instead), cmocka_unit_test(test_file), cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
