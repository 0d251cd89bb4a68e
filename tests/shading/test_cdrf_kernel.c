// SPDX-License-Identifier: Apache-2.0
// Kernels on the sphere, their laws and the moisture law, against closed forms, convolutions and random walks.
#include "spherical.h"
#include <tsuya/shading/cdrf.h>

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
    float t = ty_cdrf_poisson_t(0.25f), sigma = ty_cdrf_gaussian_sigma(0.25f);
    assert_near(ty_cdrf_poisson(t, 0.0f), 0.148, 0.001);
    assert_near(ty_cdrf_poisson(t, -1.0f), 0.0284, 0.0005);
    assert_near(ty_cdrf_gaussian(sigma, TY_PI / 2), 0.172, 0.0025);
    assert_near(ty_cdrf_gaussian(sigma, TY_PI), 0.0004, 0.0003);
}

static void test_laws(void** state)
{
    (void)state;
    static const double x[11] = {1.0 / 60, .05, .0833, .125, .1667, .25, .333, .5, .667, 1, 2};
    static const double t[11] = {.022, .064, .105, .155, .203, .294, .377, .528, .666, .890, 1.387};
    static const double s[11] = {.106, .210, .283, .357, .419, .527, .618, .775, .915, 1.135, 1.525};
    for (int i = 0; i < 11; i++)
    {
        assert_near(ty_cdrf_poisson_t((float)x[i]), t[i], i == 0 ? 3e-4 : 1e-5);
        assert_near(ty_cdrf_gaussian_sigma((float)x[i]), s[i], 1e-5);
        if (x[i] <= 1)
            assert_near(ty_cdrf_poisson_t((float)x[i]), 4.0 / 3 * x[i] / (1 + x[i] / 2), 0.025 * t[i]);
    }
    assert_near(ty_cdrf_poisson_t(0.003f), 0.004, 1e-6);
    assert_near(ty_cdrf_poisson_t(0.0f), 0.0, 0.0);
    assert_near(ty_cdrf_gaussian_sigma(0.0f), 0.0, 0.0);
    for (float v = 1e-3f; v < 8.0f; v *= 1.1f)
    {
        assert_true(ty_cdrf_poisson_t(v * 1.1f) > ty_cdrf_poisson_t(v));
        assert_true(ty_cdrf_gaussian_sigma(v * 1.1f) > ty_cdrf_gaussian_sigma(v));
    }
    // Beyond the table: the last slope in the log.
    double slope = log(1.387 / 0.890) / log(2.0);
    assert_near(ty_cdrf_poisson_t(4.0f), 1.387 * pow(2.0, slope), 1e-4);
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
        cmocka_unit_test(test_moisture),
        cmocka_unit_test(test_moisture_is_monotone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
