// SPDX-License-Identifier: Apache-2.0
// `surface`: rough diffuse, fuzz and coat over every base: sampling, energy, reciprocity, colour.
#define INNER 32 // densities end within cells, at the horizon
#include "spherical.h"
#include "surface_stack.h"
#include <tsuya/shading/sampling.h>

static const double angles[] = {0.05, 0.7, 1.2, 1.45};
static const float roughnesses[] = {0.1f, 0.3f, 0.5f, 0.8f, 1.0f};

static void check_at_angles(const ty_surface_def* def)
{
    ty_material* m = surface(def);
    for (int i = 0; i < 4; i++)
    {
        ty_bsdf b = bsdf_at(m, angles[i]);
        check_sampling(&b, ty_vec3_make(-(float)sin(angles[i]), 0, (float)cos(angles[i])), 100000);
    }
    ty_material_destroy(m);
}

static void test_sampling(void** state)
{
    (void)state;
    ty_surface_def d = stack(STACK_FUZZ, 0.3f);
    d.base_color = ty_input_scalar(0);
    check_at_angles(&d); // fuzz alone
    d = stack(STACK_CLAY, 1.0f);
    d.base_color = ty_input_make(ty_rgb_make(0.8f, 0.3f, 0.1f));
    check_at_angles(&d);
    d = stack(STACK_FUZZ_COAT_METAL, 0.4f);
    d.base_metalness = ty_input_scalar(0.5f);
    d.base_diffuse_roughness = ty_input_scalar(0.7f);
    d.coat_color = ty_input_make(ty_rgb_make(0.9f, 0.5f, 0.2f));
    d.fuzz_color = ty_input_make(ty_rgb_make(0.2f, 0.5f, 0.9f));
    check_at_angles(&d);
}

// Mean weight over lobes in proportion and, in each, a lattice of directions: much closer than by chance.
static double lattice_weight(const ty_bsdf* b, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
    {
        double v = i * 0.7548776662466927, w = i * 0.5698402909980532; // Roberts' R2 sequence
        ty_bsdf_sample s;
        float lobe = ((float)i + 0.5f) / (float)n;
        if (ty_bsdf_sample_wi(b, lobe, (ty_vec2){(float)(v - floor(v)), (float)(w - floor(w))}, &s))
            sum += (double)s.weight.g;
    }
    return sum / n;
}

// Of white matter all light returns, whatever lies over it.
static void test_furnace(void** state)
{
    (void)state;
    for (int kind = 0; kind < STACK_COUNT; kind++)
    {
        double least = 2, most = 0;
        for (int r = 0; r < 5; r++)
        {
            ty_surface_def d = stack(kind, roughnesses[r]);
            ty_material* m = surface(&d);
            for (int a = 0; a < 4; a++)
            {
                ty_bsdf b = bsdf_at(m, angles[a]);
                double e = lattice_weight(&b, 50000);
                least = fmin(least, e);
                most = fmax(most, e);
            }
            ty_material_destroy(m);
        }
        print_message("%-20s %.4f .. %.4f\n", stack_names[kind], least, most);
        assert_true(least > 0.9965 && most < 1.0037);
    }
}

// Inputs that vary go through tables of several slices.
static void test_furnace_of_varying_inputs(void** state)
{
    (void)state;
    ty_shading_context context = {0};
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    for (int kind = STACK_FUZZ; kind < STACK_COUNT; kind++)
    {
        ty_surface_def d = stack(kind, 0.43f);
        // An attribute that is absent leaves the value alone.
        d.specular_roughness.attribute_index = d.coat_roughness.attribute_index = d.coat_weight.attribute_index =
            d.fuzz_roughness.attribute_index = d.fuzz_weight.attribute_index = 0;
        ty_material* m = surface(&d);
        for (int a = 0; a < 4; a++)
        {
            ty_bsdf b;
            ty_material_prepare(m, &context, &p, ty_vec3_make((float)sin(angles[a]), 0, (float)cos(angles[a])), &b);
            double e = lattice_weight(&b, 30000);
            assert_near(e, 1.0, 0.007);
        }
        ty_material_destroy(m);
    }
}

