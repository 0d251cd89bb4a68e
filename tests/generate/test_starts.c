// SPDX-License-Identifier: Apache-2.0
// The starts of a pile: what each promises of overlaps, counts and repetition, and the targets of a fill.
#include "recipe_made.h"

static ty_aggregate_recipe small_box(void)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.container.kind = TY_CONTAINER_BOX;
    r.container.shape.size = ty_vec3_make(0.014f, 0.02f, 0.014f);
    r.container.shape.rounding = 0.0f;
    r.element.variants = 3;
    r.element.divisions = 6;
    r.fill.count = 160;
    r.fill.heap = 0.0f;
    r.fill.sprinkle = 0.0f;
    return r;
}

// The thesis takes out what overlaps and leaves nothing that does; with a larger threshold more stay, and overlap.
static void the_thesis_leaves_no_overlap(void** state)
{
    (void)state;
    ty_aggregate_recipe r = small_box();
    r.fill.start = TY_FILL_THESIS;
    ty_aggregate* a = made(&r, NULL);
    double removed = metric(a, "removed");
    assert_true(removed > 0.0 && removed < 160.0);
    assert_int_equal((int)a->instance_count, 160 - (int)removed);
    assert_true(metric(a, "start_overlap_max_percent") < 0.01);
    ty_aggregate_destroy(a);
    r.fill.thesis.remove = 1.05f;
    a = made(&r, NULL);
    assert_true(metric(a, "removed") < removed);
    assert_true(metric(a, "start_overlap_max_percent") > 1.0);
    ty_aggregate_destroy(a);
    r.fill.thesis.remove = 100.0f;
    a = made(&r, NULL);
    assert_int_equal((int)a->instance_count, 160);
    ty_aggregate_destroy(a);
}

// Most elements of a lattice have another at one and the same distance; hardly any of a filling that grew have.
static void a_lattice_repeats(void** state)
{
    (void)state;
    ty_aggregate_recipe r = small_box();
    r.fill.start = TY_FILL_LATTICE;
    r.element.variation = 0.0f;
    ty_aggregate* a = made(&r, NULL);
    assert_int_equal((int)a->instance_count, 160);
    assert_true(metric(a, "start_repeat_percent") > 60.0);
    assert_true(metric(a, "start_overlap_max_percent") < 1.0);
    ty_aggregate_destroy(a);
    r.fill.start = TY_FILL_INFLATE;
    a = made(&r, NULL);
    assert_true(metric(a, "start_repeat_percent") < 12.0);
    ty_aggregate_destroy(a);
}

// A level gives the count that a count would have given the level; the whole box holds what its volume says.
static void targets_agree(void** state)
{
    (void)state;
    ty_aggregate_recipe r = small_box();
    ty_aggregate* a = made(&r, NULL);
    double level = metric(a, "level_mm");
    ty_aggregate_destroy(a);
    r.fill.target = TY_FILL_LEVEL;
    r.fill.level = (float)(level * 1e-3) + r.container.shape.size.y;
    a = made(&r, NULL);
    assert_in_range(a->instance_count, 155, 165);
    ty_aggregate_destroy(a);
    r.fill.target = TY_FILL_DENSITY;
    r.fill.density = 0.3f;
    a = made(&r, NULL);
    float inside = 8.0f * 0.014f * 0.02f * 0.014f, grain = 3.4e-8f;
    assert_true((float)a->instance_count > 0.6f * 0.3f * inside / grain);
    assert_true((float)a->instance_count < 0.3f * inside / grain);
    ty_aggregate_destroy(a);
}

// Denser than anything packs: the bound that was found is named, and it can be packed.
static void the_bound_is_found(void** state)
{
    (void)state;
    ty_aggregate_recipe r = small_box();
    r.fill.density = 0.9f;
    ty_aggregate* out = NULL;
    ty_error error = {0};
    assert_int_equal(ty_aggregate_make(&r, NULL, &out, &error), TY_BAD_INPUT);
    const char* at = strstr(error.text, "pack to ");
    assert_non_null(at);
    double bound = atof(at + 8);
    assert_true(bound > 0.6 && bound < 0.85);
    r.fill.density = (float)bound - 0.03f;
    ty_aggregate_destroy(made(&r, NULL));
    r = small_box();
    r.container.kind = TY_CONTAINER_SPHERE;
    r.container.shape.radius = 0.012f;
    r.fill.start = TY_FILL_LATTICE;
    r.fill.count = 80;
    assert_refused(&r, "a lattice has", "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_thesis_leaves_no_overlap),
        cmocka_unit_test(a_lattice_repeats),
        cmocka_unit_test(targets_agree),
        cmocka_unit_test(the_bound_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
