// SPDX-License-Identifier: Apache-2.0
// Directional albedo E(mu) of a rough dielectric reflection, to couple what lies beneath with it.
#pragma once
#include <tsuya/shading/bsdf.h>

typedef struct ty_albedo_table ty_albedo_table; // opaque, const after creation

// One slice where roughness (or eta) is the same at both ends of its range, 16 (or 9) otherwise. Deterministic.
ty_albedo_table* ty_albedo_table_create(float roughness_low, float roughness_high, float eta_low, float eta_high);
void ty_albedo_table_destroy(ty_albedo_table* table); // NULL is allowed

// The row for a point; table NULL gives the row of a layer that reflects nothing.
ty_albedo_row ty_albedo_table_row(const ty_albedo_table* table, float roughness, float eta);

// E(mu), 0 <= mu <= 1; linear in sqrt(mu).
float ty_albedo_row_at(const ty_albedo_row* row, float mu);

// 2 * integral of E_a(mu) E_b(mu) mu: what two layers above one another have in common.
float ty_albedo_row_common(const ty_albedo_row* a, const ty_albedo_row* b);
