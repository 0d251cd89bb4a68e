// SPDX-License-Identifier: Apache-2.0
// Inputs at a point, parameter tables, and what kind of material is what.
#include "spherical.h"

static void test_inputs(void** state)
{
    (void)state;
    const float tint[3] = {0.25f, 0.5f, 0.75f};
    const float* const with[2] = {NULL, tint};
    const float* const* const objects[2] = {NULL, with};
    ty_shading_context context = {.object_attributes = objects};
    ty_surface_point p = {.object = 1, .instance = 2};
    ty_input input = ty_input_make(ty_rgb_make(2, 4, 6));
    assert_near(ty_input_float(&input, NULL, &p), 2, 0);
    assert_near(ty_input_color(&input, &context, &p).b, 6, 0);
    input.attribute_index = 1;
    input.scale = 2;
    input.offset = -0.5f;
    assert_near(ty_input_float(&input, &context, &p), 2 * (-0.5 + 2 * 0.75), 1e-6);
    assert_near(ty_input_color(&input, &context, &p).b, 6 * (-0.5 + 2 * 0.75), 1e-6);
    // Absent on this object, or this attribute: the value alone.
    input.attribute_index = 0;
    assert_near(ty_input_float(&input, &context, &p), 2, 0);
    p.object = 0;
    assert_near(ty_input_color(&input, &context, &p).g, 4, 0);
}

static void check_table(const ty_param_table* table)
{
    _Alignas(16) char def[4096];
    assert_true(table->size <= sizeof(def));
    table->set_default(def);
    size_t end = 0;
    for (int i = 0; i < table->count; i++)
    {
        const ty_param* p = &table->params[i];
        assert_true(p->name && p->help && p->unit && p->offset >= end);
        bool input =
            p->type == TY_PARAM_SCALAR_INPUT || p->type == TY_PARAM_COLOR_INPUT || p->type == TY_PARAM_VECTOR_INPUT;
        if (p->type == TY_PARAM_BRIEF_GROUP || p->type == TY_PARAM_GROUP)
        {
            end = p->offset + p->group->size;
            continue;
        }
        end = p->offset + (input ? sizeof(ty_input) : sizeof(float));
        if (p->type == TY_PARAM_ENUM)
        {
            assert_non_null(p->choices[1]);
            continue;
        }
        if (p->type == TY_PARAM_BOOL || p->type == TY_PARAM_INT)
            continue;
        assert_true(p->maximum > p->minimum);
        float value = input ? ((const ty_input*)(def + p->offset))->value.r : *(const float*)(def + p->offset);
        double written = (double)value * (strcmp(p->unit, "mm") == 0 ? 1e3 : 1);
        assert_true(written >= p->minimum - 1e-6 && written <= p->maximum);
    }
    assert_true(end <= table->size && table->size - end < sizeof(void*));
}

static void test_parameter_tables(void** state)
{
    (void)state;
    check_table(ty_surface_params());
    check_table(ty_cdrf_params());
    check_table(ty_soak_params());
    check_table(ty_moisture_law_params());
    assert_int_equal(ty_surface_params()->count, 42);
    assert_int_equal(ty_cdrf_params()->count, 15);
}

static void test_kinds(void** state)
{
    (void)state;
    ty_surface_def sd = ty_surface_def_default();
    ty_cdrf_def cd = ty_cdrf_def_default();
    ty_material *s = surface(&sd), *depth = cdrf(&cd);
    cd.evaluate = TY_CDRF_LOCAL;
    ty_material* local = cdrf(&cd);
    assert_false(ty_material_is_subsurface(s) || ty_material_needs_depth(s) || ty_material_is_emissive(s));
    assert_true(ty_material_is_subsurface(depth) && ty_material_needs_depth(depth));
    assert_true(ty_material_is_subsurface(local) && !ty_material_needs_depth(local));
    assert_false(ty_material_is_emissive(depth));
    ty_material_destroy(s);
    ty_material_destroy(depth);
    ty_material_destroy(local);
    ty_material_destroy(NULL);
}

// Colour at a moisture, without any world: the water on the surface darkens and saturates.
static void test_moisture_of_an_instance_darkens(void** state)
{
    (void)state;
    const float moisture[2] = {0.145f, 0.62f};
    const float* const attributes[1] = {moisture};
    const float* const* const objects[1] = {attributes};
    ty_shading_context context = {.object_attributes = objects};
    ty_cdrf_def d = ty_cdrf_def_default();
    d.moisture.wet_basis = ty_input_scalar(1);
    d.moisture.wet_basis.attribute_index = 0;
    ty_material* m = cdrf(&d);
    ty_bsdf b[2];
    for (uint32_t i = 0; i < 2; i++)
    {
        ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}, .instance = i};
        ty_material_prepare(m, &context, &p, ty_vec3_make(0.6f, 0, 0.8f), &b[i]);
    }
    assert_true(b[1].color.g < b[0].color.g && b[1].color.b / b[1].color.r < b[0].color.b / b[0].color.r);
    assert_true(b[1].coat_weight > 1.5f * b[0].coat_weight && b[1].coat_alpha < 0.3f * b[0].coat_alpha);
    assert_true(b[1].mean_free_path[0] > 3 * b[0].mean_free_path[0]);
    ty_material_destroy(m);
}

// A normal bent away from the viewer must not make a black or broken pixel.
static void test_normal_turned_away(void** state)
{
    (void)state;
    ty_surface_def d = ty_surface_def_default();
    ty_material* m = surface(&d);
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0.6f, 0, 0.8f}};
    ty_bsdf b;
    ty_vec3 wo = ty_normalize(ty_vec3_make(-0.95f, 0, 0.1f));
    ty_material_prepare(m, NULL, &p, wo, &b);
    assert_true(ty_dot(wo, b.frame.n) > 0.0f);
    assert_near(ty_length(b.frame.n), 1.0, 1e-5);
    ty_rgb mean = mean_weight(&b, 20000);
    assert_true(mean.g > 0.5f && mean.g < 1.01f);
    ty_material_destroy(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inputs),
        cmocka_unit_test(test_parameter_tables),
        cmocka_unit_test(test_kinds),
        cmocka_unit_test(test_moisture_of_an_instance_darkens),
        cmocka_unit_test(test_normal_turned_away),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
