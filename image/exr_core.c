// SPDX-License-Identifier: Apache-2.0
// The set-up of OpenEXRCore: memory through our door, messages kept instead of printed.
#include "exr_core.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/memory.h>

// The library reports an error on the thread that made it, at times while it holds the context's lock: asking the
// context for user data from the callback could then block for ever.
static _Thread_local char first_message[512];

static void keep_message(exr_const_context_t context, exr_result_t code, const char* message)
{
    (void)context;
    (void)code;
    if (first_message[0] == '\0' && message)
        snprintf(first_message, sizeof first_message, "%s", message);
}

static void* core_alloc(size_t size)
{
    return ty_try_alloc(1, size);
}

void ty_exr_core_begin(exr_context_initializer_t* initializer)
{
    first_message[0] = '\0';
    *initializer = (exr_context_initializer_t)EXR_DEFAULT_CONTEXT_INITIALIZER;
    initializer->error_handler_fn = keep_message;
    initializer->alloc_fn = core_alloc;
    initializer->free_fn = ty_free;
    initializer->max_image_width = TY_EXR_MAX_SIDE;
    initializer->max_image_height = TY_EXR_MAX_SIDE;
}

ty_status ty_exr_core_fail(ty_error* error, const char* path, exr_result_t result)
{
    if (result == EXR_ERR_OUT_OF_MEMORY)
        return ty_error_set_at(error, TY_NO_MEMORY, path, 0, 0, "not enough memory for the image");
    if (result == EXR_ERR_READ_IO && !first_message[0])
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "the EXR file ends early: truncated or damaged");
    const char* text = first_message[0] ? first_message : exr_get_default_error_message(result);
    return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "OpenEXR: %s", text);
}

bool ty_exr_is_reserved(const char* attribute_name)
{
    static const char* const reserved[] = {
        "channels",          "compression", "dataWindow", "displayWindow", "lineOrder",
        "pixelAspectRatio",  "chunkCount",  "tiles",      "version",       "screenWindowCenter",
        "screenWindowWidth", "name",        "type",
    };
    for (size_t i = 0; i < sizeof reserved / sizeof *reserved; i++)
        if (strcmp(attribute_name, reserved[i]) == 0)
            return true;
    return false;
}
