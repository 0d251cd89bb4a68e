// SPDX-License-Identifier: Apache-2.0
// A scene with every feature: what the file says is what is in memory, in metres, radians and ACEScg.
#include "scene/fixture.h"
#include <tsuya/geometry/mesh_file.h>
#include <tsuya/geometry/shape.h>
#include <tsuya/image/exr.h>
#include <tsuya/image/image.h>

static const char whole_scene[] =
    "tsuya: 1\n"
    "film: { size: [320, 180], filter: gaussian, filter_width: 2, half: false }\n"
    "camera: { position: [0, .15, .135], look_at: [0, 0.031, 0], vfov: 90, f_stop: 4, film_height: 36, "
    "focus_point: [0, 0, 0.01] }\n"
    "render: { integrator: ao, samples: 256, max_depth: 3, roulette_depth: 2, seed: 18446744073709551615 }\n"
    "vars: { wet: 0.31, tint: [.5, .25, .125] }\n"
    "assets:\n"
    "  ball: { shape: sphere, radius: 0.5, divisions: 32 }\n"
    "  grain: { mesh: models/grain.ply }\n"
    "  again: { mesh: models/grain.ply }\n"
    "  heap: { aggregate: heap.glb }\n"
    "  wood: { texture: wood.png, wrap: clamp }\n"
    "materials:\n"
    "  rice: { model: cdrf, color: $tint, moisture: { attribute: moisture, value: 0.62, scale: .5, offset: .5 }, "
    "mean_free_path: 2, evaluate: local }\n"
    "  table: { model: surface, base_color: { texture: wood }, specular_roughness: { texture: wood.png, value: .5 } }\n"
    "  wall: { model: surface, base_color: '#ff0000', coat_weight: 1 }\n"
    "objects:\n"
    "  - { aggregate: heap, material: rice }\n"
    "  - { name: floor, mesh: ball, material: table, translate: [1, 2, 3], rotate: [0, 90, 0], scale: 2 }\n"
    "  - { mesh: grain, material: wall, scale: [1, 2, 3] }\n"
    "  - { mesh: again, material: wall }\n"
    "lights:\n"
    "  - { type: environment, image: sky.exr, rotate: 180, color_space: raw }\n"
    "  - { type: rectangle, center: [0, 1, 0], target: [0, 0, 0], size: 0.1, radiance: [1, 2, 3] }\n"
    "  - { type: sphere, center: [1, 1, 1], radius: .25, radiance: { color: [1, 1, 1], space: lin_rec709 } }\n"
    "  - { type: point, center: [0, 2, 0], intensity: 5 }\n"
    "  - { type: directional, center: [0, 1, 0], irradiance: 2 }\n";

static ty_mesh* make_ball(int divisions)
{
    ty_shape_def def = ty_shape_def_default();
    ty_mesh* mesh = NULL;
    ty_error error;
    def.kind = TY_SHAPE_SPHERE;
    def.radius = 0.1f;
    def.divisions = divisions;
    assert_int_equal(ty_shape_create(&def, &mesh, &error), TY_OK);
    return mesh;
}

static void write_aggregate(const char* name)
{
    char path[TY_PATH_MAX];
    ty_error error;
    ty_aggregate* aggregate = ty_aggregate_create(5, 1);
    aggregate->prototypes[0] = make_ball(16);
    float* values = ty_aggregate_add_attribute(aggregate, "moisture");
    for (uint32_t i = 0; i < 5; ++i)
    {
        aggregate->transforms[i].t = ty_vec3_make((float)i, 0.0f, 0.0f);
        aggregate->ids[i] = 100 + i;
        values[i] = 0.125f * (float)i;
    }
    assert_int_equal(ty_aggregate_write(fixture_path(name, path), aggregate, &error), TY_OK);
    ty_aggregate_destroy(aggregate);
}

static void write_image(const char* name)
{
    char path[TY_PATH_MAX];
    ty_error error;
    float pixels[8 * 3];
    for (int i = 0; i < 24; ++i)
        pixels[i] = 0.25f;
    ty_image image = {.width = 4, .height = 2, .channels = 3, .pixels = pixels};
    assert_int_equal(ty_image_write(fixture_path(name, path), &image, 8, &error), TY_OK);
}

static void write_sky(const char* name)
{
    char path[TY_PATH_MAX];
    ty_error error;
    const int window[4] = {0, 0, 3, 1};
    ty_exr* exr = ty_exr_create(window, window);
    const char* const channels[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c)
    {
        float* pixels = ty_exr_add_channel(exr, channels[c], TY_EXR_FLOAT);
        for (int i = 0; i < 8; ++i)
            pixels[i] = 7.0f;
    }
    assert_int_equal(ty_exr_write(fixture_path(name, path), exr, &error), TY_OK);
    ty_exr_destroy(exr);
}

