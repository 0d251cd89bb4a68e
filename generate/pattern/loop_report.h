// SPDX-License-Identifier: Apache-2.0
// How the frames of a loop differ from one to the next, and whether its seam is a step like any other.
#pragma once
#include "loop_motion.h"

typedef struct ty_loop_report ty_loop_report; // opaque

// The recipe and volume are borrowed. On failure *out is NULL.
TY_CHECKED ty_status ty_loop_report_create(const ty_loop_recipe* recipe, const ty_loop_volume* volume,
                                           ty_loop_report** out, ty_error* error);
void ty_loop_report_destroy(ty_loop_report* report); // NULL is allowed

// Frames in order, as shares of pixels that are inside: [height][width].
void ty_loop_report_add(ty_loop_report* report, const float* coverage);
// After the last: from which frame, from 0, the loop goes on after its least change; 0 where no change is less than
// that back to frame 0.
int ty_loop_report_quietest(const ty_loop_report* report);
// After the last: a JSON object as text, the caller's. first: the frame of the path that was added first. Warns of
// steps that are too long.
char* ty_loop_report_end(const ty_loop_report* report, int first);

// Two pictures of inside and outside, from counts of pixels.
typedef struct ty_loop_pair
{
    double changed; // share of all pixels that are in one and not in the other
    double overlap; // of the first's inside, what is inside of the second
    double density; // of the first
    double jaccard; // inside of both by inside of either
    double kappa;   // Cohen 1960: 0 = as if by chance, 1 = the same
} ty_loop_pair;
ty_loop_pair ty_loop_pair_of(int64_t pixels, int64_t first, int64_t second, int64_t both);

// Voxels from one entry into the inside to the next, along the axis on which it is least; 0 = there is none.
double ty_loop_wavelength(const ty_loop_volume* volume, float iso);
