// SPDX-License-Identifier: Apache-2.0
// Meshes: validation, welds, normals with creases, topology, convexity, copies, transforms and attributes.
#include <base/cmocka_all.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/geometry/shape.h>

// A cube of side 2 about the origin from eight vertices.
static ty_mesh* make_cube(void)
{
    static const uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    ty_mesh* mesh = ty_mesh_create(8, 12);
    assert_non_null(mesh);
    for (uint32_t i = 0; i < 8; i++)
        mesh->positions[i] = ty_vec3_make(i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f);
    for (uint32_t i = 0; i < 6; i++)
        for (int k = 0; k < 3; k++)
        {
            mesh->triangles[2 * i][k] = quads[i][k];
            mesh->triangles[2 * i + 1][k] = quads[i][k == 0 ? 0 : k + 1];
        }
    ty_mesh_compute_bounds(mesh);
    ty_mesh_compute_welds(mesh);
    return mesh;
}

static ty_mesh* make_ball(int divisions, ty_vec3 size)
{
    ty_shape_def def = ty_shape_def_default();
    def.kind = TY_SHAPE_ELLIPSOID;
    def.size = size;
    def.divisions = divisions;
    ty_mesh* mesh;
    assert_int_equal(ty_shape_create(&def, &mesh, NULL), TY_OK);
    return mesh;
}

static ty_mesh_topology analyse(const ty_mesh* mesh)
{
    ty_mesh_topology topology;
    ty_mesh_analyse(mesh, &topology);
    return topology;
}

static void flip(ty_mesh* mesh, uint32_t triangle)
{
    uint32_t second = mesh->triangles[triangle][1];
    mesh->triangles[triangle][1] = mesh->triangles[triangle][2];
    mesh->triangles[triangle][2] = second;
}

// --- validation ---

static void assert_invalid(const ty_mesh* mesh, const char* offender)
{
    ty_error error = {0};
    assert_int_equal(ty_mesh_validate(mesh, "some.ply", &error), TY_BAD_FILE);
    assert_int_equal(error.status, TY_BAD_FILE);
    assert_string_equal(error.file, "some.ply");
    assert_non_null(strstr(error.text, offender));
}

static void test_validate_names_the_first_offender(void** state)
{
    (void)state;
    ty_mesh* mesh = make_cube();
    ty_error error = {0};
    assert_int_equal(ty_mesh_validate(mesh, "some.ply", &error), TY_OK);
    mesh->triangles[7][2] = 8;
    assert_invalid(mesh, "triangle 7");
    mesh->positions[5].y = NAN;
    assert_invalid(mesh, "vertex 5");
    mesh->positions[3].z = INFINITY;
    assert_invalid(mesh, "vertex 3");
    ty_mesh_destroy(mesh);
}

static void test_validate_wants_area(void** state)
{
    (void)state;
    ty_mesh* mesh = make_cube();
    for (uint32_t i = 0; i < 8; i++)
        mesh->positions[i].x = mesh->positions[i].y = 0.5f;
    assert_invalid(mesh, "area");
    for (uint32_t i = 0; i < 8; i++)
        mesh->positions[i] = ty_vec3_make(i & 1 ? 3e38f : -3e38f, i & 2 ? 3e38f : -3e38f, 0.0f);
    assert_int_equal(ty_mesh_validate(mesh, "large", NULL), TY_OK);
    mesh->triangle_count = 0;
    assert_invalid(mesh, "triangles");
    mesh->vertex_count = 0;
    assert_invalid(mesh, "vertices");
    ty_mesh_destroy(mesh);
}

static void test_create_survives_exhaustion(void** state)
{
    (void)state;
    int failures = 0;
    for (long i = 0; i < 16; i++)
    {
        ty_memory_fail_after(i);
        ty_mesh* mesh = ty_mesh_create(100, 100);
        ty_memory_fail_after(-1);
        failures += mesh == NULL;
        ty_mesh_destroy(mesh);
    }
    assert_int_equal(failures, 4); // the mesh and its three arrays
}

// --- welds ---

static void test_welds_join_equal_positions_only(void** state)
{
    (void)state;
    ty_mesh* mesh = ty_mesh_create(6, 1);
    mesh->positions[0] = ty_vec3_make(0.0f, 1.0f, 2.0f);
    mesh->positions[1] = ty_vec3_make(0.0f, 1.0f, nextafterf(2.0f, 3.0f));
    mesh->positions[2] = ty_vec3_make(-0.0f, 1.0f, 2.0f);
    mesh->positions[3] = ty_vec3_make(1.0f, 0.0f, 2.0f);
    mesh->positions[4] = mesh->positions[1];
    mesh->positions[5] = mesh->positions[2];
    ty_mesh_compute_welds(mesh);
    const uint32_t expected[6] = {0, 1, 0, 3, 1, 0};
    assert_memory_equal(mesh->welds, expected, sizeof(expected));
    ty_mesh_destroy(mesh);
}

