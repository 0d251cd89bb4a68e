// SPDX-License-Identifier: Apache-2.0
// `tsuya merge`: parts of one picture, made with --samples, into the whole.
#include "cli.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/renderer/render.h>

static ty_status run(const ty_arguments* arguments)
{
    const char* output = ty_argument_text(arguments, "output", NULL);
    if (!output || strcmp(ty_path_extension(output), "exr") != 0)
    {
        return ty_usage(arguments->command, "where to? give -o OUT.exr");
    }
    ty_error error = {0};
    ty_status status = ty_film_merge(arguments->positional, arguments->positional_count, output, &error);
    if (status != TY_OK)
    {
        ty_log_error(&error);
        return status;
    }
    printf("%s\n", output);
    return ty_output_finish();
}

static const ty_option options[] = {
    {"output", 'o', "OUT.exr", "the joined picture"},
};

const ty_command ty_command_merge = {
    "merge",
    "PART... -o OUT.exr",
    "join parts rendered with --samples; the result has the bytes of one run",
    "tsuya merge out/a.exr out/b.exr -o out/whole.exr",
    1,
    256,
    options,
    TY_PARAM_COUNT(options),
    run,
};
