// SPDX-License-Identifier: Apache-2.0
// Roe: eggs at rest whose white lies in the membrane and whose yolk floats in the white; what cannot be is refused.
#include "recipe_made.h"
#include <stdio.h>
#include <tsuya/base/file.h>

enum
{
    EGGS = 60,
};

static ty_aggregate_recipe spoonful(void)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.element.kind = TY_ELEMENT_ROE;
    set_bowl(&r.container.shape, 0.0205f, 0.0125f, 0.0016f, 0.008f, 0.0006f);
    r.fill.count = EGGS;
    r.fill.sprinkle = 0.4f;
    r.settle.friction = 1.0f;
    r.settle.rolling = 0.1f;
    return r;
}

static float volume_of(const ty_affine* m)
{
    return ty_dot(ty_cross(m->x, m->y), m->z);
}

// In the shape of the outer body, where it is a ball of radius 1: how far the inner one reaches from its middle.
static float reach_within(const ty_affine* outer, const ty_affine* inner)
{
    ty_affine back;
    assert_true(ty_affine_invert(outer, &back));
    ty_affine m = ty_affine_multiply(&back, inner);
    return ty_length(m.t) / 0.0031f + ty_length(m.x); // the mesh is a ball of half a diameter
}

static void bodies_lie_in_one_another(void** state)
{
    (void)state;
    ty_aggregate_recipe r = spoonful();
    r.element.roe.lean = 0.5f;
    r.element.roe.yolk = 0.145f;
    ty_aggregate* a = made(&r, NULL);
    assert_int_equal(a->instance_count, 3 * EGGS);
    assert_int_equal(a->prototype_count, 3);
    static const char* const slots[3] = {"membrane", "white", "yolk"};
    for (int i = 0; i < 3; i++)
    {
        assert_int_equal(a->prototypes[i]->slot_count, 1);
        assert_string_equal(a->prototypes[i]->slot_names[0], slots[i]);
        assert_true(fabsf(a->prototypes[i]->bounds.high.y - 0.0031f) < 1e-6f);
    }
    float smallest = 2.0f, largest = 0.0f, leaning = 1.0f;
    for (uint32_t i = 0; i < EGGS; i++)
    {
        const ty_affine *membrane = &a->transforms[i], *white = membrane + EGGS, *yolk = white + EGGS;
        for (uint32_t k = 0; k < 3; k++)
            assert_int_equal(a->prototype_index[i + k * EGGS], k);
        float size = ty_length(membrane->y), thickness = 0.0031f * (size - ty_length(white->y));
        smallest = ty_min(smallest, size);
        largest = ty_max(largest, size);
        assert_true(fabsf(thickness - 53e-6f) < 3e-6f); // of every egg
        assert_true(fabsf(volume_of(yolk) / volume_of(white) - 0.145f) < 1e-3f);
        float reach = reach_within(white, yolk);
        assert_true(reach < 0.999f && reach > 0.98f); // it floats, and touches but for a hair
        leaning = ty_min(leaning, ty_normalize(ty_sub(yolk->t, white->t)).y);
        const ty_instance_attribute* tint = ty_aggregate_find_attribute(a, "tint");
        assert_true(tint->values[i] == tint->values[i + EGGS] && tint->values[i] == tint->values[i + 2 * EGGS]);
    }
    assert_true(largest > 1.1f && smallest < 0.95f);
    assert_true(leaning > ty_cos(0.55f) && leaning < ty_cos(0.3f));
    ty_aggregate_destroy(a);
}

