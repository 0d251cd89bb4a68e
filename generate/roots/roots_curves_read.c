// SPDX-License-Identifier: Apache-2.0
// Centre lines of roots from a file that somebody may have edited: each number held against its range, then the network
// against itself.
#include "roots_output.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>

#define MOST_BYTES ((size_t)1 << 30)

enum
{
    MOST_COLUMNS = 32,
    MOST_ELEMENTS = 8,
    WORD = 64,
};

// What a column holds; the order is that of point_columns and line_columns below.
enum
{
    X,
    NX = 3,
    RADIUS = 6,
    FLAT,
    SINK,
    ALONG,
    BIRTH,
    LINE,
    POINT_COLUMNS,
};
enum
{
    KIND,
    PARENT,
    END,
    KEY_LOW,
    KEY_HIGH,
    LINE_COLUMNS,
};

typedef struct column
{
    const char* name;
    double low, high;
    bool whole;
} column;

static const column point_columns[] = {
    {"x", -1e6, 1e6, false},      {"y", -1e6, 1e6, false},    {"z", -1e6, 1e6, false},
    {"nx", -1e3, 1e3, false},     {"ny", -1e3, 1e3, false},   {"nz", -1e3, 1e3, false},
    {"radius", 1e-6, 1e4, false}, {"flat", 0.3, 1.0, false},  {"sink", 0.0, 4.0, false},
    {"along", 0.0, 1e6, false},   {"birth", 0.0, 1.0, false}, {"line", 0, 2147483647.0, true},
};
static const column line_columns[] = {
    {"kind", 0, ROOTS_KINDS - 1, true}, {"parent", -1, 2147483647.0, true},  {"end", -1, 2147483647.0, true},
    {"key_low", 0, 4294967295.0, true}, {"key_high", 0, 4294967295.0, true},
};

typedef struct element
{
    char name[WORD];
    int rows;
    int columns[MOST_COLUMNS]; // which of the known ones, -1 = another
    int count;
} element;

typedef struct reader
{
    const char* path;
    const char *line, *next, *end; // of text: the line that is read, the one after it, all
    const char* at;
    int number; // of the line, from 1
    element elements[MOST_ELEMENTS];
    int element_count;
    int* rows; // [line_count] where each line stands in the file
    roots_network* net;
    ty_error* error;
} reader;

// --- text ---

static ty_status wrong(const reader* r, const char* word, const char* text)
{
    int place = word ? (int)(word - r->line) + 1 : 0;
    return ty_error_set_at(r->error, TY_BAD_INPUT, r->path, r->number, place, "%s", text);
}

static bool line_next(reader* r)
{
    if (r->next == r->end)
        return false;
    r->line = r->at = r->next;
    const char* newline = memchr(r->next, '\n', (size_t)(r->end - r->next));
    r->next = newline ? newline + 1 : r->end;
    r->number++;
    return true;
}

// The next word of the line; NULL at its end.
static const char* word_next(reader* r, char word[WORD])
{
    while (r->at < r->end && (*r->at == ' ' || *r->at == '\t' || *r->at == '\r'))
        r->at++;
    const char* begin = r->at;
    size_t size = 0;
    for (; r->at < r->end && (unsigned char)*r->at > ' '; r->at++)
        if (size + 1 < WORD)
            word[size++] = *r->at;
    word[size] = '\0';
    return r->at > begin ? begin : NULL;
}

static bool line_is_empty(const reader* r)
{
    const char* c = r->line;
    while (c < r->end && (*c == ' ' || *c == '\t' || *c == '\r'))
        c++;
    return c == r->end || *c == '\n';
}

static ty_status number_read(reader* r, const column* c, double* out)
{
    char word[WORD], text[256], *end;
    const char* place = word_next(r, word);
    if (!place)
    {
        snprintf(text, sizeof text, "the row ends before its '%s'", c ? c->name : "last number");
        return wrong(r, r->at, text);
    }
    *out = strtod(word, &end);
    if (!c)
        return TY_OK;
    bool good = !*end && *out >= c->low && *out <= c->high && (!c->whole || floor(*out) >= *out);
    if (good)
        return TY_OK;
    snprintf(text, sizeof text, "%s: %s; it is a %s %.10g..%.10g", c->name, word, c->whole ? "whole number" : "number",
             c->low, c->high);
    return wrong(r, place, text);
}

