// SPDX-License-Identifier: Apache-2.0
// Foreign mesh formats: read through the child process, or refused with a reason.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/geometry/mesh_file.h>

static const char cube_obj[] = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n"
                               "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
static const char tetrahedron_stl[] =
    "solid t\n"
    "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 3 0\nvertex 3 0 0\nendloop\nendfacet\n"
    "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 3 0 0\nvertex 0 0 3\nendloop\nendfacet\n"
    "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 3\nvertex 0 3 0\nendloop\nendfacet\n"
    "facet normal 1 1 1\nouter loop\nvertex 3 0 0\nvertex 0 3 0\nvertex 0 0 3\nendloop\nendfacet\nendsolid t\n";

static void write_text(const char* path, const char* text)
{
    ty_error error;
    assert_int_equal(ty_file_write(path, text, strlen(text), &error), TY_OK);
}

static void check_solid(const char* path, uint32_t triangles, double volume, double area)
{
    ty_mesh* mesh;
    ty_error error;
    assert_int_equal(ty_mesh_read(path, &mesh, &error), TY_OK);
    assert_int_equal(mesh->triangle_count, triangles);
    ty_mesh_topology topology;
    ty_mesh_analyse(mesh, &topology);
    assert_true(topology.closed && topology.convex && topology.components == 1);
    assert_true(fabs(topology.volume - volume) < 1e-5 && fabs(topology.area - area) < 1e-4);
    ty_mesh_destroy(mesh);
}

static void solids_come_in_whole(void** state)
{
    (void)state;
    write_text("cube.obj", cube_obj);
    write_text("tetrahedron.stl", tetrahedron_stl);
    check_solid("cube.obj", 12, 8.0, 24.0);
    check_solid("tetrahedron.stl", 4, 4.5, 13.5 + 7.794228634);
}

// Slots in the order of use; a material that nothing uses is none; colours of vertices are kept.
static void slots_have_the_files_names(void** state)
{
    (void)state;
    write_text("slots.obj", "mtllib slots.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 1 1 0 1 1 1\n"
                            "usemtl Leaf\nf 1 2 3\nusemtl Bark\nf 2 4 3\n");
    write_text("slots.mtl", "newmtl Bark\nKd 1 0 0\nnewmtl Unused\nKd 0 1 0\nnewmtl Leaf\nKd 0 0 1\n");
    ty_mesh* mesh;
    ty_error error;
    assert_int_equal(ty_mesh_read("slots.obj", &mesh, &error), TY_OK);
    assert_int_equal(mesh->slot_count, 2);
    assert_int_equal(mesh->triangle_count, 2);
    for (uint32_t t = 0; t < 2; t++)
    {
        bool is_leaf = mesh->positions[mesh->triangles[t][0]].x + mesh->positions[mesh->triangles[t][1]].x +
                           mesh->positions[mesh->triangles[t][2]].x <
                       1.5f;
        assert_string_equal(mesh->slot_names[mesh->slots[t]], is_leaf ? "Leaf" : "Bark");
    }
    const ty_mesh_attribute* color = ty_mesh_find_attribute(mesh, "color");
    assert_true(color && color->components == 4 && color->space == TY_ATTRIBUTE_SRGB);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        bool at_origin = ty_length_sqr(mesh->positions[v]) == 0.0f;
        assert_true(!at_origin || (color->values[4 * v] == 1.0f && color->values[4 * v + 1] == 0.0f));
    }
    ty_mesh_destroy(mesh);
}

static void refused(const char* path, const char* says)
{
    ty_mesh* mesh = (ty_mesh*)1;
    ty_error error = {0};
    assert_int_equal(ty_mesh_read(path, &mesh, &error), TY_BAD_FILE);
    assert_null(mesh);
    assert_string_equal(error.file, path);
    if (!strstr(error.text, says))
    {
        print_error("%s: '%s'\n", path, error.text);
    }
    assert_non_null(strstr(error.text, says));
}

static void faults_are_named(void** state)
{
    (void)state;
    write_text("empty.obj", "");
    write_text("index.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n");
    write_text("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    write_text("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    write_text("cut.stl", "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0");
    refused("missing.obj", "no such file");
    refused("empty.obj", "");
    refused("index.obj", "");
    refused("points.obj", "");
    refused("flat.obj", "area");
    refused("cut.stl", "");
    refused("mesh.xyz", "unknown mesh type '.xyz'");
    refused("scene.glb", "");
    refused("missing.ply", "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solids_come_in_whole),
        cmocka_unit_test(slots_have_the_files_names),
        cmocka_unit_test(faults_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
