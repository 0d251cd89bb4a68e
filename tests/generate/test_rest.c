// SPDX-License-Identifier: Apache-2.0
// Small piles of rice and of roe come to rest and stay there; long_rest holds the large ones to the same bounds.
#include "rest_rows.h"

static void test_rice(void** state)
{
    (void)state;
    const rest_bounds bounds = {{0.55, 0.68}, {4.0, 7.0}};
    ty_aggregate_recipe r = rice_bowl(300);
    r.element.variants = 4;
    r.element.divisions = 6;
    ty_aggregate* a = made(&r, NULL);
    assert_at_rest("rice bowl", a, &bounds);
    assert_meshes_apart(a, NULL, 3e-3f, 5.0, 1.5);
    ty_aggregate_destroy(a);
}

static void test_roe(void** state)
{
    (void)state;
    const rest_bounds bounds = {{0.0, 0.66}, {2.0, 7.0}}; // too few for phi
    ty_aggregate_recipe r = roe_bowl(60);
    ty_aggregate* a = made(&r, NULL);
    assert_at_rest("roe bowl", a, &bounds);
    assert_meshes_apart(a, "membrane", 6.2e-3f, 3.0, 1.5);
    ty_aggregate_destroy(a);
}

// The measure itself: two balls of 4 mm, 3.9 mm apart.
static void test_known_overlap(void** state)
{
    (void)state;
    ty_shape_def def = ty_shape_def_default();
    def.kind = TY_SHAPE_SPHERE;
    def.radius = 2e-3f;
    def.divisions = 64;
    ty_aggregate* a = ty_aggregate_create(2, 1);
    ty_error error;
    assert_int_equal(ty_shape_create(&def, &a->prototypes[0], &error), TY_OK);
    for (int i = 0; i < 2; i++)
        a->transforms[i] = ty_affine_from_trs(ty_vec3_make(3.9e-3f * (float)i, 0.0f, 0.0f), ty_quat_identity(),
                                              ty_vec3_make(1.0f, 1.0f, 1.0f));
    mesh_overlap o = mesh_overlap_measure(a, NULL, 4e-3f);
    assert_true(fabsf(o.most - 0.025f) < 1e-3f && o.mean == o.most && o.pairs == 1.0f);
    a->transforms[1].t.x = 4.01e-3f;
    assert_true(mesh_overlap_measure(a, NULL, 4e-3f).most == 0.0f);
    ty_aggregate_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_overlap),
        cmocka_unit_test(test_rice),
        cmocka_unit_test(test_roe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
