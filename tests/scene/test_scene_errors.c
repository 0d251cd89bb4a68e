// SPDX-License-Identifier: Apache-2.0
// Mistakes: every one of a file is found, each at its line and column, with what would have been right.
#include "scene/fixture.h"

static void six_mistakes_are_all_listed(void** state)
{
    (void)state;
    static const char text[] = "tsuya: 1\n"                                                       // 1
                               "film: { size: [960, 540], fliter: box }\n"                        // 2
                               "camera: { position: [0, 0, 1], look_at: [0, 0, 0], vfov: 200 }\n" // 3
                               "assets:\n"                                                        // 4
                               "  ball: { shape: sphere, radius: .1 }\n"                          // 5
                               "materials:\n"                                                     // 6
                               "  rice: { model: cdrf, moisture: [1, 2] }\n"                      // 7
                               "  wood: { model: surface, base_color: { texture: gone.png } }\n"  // 8
                               "objects:\n"                                                       // 9
                               "  - { mesh: ball, material: ricee }\n"                            // 10
                               "lights:\n"                                                        // 11
                               "  - { type: rectangel, radiance: 20 }\n";                         // 12
    assert_int_equal(fixture_check(text), TY_BAD_INPUT);
    assert_null(fixture_scene);
    assert_true(fixture_has("scene.yaml", 2, 27, "unknown key 'fliter' in film; did you mean 'filter'?"));
    assert_true(fixture_has("scene.yaml", 3, 58, "'vfov' is 200: out of range, expected a number 0.01..179 deg"));
    assert_true(fixture_has("scene.yaml", 7, 34, "'moisture': expected a number"));
    assert_true(fixture_has("scene.yaml", 7, 34, "got a list of 2"));
    assert_true(fixture_has("scene.yaml", 8, 50, "no file 'gone.png' (tried: "));
    assert_true(fixture_has("scene.yaml", 10, 29, "no material 'ricee'; did you mean 'rice'?"));
    assert_true(fixture_has("scene.yaml", 12, 13, "'rectangel' is not one of: environment, sky, rectangle"));
    assert_true(fixture_has("scene.yaml", 12, 13, "did you mean 'rectangle'?"));
    if (fixture_errors.count != 6)
        fixture_print_errors();
    assert_int_equal(fixture_errors.count, 6);
}

static void matter_out_of_range(void** state)
{
    (void)state;
#define WALK "tsuya: 1\nmaterials:\n  m: { model: walk, "
    fixture_one_error(WALK "subsurface_color: 1.2 }\n", 3, 39, "out of range, expected");
    fixture_one_error(WALK "subsurface_color: 1.2 }\n", 3, 39, "-1..1");
    fixture_one_error(WALK "color: [0.5, 1.01, 0] }\n", 3, 34, "0..1");
    fixture_one_error(WALK "subsurface_radius: 0 }\n", 3, 40, "1e-06..1000000 mm");
    fixture_one_error(WALK "absorption: -0.1 }\n", 3, 33, "0..1000000");
    fixture_one_error(WALK "specular_ior: 0.9 }\n", 3, 35, "1..3");
    fixture_one_error(WALK "anisotropy: 1 }\n", 3, 33, "-0.99..0.99");
    fixture_one_error(WALK "preset: marbel }\n", 3, 29, "did you mean 'marble'?");
    fixture_one_error(WALK "preset: brick }\n", 3, 29, "is not one of: none, apple");
    fixture_one_error(WALK "preset: apple, scattering: 1 }\n", 3, 29, "leave out one of them");
    fixture_one_error(WALK "evaluate: local, bounday: diffuse }\n", 3, 38, "did you mean 'boundary'?");
    fixture_one_error(
        "tsuya: 1\nmaterials:\n  m: { model: surface, transmission_weight: 1, transmission_scatter: 2 }\n", 3, 70,
        "must be above 0");
#undef WALK
}

