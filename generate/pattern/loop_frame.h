// SPDX-License-Identifier: Apache-2.0
// A frame of a looping texture as a picture.
#pragma once
#include "loop_motion.h"

typedef struct ty_loop_painter ty_loop_painter; // opaque; one thread

// Borrows all. On failure *out is NULL.
TY_CHECKED ty_status ty_loop_painter_create(const ty_loop_recipe* recipe, const ty_loop_volume* volume,
                                            ty_workers* workers, ty_loop_painter** out, ty_error* error);
void ty_loop_painter_destroy(ty_loop_painter* painter); // NULL is allowed

// Frame i of the path, from 0: halves R, G, B (ACEScg), or Y where all is grey; and A, with which they are multiplied,
// where what is outside is transparent. The caller's; on failure *out is NULL.
TY_CHECKED ty_status ty_loop_painter_paint(ty_loop_painter* painter, int i, ty_exr** out, ty_error* error);
// The same without the picture.
TY_CHECKED ty_status ty_loop_painter_cover(ty_loop_painter* painter, int i, ty_error* error);
// Of the last frame, how much of each pixel is inside: [height][width]. Borrowed until the next one.
const float* ty_loop_painter_coverage(const ty_loop_painter* painter);
// The first half of painting alone: the values 0..1 at a moment, [height][width].
TY_CHECKED ty_status ty_loop_painter_slice(ty_loop_painter* painter, int64_t i, int64_t n, const float** out,
                                           ty_error* error);
