// SPDX-License-Identifier: Apache-2.0
// What is made of a fill's frames: a contact sheet, and a page on which rates are picked.
#pragma once
#include "cli.h"

// Every n-th frame of the pattern's files from the first (0: so many that there are 24 at most), with their numbers.
TY_CHECKED ty_status ty_contact_sheet_write(const char* path, const char* pattern, int every, ty_error* error);

// The last of the pattern's files, which is a map of rates, in a page of its own: a click prints the recipe.
TY_CHECKED ty_status ty_map_page_write(const char* path, const char* pattern, ty_error* error);
