// SPDX-License-Identifier: Apache-2.0
// Thin films: against sums of waves by wavelength, where they must change nothing, sampling, energy, reciprocity.
#define INNER 32
#include "spherical.h"
#include "surface_stack.h"
#include <complex.h>
#include <tsuya/shading/sampling.h>

static const double angles[] = {0.05, 0.7, 1.2, 1.45};

static void put_film(ty_surface_def* d, float thickness, float ior)
{
    d->thin_film_weight = ty_input_scalar(1);
    d->thin_film_thickness = ty_input_scalar(thickness);
    d->thin_film_ior = ior;
}

static double lobe(double w, double centre, double below, double above)
{
    double t = (w - centre) / (w < centre ? below : above);
    return exp(-0.5 * t * t);
}

// As in the program, in double precision.
static void sensitivity(double w, double out[3])
{
    double x = 1.056 * lobe(w, 599.8, 37.9, 31.0) + 0.362 * lobe(w, 442, 16, 26.7) - 0.065 * lobe(w, 501.1, 20.4, 26.2);
    double y = 0.821 * lobe(w, 568.8, 46.9, 40.5) + 0.286 * lobe(w, 530.9, 16.3, 31.1);
    double z = 1.217 * lobe(w, 437, 11.8, 36) + 0.681 * lobe(w, 459, 26, 13.8);
    out[0] = 1.6410233797 * x - 0.3248032942 * y - 0.2364246952 * z;
    out[1] = -0.6636628587 * x + 1.6153315917 * y + 0.0167563477 * z;
    out[2] = 0.0117218943 * x - 0.0082844420 * y + 0.9883948585 * z;
}

// Reflectance of film over base at one wavelength, by Fresnel's amplitudes and the waves between its sides one by one.
static double waves(double cosine, double film, double base, double thickness, double wavelength)
{
    double sine = sqrt(1 - cosine * cosine),
           c[3] = {cosine, sqrt(1 - pow(sine / film, 2)), sqrt(1 - pow(sine / base, 2))};
    double n[3] = {1, film, base}, sum = 0;
    double complex turn = cexp(2 * I * (2 * M_PI / wavelength) * film * thickness * c[1]);
    for (int polarisation = 0; polarisation < 2; polarisation++)
    {
        double r[2], back, across;
        for (int k = 0; k < 2; k++)
        {
            double x = polarisation ? n[k + 1] * c[k] : n[k] * c[k];
            double y = polarisation ? n[k] * c[k + 1] : n[k + 1] * c[k + 1];
            r[k] = (x - y) / (x + y);
        }
        back = -r[0];
        across = 1 - r[0] * r[0];
        double complex amplitude = r[0], wave = across * r[1] * turn;
        for (int i = 0; i < 400; i++)
        {
            amplitude += wave;
            wave *= back * r[1] * turn;
        }
        sum += 0.5 * creal(amplitude * conj(amplitude));
    }
    return sum;
}

static void mean_waves(double cosine, double film, double base, double thickness, double out[3])
{
    double all[3] = {0}, s[3];
    out[0] = out[1] = out[2] = 0;
    for (int k = 0; k <= 470; k++)
    {
        double r = waves(cosine, film, base, thickness, 1e-3 * (360 + k));
        sensitivity(360 + k, s);
        for (int i = 0; i < 3; i++)
        {
            out[i] += s[i] * r;
            all[i] += s[i];
        }
    }
    for (int i = 0; i < 3; i++)
        out[i] /= all[i];
}

// Of a mirror over black.
static ty_rgb mirror(ty_surface_def d, double cosine)
{
    d.specular_roughness = ty_input_scalar(0);
    d.transmission_color = ty_input_scalar(0);
    if (!(d.base_metalness.value.r > 0))
        d.base_color = ty_input_scalar(0);
    ty_material* m = surface(&d);
    ty_bsdf b = bsdf_at(m, acos(cosine));
    ty_rgb e = mean_weight(&b, 64);
    ty_material_destroy(m);
    return e;
}

