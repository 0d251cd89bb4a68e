// SPDX-License-Identifier: Apache-2.0
// `surface`: stretched highlights, sheets, transparency, and normals bent by maps.
#define INNER 32 // densities end within cells, at the horizon
#include "spherical.h"

static const double angles[] = {0.1, 0.7, 1.2, 1.45};

// Seen from another azimuth as well.
static ty_bsdf bsdf_around(const ty_material* material, double angle, double azimuth)
{
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    ty_bsdf b;
    double s = sin(angle);
    ty_material_prepare(material, NULL, &p,
                        ty_vec3_make((float)(s * cos(azimuth)), (float)(s * sin(azimuth)), (float)cos(angle)), &b);
    return b;
}

static ty_surface_def stretched(float roughness, float anisotropy, bool metal)
{
    ty_surface_def d = ty_surface_def_default();
    d.base_metalness = ty_input_scalar(metal ? 1.0f : 0.0f);
    d.transmission_weight = ty_input_scalar(metal ? 0.0f : 1.0f);
    d.base_color = ty_input_scalar(1);
    d.specular_roughness = ty_input_scalar(roughness);
    d.specular_roughness_anisotropy = ty_input_scalar(anisotropy);
    return d;
}

static void test_stretched_sampling(void** state)
{
    (void)state;
    for (int i = 0; i < 16; i++)
    {
        ty_surface_def d = stretched(i & 1 ? 0.45f : 0.8f, i & 2 ? 0.5f : 0.8f, i < 8);
        ty_material* m = surface(&d);
        ty_bsdf b = bsdf_around(m, i & 4 ? 0.5 : 1.1, 0.7);
        ty_vec3 axis = ty_reflect(b.wo, ty_vec3_make(0, 0, 1));
        if (i >= 8)
            axis = ty_vec3_make(-b.wo.x / 1.5f, -b.wo.y / 1.5f, -0.8f);
        check_sampling(&b, axis, 200000);
        ty_material_destroy(m);
    }
}

// What stretched facets lose is taken to be that of round ones with the same mean square of slopes.
static void test_stretched_energy(void** state)
{
    (void)state;
    double worst[2] = {0, 0};
    for (int i = 0; i < 6 * 4 * 3; i++)
    {
        float anisotropy = 0.3f * (float)(i % 3 + 1), roughness = 0.2f + 0.2f * (float)(i / 3 % 4);
        ty_surface_def d = stretched(roughness, anisotropy, i / 12 % 2 == 0);
        ty_material* m = surface(&d);
        ty_bsdf b = bsdf_around(m, angles[i / 12 % 4], (double)i);
        double e = (double)mean_weight(&b, 50000).g;
        worst[0] = fmin(worst[0], e - 1);
        worst[1] = fmax(worst[1], e - 1);
        ty_material_destroy(m);
    }
    print_message("stretched: %+.4f .. %+.4f\n", worst[0], worst[1]);
    assert_true(worst[0] > -0.13 && worst[1] < 0.06);
}

static void test_highlight_is_longer_along_u(void** state)
{
    (void)state;
    ty_surface_def d = stretched(0.4f, 0.8f, true);
    ty_material* m = surface(&d);
    ty_bsdf b = bsdf_at(m, 0.0);
    float pdf;
    ty_vec3 along = ty_to_world(b.frame, ty_vec3_make(0.4f, 0, 0.9165f));
    ty_vec3 across = ty_to_world(b.frame, ty_vec3_make(0, 0.4f, 0.9165f));
    assert_true(ty_bsdf_eval(&b, along, &pdf).g > 4.0f * ty_bsdf_eval(&b, across, &pdf).g);
    ty_material_destroy(m);
    d.specular_rotation = ty_input_scalar((float)M_PI / 2);
    m = surface(&d);
    b = bsdf_at(m, 0.0);
    assert_near(b.alpha.x * b.alpha.y, 0.16 * 0.16 * 2 * 0.2 / 1.04, 1e-5);
    assert_true(ty_bsdf_eval(&b, across, &pdf).g > 4.0f * ty_bsdf_eval(&b, along, &pdf).g);
    ty_material_destroy(m);
}

static ty_surface_def sheet(float roughness)
{
    ty_surface_def d = ty_surface_def_default();
    d.thin_walled = true;
    d.transmission_weight = ty_input_scalar(1);
    d.specular_roughness = ty_input_scalar(roughness);
    return d;
}