static void write_files(void)
{
    char path[TY_PATH_MAX];
    ty_error error;
    fixture_write("models/readme", "x");
    ty_mesh* grain = make_ball(24);
    assert_int_equal(ty_ply_write(fixture_path("models/grain.ply", path), grain, &error), TY_OK);
    ty_mesh_destroy(grain);
    write_aggregate("heap.glb");
    write_image("wood.png");
    write_sky("sky.exr");
}

static void load_whole(const ty_scene_options* options)
{
    write_files();
    fixture_write("scene.yaml", whole_scene);
    ty_status status = fixture_load(options);
    fixture_print_errors();
    assert_int_equal(status, TY_OK);
}

static void values_arrive_in_metres_radians_and_acescg(void** state)
{
    (void)state;
    load_whole(&(ty_scene_options){0});
    const ty_scene* s = fixture_scene;
    assert_int_equal(s->film.size[0], 320);
    assert_int_equal(s->film.size[1], 180);
    assert_int_equal(s->film.filter, TY_FILTER_GAUSSIAN);
    assert_false(s->film.half);
    fixture_near(s->camera.position.y, 0.15f, 0.0f);
    fixture_near(s->camera.vfov, TY_PI / 2.0f, 1e-6f);
    fixture_near(s->camera.film_height, 0.036f, 1e-9f);
    fixture_near(s->camera.up.y, 1.0f, 0.0f);
    assert_true(s->camera.has_focus_point);
    fixture_near(s->camera.focus_point.z, 0.01f, 0.0f);
    assert_int_equal(s->render.integrator, TY_INTEGRATOR_AO);
    assert_int_equal(s->render.samples, 256);
    assert_true(s->render.seed.value == UINT64_MAX);
    assert_int_equal(s->light_count, 5);
    assert_int_equal(s->lights[0].kind, TY_LIGHT_ENVIRONMENT);
    fixture_near(s->lights[0].rotate, TY_PI, 1e-6f);
    fixture_near(s->lights[1].size[1], 0.1f, 0.0f);
    fixture_near(s->lights[1].radiance.b, 3.0f, 0.0f);
    fixture_near(s->lights[2].radiance.g, 1.0f, 1e-3f); // white is white in either space
    fixture_near(s->lights[3].intensity.r, 5.0f, 0.0f);
    fixture_near(s->lights[4].irradiance.r, 2.0f, 0.0f);
}

static void images_are_shared_and_converted(void** state)
{
    (void)state;
    load_whole(&(ty_scene_options){0});
    const ty_scene* s = fixture_scene;
    assert_int_equal(s->texture_count, 1);         // sky
    assert_int_equal(s->surface_texture_count, 2); // wood clamped, wood repeated
    assert_non_null(s->light_images[0]);
    assert_null(s->light_images[1]);
    fixture_near(ty_texture_texel(s->light_images[0], 1, 1).g, 7.0f, 1e-3f);
    assert_non_null(s->light_tables[0]);
    assert_null(s->light_tables[1]);
    assert_true(s->light_tables[0]->mean > 0.0f);
    // 8 bit, sRGB encoded .25 is linear .0509
    const ty_vec2 corner = {0.01f, 0.99f}, none = {0.0f, 0.0f};
    fixture_near(ty_mip_texture_sample(s->shading.textures[0], corner, none, none).rgb.g, 0.0509f, 1e-3f);
    // a roughness: the number as it stands
    fixture_near(ty_mip_texture_sample(s->shading.textures[1], corner, none, none).rgb.g, 0.251f, 1e-3f);
}

static void objects_stand_in_the_world(void** state)
{
    (void)state;
    load_whole(&(ty_scene_options){0});
    const ty_scene* s = fixture_scene;
    assert_int_equal(s->object_count, 4);
    assert_string_equal(s->objects[0].name, "object0");
    assert_string_equal(s->objects[1].name, "floor");
    assert_int_equal(s->objects[0].material, 0);
    assert_int_equal(s->objects[1].material, 1);
    assert_int_equal(s->objects[0].instance_count, 5);
    assert_int_equal(s->instance_count, 8);
    assert_int_equal(ty_world_prototype_count(s->world), 3); // heap's, ball, and grain once for both its names
    assert_ptr_equal(ty_world_mesh(s->world, 2, 0), ty_world_mesh(s->world, 3, 0));
    assert_non_null(ty_world_mesh(s->world, 2, 0)->curvature_1);
    // scale, then rotate about y by 90 degrees, then translate: +z goes to +x
    ty_affine standing = ty_world_to_world(s->world, 1, 0, 0.0f);
    ty_vec3 p = ty_map_point(&standing, ty_vec3_make(0.0f, 0.0f, 0.5f));
    fixture_near(p.x, 2.0f, 1e-5f);
    fixture_near(p.y, 2.0f, 1e-5f);
    fixture_near(p.z, 3.0f, 1e-5f);
    ty_ray ray = ty_ray_make((ty_vec3){4.0f, 1.0f, 0.0f}, (ty_vec3){0.0f, -1.0f, 0.0f}, TY_FLOAT_MAX);
    ty_hit hit;
    assert_true(ty_world_intersect(s->world, &ray, &hit));
    assert_int_equal(hit.object, 0);
    assert_int_equal(hit.instance, 4);
    assert_int_equal(s->objects[0].ids[4], 104);
}

