// SPDX-License-Identifier: Apache-2.0
// Includes, variables, aliases and bounds; the text of a scene makes the same scene again.
#include "scene/fixture.h"
#include <tsuya/geometry/mesh_file.h>
#include <tsuya/geometry/shape.h>

static void includes_merge_in_order(void** state)
{
    (void)state;
    fixture_write("first.yaml", "film: { size: [10, 20], filter: box }\nrender: { samples: 1, max_depth: 2 }\n"
                                "lights: [{ type: point }, { type: point }]\n");
    fixture_write("parts/second.yaml", "include: third.yaml\nrender: { samples: 3 }\n");
    fixture_write("parts/third.yaml", "render: { samples: 4, roulette_depth: 7 }\n");
    fixture_must_load(
        "tsuya: 1\ninclude: [first.yaml, parts/second.yaml]\nfilm: { filter: gaussian }\nlights: [{ type: point "
        "}]\n");
    const ty_scene* s = fixture_scene;
    assert_int_equal(s->film.size[1], 20);
    assert_int_equal(s->film.filter, TY_FILTER_GAUSSIAN);
    assert_int_equal(s->render.samples, 3);
    assert_int_equal(s->render.max_depth, 2);
    assert_int_equal(s->render.roulette_depth, 7);
    assert_int_equal(s->light_count, 1); // lists are replaced, not joined
}

static void mistakes_of_includes_stand_in_them(void** state)
{
    (void)state;
    fixture_write("parts/film.yaml", "film:\n  sizes: [1, 1]\n");
    assert_int_equal(fixture_check("tsuya: 1\ninclude: [parts/film.yaml, gone.yaml]\n"), TY_BAD_INPUT);
    assert_true(fixture_has("parts/film.yaml", 2, 3, "did you mean 'size'?"));
    assert_true(fixture_has("scene.yaml", 2, 28, "include: no file 'gone.yaml'"));
    assert_int_equal(fixture_errors.count, 2);
}

static void include_cycles_end(void** state)
{
    (void)state;
    fixture_write("a.yaml", "include: b.yaml\n");
    fixture_write("b.yaml", "include:\n  - a.yaml\n");
    assert_int_equal(fixture_check("tsuya: 1\ninclude: a.yaml\n"), TY_BAD_INPUT);
    assert_true(fixture_has("b.yaml", 2, 5, "includes itself"));
    assert_int_equal(fixture_errors.count, 1);
    fixture_one_error("tsuya: 1\ninclude: scene.yaml\n", 2, 10, "includes itself");
}

static void includes_are_bounded(void** state)
{
    (void)state;
    char name[64], text[64];
    for (int i = 0; i < 20; ++i)
    {
        snprintf(name, sizeof(name), "deep%d.yaml", i);
        snprintf(text, sizeof(text), "include: deep%d.yaml\n", i + 1);
        fixture_write(name, text);
    }
    assert_int_equal(fixture_check("tsuya: 1\ninclude: deep0.yaml\n"), TY_BAD_INPUT);
    assert_true(fixture_has("deep14.yaml", 1, 10, "deeper than 16"));
    // 2^10 files, were there no bound on their number
    for (int i = 0; i < 10; ++i)
    {
        snprintf(name, sizeof(name), "wide%d.yaml", i);
        char twice[128];
        snprintf(twice, sizeof(twice), "include: [wide%d.yaml, wide%d.yaml]\n", i + 1, i + 1);
        fixture_write(name, twice);
    }
    fixture_write("wide10.yaml", "film: {}\n");
    assert_int_equal(fixture_check("tsuya: 1\ninclude: wide0.yaml\n"), TY_BAD_INPUT);
    assert_int_equal(fixture_errors.count, 1);
    assert_non_null(strstr(fixture_errors.items[0].text, "more than 64 files"));
}

