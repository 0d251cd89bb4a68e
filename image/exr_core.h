// SPDX-License-Identifier: Apache-2.0
// What the EXR reader and writer share: the set-up of OpenEXRCore, its messages as ours, names that the format
// reserves.
#pragma once
#include <openexr.h>
#include <stdbool.h>
#include <tsuya/base/status.h>

#define TY_EXR_MAX_SIDE 65536
#define TY_EXR_MAX_COORDINATE (1 << 30)

// Fills the initializer: our memory, no printing, messages kept for ty_exr_core_fail of this thread. Forgets an earlier
// message.
void ty_exr_core_begin(exr_context_initializer_t* initializer);

// Turns a result of the library into a status; the text is the first message since ty_exr_core_begin on this thread.
ty_status ty_exr_core_fail(ty_error* error, const char* path, exr_result_t result);

// Whether the attribute belongs to the format itself (windows, channels, compression...).
bool ty_exr_is_reserved(const char* attribute_name);
