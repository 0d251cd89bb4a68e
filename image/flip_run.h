// SPDX-License-Identifier: Apache-2.0
// The planes of one comparison by FLIP, used again for every exposure of HDR-FLIP.
#pragma once
#include <tsuya/base/math.h>
#include <tsuya/base/status.h>
#include <tsuya/base/workers.h>

typedef struct ty_flip_run ty_flip_run; // opaque

TY_CHECKED ty_status ty_flip_run_create(int width, int height, float ppd, ty_workers* workers, ty_flip_run** out,
                                        ty_error* error);
void ty_flip_run_destroy(ty_flip_run* run); // NULL is allowed

// Linear Rec.709 of pixel i (row by row) as a display shows it, 0..1. Called from several threads.
typedef void ty_flip_pixel_fn(const void* context, int64_t i, float rgb[3]);
// Filters one side (0 = reference, 1 = test).
void ty_flip_run_picture(ty_flip_run* run, int side, ty_flip_pixel_fn* pixel, const void* context);
// The errors between the two sides, or the larger of them and what map holds.
void ty_flip_run_errors(ty_flip_run* run, bool keep_larger, float* map);
