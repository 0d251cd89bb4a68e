// SPDX-License-Identifier: Apache-2.0
// Walks in spheres against published and tabulated numbers, and the fits through them.
#include "stage.h"
#include <tsuya/shading/calibrate.h>
#include <tsuya/shading/sampling.h>
#include <tsuya/shading/walk.h>

static ty_sphere_walk walked(float optical_radius, float albedo, float anisotropy, float ior, int count)
{
    ty_sphere_walk_def def = {optical_radius, albedo, anisotropy, ior, count, {7}};
    ty_sphere_walk walk;
    assert_true(ty_sphere_walk_run(&def, NULL, &walk));
    return walk;
}

// Albedo of the whole sphere, from a program of its own.
static void test_sphere_albedo(void** state)
{
    (void)state;
    static const double table[][3] = {{1, 0.9, 0.878}, {2, 0.9, 0.782}, {4, 0.9, 0.659},   {6, 0.9, 0.598},
                                      {4, 0.98, .905}, {8, 0.98, .842}, {4, 0.999, 0.995}, {8, 0.995, 0.951}};
    for (int i = 0; i < 8; i++)
        assert_near(walked((float)table[i][0], (float)table[i][1], 0, 1, 40000).moments[0], table[i][2], 0.005);
    assert_near(walked(4, 1, 0, 1, 1000).moments[0], 1, 1e-12);
}

// A white walk makes 4R / 3l scatterings on average, whatever its phase function makes of each.
static void test_mean_scatterings(void** state)
{
    (void)state;
    for (int i = 0; i < 4; i++)
    {
        float radius = (float)(1 << i);
        assert_near(walked(radius, 1, 0, 1, 40000).mean_scatterings / (4.0 / 3.0 * (double)radius), 1, 0.02);
    }
    assert_near(walked(4, 1, 0.5f, 1, 20000).mean_scatterings / (2 * 4.0 / 3.0 * 4), 1, 0.03);
}

static void test_kernels_fit_as_tabulated(void** state)
{
    (void)state;
    // R/l, t, sigma; errors of Lambert, of the normalised Gaussian and of the Poisson kernel.
    static const double table[][6] = {{1, .890, 1.135, .207, .0241, .0084},
                                      {2, .528, .775, .152, .0255, .0064},
                                      {4, .294, .527, .100, .0202, .0035},
                                      {8, .155, .357, .059, .0152, .0019}};
    for (int i = 0; i < 4; i++)
    {
        ty_sphere_walk walk = walked((float)table[i][0], 1, 0, 1, 200000);
        double t = ty_sphere_fit_poisson(&walk), sigma = ty_sphere_fit_gaussian(&walk);
        assert_near(t / table[i][1], 1, 0.02);
        assert_near(sigma / table[i][2], 1, 0.02);
        assert_near(ty_sphere_error_poisson(&walk, 0), table[i][3], 0.002);
        assert_near(ty_sphere_error_gaussian(&walk, sigma), table[i][4], 0.0015);
        assert_near(ty_sphere_error_poisson(&walk, t), table[i][5], 0.0008);
    }
    ty_sphere_walk absorbing = walked(4, 0.9f, 0, 1, 100000);
    assert_near(ty_sphere_fit_poisson(&absorbing), 0.190, 0.006);
}

// A deep sphere knows the transport mean free path alone.
static void test_similar_media(void** state)
{
    (void)state;
    double t = ty_sphere_fit_poisson(&(ty_sphere_walk[]){walked(8, 1, 0, 1, 40000)}[0]);
    double forward = ty_sphere_fit_poisson(&(ty_sphere_walk[]){walked(8, 1, 0.7f, 1, 40000)}[0]);
    assert_near(forward / t, 1, 0.08);
    assert_near(walked(8, 0.98f, 0.7f, 1, 20000).moments[0], walked(8, 0.98f, 0, 1, 20000).moments[0], 0.01);
    // A boundary that reflects from inside keeps light longer: 2.1 to 2.3 x at 1.33, 2.5 to 2.9 x at 1.5.
    ty_sphere_walk water = walked(8, 1, 0, 1.33f, 40000), glass = walked(8, 1, 0, 1.5f, 40000);
    assert_near(8 * ty_sphere_fit_poisson(&water), 2.2, 0.15);
    assert_near(8 * ty_sphere_fit_poisson(&glass), 2.7, 0.25);
}

