// SPDX-License-Identifier: Apache-2.0
// `tsuya params`: a table, or one row, as aligned text.
#include "number.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/suggest.h>
#include <tsuya/scene/scene.h>

enum
{
    NAME,
    TYPE,
    RANGE,
    DEFAULT,
    HELP,
    COLUMNS
};

// The texts of one row, each in its column.
typedef struct ty_row_text
{
    char* cells[COLUMNS];
} ty_row_text;

static char* take_trimmed(ty_text* text)
{
    size_t blanks = text->size ? strspn(text->data, " ") : 0;
    char* copy = ty_string_copy(text->size ? text->data + blanks : "");
    ty_text_term(text);
    return copy;
}

static ty_row_text describe_row(const ty_param* row, const void* def)
{
    ty_text range = {0}, value = {0}, help = {0};
    if (row->type == TY_PARAM_ENUM)
        for (int i = 0; row->choices[i]; ++i)
            ty_text_format(&range, "%s%s", i ? "|" : "", row->choices[i]);
    else if (row->group)
        ty_text_format(&range, "see %s", row->group->name);
    else
        ty_param_range_text(row, &range);
    if (row->required)
        ty_text_add(&value, "(required)");
    else
        ty_param_value_text(row, def, &value);
    ty_text_add(&help, row->help ? row->help : "");
    return (ty_row_text){{ty_string_copy(row->name), ty_string_copy(ty_param_type_name(row->type)),
                          take_trimmed(&range), take_trimmed(&value), take_trimmed(&help)}};
}

static void write_table(ty_text* out, const ty_param_table* table, const ty_param* only)
{
    static const int widest[COLUMNS] = {[NAME] = 24, [TYPE] = 13, [RANGE] = 28, [DEFAULT] = 22};
    void* def = ty_alloc(1, table->size);
    table->set_default(def);
    ty_row_text* rows = TY_ALLOC(ty_row_text, table->count);
    int widths[COLUMNS] = {0};
    for (int i = 0; i < table->count; ++i)
    {
        rows[i] = describe_row(&table->params[i], def);
        for (int c = 0; c < HELP; ++c)
        {
            int length = (int)strlen(rows[i].cells[c]);
            if (length <= widest[c] && length > widths[c])
                widths[c] = length;
        }
    }
    ty_text_format(out, "%s: %s\n", table->name, table->help);
    for (int i = 0; i < table->count; ++i)
    {
        bool shown = !only || only == &table->params[i];
        for (int c = 0; c < COLUMNS && shown; ++c)
        {
            int space = c == HELP ? 0 : widths[c] - (int)strlen(rows[i].cells[c]);
            ty_text_format(out, "  %s", rows[i].cells[c]);
            ty_text_repeat(out, ' ', space);
        }
        ty_text_add(out, shown ? "\n" : "");
        for (int c = 0; c < COLUMNS; ++c)
            ty_free(rows[i].cells[c]);
    }
    ty_free(rows);
    ty_free(def);
}

// "cdrf" finds "material.cdrf".
static bool names_table(const char* path, const ty_param_table* table)
{
    const char* dot = strrchr(table->name, '.');
    return strcmp(path, table->name) == 0 || (dot && strcmp(path, dot + 1) == 0);
}

static char* text_of_row(const char* path, const ty_param_table* const* tables, int count)
{
    const char* dot = strrchr(path, '.');
    if (!dot)
        return NULL;
    char* owner = ty_string_format("%.*s", (int)(dot - path), path);
    ty_text out = {0};
    for (int i = 0; i < count && !out.size; ++i)
        for (int r = 0; r < tables[i]->count && names_table(owner, tables[i]); ++r)
            if (strcmp(tables[i]->params[r].name, dot + 1) == 0)
                write_table(&out, tables[i], &tables[i]->params[r]);
    ty_free(owner);
    return out.size ? ty_text_take(&out) : NULL;
}

static void suggest(const char* path, const ty_param_table* const* tables, int count, char suggestion[64])
{
    const char** names = TY_ALLOC(const char*, 2 * count);
    for (int i = 0; i < count; ++i)
    {
        const char* dot = strrchr(tables[i]->name, '.');
        names[i] = tables[i]->name;
        names[count + i] = dot ? dot + 1 : NULL;
    }
    const char* best = ty_suggest_name(path, names, 2 * count);
    snprintf(suggestion, 64, "%s", best ? best : "");
    ty_free(names);
}

char* ty_params_text(const char* path, char suggestion[64])
{
    int count = 0;
    const ty_param_table* const* tables = ty_scene_tables(&count);
    ty_text out = {0};
    suggestion[0] = 0;
    for (int i = 0; i < count && !path; ++i)
    {
        ty_text_add(&out, i ? "\n" : "");
        write_table(&out, tables[i], NULL);
    }
    for (int exact = 1; exact >= 0 && path && !out.size; --exact)
        for (int i = 0; i < count && !out.size; ++i)
            if (exact ? strcmp(path, tables[i]->name) == 0 : names_table(path, tables[i]))
                write_table(&out, tables[i], NULL);
    if (out.size || !path)
        return ty_text_take(&out);
    char* row = text_of_row(path, tables, count);
    if (!row)
        suggest(path, tables, count, suggestion);
    return row;
}
