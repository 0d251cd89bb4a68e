// SPDX-License-Identifier: Apache-2.0
// PLY: round trips, every property kept, and no count believed.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/geometry/mesh_file.h>

#define HEADER(format, vertices)                                                                                       \
    "ply\nformat " format " 1.0\ncomment made by hand\nelement vertex " vertices                                       \
    "\nproperty float x\nproperty float y\nproperty float z\n"
#define FACES(count) "element face " count "\nproperty list uchar int vertex_indices\nend_header\n"
#define TRIANGLE "0 0 0\n1 0 0\n0 1 0\n"

static ty_status read_text(const char* text, ty_mesh** mesh, ty_error* error)
{
    return ty_ply_read_memory("test.ply", text, strlen(text), mesh, error);
}

static void reads_polygons_and_properties(void** state)
{
    (void)state;
    const char* text = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
                       "property uchar red\nproperty double age\nelement face 1\nproperty uchar flag\n"
                       "property list uchar int vertex_index\nend_header\n"
                       "0 0 0 255 1.5\n2 0 0 0 2.5\r\n3 1 0 51 -3\n1 2 0 0 4e2\n-1 1 0 0 0\n7 5 0 1 2 3 4\n";
    ty_mesh* mesh;
    ty_error error;
    assert_int_equal(read_text(text, &mesh, &error), TY_OK);
    assert_int_equal(mesh->vertex_count, 5);
    assert_int_equal(mesh->triangle_count, 3);
    const ty_mesh_attribute* red = ty_mesh_find_attribute(mesh, "red");
    const ty_mesh_attribute* age = ty_mesh_find_attribute(mesh, "age");
    assert_non_null(red);
    assert_non_null(age);
    assert_true(red->values[0] == 1.0f && fabsf(red->values[2] - 0.2f) < 1e-6f);
    assert_true(age->values[2] == -3.0f && age->values[3] == 400.0f);
    assert_true(mesh->normals[0].z > 0.999f); // computed: the fan is flat and faces +z
    assert_true(mesh->bounds.low.x == -1.0f && mesh->bounds.high.y == 2.0f);
    ty_mesh_destroy(mesh);
}

static void colours_come_joined(void** state)
{
    (void)state;
    ty_mesh* mesh;
    ty_mesh* again;
    ty_error error;
    const char* bytes =
        HEADER("ascii", "3") "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                             "property uchar alpha\n" FACES("1") "0 0 0 255 0 51 255\n"
                                                                 "1 0 0 1 2 3 4\n0 1 0 9 8 7 6\n3 0 1 2\n";
    assert_int_equal(read_text(bytes, &mesh, &error), TY_OK);
    const ty_mesh_attribute* color = ty_mesh_find_attribute(mesh, "color");
    assert_non_null(color);
    assert_true(mesh->attribute_count == 1 && color->components == 4 && color->space == TY_ATTRIBUTE_SRGB);
    assert_true(color->values[0] == 1.0f && fabsf(color->values[2] - 0.2f) < 1e-6f);
    assert_true(fabsf(color->values[9] - 8.0f / 255.0f) < 1e-6f);
    assert_int_equal(ty_ply_write("color.ply", mesh, &error), TY_OK);
    assert_int_equal(ty_mesh_read("color.ply", &again, &error), TY_OK);
    assert_memory_equal(color->values, ty_mesh_find_attribute(again, "color")->values, 12 * sizeof(float));
    ty_mesh_destroy(again);
    ty_mesh_destroy(mesh);
    // floats are linear; a scalar called color keeps them apart
    const char* floats = HEADER("ascii", "3") "property float red\nproperty float green\nproperty float blue\n" FACES(
        "1") "0 0 0 1 0 .5\n1 0 0 1 2 3\n0 1 0 9 8 7\n3 0 1 2\n";
    assert_int_equal(read_text(floats, &mesh, &error), TY_OK);
    assert_int_equal(ty_mesh_find_attribute(mesh, "color")->space, TY_ATTRIBUTE_LINEAR_SRGB);
    ty_mesh_destroy(mesh);
    const char* clash = HEADER("ascii", "3") "property float color\nproperty float red\nproperty float green\n"
                                             "property float blue\n" FACES("1") "0 0 0 1 0 .5 1\n1 0 0 1 2 3 1\n"
                                                                                "0 1 0 9 8 7 1\n3 0 1 2\n";
    assert_int_equal(read_text(clash, &mesh, &error), TY_OK);
    assert_int_equal(ty_mesh_find_attribute(mesh, "color")->components, 1);
    assert_int_equal(mesh->attribute_count, 4);
    ty_mesh_destroy(mesh);
}

