// SPDX-License-Identifier: Apache-2.0
// JSON Schema (draft 2020-12) of scene files, for editors, from the tables.
#include "loader.h"
#include "number.h"
#include "scene_params.h"
#include <string.h>
#include <tsuya/generate/asset.h>
#include <tsuya/geometry/shape.h>

#define VARIABLE "{\"$ref\": \"#/$defs/variable\"}"
#define OUTSIDE "{\"enum\": [\"hold\", \"loop\", \"mirror\", \"continue\", \"error\"]}"
#define KEYED ", {\"$ref\": \"#/$defs/keyed\"}"

static void add_string(ty_text* out, const char* text)
{
    ty_text_add(out, "\"");
    for (const char* c = text; *c; ++c)
    {
        unsigned char byte = (unsigned char)*c;
        if (byte == '"' || byte == '\\')
            ty_text_format(out, "\\%c", byte);
        else if (byte < 0x20)
            ty_text_format(out, "\\u%04x", byte);
        else
            ty_text_add_bytes(out, c, 1);
    }
    ty_text_add(out, "\"");
}

// A number or variable within the row's bounds.
static void add_number(ty_text* out, const ty_param* row, const char* type)
{
    ty_text_format(out, "{\"anyOf\": [{\"type\": \"%s\"", type);
    if (row->minimum != 0.0 || row->maximum != 0.0)
        ty_text_format(out, ", \"minimum\": %.9g, \"maximum\": %.9g", row->minimum, row->maximum);
    ty_text_add(out, "}, " VARIABLE "]}");
}

static void add_numbers(ty_text* out, const ty_param* row, const char* type, int count)
{
    ty_text_add(out, "{\"type\": \"array\", \"items\": ");
    add_number(out, row, type);
    ty_text_format(out, ", \"minItems\": %d, \"maxItems\": %d}", count, count);
}

static void add_color(ty_text* out, const ty_param* row)
{
    add_number(out, row, "number");
    ty_text_add(out, ", ");
    add_numbers(out, row, "number", 3);
    ty_text_add(out,
                ", {\"type\": \"string\", \"pattern\": \"^#[0-9a-fA-F]{6}$\"}, {\"type\": \"object\", \"properties\": "
                "{\"color\": {}, \"space\": {\"type\": \"string\"}}, \"required\": [\"color\"], "
                "\"additionalProperties\": false}");
}

static void add_input(ty_text* out, const ty_param* row)
{
    if (row->type == TY_PARAM_COLOR_INPUT)
        add_color(out, row);
    else if (row->type == TY_PARAM_SCALAR_INPUT)
        add_number(out, row, "number");
    static const char mapping[] =
        ", \"uv\": {\"type\": \"object\", \"properties\": {\"scale\": {}, \"offset\": {}, \"rotate\": {}}, "
        "\"additionalProperties\": false}, \"mapping\": {\"enum\": [\"uv\", \"triplanar\", \"planar\"]}, \"space\": "
        "{\"enum\": [\"object\", \"world\"]}, \"size\": {\"type\": "
        "\"number\"}, \"blend\": {\"type\": \"number\"}, \"channel\": {\"type\": \"string\", "
        "\"examples\": [\"all\", \"r\", \"g\", \"b\", \"a\", \"luminance\", \"v\"]}, \"wrap\": {\"anyOf\": [{\"enum\": "
        "[\"repeat\", \"clamp\", \"mirror\"]}, {\"type\": "
        "\"array\", \"minItems\": 2, \"maxItems\": 2, \"items\": {\"enum\": [\"repeat\", \"clamp\", \"mirror\"]}}]}, "
        "\"attribute\": "
        "{\"type\": \"string\"}";
    for (int i = 0; i < 2; ++i)
    {
        const char* source = i ? "attribute" : "texture";
        ty_text_add(out, i || row->type != TY_PARAM_VECTOR_INPUT ? ", " : "");
        ty_text_format(
            out,
            "{\"type\": \"object\", \"properties\": {\"%s\": {\"type\": \"string\"}, \"value\": {}, \"scale\": "
            "{\"type\": \"number\"}, \"offset\": {\"type\": \"number\"}, \"product\": {\"enum\": [\"acescg\", "
            "\"rec709\"]}%s}, \"required\": [\"%s\"], "
            "\"additionalProperties\": false}",
            source, i ? "" : mapping, source);
    }
}

