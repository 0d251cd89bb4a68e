// SPDX-License-Identifier: Apache-2.0
// Rice that is soaked, cooked and left to stand in a film: the laws of its water, grains that grow in the heap and push
// it up without reaching into each other, and what drying at the surface does.
#include "mesh_overlap.h"
#include "recipe_made.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/generate/aggregate_recipe.h>

enum
{
    GRAINS = 80,
    FRAMES = 11, // 30 minutes of soaking up to the 4th, 30 of cooking up to the 7th, 40 of standing
};

typedef struct film
{
    ty_affine transforms[FRAMES][GRAINS];
    float wet_basis[FRAMES][GRAINS], cooked[FRAMES], pores[FRAMES], moisture[GRAINS];
    double overlap[FRAMES];
    mesh_overlap meshes; // of the frame as it comes off the fire
    int shown;
} film;

static const float* attribute(const ty_aggregate* a, const char* name)
{
    const ty_instance_attribute* found = ty_aggregate_find_attribute(a, name);
    assert_non_null(found);
    return found->values;
}

static ty_status keep(void* context, int frame, ty_aggregate* a, ty_error* error)
{
    (void)error;
    film* f = context;
    assert_int_equal(frame, ++f->shown);
    assert_int_equal(a->instance_count, GRAINS);
    for (uint32_t i = 0; i < GRAINS; i++)
        assert_int_equal(a->ids[i], i);
    memcpy(f->transforms[frame - 1], a->transforms, sizeof f->transforms[0]);
    memcpy(f->wet_basis[frame - 1], attribute(a, "wet_basis"), sizeof f->wet_basis[0]);
    memcpy(f->moisture, attribute(a, "moisture"), sizeof f->moisture);
    f->cooked[frame - 1] = attribute(a, "cooked")[GRAINS - 1];
    f->pores[frame - 1] = attribute(a, "pore_area")[0];
    f->overlap[frame - 1] = metric(a, "overlap_max_percent");
    if (frame == 7)
        f->meshes = mesh_overlap_measure(a, NULL, 2.5e-3f);
    return TY_OK;
}

static ty_aggregate_recipe recipe_make(void)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.element.variants = 2;
    set_bowl(&r.container.shape, 0.019f, 0.016f, 0.0016f, 0.008f, 0.002f);
    r.fill.count = GRAINS;
    r.fill.sprinkle = 0.0f;
    r.settle.rate = 1500.0f;
    r.animate = (ty_animate_def){.frames = FRAMES, .fps = 24.0f, .soak = 30.0f, .cook = 30.0f, .stand = 40.0f};
    return r;
}

static void shoot(const ty_aggregate_recipe* r, ty_workers* workers, film* f)
{
    *f = (film){0};
    ty_error error;
    ty_aggregate_sink sink = {keep, f};
    if (ty_aggregate_film(r, workers, &sink, &error) != TY_OK)
        fail_msg("%s", error.text);
    assert_int_equal(f->shown, FRAMES);
}

static double mean_wet(const film* f, int frame)
{
    double sum = 0.0;
    for (int i = 0; i < GRAINS; i++)
        sum += (double)f->wet_basis[frame][i] / GRAINS;
    return sum;
}

static double mean_height(const film* f, int frame)
{
    double sum = 0.0;
    for (int i = 0; i < GRAINS; i++)
        sum += (double)f->transforms[frame][i].t.y / GRAINS;
    return sum;
}

// Volume of a grain of unit dry mass: 1 / 1.45 of matter and the water.
static double volume(double wet)
{
    return 1.0 / 1.45 + wet / (1.0 - wet);
}

static film whole;

static void make_whole(void)
{
    ty_aggregate_recipe r = recipe_make();
    r.moisture.drying = 0.5f;
    if (whole.shown == 0)
        shoot(&r, NULL, &whole);
}

// Raw; soaked by the law of uptake; cooked to .62; then drier.
static void water_follows_its_laws(void** state)
{
    (void)state;
    make_whole();
    double chance = 0.0;
    for (int i = 0; i < GRAINS; i++)
        chance += 0.06 * (double)whole.moisture[i] / GRAINS;
    for (int frame = 0; frame <= 3; frame++)
    {
        double expected =
            (double)ty_moisture_wet_basis(ty_moisture_uptake(10.0f * (float)frame, 10.0f)) * (1.0 + chance);
        assert_true(fabs(mean_wet(&whole, frame) - expected) < 1e-4);
        assert_true(whole.cooked[frame] == 0.0f);
    }
    // Of table 1 of Gan 2023: .02 um^2 unsoaked, .06 after 20 minutes, 1.31 after an hour; cooking leaves them.
    assert_true(fabsf(whole.pores[0] - 0.02f) < 1e-6f && fabsf(whole.pores[2] - 0.06f) < 1e-6f);
    assert_true(whole.pores[3] > 0.06f && whole.pores[3] < 1.31f && whole.pores[FRAMES - 1] == whole.pores[3]);
    assert_true(fabs(mean_wet(&whole, 6) - 0.62 * (1.0 + chance)) < 1e-4);
    assert_true(whole.cooked[6] > 0.999f && fabsf(whole.cooked[5] - 20.0f / 27.0f) < 1e-3f);
    for (int frame = 7; frame < FRAMES; frame++)
        assert_true(mean_wet(&whole, frame) < mean_wet(&whole, frame - 1) - 0.002);
}

