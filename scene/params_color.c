// SPDX-License-Identifier: Apache-2.0
// Colours in their three spellings, and inputs: a constant, possibly times a texture or an attribute.
#include "number.h"
#include "params_read.h"
#include <ctype.h>
#include <string.h>

static int hex_digit(char c)
{
    return isdigit((unsigned char)c) ? c - '0' : tolower((unsigned char)c) - 'a' + 10;
}

static bool parse_hex(const char* text, ty_rgb* out)
{
    if (text[0] != '#' || strlen(text) != 7 || strspn(text + 1, "0123456789abcdefABCDEF") != 6)
        return false;
    float value[3];
    for (int i = 0; i < 3; ++i)
        value[i] = (float)(hex_digit(text[1 + 2 * i]) * 16 + hex_digit(text[2 + 2 * i])) / 255.0f;
    *out = ty_rgb_make(value[0], value[1], value[2]);
    return true;
}

// To ACEScg; what falls a rounding beyond the row's bounds comes back to them.
static bool convert(ty_reader* reader, const ty_node* node, const ty_param* row, const char* space, ty_rgb* value)
{
    ty_error error;
    if (reader->color && ty_color_to_acescg(reader->color, space, value, &error) != TY_OK)
    {
        ty_report(reader->errors, node->place, TY_BAD_INPUT, "'%s': colour space '%.100s': %.600s", row->name, space,
                  error.text);
        return false;
    }
    if (row->minimum != 0.0 || row->maximum != 0.0)
    {
        float low = (float)row->minimum, high = (float)row->maximum;
        *value =
            ty_rgb_make(ty_clamp(value->r, low, high), ty_clamp(value->g, low, high), ty_clamp(value->b, low, high));
    }
    return true;
}

static bool read_plain_rgb(ty_reader* reader, const ty_node* node, const ty_param* row, ty_rgb* out)
{
    float value[3];
    if (node->kind == TY_NODE_SCALAR)
    {
        if (!ty_param_read_number(reader, node, row, &value[0]))
            return false;
        *out = ty_rgb_grey(value[0]);
        return true;
    }
    if (!ty_param_read_numbers(reader, node, row, value, 3))
        return false;
    *out = ty_rgb_make(value[0], value[1], value[2]);
    return true;
}

bool ty_param_read_rgb(ty_reader* reader, ty_node* node, const ty_param* row, ty_rgb* out)
{
    static const char* const keys[] = {"color", "space", NULL};
    if (node->kind == TY_NODE_SCALAR && node->text[0] == '#')
    {
        if (parse_hex(node->text, out))
            return convert(reader, node, row, "srgb_texture", out);
        ty_param_report_type(reader, node, row);
        return false;
    }
    if (node->kind != TY_NODE_MAP)
        return read_plain_rgb(reader, node, row, out);
    if (!ty_params_check_keys(reader, node, keys, "a colour"))
        return false;
    ty_node *color = ty_node_get(node, "color"), *space = ty_node_get(node, "space");
    if (!color || (space && (space->kind != TY_NODE_SCALAR || !space->text[0])))
    {
        ty_param_report_type(reader, color ? space : node, row);
        return false;
    }
    if (!read_plain_rgb(reader, color, row, out))
        return false;
    return !space || convert(reader, space, row, space->text, out);
}

// value, or color and space, of an input written as a mapping.
static bool read_input_value(ty_reader* reader, ty_node* node, const ty_param* row, ty_input* out)
{
    ty_node* value = ty_node_get(node, "value");
    if (value && row->type == TY_PARAM_COLOR_INPUT)
        return ty_param_read_rgb(reader, value, row, &out->value);
    if (row->type == TY_PARAM_VECTOR_INPUT)
    {
        float v[3] = {1.0f, 1.0f, 1.0f};
        bool good = !value || ty_param_read_numbers(reader, value, row, v, 3);
        out->value = ty_rgb_make(v[0], v[1], v[2]);
        return good;
    }
    float number = (float)ty_unit_scale(row->unit); // 1 in the written unit
    bool good = !value || ty_param_read_number(reader, value, row, &number);
    out->value = ty_rgb_grey(number);
    return good;
}

