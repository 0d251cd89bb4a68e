// SPDX-License-Identifier: Apache-2.0
// Numbers as scene files write them, and the words for what a row of a table accepts.
#include "number.h"
#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define NO_LIMIT 1e9 // bounds from here on mean "unbounded on this side" in messages

static const char* skip_digits(const char* c)
{
    while (isdigit((unsigned char)*c))
        ++c;
    return c;
}

static bool is_decimal(const char* c)
{
    c += *c == '+' || *c == '-';
    const char* whole = c;
    c = skip_digits(c);
    ptrdiff_t digits = c - whole;
    if (*c == '.')
    {
        const char* fraction = ++c;
        c = skip_digits(c);
        digits += c - fraction;
    }
    if (digits == 0)
        return false;
    if (*c == 'e' || *c == 'E')
    {
        ++c;
        c += *c == '+' || *c == '-';
        const char* exponent = c;
        c = skip_digits(c);
        if (c == exponent)
            return false;
    }
    return *c == 0;
}

bool ty_number_parse(const char* text, double* out)
{
    if (!is_decimal(text))
        return false;
    *out = strtod(text, NULL);
    return isfinite(*out) != 0;
}

bool ty_seed_parse(const char* text, uint64_t* out)
{
    if (!*text || *skip_digits(text) != 0)
        return false;
    errno = 0;
    *out = strtoull(text, NULL, 10);
    return errno == 0;
}

double ty_unit_scale(const char* unit)
{
    if (unit && strcmp(unit, "deg") == 0)
        return 3.14159265358979323846 / 180.0;
    return unit && strcmp(unit, "mm") == 0 ? 1e-3 : 1.0;
}

void ty_param_range_text(const ty_param* row, ty_text* out)
{
    bool low = row->minimum > -NO_LIMIT, high = row->maximum < NO_LIMIT;
    if (row->minimum == 0.0 && row->maximum == 0.0)
        low = high = false;
    if (low && high)
        ty_text_format(out, " %.9g..%.9g", row->minimum, row->maximum);
    else if (low)
        ty_text_format(out, " of at least %.9g", row->minimum);
    else if (high)
        ty_text_format(out, " of at most %.9g", row->maximum);
    if (row->unit && row->unit[0])
        ty_text_format(out, " %s", row->unit);
}

static void expected_enum(const ty_param* row, ty_text* out)
{
    ty_text_add(out, "one of: ");
    for (int i = 0; row->choices[i]; ++i)
        ty_text_format(out, "%s%s", i ? ", " : "", row->choices[i]);
}

void ty_param_expected(const ty_param* row, ty_text* out)
{
    static const char* const words[] = {
        [TY_PARAM_BOOL] = "true or false",
        [TY_PARAM_INT] = "a whole number",
        [TY_PARAM_INT2] = "two whole numbers [a, b]",
        [TY_PARAM_FLOAT] = "a number",
        [TY_PARAM_FLOAT2] = "two numbers [a, b] or one for both",
        [TY_PARAM_FLOAT3] = "three numbers [x, y, z]",
        [TY_PARAM_RGB] = "a colour: [r, g, b], one number, '#rrggbb' or { color, space }",
        [TY_PARAM_SEED] = "a whole number 0..18446744073709551615",
        [TY_PARAM_STRING] = "a text",
        [TY_PARAM_PATH] = "the name of a file",
        [TY_PARAM_FRAMES] = "the name of a file, or of files with #### for the number of the frame",
        [TY_PARAM_ENUM] = "",
        [TY_PARAM_SCALAR_INPUT] =
            "a number, { texture, value, scale, offset, uv, mapping, channel } or { attribute, ... }",
        [TY_PARAM_COLOR_INPUT] =
            "a colour, { texture, value, scale, offset, uv, mapping, channel } or { attribute, ... }",
        [TY_PARAM_VECTOR_INPUT] = "{ texture, value, scale, offset, uv, mapping } or { attribute, ... }",
        [TY_PARAM_GROUP] = "a mapping",
        [TY_PARAM_BRIEF_GROUP] = "a mapping",
        [TY_PARAM_LIST] = "a list of mappings",
        [TY_PARAM_POINTS] = "a list of points [x, y, z]",
        [TY_PARAM_POINTS2] = "a list of points [x, y]",
        [TY_PARAM_NAMES] = "a mapping of names to names",
        [TY_PARAM_STRINGS] = "a list of texts",
    };
    if (row->type == TY_PARAM_ENUM)
    {
        expected_enum(row, out);
        return;
    }
    ty_text_add(out, words[row->type]);
    if (row->type == TY_PARAM_SEED)
        return;
    ty_text range = {0};
    ty_param_range_text(row, &range);
    bool is_long = row->type == TY_PARAM_RGB || row->type == TY_PARAM_SCALAR_INPUT ||
                   row->type == TY_PARAM_COLOR_INPUT || row->type == TY_PARAM_VECTOR_INPUT;
    if (range.size > 0)
        ty_text_format(out, "%s%s", is_long ? ", values" : "", range.data);
    ty_text_term(&range);
}

