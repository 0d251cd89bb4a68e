// SPDX-License-Identifier: Apache-2.0
// Roots as tubes: each closed and alone, uv without stretch, files that hold all of it, growth.
#include "base/cmocka_all.h"
#include <math.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/generate/roots_recipe.h>
#include <tsuya/geometry/aggregate_export.h>
#include <tsuya/geometry/mesh_file.h>

static ty_roots_recipe recipe_for(int method)
{
    ty_roots_recipe r = ty_roots_recipe_default();
    r.host.kind = TY_ROOTS_HOST_BOX;
    r.host.shape.size = (ty_vec3){0.03f, 0.06f, 0.03f};
    r.host.shape.rounding = 0.0f;
    r.host.resolution = 96;
    r.tip = r.detail = 1.2e-3f;
    r.mesh = TY_ROOTS_TUBES;
    r.method = method;
    r.thesis.fall = 100.0f;
    r.count = method == TY_ROOTS_SEED ? 6 : 8;
    return r;
}

static ty_mesh* make(const ty_roots_recipe* recipe)
{
    ty_mesh* mesh;
    ty_error error = {0};
    ty_status status = ty_roots_make(recipe, NULL, &mesh, &error);
    if (status != TY_OK)
        print_message("%s\n", error.text);
    assert_int_equal(status, TY_OK);
    return mesh;
}

static const float* attribute(const ty_mesh* mesh, const char* name)
{
    const ty_mesh_attribute* found = ty_mesh_find_attribute(mesh, name);
    assert_non_null(found);
    return found->values;
}

// --- each a manifold ---

// The triangles of one root, by places alone.
static ty_mesh* root_of(const ty_mesh* mesh, int number)
{
    const float* root = attribute(mesh, "root");
    uint32_t count = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        count += (int)root[mesh->triangles[t][0]] == number;
    ty_mesh* out = ty_mesh_create(mesh->vertex_count, count);
    memcpy(out->positions, mesh->positions, mesh->vertex_count * sizeof(ty_vec3));
    count = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        if ((int)root[mesh->triangles[t][0]] == number)
            memcpy(out->triangles[count++], mesh->triangles[t], sizeof *mesh->triangles);
    ty_mesh_compute_welds(out);
    return out;
}

static void each_tube_is_closed(void** state)
{
    (void)state;
    for (int method = 0; method < 2; method++)
    {
        ty_roots_recipe recipe = recipe_for(method);
        ty_mesh* mesh = make(&recipe);
        const float* root = attribute(mesh, "root");
        ty_mesh_topology all;
        int tubes = 0, lines = 0;
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            lines = (int)root[v] + 1 > lines ? (int)root[v] + 1 : lines;
        for (int i = 0; i < lines; i++)
        {
            ty_mesh_topology own;
            ty_mesh* tube = root_of(mesh, i);
            if (tube->triangle_count > 0)
            {
                uint32_t corners = 0;
                bool* used = TY_ALLOC(bool, mesh->vertex_count);
                ty_mesh_analyse(tube, &own);
                assert_int_equal(own.boundary_edges, 0);
                assert_int_equal(own.nonmanifold_edges, 0);
                assert_int_equal(own.misoriented_edges, 0);
                assert_int_equal(own.components, 1);
                for (uint32_t t = 0; t < 3 * tube->triangle_count; t++)
                {
                    uint32_t v = tube->welds[tube->triangles[t / 3][t % 3]];
                    corners += !used[v];
                    used[v] = true;
                }
                ty_free(used);
                assert_int_equal((int)corners - (int)own.edges + (int)tube->triangle_count, 2); // a ball: both ends
                assert_true(own.volume > 0.0 || method == TY_ROOTS_SEED); // kinks turn themselves inside out
                tubes++;
            }
            ty_mesh_destroy(tube);
        }
        assert_true(tubes > 20 && tubes >= lines - 1);
        ty_mesh_analyse(mesh, &all); // nothing is welded to anything else
        assert_int_equal(all.components, tubes);
        assert_int_equal(all.boundary_edges + all.nonmanifold_edges + all.misoriented_edges, 0);
        ty_mesh_destroy(mesh);
    }
}

// --- uv ---

