// SPDX-License-Identifier: Apache-2.0
// Cells of a sweep: their number, values and names, and whose mistake a mistake is.
#include <stdio.h>
#include <string.h>
#include <tsuya/base/hash.h>
#include <tsuya/base/memory.h>
#include <tsuya/scene/sweep.h>

// The readable part of a name that a hash follows.
enum
{
    READABLE = 120,
    HASH_DIGITS = 10
};

int ty_sweep_index(const ty_sweep* sweep, int cell, int axis)
{
    if (sweep->zip)
        return cell;
    for (int a = sweep->axis_count - 1; a > axis; --a)
        cell /= sweep->axes[a].count;
    return cell % sweep->axes[axis].count;
}

const ty_sweep_value* ty_sweep_value_at(const ty_sweep* sweep, int cell, int axis)
{
    return &sweep->axes[axis].values[ty_sweep_index(sweep, cell, axis)];
}

static bool is_plain(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || (c && strchr("._+-", c));
}

typedef struct name_text
{
    char* out;
    size_t size;
    bool replaced; // something of it is not as given
} name_text;

// A run of other characters becomes one underscore.
static void add_plain(name_text* name, const char* text)
{
    for (; *text; ++text)
    {
        bool plain = is_plain(*text);
        name->replaced |= !plain;
        if (name->size == READABLE)
        {
            name->replaced = true;
            return;
        }
        if (plain || (name->size > 0 && name->out[name->size - 1] != '_'))
            name->out[name->size++] = plain ? *text : '_';
    }
}

static void add_mark(name_text* name, char mark)
{
    if (name->size < READABLE)
        name->out[name->size++] = mark;
    else
        name->replaced = true;
}

void ty_sweep_name(const ty_sweep* sweep, int cell, char out[TY_SWEEP_NAME_MAX])
{
    name_text name = {.out = out};
    ty_hasher* hasher = ty_hasher_create();
    for (int a = 0; a < sweep->axis_count; ++a)
    {
        const ty_sweep_value* value = ty_sweep_value_at(sweep, cell, a);
        if (a)
            add_mark(&name, ',');
        add_plain(&name, sweep->axes[a].name);
        add_mark(&name, '=');
        add_plain(&name, value->text);
        ty_hasher_add_string(hasher, value->override);
    }
    char hex[33];
    ty_hash_hex(ty_hasher_end(hasher), hex);
    out[name.size] = 0;
    if (name.replaced)
        snprintf(out + name.size, TY_SWEEP_NAME_MAX - name.size, "~%.*s", HASH_DIGITS, hex);
}

// "... (in '--set camera.vfov=400')" in front of its last part, if that names the override.
static bool take_quote(ty_error* error, const char* flag, const char* override)
{
    char quote[sizeof error->text];
    snprintf(quote, sizeof quote, " (in '%s %s')", flag, override);
    size_t size = strlen(error->text), tail = strlen(quote);
    if (strcmp(error->file, flag) != 0 || size < tail || strcmp(error->text + size - tail, quote) != 0)
        return false;
    error->text[size - tail] = 0;
    return true;
}

bool ty_sweep_place_error(const ty_sweep* sweep, int cell, ty_error* error)
{
    for (int a = 0; a < sweep->axis_count; ++a)
    {
        const ty_sweep_axis* axis = &sweep->axes[a];
        const ty_sweep_value* value = ty_sweep_value_at(sweep, cell, a);
        if (!take_quote(error, axis->is_variable ? "-D" : "--set", value->override))
            continue;
        int begin = (int)strlen(axis->name) + 2; // of the value, in the override
        int within = value->literal && error->column > begin ? error->column - begin : 0;
        int column = error->column < begin ? error->column : value->column + within;
        char text[sizeof error->text];
        memcpy(text, error->text, sizeof text);
        const char* which = value->literal || error->column < begin ? "" : value->text;
        (void)ty_error_set_at(error, error->status, "--vary", 1, column, "%.600s%s%s%s (in '--vary %s')", text,
                              which[0] ? ", value " : "", which, which[0] ? " of the range" : "", axis->argument);
        return true;
    }
    return false;
}
