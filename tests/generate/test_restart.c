// SPDX-License-Identifier: Apache-2.0
// A pile and an aggregate that go on from what was kept: to the bit what one run gives, for any number of threads.
// Damaged states and those of another recipe are refused.
#include "recipe_made.h"
#include <tsuya/base/workers.h>
#include <tsuya/generate/pile.h>

enum
{
    VARIANTS = 3,
    GRAINS = 150,
};

static ty_element grains[VARIANTS];

static int group_setup(void** state)
{
    (void)state;
    ty_element_def def = ty_element_def_default();
    ty_error error;
    for (int i = 0; i < VARIANTS; i++)
        assert_int_equal(ty_element_init(&def, (ty_seed){5}, i, &grains[i], &error), TY_OK);
    return 0;
}

static int group_teardown(void** state)
{
    (void)state;
    for (int i = 0; i < VARIANTS; i++)
        ty_element_term(&grains[i]);
    return 0;
}

// --- a pile ---

static ty_container* bowl_make(void)
{
    ty_container_def def = ty_container_def_default();
    set_bowl(&def.shape, 0.024f, 0.021f, 0.0018f, 0.010f, 0.003f);
    ty_container* bowl;
    ty_error error;
    assert_int_equal(ty_container_create(&def, NULL, &bowl, &error), TY_OK);
    return bowl;
}

static ty_wall_motion rocking(void* context, int wall, float seconds)
{
    (void)context;
    (void)wall;
    float angle = 0.2f * ty_sin(10.0f * seconds), rate = 2.0f * ty_cos(10.0f * seconds);
    return (ty_wall_motion){.rotation = ty_quat_axis_angle((ty_vec3){0, 0, 1}, angle), .spin = {0, 0, rate}};
}

static ty_pile* pile_make(const ty_container* bowl, bool wet, bool rocks)
{
    ty_pile_def def = ty_pile_def_default();
    def.grains = grains;
    def.grain_count = VARIANTS;
    def.container = bowl;
    def.rolling = 0.02f;
    if (wet)
        def.bridge = ty_bridge_of_moisture(0.5f);
    ty_pile* pile = ty_pile_create(&def);
    if (rocks)
        ty_pile_move_walls(pile, rocking, NULL);
    return pile;
}

static void pile_pour(ty_pile* pile)
{
    ty_rng rng = ty_rng_make((ty_seed){3}, 0, 0);
    for (uint32_t i = 0; i < GRAINS; i++)
    {
        ty_vec3 axis = ty_normalize((ty_vec3){ty_rng_range(&rng, -1, 1), 1.0f, ty_rng_range(&rng, -1, 1)});
        ty_body body = {.position = {0.008f * (float)(i % 4) - 0.012f, 0.012f + 0.0045f * (float)(i / 16),
                                     0.008f * (float)(i / 4 % 4) - 0.012f},
                        .rotation = ty_quat_axis_angle(axis, ty_rng_range(&rng, 0.0f, 3.0f)),
                        .scale = ty_rng_range(&rng, 0.9f, 1.1f),
                        .grain = i % VARIANTS};
        ty_pile_add(pile, &body, 1);
    }
}

static void assert_same_piles(const ty_pile* a, const ty_pile* b)
{
    assert_int_equal(ty_pile_count(a), ty_pile_count(b));
    assert_true(ty_pile_time(a) == ty_pile_time(b));
    assert_memory_equal(ty_pile_bodies(a), ty_pile_bodies(b), (size_t)ty_pile_count(a) * sizeof(ty_body));
}

static ty_pile* copy_make(const ty_pile* pile, const ty_container* bowl, bool wet, bool rocks, ty_workers* workers)
{
    ty_bytes bytes;
    ty_error error;
    assert_int_equal(ty_pile_save(pile, &bytes, &error), TY_OK);
    ty_pile* copy = pile_make(bowl, wet, rocks);
    assert_int_equal(ty_pile_restore(copy, bytes.data, bytes.size, workers, &error), TY_OK);
    ty_bytes again;
    assert_int_equal(ty_pile_save(copy, &again, &error), TY_OK);
    assert_int_equal(again.size, bytes.size);
    assert_memory_equal(again.data, bytes.data, bytes.size);
    ty_bytes_term(&bytes);
    ty_bytes_term(&again);
    return copy;
}