static void attributes_reach_the_shading(void** state)
{
    (void)state;
    load_whole(&(ty_scene_options){0});
    const ty_scene* s = fixture_scene;
    assert_int_equal(s->attribute_count, 1);
    assert_string_equal(s->attribute_names[0], "moisture");
    fixture_near(s->shading.object_attributes[0][0][3], 0.375f, 0.0f);
    assert_null(s->shading.object_attributes[1][0]);
    assert_null(s->shading.depth_fields[0]); // local needs none
}

static void depth_fields_where_they_are_needed(void** state)
{
    (void)state;
    const char* sets[] = {"materials.rice.evaluate=depth", "materials.rice.kernel=poisson"};
    load_whole(&(ty_scene_options){.sets = sets, .set_count = 2});
    uint32_t of_heap = ty_world_prototype(fixture_scene->world, 0, 0);
    uint32_t of_ball = ty_world_prototype(fixture_scene->world, 1, 0);
    assert_non_null(fixture_scene->shading.depth_fields[of_heap]);
    assert_null(fixture_scene->shading.depth_fields[of_ball]);
}

static void a_folder_names_its_scene(void** state)
{
    (void)state;
    fixture_write("scene.yaml", "tsuya: 1\n");
    assert_int_equal(ty_scene_load(fixture_folder, &(ty_scene_options){0}, &fixture_scene, &fixture_errors), TY_OK);
    assert_string_equal(fixture_scene->recipe, "tsuya: 1\n");
    assert_int_equal(fixture_scene->film.size[0], 960);
    fixture_near(fixture_scene->camera.vfov, ty_radians(40.0f), 1e-6f);
}

static void json_is_read_as_it_is(void** state)
{
    (void)state;
    fixture_must_load(
        "{\"tsuya\": 1,\n\t\"camera\": {\"vfov\": 1e1, \"position\": [0, 0, -1]},\n \"lights\": [{\"type\": "
        "\"point\"}]}\n");
    fixture_near(fixture_scene->camera.vfov, ty_radians(10.0f), 1e-6f);
    assert_int_equal(fixture_scene->light_count, 1);
}

static void checking_builds_no_world(void** state)
{
    (void)state;
    load_whole(&(ty_scene_options){.check_only = true});
    assert_null(fixture_scene->world);
    assert_int_equal(fixture_scene->object_count, 4);
}

static void colours_are_converted(void** state)
{
    (void)state;
    fixture_must_load("tsuya: 1\nlights:\n"
                      "  - { type: point, intensity: '#ffffff' }\n"
                      "  - { type: point, intensity: { color: [1, 0, 0], space: lin_rec709 } }\n"
                      "  - { type: point, intensity: '#808080' }\n"
                      "  - { type: point, intensity: { color: [1, 0, 0] } }\n");
    const ty_light_def* lights = fixture_scene->lights;
    fixture_near(lights[0].intensity.r, 1.0f, 2e-3f);
    fixture_near(lights[1].intensity.r, 0.6131f, 1e-3f); // Rec.709 red in AP1, Bradford adapted
    fixture_near(lights[1].intensity.g, 0.0702f, 1e-3f);
    fixture_near(lights[1].intensity.b, 0.0206f, 1e-3f);
    fixture_near(lights[2].intensity.g, 0.2159f, 1e-3f);
    fixture_near(lights[3].intensity.g, 0.0f, 0.0f);
}

static void a_search_folder_is_looked_into(void** state)
{
    (void)state;
    fixture_write("pictures/readme", "x");
    write_image("pictures/wood.png");
    fixture_must_load(
        "tsuya: 1\nsearch: [pictures]\nmaterials:\n  a: { model: surface, base_color: { texture: wood.png } }\n");
    assert_non_null(strstr(fixture_scene->recipe, "texture: pictures/wood.png"));
    assert_null(strstr(fixture_scene->recipe, "search"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(values_arrive_in_metres_radians_and_acescg),
        FIXTURE_TEST(images_are_shared_and_converted),
        FIXTURE_TEST(objects_stand_in_the_world),
        FIXTURE_TEST(attributes_reach_the_shading),
        FIXTURE_TEST(depth_fields_where_they_are_needed),
        FIXTURE_TEST(a_folder_names_its_scene),
        FIXTURE_TEST(json_is_read_as_it_is),
        FIXTURE_TEST(checking_builds_no_world),
        FIXTURE_TEST(colours_are_converted),
        FIXTURE_TEST(a_search_folder_is_looked_into),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
