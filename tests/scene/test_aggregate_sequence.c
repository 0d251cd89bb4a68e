// SPDX-License-Identifier: Apache-2.0
// Aggregates from sequences of files: where instances are at a time, what shading gets, and what is wrong with files.
#include "scene/fixture.h"
#include <tsuya/geometry/aggregate.h>
#include <tsuya/geometry/shape.h>

#define SCENE(options)                                                                                                 \
    "tsuya: 1\ntimeline: { fps: 24, start: 1, end: 3 }\n"                                                              \
    "assets: { heap: { aggregate: h.####.glb" options " } }\n"                                                         \
    "materials: { m: { model: surface, specular_roughness: { attribute: height }, "                                    \
    "coat_roughness: { attribute: moisture } } }\n"                                                                    \
    "objects: [ { name: it, aggregate: heap, material: m } ]\n"

// What a file may differ in from the others.
typedef struct file_def
{
    uint32_t instance_count;
    float radius;
    uint32_t first_id;
    const char* attribute;
    float speed; // m/s, of the middle ball along z
} file_def;

static const file_def usual = {3, 0.25f, 100, "moisture", 0.0f};

// Balls at x = 0, 2 and 4; the middle one at height y with 1 above and 0 below, as moist as it is high by a tenth.
static void write_frame(int number, float y, file_def f)
{
    char name[32], path[TY_PATH_MAX];
    ty_error error;
    ty_shape_def def = ty_shape_def_default();
    def.kind = TY_SHAPE_SPHERE;
    def.radius = f.radius;
    def.divisions = 16;
    ty_aggregate* aggregate = ty_aggregate_create(f.instance_count, 1);
    assert_int_equal(ty_shape_create(&def, &aggregate->prototypes[0], &error), TY_OK);
    float* moisture = ty_aggregate_add_attribute(aggregate, f.attribute);
    for (uint32_t i = 0; i < f.instance_count; ++i)
    {
        aggregate->transforms[i].t = ty_vec3_make(2.0f * (float)i, i == 1 ? y : i == 0 ? 0.0f : 8.0f, 0.0f);
        aggregate->ids[i] = f.first_id + i;
        moisture[i] = 0.1f * y;
        ty_aggregate_add_velocities(aggregate)[i] = ty_vec3_make(0.0f, 0.0f, i == 1 ? f.speed : 0.0f);
    }
    snprintf(name, sizeof name, "h.%04d.glb", number);
    assert_int_equal(ty_aggregate_write(fixture_path(name, path), aggregate, &error), TY_OK);
    ty_aggregate_destroy(aggregate);
}

static void write_frames(void)
{
    write_frame(5, 1.0f, usual);
    write_frame(6, 2.0f, usual);
    write_frame(7, 4.0f, usual);
}

static void load(const char* text)
{
    fixture_write("scene.yaml", text);
    ty_status status = fixture_load(&(ty_scene_options){0});
    if (status != TY_OK)
        fixture_print_errors();
    assert_int_equal(status, TY_OK);
}

// Where a ray down at x meets the balls.
static float top(float x)
{
    ty_hit hit;
    ty_ray ray = {.origin = {x, 100.0f, 0.0f},
                  .direction = {0, -1, 0},
                  .t_max = 1000.0f,
                  .skip_object = TY_NONE,
                  .mask = TY_MASK_ALL,
                  .skip_instance = TY_NONE};
    assert_true(ty_world_intersect(fixture_scene->world, &ray, &hit));
    return 100.0f - hit.t;
}

static float attribute(const char* name, uint32_t instance)
{
    int i = 0;
    while (strcmp(fixture_scene->attribute_names[i], name) != 0)
        ++i;
    return fixture_scene->objects[0].attributes[i][instance];
}

static void shows(float y)
{
    fixture_near(top(2.0f), y + 0.25f, 1e-4f);
    fixture_near(top(0.0f), 0.25f, 1e-4f);
    fixture_near(attribute("height", 1), y / 8.0f, 1e-6f);
    fixture_near(attribute("moisture", 1), 0.1f * y, 1e-6f);
}

