// SPDX-License-Identifier: Apache-2.0
// Hosts of roots: distances and sides against formulas, several objects and instances, what is painted, what is
// refused.
#include "roots_grown.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/geometry/mesh_file.h>

static void refused(const ty_roots_recipe* recipe, const char* text)
{
    roots_host host;
    ty_error error = {0};
    assert_int_not_equal(roots_host_init(recipe, NULL, NULL, &host, &error), TY_OK);
    assert_null(host.mesh);
    if (!strstr(error.text, text))
        fail_msg("no '%s' in: %s", text, error.text);
}

static ty_roots_recipe recipe_of(ty_roots_host_kind kind)
{
    ty_roots_recipe recipe = ty_roots_recipe_default();
    recipe.host.kind = (int)kind;
    recipe.host.resolution = 64;
    recipe.host.floor = false;
    recipe.host.shape.size = ty_vec3_make(0.03f, 0.04f, 0.02f);
    return recipe;
}

static ty_roots_recipe recipe_of_file(const char* path)
{
    ty_roots_recipe recipe = recipe_of(TY_ROOTS_HOST_MESH);
    recipe.host.mesh = path;
    return recipe;
}

static ty_vec3 random_in(ty_rng* rng, float half)
{
    float x = ty_rng_range(rng, -half, half), y = ty_rng_range(rng, -half, half);
    return ty_vec3_make(x, y, ty_rng_range(rng, -half, half));
}

static ty_mesh* shape(ty_shape_kind kind)
{
    ty_shape_def def = ty_shape_def_default();
    def.kind = (int)kind;
    def.radius = 0.04f;
    def.tube = 0.01f;
    def.divisions = 96;
    def.size = ty_vec3_make(0.03f, 0.04f, 0.02f);
    ty_mesh* mesh;
    ty_error error;
    assert_int_equal(ty_shape_create(&def, &mesh, &error), TY_OK);
    return mesh;
}

static void write_mesh(const char* path, ty_mesh* mesh)
{
    ty_error error;
    assert_int_equal(ty_ply_write(path, mesh, &error), TY_OK);
    ty_mesh_destroy(mesh);
}

