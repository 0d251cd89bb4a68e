// SPDX-License-Identifier: Apache-2.0
// A Lambert surface alone: what `surface` comes to without layers, metal and transmission. cos: of wi to the frame's
// normal.
#pragma once
#include "lobes.h"

static inline bool ty_matte_is_black(const ty_bsdf* bsdf)
{
    return ty_rgb_is_black(bsdf->color);
}

// Nothing but a cosine about the frame's normal.
static inline bool ty_matte_is_plain(const ty_bsdf* bsdf)
{
    return bsdf->kind == TY_BSDF_MATTE && !bsdf->bent;
}

static inline ty_rgb ty_matte_eval(const ty_bsdf* bsdf, float cos, float* pdf)
{
    *pdf = ty_max(cos, 0.0f) * TY_INV_PI;
    return ty_rgb_scale(bsdf->color, *pdf);
}

static inline bool ty_matte_sample(const ty_bsdf* bsdf, ty_vec2 u, ty_bsdf_sample* out)
{
    ty_vec3 wi = ty_sample_cosine(u);
    *out = (ty_bsdf_sample){.wi = wi, .weight = bsdf->color, .pdf = wi.z * TY_INV_PI, .kind = TY_MASK_DIFFUSE};
    return wi.z > 0.0f && !ty_matte_is_black(bsdf);
}
