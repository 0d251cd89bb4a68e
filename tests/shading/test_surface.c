// SPDX-License-Identifier: Apache-2.0
// `surface`: sampling against density, energy, Fresnel, reciprocity, emission, absorption.
#include "spherical.h"
#include <tsuya/shading/media.h>
#include <tsuya/shading/sampling.h>

static const double angles[] = {0.1, 0.7, 1.2, 1.45};

static ty_surface_def metal(float roughness)
{
    ty_surface_def d = ty_surface_def_default();
    d.base_metalness = ty_input_scalar(1);
    d.base_color = ty_input_make(ty_rgb_make(0.9f, 0.6f, 0.3f));
    d.specular_roughness = ty_input_scalar(roughness);
    return d;
}

static ty_surface_def glass(float roughness)
{
    ty_surface_def d = ty_surface_def_default();
    d.transmission_weight = ty_input_scalar(1);
    d.specular_roughness = ty_input_scalar(roughness);
    return d;
}

static ty_surface_def white(float specular, float roughness)
{
    ty_surface_def d = ty_surface_def_default();
    d.base_color = ty_input_scalar(1);
    d.specular_weight = ty_input_scalar(specular);
    d.specular_roughness = ty_input_scalar(roughness);
    return d;
}

// Mirror direction, bent a little towards the normal as the peak of a rough lobe is not.
static ty_vec3 mirror(double angle)
{
    return ty_vec3_make(-(float)sin(angle), 0, (float)cos(angle));
}

static void check_at_angles(const ty_surface_def* def, bool along_refraction)
{
    ty_material* m = surface(def);
    for (int i = 0; i < 4; i++)
    {
        ty_bsdf b = bsdf_at(m, angles[i]);
        float s = (float)sin(angles[i]) / def->specular_ior.value.r;
        ty_vec3 refracted = ty_vec3_make(-s, 0, -sqrtf(1 - s * s));
        check_sampling(&b, along_refraction ? refracted : mirror(angles[i]), 200000);
    }
    ty_material_destroy(m);
}

static void test_metal_sampling(void** state)
{
    (void)state;
    static const float roughness[] = {0.25f, 0.4f, 0.7f, 1.0f};
    for (int i = 0; i < 4; i++)
    {
        ty_surface_def d = metal(roughness[i]);
        check_at_angles(&d, false);
    }
}

static void test_plastic_and_coat_sampling(void** state)
{
    (void)state;
    ty_surface_def d = white(1, 0.5f);
    d.base_color = ty_input_make(ty_rgb_make(0.8f, 0.2f, 0.1f));
    check_at_angles(&d, false);
    d.coat_weight = ty_input_scalar(0.8f);
    d.coat_roughness = ty_input_scalar(0.3f);
    d.base_metalness = ty_input_scalar(0.3f);
    check_at_angles(&d, false);
    d.coat_roughness = ty_input_scalar(0); // a mirror over rough lobes
    check_at_angles(&d, false);
}

static void test_rough_transmission_sampling(void** state)
{
    (void)state;
    ty_surface_def d = glass(0.4f);
    check_at_angles(&d, true);
    d.specular_roughness = ty_input_scalar(0.7f);
    check_at_angles(&d, true);
    d.transmission_weight = ty_input_scalar(0.5f);
    d.coat_weight = ty_input_scalar(0.5f);
    d.coat_roughness = ty_input_scalar(0.5f);
    check_at_angles(&d, true);
    // From within, beyond the critical angle too.
    ty_material* m = surface(&d);
    for (int i = 0; i < 3; i++)
    {
        double angle = M_PI - angles[i];
        ty_bsdf b = bsdf_at(m, angle);
        assert_true(b.inside && !b.entering);
        check_sampling(&b, ty_vec3_make(-(float)sin(angle), 0, (float)cos(angle)), 200000);
    }
    ty_material_destroy(m);
}

static void test_lambert_furnace_is_exact(void** state)
{
    (void)state;
    ty_surface_def d = white(0, 0.3f);
    ty_material* m = surface(&d);
    ty_rng rng = ty_rng_make((ty_seed){2}, 0, 0);
    for (int i = 0; i < 1000; i++)
    {
        ty_bsdf b = bsdf_at(m, 1.5 * (double)ty_rng_float(&rng));
        ty_bsdf_sample s;
        float ux = ty_rng_float(&rng);
        assert_true(ty_bsdf_sample_wi(&b, ty_rng_float(&rng), (ty_vec2){ux, ty_rng_float(&rng)}, &s));
        assert_near(s.weight.r, 1.0, 1e-6);
        assert_false(s.delta || s.transmitted);
    }
    ty_material_destroy(m);
}