static void big_and_little_endian_agree(void** state)
{
    (void)state;
    static const char data[2][51] = {
        "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0\3\0\0\0\0\1\0\0\0\2\0\0\0",
        "\0\0\0\0\0\0\0\0\0\0\0\0\77\200\0\0\0\0\0\0\0\0\0\0\0\0\0\0\77\200\0\0\0\0\0\0\3\0\0\0\0\0\0\0\1\0\0\0\2"};
    static const char* const headers[2] = {HEADER("binary_little_endian", "3") FACES("1"),
                                           HEADER("binary_big_endian", "3") FACES("1")};
    for (int i = 0; i < 2; i++)
    {
        char bytes[512];
        size_t header = strlen(headers[i]);
        memcpy(bytes, headers[i], header);
        memcpy(bytes + header, data[i], 49);
        ty_mesh* mesh;
        ty_error error;
        assert_int_equal(ty_ply_read_memory("b.ply", bytes, header + 49, &mesh, &error), TY_OK);
        assert_true(mesh->positions[1].x == 1.0f && mesh->positions[2].y == 1.0f && mesh->triangles[0][2] == 2);
        ty_mesh_destroy(mesh);
        assert_int_equal(ty_ply_read_memory("b.ply", bytes, header + 48, &mesh, &error), TY_BAD_FILE);
        assert_non_null(strstr(error.text, "byte"));
    }
}

static void written_bytes_come_back(void** state)
{
    (void)state;
    ty_mesh* mesh;
    ty_mesh* again;
    ty_error error;
    const char* text =
        HEADER("ascii", "4") "property float weight\n" FACES("2") "0.1 0.2 0.30000001 1\n1 0 0 2\n0 1 "
                                                                  "-1e-20 3\n5 5 5 4\n3 0 1 2\n3 1 3 2\n";
    assert_int_equal(read_text(text, &mesh, &error), TY_OK);
    uint32_t count = mesh->vertex_count; // the sharp edge has split vertices
    mesh->uvs = TY_ALLOC(ty_vec2, count);
    mesh->uvs[3] = (ty_vec2){0.25f, 0.75f};
    char line[1200]; // far more than a line of a header may have
    memset(line, 'x', sizeof line);
    line[sizeof line - 1] = 0;
    assert_null(mesh->recipe);
    mesh->hash = ty_string_copy("00ff");
    mesh->recipe = ty_string_format("tsuya: 1\n\n  odd: ' end_header '\n%s\n", line);
    assert_int_equal(ty_ply_write("round.ply", mesh, &error), TY_OK);
    assert_int_equal(ty_mesh_read("round.ply", &again, &error), TY_OK);
    assert_memory_equal(mesh->positions, again->positions, count * sizeof(ty_vec3));
    assert_memory_equal(mesh->normals, again->normals, count * sizeof(ty_vec3));
    assert_memory_equal(mesh->uvs, again->uvs, count * sizeof(ty_vec2));
    assert_memory_equal(mesh->triangles, again->triangles, 2 * sizeof mesh->triangles[0]);
    assert_memory_equal(ty_mesh_find_attribute(mesh, "weight")->values, ty_mesh_find_attribute(again, "weight")->values,
                        count * sizeof(float));
    assert_string_equal(again->recipe, mesh->recipe);
    assert_string_equal(again->hash, "00ff");
    assert_int_equal(ty_ply_write("round2.ply", again, &error), TY_OK);
    ty_bytes a, b;
    assert_int_equal(ty_file_read("round.ply", 1 << 20, &a, &error), TY_OK);
    assert_int_equal(ty_file_read("round2.ply", 1 << 20, &b, &error), TY_OK);
    assert_int_equal(a.size, b.size);
    assert_memory_equal(a.data, b.data, a.size);
    ty_bytes_term(&a);
    ty_bytes_term(&b);
    ty_mesh_destroy(mesh);
    ty_mesh_destroy(again);
}

