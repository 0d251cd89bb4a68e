// SPDX-License-Identifier: Apache-2.0
// NAME=VALUES: lists and ranges to the values of an axis.
#include "number.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/arena.h>
#include <tsuya/base/memory.h>
#include <tsuya/scene/sweep.h>

typedef struct parsing
{
    ty_sweep* sweep;
    ty_sweep_axis* axis;
    int capacity; // of its values
    ty_error_list* errors;
    bool failed;
} parsing;

TY_PRINTF(3, 4) static void report(parsing* p, int column, const char* format, ...)
{
    char text[768];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    ty_error error;
    (void)ty_error_set_at(&error, TY_USAGE, "--vary", 1, column, "%s (in '--vary %s')", text, p->axis->argument);
    ty_error_list_add(p->errors, &error);
    p->failed = true;
}

static void add_value(parsing* p, const char* text, int column, bool literal)
{
    ty_sweep_axis* axis = p->axis;
    if (axis->count == p->capacity)
    {
        p->capacity = p->capacity ? 2 * p->capacity : 16;
        ty_sweep_value* larger = TY_ARENA_ALLOC(p->sweep->arena, ty_sweep_value, p->capacity);
        if (axis->count)
            memcpy(larger, axis->values, (size_t)axis->count * sizeof *larger);
        axis->values = larger;
    }
    char* override = ty_arena_format(p->sweep->arena, "%s=%s", axis->name, text);
    axis->values[axis->count++] = (ty_sweep_value){override + strlen(axis->name) + 1, override, column, literal};
}

// --- ranges ---

typedef struct range
{
    double from, to;
    int count;
    bool log;
} range;

static double range_value(const range* r, int i)
{
    if (i == 0 || i == r->count - 1)
        return i ? r->to : r->from;
    double s = (double)i / (r->count - 1);
    return r->log ? r->from * pow(r->to / r->from, s) : r->from + (r->to - r->from) * s;
}

// Whether so many digits keep the ends and tell all values apart. They fall or rise, so neighbours suffice.
static bool digits_suffice(const range* r, int digits)
{
    char before[40] = "", text[40];
    for (int i = 0; i < r->count; ++i)
    {
        snprintf(text, sizeof text, "%.*g", digits, range_value(r, i));
        bool is_end = i == 0 || i == r->count - 1;
        if (strcmp(text, before) == 0 || (is_end && strtod(text, NULL) != range_value(r, i)))
            return false;
        memcpy(before, text, sizeof before);
    }
    return true;
}

static void add_range(parsing* p, const range* r, int column)
{
    static const int choices[] = {6, 9, 12, 15};
    int digits = 17;
    for (int i = 3; i >= 0; --i)
        digits = digits_suffice(r, choices[i]) ? choices[i] : digits;
    for (int i = 0; i < r->count; ++i)
    {
        char text[40];
        snprintf(text, sizeof text, "%.*g", digits, range_value(r, i) + 0.0); // no minus in front of zero
        add_value(p, text, column, false);
    }
}

// The part of text up to a colon, without it; NULL at the end.
static char* take_part(char** text, int* column, int* begin)
{
    char* part = *text;
    *begin = *column;
    if (!part)
        return NULL;
    char* colon = strchr(part, ':');
    *text = colon ? colon + 1 : NULL;
    *column += colon ? (int)(colon - part) + 1 : 0;
    if (colon)
        *colon = 0;
    return part;
}

