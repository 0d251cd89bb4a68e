// SPDX-License-Identifier: Apache-2.0
// Which frames of a sequence are there, and which are missing.
#include "cmocka_all.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <tsuya/base/file.h>
#include <unistd.h>

static char folder[64];
static char path[TY_PATH_MAX];

static const char* at(const char* name)
{
    ty_path_join(folder, name, path);
    return path;
}

static const char* const names[] = {"f.0003.exr",  "f.0001.exr",     "f.10000.exr", "f.-001.exr", "f.7.exr",
                                    "f.00010.exr", "f.0002.exr.bak", "g.0002.exr",  "f..exr",     "f.0008"};
enum
{
    NAMES = sizeof names / sizeof *names
};

static int folder_make(void** state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/tsuya-frames-XXXXXX");
    if (!mkdtemp(folder))
        return -1;
    for (int i = 0; i < NAMES; i++)
        if (ty_file_write(at(names[i]), "x", 1, NULL) != TY_OK)
            return -1;
    return mkdir(at("f.0004.exr"), 0777); // no file
}

static int folder_remove(void** state)
{
    (void)state;
    for (int i = 0; i < NAMES; i++)
        unlink(at(names[i]));
    rmdir(at("f.0004.exr"));
    return rmdir(folder);
}

static void test_frames_are_found_in_order(void** state)
{
    (void)state;
    ty_frame_numbers frames;
    ty_error error;
    assert_int_equal(ty_frame_numbers_find(at("f.####.exr"), &frames, &error), TY_OK);
    assert_int_equal(frames.count, 4);
    const int expected[4] = {-1, 1, 3, 10000};
    assert_memory_equal(frames.numbers, expected, sizeof expected);
    ty_frame_numbers_term(&frames);
    assert_null(frames.numbers);
    assert_int_equal(ty_frame_numbers_find(at("f.#.exr"), &frames, &error), TY_OK);
    assert_int_equal(frames.count, 2); // 7 and 10000: the others have zeros in front
    ty_frame_numbers_term(&frames);
}

static void test_no_frames_is_an_error(void** state)
{
    (void)state;
    ty_frame_numbers frames;
    ty_error error;
    assert_int_equal(ty_frame_numbers_find(at("h.####.exr"), &frames, &error), TY_BAD_FILE);
    assert_non_null(strstr(error.text, "without frames"));
    assert_int_equal(ty_frame_numbers_find(at("none/h.####.exr"), &frames, &error), TY_BAD_FILE);
    assert_non_null(strstr(error.text, "No such file"));
}

static void assert_missing(const ty_frame_numbers* frames, int first, int last, int count, const char* expected)
{
    char text[64];
    assert_int_equal(ty_frame_numbers_missing(frames, first, last, text, sizeof text), count);
    assert_string_equal(text, expected);
}

static void test_missing_frames_are_listed(void** state)
{
    (void)state;
    int numbers[] = {-3, 1, 2, 3, 5, 10, 15, 16};
    ty_frame_numbers frames = {numbers, 8};
    assert_missing(&frames, 1, 3, 0, "");
    assert_missing(&frames, 1, 16, 9, "4, 6-9, 11-14");
    assert_missing(&frames, -3, 2, 3, "-2-0");
    assert_missing(&frames, 4, 4, 1, "4");
    assert_missing(&frames, 15, 20, 4, "17-20");
    assert_missing(&frames, 15, 999999999, 999999983, "17-999999999");
    char narrow[11];
    assert_int_equal(ty_frame_numbers_missing(&frames, 1, 16, narrow, sizeof narrow), 9);
    assert_string_equal(narrow, "4, ...");
}

static void test_numbers_as_a_text(void** state)
{
    (void)state;
    int numbers[] = {-3, 1, 2, 3, 5, 10, 15, 16};
    char text[64], narrow[11];
    ty_frame_numbers_text(&(ty_frame_numbers){numbers, 8}, text, sizeof text);
    assert_string_equal(text, "-3, 1-3, 5, 10, 15-16");
    ty_frame_numbers_text(&(ty_frame_numbers){numbers, 8}, narrow, sizeof narrow);
    assert_string_equal(narrow, "-3, ...");
    ty_frame_numbers_text(&(ty_frame_numbers){numbers, 0}, text, sizeof text);
    assert_string_equal(text, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_frames_are_found_in_order, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_no_frames_is_an_error, folder_make, folder_remove),
        cmocka_unit_test(test_missing_frames_are_listed),
        cmocka_unit_test(test_numbers_as_a_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
