// SPDX-License-Identifier: Apache-2.0
// The filters of FLIP as separable passes; every kernel of the paper is a sum of products of functions of x and of y.
#include "flip_filter.h"
#include <math.h>
#include <tsuya/base/math.h>

typedef enum kernel
{
    KERNEL_ACHROMATIC,
    KERNEL_RED_GREEN,
    KERNEL_BLUE_YELLOW_A,
    KERNEL_BLUE_YELLOW_B,
    KERNEL_SMOOTH, // the Gaussian across a feature
    KERNEL_EDGE,   // its first derivative
    KERNEL_POINT,  // its second
} kernel;

// Widths b of the Gaussians exp(-pi^2 d^2 / b), d in degrees, and amplitudes a (table 1 of the paper).
static const double widths[4] = {0.0047, 0.0053, 0.04, 0.025};
static const double amplitudes[2] = {34.1, 13.5};
#define WIDEST 0.04
// The peak-to-trough distance of the edge detector of the eye, degrees.
#define FEATURE_WIDTH 0.082
#define PI 3.14159265358979323846

// White of D65 in XYZ is what the matrix makes of (1, 1, 1).
static const float to_xyz[3][3] = {{0.41238656f, 0.35759149f, 0.18045049f},
                                   {0.21263682f, 0.71518298f, 0.07218020f},
                                   {0.01933062f, 0.11919716f, 0.95037259f}};
static const float from_xyz[3][3] = {{3.24100326f, -1.53739897f, -0.49861587f},
                                     {-0.96922425f, 1.87592999f, 0.04155422f},
                                     {0.05563942f, -0.20401120f, 1.05714898f}};
static const float white[3] = {0.95042854f, 1.0f, 1.08890037f};

static double scale_to(float* weights, int radius, double sum)
{
    for (int i = 0; i <= 2 * radius; i++)
        weights[i] = (float)((double)weights[i] / sum);
    return sum;
}

static double gaussian(float* weights, int radius, double exponent)
{
    double sum = 0.0;
    for (int x = -radius; x <= radius; x++)
    {
        double value = exp(exponent * x * x);
        weights[x + radius] = (float)value;
        sum += value;
    }
    return scale_to(weights, radius, sum);
}

// Positive weights sum to 1, negative ones to -1: a step or a spot of full contrast answers with 1.
static void normalize_signs(float* weights, int radius)
{
    double positive = 0.0, negative = 0.0;
    for (int i = 0; i <= 2 * radius; i++)
        *(weights[i] > 0.0f ? &positive : &negative) += fabs((double)weights[i]);
    for (int i = 0; i <= 2 * radius; i++)
        weights[i] = (float)((double)weights[i] / (weights[i] > 0.0f ? positive : negative));
}

void ty_flip_kernels_make(float ppd, ty_flip_kernels* out)
{
    double pixels = (double)ppd, deviation = 0.5 * FEATURE_WIDTH * pixels;
    int radius = out->contrast_radius = (int)ceil(3.0 * sqrt(WIDEST / (2.0 * PI * PI)) * pixels);
    TY_ASSERT(radius <= TY_FLIP_RADIUS_MAX);
    double sums[4];
    for (int i = 0; i < 4; i++)
        sums[i] = gaussian(out->weights[i], radius, -PI * PI / (pixels * pixels * widths[i]));
    double shares[2];
    for (int i = 0; i < 2; i++)
        shares[i] = amplitudes[i] * sqrt(PI / widths[2 + i]) * sums[2 + i] * sums[2 + i];
    for (int i = 0; i < 2; i++)
        out->blue_yellow[i] = (float)(shares[i] / (shares[0] + shares[1]));

    radius = out->feature_radius = (int)ceil(3.0 * deviation);
    TY_ASSERT(radius <= TY_FLIP_RADIUS_MAX);
    gaussian(out->weights[KERNEL_SMOOTH], radius, -0.5 / (deviation * deviation));
    for (int x = -radius; x <= radius; x++)
    {
        double g = exp(-0.5 * x * x / (deviation * deviation));
        out->weights[KERNEL_EDGE][x + radius] = (float)(-x * g);
        out->weights[KERNEL_POINT][x + radius] = (float)((x * x / (deviation * deviation) - 1.0) * g);
    }
    normalize_signs(out->weights[KERNEL_EDGE], radius);
    normalize_signs(out->weights[KERNEL_POINT], radius);
}

