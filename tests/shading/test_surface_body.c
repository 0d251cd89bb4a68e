// SPDX-License-Identifier: Apache-2.0
// `surface` with a share of its base that light enters: energy, and the same light as `cdrf` and `walk` have.
#include "stage.h"

static ty_surface_def body(float weight, int evaluate)
{
    ty_surface_def d = ty_surface_def_default();
    d.base_color = d.subsurface_color = ty_input_scalar(1);
    d.specular_weight = ty_input_scalar(0);
    d.subsurface_weight = ty_input_scalar(weight);
    d.subsurface_radius = ty_input_scalar(2e-4f);
    d.subsurface_evaluate = evaluate;
    return d;
}

// A ball of 1 mm.
static void make_ball(stage* s)
{
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, 1e-3f, 1e-3f, 1e-3f);
    shape.divisions = 96;
    stage_init_one(s, &shape);
}

static void test_furnace(void** state)
{
    (void)state;
    stage s;
    make_ball(&s);
    for (int i = 0; i < 8; i++)
    {
        ty_surface_def d = body(i & 1 ? 0.6f : 1.0f, i & 2 ? TY_SUBSURFACE_WALK : TY_SUBSURFACE_DEPTH);
        if (i & 4)
        {
            d.specular_weight = d.coat_weight = d.fuzz_weight = ty_input_scalar(1);
            d.coat_roughness = ty_input_scalar(0.3f);
        }
        ty_material* m = surface(&d);
        ty_vec3 from = {0.0006f, 0.0003f, 0.01f};
        ty_surface_point p = seen(&s, from, ty_vec3_make(0, 0, -1));
        // The walk leaves a little of its light at its bound on flights.
        assert_near(furnace(&s, m, &p, ty_vec3_make(0, 0, 1), 40000), 1.0, 0.006);
        ty_material_destroy(m);
    }
    stage_term(&s);
}

static double shown(const stage* s, const ty_material* m, double angle)
{
    ty_surface_point p = seen(s, ty_vec3_make(0.0003f, 0, 0.01f), ty_vec3_make(0, 0, -1));
    return lit(s, m, &p, ty_vec3_make(0, 0, 1), ty_vec3_make((float)sin(angle), 0, (float)cos(angle)), 60000);
}

// With nothing over it the body alone is the material of that name, at each angle of the light.
static void test_same_as_cdrf_and_walk(void** state)
{
    (void)state;
    stage s;
    make_ball(&s);
    ty_surface_def d = body(1.0f, TY_SUBSURFACE_DEPTH);
    d.subsurface_radius_scale = d.subsurface_color = ty_input_scalar(1);
    ty_cdrf_def c = white_cdrf(TY_CDRF_DEPTH, TY_CDRF_POISSON, 2e-4f);
    ty_walk_def w = ty_walk_def_default();
    w.common = c;
    w.subsurface_color = ty_input_scalar(0.8f);
    w.subsurface_radius = ty_input_scalar(2e-4f);
    w.subsurface_radius_scale = ty_input_scalar(1);
    ty_material *as_cdrf = cdrf(&c), *as_walk, *depth = surface(&d), *walk;
    ty_error error;
    assert_int_equal(ty_material_create_walk(&w, &as_walk, &error), TY_OK);
    d.subsurface_evaluate = TY_SUBSURFACE_WALK;
    d.subsurface_color = ty_input_scalar(0.8f);
    walk = surface(&d);
    assert_true(ty_material_is_subsurface(depth) && ty_material_needs_depth(depth) && !ty_material_needs_depth(walk));
    for (int i = 0; i < 4; i++)
    {
        double angle = 0.3 + 0.6 * i;
        assert_near(shown(&s, depth, angle), shown(&s, as_cdrf, angle), 0.012);
        assert_near(shown(&s, walk, angle), shown(&s, as_walk, angle), 0.012);
    }
    ty_material_destroy(as_cdrf);
    ty_material_destroy(as_walk);
    ty_material_destroy(depth);
    ty_material_destroy(walk);
    stage_term(&s);
}

// Channels with paths of their own: each as it is alone.
static void test_channels(void** state)
{
    (void)state;
    stage s;
    make_ball(&s);
    ty_surface_def d = body(1.0f, TY_SUBSURFACE_DEPTH);
    d.subsurface_radius = ty_input_scalar(6e-4f);
    const float scales[3] = {1, 0.3f, 0.05f};
    double alone[3];
    for (int i = 0; i < 3; i++)
    {
        d.subsurface_radius_scale = ty_input_scalar(scales[i]);
        ty_material* m = surface(&d);
        alone[i] = shown(&s, m, 1.9);
        ty_material_destroy(m);
    }
    assert_true(alone[0] > alone[1] + 0.02 && alone[1] > alone[2] + 0.02);
    // What `shown` sees is green: each scale takes its place there, among the others.
    for (int i = 0; i < 3; i++)
    {
        d.subsurface_radius_scale = ty_input_make(ty_rgb_make(scales[(i + 2) % 3], scales[i], scales[(i + 1) % 3]));
        ty_material* m = surface(&d);
        assert_near(shown(&s, m, 1.9), alone[i], 0.012);
        ty_bsdf b = bsdf_at(m, 0.3);
        for (int k = 0; k < 3; k++)
            assert_near(b.mean_free_path[k], 6e-4 * (double)scales[(i + k + 2) % 3], 1e-8);
        ty_material_destroy(m);
    }
    stage_term(&s);
}

static void test_bad_definitions(void** state)
{
    (void)state;
    ty_material* m;
    ty_error error;
    ty_surface_def d = body(1.0f, TY_SUBSURFACE_DEPTH);
    d.subsurface_radius = ty_input_scalar(0);
    assert_int_equal(ty_material_create_surface(&d, &m, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "subsurface_radius"));
    d = body(1.0f, TY_SUBSURFACE_WALK);
    d.subsurface_anisotropy = 1.0f;
    assert_int_equal(ty_material_create_surface(&d, &m, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "-0.99..0.99"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_furnace),
        cmocka_unit_test(test_same_as_cdrf_and_walk),
        cmocka_unit_test(test_channels),
        cmocka_unit_test(test_bad_definitions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
