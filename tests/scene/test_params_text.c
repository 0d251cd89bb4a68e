// SPDX-License-Identifier: Apache-2.0
// Help, schema and reference come from the tables: every row is in each, and the schema is JSON.
#include "scene/fixture.h"
#include <ctype.h>
#include <math.h>

// A strict JSON reader that keeps nothing; NULL at the first fault.
static const char* json_value(const char* c);

static const char* json_blank(const char* c)
{
    return c ? c + strspn(c, " \t\r\n") : NULL;
}

static const char* json_string(const char* c)
{
    if (!c || *c++ != '"')
        return NULL;
    for (; *c != '"'; ++c)
    {
        if ((unsigned char)*c < 0x20)
            return NULL;
        if (*c == '\\' && !strchr("\"\\/bfnrtu", *++c))
            return NULL;
    }
    return c + 1;
}

static const char* json_number(const char* c)
{
    c += *c == '-';
    if (!isdigit((unsigned char)*c))
        return NULL;
    char* end = NULL;
    strtod(c, &end);
    return end;
}

static const char* json_members(const char* c, char close)
{
    c = json_blank(c + 1);
    if (*c == close)
        return c + 1;
    for (;;)
    {
        if (close == '}')
        {
            c = json_blank(json_string(c));
            if (!c || *c++ != ':')
                return NULL;
        }
        c = json_blank(json_value(json_blank(c)));
        if (!c || (*c != ',' && *c != close))
            return NULL;
        if (*c++ == close)
            return c;
        c = json_blank(c);
    }
}

static const char* json_value(const char* c)
{
    if (!c)
        return NULL;
    if (*c == '{' || *c == '[')
        return json_members(c, *c == '{' ? '}' : ']');
    if (*c == '"')
        return json_string(c);
    if (strncmp(c, "true", 4) == 0)
        return c + 4;
    if (strncmp(c, "false", 5) == 0)
        return c + 5;
    return json_number(c);
}

static void the_reader_of_this_test_can_fail(void** state)
{
    (void)state;
    assert_non_null(json_value("{\"a\": [1, -2e3, true, {}, []], \"b\": \"x\\\"\"}"));
    assert_null(json_value("{\"a\": 1,}"));
    assert_null(json_value("[1 2]"));
    assert_null(json_value("{a: 1}"));
    assert_null(json_value("[inf]"));
    assert_null(json_value("\"\n\""));
}

static void the_schema_is_json_and_complete(void** state)
{
    (void)state;
    char* schema = ty_params_schema();
    const char* end = json_value(schema);
    assert_non_null(end);
    assert_string_equal(end, "\n");
    int count = 0;
    const ty_param_table* const* tables = ty_scene_tables(&count);
    assert_true(count >= 11);
    for (int i = 0; i < count; ++i)
    {
        char* heading = ty_string_format("\n    \"%s\": {\"type\": \"object\"", tables[i]->name);
        const char* definition = strstr(schema, heading);
        assert_non_null(definition);
        ty_free(heading);
        for (int r = 0; r < tables[i]->count; ++r)
        {
            char* row = ty_string_format("\n      \"%s\": {\"description\": ", tables[i]->params[r].name);
            assert_non_null(strstr(definition, row));
            ty_free(row);
        }
    }
    // a second key of the same name, or a reference to nothing, would hide a rule
    char* text = ty_string_format("tsuya: 1\nvars:\n  schema: %s", schema);
    fixture_must_load(text);
    for (const char* c = strstr(schema, "\"#/$defs/"); c; c = strstr(c + 1, "\"#/$defs/"))
    {
        char* heading = ty_string_format("\n    \"%.*s\": {", (int)strcspn(c + 9, "\""), c + 9);
        assert_non_null(strstr(schema, heading));
        ty_free(heading);
    }
    ty_free(text);
    ty_free(schema);
}

