// SPDX-License-Identifier: Apache-2.0
// A frame of a pattern before it is painted.
#pragma once
#include <tsuya/image/exr.h>

// Zeros of ACEScg as R, G, B, or as Y alone: then the second and third of color are NULL. The caller's.
ty_exr* pattern_image_create(int width, int height, bool grey, float* color[3]);
