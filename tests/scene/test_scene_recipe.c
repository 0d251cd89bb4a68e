// SPDX-License-Identifier: Apache-2.0
// Recipes as assets: made once, kept, made again when damaged; their parameters are the scene's too.
#include "scene/fixture.h"
#include <dirent.h>

static const char recipe[] =
    "tsuya: 1\nkind: aggregate\nvars: { n: 12, wet: 0.5, spare: 1 }\nelement: { divisions: 5, variants: 1 }\n"
    "container: { shape: sphere, radius: 0.01 }\nfill: { count: $n }\nseed: 3\n";
static const char scene[] =
    "tsuya: 1\nvars: { wet: 0.4 }\nassets: { heap: { aggregate: recipes/heap.yaml } }\n"
    "materials: { m: { model: cdrf, moisture: { attribute: moisture, value: $wet, scale: .2, offset: 1 } } }\n"
    "objects: [{ aggregate: heap, material: m }]\n";

static char cache[TY_PATH_MAX];

static ty_status load(const char* variable, const char* set)
{
    ty_scene_options options = {.cache_folder = fixture_path("cache", cache)};
    options.variables = &variable;
    options.variable_count = variable != NULL;
    options.sets = &set;
    options.set_count = set != NULL;
    return fixture_load(&options);
}

static void write_both(void)
{
    fixture_write("recipes/heap.yaml", recipe);
    fixture_write("scene.yaml", scene);
}

static void must_load(const char* variable, const char* set, int made)
{
    ty_status status = load(variable, set);
    fixture_print_errors();
    assert_int_equal(status, TY_OK);
    assert_int_equal(fixture_scene->assets_made, made);
    assert_int_equal(fixture_scene->assets_cached, 1 - made);
}

static void the_second_load_makes_nothing(void** state)
{
    (void)state;
    write_both();
    must_load(NULL, NULL, 1);
    assert_int_equal(fixture_scene->objects[0].instance_count, 12);
    assert_non_null(fixture_scene->shading.object_attributes[0][0]);
    char hash[33];
    strcpy(hash, fixture_scene->hash);
    ty_affine first = ty_world_to_world(fixture_scene->world, 0, 5, 0.0f);
    must_load(NULL, NULL, 0);
    assert_string_equal(fixture_scene->hash, hash);
    ty_affine again = ty_world_to_world(fixture_scene->world, 0, 5, 0.0f);
    assert_memory_equal(&again, &first, sizeof(first));
    // shading does not touch the asset, the recipe does
    must_load("wet=.3", NULL, 0);
    assert_string_not_equal(fixture_scene->hash, hash);
    must_load("n=13", NULL, 1);
    assert_int_equal(fixture_scene->objects[0].instance_count, 13);
    must_load("spare=2", NULL, 0); // the recipe knows it, even if it does not use it
    must_load(NULL, "assets.heap.aggregate.fill.count=14", 1);
    assert_int_equal(fixture_scene->objects[0].instance_count, 14);
    assert_int_equal(load("m=7", NULL), TY_BAD_INPUT);
    assert_true(fixture_has("-D", 1, 1, "no variable 'm'"));
}

// Applies fn to the one file in the cache.
static void for_cached_file(void (*fn)(const char* path))
{
    DIR* folder = opendir(cache);
    assert_non_null(folder);
    int count = 0;
    for (struct dirent* entry = readdir(folder); entry; entry = readdir(folder))
        if (entry->d_name[0] != '.')
        {
            char path[TY_PATH_MAX];
            ty_path_join(cache, entry->d_name, path);
            assert_string_equal(ty_path_extension(path), "glb");
            fn(path);
            ++count;
        }
    closedir(folder);
    assert_int_equal(count, 1);
}

static void cut(const char* path)
{
    assert_int_equal(truncate(path, 1000), 0);
}