// The cube of a grain's size goes with its own water, whatever its form; the shape stays.
static void grains_swell_by_their_water(void** state)
{
    (void)state;
    make_whole();
    for (int frame = 0; frame < FRAMES; frame++)
        for (int i = 0; i < GRAINS; i++)
        {
            const ty_affine *a = &whole.transforms[0][i], *b = &whole.transforms[frame][i];
            double grown = pow((double)(ty_length(b->y) / ty_length(a->y)), 3.0);
            double expected = volume((double)whole.wet_basis[frame][i]) / volume((double)whole.wet_basis[0][i]);
            if (fabs(grown / expected - 1.0) > 0.01)
                fail_msg("frame %d, grain %d: %g, expected %g", frame, i, grown, expected);
        }
    assert_true(fabs(volume(0.62) / volume(0.145) - 2.70) < 0.01);
}

static void heaps_rise_and_sink(void** state)
{
    (void)state;
    make_whole();
    double raw = mean_height(&whole, 0), soaked = mean_height(&whole, 3), cooked = mean_height(&whole, 6),
           stood = mean_height(&whole, FRAMES - 1);
    print_message("  mean height %.2f raw, %.2f soaked, %.2f cooked, %.2f mm after standing\n", raw * 1e3, soaked * 1e3,
                  cooked * 1e3, stood * 1e3);
    assert_true(soaked > raw + 0.1e-3 && cooked > soaked + 0.5e-3 && stood < cooked - 0.05e-3);
    for (int frame = 0; frame < FRAMES; frame++)
        assert_true(whole.overlap[frame] < 0.2);
}

// Of the meshes that are shown: what is left is what the balls of a grain leave out.
static void frames_are_polished(void** state)
{
    (void)state;
    static film raw;
    ty_aggregate_recipe r = recipe_make();
    r.moisture.drying = 0.5f;
    r.settle.polish = 0;
    make_whole();
    shoot(&r, NULL, &raw);
    float left = whole.meshes.mean * whole.meshes.pairs, there = raw.meshes.mean * raw.meshes.pairs;
    print_message("  overlap a grain %.2f %% of the width, %.2f without, at most %.2f and %.2f\n", (double)left * 100.0,
                  (double)there * 100.0, (double)whole.meshes.most * 100.0, (double)raw.meshes.most * 100.0);
    assert_true(left < 0.75f * there);
}

// What lies at the top loses more than what lies below, and none without drying.
static void surfaces_dry_first(void** state)
{
    (void)state;
    make_whole();
    double lost[2] = {0.0, 0.0}, count[2] = {0.0, 0.0}, mean = mean_height(&whole, 6);
    for (int i = 0; i < GRAINS; i++)
    {
        int top = (double)whole.transforms[6][i].t.y > mean;
        lost[top] += (double)(whole.wet_basis[6][i] - whole.wet_basis[FRAMES - 1][i]);
        count[top] += 1.0;
    }
    print_message("  lost %.3f below, %.3f above\n", lost[0] / count[0], lost[1] / count[1]);
    assert_true(lost[0] / count[0] > 0.01 && lost[1] / count[1] > 1.2 * lost[0] / count[0]);
    static film moist;
    ty_aggregate_recipe r = recipe_make();
    r.moisture.drying = 0.0f;
    r.animate.soak = 0.0f;
    r.animate.cook = 10.0f;
    ty_workers* workers;
    ty_error error;
    assert_int_equal(ty_workers_create(3, &workers, &error), TY_OK);
    shoot(&r, workers, &moist);
    ty_workers_destroy(workers);
    assert_memory_equal(moist.wet_basis[FRAMES - 1], moist.wet_basis[2], sizeof moist.wet_basis[0]);
    static film again;
    shoot(&r, NULL, &again);
    assert_memory_equal(moist.transforms, again.transforms, sizeof again.transforms); // for any number of threads
}

static void states_are_said_once(void** state)
{
    (void)state;
    static film f;
    ty_aggregate_recipe r = recipe_make();
    r.moisture.wet_basis = 0.5f;
    ty_error error;
    ty_aggregate_sink sink = {keep, &f};
    assert_int_equal(ty_aggregate_film(&r, NULL, &sink, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "animate.soak"));
    assert_int_equal(f.shown, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(water_follows_its_laws), cmocka_unit_test(grains_swell_by_their_water),
        cmocka_unit_test(heaps_rise_and_sink),    cmocka_unit_test(surfaces_dry_first),
        cmocka_unit_test(states_are_said_once),   cmocka_unit_test(frames_are_polished),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