static void write_text(const char* path, const char* text)
{
    FILE* file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

// --- distances ---

static float box(ty_vec3 p)
{
    ty_vec3 q = {fabsf(p.x) - 0.03f, fabsf(p.y) - 0.04f, fabsf(p.z) - 0.02f}, zero = {0.0f, 0.0f, 0.0f};
    return ty_length(ty_max3(q, zero)) + ty_min(ty_max(q.x, ty_max(q.y, q.z)), 0.0f);
}

// At edges and corners, where facets turn, the side is right and the normal points away.
static void a_box_is_exact_at_its_edges(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_of(TY_ROOTS_HOST_BOX);
    roots_host host = host_of(&recipe);
    ty_rng rng = ty_rng_make((ty_seed){1}, 0, 0);
    for (int i = 0; i < 20000; i++)
    {
        ty_vec3 n, corner = {i & 1 ? 0.03f : -0.03f, i & 2 ? 0.04f : -0.04f, i & 4 ? 0.02f : -0.02f};
        ty_vec3 p = i % 3 == 0 ? random_in(&rng, 0.05f) : ty_add(corner, random_in(&rng, i % 3 == 1 ? 0.002f : 1e-4f));
        float d = box(p), found = roots_host_exact(&host, p, 0.05f, &n);
        assert_float_equal(found, d, 2e-7f);
        assert_float_equal(ty_length(n), 1.0f, 1e-4f);
        if (fabsf(d) > 1e-4f)
            assert_float_equal(box(ty_mad(p, n, -d)), 0.0f, 1e-6f);
        float steps = d / host.field.step; // cells that an edge runs through are rounded
        if (steps > 0.0f && steps < 4.0f)
            assert_float_equal(roots_host_value(&host, p, NULL), d, (steps < 2.0f ? 0.35f : 0.15f) * host.field.step);
    }
    roots_host_term(&host);
}

static void a_ball_has_its_distance(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_of(TY_ROOTS_HOST_SPHERE);
    recipe.host.shape.divisions = 512;
    roots_host host = host_of(&recipe);
    ty_rng rng = ty_rng_make((ty_seed){2}, 0, 0);
    for (int i = 0; i < 20000; i++)
    {
        ty_vec3 g, n, p = ty_mul(ty_normalize(random_in(&rng, 1.0f)), 0.04f + ty_rng_range(&rng, -0.004f, 0.004f));
        float d = ty_length(p) - 0.04f;
        assert_float_equal(roots_host_value(&host, p, &g), d, 0.1f * host.field.step);
        assert_true(ty_dot(ty_normalize(g), ty_normalize(p)) > 0.99f);
        assert_float_equal(roots_host_exact(&host, p, 0.01f, &n), d, 2e-6f);
        assert_float_equal(ty_length(roots_host_project(&host, p, 0.002f, &n)), 0.042f, 0.1f * host.field.step);
    }
    recipe.host.floor = true;
    recipe.host.floor_height = 0.01f;
    roots_host_term(&host);
    host = host_of(&recipe);
    ty_vec3 n;
    assert_float_equal(roots_host_exact(&host, ty_vec3_make(0.2f, -0.02f, 0.0f), 0.01f, &n), 0.01f, 1e-6f);
    assert_float_equal(n.y, 1.0f, 0.0f);
    roots_host_term(&host);
}

static void sheets_are_held_on_either_side(void** state)
{
    (void)state;
    write_mesh("roots_sheet.ply", shape(TY_SHAPE_PLANE));
    ty_roots_recipe recipe = recipe_of_file("roots_sheet.ply");
    roots_host host = host_of(&recipe);
    for (int i = -40; i <= 40; i++)
    {
        ty_vec3 n, p = {0.003f, 1e-4f * (float)i, 0.002f};
        assert_float_equal(roots_host_exact(&host, p, 0.01f, &n), fabsf(p.y), 1e-7f);
        assert_true(i == 0 || n.y * (float)i > 0.0f);
    }
    roots_host_term(&host);
}

// --- several ---

static void objects_stand_where_they_are_put(void** state)
{
    (void)state;
    ty_roots_object_def objects[3] = {{.kind = TY_ROOTS_HOST_BOX, .shape = ty_shape_def_default()},
                                      {.kind = TY_ROOTS_HOST_SPHERE, .shape = ty_shape_def_default()}};
    objects[0].shape.size = ty_vec3_make(0.03f, 0.01f, 0.01f);
    objects[0].rotate.z = ty_radians(90.0f); // it stands up
    objects[0].scale = ty_vec3_make(1.0f, 1.0f, 1.0f);
    objects[1].shape.radius = 0.01f;
    objects[1].translate.y = 0.035f;
    objects[1].scale = ty_vec3_make(2.0f, 2.0f, 2.0f);
    objects[2] = objects[0];
    objects[2].translate.z = 0.1f;
    ty_roots_recipe recipe = recipe_of(TY_ROOTS_HOST_SPHERE);
    recipe.host.objects = (ty_param_list){objects, 3};
    roots_host host = host_of(&recipe);
    ty_vec3 n;
    assert_float_equal(roots_host_exact(&host, ty_vec3_make(0.0f, -0.033f, 0.0f), 0.01f, &n), 0.003f, 1e-6f);
    assert_float_equal(roots_host_exact(&host, ty_vec3_make(0.0f, 0.06f, 0.0f), 0.01f, &n), 0.005f, 2e-4f);
    assert_true(roots_host_value(&host, ty_vec3_make(0.0f, 0.025f, 0.0f), NULL) < 0.0f); // in both
    assert_float_equal(roots_host_exact(&host, ty_vec3_make(0.0f, 0.033f, 0.1f), 0.01f, &n), 0.003f, 1e-6f);
    roots_host_term(&host);
    objects[1].scale.y = 0.0f;
    refused(&recipe, "host.objects[1].scale: [2, 0, 2]");
    objects[1].scale.y = 2.0f;
    recipe.host.objects.count = 0;
    recipe.obstacles = (ty_param_list){objects, 2};
    host = host_of(&recipe);
    assert_float_equal(roots_host_clear(&host, ty_vec3_make(0.0f, -0.033f, 0.0f), &n), 0.003f, 1e-4f);
    assert_true(n.y < -0.99f);
    roots_host_term(&host);
    recipe.obstacles.count = 0;
    host = host_of(&recipe);
    assert_true(roots_host_clear(&host, ty_vec3_make(0.0f, 0.0f, 0.0f), NULL) == TY_FLOAT_MAX);
    roots_host_term(&host);
}

static void instances_are_all_there(void** state)
{
    (void)state;
    ty_error error;
    ty_aggregate* a = ty_aggregate_create(2, 1);
    a->prototypes[0] = shape(TY_SHAPE_BOX);
    for (uint32_t i = 0; i < 2; i++)
    {
        ty_vec3 place = {i == 0 ? -0.1f : 0.1f, 0.0f, 0.0f};
        a->transforms[i] = ty_affine_from_trs(place, ty_quat_euler((ty_vec3){0}), ty_vec3_make(1.0f, 1.0f, 1.0f));
        a->ids[i] = i;
    }
    assert_int_equal(ty_aggregate_write("roots_host.glb", a, &error), TY_OK);
    ty_aggregate_destroy(a);
    ty_roots_recipe recipe = recipe_of_file("roots_host.glb");
    roots_host host = host_of(&recipe);
    ty_vec3 n;
    assert_float_equal(roots_host_exact(&host, ty_vec3_make(-0.1f, 0.045f, 0.0f), 0.02f, &n), 0.005f, 1e-6f);
    assert_float_equal(roots_host_exact(&host, ty_vec3_make(0.1f, 0.045f, 0.0f), 0.02f, &n), 0.005f, 1e-6f);
    assert_float_equal(roots_host_exact(&host, ty_vec3_make(0.06f, 0.0f, 0.0f), 0.02f, &n), 0.01f, 1e-6f);
    roots_host_term(&host);
}

// --- what is painted ---

// A ball, `seed` 1 above y = 0.02 and red there.
static void write_painted(const char* path)
{
    ty_mesh* mesh = shape(TY_SHAPE_SPHERE);
    float* seed = ty_mesh_add_attribute(mesh, "seed", 1);
    float* color = ty_mesh_add_attribute(mesh, "color", 3);
    mesh->attributes[mesh->attribute_count - 1].space = TY_ATTRIBUTE_SRGB;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        seed[v] = mesh->positions[v].y > 0.02f ? 1.0f : 0.0f;
        color[3 * v] = mesh->positions[v].x > 0.0f ? 1.0f : 0.0f;
    }
    write_mesh(path, mesh);
}

