// SPDX-License-Identifier: Apache-2.0
// Grains of rice from fields: closed, met by their balls, of the volume that they swell to, porous as far as soaking
// opens them, and cut.
#include "base/cmocka_all.h"
#include <string.h>
#include <tsuya/generate/element.h>

static const ty_seed seed = {5};

static ty_element_def def_of(int cultivar)
{
    ty_element_def def = ty_element_def_default();
    def.model = TY_RICE_FIELD;
    def.cultivar = cultivar;
    def.grain.voxels = 24;
    def.divisions = 12;
    ty_error error;
    assert_int_equal(ty_element_complete(&def, "element", &error), TY_OK);
    return def;
}

static void grain_make(const ty_element_def* def, int variant, ty_element* out)
{
    ty_error error;
    if (ty_element_init(def, seed, variant, out, &error) != TY_OK)
        fail_msg("%s", error.text);
}

static double volume_of(const ty_element_def* def, int variant)
{
    static ty_element e;
    grain_make(def, variant, &e);
    double volume = (double)e.volume;
    ty_element_term(&e);
    return volume;
}

static void closed_and_met(void** state)
{
    (void)state;
    static ty_element e;
    for (int c = 0; c < 4; c++)
        for (int v = 0; v < 2; v++)
        {
            ty_element_def def = def_of(c);
            grain_make(&def, v, &e);
            ty_mesh_topology t;
            ty_mesh_analyse(e.mesh, &t);
            assert_true(t.closed);
            assert_int_equal(t.components, 1);
            assert_true(fabs(t.volume / (double)e.volume - 1.0) < 1e-4);
            assert_true(e.fit_max <= 0.03f * e.width);
            assert_in_range(e.ball_count, 8, 80);
            assert_non_null(e.mesh->curvature_1);
            ty_element_term(&e);
        }
}

// The balls and the mesh lie on one another: the mesh's vertices but those of dent and pores are near the union.
static void balls_lie_on_the_mesh(void** state)
{
    (void)state;
    static ty_element e;
    ty_element_def def = def_of(TY_CULTIVAR_JAPONICA);
    def.notch = 0.0f;
    def.grain.pores = 0;
    grain_make(&def, 3, &e);
    for (uint32_t i = 0; i < e.mesh->vertex_count; i++)
    {
        float least = TY_FLOAT_MAX;
        for (int b = 0; b < e.ball_count; b++)
            least = ty_min(least, ty_length(ty_sub(e.mesh->positions[i], e.balls[b].center)) - e.balls[b].radius);
        assert_true(fabsf(least) < 0.045f * e.width);
    }
    ty_element_term(&e);
}

// Without chance the volume is that of the swelling, and the sizes of the recipe are those of the cooked grain.
static void swells_by_volume(void** state)
{
    (void)state;
    ty_element_def def = def_of(TY_CULTIVAR_INDICA);
    def.variation = def.grain.unevenness = 0.0f;
    def.grain.bumps = def.grain.pores = 0;
    def.grain.smoothing = 0.0f;
    double own = volume_of(&def, 0);
    def.grain.swelling = 1.2f;
    assert_true(fabs(volume_of(&def, 0) / own - 1.0) < 1e-3);
    def.grain.swelling = 1.0f;
    assert_true(fabs(1.2 * volume_of(&def, 0) / own - 1.0) < 0.01);
    def.model = TY_RICE_FORMULA;
    assert_true(fabs(volume_of(&def, 0) / own - 1.0) < 0.01);
}

static void bumps_add_and_pores_take(void** state)
{
    (void)state;
    ty_element_def def = def_of(TY_CULTIVAR_JAPONICA);
    def.grain.voxels = 40;
    def.divisions = 40;
    def.grain.bumps = def.grain.pores = 0;
    def.grain.smoothing = 0.0f;
    double plain = volume_of(&def, 1);
    def.grain.bumps = 200;
    def.grain.bump_height = 0.1e-3f;
    double bumpy = volume_of(&def, 1);
    assert_true(bumpy > 1.015 * plain && bumpy < 1.1 * plain);
    def.grain.bumps = 0;
    def.grain.pores = 100;
    def.grain.pore_radius = 0.15e-3f;
    def.grain.open = 1.0f;
    double pitted = volume_of(&def, 1);
    double most = 100.0 * 4.19 * 3.375e-12 * 1.19; // of balls with that spread, of which .78 lie under the surface
    assert_true(pitted < plain - 0.55 * most && pitted > plain - 0.85 * most);
    def.grain.open = 0.0f; // under the skin they are not seen
    def.grain.soak = 120.0f;
    assert_true(fabs(volume_of(&def, 1) / plain - 1.0) < 2e-3);
    static ty_element e;
    def.grain.cut = 0.5f; // but in a section they are
    double with = volume_of(&def, 1);
    grain_make(&def, 1, &e);
    ty_mesh_topology t;
    ty_mesh_analyse(e.mesh, &t);
    assert_int_equal(t.boundary_edges + t.nonmanifold_edges + t.misoriented_edges, 0);
    assert_true(t.components > 5); // walls of cavities
    ty_element_term(&e);
    def.grain.pores = 0;
    double without = volume_of(&def, 1);
    assert_true(with < without - 0.25 * most);
    assert_true(without > 0.4 * plain && without < 0.6 * plain);
}