static void test_against_waves(void** state)
{
    (void)state;
    static const double cosines[] = {1, 0.8, 0.5, 0.2, 0.05}, films[] = {1.2, 1.4, 2.4}, bases[] = {1.33, 1.5, 2.0};
    static const double thicknesses[] = {0.05, 0.2, 0.5, 1.1, 3.0};
    double worst = 0;
    for (int c = 0; c < 5; c++)
        for (int f = 0; f < 3; f++)
            for (int b = 0; b < 3; b++)
                for (int t = 0; t < 5; t++)
                {
                    ty_surface_def d = stack(STACK_PLASTIC, 0);
                    double expected[3];
                    put_film(&d, (float)thicknesses[t], (float)films[f]);
                    d.specular_ior = ty_input_scalar((float)bases[b]);
                    ty_rgb e = mirror(d, cosines[c]);
                    mean_waves(cosines[c], films[f], bases[b], thicknesses[t], expected);
                    const float got[3] = {e.r, e.g, e.b};
                    for (int i = 0; i < 3; i++)
                    {
                        double difference = fabs((double)got[i] - fmin(fmax(expected[i], 0), 1));
                        worst = fmax(worst, difference);
                        if (difference > 0.002)
                            print_message("cos %g film %g base %g %g um: %g, not %g\n", cosines[c], films[f], bases[b],
                                          thicknesses[t], (double)got[i], expected[i]);
                    }
                }
    print_message("worst %.5f\n", worst);
    assert_true(worst < 0.002);
}

static void assert_same(ty_rgb a, ty_rgb b, double tolerance)
{
    assert_near(a.r, (double)b.r, tolerance);
    assert_near(a.g, (double)b.g, tolerance);
    assert_near(a.b, (double)b.b, tolerance);
}

static ty_surface_def copper(void)
{
    ty_surface_def d = stack(STACK_METAL, 0);
    d.base_color = ty_input_make(ty_rgb_make(0.9f, 0.55f, 0.35f));
    d.specular_color = ty_input_make(ty_rgb_make(0.8f, 0.9f, 1.0f));
    return d;
}

// Of no thickness, of no weight, or of the index of what is outside; of the base's index it is the base's.
static void test_where_it_changes_nothing(void** state)
{
    (void)state;
    for (int metal = 0; metal < 2; metal++)
        for (int i = 0; i < 4; i++)
        {
            double cosine = cos(angles[i]);
            ty_surface_def d = metal ? copper() : stack(STACK_PLASTIC, 0), none = d;
            ty_rgb bare = mirror(none, cosine);
            put_film(&d, 0, 1.7f);
            assert_same(mirror(d, cosine), bare, 1e-6);
            put_film(&d, 1e-5f, 1.7f);
            assert_same(mirror(d, cosine), bare, 2e-3);
            put_film(&d, 0.4f, 1.0f);
            assert_same(mirror(d, cosine), bare, 1e-5);
            put_film(&d, 0.4f, 1.7f);
            assert_true(fabsf(mirror(d, cosine).b - bare.b) > 1e-3f);
            d.thin_film_weight = ty_input_scalar(0);
            assert_same(mirror(d, cosine), bare, 1e-6);
            put_film(&d, 0.4f, 1.5f);
            if (!metal)
                assert_same(mirror(d, cosine), bare, 1e-5);
        }
}

// A thick film is two boundaries: what each lets through, back and forth, whatever the phase.
static void test_thick_film(void** state)
{
    (void)state;
    for (int i = 0; i < 4; i++)
    {
        ty_surface_def d = stack(STACK_PLASTIC, 0);
        double c = cos(angles[i]), within = sqrt(1 - (1 - c * c) / (1.3 * 1.3)), sum = 0;
        d.specular_ior = ty_input_scalar(2);
        put_film(&d, 200, 1.3f);
        for (int p = 0; p < 2; p++)
        {
            double last = sqrt(1 - (1 - c * c) / 4);
            double r1 = p ? (1.3 * c - within) / (1.3 * c + within) : (c - 1.3 * within) / (c + 1.3 * within);
            double r2 = p ? (2 * within - 1.3 * last) / (2 * within + 1.3 * last)
                          : (1.3 * within - 2 * last) / (1.3 * within + 2 * last);
            double a = r1 * r1, b = r2 * r2;
            sum += 0.5 * (a + (1 - a) * (1 - a) * b / (1 - a * b));
        }
        ty_rgb e = mirror(d, c);
        assert_same(e, ty_rgb_grey((float)sum), 1e-4);
    }
}