// Of fuzz alone over black: a quadrature of the published formulas in double precision, apart from the program.
static void test_fuzz_albedo(void** state)
{
    (void)state;
    static const double mu[4] = {0.1, 0.3, 0.6, 1.0}, expected[4] = {0.655, 0.419, 0.230, 0.088};
    ty_surface_def d = stack(STACK_FUZZ, 0.5f);
    d.base_color = ty_input_scalar(0);
    ty_material* m = surface(&d);
    for (int i = 0; i < 4; i++)
    {
        ty_bsdf b = bsdf_at(m, acos(mu[i]));
        assert_near(lattice_weight(&b, 50000), expected[i], 0.002);
    }
    ty_material_destroy(m);
}

// Of nearly black clay light is met once: A (1 + r s / t) / pi with A = 1 / (1 + r (1/2 - 2 / (3 pi))), s the cosine
// between the directions less the product of their own, t the larger of these where s > 0 (Fujii's Oren-Nayar).
static void test_rough_diffuse(void** state)
{
    (void)state;
    static const double pairs[5][3] = {{0, 0, 0}, {0, 1, 0}, {0.9, 0.9, 0}, {0.9, 0.5, M_PI}, {1.2, 0.8, 1}};
    for (int k = 0; k < 2; k++)
    {
        double r = k ? 0.4 : 1.0;
        ty_surface_def d = stack(STACK_CLAY, (float)r);
        d.base_diffuse_roughness = ty_input_scalar((float)r);
        d.base_color = ty_input_scalar(1e-4f);
        ty_material* m = surface(&d);
        for (int i = 0; i < 5; i++)
        {
            double o = pairs[i][0], a = pairs[i][1], turn = pairs[i][2], s = sin(o) * sin(a) * cos(turn);
            double t = s > 0 ? fmax(cos(o), cos(a)) : 1, A = 1 / (1 + r * (0.5 - 2 / (3 * M_PI)));
            ty_bsdf b = bsdf_at(m, o);
            float pdf;
            ty_vec3 wi = {(float)(sin(a) * cos(turn)), (float)(sin(a) * sin(turn)), (float)cos(a)};
            double f = (double)ty_bsdf_eval(&b, wi, &pdf).g * M_PI / 1e-4 / cos(a);
            assert_near(f, A * (1 + r * s / t), 2e-3);
        }
        ty_material_destroy(m);
    }
}

// Coloured, so that nothing hides behind white.
static ty_surface_def coloured(void)
{
    ty_surface_def d = stack(STACK_ALL, 0.4f);
    d.base_color = ty_input_make(ty_rgb_make(0.9f, 0.5f, 0.2f));
    d.base_weight = ty_input_scalar(0.8f);
    d.specular_color = ty_input_make(ty_rgb_make(0.7f, 0.9f, 1.0f));
    d.specular_weight = ty_input_scalar(0.7f);
    d.coat_color = ty_input_make(ty_rgb_make(0.6f, 0.8f, 0.9f));
    d.fuzz_color = ty_input_make(ty_rgb_make(0.3f, 0.8f, 0.5f));
    return d;
}

static void test_reciprocity(void** state)
{
    (void)state;
    ty_surface_def d = coloured();
    check_reciprocal(&d, false, 1);
    d.base_metalness = ty_input_scalar(0);
    d.transmission_weight = ty_input_scalar(1);
    check_reciprocal(&d, true, 1.5f);
}

// The reflection of a smooth metal straight on is its base colour, and at 82 degrees Schlick's times specular_color.
static void test_metal_edge(void** state)
{
    (void)state;
    ty_surface_def d = stack(STACK_METAL, 0.0f);
    d.base_color = ty_input_make(ty_rgb_make(0.9f, 0.5f, 0.2f));
    d.base_weight = ty_input_scalar(0.5f);
    d.specular_color = ty_input_make(ty_rgb_make(0.4f, 1.0f, 0.7f));
    ty_material* m = surface(&d);
    for (int i = 0; i < 2; i++)
    {
        double cosine = i ? 1.0 / 7.0 : 1.0, schlick = i ? pow(6.0 / 7.0, 5) : 0.0;
        ty_bsdf b = bsdf_at(m, acos(cosine));
        ty_rgb e = mean_weight(&b, 10);
        assert_near(e.r, (0.45 + 0.55 * schlick) * (i ? 0.4 : 1), 1e-4);
        assert_near(e.g, 0.25 + 0.75 * schlick, 1e-4);
        assert_near(e.b, (0.1 + 0.9 * schlick) * (i ? 0.7 : 1), 1e-4);
    }
    ty_material_destroy(m);
}