static void faults_are_named(void** state)
{
    (void)state;
    static const struct
    {
        const char* text;
        const char* says;
        int line;
    } cases[] = {
        {"", "empty", 0},
        {"plx\n", "does not begin", 1},
        {"ply\nformat ascii 1.0\nelement vertex 3\n", "does not end", 3},
        {"ply\nformat binary 1.0\nend_header\n", "unknown format", 2},
        {"ply\nformat ascii 1.0\nelement vertex -3\nend_header\n", "not a count", 3},
        {"ply\nformat ascii 1.0\nproperty float x\nend_header\n", "before any element", 3},
        {"ply\nformat ascii 1.0\nelement vertex 3\nproperty half x\nend_header\n", "unknown type", 4},
        {"ply\nformat ascii 1.0\nwhat\nend_header\n", "not a PLY header line", 3},
        {HEADER("ascii", "3") "property float x\n" FACES("1") TRIANGLE, "twice", 8},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n" FACES("1") "0\n3 0 0 0\n", "x, y and z", 8},
        {HEADER("ascii", "100") FACES("1") TRIANGLE, "cannot be", 11},
        {HEADER("ascii", "180000000") FACES("1") TRIANGLE, "cannot be", 11},
        {HEADER("ascii", "3") FACES("180000000") TRIANGLE "3 0 1 2\n", "cannot be", 13},
        {HEADER("ascii", "0") FACES("0"), "no vertices", 11},
        {HEADER("ascii", "3") FACES("0") TRIANGLE, "no faces", 0},
        {HEADER("ascii", "3") FACES("1") "0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n", "not a number", 12},
        {HEADER("ascii", "3") FACES("1") "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "not finite", 12},
        {HEADER("ascii", "3") FACES("1") TRIANGLE "3 0 1 3\n", "within 0..2", 14},
        {HEADER("ascii", "3") FACES("1") TRIANGLE "3 0 1 -1\n", "within 0..2", 14},
        {HEADER("ascii", "3") FACES("1") TRIANGLE "2 0 1\n", "corners", 14},
        {HEADER("ascii", "3") FACES("1") TRIANGLE "3 0 1\n", "ends too early", 15},
        {HEADER("ascii", "3") FACES("1") "0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n", "area", 0},
        {HEADER("ascii", "3") "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" TRIANGLE
                              "3 0 1 2\n",
         "strips", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    {
        ty_mesh* mesh = (ty_mesh*)1;
        ty_error error = {0};
        ty_status status = read_text(cases[i].text, &mesh, &error);
        if (status != TY_BAD_FILE || !strstr(error.text, cases[i].says) ||
            (cases[i].line && error.line != cases[i].line))
        {
            print_error("case %zu: status %d line %d text '%s'\n", i, status, error.line, error.text);
        }
        assert_int_equal(status, TY_BAD_FILE);
        assert_null(mesh);
        assert_non_null(strstr(error.text, cases[i].says));
        assert_true(cases[i].line == 0 || error.line == cases[i].line);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_polygons_and_properties),
        cmocka_unit_test(colours_come_joined),
        cmocka_unit_test(big_and_little_endian_agree),
        cmocka_unit_test(written_bytes_come_back),
        cmocka_unit_test(faults_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