static void masks_are_felt_near_the_host(void** state)
{
    (void)state;
    write_painted("roots_painted.ply");
    ty_roots_recipe recipe = recipe_of_file("roots_painted.ply");
    recipe.host.avoid.attribute = "seed";
    roots_host host = host_of(&recipe);
    ty_vec3 g, up = {0.0f, 0.042f, 0.0f}, beside = {0.042f, 0.0f, 0.0f}, edge = {0.0357f, 0.0206f, 0.0f};
    assert_float_equal(roots_host_mask(&host, ROOTS_AVOID, up, &g), 1.0f, 0.01f);
    assert_float_equal(roots_host_mask(&host, ROOTS_AVOID, beside, &g), 0.0f, 0.01f);
    (void)roots_host_mask(&host, ROOTS_AVOID, edge, &g);
    assert_true(g.y > 50.0f); // up to it
    assert_true(roots_host_mask(&host, ROOTS_ATTRACT, up, &g) == 0.0f && g.y == 0.0f);
    roots_host_term(&host);
    recipe.host.avoid.attribute = "color.r";
    host = host_of(&recipe);
    assert_float_equal(roots_host_mask(&host, ROOTS_AVOID, beside, NULL), 1.0f, 0.01f);
    roots_host_term(&host);
    recipe.host.avoid.attribute = "moss";
    refused(&recipe, "host.avoid: 'moss'; the host's vertices have ");
    refused(&recipe, "seed");
    recipe.host.avoid.attribute = NULL;
    recipe.host.attract.attribute = "seed.g"; // there is but one number
    refused(&recipe, "host.attract: 'seed.g'");
    recipe.host = recipe_of(TY_ROOTS_HOST_BOX).host;
    recipe.host.attract.attribute = "seed";
    refused(&recipe, "no attributes");
}

