// SPDX-License-Identifier: Apache-2.0
// What a material holds, and the preparation of its lobes by model.
#pragma once
#include "albedo_table.h"
#include "kernel_table.h"
#include "loss_table.h"
#include <tsuya/shading/material.h>

typedef enum ty_material_model
{
    TY_MODEL_SURFACE,
    TY_MODEL_CDRF,
} ty_material_model;

struct ty_material
{
    ty_material_model model;
    ty_surface_def surface;
    ty_cdrf_def cdrf;
    ty_albedo_table* specular; // E of the dielectric specular of `surface`, or NULL where it has none
    ty_albedo_table* coat;     // E of the coat of `surface`, or of the specular reflection of `cdrf`
    bool anisotropic;          // the frame follows the texture's u
    bool bent;                 // a normal or bump map
    bool matte;                // nothing but a diffuse base
    unsigned traits;           // ty_material_trait
    ty_loss_table* conductor;  // of the metal or sheet of `surface`, NULL where it has none or loses nothing
    ty_loss_table* dielectric; // of its clear boundary, likewise
    ty_poisson_table* poisson; // for `local` with the Poisson kernel
};

// out holds point, frame, wo, entering and convex already.
void ty_surface_prepare(const ty_material* material, const ty_shading_context* context, ty_bsdf* out);
void ty_cdrf_prepare(const ty_material* material, const ty_shading_context* context, ty_bsdf* out);

// n bent until it faces wo.
ty_vec3 ty_facing_normal(ty_vec3 n, ty_vec3 wo);

// The frame at the point: along the texture where highlights are stretched, bent by normal and bump maps.
void ty_shading_frame_bend(const ty_material* material, const ty_shading_context* context, ty_bsdf* bsdf);
void ty_shading_frame_turn(const ty_material* material, const ty_shading_context* context, ty_bsdf* bsdf);
