// SPDX-License-Identifier: Apache-2.0
// From an image in any format to halves in ACEScg (or as they are) with all their reductions.
#pragma once
#include "tiles_oiio.h"
#include <tsuya/image/color.h>
#include <tsuya/image/image.h>

// levels[0] is the image; each further one is half as large, rounded down, down to one texel. All are owned.
typedef struct ty_mip_levels
{
    int width, height;
    int channels; // 1 = grey, 2 = grey and alpha, 3 = RGB, 4 = RGB and alpha
    int count;
    uint16_t* levels[TY_LEVELS_MAX];
} ty_mip_levels;

void ty_mip_levels_term(ty_mip_levels* levels);

// space NULL = what the file says or is usual for its type; "raw" = numbers, not colours. The image's pixels are freed
// on the way: large ones do not lie in memory twice. Infinities and NaN become what a lookup can bear.
TY_CHECKED ty_status ty_mip_levels_build(ty_image* image, const char* space, const ty_color* color, ty_mip_levels* out,
                                         ty_error* error);