// A weight of w gives w times the reflectance at normal incidence, of any index; grazing light is reflected all the
// same, and what lies within is bent as before.
static void test_specular_weight(void** state)
{
    (void)state;
    for (int i = 0; i < 3; i++)
    {
        float ior = 1.3f + 0.5f * (float)i;
        ty_surface_def d = stack(STACK_GLASS, 0.0f);
        d.specular_ior = ty_input_scalar(ior);
        d.specular_weight = ty_input_scalar(0.3f);
        d.transmission_color = ty_input_scalar(0);
        ty_material* m = surface(&d);
        double f0 = pow((double)((ior - 1) / (ior + 1)), 2);
        ty_bsdf b = bsdf_at(m, 0.0);
        assert_near(mean_weight(&b, 100).g, 0.3 * f0, 1e-4);
        b = bsdf_at(m, 1.5705);
        assert_true(mean_weight(&b, 100).g > 0.98f);
        ty_material_destroy(m);
    }
}

// Straight through the coat and back its colour once, along a slope more; what it sends back meets the base again.
static void test_coat_colour_and_darkening(void** state)
{
    (void)state;
    ty_surface_def d = stack(STACK_COAT_LAMBERT, 0.0f);
    d.coat_color = ty_input_make(ty_rgb_make(0.25f, 1.0f, 1.0f));
    ty_material* m = surface(&d);
    ty_bsdf b = bsdf_at(m, 0.0);
    float pdf;
    ty_rgb f = ty_bsdf_eval(&b, ty_vec3_make(0, 0, 1), &pdf);
    ty_rgb g = ty_bsdf_eval(&b, ty_normalize(ty_vec3_make(0.8f, 0, 0.6f)), &pdf);
    double within = sqrt(1 - 0.64 / 2.56); // index 1.6
    ty_material_destroy(m);
    d.coat_color = ty_input_scalar(1);
    m = surface(&d);
    b = bsdf_at(m, 0.0);
    ty_rgb f1 = ty_bsdf_eval(&b, ty_vec3_make(0, 0, 1), &pdf);
    ty_rgb g1 = ty_bsdf_eval(&b, ty_normalize(ty_vec3_make(0.8f, 0, 0.6f)), &pdf);
    double coat = (double)(f1.r - f.r) / 0.75; // of the base; the rest is the coat's own
    assert_near(f.g, (double)f1.g, 1e-6);
    assert_true(coat > 0.2);
    assert_near(g1.r - g.r, (double)g1.g * (1 - pow(0.25, 0.5 + 0.5 / within)), 0.02);
    ty_material_destroy(m);

    d.base_color = ty_input_scalar(0.5f);
    double albedo[2];
    for (int i = 0; i < 2; i++)
    {
        d.coat_darkening = ty_input_scalar((float)i);
        m = surface(&d);
        b = bsdf_at(m, 0.3);
        ty_rgb parts = ty_bsdf_eval_parts(&b, ty_vec3_make(0, 0, 1)).f[0];
        albedo[i] = (double)parts.g;
        ty_material_destroy(m);
    }
    // Diffuse light from within the index 1.6 is sent back by 1 - (1 - .108) / 1.6^2 = .652.
    assert_near(albedo[1] / albedo[0], (1 - 0.652) / (1 - 0.5 * 0.652), 0.005);
}

static void brush_coat(ty_surface_def* d, float turn)
{
    d->coat_roughness = ty_input_scalar(0.6f);
    d->coat_roughness_anisotropy = ty_input_scalar(0.8f);
    d->coat_rotation = ty_input_scalar(turn);
}