static void test_white_under_specular_keeps_energy(void** state)
{
    (void)state;
    static const float roughness[] = {0.0f, 0.1f, 0.3f, 0.6f, 1.0f};
    for (int i = 0; i < 5; i++)
        for (int coated = 0; coated < 2; coated++)
        {
            ty_surface_def d = white(1, roughness[i]);
            d.coat_weight = ty_input_scalar(coated ? 1.0f : 0.0f);
            d.coat_roughness = ty_input_scalar(0.2f);
            ty_material* m = surface(&d);
            for (int a = 0; a < 4; a++)
            {
                ty_bsdf b = bsdf_at(m, angles[a]);
                float mean = mean_weight(&b, 200000).g;
                // Under a coat the specular lobe loses a little: only the Lambert base is coupled exactly.
                assert_true(mean < 1.004f);
                assert_near(mean, 1.0, coated ? 0.04 : 0.004);
            }
            ty_material_destroy(m);
        }
}

static void test_varying_roughness_uses_the_same_table(void** state)
{
    (void)state;
    // An attribute that is absent leaves the value alone, but the whole table is built.
    ty_surface_def d = white(1, 0.37f);
    d.specular_roughness.attribute_index = 0;
    ty_shading_context context = {0};
    ty_material* m = surface(&d);
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    for (int a = 0; a < 4; a++)
    {
        ty_bsdf b;
        ty_material_prepare(m, &context, &p, ty_vec3_make((float)sin(angles[a]), 0, (float)cos(angles[a])), &b);
        assert_int_equal(b.specular_row.count, 2);
        assert_near(mean_weight(&b, 200000).g, 1.0, 0.006);
    }
    ty_material_destroy(m);
}

// Fresnel 1823, in angles: another form than the program's.
static double fresnel(double angle, double eta)
{
    if (angle == 0)
        return (eta - 1) * (eta - 1) / (eta + 1) / (eta + 1);
    double s = sin(angle) / eta, t = asin(s);
    double rs = sin(angle - t) / sin(angle + t), rp = tan(angle - t) / tan(angle + t);
    return 0.5 * (rs * rs + rp * rp);
}

static void test_smooth_glass_is_fresnel(void** state)
{
    (void)state;
    static const double degrees[] = {0, 30, 45, 56.3, 75};
    ty_surface_def d = glass(0);
    ty_material* m = surface(&d);
    for (int i = 0; i < 5; i++)
    {
        double angle = degrees[i] * M_PI / 180, reflected = 0, transmitted = 0;
        ty_bsdf b = bsdf_at(m, angle);
        assert_true(ty_bsdf_is_delta(&b));
        for (int k = 0; k < 2000; k++)
        {
            ty_bsdf_sample s;
            assert_true(ty_bsdf_sample_wi(&b, ((float)k + 0.5f) / 2000, (ty_vec2){0.5f, 0.5f}, &s));
            assert_true(s.delta && s.pdf == 0.0f);
            assert_near(s.weight.g, 1.0, 1e-4);
            *(s.transmitted ? &transmitted : &reflected) += (double)s.weight.g / 2000;
            double snell = s.transmitted ? sin(angle) / 1.5 : sin(angle);
            assert_near(s.wi.x, -snell, 1e-5);
            assert_true(s.transmitted == (s.wi.z < 0));
        }
        assert_near(reflected, fresnel(angle, 1.5), 6e-4);
        assert_near(reflected + transmitted, 1.0, 1e-4);
    }
    // From within beyond the critical angle everything comes back.
    ty_bsdf b = bsdf_at(m, M_PI - 0.8);
    ty_bsdf_sample s;
    assert_true(ty_bsdf_sample_wi(&b, 0.999f, (ty_vec2){0.5f, 0.5f}, &s));
    assert_true(!s.transmitted && s.wi.z < 0);
    assert_near(s.weight.g, 1.0, 1e-6);
    ty_material_destroy(m);
}

