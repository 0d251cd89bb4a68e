// SPDX-License-Identifier: Apache-2.0
// A string that grows at its end.
#include "text.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void reserve(ty_text* text, size_t more)
{
    size_t needed = text->size + more + 1;
    if (needed <= text->capacity)
        return;
    size_t capacity = text->capacity ? text->capacity * 2 : 256;
    if (capacity < needed)
        capacity = needed;
    text->data = ty_grow(text->data, text->capacity, capacity, 1);
    text->capacity = capacity;
}

void ty_text_add_bytes(ty_text* text, const char* bytes, size_t size)
{
    reserve(text, size);
    if (size > 0)
        memcpy(text->data + text->size, bytes, size);
    text->size += size;
    text->data[text->size] = 0;
}

void ty_text_add(ty_text* text, const char* part)
{
    ty_text_add_bytes(text, part, strlen(part));
}

void ty_text_format(ty_text* text, const char* format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int size = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    TY_ASSERT(size >= 0);
    reserve(text, (size_t)size);
    vsnprintf(text->data + text->size, (size_t)size + 1, format, again);
    va_end(again);
    text->size += (size_t)size;
}

void ty_text_repeat(ty_text* text, char c, int count)
{
    for (int i = 0; i < count; ++i)
        ty_text_add_bytes(text, &c, 1);
}

char* ty_text_take(ty_text* text)
{
    reserve(text, 0);
    text->data[text->size] = 0;
    char* data = text->data;
    *text = (ty_text){0};
    return data;
}

void ty_text_term(ty_text* text)
{
    ty_free(text->data);
    *text = (ty_text){0};
}
