// SPDX-License-Identifier: Apache-2.0
// Two ways to begin a pile that stand beside the inflation, and how far a pile repeats itself.
#pragma once
#include <tsuya/generate/aggregate_recipe.h>

// Sites of a regular lattice, row by row and bottom-up, one element of the size pitch (length along x) at each: the
// start of a full simulation (Gan 2023, section 3.2.1). In a volume all sites lie inside of it; in an open vessel they
// go on above the rim, as high as count needs. Returns how many of count find a site.
int ty_fill_lattice(const ty_container* container, ty_vec3 pitch, int count, ty_vec3* out);

// The aperiodic filling of Gan 2023, section 3.2.2 (after Sakurai & Miyata 2014), where its equations 1 to 3 read: each
// element moves by t n within [0, spacing * refine], where the cost c(t) = a(max f(x + t n)) + t is least; f is the
// depth of the element's own balls in those of another or behind a wall, less the offset; n = -grad SDF of the
// container; elements with c > D go. Moves bodies, marks gone[count], returns how many are gone. Equal input, equal
// bits.
int ty_fill_thesis(const ty_container* container, const ty_element* grains, int grain_count, const ty_thesis_def* def,
                   float spacing, ty_body* bodies, int count, bool* gone);

// Share of the bodies that have another at the most frequent displacement between any two, to an eighth of cell in each
// direction: 1 for an endless lattice, near 0 for a pile without order. cell is about a width of the bodies.
float ty_pile_repeat(const ty_body* bodies, int count, float cell);

#define TY_PILE_PACKED 0.02f // of the mean width: a mean overlap above this says that a filling does not fit

// The common size at which a filling below top fits after all (mean overlap at most TY_PILE_PACKED), 1 or less; by
// steps of a hundredth with sweeps of projection each. The bodies keep their own sizes and stay where they went.
float ty_pile_fit(ty_pile* pile, const ty_fill_top* top, int sweeps, ty_workers* workers);