// The pores of Gan 2023, table 1, and how deep they reach.
static void soaking_opens_pores(void** state)
{
    (void)state;
    static const float minutes[] = {0.0f, 20.0f, 60.0f, 120.0f}, areas[] = {0.02f, 0.06f, 1.31f, 4.72f};
    for (int i = 0; i < 4; i++)
        assert_true(fabsf(ty_rice_pores_after(60.0f * minutes[i], 1e-3f).area * 1e12f / areas[i] - 1.0f) < 1e-3f);
    assert_true(fabsf(ty_rice_pores_after(0.0f, 1e-3f).depth - 1e-4f) < 1e-8f);
    assert_true(fabsf(ty_rice_pores_after(3600.0f, 1e-3f).depth - 2e-4f) < 1e-8f);
    assert_true(fabsf(ty_rice_pores_after(1e5f, 1e-3f).depth - 1e-3f) < 1e-8f);
    static ty_element e;
    ty_element_def def = def_of(TY_CULTIVAR_JAPONICA);
    def.grain.cut = 0.5f;
    for (int i = 0; i < 4; i++)
    {
        def.grain.soak = minutes[i];
        grain_make(&def, 0, &e);
        const float* pores = ty_mesh_find_attribute(e.mesh, "pores")->values;
        const float* depth = ty_mesh_find_attribute(e.mesh, "depth")->values;
        float skin = 0.0f, middle = 1.0f;
        for (uint32_t v = 0; v < e.mesh->vertex_count; v++)
        {
            skin = depth[v] < 0.02f ? ty_max(skin, pores[v]) : skin;
            middle = depth[v] > 0.7f ? ty_min(middle, pores[v]) : middle;
        }
        assert_true(fabsf(skin - sqrtf(areas[i] / 4.72f)) < 0.01f);
        assert_true(fabsf(middle - (i == 3 ? 1.0f : 0.0f)) < 0.01f);
        ty_element_term(&e);
    }
}

static void repeats_and_differs(void** state)
{
    (void)state;
    static ty_element a, b;
    ty_element_def def = def_of(TY_CULTIVAR_AROMATIC);
    grain_make(&def, 2, &a);
    grain_make(&def, 2, &b);
    assert_int_equal(a.mesh->vertex_count, b.mesh->vertex_count);
    assert_memory_equal(a.mesh->positions, b.mesh->positions, sizeof(ty_vec3) * a.mesh->vertex_count);
    assert_memory_equal(a.balls, b.balls, sizeof a.balls);
    ty_element_term(&b);
    grain_make(&def, 3, &b);
    assert_true(fabsf(a.volume / b.volume - 1.0f) > 1e-3f);
    ty_element_term(&a);
    ty_element_term(&b);
}

static void says_what_cannot_be(void** state)
{
    (void)state;
    static ty_element e;
    ty_error error;
    ty_element_def def = def_of(TY_CULTIVAR_JAPONICA);
    for (long n = 0; n < 24; n++)
    {
        ty_memory_fail_after(n);
        assert_int_equal(ty_element_init(&def, seed, 0, &e, &error), TY_NO_MEMORY);
        ty_memory_fail_after(-1);
        assert_null(e.mesh);
    }
    def.grain.swelling = 0.5f;
    assert_int_equal(ty_element_complete(&def, "element", &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "element.grain.swelling: 0.5; it is 0 or lies in 1..1.5"));
    def = def_of(TY_CULTIVAR_JAPONICA);
    def.grain.pores = 2000;
    def.grain.pore_radius = 5e-3f;
    assert_int_equal(ty_element_init(&def, seed, 0, &e, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "nothing of the solid is left"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_and_met),      cmocka_unit_test(balls_lie_on_the_mesh),
        cmocka_unit_test(swells_by_volume),    cmocka_unit_test(bumps_add_and_pores_take),
        cmocka_unit_test(soaking_opens_pores), cmocka_unit_test(repeats_and_differs),
        cmocka_unit_test(says_what_cannot_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