// A lossless reflection of colour c straight on, half a wave turned, and a film on it.
static void test_metal_straight_on(void** state)
{
    (void)state;
    ty_surface_def d = copper();
    put_film(&d, 0.12f, 2.4f);
    ty_rgb e = mirror(d, 1);
    const double f0[3] = {0.9, 0.55, 0.35};
    const float got[3] = {e.r, e.g, e.b};
    for (int i = 0; i < 3; i++)
    {
        double sum = 0, all = 0, s[3], r1 = (1 - 2.4) / 3.4, z = -sqrt(f0[i]), r2 = (z - r1) / (1 - r1 * z);
        for (int k = 0; k <= 470; k++)
        {
            double complex turn = r2 * cexp(4 * I * M_PI * 2.4 * 0.12 / (1e-3 * (360 + k)));
            double amplitude = cabs((r1 + turn) / (1 + r1 * turn));
            sensitivity(360 + k, s);
            sum += s[i] * amplitude * amplitude;
            all += s[i];
        }
        assert_near(got[i], sum / all, 0.002);
    }
}

static ty_rgb lattice_color(const ty_bsdf* b, int n)
{
    double sum[3] = {0};
    for (int i = 0; i < n; i++)
    {
        double v = i * 0.7548776662466927, w = i * 0.5698402909980532; // Roberts' R2 sequence
        ty_bsdf_sample s;
        if (!ty_bsdf_sample_wi(b, ((float)i + 0.5f) / (float)n, (ty_vec2){(float)(v - floor(v)), (float)(w - floor(w))},
                               &s))
            continue;
        sum[0] += (double)s.weight.r;
        sum[1] += (double)s.weight.g;
        sum[2] += (double)s.weight.b;
    }
    return ty_rgb_make((float)(sum[0] / n), (float)(sum[1] / n), (float)(sum[2] / n));
}

// A film absorbs nothing: of white matter all light returns, in every channel.
static void test_furnace(void** state)
{
    (void)state;
    static const float roughnesses[] = {0.0f, 0.1f, 0.3f, 0.6f, 1.0f};
    // Fuzz and coat keep what they do on average; rough diffuse prefers directions by its mean colour.
    static const double allowed[STACK_COUNT] = {
        [STACK_CLAY] = 0.009,
        [STACK_FUZZ] = 0.006,
        [STACK_FUZZ_CLAY] = 0.007,
        [STACK_COAT_LAMBERT] = 0.005,
        [STACK_FUZZ_COAT_METAL] = 0.013,
        [STACK_FUZZ_COAT_PLASTIC] = 0.007,
        [STACK_COAT_GLASS] = 0.04,
        [STACK_FUZZ_COAT_GLASS] = 0.02,
        [STACK_ALL] = 0.005,
        [STACK_FUZZ_GLASS] = 0.005,
        [STACK_ROUGH_PLASTIC] = 0.004,
        [STACK_GLASS] = 0.004,
    };
    for (int kind = 0; kind < STACK_COUNT; kind++)
        for (int sheet = 0; sheet < 2; sheet++)
        {
            double least = 2, most = 0;
            // What a film changes in the losses of a rough clear boundary is not made up for.
            int count = !sheet && (stack_has(kind, "glass") || kind == STACK_ALL) ? 3 : 5;
            for (int r = 0; r < count; r++)
            {
                ty_surface_def d = stack(kind, roughnesses[r]);
                put_film(&d, 0.3f, 1.8f);
                d.thin_walled = sheet;
                ty_material* m = surface(&d);
                for (int a = 0; a < 4; a++)
                {
                    ty_bsdf b = bsdf_at(m, angles[a]);
                    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
                    ty_rgb e = lattice_color(&b, 12000);
                    e = ty_rgb_add(e, ty_material_transparency(m, NULL, &p, b.wo).through);
                    least = fmin(least, (double)ty_min(e.r, ty_min(e.g, e.b)));
                    most = fmax(most, (double)ty_max(e.r, ty_max(e.g, e.b)));
                }
                ty_material_destroy(m);
            }
            print_message("%-20s %s %.4f .. %.4f\n", stack_names[kind], sheet ? "sheet" : "body ", least, most);
            assert_true(fmax(1 - least, most - 1) < fmax(allowed[kind], 0.003));
        }
}

