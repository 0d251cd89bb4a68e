// SPDX-License-Identifier: Apache-2.0
// Centre lines of roots as a file: what is written comes back, an edit moves the mesh, and mistakes are named in place.
#include "base/cmocka_all.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/generate/roots_recipe.h>

#define FILE_NAME "roots_curves.ply"

static ty_roots_recipe coarse(void)
{
    ty_roots_recipe recipe = ty_roots_recipe_default();
    recipe.tip = recipe.detail = 1.2e-3f;
    recipe.count = 5;
    return recipe;
}

static ty_made make(const ty_roots_recipe* recipe)
{
    ty_made made = {.wants_curves = true};
    ty_error error = {0};
    ty_status status = ty_roots_make_all(recipe, NULL, &made, &error);
    if (status != TY_OK)
        print_message("%s\n", error.text);
    assert_int_equal(status, TY_OK);
    assert_non_null(made.curves);
    return made;
}

static void made_term(ty_made* made)
{
    ty_mesh_destroy(made->mesh);
    ty_free(made->curves);
}

static void save(const char* text)
{
    ty_error error;
    assert_int_equal(ty_file_write(FILE_NAME, text, strlen(text), &error), TY_OK);
}

static void what_is_written_comes_back(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    ty_made grown = make(&recipe);
    save(grown.curves);
    recipe.curves = FILE_NAME;
    ty_made again = make(&recipe);
    assert_string_equal(grown.curves, again.curves);
    assert_int_equal(grown.mesh->vertex_count, again.mesh->vertex_count);
    assert_int_equal(grown.mesh->triangle_count, again.mesh->triangle_count);
    assert_memory_equal(grown.mesh->positions, again.mesh->positions, grown.mesh->vertex_count * sizeof(ty_vec3));
    assert_memory_equal(grown.mesh->normals, again.mesh->normals, grown.mesh->vertex_count * sizeof(ty_vec3));
    assert_memory_equal(grown.mesh->uvs, again.mesh->uvs, grown.mesh->vertex_count * sizeof(ty_vec2));
    assert_memory_equal(grown.mesh->triangles, again.mesh->triangles,
                        grown.mesh->triangle_count * sizeof(*grown.mesh->triangles));
    for (int a = 0; a < grown.mesh->attribute_count; a++)
        assert_memory_equal(grown.mesh->attributes[a].values, again.mesh->attributes[a].values,
                            grown.mesh->vertex_count * sizeof(float));
    made_term(&grown);
    made_term(&again);
}

// Two lines by hand: a stem that hangs beside the host, and a branch of it.
static const char header[] = "ply\nformat ascii 1.0\ncomment top 0.2\nelement vertex 5\n"
                             "property float x\nproperty float y\nproperty float z\n"
                             "property float nx\nproperty float ny\nproperty float nz\n"
                             "property float radius\nproperty float flat\nproperty float sink\n"
                             "property float along\nproperty float birth\nproperty int line\n"
                             "element line 2\nproperty int kind\nproperty int parent\nproperty int end\n"
                             "property uint key_low\nproperty uint key_high\nend_header\n";
static const char stem[] = "0.1 0.1 0 1 0 0 0.006 1 0 0.0 0.0 0\n"
                           "0.1 0.05 0 1 0 0 0.005 1 0 0.05 0.3 0\n"
                           "0.1 0.0 0 1 0 0 0.004 1 0 0.1 0.6 0\n";
static const char branch[] = "0.1 0.05 0 0 1 0 0.003 1 0 0.05 0.3 1\n"
                             "0.15 0.05 0 0 1 0 0.003 1 0 0.1 0.6 1\n";
static const char lines[] = "1 -1 -1 7 0\n3 0 -1 8 0\n";

// Written with one part in another's place.
static void save_parts(const char* stem_rows, const char* branch_rows, const char* line_rows)
{
    char text[4096];
    snprintf(text, sizeof text, "%s%s%s%s", header, stem_rows, branch_rows, line_rows);
    save(text);
}

static void a_network_by_hand_is_a_mesh(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    recipe.bark = 0.0f;
    recipe.curves = FILE_NAME;
    save_parts(stem, branch, lines);
    ty_made made = make(&recipe);
    ty_mesh_topology topology;
    ty_mesh_analyse(made.mesh, &topology);
    assert_true(topology.closed);
    assert_int_equal(topology.components, 1);
    assert_float_equal(made.mesh->bounds.high.x, 0.153f, 1e-3f); // the branch's end and its radius
    assert_float_equal(made.mesh->bounds.low.y, -0.004f, 1e-3f); // the stem's
    made_term(&made);
}

// Away from what it leaves and from its end the branch is a cylinder of 3 mm: its mean curvature is 1 / 6 mm.
static void a_straight_root_has_its_curvature(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    recipe.bark = 0.0f;
    recipe.detail = 0.5e-3f;
    recipe.curves = FILE_NAME;
    save_parts(stem, branch, lines);
    ty_made made = make(&recipe);
    const ty_mesh_attribute* curvature = ty_mesh_find_attribute(made.mesh, "curvature");
    assert_non_null(curvature);
    double sum = 0.0, worst = 0.0;
    int count = 0;
    for (uint32_t v = 0; v < made.mesh->vertex_count; v++)
        if (made.mesh->positions[v].x > 0.12f && made.mesh->positions[v].x < 0.145f)
        {
            double relative = (double)curvature->values[v] * 0.006;
            worst = fabs(relative - 1.0) > worst ? fabs(relative - 1.0) : worst;
            sum += relative;
            count++;
        }
    print_message("mean curvature %.4f / (2 r), off by %.3f at most, at %d vertices\n", sum / count, worst, count);
    assert_true(count > 1000);
    assert_true(fabs(sum / count - 1.0) < 0.01 && worst < 0.1);
    made_term(&made);
}

