// SPDX-License-Identifier: Apache-2.0
// The tree of lights: its probabilities are what it samples, add up, leave nothing out, and beat power alone.
#include "renderer_private.h"
#include <tsuya/base/memory.h>

enum
{
    MANY = 1500
};

typedef struct field
{
    ty_light_node leaves[MANY]; // by item
    ty_light_tree* tree;
} field;

// Lamps over a table, every third of them a flat one that faces somewhere.
static field* field_make(void)
{
    field* f = TY_ALLOC(field, 1);
    ty_light_node* order = TY_ALLOC(ty_light_node, MANY);
    for (int i = 0; i < MANY; ++i)
    {
        ty_rng rng = ty_rng_make((ty_seed){4}, 2, (uint64_t)i);
        ty_vec3 p = {ty_rng_range(&rng, -0.5f, 0.5f), ty_rng_range(&rng, 0.05f, 0.5f), ty_rng_range(&rng, -0.5f, 0.5f)};
        ty_vec3 n =
            ty_normalize((ty_vec3){ty_rng_range(&rng, -1, 1), ty_rng_range(&rng, -1, 1), ty_rng_range(&rng, -1, 1)});
        bool flat = i % 3 == 0;
        f->leaves[i] = (ty_light_node){.low = p,
                                       .high = p,
                                       .axis = n,
                                       .cos_o = flat ? 1.0f : -1.0f,
                                       .energy = 0.2f + ty_rng_float(&rng),
                                       .even = flat ? 0.0f : 1.0f,
                                       .mean = flat ? n : (ty_vec3){0},
                                       .child = (uint32_t)i};
        order[i] = f->leaves[i];
    }
    f->tree = ty_light_tree_create(order, MANY, MANY + 5); // five items are no lights
    ty_free(order);
    return f;
}

static void field_free(field* f)
{
    ty_light_tree_destroy(f->tree);
    ty_free(f);
}

// Irradiance of a light at p on a plane with a normal, or over all directions.
static double given(const ty_light_node* leaf, ty_vec3 p, ty_vec3 normal)
{
    ty_vec3 d = ty_sub(leaf->low, p), w = ty_normalize(d);
    double out = leaf->even > 0.0f ? 1.0 : fmax(-(double)ty_dot(leaf->axis, w), 0.0);
    double in = ty_length_sqr(normal) > 0.0f ? fmax((double)ty_dot(normal, w), 0.0) : 1.0;
    return (double)leaf->energy * out * in / (double)ty_length_sqr(d);
}

static const ty_vec3 places[] = {{0, 0, 0}, {0.4f, 0, 0.3f}, {0.1f, 0.2f, -0.1f}, {3, 1, 0}, {0, 40, 0}};
static const ty_vec3 normals[] = {{0, 1, 0}, {0, 0, 0}, {0, -1, 0}};

static void probabilities_add_up_and_miss_nothing(void** state)
{
    (void)state;
    field* f = field_make();
    for (int p = 0; p < 5; ++p)
        for (int n = 0; n < 3; ++n)
        {
            double sum = 0.0, light = 0.0;
            for (int i = 0; i < MANY; ++i)
            {
                float probability = ty_light_tree_probability(f->tree, places[p], normals[n], i);
                double e = given(&f->leaves[i], places[p], normals[n]);
                assert_true(!(e > 0.0) || probability > 0.0f);
                sum += (double)probability;
                light += e;
            }
            // Where a subtree turns out to give nothing after all, its share is lost.
            assert_true(sum < 1.0 + 1e-4 && (!(light > 0.0) || sum > 0.5));
            assert_true(ty_light_tree_probability(f->tree, places[p], normals[n], MANY + 2) == 0.0f);
        }
    field_free(f);
}

static void samples_come_with_their_probability(void** state)
{
    (void)state;
    enum
    {
        N = 200000
    };
    field* f = field_make();
    int* counts = TY_ALLOC(int, MANY);
    for (int k = 0; k < N; ++k)
    {
        double u = (k + 0.5) / N;
        float probability;
        int i = ty_light_tree_sample(f->tree, places[1], normals[0], &u, &probability);
        assert_true(u >= 0.0 && u <= 1.0);
        if (i < 0)
            continue;
        counts[i]++;
        float expected = ty_light_tree_probability(f->tree, places[1], normals[0], i);
        assert_true(fabsf(probability - expected) <= 1e-6f * expected);
    }
    // An even walk over u meets each as often as it should, to one step at either end.
    for (int i = 0; i < MANY; ++i)
    {
        double expected = N * (double)ty_light_tree_probability(f->tree, places[1], normals[0], i);
        if (fabs(counts[i] - expected) > 2.0 + 1e-3 * expected)
            fail_msg("light %d: %d times, expected %.1f", i, counts[i], expected);
    }
    ty_free(counts);
    field_free(f);
}

// Relative variance of one sample: sum of e^2 / p over the square of the sum, less 1.
static void it_beats_power_alone(void** state)
{
    (void)state;
    field* f = field_make();
    for (int p = 0; p < 3; ++p)
    {
        double sum = 0.0, by_tree = 0.0, by_power = 0.0, power = 0.0;
        for (int i = 0; i < MANY; ++i)
            power += (double)f->leaves[i].energy;
        for (int i = 0; i < MANY; ++i)
        {
            double e = given(&f->leaves[i], places[p], normals[0]);
            if (!(e > 0.0))
                continue;
            sum += e;
            by_tree += e * e / (double)ty_light_tree_probability(f->tree, places[p], normals[0], i);
            by_power += e * e / ((double)f->leaves[i].energy / power);
        }
        double tree = by_tree / (sum * sum) - 1.0, alone = by_power / (sum * sum) - 1.0;
        print_message("relative variance: tree %.3f, power %.3f\n", tree, alone);
        assert_true(tree < 0.8 && tree < 0.1 * alone);
    }
    field_free(f);
}

static void equal_places_and_one_light(void** state)
{
    (void)state;
    ty_light_node leaves[300];
    for (int i = 0; i < 300; ++i)
        leaves[i] = (ty_light_node){.cos_o = -1.0f, .even = 1.0f, .energy = 1.0f, .child = (uint32_t)i};
    ty_light_tree* tree = ty_light_tree_create(leaves, 300, 300);
    double sum = 0.0;
    for (int i = 0; i < 300; ++i)
        sum += (double)ty_light_tree_probability(tree, (ty_vec3){0, 1, 0}, (ty_vec3){0}, i);
    assert_true(fabs(sum - 1.0) < 1e-4);
    ty_light_tree_destroy(tree);
    ty_light_node one = {.cos_o = -1.0f, .even = 1.0f, .energy = 1.0f, .child = 3};
    tree = ty_light_tree_create(&one, 1, 4);
    assert_true(ty_light_tree_probability(tree, (ty_vec3){0, 1, 0}, (ty_vec3){0}, 3) == 1.0f);
    assert_true(ty_light_tree_probability(tree, (ty_vec3){0, 1, 0}, (ty_vec3){0}, 0) == 0.0f);
    ty_light_tree_destroy(tree);
    assert_null(ty_light_tree_create(leaves, 0, 3));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(probabilities_add_up_and_miss_nothing),
        cmocka_unit_test(samples_come_with_their_probability),
        cmocka_unit_test(it_beats_power_alone),
        cmocka_unit_test(equal_places_and_one_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