static void replace(const char* path)
{
    fixture_write("other.yaml", recipe);
    char other[TY_PATH_MAX];
    const char* variable = "n=10";
    ty_scene_options options = {.variables = &variable, .variable_count = 1};
    assert_int_equal(ty_recipe_make(fixture_path("other.yaml", other), NULL, path, 0, &options, &fixture_errors),
                     TY_OK);
}

static void damaged_files_are_made_again(void** state)
{
    (void)state;
    write_both();
    must_load(NULL, NULL, 1);
    for_cached_file(cut);
    must_load(NULL, NULL, 1);
    must_load(NULL, NULL, 0);
    for_cached_file(replace); // a good file, but of another recipe
    must_load(NULL, NULL, 1);
    assert_int_equal(fixture_scene->objects[0].instance_count, 12);
}

static void recipes_are_written_into_the_scene(void** state)
{
    (void)state;
    write_both();
    must_load("n=11", NULL, 1);
    assert_non_null(strstr(fixture_scene->recipe, "  heap:\n    aggregate:\n      kind: aggregate\n"));
    assert_non_null(strstr(fixture_scene->recipe, "count: 11\n"));
    char* text = ty_string_copy(fixture_scene->recipe);
    char hash[33];
    strcpy(hash, fixture_scene->hash);
    char path[TY_PATH_MAX];
    assert_int_equal(remove(fixture_path("recipes/heap.yaml", path)), 0);
    fixture_write("scene.yaml", text);
    must_load(NULL, NULL, 0); // the same asset
    assert_string_equal(fixture_scene->recipe, text);
    assert_string_equal(fixture_scene->hash, hash);
    ty_free(text);
}

static void mistakes_of_recipes_stand_in_them(void** state)
{
    (void)state;
    write_both();
    fixture_write("recipes/heap.yaml",
                  "tsuya: 1\nkind: aggregate\nfill: { cuont: 3 }\ncontainer: { shape: mesh, mesh: v.ply }\n");
    assert_int_equal(load(NULL, NULL), TY_BAD_INPUT);
    assert_true(fixture_has("recipes/heap.yaml", 3, 9, "did you mean 'count'?"));
    assert_true(fixture_has("recipes/heap.yaml", 4, 33, "no file 'v.ply'"));
    assert_non_null(strstr(fixture_errors.items[1].text, "recipes/v.ply"));
    assert_int_equal(fixture_errors.count, 2);
    fixture_write("recipes/heap.yaml", "kind: aggregate\n");
    assert_int_equal(load(NULL, NULL), TY_BAD_INPUT);
    assert_true(fixture_has("recipes/heap.yaml", 1, 1, "missing key 'tsuya'"));
}

static void a_missing_attribute_is_named(void** state)
{
    (void)state;
    write_both();
    fixture_write("scene.yaml", "tsuya: 1\nassets: { heap: { aggregate: recipes/heap.yaml } }\n"
                                "materials: { m: { model: surface, coat_weight: { attribute: burn } } }\n"
                                "objects: [{ aggregate: heap, material: m }]\n");
    assert_int_equal(load(NULL, NULL), TY_BAD_INPUT);
    assert_true(fixture_has("scene.yaml", 3, 61, "aggregate 'heap' has no attribute 'burn'; there are: "));
    assert_non_null(strstr(fixture_errors.items[0].text, "moisture"));
}

static void checking_makes_nothing(void** state)
{
    (void)state;
    write_both();
    ty_scene_options options = {.check_only = true, .cache_folder = fixture_path("cache", cache)};
    assert_int_equal(fixture_load(&options), TY_OK);
    assert_false(ty_folder_exists(cache));
    assert_int_equal(fixture_scene->assets_made, 0);
}

