// SPDX-License-Identifier: Apache-2.0
// What a material holds, and the preparation of its lobes by model.
#pragma once
#include "albedo_table.h"
#include "kernel_table.h"
#include "loss_table.h"
#include "thin_film.h"
#include <tsuya/shading/material.h>

typedef enum ty_material_model
{
    TY_MODEL_SURFACE,
    TY_MODEL_CDRF,
    TY_MODEL_WALK,
} ty_material_model;

// What the inputs of `cdrf` come to at a point.
typedef struct ty_cdrf_optics
{
    ty_rgb color;
    float mean_free_path[3], loss[3]; // as in ty_bsdf
    bool grey;
    float sigma_slope;
    float coat_weight, coat_alpha;
    ty_albedo_row coat_row;
} ty_cdrf_optics;

struct ty_material
{
    ty_material_model model;
    ty_surface_def surface;
    ty_cdrf_def cdrf; // of `walk`: what both have in common
    ty_walk_def walk;
    ty_bark_def bark; // of a `surface` that is bark: says its colour, roughness and relief
    bool is_bark;
    float inner_reflection;    // mean, of diffuse light within `walk` with a dielectric boundary; 0 of a diffuse one
    ty_albedo_table* specular; // E of the dielectric specular of `surface`, or NULL where it has none
    ty_albedo_table* coat;     // E of the coat of `surface`, or of the specular reflection of `cdrf`
    ty_albedo_table* fuzz;     // E of the fuzz
    // What layers keep of the reflections beneath them, NULL where there is no such layer.
    ty_albedo_table *coat_under_fuzz, *base_under_coat, *base_under_fuzz;
    ty_thin_film_bands* film_bands; // of the thin film of `surface`, or NULL where it has none
    ty_thin_film_table* film;       // what it adds to the dielectric specular, likewise
    bool anisotropic;               // the frame follows the texture's u
    bool bent;                      // a normal or bump map
    bool matte;                     // nothing but a diffuse base
    bool body;                      // of `surface`: light enters a share of it
    bool emissive;
    bool base_is_constant; // of `surface`: base_color is, and then it is this:
    ty_rgb base_color;
    unsigned traits;           // ty_material_trait
    ty_loss_table* conductor;  // of the metal or sheet of `surface`, NULL where it has none or loses nothing
    ty_loss_table* dielectric; // of its clear boundary, likewise
    ty_poisson_table* poisson; // for `local` with the Poisson kernel
    bool optics_are_constant;  // of `cdrf`: the moisture is, and then they are these:
    ty_moisture_optics optics;
    ty_spread_table* spread; // of `cdrf`
    bool cdrf_is_constant;   // nor does any other input of `cdrf`, and then what they come to is this:
    ty_cdrf_optics cdrf_optics;
};

extern const ty_param_table ty_moisture_table, ty_moisture_law_table;

// A negative constant stands for nothing.
static inline bool ty_walk_is_given(const ty_input* input)
{
    return input->texture_index >= 0 || input->attribute_index >= 0 || input->value.r >= 0.0f;
}

static inline bool ty_input_is_constant(const ty_input* input)
{
    return input->texture_index < 0 && input->attribute_index < 0;
}

static inline bool ty_input_is_zero(const ty_input* input)
{
    return ty_rgb_is_black(input->value); // a texture or attribute only scales the value
}

static inline ty_rgb ty_clamp_color(ty_rgb c)
{
    return ty_rgb_make(ty_clamp(c.r, 0, 1), ty_clamp(c.g, 0, 1), ty_clamp(c.b, 0, 1));
}

static inline float ty_unit_input(const ty_input* input, const ty_shading_context* context,
                                  const ty_surface_point* point)
{
    return ty_clamp(ty_input_float(input, context, point), 0.0f, 1.0f);
}

// Tables of a reflection, NULL where it is none; and all those of a `surface` that holds its def.
ty_albedo_table* ty_material_make_table(const ty_input* weight, const ty_input* roughness, const float eta[2]);
void ty_surface_make_tables(ty_material* material);

ty_rgb ty_surface_base_color(const ty_surface_def* def, const ty_shading_context* context,
                             const ty_surface_point* point);

// Matter by its colour and mean free path.
ty_scattering ty_walk_matter(ty_rgb color, float radius, ty_rgb scale, float anisotropy);

// Coat and fuzz at the point; and what goes on beneath the coat, once the base is known.
void ty_surface_prepare_layers(const ty_material* material, const ty_shading_context* context, ty_bsdf* bsdf);
void ty_surface_prepare_darkening(const ty_surface_def* def, const ty_shading_context* context, float roughness,
                                  ty_bsdf* bsdf);

// out holds point, frame, wo, entering and bent already; all else is zero.
void ty_surface_prepare(const ty_material* material, const ty_shading_context* context, ty_bsdf* out);

// `cdrf` sets what its kinds read and leaves the rest as it is.
void ty_cdrf_begin(ty_material* material); // tables and constants; inputs must be in place
void ty_cdrf_prepare(const ty_material* material, const ty_shading_context* context, ty_bsdf* out);
void ty_walk_prepare_boundary(const ty_material* material, const ty_shading_context* context, ty_bsdf* out);
void ty_walk_prepare(const ty_material* material, const ty_shading_context* context, ty_bsdf* out);

// Shading normals may turn away from a viewer who sees the triangle: bend them back until they face wo.
static inline ty_vec3 ty_facing_normal(ty_vec3 n, ty_vec3 wo)
{
    const float least = 1e-3f;
    float c = ty_dot(n, wo);
    return c >= least ? n : ty_normalize(ty_mad(n, wo, least - c));
}

// The frame at the point: along the texture where highlights are stretched, bent by normal and bump maps.
void ty_shading_frame_bend(const ty_material* material, const ty_shading_context* context, ty_bsdf* bsdf);
void ty_shading_frame_turn(const ty_material* material, const ty_shading_context* context, ty_bsdf* bsdf);

// Frame and side of a bsdf that holds point and wo.
static inline void ty_shading_frame_prepare(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    const ty_surface_point* p = &b->point;
    b->entering = ty_dot(b->wo, p->ng) > 0.0f;
    b->bent = material->bent;
    if (material->bent)
        ty_shading_frame_bend(material, context, b);
    else
        b->frame = ty_frame_from_normal(ty_facing_normal(b->entering ? p->ns : ty_neg(p->ns), b->wo));
    if (material->anisotropic)
        ty_shading_frame_turn(material, context, b);
}
