// SPDX-License-Identifier: Apache-2.0
// Warps follow their densities; the piecewise-constant density samples what it says.
#include "spherical.h"
#include <tsuya/shading/sampling.h>

static void test_warps(void** state)
{
    (void)state;
    // Midpoints of a grid: means of the first two moments are those of the density.
    double n = 400, disc = 0, cosine = 0, cosine_xx = 0, sphere_zz = 0, sphere_z = 0, cone = 0, disc_x = 0, disc_xx = 0;
    for (int i = 0; i < 400 * 400; i++)
    {
        ty_vec2 u = {(float)((i % 400 + 0.5) / n), (float)((int)(i / 400) / n + 0.5 / n)};
        ty_vec2 d = ty_sample_disc(u);
        ty_vec3 c = ty_sample_cosine(u), s = ty_sample_sphere(u), k = ty_sample_cone(u, 0.9f);
        disc += (double)(d.x * d.x + d.y * d.y) / n / n;
        disc_x += (double)d.x / n / n;
        disc_xx += (double)(d.x * d.x) / n / n;
        cosine += (double)c.z / n / n;
        cosine_xx += (double)(c.x * c.x) / n / n;
        sphere_z += (double)s.z / n / n;
        sphere_zz += (double)(s.y * s.y) / n / n;
        cone += (double)k.z / n / n;
        assert_true(k.z >= 0.9f - 1e-6f && d.x * d.x + d.y * d.y <= 1.0f + 1e-6f && c.z >= 0.0f);
        assert_near(ty_length(s), 1.0, 1e-6);
        assert_near(ty_length(k), 1.0, 1e-6);
    }
    assert_near(disc, 0.5, 1e-4);
    assert_near(disc_x, 0.0, 1e-4);
    assert_near(disc_xx, 0.25, 1e-4);
    assert_near(cosine, 2.0 / 3, 1e-4);
    assert_near(cosine_xx, 0.25, 1e-4);
    assert_near(sphere_z, 0.0, 1e-4);
    assert_near(sphere_zz, 1.0 / 3, 1e-4);
    assert_near(cone, 0.95, 1e-4);
}

static void test_disc_has_no_hole(void** state)
{
    (void)state;
    ty_vec2 d = ty_sample_disc((ty_vec2){0.5f, 0.5f});
    assert_near(d.x * d.x + d.y * d.y, 0.0, 0.0);
    // A cone of a tenth of a milliradian keeps its shape.
    ty_vec3 k = ty_sample_cone((ty_vec2){0.25f, 0.0f}, 1.0f - 1e-6f);
    assert_near(k.x, sqrt(0.25 * 2e-6), 1e-4 * sqrt(0.25 * 2e-6) + 3e-5);
}

static void test_distribution(void** state)
{
    (void)state;
    float weights[3 * 4] = {1, 2, 0, 5, 0, 0, 0, 0, 3, 0.5f, 4, 0.5f};
    double sum = 16, count[12] = {0};
    ty_distribution* d = ty_distribution_create(weights, 4, 3);
    ty_rng rng = ty_rng_make((ty_seed){5}, 0, 0);
    int n = 160000;
    for (int i = 0; i < n; i++)
    {
        float ux = ty_rng_float(&rng), pdf;
        ty_vec2 p = ty_distribution_sample(d, (ty_vec2){ux, ty_rng_float(&rng)}, &pdf);
        int cell = (int)(p.y * 3) * 4 + (int)(p.x * 4);
        assert_in_range(cell, 0, 11);
        count[cell]++;
        assert_near(pdf, (double)weights[cell] / sum * 12, 1e-4);
        assert_near(ty_distribution_pdf(d, p), (double)pdf, 1e-5);
    }
    for (int i = 0; i < 12; i++)
        assert_near(count[i], (double)weights[i] / sum * n, 5 * sqrt((double)weights[i] / sum * n) + 0.0);
    assert_near(ty_distribution_pdf(d, (ty_vec2){0.1f, 0.5f}), 0.0, 0.0);
    ty_distribution_destroy(d);
}

static void test_distribution_of_nothing_is_uniform(void** state)
{
    (void)state;
    float weights[6] = {0, -1, NAN, 0, INFINITY, 0}, pdf;
    ty_distribution* d = ty_distribution_create(weights, 3, 2);
    ty_vec2 p = ty_distribution_sample(d, (ty_vec2){0.3f, TY_ONE_MINUS_EPSILON}, &pdf);
    assert_near(pdf, 1.0, 1e-6);
    assert_near(p.x, 0.3, 1e-6);
    assert_true(p.y < 1.0f);
    ty_distribution_destroy(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_warps),
        cmocka_unit_test(test_disc_has_no_hole),
        cmocka_unit_test(test_distribution),
        cmocka_unit_test(test_distribution_of_nothing_is_uniform),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
