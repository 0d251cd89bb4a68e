// SPDX-License-Identifier: Apache-2.0
// Statistics of directions: chi-squared of samples against their density, and means over the sphere.
#pragma once
#include "base/cmocka_all.h"
#include <math.h>
#include <string.h>
#include <tsuya/base/rng.h>
#include <tsuya/shading/material.h>
#include <tsuya/shading/sampling.h>

static inline void assert_near_at(double value, double expected, double tolerance, const char* file, int line)
{
    if (!(fabs(value - expected) <= tolerance))
    {
        print_error("%.8g is not %.8g +- %.2g\n", value, expected, tolerance);
        _fail(file, line);
    }
}
#define assert_near(value, expected, tolerance) assert_near_at((double)(value), expected, tolerance, __FILE__, __LINE__)

#define RINGS 24
#define SPOKES 16
#ifndef INNER
#define INNER 12 // quadrature points a cell and axis
#endif

// Cells about an axis, dense towards it: cos = 1 - 2 s^3 over rings of equal s.
typedef struct cells
{
    ty_frame frame;
    double density[RINGS][SPOKES]; // integral of the pdf
    double count[RINGS][SPOKES];
    double lost; // samples absorbed or delta
} cells;

static inline ty_vec3 cell_direction(const cells* c, double s, double phi)
{
    double z = 1.0 - 2.0 * s * s * s, r = sqrt(fmax(0.0, 1.0 - z * z));
    return ty_to_world(c->frame, ty_vec3_make((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z));
}

static inline void count_direction(cells* c, ty_vec3 w)
{
    ty_vec3 l = ty_to_local(c->frame, w);
    double s = cbrt(fmax(0.0, 0.5 * (1.0 - (double)l.z))), phi = atan2((double)l.y, (double)l.x) / (2 * M_PI);
    int ring = (int)fmin(s * RINGS, RINGS - 1), spoke = (int)((phi - floor(phi)) * SPOKES) % SPOKES;
    c->count[ring][spoke]++;
}

static inline double cell_density(const cells* c, const ty_bsdf* bsdf, int ring, int spoke)
{
    double sum = 0.0;
    for (int i = 0; i < INNER * INNER; i++)
    {
        double s = (ring + (i / INNER + 0.5) / INNER) / RINGS;
        double phi = (spoke + (i % INNER + 0.5) / INNER) / SPOKES * 2 * M_PI;
        float pdf;
        (void)ty_bsdf_eval(bsdf, cell_direction(c, s, phi), &pdf);
        sum += (double)pdf * 6.0 * s * s; // d cos / ds
    }
    return sum / (INNER * INNER) * (2 * M_PI / SPOKES) / RINGS;
}

// Chi-squared statistic over cells with at least 10 expected, in standard deviations from its mean.
static inline double chi_squared(const cells* c, double n)
{
    double chi = 0.0, expected_rest = n, count_rest = n;
    int cell_count = 1;
    for (int r = 0; r < RINGS; r++)
        for (int s = 0; s < SPOKES; s++)
        {
            double e = n * c->density[r][s];
            if (e < 10.0)
                continue;
            chi += (c->count[r][s] - e) * (c->count[r][s] - e) / e;
            expected_rest -= e;
            count_rest -= c->count[r][s];
            cell_count++;
        }
    // Everything else, the lost samples included, is one more cell.
    if (expected_rest > 10.0)
        chi += (count_rest - expected_rest) * (count_rest - expected_rest) / expected_rest;
    else
        chi += (count_rest - expected_rest) * (count_rest - expected_rest) / 10.0;
    return (chi - cell_count) / sqrt(2.0 * cell_count);
}

// Samples against pdf, weight * pdf against eval. axis: where the density peaks.
static inline void check_sampling(const ty_bsdf* bsdf, ty_vec3 axis, int n)
{
    static cells c;
    c = (cells){.frame = ty_frame_from_normal(ty_normalize(axis))};
    ty_rng rng = ty_rng_make((ty_seed){11}, 0, 0);
    for (int i = 0; i < n; i++)
    {
        ty_bsdf_sample s;
        float u = ty_rng_float(&rng), ux = ty_rng_float(&rng), pdf;
        if (!ty_bsdf_sample_wi(bsdf, u, (ty_vec2){ux, ty_rng_float(&rng)}, &s) || s.delta)
        {
            c.lost++;
            continue;
        }
        count_direction(&c, s.wi);
        ty_rgb f = ty_bsdf_eval(bsdf, s.wi, &pdf);
        assert_near(pdf / s.pdf, 1.0, 2e-3);
        assert_near(s.weight.g * s.pdf, (double)f.g, 2e-3 * (double)f.g + 1e-6);
        assert_near(s.weight.r * s.pdf, (double)f.r, 2e-3 * (double)f.r + 1e-6);
    }
    double total = 0.0;
    for (int r = 0; r < RINGS; r++)
        for (int s = 0; s < SPOKES; s++)
            total += c.density[r][s] = cell_density(&c, bsdf, r, s);
    assert_near(total, 1.0 - c.lost / n, 4.0 / sqrt((double)n) + 2e-3);
    double deviation = chi_squared(&c, n);
    if (deviation > 5.0)
        fail_msg("samples do not follow the pdf: chi-squared is %.1f standard deviations too large", deviation);
}

// Mean weight over a stratified set of samples: the directional albedo.
static inline ty_rgb mean_weight(const ty_bsdf* bsdf, int n)
{
    ty_rng rng = ty_rng_make((ty_seed){3}, 1, 0);
    double r = 0, g = 0, b = 0;
    for (int i = 0; i < n; i++)
    {
        ty_bsdf_sample s;
        float u = ((float)i + 0.5f) / (float)n; // the lobe, in proportion
        float ux = ty_rng_float(&rng);
        if (!ty_bsdf_sample_wi(bsdf, u, (ty_vec2){ux, ty_rng_float(&rng)}, &s))
            continue;
        r += (double)s.weight.r;
        g += (double)s.weight.g;
        b += (double)s.weight.b;
    }
    return ty_rgb_make((float)(r / n), (float)(g / n), (float)(b / n));
}

// A point of a plane with normal +z, seen at an angle (radians) from it; from below where the cosine is negative.
static inline ty_bsdf bsdf_at(const ty_material* material, double angle)
{
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    ty_bsdf b;
    ty_material_prepare(material, NULL, &p, ty_vec3_make((float)sin(angle), 0, (float)cos(angle)), &b);
    return b;
}

static inline ty_material* surface(const ty_surface_def* def)
{
    ty_material* m;
    ty_error error;
    assert_int_equal(ty_material_create_surface(def, &m, &error), TY_OK);
    return m;
}

// Power that goes from one direction to the other is the same both ways; across: through the boundary, below which
// there is that index.
static inline void check_reciprocal(const ty_surface_def* def, bool across, float index)
{
    ty_material* m = surface(def);
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}};
    ty_rng rng = ty_rng_make((ty_seed){9}, 0, 0);
    float scale = across ? index * index : 1.0f; // radiance is n^2 times denser there
    for (int i = 0; i < 2000; i++)
    {
        ty_vec3 w[2];
        ty_bsdf b[2];
        float pdf;
        for (int k = 0; k < 2; k++)
        {
            float ux = ty_rng_float(&rng);
            w[k] = ty_sample_cosine((ty_vec2){ux, ty_rng_float(&rng)});
            w[k].z = ty_max(w[k].z, 0.05f) * (k && across ? -1.0f : 1.0f);
            w[k] = ty_normalize(w[k]);
            ty_material_prepare(m, NULL, &p, w[k], &b[k]);
        }
        ty_rgb f = ty_rgb_scale(ty_bsdf_eval(&b[0], w[1], &pdf), 1.0f / fabsf(w[1].z));
        ty_rgb g = ty_rgb_scale(ty_bsdf_eval(&b[1], w[0], &pdf), scale / fabsf(w[0].z));
        assert_near(f.r, (double)g.r, 2e-3 * (double)g.r + 1e-5);
        assert_near(f.g, (double)g.g, 2e-3 * (double)g.g + 1e-5);
        assert_near(f.b, (double)g.b, 2e-3 * (double)g.b + 1e-5);
    }
    ty_material_destroy(m);
}

static inline ty_material* cdrf(const ty_cdrf_def* def)
{
    ty_material* m;
    ty_error error;
    assert_int_equal(ty_material_create_cdrf(def, &m, &error), TY_OK);
    return m;
}
