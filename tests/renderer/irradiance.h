// SPDX-License-Identifier: Apache-2.0
// Irradiance on a small white Lambert disc at the origin, facing +y, through the whole program: its radiance is E / pi.
#pragma once
#include "whole_program.h"
#include <math.h>

#define PI 3.14159265358979

// further: more keys of the disc's own entry, with a comma before; more: other objects, likewise.
typedef struct stage
{
    const char *lights, *assets, *materials, *objects, *disc, *render;
} stage;

static const char disc_scene[] = "tsuya: 1\n"
                                 "film: { size: [8, 8], filter: box, filter_width: 1, half: false }\n"
                                 "render: { samples: 256, max_depth: 1, seed: 11%s }\n"
                                 "camera: { position: [0, 1, 0.0001], look_at: [0, 0, 0], vfov: 0.04 }\n"
                                 "assets: { disc: { shape: disc, radius: 0.02 }%s }\n"
                                 "materials: { m: { model: surface, base_color: 1, specular_weight: 0 }%s }\n"
                                 "objects: [ { name: disc, mesh: disc, material: m%s }%s ]\n"
                                 "lights: [ %s ]\n";

static inline const char* or_nothing(const char* text)
{
    return text ? text : "";
}

static inline mean_error irradiance_on(const stage* s)
{
    static char text[1 << 16];
    int length = snprintf(text, sizeof text, disc_scene, or_nothing(s->render), or_nothing(s->assets),
                          or_nothing(s->materials), or_nothing(s->disc), or_nothing(s->objects), or_nothing(s->lights));
    assert_true(length > 0 && length < (int)sizeof text);
    ty_exr* exr = render_text(text);
    mean_error found = mean_over(exr, 0, 0, 7, 7);
    ty_exr_destroy(exr);
    return (mean_error){found.mean * PI, found.error * PI};
}

// precision: the largest relative standard error that 16,384 samples may leave.
static inline void check_stage(const stage* s, double expected, double precision)
{
    mean_error found = irradiance_on(s);
    print_message("%-110.110s E %.6f +- %.6f expected %.6f\n", or_nothing(s->lights), found.mean, found.error,
                  expected);
    // The disc is seen through a cone of 0.04 degrees: E varies over it by less than 1e-5 of itself.
    assert_true(fabs(found.mean - expected) <= 3.0 * found.error + 1e-5 * expected);
    assert_true(found.error <= precision * expected);
}

static inline void check_irradiance(const char* light, double expected)
{
    check_stage(&(stage){.lights = light}, expected, 0.02);
}

// View factor of a parallel rectangle with one corner over the disc: sides a, b at height h.
static inline double corner_factor(double a, double b, double h)
{
    double x = a / h, y = b / h;
    return (x / sqrt(1 + x * x) * atan(y / sqrt(1 + x * x)) + y / sqrt(1 + y * y) * atan(x / sqrt(1 + y * y))) /
           (2 * PI);
}
