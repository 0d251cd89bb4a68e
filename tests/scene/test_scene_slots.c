// SPDX-License-Identifier: Apache-2.0
// Several materials a mesh, and vertex attributes as inputs.
#include "scene/fixture.h"
#include <fcntl.h>

// Two quads, each a slot of its own, and a third that shares the first's.
static const char quads[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 3 1 0\nv 2 1 0\n"
                            "usemtl Bark\nf 1 2 3 4\nusemtl Leaf\nf 5 6 7 8\nusemtl Bark\nf 2 5 8 3\n";

static const char colored[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                              "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                              "property float age\nelement face 1\nproperty list uchar int vertex_indices\n"
                              "end_header\n0 0 0 255 0 0 2\n1 0 0 128 128 128 4\n0 1 0 0 0 255 10\n3 0 1 2\n";

#define HEAD                                                                                                           \
    "tsuya: 1\nassets: { tree: { mesh: tree.obj }, leaf: { mesh: leaf.ply } }\nmaterials:\n"                           \
    "  a: { model: surface }\n  b: { model: surface }\n  c: { model: surface, base_color: { attribute: color } }\n"    \
    "  d: { model: surface, specular_roughness: { attribute: age, scale: .1 } }\n  e: { model: cdrf }\n  f: { model: " \
    "surface }\nobjects:\n"

static void write_files(void)
{
    fixture_write("tree.obj", quads);
    fixture_write("leaf.ply", colored);
}

static void load_world(const char* text)
{
    ty_scene_options options = {0};
    fixture_write("scene.yaml", text);
    ty_status status = fixture_load(&options);
    if (status != TY_OK)
        fixture_print_errors();
    assert_int_equal(status, TY_OK);
}

// The material at x on the line y = .5, seen from above.
static const ty_material* material_at(float x, uint32_t object)
{
    ty_hit hit;
    ty_ray ray = ty_ray_make((ty_vec3){x, 0.5f, 1.0f}, (ty_vec3){0, 0, -1}, 10.0f);
    assert_true(ty_world_intersect(fixture_scene->world, &ray, &hit));
    return ty_scene_material(fixture_scene, object, hit.instance, hit.triangle);
}

static void each_triangle_has_its_slots_material(void** state)
{
    (void)state;
    write_files();
    load_world(HEAD "  - { mesh: tree, materials: { Leaf: b, Bark: a } }\n"
                    "  - { mesh: tree, materials: { Leaf: e }, material: f }\n"
                    "  - { mesh: tree, material: b }\n");
    ty_material** m = fixture_scene->materials;
    assert_ptr_equal(material_at(0.5f, 0), m[0]);
    assert_ptr_equal(material_at(2.5f, 0), m[1]);
    assert_ptr_equal(material_at(1.5f, 0), m[0]);
    assert_ptr_equal(material_at(0.5f, 1), m[5]);
    assert_ptr_equal(material_at(2.5f, 1), m[4]);
    assert_ptr_equal(material_at(2.5f, 2), m[1]);
    assert_int_equal(ty_scene_material_count(&fixture_scene->objects[0]), 2);
    assert_int_equal(ty_scene_material_count(&fixture_scene->objects[2]), 1);
}

static void wrong_slots_are_named(void** state)
{
    (void)state;
    write_files();
    fixture_one_error(HEAD "  - { mesh: tree, materials: { leaf: b, Bark: a } }\n", 11, 32,
                      "'tree' has no material slot 'leaf'; did you mean 'Leaf'?");
    fixture_one_error(HEAD "  - { mesh: leaf, materials: { Leaf: b } }\n", 11, 32, "it names none");
    fixture_one_error(HEAD "  - { mesh: tree, materials: { Leaf: bb, Bark: a } }\n", 11, 38, "no material 'bb'");
    fixture_one_error(HEAD "  - { mesh: tree }\n", 11, 5, "missing key 'material' (or 'materials') of an object");
    fixture_one_error(HEAD "  - { mesh: tree, materials: [a, b] }\n", 11, 30, "a mapping of names to names");
}

static void slots_left_over_are_listed(void** state)
{
    (void)state;
    char path[TY_PATH_MAX];
    ty_bytes log;
    ty_error error;
    write_files();
    fixture_path("log", path);
    int before = dup(2), file = open(path, O_CREAT | O_WRONLY, 0600);
    assert_true(before >= 0 && file >= 0 && dup2(file, 2) == 2);
    ty_log_set_level(TY_LOG_WARNING);
    ty_status status = fixture_check(HEAD "  - { mesh: tree, materials: { Bark: b } }\n");
    ty_log_set_level(TY_LOG_ERROR);
    assert_true(dup2(before, 2) == 2 && close(file) == 0 && close(before) == 0);
    assert_int_equal(status, TY_OK);
    assert_int_equal(ty_file_read(path, 1 << 16, &log, &error), TY_OK);
    char* text = ty_string_format("%.*s", (int)log.size, (const char*)log.data);
    assert_non_null(strstr(text, "no material for slot 'Leaf' of 'tree': 'b' is used"));
    ty_free(text);
    ty_bytes_term(&log);
}

static ty_surface_point point_on(uint32_t object, float u, float v)
{
    return (ty_surface_point){.object = object, .u = u, .v = v};
}

static void vertex_attributes_are_inputs(void** state)
{
    (void)state;
    write_files();
    load_world(HEAD "  - { mesh: leaf, material: c }\n  - { mesh: leaf, material: d }\n");
    const ty_shading_context* context = &fixture_scene->shading;
    ty_input input = ty_input_scalar(1.0f);
    ty_surface_point corner = point_on(0, 1.0f, 0.0f), first = point_on(0, 0.0f, 0.0f), middle = point_on(1, .25f, .5f);
    input.attribute_index = 0; // color
    ty_rgb grey = ty_input_color(&input, context, &corner), red = ty_input_color(&input, context, &first);
    fixture_near(grey.r, 0.2158605f, 1e-4f); // 128/255 decoded; grey is grey in every space
    fixture_near(grey.b, 0.2158605f, 1e-4f);
    fixture_near(red.r, 0.6131f, 1e-3f); // Rec.709 red in ACEScg
    fixture_near(red.g, 0.0702f, 1e-3f);
    input.attribute_index = 1; // age
    input.scale = 0.1f;
    fixture_near(ty_input_float(&input, context, &middle), 0.1f * (0.25f * 2.0f + 0.25f * 4.0f + 0.5f * 10.0f), 1e-5f);
}

// Green paint over red vertices is black where files of Rec.709 mean it, and not quite in ACEScg.
static void products_are_of_a_space(void** state)
{
    (void)state;
    write_files();
    load_world("tsuya: 1\nassets: { leaf: { mesh: leaf.ply } }\n"
               "materials: { m: { model: surface, base_color: { attribute: color } } }\n"
               "objects: [ { mesh: leaf, material: m } ]\n");
    ty_surface_point red = point_on(0, 0.0f, 0.0f);
    ty_input input = ty_input_make(ty_rgb_make(0.33952315f, 0.91635388f, 0.10956977f)); // Rec.709 green
    input.attribute_index = 0;
    ty_rgb mixed = ty_input_color(&input, &fixture_scene->shading, &red);
    assert_true(mixed.r > 0.15f);
    input.product = TY_PRODUCT_REC709;
    ty_rgb black = ty_input_color(&input, &fixture_scene->shading, &red);
    fixture_near(black.r, 0.0f, 1e-5f);
    fixture_near(black.g, 0.0f, 1e-5f);
    fixture_one_error("tsuya: 1\nmaterials: { m: { model: surface, base_color: { attribute: a, product: srgb } } }\n",
                      2, 72, "not one of");
}

static void a_missing_vertex_attribute_is_named(void** state)
{
    (void)state;
    write_files();
    fixture_one_error("tsuya: 1\nassets: { leaf: { mesh: leaf.ply } }\n"
                      "materials: { m: { model: surface, coat_weight: { attribute: agee } } }\n"
                      "objects: [ { mesh: leaf, material: m } ]\n",
                      3, 61, "mesh 'leaf' has no attribute 'agee'; did you mean 'age'?");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(each_triangle_has_its_slots_material), FIXTURE_TEST(wrong_slots_are_named),
        FIXTURE_TEST(slots_left_over_are_listed),           FIXTURE_TEST(vertex_attributes_are_inputs),
        FIXTURE_TEST(a_missing_vertex_attribute_is_named),  FIXTURE_TEST(products_are_of_a_space),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