// --- header ---

static int column_find(const element* e, const char* name)
{
    bool points = strcmp(e->name, "vertex") == 0, lines = strcmp(e->name, "line") == 0;
    const column* columns = points ? point_columns : line_columns;
    int count = points ? POINT_COLUMNS : lines ? LINE_COLUMNS : 0;
    for (int i = 0; i < count; i++)
        if (strcmp(columns[i].name, name) == 0)
            return i;
    return -1;
}

static ty_status element_read(reader* r)
{
    static const column rows = {"the number of rows", 0, 1e8, true};
    double count;
    element* e = &r->elements[r->element_count];
    if (r->element_count == MOST_ELEMENTS)
        return wrong(r, r->line, "more than 8 elements");
    *e = (element){.count = 0};
    if (!word_next(r, e->name))
        return wrong(r, r->at, "expected the name of an element");
    ty_status status = number_read(r, &rows, &count);
    e->rows = (int)count;
    r->element_count += status == TY_OK;
    return status;
}

// The name is the line's last word: types do not matter to text.
static ty_status property_read(reader* r)
{
    char word[WORD] = "", name[WORD] = "";
    if (r->element_count == 0 || r->elements[r->element_count - 1].count == MOST_COLUMNS)
        return wrong(r, r->line, "a property belongs to an element, 32 at most");
    element* e = &r->elements[r->element_count - 1];
    while (word_next(r, word))
        memcpy(name, word, sizeof name);
    e->columns[e->count++] = column_find(e, name);
    return TY_OK;
}

static ty_status top_read(reader* r)
{
    static const column top = {"top", -1e6, 1e6, false};
    double value = 0.0;
    ty_status status = number_read(r, &top, &value);
    r->net->top = (float)value;
    return status;
}

// Whether every column of a known element is there.
static ty_status columns_check(reader* r, const char* name, const column* columns, int count)
{
    char text[256];
    for (int i = 0; i < r->element_count; i++)
    {
        const element* e = &r->elements[i];
        if (strcmp(e->name, name) != 0)
            continue;
        for (int c = 0; c < count; c++)
        {
            bool found = false;
            for (int k = 0; k < e->count; k++)
                found |= e->columns[k] == c;
            if (found)
                continue;
            snprintf(text, sizeof text, "the element '%s' lacks the property '%s'", name, columns[c].name);
            return wrong(r, NULL, text);
        }
        return TY_OK;
    }
    snprintf(text, sizeof text, "the element '%s' is missing", name);
    return wrong(r, NULL, text);
}

static ty_status header_read(reader* r)
{
    char word[WORD], format[WORD];
    ty_status status = TY_OK;
    if (!line_next(r) || !word_next(r, word) || strcmp(word, "ply") != 0)
        return wrong(r, r->line, "this is no PLY file: its first line is 'ply'");
    while (status == TY_OK)
    {
        if (!line_next(r))
            return wrong(r, NULL, "the file ends within its header");
        const char* place = word_next(r, word);
        if (!place)
            continue;
        if (strcmp(word, "end_header") == 0)
            break;
        if (strcmp(word, "format") == 0 && (!word_next(r, format) || strcmp(format, "ascii") != 0))
            return wrong(r, place, "centre lines are in the format 'ascii'");
        if (strcmp(word, "element") == 0)
            status = element_read(r);
        else if (strcmp(word, "property") == 0)
            status = property_read(r);
        else if (strcmp(word, "comment") == 0 && word_next(r, word) && strcmp(word, "top") == 0)
            status = top_read(r);
    }
    if (status == TY_OK)
        status = columns_check(r, "vertex", point_columns, POINT_COLUMNS);
    return status == TY_OK ? columns_check(r, "line", line_columns, LINE_COLUMNS) : status;
}

// --- rows ---

static ty_status row_read(reader* r, const element* e, const column* columns, double* values)
{
    char text[160];
    do
    {
        if (!line_next(r))
        {
            snprintf(text, sizeof text, "the file ends before the %d rows of '%s'", e->rows, e->name);
            return wrong(r, NULL, text);
        }
    } while (line_is_empty(r));
    double other;
    ty_status status = TY_OK;
    for (int k = 0; columns && k < e->count && status == TY_OK; k++)
    {
        int c = e->columns[k];
        status = number_read(r, c >= 0 ? &columns[c] : NULL, c >= 0 ? &values[c] : &other);
    }
    char word[WORD];
    const char* more = columns && status == TY_OK ? word_next(r, word) : NULL;
    return more ? wrong(r, more, "the row has more numbers than properties") : status;
}

