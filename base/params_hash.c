// SPDX-License-Identifier: Apache-2.0
// What a struct that a table describes holds, as a hash.
#include <stdio.h>
#include <string.h>
#include <tsuya/base/params.h>
#include <tsuya/base/rng.h>

enum
{
    PATH_SIZE = 256,
};

typedef struct walk
{
    const char* const* skip;
    ty_hasher* hasher;
    char path[PATH_SIZE];
} walk;

static void add_text(ty_hasher* hasher, const char* text)
{
    const bool given = text != NULL;
    ty_hasher_add(hasher, &given, sizeof given);
    if (given)
        ty_hasher_add_string(hasher, text);
}

// Bytes of a row that is plain numbers; 0 of others.
static size_t plain_size(ty_param_type type)
{
    switch (type)
    {
    case TY_PARAM_BOOL:
        return sizeof(bool);
    case TY_PARAM_INT:
    case TY_PARAM_ENUM:
        return sizeof(int);
    case TY_PARAM_INT2:
        return 2 * sizeof(int);
    case TY_PARAM_FLOAT:
        return sizeof(float);
    case TY_PARAM_FLOAT2:
        return 2 * sizeof(float);
    case TY_PARAM_FLOAT3:
        return sizeof(ty_vec3);
    case TY_PARAM_RGB:
        return sizeof(ty_rgb);
    case TY_PARAM_SEED:
        return sizeof(ty_seed);
    default:
        return 0;
    }
}

static void add_input(ty_hasher* hasher, const ty_input* input)
{
    const int modes[3] = {input->product, input->mapping, input->channel};
    const float numbers[4] = {input->scale, input->offset, input->size, input->blend};
    const ty_vec2 place[3] = {input->uv_x, input->uv_y, input->uv_t};
    ty_hasher_add(hasher, &input->value, sizeof input->value);
    ty_hasher_add(hasher, modes, sizeof modes);
    ty_hasher_add(hasher, numbers, sizeof numbers);
    ty_hasher_add(hasher, place, sizeof place);
    add_text(hasher, input->texture);
    add_text(hasher, input->attribute);
}

static void add_table(walk* w, const ty_param_table* table, const char* def, size_t length);

static void add_list(walk* w, const ty_param* row, const ty_param_list* list, size_t length)
{
    ty_hasher_add(w->hasher, &list->count, sizeof list->count);
    for (int i = 0; i < list->count; i++)
        if (row->type == TY_PARAM_LIST)
            add_table(w, row->group, (const char*)list->items + (size_t)i * row->group->size, length);
        else if (row->type == TY_PARAM_POINTS2)
            ty_hasher_add(w->hasher, (const ty_vec2*)list->items + i, sizeof(ty_vec2));
        else if (row->type == TY_PARAM_POINTS)
            ty_hasher_add(w->hasher, (const ty_vec3*)list->items + i, sizeof(ty_vec3));
        else
        {
            add_text(w->hasher, ((const ty_param_name*)list->items)[i].key);
            add_text(w->hasher, ((const ty_param_name*)list->items)[i].value);
        }
}

static void add_strings(walk* w, const ty_param_strings* strings)
{
    ty_hasher_add(w->hasher, &strings->count, sizeof strings->count);
    for (int i = 0; i < strings->count; i++)
        add_text(w->hasher, strings->items[i]);
}

static void add_value(walk* w, const ty_param* row, const void* at, size_t length)
{
    const char* const* text = at;
    const bool given = (row->type == TY_PARAM_PATH || row->type == TY_PARAM_FRAMES) && *text;
    switch (row->type)
    {
    case TY_PARAM_STRING:
        add_text(w->hasher, *text);
        return;
    case TY_PARAM_PATH:
    case TY_PARAM_FRAMES:
        ty_hasher_add(w->hasher, &given, sizeof given);
        return;
    case TY_PARAM_SCALAR_INPUT:
    case TY_PARAM_COLOR_INPUT:
    case TY_PARAM_VECTOR_INPUT:
        add_input(w->hasher, at);
        return;
    case TY_PARAM_GROUP:
    case TY_PARAM_BRIEF_GROUP:
        add_table(w, row->group, at, length);
        return;
    case TY_PARAM_LIST:
    case TY_PARAM_POINTS:
    case TY_PARAM_POINTS2:
    case TY_PARAM_NAMES:
        add_list(w, row, at, length);
        return;
    case TY_PARAM_STRINGS:
        add_strings(w, at);
        return;
    default:
        ty_hasher_add(w->hasher, at, plain_size(row->type));
    }
}

static bool is_skipped(const walk* w)
{
    for (const char* const* skip = w->skip; skip && *skip; skip++)
        if (strcmp(*skip, w->path) == 0)
            return true;
    return false;
}

static void add_table(walk* w, const ty_param_table* table, const char* def, size_t length)
{
    for (int i = 0; i < table->count; i++)
    {
        const ty_param* row = &table->params[i];
        int added = snprintf(w->path + length, PATH_SIZE - length, "%s%s", length > 0 ? "." : "", row->name);
        if (is_skipped(w))
            continue;
        ty_hasher_add_string(w->hasher, row->name);
        add_value(w, row, def + row->offset, length + (size_t)added);
    }
}

void ty_params_add_to_hash(const ty_param_table* table, const void* def, const char* const* skip, ty_hasher* hasher)
{
    walk w = {.skip = skip, .hasher = hasher};
    add_table(&w, table, def, 0);
}