// Triangles are as large, and as long, on uv as they are in circumferences of their root.
static void strips_are_not_stretched(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_for(TY_ROOTS_WRAP);
    recipe.growth.flatten = 1.0f;
    recipe.tubes.junction = 0.0f;
    ty_mesh* mesh = make(&recipe);
    const float* radius = attribute(mesh, "radius");
    double good = 0.0, all = 0.0, sum = 0.0, shape = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        const uint32_t* c = mesh->triangles[t];
        const ty_vec2* uv = mesh->uvs;
        ty_vec3 p = mesh->positions[c[0]], a = ty_sub(mesh->positions[c[1]], p), b = ty_sub(mesh->positions[c[2]], p);
        double turn = 2.0 * M_PI * (double)(radius[c[0]] + radius[c[1]] + radius[c[2]]) / 3.0;
        double ax = (double)(uv[c[1]].x - uv[c[0]].x), ay = (double)(uv[c[1]].y - uv[c[0]].y);
        double bx = (double)(uv[c[2]].x - uv[c[0]].x), by = (double)(uv[c[2]].y - uv[c[0]].y);
        double flat = 0.5 * (ax * by - ay * bx) * turn * turn, area = 0.5 * (double)ty_length(ty_cross(a, b));
        double la = turn * sqrt(ax * ax + ay * ay), lb = turn * sqrt(bx * bx + by * by);
        double edges = fmax(fabs(log(la / (double)ty_length(a))), fabs(log(lb / (double)ty_length(b))));
        assert_true(flat > 0.0); // none is turned over
        all += area;
        sum += flat;
        good += fabs(log(flat / area)) < log(1.3) ? area : 0.0;
        shape += edges < log(1.3) ? area : 0.0;
    }
    print_message("uv: %.1f %% of the area within 1.3, edges of %.1f %%; whole %.3f\n", 100.0 * good / all,
                  100.0 * shape / all, sum / all);
    assert_true(good > 0.9 * all && shape > 0.9 * all); // bends are longer without than within
    assert_true(sum > 0.97 * all && sum < 1.03 * all);
    ty_mesh_destroy(mesh);
}

// --- the host ---

// Of our method, but for the trunk, which stands in it; the box and its floor as formulas.
static void they_go_no_deeper_than_sink(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_for(TY_ROOTS_WRAP);
    ty_vec3 half = recipe.host.shape.size;
    ty_mesh* mesh = make(&recipe);
    const float *radius = attribute(mesh, "radius"), *sink = attribute(mesh, "sink"), *root = attribute(mesh, "root");
    int sunk = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        ty_vec3 p = mesh->positions[v], q = {fabsf(p.x) - half.x, fabsf(p.y) - half.y, fabsf(p.z) - half.z};
        float inside = ty_min(ty_max(q.x, ty_max(q.y, q.z)), 0.0f);
        float height = ty_min(inside + ty_length(ty_max3(q, (ty_vec3){0.0f, 0.0f, 0.0f})), p.y + half.y);
        if (root[v] == 0.0f)
            continue;
        assert_true(-height <= (sink[v] + 0.05f) * radius[v]);
        sunk += height < -0.1f * radius[v];
    }
    assert_true(sunk > 100);
    ty_mesh_destroy(mesh);
}

// --- files, growth ---

static void files_hold_all_that_stands_at_vertices(void** state)
{
    (void)state;
    static const char* const names[] = {"radius", "sink", "root", "along", "age", "level", "join"};
    ty_roots_recipe recipe = recipe_for(TY_ROOTS_WRAP);
    ty_error error;
    ty_mesh *mesh, *read;
    recipe.tubes.color = (ty_rgb){0.4f, 0.2f, 0.1f};
    mesh = make(&recipe);
    for (int glb = 0; glb < 2; glb++)
    {
        const char* path = glb ? "roots_tubes.glb" : "roots_tubes.ply";
        assert_int_equal(ty_mesh_export(path, mesh, &error), TY_OK);
        assert_int_equal(ty_mesh_read(path, &read, &error), TY_OK);
        assert_int_equal(read->triangle_count, mesh->triangle_count);
        assert_non_null(read->uvs);
        for (size_t i = 0; i < sizeof names / sizeof *names; i++)
            (void)attribute(read, names[i]);
        const ty_mesh_attribute* color = ty_mesh_find_attribute(read, "color");
        assert_non_null(color);
        assert_int_equal(color->space, TY_ATTRIBUTE_LINEAR_SRGB);
        assert_float_equal(color->values[0], 0.5494f, 1e-3f); // ACEScg to Rec.709
        assert_float_equal(color->values[1], 0.1750f, 1e-3f);
        ty_mesh_destroy(read);
    }
    ty_mesh_destroy(mesh);
}

typedef struct frames
{
    ty_mesh* last;
    float* radius; // of the frame before
    int count;
} frames;