static void a_table_is_shown(void** state)
{
    (void)state;
    char near[64];
    char* text = ty_params_text("camera", near);
    assert_non_null(text);
    assert_int_equal(strncmp(text, "camera: ", 8), 0);
    const char* row = strstr(text, "\n  vfov ");
    assert_non_null(row);
    assert_non_null(strstr(row, "number "));
    assert_non_null(strstr(row, "0.01..179 deg"));
    assert_non_null(strstr(row, " 40 "));
    assert_non_null(strstr(text, "vertical field of view\n"));
    assert_null(strstr(text, "film:"));
    ty_free(text);
    text = ty_params_text("cdrf", near);
    assert_int_equal(strncmp(text, "material.cdrf: ", 15), 0);
    ty_free(text);
    text = ty_params_text("camera.vfov", near);
    assert_non_null(strstr(text, "vfov"));
    assert_null(strstr(text, "look_at"));
    ty_free(text);
}

static void all_tables_are_shown(void** state)
{
    (void)state;
    char near[64];
    int count = 0;
    const ty_param_table* const* tables = ty_scene_tables(&count);
    char *text = ty_params_text(NULL, near), *page = ty_params_markdown(), *again = ty_params_markdown();
    for (int i = 0; i < count; ++i)
    {
        char* heading = ty_string_format("%s%s: ", i ? "\n" : "", tables[i]->name);
        assert_non_null(strstr(text, heading));
        ty_free(heading);
        heading = ty_string_format("\n## %s\n", tables[i]->name);
        assert_non_null(strstr(page, heading));
        ty_free(heading);
    }
    assert_string_equal(page, again);
    assert_non_null(strstr(page, "| `vfov` | a number 0.01..179 deg | `40` | vertical field of view |\n"));
    ty_free(text);
    ty_free(page);
    ty_free(again);
}

static void unknown_tables_are_guessed(void** state)
{
    (void)state;
    char near[64];
    assert_null(ty_params_text("camrea", near));
    assert_string_equal(near, "camera");
    assert_null(ty_params_text("zzzzzzzz", near));
    assert_string_equal(near, "");
}

static void defaults_lie_in_their_ranges(void** state)
{
    (void)state;
    int count = 0;
    const ty_param_table* const* tables = ty_scene_tables(&count);
    for (int i = 0; i < count; ++i)
        for (int r = 0; r < tables[i]->count; ++r)
        {
            const ty_param* row = &tables[i]->params[r];
            assert_true(row->minimum <= row->maximum);
            assert_non_null(row->help);
            assert_true((row->type == TY_PARAM_ENUM) == (row->choices != NULL));
            bool is_number = row->type == TY_PARAM_INT || row->type == TY_PARAM_FLOAT || row->type == TY_PARAM_FLOAT2 ||
                             row->type == TY_PARAM_SCALAR_INPUT;
            if (!is_number || (row->minimum == 0.0 && row->maximum == 0.0))
                continue;
            void* def = ty_alloc(1, tables[i]->size);
            tables[i]->set_default(def);
            double scale = strcmp(row->unit, "deg") == 0  ? 180.0 / 3.14159265358979
                           : strcmp(row->unit, "mm") == 0 ? 1e3
                                                          : 1.0;
            double value = row->type == TY_PARAM_INT ? *(int*)((char*)def + row->offset)
                                                     : (double)*(float*)((char*)def + row->offset) * scale;
            if (!(value >= row->minimum - 1e-6 * fabs(row->minimum) - 1e-12 && value <= row->maximum * (1 + 1e-6)))
                fail_msg("%s.%s: default %g", tables[i]->name, row->name, value);
            ty_free(def);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(the_reader_of_this_test_can_fail),
        FIXTURE_TEST(the_schema_is_json_and_complete),
        FIXTURE_TEST(a_table_is_shown),
        FIXTURE_TEST(all_tables_are_shown),
        FIXTURE_TEST(unknown_tables_are_guessed),
        FIXTURE_TEST(defaults_lie_in_their_ranges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