static void variables_are_replaced(void** state)
{
    (void)state;
    fixture_must_load(
        "tsuya: 1\nvars: { n: 12, size: [$n, 34], all: { size: $size, filter: $f }, f: box }\nfilm: $all\n"
        "render: { samples: \"$n\" }\n");
    assert_int_equal(fixture_scene->film.size[0], 12);
    assert_int_equal(fixture_scene->film.filter, TY_FILTER_BOX);
    assert_int_equal(fixture_scene->render.samples, 12);
    fixture_one_error("tsuya: 1\nvars: { moisture: 1 }\nrender: { samples: $moistre }\n", 3, 20,
                      "unknown variable '$moistre'; did you mean 'moisture'?");
    fixture_one_error("tsuya: 1\nrender: { samples: $n }\n", 2, 20, "unknown variable '$n'");
    // a bad value is reported where it is written
    fixture_one_error("tsuya: 1\nvars: { n: -3 }\nrender: { samples: $n }\n", 2, 12, "'samples' is -3: out of range");
    fixture_one_error("tsuya: 1\nvars: { a: $b, b: $a }\nrender: { samples: $a }\n", 2, 19, "stands in its own value");
    fixture_one_error("tsuya: 1\nvars: [a]\n", 2, 7, "'vars': expected a mapping");
}

static void a_dollar_is_escaped(void** state)
{
    (void)state;
    fixture_must_load("tsuya: 1\nassets: { b: { shape: sphere } }\nmaterials: { m: { model: surface } }\n"
                      "objects: [{ name: $$n, mesh: b, material: m }]\n");
    assert_string_equal(fixture_scene->objects[0].name, "$n");
    assert_non_null(strstr(fixture_scene->recipe, "name: $$n\n"));
}

static void aliases_are_copied(void** state)
{
    (void)state;
    fixture_must_load("tsuya: 1\nlights:\n  - &p { type: point, center: [1, 2, 3] }\n  - *p\n");
    assert_int_equal(fixture_scene->light_count, 2);
    fixture_near(fixture_scene->lights[1].center.z, 3.0f, 0.0f);
    fixture_one_error("tsuya: 1\nlights: *p\n", 2, 9, "an alias without its anchor");
    fixture_one_error("tsuya: 1\nlights: &p [*p]\n", 2, 13, "inside the value that it repeats");
}

// Ten times ten times ten ...
static void bombs_are_refused(void** state)
{
    (void)state;
    char aliases[4096] = "tsuya: 1\nvars:\n  a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
    char variables[4096] = "tsuya: 1\nvars:\n  a0: [x, x, x, x, x, x, x, x, x, x]\n";
    for (int i = 1; i < 9; ++i)
    {
        int p = i - 1;
        snprintf(aliases + strlen(aliases), sizeof(aliases) - strlen(aliases),
                 "  a%d: &a%d [*a%d, *a%d, *a%d, *a%d, *a%d, *a%d, *a%d, *a%d, *a%d, *a%d]\n", i, i, p, p, p, p, p, p,
                 p, p, p, p);
        snprintf(variables + strlen(variables), sizeof(variables) - strlen(variables),
                 "  a%d: [$a%d, $a%d, $a%d, $a%d, $a%d, $a%d, $a%d, $a%d, $a%d, $a%d]\n", i, p, p, p, p, p, p, p, p, p,
                 p);
    }
    strcat(variables, "film: $a8\n");
    assert_int_equal(fixture_check(aliases), TY_BAD_INPUT);
    assert_int_equal(fixture_errors.count, 1);
    assert_non_null(strstr(fixture_errors.items[0].text, "more than 100000 values"));
    assert_int_equal(fixture_check(variables), TY_BAD_INPUT);
    assert_int_equal(fixture_errors.count, 1);
    assert_non_null(strstr(fixture_errors.items[0].text, "more than 100000 values"));
}

