// SPDX-License-Identifier: Apache-2.0
// Kernels on the sphere, their laws and the moisture law, against closed forms, convolutions and random walks.
#include "../../shading/kernel_table.h"
#include "spherical.h"
#include <tsuya/shading/cdrf.h>
#include <tsuya/shading/material.h>

// max(cos, 0) convolved with a Gaussian on the circle, by brute force.
static double convolved(double theta, double sigma)
{
    double sum = 0.0, norm = 0.0;
    for (int i = -20000; i <= 20000; i++)
    {
        double d = i * sigma * 5e-4, w = exp(-0.5 * d * d / (sigma * sigma));
        sum += w * fmax(cos(theta - d), 0.0);
        norm += w;
    }
    return sum / norm;
}

static void test_gaussian_is_the_convolution(void** state)
{
    (void)state;
    static const float sigmas[] = {0.004f, 0.0199f, 0.0201f, 0.1f, 0.3f, 0.8f, 1.5f};
    for (int s = 0; s < 7; s++)
        for (int i = 0; i <= 90; i++)
        {
            float theta = (float)(i * M_PI / 90);
            assert_near(ty_cdrf_gaussian_published(sigmas[s], theta), convolved((double)theta, (double)sigmas[s]),
                        1e-5);
        }
    assert_near(ty_cdrf_gaussian_published(0.0f, 1.0f), cos(1.0), 1e-6);
}

static void test_gaussian_normaliser(void** state)
{
    (void)state;
    static const double table[10][2] = {{.1, .9951}, {.2, .9810}, {.3, .9597}, {.4, .9339},  {.5, .9065},
                                        {.6, .8802}, {.8, .8371}, {1, .8098},  {1.5, .7873}, {2, .7855}};
    for (int i = 0; i < 10; i++)
        assert_near(M_PI / (double)ty_cdrf_gaussian_integral((float)table[i][0]), table[i][1], 6e-5);
    assert_near(ty_cdrf_gaussian_integral(0.0f), M_PI, 1e-5);
    assert_near(ty_cdrf_gaussian_integral(0.5f) / TY_PI, 1.103, 5e-4);
}

// Integral over directions between two angles of a response by angle, midpoint rule.
static double integral(float (*response)(float, float), float spread, bool by_cosine, double from, double to)
{
    double sum = 0.0;
    int n = 4000;
    for (int i = 0; i < n; i++)
    {
        double theta = from + (to - from) * (i + 0.5) / n;
        sum += (double)response(spread, (float)(by_cosine ? cos(theta) : theta)) * sin(theta);
    }
    return sum * 2 * M_PI * (to - from) / n;
}

static void test_integrals_and_shares(void** state)
{
    (void)state;
    static const float spreads[] = {0.03f, 0.2f, 0.5f, 1.2f};
    for (int i = 0; i < 4; i++)
    {
        float s = spreads[i];
        assert_near(integral(ty_cdrf_poisson, s, true, 0, M_PI), M_PI, 1e-3);
        assert_near(integral(ty_cdrf_gaussian, s, false, 0, M_PI), M_PI, 1e-3);
        assert_near(integral(ty_cdrf_gaussian_published, s, false, 0, M_PI), (double)ty_cdrf_gaussian_integral(s),
                    1e-3);
        assert_near(ty_cdrf_share_below(TY_CDRF_POISSON, s), integral(ty_cdrf_poisson, s, true, M_PI / 2, M_PI) / M_PI,
                    3e-4);
        assert_near(ty_cdrf_share_below(TY_CDRF_GAUSSIAN, s),
                    integral(ty_cdrf_gaussian, s, false, M_PI / 2, M_PI) / M_PI, 3e-4);
    }
    static const double shares[6][2] = {{.1, .5}, {.2, 1.9}, {.3, 4.1}, {.5, 10}, {.8, 20}, {1.2, 31}};
    for (int i = 0; i < 6; i++)
        assert_near(100 * ty_cdrf_share_below(TY_CDRF_GAUSSIAN, (float)shares[i][0]), shares[i][1], i < 3 ? 0.06 : 0.6);
}

