// SPDX-License-Identifier: Apache-2.0
// Response of a sphere to one directional light under the Poisson and the wrapped Gaussian kernel.
#include "kernel_table.h"
#include <tsuya/base/memory.h>
#include <tsuya/shading/cdrf.h>
#include <tsuya/shading/material.h>

#define MAX_DEGREE 4000
#define GAIN_NODES 80    // at gain = 1 - (i / 79)^2: the response changes like t ln t near t = 0
#define COSINE_NODES 257 // at cos = s |s|, s in [-1, 1]: dense about the terminator
#define SMALL_SIGMA 0.02f

// out[i] = sum a_l gain^l P_l(x[i]): the harmonic function in the unit ball, at radius `gain`, whose boundary values
// are max(cos, 0). a_l = (2l+1)/2 integral_0^1 x P_l, zero for odd l > 1. At most COSINE_NODES values.
static void poisson_response(double gain, const double* x, int count, double* out)
{
    double p0[COSINE_NODES], p1[COSINE_NODES], moment = 0.125, power = gain * gain;
    for (int i = 0; i < count; i++)
    {
        p0[i] = 1.0;
        p1[i] = x[i];
        out[i] = 0.25 + 0.5 * gain * x[i];
    }
    for (int l = 2; l <= MAX_DEGREE && power > 1e-9; l++, power *= gain)
    {
        double a = (2.0 * l - 1.0) / l, b = (l - 1.0) / l, c = l % 2 == 0 ? (l + 0.5) * moment * power : 0.0;
        for (int i = 0; i < count; i++)
        {
            double p2 = a * x[i] * p1[i] - b * p0[i];
            p0[i] = p1[i];
            p1[i] = p2;
            out[i] += c * p2;
        }
        if (l % 2 == 0)
            moment *= -(l - 1.0) / (l + 4.0);
    }
}

float ty_cdrf_poisson(float t, float cos_theta)
{
    double x = (double)ty_clamp(cos_theta, -1.0f, 1.0f), value;
    if (t <= 0.0f)
        return ty_max((float)x, 0.0f);
    poisson_response((double)ty_exp(-t), &x, 1, &value);
    return ty_max((float)value, 0.0f);
}

struct ty_poisson_table
{
    float values[GAIN_NODES][COSINE_NODES];
};

ty_poisson_table* ty_poisson_table_create(void)
{
    ty_poisson_table* table = TY_ALLOC(ty_poisson_table, 1);
    double x[COSINE_NODES], row[COSINE_NODES];
    for (int i = 0; i < COSINE_NODES; i++)
    {
        double s = 2.0 * i / (COSINE_NODES - 1) - 1.0;
        x[i] = s < 0.0 ? -s * s : s * s;
    }
    for (int g = 0; g < GAIN_NODES; g++)
    {
        double s = (double)g / (GAIN_NODES - 1);
        if (g > 0)
            poisson_response(1.0 - s * s, x, COSINE_NODES, row);
        for (int i = 0; i < COSINE_NODES; i++)
        {
            double value = g > 0 ? row[i] : x[i];
            table->values[g][i] = value > 0.0 ? (float)value : 0.0f;
        }
    }
    return table;
}

void ty_poisson_table_destroy(ty_poisson_table* table)
{
    ty_free(table);
}

float ty_poisson_table_at(const ty_poisson_table* table, float drop, float cos_theta)
{
    float y = sqrtf(ty_clamp(drop, 0.0f, 1.0f)) * (GAIN_NODES - 1);
    float s = copysignf(sqrtf(ty_min(fabsf(cos_theta), 1.0f)), cos_theta);
    float x = (s + 1.0f) * (0.5f * (COSINE_NODES - 1));
    int j = (int)y < GAIN_NODES - 1 ? (int)y : GAIN_NODES - 2,
        i = (int)x < COSINE_NODES - 1 ? (int)x : COSINE_NODES - 2;
    // Within a cell the response is nearly linear in cos, not in s.
    float s0 = (float)i * (2.0f / (COSINE_NODES - 1)) - 1.0f, s1 = s0 + 2.0f / (COSINE_NODES - 1);
    float c0 = s0 * fabsf(s0), c1 = s1 * fabsf(s1), fx = ty_clamp((cos_theta - c0) / (c1 - c0), 0.0f, 1.0f);
    const float *a = table->values[j], *b = table->values[j + 1];
    return ty_lerp(ty_lerp(a[i], a[i + 1], fx), ty_lerp(b[i], b[i + 1], fx), y - (float)j);
}

