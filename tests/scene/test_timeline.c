// SPDX-License-Identifier: Apache-2.0
// Keyed values: what a scene is at a frame, which mistakes are told, and how little is made again.
#include "geometry/gltf_text.h"
#include "scene/fixture.h"

#define HEAD                                                                                                           \
    "tsuya: 1\n"                                                                                                       \
    "timeline: { fps: 25, start: 1, end: 24 }\n"
#define BODY                                                                                                           \
    "assets:\n"                                                                                                        \
    "  ball: { shape: sphere, divisions: 8, radius: 0.01 }\n"                                                          \
    "materials:\n"                                                                                                     \
    "  grey: { model: surface, base_color: 0.5 }\n"                                                                    \
    "objects:\n"                                                                                                       \
    "  - { mesh: ball, material: grey }\n"

static void load(const char* text, bool whole)
{
    ty_scene_options options = {.check_only = !whole};
    fixture_write("scene.yaml", text);
    ty_status status = fixture_load(&options);
    if (status != TY_OK)
        fixture_print_errors();
    assert_int_equal(status, TY_OK);
}

static void set_frame(double frame)
{
    ty_status status = ty_scene_set_frame(fixture_scene, frame, &fixture_errors);
    if (status != TY_OK)
        fixture_print_errors();
    assert_int_equal(status, TY_OK);
}

static float vfov_at(double frame)
{
    set_frame(frame);
    return fixture_scene->camera.vfov * 180.0f / TY_PI;
}

static void load_vfov(const char* keyed)
{
    char* text = ty_string_format(HEAD "camera: { vfov: %s }\n" BODY, keyed);
    load(text, false);
    ty_free(text);
}

static void keys_are_met_and_joined(void** state)
{
    (void)state;
    load_vfov("{ keys: { 11: 30, 1: 10, 21: 20 } }");
    fixture_near(vfov_at(1), 10.0f, 1e-5f);
    fixture_near(vfov_at(3.5), 15.0f, 1e-5f);
    fixture_near(vfov_at(11), 30.0f, 1e-5f);
    fixture_near(vfov_at(16), 25.0f, 1e-5f);
    fixture_near(vfov_at(-5), 10.0f, 1e-5f);
    fixture_near(vfov_at(99), 20.0f, 1e-5f);
    load_vfov("{ keys: { 1: 10, 11: 30 }, interpolate: hold }");
    fixture_near(vfov_at(10.999), 10.0f, 1e-5f);
    fixture_near(vfov_at(11), 30.0f, 1e-5f);
    load_vfov("{ keys: { 1: 10, 11: 30 }, interpolate: ease }"); // 3 s^2 - 2 s^3
    fixture_near(vfov_at(3.5), 10.0f + 20.0f * 0.15625f, 1e-5f);
    fixture_near(vfov_at(6), 20.0f, 1e-5f);
}

// Steffen's curve through a straight line is the line; through a plateau it does not overshoot; at its keys it has one
// slope.
static void smooth_is_monotone(void** state)
{
    (void)state;
    load_vfov("{ keys: { 1: 10, 5: 14, 7: 16, 21: 30 }, interpolate: smooth }");
    for (int i = 0; i <= 80; ++i)
        fixture_near(vfov_at(1.0 + 0.25 * i), 10.0f + 0.25f * (float)i, 1e-4f);
    load_vfov("{ keys: { 1: 10, 5: 12, 6: 40, 9: 40, 21: 41 }, interpolate: smooth }");
    float last = 10.0f;
    for (int i = 1; i <= 200; ++i)
    {
        float value = vfov_at(1.0 + 0.1 * i);
        assert_true(value >= last - 1e-5f && value <= 41.0f + 1e-5f);
        last = value;
    }
    // h0 = 4, h1 = 1, s0 = .5, s1 = 28: p = (.5 * 1 + 28 * 4) / 5 = 22.5, limited to 2 * .5
    float left = (vfov_at(5) - vfov_at(4.999)) / 0.001f, right = (vfov_at(5.001) - vfov_at(5)) / 0.001f;
    fixture_near(left, 1.0f, 0.12f);
    fixture_near(right, 1.0f, 0.12f);
}

