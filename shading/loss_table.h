// SPDX-License-Identifier: Apache-2.0
// What GGX facets lose that are met once only: 1 - E(mu) where nothing absorbs, to give it back as a lobe.
#pragma once
#include <tsuya/shading/bsdf.h>

typedef struct ty_loss_table ty_loss_table; // opaque, const after creation

// Of facets that reflect everything. One slice where both roughnesses are the same, 12 otherwise. Deterministic.
ty_loss_table* ty_loss_table_create_conductor(float roughness_low, float roughness_high);
// Of facets that reflect and refract, for any index from 1/3 to 3; exact in the index between ior_low and ior_high (and
// their inverses) at its ends. weight and coat: see ty_shine.
ty_loss_table* ty_loss_table_create_dielectric(float roughness_low, float roughness_high, float ior_low, float ior_high,
                                               float weight, float coat);
void ty_loss_table_destroy(ty_loss_table* table); // NULL is allowed

// The row for a point; table NULL gives the row of facets that lose nothing.
ty_loss_row ty_loss_table_row(const ty_loss_table* table, float roughness, float eta);

// 1 - E(mu), 0 <= mu <= 1; linear in sqrt(mu).
float ty_loss_row_at(const ty_loss_row* row, float mu);

// A cosine with a density about proportional to (1 - E(mu)) mu, and its density over directions.
float ty_loss_row_sample(const ty_loss_row* row, float u);
float ty_loss_row_pdf(const ty_loss_row* row, float mu);
