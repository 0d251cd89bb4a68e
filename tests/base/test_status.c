// SPDX-License-Identifier: Apache-2.0
// Errors: text, place, bounds of text and list, failed assertions.
#include "cmocka_all.h"
#include "process.h"
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/status.h>

static void test_set(void** state)
{
    (void)state;
    ty_error error;
    memset(&error, 0xff, sizeof(error));
    assert_int_equal(ty_error_set(&error, TY_BAD_FILE, "%s has %d", "x", 7), TY_BAD_FILE);
    assert_int_equal(error.status, TY_BAD_FILE);
    assert_string_equal(error.text, "x has 7");
    assert_string_equal(error.file, "");
    assert_int_equal(error.line, 0);
    assert_int_equal(error.column, 0);
    assert_int_equal(ty_error_set(NULL, TY_USAGE, "unseen"), TY_USAGE);
    assert_int_equal(ty_error_set_at(NULL, TY_BAD_INPUT, "f", 1, 2, "unseen"), TY_BAD_INPUT);
}

static void test_format(void** state)
{
    (void)state;
    ty_error error;
    char text[64];
    ty_error_set_at(&error, TY_BAD_INPUT, "a.yaml", 3, 9, "unknown key");
    ty_error_format(&error, text, sizeof(text));
    assert_string_equal(text, "a.yaml:3:9: unknown key");
    error.column = 0;
    ty_error_format(&error, text, sizeof(text));
    assert_string_equal(text, "a.yaml:3: unknown key");
    error.line = 0;
    ty_error_format(&error, text, sizeof(text));
    assert_string_equal(text, "a.yaml: unknown key");
    error.file[0] = 0;
    ty_error_format(&error, text, sizeof(text));
    assert_string_equal(text, "unknown key");
    ty_error_format(&error, text, 5);
    assert_string_equal(text, "unkn");
}

static void test_long_text_is_cut(void** state)
{
    (void)state;
    char text[3000];
    memset(text, 'a', sizeof(text) - 1);
    text[sizeof(text) - 1] = 0;
    ty_error error;
    ty_error_set_at(&error, TY_BAD_INPUT, text, 1, 1, "%s", text);
    assert_int_equal(strlen(error.text), sizeof(error.text) - 1);
    assert_int_equal(strlen(error.file), sizeof(error.file) - 1);
}

// A caller adds what it knows to the text of its callee.
static void test_argument_may_be_the_error_itself(void** state)
{
    (void)state;
    ty_error error;
    ty_error_set_at(&error, TY_BAD_FILE, "in.ply", 2, 0, "truncated");
    ty_error_set_at(&error, error.status, error.file, error.line, 5, "mesh: %s", error.text);
    assert_string_equal(error.text, "mesh: truncated");
    assert_string_equal(error.file, "in.ply");
    ty_error_set(&error, TY_BAD_INPUT, "%s: %s", error.file, error.text);
    assert_string_equal(error.text, "in.ply: mesh: truncated");
    assert_string_equal(error.file, "");
}

static void test_list_keeps_order_and_bound(void** state)
{
    (void)state;
    ty_error_list list = {0};
    for (int i = 0; i < 1000; i++)
    {
        ty_error error;
        ty_error_set_at(&error, TY_BAD_INPUT, "s.yaml", i + 1, 1, "error %d", i);
        ty_error_list_add(&list, &error);
        if (i < 200)
            assert_int_equal(list.count, i + 1);
    }
    assert_int_equal(list.count, 200);
    for (int i = 0; i < 199; i++)
        assert_int_equal(list.items[i].line, i + 1);
    assert_string_equal(list.items[198].text, "error 198");
    assert_non_null(strstr(list.items[199].text, "more than 199 errors"));
    ty_error_list_term(&list);
    assert_null(list.items);
    assert_int_equal(list.count, 0);
}

static void fail_assertion(void* context)
{
    TY_ASSERT(context != NULL);
}

static void test_assert_names_its_place(void** state)
{
    (void)state;
    process_end end = process_run(fail_assertion, NULL);
    assert_int_equal(end.signal, SIGABRT);
    assert_non_null(strstr(end.text, "context != NULL"));
    assert_non_null(strstr(end.text, "test_status.c:"));
    assert_int_equal(process_run(fail_assertion, &end).exit_status, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_set),
        cmocka_unit_test(test_format),
        cmocka_unit_test(test_long_text_is_cut),
        cmocka_unit_test(test_argument_may_be_the_error_itself),
        cmocka_unit_test(test_list_keeps_order_and_bound),
        cmocka_unit_test(test_assert_names_its_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
