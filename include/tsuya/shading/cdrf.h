// SPDX-License-Identifier: Apache-2.0
// Curvature reflectance: kernels on the sphere, their laws, and the moisture law. For the material, tests and tools.
#pragma once
#include <tsuya/base/math.h>
#include <tsuya/base/moisture.h>

// Poisson kernel parameter t against x = curvature * mean free path and loss = 1 - single-scattering albedo: table in
// their logarithms (random walks in spheres), linear in x below it and by its last slope above.
float ty_cdrf_poisson_t(float x, float loss);
// Normalised Gaussian's sigma, likewise, by the first slope below.
float ty_cdrf_gaussian_sigma(float x, float loss);
// 1 - single-scattering albedo of matter of which a thick piece gives back the share `color` of the light that entered
// it. internal: share of the diffuse light within that the boundary reflects back, 0 = none.
float ty_cdrf_loss(float color, float internal);

// E(theta) / E(lit Lambert point at 0): response of a sphere to one directional light at cos_theta.
float ty_cdrf_poisson(float t, float cos_theta);            // sum a_l e^(-l t) P_l, integral pi
float ty_cdrf_gaussian(float sigma, float theta);           // normalised: integral pi
float ty_cdrf_gaussian_published(float sigma, float theta); // integral I(sigma)
float ty_cdrf_gaussian_integral(float sigma);               // I(sigma)

// Share of the kernel's integral below the horizon.
float ty_cdrf_share_below(int kernel, float spread);

typedef struct ty_moisture_optics
{
    float mean_free_path; // m
    float gaussian_sigma; // sigma_0 in m (sigma = sigma_0 * curvature), the seed's linear law
    float film;           // 0..1 weight of the water film
    float water;          // 0..1 of free water above saturation: .31 raw, .62 cooked
    float roughness;      // of the specular coat
    float color_exponent; // the colour is that of the cooked state to this power
} ty_moisture_optics;

// What `tsuya calibrate` fits: lengths as power laws of the wet basis w, mixed in the log by `cooked`.
typedef struct ty_moisture_law
{
    float cooked_constant, cooked_exponent; // ln(l / mm) = constant + exponent ln w
    float raw_length, soaked_length;        // m, of uncooked grains at w = .145 and .31, by the log between
    float sigma_constant, sigma_exponent;   // ln(sigma_0 / mm), for the published form
    float rms;                              // of the fit, for whom it may concern; 0 = not known
} ty_moisture_law;

// l(w) = exp(.0736 + .9 ln w) mm for cooked; raw soaked .19 -> .10 mm over w .145 -> .31; sigma_0 = exp(.34 + .52 ln w)
// mm. The constants are ours (the paper leaves them out).
ty_moisture_law ty_moisture_law_default(void);
ty_moisture_optics ty_moisture_law_at(const ty_moisture_law* law, ty_moisture state);
ty_moisture_optics ty_moisture_optics_make(ty_moisture state); // by the default law

// Colour of a channel at a moisture.
float ty_moisture_color(const ty_moisture_optics* optics, float color);
