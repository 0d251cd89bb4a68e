// SPDX-License-Identifier: Apache-2.0
// "Did you mean": slips are found, other words are left alone.
#include "cmocka_all.h"
#include <stddef.h>
#include <string.h>
#include <tsuya/base/suggest.h>

static const char* const names[] = {"moisture", "samples", "seed", NULL, "max_depth", "material"};

static const char* suggest(const char* word)
{
    return ty_suggest_name(word, names, 6);
}

static void test_slips(void** state)
{
    (void)state;
    assert_string_equal(suggest("moistrue"), "moisture"); // a swap
    assert_string_equal(suggest("sampels"), "samples");
    assert_string_equal(suggest("sample"), "samples"); // one left out
    assert_string_equal(suggest("seeed"), "seed");     // one too many
    assert_string_equal(suggest("max-depth"), "max_depth");
    assert_string_equal(suggest("MATERIAL"), "material");
}

static void test_other_words(void** state)
{
    (void)state;
    assert_null(suggest("camera"));
    assert_null(suggest("x"));
    assert_null(ty_suggest_name("seed", names, 0));
    char large[500];
    memset(large, 's', sizeof(large) - 1);
    large[sizeof(large) - 1] = 0;
    assert_null(suggest(large));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slips),
        cmocka_unit_test(test_other_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
