// SPDX-License-Identifier: Apache-2.0
// What messages and progress share of standard error.
#pragma once
#include <stdbool.h>
#include <stddef.h>

bool ty_terminal_is(void); // whether standard error is a terminal
void ty_terminal_write(const char* bytes, size_t size);
void ty_terminal_set_bar(bool shown); // the next message erases the line first