static void test_within_partly_clear_bodies(void** state)
{
    (void)state;
    // A weak specular does not let light out where it is totally reflected.
    ty_surface_def d = glass(0);
    d.specular_weight = ty_input_scalar(0.3f);
    ty_material* m = surface(&d);
    ty_bsdf b = bsdf_at(m, M_PI - 0.9);
    assert_near(mean_weight(&b, 1000).g, 1.0, 1e-4);
    ty_material_destroy(m);
    // Half clear, half white: nothing is created on either side.
    for (int smooth = 0; smooth < 2; smooth++)
    {
        d = white(1, smooth ? 0.0f : 0.3f);
        d.transmission_weight = ty_input_scalar(0.5f);
        m = surface(&d);
        for (int a = 0; a < 4; a++)
        {
            b = bsdf_at(m, M_PI - angles[a]);
            assert_in_range((long)(1e4f * mean_weight(&b, 100000).g), 9000, 10040);
            b = bsdf_at(m, angles[a]);
            assert_in_range((long)(1e4f * mean_weight(&b, 100000).g), 9500, 10040);
        }
        ty_material_destroy(m);
    }
}

// Single scattering alone would lose up to 70 % (a metal of roughness 1 at normal incidence).
static void test_rough_lobes_keep_all_energy(void** state)
{
    (void)state;
    static const float roughness[] = {0.1f, 0.3f, 0.5f, 0.8f, 1.0f}, ior[] = {1.33f, 1.5f, 2.4f};
    static const double seen[] = {0.05, 0.5, 1.0, 1.3, 1.5};
    double worst = 0;
    for (int i = 0; i < 5 * 4; i++)
    {
        ty_surface_def d = i % 4 ? glass(roughness[i / 4]) : metal(roughness[i / 4]);
        d.base_color = ty_input_scalar(1);
        if (i % 4)
            d.specular_ior = ty_input_scalar(ior[i % 4 - 1]);
        ty_material* m = surface(&d);
        for (int a = 0; a < 10; a++)
        {
            if (a % 2 && i % 4 == 0) // a metal has no inside
                continue;
            ty_bsdf b = bsdf_at(m, a % 2 ? M_PI - seen[a / 2] : seen[a / 2]);
            double e = (double)mean_weight(&b, 100000).g;
            worst = fmax(worst, fabs(e - 1));
            assert_near(e, 1.0, 0.003);
        }
        ty_material_destroy(m);
    }
    print_message("rough metal and glass: at most %.4f from 1\n", worst);
}

// Light that meets several facets takes their colour as often.
static void test_rough_metal_is_more_saturated(void** state)
{
    (void)state;
    float before = 0.0f;
    for (int i = 0; i < 5; i++)
    {
        ty_surface_def d = metal(0.1f + 0.225f * (float)i);
        ty_material* m = surface(&d);
        ty_bsdf b = bsdf_at(m, 0.5);
        ty_rgb e = mean_weight(&b, 200000);
        float saturation = e.r / e.b;
        print_message("roughness %.2f: %.3f %.3f %.3f\n", 0.1 + 0.225 * i, (double)e.r, (double)e.g, (double)e.b);
        assert_true(saturation > before);
        assert_true(e.r < 0.91f && e.r > 0.75f);
        before = saturation;
        ty_material_destroy(m);
    }
}

// A roughness from a texture or attribute is interpolated between tables.
static void test_varying_rough_lobes_keep_energy(void** state)
{
    (void)state;
    ty_shading_context context = {0};
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    for (int i = 0; i < 10; i++)
    {
        float roughness = 0.07f + 0.1f * (float)(i / 2);
        ty_surface_def d = i % 2 ? glass(roughness) : metal(roughness);
        d.base_color = ty_input_scalar(1);
        d.specular_roughness.attribute_index = 0;
        ty_material* m = surface(&d);
        for (int a = 0; a < 4; a++)
        {
            ty_bsdf b;
            ty_material_prepare(m, &context, &p, ty_vec3_make((float)sin(angles[a]), 0, (float)cos(angles[a])), &b);
            assert_near(mean_weight(&b, 100000).g, 1.0, 0.006);
        }
        ty_material_destroy(m);
    }
}

// Power that goes from one direction to the other is the same both ways, across the boundary and a coat too.
static void test_transmission_is_reciprocal(void** state)
{
    (void)state;
    ty_surface_def d = glass(0.6f);
    d.coat_weight = ty_input_scalar(0.7f);
    d.coat_roughness = ty_input_scalar(0.3f);
    check_reciprocal(&d, true, 1.5f);
}

