// SPDX-License-Identifier: Apache-2.0
// Fills, loops and filters as textures: keys by kind, frames at the scene's time, and channels of numbers.
#include "fixture.h"

// Three frames, all of each with one mark: 0, 1 and 2.
static const char marks[] = "tsuya: 1\nkind: fill\ncells: [8, 8]\nscale: 1\nstart: plain\n"
                            "marks:\n"
                            "  - { name: bare, preset: plain, color: [0.6, 0.3, 0.1], ground: [0.6, 0.3, 0.1] }\n"
                            "  - { name: moss, preset: plain, color: [0.1, 0.4, 0.05], ground: [0.1, 0.4, 0.05] }\n"
                            "  - { preset: plain, color: [0.2, 0.2, 0.2], ground: [0.2, 0.2, 0.2] }\n"
                            "run: { frames: 3, steps: 1 }\n"
                            "events:\n"
                            "  - { at: 2, op: mark, mark: moss, shape: all }\n"
                            "  - { at: 3, op: mark, mark: 2, shape: all }\n";
static const char grey[] = "tsuya: 1\nkind: fill\ncells: [8, 8]\nscale: 1\nstart: plain\nhigh: 0.25\nlow: 0.25\n"
                           "loop: { frames: 2, span: 0 }\nsteps: 1\n";
static const char turning[] =
    "tsuya: 1\nkind: loop\nvolume: [ { source: reaction, reaction: { cells: [16, 16], depth: 9, "
    "start: 40, every: 4 } } ]\niso: 0.3\nshow_values: true\nframes: 4\nsize: [8, 8]\n";
static const char redrawn[] =
    "tsuya: 1\nkind: filter\ncells: [24, 24]\nmode: plain\nedges: wrap\ntime: 40\nframes: 2\n";

static void write_recipes(void)
{
    fixture_write("marks.yaml", marks);
    fixture_write("grey.yaml", grey);
    fixture_write("turning.yaml", turning);
    fixture_write("redrawn.yaml", redrawn);
}

static void load(const char* asset, const char* inputs)
{
    char* text = ty_string_format("tsuya: 1\ntimeline: { start: 1, end: 3, fps: 24 }\n"
                                  "assets:\n  floor: { shape: plane }\n  skin: { %s }\n"
                                  "materials: { m: { model: surface, %s } }\n"
                                  "objects: [{ mesh: floor, material: m }]\n",
                                  asset, inputs);
    const ty_scene_options options = {0};
    fixture_write("scene.yaml", text);
    ty_free(text);
    ty_status status = fixture_load(&options);
    fixture_print_errors();
    assert_int_equal(status, TY_OK);
}

static ty_rgb color_of(int texture)
{
    const ty_vec2 somewhere = {0.3f, 0.6f}, none = {0.0f, 0.0f};
    return ty_mip_texture_sample(fixture_scene->shading.textures[texture], somewhere, none, none).rgb;
}

static float value_at(double frame)
{
    assert_int_equal(ty_scene_set_frame(fixture_scene, frame, &fixture_errors), TY_OK);
    return color_of(0).g;
}

static void each_kind_has_a_key(void** state)
{
    (void)state;
    write_recipes();
    load("fill: marks.yaml, loop: true", "base_color: { texture: skin }");
    load("loop: turning.yaml", "base_color: { texture: skin }");
    load("filter: redrawn.yaml, loop: true", "base_color: { texture: skin }");
    load("fill: { kind: fill, cells: [8, 8], steps: 1, loop: { frames: 2, span: 0 } }, hold: true",
         "base_color: { texture: skin }");
    fixture_must_load(
        "tsuya: 1\nassets: { a: { fill: marks.yaml, hold: true }, b: { frames: turning.yaml, loop: true } }\n");
}

#define SKIN(text) "tsuya: 1\nassets:\n  skin: " text "\n"

