// SPDX-License-Identifier: Apache-2.0
// Random walks of light through scattering matter: within one closed instance, and the steps they are made of. For the
// material, tests and tools. Callable from any thread; nothing is allocated.
#pragma once
#include <tsuya/base/rng.h>
#include <tsuya/shading/material.h>

// Albedo of one scattering in a half-space whose diffuse reflectance is `color`, refractive indices matched: C. Kulla
// and A. Conty 2017 ("Revisiting physically based shading at Imageworks"). Colours stay within .002 up to .95.
float ty_walk_albedo(float color, float anisotropy);
// And back (H. C. van de Hulst 1980, "Multiple light scattering").
float ty_walk_color(float albedo, float anisotropy);

// Cosine between the directions before and after a scattering; u in [0,1).
float ty_phase_cosine(float anisotropy, float u);
float ty_phase_pdf(float anisotropy, float cosine); // per solid angle
ty_vec3 ty_phase_sample(float anisotropy, ty_vec3 direction, ty_vec2 u);

// What is left of light after a distance through matter (Beer's law): all of it in clear matter, however far that is.
// is.
ty_rgb ty_flight_transmittance(ty_rgb extinction, float distance);

// How far light goes before it is scattered; TY_FLOAT_MAX = for ever. Where channels differ, one of them decides, by
// its share of beta, and all densities count (A. Wilkie et al. 2014, "Hero wavelength spectral sampling").
float ty_flight_sample(const ty_scattering* matter, const ty_rgb* beta, float u_channel, float u);
// Weighs beta for a flight that ended in a scattering at a distance, or went past it.
void ty_flight_scatter(const ty_scattering* matter, float distance, ty_rgb* beta);
void ty_flight_pass(const ty_scattering* matter, float distance, ty_rgb* beta);
// Of faint walks some go on for all: beta below a quarter of what it was when they began. False = it ends.
bool ty_flight_survives(float began, ty_rgb* beta, ty_rng* rng);

#define TY_WALK_MAX_FLIGHTS 16384

typedef struct ty_walk
{
    ty_rgb beta;           // weight of what leaves
    ty_surface_point exit; // where
    ty_vec3 direction;     // into which, before the boundary does anything to it; unit, world
    uint32_t scatterings;
} ty_walk;

// A walk through the instance of x, that begins there, inwards along a unit direction in the world, and ends at the
// first crossing of the boundary to the outside. Other instances do not exist for it. u: for the length of its first
// flight. Of walk, what is beyond beta and scatterings is set when it left, or met the bound: it then leaves straight
// on.
ty_walk_end ty_walk_through(const ty_world* world, const ty_surface_point* x, const ty_scattering* matter,
                            ty_vec3 direction, float u, ty_rng* rng, ty_walk* walk);
// The same from a point within an instance.
ty_walk_end ty_walk_from(const ty_world* world, uint32_t object, uint32_t instance, float time, ty_vec3 origin,
                         const ty_scattering* matter, ty_vec3 direction, ty_rng* rng, ty_walk* walk);