static void at_frame(double frame, float y)
{
    assert_int_equal(ty_scene_set_frame(fixture_scene, frame, &fixture_errors), TY_OK);
    shows(y);
}

static void files_follow_the_time(void** state)
{
    (void)state;
    write_frames();
    load(SCENE(""));
    shows(1.0f);
    at_frame(2, 2.0f);
    at_frame(3, 4.0f);
    at_frame(2.5, 2.0f); // not between two: the last before
    at_frame(1, 1.0f);
    load(SCENE(", first_frame: 6, last_frame: 7, hold: true"));
    shows(2.0f);
    at_frame(9, 4.0f);
    load(SCENE(", loop: true"));
    at_frame(4, 1.0f);
    load(SCENE(", fps: 12, hold: true"));
    at_frame(3, 2.0f);
}

static void only_what_changes_is_rebuilt(void** state)
{
    (void)state;
    write_frames();
    load(SCENE(", hold: true"));
    at_frame(2, 2.0f);
    at_frame(3, 4.0f);
    at_frame(4, 4.0f); // held
    assert_int_equal(fixture_scene->rebuilds.worlds, 2);
    assert_int_equal(fixture_scene->rebuilds.meshes, 0);
}

// What a ray down between the middle ball and where it flies to meets, and when.
static bool flies(float z, float time)
{
    ty_hit hit;
    ty_ray ray = ty_ray_make((ty_vec3){2.0f, 100.0f, z}, (ty_vec3){0, -1, 0}, 1000.0f);
    ray.time = time;
    return ty_world_intersect(fixture_scene->world, &ray, &hit);
}

// Half a frame before and after its moment at 24 m/s; at rest in the files before and after it. Rays have a time only
// while something moves, and a keyed shutter takes instances along.
static void velocities_follow_the_time(void** state)
{
    (void)state;
    file_def fast = usual;
    fast.speed = 24.0f;
    write_frame(5, 1.0f, usual);
    write_frame(6, 2.0f, fast);
    write_frame(7, 4.0f, usual);
    load(SCENE("") "camera: { shutter: { keys: { 1: 1, 2.2: 1, 2.3: 0.75, 9: 0.75 } } }\n");
    assert_false(fixture_scene->moves);
    assert_int_equal(ty_scene_set_frame(fixture_scene, 2, &fixture_errors), TY_OK);
    assert_true(fixture_scene->moves);
    assert_true(flies(-0.5f, 0.0f) && flies(0.0f, 0.5f) && flies(0.5f, 1.0f));
    assert_false(flies(-0.5f, 0.6f) || flies(0.0f, 0.0f) || flies(0.5f, 0.4f));
    assert_int_equal(ty_scene_set_frame(fixture_scene, 2.5, &fixture_errors), TY_OK);
    assert_true(flies(-0.375f, 0.0f) && flies(0.375f, 1.0f) && !flies(0.64f, 1.0f));
    assert_int_equal(ty_scene_set_frame(fixture_scene, 3, &fixture_errors), TY_OK);
    assert_false(fixture_scene->moves);
    shows(4.0f);
    load(SCENE(", velocity_scale: -2") "camera: { shutter: 1 }\nframe: 2\n");
    assert_true(fixture_scene->moves && flies(1.0f, 0.0f) && flies(-1.0f, 1.0f) && !flies(1.0f, 1.0f));
    assert_int_equal(ty_scene_set_frame(fixture_scene, 2.25, &fixture_errors), TY_OK); // the same file
    assert_true(fixture_scene->moves && flies(1.0f, 0.0f));
}

