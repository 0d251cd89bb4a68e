// SPDX-License-Identifier: Apache-2.0
// Tables to structs: every key looked up, every value checked, every mistake reported where it stands.
#include "params_read.h"
#include "nearest.h"
#include "number.h"
#include <float.h>
#include <limits.h>
#include <string.h>

#define MAX_LIST 65536

void ty_param_report_type(ty_reader* reader, const ty_node* node, const ty_param* row)
{
    if (node->bad)
        return;
    char described[80];
    ty_text expected = {0};
    ty_param_expected(row, &expected);
    ty_report(reader->errors, node->place, TY_BAD_INPUT, "'%s': expected %s, got %s", row->name, expected.data,
              ty_node_describe(node, described));
    ty_text_term(&expected);
}

bool ty_param_in_range(ty_reader* reader, const ty_node* node, const ty_param* row, double value)
{
    bool bounded = row->minimum != 0.0 || row->maximum != 0.0;
    if (!bounded || (value >= row->minimum && value <= row->maximum))
        return true;
    ty_text range = {0};
    ty_param_range_text(row, &range);
    ty_report(reader->errors, node->place, TY_BAD_INPUT, "'%s' is %s: out of range, expected a number%s", row->name,
              node->text, range.data);
    ty_text_term(&range);
    return false;
}

bool ty_param_read_number(ty_reader* reader, const ty_node* node, const ty_param* row, float* out)
{
    double value = 0.0;
    if (node->kind != TY_NODE_SCALAR || !ty_number_parse(node->text, &value) ||
        fabs(value * ty_unit_scale(row->unit)) > (double)FLT_MAX)
    {
        ty_param_report_type(reader, node, row);
        return false;
    }
    if (!ty_param_in_range(reader, node, row, value))
        return false;
    *out = (float)(value * ty_unit_scale(row->unit));
    return true;
}

bool ty_param_read_numbers(ty_reader* reader, const ty_node* node, const ty_param* row, float* out, int count)
{
    if (node->kind != TY_NODE_LIST || node->count != count)
    {
        ty_param_report_type(reader, node, row);
        return false;
    }
    bool good = true;
    for (int i = 0; i < count; ++i)
        good &= ty_param_read_number(reader, node->items[i], row, &out[i]);
    return good;
}

static bool read_int(ty_reader* reader, const ty_node* node, const ty_param* row, int* out)
{
    double value = 0.0;
    bool is_whole = node->kind == TY_NODE_SCALAR && !strpbrk(node->text, ".eE") && ty_number_parse(node->text, &value);
    if (!is_whole || value < INT_MIN || value > INT_MAX)
    {
        ty_param_report_type(reader, node, row);
        return false;
    }
    *out = (int)value;
    return ty_param_in_range(reader, node, row, value);
}

static bool read_int2(ty_reader* reader, const ty_node* node, const ty_param* row, int* out)
{
    if (node->kind != TY_NODE_LIST || node->count != 2)
    {
        ty_param_report_type(reader, node, row);
        return false;
    }
    bool first = read_int(reader, node->items[0], row, &out[0]);
    return read_int(reader, node->items[1], row, &out[1]) && first;
}

static bool read_float2(ty_reader* reader, const ty_node* node, const ty_param* row, float* out)
{
    if (node->kind != TY_NODE_SCALAR)
        return ty_param_read_numbers(reader, node, row, out, 2);
    bool good = ty_param_read_number(reader, node, row, &out[0]);
    if (good)
        out[1] = out[0];
    return good;
}

static bool read_bool(ty_reader* reader, const ty_node* node, const ty_param* row, bool* out)
{
    bool is_true = node->kind == TY_NODE_SCALAR && strcmp(node->text, "true") == 0;
    bool is_false = node->kind == TY_NODE_SCALAR && strcmp(node->text, "false") == 0;
    if (is_true || is_false)
        *out = is_true;
    else
        ty_param_report_type(reader, node, row);
    return is_true || is_false;
}

static bool read_seed(ty_reader* reader, const ty_node* node, const ty_param* row, ty_seed* out)
{
    bool good = node->kind == TY_NODE_SCALAR && ty_seed_parse(node->text, &out->value);
    if (!good)
        ty_param_report_type(reader, node, row);
    return good;
}

static bool read_string(ty_reader* reader, const ty_node* node, const ty_param* row, const char** out)
{
    bool good = node->kind == TY_NODE_SCALAR && node->text[0];
    if (good)
        *out = node->text;
    else
        ty_param_report_type(reader, node, row);
    return good;
}

static bool read_enum(ty_reader* reader, const ty_node* node, const ty_param* row, int* out)
{
    if (node->kind != TY_NODE_SCALAR || node->text[0] == 0)
    {
        ty_param_report_type(reader, node, row);
        return false;
    }
    int count = 0;
    for (; row->choices[count]; ++count)
    {
        if (strcmp(row->choices[count], node->text) != 0)
            continue;
        *out = count;
        return true;
    }
    char nearest[TY_NEAREST_SIZE];
    ty_text expected = {0};
    ty_param_expected(row, &expected);
    const char* tail = ty_nearest(node->text, row->choices, count, nearest);
    ty_report(reader->errors, node->place, TY_BAD_INPUT, "'%s': '%.100s' is not %s%s", row->name, node->text,
              expected.data, strncmp(tail, "; did", 5) == 0 ? tail : "");
    ty_text_term(&expected);
    return false;
}

