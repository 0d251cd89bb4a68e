// SPDX-License-Identifier: Apache-2.0
// Elements of every kind: closed solids of known mass, met by their balls, the same from run to run; mixtures by ratio;
// what cannot be is refused.
#include "recipe_made.h"
#include <stdio.h>
#include <tsuya/base/file.h>
#include <tsuya/geometry/shape.h>
#include <tsuya/geometry/voxels.h>

static const ty_seed seed = {5};
static const int solids[] = {TY_ELEMENT_BALL, TY_ELEMENT_ICE,  TY_ELEMENT_GRAPE,
                             TY_ELEMENT_BEAN, TY_ELEMENT_TOFU, TY_ELEMENT_PEBBLE};

static ty_element_def def_of(int kind)
{
    ty_element_def def = ty_element_def_default();
    def.kind = kind;
    def.fit = 0.03f;
    return def;
}

static void element_make(const ty_element_def* def, int variant, ty_element* out)
{
    ty_error error;
    if (ty_element_init(def, seed, variant, out, &error) != TY_OK)
        fail_msg("%s", error.text);
}

static void closed_and_met(void** state)
{
    (void)state;
    static ty_element e;
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++)
        for (int v = 0; v < 3; v++)
        {
            ty_element_def def = def_of(solids[i]);
            element_make(&def, v, &e);
            ty_mesh_topology topology;
            ty_mesh_analyse(e.mesh, &topology);
            assert_true(topology.closed);
            assert_int_equal(topology.components, 1);
            assert_true(fabs(topology.volume / (double)e.volume - 1.0) < 1e-4);
            assert_true(topology.convex || (solids[i] != TY_ELEMENT_ICE && solids[i] != TY_ELEMENT_BALL));
            assert_true(e.fit_max <= def.fit * e.width);
            assert_in_range(e.ball_count, 1, 140);
            assert_non_null(e.mesh->curvature_1);
            ty_element_term(&e);
        }
}

// The worst distance over points that the fit has not seen: corners and middles of the triangles. Sharp corners of ice
// lie between its samples.
static void fit_holds_elsewhere(void** state)
{
    (void)state;
    static ty_element e;
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++)
    {
        ty_element_def def = def_of(solids[i]);
        element_make(&def, 1, &e);
        float worst = 0.0f;
        for (uint32_t t = 0; t < e.mesh->triangle_count; t++)
        {
            const uint32_t* c = e.mesh->triangles[t];
            ty_vec3 p = ty_add(e.mesh->positions[c[0]], ty_add(e.mesh->positions[c[1]], e.mesh->positions[c[2]]));
            float least = TY_FLOAT_MAX;
            for (int b = 0; b < e.ball_count; b++)
                least = ty_min(least, ty_length(ty_mad(ty_neg(e.balls[b].center), p, 1.0f / 3.0f)) - e.balls[b].radius);
            worst = ty_max(worst, fabsf(least));
        }
        assert_true(worst < 1.6f * def.fit * e.width);
        ty_element_term(&e);
    }
}

// And the other way round: no ball lies outside, or reaches farther than that beyond the surface, where no point of the
// surface would tell. Cultivars of long grains as well.
static void balls_stay_within(void** state)
{
    (void)state;
    static ty_element e;
    for (size_t i = 0; i < sizeof solids / sizeof *solids + 4; i++)
    {
        bool rice = i >= sizeof solids / sizeof *solids;
        ty_element_def def = def_of(rice ? TY_ELEMENT_RICE : solids[i]);
        def.cultivar = rice ? (int)(i - sizeof solids / sizeof *solids) : 0;
        def.notch = 0.0f;
        element_make(&def, 0, &e);
        ty_voxels field;
        ty_error error;
        float step = e.width / 40.0f;
        assert_int_equal(ty_voxels_from_mesh(e.mesh, step, step, &field, &error), TY_OK);
        assert_true(e.fit_max <= 0.0301f * e.width);
        for (int b = 0; b < e.ball_count; b++)
        {
            float inside = -ty_voxels_value(&field, e.balls[b].center);
            assert_true(inside > -0.02f * e.width);
            assert_true(e.balls[b].radius < inside + 0.05f * e.width);
        }
        ty_voxels_term(&field);
        ty_element_term(&e);
    }
}

// A box of 2 x 1 x .5 about a point off the origin, in metres.
static void box_write(const char* path, float scale, bool broken, bool open)
{
    ty_shape_def shape = ty_shape_def_default();
    shape.kind = TY_SHAPE_BOX;
    shape.size = ty_vec3_make(scale, 0.5f * scale, 0.25f * scale);
    shape.rounding = 0.0f;
    ty_mesh* mesh;
    ty_error error;
    assert_int_equal(ty_shape_create(&shape, &mesh, &error), TY_OK);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        mesh->positions[i] = ty_add(mesh->positions[i], ty_vec3_make(scale, 2.0f * scale, 0.0f));
    if (broken)
        mesh->positions[2].y = NAN;
    if (open)
        mesh->triangle_count--;
    assert_int_equal(ty_ply_write(path, mesh, &error), TY_OK);
    ty_mesh_destroy(mesh);
}

