// SPDX-License-Identifier: Apache-2.0
// Errors with their place, lists of them, and failed assertions.
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/status.h>

enum
{
    error_list_limit = 200
};

static void place_set(ty_error* error, ty_status status, const char* file, int line, int column)
{
    error->status = status;
    error->line = line;
    error->column = column;
    snprintf(error->file, sizeof(error->file), "%s", file ? file : "");
}

// In parentheses, since the analyser has macros of these names.
ty_status(ty_error_set)(ty_error* error, ty_status status, const char* format, ...)
{
    if (!error)
        return status;
    // The text is made apart first: an argument may point into *error.
    char text[sizeof(error->text)];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof(text), format, arguments);
    va_end(arguments);
    place_set(error, status, NULL, 0, 0);
    memcpy(error->text, text, sizeof(text));
    return status;
}

ty_status(ty_error_set_at)(ty_error* error, ty_status status, const char* file, int line, int column,
                           const char* format, ...)
{
    if (!error)
        return status;
    char text[sizeof(error->text)], place[sizeof(error->file)];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof(text), format, arguments);
    va_end(arguments);
    snprintf(place, sizeof(place), "%s", file ? file : "");
    place_set(error, status, place, line, column);
    memcpy(error->text, text, sizeof(text));
    return status;
}

void ty_error_format(const ty_error* error, char* buffer, size_t size)
{
    if (!error->file[0])
        snprintf(buffer, size, "%s", error->text);
    else if (error->line <= 0)
        snprintf(buffer, size, "%s: %s", error->file, error->text);
    else if (error->column <= 0)
        snprintf(buffer, size, "%s:%d: %s", error->file, error->line, error->text);
    else
        snprintf(buffer, size, "%s:%d:%d: %s", error->file, error->line, error->column, error->text);
}

void ty_error_list_add(ty_error_list* list, const ty_error* error)
{
    if (list->count == error_list_limit)
    {
        ty_error_set(&list->items[error_list_limit - 1], error->status,
                     "more than %d errors; the others are not listed", error_list_limit - 1);
        return;
    }
    if (list->count == list->capacity)
    {
        int capacity = list->capacity ? 2 * list->capacity : 8;
        list->items = ty_grow(list->items, (size_t)list->count, (size_t)capacity, sizeof(ty_error));
        list->capacity = capacity;
    }
    list->items[list->count++] = *error;
}

void ty_error_list_term(ty_error_list* list)
{
    ty_free(list->items);
    *list = (ty_error_list){0};
}

_Noreturn void ty_assert_fail(const char* condition, const char* file, int line)
{
    fprintf(stderr, "tsuya: internal error: %s:%d: %s does not hold\n", file, line, condition);
    ty_atomic_abort_all();
    abort();
}
