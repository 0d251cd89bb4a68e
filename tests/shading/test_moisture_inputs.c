// SPDX-License-Identifier: Apache-2.0
// Moisture from what a scene says to the state at a point, and to the terminator of a grain.
#include "spherical.h"
#include <tsuya/shading/cdrf.h>
#include <tsuya/shading/material.h>

static ty_input by_attribute(float value, float scale, float offset)
{
    ty_input input = ty_input_scalar(value);
    input.attribute_index = 0;
    input.scale = scale;
    input.offset = offset;
    return input;
}

// Three instances with one attribute.
static ty_moisture at(const ty_moisture_inputs* inputs, uint32_t instance)
{
    static const float values[3] = {0.0f, 0.25f, 1.0f};
    static const float* const attributes[1] = {values};
    static const float* const* const objects[1] = {attributes};
    ty_shading_context context = {.object_attributes = objects};
    ty_surface_point p = {.instance = instance};
    return ty_moisture_at(inputs, &context, &p);
}

static void test_three_ways(void** state)
{
    (void)state;
    ty_moisture_inputs m = ty_moisture_inputs_default();
    assert_near(at(&m, 0).wet_basis, 0.62, 1e-6);
    assert_near(at(&m, 0).cooked, 1, 0);
    m.source = TY_MOISTURE_UPTAKE;
    m.uptake = ty_input_scalar(0.24f);
    assert_near(at(&m, 0).wet_basis, 0.385 / 1.24, 1e-6);
    assert_near(at(&m, 0).cooked, 0, 5e-3);
    m.source = TY_MOISTURE_SOAK;
    const double minutes[3] = {20, 60, 120}, taken_up[3] = {0.6916, 0.9707, 0.99914};
    for (int i = 0; i < 3; i++)
    {
        m.soak.minutes = ty_input_scalar((float)minutes[i]);
        double u = 0.24 * taken_up[i];
        assert_near(at(&m, 0).wet_basis, (0.145 + u) / (1 + u), 1e-4);
        assert_near(at(&m, 0).cooked, 0, 0);
    }
    m.cooked = ty_input_scalar(1);
    assert_near(at(&m, 0).wet_basis, 0.62, 1e-5);
}

static void test_by_instance(void** state)
{
    (void)state;
    ty_moisture_inputs m = ty_moisture_inputs_default();
    m.wet_basis = by_attribute(1, 1, 0);
    assert_near(at(&m, 0).wet_basis, 0.05, 1e-7); // the law ends there
    assert_near(at(&m, 1).wet_basis, 0.25, 0);
    assert_near(at(&m, 2).wet_basis, 1, 0);
    assert_false(ty_moisture_inputs_are_constant(&m));
    m = ty_moisture_inputs_default();
    assert_true(ty_moisture_inputs_are_constant(&m));
    m.source = TY_MOISTURE_SOAK;
    m.soak.minutes = by_attribute(80, 1, 0);
    assert_false(ty_moisture_inputs_are_constant(&m));
    assert_near(at(&m, 0).wet_basis, 0.145, 1e-6);
    double u = (double)ty_moisture_uptake(20, 10);
    assert_near(at(&m, 1).wet_basis, (0.145 + u) / (1 + u), 1e-6);
    m.cooked = by_attribute(1, 1, 0);
    assert_near(at(&m, 2).wet_basis, 0.62, 1e-5);
}

static void test_gradient_ends_at_its_value(void** state)
{
    (void)state;
    ty_moisture_inputs m = ty_moisture_inputs_default();
    m.gradient = by_attribute(-0.2f, 1, 0);
    assert_near(at(&m, 0).wet_basis, 0.62, 1e-6);
    assert_near(at(&m, 1).wet_basis, 0.57, 1e-6);
    assert_near(at(&m, 2).wet_basis, 0.42, 1e-6);
    assert_near(at(&m, 2).cooked, 1, 0); // it dries, and stays cooked
    m.gradient = by_attribute(-0.2f, -2, 1);
    assert_near(at(&m, 0).wet_basis, 0.42, 1e-6);
    assert_near(at(&m, 1).wet_basis, 0.52, 1e-6);
    assert_near(at(&m, 2).wet_basis, 0.62, 1e-6); // not wetter than without
    m.gradient = by_attribute(0.2f, 3, 0);
    assert_near(at(&m, 1).wet_basis, 0.77, 1e-6);
    assert_near(at(&m, 2).wet_basis, 0.82, 1e-6);
    m.gradient = ty_input_scalar(-0.9f);
    assert_near(at(&m, 0).wet_basis, 0.05, 1e-7);
}

