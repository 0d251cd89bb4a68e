// SPDX-License-Identifier: Apache-2.0
// A file of text or bytes as it grows in memory.
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/sink.h>

void ty_sink_term(ty_sink* text)
{
    ty_free(text->bytes);
    *text = (ty_sink){0};
}

void ty_sink_put(ty_sink* text, const void* bytes, size_t size)
{
    size_t wanted = text->size + size;
    if (wanted > text->capacity)
    {
        size_t capacity = wanted > 2 * text->capacity ? wanted + 4096 : 2 * text->capacity;
        text->bytes = ty_grow(text->bytes, text->size, capacity, 1);
        text->capacity = capacity;
    }
    memcpy(text->bytes + text->size, bytes, size);
    text->size = wanted;
}

void ty_sink_format(ty_sink* text, const char* format, ...)
{
    char line[512];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    TY_ASSERT(length >= 0 && (size_t)length < sizeof line);
    ty_sink_put(text, line, (size_t)length);
}

void ty_sink_float(ty_sink* text, float value)
{
    char number[32];
    int length = snprintf(number, sizeof number, "%.9g", (double)value);
    ty_sink_put(text, number, (size_t)length);
}

void ty_sink_vector(ty_sink* text, const float* values, int count)
{
    for (int i = 0; i < count; i++)
    {
        ty_sink_put(text, i == 0 ? "(" : ", ", i == 0 ? 1 : 2);
        ty_sink_float(text, values[i]);
    }
    ty_sink_put(text, ")", 1);
}

void ty_sink_u32(ty_sink* text, uint32_t value)
{
    uint8_t bytes[4] = {(uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16), (uint8_t)(value >> 24)};
    ty_sink_put(text, bytes, 4);
}

void ty_sink_f32(ty_sink* text, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    ty_sink_u32(text, bits);
}