static void check_deep(const char* open, int depth, const char* close, const char* expected)
{
    ty_status status;
    char* text = ty_alloc((size_t)depth * 8 + 64, 1);
    strcpy(text, "tsuya: 1\nvars: { v: ");
    size_t end = strlen(text);
    for (int i = 0; i < depth; ++i, end += strlen(open))
        memcpy(text + end, open, strlen(open));
    for (int i = 0; i < depth && close; ++i, end += strlen(close))
        memcpy(text + end, close, strlen(close));
    strcpy(text + end, "}\n");
    status = fixture_check(text);
    ty_free(text);
    assert_int_equal(status == TY_OK, expected == NULL);
    if (expected)
        assert_non_null(strstr(fixture_errors.items[0].text, expected));
}

static void depth_is_bounded(void** state)
{
    (void)state;
    check_deep("[", 60, "]", NULL);
    check_deep("[", 63, "]", "deeper than 64");
    check_deep("[", 100000, NULL, "deeper than 64");
    check_deep("{a: ", 100000, NULL, "deeper than 64");
    // variables within variables
    char text[8192] = "tsuya: 1\nvars:\n  v0: x\n";
    for (int i = 1; i < 100; ++i)
        snprintf(text + strlen(text), sizeof(text) - strlen(text), "  v%d: [$v%d]\n", i, i - 1);
    strcat(text, "film: $v99\n");
    assert_int_equal(fixture_check(text), TY_BAD_INPUT);
    assert_non_null(strstr(fixture_errors.items[0].text, "deeper than 64 levels once aliases and variables"));
}

static void files_are_bounded(void** state)
{
    (void)state;
    size_t size = ((size_t)16 << 20) + 100;
    char* text = ty_alloc(size, 1);
    memset(text, ' ', size - 1);
    memcpy(text, "tsuya: 1 #", 10);
    assert_int_equal(fixture_check(text), TY_BAD_FILE);
    memset(text, ',', size - 1);
    memcpy(text, "a: [", 4);
    for (size_t i = 4; i < 3000000; i += 2)
        text[i] = '1';
    text[3000000] = 0;
    assert_int_equal(fixture_check(text), TY_BAD_INPUT);
    ty_free(text);
    assert_int_equal(fixture_errors.count, 1);
    assert_non_null(strstr(fixture_errors.items[0].text, "more than 1000000"));
}

// --- the text of a scene ---

static void write_grain(const char* name)
{
    char path[TY_PATH_MAX];
    ty_error error;
    ty_shape_def def = ty_shape_def_default();
    ty_mesh* mesh = NULL;
    assert_int_equal(ty_shape_create(&def, &mesh, &error), TY_OK);
    assert_int_equal(ty_ply_write(fixture_path(name, path), mesh, &error), TY_OK);
    ty_mesh_destroy(mesh);
}

static const char rich[] =
    "tsuya: 1 # version\ninclude: parts/more.yaml\nvars: { w: 0.3, 'odd name': &o [1, 2, 3] }\n"
    "camera: { position: *o, vfov: \"30\" }\n"
    "materials: { 'my: material': { model: cdrf, moisture: $w, color: '#ffeedd' }, \"new\\nline\": { model: surface }, "
    "yes: { model: surface } }\n"
    "objects:\n  - { mesh: grain, material: 'my: material', scale: 3, name: '$$# - \"quoted\" \\ \xc3\xa9' }\n"
    "  - { mesh: grain, material: \"new\\nline\", name: '-' }\n  - { mesh: grain, material: yes, name: '...' }\n"
    "lights: []\nfilm:\n";