// --- normals ---

static void test_sharp_edges_are_split(void** state)
{
    (void)state;
    ty_mesh* mesh = make_cube();
    float* tag = ty_mesh_add_attribute(mesh, "tag", 2);
    for (uint32_t i = 0; i < 8; i++)
        tag[2 * i + 1] = (float)i;
    ty_mesh_compute_normals(mesh, ty_radians(89.0f));
    assert_int_equal(mesh->vertex_count, 24);
    tag = ty_mesh_add_attribute(mesh, "tag", 2);
    for (uint32_t i = 0; i < 12; i++)
        for (int k = 0; k < 3; k++)
        {
            uint32_t v = mesh->triangles[i][k];
            const uint32_t* c = mesh->triangles[i];
            ty_vec3 u = ty_sub(mesh->positions[c[1]], mesh->positions[c[0]]);
            ty_vec3 face = ty_normalize(ty_cross(u, ty_sub(mesh->positions[c[2]], mesh->positions[c[0]])));
            assert_true(ty_dot(face, mesh->normals[v]) > 0.999999f);
            assert_true(tag[2 * v + 1] == (float)mesh->welds[v]);
            assert_true(memcmp(&mesh->positions[v], &mesh->positions[mesh->welds[v]], sizeof(ty_vec3)) == 0);
        }
    assert_true(analyse(mesh).closed);
    ty_mesh_destroy(mesh);
}

// The corner's normal is the diagonal however the faces are cut: what weighting by angle is for.
static void test_smooth_normals_do_not_depend_on_the_cut(void** state)
{
    (void)state;
    const float creases[] = {TY_PI, 1.6f};
    for (int i = 0; i < 2; i++)
    {
        ty_mesh* mesh = make_cube();
        ty_mesh_compute_normals(mesh, creases[i]);
        assert_int_equal(mesh->vertex_count, 8);
        for (uint32_t v = 0; v < 8; v++)
            assert_true(ty_dot(mesh->normals[v], ty_normalize(mesh->positions[v])) > 0.999999f);
        ty_mesh_destroy(mesh);
    }
}

// A seam of the uv (two vertices at one position) is no crease.
static void test_normals_agree_over_welds(void** state)
{
    (void)state;
    ty_mesh* mesh = make_ball(32, ty_vec3_make(0.03f, 0.02f, 0.01f));
    uint32_t before = mesh->vertex_count, seam = 0;
    ty_mesh_compute_normals(mesh, ty_radians(60.0f));
    assert_int_equal(mesh->vertex_count, before);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        seam += mesh->welds[i] != i;
        ty_vec3 p = mesh->positions[i];
        ty_vec3 exact = ty_normalize(ty_vec3_make(p.x / 9.0f, p.y / 4.0f, p.z));
        assert_true(memcmp(&mesh->normals[i], &mesh->normals[mesh->welds[i]], sizeof(ty_vec3)) == 0);
        assert_true(ty_dot(mesh->normals[i], exact) > 0.999f);
    }
    assert_true(seam > 10);
    ty_mesh_destroy(mesh);
}

// At pi even what only touches at a point is smooth; below, it is not.
static void test_touching_fans_share_a_normal_at_pi_only(void** state)
{
    (void)state;
    for (int sharp = 0; sharp < 2; sharp++)
    {
        ty_mesh* mesh = ty_mesh_create(5, 2);
        mesh->positions[1] = ty_vec3_make(1.0f, 0.0f, 0.0f);
        mesh->positions[2] = ty_vec3_make(0.0f, 1.0f, 0.0f);
        mesh->positions[3] = ty_vec3_make(0.0f, -1.0f, 0.0f);
        mesh->positions[4] = ty_vec3_make(0.0f, 0.0f, -1.0f);
        const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 3, 4}};
        memcpy(mesh->triangles, triangles, sizeof(triangles));
        ty_mesh_compute_normals(mesh, sharp ? 3.0f : TY_PI);
        assert_int_equal(mesh->vertex_count, sharp ? 6 : 5);
        ty_vec3 expected = sharp ? ty_vec3_make(0, 0, 1) : ty_normalize(ty_vec3_make(1, 0, 1));
        assert_true(ty_dot(mesh->normals[0], expected) > 0.999999f);
        ty_mesh_destroy(mesh);
    }
}

