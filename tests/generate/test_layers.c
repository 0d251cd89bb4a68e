// SPDX-License-Identifier: Apache-2.0
// Layers: what comes second lies above the first, nothing floats, each keeps its own slots; what cannot be is refused.
#include "recipe_made.h"
#include <tsuya/base/workers.h>

enum
{
    RICE = 150,
    EGGS = 12,
    VARIANTS = 3,
};

static ty_layer_def eggs(void)
{
    ty_layer_def layer;
    ty_layer_params()->set_default(&layer);
    layer.element.kind = TY_ELEMENT_ROE;
    layer.fill.count = EGGS;
    return layer;
}

static ty_aggregate_recipe small_bowl(ty_layer_def* layers, int count)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    set_bowl(&r.container.shape, 0.024f, 0.021f, 0.0018f, 0.010f, 0.003f);
    r.element.variants = VARIANTS;
    r.element.divisions = 8;
    r.fill.count = RICE;
    r.fill.heap = 2e-3f;
    r.settle.rolling = 0.05f;
    r.layers = (ty_param_list){layers, count};
    return r;
}

static int by_height(const void* a, const void* b)
{
    float x = *(const float*)a, y = *(const float*)b;
    return (x > y) - (x < y);
}

static void eggs_lie_on_rice(void** state)
{
    (void)state;
    ty_layer_def layer = eggs();
    ty_aggregate_recipe r = small_bowl(&layer, 1);
    ty_aggregate* a = made(&r, NULL);
    assert_int_equal(a->instance_count, RICE + 3 * EGGS);
    assert_int_equal(a->prototype_count, VARIANTS + 3);
    static const char* const slots[] = {"rice", "rice", "rice", "membrane", "white", "yolk"};
    for (int i = 0; i < a->prototype_count; i++)
    {
        assert_int_equal(a->prototypes[i]->slot_count, 1);
        assert_string_equal(a->prototypes[i]->slot_names[0], slots[i]);
    }
    assert_non_null(strstr(a->metrics, "\"floating\": 0"));
    assert_non_null(strstr(a->metrics, "\"rest\": true"));
    float rice[RICE];
    int grains = 0, found = 0;
    for (uint32_t i = 0; i < RICE + EGGS; i++)
        if (a->prototype_index[i] < VARIANTS)
            rice[grains++] = a->transforms[i].t.y;
    assert_int_equal(grains, RICE);
    qsort(rice, RICE, sizeof *rice, by_height);
    for (uint32_t i = 0; i < RICE + EGGS; i++)
    {
        if (a->prototype_index[i] < VARIANTS)
            continue;
        ty_vec3 egg = a->transforms[i].t;
        int above = 0; // of the egg's middle and near: grains that cover it
        for (uint32_t k = 0; k < RICE + EGGS; k++)
        {
            ty_vec3 d = ty_sub(a->transforms[k].t, egg);
            above += a->prototype_index[k] < VARIANTS && d.y > 2e-3f && d.x * d.x + d.z * d.z < ty_sqr(3e-3f);
        }
        assert_int_equal(above, 0);
        assert_true(egg.y > rice[RICE / 2] + 1e-3f && egg.y < rice[RICE - 1] + 0.012f);
        found++;
    }
    assert_int_equal(found, EGGS);
    ty_aggregate_destroy(a);
}

// The lower layer may move, but stays: it is the pile that it is without the upper one.
static void what_lies_below_stays(void** state)
{
    (void)state;
    ty_layer_def layer = eggs();
    ty_aggregate_recipe r = small_bowl(&layer, 1), bare = small_bowl(NULL, 0);
    ty_aggregate *a = made(&r, NULL), *b = made(&bare, NULL);
    assert_int_equal(b->instance_count, RICE);
    int stayed = 0;
    for (uint32_t i = 0; i < RICE; i++)
        stayed += ty_length(ty_sub(a->transforms[i].t, b->transforms[i].t)) < 2e-3f;
    assert_true(stayed > 0.9 * RICE);
    ty_aggregate_destroy(a);
    ty_aggregate_destroy(b);
}

static void threads_change_nothing(void** state)
{
    (void)state;
    ty_layer_def layers[2] = {eggs(), eggs()};
    layers[1].element = ty_element_def_default();
    layers[1].element.kind = TY_ELEMENT_BEAN;
    layers[1].fill.count = 4;
    ty_aggregate_recipe r = small_bowl(layers, 2);
    r.fill.count = 80;
    ty_workers* two;
    ty_error error;
    assert_int_equal(ty_workers_create(2, &two, &error), TY_OK);
    ty_aggregate *a = made(&r, NULL), *b = made(&r, two);
    assert_int_equal(a->instance_count, 80 + 3 * EGGS + 4);
    assert_int_equal(b->instance_count, a->instance_count);
    assert_memory_equal(a->transforms, b->transforms, a->instance_count * sizeof *a->transforms);
    assert_memory_equal(a->prototype_index, b->prototype_index, a->instance_count * sizeof *a->prototype_index);
    assert_string_equal(a->metrics, b->metrics);
    ty_aggregate_destroy(a);
    ty_aggregate_destroy(b);
    ty_workers_destroy(two);
}

