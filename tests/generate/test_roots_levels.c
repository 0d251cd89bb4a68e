// SPDX-License-Identifier: Apache-2.0
// Levels of detail of roots: each closed, a quarter of the one before, and not far from the first.
#include "base/cmocka_all.h"
#include <tsuya/generate/roots_recipe.h>
#include <tsuya/geometry/trace.h>

static ty_roots_recipe recipe_make(void)
{
    ty_roots_recipe r = ty_roots_recipe_default();
    r.host.kind = TY_ROOTS_HOST_BOX;
    r.host.shape.size = (ty_vec3){0.03f, 0.06f, 0.03f};
    r.host.shape.rounding = 0.0f;
    r.host.resolution = 96;
    r.tip = 1.2e-3f;
    r.detail = 0.6e-3f;
    r.count = 8;
    return r;
}

typedef struct levels
{
    ty_mesh* mesh[4];
    int count;
} levels;

static ty_status level_put(void* context, int level, ty_mesh* mesh, ty_error* error)
{
    levels* l = context;
    (void)error;
    assert_int_equal(level, l->count);
    l->mesh[l->count++] = ty_mesh_copy(mesh);
    return TY_OK;
}

// The farthest that a vertex of one, or the middle of its triangles, is from the other, m; and of its radius.
static float farthest(const ty_mesh* of, const ty_mesh* from, float* relative)
{
    ty_world* world;
    ty_world_def def = ty_world_def_default();
    ty_error error;
    uint32_t part;
    float most = 0.0f;
    const float* radius = ty_mesh_find_attribute(of, "radius")->values;
    *relative = 0.0f;
    assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
    assert_int_equal(ty_world_add_prototype(world, from, &part, &error), TY_OK);
    assert_int_equal(ty_world_commit(world, &error), TY_OK);
    for (uint32_t i = 0; i < of->vertex_count + of->triangle_count; i++)
    {
        ty_closest c;
        ty_vec3 p;
        if (i < of->vertex_count)
            p = of->positions[i];
        else
        {
            const uint32_t* t = of->triangles[i - of->vertex_count];
            p = ty_add(of->positions[t[0]], ty_add(of->positions[t[1]], of->positions[t[2]]));
            p = ty_mul(p, 1.0f / 3.0f);
        }
        assert_true(ty_world_closest(world, part, p, 0.02f, &c));
        most = ty_max(most, c.distance);
        uint32_t v = i < of->vertex_count ? i : of->triangles[i - of->vertex_count][0];
        *relative = ty_max(*relative, c.distance / radius[v]);
    }
    ty_world_destroy(world);
    return most;
}

static void levels_of(const ty_roots_recipe* recipe, levels* out)
{
    ty_made made = {.levels = {level_put, out}};
    ty_error error;
    *out = (levels){.count = 1};
    assert_int_equal(ty_roots_make_all(recipe, NULL, &made, &error), TY_OK);
    out->mesh[0] = made.mesh;
    assert_int_equal(out->count, recipe->levels);
}

static void levels_drop(levels* l)
{
    for (int i = 0; i < l->count; i++)
        ty_mesh_destroy(l->mesh[i]);
}

static void levels_of_the_surface(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_make();
    levels l;
    recipe.levels = 3;
    levels_of(&recipe, &l);
    for (int i = 1; i < l.count; i++)
    {
        ty_mesh_topology topology;
        float cell = recipe.detail * (float)(1 << i), relative, off = farthest(l.mesh[i], l.mesh[0], &relative);
        float miss = farthest(l.mesh[0], l.mesh[i], &relative);
        double share = (double)l.mesh[i - 1]->triangle_count / l.mesh[i]->triangle_count;
        ty_mesh_analyse(l.mesh[i], &topology);
        print_message("surface, level %d: %u triangles, 1 of %.2f, off by %.2f cells, misses %.2f\n", i,
                      l.mesh[i]->triangle_count, share, (double)(off / cell), (double)(miss / cell));
        assert_true(topology.closed);
        assert_int_equal(topology.components, 1);
        assert_true(share > 2.8 && share < 5.0);
        assert_true(off < 1.6f * cell && miss < 1.6f * cell);
    }
    levels_drop(&l);
}

static void levels_of_tubes(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_make();
    levels l;
    recipe.levels = 3;
    recipe.mesh = TY_ROOTS_TUBES;
    levels_of(&recipe, &l);
    for (int i = 1; i < l.count; i++)
    {
        ty_mesh_topology topology;
        float sag = 1.0f - ty_cos(TY_PI / (float)(recipe.tubes.divisions >> i));
        float off, miss;
        (void)farthest(l.mesh[i], l.mesh[0], &off);
        (void)farthest(l.mesh[0], l.mesh[i], &miss);
        double share = (double)l.mesh[i - 1]->triangle_count / l.mesh[i]->triangle_count;
        ty_mesh_analyse(l.mesh[i], &topology);
        print_message("tubes, level %d: %u triangles, 1 of %.2f, off by %.3f radii, misses %.3f; sag %.3f\n", i,
                      l.mesh[i]->triangle_count, share, (double)off, (double)miss, (double)sag);
        assert_true(topology.closed);
        assert_true(share > 3.0 && share < 5.0);
        assert_true(off < 0.6f + sag && miss < 0.6f + sag);
    }
    levels_drop(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_of_the_surface),
        cmocka_unit_test(levels_of_tubes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