// One moisture, said of the material or by the instance: the same bits.
static void test_instance_is_material(void** state)
{
    (void)state;
    ty_cdrf_def d = ty_cdrf_def_default();
    const float values[4] = {0.145f, 0.31f, 0.62f, 0.8f};
    const float* const attributes[1] = {values};
    const float* const* const objects[1] = {attributes};
    ty_shading_context context = {.object_attributes = objects};
    d.moisture.wet_basis = by_attribute(1, 1, 0);
    ty_material *by_point, *plain;
    ty_error error;
    assert_int_equal(ty_material_create_cdrf(&d, &by_point, &error), TY_OK);
    for (uint32_t i = 0; i < 4; i++)
    {
        d.moisture.wet_basis = ty_input_scalar(values[i]);
        assert_int_equal(ty_material_create_cdrf(&d, &plain, &error), TY_OK);
        ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}, .instance = i};
        ty_bsdf a, b;
        ty_material_prepare(by_point, &context, &p, ty_vec3_make(0.6f, 0, 0.8f), &a);
        ty_material_prepare(plain, &context, &p, ty_vec3_make(0.6f, 0, 0.8f), &b);
        assert_memory_equal(&a.color, &b.color, sizeof a.color);
        assert_memory_equal(&a.mean_free_path, &b.mean_free_path, sizeof a.mean_free_path);
        assert_memory_equal(&a.coat_alpha, &b.coat_alpha, sizeof a.coat_alpha);
        assert_memory_equal(&a.coat_weight, &b.coat_weight, sizeof a.coat_weight);
        ty_material_destroy(plain);
    }
    ty_material_destroy(by_point);
}

static void test_cooked_beside_moisture(void** state)
{
    (void)state;
    ty_cdrf_def d = ty_cdrf_def_default();
    ty_bsdf b[2];
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    for (int i = 0; i < 2; i++)
    {
        ty_material* m;
        ty_error error;
        d = ty_cdrf_def_default();
        d.moisture.wet_basis = ty_input_scalar(0.31f);
        d.cooked = i ? 0.5f : -1.0f;
        d.moisture.cooked = ty_input_scalar(i ? -1.0f : 0.5f);
        assert_int_equal(ty_material_create_cdrf(&d, &m, &error), TY_OK);
        ty_material_prepare(m, NULL, &p, ty_vec3_make(0, 0, 1), &b[i]);
        ty_material_destroy(m);
    }
    assert_near(b[0].mean_free_path[0], sqrt(.10 * .3753) * 1e-3, 1e-6);
    assert_near(b[0].mean_free_path[0], b[1].mean_free_path[0], 0);
}

// Angle from half of the lit pole's light to a tenth of it.
static double terminator_width(bool published, float spread)
{
    double at_half = 0, at_tenth = 0;
    float full = published ? ty_cdrf_gaussian_published(spread, 0) : ty_cdrf_poisson(spread, 1);
    for (int i = 0; i <= 18000; i++)
    {
        float theta = (float)i * (TY_PI / 18000);
        float e = (published ? ty_cdrf_gaussian_published(spread, theta) : ty_cdrf_poisson(spread, cosf(theta))) / full;
        at_half = e > 0.5f ? theta : at_half;
        at_tenth = e > 0.1f ? theta : at_tenth;
    }
    return at_tenth - at_half;
}

static void test_terminator_grows_with_uptake(void** state)
{
    (void)state;
    double before[2] = {0, 0};
    for (int i = 0; i <= 24; i += 4)
    {
        float w = ty_moisture_wet_basis((float)i / 100);
        ty_moisture_optics o = ty_moisture_optics_make((ty_moisture){w, 1});
        assert_near(o.gaussian_sigma, 1e-3 * exp(0.34 + 0.52 * log((double)w)), 1e-9);
        double width[2] = {terminator_width(false, ty_cdrf_poisson_t(o.mean_free_path / 1.2e-3f, 0)),
                           terminator_width(true, o.gaussian_sigma / 1.2e-3f)};
        for (int k = 0; k < 2; k++)
        {
            assert_true(width[k] > before[k] + 0.005);
            before[k] = width[k];
        }
    }
}

// Above what the grain can hold, water lies on it: darker, more saturated, smoother.
static void test_free_water(void** state)
{
    (void)state;
    ty_moisture_optics held = ty_moisture_optics_make((ty_moisture){0.62f, 1});
    ty_moisture_optics wet = ty_moisture_optics_make((ty_moisture){0.72f, 1});
    ty_moisture_optics raw = ty_moisture_optics_make((ty_moisture){0.31f, 0});
    ty_moisture_optics dripping = ty_moisture_optics_make((ty_moisture){0.41f, 0});
    assert_near(held.water, 0, 0);
    assert_near(held.color_exponent, 1, 0); // the colour of a material is that of the cooked state
    assert_near(raw.water, 0, 1e-6);
    assert_true(wet.water > 0.5f && wet.roughness < 0.75f * held.roughness && wet.color_exponent > 1.05f);
    assert_true(dripping.water > 0.5f && dripping.roughness < raw.roughness);
    assert_near(ty_moisture_optics_make((ty_moisture){0.9f, 1}).water, 1, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_three_ways),
        cmocka_unit_test(test_by_instance),
        cmocka_unit_test(test_gradient_ends_at_its_value),
        cmocka_unit_test(test_instance_is_material),
        cmocka_unit_test(test_cooked_beside_moisture),
        cmocka_unit_test(test_terminator_grows_with_uptake),
        cmocka_unit_test(test_free_water),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
