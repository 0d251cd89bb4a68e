// SPDX-License-Identifier: Apache-2.0
// A file of text or bytes as it grows in memory.
#pragma once
#include <stdint.h>
#include <tsuya/base/math.h>
#include <tsuya/base/status.h>

typedef struct ty_sink
{
    uint8_t* bytes; // owned
    size_t size, capacity;
} ty_sink;

void ty_sink_term(ty_sink* text);
void ty_sink_put(ty_sink* text, const void* bytes, size_t size);
void ty_sink_format(ty_sink* text, const char* format, ...) TY_PRINTF(2, 3); // at most 500 characters
// Nine digits bring every float back.
void ty_sink_float(ty_sink* text, float value);
// "(a, b, c)"
void ty_sink_vector(ty_sink* text, const float* values, int count);
void ty_sink_u32(ty_sink* text, uint32_t value); // little-endian
void ty_sink_f32(ty_sink* text, float value);    // the same
