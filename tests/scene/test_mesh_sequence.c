// SPDX-License-Identifier: Apache-2.0
// Meshes from sequences of files: where they are at a time, what is rebuilt, and what is wrong with the files.
#include "scene/fixture.h"

#define SCENE(options)                                                                                                 \
    "tsuya: 1\ntimeline: { fps: 24, start: 1, end: 3 }\n"                                                              \
    "assets: { moving: { mesh: m.####.ply, fps: 24" options " }, still: { shape: box } }\n"                            \
    "materials: { m: { model: surface }, d: { model: cdrf } }\n"                                                       \
    "objects: [ { mesh: moving, material: m }, { mesh: still, material: m, translate: [9, 0, 0] } ]\n"

// A triangle of the unit axes at height z, of age z.
static void write_frame(int number, float z, const char* triangle)
{
    char name[32];
    snprintf(name, sizeof name, "m.%04d.ply", number);
    char* text = ty_string_format("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                  "property float z\nproperty float age\nelement face 1\nproperty list uchar int "
                                  "vertex_indices\nend_header\n0 0 %g %g\n1 0 %g %g\n0 1 %g %g\n3 %s\n",
                                  (double)z, (double)z, (double)z, (double)z, (double)z, (double)z, triangle);
    fixture_write(name, text);
    ty_free(text);
}

static void write_frames(void)
{
    write_frame(5, 0.0f, "0 1 2");
    write_frame(6, 1.0f, "0 1 2");
    write_frame(7, 4.0f, "0 1 2");
}

static void load(const char* text)
{
    ty_scene_options options = {0};
    fixture_write("scene.yaml", text);
    ty_status status = fixture_load(&options);
    if (status != TY_OK)
        fixture_print_errors();
    assert_int_equal(status, TY_OK);
}

static float height(void)
{
    ty_hit hit;
    ty_ray ray = {.origin = {0.2f, 0.2f, 100.0f},
                  .direction = {0, 0, -1},
                  .t_max = 1000.0f,
                  .skip_object = TY_NONE,
                  .mask = TY_MASK_ALL,
                  .skip_instance = TY_NONE};
    assert_true(ty_world_intersect(fixture_scene->world, &ray, &hit));
    return 100.0f - hit.t;
}

static void at_frame(double frame, float z)
{
    assert_int_equal(ty_scene_set_frame(fixture_scene, frame, &fixture_errors), TY_OK);
    fixture_near(height(), z, 1e-4f);
}

static void files_follow_the_time(void** state)
{
    (void)state;
    write_frames();
    load(SCENE(""));
    fixture_near(height(), 0.0f, 1e-5f);
    at_frame(2, 1.0f);
    at_frame(3, 4.0f);
    at_frame(2.5, 2.5f); // between two
    at_frame(1.25, 0.25f);
    load(SCENE(", interpolate: none"));
    at_frame(2.5, 1.0f);
    load(SCENE(", first_frame: 6, last_frame: 7, hold: true"));
    fixture_near(height(), 1.0f, 1e-5f);
    at_frame(3, 4.0f);
    load(SCENE(", loop: true"));
    at_frame(4, 0.0f);
    at_frame(3.5, 2.0f); // the first follows the last
}

static void only_what_changes_is_rebuilt(void** state)
{
    (void)state;
    write_frames();
    load(SCENE(", hold: true"));
    at_frame(2, 1.0f);
    assert_int_equal(fixture_scene->rebuilds.meshes, 1);
    assert_int_equal(fixture_scene->rebuilds.worlds, 1);
    at_frame(3, 4.0f);
    at_frame(4, 4.0f); // held
    at_frame(5, 4.0f);
    assert_int_equal(fixture_scene->rebuilds.meshes, 2);
    assert_int_equal(fixture_scene->rebuilds.worlds, 2);
}

// A frame that was gone to is the one that is loaded by itself.
static void frames_do_not_remember(void** state)
{
    (void)state;
    write_frames();
    load(SCENE(", loop: true"));
    at_frame(3, 4.0f);
    at_frame(1.5, 0.5f);
    char hash[33];
    snprintf(hash, sizeof hash, "%s", fixture_scene->hash);
    load(SCENE(", loop: true") "frame: 1.5\n");
    fixture_near(height(), 0.5f, 1e-5f);
    assert_string_equal(hash, fixture_scene->hash);
}

// A camera that focuses on the mesh sees the one of this frame.
static void focus_follows_the_mesh(void** state)
{
    (void)state;
    write_frames();
    load("tsuya: 1\ntimeline: { end: 3 }\nassets: { a: { mesh: m.####.ply } }\nmaterials: { m: { model: surface } }\n"
         "camera: { position: [0, 0, 9], focus_object: it, f_stop: 2 }\n"
         "objects: [ { name: it, mesh: a, material: m } ]\n");
    fixture_near(fixture_scene->camera.focus_point.z, 0.0f, 1e-6f);
    at_frame(3, 4.0f);
    fixture_near(fixture_scene->camera.focus_point.z, 4.0f, 1e-6f);
    at_frame(2, 1.0f);
    fixture_near(fixture_scene->camera.focus_point.z, 1.0f, 1e-6f);
}