// A list of no more entries than are read; false after a report.
static bool is_list(ty_reader* reader, const ty_node* node, const ty_param* row)
{
    if (node->kind != TY_NODE_LIST)
    {
        ty_param_report_type(reader, node, row);
        return false;
    }
    if (node->count > MAX_LIST)
    {
        ty_report(reader->errors, node->place, TY_BAD_INPUT, "'%s': more than %d entries", row->name, MAX_LIST);
        return false;
    }
    return true;
}

static bool read_list(ty_reader* reader, ty_node* node, const ty_param* row, ty_param_list* out)
{
    if (!is_list(reader, node, row))
        return false;
    char* items = ty_arena_alloc(reader->arena, (size_t)node->count, row->group->size);
    bool good = true;
    for (int i = 0; i < node->count; ++i)
        good &= ty_params_read(reader, node->items[i], row->group, items + (size_t)i * row->group->size, NULL);
    *out = (ty_param_list){items, node->count};
    return good;
}

static bool read_points(ty_reader* reader, const ty_node* node, const ty_param* row, ty_param_list* out)
{
    int size = row->type == TY_PARAM_POINTS2 ? 2 : 3;
    if (!is_list(reader, node, row))
        return false;
    float* points = TY_ARENA_ALLOC(reader->arena, float, size * node->count);
    const ty_param each = {row->name,    size == 2 ? TY_PARAM_FLOAT2 : TY_PARAM_FLOAT3,
                           row->unit,    row->minimum,
                           row->maximum, NULL,
                           NULL,         0,
                           "",           false};
    bool good = true;
    for (int i = 0; i < node->count; ++i)
        good &= !node->items[i]->bad && ty_param_read_numbers(reader, node->items[i], &each, &points[size * i], size);
    *out = (ty_param_list){points, node->count};
    return good;
}

static bool read_names(ty_reader* reader, ty_node* node, const ty_param* row, ty_param_list* out)
{
    if (node->kind != TY_NODE_MAP)
    {
        ty_param_report_type(reader, node, row);
        return false;
    }
    ty_param_name* names = TY_ARENA_ALLOC(reader->arena, ty_param_name, node->count);
    bool good = true;
    for (int i = 0; i < node->count; ++i)
    {
        const ty_param named = {.name = node->keys[i].text, .type = TY_PARAM_STRING, .unit = ""};
        names[i].key = ty_arena_string(reader->arena, node->keys[i].text);
        good &= read_string(reader, node->items[i], &named, &names[i].value);
    }
    *out = (ty_param_list){names, node->count};
    return good;
}

static bool read_strings(ty_reader* reader, const ty_node* node, const ty_param* row, ty_param_strings* out)
{
    bool single = node->kind == TY_NODE_SCALAR && node->text[0];
    if (!single && !is_list(reader, node, row))
        return false;
    int count = single ? 1 : node->count;
    *out = (ty_param_strings){TY_ARENA_ALLOC(reader->arena, const char*, count), count};
    bool good = true;
    const ty_param text = {.name = row->name, .type = TY_PARAM_STRING, .unit = ""};
    for (int i = 0; i < count; ++i)
        good &= read_string(reader, single ? node : node->items[i], &text, &out->items[i]);
    return good;
}

// Keys of a group within a struct: the defaults are the struct's, not the group's.
static bool read_keys(ty_reader* reader, ty_node* node, const ty_param_table* table, void* def,
                      const char* const* skip);

static bool is_group_written(const ty_node* node)
{
    static const char* const of_inputs[] = {"attribute", "texture", "value"};
    for (int i = 0; i < TY_PARAM_COUNT(of_inputs); ++i)
        if (ty_node_find(node, of_inputs[i]) >= 0)
            return false;
    return node->kind == TY_NODE_MAP;
}

// A mapping of the group, else what its first row is under the group's name.
static bool read_brief(ty_reader* reader, ty_node* node, const ty_param* row, void* field)
{
    ty_param first = row->group->params[0];
    bool is_input = first.type == TY_PARAM_SCALAR_INPUT || first.type == TY_PARAM_COLOR_INPUT;
    if (is_input ? is_group_written(node) : node->kind == TY_NODE_MAP)
        return read_keys(reader, node, row->group, field, NULL);
    first.name = row->name;
    return ty_param_read(reader, node, &first, (char*)field + first.offset);
}