static void outside_the_keys(void** state)
{
    (void)state;
    load_vfov("{ keys: { 1: 10, 5: 30, 9: 50 }, after: loop }");
    uint32_t first, again;
    for (int i = 0; i < 40; ++i)
    {
        double frame = 1.0 + 0.2 * i;
        float a = vfov_at(frame), b = vfov_at(frame + 8.0), c = vfov_at(frame - 16.0);
        fixture_near(b, a, 1e-4f);
        fixture_near(c, a, 1e-4f);
    }
    float value = vfov_at(1);
    memcpy(&first, &value, sizeof first);
    value = vfov_at(9);
    memcpy(&again, &value, sizeof again);
    assert_int_equal(first, again); // the last key's moment is the first's
    load_vfov("{ keys: { 1: 10, 5: 30 }, after: mirror }");
    fixture_near(vfov_at(6), 25.0f, 1e-4f);
    fixture_near(vfov_at(9), 10.0f, 1e-4f);
    fixture_near(vfov_at(10), 15.0f, 1e-4f);
    fixture_near(vfov_at(0), 15.0f, 1e-4f);
    load_vfov("{ keys: { 1: 10, 5: 30 }, after: continue, before: hold }");
    fixture_near(vfov_at(9), 50.0f, 1e-4f);
    fixture_near(vfov_at(-9), 10.0f, 1e-4f);
}

static void every_kind_of_value(void** state)
{
    (void)state;
    load(HEAD
         "vars: { wet: { keys: { 1: 0.2, 11: 0.6 } } }\n"
         "camera: { position: { keys: { 1: [0, 0, 1], 11: [2, 4, 1] } }, look_at: [0, { keys: { 1: 0, 11: 1 } }, 0] }\n"
         "lights:\n"
         "  - { type: environment, radiance: { keys: { 1: '#ffffff', 11: [3, 0, 0] } }, camera_visible: { keys: { 1: "
         "true, 6: false } } }\n"
         "  - { type: sphere, radiance: { color: { keys: { 1: 1, 11: 2 } }, space: lin_rec709 } }\n"
         "assets: { ball: { shape: sphere, divisions: 8 } }\n"
         "materials: { keys: { model: cdrf, moisture: $wet } }\n" // a name like any other
         "objects: [{ mesh: ball, material: keys, scale: { keys: { 1: 1, 11: 3 } } }]\n",
         false);
    const ty_scene* scene = fixture_scene;
    set_frame(6);
    fixture_near(scene->camera.position.x, 1.0f, 1e-6f);
    fixture_near(scene->camera.position.y, 2.0f, 1e-6f);
    fixture_near(scene->camera.look_at.y, 0.5f, 1e-6f);
    fixture_near(scene->lights[0].radiance.r, 2.0f, 1e-4f);
    fixture_near(scene->lights[0].radiance.g, 0.5f, 1e-4f);
    assert_false(scene->lights[0].camera_visible);
    fixture_near(scene->lights[1].radiance.r, 1.5f, 1e-3f);
    assert_true(scene->seconds == 5.0 / 25.0);
    set_frame(5);
    assert_true(scene->lights[0].camera_visible);
}

// What a keyed scene is at a frame is, bit for bit, what a scene with those numbers is.
static void a_key_is_the_number(void** state)
{
    (void)state;
    load("tsuya: 1\ncamera: { position: [0.1, 0.7, 1.3], vfov: 33.3 }\n" BODY, false);
    ty_camera_def plain = fixture_scene->camera;
    load("tsuya: 1\ncamera: { position: { keys: { 3: [0.1, 0.7, 1.3], 9: [1, 1, 1] } }, vfov: { keys: { 0: 1, 3: "
         "33.3 } } }\n" BODY,
         false);
    set_frame(3);
    assert_memory_equal(&plain.position, &fixture_scene->camera.position, sizeof plain.position);
    assert_true(plain.vfov == fixture_scene->camera.vfov);
}