static void files_that_are_no_yaml(void** state)
{
    (void)state;
    fixture_one_error("", 1, 1, "nothing is written here");
    fixture_one_error("# only a comment\n", 1, 1, "nothing is written here");
    fixture_one_error("tsuya: 1\nfilm: { size: [1, 2\ncamera: {}\n", 3, 7, "this is not YAML");
    fixture_one_error("tsuya: 1\nfilm:\n\tsize: 1\n", 3, 1, "this is not YAML");
    fixture_one_error("- 1\n", 1, 1, "expected a mapping");
    fixture_one_error("tsuya: 1\n---\ntsuya: 1\n", 2, 1, "second document");
    fixture_one_error("tsuya: !!int 1\n", 1, 8, "tags");
    fixture_one_error("tsuya: 1\nfilm: \"\\0\"\n", 2, 7, "zero byte");
    fixture_one_error("tsuya: 1\n\xff\n", 2, 1, "this is not YAML");
}

static void versions(void** state)
{
    (void)state;
    fixture_one_error("film: {}\n", 1, 1, "missing key 'tsuya'");
    fixture_one_error("tsuya: 2\n", 1, 8, "reads version 1, got '2'");
}

static void duplicate_keys(void** state)
{
    (void)state;
    fixture_one_error("tsuya: 1\nrender: { samples: 4, max_depth: 2, samples: 8 }\n", 2, 37,
                      "duplicate key 'samples', first at line 2");
    char text[4096] = "tsuya: 1\nvars:\n";
    for (int i = 0; i < 100; ++i) // enough for the index of the mapping
        snprintf(text + strlen(text), sizeof(text) - strlen(text), "  name%d: 1\n", i);
    strcat(text, "  name57: 1\n");
    fixture_one_error(text, 103, 3, "duplicate key 'name57', first at line 60");
}

static void numbers_are_plain_decimals(void** state)
{
    (void)state;
    const char* const bad[] = {"0x10",  "inf", ".inf", "nan", "-nan", "1e999", "12px",
                               "1_000", "1e",  "+",    "",    "1 2",  "1e39"};
    for (size_t i = 0; i < sizeof(bad) / sizeof(bad[0]); ++i)
    {
        char text[128];
        snprintf(text, sizeof(text), "tsuya: 1\ncamera: { f_stop: '%s' }\n", bad[i]);
        fixture_one_error(text, 2, 19, "'f_stop': expected a number of at least 0, got");
    }
    fixture_must_load("tsuya: 1\ncamera: { f_stop: +1.25e+1 }\n");
    fixture_near(fixture_scene->camera.f_stop, 12.5f, 0.0f);
    fixture_one_error("tsuya: 1\nrender: { samples: 4.5 }\n", 2, 20, "expected a whole number 1..65536");
    fixture_one_error("tsuya: 1\nrender: { samples: 99999999999 }\n", 2, 20, "expected a whole number");
    fixture_one_error("tsuya: 1\nrender: { samples: 0 }\n", 2, 20, "out of range");
    fixture_one_error("tsuya: 1\nrender: { seed: -1 }\n", 2, 17, "0..18446744073709551615, got '-1'");
    fixture_one_error("tsuya: 1\nrender: { seed: 18446744073709551616 }\n", 2, 17, "expected a whole number");
    fixture_one_error("tsuya: 1\nfilm: { half: yes }\n", 2, 15, "'half': expected true or false, got 'yes'");
}

static void wrong_types_say_what_was_there(void** state)
{
    (void)state;
    fixture_one_error("tsuya: 1\nfilm: [1]\n", 2, 7, "'film': expected a mapping, got a list of 1");
    fixture_one_error("tsuya: 1\nlights: { type: point }\n", 2, 9, "'lights': expected a list, got a mapping");
    fixture_one_error("tsuya: 1\nlights: [3]\n", 2, 10, "expected a mapping of 'light' parameters, got '3'");
    fixture_one_error("tsuya: 1\ncamera: { position: [0, 1] }\n", 2, 21, "three numbers [x, y, z]");
    fixture_one_error("tsuya: 1\ncamera: { position: [0, [1], 2] }\n", 2, 25, "got a list of 1");
    fixture_one_error("tsuya: 1\ncamera: { vfov: }\n", 2, 17, "got nothing");
    fixture_one_error("tsuya: 1\nfilm: { [1, 2]: 3 }\n", 2, 9, "a key must be a word");
    fixture_one_error("tsuya: 1\nmaterial: {}\n", 2, 1, "unknown key 'material' in a scene; did you mean 'materials'?");
    fixture_one_error("tsuya: 1\nlights: [{ type: point, intensity: '#12345' }]\n", 2, 36, "expected a colour");
    fixture_one_error("tsuya: 1\nlights: [{ type: point, intensity: { colour: 1 } }]\n", 2, 38,
                      "did you mean 'color'?");
    fixture_one_error("tsuya: 1\nlights: [{ type: point, intensity: { color: 1, space: lin_rec708 } }]\n", 2, 55,
                      "'intensity': colour space 'lin_rec708'");
}