static void mistakes_have_places(void** state)
{
    (void)state;
    write_recipes();
    assert_int_equal(fixture_check(SKIN("{ fill: turning.yaml }")), TY_BAD_INPUT);
    assert_true(fixture_has("turning.yaml", 2, 7, "'fill': expected a recipe of kind 'fill', got one of kind 'loop'"));
    assert_int_equal(fixture_check(SKIN("{ loop: marks.yaml }")), TY_BAD_INPUT);
    assert_true(fixture_has("marks.yaml", 2, 7, "'loop': expected a recipe of kind 'loop', got one of kind 'fill'"));
    fixture_one_error(SKIN("{ fill: f.####.exr }"), 3, 17, "(a .yaml file, or in place), got 'f.####.exr'");
    fixture_one_error(SKIN("{ fill: none.yaml }"), 3, 17, "none.yaml");
    fixture_one_error(SKIN("{ loop: true }"), 3, 9, "expected one of the keys");
    fixture_one_error(SKIN("{ filer: a }"), 3, 9, "did you mean 'filter'");
    fixture_one_error(SKIN("{ loop: turning.yaml, hold: true }"), 3, 31, "unknown key 'hold'");
    fixture_one_error(SKIN("{ fill: marks.yaml, loop: true, mirror: true }"), 3, 9, "only one of");
}

// By number of the mark: 0, 1, 2.
static void frames_follow_time(void** state)
{
    (void)state;
    static const char inputs[] = "specular_roughness: { texture: skin, channel: mark, scale: 0.3 }";
    write_recipes();
    load("fill: marks.yaml, loop: true", inputs);
    static const float whole[6][2] = {{1, 0}, {2.5f, 1}, {3, 2}, {4, 0}, {7, 0}, {0.5f, 2}};
    for (int i = 0; i < 6; i++)
        fixture_near(value_at((double)whole[i][0]), whole[i][1], 0.0f);
    load("fill: marks.yaml, loop: true, interpolate: linear", inputs);
    static const float between[7][2] = {{1, 0},        {1.5f, 0.5f}, {2.25f, 1.25f}, {3.5f, 1},
                                        {3.75f, 0.5f}, {4, 0},       {0.5f, 1}};
    for (int i = 0; i < 7; i++)
        fixture_near(value_at((double)between[i][0]), between[i][1], 2e-6f);
    load("fill: marks.yaml, hold: true, interpolate: linear, fps: 12, start: 0.25", inputs); // frame 1 is shown at 7
    static const float held[6][2] = {{1, 0}, {7, 0}, {8, 0.5f}, {9, 1}, {11, 2}, {40, 2}};
    for (int i = 0; i < 6; i++)
        fixture_near(value_at((double)held[i][0]), held[i][1], 2e-6f);
    load("fill: marks.yaml", inputs);
    fixture_near(value_at(3.0), 2.0f, 0.0f);
    assert_int_equal(ty_scene_set_frame(fixture_scene, 4.0, &fixture_errors), TY_BAD_INPUT);
}

// A loop needs nobody to say that it is one.
static void loops_close(void** state)
{
    (void)state;
    write_recipes();
    load("loop: turning.yaml, interpolate: linear", "base_color: { texture: skin }");
    float first = value_at(1.0), last = value_at(4.0);
    assert_true(value_at(5.0) == first && value_at(-3.0) == first && value_at(0.0) == last);
    fixture_near(value_at(4.5), 0.5f * (first + last), 1e-6f);
}

static void channels_are_numbers(void** state)
{
    (void)state;
    write_recipes();
    load("fill: marks.yaml, loop: true, color_space: srgb_texture",
         "base_color: { texture: skin, channel: matte.moss }, specular_roughness: { texture: skin, channel: mark }, "
         "emission_luminance: { texture: skin, channel: matte.2 }, coat_weight: { texture: skin, channel: trail }");
    assert_int_equal(fixture_scene->assets_made, 1); // with all that anybody asks for
    static const float expected[3][4] = {{0, 0, 0, 1}, {1, 1, 0, 1}, {0, 2, 1, 1}};
    for (int frame = 0; frame < 3; frame++)
    {
        assert_int_equal(ty_scene_set_frame(fixture_scene, 1.0 + frame, &fixture_errors), TY_OK);
        for (int i = 0; i < 4; i++)
        {
            ty_rgb found = color_of(i);
            assert_true(found.r == found.g && found.g == found.b);
            fixture_near(found.g, expected[frame][i], 0.0f);
        }
    }
    load("fill: marks.yaml, loop: true", "base_color: { texture: skin, channel: v }");
    fixture_near(color_of(0).g, 0.334f, 0.01f); // of the plain state
}

