// SPDX-License-Identifier: Apache-2.0
// Elements that are poured, as a start and as a film; the film of a press; what the files of a film tell of rest.
#include "recipe_made.h"

enum
{
    GRAINS = 40,
    MOST_FRAMES = 40,
};

static ty_aggregate_recipe recipe_make(void)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.element.variants = 2;
    set_bowl(&r.container.shape, 0.018f, 0.018f, 0.0015f, 0.008f, 0.002f);
    r.fill.count = GRAINS;
    r.fill.start = TY_FILL_POUR;
    r.fill.pour.rate = 100.0f;
    r.fill.pour.radius = 0.006f;
    return r;
}

static void test_start(void** state)
{
    (void)state;
    ty_aggregate_recipe r = recipe_make();
    ty_aggregate* a = made(&r, NULL);
    assert_int_equal(a->instance_count, GRAINS);
    assert_non_null(strstr(a->metrics, "\"rest\": true"));
    assert_non_null(strstr(a->metrics, "\"start\": \"pour\""));
    assert_true(metric(a, "substeps") > 0.4 * 2500.0); // .4 s of pouring alone
    ty_aggregate_destroy(a);
}

typedef struct film
{
    ty_affine transforms[MOST_FRAMES][GRAINS];
    float poured[MOST_FRAMES][GRAINS];
    bool rest[MOST_FRAMES];
    double height[MOST_FRAMES];
    uint32_t count;
    int frames;
} film;

static ty_status keep(void* context, int frame, ty_aggregate* a, ty_error* error)
{
    (void)error;
    film* f = context;
    assert_true(frame == f->frames + 1 && frame <= MOST_FRAMES);
    assert_true(frame == 1 || a->instance_count == f->count);
    f->count = a->instance_count;
    const ty_instance_attribute* poured = ty_aggregate_find_attribute(a, "poured");
    for (uint32_t i = 0; i < a->instance_count && i < GRAINS; i++)
    {
        assert_int_equal(a->ids[i], i);
        f->transforms[f->frames][i] = a->transforms[i];
        f->poured[f->frames][i] = poured ? poured->values[i] : -1.0f;
    }
    f->rest[f->frames] = strstr(a->metrics, "\"rest\": true") != NULL;
    f->height[f->frames] = strstr(a->metrics, "\"height_mm\"") ? metric(a, "height_mm") : -1.0;
    f->frames++;
    return TY_OK;
}

static void shoot(const ty_aggregate_recipe* r, ty_workers* workers, film* f)
{
    *f = (film){0};
    ty_error error;
    ty_aggregate_sink sink = {keep, f};
    if (ty_aggregate_film(r, workers, &sink, &error) != TY_OK)
        fail_msg("%s", error.text);
}

static int poured_at(const film* f, int frame)
{
    int sum = 0;
    for (int i = 0; i < GRAINS; i++)
        sum += f->poured[frame][i] == 1.0f;
    return sum;
}

// One each hundredth of a second from the first moment on; those that wait are too small to be seen; between mouth and
// heap they fall freely; in the end all rest, and only then do the files say so.
static void test_film(void** state)
{
    (void)state;
    static film f, g;
    ty_aggregate_recipe r = recipe_make();
    const ty_vec3 from = {0.001f, 0.09f, 0.002f};
    r.fill.pour.from = from;
    r.animate.frames = MOST_FRAMES;
    r.animate.fps = 50.0f;
    shoot(&r, NULL, &f);
    assert_int_equal(f.count, GRAINS);
    assert_int_equal(poured_at(&f, 0), 0);
    for (int frame = 1; frame <= 20; frame++) // frame 20 shows .4 s
        assert_in_range(poured_at(&f, frame), 2 * frame - 1, 2 * frame + 1);
    assert_int_equal(poured_at(&f, 21), GRAINS);
    for (int frame = 0; frame < 20; frame++)
        for (int i = 0; i < GRAINS; i++)
        {
            const ty_affine* t = &f.transforms[frame][i];
            assert_true((ty_length(t->x) < 2e-3f) == (f.poured[frame][i] == 0.0f));
            assert_true(f.poured[frame][i] == 1.0f || ty_length(ty_sub(t->t, from)) < 1e-6f);
        }
    const float seconds = 0.04f; // grain 20 leaves at .2 s, frame 12 shows .24
    float fallen = seconds * (r.fill.pour.speed + 0.5f * 9.81f * seconds);
    assert_float_equal(f.transforms[12][20].t.y, from.y - fallen, 3e-4f);
    assert_true(ty_sqr(f.transforms[12][20].t.x - from.x) + ty_sqr(f.transforms[12][20].t.z - from.z) <=
                0.006f * 0.006f);
    assert_false(f.rest[0]);
    assert_false(f.rest[10]);
    assert_true(f.rest[MOST_FRAMES - 1]);
    ty_workers* two;
    ty_error error;
    assert_int_equal(ty_workers_create(2, &two, &error), TY_OK);
    shoot(&r, two, &g);
    assert_memory_equal(f.transforms, g.transforms, sizeof f.transforms);
    ty_workers_destroy(two);
}