static void test_unused_vertices_get_unit_normals(void** state)
{
    (void)state;
    ty_mesh* mesh = make_cube();
    mesh->triangle_count = 1;
    ty_mesh_compute_normals(mesh, 0.5f);
    for (uint32_t i = 0; i < 8; i++)
        assert_float_equal(ty_length(mesh->normals[i]), 1.0f, 1e-6f);
    ty_mesh_destroy(mesh);
}

// --- topology ---

static void test_cube_topology(void** state)
{
    (void)state;
    ty_mesh* mesh = make_cube();
    ty_mesh_topology t = analyse(mesh);
    assert_int_equal(t.welded_vertices, 8);
    assert_int_equal(t.edges, 18);
    assert_int_equal(t.boundary_edges + t.nonmanifold_edges + t.misoriented_edges, 0);
    assert_int_equal(t.components, 1);
    assert_true(fabs(t.area - 24.0) < 1e-12 && fabs(t.volume - 8.0) < 1e-12);
    assert_true(t.closed && t.convex);
    ty_mesh_destroy(mesh);
}

static void test_open_flipped_and_inside_out_are_not_closed(void** state)
{
    (void)state;
    ty_mesh* mesh = make_cube();
    mesh->triangle_count = 10;
    ty_mesh_topology t = analyse(mesh);
    assert_true(t.boundary_edges == 4 && !t.closed && !t.convex);
    mesh->triangle_count = 12;
    flip(mesh, 3);
    t = analyse(mesh);
    assert_true(t.misoriented_edges == 3 && t.boundary_edges == 0 && !t.closed);
    for (uint32_t i = 0; i < 12; i++)
        if (i != 3)
            flip(mesh, i);
    t = analyse(mesh);
    assert_true(t.misoriented_edges == 0 && t.volume < 0.0 && !t.closed && !t.convex);
    ty_mesh_destroy(mesh);
}

static void test_fins_and_collapsed_triangles(void** state)
{
    (void)state;
    ty_mesh* cube = make_cube();
    ty_mesh* mesh = ty_mesh_create(9, 13);
    memcpy(mesh->positions, cube->positions, 8 * sizeof(ty_vec3));
    memcpy(mesh->triangles, cube->triangles, 12 * sizeof(*cube->triangles));
    mesh->positions[8] = ty_vec3_make(3.0f, 3.0f, 3.0f);
    const uint32_t fin[3] = {0, 1, 8};
    memcpy(mesh->triangles[12], fin, sizeof(fin));
    ty_mesh_compute_welds(mesh);
    ty_mesh_topology t = analyse(mesh);
    assert_true(t.nonmanifold_edges == 1 && t.boundary_edges == 2 && !t.closed);
    // Collapsed, the fin is no part of the surface.
    mesh->positions[8] = mesh->positions[1];
    ty_mesh_compute_welds(mesh);
    t = analyse(mesh);
    assert_true(t.edges == 18 && t.closed && t.convex);
    ty_mesh_destroy(mesh);
    ty_mesh_destroy(cube);
}

static void test_components_are_counted(void** state)
{
    (void)state;
    ty_mesh* cube = make_cube();
    ty_mesh* mesh = ty_mesh_create(16, 24);
    for (uint32_t i = 0; i < 16; i++)
        mesh->positions[i] = ty_add(cube->positions[i % 8], ty_vec3_make(i < 8 ? 0.0f : 5.0f, 0.0f, 0.0f));
    for (uint32_t i = 0; i < 72; i++)
        mesh->triangles[i / 3][i % 3] = cube->triangles[i / 3 % 12][i % 3] + (i < 36 ? 0 : 8);
    ty_mesh_compute_welds(mesh);
    ty_mesh_topology t = analyse(mesh);
    assert_true(t.components == 2 && t.closed && !t.convex && fabs(t.volume - 16.0) < 1e-12);
    ty_mesh_destroy(mesh);
    ty_mesh_destroy(cube);
}

static void test_fine_balls_are_convex_and_dents_are_not(void** state)
{
    (void)state;
    const int divisions[] = {8, 64, 512};
    for (int i = 0; i < 3; i++)
    {
        ty_mesh* mesh = make_ball(divisions[i], ty_vec3_make(0.0035f, 0.0013f, 0.0016f));
        assert_true(analyse(mesh).convex);
        // One vertex pressed in by little more than makes its surroundings hollow.
        const float pressed[] = {0.8f, 0.993f, 1.0f - 1.2e-4f};
        uint32_t w = mesh->welds[mesh->vertex_count / 3];
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            if (mesh->welds[v] == w)
                mesh->positions[v] = ty_mul(mesh->positions[v], pressed[i]);
        assert_true(analyse(mesh).closed && !analyse(mesh).convex);
        ty_mesh_destroy(mesh);
    }
}