static void cameras(void** state)
{
    (void)state;
    fixture_one_error("tsuya: 1\ncamera: { position: [1, 2, 3], look_at: [1, 2, 3] }\n", 2, 41, "own position");
    fixture_one_error("tsuya: 1\ncamera: { position: [0, 2, 0], look_at: [0, 1, 0] }\n", 2, 9, "'up' is zero or along");
    fixture_one_error("tsuya: 1\ncamera: { focus_distance: 1, focus_point: [0, 0, 0] }\n", 2, 27, "not both");
}

static void lights(void** state)
{
    (void)state;
    fixture_one_error("tsuya: 1\nlights: [{ type: rectangle, size: [0, 1] }]\n", 2, 36, "'size' is 0: out of range");
    fixture_one_error("tsuya: 1\nlights: [{ type: sphere, radiance: -1 }]\n", 2, 36, "out of range");
    fixture_one_error("tsuya: 1\nlights: [{ type: point, radiance: 1 }]\n", 2, 25,
                      "'radiance' means nothing for a point light, which has: name, type, group, intensity, power, "
                      "color, exposure, center");
    fixture_one_error("tsuya: 1\nlights: [{ type: directional, target: [0, 1, 0] }]\n", 2, 39, "own center");
    fixture_one_error("tsuya: 1\nlights: [{ radiance: 1 }]\n", 2, 10, "missing key 'type' of light");
    fixture_one_error("tsuya: 1\nlights: [{ type: environment, image: sky.exr }]\n", 2, 38, "no file 'sky.exr'");
    fixture_one_error("tsuya: 1\nlights: [{ type: disk, radius: 0 }]\n", 2, 32, "'radius' is 0: out of range");
    fixture_one_error("tsuya: 1\nlights: [{ type: cylinder, length: -1 }]\n", 2, 36, "'length' is -1: out of range");
    fixture_one_error("tsuya: 1\nlights: [{ type: cylinder, axis: [0, 0, 0] }]\n", 2, 34, "'axis' has no length");
    fixture_one_error("tsuya: 1\nlights: [{ type: sphere, power: -5 }]\n", 2, 33, "'power' is -5: out of range");
    fixture_one_error("tsuya: 1\nlights: [{ type: sphere, power: 5, radiance: 1 }]\n", 2, 33,
                      "either 'power' or 'radiance', not both");
    fixture_one_error("tsuya: 1\nlights: [{ type: spot, cone: 180 }]\n", 2, 30, "out of range");
    fixture_one_error("tsuya: 1\nlights: [{ type: spot, image: slide.png }]\n", 2, 31, "no file 'slide.png'");
    fixture_one_error("tsuya: 1\nlights: [{ type: sky, zenith: -1 }]\n", 2, 31, "out of range");
    fixture_one_error("tsuya: 1\nlights: [{ type: point, group: 'a b' }]\n", 2, 32, "light group 'a b': expected");
    fixture_one_error("tsuya: 1\nlights: [{ type: sphere, visible: { diffus: false } }]\n", 2, 37,
                      "unknown key 'diffus' in light.visible; did you mean 'diffuse'?");
}

