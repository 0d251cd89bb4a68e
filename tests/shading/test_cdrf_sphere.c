// SPDX-License-Identifier: Apache-2.0
// `cdrf` on spheres, where the answers are known: exit points, terminator, furnace.
#include "stage.h"

static const float radius = 1e-3f;
static const ty_vec3 top = {0, 1, 0};

static stage ball;

static int make_ball(void** state)
{
    (void)state;
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, radius, 0, 0);
    stage_init_one(&ball, &shape);
    return 0;
}

static int drop_ball(void** state)
{
    (void)state;
    stage_term(&ball);
    return 0;
}

// Seen straight from a direction, some radii away.
static ty_surface_point seen_from(const stage* s, ty_vec3 direction)
{
    return seen(s, ty_mul(direction, 10 * radius), ty_neg(direction));
}

// Where the exits of a material lie, against the Poisson kernel about the entry.
static void check_exits(const ty_cdrf_def* def, float t)
{
    ty_material* m = cdrf(def);
    ty_vec3 direction = ty_normalize(ty_vec3_make(0.31f, 0.57f, 0.76f));
    ty_surface_point x = seen_from(&ball, direction);
    ty_rng rng = ty_rng_make((ty_seed){6}, 0, 0);
    double count[32] = {0}, g = exp(-(double)t), chi = 0, around[8] = {0};
    int n = 64000;
    for (int i = 0; i < n; i++)
    {
        ty_bsdf b;
        ty_rgb weight;
        float u[4];
        random4(&rng, u);
        ty_material_prepare(m, &ball.context, &x, direction, &b);
        assert_true(ty_bsdf_resolve(&b, &ball.context, u, &rng, &weight));
        assert_near(weight.g, 1.0, 1e-6);
        assert_near(ty_length(b.point.position) / radius, 1.0, 1e-3);
        assert_near(ty_dot(b.frame.n, ty_normalize(b.point.position)), 1.0, 1e-3);
        ty_vec3 l = ty_to_local(ty_frame_from_normal(ty_normalize(x.position)), ty_normalize(b.point.position));
        // Distribution function of the Poisson kernel: the share nearer to the pole than c.
        double c = (double)l.z, near = (1 + g * g - 2 * g * c);
        double share = 1.0 - (1 - g * g) / (2 * g) * (1 / sqrt(near) - 1 / (1 + g));
        count[(int)fmin(31, fmax(0, share) * 32)]++;
        double turn = atan2((double)l.y, (double)l.x) / (2 * M_PI);
        around[(int)((turn - floor(turn)) * 8) % 8]++;
    }
    for (int i = 0; i < 32; i++)
        chi += (count[i] - n / 32.0) * (count[i] - n / 32.0) / (n / 32.0);
    if (chi > 31 + 5 * sqrt(62))
        fail_msg("exits do not follow the Poisson kernel: chi-squared %.1f of 31", chi);
    for (int i = 0; i < 8; i++)
        assert_near(around[i], n / 8.0, 5 * sqrt(n / 8.0));
    ty_material_destroy(m);
}

static void test_exits_follow_the_poisson_kernel(void** state)
{
    (void)state;
    static const float x[] = {0.1f, 0.29f, 0.8f, 3.0f};
    for (int i = 0; i < 4; i++)
        for (int e = i < 2 ? TY_CDRF_DEPTH : TY_CDRF_PROBE; e <= TY_CDRF_PROBE; e++) // depth walks from .3 on
        {
            // The mesh's own roundness is off by its facets: a coarser kernel cannot see it.
            ty_cdrf_def d = white_cdrf(e, TY_CDRF_POISSON, x[i] * radius);
            check_exits(&d, ty_cdrf_poisson_t(x[i], 0));
        }
}

// Angles from the light, seen from above the point.
static double at_angle(const stage* s, const ty_material* m, double degrees, int n)
{
    double a = degrees * M_PI / 180;
    ty_surface_point p = seen_from(s, top);
    ty_vec3 light = ty_normalize(ty_vec3_make((float)(sin(a) * 0.8), (float)cos(a), (float)(sin(a) * 0.6)));
    return lit(s, m, &p, top, light, n);
}