static ty_status frame_put(void* context, int frame, ty_mesh* mesh, ty_error* error)
{
    frames* f = context;
    const float* radius = attribute(mesh, "radius");
    (void)error;
    assert_int_equal(frame, ++f->count);
    if (!f->radius)
        f->radius = TY_ALLOC(float, mesh->vertex_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        assert_true(radius[v] >= f->radius[v]);
        f->radius[v] = radius[v];
    }
    ty_mesh_destroy(f->last);
    f->last = ty_mesh_copy(mesh);
    return TY_OK;
}

static ty_status frame_check(void* context, int frame, ty_mesh* mesh, ty_error* error)
{
    frames* f = context;
    ty_mesh_topology topology;
    (void)error;
    assert_int_equal(frame, ++f->count);
    ty_mesh_analyse(mesh, &topology);
    assert_int_equal(topology.boundary_edges + topology.nonmanifold_edges + topology.misoriented_edges, 0);
    return TY_OK;
}

static void tubes_grow_and_come_from_files(void** state)
{
    (void)state;
    for (int method = 0; method < 2; method++)
    {
        ty_roots_recipe recipe = recipe_for(method);
        ty_made made = {.wants_curves = true};
        ty_error error;
        frames f = {0};
        assert_int_equal(ty_roots_make_all(&recipe, NULL, &made, &error), TY_OK);
        ty_mesh* still = made.mesh;
        assert_int_equal(ty_file_write("roots_tubes_curves.ply", made.curves, strlen(made.curves), &error), TY_OK);
        ty_free(made.curves);
        recipe.curves = "roots_tubes_curves.ply";
        ty_mesh* again = make(&recipe);
        assert_int_equal(again->vertex_count, still->vertex_count);
        assert_memory_equal(again->positions, still->positions, still->vertex_count * sizeof(ty_vec3));
        recipe.curves = NULL;
        recipe.grow.frames = 5;
        made = (ty_made){.growth = {frame_put, &f}};
        assert_int_equal(ty_roots_make_all(&recipe, NULL, &made, &error), TY_OK);
        assert_int_equal(f.count, 5);
        assert_int_equal(f.last->vertex_count, still->vertex_count);
        assert_memory_equal(f.last->positions, still->positions, still->vertex_count * sizeof(ty_vec3));
        f.count = 0;
        recipe.grow.remesh = true; // tubes of what is there
        ty_free(f.radius);
        f.radius = NULL;
        made = (ty_made){.growth = {frame_check, &f}};
        assert_int_equal(ty_roots_make_all(&recipe, NULL, &made, &error), TY_OK);
        assert_int_equal(f.count, 5);
        recipe.levels = 2;
        assert_int_equal(ty_roots_make_all(&recipe, NULL, &made, &error), TY_BAD_INPUT);
        assert_non_null(strstr(error.text, "levels: 2"));
        ty_mesh_destroy(f.last);
        ty_mesh_destroy(again);
        ty_mesh_destroy(still);
        ty_free(f.radius);
    }
}

static ty_status level_put(void* context, int level, ty_mesh* mesh, ty_error* error)
{
    (void)error;
    assert_non_null(mesh);
    *(int*)context = level;
    return TY_OK;
}

static void memory_may_end_anywhere(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_for(TY_ROOTS_WRAP);
    ty_status status = TY_NO_MEMORY;
    recipe.count = 2;
    recipe.first.spacing = 0.0f;
    recipe.levels = 2;
    for (long i = 0; status != TY_OK && i < 200; i++)
    {
        ty_error error;
        int level = 0;
        ty_made made = {.levels = {level_put, &level}};
        ty_memory_fail_after(i);
        status = ty_roots_make_all(&recipe, NULL, &made, &error);
        ty_memory_fail_after(-1);
        assert_true(status == TY_OK ? made.mesh && level == 1 : status == TY_NO_MEMORY && !made.mesh);
        ty_mesh_destroy(made.mesh);
    }
    assert_int_equal(status, TY_OK);
}

static void odd_sections_are_refused(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_for(TY_ROOTS_WRAP);
    ty_mesh* mesh;
    ty_error error;
    recipe.tubes.divisions = 7;
    assert_int_equal(ty_roots_make(&recipe, NULL, &mesh, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "tubes.divisions: 7; an even number 4..128"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_tube_is_closed),
        cmocka_unit_test(strips_are_not_stretched),
        cmocka_unit_test(they_go_no_deeper_than_sink),
        cmocka_unit_test(files_hold_all_that_stands_at_vertices),
        cmocka_unit_test(tubes_grow_and_come_from_files),
        cmocka_unit_test(odd_sections_are_refused),
        cmocka_unit_test(memory_may_end_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
