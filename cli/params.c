// SPDX-License-Identifier: Apache-2.0
// `tsuya params`: every parameter there is, its type, range, default and meaning.
#include "cli.h"
#include <stdio.h>
#include <tsuya/base/memory.h>

static ty_status run(const ty_arguments* arguments)
{
    char nearest[64] = "";
    const char* path = arguments->positional_count ? arguments->positional[0] : NULL;
    char* text;
    if (ty_argument_has(arguments, "schema"))
    {
        text = ty_params_schema();
    }
    else if (ty_argument_has(arguments, "markdown"))
    {
        text = ty_params_markdown();
    }
    else
    {
        text = ty_params_text(path, nearest);
    }
    if (!text)
    {
        return nearest[0] ? ty_usage(arguments->command, "no parameters named '%s'; did you mean '%s'?", path, nearest)
                          : ty_usage(arguments->command, "no parameters named '%s'", path);
    }
    fputs(text, stdout);
    ty_free(text);
    return ty_output_finish();
}

static const ty_option options[] = {
    {"schema", 0, NULL, "JSON Schema of scene files, for editors"},
    {"markdown", 0, NULL, "the reference page"},
};

const ty_command ty_command_params = {
    "params",
    "[TABLE]",
    "list parameters: type, range, default, meaning",
    "tsuya params material.cdrf",
    0,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
