// SPDX-License-Identifier: Apache-2.0
// Kernels fitted to walks in spheres, by their Legendre coefficients.
#include <tsuya/base/math.h>
#include <tsuya/shading/calibrate.h>

#define NODES 256 // of cos theta, equal areas

// Coefficients of max(cos, 0) = sum a_l P_l.
static void lambert_coefficients(double a[TY_SPHERE_DEGREES])
{
    double moment = 0.125; // integral of x P_l over 0..1 at even l
    a[0] = 0.25;
    a[1] = 0.5;
    for (int l = 2; l < TY_SPHERE_DEGREES; l++)
    {
        a[l] = l % 2 == 0 ? (l + 0.5) * moment : 0.0;
        moment *= l % 2 == 0 ? -(l - 1.0) / (l + 4.0) : 1.0;
    }
}

// The mean of P_l^2 over the sphere is 1 / (2l + 1).
double ty_sphere_error_poisson(const ty_sphere_walk* walk, double t)
{
    double a[TY_SPHERE_DEGREES], gain = (double)ty_exp((float)-t), power = 1.0, sum = 0.0;
    lambert_coefficients(a);
    for (int l = 1; l < TY_SPHERE_DEGREES; l++)
    {
        power *= gain;
        double e = a[l] * (walk->moments[l] / walk->moments[0] - power);
        sum += e * e / (2 * l + 1);
    }
    return sqrt(sum);
}

static double response(const ty_sphere_walk* walk, const double* a, double x)
{
    double before = 1.0, now = x, sum = a[0] + a[1] * walk->moments[1] / walk->moments[0] * x;
    for (int l = 2; l < TY_SPHERE_DEGREES; l++)
    {
        double next = ((2 * l - 1) * x * now - (l - 1) * before) / l;
        before = now;
        now = next;
        sum += a[l] * walk->moments[l] / walk->moments[0] * next;
    }
    return sum;
}

static double error_of(const ty_sphere_walk* walk, double sigma, float (*model)(float, float))
{
    double a[TY_SPHERE_DEGREES], sum = 0.0;
    lambert_coefficients(a);
    for (int i = 0; i < NODES; i++)
    {
        double x = (2.0 * i + 1.0) / NODES - 1.0;
        double e = response(walk, a, x) - (double)model((float)sigma, ty_acos((float)x));
        sum += e * e;
    }
    return sqrt(sum / NODES);
}

double ty_sphere_error_gaussian(const ty_sphere_walk* walk, double sigma)
{
    return error_of(walk, sigma, ty_cdrf_gaussian);
}

double ty_sphere_error_published(const ty_sphere_walk* walk, double sigma)
{
    return error_of(walk, sigma, ty_cdrf_gaussian_published);
}

// Golden section: the errors have one minimum.
static double least(const ty_sphere_walk* walk, double (*error)(const ty_sphere_walk*, double), double low, double high)
{
    const double ratio = 0.6180339887498949;
    double a = high - ratio * (high - low), b = low + ratio * (high - low), ea = error(walk, a), eb = error(walk, b);
    for (int i = 0; i < 40; i++)
        if (ea < eb)
        {
            high = b;
            b = a;
            eb = ea;
            a = high - ratio * (high - low);
            ea = error(walk, a);
        }
        else
        {
            low = a;
            a = b;
            ea = eb;
            b = low + ratio * (high - low);
            eb = error(walk, b);
        }
    return 0.5 * (low + high);
}

double ty_sphere_fit_poisson(const ty_sphere_walk* walk)
{
    return least(walk, ty_sphere_error_poisson, 0.0, 8.0);
}

double ty_sphere_fit_gaussian(const ty_sphere_walk* walk)
{
    return least(walk, ty_sphere_error_gaussian, 0.0, 3.0);
}