static void attributes_change_too(void** state)
{
    (void)state;
    write_frames();
    load("tsuya: 1\ntimeline: { end: 3 }\nassets: { a: { mesh: m.####.ply } }\n"
         "materials: { m: { model: surface, specular_roughness: { attribute: age, scale: .1 } } }\n"
         "objects: [ { mesh: a, material: m } ]\n");
    ty_input input = ty_input_scalar(1.0f);
    input.attribute_index = 0;
    ty_surface_point point = {.u = 0.25f, .v = 0.25f};
    assert_int_equal(ty_scene_set_frame(fixture_scene, 2.5, &fixture_errors), TY_OK);
    fixture_near(ty_input_float(&input, &fixture_scene->shading, &point), 2.5f, 1e-5f);
}

// A square of two triangles among single ones: with `interpolate: none` each frame is as its file.
static void topology_may_change(void** state)
{
    (void)state;
    write_frames();
    fixture_write("m.0006.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                                "property float z\nproperty float age\nelement face 2\nproperty list uchar int "
                                "vertex_indices\nend_header\n0 0 2 7\n1 0 2 7\n1 1 2 7\n0 1 2 7\n3 0 1 2\n3 0 2 3\n");
    load("tsuya: 1\ntimeline: { end: 3 }\nassets: { a: { mesh: m.####.ply, interpolate: none } }\n"
         "materials: { m: { model: surface, specular_roughness: { attribute: age, scale: .1 } } }\n"
         "objects: [ { mesh: a, material: m } ]\n");
    ty_input input = ty_input_scalar(1.0f);
    input.attribute_index = 0;
    ty_surface_point point = {.u = 0.25f, .v = 0.25f, .triangle = 1};
    fixture_near(height(), 0.0f, 1e-5f);
    at_frame(2, 2.0f);
    assert_int_equal(ty_world_prototype_mesh(fixture_scene->world, 0)->triangle_count, 2);
    fixture_near(ty_input_float(&input, &fixture_scene->shading, &point), 7.0f, 1e-5f);
    at_frame(2.75, 2.0f); // not blended
    at_frame(3, 4.0f);
    assert_int_equal(ty_world_prototype_mesh(fixture_scene->world, 0)->triangle_count, 1);
    at_frame(2, 2.0f);
    at_frame(1, 0.0f);
    assert_int_equal(fixture_check(SCENE("")), TY_BAD_FILE); // blended they cannot be
    assert_non_null(strstr(fixture_errors.items[0].text, "interpolate: none"));
    fixture_write("m.0007.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                                "end_header\n0 0 2\n1 0 2\n1 1 2\n3 0 1 2\n");
    assert_int_equal(fixture_check(SCENE(", interpolate: none")), TY_BAD_FILE);
    assert_non_null(strstr(fixture_errors.items[0].text, "frame 7,"));
    assert_non_null(strstr(fixture_errors.items[0].text, "attributes"));
}

// Steps of the mesh while the shutter is open, at a frame.
static const ty_mesh* steps_at(double frame, int count)
{
    assert_int_equal(ty_scene_set_frame(fixture_scene, frame, &fixture_errors), TY_OK);
    const ty_mesh* mesh = ty_world_prototype_mesh(fixture_scene->world, 0);
    assert_int_equal(mesh->step_count, count);
    assert_int_equal(fixture_scene->moves, count > 0);
    return mesh;
}

// Files stand at heights 0, 1 and 4, so that the way from one to the next is straight and bends at each.
static void vertices_move_within_the_shutter(void** state)
{
    (void)state;
    write_frames();
    load(SCENE(", hold: true") "camera: { shutter: 0.5, shutter_position: start }\n");
    const ty_mesh* mesh = steps_at(1, 2);
    fixture_near(mesh->step_positions[0].z, 0.0f, 1e-6f);
    fixture_near(mesh->step_positions[3].z, 0.5f, 1e-6f);
    fixture_near(height(), 0.0f, 1e-5f); // the ray is of the time at which the shutter opens
    steps_at(2, 2);
    fixture_near(mesh->step_positions[3].z, 2.5f, 1e-5f);
    steps_at(4, 0); // held: it rests
    assert_int_equal(fixture_scene->rebuilds.meshes, 2);
    load(SCENE(", hold: true") "camera: { shutter: 0.5 }\n");
    mesh = steps_at(2, 3); // the file of the frame is a step of its own
    static const float heights[] = {0.75f, 1.0f, 1.75f};
    for (int i = 0; i < 3; ++i)
        fixture_near(mesh->step_positions[3 * i].z, heights[i], 1e-5f);
    fixture_near(mesh->positions[0].z, 1.0f, 1e-6f);
    fixture_near(height(), 0.75f, 1e-5f);
    load(SCENE(", hold: true") "camera: { shutter: 2 }\n");
    steps_at(2, 3);
    load(SCENE(", hold: true") "camera: { shutter: 1.5 }\n");
    mesh = steps_at(2.25, 4); // from 1.5 to 3: files at 2 and, held from there on, 3
    fixture_near(mesh->step_positions[3].z, 1.0f, 1e-5f);
    load(SCENE("") "camera: { shutter: 1 }\n");
    mesh = steps_at(1, 3); // ahead of its time it stands still
    fixture_near(mesh->step_positions[0].z, 0.0f, 1e-6f);
    fixture_near(mesh->step_positions[6].z, 0.5f, 1e-6f);
    load(SCENE(", loop: true") "camera: { shutter: 1 }\n");
    mesh = steps_at(1, 3); // ahead of the first comes the last
    fixture_near(mesh->step_positions[0].z, 2.0f, 1e-5f);
}

static void what_does_not_blur_stands_still(void** state)
{
    (void)state;
    write_frames();
    load(SCENE(", hold: true"));
    steps_at(2, 0);
    load(SCENE(", hold: true, interpolate: none") "camera: { shutter: 1 }\n");
    steps_at(2, 0);
    load("tsuya: 1\ntimeline: { end: 3 }\nassets: { a: { mesh: m.####.ply } }\ncamera: { shutter: 1 }\n"
         "materials: { m: { model: surface, emission_luminance: 1 } }\nobjects: [ { mesh: a, material: m } ]\n");
    steps_at(2, 0); // light is drawn from its triangles
    // a shutter with keys opens and closes again
    load(SCENE(", hold: true") "camera: { shutter: { keys: { 1: 0, 2: 1, 3: 0 } } }\n");
    steps_at(2, 3);
    steps_at(3, 0);
    fixture_near(height(), 4.0f, 1e-5f);
}

static void wrong_files_are_named(void** state)
{
    (void)state;
    write_frame(5, 0.0f, "0 1 2");
    write_frame(7, 0.0f, "0 1 2");
    assert_int_equal(fixture_check(SCENE("")), TY_BAD_FILE);
    assert_non_null(strstr(fixture_errors.items[0].text, "lacks 1 of its frames: 6"));
    write_frame(6, 0.0f, "0 2 1");
    assert_int_equal(fixture_check(SCENE("")), TY_BAD_FILE);
    assert_non_null(strstr(fixture_errors.items[0].text, "frame 6,"));
    assert_non_null(strstr(fixture_errors.items[0].text, "one topology"));
    ty_scene_options options = {0};
    assert_int_equal(fixture_load(&options), TY_OK); // the first two frames of time are well
    ty_status status = ty_scene_set_frame(fixture_scene, 2, &fixture_errors);
    assert_int_equal(status, TY_BAD_FILE);
    write_frames();
    fixture_one_error("tsuya: 1\ntimeline: { end: 4 }\nassets: { a: { mesh: m.####.ply } }\n", 3, 22,
                      "frame 4 of the timeline");
    fixture_one_error("tsuya: 1\nassets: { a: { mesh: m.0005.ply, fps: 3 } }\n", 2, 14, "'fps' belongs to sequences");
    fixture_one_error("tsuya: 1\nassets: { a: { mesh: n.####.ply } }\n", 2, 22, "n.####.ply");
    fixture_one_error("tsuya: 1\ntimeline: { end: 3 }\nassets: { a: { mesh: m.####.ply, loop: true, hold: true } }\n",
                      3, 22, "only one of");
}

// Frames that are named stand in place of the timeline: what does not cover them is known before the first is shown.
static void named_frames_are_covered(void** state)
{
    (void)state;
    write_frames();
    static const int inside[] = {1, 3}, outside[] = {2, 3, 4, 5, 9};
    double first = 1.0;
    ty_scene_options options = {.frame = &first, .frames = inside, .frame_count = 2};
    fixture_write("scene.yaml", "tsuya: 1\ntimeline: { end: 4 }\nassets: { a: { mesh: m.####.ply } }\n");
    assert_int_equal(fixture_load(&options), TY_OK);
    first = 2.0;
    options.frames = outside;
    options.frame_count = 5;
    assert_int_equal(fixture_load(&options), TY_BAD_INPUT);
    assert_true(
        fixture_has("scene.yaml", 3, 22, "3 of the 5 frames are outside of the sequence's 0 to 0.125 s: 4-5, 9;"));
    assert_int_equal(fixture_errors.count, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(files_follow_the_time),
        FIXTURE_TEST(only_what_changes_is_rebuilt),
        FIXTURE_TEST(frames_do_not_remember),
        FIXTURE_TEST(focus_follows_the_mesh),
        FIXTURE_TEST(attributes_change_too),
        FIXTURE_TEST(wrong_files_are_named),
        FIXTURE_TEST(named_frames_are_covered),
        FIXTURE_TEST(topology_may_change),
        FIXTURE_TEST(vertices_move_within_the_shutter),
        FIXTURE_TEST(what_does_not_blur_stands_still),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
