// SPDX-License-Identifier: Apache-2.0
// Results: JSON and text on standard output, checked to have arrived, and files.
#include "cli.h"
#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

enum
{
    JSON_FLAGS = JSON_INDENT(2) | JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(9)
};

const char* const ty_state_endings[] = {"exr", NULL};

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

static ty_status check_ending(const ty_command* command, const char* what, const char* output,
                              const char* const* endings)
{
    char list[128] = "";
    for (int i = 0; endings[i]; i++)
    {
        if (strcmp(ty_path_extension(output), endings[i]) == 0)
            return TY_OK;
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s.%s", i == 0 ? "" : endings[i + 1] ? ", " : " or ", endings[i]);
    }
    return ty_usage(command, "the %s '%s' must end in %s", what, output, list);
}

ty_status ty_output_check_ending(const ty_command* command, const char* output, const char* const* endings)
{
    return check_ending(command, "output", output, endings);
}

ty_status ty_output_check(const ty_command* command, const char* what, const char* path, const char* const* endings,
                          ty_output_form form)
{
    ty_error error;
    char first[TY_PATH_MAX];
    if (!path)
        return ty_usage(command, "where to? give -o %s", command->options[0].value);
    ty_status status = endings ? check_ending(command, what, path, endings) : TY_OK;
    if (status != TY_OK)
        return status;
    if (form == TY_OUTPUT_FRAMES && !ty_path_is_sequence(path))
        return ty_usage(command, "the %s '%s' needs #### where the number of a frame goes", what, path);
    if (form == TY_OUTPUT_FILE && ty_path_is_sequence(path))
        return ty_usage(command, "the %s '%s' is one file: it has no #", what, path);
    ty_path_frame(path, 1, first);
    status = ty_output_probe(first, &error);
    if (status != TY_OK)
        ty_log_error(&error);
    return status;
}

// The place that a path names, links followed where it is there: of what is not, its folder's.
static bool place_of(const char* path, char out[PATH_MAX])
{
    char folder[TY_PATH_MAX], whole[PATH_MAX];
    if (realpath(path, out))
        return true;
    ty_path_folder(path, folder);
    const char* name = strrchr(path, '/');
    return realpath(folder, whole) && snprintf(out, PATH_MAX, "%s/%s", whole, name ? name + 1 : path) < PATH_MAX;
}

ty_status ty_output_check_apart(const ty_command* command, const char* const* names, const char* const* paths,
                                int count)
{
    char a[PATH_MAX], b[PATH_MAX];
    for (int i = 1; i < count; i++)
        for (int k = 0; k < i; k++)
            if (paths[i] && paths[k] && place_of(paths[i], a) && place_of(paths[k], b) && strcmp(a, b) == 0)
                return ty_usage(command, "the %s and the %s are one file: '%s'", names[k], names[i], paths[i]);
    return TY_OK;
}

ty_status ty_output_write(const char* path, ty_output_fn* put, const void* context, ty_error* error)
{
    static ty_atomic_file output; // paths: too large for the stack
    ty_status status = ty_atomic_begin(&output, path, error);
    if (status != TY_OK)
    {
        return status;
    }
    FILE* file = fopen(output.temporary, "wb");
    if (file)
    {
        status = put(file, context, error);
    }
    bool bad = !file || ferror(file);
    if (file)
    {
        bad |= fclose(file) != 0;
    }
    if (status == TY_OK && bad)
    {
        status = ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot write: %s", strerror(errno));
    }
    if (status == TY_OK)
    {
        return ty_atomic_commit(&output, error);
    }
    ty_atomic_abort(&output);
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

// Bytes of the character at text; 0 when it is none.
static size_t character_size(const char* text)
{
    for (size_t size = 1; size <= strnlen(text, 4); size++)
    {
        json_t* character = json_stringn(text, size);
        json_decref(character);
        if (character)
        {
            return size;
        }
    }
    return 0;
}

json_t* ty_json_from_text(const char* text)
{
    static const char replacement[] = "\uFFFD";
    json_t* whole = json_string(text);
    if (whole)
    {
        return whole;
    }
    char *good = TY_ALLOC(char, strlen(text) * (sizeof replacement - 1) + 1), *end = good;
    while (*text)
    {
        size_t size = character_size(text);
        const char* source = size ? text : replacement;
        size_t copied = size ? size : sizeof replacement - 1;
        memcpy(end, source, copied);
        end += copied;
        text += size ? size : 1;
    }
    whole = json_stringn(good, (size_t)(end - good));
    ty_free(good);
    return whole;
}

json_t* ty_json_format(const char* format, ...)
{
    char text[4096];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return ty_json_from_text(text);
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

ty_status ty_report_give(const ty_arguments* arguments, const char* output, const char* text,
                         void (*print)(const json_t* report))
{
    const char* file = ty_argument_text(arguments, "report", NULL);
    json_t* report = json_loads(text, 0, NULL);
    if (!report)
    {
        ty_log(TY_LOG_ERROR, "the report is no JSON");
        return TY_INTERNAL;
    }
    json_object_set_new(report, "output", ty_json_from_text(output));
    ty_status status = file ? ty_json_write(file, json_incref(report)) : TY_OK;
    if (status == TY_OK && ty_argument_has(arguments, "json"))
        return ty_json_print(report);
    if (status == TY_OK)
    {
        printf("%s\n", output);
        print(report);
        status = ty_output_finish();
    }
    json_decref(report);
    return status;
}
