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
    TY_LOBE_COUNT
} ty_surface_lobe;

// Share of the dielectric that is clear, of the whole surface.
static inline float ty_surface_clear(const ty_bsdf* b)
{
    return (1.0f - b->metalness) * b->transmission_weight;
}

static inline float ty_surface_diffuse(const ty_bsdf* b)
{
    return (1.0f - b->metalness) * (1.0f - b->transmission_weight);
}

// Share the dielectric boundary reflects at a facet.
float ty_surface_boundary(const ty_bsdf* bsdf, float cos_h);
// Reflectance of the base's specular lobe at a facet, and transmittance of its clear share.
ty_rgb ty_surface_reflectance(const ty_bsdf* bsdf, float cos_h);
ty_rgb ty_surface_transmittance(const ty_bsdf* bsdf, float cos_h);

// A clear sheet: light goes back and forth between its sides, and c is left of it after each passage.
typedef struct ty_sheet
{
    ty_rgb reflected, transmitted;
} ty_sheet;
ty_sheet ty_surface_sheet(const ty_bsdf* bsdf, float cos_h);

// What coat and specular let through to or from the base.
float ty_surface_through_layers(const ty_bsdf* bsdf, float mu);
// What the coat leaves to a lobe beneath that reflects, and to one that transmits.
float ty_surface_through_coat(const ty_bsdf* bsdf, float mu_o, float mu_i);
float ty_surface_across_coat(const ty_bsdf* bsdf, float mu_o, float mu_i);
