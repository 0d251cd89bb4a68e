// SPDX-License-Identifier: Apache-2.0
// What is known in closed form of the kernels, their laws and the coat, against the program's functions.
#include "report.h"
#include "subject.h"
#include <math.h>
#include <stdio.h>

#define PI 3.14159265358979323846

static void report_normaliser(void)
{
    static const double sigma[10] = {.1, .2, .3, .4, .5, .6, .8, 1, 1.5, 2};
    static const double expected[10] = {.9951, .9810, .9597, .9339, .9065, .8802, .8371, .8098, .7873, .7855};
    report_title("Normaliser of the published kernel, pi / I(sigma)", NULL);
    for (int i = 0; i < 10; i++)
    {
        char name[60];
        snprintf(name, sizeof name, "sigma %g", sigma[i]);
        report_near(name, PI / (double)ty_cdrf_gaussian_integral((float)sigma[i]), expected[i], 0.00006);
    }
}

// Largest relative distance of a law in closed form from the program's table.
static double farthest(bool poisson, double low, double high)
{
    double most = 0.0;
    for (double x = low; x <= high; x *= 1.05)
    {
        double table = poisson ? (double)ty_cdrf_poisson_t((float)x, 0) : (double)ty_cdrf_gaussian_sigma((float)x, 0);
        double law = poisson ? 4.0 / 3.0 * x / (1.0 + 0.5 * x) : 1.13 * pow(x, 0.57);
        most = fmax(most, fabs(law / table - 1.0));
    }
    return most;
}

// sigma over curvature in units of the root of l L, L = l / sqrt(3 (1 - albedo)): one number for all spheres that are
// large beside L.
static double absorbing_width(double x, double albedo)
{
    double loss = 1.0 - albedo;
    return (double)ty_cdrf_gaussian_sigma((float)x, (float)loss) / (x * sqrt(1.0 / sqrt(3.0 * loss)));
}

static void report_laws(void)
{
    double small = absorbing_width(1.0 / 60, 0.98), large = absorbing_width(1.0 / 24, 0.98);
    report_title("The laws in closed form against the tables", NULL);
    report_most("t = 4/3 x / (1 + x/2), white, x .05 to 1: farthest", farthest(true, 0.05, 1), 0.02, 0.025);
    report_most("sigma = 1.13 x^.57, white, x .05 to 1: farthest", farthest(false, 0.05, 1), 0.05, 0.055);
    report_near("sigma0 / sqrt(l L), albedo .98, R/l 60", small, 0.98, 0.06);
    report_near("the same at R/l 24 over that", large / small, 1, 0.06);
}

// Mean reflectance for diffuse light of a smooth coat, as the material has it.
static double coat_reflectance(double eta)
{
    const int steps = 2000;
    ty_cdrf_def d = ty_cdrf_def_default();
    ty_material* material;
    ty_error error = {0};
    ty_shading_context context = {0};
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    double sum = 0.0;
    d.specular_weight = ty_input_scalar(1);
    d.specular_roughness = ty_input_scalar(0);
    d.specular_ior = (float)eta;
    if (ty_material_create_cdrf(&d, &material, &error) != TY_OK)
        return NAN;
    for (int i = 0; i < steps; i++)
    {
        float mu = sqrtf(((float)i + 0.5f) / (float)steps);
        ty_bsdf b;
        ty_bsdf_sample sample;
        ty_material_prepare(material, &context, &p, ty_vec3_make(sqrtf(1.0f - mu * mu), 0, mu), &b);
        ty_bsdf_take_coat(&b);
        if (ty_bsdf_sample_wi(&b, 0.5f, (ty_vec2){0.5f, 0.5f}, &sample))
            sum += (double)sample.weight.g / steps;
    }
    ty_material_destroy(material);
    return sum;
}

static void report_coat(void)
{
    static const double eta[4] = {1.33, 1.38, 1.45, 1.5}, outside[4] = {.066, .074, .084, .092},
                        inside[4] = {.472, .514, .565, .596};
    report_title("A smooth coat: mean reflectance for diffuse light from outside, and from within", NULL);
    for (int i = 0; i < 4; i++)
    {
        char name[60];
        double found = coat_reflectance(eta[i]);
        snprintf(name, sizeof name, "index %.2f, outside", eta[i]);
        report_near(name, found, outside[i], 0.001);
        snprintf(name, sizeof name, "index %.2f, within", eta[i]);
        report_near(name, 1.0 - (1.0 - found) / (eta[i] * eta[i]), inside[i], 0.002);
    }
}

void bench_laws(const bench_options* options)
{
    (void)options;
    report_normaliser();
    report_laws();
    report_coat();
}