static void steps(ty_pile* pile, int count, ty_workers* workers)
{
    for (int i = 0; i < count; i++)
        ty_pile_step(pile, workers);
}

// Falling, hitting and lying; dry, wet, in a bowl that rocks, and bent; right after some were taken out as well.
static void piles_go_on(void** state)
{
    (void)state;
    ty_container* bowl = bowl_make();
    ty_workers* workers;
    ty_error error;
    assert_int_equal(ty_workers_create(3, &workers, &error), TY_OK);
    for (int kind = 0; kind < 4; kind++)
    {
        ty_pile* pile = pile_make(bowl, kind == 1, kind == 2);
        pile_pour(pile);
        for (int i = 0; i < GRAINS && kind == 3; i += 3)
        {
            ty_affine map = {{1.2f, 0.1f, 0}, {0.05f, 0.9f, 0}, {0, -0.1f, 0.95f + 0.001f * (float)i}, {0, 0, 0}};
            ty_pile_bend(pile, i, &map);
        }
        for (int part = 0; part < 4; part++)
        {
            steps(pile, 73 + 40 * part, NULL);
            if (part == 2)
            {
                bool gone[GRAINS] = {[3] = true, [90] = true};
                ty_pile_remove(pile, gone);
            }
            ty_pile* copy = copy_make(pile, bowl, kind == 1, kind == 2, part % 2 ? workers : NULL);
            assert_same_piles(pile, copy);
            steps(copy, 120, part % 2 ? workers : NULL);
            steps(pile, 120, NULL);
            assert_same_piles(pile, copy);
            ty_pile_destroy(copy);
        }
        ty_pile_destroy(pile);
    }
    ty_workers_destroy(workers);
    ty_container_destroy(bowl);
}

// A settling that time ended, while some slept, and the same without an end.
static void settling_goes_on(void** state)
{
    (void)state;
    ty_container* bowl = bowl_make();
    ty_pile *whole = pile_make(bowl, false, false), *held = pile_make(bowl, false, false);
    pile_pour(whole);
    pile_pour(held);
    assert_int_equal(ty_pile_settle(whole, 3.0f, NULL, NULL), TY_PILE_REST);
    ty_pile_end end = TY_PILE_TIME;
    for (float until = 0.1f; end == TY_PILE_TIME && until < 2.0f; until += 0.0171f) // between any two checks
    {
        ty_pile* copy = copy_make(held, bowl, false, false, NULL);
        end = ty_pile_settle_on(copy, until, NULL, NULL);
        ty_pile_destroy(held);
        held = copy;
        ty_pile_metrics metrics;
        ty_pile_measure(held, &metrics, NULL); // leaves no trace
    }
    assert_int_equal(end, TY_PILE_REST);
    assert_same_piles(whole, held);
    assert_int_equal(ty_pile_settle_on(held, 3.0f, NULL, NULL), TY_PILE_REST);
    assert_same_piles(whole, held);
    ty_pile_destroy(whole);
    ty_pile_destroy(held);
    ty_container_destroy(bowl);
}