// What comes after another point of the same line is farther from the trunk and not older.
static ty_status order_check(const reader* r, const roots_point* p, int line)
{
    char text[256];
    roots_network* net = r->net;
    int own = net->line_count - 1;
    if (line != own && line != own + 1)
    {
        snprintf(text, sizeof text,
                 "the points are out of order: line %d after line %d; those of a line stand together, and lines in the "
                 "order of their numbers from 0",
                 line, own);
        return wrong(r, r->line, text);
    }
    if (line == own + 1)
        return TY_OK;
    const roots_point* before = &net->points[net->point_count - 1];
    if (p->s >= before->s && p->birth >= before->birth)
        return TY_OK;
    snprintf(text, sizeof text,
             "the points of line %d are out of order: along %g after %g, birth %g after %g; both grow from the trunk",
             line, (double)p->s, (double)before->s, (double)p->birth, (double)before->birth);
    return wrong(r, r->line, text);
}

static ty_status point_take(reader* r, const double* v)
{
    roots_point p = {.p = {(float)v[X], (float)v[X + 1], (float)v[X + 2]},
                     .n = {(float)v[NX], (float)v[NX + 1], (float)v[NX + 2]},
                     .r = (float)v[RADIUS],
                     .flat = (float)v[FLAT],
                     .sink = (float)v[SINK],
                     .s = (float)v[ALONG],
                     .birth = (float)v[BIRTH]};
    int line = (int)v[LINE];
    float length = ty_length(p.n);
    if (!(length > 0.0f))
        return wrong(r, r->line, "nx ny nz: 0 0 0; a normal has a direction");
    if (fabsf(length - 1.0f) > 1e-3f) // what was written stays as it was, bit for bit
        p.n = ty_mul(p.n, 1.0f / length);
    ty_status status = order_check(r, &p, line);
    if (status != TY_OK)
        return status;
    if (line == r->net->line_count)
    {
        roots_line fresh = {.first = r->net->point_count, .parent = -1, .parent_point = -1, .end = -1, .end_point = -1};
        roots_network_add_line(r->net, &fresh);
    }
    r->net->lines[line].count++;
    roots_network_add_point(r->net, &p);
    return TY_OK;
}

static ty_status line_take(reader* r, int number, const double* v)
{
    if (number >= r->net->line_count)
        return wrong(r, r->line, "a line without points: each has at least two");
    roots_line* line = &r->net->lines[number];
    line->kind = (roots_kind)(int)v[KIND];
    line->parent = (int)v[PARENT];
    line->end = (int)v[END];
    line->key = (uint64_t)v[KEY_LOW] | (uint64_t)v[KEY_HIGH] << 32;
    r->rows[number] = r->number;
    r->net->requested[line->kind]++;
    r->net->grown[line->kind]++;
    return TY_OK;
}

static ty_status elements_read(reader* r)
{
    double values[POINT_COLUMNS] = {0};
    ty_status status = TY_OK;
    for (int i = 0; i < r->element_count; i++)
    {
        const element* e = &r->elements[i];
        bool points = strcmp(e->name, "vertex") == 0, lines = strcmp(e->name, "line") == 0;
        if (lines && r->net->line_count != e->rows)
            return wrong(r, NULL,
                         "the element 'line' has not as many rows as lines have points (or stands before them)");
        if (lines && !(r->rows = TY_TRY_ALLOC(int, e->rows)))
            return ty_error_set(r->error, TY_NO_MEMORY, "no memory for %d lines", e->rows);
        for (int k = 0; k < e->rows && status == TY_OK; k++)
        {
            status = row_read(r, e, points ? point_columns : lines ? line_columns : NULL, values);
            if (status == TY_OK && points)
                status = point_take(r, values);
            else if (status == TY_OK && lines)
                status = line_take(r, k, values);
        }
        if (status != TY_OK)
            return status;
    }
    return TY_OK;
}

// --- the network against itself ---

