// SPDX-License-Identifier: Apache-2.0
// Command lines: options by table, numbers with their range, help.
#include "cli.h"
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <tsuya/base/log.h>
#include <tsuya/base/suggest.h>

ty_status ty_usage(const ty_command* command, const char* format, ...)
{
    char text[512];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    ty_log(TY_LOG_ERROR, "%s: %s (tsuya %s --help)", command->name, text, command->name);
    return TY_USAGE;
}

void ty_command_help(const ty_command* command)
{
    printf("tsuya %s%s%s\n\n%s\n\n", command->name, command->usage[0] ? " " : "", command->usage, command->summary);
    for (int i = 0; i < command->option_count; i++)
    {
        const ty_option* option = &command->options[i];
        char left[64];
        snprintf(left, sizeof left, "%s%c%s--%s %s", option->short_name ? "-" : " ",
                 option->short_name ? option->short_name : ' ', option->short_name ? ", " : "  ", option->name,
                 option->value ? option->value : "");
        printf("  %-27s %s\n", left, option->help);
    }
    printf("\nexample: %s\n", command->example);
}

static const ty_option* find_long(const ty_command* command, const char* name, size_t length)
{
    for (int i = 0; i < command->option_count; i++)
    {
        if (strlen(command->options[i].name) == length && strncmp(command->options[i].name, name, length) == 0)
        {
            return &command->options[i];
        }
    }
    return NULL;
}

static const ty_option* find_short(const ty_command* command, char name)
{
    for (int i = 0; i < command->option_count; i++)
    {
        if (command->options[i].short_name == name)
        {
            return &command->options[i];
        }
    }
    return NULL;
}

static ty_status unknown_option(const ty_command* command, const char* text, size_t length)
{
    const char* names[64];
    for (int i = 0; i < command->option_count && i < 64; i++)
    {
        names[i] = command->options[i].name;
    }
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    const char* near = ty_suggest_name(name, names, command->option_count);
    return near ? ty_usage(command, "unknown option '--%s'; did you mean '--%s'?", name, near)
                : ty_usage(command, "unknown option '--%s'", name);
}

static ty_status add_given(ty_arguments* out, const ty_option* option, const char* text)
{
    if (out->given_count == TY_PARAM_COUNT(out->given))
    {
        return ty_usage(out->command, "too many options");
    }
    out->given[out->given_count++] = (ty_given){option, text};
    return TY_OK;
}

// One option at argv[*i]; *i moves over its value.
static ty_status parse_option(ty_arguments* out, int argc, char** argv, int* i)
{
    const char* text = argv[*i];
    const ty_option* option;
    const char* value = NULL;
    if (text[1] == '-')
    {
        const char* equals = strchr(text, '=');
        size_t length = equals ? (size_t)(equals - text - 2) : strlen(text + 2);
        option = find_long(out->command, text + 2, length);
        if (!option)
        {
            return unknown_option(out->command, text + 2, length);
        }
        value = equals ? equals + 1 : NULL;
    }
    else
    {
        option = find_short(out->command, text[1]);
        if (!option)
        {
            return ty_usage(out->command, "unknown option '-%c'", text[1]);
        }
        value = text[2] ? text + 2 : NULL;
    }
    if (!option->value)
    {
        return value ? ty_usage(out->command, "--%s takes no value", option->name) : add_given(out, option, "");
    }
    if (!value)
    {
        if (*i + 1 >= argc)
        {
            return ty_usage(out->command, "--%s needs a value: %s", option->name, option->value);
        }
        value = argv[++*i];
    }
    return add_given(out, option, value);
}

ty_status ty_arguments_parse(const ty_command* command, int argc, char** argv, ty_arguments* out)
{
    out->command = command;
    out->given_count = out->positional_count = 0;
    bool options_over = false;
    for (int i = 0; i < argc; i++)
    {
        if (!options_over && strcmp(argv[i], "--") == 0)
        {
            options_over = true;
            continue;
        }
        if (!options_over && argv[i][0] == '-' && argv[i][1])
        {
            ty_status status = parse_option(out, argc, argv, &i);
            if (status != TY_OK)
            {
                return status;
            }
            continue;
        }
        if (out->positional_count == TY_PARAM_COUNT(out->positional))
        {
            return ty_usage(command, "too many arguments");
        }
        out->positional[out->positional_count++] = argv[i];
    }
    if (out->positional_count < command->least)
    {
        return ty_usage(command, "missing argument: %s", command->usage);
    }
    if (out->positional_count > command->most)
    {
        return ty_usage(command, "unexpected argument '%s'", out->positional[command->most]);
    }
    return TY_OK;
}

bool ty_argument_has(const ty_arguments* arguments, const char* name)
{
    return ty_argument_text(arguments, name, NULL) != NULL;
}

const char* ty_argument_text(const ty_arguments* arguments, const char* name, const char* fallback)
{
    for (int i = arguments->given_count - 1; i >= 0; i--)
    {
        if (strcmp(arguments->given[i].option->name, name) == 0)
        {
            return arguments->given[i].text;
        }
    }
    return fallback;
}

ty_status ty_argument_int(const ty_arguments* arguments, const char* name, long low, long high, long* out)
{
    const char* text = ty_argument_text(arguments, name, "");
    char* end;
    errno = 0;
    long value = strtol(text, &end, 10);
    if (end == text || *end || errno || value < low || value > high)
    {
        return ty_usage(arguments->command, "--%s: '%s' is not a whole number from %ld to %ld", name, text, low, high);
    }
    *out = value;
    return TY_OK;
}

ty_status ty_argument_bytes(const ty_arguments* arguments, const char* name, double low, double high, uint64_t* out)
{
    static const struct
    {
        const char* name;
        double bytes;
    } units[] = {{"", 1.0}, {"kB", 1e3}, {"MB", 1e6}, {"GB", 1e9}, {"KiB", 0x1p10}, {"MiB", 0x1p20}, {"GiB", 0x1p30}};
    const char* text = ty_argument_text(arguments, name, "");
    char* end;
    double value = strtod(text, &end);
    for (size_t i = 0; i < sizeof units / sizeof *units && end != text; i++)
    {
        double bytes = value * units[i].bytes;
        if (strcasecmp(end, units[i].name) == 0 && bytes >= low && bytes <= high)
        {
            *out = (uint64_t)bytes;
            return TY_OK;
        }
    }
    return ty_usage(arguments->command, "--%s: '%s' is not a size from %g MB to %g TB, such as 512MB or 2GB", name,
                    text, low * 1e-6, high * 1e-12);
}

ty_status ty_argument_float(const ty_arguments* arguments, const char* name, double low, double high, double* out)
{
    const char* text = ty_argument_text(arguments, name, "");
    char* end;
    errno = 0;
    double value = strtod(text, &end);
    if (end == text || *end || errno || !(value >= low && value <= high))
    {
        return ty_usage(arguments->command, "--%s: '%s' is not a number from %g to %g", name, text, low, high);
    }
    *out = value;
    return TY_OK;
}
