// SPDX-License-Identifier: Apache-2.0
// How wide the kernels are: spread against x = curvature * transport mean free path, from random walks in white
// spheres.
#include <tsuya/shading/cdrf.h>

#define NODE_COUNT 11

// Natural logarithms of x = 1/60, .05, .0833, .125, .1667, .25, .333, .5, .667, 1, 2.
static const float log_x[NODE_COUNT] = {-4.0943446f, -2.9957323f, -2.4853067f, -2.0794415f, -1.7915595f, -1.3862944f,
                                        -1.0996128f, -0.6931472f, -0.4049653f, 0.0f,        0.6931472f};

// ln t of t = (4/3)/60, .064, .105, .155, .203, .294, .377, .528, .666, .890, 1.387.
static const float log_t[NODE_COUNT] = {-3.8066625f, -2.7488722f, -2.2537949f, -1.8643302f, -1.5945493f, -1.2241755f,
                                        -0.9755101f, -0.6386590f, -0.4064656f, -0.1165338f, 0.3271433f};

// ln sigma of sigma = .106, .210, .283, .357, .419, .527, .618, .775, .915, 1.135, 1.525.
static const float log_sigma[NODE_COUNT] = {-2.2443162f, -1.5606477f, -1.2623084f, -1.0300195f,
                                            -0.8698843f, -0.6405547f, -0.4812668f, -0.2548922f,
                                            -0.0888312f, 0.1266326f,  0.4219944f};

static float interpolate(const float* log_value, float x)
{
    float lx = ty_ln(x);
    int i = 0;
    while (i < NODE_COUNT - 2 && lx > log_x[i + 1])
        i++;
    return ty_exp(log_value[i] + (log_value[i + 1] - log_value[i]) * (lx - log_x[i]) / (log_x[i + 1] - log_x[i]));
}

float ty_cdrf_poisson_t(float x)
{
    // Exact diffusion below the table; its first node is on this line.
    return x < 1.0f / 60.0f ? ty_max(x, 0.0f) * (4.0f / 3.0f) : interpolate(log_t, x);
}

float ty_cdrf_gaussian_sigma(float x)
{
    return x > 0.0f ? interpolate(log_sigma, x) : 0.0f;
}