// Two seconds between any two: what lies may rest by then, but it is not over.
static void test_not_over(void** state)
{
    (void)state;
    static film f;
    ty_aggregate_recipe r = recipe_make();
    r.fill.count = 3;
    r.fill.pour.rate = 0.5f;
    r.settle.rolling = 0.02f;
    r.animate.frames = 9;
    r.animate.fps = 1.25f;
    shoot(&r, NULL, &f);
    assert_int_equal(poured_at(&f, 2), 1); // after 1.6 s
    assert_float_equal(f.transforms[2][0].t.y, f.transforms[1][0].t.y, 1e-5f);
    assert_false(f.rest[1] || f.rest[2]);
    assert_true(f.rest[8]);
}

// A dry heap in a mould: pressed over the first .1 s, then the mould is gone and it slumps.
static void test_press_film(void** state)
{
    (void)state;
    static film f;
    ty_aggregate_recipe r = recipe_make();
    r.fill.start = TY_FILL_INFLATE;
    r.fill.target = TY_FILL_DENSITY;
    r.container.kind = TY_CONTAINER_ONIGIRI;
    r.container.role = TY_CONTAINER_MOULD;
    r.container.onigiri = (ty_onigiri_def){0.036f, 0.018f, 0.007f, 0.005f};
    r.settle.rolling = 0.01f;
    r.press.strain = 0.06f;
    r.press.from = TY_PRESS_AROUND;
    r.press.seconds = 0.1f;
    r.animate.frames = MOST_FRAMES;
    r.animate.fps = 20.0f;
    shoot(&r, NULL, &f);
    assert_true(f.height[0] < 0.0 && f.height[1] < 0.0 && f.height[2] > 0.0);
    assert_true(f.transforms[0][0].t.y != f.transforms[1][0].t.y);
    print_message("%.1f mm when released, %.1f at the end\n", f.height[2], f.height[MOST_FRAMES - 1]);
    assert_true(f.height[MOST_FRAMES - 1] < 0.8 * f.height[2]);
    assert_false(f.rest[0] || f.rest[1] || f.rest[3]);
    assert_true(f.rest[MOST_FRAMES - 1]);
}

static void assert_no_film(const ty_aggregate_recipe* r, const char* text)
{
    film f = {0};
    ty_error error = {0};
    ty_aggregate_sink sink = {keep, &f};
    assert_int_equal(ty_aggregate_film(r, NULL, &sink, &error), TY_BAD_INPUT);
    if (!strstr(error.text, text))
        fail_msg("'%s' does not say '%s'", error.text, text);
}

static void test_refused(void** state)
{
    (void)state;
    ty_aggregate_recipe r = recipe_make();
    r.container.kind = TY_CONTAINER_SPHERE;
    assert_refused(&r, "fill.start", "open");
    r = recipe_make();
    r.fill.pour.from = ty_vec3_make(0.0f, 0.003f, 0.0f);
    assert_refused(&r, "fill.pour.from", "above");
    r = recipe_make();
    r.fill.pour.radius = 0.0f; // one at a time, and none makes room
    r.fill.pour.from = ty_vec3_make(0.0f, 0.013f, 0.0f);
    r.fill.pour.rate = 1e4f;
    assert_refused(&r, "fill.pour", "radius");
    r = recipe_make();
    r.animate.frames = 2;
    r.press.strain = 0.1f;
    assert_no_film(&r, "not both");
    r.press.strain = 0.0f;
    r.settle.solver = TY_SOLVER_XPBD;
    assert_no_film(&r, "impulse");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_start),      cmocka_unit_test(test_film),    cmocka_unit_test(test_not_over),
        cmocka_unit_test(test_press_film), cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