static void expect(int line, int column, const char* part)
{
    ty_roots_recipe recipe = coarse();
    ty_error error = {0};
    ty_made made = {0};
    recipe.curves = FILE_NAME;
    ty_status status = ty_roots_make_all(&recipe, NULL, &made, &error);
    if (!strstr(error.text, part) || error.line != line || error.column != column)
        print_message("%s:%d:%d: %s\n", error.file, error.line, error.column, error.text);
    assert_int_equal(status, TY_BAD_INPUT);
    assert_null(made.mesh);
    assert_non_null(strstr(error.file, FILE_NAME));
    assert_int_equal(error.line, line);
    assert_int_equal(error.column, column);
    assert_non_null(strstr(error.text, part));
}

static void mistakes_are_named_in_place(void** state)
{
    (void)state;
    save("a lie\n");
    expect(1, 1, "no PLY file");
    save("ply\nformat binary_little_endian 1.0\nend_header\n");
    expect(2, 1, "ascii");
    save("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n");
    expect(5, 0, "lacks the property 'y'");
    save_parts("0.1 0.1 0 1 0 0 -0.006 1 0 0.0 0.0 0\n", branch, lines);
    expect(24, 17, "radius: -0.006; it is a number 1e-06..10000");
    save_parts("0.1 nan 0 1 0 0 0.006 1 0 0.0 0.0 0\n", branch, lines);
    expect(24, 5, "y: nan");
    save_parts("0.1 0.1 0 1 0 0 0.006 1 0 0.0 0.0\n", branch, lines);
    expect(24, 34, "ends before its 'line'");
    save_parts("0.1 0.1 0 1 0 0 0.006 1 0 0.0 0.0 0 9\n", branch, lines);
    expect(24, 37, "more numbers");
    save_parts("0.1 0.1 0 0 0 0 0.006 1 0 0.0 0.0 0\n", branch, lines);
    expect(24, 1, "nx ny nz");
    save_parts(stem, "0.1 0.05 0 0 1 0 0.003 1 0 0.05 0.3 1\n0.15 0.05 0 0 1 0 0.003 1 0 0.01 0.6 1\n", lines);
    expect(28, 1, "out of order: along 0.01 after 0.05");
    save_parts(stem, "0.1 0.05 0 0 1 0 0.003 1 0 0.05 0.3 2\n0.15 0.05 0 0 1 0 0.003 1 0 0.1 0.6 2\n", lines);
    expect(27, 1, "line 2 after line 0");
    save_parts(stem, branch, "1 -1 -1 7 0\n3 5 -1 8 0\n");
    expect(30, 1, "its parent is line 5; it is -1 (none) or another of the lines 0..1");
    save_parts(stem, branch, "1 -1 -1 7 0\n3 1 -1 8 0\n");
    expect(30, 1, "its parent is line 1");
    save_parts(stem, branch, "1 -1 -1 7 0\n9 0 -1 8 0\n");
    expect(30, 1, "kind: 9; it is a whole number 0..5");
    save_parts(stem, "0.12 0.05 0 0 1 0 0.003 1 0 0.05 0.3 1\n0.15 0.05 0 0 1 0 0.003 1 0 0.1 0.6 1\n", lines);
    expect(30, 1, "begins 20 mm away from line 0, its parent; at most the radius there, 5 mm");
    save_parts(stem, branch, "1 -1 -1 7 0\n");
    expect(29, 0, "the file ends before the 2 rows of 'line'");
    // the stem comes out of its own branch
    save_parts("0.1 0.05 0 1 0 0 0.006 1 0 0.0 0.0 0\n0.1 0.02 0 1 0 0 0.005 1 0 0.05 0.3 0\n"
               "0.1 0.0 0 1 0 0 0.004 1 0 0.1 0.6 0\n",
               branch, "1 1 -1 7 0\n3 0 -1 8 0\n");
    expect(29, 1, "it is its own ancestor, by way of line 1");
    ty_roots_recipe recipe = coarse();
    ty_error error;
    ty_mesh* mesh;
    recipe.curves = "no_such_curves.ply";
    assert_int_equal(ty_roots_make(&recipe, NULL, &mesh, &error), TY_BAD_FILE);
}

static void cut_files_are_refused(void** state)
{
    (void)state;
    char text[4096];
    int size = snprintf(text, sizeof text, "%s%s%s%s", header, stem, branch, lines);
    ty_roots_recipe recipe = coarse();
    recipe.curves = FILE_NAME;
    for (int cut = 1; cut < size - 4; cut += 7) // the last number may be shorter
    {
        ty_error error;
        ty_mesh* mesh;
        assert_int_equal(ty_file_write(FILE_NAME, text, (size_t)cut, &error), TY_OK);
        ty_status status = ty_roots_make(&recipe, NULL, &mesh, &error);
        assert_true(status == TY_BAD_INPUT && error.text[0] && !mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_comes_back),
        cmocka_unit_test(a_network_by_hand_is_a_mesh),
        cmocka_unit_test(a_straight_root_has_its_curvature),
        cmocka_unit_test(mistakes_are_named_in_place),
        cmocka_unit_test(cut_files_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
