// SPDX-License-Identifier: Apache-2.0
// ACEScg to linear Rec.709 and back, with Bradford's adaptation from D60 to D65.
#pragma once
#include <tsuya/base/math.h>

static inline ty_rgb ty_rgb_to_rec709(ty_rgb c)
{
    return (ty_rgb){1.70505099f * c.r - 0.62179212f * c.g - 0.08325887f * c.b,
                    -0.13025642f * c.r + 1.14080474f * c.g - 0.01054832f * c.b,
                    -0.02400336f * c.r - 0.12896898f * c.g + 1.15297233f * c.b};
}

static inline ty_rgb ty_rgb_from_rec709(ty_rgb c)
{
    return (ty_rgb){0.61309740f * c.r + 0.33952315f * c.g + 0.04737945f * c.b,
                    0.07019372f * c.r + 0.91635388f * c.g + 0.01345240f * c.b,
                    0.02061559f * c.r + 0.10956977f * c.g + 0.86981463f * c.b};
}