static void read_range(parsing* p, char* text, int column)
{
    range r = {0};
    double count = 0.0;
    int begin[5], now = column;
    char* part[5];
    for (int i = 0; i < 5; ++i)
        part[i] = take_part(&text, &now, &begin[i]);
    r.log = part[3] && strcmp(part[3], "log") == 0;
    if (!part[2] || part[4])
        report(p, column, "a range is FROM:TO:COUNT or FROM:TO:COUNT:log");
    else if (!ty_number_parse(part[0], &r.from))
        report(p, begin[0], "expected a number, got '%s'", part[0]);
    else if (!ty_number_parse(part[1], &r.to))
        report(p, begin[1], "expected a number, got '%s'", part[1]);
    else if (!ty_number_parse(part[2], &count) || !(count >= 2 && count <= TY_SWEEP_VALUES) || floor(count) < count)
        report(p, begin[2], "expected a count of values 2..%d, got '%s'", TY_SWEEP_VALUES, part[2]);
    else if (part[3] && !r.log)
        report(p, begin[3], "expected 'log' or nothing, got '%s'", part[3]);
    else if (r.from == r.to)
        report(p, column, "the range is empty: it begins and ends at %s", part[0]);
    else if (r.log && !(r.from > 0.0 && r.to > 0.0))
        report(p, column, "a range in equal ratios (log) needs ends above 0");
    else
    {
        r.count = (int)count;
        add_range(p, &r, column);
    }
}

// --- lists ---

// From a number up to a colon: no text, path or time of day begins so.
static bool is_range(const char* item)
{
    char head[64];
    double value;
    size_t size = strcspn(item, ":");
    if (!item[size] || size >= sizeof head)
        return false;
    memcpy(head, item, size);
    head[size] = 0;
    return ty_number_parse(head, &value);
}

static void read_item(parsing* p, char* text, size_t size, int column)
{
    while (size > 0 && text[size - 1] == ' ')
        --size;
    size_t blanks = strspn(text, " ");
    blanks = blanks < size ? blanks : size;
    column += (int)blanks;
    char* item = ty_arena_format(p->sweep->arena, "%.*s", (int)(size - blanks), text + blanks);
    if (!item[0])
        report(p, column, "a value is missing; expected " TY_SWEEP_SYNTAX);
    else if (is_range(item))
        read_range(p, item, column);
    else
        add_value(p, item, column, true);
    if (p->axis->count > TY_SWEEP_VALUES)
        report(p, column, "more than %d values", TY_SWEEP_VALUES);
}

// The end of the item at text: a comma outside brackets and quotes, or the end of all.
static size_t find_end(parsing* p, const char* text, int column)
{
    char closing[32];
    int depth = 0;
    int opened[32];
    size_t i = 0;
    for (; text[i] && (text[i] != ',' || depth); ++i)
    {
        char c = text[i];
        bool quoted = depth && (closing[depth - 1] == '"' || closing[depth - 1] == '\'');
        if (depth && c == closing[depth - 1])
            --depth;
        else if (!quoted && strchr("[{\"'", c) && depth < 32)
        {
            opened[depth] = column + (int)i;
            closing[depth++] = c == '[' ? ']' : c == '{' ? '}' : c;
        }
    }
    if (depth)
        report(p, opened[depth - 1], "'%c' is not closed", text[opened[depth - 1] - column]);
    return i;
}

static void check_twice(parsing* p)
{
    const ty_sweep_axis* axis = p->axis;
    for (int i = 1; i < axis->count && !p->sweep->zip; ++i)
        for (int k = 0; k < i && !p->failed; ++k)
            if (strcmp(axis->values[i].text, axis->values[k].text) == 0)
                report(p, axis->values[i].column, "the value '%.200s' is there twice", axis->values[i].text);
}

// `frame` and the sections of a scene need no dot to be paths.
static bool is_path(const char* name)
{
    static const char* const sections[] = {"frame", "ocio", "film", "camera", "render", "timeline", "turntable"};
    for (size_t i = 0; i < sizeof sections / sizeof sections[0]; ++i)
        if (strcmp(name, sections[i]) == 0)
            return true;
    return strchr(name, '.') != NULL;
}

static void read_axis(parsing* p, const char* argument)
{
    p->axis = &p->sweep->axes[p->sweep->axis_count++];
    p->capacity = 0;
    p->failed = false;
    p->axis->argument = ty_arena_string(p->sweep->arena, argument);
    size_t length = strcspn(argument, "=");
    p->axis->name = ty_arena_format(p->sweep->arena, "%.*s", (int)length, argument);
    p->axis->is_variable = !is_path(p->axis->name);
    if (!argument[length] || length == 0)
    {
        report(p, 1, "expected NAME=VALUES, with VALUES as " TY_SWEEP_SYNTAX);
        return;
    }
    size_t at = length;
    do
    {
        ++at; // over the = or the comma
        size_t size = find_end(p, argument + at, (int)at + 1);
        char* item = ty_arena_format(p->sweep->arena, "%.*s", (int)size, argument + at);
        if (!p->failed)
            read_item(p, item, size, (int)at + 1);
        at += size;
    } while (argument[at] && !p->failed);
    if (!p->failed)
        check_twice(p);
}

