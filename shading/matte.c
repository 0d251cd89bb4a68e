// SPDX-License-Identifier: Apache-2.0
// Preparation of a Lambert surface: what is not set is not read of it.
#include "matte.h"
#include "material_private.h"

void ty_matte_prepare(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    b->kind = TY_BSDF_MATTE;
    b->material = material;
    ty_shading_frame_prepare(material, context, b);
    b->color = material->base_is_constant
                   ? material->base_color
                   : ty_clamp_color(ty_input_color(&material->surface.base_color, context, &b->point));
    b->emission = ty_rgb_grey(0.0f);
    if (material->emissive && b->entering)
        b->emission = ty_material_emission(material, context, &b->point);
}