// A frame that was gone to is the one that is loaded by itself, and a camera that focuses on it sees that.
static void frames_do_not_remember(void** state)
{
    (void)state;
    write_frame(5, 1.0f, usual);
    write_frame(6, 2.0f, usual);
    write_frame(7, 12.0f, usual);
    load(SCENE("") "camera: { position: [0, 0, 9], focus_object: it, f_stop: 2 }\n");
    fixture_near(fixture_scene->camera.focus_point.y, 4.0f, 1e-4f);
    assert_int_equal(ty_scene_set_frame(fixture_scene, 3, &fixture_errors), TY_OK);
    fixture_near(fixture_scene->camera.focus_point.y, 6.0f, 1e-4f);
    fixture_near(attribute("height", 2), 8.0f / 12.0f, 1e-6f);
    at_frame(2, 2.0f);
    char hash[33];
    snprintf(hash, sizeof hash, "%s", fixture_scene->hash);
    load(SCENE("") "camera: { position: [0, 0, 9], focus_object: it, f_stop: 2 }\nframe: 2\n");
    shows(2.0f);
    fixture_near(fixture_scene->camera.focus_point.y, 4.0f, 1e-4f);
    assert_string_equal(hash, fixture_scene->hash);
}

static void is_refused(file_def f, const char* text)
{
    write_frame(6, 2.0f, f);
    assert_int_equal(fixture_check(SCENE("")), TY_BAD_FILE);
    assert_int_equal(fixture_errors.count, 1);
    assert_non_null(strstr(fixture_errors.items[0].text, "frame 6, '"));
    assert_non_null(strstr(fixture_errors.items[0].text, "h.0006.glb': "));
    if (!strstr(fixture_errors.items[0].text, text))
        fail_msg("'%s' lacks '%s'", fixture_errors.items[0].text, text);
    assert_true(fixture_has("scene.yaml", 3, 30, "the same instances in every file"));
    assert_int_equal(fixture_load(&(ty_scene_options){0}), TY_OK); // the first file is well
    assert_int_equal(ty_scene_set_frame(fixture_scene, 2, &fixture_errors), TY_BAD_FILE);
}

static void files_of_other_instances_are_refused(void** state)
{
    (void)state;
    write_frames();
    is_refused((file_def){4, 0.25f, 100, "moisture", 0.0f}, "has 4 instances, the others 3");
    is_refused((file_def){3, 0.5f, 100, "moisture", 0.0f}, "prototype 0 is another mesh");
    is_refused((file_def){3, 0.25f, 101, "moisture", 0.0f}, "instance 0 has another id or prototype (101, 0)");
    is_refused((file_def){3, 0.25f, 100, "tint", 0.0f}, "'moisture' is an attribute of some of the files only");
}

static void wrong_sequences_are_named(void** state)
{
    (void)state;
    write_frame(5, 1.0f, usual);
    write_frame(7, 4.0f, usual);
    assert_int_equal(fixture_check(SCENE("")), TY_BAD_FILE);
    assert_true(fixture_has("scene.yaml", 3, 30, "lacks 1 of its frames: 6"));
    write_frame(6, 2.0f, usual);
    fixture_one_error("tsuya: 1\ntimeline: { end: 4 }\nassets: { a: { aggregate: h.####.glb } }\n", 3, 27,
                      "frame 4 of the timeline");
    fixture_one_error("tsuya: 1\nassets: { a: { aggregate: h.0005.glb, fps: 3 } }\n", 2, 39,
                      "'fps' belongs to sequences");
    fixture_one_error("tsuya: 1\nassets: { a: { aggregate: n.####.glb } }\n", 2, 27, "n.####.glb");
    fixture_one_error("tsuya: 1\nassets: { a: { aggregate: h.####.glb, loop: true, hold: true } }\n", 2, 27,
                      "only one of");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(files_follow_the_time),     FIXTURE_TEST(only_what_changes_is_rebuilt),
        FIXTURE_TEST(frames_do_not_remember),    FIXTURE_TEST(files_of_other_instances_are_refused),
        FIXTURE_TEST(wrong_sequences_are_named), FIXTURE_TEST(velocities_follow_the_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