static void only_what_changes_is_made_again(void** state)
{
    (void)state;
    load(HEAD "camera: { position: { keys: { 1: [0, 0, 1], 4: [0, 0.3, 1] } } }\n"
              "assets: { ball: { shape: sphere, divisions: 8 }, box: { shape: box } }\n"
              "materials:\n"
              "  a: { model: surface, base_color: { keys: { 1: 0.1, 3: 0.9 } } }\n"
              "  b: { model: surface }\n"
              "lights:\n"
              "  - { type: point, intensity: { keys: { 1: 1, 2: 2 } } }\n"
              "  - { type: point }\n"
              "objects:\n"
              "  - { mesh: ball, material: a, translate: { keys: { 2: [0, 0, 0], 3: [1, 0, 0] } } }\n"
              "  - { mesh: box, material: b }\n",
         true);
    const ty_scene* scene = fixture_scene;
    const ty_material* other = scene->materials[1];
    assert_int_equal(scene->rebuilds.frames, 0);
    set_frame(1);
    assert_int_equal(scene->rebuilds.cameras + scene->rebuilds.materials + scene->rebuilds.lights +
                         scene->rebuilds.objects + scene->rebuilds.worlds,
                     0);
    set_frame(2);
    assert_int_equal(scene->rebuilds.cameras, 1);
    assert_int_equal(scene->rebuilds.materials, 1);
    assert_int_equal(scene->rebuilds.lights, 1);
    assert_int_equal(scene->rebuilds.objects, 0);
    set_frame(3);
    set_frame(4);
    set_frame(5);
    assert_int_equal(scene->rebuilds.frames, 5);
    assert_int_equal(scene->rebuilds.cameras, 3);
    assert_int_equal(scene->rebuilds.materials, 2);
    assert_int_equal(scene->rebuilds.lights, 1);
    assert_int_equal(scene->rebuilds.objects, 1);
    assert_int_equal(scene->rebuilds.worlds, 1);
    assert_ptr_equal(other, scene->materials[1]);
    ty_bounds bounds = ty_world_bounds(scene->world);
    assert_true(bounds.high.x > 1.0f);
}

static bool is_hit(uint32_t mask)
{
    ty_hit hit;
    ty_ray ray = ty_ray_make(ty_vec3_make(0.0f, 0.0f, 1.0f), ty_vec3_make(0.0f, 0.0f, -1.0f), 10.0f);
    ray.mask = mask;
    return ty_world_intersect(fixture_scene->world, &ray, &hit);
}

// Who sees an object changes with its keys, and with the opacity of its material.
static void visibility_may_be_keyed(void** state)
{
    (void)state;
    load(HEAD "assets: { ball: { shape: sphere, divisions: 8, radius: 0.1 } }\n"
              "materials: { m: { model: surface, opacity: { keys: { 1: 1, 5: 1, 6: 0.5 } } } }\n"
              "objects: [{ mesh: ball, material: m, visible: { camera: { keys: { 1: true, 3: false, 5: true } } } }]\n",
         true);
    static const struct
    {
        int frame;
        bool camera, shadow;
    } frames[] = {{1, true, true},  {2, true, true}, {3, false, true},
                  {4, false, true}, {5, true, true}, {6, true, false}};
    for (int i = 0; i < 6; ++i)
    {
        set_frame(frames[i].frame);
        assert_int_equal(is_hit(TY_MASK_CAMERA), frames[i].camera);
        assert_int_equal(is_hit(TY_MASK_SHADOW), frames[i].shadow);
    }
    assert_int_equal(fixture_scene->rebuilds.worlds, 3);
}

// Thousands of keys, as baked animation has, cost no material each.
static void many_keys_load_fast(void** state)
{
    (void)state;
    enum
    {
        KEYS = 100000
    };
    size_t size = 0;
    char* text = TY_ALLOC(char, KEYS * 24 + 1000);
    size += (size_t)sprintf(
        text, "%smaterials:\n  m: { model: surface, base_metalness: 1, specular_roughness: { keys: {", HEAD);
    for (int i = 0; i < KEYS; ++i)
        size += (size_t)sprintf(text + size, "%s%d: 0.%03d", i ? ", " : " ", i, 100 + i % 900);
    sprintf(text + size, " } } }\n");
    load(text, false); // a material each would be beyond the test's time
    set_frame(777);
    assert_int_equal(fixture_scene->rebuilds.materials, 1);
    ty_free(text);
}