// The point of a line that lies where p does.
static int point_nearest(const roots_network* net, int line, ty_vec3 p)
{
    const roots_line* l = &net->lines[line];
    int best = l->first;
    for (int i = l->first; i < l->first + l->count; i++)
        if (ty_length_sqr(ty_sub(net->points[i].p, p)) < ty_length_sqr(ty_sub(net->points[best].p, p)))
            best = i;
    return best;
}

// One end of a line is a point of another, which it may reach a little short of. *out is that point.
static ty_status join(const reader* r, int number, const char* what, int other, int point, int* out)
{
    roots_network* net = r->net;
    if (other < 0)
        return TY_OK;
    if (other >= net->line_count || other == number)
        return ty_error_set_at(r->error, TY_BAD_INPUT, r->path, r->rows[number], 1,
                               "line %d: its %s is line %d; it is -1 (none) or another of the lines 0..%d", number,
                               what, other, net->line_count - 1);
    *out = point_nearest(net, other, net->points[point].p);
    const roots_point* there = &net->points[*out];
    bool beside = net->lines[number].kind == ROOTS_MAIN && point == net->lines[number].first; // as a strand of it
    float apart = ty_length(ty_sub(there->p, net->points[point].p));
    float most = there->r + (beside ? net->points[point].r : 0.0f);
    if (apart > most)
        return ty_error_set_at(r->error, TY_BAD_INPUT, r->path, r->rows[number], 1,
                               "line %d: it %s %.4g mm away from line %d, its %s; at most the radius there, %.4g mm",
                               number, point == net->lines[number].first ? "begins" : "ends", (double)apart * 1e3,
                               other, what, (double)most * 1e3);
    if (!beside && apart > 1e-3f * there->r) // what was written stays as it was, bit for bit
        net->points[point].p = there->p;
    return TY_OK;
}

// Whoever goes from parent to parent comes to an end.
static ty_status cycles_check(const reader* r)
{
    const roots_network* net = r->net;
    uint8_t* known = TY_ALLOC(uint8_t, net->line_count); // 1: on the way, 2: has an end
    int cycle = -1;
    for (int i = 0; i < net->line_count && cycle < 0; i++)
    {
        int l = i;
        for (; l >= 0 && !known[l]; l = net->lines[l].parent)
            known[l] = 1;
        cycle = l >= 0 && known[l] == 1 ? l : -1;
        for (l = i; l >= 0 && known[l] == 1 && cycle < 0; l = net->lines[l].parent)
            known[l] = 2;
    }
    ty_free(known);
    if (cycle < 0)
        return TY_OK;
    return ty_error_set_at(
        r->error, TY_BAD_INPUT, r->path, r->rows[cycle], 1,
        "line %d: it is its own ancestor, by way of line %d; parents lead to a line without one (-1)", cycle,
        net->lines[cycle].parent);
}

static ty_status network_check(const reader* r)
{
    roots_network* net = r->net;
    ty_status status = TY_OK;
    if (net->line_count == 0)
        return wrong(r, NULL, "there is no line");
    for (int i = 0; i < net->line_count && status == TY_OK; i++)
    {
        roots_line* l = &net->lines[i];
        if (l->count < 2)
            return ty_error_set_at(r->error, TY_BAD_INPUT, r->path, r->rows[i], 1,
                                   "line %d: it has one point; at least two", i);
        status = join(r, i, "parent", l->parent, l->first, &l->parent_point);
        if (status == TY_OK)
            status = join(r, i, "end", l->end, l->first + l->count - 1, &l->end_point);
    }
    return status == TY_OK ? cycles_check(r) : status;
}

ty_status roots_curves_read(const char* path, roots_network* out, ty_error* error)
{
    ty_bytes bytes;
    *out = (roots_network){0};
    ty_status status = ty_file_read(path, MOST_BYTES, &bytes, error);
    if (status != TY_OK)
        return status;
    const char* text = (const char*)bytes.data;
    reader r = {.path = path, .line = text, .at = text, .next = text, .end = text + bytes.size, .net = out};
    r.error = error;
    out->top = TY_FLOAT_MAX; // a file without it has no trunk
    status = header_read(&r);
    if (status == TY_OK)
        status = elements_read(&r);
    if (status == TY_OK)
        status = network_check(&r);
    ty_free(r.rows);
    ty_bytes_term(&bytes);
    if (status != TY_OK)
        roots_network_term(out);
    return status;
}