// --- all of them ---

// Whether one is the other or lies in it.
static bool overlaps(const char* a, const char* b)
{
    size_t length = strlen(a);
    return strncmp(a, b, length) == 0 && (b[length] == '\0' || b[length] == '.');
}

static void check_names(parsing* p)
{
    ty_sweep* sweep = p->sweep;
    for (int i = 1; i < sweep->axis_count; ++i)
        for (int k = 0; k < i; ++k)
        {
            p->axis = &sweep->axes[i];
            const char *a = sweep->axes[i].name, *b = sweep->axes[k].name;
            if (a[0] && b[0] && (overlaps(a, b) || overlaps(b, a)))
                report(p, 1, "'%s' varies already, in '--vary %.200s'", a, sweep->axes[k].argument);
        }
}

static void count_zip(parsing* p)
{
    ty_sweep* sweep = p->sweep;
    sweep->cell_count = sweep->axes[0].count;
    for (int a = 1; a < sweep->axis_count; ++a)
    {
        p->axis = &sweep->axes[a];
        if (p->axis->count != sweep->axes[0].count)
            report(p, (int)strlen(p->axis->name) + 2,
                   "--zip takes as many values of each: here are %d, and %d of '%.200s'", p->axis->count,
                   sweep->axes[0].count, sweep->axes[0].name);
    }
    for (int i = 1; i < sweep->cell_count && !p->failed; ++i)
        for (int k = 0; k < i && !p->failed; ++k)
        {
            bool same = true;
            for (int a = 0; a < sweep->axis_count; ++a)
                same &= strcmp(sweep->axes[a].values[i].text, sweep->axes[a].values[k].text) == 0;
            if (same)
                report(p, sweep->axes[sweep->axis_count - 1].values[i].column,
                       "values %d and %d are the same in all that varies", k + 1, i + 1);
        }
}

static void count_cells(parsing* p, int most)
{
    ty_sweep* sweep = p->sweep;
    int64_t cells = 1;
    p->failed = false;
    if (sweep->zip)
        count_zip(p);
    for (int a = 0; a < sweep->axis_count && !sweep->zip && cells <= most; ++a)
        cells *= sweep->axes[a].count;
    sweep->cell_count = sweep->zip ? sweep->cell_count : (int)cells;
    p->axis = &sweep->axes[sweep->axis_count - 1];
    if (!p->failed && (cells > most || sweep->cell_count > most))
        report(p, 1, "more than %d cells; --most-cells allows more", most);
}

ty_status ty_sweep_parse(const ty_sweep_def* def, ty_sweep* out, ty_error_list* errors)
{
    int first = errors->count;
    *out = (ty_sweep){.arena = ty_arena_create(0), .zip = def->zip};
    out->axes = TY_ARENA_ALLOC(out->arena, ty_sweep_axis, TY_SWEEP_AXES);
    parsing p = {.sweep = out, .errors = errors};
    for (int i = 0; i < def->argument_count && i < TY_SWEEP_AXES; ++i)
        read_axis(&p, def->arguments[i]);
    check_names(&p);
    if (out->axis_count == 0 || def->argument_count > TY_SWEEP_AXES)
    {
        ty_error error;
        (void)ty_error_set(&error, TY_USAGE, "--vary: expected 1..%d parameters, got %d", TY_SWEEP_AXES,
                           def->argument_count);
        ty_error_list_add(errors, &error);
    }
    if (errors->count == first)
        count_cells(&p, def->most_cells);
    if (errors->count == first)
        return TY_OK;
    ty_sweep_term(out);
    return TY_USAGE;
}

void ty_sweep_term(ty_sweep* sweep)
{
    ty_arena_destroy(sweep->arena);
    *sweep = (ty_sweep){0};
}
