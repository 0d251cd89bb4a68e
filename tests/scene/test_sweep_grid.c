// SPDX-License-Identifier: Apache-2.0
// Sweeps: values of lists and ranges, cells of a grid and of a zip, names, and the place of every mistake.
#include "scene/fixture.h"
#include <tsuya/scene/sweep.h>

static ty_sweep sweep;

static ty_status parse(const char* const* arguments, int count, bool zip, int most)
{
    fixture_clear();
    ty_sweep_term(&sweep);
    ty_sweep_def def = {.arguments = arguments, .argument_count = count, .zip = zip, .most_cells = most};
    return ty_sweep_parse(&def, &sweep, &fixture_errors);
}

static void parse_one(const char* argument)
{
    ty_status status = parse(&argument, 1, false, 10000);
    if (status != TY_OK)
        fixture_print_errors();
    assert_int_equal(status, TY_OK);
}

// The values of the only axis, with blanks between them.
static void expect_values(const char* argument, const char* expected)
{
    char all[4096] = "";
    parse_one(argument);
    for (int i = 0; i < sweep.axes[0].count; ++i)
    {
        size_t used = strlen(all);
        snprintf(all + used, sizeof all - used, "%s%s", i ? " " : "", sweep.axes[0].values[i].text);
    }
    assert_string_equal(all, expected);
}

static void expect_mistake(const char* const* arguments, int count, bool zip, int column, const char* text)
{
    assert_int_equal(parse(arguments, count, zip, 100), TY_USAGE);
    assert_true(fixture_errors.count >= 1);
    if (!strstr(fixture_errors.items[0].text, text))
        fail_msg("'%s' is not in '%s'", text, fixture_errors.items[0].text);
    assert_int_equal(fixture_errors.items[0].column, column);
    assert_null(sweep.axes);
}

static void expect_bad(const char* argument, int column, const char* text)
{
    expect_mistake(&argument, 1, false, column, text);
}

static void test_ranges(void** state)
{
    (void)state;
    expect_values("m=0:1:5", "0 0.25 0.5 0.75 1");
    expect_values("m=1:0:3", "1 0.5 0");
    expect_values("m=-1:1:3", "-1 0 1");
    expect_values("m=0:1:4", "0 0.333333 0.666667 1");
    expect_values("m=1:16:5:log", "1 2 4 8 16");
    expect_values("m=0.01:1:3:log", "0.01 0.1 1");
    expect_values("m=100:1:3:log", "100 10 1");
    expect_values("m=1e-9:3e-9:3", "1e-09 2e-09 3e-09");
    // Ends stay what was written, and values differ, also where six digits do not do it.
    expect_values("m=0.12345678:1:2", "0.12345678 1");
    expect_values("m=1:1.000001:3", "1 1.0000005 1.000001");
}

static void test_lists(void** state)
{
    (void)state;
    expect_values("m=0.2, .5 ,1", "0.2 .5 1");
    expect_values("camera.position=[0, 1, 2],[3,4,5]", "[0, 1, 2] [3,4,5]");
    expect_values("a.b={ k: [1, 2], t: 'x],y' },\"a,b\"", "{ k: [1, 2], t: 'x],y' } \"a,b\"");
    expect_values("m=0:1:3,7,10:20:2", "0 0.5 1 7 10 20");
    expect_values("assets.a.mesh=C:/x.ply,a:b:c", "C:/x.ply a:b:c"); // no numbers in front of a colon
    assert_false(sweep.axes[0].is_variable);
    parse_one("moisture=1");
    assert_true(sweep.axes[0].is_variable);
    parse_one("frame=1:3:3");
    assert_false(sweep.axes[0].is_variable);
    assert_string_equal(sweep.axes[0].values[2].override, "frame=3");
}

