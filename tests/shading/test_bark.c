// SPDX-License-Identifier: Apache-2.0
// `bark`: energy, no seams, what age, water, lichen and distance do, and its relief.
#include "stage.h"

static ty_material* bark(const ty_bark_def* def)
{
    ty_error error = {0};
    ty_material* m;
    assert_int_equal(ty_material_create_bark(def, &m, &error), TY_OK);
    return m;
}

static ty_shading_context no_world(void)
{
    return (ty_shading_context){0};
}

// A place on a root of 5 mm along z.
static ty_surface_point place(float u, float v)
{
    float angle = 2.0f * (float)M_PI * u;
    ty_vec3 n = {cosf(angle), sinf(angle), 0.0f};
    return (ty_surface_point){
        .position = {0.005f * n.x, 0.005f * n.y, v}, .ng = n, .ns = n, .uv = {u, v}, .horizon = 1.0f};
}

static ty_rgb color_at(const ty_material* m, const ty_surface_point* p, ty_bsdf* b)
{
    ty_shading_context context = no_world();
    ty_material_prepare(m, &context, p, p->ng, b);
    return b->color;
}

// Mean colour of many places; variance of its green.
static ty_rgb mean_of(const ty_bark_def* def, float footprint, double* variance, float* alpha)
{
    ty_material* m = bark(def);
    double sum[3] = {0}, squares = 0.0;
    float least = 1.0f;
    const int n = 3000;
    for (int i = 0; i < n; i++)
    {
        ty_bsdf b;
        ty_surface_point p = place((float)(i % 61) / 61.0f, 0.4f * (float)i / (float)n);
        p.footprint[0] = ty_vec3_make(0, 0, footprint);
        p.footprint[1] = ty_vec3_make(footprint * p.ng.y, -footprint * p.ng.x, 0);
        ty_rgb c = color_at(m, &p, &b);
        sum[0] += (double)c.r / n;
        sum[1] += (double)c.g / n;
        sum[2] += (double)c.b / n;
        squares += (double)c.g * (double)c.g / n;
        least = ty_min(least, b.alpha.x);
    }
    ty_material_destroy(m);
    *variance = squares - sum[1] * sum[1];
    *alpha = least;
    return ty_rgb_make((float)sum[0], (float)sum[1], (float)sum[2]);
}

static void test_white_furnace(void** state)
{
    (void)state;
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, 5e-3f, 0, 0);
    stage_init_one(&s, &shape);
    ty_bark_def d = ty_bark_def_default();
    d.young_color = d.old_color = d.crease_color = ty_input_scalar(1);
    d.depth = 0.0f;
    ty_surface_point p = seen(&s, ty_vec3_make(0.001f, 0.002f, 1), ty_vec3_make(0, 0, -1));
    ty_material* m = bark(&d);
    double shown = furnace(&s, m, &p, ty_vec3_make(0, 0, 1), 20000);
    assert_true(shown <= 1.004 && shown > 0.6);
    ty_material_destroy(m);
    stage_term(&s);
}

// One turn about the root ends where it began; where roots meet, their coordinates do not matter.
static void test_no_seams(void** state)
{
    (void)state;
    ty_bark_def d = ty_bark_def_default();
    ty_material* m = bark(&d);
    d.join = ty_input_scalar(1);
    ty_material* joined = bark(&d);
    int differ = 0;
    for (int i = 0; i < 200; i++)
    {
        ty_bsdf b;
        ty_surface_point from = place(0.0f, 0.002f * (float)i), to = from, elsewhere = from;
        to.uv.x = 1.0f;
        elsewhere.uv = (ty_vec2){0.37f, 1.3f};
        assert_near(color_at(m, &from, &b).g, color_at(m, &to, &b).g, 2e-4);
        assert_near(color_at(joined, &from, &b).g, color_at(joined, &elsewhere, &b).g, 1e-7);
        differ += fabsf(color_at(m, &from, &b).g - color_at(m, &elsewhere, &b).g) > 1e-3f;
    }
    assert_true(differ > 100);
    ty_material_destroy(m);
    ty_material_destroy(joined);
}

