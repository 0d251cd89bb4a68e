// SPDX-License-Identifier: Apache-2.0
// Environment lights: constant, or a latitude-longitude image sampled by luminance times solid angle.
// The image's centre lies towards -z and its right half towards +x; the top row is +y.
#include "light.h"
#include <tsuya/base/memory.h>

enum
{
    GRID_WIDTH = 2048,
    GRID_HEIGHT = 1024
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

// Mean luminance of the bilinear image over a cell of the grid, by regular lookups (2 x 2 is exact for one texel a
// cell).
static float cell_luminance(const ty_light* light, int x, int y, int width, int height)
{
    int n = 1 + (ty_texture_width(light->image) + width - 1) / width;
    float sum = 0.0f;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
        {
            ty_vec2 p = {((float)x + ((float)i + 0.5f) / (float)n) / (float)width,
                         ((float)y + ((float)j + 0.5f) / (float)n) / (float)height};
            float luminance = ty_luminance(image_lookup(light, p));
            sum += isfinite(luminance) && luminance > 0.0f ? luminance : 0.0f;
        }
    return sum / (float)(n * n);
}

void ty_light_environment_init(ty_light* light, const ty_light_def* def, const ty_texture* image)
{
    float s, c;
    ty_sincos(def->rotate, &s, &c);
    light->frame = (ty_frame){{c, 0.0f, -s}, {0.0f, 1.0f, 0.0f}, {s, 0.0f, c}};
    light->image = image;
    if (!image)
        return;
    int image_width = ty_texture_width(image), image_height = ty_texture_height(image);
    int width = image_width < GRID_WIDTH ? image_width : GRID_WIDTH;
    int height = image_height < GRID_HEIGHT ? image_height : GRID_HEIGHT;
    float* weights = TY_ALLOC(float, (size_t)width*(size_t)height);
    double sum = 0.0, sum_sqr = 0.0;
    for (int y = 0; y < height; ++y)
    {
        // The share of the sphere in this row, exactly: half the difference of the cosines at its borders.
        float share =
            0.5f * (ty_cos(TY_PI * (float)y / (float)height) - ty_cos(TY_PI * (float)(y + 1) / (float)height));
        for (int x = 0; x < width; ++x)
        {
            float luminance = cell_luminance(light, x, y, width, height);
            weights[(size_t)y * (size_t)width + (size_t)x] = luminance * share;
            sum += (double)luminance * (double)share / width;
            sum_sqr += (double)luminance * (double)luminance * (double)share / width;
        }
    }
    light->image_mean = (float)sum;
    if (sum > 0.0 && sum_sqr > (double)SMOOTH_CONTRAST * sum * sum)
        light->distribution = ty_distribution_create(weights, width, height);
    ty_free(weights);
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
