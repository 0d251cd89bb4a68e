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
        assert_memory_equal(f.frames[i]->triangles, still->triangles,
                            still->triangle_count * sizeof(*still->triangles));
        for (uint32_t v = 0; v < still->vertex_count; v++)
        {
            assert_true(now[v] >= before[v]);
            thicker += now[v] > before[v];
        }
        assert_true(volume(f.frames[i]) > volume(f.frames[i - 1]));
    }
    for (uint32_t v = 0; v < still->vertex_count; v++)
        hidden += first[v] <= 0.02f * full[v];
    assert_true(thicker > still->vertex_count);
    assert_true(hidden > still->vertex_count / 2); // most has not come yet
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
        cmocka_unit_test(remeshed_frames_are_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