// E[max(sin v, 0)] for v ~ N(u, sigma^2), both small: sin v = v - v^3/6, with the moments of the positive part.
static float gaussian_near_terminator(float sigma, float cos_theta)
{
    float c2 = cos_theta * cos_theta, u = cos_theta * (1.0f + c2 * (1.0f / 6.0f + c2 * 0.075f)), s2 = sigma * sigma;
    float density = 0.398942280f * ty_exp(-0.5f * u * u / s2), below = 0.5f * (1.0f + ty_erf(u * 0.707106781f / sigma));
    float first = u * below + sigma * density;
    float third = u * (u * u + 3.0f * s2) * below + sigma * (u * u + 2.0f * s2) * density;
    return first - third / 6.0f;
}

// Wrapped Gaussian over max(cos, 0): its Fourier series (Kubo et al. 2010 convolve numerically).
float ty_cdrf_gaussian_cos(float sigma, float cos_theta)
{
    if (sigma < SMALL_SIGMA)
    {
        if (sigma <= 0.0f || fabsf(cos_theta) > 8.0f * sigma)
            return ty_max(cos_theta, 0.0f) * ty_exp(-0.5f * sigma * sigma);
        return ty_max(gaussian_near_terminator(sigma, cos_theta), 0.0f);
    }
    float two_cos = 2.0f * (2.0f * cos_theta * cos_theta - 1.0f), before = 1.0f, cosine = 0.5f * two_cos;
    float q = ty_exp(-2.0f * sigma * sigma), power = q, step = q * q * q, sum = 0.0f, sign = 1.0f;
    for (int k = 1; power > 1e-7f; k++)
    {
        sum += sign * power * cosine / (4.0f * (float)k * (float)k - 1.0f);
        float next = two_cos * cosine - before;
        before = cosine;
        cosine = next;
        power *= step;
        step *= q * q;
        sign = -sign;
    }
    float f = TY_INV_PI + 0.5f * ty_exp(-0.5f * sigma * sigma) * cos_theta + 2.0f * TY_INV_PI * sum;
    return ty_max(f, 0.0f);
}

float ty_cdrf_gaussian_published(float sigma, float theta)
{
    return ty_cdrf_gaussian_cos(sigma, ty_cos(theta));
}

float ty_cdrf_gaussian_integral(float sigma)
{
    float q = ty_exp(-2.0f * sigma * sigma), power = q, step = q * q * q, sum = 0.0f, sign = -1.0f;
    for (int k = 1; k <= 32 && power > 1e-8f; k++)
    {
        float d = 4.0f * (float)k * (float)k - 1.0f;
        sum += sign * power / (d * d);
        power *= step;
        step *= q * q;
        sign = -sign;
    }
    return 4.0f + 8.0f * sum;
}

float ty_cdrf_gaussian(float sigma, float theta)
{
    return ty_cdrf_gaussian_published(sigma, theta) * (TY_PI / ty_cdrf_gaussian_integral(sigma));
}

// Only l = 0 and 1 differ between the hemispheres: the even l > 0 integrate to zero over each, the odd l > 1 are
// absent.
float ty_cdrf_spread_below(int kernel, float spread)
{
    if (kernel == TY_CDRF_POISSON)
        return 0.5f * spread;
    float mean = TY_PI * ty_exp(-0.5f * spread * spread) / ty_cdrf_gaussian_integral(spread);
    return ty_clamp(0.5f * (1.0f - mean), 0.0f, 0.5f);
}

float ty_cdrf_share_below(int kernel, float spread)
{
    return ty_cdrf_spread_below(kernel, kernel == TY_CDRF_POISSON ? 1.0f - ty_exp(-ty_max(spread, 0.0f)) : spread);
}
