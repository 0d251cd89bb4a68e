// SPDX-License-Identifier: Apache-2.0
// Inputs at a point: a constant, times a texture or a per-instance attribute.
#include <tsuya/shading/material.h>

static float attribute_factor(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point)
{
    if (!context->object_attributes || !context->object_attributes[point->object])
        return 1.0f;
    const float* values = context->object_attributes[point->object][input->attribute_index];
    return values ? input->offset + input->scale * values[point->instance] : 1.0f;
}

ty_rgb ty_input_color(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point)
{
    if (input->texture_index >= 0)
    {
        ty_rgb texel = ty_texture_sample(context->textures[input->texture_index], point->uv);
        return ty_rgb_mul(input->value, ty_rgb_add(ty_rgb_grey(input->offset), ty_rgb_scale(texel, input->scale)));
    }
    if (input->attribute_index >= 0)
        return ty_rgb_scale(input->value, attribute_factor(input, context, point));
    return input->value;
}

float ty_input_float(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point)
{
    if (input->texture_index < 0 && input->attribute_index < 0)
        return input->value.r;
    return ty_input_color(input, context, point).r;
}
