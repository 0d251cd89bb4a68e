// SPDX-License-Identifier: Apache-2.0
// Textures of materials: sequences at the scene's time, mappings, and what a check finds wrong with them.
#include "fixture.h"
#include <tsuya/image/image.h>

static void write_picture(const char* name, int width, int height, float level)
{
    char path[TY_PATH_MAX];
    float* pixels = TY_ALLOC(float, width* height * 3);
    for (int i = 0; i < width * height * 3; i++)
        pixels[i] = level;
    ty_image image = {.width = width, .height = height, .channels = 3, .pixels = pixels};
    assert_int_equal(ty_image_write(fixture_path(name, path), &image, 8, NULL), TY_OK);
    ty_free(pixels);
}

static void write_frames(int first, int last)
{
    char name[32];
    for (int i = first; i <= last; i++)
    {
        snprintf(name, sizeof name, "fill.%04d.png", i);
        write_picture(name, 4, 4, (float)(i * 10) / 255.0f);
    }
}

static const char sequence[] = "tsuya: 1\n"
                               "timeline: { start: 1, end: 8, fps: 24 }\n"
                               "assets:\n"
                               "  floor: { shape: plane }\n"
                               "  fill: { frames: fill.####.png, fps: 12, loop: true%s }\n"
                               "materials:\n"
                               "  m: { model: surface, specular_roughness: { texture: fill } }\n"
                               "objects:\n"
                               "  - { mesh: floor, material: m }\n";

static void write_sequence(const char* more)
{
    char* text = ty_string_format(sequence, more);
    fixture_write("scene.yaml", text);
    ty_free(text);
}

static float roughness(void)
{
    const ty_vec2 middle = {0.5f, 0.5f}, none = {0.0f, 0.0f};
    return ty_mip_texture_sample(fixture_scene->shading.textures[0], middle, none, none).rgb.r * 255.0f / 10.0f;
}

static void load_sequence(const char* more)
{
    write_sequence(more);
    const ty_scene_options options = {0};
    ty_status status = fixture_load(&options);
    if (status != TY_OK)
        fixture_print_errors();
    assert_int_equal(status, TY_OK);
}

static int converted(void)
{
    ty_mip_cache_stats stats;
    ty_mip_cache_get_stats(fixture_scene->texture_cache, &stats);
    return stats.files_converted;
}

// The scene runs twice as fast as the texture; a frame that stays costs nothing.
static void sequences_follow_the_scene(void** state)
{
    (void)state;
    write_frames(1, 3);
    load_sequence("");
    static const float expected[8] = {1, 1, 2, 2, 3, 3, 1, 1};
    static const int files[8] = {1, 1, 2, 2, 3, 3, 3, 3};
    for (int i = 0; i < 8; i++)
    {
        assert_int_equal(ty_scene_set_frame(fixture_scene, 1.0 + i, &fixture_errors), TY_OK);
        fixture_near(roughness(), expected[i], 0.01f);
        assert_int_equal(converted(), files[i]);
    }
    load_sequence(", interpolate: linear");
    assert_int_equal(converted(), 0); // kept from before
    assert_int_equal(ty_scene_set_frame(fixture_scene, 2.0, &fixture_errors), TY_OK);
    fixture_near(roughness(), 1.5f, 0.01f);
    load_sequence(", first_frame: 2, last_frame: 3");
    fixture_near(roughness(), 2.0f, 0.01f);
}

// The scene is another when any frame is.
static void frames_are_part_of_the_scene(void** state)
{
    (void)state;
    char before[33];
    write_frames(1, 3);
    load_sequence("");
    memcpy(before, fixture_scene->hash, sizeof before);
    load_sequence("");
    assert_string_equal(before, fixture_scene->hash);
    write_picture("fill.0003.png", 4, 4, 0.5f);
    load_sequence("");
    assert_string_not_equal(before, fixture_scene->hash);
}

static void a_check_finds_what_is_missing(void** state)
{
    (void)state;
    char path[TY_PATH_MAX];
    const ty_scene_options check = {.check_only = true};
    write_sequence("");
    assert_int_equal(fixture_load(&check), TY_BAD_INPUT);
    assert_true(fixture_has("scene.yaml", 5, 19, "no frame of 'fill.####.png'"));
    write_frames(1, 14);
    assert_int_equal(fixture_load(&check), TY_OK);
    static const int missing[] = {7, 10, 11, 12};
    for (int i = 0; i < 4; i++)
    {
        char name[32];
        snprintf(name, sizeof name, "fill.%04d.png", missing[i]);
        unlink(fixture_path(name, path));
    }
    assert_int_equal(fixture_load(&check), TY_BAD_FILE);
    assert_true(fixture_has("scene.yaml", 5, 19, "frames 7, 10-12 missing of 1-14"));
    write_frames(7, 12);
    write_picture("fill.0009.png", 4, 8, 0.5f);
    assert_int_equal(fixture_load(&check), TY_BAD_FILE);
    assert_true(fixture_has("scene.yaml", 5, 19, "a frame of 4 x 8 in a sequence of 4 x 4"));
    fixture_write("fill.0009.png", "no picture");
    assert_int_equal(fixture_load(&check), TY_BAD_FILE);
    assert_true(fixture_has("scene.yaml", 5, 19, "not an image"));
}