// A coat brushed another way than what lies beneath it.
static void test_brushed_coat(void** state)
{
    (void)state;
    ty_surface_def d = stack(STACK_COAT_METAL, 0.5f), even = d;
    d.base_color = even.base_color = ty_input_make(ty_rgb_make(0.9f, 0.5f, 0.2f));
    brush_coat(&d, 0.6f);
    check_at_angles(&d);
    check_reciprocal(&d, false, 1);

    // Turned by a quarter it shows along one axis what it showed along the other; of the base alone nothing turns.
    ty_vec3 aside = ty_normalize(ty_vec3_make(0.5f, 0, 1)), across = ty_normalize(ty_vec3_make(0, 0.5f, 1));
    float shown[3][2], pdf;
    for (int i = 0; i < 3; i++)
    {
        float base = i < 2 ? 0.3f : 0.0f;
        ty_surface_def black = stack(STACK_COAT_LAMBERT, 0);
        black.base_color = ty_input_scalar(0);
        brush_coat(&black, base + (i == 1 ? 0.5f * TY_PI : 0));
        black.specular_rotation = ty_input_scalar(base);
        ty_material* m = surface(&black);
        ty_bsdf b = bsdf_at(m, 0);
        shown[i][0] = ty_bsdf_eval(&b, ty_to_world(b.frame, aside), &pdf).g;
        shown[i][1] = ty_bsdf_eval(&b, ty_to_world(b.frame, across), &pdf).g;
        ty_material_destroy(m);
    }
    assert_true(shown[0][0] > 3 * shown[0][1]);
    assert_near(shown[0][0], (double)shown[1][1], 1e-5);
    assert_near(shown[0][0], (double)shown[2][0], 1e-5);
    assert_near(shown[0][1], (double)shown[1][0], 1e-5);
    d.base_color = even.base_color = ty_input_scalar(1);
    ty_material* m = surface(&d);
    ty_bsdf b = bsdf_at(m, 0.7);
    assert_near(lattice_weight(&b, 50000), 1.0, 0.015); // what is lost is known for even roughness
    ty_material_destroy(m);
}

// Emission lies at the base: a coat's Fresnel and colour, and fuzz, take their parts on the way out.
static void test_emission_beneath(void** state)
{
    (void)state;
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    for (int i = 0; i < 4; i++)
    {
        double c = cos(angles[i]), within = sqrt(1 - (1 - c * c) / (1.6 * 1.6));
        double s = (c - 1.6 * within) / (c + 1.6 * within), q = (1.6 * c - within) / (1.6 * c + within);
        double through = 1 - 0.5 * (s * s + q * q);
        ty_surface_def d = stack(STACK_COAT_LAMBERT, 0);
        d.emission_luminance = ty_input_scalar(5);
        d.coat_roughness = ty_input_scalar(0);
        d.coat_color = ty_input_make(ty_rgb_make(0.25f, 1, 1));
        ty_material* m = surface(&d);
        ty_bsdf b = bsdf_at(m, angles[i]);
        assert_near(b.emission.g, 5 * through, 0.02);
        assert_near(b.emission.r / b.emission.g, pow(0.25, 0.5 / within), 1e-3);
        ty_rgb towards = ty_material_emission_towards(m, NULL, &p, b.wo);
        assert_near(towards.r, (double)b.emission.r, 1e-6);
        assert_near(towards.g, (double)b.emission.g, 1e-6);
        ty_material_destroy(m);

        d = stack(STACK_FUZZ, 0.5f);
        d.base_color = ty_input_scalar(0);
        d.emission_luminance = ty_input_scalar(5);
        m = surface(&d);
        b = bsdf_at(m, angles[i]);
        assert_near(b.emission.g, 5 * (1 - lattice_weight(&b, 50000)), 0.02); // the fuzz is white
        assert_near(ty_material_emission_towards(m, NULL, &p, b.wo).g, (double)b.emission.g, 1e-6);
        ty_material_destroy(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sampling),
        cmocka_unit_test(test_furnace),
        cmocka_unit_test(test_furnace_of_varying_inputs),
        cmocka_unit_test(test_fuzz_albedo),
        cmocka_unit_test(test_rough_diffuse),
        cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_metal_edge),
        cmocka_unit_test(test_specular_weight),
        cmocka_unit_test(test_coat_colour_and_darkening),
        cmocka_unit_test(test_brushed_coat),
        cmocka_unit_test(test_emission_beneath),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