// All orders between the two sides of a pane: 2 F / (1 + F) comes back, the rest goes through unbent.
static void test_smooth_sheet(void** state)
{
    (void)state;
    ty_surface_def d = sheet(0);
    ty_material* m = surface(&d);
    assert_true(ty_material_traits(m) & TY_TRAIT_TRANSPARENT);
    for (int a = 0; a < 8; a++)
    {
        double angle = a % 2 ? M_PI - angles[a / 2] : angles[a / 2];
        ty_bsdf b = bsdf_at(m, angle);
        ty_transparency t = ty_material_transparency(m, NULL, &b.point, b.wo);
        double s = sin(angle) / 1.5, ct = sqrt(1 - s * s), c = fabs(cos(angle));
        double rs = (c - 1.5 * ct) / (c + 1.5 * ct), rp = (1.5 * c - ct) / (1.5 * c + ct);
        double f = 0.5 * (rs * rs + rp * rp);
        assert_true(ty_bsdf_is_delta(&b));
        assert_near(mean_weight(&b, 1000).g, 2 * f / (1 + f), 1e-4);
        assert_near(t.through.g, (1 - f) / (1 + f), 1e-4);
        assert_near(t.opacity, 1, 0);
    }
    ty_material_destroy(m);
}

static void test_rough_sheet(void** state)
{
    (void)state;
    for (int i = 0; i < 4; i++)
    {
        ty_surface_def d = sheet(0.25f + 0.25f * (float)i);
        ty_material* m = surface(&d);
        assert_false(ty_material_traits(m) & TY_TRAIT_TRANSPARENT);
        for (int a = 0; a < 4; a++)
        {
            ty_bsdf b = bsdf_at(m, angles[a]);
            assert_near(mean_weight(&b, 100000).g, 1.0, 0.003);
        }
        ty_bsdf b = bsdf_at(m, 0.7);
        check_sampling(&b, ty_neg(b.wo), 200000);
        ty_material_destroy(m);
    }
}

static void test_leaf(void** state)
{
    (void)state;
    ty_surface_def d = ty_surface_def_default();
    d.thin_walled = true;
    d.specular_weight = ty_input_scalar(0.7f);
    d.subsurface_weight = ty_input_scalar(1);
    d.subsurface_color = ty_input_scalar(1);
    d.subsurface_anisotropy = 0.4f;
    ty_material* m = surface(&d);
    for (int a = 0; a < 4; a++)
    {
        ty_bsdf b = bsdf_at(m, angles[a]);
        assert_near(mean_weight(&b, 100000).g, 1.0, 0.004);
        check_sampling(&b, ty_neg(b.wo), 100000);
    }
    // Under no reflection .7 of the light goes through and .3 comes back, at any angle.
    ty_material_destroy(m);
    d.specular_weight = ty_input_scalar(0);
    m = surface(&d);
    ty_bsdf b = bsdf_at(m, 0.7);
    float pdf;
    assert_near(ty_bsdf_eval(&b, ty_vec3_make(0, 0.6f, 0.8f), &pdf).g, 0.8 * 0.3 / M_PI, 1e-5);
    assert_near(ty_bsdf_eval(&b, ty_vec3_make(0, 0.6f, -0.8f), &pdf).g, 0.8 * 0.7 / M_PI, 1e-5);
    ty_material_destroy(m);
}

static void test_opacity(void** state)
{
    (void)state;
    ty_surface_def d = ty_surface_def_default();
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    ty_material* m = surface(&d);
    assert_false(ty_material_traits(m) & TY_TRAIT_TRANSPARENT);
    assert_near(ty_material_transparency(m, NULL, &p, p.ng).opacity, 1, 0);
    ty_material_destroy(m);
    d.opacity = ty_input_scalar(0.25f);
    m = surface(&d);
    assert_true(ty_material_traits(m) & TY_TRAIT_TRANSPARENT);
    ty_transparency t = ty_material_transparency(m, NULL, &p, p.ng);
    assert_near(t.opacity, 0.25, 1e-7);
    assert_near(t.through.r, 0.75, 1e-7);
    ty_material_destroy(m);
}

// A normal from an attribute of one instance: value times 1.
typedef struct bent_stage
{
    float one[1];
    const float* attributes[1];
    const float* const* objects[1];
    ty_shading_context context;
} bent_stage;

static ty_bsdf bent(bent_stage* s, ty_surface_def* d, ty_vec3 n, double angle, ty_material** m)
{
    *s = (bent_stage){.one = {1}};
    s->attributes[0] = s->one;
    s->objects[0] = s->attributes;
    s->context = (ty_shading_context){.object_attributes = s->objects};
    d->normal = ty_input_make(ty_rgb_make(n.x, n.y, n.z));
    d->normal.attribute_index = 0;
    *m = surface(d);
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    ty_bsdf b;
    ty_material_prepare(*m, &s->context, &p, ty_vec3_make((float)sin(angle), 0, (float)cos(angle)), &b);
    return b;
}

static const ty_vec3 tilted[] = {{0.3f, 0.1f, 0.9f}, {-0.8f, 0.3f, 0.4f}, {0.9f, 0.3f, 0.1f}, {-0.99f, 0, 0.02f}};

