// SPDX-License-Identifier: Apache-2.0
// Moisture as a state: how wet and how cooked. Its optical law is in shading, its mechanical law in generate.
#pragma once

typedef struct ty_moisture
{
    float wet_basis; // mass of water / total mass, 0.05..1; raw rice .145, soaked .31, cooked .62
    float cooked;    // degree of gelatinisation, 0..1
} ty_moisture;

// How a state is written in a scene or recipe: either wet_basis, or soaking with time and temperature.
typedef struct ty_moisture_def
{
    float wet_basis;    // >= 0: given outright; < 0: follow the soaking
    float soak_minutes; // >= 0
    float soak_celsius; // 0..60
    float cooked;       // 0..1; < 0: 1 above a wet basis of .45, 0 below .31, linear between
} ty_moisture_def;

ty_moisture_def ty_moisture_def_default(void); // cooked rice: .62, cooked 1

// Water taken up per raw mass after soaking: u(t,T) = .24 (1 - exp(-t/tau)), tau = 17 min * 1.45^((10-T)/10).
float ty_moisture_uptake(float minutes, float celsius);

// w = (.145 + u) / (1 + u); clamped to at least .05.
float ty_moisture_wet_basis(float uptake);
float ty_moisture_uptake_of(float wet_basis); // its inverse; negative where dried below raw; wet_basis < 1

// After soaking, cooking adds water up to the cooked wet basis .62 in proportion to cooked (< 0: not cooked, for
// soaking alone gelatinises nothing). A wet basis given outright stays as it is. Out-of-range values are clamped.
ty_moisture ty_moisture_make(const ty_moisture_def* def);