// The recipe of a frame, read by itself, is that frame; frames differ in their hashes, one frame does not.
static void a_recipe_tells_its_frame(void** state)
{
    (void)state;
    load(HEAD "camera: { position: { keys: { 1: [0, 0, 1], 4: [0, 0.3, 1] }, interpolate: smooth } }\n"
              "objects: [{ mesh: ball, material: grey, scale: { keys: { 1: 1, 9: 2 } } }]\n"
              "assets: { ball: { shape: sphere, divisions: 8 } }\nmaterials: { grey: { model: surface } }\n",
         false);
    assert_non_null(strstr(fixture_scene->recipe, "frame: 1\n"));
    char first[33];
    memcpy(first, fixture_scene->hash, sizeof first);
    set_frame(2.5);
    assert_string_not_equal(first, fixture_scene->hash);
    assert_non_null(strstr(fixture_scene->recipe, "frame: 2.5\n"));
    assert_non_null(strstr(fixture_scene->recipe, "interpolate: smooth"));
    char* recipe = ty_string_copy(fixture_scene->recipe);
    ty_camera_def camera = fixture_scene->camera;
    load(recipe, false);
    assert_string_equal(recipe, fixture_scene->recipe);
    assert_memory_equal(&camera.position, &fixture_scene->camera.position, sizeof camera.position);
    set_frame(1);
    assert_string_equal(first, fixture_scene->hash);
    ty_free(recipe);
}

static void still_scenes_say_nothing_of_frames(void** state)
{
    (void)state;
    load("tsuya: 1\n" BODY, false);
    assert_null(strstr(fixture_scene->recipe, "frame"));
}

static void seeds_move_only_when_asked(void** state)
{
    (void)state;
    load("tsuya: 1\nrender: { seed: 7 }\n" BODY, false);
    set_frame(12);
    assert_int_equal(fixture_scene->render.seed.value, 7);
    load("tsuya: 1\nrender: { seed: 7, animate_seed: true }\n" BODY, false);
    set_frame(12);
    uint64_t twelve = fixture_scene->render.seed.value;
    set_frame(13);
    assert_true(twelve != fixture_scene->render.seed.value);
    set_frame(12);
    assert_true(twelve == fixture_scene->render.seed.value);
}

static void a_turn_closes(void** state)
{
    (void)state;
    load(HEAD "camera: { position: [0.3, 0.2, 1], look_at: [0.1, 0, 0] }\n"
              "turntable: { angle: { keys: { 1: 0, 25: 360 }, after: loop } }\n" BODY,
         false);
    const ty_camera_def* camera = &fixture_scene->camera;
    set_frame(7); // a quarter, counter-clockwise from above: +z goes to +x
    fixture_near(camera->position.x, 0.1f + 1.0f, 1e-6f);
    fixture_near(camera->position.y, 0.2f, 1e-6f);
    fixture_near(camera->position.z, -0.2f, 1e-6f);
    fixture_near(camera->look_at.x, 0.1f, 1e-6f);
    set_frame(1);
    ty_camera_def first = *camera;
    assert_true(first.position.x == 0.3f && first.position.z == 1.0f);
    set_frame(25);
    assert_memory_equal(&first, camera, sizeof first);
    load(HEAD "camera: { position: [0, 0.2, 1] }\n"
              "turntable: { turn: objects, angle: { keys: { 1: 0, 25: 360 }, after: loop }, about: [1, 0, 0] }\n" BODY,
         true);
    set_frame(13);
    ty_bounds bounds = ty_world_bounds(fixture_scene->world);
    fixture_near(0.5f * (bounds.low.x + bounds.high.x), 2.0f, 1e-5f);
    assert_true(fixture_scene->camera.position.x == 0.0f);
}