static void mesh_weighs_as_a_box(void** state)
{
    (void)state;
    static ty_element e;
    char path[64];
    (void)snprintf(path, sizeof path, "elements_box_%d.ply", (int)getpid());
    box_write(path, 0.01f, false, false);
    ty_element_def def = def_of(TY_ELEMENT_MESH);
    def.mesh = path;
    def.length = 0.01f; // half of the file's
    element_make(&def, 0, &e);
    assert_true(fabsf(e.volume / (0.01f * 0.005f * 0.0025f) - 1.0f) < 1e-4f);
    assert_true(fabsf(e.width - 0.005f) < 1e-6f);
    const double sides[3] = {0.01, 0.005, 0.0025};
    for (int i = 0; i < 3; i++)
    {
        double j = sides[(i + 1) % 3], k = sides[(i + 2) % 3], inverse = 12.0 / (j * j + k * k);
        assert_true(fabs((double)e.inverse_inertia[i] / inverse - 1.0) < 1e-4);
        assert_true(fabs((double)e.inverse_inertia[3 + i] / inverse) < 1e-4);
    }
    ty_vec3 middle = ty_mul(ty_add(e.mesh->bounds.low, e.mesh->bounds.high), 0.5f);
    assert_true(ty_length(middle) < 1e-7f);
    ty_element_term(&e);
    (void)remove(path);
}

static void same_again_and_each_its_own(void** state)
{
    (void)state;
    static ty_element a, b;
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++)
    {
        ty_element_def def = def_of(solids[i]);
        element_make(&def, 2, &a);
        element_make(&def, 2, &b);
        assert_int_equal(a.ball_count, b.ball_count);
        assert_memory_equal(a.balls, b.balls, sizeof a.balls[0] * (size_t)a.ball_count);
        assert_memory_equal(a.mesh->positions, b.mesh->positions, sizeof(ty_vec3) * a.mesh->vertex_count);
        ty_element_term(&b);
        element_make(&def, 3, &b);
        assert_true((a.volume == b.volume) == (solids[i] == TY_ELEMENT_BALL));
        ty_element_term(&a);
        ty_element_term(&b);
    }
}

static void cultivars_differ_in_length(void** state)
{
    (void)state;
    const double slender[] = {2.4, 4.3, 1.68, 2.06};
    for (int c = 0; c < 4; c++)
    {
        ty_element_def def = def_of(TY_ELEMENT_RICE);
        ty_error error;
        def.cultivar = c;
        assert_int_equal(ty_element_complete(&def, "element", &error), TY_OK);
        assert_true(fabs((double)(def.length / def.width) / slender[c] - 1.0) < 0.02);
    }
    ty_element_def bean = def_of(TY_ELEMENT_BEAN);
    ty_error error;
    bean.length = 0.008f; // half as long, half as wide
    assert_int_equal(ty_element_complete(&bean, "element", &error), TY_OK);
    assert_true(fabsf(bean.width - 0.0041f) < 1e-6f);
}

static ty_aggregate_recipe mixed(ty_element_def* defs, int count)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.elements = (ty_param_list){defs, count};
    r.container.shape.kind = TY_SHAPE_BOX;
    r.container.kind = TY_CONTAINER_BOX;
    r.container.shape.size = ty_vec3_make(0.025f, 0.02f, 0.025f);
    r.fill.count = 120;
    r.fill.density = 0.5f;
    r.fill.sweeps = 150;
    return r;
}

static void kinds_mix_by_ratio(void** state)
{
    (void)state;
    ty_element_def defs[3] = {def_of(TY_ELEMENT_BALL), def_of(TY_ELEMENT_ROE), def_of(TY_ELEMENT_RICE)};
    defs[0].length = 0.005f;
    defs[0].ratio = 3.0f;
    defs[2].ratio = 0.0f;
    defs[2].variants = 2;
    ty_aggregate_recipe r = mixed(defs, 3);
    r.settle.rolling = 0.05f;
    ty_aggregate* a = made(&r, NULL);
    int of[6] = {0};
    assert_int_equal(a->prototype_count, 6); // ball, membrane, two grains, white, yolk
    for (uint32_t i = 0; i < a->instance_count; i++)
        of[a->prototype_index[i]]++;
    assert_int_equal(of[0] + of[1], 120);
    assert_in_range(of[0], 75, 105);
    assert_int_equal(of[2] + of[3], 0);
    assert_true(of[4] == of[1] && of[5] == of[1]);
    assert_string_equal(a->prototypes[0]->slot_names[0], "ball");
    assert_string_equal(a->prototypes[5]->slot_names[0], "yolk");
    ty_aggregate_destroy(a);
}