static void starts_are_given_or_painted(void** state)
{
    (void)state;
    write_painted("roots_painted.ply");
    ty_roots_recipe recipe = recipe_of_file("roots_painted.ply");
    roots_host host = host_of(&recipe);
    roots_start* starts;
    int count;
    ty_error error;
    ty_vec3 points[2] = {{0.0f, 0.043f, 0.0f}, {0.039f, 0.0f, 0.0f}};
    assert_int_equal(roots_host_starts(&host, &recipe, 5, &starts, &count, &error), TY_OK);
    assert_true(count == 0 && !starts);
    recipe.start.points = (ty_param_list){points, 2};
    assert_int_equal(roots_host_starts(&host, &recipe, 1, &starts, &count, &error), TY_OK);
    assert_int_equal(count, 2); // those that are given all count
    assert_float_equal(starts[0].p.y, 0.04f, 1e-4f);
    assert_true(starts[0].n.y > 0.99f && starts[1].n.x > 0.99f);
    ty_free(starts);
    recipe.start.attribute = "seed";
    assert_int_equal(roots_host_starts(&host, &recipe, 8, &starts, &count, &error), TY_OK);
    assert_int_equal(count, 8);
    for (int i = 2; i < count; i++)
        for (int k = 0; k < i; k++)
            assert_true(starts[i].p.y > 0.02f && ty_length(ty_sub(starts[i].p, starts[k].p)) > 0.015f);
    ty_free(starts);
    recipe.start.attribute = "nothing";
    assert_int_equal(roots_host_starts(&host, &recipe, 8, &starts, &count, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "start.attribute: 'nothing'"));
    recipe.start.attribute = NULL;
    points[1].x = 0.06f;
    assert_int_equal(roots_host_starts(&host, &recipe, 8, &starts, &count, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "start.points[1]: [0.06, 0, 0] is 0.02 m from the host; at most 0.008"));
    points[1].x = 0.034f;
    assert_int_equal(roots_host_starts(&host, &recipe, 8, &starts, &count, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "inside of the host, 0.00599 m deep; at most 0.0042"));
    assert_true(count == 0 && !starts);
    roots_host_term(&host);
}

// --- what is refused ---

#define HEAD "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"

static void hosts_that_are_none_are_refused(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_of_file("roots_bad.ply");
    write_text("roots_bad.ply", HEAD "end_header\n0 0 0\n1 0 0\n0 1 0\n");
    refused(&recipe, "no faces");
    write_text("roots_bad.ply", HEAD "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                     "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n");
    refused(&recipe, "vertex 1: y is not finite");
    write_text("roots_bad.ply", HEAD "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                     "0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n");
    refused(&recipe, "area");
    recipe.host.mesh = NULL;
    refused(&recipe, "host.mesh: the file is missing");
    recipe = recipe_of(TY_ROOTS_HOST_SPHERE);
    recipe.radius = 0.1f;
    refused(&recipe, "radius: 100 mm; at most 80 mm, the host's longest side");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_is_exact_at_its_edges),    cmocka_unit_test(a_ball_has_its_distance),
        cmocka_unit_test(sheets_are_held_on_either_side), cmocka_unit_test(objects_stand_where_they_are_put),
        cmocka_unit_test(instances_are_all_there),        cmocka_unit_test(masks_are_felt_near_the_host),
        cmocka_unit_test(starts_are_given_or_painted),    cmocka_unit_test(hosts_that_are_none_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