const char* ty_param_type_name(ty_param_type type)
{
    static const char* const names[] = {
        [TY_PARAM_BOOL] = "true/false",
        [TY_PARAM_INT] = "integer",
        [TY_PARAM_INT2] = "2 integers",
        [TY_PARAM_FLOAT] = "number",
        [TY_PARAM_FLOAT2] = "2 numbers",
        [TY_PARAM_FLOAT3] = "3 numbers",
        [TY_PARAM_RGB] = "colour",
        [TY_PARAM_SEED] = "seed",
        [TY_PARAM_STRING] = "text",
        [TY_PARAM_PATH] = "file",
        [TY_PARAM_FRAMES] = "file or files",
        [TY_PARAM_ENUM] = "choice",
        [TY_PARAM_SCALAR_INPUT] = "number input",
        [TY_PARAM_COLOR_INPUT] = "colour input",
        [TY_PARAM_VECTOR_INPUT] = "vector input",
        [TY_PARAM_GROUP] = "mapping",
        [TY_PARAM_BRIEF_GROUP] = "value or mapping",
        [TY_PARAM_LIST] = "list",
        [TY_PARAM_POINTS] = "points",
        [TY_PARAM_POINTS2] = "points",
        [TY_PARAM_NAMES] = "names",
        [TY_PARAM_STRINGS] = "texts",
    };
    return names[type];
}

static void numbers_text(const float* values, int count, double scale, ty_text* out)
{
    ty_text_add(out, count > 1 ? "[" : "");
    for (int i = 0; i < count; ++i)
        ty_text_format(out, "%s%.6g", i ? ", " : "", (double)values[i] / scale);
    ty_text_add(out, count > 1 ? "]" : "");
}

void ty_param_value_text(const ty_param* row, const void* def, ty_text* out)
{
    const void* field = (const char*)def + row->offset;
    double scale = ty_unit_scale(row->unit);
    switch (row->type)
    {
    case TY_PARAM_BOOL:
        ty_text_add(out, *(const bool*)field ? "true" : "false");
        break;
    case TY_PARAM_INT:
        ty_text_format(out, "%d", *(const int*)field);
        break;
    case TY_PARAM_INT2:
        ty_text_format(out, "[%d, %d]", ((const int*)field)[0], ((const int*)field)[1]);
        break;
    case TY_PARAM_FLOAT:
    case TY_PARAM_SCALAR_INPUT: // the value stands first in ty_input
        numbers_text(field, 1, scale, out);
        break;
    case TY_PARAM_FLOAT2:
        numbers_text(field, 2, scale, out);
        break;
    case TY_PARAM_FLOAT3:
    case TY_PARAM_RGB:
    case TY_PARAM_COLOR_INPUT:
        numbers_text(field, 3, scale, out);
        break;
    case TY_PARAM_SEED:
        ty_text_format(out, "%llu", (unsigned long long)((const ty_seed*)field)->value);
        break;
    case TY_PARAM_STRING:
    case TY_PARAM_PATH:
    case TY_PARAM_FRAMES:
        ty_text_add(out, *(const char* const*)field ? *(const char* const*)field : "");
        break;
    case TY_PARAM_ENUM:
        ty_text_add(out, row->choices[*(const int*)field]);
        break;
    case TY_PARAM_BRIEF_GROUP:
        ty_param_value_text(&row->group->params[0], field, out);
        break;
    case TY_PARAM_VECTOR_INPUT: // none unless written
    case TY_PARAM_GROUP:
    case TY_PARAM_LIST:
    case TY_PARAM_POINTS:
    case TY_PARAM_POINTS2:
    case TY_PARAM_NAMES:
    case TY_PARAM_STRINGS:
        break;
    }
}