static void flakes_pack_with_defaults(void** state)
{
    (void)state;
    ty_aggregate_recipe r = mixed(NULL, 0);
    r.element = def_of(TY_ELEMENT_ICE);
    r.element.variants = 4;
    r.element.fit = 0.0f;
    r.container.shape.size = ty_vec3_make(0.01f, 0.01f, 0.01f);
    r.fill.sprinkle = 0.0f;
    r.settle.max_seconds = 0.1f;
    ty_aggregate* a = NULL;
    ty_error error;
    ty_status status = ty_aggregate_make(&r, NULL, &a, &error);
    if (!a)
        fail_msg("%d: %s", (int)status, error.text);
    assert_int_equal(a->instance_count, 120);
    ty_aggregate_destroy(a);
}

// A count that follows from a density is one that goes in, also where few do.
static void few_go_in_by_density(void** state)
{
    (void)state;
    for (float radius = 0.03f; radius < 0.06f; radius += 0.004f)
    {
        ty_aggregate_recipe r = mixed(NULL, 0);
        r.element = def_of(TY_ELEMENT_BALL);
        r.element.length = 0.014f;
        r.container = ty_container_def_default();
        r.container.shape.radius = radius;
        r.container.shape.height = 0.025f;
        r.fill.target = TY_FILL_DENSITY;
        r.fill.heap = 0.014f;
        r.fill.sprinkle = 0.0f;
        r.settle.rolling = 0.05f;
        ty_aggregate* a = NULL;
        ty_error error;
        ty_status status = ty_aggregate_make(&r, NULL, &a, &error);
        if (!a)
            fail_msg("radius %g: %d: %s", (double)radius, (int)status, error.text);
        assert_true(a->instance_count >= 3);
        ty_aggregate_destroy(a);
    }
}

static void impossible_ones_are_refused(void** state)
{
    (void)state;
    char path[64];
    (void)snprintf(path, sizeof path, "elements_bad_%d.ply", (int)getpid());
    ty_element_def defs[2] = {def_of(TY_ELEMENT_BALL), def_of(TY_ELEMENT_MESH)};
    defs[0].ratio = 0.0f;
    ty_aggregate_recipe r = mixed(defs, 1);
    assert_refused(&r, "elements: the ratios sum to 0", "");
    defs[0].ratio = 1.0f;
    defs[0].length = 0.06f;
    assert_refused(&r, "60 x 60 mm", "");
    r = mixed(defs + 1, 1);
    assert_refused(&r, "elements[0].mesh: a path is needed", "");
    defs[1].mesh = path;
    assert_fails(&r, TY_BAD_FILE, "No such file", "");
    box_write(path, 0.01f, false, true);
    assert_refused(&r, "not a closed outward surface", "");
    box_write(path, 0.01f, true, false);
    assert_fails(&r, TY_BAD_FILE, "not finite", "");
    box_write(path, 10.0f, false, false);
    assert_refused(&r, "give a length of 0.1..500 mm", "");
    (void)remove(path);
}

// Two lots of one kind are told apart by slots of their own; the rest keep their kind's names.
static void slots_have_given_names(void** state)
{
    (void)state;
    ty_element_def defs[3] = {def_of(TY_ELEMENT_BALL), def_of(TY_ELEMENT_BALL), def_of(TY_ELEMENT_BALL)};
    for (int i = 0; i < 3; i++)
        defs[i].length = 0.005f;
    defs[0].slot = "unripe";
    defs[1].slot = "ripe";
    ty_aggregate_recipe r = mixed(defs, 3);
    ty_aggregate* a = made(&r, NULL);
    assert_string_equal(a->prototypes[0]->slot_names[0], "unripe");
    assert_string_equal(a->prototypes[1]->slot_names[0], "ripe");
    assert_string_equal(a->prototypes[2]->slot_names[0], "ball");
    ty_aggregate_destroy(a);
    r = mixed(defs, 0);
    r.element = defs[1];
    a = made(&r, NULL);
    assert_string_equal(a->prototypes[0]->slot_names[0], "ripe");
    ty_aggregate_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_and_met),
        cmocka_unit_test(fit_holds_elsewhere),
        cmocka_unit_test(balls_stay_within),
        cmocka_unit_test(flakes_pack_with_defaults),
        cmocka_unit_test(few_go_in_by_density),
        cmocka_unit_test(mesh_weighs_as_a_box),
        cmocka_unit_test(same_again_and_each_its_own),
        cmocka_unit_test(cultivars_differ_in_length),
        cmocka_unit_test(kinds_mix_by_ratio),
        cmocka_unit_test(slots_have_given_names),
        cmocka_unit_test(impossible_ones_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
