// SPDX-License-Identifier: Apache-2.0
// Numbers as scene files write them, and the words for what a row of a table accepts.
#pragma once
#include "text.h"
#include <tsuya/base/params.h>
#include <tsuya/base/rng.h>

// Decimal numbers only: no 0x, inf or nan, nothing behind. False also when beyond the range of double.
bool ty_number_parse(const char* text, double* out);
bool ty_seed_parse(const char* text, uint64_t* out); // decimal, 0 .. 2^64 - 1

double ty_unit_scale(const char* unit); // written unit to memory: deg to radians, mm to metres, else 1

// " 0..1 deg", " of at least 0", "" when unbounded.
void ty_param_range_text(const ty_param* row, ty_text* out);
// "a number 0..1", "one of: box, gaussian", "a list of two numbers" ...
void ty_param_expected(const ty_param* row, ty_text* out);
const char* ty_param_type_name(ty_param_type type); // "number", "colour input" ...
// The value of a row in def, in the written unit; "" for groups and lists.
void ty_param_value_text(const ty_param* row, const void* def, ty_text* out);
