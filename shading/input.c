// SPDX-License-Identifier: Apache-2.0
// Inputs at a point: a constant, times a texture or an attribute.
#include "input_texture.h"
#include <tsuya/base/rec709.h>

static ty_rgb vertex_value(const ty_mesh_attribute* attribute, const ty_shading_context* context,
                           const ty_surface_point* point)
{
    float v[4];
    ty_world_interpolate_attribute(context->world, point, attribute, v);
    return attribute->components == 1 ? ty_rgb_grey(v[0]) : ty_rgb_make(v[0], v[1], v[2]);
}

// Attributes of instances come before those of vertices. False where there is neither.
static bool find_attribute(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point,
                           ty_rgb* out)
{
    const float* const* of_object = context->object_attributes ? context->object_attributes[point->object] : NULL;
    const float* values = of_object ? of_object[input->attribute_index] : NULL;
    if (values)
    {
        *out = ty_rgb_grey(values[point->instance]);
        return true;
    }
    if (!context->vertex_attributes)
        return false;
    uint32_t prototype = ty_world_prototype(context->world, point->object, point->instance);
    const ty_mesh_attribute* attribute = context->vertex_attributes[prototype][input->attribute_index];
    if (attribute)
        *out = vertex_value(attribute, context, point);
    return attribute != NULL;
}

static ty_rgb attribute_factor(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point)
{
    ty_rgb value;
    if (!find_attribute(input, context, point, &value))
        return ty_rgb_grey(1.0f);
    return ty_rgb_add(ty_rgb_grey(input->offset), ty_rgb_scale(value, input->scale));
}

// Beside a texture, which scale and offset are of.
static ty_rgb plain_attribute(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point)
{
    ty_rgb value;
    return find_attribute(input, context, point, &value) ? value : ty_rgb_grey(1.0f);
}

static ty_rgb product(const ty_input* input, ty_rgb a, ty_rgb b)
{
    if (input->product == TY_PRODUCT_ACESCG)
        return ty_rgb_mul(a, b);
    return ty_rgb_from_rec709(ty_rgb_mul(ty_rgb_to_rec709(a), ty_rgb_to_rec709(b)));
}

ty_rgb ty_input_color(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point)
{
    if (input->texture_index >= 0)
    {
        ty_rgb texel = ty_input_texel(input, context, point);
        texel = ty_rgb_add(ty_rgb_grey(input->offset), ty_rgb_scale(texel, input->scale));
        ty_rgb value = product(input, input->value, texel);
        return input->attribute_index < 0 ? value : product(input, value, plain_attribute(input, context, point));
    }
    if (input->attribute_index >= 0)
        return product(input, input->value, attribute_factor(input, context, point));
    return input->value;
}

float ty_input_float(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point)
{
    if (input->texture_index < 0 && input->attribute_index < 0)
        return input->value.r;
    return ty_input_color(input, context, point).r;
}