// From within, what the coat keeps in is reflected.
static void test_coated_glass_keeps_energy(void** state)
{
    (void)state;
    ty_surface_def d = glass(0);
    d.coat_weight = ty_input_scalar(1);
    ty_material* m = surface(&d);
    for (int a = 0; a < 8; a++)
    {
        ty_bsdf b = bsdf_at(m, a % 2 ? M_PI - angles[a / 2] : angles[a / 2]);
        assert_near(mean_weight(&b, 100000).g, 1.0, 1e-3);
    }
    ty_material_destroy(m);
}

static void test_reflection_is_reciprocal(void** state)
{
    (void)state;
    ty_surface_def d = white(1, 0.4f);
    d.base_metalness = ty_input_scalar(0.4f);
    d.base_color = ty_input_make(ty_rgb_make(0.9f, 0.5f, 0.2f));
    d.coat_weight = ty_input_scalar(0.7f);
    d.coat_roughness = ty_input_scalar(0.3f);
    ty_material* m = surface(&d);
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    ty_rng rng = ty_rng_make((ty_seed){9}, 0, 0);
    for (int i = 0; i < 2000; i++)
    {
        ty_vec3 w[2];
        ty_bsdf b[2];
        float pdf;
        for (int k = 0; k < 2; k++)
        {
            float ux = ty_rng_float(&rng);
            w[k] = ty_sample_cosine((ty_vec2){ux, ty_rng_float(&rng)});
            w[k].z = ty_max(w[k].z, 0.05f);
            w[k] = ty_normalize(w[k]);
            ty_material_prepare(m, NULL, &p, w[k], &b[k]);
        }
        ty_rgb f01 = ty_bsdf_eval(&b[0], w[1], &pdf), f10 = ty_bsdf_eval(&b[1], w[0], &pdf);
        assert_near(f01.r / w[1].z, (double)(f10.r / w[0].z), 1e-3 * (double)(f10.r / w[0].z) + 1e-5);
        assert_near(f01.b / w[1].z, (double)(f10.b / w[0].z), 1e-3 * (double)(f10.b / w[0].z) + 1e-5);
    }
    ty_material_destroy(m);
}

static void test_back_of_opaque_is_front(void** state)
{
    (void)state;
    ty_surface_def d = white(1, 0.4f);
    ty_material* m = surface(&d);
    ty_bsdf front = bsdf_at(m, 0.5), back = bsdf_at(m, M_PI - 0.5);
    float pf, pb;
    ty_rgb f = ty_bsdf_eval(&front, ty_vec3_make(-0.6f, 0, 0.8f), &pf);
    ty_rgb g = ty_bsdf_eval(&back, ty_vec3_make(-0.6f, 0, -0.8f), &pb);
    assert_near(f.g, (double)g.g, 1e-6);
    assert_near(pf, (double)pb, 1e-6);
    assert_true(front.entering && !back.entering);
    ty_material_destroy(m);
}

static void test_emission_absorption_albedo(void** state)
{
    (void)state;
    ty_surface_def d = white(0, 0.3f);
    d.emission_luminance = ty_input_scalar(3);
    d.emission_color = ty_input_make(ty_rgb_make(1, 0.5f, 0));
    ty_material* m = surface(&d);
    assert_true(ty_material_is_emissive(m));
    ty_bsdf front = bsdf_at(m, 0.3), back = bsdf_at(m, M_PI - 0.3);
    assert_near(front.emission.g, 1.5, 1e-6);
    assert_true(ty_rgb_is_black(back.emission));
    assert_near(ty_bsdf_albedo(&front).g, 1.0, 1e-6);
    ty_material_destroy(m);

    d = glass(0);
    d.transmission_color = ty_input_make(ty_rgb_make(1, 0.5f, 0.25f));
    d.transmission_depth = 0.01f;
    m = surface(&d);
    assert_false(ty_material_is_emissive(m));
    ty_bsdf b = bsdf_at(m, 0.3);
    ty_medium medium = ty_medium_make(m, NULL, &b.point);
    assert_near(medium.ior, 1.5, 0);
    assert_near(medium.matter.extinction.r, 0.0, 1e-5);
    assert_near(medium.matter.extinction.g, log(2) / 0.01, 1e-3);
    assert_near(medium.matter.extinction.b, log(4) / 0.01, 1e-3);
    ty_material_destroy(m);
    d.transmission_depth = 0;
    m = surface(&d);
    b = bsdf_at(m, 0.0);
    assert_near(ty_medium_make(m, NULL, &b.point).matter.extinction.g, 0.0, 0.0);
    assert_near(mean_weight(&b, 4000).g, 0.04 + 0.96 * 0.5, 1e-3);
    ty_material_destroy(m);
}

