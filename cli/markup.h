// SPDX-License-Identifier: Apache-2.0
// Parts of reports in HTML and XML: text that is escaped, bytes as text.
#pragma once
#include <stdio.h>
#include <tsuya/base/file.h>

// Text of an element or attribute; what XML 1.0 cannot hold becomes a question mark.
void ty_markup_text(FILE* file, const char* text);

void ty_markup_base64(FILE* file, const ty_bytes* bytes); // RFC 4648
