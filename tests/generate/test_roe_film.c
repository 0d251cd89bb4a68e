// SPDX-License-Identifier: Apache-2.0
// Roe as a film: shells go with the bodies, yolks rise through the white by buoyancy and drag and stop at the membrane.
#include "recipe_made.h"
#include <math.h>
#include <string.h>
#include <tsuya/generate/aggregate_recipe.h>

enum
{
    EGGS = 12,
    MOST_FRAMES = 101,
};

// m; an egg of mean size as it is packed
static const float radius = 0.0031f, shell = 53e-6f, yolk_share = 0.145f;

typedef struct film
{
    ty_affine transforms[MOST_FRAMES][3 * EGGS];
    ty_vec3 velocities[MOST_FRAMES][3 * EGGS], spins[3 * EGGS];
    uint32_t instances;
    int shown;
} film;

static ty_status keep(void* context, int frame, ty_aggregate* a, ty_error* error)
{
    (void)error;
    film* f = context;
    assert_int_equal(frame, ++f->shown);
    assert_int_equal(a->instance_count, f->instances);
    assert_int_equal(a->prototype_count, 3);
    for (uint32_t i = 0; i < a->instance_count; i++)
        assert_true(a->ids[i] == i && a->prototype_index[i] == i / (a->instance_count / 3));
    memcpy(f->transforms[frame - 1], a->transforms, a->instance_count * sizeof *a->transforms);
    memcpy(f->velocities[frame - 1], a->velocities, a->instance_count * sizeof *a->velocities);
    memcpy(f->spins, a->spins, a->instance_count * sizeof *a->spins);
    return TY_OK;
}

static ty_aggregate_recipe spoonful(int eggs, int frames, float fps)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.element.kind = TY_ELEMENT_ROE;
    r.element.variation = 0.0f;
    r.element.roe.lean = 0.0f;
    r.element.roe.press = 0.0f;
    set_bowl(&r.container.shape, 0.0205f, 0.0125f, 0.0016f, 0.008f, 0.0006f);
    r.fill.count = eggs;
    r.settle.friction = 1.0f;
    r.settle.rolling = 0.1f;
    r.animate = (ty_animate_def){.frames = frames, .fps = fps};
    return r;
}

static void shoot(const ty_aggregate_recipe* r, ty_workers* workers, film* f)
{
    *f = (film){.instances = 3 * (uint32_t)r->fill.count};
    ty_error error;
    ty_aggregate_sink sink = {keep, f};
    ty_status status = ty_aggregate_film(r, workers, &sink, &error);
    if (status != TY_OK)
        fail_msg("%s", error.text);
    assert_int_equal(f->shown, r->animate.frames);
}

static ty_vec3 yolk_off(const film* f, int frame, uint32_t egg, uint32_t eggs)
{
    return ty_sub(f->transforms[frame][egg + 2 * eggs].t, f->transforms[frame][egg].t);
}

// How far a yolk that touches the membrane is from the middle, but for the hair.
static float room(void)
{
    return (radius - shell) * (1.0f - cbrtf(yolk_share));
}

// The still of a spoonful: the yolk has .525 of the white's radius, touches the membrane at the top, so that what is
// below is white.
static void still_yolks_touch_the_top(void** state)
{
    (void)state;
    ty_aggregate_recipe r = spoonful(EGGS, 0, 24.0f);
    ty_aggregate* a;
    ty_error error;
    assert_int_equal(ty_aggregate_make(&r, NULL, &a, &error), TY_OK);
    for (uint32_t i = 0; i < EGGS; i++)
    {
        const ty_affine *membrane = &a->transforms[i], *white = membrane + EGGS, *yolk = white + EGGS;
        float outer = radius * ty_length(white->y), inner = radius * ty_length(yolk->y);
        assert_true(fabsf(inner / outer - 0.525f) < 0.001f);
        assert_true(fabsf(outer - (radius - shell)) < 1e-6f && ty_length(ty_sub(white->t, membrane->t)) == 0.0f);
        float above = (white->t.y + outer) - (yolk->t.y + inner), below = (yolk->t.y - inner) - (white->t.y - outer);
        assert_true(above > 0.0f && above < 0.01f * outer);
        assert_true(fabsf(below / outer - 2.0f * (1.0f - 0.525f)) < 0.02f);
        assert_true(hypotf(yolk->t.x - white->t.x, yolk->t.z - white->t.z) < 1e-6f);
    }
    ty_aggregate_destroy(a);
}