// Edges that bend by almost pi have almost no sine: the bottom of a slit is concave, a blade's edge is convex.
static void test_slits_and_blades_are_told_apart(void** state)
{
    (void)state;
    const float width = 1e-5f;
    const ty_vec2 outline[7] = {{-1, 0}, {1, 0}, {1, 1}, {width, 1}, {0, 0.2f}, {-width, 1}, {-1, 1}};
    const uint32_t fan[5][3] = {{4, 5, 6}, {4, 6, 0}, {4, 0, 1}, {4, 1, 2}, {4, 2, 3}};
    ty_mesh* mesh = ty_mesh_create(14, 24);
    for (uint32_t i = 0; i < 14; i++)
        mesh->positions[i] = ty_vec3_make(outline[i % 7].x, outline[i % 7].y, i < 7 ? 1.0f : -1.0f);
    for (uint32_t i = 0; i < 7; i++)
    {
        uint32_t j = (i + 1) % 7, sides[2][3] = {{j, i, i + 7}, {j, i + 7, j + 7}};
        memcpy(mesh->triangles[2 * i], sides, sizeof(sides));
    }
    for (uint32_t i = 0; i < 10; i++)
        for (int k = 0; k < 3; k++)
            mesh->triangles[14 + i][k] = i < 5 ? fan[i][k] : fan[i - 5][2 - k] + 7;
    ty_mesh_compute_welds(mesh);
    assert_true(analyse(mesh).closed && !analyse(mesh).convex);
    ty_mesh_destroy(mesh);

    ty_mesh* blade = make_cube(); // its top drawn together to an edge
    for (uint32_t i = 0; i < 8; i++)
        blade->positions[i].x *= blade->positions[i].y > 0.0f ? 0.0f : 1e-5f;
    ty_mesh_compute_welds(blade);
    assert_true(analyse(blade).convex);
    ty_mesh_destroy(blade);
}

// --- copies, transforms, attributes ---

static void test_copy_is_deep(void** state)
{
    (void)state;
    ty_mesh* mesh = make_ball(16, ty_vec3_make(1.0f, 1.0f, 1.0f));
    ty_mesh_add_attribute(mesh, "x", 3)[5] = 7.0f;
    ty_mesh* copy = ty_mesh_copy(mesh);
    size_t n = mesh->vertex_count;
    assert_memory_equal(copy->positions, mesh->positions, n * sizeof(ty_vec3));
    assert_memory_equal(copy->uvs, mesh->uvs, n * sizeof(ty_vec2));
    assert_memory_equal(copy->welds, mesh->welds, n * sizeof(uint32_t));
    assert_memory_equal(copy->triangles, mesh->triangles, mesh->triangle_count * sizeof(*mesh->triangles));
    assert_memory_equal(copy->curvature_1, mesh->curvature_1, n * sizeof(float));
    assert_memory_equal(copy->direction_1, mesh->direction_1, n * sizeof(ty_vec3));
    ty_mesh_destroy(mesh);
    const ty_mesh_attribute* x = ty_mesh_find_attribute(copy, "x");
    assert_true(x && x->components == 3 && x->values[5] == 7.0f);
    ty_mesh_destroy(copy);
}

static void test_mirror_keeps_the_outside_out(void** state)
{
    (void)state;
    ty_mesh* mesh = make_ball(24, ty_vec3_make(1.0f, 2.0f, 3.0f));
    double volume = analyse(mesh).volume;
    ty_affine mirror = {{-2, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 0, 0}};
    ty_mesh_transform(mesh, &mirror);
    ty_mesh_topology t = analyse(mesh);
    assert_true(t.closed && t.convex && fabs(t.volume / volume - 2.0) < 1e-5);
    assert_float_equal(mesh->bounds.low.x, 3.0f, 1e-6f);
    assert_float_equal(mesh->bounds.high.x, 7.0f, 1e-6f);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        assert_true(ty_dot(mesh->normals[i], ty_sub(mesh->positions[i], ty_vec3_make(5.0f, 0.0f, 0.0f))) > 0.0f);
    ty_mesh_destroy(mesh);
}