static void test_terminator(void** state)
{
    (void)state;
    for (int e = TY_CDRF_DEPTH; e <= TY_CDRF_LOCAL; e++)
    {
        ty_cdrf_def d = white_cdrf(e, TY_CDRF_POISSON, radius / 4);
        ty_material* m = cdrf(&d);
        int n = e == TY_CDRF_LOCAL ? 1 : 300000;
        assert_near(at_angle(&ball, m, 90, n), 0.148, 0.003);
        assert_near(at_angle(&ball, m, 180, n), 0.0284, 0.002);
        assert_near(at_angle(&ball, m, 0, n), (double)ty_cdrf_poisson(ty_cdrf_poisson_t(0.25f, 0), 1), 0.003);
        ty_material_destroy(m);
    }
    ty_cdrf_def d = white_cdrf(TY_CDRF_LOCAL, TY_CDRF_GAUSSIAN, radius / 4);
    ty_material* m = cdrf(&d);
    assert_near(at_angle(&ball, m, 90, 1), 0.172, 0.003);
    ty_material_destroy(m);
    // The probe has a spherical Gaussian instead of the wrapped one.
    d.evaluate = TY_CDRF_PROBE;
    m = cdrf(&d);
    assert_near(at_angle(&ball, m, 90, 300000), 0.172, 0.01);
    ty_material_destroy(m);
}

static void test_local_follows_the_closed_forms(void** state)
{
    (void)state;
    static const float x[] = {0.02f, 0.12f, 0.5f, 2.0f};
    for (int i = 0; i < 4; i++)
        for (int k = TY_CDRF_POISSON; k <= TY_CDRF_GAUSSIAN_PUBLISHED; k++)
        {
            ty_cdrf_def d = white_cdrf(TY_CDRF_LOCAL, k, x[i] * radius);
            ty_material* m = cdrf(&d);
            for (int a = 0; a <= 18; a++)
            {
                float theta = (float)(a * M_PI / 18), s = ty_cdrf_gaussian_sigma(x[i], 0);
                float expected = k == TY_CDRF_POISSON    ? ty_cdrf_poisson(ty_cdrf_poisson_t(x[i], 0), ty_cos(theta))
                                 : k == TY_CDRF_GAUSSIAN ? ty_cdrf_gaussian(s, theta)
                                                         : ty_cdrf_gaussian_published(s, theta);
                assert_near(at_angle(&ball, m, a * 10.0, 1), (double)expected, 2e-3);
            }
            ty_material_destroy(m);
        }
}

static void test_published_moisture_law_is_linear(void** state)
{
    (void)state;
    ty_cdrf_def d = white_cdrf(TY_CDRF_LOCAL, TY_CDRF_GAUSSIAN_PUBLISHED, -1);
    d.moisture.wet_basis = ty_input_scalar(0.2f);
    ty_material* m = cdrf(&d);
    float sigma = ty_moisture_optics_make((ty_moisture){0.2f, 0}).gaussian_sigma / radius;
    assert_near(at_angle(&ball, m, 90, 1), (double)ty_cdrf_gaussian_published(sigma, TY_PI / 2), 1e-3);
    ty_material_destroy(m);
}

// The mean free path at which the law gives this sigma.
static float path_of_sigma(float sigma)
{
    float low = 0.01f, high = 3.0f;
    for (int i = 0; i < 60; i++)
    {
        float middle = 0.5f * (low + high);
        if (ty_cdrf_gaussian_sigma(middle, 0) < sigma)
            low = middle;
        else
            high = middle;
    }
    return low * radius;
}

static void test_furnace(void** state)
{
    (void)state;
    ty_vec3 wo = ty_normalize(ty_vec3_make(0.8f, 0.5f, -0.1f));
    ty_surface_point p = seen_from(&ball, top);
    for (int e = TY_CDRF_DEPTH; e <= TY_CDRF_LOCAL; e++)
        for (int k = TY_CDRF_POISSON; k <= TY_CDRF_GAUSSIAN; k++)
        {
            if (e == TY_CDRF_DEPTH && k != TY_CDRF_POISSON)
                continue;
            ty_cdrf_def d = white_cdrf(e, k, radius / 3);
            ty_material* m = cdrf(&d);
            assert_near(furnace(&ball, m, &p, wo, e == TY_CDRF_LOCAL ? 200000 : 2000), 1.0,
                        e == TY_CDRF_LOCAL ? 0.002 : 1e-5);
            ty_material_destroy(m);
            d.specular_weight = ty_input_scalar(1); // the coat as well, at the moisture's roughness and as a mirror
            m = cdrf(&d);
            assert_near(furnace(&ball, m, &p, wo, 150000), 1.0, 0.004);
            ty_material_destroy(m);
            d.specular_roughness = ty_input_scalar(0);
            m = cdrf(&d);
            assert_near(furnace(&ball, m, &p, wo, 100000), 1.0, 0.004);
            ty_material_destroy(m);
        }
}

