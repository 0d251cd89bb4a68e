// SPDX-License-Identifier: Apache-2.0
// Grains that took up more and more water, rendered under one directional light: how wide the terminator is.
#include "picture.h"
#include "report.h"
#include <math.h>
#include <stdio.h>
#include <tsuya/shading/cdrf.h>

#define PI 3.14159265358979323846
#define STATES 6 // A to F: 0 to 24 % of the raw mass
#define WIDTH 240
#define HEIGHT 4
#define RADIUS 1.2e-3

// Seen across the light, so that the position along the picture is the cosine of the angle from it.
static const char* const scene_text =
    "tsuya: 1\nfilm: { size: [240, 4], filter: box, filter_width: 1, half: false }\n"
    "camera: { projection: orthographic, ortho_height: %.9f, position: [0, 0, 0.1], look_at: [0, 0, 0] }\n"
    "render: { samples: %d, max_depth: 3 }\n"
    "assets:\n  grain: { shape: ellipsoid, size: [%.9f, %.9f, %.9f], divisions: %d }\n"
    "materials:\n  rice: { model: cdrf, color: 1, specular_weight: 0, moisture: { uptake: %.6f, cooked: 1 }, %s }\n"
    "objects:\n  - { mesh: grain, material: rice }\n"
    "lights:\n  - { type: directional, center: [1, 0, 0], target: [0, 0, 0], irradiance: 3.14159265 }\n";

typedef struct sweep
{
    const char *name, *evaluate;
    double size[3]; // semi-axes over RADIUS, the first along the light
    bool published; // kernel
    int samples;
} sweep;

static const sweep sweeps[] = {
    {"sphere, published", "evaluate: local, kernel: gaussian_published", {1, 1, 1}, true, 16},
    {"sphere, depth", "evaluate: depth", {1, 1, 1}, false, 256},
    {"grain, depth", "evaluate: depth", {1, 2.4, 1.1}, false, 256},
};

// Light along the picture, from the far side of the light to the near.
static void render_profile(const sweep* way, double uptake, const bench_options* options, ty_workers* workers,
                           double out[WIDTH])
{
    char text[2000];
    double seconds, ortho = 2.0 * RADIUS * way->size[0] * HEIGHT / WIDTH;
    int samples = options->quick ? way->samples / 8 : way->samples;
    snprintf(text, sizeof text, scene_text, ortho, samples, way->size[0] * RADIUS, way->size[1] * RADIUS,
             way->size[2] * RADIUS, options->quick ? 96 : 192, uptake, way->evaluate);
    picture_def def = {.path = "moisture", .text = text, .samples = samples, .seed = 3, .workers = workers};
    ty_exr* exr = picture_render(&def, &seconds);
    const float* g = picture_channel(exr, "G");
    for (int x = 0; x < WIDTH; x++)
    {
        out[x] = 0.0;
        for (int y = 0; y < HEIGHT; y++)
            out[x] += (double)g[y * WIDTH + x] / HEIGHT;
    }
    ty_exr_destroy(exr);
}

// Where the light last falls to this level on the way from the lit end, as an angle of a sphere from the light.
static double angle_at(const double profile[WIDTH], double level)
{
    int x = WIDTH - 1;
    while (x > 0 && profile[x - 1] > level)
        x--;
    double share = x > 0 ? (profile[x] - level) / (profile[x] - profile[x - 1]) : 0.0;
    return acos(fmin(fmax((x - share + 0.5) / WIDTH * 2.0 - 1.0, -1.0), 1.0)) * 180.0 / PI;
}

static double width_of(const double profile[WIDTH])
{
    double full = 0.0;
    for (int x = 0; x < WIDTH; x++)
        full = fmax(full, profile[x]);
    return angle_at(profile, 0.1 * full) - angle_at(profile, 0.5 * full);
}

static void kernel_profile(bool published, double spread, double out[WIDTH])
{
    for (int x = 0; x < WIDTH; x++)
    {
        float c = (float)((x + 0.5) / WIDTH * 2.0 - 1.0);
        out[x] = published ? (double)ty_cdrf_gaussian_published((float)spread, ty_acos(c))
                           : (double)ty_cdrf_poisson((float)spread, c);
    }
}

static double misfit(const double profile[WIDTH], double t)
{
    double kernel[WIDTH], dot = 0.0, square = 0.0, sum = 0.0;
    kernel_profile(false, t, kernel);
    for (int x = 0; x < WIDTH; x++)
    {
        dot += kernel[x] * profile[x];
        square += kernel[x] * kernel[x];
    }
    for (int x = 0; x < WIDTH; x++)
        sum += (profile[x] - dot / square * kernel[x]) * (profile[x] - dot / square * kernel[x]);
    return sum;
}

// Of what is noisy: the width of the Poisson kernel that fits best, by golden section.
static double fitted_width(const double profile[WIDTH])
{
    const double g = 0.6180339887498949;
    double low = 0.01, high = 2.0, kernel[WIDTH];
    for (int i = 0; i < 30; i++)
    {
        double c = high - g * (high - low), d = low + g * (high - low);
        if (misfit(profile, c) < misfit(profile, d))
            high = d;
        else
            low = c;
    }
    kernel_profile(false, 0.5 * (low + high), kernel);
    return width_of(kernel);
}

static void report_sweep(const sweep* way, const bench_options* options, ty_workers* workers)
{
    double before = 0.0, least_growth = 1e9;
    char name[100];
    for (int i = 0; i < STATES; i++)
    {
        double profile[WIDTH], uptake = 0.24 * i / (STATES - 1), w = (0.145 + uptake) / (1.0 + uptake);
        ty_moisture_optics o = ty_moisture_optics_make((ty_moisture){ty_moisture_wet_basis((float)uptake), 1});
        render_profile(way, uptake, options, workers, profile);
        double width = way->published ? width_of(profile) : fitted_width(profile), sigma = (double)o.gaussian_sigma,
               l = (double)o.mean_free_path;
        printf("  %-18s %c  uptake %4.1f %%  w %.4f  l %.4f mm  sigma0 %.4f mm   terminator %6.2f degrees\n", way->name,
               'A' + i, 100 * uptake, w, 1e3 * l, 1e3 * sigma, width);
        if (i > 0)
            least_growth = fmin(least_growth, width - before);
        before = width;
        if (way->published)
        {
            snprintf(name, sizeof name, "%c: sigma0, mm", 'A' + i);
            report_near(name, 1e3 * sigma, exp(0.34 + 0.52 * log(w)), 0.0005);
        }
        if (way->size[1] > 1.0)
            continue; // no closed form
        double kernel[WIDTH],
            spread = way->published ? sigma / RADIUS : (double)ty_cdrf_poisson_t((float)(l / RADIUS), 0);
        kernel_profile(way->published, spread, kernel);
        snprintf(name, sizeof name, "%s, %c: terminator, degrees", way->name, 'A' + i);
        report_near(name, width, width_of(kernel), way->published ? 0.3 : 1.0);
    }
    snprintf(name, sizeof name, "%s: least growth from one to the next, degrees", way->name);
    report_least(name, least_growth, 1, 0.5);
}

void bench_moisture(const bench_options* options)
{
    ty_workers* workers;
    ty_error error;
    if (ty_workers_create(options->threads, &workers, &error) != TY_OK)
        workers = NULL;
    report_title("Moisture: grains that took up water under one light, cooked: from half of the most light to a tenth",
                 "  (angles of a sphere whose outline that of the grain is)");
    for (size_t i = 0; i < sizeof sweeps / sizeof *sweeps; i++)
        report_sweep(&sweeps[i], options, workers);
    ty_workers_destroy(workers);
}