// The response as the average of max(cos, 0) over Henyey-Greenstein deviations, by quadrature.
static double scattered(double t, double theta)
{
    double g = exp(-t), sum = 0.0;
    int n = 800, m = 256;
    for (int i = 0; i < n; i++)
    {
        double u = (i + 0.5) / n, s = (1 - g * g) / (1 - g + 2 * g * u), c = (1 + g * g - s * s) / (2 * g);
        double r = sqrt(fmax(0, 1 - c * c));
        for (int j = 0; j < m; j++)
            sum += fmax(0, c * cos(theta) + r * sin(theta) * cos((j + 0.5) * 2 * M_PI / m));
    }
    return sum / n / m;
}

static void test_poisson_is_henyey_greenstein(void** state)
{
    (void)state;
    for (int i = 0; i <= 8; i++)
    {
        double theta = i * M_PI / 8;
        assert_near(ty_cdrf_poisson(0.05f, (float)cos(theta)), scattered((double)0.05f, theta), 2e-4);
        assert_near(ty_cdrf_poisson(0.3f, (float)cos(theta)), scattered((double)0.3f, theta), 2e-4);
        assert_near(ty_cdrf_poisson(1.4f, (float)cos(theta)), scattered((double)1.4f, theta), 2e-4);
    }
    assert_near(ty_cdrf_poisson(0.0f, 0.3f), 0.3, 1e-6);
    assert_near(ty_cdrf_poisson(0.0f, -0.3f), 0.0, 0.0);
    assert_near(ty_cdrf_poisson(20.0f, -0.7f), 0.25, 1e-6);
}

// Terminator of a sphere with R = 4 mean free paths.
static void test_terminator(void** state)
{
    (void)state;
    float t = ty_cdrf_poisson_t(0.25f, 0), sigma = ty_cdrf_gaussian_sigma(0.25f, 0);
    assert_near(ty_cdrf_poisson(t, 0.0f), 0.148, 0.001);
    assert_near(ty_cdrf_poisson(t, -1.0f), 0.0284, 0.0005);
    assert_near(ty_cdrf_gaussian(sigma, TY_PI / 2), 0.172, 0.0025);
    assert_near(ty_cdrf_gaussian(sigma, TY_PI), 0.0004, 0.0003);
}

// Fits to random walks made apart from those behind our table.
static const double law_x[11] = {1.0 / 60, .05, .0833, .125, .1667, .25, .333, .5, .667, 1, 2};
static const double law_loss[5] = {.1, .02, .005, .001, 0};
static const double law_t[5][11] = {{.001, .009, .024, .053, .093, .190, .289, .469, .628, .880, 1.409},
                                    {.003, .021, .055, .107, .161, .263, .354, .514, .657, .887, 1.391},
                                    {.005, .039, .084, .139, .190, .285, .371, .525, .664, .889, 1.388},
                                    {.011, .057, .100, .152, .200, .292, .376, .528, .665, .890, 1.387},
                                    {.022, .064, .105, .155, .203, .294, .377, .528, .666, .890, 1.387}};
static const double law_sigma[5][11] = {{.022, .069, .121, .192, .266, .404, .521, .713, .877, 1.125, 1.539},
                                        {.034, .111, .194, .287, .365, .491, .593, .760, .906, 1.132, 1.527},
                                        {.048, .159, .249, .335, .403, .517, .611, .771, .913, 1.134, 1.525},
                                        {.072, .196, .275, .352, .416, .525, .616, .774, .915, 1.135, 1.525},
                                        {.106, .210, .283, .357, .419, .527, .618, .775, .915, 1.135, 1.525}};

