// SPDX-License-Identifier: Apache-2.0
// Reports in HTML and XML: text that is escaped, files that are complete or absent.
#pragma once
#include <stdio.h>
#include <tsuya/base/file.h>

// Text of an element or attribute; what XML 1.0 cannot hold becomes a question mark.
void ty_markup_text(FILE* file, const char* text);

void ty_markup_base64(FILE* file, const ty_bytes* bytes); // RFC 4648

typedef ty_status ty_markup_fn(FILE* file, const void* context, ty_error* error);
// put writes the whole; a failure of it or of the disk leaves the old file.
TY_CHECKED ty_status ty_markup_write(const char* path, ty_markup_fn* put, const void* context, ty_error* error);