static void a_check_looks_at_the_timeline(void** state)
{
    (void)state;
    write_frames(1, 3); // a quarter of a second; the timeline's last frame is at 7/24 s
    static const char scene[] = "tsuya: 1\n"
                                "timeline: { start: 1, end: 8, fps: 24 }\n"
                                "assets:\n"
                                "  fill: { frames: fill.####.png, fps: %s }\n";
    char* text = ty_string_format(scene, "12");
    fixture_one_error(text, 4, 19, "frame 8 of the timeline, at 0.291667 s, is outside of the sequence's 0 to 0.25 s");
    ty_free(text);
    text = ty_string_format(scene, "12, hold: true");
    fixture_must_load(text);
    ty_free(text);
    text = ty_string_format(scene, "10");
    fixture_must_load(text);
    ty_free(text);
    text = ty_string_format(scene, "12, hold: true, loop: true");
    fixture_one_error(text, 4, 9, "only one of 'loop', 'mirror' and 'hold'");
    ty_free(text);
}

static void mistakes_of_sequences(void** state)
{
    (void)state;
    write_frames(1, 2);
    fixture_one_error("tsuya: 1\nassets:\n  a: { frames: fill.0001.png }\n", 3, 16, "expected a name with ####");
    fixture_one_error("tsuya: 1\nassets:\n  a: { frames: fill.####.png, fps: 0 }\n", 3, 36, "out of range");
    fixture_one_error("tsuya: 1\nassets:\n  a: { frames: fill.####.png, lop: true }\n", 3, 31, "did you mean 'loop'");
    fixture_one_error("tsuya: 1\nassets:\n  a: { frames: fill.####.png, color_space: srgb_textur }\n", 3, 16,
                      "did you mean 'srgb_texture'");
    ty_scene_options options = {.check_only = true, .sandbox = true};
    char name[TY_PATH_MAX], target[TY_PATH_MAX];
    assert_int_equal(symlink("/etc/hostname", fixture_path("fill.0003.png", name)), 0);
    snprintf(target, sizeof target, "%s", name);
    fixture_write("scene.yaml", "tsuya: 1\nassets:\n  a: { frames: fill.####.png }\n");
    assert_int_equal(fixture_load(&options), TY_BAD_INPUT);
    assert_true(fixture_has("scene.yaml", 3, 16, "outside the scene's folder"));
}

#define MATERIAL(text) "tsuya: 1\nmaterials:\n  m: { model: surface, base_color: " text " }\n"

static void mappings_are_read(void** state)
{
    (void)state;
    write_picture("a.png", 4, 4, 0.5f);
    fixture_must_load(MATERIAL("{ texture: ./a.png, uv: { scale: [2, 3], offset: 0.5, rotate: 90 }, channel: g }"));
    fixture_must_load(MATERIAL("{ texture: ./a.png, mapping: triplanar, size: 0.2, blend: 1, channel: luminance }"));
    fixture_one_error(MATERIAL("{ texture: ./a.png, size: 0.2 }"), 3, 62, "nothing without 'mapping: triplanar'");
    fixture_must_load(MATERIAL("{ texture: ./a.png, mapping: planar, space: world, size: 0.2, uv: { offset: 0.5 } }"));
    fixture_one_error(MATERIAL("{ texture: ./a.png, mapping: planar, blend: 0.2 }"), 3, 80,
                      "without 'mapping: triplanar'");
    fixture_one_error(MATERIAL("{ texture: ./a.png, space: world }"), 3, 63, "'mapping: triplanar' or 'planar'");
    fixture_one_error(MATERIAL("{ texture: ./a.png, mapping: triplaner }"), 3, 65, "did you mean 'triplanar'");
    fixture_one_error(MATERIAL("{ texture: ./a.png, channel: x }"), 3, 65, "no channel 'x'; the file has R, G, B");
    fixture_one_error(MATERIAL("{ texture: ./a.png, uv: { scal: 2 } }"), 3, 62, "did you mean 'scale'");
    fixture_one_error(MATERIAL("{ attribute: tint, channel: r }"), 3, 55, "unknown key 'channel' in an attribute");
    fixture_one_error(MATERIAL("{ attribute: tint, ofset: 1 }"), 3, 55, "did you mean 'offset'");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(sequences_follow_the_scene),    FIXTURE_TEST(frames_are_part_of_the_scene),
        FIXTURE_TEST(a_check_finds_what_is_missing), FIXTURE_TEST(a_check_looks_at_the_timeline),
        FIXTURE_TEST(mistakes_of_sequences),         FIXTURE_TEST(mappings_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