static void links_to_lights(void** state)
{
    (void)state;
    static const char scene[] = "tsuya: 1\n"
                                "assets: { ball: { shape: sphere } }\n"
                                "materials: { m: { model: surface }, g: { model: surface, emission_luminance: 1 } }\n"
                                "lights: [{ name: key, type: point, group: warm }]\n"
                                "objects:\n"
                                "  - { name: lamp, mesh: ball, material: g, light_group: lamps }\n"
                                "  - { name: dull, mesh: ball, material: m%s }\n";
    static const struct
    {
        const char *keys, *error;
        int column;
    } cases[] = {
        {", lights: [key, kei]", "no light, glowing object or light group 'kei'; did you mean 'key'?", 58},
        {", lights: [warm, lamps, lamp, dull]", "no light, glowing object or light group 'dull'", 72},
        {", exclude_lights: wram", "did you mean 'warm'?", 60},
        {", lights: key, exclude_lights: lamp", "either 'lights' or 'exclude_lights', not both", 73},
        {", lights: { key: true }", "'lights': expected a list of texts", 52},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    {
        char text[1024];
        snprintf(text, sizeof text, scene, cases[i].keys);
        fixture_one_error(text, 7, cases[i].column, cases[i].error);
    }
}

static void objects(void** state)
{
    (void)state;
    static const char head[] = "tsuya: 1\nassets:\n  ball: { shape: sphere }\nmaterials: { m: { model: surface } }\n";
    const struct
    {
        const char* object;
        int column;
        const char* text;
    } cases[] = {
        {"{ mesh: bal, material: m }", 19, "no asset 'bal'; did you mean 'ball'?"},
        {"{ aggregate: ball, material: m }", 24, "asset 'ball' is no aggregate"},
        {"{ mesh: ball }", 11, "missing key 'material' (or 'materials') of an object"},
        {"{ material: m }", 11, "missing key 'mesh', 'aggregate' or 'gltf'"},
        {"{ mesh: ball, aggregate: ball, material: m }", 36, "not both"},
        {"{ mesh: ball, material: m, scale: [1, 0, 1] }", 45, "flat"},
        {"{ mesh: ball, material: m, scale: big }", 45, "'scale': expected three numbers"},
        {"{ mesh: ball, materail: m }", 25, "did you mean 'material'?"},
    };
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); ++i)
    {
        char text[512];
        snprintf(text, sizeof(text), "%sobjects: [%s]\n", head, cases[i].object);
        assert_int_equal(fixture_check(text), TY_BAD_INPUT);
        assert_true(fixture_has("scene.yaml", 5, cases[i].column, cases[i].text));
    }
}

static void assets_and_materials(void** state)
{
    (void)state;
    fixture_one_error("tsuya: 1\nassets: { a: { msh: x.ply } }\n", 2, 14, "asset 'a': expected one of the keys");
    fixture_one_error("tsuya: 1\nassets: { a: { mesh: x.ply } }\n", 2, 22, "mesh: no file 'x.ply' (tried: ");
    fixture_one_error("tsuya: 1\nassets: { a: { shape: cube } }\n", 2, 23, "'cube' is not one of:");
    fixture_one_error("tsuya: 1\nassets: { a: { shape: tube, points: 3 } }\n", 2, 37, "expected a list of points");
    fixture_one_error("tsuya: 1\nassets: { a: { shape: tube, points: [[0, 0, 0], [1, 2]] } }\n", 2, 49,
                      "three numbers [x, y, z] -10000..10000 m, got a list of 2");
    fixture_one_error("tsuya: 1\nassets: { a: { aggregate: { kind: agregate } } }\n", 2, 35,
                      "did you mean 'aggregate'?");
    fixture_one_error("tsuya: 1\nassets: { a: { aggregate: { count: 3 } } }\n", 2, 27, "missing key 'kind'");
    fixture_one_error("tsuya: 1\nmaterials: { m: { base_color: 1 } }\n", 2, 17, "missing key 'model'");
    fixture_one_error("tsuya: 1\nmaterials: { m: { model: cdrff } }\n", 2, 26, "did you mean 'cdrf'?");
    fixture_one_error("tsuya: 1\nmaterials: { m: { model: cdrf, kernel: gaussian } }\n", 2, 40, "kernel");
    fixture_one_error("tsuya: 1\nmaterials: { m: { model: surface, base_color: { texture: wod } } }\n", 2, 58,
                      "no asset 'wod'");
    fixture_one_error("tsuya: 1\nmaterials: { m: { model: surface, base_color: { texture: a.png, wrap: round } } }\n",
                      2, 71, "'wrap': 'round' is not one of");
    fixture_one_error(
        "tsuya: 1\nmaterials: { m: { model: surface, base_color: { texture: a.png, wrap: [clamp, round] } } }\n", 2, 79,
        "'wrap': 'round' is not one of");
    fixture_one_error("tsuya: 1\nmaterials: { m: { model: surface, base_color: { texture: a.png, wrap: [clamp] } } }\n",
                      2, 71, "'wrap'");
    fixture_one_error("tsuya: 1\nmaterials: { m: { model: surface, base_color: { value: 1 } } }\n", 2, 47,
                      "'base_color': expected a colour");
}