static void mistakes_are_told_where_they_stand(void** state)
{
    (void)state;
    fixture_one_error("tsuya: 1\ncamera:\n  vfov: { keys: {} }\n", 3, 17, "mapping of frames");
    fixture_one_error("tsuya: 1\ncamera:\n  vfov: { keys: { 1: 20, two: 3 } }\n", 3, 26, "frame number");
    fixture_one_error("tsuya: 1\ncamera:\n  vfov: { keys: { 1: 20, 1.0: 3 } }\n", 3, 31, "twice");
    fixture_one_error("tsuya: 1\ncamera:\n  vfov: { keys: { 1: 20, 5: 500, 9: 30 } }\n", 3, 29, "out of range");
    fixture_one_error("tsuya: 1\ncamera:\n  vfov: { keys: { 1: 20, 5: wide } }\n", 3, 29, "expected a number");
    fixture_one_error("tsuya: 1\ncamera:\n  position: { keys: { 1: [0, 0, 1], 5: [0, 1] } }\n", 3, 40,
                      "as in the first key");
    fixture_one_error("tsuya: 1\ncamera:\n  vfov: { keys: { 1: 20 }, interpolate: smoth }\n", 3, 41, "smooth");
    fixture_one_error("tsuya: 1\ncamera:\n  vfov: { keys: { 1: 20 }, after: loop }\n", 3, 9, "two keys");
    fixture_one_error("tsuya: 1\ncamera:\n  vfov: { keys: { 1: 20 }, afer: loop }\n", 3, 28, "did you mean 'after'");
    fixture_one_error("tsuya: 1\nfilm:\n  filter_width: { keys: { 1: 2 } }\n", 3, 17, "same for all frames");
    fixture_one_error("tsuya: 1\nassets:\n  a: { shape: sphere, radius: { keys: { 1: 2 } } }\n", 3, 31, "made once");
    fixture_one_error("tsuya: 1\ntimeline: { start: 5, end: 4 }\n", 2, 28, "ahead of 'start'");
    fixture_one_error("tsuya: 1\nframe: soon\n", 2, 8, "expected a number");
    fixture_one_error("tsuya: 1\nlights:\n  - { type: point, intensity: { keys: { 1: 1, 5: -2 } } }\n", 3, 50,
                      "out of range");
}

static void lenses_are_checked(void** state)
{
    (void)state;
    fixture_one_error("tsuya: 1\ncamera:\n  focus_object: bowl\n" BODY, 3, 17, "no object is named 'bowl'");
    fixture_one_error("tsuya: 1\ncamera:\n  focus_object: bal\nassets: { b: { shape: sphere } }\nmaterials: { m: { "
                      "model: surface } }\nobjects: [{ name: ball, mesh: b, material: m }]\n",
                      3, 17, "did you mean 'ball'");
    fixture_one_error("tsuya: 1\ncamera:\n  focus_point: [0, 0, 0]\n  focus_distance: 2\n", 4, 19,
                      "either 'focus_point' or 'focus_distance'");
    fixture_one_error("tsuya: 1\ncamera:\n  vfov: 20\n  focal_length: 50\n", 3, 9, "either 'focal_length' or 'vfov'");
    fixture_one_error("tsuya: 1\ncamera:\n  projection: orthographic\n  f_stop: 2\n", 4, 11, "give 'aperture'");
    fixture_one_error("tsuya: 1\ncamera:\n  projection: equirectangular\n  f_stop: 2\n", 4, 11, "no lens");
    fixture_one_error("tsuya: 1\ncamera:\n  projection: fisheye\n", 3, 15, "equirectangular");
    fixture_one_error("tsuya: 1\ncamera:\n  far_clip: 0.0001\n", 3, 13, "not beyond 'near_clip'");
    fixture_one_error("tsuya: 1\ncamera:\n  shutter: -1\n", 3, 12, "out of range");
}

// 36 x 24 mm behind 50 mm sees 26.99 degrees upwards; by its width, the film of a 2:1 picture is 18 mm high.
static void film_and_focal_length_give_the_angle(void** state)
{
    (void)state;
    load("tsuya: 1\nfilm: { size: [300, 200] }\ncamera: { focal_length: 50 }\n" BODY, false);
    fixture_near(fixture_scene->camera.vfov * 180.0f / TY_PI, 26.9915f, 1e-3f);
    load("tsuya: 1\nfilm: { size: [200, 100] }\ncamera: { focal_length: 50, film_width: 36 }\n" BODY, false);
    fixture_near(fixture_scene->camera.film_height, 0.018f, 1e-7f);
    fixture_near(fixture_scene->camera.vfov * 180.0f / TY_PI, 20.4079f, 1e-3f);
}