static void recipes_are_made_to_files(void** state)
{
    (void)state;
    char in[TY_PATH_MAX], out[TY_PATH_MAX];
    ty_scene_options options = {0};
    const char *set = "fill.count=10", *wrong = "fill.cuont=10";
    fixture_write("heap.yaml", recipe);
    fixture_path("heap.yaml", in);
    fixture_path("heap.glb", out);
    options.sets = &wrong;
    options.set_count = 1;
    assert_int_equal(ty_recipe_make(in, NULL, out, 0, &options, &fixture_errors), TY_BAD_INPUT);
    assert_true(fixture_has("--set", 1, 6, "did you mean 'count'?"));
    assert_false(ty_file_exists(out));
    options.sets = &set;
    fixture_clear();
    assert_int_equal(ty_recipe_make(in, NULL, out, 0, &options, &fixture_errors), TY_OK);
    ty_aggregate* aggregate = NULL;
    ty_error error;
    assert_int_equal(ty_aggregate_read(out, NULL, &aggregate, &error), TY_OK);
    assert_int_equal(aggregate->instance_count, 10);
    assert_non_null(strstr(aggregate->recipe, "count: 10\n"));
    assert_int_equal(strlen(aggregate->hash), 32);
    // what it carries makes it again
    fixture_write("again.yaml", aggregate->recipe);
    char again[TY_PATH_MAX];
    options.set_count = 0;
    fixture_path("again.yaml", in);
    assert_int_equal(ty_recipe_make(in, NULL, fixture_path("again.glb", again), 0, &options, &fixture_errors), TY_OK);
    ty_bytes one, two;
    assert_int_equal(ty_file_read(out, 1 << 26, &one, &error), TY_OK);
    assert_int_equal(ty_file_read(again, 1 << 26, &two, &error), TY_OK);
    assert_int_equal(one.size, two.size);
    assert_memory_equal(one.data, two.data, one.size);
    ty_bytes_term(&one);
    ty_bytes_term(&two);
    ty_aggregate_destroy(aggregate);
    assert_int_equal(ty_recipe_make("/nowhere.yaml", NULL, again, 0, &options, &fixture_errors), TY_BAD_FILE);
}

// What a generator refuses stands where the recipe says it, or as near as it says anything.
static void mistakes_have_a_place(void** state)
{
    (void)state;
    static const struct
    {
        const char *recipe, *place;
    } cases[] = {
        {"tsuya: 1\nkind: aggregate\ncontainer:\n  radius: 0.02\n  thickness: 0.01\n",
         "heap.yaml:5:3: container.thickness: 0.01 m"},
        {"tsuya: 1\nkind: aggregate\ncontainer: { radius: 0.02 }\nfill: { count: 90000 }\n",
         "heap.yaml:4:9: fill.count: 90000 grains"},
        {"tsuya: 1\nkind: aggregate\nelement: { length: 1 }\n", "heap.yaml:3:12: element.length: 1 mm"},
        {"tsuya: 1\nkind: aggregate\nelement: { kind: mesh }\n", "heap.yaml:3:1: element.mesh: a path"},
        {"tsuya: 1\nkind: aggregate\nelements:\n- { kind: ball }\n- { kind: ball, width: 2, fit: 0.001 }\n",
         "heap.yaml:5:27: elements[1].fit: 0.001"},
    };
    fixture_write("scene.yaml", scene);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    {
        fixture_write("recipes/heap.yaml", cases[i].recipe);
        assert_int_equal(load(NULL, NULL), TY_BAD_INPUT);
        if (fixture_errors.count != 1 || !strstr(fixture_errors.items[0].text, cases[i].place))
            fail_msg("not '%s': %s", cases[i].place,
                     fixture_errors.count > 0 ? fixture_errors.items[0].text : "nothing");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_have_a_place),
        FIXTURE_TEST(the_second_load_makes_nothing),
        FIXTURE_TEST(damaged_files_are_made_again),
        FIXTURE_TEST(recipes_are_written_into_the_scene),
        FIXTURE_TEST(mistakes_of_recipes_stand_in_them),
        FIXTURE_TEST(a_missing_attribute_is_named),
        FIXTURE_TEST(checking_makes_nothing),
        FIXTURE_TEST(recipes_are_made_to_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
