// SPDX-License-Identifier: Apache-2.0
// A string that grows at its end.
#pragma once
#include <tsuya/base/memory.h>

typedef struct ty_text
{
    char* data; // terminated once something was added; owned
    size_t size, capacity;
} ty_text;

void ty_text_add(ty_text* text, const char* part);
void ty_text_add_bytes(ty_text* text, const char* bytes, size_t size);
void ty_text_format(ty_text* text, const char* format, ...) TY_PRINTF(2, 3);
void ty_text_repeat(ty_text* text, char c, int count); // nothing when count <= 0
char* ty_text_take(ty_text* text);                     // the caller frees it with ty_free; *text is empty afterwards
void ty_text_term(ty_text* text);