static void multiply(const float matrix[3][3], const float v[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = matrix[i][0] * v[0] + matrix[i][1] * v[1] + matrix[i][2] * v[2];
}

void ty_flip_opponent(const float rgb[3], float out[3])
{
    float xyz[3];
    multiply(to_xyz, rgb, xyz);
    float x = xyz[0] / white[0], y = xyz[1], z = xyz[2] / white[2];
    out[0] = 116.0f * y - 16.0f;
    out[1] = 500.0f * (x - y);
    out[2] = 200.0f * (y - z);
}

static float lab_curve(float t)
{
    const float delta = 6.0f / 29.0f;
    return t > delta * delta * delta ? ty_pow(t, 1.0f / 3.0f) : t / (3.0f * delta * delta) + 4.0f / 29.0f;
}

void ty_flip_lab(const float opponent[3], float out[3])
{
    float y = (opponent[0] + 16.0f) / 116.0f;
    float xyz[3] = {(opponent[1] / 500.0f + y) * white[0], y, (y - opponent[2] / 200.0f) * white[2]}, rgb[3];
    multiply(from_xyz, xyz, rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = ty_clamp(rgb[i], 0.0f, 1.0f);
    multiply(to_xyz, rgb, xyz);
    float fx = lab_curve(xyz[0] / white[0]), fy = lab_curve(xyz[1]), fz = lab_curve(xyz[2] / white[2]);
    out[0] = 116.0f * fy - 16.0f;
    out[1] = 0.01f * out[0] * 500.0f * (fx - fy);
    out[2] = 0.01f * out[0] * 200.0f * (fy - fz);
}

// --- passes ---

// Strips of this many columns are summed at a time, weight by weight: the order of the sum of each pixel is that of the
// weights, and the compiler sees plain rows.
enum
{
    STRIP = 64,
};

static int clamp_index(int i, int count)
{
    return i < 0 ? 0 : i >= count ? count - 1 : i;
}

static void add_scaled(const float* restrict from, float weight, int count, float* restrict sum)
{
    for (int x = 0; x < count; x++)
        sum[x] += weight * from[x];
}

static void filter_row(const float* row, int width, const float* weights, int radius, float scale, float offset,
                       float* out)
{
    float padded[STRIP + 2 * TY_FLIP_RADIUS_MAX];
    for (int x0 = 0; x0 < width; x0 += STRIP)
    {
        int count = width - x0 < STRIP ? width - x0 : STRIP;
        float sum[STRIP] = {0.0f};
        for (int i = 0; i < count + 2 * radius; i++)
            padded[i] = row[clamp_index(x0 + i - radius, width)];
        for (int k = 0; k <= 2 * radius; k++)
            add_scaled(padded + k, weights[k], count, sum);
        for (int x = 0; x < count; x++)
            out[x0 + x] = sum[x] * scale + offset;
    }
}

// Rows of the seven products; features look at relative luminance, which is (Y + 16) / 116.
static void horizontal(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    static const int from[TY_FLIP_PASS_COUNT] = {0, 1, 2, 2, 0, 0, 0};
    const ty_flip_filter* filter = context;
    const ty_flip_kernels* kernels = filter->kernels;
    for (int64_t y = begin; y < end; y++)
        for (int i = 0; i < TY_FLIP_PASS_COUNT; i++)
        {
            bool feature = i >= KERNEL_SMOOTH;
            float offset = i == KERNEL_SMOOTH ? 16.0f / 116.0f : 0.0f; // the others' weights sum to 0
            filter_row(filter->opponent[from[i]] + y * filter->width, filter->width, kernels->weights[i],
                       feature ? kernels->feature_radius : kernels->contrast_radius, feature ? 1.0f / 116.0f : 1.0f,
                       offset, filter->passes[i] + y * filter->width);
        }
}

typedef enum product
{
    PRODUCT_ACHROMATIC,
    PRODUCT_RED_GREEN,
    PRODUCT_BLUE_YELLOW_A,
    PRODUCT_BLUE_YELLOW_B,
    PRODUCT_EDGE_X,
    PRODUCT_EDGE_Y,
    PRODUCT_POINT_X,
    PRODUCT_POINT_Y,
    PRODUCT_COUNT
} product;

// What runs along x and what along y.
static const kernel products[PRODUCT_COUNT][2] = {
    {KERNEL_ACHROMATIC, KERNEL_ACHROMATIC},
    {KERNEL_RED_GREEN, KERNEL_RED_GREEN},
    {KERNEL_BLUE_YELLOW_A, KERNEL_BLUE_YELLOW_A},
    {KERNEL_BLUE_YELLOW_B, KERNEL_BLUE_YELLOW_B},
    {KERNEL_EDGE, KERNEL_SMOOTH},
    {KERNEL_SMOOTH, KERNEL_EDGE},
    {KERNEL_POINT, KERNEL_SMOOTH},
    {KERNEL_SMOOTH, KERNEL_POINT},
};

static void filter_columns(const ty_flip_filter* filter, int x0, int count, int y, float sum[PRODUCT_COUNT][STRIP])
{
    const ty_flip_kernels* kernels = filter->kernels;
    for (int p = 0; p < PRODUCT_COUNT; p++)
    {
        int radius = p >= PRODUCT_EDGE_X ? kernels->feature_radius : kernels->contrast_radius;
        const float* weights = kernels->weights[products[p][1]];
        for (int x = 0; x < count; x++)
            sum[p][x] = 0.0f;
        for (int k = 0; k <= 2 * radius; k++)
        {
            int64_t row = clamp_index(y + k - radius, filter->height);
            add_scaled(filter->passes[products[p][0]] + row * filter->width + x0, weights[k], count, sum[p]);
        }
    }
}

static float length2(float x, float y)
{
    return sqrtf(x * x + y * y);
}

static void finish_pixel(const ty_flip_filter* filter, const float sum[PRODUCT_COUNT][STRIP], int x, int64_t at)
{
    const float* shares = filter->kernels->blue_yellow;
    const float opponent[3] = {sum[PRODUCT_ACHROMATIC][x], sum[PRODUCT_RED_GREEN][x],
                               shares[0] * sum[PRODUCT_BLUE_YELLOW_A][x] + shares[1] * sum[PRODUCT_BLUE_YELLOW_B][x]};
    float lab[3];
    ty_flip_lab(opponent, lab);
    for (int i = 0; i < 3; i++)
        filter->planes[i][at] = lab[i];
    filter->planes[TY_FLIP_EDGE][at] = length2(sum[PRODUCT_EDGE_X][x], sum[PRODUCT_EDGE_Y][x]);
    filter->planes[TY_FLIP_POINT][at] = length2(sum[PRODUCT_POINT_X][x], sum[PRODUCT_POINT_Y][x]);
}

static void vertical(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const ty_flip_filter* filter = context;
    float sum[PRODUCT_COUNT][STRIP];
    for (int64_t y = begin; y < end; y++)
        for (int x0 = 0; x0 < filter->width; x0 += STRIP)
        {
            int count = filter->width - x0 < STRIP ? filter->width - x0 : STRIP;
            filter_columns(filter, x0, count, (int)y, sum);
            for (int x = 0; x < count; x++)
                finish_pixel(filter, (const float(*)[STRIP])sum, x, y * filter->width + x0 + x);
        }
}

void ty_flip_filter_run(const ty_flip_filter* filter, ty_workers* workers)
{
    ty_flip_filter job = *filter;
    ty_parallel_for(workers, filter->height, 8, horizontal, &job);
    ty_parallel_for(workers, filter->height, 8, vertical, &job);
}