static void test_attributes_are_found_again(void** state)
{
    (void)state;
    ty_mesh* mesh = make_cube();
    float* first = ty_mesh_add_attribute(mesh, "moisture", 1);
    for (int i = 0; i < 8; i++)
        assert_true(first[i] == 0.0f);
    first[7] = 0.5f;
    ty_mesh_add_attribute(mesh, "velocity", 3)[23] = 2.0f;
    assert_int_equal(mesh->attribute_count, 2);
    assert_ptr_equal(ty_mesh_add_attribute(mesh, "moisture", 1), first);
    assert_int_equal(mesh->attribute_count, 2);
    assert_true(ty_mesh_find_attribute(mesh, "moisture")->values[7] == 0.5f);
    assert_int_equal(ty_mesh_find_attribute(mesh, "velocity")->components, 3);
    assert_null(ty_mesh_find_attribute(mesh, "moist"));
    ty_mesh_destroy(mesh);
}

// --- material slots ---

static void test_slots_are_shared_by_name(void** state)
{
    (void)state;
    ty_mesh* meshes[3] = {make_cube(), make_cube(), make_cube()};
    assert_int_equal(ty_mesh_add_slot(meshes[0], "bark"), 0);
    assert_int_equal(ty_mesh_add_slot(meshes[0], "leaf"), 1);
    assert_int_equal(ty_mesh_add_slot(meshes[0], "bark"), 0);
    meshes[0]->slots = TY_ALLOC(uint16_t, 12);
    meshes[0]->slots[5] = 1;
    assert_int_equal(ty_mesh_add_slot(meshes[2], "leaf"), 0);
    assert_true(ty_mesh_share_slots(meshes, 3));
    for (int i = 0; i < 3; i++)
    {
        assert_int_equal(meshes[i]->slot_count, 3);
        assert_int_equal(ty_mesh_validate(meshes[i], "m", NULL), TY_OK);
    }
    assert_string_equal(meshes[0]->slot_names[meshes[0]->slots[5]], "leaf");
    assert_string_equal(meshes[0]->slot_names[meshes[0]->slots[6]], "bark");
    assert_string_equal(meshes[1]->slot_names[meshes[1]->slots[0]], "");
    assert_string_equal(meshes[2]->slot_names[meshes[2]->slots[11]], "leaf");
    ty_mesh* copy = ty_mesh_copy(meshes[0]);
    assert_true(copy->slots != meshes[0]->slots && copy->slots[5] == meshes[0]->slots[5]);
    assert_true(copy->slot_names[1] != meshes[0]->slot_names[1]);
    copy->slots[7] = 3;
    assert_invalid(copy, "triangle 7 has material slot 3 of 3");
    ty_mesh_destroy(copy);
    for (int i = 0; i < 3; i++)
        ty_mesh_destroy(meshes[i]);
}

static void test_slots_are_bounded(void** state)
{
    (void)state;
    ty_mesh* mesh = make_cube();
    for (int i = 0; i < TY_MESH_MAX_SLOTS; i++)
    {
        char name[16];
        snprintf(name, sizeof name, "s%d", i);
        assert_int_equal(ty_mesh_add_slot(mesh, name), i);
    }
    assert_int_equal(ty_mesh_add_slot(mesh, "one more"), -1);
    ty_mesh* meshes[2] = {mesh, make_cube()};
    assert_false(ty_mesh_share_slots(meshes, 2));
    assert_int_equal(meshes[1]->slot_count, 0);
    ty_mesh_destroy(meshes[1]);
    ty_mesh_destroy(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_validate_names_the_first_offender),
        cmocka_unit_test(test_validate_wants_area),
        cmocka_unit_test(test_create_survives_exhaustion),
        cmocka_unit_test(test_welds_join_equal_positions_only),
        cmocka_unit_test(test_sharp_edges_are_split),
        cmocka_unit_test(test_smooth_normals_do_not_depend_on_the_cut),
        cmocka_unit_test(test_normals_agree_over_welds),
        cmocka_unit_test(test_touching_fans_share_a_normal_at_pi_only),
        cmocka_unit_test(test_unused_vertices_get_unit_normals),
        cmocka_unit_test(test_cube_topology),
        cmocka_unit_test(test_open_flipped_and_inside_out_are_not_closed),
        cmocka_unit_test(test_fins_and_collapsed_triangles),
        cmocka_unit_test(test_components_are_counted),
        cmocka_unit_test(test_fine_balls_are_convex_and_dents_are_not),
        cmocka_unit_test(test_slits_and_blades_are_told_apart),
        cmocka_unit_test(test_copy_is_deep),
        cmocka_unit_test(test_mirror_keeps_the_outside_out),
        cmocka_unit_test(test_attributes_are_found_again),
        cmocka_unit_test(test_slots_are_shared_by_name),
        cmocka_unit_test(test_slots_are_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
