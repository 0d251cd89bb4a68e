// SPDX-License-Identifier: Apache-2.0
// Matter that scatters light within, as coefficients per channel.
#pragma once
#include <tsuya/base/math.h>

typedef struct ty_scattering
{
    ty_rgb extinction; // 1/m, world: scattering and absorption
    ty_rgb albedo;     // of one scattering, 0..1
    float anisotropy;  // mean cosine of the Henyey-Greenstein phase function, -.99..+.99
} ty_scattering;
