// SPDX-License-Identifier: Apache-2.0
// Closed forms by cosine, and the Poisson kernel's response as a table for the hot path.
#pragma once
#include <tsuya/base/math.h>

// Published Gaussian response and its integral over the sphere, by cosine.
float ty_cdrf_gaussian_cos(float sigma, float cos_theta);

typedef struct ty_poisson_table ty_poisson_table; // opaque, const after creation

ty_poisson_table* ty_poisson_table_create(void);        // about 15 ms
void ty_poisson_table_destroy(ty_poisson_table* table); // NULL is allowed

// ty_cdrf_poisson within 1e-4; gain = e^-t, 0..1.
float ty_poisson_table_at(const ty_poisson_table* table, float gain, float cos_theta);
