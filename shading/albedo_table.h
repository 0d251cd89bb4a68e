// SPDX-License-Identifier: Apache-2.0
// Directional albedos E(mu) of layers, to couple what lies beneath with them.
#pragma once
#include <tsuya/shading/bsdf.h>

typedef struct ty_albedo_table ty_albedo_table; // opaque, const after creation

// Of a rough dielectric reflection. Ranges are {least, most}: one slice where both are the same, 16 of roughness and 9
// of eta otherwise. Deterministic.
ty_albedo_table* ty_albedo_table_create(const float roughness[2], const float eta[2]);
// Of fuzz.
ty_albedo_table* ty_albedo_table_create_fuzz(const float roughness[2]);

// A reflection that lies under a layer.
typedef struct ty_lower_layer
{
    float roughness[2];
    float eta;                   // 0 = of metal
    const ty_albedo_table* coat; // between both: takes its part first; NULL = none
    float coat_roughness, coat_eta, coat_weight;
} ty_lower_layer;
// The mean over its directions wi of max(E(wo), E(wi)) of the upper layer, which that keeps of it. Rows are for both
// roughnesses. upper NULL gives NULL.
ty_albedo_table* ty_albedo_table_create_joint(const ty_lower_layer* lower, const ty_albedo_table* upper,
                                              const float upper_roughness[2], float upper_eta);
void ty_albedo_table_destroy(ty_albedo_table* table); // NULL is allowed

// The row for a point; table NULL gives the row of a layer that reflects nothing.
ty_albedo_row ty_albedo_table_row(const ty_albedo_table* table, float roughness, float eta);

// E(mu), 0 <= mu <= 1; linear in sqrt(mu).
float ty_albedo_row_at(const ty_albedo_row* row, float mu);