// In a full bowl some fall over the rim: of each layer as many come again.
static void what_is_lost_comes_again(void** state)
{
    (void)state;
    ty_layer_def layer = eggs();
    layer.fill.count = 20;
    ty_aggregate_recipe r = small_bowl(&layer, 1);
    r.fill.count = 260;
    r.fill.heap = 8e-3f;
    r.settle.friction = 0.3f;
    r.settle.rolling = 0.0f;
    ty_aggregate* a = NULL;
    for (r.seed.value = 1; r.seed.value <= 8 && (!a || strstr(a->metrics, "\"lost\": 0,")); r.seed.value++)
    {
        ty_aggregate_destroy(a); // none of these fell
        a = made(&r, NULL);
    }
    assert_null(strstr(a->metrics, "\"lost\": 0,"));
    assert_non_null(strstr(a->metrics, "\"floating\": 0"));
    int membranes = 0;
    for (uint32_t i = 0; i < a->instance_count; i++)
        membranes += a->prototype_index[i] == VARIANTS;
    assert_int_equal(membranes, 20);
    assert_int_equal(a->instance_count, 260 + 3 * 20);
    ty_aggregate_destroy(a);
}

// Up to a level: as many as the space between that and the rice takes.
static void a_level_gives_the_count(void** state)
{
    (void)state;
    ty_layer_def layer = eggs();
    layer.fill.target = TY_FILL_LEVEL;
    layer.fill.heap = 0.0f;
    uint32_t counts[2];
    for (int i = 0; i < 2; i++)
    {
        layer.fill.level = i == 0 ? 0.0135f : 0.0155f;
        ty_aggregate_recipe r = small_bowl(&layer, 1);
        r.fill.count = 40;
        ty_aggregate* a = made(&r, NULL);
        counts[i] = (a->instance_count - 40) / 3;
        ty_aggregate_destroy(a);
    }
    print_message("eggs up to 13.5 and 15.5 mm: %u, %u\n", counts[0], counts[1]);
    double more = 0.6 * 2e-3 * 3.14159 * 0.019 * 0.019 / (3.14159 / 6.0 * 6.2e-3 * 6.2e-3 * 6.2e-3);
    assert_true(fabs((double)(counts[1] - counts[0]) - more) < 0.3 * more);
}

static void impossible_layers_are_refused(void** state)
{
    (void)state;
    ty_layer_def layers[2] = {eggs(), eggs()};
    ty_aggregate_recipe r = small_bowl(layers, 2);
    layers[1].fill.count = 0;
    assert_refused(&r, "layers[1].fill.count: 0", "1..2000000");
    layers[1] = eggs();
    layers[1].fill.density = 0.97f;
    assert_refused(&r, "layers[1].fill.density", "0.1..0.95");
    layers[1] = eggs();
    layers[1].element.roe.diameter = 0.04f;
    assert_refused(&r, "container", "its inside");
    layers[1] = eggs();
    layers[1].fill.count = 40;
    assert_refused(&r, "layers[1].fill.count: 40", "holds at most 2"); // some 430 grains' room, an egg takes four's
    layers[1].fill.target = TY_FILL_LEVEL;
    layers[1].fill.level = 1e-3f;
    assert_refused(&r, "layers[1].fill.level", "space of -"); // the rice reaches higher
    r.layers.count = 1;
    r.settle.solver = TY_SOLVER_XPBD;
    assert_refused(&r, "layers", "impulse");
    r = small_bowl(layers, 1);
    r.container.kind = TY_CONTAINER_SPHERE;
    assert_refused(&r, "layers[0].fill", "opening");
    ty_element_def none = ty_element_def_default();
    none.ratio = 0.0f;
    layers[0].elements = (ty_param_list){&none, 1};
    r = small_bowl(layers, 1);
    assert_refused(&r, "layers[0].elements", "above 0");
}

enum
{
    FRAMES = 6,
};

typedef struct film
{
    ty_vec3 at[FRAMES][RICE + 3 * EGGS];
    int shown;
} film;

static ty_status keep(void* context, int frame, ty_aggregate* a, ty_error* error)
{
    (void)error;
    film* f = context;
    assert_int_equal(frame, ++f->shown);
    assert_int_equal(a->instance_count, RICE + 3 * EGGS);
    for (uint32_t i = 0; i < a->instance_count; i++)
        f->at[frame - 1][i] = a->transforms[i].t;
    return TY_OK;
}

// The rice lies and stays, the eggs come down onto it; both are in every frame.
static void films_show_the_last_layer(void** state)
{
    (void)state;
    static film f;
    ty_layer_def layer = eggs();
    ty_aggregate_recipe r = small_bowl(&layer, 1);
    r.animate.frames = FRAMES;
    r.animate.fps = 20.0f;
    ty_error error;
    ty_aggregate_sink sink = {keep, &f};
    if (ty_aggregate_film(&r, NULL, &sink, &error) != TY_OK)
        fail_msg("%s", error.text);
    assert_int_equal(f.shown, FRAMES);
    double rice = 0.0, fallen = 0.0;
    for (int i = 0; i < RICE; i++)
        rice += (double)ty_length(ty_sub(f.at[FRAMES - 1][i], f.at[0][i])) / RICE;
    for (int i = RICE; i < RICE + EGGS; i++)
        fallen += (double)(f.at[0][i].y - f.at[FRAMES - 1][i].y) / EGGS;
    assert_true(rice < 1e-3 && fallen > 2e-3);
    r.fill.start = TY_FILL_POUR;
    assert_int_equal(ty_aggregate_film(&r, NULL, &sink, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "layers"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eggs_lie_on_rice),          cmocka_unit_test(what_lies_below_stays),
        cmocka_unit_test(what_is_lost_comes_again),  cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(a_level_gives_the_count),   cmocka_unit_test(impossible_layers_are_refused),
        cmocka_unit_test(films_show_the_last_layer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
