// SPDX-License-Identifier: Apache-2.0
// The frame of a state's file: format, size, and the recipe's rows as lines of a name and a hash.
#include "pattern_state.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/hash.h>

enum
{
    NAME_SIZE = 96,
    LINE_SIZE = NAME_SIZE + 24,
    MOST_NAMED = 6 // rows in a message
};

// --- the recipe as lines ---

typedef struct print
{
    const pattern_state_kind* kind;
    char* text;
    size_t size, room;
} print;

static bool is_free(const pattern_state_kind* kind, const char* path)
{
    for (const char* const* row = kind->free_rows; *row; row++)
        if (strcmp(*row, path) == 0)
            return true;
    return false;
}

static void line_add(print* p, const char* name, ty_hash hash)
{
    if (p->size + LINE_SIZE > p->room)
    {
        size_t room = 2 * p->room + LINE_SIZE;
        p->text = ty_grow(p->text, p->room, room, 1);
        p->room = room;
    }
    p->size += (size_t)snprintf(p->text + p->size, LINE_SIZE, "%s %016llx\n", name,
                                (unsigned long long)(hash.low ^ hash.high));
}

// Of one row of def. skip: paths within it.
static ty_hash row_hash(const ty_param* row, const void* def, const char* const* skip)
{
    const ty_param_table table = {.size = 0, .params = row, .count = 1};
    ty_hasher* hasher = ty_hasher_create();
    ty_params_add_to_hash(&table, def, skip, hasher);
    return ty_hasher_end(hasher);
}

static void list_print(print* p, const ty_param* row, const ty_param_list* list, const char* name)
{
    for (int i = 0; i < list->count; i++)
    {
        char item[NAME_SIZE];
        ty_param_list one = {(char*)list->items + (size_t)i * row->group->size, 1};
        ty_param alone = *row;
        alone.offset = 0;
        snprintf(item, sizeof item, "%.72s[%d]", name, i);
        line_add(p, item, row_hash(&alone, &one, p->kind->free_rows));
    }
}

static void table_print(print* p, const ty_param_table* table, const char* def, const char* prefix)
{
    for (int i = 0; i < table->count; i++)
    {
        const ty_param* row = &table->params[i];
        char name[NAME_SIZE];
        snprintf(name, sizeof name, "%s%s%s", prefix, *prefix ? "." : "", row->name);
        if (is_free(p->kind, name))
            continue;
        if (row->type == TY_PARAM_GROUP)
            table_print(p, row->group, def + row->offset, name);
        else if (row->type == TY_PARAM_LIST)
            list_print(p, row, (const ty_param_list*)(const void*)(def + row->offset), name);
        else
            line_add(p, name, row_hash(row, def, NULL));
    }
}

// The caller frees it.
static char* recipe_print(const pattern_state_kind* kind, const void* def)
{
    print p = {.kind = kind};
    table_print(&p, kind->table, def, "");
    return p.text;
}

// --- the file ---

ty_exr* pattern_state_create(const pattern_state_kind* kind, const void* def, int width, int height)
{
    const int window[4] = {0, 0, width - 1, height - 1};
    ty_exr* state = ty_exr_create(window, window);
    char* text = recipe_print(kind, def);
    ty_exr_add_string(state, "tsuya/state", kind->format);
    ty_exr_add_string(state, "tsuya/made_by", text);
    ty_free(text);
    return state;
}

static const char* text_find(const ty_exr* state, const char* name)
{
    const ty_exr_attribute* a = ty_exr_find_attribute(state, name);
    return a && a->type == TY_EXR_STRING ? a->text : "";
}

ty_status pattern_state_read(const pattern_state_kind* kind, const ty_bytes* bytes, ty_exr** out, ty_error* error)
{
    ty_status status = ty_exr_read_memory("the state", bytes->data, bytes->size, out, error);
    if (status != TY_OK || strcmp(text_find(*out, "tsuya/state"), kind->format) == 0)
        return status;
    ty_exr_destroy(*out);
    *out = NULL;
    return ty_error_set(error, TY_BAD_FILE, "the state to go on from is not one of %s", kind->article);
}

bool pattern_state_number(const ty_exr* state, const char* name, int* out)
{
    const ty_exr_attribute* a = ty_exr_find_attribute(state, name);
    if (!a || a->type != TY_EXR_INT1)
        return false;
    *out = a->integer[0];
    return true;
}

const void* pattern_state_plane(const ty_exr* state, const char* name, ty_exr_type type)
{
    const ty_exr_channel* channel = ty_exr_find_channel(state, name);
    return channel && channel->type == type ? channel->pixels : NULL;
}

// --- is it this recipe's? ---

static size_t line_length(const char* line)
{
    return strcspn(line, "\n");
}

static bool has_line(const char* text, const char* line, size_t length)
{
    while (*text && (strncmp(text, line, length) != 0 || text[length] != '\n'))
        text += line_length(text) + (text[line_length(text)] != 0);
    return *text != 0;
}

typedef struct differences
{
    char first[NAME_SIZE], others[MOST_NAMED * NAME_SIZE];
    int count;
} differences;

static void difference_add(differences* d, const char* line)
{
    char name[NAME_SIZE];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(line, " \n"), line);
    size_t used = strlen(d->others);
    if (d->count == 0)
        memcpy(d->first, name, sizeof name);
    else if (strcmp(d->first, name) == 0 || strstr(d->others, name))
        return;
    else if (d->count < MOST_NAMED)
        snprintf(d->others + used, sizeof d->others - used, "%s%s", d->count > 1 ? ", " : "; so do ", name);
    d->count++;
}

// Lines of text that are not among those of the other.
static void lines_compare(differences* d, const char* text, const char* other)
{
    while (*text)
    {
        size_t length = line_length(text);
        if (!has_line(other, text, length))
            difference_add(d, text);
        text += length + (text[length] != 0);
    }
}

ty_status pattern_state_check(const pattern_state_kind* kind, const ty_exr* state, const void* def, int width,
                              int height, ty_error* error)
{
    if (ty_exr_width(state) != width || ty_exr_height(state) != height)
        return ty_error_set(error, TY_BAD_INPUT, "cells: [%d, %d]; the state to go on from has %d x %d", width, height,
                            ty_exr_width(state), ty_exr_height(state));
    differences d = {0};
    const char* before = text_find(state, "tsuya/made_by");
    char* now = recipe_print(kind, def);
    lines_compare(&d, now, before);
    lines_compare(&d, before, now);
    ty_free(now);
    if (d.count == 0)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "%s: differs from that of the state to go on from%s%s", d.first, d.others,
                        d.count > MOST_NAMED ? ", ..." : "");
}