static void test_laws(void** state)
{
    (void)state;
    for (int k = 0; k < 5; k++)
        for (int i = 0; i < 11; i++)
        {
            // The least are given to one digit; the narrowest Gaussians are set by the smallest angle that was fitted.
            float x = (float)law_x[i], loss = (float)law_loss[k];
            assert_near(ty_cdrf_poisson_t(x, loss), law_t[k][i], 0.03 * law_t[k][i] + 5e-4);
            assert_near(ty_cdrf_gaussian_sigma(x, loss), law_sigma[k][i], 0.03 * law_sigma[k][i] + (i ? 0 : 2.5e-3));
            if (k == 4 && x <= 1)
                assert_near(ty_cdrf_poisson_t(x, 0), 4.0 / 3 * x / (1 + x / 2), 0.025 * law_t[k][i]);
        }
    assert_near(ty_cdrf_poisson_t(0.003f, 0), 0.004, 8e-5); // exact diffusion
    assert_near(ty_cdrf_poisson_t(0.0f, 0), 0.0, 0.0);
    assert_near(ty_cdrf_gaussian_sigma(0.0f, 0), 0.0, 0.0);
    // Beyond the table: the last slope in the log.
    double slope = log(1.967 / 1.384) / log(2.0);
    assert_near(ty_cdrf_poisson_t(8.0f, 0), 1.967 * pow(2.0, slope), 1e-3);
}

static void test_laws_are_monotone(void** state)
{
    (void)state;
    static const float losses[4] = {0, 5e-5f, 2e-3f, 0.3f};
    for (int k = 0; k < 4; k++)
        for (float x = 1e-3f; x < 8.0f; x *= 1.1f)
        {
            assert_true(ty_cdrf_poisson_t(x * 1.1f, losses[k]) > ty_cdrf_poisson_t(x, losses[k]));
            assert_true(ty_cdrf_gaussian_sigma(x * 1.1f, losses[k]) > ty_cdrf_gaussian_sigma(x, losses[k]));
            if (k < 3 && x < 0.6f)
                assert_true(ty_cdrf_poisson_t(x, losses[k]) >= ty_cdrf_poisson_t(x, losses[k + 1]));
        }
}

// The table that shading reads is the law, but for the kink where its nodes begin: bits of x and loss instead of
// logarithms.
static void test_spread_table(void** state)
{
    (void)state;
    ty_spread_table* poisson = ty_spread_table_create(TY_CDRF_POISSON);
    ty_spread_table* gaussian = ty_spread_table_create(TY_CDRF_GAUSSIAN);
    for (float loss = 0.0f; loss < 0.5f; loss = loss * 1.7f + 1e-5f)
        for (float x = 1e-3f; x < 30.0f; x *= 1.13f)
        {
            double t = (double)ty_cdrf_poisson_t(x, loss), sigma = (double)ty_cdrf_gaussian_sigma(x, loss);
            assert_near(ty_spread_table_at(poisson, x, loss), 1 - exp(-t), 0.06 * (1 - exp(-t)));
            assert_near(ty_spread_table_at(gaussian, x, loss), sigma, 0.02 * sigma);
        }
    assert_near(ty_spread_table_at(poisson, 0.0f, 0.01f), 0.0, 0.0);
    assert_near(ty_spread_table_at(poisson, -1.0f, 0.01f), 0.0, 0.0);
    assert_near(ty_spread_table_at(poisson, 1e6f, 1.0f), 1.0, 0.02);
    ty_spread_table_destroy(poisson);
    ty_spread_table_destroy(gaussian);
}

// Albedo of a half space of isotropic scatterers lit diffusely, by its H-function (Chandrasekhar 1960, sec. 48: the
// share that returns is 1 - 2 sqrt(1 - a) times the first moment of H).
static double half_space_albedo(double single)
{
    enum
    {
        N = 400
    };
    double h[N], moment = 0.0;
    for (int i = 0; i < N; i++)
        h[i] = 1.0;
    for (int pass = 0; pass < 400; pass++)
        for (int i = 0; i < N; i++)
        {
            double mu = (i + 0.5) / N, sum = 0.0;
            for (int j = 0; j < N; j++)
            {
                double nu = (j + 0.5) / N;
                sum += nu / (mu + nu) * h[j] / N;
            }
            h[i] = 0.5 * (h[i] + 1.0 / (sqrt(1.0 - single) + 0.5 * single * sum));
        }
    for (int i = 0; i < N; i++)
        moment += (i + 0.5) / N * h[i] / N;
    return 1.0 - 2.0 * sqrt(1.0 - single) * moment;
}