static void the_text_of_a_scene_is_a_fixpoint(void** state)
{
    (void)state;
    const char* sets[] = {"camera.vfov=31", "film.size=[64, 32]"};
    const char* variables[] = {"w=0.4"};
    ty_scene_options options = {
        .check_only = true, .sets = sets, .set_count = 2, .variables = variables, .variable_count = 1};
    fixture_write("parts/more.yaml", "assets: { grain: { mesh: grain.ply } }\n");
    write_grain("parts/grain.ply");
    fixture_write("scene.yaml", rich);
    assert_int_equal(fixture_load(&options), TY_OK);
    assert_string_equal(fixture_scene->overrides, "-D w=0.4 --set camera.vfov=31 --set film.size=[64, 32]");
    assert_non_null(strstr(fixture_scene->recipe, "mesh: parts/grain.ply\n"));
    assert_non_null(strstr(fixture_scene->recipe, "moisture: 0.4\n"));
    assert_non_null(strstr(fixture_scene->recipe, "position: [1, 2, 3]\n"));
    assert_null(strstr(fixture_scene->recipe, "vars"));
    assert_null(strstr(fixture_scene->recipe, "include"));
    char* first = ty_string_copy(fixture_scene->recipe);
    char hash[33];
    strcpy(hash, fixture_scene->hash);
    fixture_must_load(first);
    assert_string_equal(fixture_scene->recipe, first);
    assert_string_equal(fixture_scene->hash, hash);
    assert_string_equal(fixture_scene->objects[0].name, "$# - \"quoted\" \\ \xc3\xa9");
    assert_string_equal(fixture_scene->material_names[1], "new\nline");
    assert_int_equal(fixture_scene->film.size[0], 64);
    ty_free(first);
}

#define TRIANGLE(last)                                                                                                 \
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"                  \
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 " last "\n3 0 1 2\n"

static void the_hash_covers_files_and_text(void** state)
{
    (void)state;
    static const char text[] = "tsuya: 1\nassets: { g: { mesh: g.ply } }\n";
    char first[33];
    fixture_write("g.ply", TRIANGLE("0"));
    fixture_must_load(text);
    strcpy(first, fixture_scene->hash);
    assert_int_equal(strlen(first), 32);
    fixture_must_load("tsuya: 1   # the same, written otherwise\nassets:\n  g:\n    mesh: ./g.ply\n");
    assert_string_equal(fixture_scene->hash, first);
    fixture_must_load("tsuya: 1\nassets: { g: { mesh: g.ply } }\nrender: { seed: 1 }\n");
    assert_string_not_equal(fixture_scene->hash, first);
    fixture_write("g.ply", TRIANGLE("1"));
    fixture_must_load(text);
    assert_string_not_equal(fixture_scene->hash, first);
}

static void a_scene_comes_from_memory_too(void** state)
{
    (void)state;
    static const char text[] = "tsuya: 1\nfilm: { size: [8, 9] }\n";
    ty_scene_options options = {.check_only = true};
    assert_int_equal(ty_scene_load_memory("picture.exr", text, strlen(text), &options, &fixture_scene, &fixture_errors),
                     TY_OK);
    assert_int_equal(fixture_scene->film.size[1], 9);
    fixture_clear();
    assert_int_equal(ty_scene_load_memory("picture.exr", "[", 1, &options, &fixture_scene, &fixture_errors),
                     TY_BAD_INPUT);
    assert_int_equal(fixture_errors.count, 1);
    assert_string_equal(fixture_errors.items[0].file, "picture.exr");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(includes_merge_in_order),
        FIXTURE_TEST(mistakes_of_includes_stand_in_them),
        FIXTURE_TEST(include_cycles_end),
        FIXTURE_TEST(includes_are_bounded),
        FIXTURE_TEST(variables_are_replaced),
        FIXTURE_TEST(a_dollar_is_escaped),
        FIXTURE_TEST(aliases_are_copied),
        FIXTURE_TEST(bombs_are_refused),
        FIXTURE_TEST(depth_is_bounded),
        FIXTURE_TEST(files_are_bounded),
        FIXTURE_TEST(the_text_of_a_scene_is_a_fixpoint),
        FIXTURE_TEST(the_hash_covers_files_and_text),
        FIXTURE_TEST(a_scene_comes_from_memory_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