static void add_choices(ty_text* out, const ty_param* row)
{
    ty_text_add(out, "{\"enum\": [");
    for (int i = 0; row->choices[i]; ++i)
    {
        ty_text_add(out, i ? ", " : "");
        add_string(out, row->choices[i]);
    }
    ty_text_add(out, "]}");
}

// The alternatives of a row, without the variable.
static void add_type(ty_text* out, const ty_param* row)
{
    switch (row->type)
    {
    case TY_PARAM_BOOL:
        ty_text_add(out, "{\"type\": \"boolean\"}");
        break;
    case TY_PARAM_INT:
        add_number(out, row, "integer");
        break;
    case TY_PARAM_INT2:
        add_numbers(out, row, "integer", 2);
        break;
    case TY_PARAM_FLOAT:
        add_number(out, row, "number");
        break;
    case TY_PARAM_FLOAT2:
        add_number(out, row, "number");
        ty_text_add(out, ", ");
        add_numbers(out, row, "number", 2);
        break;
    case TY_PARAM_FLOAT3:
        add_numbers(out, row, "number", 3);
        break;
    case TY_PARAM_RGB:
        add_color(out, row);
        break;
    case TY_PARAM_SEED:
        ty_text_add(out, "{\"type\": \"integer\", \"minimum\": 0, \"maximum\": 18446744073709551615}");
        break;
    case TY_PARAM_STRING:
    case TY_PARAM_PATH:
    case TY_PARAM_FRAMES:
        ty_text_add(out, "{\"type\": \"string\"}");
        break;
    case TY_PARAM_ENUM:
        add_choices(out, row);
        break;
    case TY_PARAM_SCALAR_INPUT:
    case TY_PARAM_COLOR_INPUT:
    case TY_PARAM_VECTOR_INPUT:
        add_input(out, row);
        break;
    case TY_PARAM_GROUP:
        ty_text_format(out, "{\"$ref\": \"#/$defs/%s\"}", row->group->name);
        break;
    case TY_PARAM_BRIEF_GROUP:
        add_type(out, &row->group->params[0]);
        ty_text_format(out, ", {\"$ref\": \"#/$defs/%s\"}", row->group->name);
        break;
    case TY_PARAM_STRINGS:
        ty_text_add(out, "{\"type\": \"string\"}, {\"type\": \"array\", \"items\": {\"type\": \"string\"}}");
        break;
    case TY_PARAM_LIST:
        ty_text_format(out, "{\"type\": \"array\", \"items\": {\"$ref\": \"#/$defs/%s\"}}", row->group->name);
        break;
    case TY_PARAM_POINTS:
    case TY_PARAM_POINTS2:
        ty_text_add(out, "{\"type\": \"array\", \"items\": ");
        add_numbers(out, row, "number", row->type == TY_PARAM_POINTS2 ? 2 : 3);
        ty_text_add(out, "}");
        break;
    case TY_PARAM_NAMES:
        ty_text_add(out, "{\"type\": \"object\", \"additionalProperties\": {\"type\": \"string\"}}");
        break;
    }
}

// Whether values of a table may change with time.
static bool is_keyed(const ty_param_table* table)
{
    const ty_param_table* const tables[] = {
        ty_camera_params(), ty_turntable_params(), ty_light_params(), ty_object_params(), ty_surface_params(),
        ty_cdrf_params(),   ty_moisture_params(),  ty_soak_params(),  ty_walk_params(),   ty_bark_params()};
    for (int i = 0; i < TY_PARAM_COUNT(tables); ++i)
        if (tables[i] == table)
            return true;
    return false;
}

