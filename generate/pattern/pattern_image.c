// SPDX-License-Identifier: Apache-2.0
// Frames have their colours in one manner.
#include "pattern_image.h"
#include <tsuya/image/color.h>

ty_exr* pattern_image_create(int width, int height, bool grey, float* color[3])
{
    static const char* const names[] = {"R", "G", "B"};
    static const float ap1[8] = TY_ACESCG_CHROMATICITIES;
    const int window[4] = {0, 0, width - 1, height - 1};
    ty_exr* image = ty_exr_create(window, window);
    for (int c = 0; c < 3; c++)
        color[c] = grey && c > 0 ? NULL : ty_exr_add_channel(image, grey ? "Y" : names[c], TY_EXR_HALF);
    if (!grey)
        ty_exr_add_chromaticities(image, ap1);
    return image;
}