static void test_albedo_inversion(void** state)
{
    (void)state;
    static const float colors[3] = {0.3f, 0.7f, 0.9f};
    for (int i = 0; i < 3; i++)
        assert_near(half_space_albedo(1.0 - (double)ty_cdrf_loss(colors[i], 0)), (double)colors[i], 0.006);
    assert_near(ty_cdrf_loss(1.0f, 0), 0.0, 1e-6);
    assert_near(ty_cdrf_loss(1.0f, 0.6f), 0.0, 1e-6);
    // A boundary that sends .5 back asks for .8 / (.5 + .5 * .8) within.
    assert_near(ty_cdrf_loss(0.8f, 0.5f), (double)ty_cdrf_loss(8.0f / 9, 0), 1e-6);
    assert_true(ty_cdrf_loss(0.0f, 0) > 0.95f);
}

static void test_moisture(void** state)
{
    (void)state;
    static const double wet[3] = {.145, .31, .62}, path[3] = {.19, .375, .70};
    for (int i = 0; i < 3; i++)
    {
        ty_moisture_optics o = ty_moisture_optics_make((ty_moisture){(float)wet[i], 1.0f});
        assert_near(1e3f * o.mean_free_path, path[i], 0.0035);
        assert_near(1e3f * o.gaussian_sigma, exp(.34 + .52 * log(wet[i])), 1e-4);
    }
    assert_near(1e3f * ty_moisture_optics_make((ty_moisture){.145f, 0}).mean_free_path, 0.19, 1e-4);
    assert_near(1e3f * ty_moisture_optics_make((ty_moisture){.31f, 0}).mean_free_path, 0.10, 1e-4);
    assert_near(1e3f * ty_moisture_optics_make((ty_moisture){.31f, .5f}).mean_free_path, sqrt(.10 * .3753), 1e-3);
    // Dry is matt with hardly a film, cooked is covered.
    ty_moisture_optics dry = ty_moisture_optics_make((ty_moisture){.145f, 0});
    ty_moisture_optics moist = ty_moisture_optics_make((ty_moisture){.62f, 1});
    assert_true(dry.film < 0.1f && dry.roughness > 0.4f && dry.roughness < 0.5f);
    assert_true(moist.film > 0.99f && moist.roughness >= 0.15f && moist.roughness <= 0.2f);
}

static void test_moisture_is_monotone(void** state)
{
    (void)state;
    for (float w = 0.06f; w < 0.61f; w += 0.01f)
    {
        ty_moisture_optics a = ty_moisture_optics_make((ty_moisture){w, 1});
        ty_moisture_optics b = ty_moisture_optics_make((ty_moisture){w + 0.01f, 1});
        assert_true(b.mean_free_path > a.mean_free_path && b.gaussian_sigma > a.gaussian_sigma);
        assert_true(b.film >= a.film && b.roughness <= a.roughness);
        // Uncooked grains turn whiter as they soak.
        assert_true(ty_moisture_optics_make((ty_moisture){w + 0.01f, 0}).mean_free_path <=
                    ty_moisture_optics_make((ty_moisture){w, 0}).mean_free_path);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gaussian_is_the_convolution),
        cmocka_unit_test(test_gaussian_normaliser),
        cmocka_unit_test(test_integrals_and_shares),
        cmocka_unit_test(test_poisson_is_henyey_greenstein),
        cmocka_unit_test(test_terminator),
        cmocka_unit_test(test_laws),
        cmocka_unit_test(test_laws_are_monotone),
        cmocka_unit_test(test_spread_table),
        cmocka_unit_test(test_albedo_inversion),
        cmocka_unit_test(test_moisture),
        cmocka_unit_test(test_moisture_is_monotone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
