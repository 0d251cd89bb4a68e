// SPDX-License-Identifier: Apache-2.0
// --set and -D: any parameter, by index or name, with mistakes shown in the argument itself.
#include "scene/fixture.h"

static const char base[] =
    "tsuya: 1\nvars: { wet: 0.5, unused: 1 }\nassets: { ball: { shape: sphere, radius: 1 } }\n"
    "materials:\n  rice: { model: cdrf, moisture: $wet }\n"
    "objects:\n  - { mesh: ball, material: rice }\n  - { name: top, mesh: ball, material: rice }\n"
    "lights: [{ type: point }]\n";

static ty_status load_with(const char* set, const char* variable)
{
    ty_scene_options options = {.check_only = true};
    options.sets = &set;
    options.set_count = set != NULL;
    options.variables = &variable;
    options.variable_count = variable != NULL;
    fixture_write("scene.yaml", base);
    return fixture_load(&options);
}

static void must_set(const char* set, const char* in_recipe)
{
    ty_status status = load_with(set, NULL);
    fixture_print_errors();
    assert_int_equal(status, TY_OK);
    if (!strstr(fixture_scene->recipe, in_recipe))
        print_message("%s\nlacks %s\n", fixture_scene->recipe, in_recipe);
    assert_non_null(strstr(fixture_scene->recipe, in_recipe));
}

static void must_fail(const char* set, int column, const char* text)
{
    assert_int_equal(load_with(set, NULL), TY_BAD_INPUT);
    assert_null(fixture_scene);
    assert_true(fixture_has("--set", 1, column, text));
    assert_int_equal(fixture_errors.count, 1);
}

static void values_are_set(void** state)
{
    (void)state;
    must_set("materials.rice.color=[.8,.7,.6]", "color: [.8, .7, .6]\n");
    must_set("film.size=[3, 4]", "size: [3, 4]\n"); // the file has no film
    assert_int_equal(fixture_scene->film.size[1], 4);
    must_set("objects.1.translate=[1, 2, 3]", "translate: [1, 2, 3]\n");
    must_set("objects.top.scale=2", "scale: [2, 2, 2]\n");
    must_set("lights.0.intensity=10", "intensity: 10\n");
    fixture_near(fixture_scene->lights[0].intensity.g, 10.0f, 0.0f);
    must_set("materials.wood={model: surface}", "wood:\n");
    must_set("vars.wet=.25", "moisture: .25\n");
    must_set("materials.rice.cooked=$wet", "cooked: 0.5\n");
    must_set("assets.ball.radius=2", "radius: 2\n");
}

static void mistakes_point_into_the_argument(void** state)
{
    (void)state;
    must_fail("materials.rice.colour=1", 16, "unknown key 'colour' in material.cdrf; did you mean 'color'?");
    must_fail("materials.rice.colour=1", 16, "(in '--set materials.rice.colour=1')");
    must_fail("materials.ricee.color=1", 11, "no 'ricee' in materials; did you mean 'rice'?");
    must_fail("materials.rice.color=[1, 2]", 22, "expected a colour");
    must_fail("materials.rice.cooked=[1", 25, "this is not YAML");
    must_fail("objects.2.scale=1", 9, "no entry '2' in the list, which has 2");
    must_fail("objects.tp.scale=1", 9, "did you mean 'top'?");
    must_fail("lights.0.type.x=1", 15, "'type' is 'point': there is no 'x' in it");
    must_fail("matrials.rice.color=1", 1, "unknown key 'matrials' in a scene; did you mean 'materials'?");
    must_fail("vars.wett=1", 6, "no 'wett' in vars; did you mean 'wet'?");
    must_fail("render.samples", 1, "expected path=value");
    must_fail("=3", 1, "expected path=value");
    must_fail("render..samples=3", 8, "a step of the path is empty");
    must_fail("render.samples=$wat", 16, "unknown variable '$wat'; did you mean 'wet'?");
    must_fail("film.size=", 11, "nothing is written here");
}

static void variables_are_defined(void** state)
{
    (void)state;
    assert_int_equal(load_with(NULL, "wet=.125"), TY_OK);
    assert_non_null(strstr(fixture_scene->recipe, "moisture: .125\n"));
    assert_int_equal(load_with(NULL, "wt=.125"), TY_BAD_INPUT);
    assert_true(fixture_has("-D", 1, 1, "no variable 'wt'; did you mean 'wet'?"));
    assert_int_equal(load_with(NULL, "wet=7"), TY_BAD_INPUT);
    assert_true(fixture_has("-D", 1, 5, "'moisture' is 7: out of range, expected a number 0..1"));
    assert_int_equal(load_with(NULL, "wet"), TY_BAD_INPUT);
    assert_true(fixture_has("-D", 1, 1, "expected name=value"));
}

static void the_last_of_two_wins(void** state)
{
    (void)state;
    const char* sets[] = {"render.samples=3", "render.samples=5"};
    const char* variables[] = {"wet=.1", "wet=.2"};
    fixture_write("scene.yaml", base);
    ty_scene_options options = {
        .check_only = true, .sets = sets, .set_count = 2, .variables = variables, .variable_count = 2};
    assert_int_equal(fixture_load(&options), TY_OK);
    assert_int_equal(fixture_scene->render.samples, 5);
    assert_non_null(strstr(fixture_scene->recipe, "moisture: .2\n"));
    assert_string_equal(fixture_scene->overrides, "-D wet=.1 -D wet=.2 --set render.samples=3 --set render.samples=5");
}

static void quick_is_an_override(void** state)
{
    (void)state;
    ty_scene_options options = {.check_only = true, .quick = true};
    fixture_write("scene.yaml", "tsuya: 1\nfilm: { size: [101, 50] }\nrender: { samples: 500 }\n");
    assert_int_equal(fixture_load(&options), TY_OK);
    assert_int_equal(fixture_scene->film.size[0], 51);
    assert_int_equal(fixture_scene->film.size[1], 25);
    assert_int_equal(fixture_scene->render.samples, 16);
    assert_string_equal(fixture_scene->overrides, "--quick");
    fixture_write("scene.yaml", "tsuya: 1\n");
    assert_int_equal(fixture_load(&options), TY_OK);
    assert_int_equal(fixture_scene->film.size[0], 480);
    // what is asked for in so many words wins
    const char* const sets[] = {"film.size=[200, 100]", "render.samples=4"};
    ty_scene_options precise = {.check_only = true, .quick = true, .sets = sets, .set_count = 2};
    assert_int_equal(fixture_load(&precise), TY_OK);
    assert_int_equal(fixture_scene->film.size[0], 200);
    assert_int_equal(fixture_scene->render.samples, 4);
    assert_string_equal(fixture_scene->overrides, "--quick --set film.size=[200, 100] --set render.samples=4");
    // mistakes stay visible
    fixture_write("scene.yaml", "tsuya: 1\nfilm: { size: [0, 2147483647] }\n");
    assert_int_equal(fixture_load(&options), TY_BAD_INPUT);
    assert_true(fixture_has("scene.yaml", 2, 16, "out of range"));
    fixture_write("scene.yaml", "tsuya: 1\nfilm: { size: big }\n");
    assert_int_equal(fixture_load(&options), TY_BAD_INPUT);
    assert_true(fixture_has("scene.yaml", 2, 15, "got 'big'"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(values_are_set),        FIXTURE_TEST(mistakes_point_into_the_argument),
        FIXTURE_TEST(variables_are_defined), FIXTURE_TEST(the_last_of_two_wins),
        FIXTURE_TEST(quick_is_an_override),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
