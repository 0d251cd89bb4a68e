// SPDX-License-Identifier: Apache-2.0
// Growth as frames: nothing becomes thinner, it begins with a sprout, and the last frame is the still mesh.
#include "base/cmocka_all.h"
#include <string.h>
#include <tsuya/generate/roots_recipe.h>

enum
{
    FRAMES = 6,
};

typedef struct film
{
    ty_mesh* frames[FRAMES + 1]; // from 1
    int count;
} film;

static ty_status keep(void* context, int frame, ty_mesh* mesh, ty_error* error)
{
    film* f = context;
    (void)error;
    assert_int_equal(frame, ++f->count);
    f->frames[frame] = ty_mesh_copy(mesh);
    ty_mesh_compute_welds(f->frames[frame]);
    return TY_OK;
}

static ty_roots_recipe coarse(bool remesh)
{
    ty_roots_recipe recipe = ty_roots_recipe_default();
    recipe.tip = recipe.detail = 1.2e-3f;
    recipe.count = 5;
    recipe.host.resolution = 96;
    recipe.grow.frames = FRAMES;
    recipe.grow.remesh = remesh;
    return recipe;
}

static void film_make(const ty_roots_recipe* recipe, film* f, ty_mesh** still)
{
    ty_error error = {0};
    ty_made made = {.growth = {keep, f}};
    *f = (film){.count = 0};
    assert_int_equal(ty_roots_make_all(recipe, NULL, &made, &error), TY_OK);
    assert_null(made.mesh);
    assert_int_equal(f->count, FRAMES);
    assert_int_equal(ty_roots_make(recipe, NULL, still, &error), TY_OK);
}

static void film_term(film* f, ty_mesh* still)
{
    for (int i = 1; i <= f->count; i++)
        ty_mesh_destroy(f->frames[i]);
    ty_mesh_destroy(still);
}

static void same_mesh(const ty_mesh* a, const ty_mesh* b)
{
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->triangle_count, b->triangle_count);
    assert_memory_equal(a->positions, b->positions, a->vertex_count * sizeof(ty_vec3));
    assert_memory_equal(a->normals, b->normals, a->vertex_count * sizeof(ty_vec3));
    assert_memory_equal(a->uvs, b->uvs, a->vertex_count * sizeof(ty_vec2));
    assert_memory_equal(a->triangles, b->triangles, a->triangle_count * sizeof(*a->triangles));
    assert_int_equal(a->attribute_count, b->attribute_count);
    for (int k = 0; k < a->attribute_count; k++)
        assert_memory_equal(a->attributes[k].values, b->attributes[k].values, a->vertex_count * sizeof(float));
}

static double volume(const ty_mesh* mesh)
{
    ty_mesh_topology topology;
    ty_mesh_analyse(mesh, &topology);
    return topology.volume;
}

static void no_vertex_becomes_thinner(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse(false);
    film f;
    ty_mesh* still;
    film_make(&recipe, &f, &still);
    same_mesh(f.frames[FRAMES], still);
    uint32_t thicker = 0, hidden = 0;
    const float *full = ty_mesh_find_attribute(still, "radius")->values,
                *first = ty_mesh_find_attribute(f.frames[1], "radius")->values;
    for (int i = 2; i <= FRAMES; i++)
    {
        const float *before = ty_mesh_find_attribute(f.frames[i - 1], "radius")->values,
                    *now = ty_mesh_find_attribute(f.frames[i], "radius")->values;
        const float *bend = ty_mesh_find_attribute(f.frames[i], "curvature")->values,
                    *bent = ty_mesh_find_attribute(still, "curvature")->values;
        assert_memory_equal(f.frames[i]->triangles, still->triangles,
                            still->triangle_count * sizeof(*still->triangles));
        for (uint32_t v = 0; v < still->vertex_count; v++)
        {
            assert_true(now[v] >= before[v]);
            thicker += now[v] > before[v];
            if (now[v] > 0.01f * full[v])
                assert_float_equal(bend[v] * now[v], bent[v] * full[v], 1e-3f * (1.0f + fabsf(bent[v] * full[v])));
        }
        assert_true(volume(f.frames[i]) > volume(f.frames[i - 1]));
    }
    for (uint32_t v = 0; v < still->vertex_count; v++)
        hidden += first[v] <= 0.02f * full[v];
    assert_true(thicker > still->vertex_count);
    assert_true(hidden > still->vertex_count / 2); // most has not come yet
    film_term(&f, still);
}

