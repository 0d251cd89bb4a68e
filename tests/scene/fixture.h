// SPDX-License-Identifier: Apache-2.0
// A folder for one test's files, loading with its errors kept, and looking at them.
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>
#include <tsuya/scene/scene.h>
#include <unistd.h>

static char fixture_folder[TY_PATH_MAX];
static ty_error_list fixture_errors;
static ty_scene* fixture_scene;

static inline int fixture_begin(void** state)
{
    (void)state;
    snprintf(fixture_folder, sizeof(fixture_folder), "%s/tsuya_scene_XXXXXX",
             getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
    ty_log_set_level(TY_LOG_ERROR);
    if (!mkdtemp(fixture_folder))
        return -1;
    char* cache = ty_string_format("%s/cache", fixture_folder);
    int result = setenv("TSUYA_CACHE", cache, 1);
    ty_free(cache);
    return result;
}

static inline void fixture_clear(void)
{
    ty_scene_destroy(fixture_scene);
    fixture_scene = NULL;
    ty_error_list_term(&fixture_errors);
    fixture_errors = (ty_error_list){0};
}

static inline int fixture_end(void** state)
{
    (void)state;
    fixture_clear();
    char* command = ty_string_format("rm -r '%s'", fixture_folder);
    int result = system(command);
    ty_free(command);
    return result;
}

static inline char* fixture_path(const char* name, char path[TY_PATH_MAX])
{
    ty_path_join(fixture_folder, name, path);
    return path;
}

static inline void fixture_write(const char* name, const char* text)
{
    char path[TY_PATH_MAX], folder[TY_PATH_MAX];
    ty_error error;
    fixture_path(name, path);
    ty_path_folder(path, folder);
    assert_int_equal(ty_folder_create(folder, &error), TY_OK);
    assert_int_equal(ty_file_write(path, text, strlen(text), &error), TY_OK);
}

static inline void fixture_print_errors(void)
{
    for (int i = 0; i < fixture_errors.count; ++i)
    {
        char text[2048];
        ty_error_format(&fixture_errors.items[i], text, sizeof(text));
        print_message("  error %d: %s\n", i, text);
    }
}

// Loads scene.yaml of the folder.
static inline ty_status fixture_load(const ty_scene_options* options)
{
    char path[TY_PATH_MAX];
    fixture_clear();
    return ty_scene_load(fixture_path("scene.yaml", path), options, &fixture_scene, &fixture_errors);
}

static inline ty_status fixture_check(const char* text)
{
    ty_scene_options options = {.check_only = true};
    fixture_write("scene.yaml", text);
    return fixture_load(&options);
}

static inline void fixture_must_load(const char* text)
{
    ty_status status = fixture_check(text);
    if (status != TY_OK)
        fixture_print_errors();
    assert_int_equal(status, TY_OK);
    assert_non_null(fixture_scene);
}

// Whether some error stands at line:column of a file whose name ends in file, and says text.
static inline bool fixture_has(const char* file, int line, int column, const char* text)
{
    for (int i = 0; i < fixture_errors.count; ++i)
    {
        const ty_error* error = &fixture_errors.items[i];
        size_t length = strlen(error->file), ending = strlen(file);
        bool same_file = length >= ending && strcmp(error->file + length - ending, file) == 0;
        if (same_file && error->line == line && error->column == column && strstr(error->text, text))
            return true;
    }
    print_message("no error at %s:%d:%d that says: %s\n", file, line, column, text);
    fixture_print_errors();
    return false;
}

// The only error of a scene text.
static inline void fixture_one_error(const char* scene, int line, int column, const char* text)
{
    assert_int_equal(fixture_check(scene), TY_BAD_INPUT);
    assert_null(fixture_scene);
    assert_true(fixture_has("scene.yaml", line, column, text));
    if (fixture_errors.count != 1)
        fixture_print_errors();
    assert_int_equal(fixture_errors.count, 1);
}

static inline void fixture_near(float value, float expected, float tolerance)
{
    if (!(value >= expected - tolerance && value <= expected + tolerance))
        print_message("%g is not %g within %g\n", (double)value, (double)expected, (double)tolerance);
    assert_true(value >= expected - tolerance && value <= expected + tolerance);
}

#define FIXTURE_TEST(function) cmocka_unit_test_setup_teardown(function, fixture_begin, fixture_end)