static void damaged_piles(void** state)
{
    (void)state;
    ty_container* bowl = bowl_make();
    ty_pile* pile = pile_make(bowl, true, false);
    pile_pour(pile);
    steps(pile, 300, NULL);
    ty_bytes bytes;
    ty_error error;
    assert_int_equal(ty_pile_save(pile, &bytes, &error), TY_OK);
    for (size_t size = 0; size < bytes.size; size += size < 64 ? 1 : 977)
    {
        ty_pile* copy = pile_make(bowl, true, false);
        uint8_t* cut = ty_alloc(size, 1); // its own, so that reads beyond it are seen
        memcpy(cut, bytes.data, size);
        assert_int_equal(ty_pile_restore(copy, cut, size, NULL, &error), TY_BAD_FILE);
        ty_free(cut);
        ty_pile_destroy(copy);
    }
    ty_rng rng = ty_rng_make((ty_seed){8}, 0, 0);
    int refused = 0;
    for (int i = 0; i < 400; i++)
    {
        size_t at = i < 52 ? (size_t)i : ty_rng_u32(&rng) % bytes.size;
        uint8_t was = bytes.data[at];
        bytes.data[at] ^= (uint8_t)(1u << (ty_rng_u32(&rng) % 8));
        ty_pile* copy = pile_make(bowl, true, false);
        ty_status status = ty_pile_restore(copy, bytes.data, bytes.size, NULL, &error);
        assert_true(status == TY_OK || status == TY_BAD_FILE);
        refused += status == TY_BAD_FILE;
        if (status == TY_OK && i % 8 == 0)
            steps(copy, 2, NULL);
        ty_pile_destroy(copy);
        bytes.data[at] = was;
    }
    assert_true(refused > 40);
    ty_bytes_term(&bytes);
    ty_pile_destroy(pile);
    // Of a bowl that rocks.
    pile = pile_make(bowl, false, true);
    pile_pour(pile);
    assert_int_equal(ty_pile_save(pile, &bytes, &error), TY_OK);
    ty_pile* copy = pile_make(bowl, false, false);
    assert_int_equal(ty_pile_restore(copy, bytes.data, bytes.size, NULL, &error), TY_BAD_FILE);
    assert_non_null(strstr(error.text, "moving walls"));
    ty_bytes_term(&bytes);
    ty_pile_destroy(pile);
    ty_pile_destroy(copy);
    ty_container_destroy(bowl);
}

// --- an aggregate ---

static ty_layer_def eggs(void)
{
    ty_layer_def layer;
    ty_layer_params()->set_default(&layer);
    layer.element.kind = TY_ELEMENT_ROE;
    layer.fill.count = 8;
    return layer;
}

static ty_aggregate_recipe small_box(ty_layer_def* layers, int count)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.container.kind = TY_CONTAINER_BOX;
    r.container.shape.size = ty_vec3_make(0.03f, 0.02f, 0.03f);
    r.container.shape.rounding = 0.0f;
    r.element.variants = VARIANTS;
    r.element.divisions = 8;
    r.fill.count = 120;
    r.fill.heap = 2e-3f;
    r.settle.rolling = 0.05f;
    r.settle.state = true;
    r.layers = (ty_param_list){layers, count};
    return r;
}

static void assert_same_aggregates(const ty_aggregate* a, const ty_aggregate* b)
{
    assert_int_equal(a->instance_count, b->instance_count);
    assert_int_equal(a->prototype_count, b->prototype_count);
    assert_memory_equal(a->transforms, b->transforms, a->instance_count * sizeof(ty_affine));
    assert_memory_equal(a->prototype_index, b->prototype_index, a->instance_count * sizeof(uint32_t));
    assert_int_equal(a->attribute_count, b->attribute_count);
    for (int i = 0; i < a->attribute_count; i++)
        assert_memory_equal(a->attributes[i].values, b->attributes[i].values, a->instance_count * sizeof(float));
    assert_string_equal(a->metrics, b->metrics);
    assert_int_equal(a->state.size, b->state.size);
    assert_memory_equal(a->state.data, b->state.data, a->state.size);
}

static ty_aggregate* resumed(const ty_aggregate_recipe* r, const ty_aggregate* from, ty_workers* workers,
                             ty_status expected)
{
    ty_aggregate* a;
    ty_error error = {0};
    ty_status status = ty_aggregate_resume(r, from->state.data, from->state.size, workers, &a, &error);
    if (status != expected)
        print_message("%s\n", error.text);
    assert_int_equal(status, expected);
    return a;
}

