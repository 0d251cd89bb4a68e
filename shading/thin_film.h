// SPDX-License-Identifier: Apache-2.0
// Reflection of a film as thin as waves of light are long, over a dielectric or a metal: RGB means over the spectrum.
#pragma once
#include <tsuya/shading/material.h>

typedef struct ty_thin_film_bands ty_thin_film_bands; // opaque, const after creation
typedef struct ty_thin_film_table ty_thin_film_table; // likewise

// How waves that differ by a path agree on the mean over each channel of ACEScg.
ty_thin_film_bands* ty_thin_film_bands_create(void);
void ty_thin_film_bands_destroy(ty_thin_film_bands* bands); // NULL is allowed
// Mean of cos(2 pi path / wavelength) over the channels; path in micrometres, 0 gives 1.
ty_rgb ty_thin_film_bands_at(const ty_thin_film_bands* bands, float path);

// A film of an index relative to that of air, under light that comes through a medium of index `outside`, and perhaps
// a coat of index `cover` relative to that. base: index of what is beneath relative to `outside`, to know whether that
// is denser than the cover. thickness in micrometres.
ty_thin_film ty_thin_film_make(const ty_thin_film_bands* bands, float weight, float thickness, float ior, float outside,
                               float cover, float base);
// The film's cosine is that outside. Bare reflectance without it: by an index, which ty_shine gives (of less than 1,
// the cosine must be one that is not reflected totally), or of a metal.
ty_rgb ty_thin_film_over_dielectric(const ty_thin_film* film, float cosine, float shine);
ty_rgb ty_thin_film_over_metal(const ty_thin_film* film, float cosine, ty_rgb bare);

// What a film adds to the directional albedo of a rough dielectric reflection, by roughness and thickness. thickness:
// least and most, micrometres.
ty_thin_film_table* ty_thin_film_table_create(const ty_thin_film* film, const float roughness[2],
                                              const float thickness[2], float shine);
void ty_thin_film_table_destroy(ty_thin_film_table* table); // NULL is allowed
ty_thin_film_row ty_thin_film_table_row(const ty_thin_film_table* table, float roughness, float thickness,
                                        float weight);
ty_rgb ty_thin_film_row_at(const ty_thin_film_row* row, float mu);
