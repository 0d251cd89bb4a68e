// SPDX-License-Identifier: Apache-2.0
// Results: JSON and text on standard output, checked to have arrived.
#include "cli.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>

enum
{
    JSON_FLAGS = JSON_INDENT(2) | JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(9)
};

ty_status ty_output_probe(const char* path, ty_error* error)
{
    ty_atomic_file file;
    ty_status status = ty_atomic_begin(&file, path, error);
    if (status == TY_OK)
    {
        ty_atomic_abort(&file);
    }
    return status;
}

// A reader that has seen enough (`| head`) needs no message.
ty_status ty_output_finish(void)
{
    if (fflush(stdout) != 0 || ferror(stdout))
    {
        ty_log(errno == EPIPE ? TY_LOG_DEBUG : TY_LOG_ERROR, "standard output: %s", strerror(errno));
        return TY_BAD_FILE;
    }
    return TY_OK;
}

ty_status ty_json_print(json_t* value)
{
    bool written = json_dumpf(value, stdout, JSON_FLAGS) == 0 && fputc('\n', stdout) != EOF;
    json_decref(value);
    ty_status status = ty_output_finish();
    return written ? status : TY_BAD_FILE;
}

ty_status ty_json_write(const char* path, json_t* value)
{
    char* text = json_dumps(value, JSON_FLAGS);
    json_decref(value);
    ty_error error;
    ty_status status = text ? ty_file_write(path, text, strlen(text), &error)
                            : ty_error_set(&error, TY_INTERNAL, "cannot format JSON");
    free(text); // jansson's own allocation
    if (status != TY_OK)
    {
        ty_log_error(&error);
    }
    return status;
}