static void focus_follows_its_object(void** state)
{
    (void)state;
    load(HEAD
         "camera: { position: [0, 0, 2], focus_object: it, f_stop: 2 }\n"
         "assets: { ball: { shape: sphere, divisions: 8, radius: 0.1 } }\nmaterials: { m: { model: surface } }\n"
         "objects: [{ name: it, mesh: ball, material: m, translate: { keys: { 1: [0, 0, 0], 11: [0, 0, 1] } } }]\n",
         true);
    set_frame(6);
    fixture_near(fixture_scene->camera.focus_point.z, 0.5f, 1e-6f);
    assert_true(fixture_scene->camera.has_focus_point);
    set_frame(11);
    fixture_near(fixture_scene->camera.focus_point.z, 1.0f, 1e-6f);
}

// Camera and objects have poses over the open shutter where they move, and one where they do not.
static void poses_span_the_shutter(void** state)
{
    (void)state;
    static const char text[] =
        HEAD "camera: { position: { keys: { 1: [0, 0, 2], 11: [10, 0, 2] } }, look_at: [0, 0, -9], shutter: 0.5, "
             "motion_steps: "
             "3, shutter_position: %s }\n"
             "assets: { ball: { shape: sphere, divisions: 8, radius: 0.1 } }\nmaterials: { m: { model: surface } }\n"
             "objects:\n"
             "  - { mesh: ball, material: m, translate: { keys: { 5: [0, 0, 0], 7: [0, 4, 0] } } }\n"
             "  - { mesh: ball, material: m }\n";
    static const char* const positions[] = {"center", "start", "end"};
    for (int i = 0; i < 3; ++i)
    {
        char* scene_text = ty_string_format(text, positions[i]);
        load(scene_text, true);
        ty_free(scene_text);
        const ty_scene* scene = fixture_scene;
        float begin = i == 0 ? -0.25f : i == 1 ? 0.0f : -0.5f;
        set_frame(6);
        assert_true(scene->moves);
        assert_int_equal(scene->camera_step_count, 3);
        for (int k = 0; k < 3; ++k)
            fixture_near(scene->camera_steps[k].position.x, 5.0f + begin + 0.25f * (float)k, 1e-5f);
        fixture_near(scene->camera.position.x, 5.0f, 1e-6f);
        assert_true(ty_world_is_moving(scene->world, 0));
        assert_false(ty_world_is_moving(scene->world, 1));
        ty_affine map = ty_world_to_world(scene->world, 0, 0, 0.5f);
        fixture_near(map.t.y, 2.0f + 2.0f * (begin + 0.25f), 1e-5f);
        int worlds = scene->rebuilds.worlds;
        set_frame(9); // the object rests: built once more, then no more
        assert_int_equal(scene->rebuilds.worlds, worlds + 1);
        assert_false(ty_world_is_moving(scene->world, 0));
        set_frame(10);
        assert_int_equal(scene->rebuilds.worlds, worlds + 1);
    }
}

static void a_keyed_shutter_is_that_of_the_frame(void** state)
{
    (void)state;
    load(HEAD "camera: { position: { keys: { 1: [0, 0, 2], 11: [10, 0, 2] } }, look_at: [0, 0, -9], motion_steps: 2, "
              "shutter: { keys: { 1: 0, 3: 1 } } }\n" BODY,
         true);
    assert_int_equal(fixture_scene->camera_step_count, 1);
    set_frame(2);
    assert_int_equal(fixture_scene->camera_step_count, 2);
    fixture_near(fixture_scene->camera_steps[0].position.x, 0.75f, 1e-6f);
    fixture_near(fixture_scene->camera_steps[1].position.x, 1.25f, 1e-6f);
    set_frame(1);
    assert_int_equal(fixture_scene->camera_step_count, 1);
}