static bool is_keyed_type(ty_param_type type)
{
    return type != TY_PARAM_STRING && type != TY_PARAM_PATH && type != TY_PARAM_FRAMES && type != TY_PARAM_ENUM &&
           type != TY_PARAM_INT && type != TY_PARAM_GROUP && type != TY_PARAM_LIST;
}

static void add_row(ty_text* out, const ty_param* row, const char* further, bool keyed)
{
    ty_text range = {0}, about = {0};
    ty_param_range_text(row, &range);
    ty_text_format(&about, "%s%s%s%s", row->help ? row->help : "", range.size ? " (" : "",
                   range.size ? range.data + strspn(range.data, " ") : "", range.size ? ")" : "");
    ty_text_add(out, "      ");
    add_string(out, row->name);
    ty_text_add(out, ": {\"description\": ");
    add_string(out, about.data);
    ty_text_add(out, ", \"anyOf\": [");
    add_type(out, row);
    ty_text_format(out, "%s%s, " VARIABLE "]}", further, keyed && is_keyed_type(row->type) ? KEYED : "");
    ty_text_term(&range);
    ty_text_term(&about);
}

// What the readers accept beyond a row's own type.
static void add_further_type(ty_text* out, const ty_param_table* table, const ty_param* row)
{
    int count = 0;
    const ty_generator* const* generators = ty_generator_list(&count);
    ty_text_add(out, "");
    if (table == ty_object_params() && strcmp(row->name, "scale") == 0)
        ty_text_add(out, ", {\"type\": \"number\"}");
    if (table == ty_cdrf_params() && strcmp(row->name, "calibration") == 0)
        ty_text_add(out, ", {\"type\": \"string\"}"); // of a file
    if (strncmp(table->name, "asset.", 6) != 0 || row->type != TY_PARAM_PATH)
        return;
    for (int i = 0; i < count; ++i)
        if (ty_recipe_belongs(generators[i], row->name))
            ty_text_format(out, ", {\"$ref\": \"#/$defs/%s\"}", generators[i]->params->name);
}

// extra: a key that tells this table from its neighbours, with its fixed value; NULL = none.
static void add_table(ty_text* out, const ty_param_table* table, const char* extra, const char* value)
{
    ty_text required = {0};
    ty_text_add(out, "    ");
    add_string(out, table->name);
    ty_text_add(out, ": {\"type\": \"object\", \"description\": ");
    add_string(out, table->help);
    ty_text_add(out, ", \"additionalProperties\": false, \"properties\": {\n");
    if (extra)
    {
        ty_text_format(out, "      \"%s\": {\"const\": \"%s\"}%s\n", extra, value, table->count ? "," : "");
        ty_text_format(&required, "\"%s\"", extra);
    }
    for (int i = 0; i < table->count; ++i)
    {
        const ty_param* row = &table->params[i];
        ty_text further = {0};
        add_further_type(&further, table, row);
        add_row(out, row, further.data, is_keyed(table));
        ty_text_term(&further);
        ty_text_add(out, i + 1 < table->count ? ",\n" : "\n");
        if (row->required)
            ty_text_format(&required, "%s\"%s\"", required.size ? ", " : "", row->name);
    }
    ty_text_format(out, "    }, \"required\": [%s]}", required.size ? required.data : "");
    ty_text_term(&required);
}

static const char* generator_kind(const ty_param_table* table)
{
    int count = 0;
    const ty_generator* const* generators = ty_generator_list(&count);
    for (int i = 0; i < count; ++i)
        if (generators[i]->params == table)
            return generators[i]->kind;
    return NULL;
}