// From the middle up to the membrane, and there they stay, whatever way the eggs have rolled meanwhile.
static void yolks_float_up(void** state)
{
    (void)state;
    static film f;
    ty_aggregate_recipe r = spoonful(EGGS, 61, 20.0f);
    r.fill.sprinkle = 0.5f;
    shoot(&r, NULL, &f);
    float rolled = 0.0f;
    for (uint32_t i = 0; i < EGGS; i++)
    {
        assert_true(ty_length(yolk_off(&f, 0, i, EGGS)) < 1e-9f);
        for (int frame = 0; frame < 61; frame++)
        {
            const ty_affine* all = f.transforms[frame];
            assert_true(ty_length(yolk_off(&f, frame, i, EGGS)) < room());
            assert_true(ty_length(ty_sub(all[i].t, all[i + EGGS].t)) == 0.0f);
        }
        ty_vec3 off = yolk_off(&f, 60, i, EGGS);
        assert_true(off.y > 0.98f * room() && hypotf(off.x, off.z) < 0.02f * room());
        assert_true(off.y > yolk_off(&f, 5, i, EGGS).y + 1e-4f);
        rolled = ty_max(rolled, ty_length(ty_sub(f.transforms[60][i].t, f.transforms[0][i].t)) / radius);
        assert_true(ty_length_sqr(f.spins[i]) == 0.0f); // shown upright
    }
    assert_true(rolled > 1.0f);
    r.element.roe.buoyancy = -110.0f;
    shoot(&r, NULL, &f);
    assert_true(yolk_off(&f, 60, 0, EGGS).y < -0.98f * room());
}

// In a white as thick as syrup a yolk rises at 2/9 of the difference of density g a^2 / viscosity, but 8.6 times slower
// in an egg that is not twice as wide: the wall.
static void yolks_rise_by_stokes(void** state)
{
    (void)state;
    static film f;
    ty_aggregate_recipe r = spoonful(1, 101, 50.0f);
    r.element.roe.viscosity = 1.0f;
    shoot(&r, NULL, &f);
    double a = (radius - shell) * cbrt(0.145), k = cbrt(0.145);
    double wall = (1 - pow(k, 5)) / (1 - 2.25 * k + 2.5 * pow(k, 3) - 2.25 * pow(k, 5) + pow(k, 6));
    double expected = 2.0 / 9.0 * 110.0 * 9.81 * a * a / (1.0 * wall);
    double found = (double)(yolk_off(&f, 100, 0, 1).y - yolk_off(&f, 50, 0, 1).y);
    print_message("  %.3g um/s, expected %.3g; the wall slows by %.2f\n", found * 1e6, expected * 1e6, wall);
    assert_true(fabs(wall - 8.6) < 0.05 && fabs(found / expected - 1.0) < 0.01);
    ty_vec3 rate = ty_mul(ty_sub(f.transforms[76][2].t, f.transforms[74][2].t), 25.0f);
    assert_true(ty_length(ty_sub(rate, f.velocities[75][2])) < 0.02f * ty_length(rate));
}

// What falls freely has no weight: on its way down an egg leaves its yolk where it is.
static void yolks_fall_with_their_eggs(void** state)
{
    (void)state;
    static film f;
    ty_aggregate_recipe r = spoonful(EGGS, 20, 100.0f);
    r.fill.sprinkle = 0.5f;
    shoot(&r, NULL, &f);
    int falling = 0, standing = 0;
    bool falls[EGGS];
    memset(falls, 1, sizeof falls);
    for (int frame = 1; frame < 20; frame++)
        for (uint32_t i = 0; i < EGGS; i++)
        {
            float now = f.velocities[frame][i].y, last = f.velocities[frame - 1][i].y;
            float rise = f.velocities[frame][i + 2 * EGGS].y - now;
            // Gravity comes up over the first five frames.
            float gained = frame > 5 ? 0.0981f : 0.00981f * (float)(2 * frame - 1);
            falls[i] = falls[i] && fabsf(last - now - gained) < 1e-3f;
            bool stands = fabsf(now) < 1e-4f && fabsf(last) < 1e-4f && frame > 7;
            assert_true(!falls[i] || fabsf(rise) < 0.1e-3f);
            assert_true(!stands || rise > 3e-3f || yolk_off(&f, frame, i, EGGS).y > 0.98f * room());
            falling += falls[i];
            standing += stands;
        }
    print_message("  %d falling, %d standing\n", falling, standing);
    assert_true(falling > 5 && standing > 5);
}

static void threads_change_nothing(void** state)
{
    (void)state;
    static film one, three;
    ty_aggregate_recipe r = spoonful(EGGS, 5, 24.0f);
    shoot(&r, NULL, &one);
    ty_workers* workers;
    ty_error error;
    assert_int_equal(ty_workers_create(3, &workers, &error), TY_OK);
    shoot(&r, workers, &three);
    ty_workers_destroy(workers);
    assert_memory_equal(one.transforms, three.transforms, sizeof one.transforms);
    assert_memory_equal(one.velocities, three.velocities, sizeof one.velocities);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(still_yolks_touch_the_top), cmocka_unit_test(yolks_float_up),
        cmocka_unit_test(yolks_rise_by_stokes),      cmocka_unit_test(yolks_fall_with_their_eggs),
        cmocka_unit_test(threads_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