// They lie in the spoon and on each other, and reach into one another by what they are pressed.
static void eggs_lie_on_one_another(void** state)
{
    (void)state;
    ty_aggregate_recipe r = spoonful();
    ty_aggregate* a = made(&r, NULL);
    ty_shape_def bowl = r.container.shape;
    bowl.kind = TY_SHAPE_BOWL;
    int touching = 0;
    for (uint32_t i = 0; i < EGGS; i++)
    {
        ty_vec3 p = a->transforms[i].t;
        float radius = 0.0031f * ty_length(a->transforms[i].y);
        bool within = p.y < bowl.height;
        assert_true(!within || ty_shape_interior_distance(&bowl, p) < -0.9f * radius);
        int near = 0;
        for (uint32_t k = 0; k < EGGS; k++)
        {
            float other = 0.0031f * ty_length(a->transforms[k].y);
            float gap = ty_length(ty_sub(p, a->transforms[k].t)) - radius - other;
            assert_true(k == i || gap > -2.0f * 0.06f * 0.0031f); // press .012, shape up to .03
            near += k != i && gap < 0.02f * 0.0062f;
        }
        assert_true(near >= 1);
        touching += near;
    }
    assert_true(touching > 3 * EGGS && touching < 8 * EGGS);
    assert_non_null(strstr(a->metrics, "\"floating\": 0"));
    assert_non_null(strstr(a->metrics, "\"rest\": true"));
    ty_aggregate_destroy(a);
}

// A file brings the slots back, and the same recipe the same eggs.
static void files_keep_the_slots(void** state)
{
    (void)state;
    ty_aggregate_recipe r = spoonful();
    ty_aggregate *a = made(&r, NULL), *b = made(&r, NULL), *read = NULL;
    char path[64];
    snprintf(path, sizeof path, "roe_%d.glb", (int)getpid());
    ty_error error;
    assert_memory_equal(a->transforms, b->transforms, 3 * EGGS * sizeof *a->transforms);
    assert_int_equal(ty_aggregate_write(path, a, &error), TY_OK);
    assert_int_equal(ty_aggregate_read(path, NULL, &read, &error), TY_OK);
    for (int i = 0; i < 3; i++)
    {
        assert_int_equal(read->prototypes[i]->slot_count, 1);
        assert_string_equal(read->prototypes[i]->slot_names[0], a->prototypes[i]->slot_names[0]);
    }
    for (uint32_t i = 0; i < 3 * EGGS; i++)
    {
        assert_int_equal(read->prototype_index[i], i / EGGS);
        assert_true(ty_length(ty_sub(read->transforms[i].t, a->transforms[i].t)) == 0.0f);
    }
    remove(path);
    ty_aggregate_destroy(read);
    ty_aggregate_destroy(b);
    ty_aggregate_destroy(a);
}

static void presets_have_sizes(void** state)
{
    (void)state;
    static const float diameters[] = {6.2e-3f, 1.6e-3f, 1.0e-3f, 1.4e-3f};
    for (int i = 0; i < 4; i++)
    {
        ty_aggregate_recipe r = spoonful();
        r.element.roe.preset = i;
        r.fill.count = 20;
        r.container.kind = TY_CONTAINER_BOX;
        r.container.shape.rounding = 0.0f;
        float d = diameters[i];
        r.container.shape.size = ty_vec3_make(2.0f * d, 2.0f * d, 2.0f * d);
        r.fill.heap = d;
        ty_aggregate* a = made(&r, NULL);
        assert_true(fabsf(2.0f * a->prototypes[0]->bounds.high.x - d) < 1e-6f);
        ty_aggregate_destroy(a);
    }
}

static void impossible_eggs_are_refused(void** state)
{
    (void)state;
    ty_aggregate_recipe r = spoonful();
    r.element.roe.diameter = 0.1e-3f;
    assert_refused(&r, "element.roe.diameter: 0.1 mm", "0.2..50");
    r = spoonful();
    r.element.roe.diameter = 4e-3f;
    r.element.roe.membrane = 0.5e-3f;
    assert_refused(&r, "element.roe.membrane: 0.5 mm", "0.004..0.4");
    r.element.roe.membrane = 2e-6f;
    assert_refused(&r, "element.roe.membrane: 0.002 mm", "0.004..0.4");
    r = spoonful();
    r.fill.count = 500;
    assert_refused(&r, "fill.count", "at most");
    r = spoonful();
    r.element.roe.diameter = 30e-3f;
    assert_refused(&r, "container", "its inside");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_lie_in_one_another),   cmocka_unit_test(eggs_lie_on_one_another),
        cmocka_unit_test(files_keep_the_slots),        cmocka_unit_test(presets_have_sizes),
        cmocka_unit_test(impossible_eggs_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