static void test_published_gain(void** state)
{
    (void)state;
    ty_surface_point p = seen_from(&ball, top);
    for (int e = TY_CDRF_PROBE; e <= TY_CDRF_LOCAL; e++)
    {
        ty_cdrf_def d = white_cdrf(e, TY_CDRF_GAUSSIAN_PUBLISHED, path_of_sigma(0.5f));
        ty_material* m = cdrf(&d);
        assert_near(furnace(&ball, m, &p, top, 200000), 1.103, 0.003);
        ty_material_destroy(m);
    }
}

static void test_local_sampling(void** state)
{
    (void)state;
    ty_surface_point p = seen_from(&ball, top);
    for (int k = TY_CDRF_POISSON; k <= TY_CDRF_GAUSSIAN_PUBLISHED; k++)
        for (int coated = 0; coated < 2; coated++)
        {
            ty_cdrf_def d = white_cdrf(TY_CDRF_LOCAL, k, 0.7f * radius);
            d.specular_weight = ty_input_scalar(coated ? 1.0f : 0.0f);
            d.specular_roughness = ty_input_scalar(0.4f);
            ty_material* m = cdrf(&d);
            ty_bsdf b;
            ty_vec3 wo = ty_normalize(ty_vec3_make(0.9f, 0.7f, 0.2f));
            ty_material_prepare(m, &ball.context, &p, wo, &b);
            check_sampling(&b, ty_reflect(wo, top), 200000);
            ty_material_destroy(m);
        }
}

static void test_exit_and_coat_sampling(void** state)
{
    (void)state;
    ty_cdrf_def d = white_cdrf(TY_CDRF_DEPTH, TY_CDRF_POISSON, 0.3f * radius);
    d.specular_weight = ty_input_scalar(1);
    d.specular_roughness = ty_input_scalar(0.4f);
    ty_material* m = cdrf(&d);
    ty_surface_point p = seen_from(&ball, top);
    ty_vec3 wo = ty_normalize(ty_vec3_make(0.9f, 0.7f, 0.2f));
    ty_rng rng = ty_rng_make((ty_seed){1}, 0, 0);
    for (int coat = 0; coat < 2; coat++)
    {
        ty_bsdf b;
        ty_rgb weight;
        const float u[4] = {coat ? 0.0f : 0.99f, 0.3f, 0.6f, 0.1f};
        ty_material_prepare(m, &ball.context, &p, wo, &b);
        assert_true(ty_bsdf_resolve(&b, &ball.context, u, &rng, &weight));
        assert_int_equal(b.kind, coat ? TY_BSDF_CDRF_COAT : TY_BSDF_CDRF_EXIT);
        check_sampling(&b, coat ? ty_reflect(wo, top) : b.frame.n, 200000);
    }
    ty_material_destroy(m);
}

static void test_scaled_instances(void** state)
{
    (void)state;
    // Twice the ball with twice the path is the same picture; a mirror and a turn change nothing.
    ty_affine maps[2] = {
        ty_affine_from_trs((ty_vec3){0}, ty_quat_axis_angle(ty_vec3_make(0.6f, 0, 0.8f), 1.1f), ty_vec3_make(2, 2, 2)),
        {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, radius, 0, 0);
    for (int i = 0; i < 2; i++)
    {
        stage s;
        stage_init(&s, &shape, &maps[i], 1);
        for (int e = TY_CDRF_DEPTH; e <= TY_CDRF_LOCAL; e++)
        {
            ty_cdrf_def d = white_cdrf(e, TY_CDRF_POISSON, (i == 0 ? 2 : 1) * radius / 4);
            ty_material* m = cdrf(&d);
            assert_near(at_angle(&s, m, 90, e == TY_CDRF_LOCAL ? 1 : 100000), 0.148, 0.004);
            ty_material_destroy(m);
        }
        stage_term(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exits_follow_the_poisson_kernel),
        cmocka_unit_test(test_terminator),
        cmocka_unit_test(test_local_follows_the_closed_forms),
        cmocka_unit_test(test_published_moisture_law_is_linear),
        cmocka_unit_test(test_furnace),
        cmocka_unit_test(test_published_gain),
        cmocka_unit_test(test_local_sampling),
        cmocka_unit_test(test_exit_and_coat_sampling),
        cmocka_unit_test(test_scaled_instances),
    };
    return cmocka_run_group_tests(tests, make_ball, drop_ball);
}
