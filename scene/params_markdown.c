// SPDX-License-Identifier: Apache-2.0
// The reference page: every table as Markdown.
#include "number.h"
#include <string.h>
#include <tsuya/scene/scene.h>

// A bar would end the cell.
static void add_cell(ty_text* out, const char* text)
{
    ty_text_add(out, " ");
    for (const char* c = text + strspn(text, " "); *c; ++c)
    {
        if (*c == '|')
            ty_text_add(out, "\\");
        ty_text_add_bytes(out, c, 1);
    }
    ty_text_add(out, " |");
}

static void add_accepted(ty_text* out, const ty_param* row)
{
    ty_text cell = {0};
    if (row->group)
        ty_text_format(&cell, "%s of `%s`", row->type == TY_PARAM_LIST ? "a list" : "a mapping", row->group->name);
    else
        ty_param_expected(row, &cell);
    add_cell(out, cell.data);
    ty_text_term(&cell);
}

static void add_default(ty_text* out, const ty_param* row, const void* def)
{
    ty_text value = {0}, cell = {0};
    if (row->required)
        ty_text_add(&cell, "*required*");
    else
        ty_param_value_text(row, def, &value);
    if (value.size)
        ty_text_format(&cell, "`%s`", value.data);
    add_cell(out, cell.size ? cell.data : "");
    ty_text_term(&value);
    ty_text_term(&cell);
}

static void add_table(ty_text* out, const ty_param_table* table)
{
    void* def = ty_alloc(1, table->size);
    table->set_default(def);
    ty_text_format(out, "\n## %s\n\n%s\n\n", table->name, table->help);
    ty_text_add(out, "| key | accepted | default | meaning |\n|---|---|---|---|\n");
    for (int i = 0; i < table->count; ++i)
    {
        const ty_param* row = &table->params[i];
        ty_text_format(out, "| `%s` |", row->name);
        add_accepted(out, row);
        add_default(out, row, def);
        add_cell(out, row->help ? row->help : "");
        ty_text_add(out, "\n");
    }
    ty_free(def);
}

char* ty_params_markdown(void)
{
    int count = 0;
    const ty_param_table* const* tables = ty_scene_tables(&count);
    ty_text out = {0};
    ty_text_add(&out,
                "# Scene and recipe reference\n\n"
                "Written by `tsuya params --markdown` from the tables that the program reads files with.\n\n"
                "Units: metres unless a row says otherwise; angles in degrees. Colours are linear ACEScg unless a "
                "space is named; `'#rrggbb'` is sRGB. `$name` as a whole value is replaced by the variable `name`.\n");
    for (int i = 0; i < count; ++i)
        add_table(&out, tables[i]);
    return ty_text_take(&out);
}