static void test_age_water_lichen(void** state)
{
    (void)state;
    double variance, even;
    float dry, wet;
    ty_bark_def d = ty_bark_def_default();
    d.age = ty_input_scalar(0);
    ty_rgb young = mean_of(&d, 0, &variance, &dry);
    d.age = ty_input_scalar(1);
    ty_rgb old = mean_of(&d, 0, &even, &dry);
    assert_true(old.r < young.r && old.r / old.b < young.r / young.b); // darker and greyer
    assert_true(even > variance);                                      // and rougher
    assert_near(dry, 0.62 * 0.62, 1e-5);
    d.moisture = ty_input_scalar(1);
    ty_rgb drenched = mean_of(&d, 0, &variance, &wet);
    assert_true(drenched.g < 0.8f * old.g && drenched.g > 0.3f * old.g);
    d.age = ty_input_scalar(0);
    ty_rgb deep = mean_of(&d, 0, &variance, &wet);
    assert_true(deep.r / deep.b > 1.03f * young.r / young.b); // deeper colours
    d.age = ty_input_scalar(1);
    assert_true(wet < 0.05f); // a film stands in the runs
    d.moisture = ty_input_scalar(0);
    d.lichen = ty_input_scalar(0.7f);
    d.lichen_color = ty_input_make(ty_rgb_make(0, 1, 0));
    ty_rgb grown = mean_of(&d, 0, &variance, &dry);
    d.age = ty_input_scalar(0.2f);
    ty_rgb less = mean_of(&d, 0, &variance, &dry);
    assert_true(grown.g > old.g + 0.1f && grown.g < 0.9f && less.g < grown.g - 0.05f);
}

// From afar all is as bright as from near, without the pattern.
static void test_distance(void** state)
{
    (void)state;
    double near, far;
    float alpha;
    ty_bark_def d = ty_bark_def_default();
    ty_rgb from_near = mean_of(&d, 0, &near, &alpha), from_afar = mean_of(&d, 0.5f, &far, &alpha);
    assert_true(near > 1e-4 && far < 1e-9);
    assert_near(from_afar.g, from_near.g, 0.012);
}

// Patterns are as large on an instance that is scaled as on a mesh of that size.
static void test_scaled_instances(void** state)
{
    (void)state;
    stage s[2];
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, 5e-3f, 0, 0);
    ty_affine twice = {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {0, 0, 0}};
    stage_init(&s[0], &shape, &twice, 1);
    shape.radius = 10e-3f;
    stage_init_one(&s[1], &shape);
    ty_bark_def d = ty_bark_def_default();
    d.depth = 0.0f;
    d.join = ty_input_scalar(1);
    ty_material* m = bark(&d);
    for (int k = 0; k < 40; k++)
    {
        ty_rgb color[2];
        for (int i = 0; i < 2; i++)
        {
            ty_bsdf b;
            ty_surface_point p = seen(&s[i], ty_vec3_make(2e-4f * (float)k, 1e-4f, 1), ty_vec3_make(0, 0, -1));
            ty_material_prepare(m, &s[i].context, &p, p.ng, &b);
            color[i] = b.color;
        }
        assert_near(color[0].g, color[1].g, 2e-3);
    }
    ty_material_destroy(m);
    stage_term(&s[0]);
    stage_term(&s[1]);
}

// The normal leans by the slope of the relief: twice the depth, twice the slope; none without.
static void test_relief(void** state)
{
    (void)state;
    ty_shading_context context = no_world();
    double steep[3] = {0};
    for (int k = 0; k < 3; k++)
    {
        ty_bark_def d = ty_bark_def_default();
        d.depth = 5e-5f * (float)k;
        ty_material* m = bark(&d);
        for (int i = 0; i < 300; i++)
        {
            ty_bsdf b;
            ty_surface_point p = place(0.13f, 1e-3f * (float)i);
            ty_material_prepare(m, &context, &p, p.ng, &b);
            ty_vec3 across = ty_cross(b.frame.n, p.ng);
            steep[k] += sqrt((double)ty_length_sqr(across)) / (double)ty_dot(b.frame.n, p.ng) / 300;
        }
        ty_material_destroy(m);
    }
    assert_near(steep[0], 0, 1e-6);
    assert_true(steep[1] > 2e-3);
    assert_near(steep[2] / steep[1], 2, 0.02);
}

static void test_refusals(void** state)
{
    (void)state;
    ty_error error = {0};
    ty_material* m;
    ty_bark_def d = ty_bark_def_default();
    d.size = 0.0f;
    assert_int_equal(ty_material_create_bark(&d, &m, &error), TY_BAD_INPUT);
    assert_null(m);
    assert_non_null(strstr(error.text, "size"));
    d = ty_bark_def_default();
    d.depth = -1.0f;
    assert_int_equal(ty_material_create_bark(&d, &m, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "depth"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_white_furnace), cmocka_unit_test(test_no_seams), cmocka_unit_test(test_age_water_lichen),
        cmocka_unit_test(test_distance),      cmocka_unit_test(test_relief),   cmocka_unit_test(test_scaled_instances),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
