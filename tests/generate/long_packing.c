// SPDX-License-Identifier: Apache-2.0
// How dense ellipsoids twice as long as wide pack: without friction at least .70 of the space, and the less the more
// friction there is. Volumes are those of the meshes.
#include "recipe_made.h"

static double packing(const char* mesh, float friction)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.element.kind = TY_ELEMENT_MESH;
    r.element.mesh = mesh;
    r.element.fit = 0.015f;
    r.element.variation = 0.0f;
    r.container.kind = TY_CONTAINER_BOX;
    r.container.shape.size = ty_vec3_make(0.019f, 0.02f, 0.019f);
    r.container.shape.rounding = 0.0f;
    r.fill.count = 700;
    r.fill.density = 0.54f;
    r.fill.heap = 0.0f;
    r.fill.sprinkle = 0.0f;
    r.settle.friction = friction;
    r.settle.rolling = friction > 0.0f ? 0.001f : 0.0f;
    r.settle.max_seconds = 2.5f;
    ty_aggregate* a = made(&r, NULL);
    double phi = metric(a, "phi");
    print_message("friction %.1f: phi %.4f (balls %.4f), contacts %.2f\n", (double)friction, phi,
                  metric(a, "phi_balls"), metric(a, "loaded"));
    ty_aggregate_destroy(a);
    return phi;
}

static void test_friction(void** state)
{
    (void)state;
    ty_shape_def def = ty_shape_def_default();
    def.kind = TY_SHAPE_ELLIPSOID;
    def.size = ty_vec3_make(3e-3f, 1.5e-3f, 1.5e-3f);
    def.divisions = 48;
    ty_mesh* mesh;
    ty_error error;
    assert_int_equal(ty_shape_create(&def, &mesh, &error), TY_OK);
    char path[] = "/tmp/tsuya_ellipsoid_XXXXXX.ply";
    mesh_keep(mesh, path);
    ty_mesh_destroy(mesh);
    const float frictions[] = {0.0f, 0.1f, 0.3f, 0.8f};
    double last = 1.0;
    for (int i = 0; i < 4; i++)
    {
        double phi = packing(path, frictions[i]);
        assert_true(phi < last - 0.003);
        assert_true(i > 0 || (phi >= 0.70 && phi < 0.76));
        last = phi;
    }
    assert_true(last > 0.53 && last < 0.66);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_friction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