static void test_cells(void** state)
{
    (void)state;
    const char* const arguments[] = {"a=1,2,3", "b.c=x,y", "d=7,8"};
    assert_int_equal(parse(arguments, 3, false, 12), TY_OK);
    assert_int_equal(sweep.cell_count, 12);
    for (int cell = 0; cell < 12; ++cell)
    {
        assert_int_equal(ty_sweep_index(&sweep, cell, 0), cell / 4);
        assert_int_equal(ty_sweep_index(&sweep, cell, 1), cell / 2 % 2);
        assert_int_equal(ty_sweep_index(&sweep, cell, 2), cell % 2);
    }
    assert_string_equal(ty_sweep_value_at(&sweep, 6, 1)->override, "b.c=y");
    const char* const zipped[] = {"a=1,1,3", "b.c=x,y,y"};
    assert_int_equal(parse(zipped, 2, true, 3), TY_OK);
    assert_int_equal(sweep.cell_count, 3);
    assert_string_equal(ty_sweep_value_at(&sweep, 1, 0)->text, "1");
    assert_string_equal(ty_sweep_value_at(&sweep, 1, 1)->text, "y");
}

static const char* name_of(int cell)
{
    static char name[TY_SWEEP_NAME_MAX];
    ty_sweep_name(&sweep, cell, name);
    return name;
}

static void test_names(void** state)
{
    (void)state;
    const char* const arguments[] = {"moisture=0:1:3", "camera.vfov=20,30"};
    assert_int_equal(parse(arguments, 2, false, 100), TY_OK);
    assert_string_equal(name_of(0), "moisture=0,camera.vfov=20");
    assert_string_equal(name_of(3), "moisture=0.5,camera.vfov=30");
    // More values elsewhere change no name.
    const char* const more[] = {"moisture=0.5,0.7", "camera.vfov=10:30:5"};
    assert_int_equal(parse(more, 2, false, 100), TY_OK);
    assert_string_equal(name_of(4), "moisture=0.5,camera.vfov=30");
    // The texts are the values: the hash is of them, the same on every machine.
    parse_one("m.color=[0.8, 0.7],[0.8  0.7],[0.8; 0.7]");
    assert_string_equal(name_of(0), "m.color=_0.8_0.7_~64d858d696");
    for (int a = 0; a < 3; ++a)
    {
        char first[TY_SWEEP_NAME_MAX];
        memcpy(first, name_of(a), sizeof first);
        assert_int_equal(strspn(first, "abcdefghijklmnopqrstuvwxyz0123456789._+-=,~"), strlen(first));
        for (int b = 0; b < a; ++b)
            assert_string_not_equal(first, name_of(b));
    }
    // An axis is not another's value, nor a folder.
    parse_one("a='1,b=2',../x,..");
    for (int a = 0; a < 3; ++a)
        assert_null(strpbrk(name_of(a), "/' "));
    assert_non_null(strchr(name_of(0), '~'));
}

static void test_long_names(void** state)
{
    (void)state;
    char argument[2048] = "a=";
    for (int i = 0; i < 2; ++i)
    {
        size_t used = strlen(argument);
        memset(argument + used, 'x', 500);
        snprintf(argument + used + 500, 8, "%d%s", i, i ? "" : ",");
    }
    parse_one(argument);
    char first[TY_SWEEP_NAME_MAX];
    memcpy(first, name_of(0), sizeof first);
    assert_true(strlen(first) < TY_SWEEP_NAME_MAX - 20);
    assert_string_not_equal(first, name_of(1));
}

