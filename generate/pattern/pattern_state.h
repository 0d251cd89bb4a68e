// SPDX-License-Identifier: Apache-2.0
// What a run goes on from, as an EXR file: of what it is, whose recipe it was made by, and planes that the run knows.
#pragma once
#include <tsuya/base/file.h>
#include <tsuya/base/params.h>
#include <tsuya/base/status.h>
#include <tsuya/image/exr.h>

typedef struct pattern_state_kind
{
    const char *format, *article; // of the file; of what it is one, with its article
    const ty_param_table* table;
    // Rows that change no bit of what comes, by their dotted paths ("run.frames"), up to NULL; a group takes all below
    // it, a list all its items.
    const char* const* free_rows;
} pattern_state_kind;

// A state of that size without planes. def: of kind->table; what it holds is told by a hash a row, and a hash an item
// of lists.
ty_exr* pattern_state_create(const pattern_state_kind* kind, const void* def, int width, int height);

// A file that is no state of that kind: TY_BAD_FILE. *out is the caller's.
TY_CHECKED ty_status pattern_state_read(const pattern_state_kind* kind, const ty_bytes* bytes, ty_exr** out,
                                        ty_error* error);
bool pattern_state_number(const ty_exr* state, const char* name, int* out);               // false: it has none
const void* pattern_state_plane(const ty_exr* state, const char* name, ty_exr_type type); // NULL: it has none

// Whether the state has that size and was made by that recipe, but for the free rows: else TY_BAD_INPUT, which begins
// with the first row that differs and names others.
TY_CHECKED ty_status pattern_state_check(const pattern_state_kind* kind, const ty_exr* state, const void* def,
                                         int width, int height, ty_error* error);
