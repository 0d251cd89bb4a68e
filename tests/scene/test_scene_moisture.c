// SPDX-License-Identifier: Apache-2.0
// Moisture in scenes: its forms, the attribute `height` of aggregates, mistakes with their place.
#include "scene/fixture.h"
#include <tsuya/shading/cdrf.h>
#include <tsuya/shading/material.h>

#define SCENE(moisture)                                                                                                \
    "tsuya: 1\nassets:\n  grain: { shape: sphere, radius: .002, divisions: 16 }\n"                                     \
    "  heap: { aggregate: heap.ply, prototype: grain }\n"                                                              \
    "objects: [ { aggregate: heap, material: rice } ]\n"                                                               \
    "materials:\n  rice: { model: cdrf, " moisture " }\n"

// Four grains, the second lowest and the third highest.
static void write_heap(const char* further, const char* column)
{
    char* text =
        ty_string_format("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                         "property float z\n%s\nend_header\n0 .02 0%s\n.01 .01 0%s\n.02 .05 0%s\n.03 .02 0%s\n",
                         further, column, column, column, column);
    fixture_write("heap.ply", text);
    ty_free(text);
}

static void must_load(const char* text)
{
    fixture_write("scene.yaml", text);
    ty_status status = fixture_load(&(ty_scene_options){0});
    if (status != TY_OK)
        fixture_print_errors();
    assert_int_equal(status, TY_OK);
}

static float length_at(uint32_t instance)
{
    ty_surface_point p = {.ng = {0, 0, 1}, .ns = {0, 0, 1}, .instance = instance};
    ty_bsdf b;
    ty_material_prepare(fixture_scene->materials[0], &fixture_scene->shading, &p, ty_vec3_make(0, 0, 1), &b);
    return b.mean_free_path[0] * 1e3f;
}

static void forms(void** state)
{
    (void)state;
    write_heap("comment y is height", "");
    must_load(SCENE("moisture: 0.62"));
    float cooked = length_at(0);
    fixture_near(cooked, 0.70f, 0.001f);
    must_load(SCENE("moisture: { wet_basis: .62 }"));
    assert_true(length_at(0) == cooked);
    must_load(SCENE("moisture: { soak: { minutes: 60, celsius: 10 }, cooked: 1 }"));
    fixture_near(length_at(0), cooked, 1e-5f);
    must_load(SCENE("moisture: { soak: { minutes: 0 } }"));
    fixture_near(length_at(0), 0.19f, 1e-5f);
    must_load(SCENE("moisture: { uptake: .24, cooked: 0 }"));
    fixture_near(length_at(0), 0.10f, 5e-4f);
    must_load(SCENE("moisture: { uptake: .24 }, cooked: 1"));
    fixture_near(length_at(0), 0.375f, 1e-3f);
    must_load(SCENE("moisture: 0"));
    float driest = length_at(0);
    must_load(SCENE("moisture: 0.05"));
    assert_true(length_at(0) == driest);
}

static void height_of_a_heap(void** state)
{
    (void)state;
    write_heap("comment y is height", "");
    must_load(SCENE("moisture: { wet_basis: .62, cooked: 1, gradient: { value: -.4, attribute: height } }"));
    const float height[4] = {0.25f, 0.0f, 1.0f, 0.25f};
    for (uint32_t i = 0; i < 4; ++i)
    {
        ty_moisture_optics law = ty_moisture_optics_make((ty_moisture){0.62f - 0.4f * height[i], 1.0f});
        fixture_near(length_at(i), law.mean_free_path * 1e3f, 1e-5f);
    }
    // What the file says of height is the file's.
    write_heap("property float height", " .5");
    must_load(SCENE("moisture: { value: .62, attribute: height }, cooked: 1"));
    fixture_near(length_at(2), ty_moisture_optics_make((ty_moisture){0.31f, 1.0f}).mean_free_path * 1e3f, 1e-5f);
}

static void mistakes(void** state)
{
    (void)state;
    static const struct
    {
        const char* text;
        int column;
        const char* says;
    } cases[] = {
        {SCENE("moisture: 1.2"), 34, "'moisture' is 1.2: out of range, expected a number 0..1"},
        {SCENE("moisture: { uptake: -1 }"), 44, "'uptake' is -1: out of range, expected a number 0..10"},
        {SCENE("moisture: { uptake: .1, soak: {} }"), 48, "moisture is either 'uptake' or 'soak', not both"},
        {SCENE("moisture: { soak: { celsius: 99 } }"), 53, "'celsius' is 99: out of range, expected a number 0..60 C"},
        {SCENE("moisture: { soak: { minute: 9 } }"), 44, "did you mean 'minutes'"},
        {SCENE("moisture: { cooked: 1 }, cooked: 0"), 57, "'cooked' is said in 'moisture' already"},
        {SCENE("moisture: { wet: .3 }"), 36, "unknown key 'wet' in moisture"},
        {SCENE("moisture: { gradient: { value: .1, attribute: hight } }"), 70, "did you mean 'height'"},
        {SCENE("moisture: [.1]"), 34, "'moisture': expected a number"},
    };
    write_heap("comment y is height", "");
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i)
    {
        assert_int_not_equal(fixture_check(cases[i].text), TY_OK);
        assert_true(fixture_has("scene.yaml", 7, cases[i].column, cases[i].says));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forms),
        cmocka_unit_test(height_of_a_heap),
        cmocka_unit_test(mistakes),
    };
    return cmocka_run_group_tests(tests, fixture_begin, fixture_end);
}