static void test_mistakes(void** state)
{
    (void)state;
    expect_bad("moisture", 1, "NAME=VALUES");
    expect_bad("=1", 1, "NAME=VALUES");
    expect_bad("m=", 3, "a value is missing");
    expect_bad("m=1,,2", 5, "a value is missing");
    expect_bad("m=1,2,", 7, "a value is missing");
    expect_bad("m=1,2,1", 7, "there twice");
    expect_bad("m=0:1", 3, "FROM:TO:COUNT");
    expect_bad("m=0:x:3", 5, "expected a number, got 'x'");
    expect_bad("m=7,0:1:0", 9, "2..10000, got '0'");
    expect_bad("m=0:1:1", 7, "2..10000");
    expect_bad("m=0:1:2.5", 7, "2..10000");
    expect_bad("m=0:1:3:lin", 9, "'log'");
    expect_bad("m=0:1:3:log:x", 3, "FROM:TO:COUNT");
    expect_bad("m=2:2:3", 3, "empty");
    expect_bad("m=0:1:3:log", 3, "above 0");
    expect_bad("m=1,[2,3", 5, "'[' is not closed");
    expect_bad("m=0:1:101", 1, "more than 100 cells");
    const char* const twice[] = {"a=1,2", "a=3,4"};
    expect_mistake(twice, 2, false, 1, "varies already");
    const char* const within[] = {"film.size=[1,1],[2,2]", "film=3"};
    expect_mistake(within, 2, false, 1, "varies already");
    const char* const many[] = {"a=1:20:20", "b=1:6:6"};
    expect_mistake(many, 2, false, 1, "more than 100 cells");
    const char* const unequal[] = {"a=1,2", "bb=1:3:3"};
    expect_mistake(unequal, 2, true, 4, "here are 3, and 2 of 'a'");
    const char* const same[] = {"a=1,2,1", "b=x,y,x"};
    expect_mistake(same, 2, true, 7, "values 1 and 3 are the same");
    expect_mistake(NULL, 0, false, 0, "1..16");
    // All at once.
    const char* const several[] = {"a=1,,2", "b=0:1"};
    assert_int_equal(parse(several, 2, false, 100), TY_USAGE);
    assert_int_equal(fixture_errors.count, 2);
}

// A mistake that loading finds in a cell's value is told where the value was written.
static void expect_place(const char* argument, int cell, int column, const char* text)
{
    parse_one(argument);
    const ty_sweep_value* value = ty_sweep_value_at(&sweep, cell, 0);
    ty_scene_options options = {.check_only = true};
    if (sweep.axes[0].is_variable)
        options = (ty_scene_options){.variables = &value->override, .variable_count = 1, .check_only = true};
    else
        options = (ty_scene_options){.sets = &value->override, .set_count = 1, .check_only = true};
    fixture_write("scene.yaml", "tsuya: 1\ncamera: { vfov: $angle }\nvars: { angle: 30 }\n");
    assert_int_not_equal(fixture_load(&options), TY_OK);
    assert_int_equal(fixture_errors.count, 1);
    ty_error* error = &fixture_errors.items[0];
    assert_true(ty_sweep_place_error(&sweep, cell, error));
    assert_string_equal(error->file, "--vary");
    assert_int_equal(error->column, column);
    if (!strstr(error->text, text))
        fail_msg("'%s' is not in '%s'", text, error->text);
    assert_non_null(strstr(error->text, argument));
    assert_null(strstr(error->text, "--set"));
    assert_false(ty_sweep_place_error(&sweep, cell, error));
}

static void test_places(void** state)
{
    (void)state;
    expect_place("camera.vfov=20,400", 1, 16, "is 400");
    expect_place("camera.vfov=100:400:3", 2, 13, "value 400 of the range");
    expect_place("angle=20,ab,30", 1, 10, "'ab'");
    expect_place("camera.vfow=20,30", 1, 8, "vfov");
    expect_place("angel=20,30", 1, 1, "angle");
    expect_place("camera.position=[0,1,2],[0,1,x]", 1, 30, "'x'");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ranges), cmocka_unit_test(test_lists),      cmocka_unit_test(test_cells),
        cmocka_unit_test(test_names),  cmocka_unit_test(test_long_names), cmocka_unit_test(test_mistakes),
        cmocka_unit_test(test_places),
    };
    int failed = cmocka_run_group_tests(tests, fixture_begin, fixture_end);
    ty_sweep_term(&sweep);
    return failed;
}