// The same moments as by the material's walks through a mesh.
static void test_walks_of_the_material(void** state)
{
    (void)state;
    const int count = 40000;
    const float radius = 1e-3f;
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, radius, 0, 0);
    stage ball;
    stage_init_one(&ball, &shape);
    ty_surface_point pole = seen(&ball, ty_vec3_make(0, 0.01f, 0), ty_vec3_make(0, -1, 0));
    ty_scattering matter = {ty_rgb_grey(3 / radius), ty_rgb_grey(0.99f), 0};
    ty_frame frame = ty_frame_from_normal(ty_neg(pole.ng));
    ty_rng rng = ty_rng_make((ty_seed){5}, 1, 2);
    double sums[3] = {0};
    for (int i = 0; i < count; i++)
    {
        ty_walk w;
        ty_vec3 d = ty_sample_cosine((ty_vec2){ty_rng_float(&rng), ty_rng_float(&rng)});
        if (ty_walk_through(ball.world, &pole, &matter, ty_to_world(frame, d), ty_rng_float(&rng), &rng, &w) !=
            TY_WALK_LEFT)
            continue;
        double x = (double)ty_dot(pole.ng, w.exit.ng), weight = (double)w.beta.g / count;
        sums[0] += weight;
        sums[1] += weight * x;
        sums[2] += weight * (1.5 * x * x - 0.5);
    }
    stage_term(&ball);
    ty_sphere_walk own = walked(3, 0.99f, 0, 1, 100000);
    for (int l = 0; l < 3; l++)
        assert_near(sums[l], own.moments[l], 0.008);
}

static void test_workers_change_nothing(void** state)
{
    (void)state;
    ty_sphere_walk_def def = {3, 0.99f, 0.3f, 1.4f, 5000, {1}};
    ty_sphere_walk alone, together;
    ty_workers* workers;
    ty_error error;
    assert_int_equal(ty_workers_create(3, &workers, &error), TY_OK);
    assert_true(ty_sphere_walk_run(&def, NULL, &alone));
    assert_true(ty_sphere_walk_run(&def, workers, &together));
    assert_memory_equal(&alone, &together, sizeof alone);
    ty_workers_destroy(workers);
}

static ty_optical_state state_of(float wet, float cooked, float scale)
{
    float length = ty_moisture_optics_make((ty_moisture){wet, cooked}).mean_free_path;
    return (ty_optical_state){wet, cooked, scale * length, 1, 0, 1};
}

static ty_calibration_fit* calibrated(const ty_optical_state* states, int count)
{
    static ty_calibration_fit fit;
    const float radii[3] = {0.5e-3f, 1e-3f, 2e-3f};
    ty_calibration_def def = {states, radii, count, 3, 20000, {3}};
    assert_true(ty_calibration_run(&def, NULL, &fit));
    return &fit;
}

static void test_law_is_found_again(void** state)
{
    (void)state;
    const ty_optical_state states[] = {state_of(0.145f, 1, 1), state_of(0.3f, 1, 1), state_of(0.62f, 1, 1),
                                       state_of(0.145f, 0, 1), state_of(0.31f, 0, 1)};
    const ty_calibration_fit* fit = calibrated(states, 5);
    ty_moisture_law law = ty_moisture_law_default();
    assert_near(fit->law.cooked_constant, (double)law.cooked_constant, 0.03);
    assert_near(fit->law.cooked_exponent, (double)law.cooked_exponent, 0.03);
    assert_near(fit->law.raw_length * 1e3f, 0.19, 0.005);
    assert_near(fit->law.soaked_length * 1e3f, 0.10, 0.003);
    assert_true(fit->law.rms < 0.008f && fit->rms_published > 0.04f && fit->rms_published < 0.08f);
    assert_near(fit->slope, 4.0 / 3.0, 0.04);
    assert_near(fit->bend, 0.5, 0.05);
    assert_true(fit->rms_t < 0.02f);
    // sigma_0 grows with moisture, as published.
    assert_true(fit->sigma_0[0] < fit->sigma_0[1] && fit->sigma_0[1] < fit->sigma_0[2]);
    assert_near(fit->law.sigma_exponent, 0.62, 0.06);
    for (int r = 0; r < 3; r++)
        assert_near(fit->rows[1][r].rms_law, (double)fit->rows[1][r].rms_poisson, 0.001);
}

// Half the length everywhere is half the length of the law; what no state tells stays.
static void test_untold_stays(void** state)
{
    (void)state;
    const ty_optical_state states[] = {state_of(0.2f, 1, 0.5f), state_of(0.62f, 1, 0.5f)};
    const ty_calibration_fit* fit = calibrated(states, 2);
    assert_near(fit->law.cooked_constant, 0.0736 - log(2), 0.03);
    assert_near(fit->law.cooked_exponent, 0.9, 0.04);
    assert_near(fit->law.raw_length * 1e3f, 0.19, 1e-6);
    assert_near(fit->law.soaked_length * 1e3f, 0.10, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere_albedo),
        cmocka_unit_test(test_mean_scatterings),
        cmocka_unit_test(test_kernels_fit_as_tabulated),
        cmocka_unit_test(test_similar_media),
        cmocka_unit_test(test_walks_of_the_material),
        cmocka_unit_test(test_workers_change_nothing),
        cmocka_unit_test(test_law_is_found_again),
        cmocka_unit_test(test_untold_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
