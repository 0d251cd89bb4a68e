// SPDX-License-Identifier: Apache-2.0
// Lists of numbers as an option's value: "0.1,0.2" and "0:0.24:7", both ends and the steps between.
#include "cli.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

static bool read_number(const char** text, double* out)
{
    char* end;
    errno = 0;
    *out = strtod(*text, &end);
    bool good = end != *text && !errno && *out - *out == 0.0;
    *text = end;
    return good;
}

// One number, or a range; false when it is neither or does not fit.
static bool read_item(const char** text, int most, double* out, int* count)
{
    double low, high = 0.0, steps = 0.0;
    if (*count == most || !read_number(text, &low))
        return false;
    if (**text != ':')
    {
        out[(*count)++] = low;
        return true;
    }
    ++*text;
    if (!read_number(text, &high) || **text != ':')
        return false;
    ++*text;
    if (!read_number(text, &steps) || !(steps >= 2.0 && steps <= most - *count) || steps != (double)(int)steps)
        return false;
    for (int i = 0; i < (int)steps; i++)
        out[(*count)++] = i + 1 == (int)steps ? high : low + (high - low) * i / (steps - 1.0);
    return true;
}

ty_status ty_argument_numbers(const ty_arguments* arguments, const char* name, double low, double high, int most,
                              double* out, int* count)
{
    const char *given = ty_argument_text(arguments, name, ""), *text = given;
    *count = 0;
    bool good = read_item(&text, most, out, count);
    while (good && *text == ',')
    {
        text++;
        good = read_item(&text, most, out, count);
    }
    for (int i = 0; i < *count && good; i++)
        good = out[i] >= low && out[i] <= high;
    if (good && *text == 0)
        return TY_OK;
    return ty_usage(arguments->command,
                    "--%s: '%.100s' is no list of at most %d numbers from %g to %g, as 0.1,0.2 or FROM:TO:COUNT", name,
                    given, most, low, high);
}