static void add_definitions(ty_text* out)
{
    int count = 0;
    const ty_param_table* const* tables = ty_scene_tables(&count);
    ty_text_add(out, "    \"variable\": {\"type\": \"string\", \"pattern\": \"^[$][^$]\"},\n");
    ty_text_add(out, "    \"keyed\": {\"type\": \"object\", \"description\": \"values at frames\", "
                     "\"additionalProperties\": false, \"required\": [\"keys\"], \"properties\": {\n"
                     "      \"keys\": {\"type\": \"object\", \"minProperties\": 1},\n"
                     "      \"interpolate\": {\"enum\": [\"linear\", \"smooth\", \"ease\", \"hold\"]},\n"
                     "      \"before\": " OUTSIDE ",\n      \"after\": " OUTSIDE "}},\n");
    for (int i = 0; i < count; ++i)
    {
        const char* kind = generator_kind(tables[i]);
        if (tables[i] == ty_surface_params())
            add_table(out, tables[i], "model", "surface");
        else if (tables[i] == ty_cdrf_params())
            add_table(out, tables[i], "model", "cdrf");
        else if (tables[i] == ty_walk_params())
            add_table(out, tables[i], "model", "walk");
        else if (tables[i] == ty_bark_params())
            add_table(out, tables[i], "model", "bark");
        else
            add_table(out, tables[i], kind ? "kind" : NULL, kind);
        ty_text_add(out, i + 1 < count ? ",\n" : "\n");
    }
}

char* ty_params_schema(void)
{
    ty_text out = {0};
    ty_text_add(&out,
                "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": \"tsuya scene\",\n"
                "  \"type\": \"object\",\n  \"required\": [\"tsuya\"],\n  \"additionalProperties\": false,\n"
                "  \"properties\": {\n    \"tsuya\": {\"const\": 1},\n"
                "    \"include\": {\"type\": [\"string\", \"array\"], \"items\": {\"type\": \"string\"}},\n"
                "    \"search\": {\"type\": \"array\", \"items\": {\"type\": \"string\"}},\n"
                "    \"overrides\": {\"type\": \"string\"},\n"
                "    \"ocio\": {\"type\": \"string\"},\n    \"vars\": {\"type\": \"object\"},\n"
                "    \"film\": {\"$ref\": \"#/$defs/film\"},\n    \"camera\": {\"$ref\": \"#/$defs/camera\"},\n"
                "    \"render\": {\"$ref\": \"#/$defs/render\"},\n"
                "    \"timeline\": {\"$ref\": \"#/$defs/timeline\"},\n"
                "    \"turntable\": {\"$ref\": \"#/$defs/turntable\"},\n    \"frame\": {\"type\": \"number\"},\n");
    ty_text_format(&out,
                   "    \"assets\": {\"type\": \"object\", \"additionalProperties\": {\"anyOf\": [{\"$ref\": "
                   "\"#/$defs/asset.mesh\"}, {\"$ref\": \"#/$defs/%s\"}, {\"$ref\": \"#/$defs/asset.texture\"}, "
                   "{\"$ref\": \"#/$defs/asset.frames\"}, {\"$ref\": \"#/$defs/asset.fill\"}, {\"$ref\": "
                   "\"#/$defs/asset.loop\"}, {\"$ref\": \"#/$defs/asset.filter\"}, {\"$ref\": "
                   "\"#/$defs/asset.aggregate\"}, {\"$ref\": \"#/$defs/asset.gltf\"}]}},\n",
                   ty_shape_params()->name);
    ty_text_add(&out, "    \"materials\": {\"type\": \"object\", \"additionalProperties\": {\"anyOf\": [{\"$ref\": "
                      "\"#/$defs/material.surface\"}, {\"$ref\": \"#/$defs/material.cdrf\"}, {\"$ref\": "
                      "\"#/$defs/material.walk\"}, {\"$ref\": \"#/$defs/material.bark\"}]}},\n"
                      "    \"objects\": {\"type\": \"array\", \"items\": {\"$ref\": \"#/$defs/object\"}},\n"
                      "    \"lights\": {\"type\": \"array\", \"items\": {\"$ref\": \"#/$defs/light\"}}\n  },\n"
                      "  \"$defs\": {\n");
    add_definitions(&out);
    ty_text_add(&out, "  }\n}\n");
    return ty_text_take(&out);
}