// What an object brings from its file stands in every picture where it does in the others, whichever came first.
static void lights_of_files_stand_still(void** state)
{
    (void)state;
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const uint16_t triangle[3] = {0, 1, 2};
    char path[TY_PATH_MAX];
    gltf_text g = {0};
    (void)gltf_floats(&g, corners, 3, 3);
    (void)gltf_shorts(&g, triangle, 3);
    gltf_write(&g, fixture_path("lamp.gltf", path),
               "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\",\"intensity\":9}]}},"
               "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
               "\"nodes\":[{\"mesh\":0},{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}]");
    static const char text[] = HEAD "assets: { a: { gltf: lamp.gltf } }\n"
                                    "objects: [ { gltf: a, file_lights: true, translate: { keys: { 1: [3, 0, 0], 11: "
                                    "[8, 0, 0] } } } ]\n%s";
    char hash[33] = "";
    for (int i = 0; i < 2; ++i)
    {
        char* scene_text = ty_string_format(text, i ? "frame: 6\n" : "");
        load(scene_text, true);
        ty_free(scene_text);
        set_frame(6);
        assert_int_equal(fixture_scene->light_count, 1);
        fixture_near(fixture_scene->lights[0].center.x, 3.0f, 1e-6f);
        if (i)
            assert_string_equal(hash, fixture_scene->hash);
        snprintf(hash, sizeof hash, "%s", fixture_scene->hash);
    }
}

// A lamp that is switched on later is linked to what it lights from the beginning.
static void dark_lamps_are_linked(void** state)
{
    (void)state;
    load(HEAD "assets: { ball: { shape: sphere, divisions: 8, radius: 0.1 } }\n"
              "materials: { m: { model: surface }, lamp: { model: surface, emission_color: 1, emission_luminance: { "
              "keys: { 1: 0, 5: 4 } } } }\n"
              "objects:\n"
              "  - { mesh: ball, material: m, lights: [glow] }\n"
              "  - { name: bulb, mesh: ball, material: lamp, light_group: glow, translate: [1, 0, 0] }\n"
              "  - { mesh: ball, material: m, exclude_lights: bulb, translate: [2, 0, 0] }\n",
         true);
    set_frame(5);
    const ty_scene* scene = fixture_scene;
    assert_true(scene->light_links[scene->objects[0].light_link][scene->light_count + 1]);
    assert_false(scene->light_links[scene->objects[2].light_link][scene->light_count + 1]);
}

static void time_outside_is_an_error_if_asked(void** state)
{
    (void)state;
    load_vfov("{ keys: { 1: 10, 9: 30 }, after: error, before: hold }");
    fixture_near(vfov_at(-3), 10.0f, 1e-5f);
    fixture_near(vfov_at(9), 30.0f, 1e-5f);
    assert_int_equal(ty_scene_set_frame(fixture_scene, 10, &fixture_errors), TY_BAD_INPUT);
    assert_true(fixture_has("scene.yaml", 3, 17, "frame 10 is after the last key, frame 9"));
    assert_int_equal(fixture_errors.count, 1);
    fixture_near(vfov_at(9), 30.0f, 1e-5f);
    // a slope that leaves the range is told at the frame where it does
    load_vfov("{ keys: { 1: 10, 9: 30 }, after: continue }");
    fixture_near(vfov_at(20), 57.5f, 1e-4f);
    assert_int_equal(ty_scene_set_frame(fixture_scene, 100, &fixture_errors), TY_BAD_INPUT);
    assert_true(fixture_has("scene.yaml", 3, 37, "out of range"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(keys_are_met_and_joined),
        FIXTURE_TEST(smooth_is_monotone),
        FIXTURE_TEST(outside_the_keys),
        FIXTURE_TEST(every_kind_of_value),
        FIXTURE_TEST(a_key_is_the_number),
        FIXTURE_TEST(only_what_changes_is_made_again),
        FIXTURE_TEST(visibility_may_be_keyed),
        FIXTURE_TEST(many_keys_load_fast),
        FIXTURE_TEST(a_recipe_tells_its_frame),
        FIXTURE_TEST(still_scenes_say_nothing_of_frames),
        FIXTURE_TEST(seeds_move_only_when_asked),
        FIXTURE_TEST(a_turn_closes),
        FIXTURE_TEST(mistakes_are_told_where_they_stand),
        FIXTURE_TEST(lenses_are_checked),
        FIXTURE_TEST(film_and_focal_length_give_the_angle),
        FIXTURE_TEST(focus_follows_its_object),
        FIXTURE_TEST(poses_span_the_shutter),
        FIXTURE_TEST(a_keyed_shutter_is_that_of_the_frame),
        FIXTURE_TEST(lights_of_files_stand_still),
        FIXTURE_TEST(dark_lamps_are_linked),
        FIXTURE_TEST(time_outside_is_an_error_if_asked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
