// SPDX-License-Identifier: Apache-2.0
// Guiding of walks in absorbing matter back to where light came in, after the exact solution for a half-space: A.
// Dwivedi 1982; J. Krivanek and E. d'Eon 2014, "A zero-variance-based sampling scheme for Monte Carlo subsurface
// scattering".
#pragma once
#include <tsuya/base/rng.h>
#include <tsuya/shading/walk.h>

typedef struct ty_guide
{
    ty_frame frame; // about the outward normal where light came in; world
    float share;    // of flights that are guided; 0 = none
    float fall;     // mean free path over diffusion length, 0 to 1
    float log;      // ln((1 + fall) / (1 - fall))
} ty_guide;

// One way of a walk: a direction and how the guide would have taken it.
typedef struct ty_guided
{
    ty_vec3 direction; // unit, world
    bool guided;       // chosen by the guide
    float stretch;     // of the extinction along it, if guided
    float ratio;       // density of the guide over that of the phase function
} ty_guided;

ty_guide ty_guide_make(const ty_scattering* matter, ty_vec3 normal);

ty_guided ty_guide_first(const ty_guide* guide, ty_vec3 direction, ty_rng* rng);
ty_guided ty_guide_next(const ty_guide* guide, const ty_scattering* matter, ty_vec3 direction, ty_rng* rng);
// Weighs beta for a flight over a distance that both ways of choosing could have made.
void ty_guide_weigh(const ty_guide* guide, const ty_scattering* matter, const ty_guided* way, float distance,
                    bool scattered, ty_rgb* beta);
