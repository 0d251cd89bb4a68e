// SPDX-License-Identifier: Apache-2.0
// Random walks in spheres, and the law of moisture that fits them best. For the command `calibrate` and tests.
#pragma once
#include <tsuya/base/params.h>
#include <tsuya/base/rng.h>
#include <tsuya/base/workers.h>
#include <tsuya/shading/cdrf.h>

enum
{
    TY_SPHERE_DEGREES = 49,
};

typedef struct ty_sphere_walk_def
{
    float optical_radius; // R / l, l the transport mean free path
    float albedo;         // of one scattering event of the equivalent isotropic medium, 0..1
    float anisotropy;     // g of Henyey and Greenstein's phase function, -.95...95; l is kept
    float ior;            // 1: light leaves freely; above, the boundary reflects from inside
    int walk_count;
    ty_seed seed;
} ty_sphere_walk_def;

// Light enters at a point, diffusely, and leaves elsewhere: moments[l] is the mean of weight * P_l(cos), cos that of
// the angle between both places. By rotation they tell the sphere's answer to any light.
typedef struct ty_sphere_walk
{
    double moments[TY_SPHERE_DEGREES]; // [0] is the albedo of the whole sphere
    double mean_scatterings;           // of a walk, weights left out
} ty_sphere_walk;

// The same numbers for any number of workers (NULL = this thread). False when cancelled.
bool ty_sphere_walk_run(const ty_sphere_walk_def* def, ty_workers* workers, ty_sphere_walk* out);

// Area-weighted RMS over the sphere between the walk under one directional light and a model, both per entered light; a
// fully lit Lambert point is 1.
double ty_sphere_error_poisson(const ty_sphere_walk* walk, double t);
double ty_sphere_error_gaussian(const ty_sphere_walk* walk, double sigma);
double ty_sphere_error_published(const ty_sphere_walk* walk, double sigma);
// The parameter of least error; t 0 is Lambert.
double ty_sphere_fit_poisson(const ty_sphere_walk* walk);
double ty_sphere_fit_gaussian(const ty_sphere_walk* walk);

// What is known of matter at one moisture.
typedef struct ty_optical_state
{
    float wet_basis;      // .05..1
    float cooked;         // 0..1
    float mean_free_path; // m, transport
    float albedo;         // as of ty_sphere_walk_def, and so on
    float anisotropy;
    float ior;
} ty_optical_state;

enum
{
    TY_CALIBRATION_MOST_STATES = 64,
    TY_CALIBRATION_MOST_RADII = 16,
};

typedef struct ty_calibration_def
{
    const ty_optical_state* states;
    const float* radii; // m
    int state_count, radius_count;
    int walk_count; // each
    ty_seed seed;
} ty_calibration_def;

// One sphere of one state.
typedef struct ty_calibration_row
{
    float x; // l / R
    float albedo, mean_scatterings;
    float t, sigma;                             // best for it alone
    float rms_poisson, rms_gaussian, rms_matte; // their errors, and Lambert's
    float rms_law, rms_published;               // those of the fitted law, by t and by sigma_0
} ty_calibration_row;

typedef struct ty_calibration_fit
{
    ty_calibration_row rows[TY_CALIBRATION_MOST_STATES][TY_CALIBRATION_MOST_RADII];
    float mean_free_path[TY_CALIBRATION_MOST_STATES]; // m, that answers best for all radii by the kernel's law t(l / R)
    float sigma_0[TY_CALIBRATION_MOST_STATES];        // m, likewise by the published sigma_0 / R
    ty_moisture_law law;                              // through all states; rms that of t
    float rms_published;
    float slope, bend; // t = slope x / (1 + bend x) over all rows
    float rms_t;       // relative, of that
} ty_calibration_fit;

// False when cancelled. What the states do not tell (raw lengths where all are cooked) stays as in the default law.
bool ty_calibration_run(const ty_calibration_def* def, ty_workers* workers, ty_calibration_fit* out);