static void damaged_files_are_named_at_their_place(void** state)
{
    (void)state;
    fixture_write("a.ply", "ply\nformat ascii 1.0\nelement vertex 2000000000\nproperty float x\nend_header\n");
    fixture_write("a.png", "\x89PNG\r\n\x1a\n");
    fixture_write("a.glb", "glTF\x02");
    assert_int_equal(
        fixture_check("tsuya: 1\nassets:\n  p: { mesh: a.ply }\n  t: { texture: a.png }\n  g: { aggregate: a.glb }\n"),
        TY_BAD_FILE);
    assert_true(fixture_has("scene.yaml", 3, 14, "a.ply"));
    assert_true(fixture_has("scene.yaml", 4, 17, "a.png"));
    assert_true(fixture_has("scene.yaml", 5, 19, "a.glb"));
    assert_int_equal(fixture_errors.count, 3);
    // the same while loading: the file is bad, not the scene
    fixture_write("scene.yaml", "tsuya: 1\nassets: { p: { mesh: a.ply } }\nmaterials: { m: { model: surface } }\n"
                                "objects: [{ mesh: p, material: m }]\n");
    assert_int_equal(fixture_load(&(ty_scene_options){0}), TY_BAD_FILE);
    assert_true(fixture_has("scene.yaml", 2, 22, "a.ply"));
}

static void missing_scenes(void** state)
{
    (void)state;
    ty_scene_options options = {0};
    assert_int_equal(ty_scene_load("/nowhere/scene.yaml", &options, &fixture_scene, &fixture_errors), TY_BAD_FILE);
    assert_int_equal(fixture_errors.count, 1);
    assert_null(fixture_scene);
}

static void a_sandbox_keeps_inside(void** state)
{
    (void)state;
    ty_scene_options options = {.check_only = true, .sandbox = true};
    fixture_write("inside/scene.yaml",
                  "tsuya: 1\ninclude: ../outside.yaml\nassets: { a: { mesh: ../b.ply }, c: { mesh: "
                  "link.ply } }\n");
    fixture_write("outside.yaml", "film: {}\n");
    fixture_write("b.ply", "x");
    char path[TY_PATH_MAX], link[TY_PATH_MAX];
    assert_int_equal(symlink(fixture_path("b.ply", path), fixture_path("inside/link.ply", link)), 0);
    assert_int_equal(ty_scene_load(fixture_path("inside", path), &options, &fixture_scene, &fixture_errors),
                     TY_BAD_INPUT);
    assert_true(fixture_has("scene.yaml", 2, 10, "outside the scene's folder"));
    assert_true(fixture_has("scene.yaml", 3, 22, "outside the scene's folder"));
    assert_true(fixture_has("scene.yaml", 3, 45, "outside the scene's folder"));
    assert_int_equal(fixture_errors.count, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(six_mistakes_are_all_listed),
        FIXTURE_TEST(matter_out_of_range),
        FIXTURE_TEST(files_that_are_no_yaml),
        FIXTURE_TEST(versions),
        FIXTURE_TEST(duplicate_keys),
        FIXTURE_TEST(numbers_are_plain_decimals),
        FIXTURE_TEST(wrong_types_say_what_was_there),
        FIXTURE_TEST(cameras),
        FIXTURE_TEST(lights),
        FIXTURE_TEST(links_to_lights),
        FIXTURE_TEST(objects),
        FIXTURE_TEST(assets_and_materials),
        FIXTURE_TEST(damaged_files_are_named_at_their_place),
        FIXTURE_TEST(missing_scenes),
        FIXTURE_TEST(a_sandbox_keeps_inside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