static ty_surface_def filmed(stack_kind kind, float roughness)
{
    ty_surface_def d = stack(kind, roughness);
    d.base_color = ty_input_make(ty_rgb_make(0.9f, 0.5f, 0.2f));
    put_film(&d, 0.35f, 1.7f);
    d.thin_film_weight = ty_input_scalar(0.8f);
    return d;
}

static void test_sampling(void** state)
{
    (void)state;
    static const stack_kind kinds[] = {STACK_PLASTIC, STACK_METAL, STACK_GLASS, STACK_ALL};
    for (int k = 0; k < 4; k++)
        for (int sheet = 0; sheet < 2; sheet++)
        {
            ty_surface_def d = filmed(kinds[k], 0.7f);
            d.thin_walled = sheet;
            ty_material* m = surface(&d);
            for (int i = 0; i < 6; i++) // from above and from below
            {
                ty_bsdf b = bsdf_at(m, i < 3 ? angles[i] : M_PI - angles[i - 3]);
                // Cells are dense where the lobe is steep.
                bool through = kinds[k] == STACK_GLASS && !sheet;
                float z = through ? -b.wo.z : b.wo.z, s = (through ? b.frame.n.z > 0 ? 1 / 1.5f : 1.5f : 1.0f) * b.wo.x;
                s = ty_min(s, 0.95f);
                check_sampling(&b, ty_vec3_make(-s, 0, copysignf(sqrtf(1 - s * s), z)), 60000);
            }
            ty_material_destroy(m);
        }
}

static void test_reciprocity(void** state)
{
    (void)state;
    ty_surface_def d = filmed(STACK_ALL, 0.4f);
    check_reciprocal(&d, false, 1);
    d = filmed(STACK_PLASTIC, 0.4f);
    check_reciprocal(&d, false, 1);
    d = filmed(STACK_GLASS, 0.4f);
    check_reciprocal(&d, true, 1.5f);
    d.thin_walled = true;
    check_reciprocal(&d, true, 1);
}

// A sheet of the index of air is its film alone, and casts the shadow that this leaves.
static void test_soap(void** state)
{
    (void)state;
    ty_surface_def d = stack(STACK_GLASS, 0);
    put_film(&d, 0.3f, 1.33f);
    d.specular_ior = ty_input_scalar(1);
    d.thin_walled = true;
    ty_material* m = surface(&d);
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    for (int i = 0; i < 4; i++)
    {
        double expected[3];
        ty_bsdf b = bsdf_at(m, angles[i]);
        mean_waves(cos(angles[i]), 1.33, 1, 0.3, expected);
        ty_rgb through = ty_material_transparency(m, NULL, &p, b.wo).through;
        assert_near(1 - through.r, expected[0], 0.002);
        assert_near(1 - through.g, expected[1], 0.002);
        assert_near(1 - through.b, expected[2], 0.002);
    }
    ty_material_destroy(m);
}

// Thickness by a map, roughness by another: what is under the film is left as much.
static void test_varying(void** state)
{
    (void)state;
    ty_shading_context context = {0};
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    ty_surface_def d = stack(STACK_PLASTIC, 0.43f);
    put_film(&d, 0.37f, 1.7f);
    // An attribute that is absent leaves the value alone.
    d.specular_roughness.attribute_index = d.thin_film_thickness.attribute_index = 0;
    ty_material* m = surface(&d);
    for (int a = 0; a < 4; a++)
    {
        ty_bsdf b;
        ty_material_prepare(m, &context, &p, ty_vec3_make((float)sin(angles[a]), 0, (float)cos(angles[a])), &b);
        assert_same(lattice_color(&b, 30000), ty_rgb_grey(1), 0.005);
    }
    ty_material_destroy(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_waves), cmocka_unit_test(test_where_it_changes_nothing),
        cmocka_unit_test(test_thick_film),    cmocka_unit_test(test_metal_straight_on),
        cmocka_unit_test(test_furnace),       cmocka_unit_test(test_sampling),
        cmocka_unit_test(test_reciprocity),   cmocka_unit_test(test_soap),
        cmocka_unit_test(test_varying),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
