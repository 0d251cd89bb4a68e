// SPDX-License-Identifier: Apache-2.0
// The parts of `surface` that preparation, evaluation and sampling share. Local frame, cosines positive.
#pragma once
#include "lobes.h"

typedef enum ty_surface_lobe
{
    TY_LOBE_COAT,
    TY_LOBE_SPECULAR,
    TY_LOBE_DIFFUSE,
    TY_LOBE_TRANSMISSION,
    TY_LOBE_LOST_ABOVE, // what facets pass on among themselves and reflect in the end
    TY_LOBE_LOST_BELOW, // or transmit
    TY_LOBE_DIFFUSE_BELOW,
    TY_LOBE_FUZZ,
    TY_LOBE_COUNT
} ty_surface_lobe;

// Share of the dielectric that is clear, of the whole surface.
static inline float ty_surface_clear(const ty_bsdf* b)
{
    return (1.0f - b->metalness) * b->transmission_weight;
}

static inline float ty_surface_body(const ty_bsdf* b)
{
    return (1.0f - b->metalness) * (1.0f - b->transmission_weight) * b->body;
}

static inline float ty_surface_diffuse(const ty_bsdf* b)
{
    return (1.0f - b->metalness) * (1.0f - b->transmission_weight) * (1.0f - b->body);
}

// What light to the diffuse base keeps on wo's side, over its mean.
static inline ty_rgb ty_surface_gain(const ty_bsdf* b)
{
    return b->film_row.count > 0 ? b->film_gain : ty_rgb_grey(b->diffuse_gain);
}

// Share the dielectric boundary reflects at a facet, where no film is on it; and with one.
float ty_surface_boundary(const ty_bsdf* bsdf, float cos_h);
ty_rgb ty_surface_boundary_color(const ty_bsdf* bsdf, float cos_h);
// Fresnel reflectance of the metal at a facet.
ty_rgb ty_surface_metal(const ty_bsdf* bsdf, float cos_h);
// Reflectance of the base's specular lobe at a facet, and transmittance of its clear share.
ty_rgb ty_surface_reflectance(const ty_bsdf* bsdf, float cos_h);
ty_rgb ty_surface_transmittance(const ty_bsdf* bsdf, float cos_h);

// A clear sheet: light goes back and forth between its sides, and c is left of it after each passage.
typedef struct ty_sheet
{
    ty_rgb reflected, transmitted;
} ty_sheet;
ty_sheet ty_surface_sheet(const ty_bsdf* bsdf, float cos_h);

// --- layers: fuzz over coat over base ---
// A reflection beneath a layer passes it twice, and what it keeps of both passages is the larger of its albedos there:
// reciprocal, exact for mirrors, too much otherwise. By how much is known on average (the joint tables), and the
// lobe at the bottom of the stack (diffuse, or what metal facets lose) takes what the rest leaves: nothing is lost.

// What fuzz and coat leave of light from or to mu.
float ty_layers_left(const ty_bsdf* bsdf, float mu);
// Of that, what the reflection at the dielectric leaves to the diffuse base, and single facets of the metal to others.
float ty_layers_diffuse(const ty_bsdf* bsdf, float mu);
ty_rgb ty_layers_diffuse_color(const ty_bsdf* bsdf, float mu); // with a film
float ty_layers_metal(const ty_bsdf* bsdf, float mu);
// What facets of a clear boundary send up late, with what the layers keep too much of its reflection.
float ty_layers_clear(const ty_bsdf* bsdf, float mu);
// What a reflection at the coat, and at the base, keeps on its way through what is above.
float ty_layers_over_coat(const ty_bsdf* bsdf, float mu_o, float mu_i);
ty_rgb ty_layers_over_base(const ty_bsdf* bsdf, float mu_o, float mu_i);
// The colour of the coat on both ways.
ty_rgb ty_layers_tint(const ty_bsdf* bsdf, float mu_o, float mu_i);
// One of both ways alone; the product of two is that of both where the coat is whole.
ty_rgb ty_layers_tint_one(const ty_bsdf* bsdf, float mu);
// What light that is transmitted keeps: the same both ways, by the direction outside.
ty_rgb ty_layers_across(const ty_bsdf* bsdf, float mu_o, float mu_i);
// 2 * integral of what(mu) mu.
float ty_layers_mean(const ty_bsdf* bsdf, float (*what)(const ty_bsdf*, float));