static void check_bent(ty_surface_def* d, double tolerance)
{
    for (int i = 0; i < 16; i++)
    {
        bent_stage s;
        ty_material* m;
        ty_bsdf b = bent(&s, d, tilted[i % 4], angles[i / 4], &m);
        assert_true(b.bent && ty_dot(b.frame.n, b.wo) > 0);
        assert_near(mean_weight(&b, 100000).g, 1.0, tolerance);
        ty_rng rng = ty_rng_make((ty_seed){4}, 0, 0);
        for (int k = 0; k < 2000; k++)
        {
            ty_bsdf_sample sample;
            float u = ty_rng_float(&rng), ux = ty_rng_float(&rng);
            if (ty_bsdf_sample_wi(&b, u, (ty_vec2){ux, ty_rng_float(&rng)}, &sample))
                assert_true((sample.wi.z > 0) != sample.transmitted);
        }
        ty_material_destroy(m);
    }
}

// However a map bends the normal, nothing is lost and nothing goes through.
static void test_bent_normals_keep_energy(void** state)
{
    (void)state;
    ty_surface_def d = ty_surface_def_default();
    d.base_color = ty_input_scalar(1);
    d.specular_weight = ty_input_scalar(0);
    check_bent(&d, 1e-4);
    d.specular_weight = ty_input_scalar(1);
    check_bent(&d, 0.006);
    d = stretched(0.5f, 0.0f, true);
    check_bent(&d, 0.006);
    d = stretched(0.0f, 0.0f, true);
    check_bent(&d, 1e-4);
    d = stretched(0.4f, 0.0f, false);
    check_bent(&d, 0.006);
}

static void test_bent_sampling(void** state)
{
    (void)state;
    for (int i = 0; i < 12; i++)
    {
        bent_stage s;
        ty_material* m;
        ty_surface_def d = stretched(0.5f, 0.0f, i < 4);
        if (i >= 8)
        {
            d = ty_surface_def_default();
            d.coat_weight = ty_input_scalar(1);
            d.coat_roughness = ty_input_scalar(0.4f);
        }
        ty_bsdf b = bent(&s, &d, tilted[i % 4], 0.6, &m);
        ty_bsdf_sample peak;
        assert_true(ty_bsdf_sample_wi(&b, 0.01f, (ty_vec2){0.5f, 0.1f}, &peak));
        check_sampling(&b, peak.wi, 40000);
        ty_material_destroy(m);
    }
}

static void test_bent_opaque_does_not_leak(void** state)
{
    (void)state;
    ty_surface_def d = ty_surface_def_default();
    bent_stage s;
    ty_material* m;
    ty_bsdf b = bent(&s, &d, tilted[1], 0.6, &m);
    ty_rng rng = ty_rng_make((ty_seed){5}, 0, 0);
    for (int k = 0; k < 5000; k++)
    {
        float pdf, z = ty_rng_float(&rng), phi = 6.2831853f * ty_rng_float(&rng), r = sqrtf(1 - z * z);
        ty_vec3 wi = ty_vec3_make(r * cosf(phi), r * sinf(phi), -z);
        assert_true(ty_rgb_is_black(ty_bsdf_eval(&b, wi, &pdf)) && pdf == 0.0f);
    }
    ty_material_destroy(m);
}

static void test_bad_definitions(void** state)
{
    (void)state;
    ty_material* m;
    ty_error error;
    ty_surface_def d = sheet(0);
    d.priority = 2;
    assert_int_equal(ty_material_create_surface(&d, &m, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "priority"));
    d = ty_surface_def_default();
    d.opacity = ty_input_scalar(1.5f);
    assert_int_equal(ty_material_create_surface(&d, &m, &error), TY_BAD_INPUT);
    d = ty_surface_def_default();
    d.bump.attribute_index = 0;
    assert_int_equal(ty_material_create_surface(&d, &m, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "slope"));
    d = ty_surface_def_default();
    d.normal_strength = -1;
    assert_int_equal(ty_material_create_surface(&d, &m, &error), TY_BAD_INPUT);
    ty_cdrf_def c = ty_cdrf_def_default();
    c.evaluate = TY_CDRF_LOCAL;
    c.bump.texture_index = 0;
    assert_int_equal(ty_material_create_cdrf(&c, &m, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "probe"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stretched_sampling),
        cmocka_unit_test(test_stretched_energy),
        cmocka_unit_test(test_highlight_is_longer_along_u),
        cmocka_unit_test(test_smooth_sheet),
        cmocka_unit_test(test_rough_sheet),
        cmocka_unit_test(test_leaf),
        cmocka_unit_test(test_opacity),
        cmocka_unit_test(test_bent_normals_keep_energy),
        cmocka_unit_test(test_bent_sampling),
        cmocka_unit_test(test_bent_opaque_does_not_leak),
        cmocka_unit_test(test_bad_definitions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