static void colors_are_as_the_recipe_has_them(void** state)
{
    (void)state;
    write_recipes();
    load("fill: marks.yaml, loop: true", "base_color: { texture: skin }");
    ty_rgb found = color_of(0);
    fixture_near(found.r, 0.6f, 5e-4f);
    fixture_near(found.g, 0.3f, 5e-4f);
    fixture_near(found.b, 0.1f, 5e-4f);
    // Y beside u and v is no third of a colour.
    load("fill: grey.yaml, loop: true",
         "base_color: { texture: skin }, coat_weight: { texture: skin, channel: u }, fuzz_weight: { texture: skin, "
         "channel: v }");
    found = color_of(0);
    fixture_near(found.r, 0.25f, 0.0f);
    fixture_near(found.g, 0.25f, 0.0f);
    fixture_near(found.b, 0.25f, 0.0f);
}

#define INPUT(asset, text)                                                                                             \
    "tsuya: 1\nassets: { skin: { " asset " } }\nmaterials:\n  m: { model: surface, base_color: " text " }\n"

static void unknown_channels_are_named(void** state)
{
    (void)state;
    write_recipes();
    fixture_one_error(INPUT("fill: marks.yaml, hold: true", "{ texture: skin, channel: matte.mos }"), 4, 62,
                      "did you mean 'matte.moss'");
    fixture_one_error(INPUT("fill: marks.yaml, hold: true", "{ texture: skin, channel: matte.closed }"), 4, 62,
                      "makes no 'matte.closed'"); // nothing is closed
    fixture_one_error(INPUT("loop: turning.yaml", "{ texture: skin, channel: v }"), 4, 62, "kind 'loop'");
    fixture_one_error(INPUT("fill: marks.yaml, hold: true", "{ texture: skin, channel: [v] }"), 4, 62, "'channel'");
}

// Frames that were made by the command are the same texture.
static void files_have_channels(void** state)
{
    (void)state;
    char recipe[TY_PATH_MAX], out[TY_PATH_MAX];
    const char* set = "outputs=[mark]";
    ty_scene_options options = {.sets = &set, .set_count = 1};
    write_recipes();
    assert_int_equal(ty_recipe_make(fixture_path("marks.yaml", recipe), "fill", fixture_path("f.####.exr", out), 0,
                                    &options, &fixture_errors),
                     TY_OK);
    load("frames: f.####.exr, loop: true", "base_color: { texture: skin, channel: mark }");
    fixture_near(value_at(3.0), 2.0f, 0.0f);
    load("texture: f.0002.exr", "base_color: { texture: skin, channel: mark }");
    fixture_near(value_at(3.0), 1.0f, 0.0f);
    fixture_clear();
    assert_int_equal(fixture_check(INPUT("frames: f.####.exr, loop: true", "{ texture: skin, channel: v }")),
                     TY_BAD_INPUT);
    assert_true(fixture_has("scene.yaml", 4, 62, "no channel 'v'; the file has R, G, B, mark"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(each_kind_has_a_key),        FIXTURE_TEST(mistakes_have_places),
        FIXTURE_TEST(frames_follow_time),         FIXTURE_TEST(loops_close),
        FIXTURE_TEST(channels_are_numbers),       FIXTURE_TEST(colors_are_as_the_recipe_has_them),
        FIXTURE_TEST(unknown_channels_are_named), FIXTURE_TEST(files_have_channels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