static void test_bad_definitions(void** state)
{
    (void)state;
    ty_surface_def d = ty_surface_def_default();
    ty_material* m;
    ty_error error;
    d.coat_ior = 0.5f;
    assert_int_equal(ty_material_create_surface(&d, &m, &error), TY_BAD_INPUT);
    assert_null(m);
    assert_non_null(strstr(error.text, "coat_ior"));
    d = ty_surface_def_default();
    d.specular_ior = ty_input_scalar(9);
    assert_int_equal(ty_material_create_surface(&d, &m, &error), TY_BAD_INPUT);
    d = ty_surface_def_default();
    d.transmission_depth = NAN;
    assert_int_equal(ty_material_create_surface(&d, &m, &error), TY_BAD_INPUT);
    ty_cdrf_def c = ty_cdrf_def_default();
    c.kernel = TY_CDRF_GAUSSIAN;
    assert_int_equal(ty_material_create_cdrf(&c, &m, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "poisson"));
}

// The lean surface against the layered one whose layers reflect next to nothing.
static void check_matte(const ty_bsdf* matte, const ty_bsdf* layered, ty_rng* rng)
{
    float u = ty_rng_float(rng), ux = ty_rng_float(rng), uy = ty_rng_float(rng), pdf, expected_pdf;
    ty_vec3 wi = ty_sample_sphere((ty_vec2){ux, uy});
    ty_rgb f = ty_bsdf_eval(matte, wi, &pdf), expected = ty_bsdf_eval(layered, wi, &expected_pdf);
    assert_near(f.r, expected.r, 1e-6);
    assert_near(f.b, expected.b, 1e-6);
    assert_near(pdf, expected_pdf, 1e-6);
    ty_bsdf_parts parts = ty_bsdf_eval_parts(matte, wi);
    assert_true(parts.f[0].r == f.r && parts.pdf[0] == pdf);
    assert_true(parts.pdf[1] + parts.pdf[2] == 0.0f && ty_rgb_is_black(ty_rgb_add(parts.f[1], parts.f[2])));
    ty_bsdf_sample s, t;
    bool lit = ty_bsdf_sample_wi(matte, u, (ty_vec2){ux, uy}, &s);
    assert_int_equal(lit, ty_bsdf_sample_wi(layered, u, (ty_vec2){ux, uy}, &t));
    if (!lit)
        return;
    assert_near(ty_length(ty_sub(s.wi, t.wi)), 0, 1e-6);
    assert_near(ty_length(s.wi), 1, 1e-6);
    assert_near(s.pdf, t.pdf, 1e-6);
    assert_near(s.weight.r, t.weight.r, 1e-6);
    assert_near(s.weight.b, t.weight.b, 1e-6);
    assert_true(s.kind == t.kind && s.delta == t.delta && s.transmitted == t.transmitted);
}

static void test_matte_is_the_layered_surface(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make((ty_seed){5}, 0, 0);
    ty_surface_def d = white(0, 0.3f);
    d.base_color = ty_input_make(ty_rgb_make(0.8f, 0.5f, 1.2f)); // clamped to 1
    d.emission_luminance = ty_input_scalar(2);
    ty_material* matte = surface(&d);
    d.specular_weight = ty_input_scalar(1e-20f);
    ty_material* layered = surface(&d);
    for (int i = 0; i < 2000; i++)
    {
        ty_vec3 ng = ty_sample_sphere((ty_vec2){ty_rng_float(&rng), ty_rng_float(&rng)});
        ty_vec3 wo = ty_sample_sphere((ty_vec2){ty_rng_float(&rng), ty_rng_float(&rng)});
        ty_surface_point p = {.ng = ng, .ns = ty_normalize(ty_mad(ng, wo, -0.4f))};
        ty_bsdf a, b;
        memset(&a, 0xff, sizeof a); // nothing that preparation leaves out is read
        a.point = b.point = p;
        ty_material_prepare(matte, NULL, &a.point, wo, &a);
        ty_material_prepare(layered, NULL, &b.point, wo, &b);
        assert_int_equal(a.kind, TY_BSDF_MATTE);
        assert_int_equal(b.kind, TY_BSDF_SURFACE);
        assert_memory_equal(&a.point, &p, sizeof p);
        assert_memory_equal(&b.point, &p, sizeof p);
        assert_true(a.entering == b.entering && a.bent == b.bent && a.emission.r == b.emission.r);
        assert_near(ty_bsdf_albedo(&a).g, ty_bsdf_albedo(&b).g, 1e-6);
        assert_true(!ty_bsdf_is_delta(&a) && !ty_bsdf_is_delta(&b));
        check_matte(&a, &b, &rng);
    }
    ty_material_destroy(matte);
    ty_material_destroy(layered);
}