static double triangle_area(const ty_mesh* mesh, uint32_t t)
{
    const uint32_t* c = mesh->triangles[t];
    ty_vec3 a = mesh->positions[c[0]];
    return 0.5 * (double)ty_length(ty_cross(ty_sub(mesh->positions[c[1]], a), ty_sub(mesh->positions[c[2]], a)));
}

// Of a frame: the area of triangles with a corner that has not come, those of which reach farther than what has come is
// wide, and of all.
typedef struct skins
{
    double waiting, stretched, all;
    int inverted; // triangles that face against the normals of all of their corners
} skins;

static skins measure(const ty_mesh* mesh, const ty_mesh* still)
{
    const float* radius = ty_mesh_find_attribute(mesh, "radius")->values;
    skins out = {0};
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        const uint32_t* c = mesh->triangles[t];
        double area = triangle_area(mesh, t);
        float least = ty_min(radius[c[0]], ty_min(radius[c[1]], radius[c[2]]));
        float most = ty_max(radius[c[0]], ty_max(radius[c[1]], radius[c[2]])), longer = 0.0f;
        for (int k = 0; k < 3; k++)
        {
            uint32_t a = c[k], b = c[(k + 1) % 3];
            longer = ty_max(longer, ty_length(ty_sub(mesh->positions[a], mesh->positions[b])) -
                                        ty_length(ty_sub(still->positions[a], still->positions[b])));
        }
        out.all += area;
        out.waiting += least == 0.0f ? area : 0.0;
        out.stretched += longer > 2.0f * most ? area : 0.0;
        ty_vec3 p = mesh->positions[c[0]];
        ty_vec3 n = ty_cross(ty_sub(mesh->positions[c[1]], p), ty_sub(mesh->positions[c[2]], p));
        out.inverted += area > 1e-10 && ty_dot(n, mesh->normals[c[0]]) < 0.0f &&
                        ty_dot(n, mesh->normals[c[1]]) < 0.0f && ty_dot(n, mesh->normals[c[2]]) < 0.0f;
    }
    return out;
}

// Between a root that is there and one that has not come, and between two that are still apart, no skin is held up.
static void nothing_spans_what_has_not_come(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse(false);
    film f;
    ty_mesh* still;
    film_make(&recipe, &f, &still);
    double whole = measure(still, still).all;
    for (int i = 1; i < FRAMES; i++)
    {
        skins s = measure(f.frames[i], still);
        print_message("  frame %d: %.4f of the area is there, %.4f waits, %.4f is stretched, %d inverted\n", i,
                      s.all / whole, s.waiting / whole, s.stretched / whole, s.inverted);
        assert_true(s.waiting < 0.025 * whole);
        assert_true(s.stretched < 0.07 * whole);
        assert_true(s.inverted * 100 < (int)still->triangle_count);
    }
    film_term(&f, still);
}

static void remeshed_frames_are_whole(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse(true);
    film f;
    ty_mesh* still;
    film_make(&recipe, &f, &still);
    same_mesh(f.frames[FRAMES], still);
    for (int i = 1; i <= FRAMES; i++)
    {
        ty_mesh_topology topology;
        ty_mesh_analyse(f.frames[i], &topology);
        assert_true(topology.closed);
        assert_int_equal(topology.components, 1);
        if (i > 1)
            assert_true(topology.volume > volume(f.frames[i - 1]));
    }
    assert_true(volume(f.frames[1]) < 0.2 * volume(still));
    film_term(&f, still);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_vertex_becomes_thinner),
        cmocka_unit_test(nothing_spans_what_has_not_come),
        cmocka_unit_test(remeshed_frames_are_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