bool ty_param_read(ty_reader* reader, ty_node* node, const ty_param* row, void* field)
{
    if (node->bad)
        return false;
    switch (row->type)
    {
    case TY_PARAM_BOOL:
        return read_bool(reader, node, row, field);
    case TY_PARAM_INT:
        return read_int(reader, node, row, field);
    case TY_PARAM_INT2:
        return read_int2(reader, node, row, field);
    case TY_PARAM_FLOAT:
        return ty_param_read_number(reader, node, row, field);
    case TY_PARAM_FLOAT2:
        return read_float2(reader, node, row, field);
    case TY_PARAM_FLOAT3:
        return ty_param_read_numbers(reader, node, row, field, 3);
    case TY_PARAM_RGB:
        return ty_param_read_rgb(reader, node, row, field);
    case TY_PARAM_SEED:
        return read_seed(reader, node, row, field);
    case TY_PARAM_STRING:
        return read_string(reader, node, row, field);
    case TY_PARAM_PATH:
        return (*(const char**)field = ty_files_use(reader->files, node, row->name)) != NULL;
    case TY_PARAM_FRAMES:
        return (*(const char**)field = ty_files_use_either(reader->files, node, row->name)) != NULL;
    case TY_PARAM_ENUM:
        return read_enum(reader, node, row, field);
    case TY_PARAM_SCALAR_INPUT:
    case TY_PARAM_COLOR_INPUT:
    case TY_PARAM_VECTOR_INPUT:
        return ty_param_read_input(reader, node, row, field);
    case TY_PARAM_GROUP:
        return read_keys(reader, node, row->group, field, NULL);
    case TY_PARAM_BRIEF_GROUP:
        return read_brief(reader, node, row, field);
    case TY_PARAM_LIST:
        return read_list(reader, node, row, field);
    case TY_PARAM_POINTS:
    case TY_PARAM_POINTS2:
        return read_points(reader, node, row, field);
    case TY_PARAM_NAMES:
        return read_names(reader, node, row, field);
    case TY_PARAM_STRINGS:
        return read_strings(reader, node, row, field);
    }
    return false;
}

static int count_names(const char* const* names)
{
    int count = 0;
    while (names && names[count])
        ++count;
    return count;
}

static bool is_among(const char* name, const char* const* names)
{
    for (int i = 0; names && names[i]; ++i)
        if (strcmp(names[i], name) == 0)
            return true;
    return false;
}

static void report_unknown(ty_reader* reader, ty_key key, const char* of, const char* const* names, int count)
{
    char nearest[TY_NEAREST_SIZE];
    ty_report(reader->errors, key.place, TY_BAD_INPUT, "unknown key '%.200s' in %s%s", key.text, of,
              ty_nearest(key.text, names, count, nearest));
}

bool ty_params_check_keys(ty_reader* reader, const ty_node* map, const char* const* keys, const char* of)
{
    bool good = true;
    for (int i = 0; i < map->count; ++i)
        if (!is_among(map->keys[i].text, keys))
        {
            report_unknown(reader, map->keys[i], of, keys, count_names(keys));
            good = false;
        }
    return good;
}

static void report_unknown_row(ty_reader* reader, ty_key key, const ty_param_table* table, const char* const* skip)
{
    int extra = count_names(skip);
    const char** names = TY_ALLOC(const char*, table->count + extra);
    for (int i = 0; skip && i < extra; ++i)
        names[i] = skip[i];
    for (int i = 0; i < table->count; ++i)
        names[extra + i] = table->params[i].name;
    report_unknown(reader, key, table->name, names, table->count + extra);
    ty_free(names);
}

static const ty_param* find_row(const ty_param_table* table, const char* name)
{
    for (int i = 0; i < table->count; ++i)
        if (strcmp(table->params[i].name, name) == 0)
            return &table->params[i];
    return NULL;
}

static bool read_keys(ty_reader* reader, ty_node* node, const ty_param_table* table, void* def, const char* const* skip)
{
    char described[80];
    if (node->bad)
        return false;
    if (node->kind != TY_NODE_MAP)
    {
        ty_report(reader->errors, node->place, TY_BAD_INPUT, "expected a mapping of '%s' parameters, got %s",
                  table->name, ty_node_describe(node, described));
        return false;
    }
    bool good = true;
    for (int i = 0; i < node->count; ++i)
    {
        if (is_among(node->keys[i].text, skip))
            continue;
        const ty_param* row = find_row(table, node->keys[i].text);
        if (!row)
            report_unknown_row(reader, node->keys[i], table, skip);
        good &= row && ty_param_read(reader, node->items[i], row, (char*)def + row->offset);
    }
    for (int i = 0; i < table->count; ++i)
        if (table->params[i].required && ty_node_find(node, table->params[i].name) < 0)
        {
            ty_report(reader->errors, node->place, TY_BAD_INPUT, "missing key '%s' of %s: %s", table->params[i].name,
                      table->name, table->params[i].help);
            good = false;
        }
    return good;
}

bool ty_params_read(ty_reader* reader, ty_node* node, const ty_param_table* table, void* def, const char* const* skip)
{
    table->set_default(def);
    return read_keys(reader, node, table, def, skip);
}