// In the midst of the first layer or of the second, and from rest.
static void aggregates_go_on(void** state)
{
    (void)state;
    ty_layer_def layer = eggs();
    ty_error error;
    for (int layers = 0; layers < 2; layers++)
    {
        ty_aggregate_recipe r = small_box(&layer, layers);
        ty_aggregate* whole = made(&r, NULL);
        for (int threads = 1; threads <= 3; threads++)
        {
            ty_workers* workers;
            assert_int_equal(ty_workers_create(threads, &workers, &error), TY_OK);
            ty_aggregate_recipe brief = r;
            brief.settle.max_seconds = 0.1f;
            ty_aggregate *part, *more, *end;
            assert_int_equal(ty_aggregate_make(&brief, workers, &part, &error), TY_NOT_AT_REST);
            brief.settle.max_seconds = 0.161f;
            more = resumed(&brief, part, workers, TY_NOT_AT_REST);
            end = resumed(&r, more, workers, TY_OK);
            assert_same_aggregates(whole, end);
            ty_aggregate_destroy(part);
            ty_aggregate_destroy(more);
            ty_aggregate_destroy(end);
            end = resumed(&r, whole, workers, TY_OK);
            assert_same_aggregates(whole, end);
            ty_aggregate_destroy(end);
            ty_workers_destroy(workers);
        }
        ty_aggregate_destroy(whole);
    }
}

static void assert_unfit(const ty_aggregate_recipe* r, const void* bytes, size_t size, ty_status expected,
                         const char* reason)
{
    ty_aggregate* a;
    ty_error error;
    assert_int_equal(ty_aggregate_resume(r, bytes, size, NULL, &a, &error), expected);
    assert_null(a);
    assert_non_null(strstr(error.text, reason));
}

static void of_something_else(void** state)
{
    (void)state;
    ty_aggregate_recipe r = small_box(NULL, 0), other = r;
    r.settle.max_seconds = 0.1f;
    ty_aggregate* part;
    ty_error error;
    assert_int_equal(ty_aggregate_make(&r, NULL, &part, &error), TY_NOT_AT_REST);
    uint8_t* bytes = part->state.data;
    size_t size = part->state.size;
    other.seed.value++;
    assert_unfit(&other, bytes, size, TY_BAD_INPUT, "another recipe");
    other = r;
    other.settle.friction = 0.4f;
    assert_unfit(&other, bytes, size, TY_BAD_INPUT, "another recipe");
    other = r;
    other.container.shape.size.x = 0.0301f;
    assert_unfit(&other, bytes, size, TY_BAD_INPUT, "another recipe");
    other = r;
    other.settle.solver = TY_SOLVER_XPBD;
    assert_unfit(&other, bytes, size, TY_BAD_INPUT, "another recipe");
    for (size_t cut = 0; cut < size; cut += 1 + size / 6)
    {
        ty_aggregate* a;
        assert_int_equal(ty_aggregate_resume(&r, bytes, cut, NULL, &a, &error), TY_BAD_FILE);
    }
    for (size_t at = 0; at < size; at += 1 + size / 9)
    {
        bytes[at] ^= 4;
        ty_aggregate* a;
        assert_int_equal(ty_aggregate_resume(&r, bytes, size, NULL, &a, &error), TY_BAD_FILE);
        bytes[at] ^= 4;
    }
    bytes[30] ^= 1;
    assert_unfit(&r, bytes, size, TY_BAD_FILE, "another version");
    bytes[30] ^= 1;
    other = r; // what may differ: the cut comes after all
    other.settle.max_seconds = 5.0f;
    other.container.cut = (ty_cut_def){.kind = TY_CUT_PLANE, .normal = {1, 0, 0}};
    ty_aggregate* cut = resumed(&other, part, NULL, TY_OK);
    assert_true(cut->instance_count > 20 && cut->instance_count < 100);
    ty_aggregate_destroy(cut);
    ty_aggregate_destroy(part);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(piles_go_on),      cmocka_unit_test(settling_goes_on),  cmocka_unit_test(damaged_piles),
        cmocka_unit_test(aggregates_go_on), cmocka_unit_test(of_something_else),
    };
    return cmocka_run_group_tests(tests, group_setup, group_teardown);
}