static bool read_factor(ty_reader* reader, const ty_node* map, const char* key, float* out)
{
    const ty_param row = {.name = key, .type = TY_PARAM_FLOAT, .unit = ""};
    const ty_node* node = ty_node_get(map, key);
    return !node || ty_param_read_number(reader, node, &row, out);
}

static bool read_product(ty_reader* reader, const ty_node* map, ty_input* out)
{
    static const char* const spaces[] = {"acescg", "rec709", NULL};
    static const ty_param row = {.name = "product", .type = TY_PARAM_ENUM, .unit = "", .choices = spaces};
    ty_node* node = ty_node_get(map, "product");
    return !node || ty_param_read(reader, node, &row, &out->product);
}

// Nothing is as good as a name.
static bool is_name(ty_reader* reader, const ty_node* node, const char* key)
{
    const ty_param named = {.name = key, .type = TY_PARAM_STRING, .unit = ""};
    if (!node || (node->kind == TY_NODE_SCALAR && node->text[0]))
        return true;
    ty_param_report_type(reader, node, &named);
    return false;
}

static bool read_input_source(ty_reader* reader, ty_node* node, const ty_param* row, ty_input* out)
{
    ty_node *texture = ty_node_get(node, "texture"), *attribute = ty_node_get(node, "attribute");
    if ((!texture && !attribute) || !reader->find_texture)
    {
        ty_param_report_type(reader, node, row);
        return false;
    }
    if (!is_name(reader, texture, "texture") || !is_name(reader, attribute, "attribute"))
        return false;
    if (texture)
    {
        int wrap[2] = {-1, -1};
        const ty_node* layer = NULL;
        if (!ty_param_read_mapping(reader, node, out, wrap, &layer))
            return false;
        out->texture = texture->text;
        out->texture_index = reader->find_texture(reader->context, texture, layer, row->type != TY_PARAM_COLOR_INPUT,
                                                  out->mapping == TY_MAPPING_UV, wrap);
        if (out->texture_index < 0 || !attribute)
            return out->texture_index >= 0;
    }
    out->attribute = attribute->text;
    out->attribute_index = reader->find_attribute(reader->context, attribute);
    return out->attribute_index >= 0;
}

bool ty_param_read_input(ty_reader* reader, ty_node* node, const ty_param* row, ty_input* out)
{
    static const char* const keys[] = {"texture", "attribute", "value", "scale", "offset", "mapping", "uv",
                                       "channel", "space",     "size",  "blend", "wrap",   "product", NULL};
    static const char* const of_attribute[] = {"attribute", "value", "scale", "offset", "product", NULL};
    *out = ty_input_scalar(1.0f);
    bool is_color = row->type == TY_PARAM_COLOR_INPUT;
    if (is_color && (node->kind != TY_NODE_MAP || ty_node_find(node, "color") >= 0))
        return ty_param_read_rgb(reader, node, row, &out->value);
    if (row->type == TY_PARAM_VECTOR_INPUT)
    {
        out->scale = 2.0f;
        out->offset = -1.0f;
    }
    if (node->kind != TY_NODE_MAP && row->type == TY_PARAM_VECTOR_INPUT)
    {
        ty_param_report_type(reader, node, row);
        return false;
    }
    if (node->kind != TY_NODE_MAP)
    {
        float value = 0.0f;
        bool good = ty_param_read_number(reader, node, row, &value);
        out->value = ty_rgb_grey(value);
        return good;
    }
    bool by_attribute = ty_node_find(node, "attribute") >= 0 && ty_node_find(node, "texture") < 0;
    bool good = by_attribute ? ty_params_check_keys(reader, node, of_attribute, "an attribute")
                             : ty_params_check_keys(reader, node, keys, row->name);
    good &= read_input_value(reader, node, row, out);
    good &= read_factor(reader, node, "scale", &out->scale);
    good &= read_factor(reader, node, "offset", &out->offset);
    good &= read_product(reader, node, out);
    return read_input_source(reader, node, row, out) && good;
}
