// SPDX-License-Identifier: Apache-2.0
// Environment lights: constant, or a latitude-longitude image sampled by luminance times solid angle.
// The image's centre lies towards -z and its right half towards +x; the top row is +y.
#include "light.h"
#include <tsuya/base/memory.h>

// Finest grid of directions. Every texel of an 8k image has its own cell, so that a sun of few texels is not lost in
// the sky around it.
enum
{
    GRID_WIDTH = 8192,
    GRID_HEIGHT = 4096
};

// Above this mean of L^2 over squared mean of L, sampling the image beats waiting for rays to find its bright places.
#define SMOOTH_CONTRAST 2.0f

static ty_vec3 direction_from_image(const ty_light* light, ty_vec2 p, float* sine)
{
    float s, c, azimuth_s, azimuth_c;
    ty_sincos(TY_PI * p.y, &s, &c);
    ty_sincos(2.0f * TY_PI * (p.x - 0.5f), &azimuth_s, &azimuth_c);
    *sine = s;
    return ty_to_world(light->frame, (ty_vec3){s * azimuth_s, c, -s * azimuth_c});
}

static ty_vec2 image_from_direction(const ty_light* light, ty_vec3 direction)
{
    ty_vec3 d = ty_to_local(light->frame, direction);
    float x = 0.5f + ty_atan2(d.x, -d.z) * (0.5f * TY_INV_PI);
    return (ty_vec2){ty_clamp(x, 0.0f, TY_ONE_MINUS_EPSILON),
                     ty_clamp(ty_acos(d.y) * TY_INV_PI, 0.0f, TY_ONE_MINUS_EPSILON)};
}

// Rows are not wrapped over the poles, whatever the texture's wrapping.
static ty_rgb image_lookup(const ty_light* light, ty_vec2 p)
{
    float margin = 0.5f / (float)ty_texture_height(light->image);
    return ty_texture_sample(light->image, (ty_vec2){p.x, ty_clamp(1.0f - p.y, margin, 1.0f - margin)});
}

ty_rgb ty_light_environment_radiance(const ty_light* light, ty_vec3 direction)
{
    if (!light->image)
        return light->value;
    return ty_rgb_mul(light->value, image_lookup(light, image_from_direction(light, direction)));
}

static float* texel_luminances(const ty_texture* image, int width, int height)
{
    float* out = TY_ALLOC(float, (size_t)width*(size_t)height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
        {
            float luminance = ty_luminance(ty_texture_texel(image, x, y));
            out[(size_t)y * (size_t)width + (size_t)x] = isfinite(luminance) && luminance > 0.0f ? luminance : 0.0f;
        }
    return out;
}

// Mean of the bilinear image over a texel: 3/4 of its own value and 1/8 of each neighbour's, in both directions.
static float texel_mean(const float* luminances, int width, int height, int x, int y)
{
    static const float weights[3] = {0.125f, 0.75f, 0.125f};
    float sum = 0.0f;
    for (int j = -1; j <= 1; ++j)
    {
        int row = y + j < 0 ? 0 : y + j < height ? y + j : height - 1;
        const float* r = luminances + (size_t)row * (size_t)width;
        sum += weights[j + 1] *
               (weights[0] * r[x ? x - 1 : width - 1] + weights[1] * r[x] + weights[2] * r[x + 1 < width ? x + 1 : 0]);
    }
    return sum;
}

// Mean luminance of each cell of the grid; texels count for the cell that holds their centre.
static float* cell_luminances(const ty_texture* image, int width, int height)
{
    int from_width = ty_texture_width(image), from_height = ty_texture_height(image);
    float* texels = texel_luminances(image, from_width, from_height);
    float* cells = TY_ALLOC(float, (size_t)width*(size_t)height);
    for (int y = 0; y < from_height; ++y)
        for (int x = 0; x < from_width; ++x)
        {
            size_t row = (size_t)((int64_t)y * height / from_height),
                   column = (size_t)((int64_t)x * width / from_width);
            cells[row * (size_t)width + column] += texel_mean(texels, from_width, from_height, x, y);
        }
    ty_free(texels);
    float share = (float)width / (float)from_width * ((float)height / (float)from_height);
    for (size_t i = 0; i < (size_t)width * (size_t)height; ++i)
        cells[i] *= share;
    return cells;
}

// Luminances become shares of the light: times the solid angle.
static void set_distribution(ty_light* light, float* cells, int width, int height)
{
    double sum = 0.0, sum_sqr = 0.0;
    for (int y = 0; y < height; ++y)
    {
        // The share of the sphere in this row, exactly: half the difference of the cosines at its borders.
        float share =
            0.5f * (ty_cos(TY_PI * (float)y / (float)height) - ty_cos(TY_PI * (float)(y + 1) / (float)height));
        float* row = cells + (size_t)y * (size_t)width;
        for (int x = 0; x < width; ++x)
        {
            sum += (double)row[x] * (double)share / width;
            sum_sqr += (double)row[x] * (double)row[x] * (double)share / width;
            row[x] *= share;
        }
    }
    light->image_mean = (float)sum;
    if (sum > 0.0 && sum_sqr > (double)SMOOTH_CONTRAST * sum * sum)
        light->distribution = ty_distribution_create(cells, width, height);
}

void ty_light_environment_init(ty_light* light, const ty_light_def* def, const ty_texture* image)
{
    ty_quat turn = ty_quat_multiply(ty_quat_axis_angle(ty_vec3_make(0.0f, 1.0f, 0.0f), def->rotate),
                                    ty_quat_euler(def->orientation));
    light->frame = (ty_frame){ty_quat_rotate(turn, ty_vec3_make(1.0f, 0.0f, 0.0f)),
                              ty_quat_rotate(turn, ty_vec3_make(0.0f, 1.0f, 0.0f)),
                              ty_quat_rotate(turn, ty_vec3_make(0.0f, 0.0f, 1.0f))};
    light->image = image;
    if (!image)
        return;
    int width = ty_texture_width(image), height = ty_texture_height(image);
    width = width < GRID_WIDTH ? width : GRID_WIDTH;
    height = height < GRID_HEIGHT ? height : GRID_HEIGHT;
    float* cells = cell_luminances(image, width, height);
    set_distribution(light, cells, width, height);
    ty_free(cells);
}

float ty_light_environment_mean(const ty_light* light)
{
    return ty_luminance(light->value) * (light->image ? light->image_mean : 1.0f);
}

bool ty_light_environment_sample(const ty_light* light, ty_vec2 u, ty_light_sample* out)
{
    float pdf, sine;
    ty_vec2 p = ty_distribution_sample(light->distribution, u, &pdf);
    *out = (ty_light_sample){.wi = direction_from_image(light, p, &sine), .distance = TY_FLOAT_MAX};
    if (!(sine > 0.0f))
        return false;
    out->radiance = ty_rgb_mul(light->value, image_lookup(light, p));
    out->pdf = pdf / (2.0f * TY_PI * TY_PI * sine);
    return true;
}

float ty_light_environment_pdf(const ty_light* light, ty_vec3 wi)
{
    ty_vec2 p = image_from_direction(light, wi);
    float sine = ty_sin(TY_PI * p.y);
    return sine > 0.0f ? ty_distribution_pdf(light->distribution, p) / (2.0f * TY_PI * TY_PI * sine) : 0.0f;
}
