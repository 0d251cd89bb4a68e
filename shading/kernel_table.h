// SPDX-License-Identifier: Apache-2.0
// Closed forms by cosine, and the Poisson kernel's response as a table for the hot path.
#pragma once
#include <tsuya/base/math.h>

// Published Gaussian response and its integral over the sphere, by cosine.
float ty_cdrf_gaussian_cos(float sigma, float cos_theta);

// Share of the kernel's integral below the horizon, by spread as the table below has it.
float ty_cdrf_spread_below(int kernel, float spread);

typedef struct ty_poisson_table ty_poisson_table; // opaque, const after creation

ty_poisson_table* ty_poisson_table_create(void);        // about 15 ms
void ty_poisson_table_destroy(ty_poisson_table* table); // NULL is allowed

// ty_cdrf_poisson within 1e-4; drop = 1 - e^-t, 0..1.
float ty_poisson_table_at(const ty_poisson_table* table, float drop, float cos_theta);

// Spread by curvature * mean free path and loss, without logarithms: 1 - e^-t of the Poisson kernel, sigma of the
// Gaussian ones.
typedef struct ty_spread_table ty_spread_table; // opaque, const after creation

ty_spread_table* ty_spread_table_create(int kernel);  // ty_cdrf_kernel; about 1 ms
void ty_spread_table_destroy(ty_spread_table* table); // NULL is allowed
float ty_spread_table_at(const ty_spread_table* table, float x, float loss);