// Every other layer makes a surface more than Lambert; and a base colour that varies does
// so on lean ones too.
static void test_what_is_matte(void** state)
{
    (void)state;
    ty_surface_def defs[10];
    for (int i = 0; i < 10; i++)
        defs[i] = white(0, 0.3f);
    defs[0].base_color.attribute_index = 0;
    defs[1].emission_luminance = ty_input_scalar(1);
    defs[2].opacity = ty_input_scalar(0.5f);
    defs[3].base_metalness = ty_input_scalar(0.5f);
    defs[4].transmission_weight = ty_input_scalar(0.5f);
    defs[5].coat_weight = ty_input_scalar(0.5f);
    defs[6].specular_weight = ty_input_scalar(0.5f);
    defs[7].thin_walled = true;
    defs[8].fuzz_weight = ty_input_scalar(0.5f);
    defs[9].base_diffuse_roughness = ty_input_scalar(0.5f);
    static const float tint[2] = {0.25f, 0.5f};
    const float* of_object[] = {tint};
    const float* const* objects[] = {of_object};
    const ty_shading_context context = {.object_attributes = objects};
    for (int i = 0; i < 10; i++)
        for (uint32_t k = 0; k < 2; k++)
        {
            ty_material* m = surface(&defs[i]);
            ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}, .instance = k};
            ty_bsdf b;
            ty_material_prepare(m, &context, &p, ty_vec3_make(0, 0, 1), &b);
            assert_int_equal(b.kind, i < 3 ? TY_BSDF_MATTE : TY_BSDF_SURFACE);
            assert_true(b.color.r == (i == 0 ? tint[k] : 1.0f));
            ty_material_destroy(m);
        }
}

static void test_black_scatters_nothing(void** state)
{
    (void)state;
    ty_surface_def d = white(0, 0);
    d.base_color = ty_input_scalar(0);
    ty_material* black = surface(&d);
    ty_bsdf b = bsdf_at(black, 0.5);
    ty_bsdf_sample s;
    float pdf;
    assert_true(ty_rgb_is_black(ty_bsdf_eval(&b, b.frame.n, &pdf)));
    assert_true(ty_bsdf_is_delta(&b)); // no light is sampled for it
    assert_false(ty_bsdf_sample_wi(&b, 0.5f, (ty_vec2){0.5f, 0.25f}, &s));
    ty_material_destroy(black);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_metal_sampling),
        cmocka_unit_test(test_plastic_and_coat_sampling),
        cmocka_unit_test(test_rough_transmission_sampling),
        cmocka_unit_test(test_lambert_furnace_is_exact),
        cmocka_unit_test(test_matte_is_the_layered_surface),
        cmocka_unit_test(test_what_is_matte),
        cmocka_unit_test(test_black_scatters_nothing),
        cmocka_unit_test(test_white_under_specular_keeps_energy),
        cmocka_unit_test(test_varying_roughness_uses_the_same_table),
        cmocka_unit_test(test_smooth_glass_is_fresnel),
        cmocka_unit_test(test_within_partly_clear_bodies),
        cmocka_unit_test(test_rough_lobes_keep_all_energy),
        cmocka_unit_test(test_rough_metal_is_more_saturated),
        cmocka_unit_test(test_varying_rough_lobes_keep_energy),
        cmocka_unit_test(test_transmission_is_reciprocal),
        cmocka_unit_test(test_coated_glass_keeps_energy),
        cmocka_unit_test(test_reflection_is_reciprocal),
        cmocka_unit_test(test_back_of_opaque_is_front),
        cmocka_unit_test(test_emission_absorption_albedo),
        cmocka_unit_test(test_bad_definitions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
