// SPDX-License-Identifier: Apache-2.0
// What a call that can fail returns, and the text that goes with it.
#pragma once
#include <stdbool.h>
#include <stddef.h>

#define TY_CHECKED __attribute__((warn_unused_result))
#define TY_PRINTF(format_index, first_index) __attribute__((format(printf, format_index, first_index)))

// The values are the exit statuses of the program.
typedef enum ty_status
{
    TY_OK = 0,
    TY_DIFFERS = 1,       // compare, regress
    TY_USAGE = 2,         // the command line is wrong
    TY_BAD_INPUT = 3,     // a scene or recipe is wrong
    TY_BAD_FILE = 4,      // a file or device is missing, damaged, unwritable
    TY_NO_MEMORY = 5,     // a size that comes from input could not be allocated
    TY_NON_FINITE = 6,    // too many samples were NaN or infinite
    TY_NOT_AT_REST = 7,   // a settling did not converge
    TY_INTERNAL = 70,     // a broken promise of ours or of a library
    TY_STOPPED = 75,      // stopped with a checkpoint: run again
    TY_INTERRUPTED = 130, // SIGINT
    TY_TERMINATED = 143,  // SIGTERM
} ty_status;

// One message with its place. Plain data: copy it freely, nothing to free.
typedef struct ty_error
{
    ty_status status;
    int line, column; // from 1; 0 = not known
    char file[512];   // empty = not known
    char text[1024];
} ty_error;

// All messages about one input, in the order found.
typedef struct ty_error_list
{
    ty_error* items; // owned; freed by ty_error_list_term
    int count, capacity;
} ty_error_list;

// Sets *error (NULL is allowed) without a place and returns status, so that a failure is one line.
ty_status ty_error_set(ty_error* error, ty_status status, const char* format, ...) TY_PRINTF(3, 4);

// The same with a place. line and column may be 0, file may be NULL.
ty_status ty_error_set_at(ty_error* error, ty_status status, const char* file, int line, int column, const char* format,
                          ...) TY_PRINTF(6, 7);

#ifdef __clang_analyzer__
// The analyser sees no bodies of other files: these return what they are given, so that it knows a failure for one.
#define ty_error_set(error, status, ...) ((void)(ty_error_set)(error, status, __VA_ARGS__), (status))
#define ty_error_set_at(error, status, ...) ((void)(ty_error_set_at)(error, status, __VA_ARGS__), (status))
#endif

// Writes "file:line:column: text" (what is known of it) into buffer, always terminated.
void ty_error_format(const ty_error* error, char* buffer, size_t size);

// Appends a copy. The list keeps at most 200 messages; further ones are dropped (the last says so).
void ty_error_list_add(ty_error_list* list, const ty_error* error);
void ty_error_list_term(ty_error_list* list);

// A broken invariant is a bug: prints the place and aborts. Stays on in release builds; keep it out of inner loops.
#define TY_ASSERT(condition) ((condition) ? (void)0 : ty_assert_fail(#condition, __FILE__, __LINE__))
_Noreturn void ty_assert_fail(const char* condition, const char* file, int line);
