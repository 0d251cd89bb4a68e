// SPDX-License-Identifier: Apache-2.0
// A heap as it settles, frame by frame: the same grains, moving as they fall, to the bit for any number of threads.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include <string.h>
#include <tsuya/generate/aggregate_recipe.h>

enum
{
    GRAINS = 40,
    FRAMES = 7
};

typedef struct film
{
    ty_affine transforms[FRAMES][GRAINS];
    ty_vec3 velocities[FRAMES][GRAINS], spins[FRAMES][GRAINS];
    ty_mesh* prototypes[2];
    int shown, fails_at;
} film;

static ty_status keep(void* context, int frame, ty_aggregate* a, ty_error* error)
{
    film* f = context;
    if (frame == f->fails_at)
        return ty_error_set(error, TY_BAD_FILE, "full");
    assert_int_equal(frame, ++f->shown);
    assert_int_equal(a->instance_count, GRAINS);
    assert_int_equal(a->prototype_count, 2);
    assert_non_null(ty_aggregate_find_attribute(a, "moisture"));
    assert_non_null(a->metrics);
    if (frame == 1)
        memcpy(f->prototypes, a->prototypes, sizeof f->prototypes);
    assert_memory_equal(f->prototypes, a->prototypes, sizeof f->prototypes);
    for (uint32_t i = 0; i < GRAINS; i++)
        assert_int_equal(a->ids[i], i);
    memcpy(f->transforms[(frame - 1) % FRAMES], a->transforms, sizeof f->transforms[0]);
    memcpy(f->velocities[(frame - 1) % FRAMES], a->velocities, sizeof f->velocities[0]);
    memcpy(f->spins[(frame - 1) % FRAMES], a->spins, sizeof f->spins[0]);
    return TY_OK;
}

static ty_aggregate_recipe recipe_make(void)
{
    ty_aggregate_recipe recipe = ty_aggregate_recipe_default();
    recipe.fill.count = GRAINS;
    recipe.element.variants = 2;
    recipe.animate.frames = FRAMES;
    recipe.animate.fps = 30.0f;
    return recipe;
}

static double mean_height(const film* f, int frame)
{
    double sum = 0.0;
    for (int i = 0; i < GRAINS; i++)
        sum += (double)f->transforms[frame][i].t.y;
    return sum / GRAINS;
}

static float largest_move(const film* f, int frame)
{
    float most = 0.0f;
    for (int i = 0; i < GRAINS; i++)
        most = ty_max(most, ty_length(ty_sub(f->transforms[frame][i].t, f->transforms[frame - 1][i].t)));
    return most;
}

// The first frame is the fill, then grains fall, and what came to rest stays.
static void falls_and_rests(void** state)
{
    (void)state;
    static film f;
    ty_aggregate_recipe recipe = recipe_make();
    recipe.animate.fps = 10.0f;
    ty_error error;
    ty_aggregate_sink sink = {keep, &f};
    assert_int_equal(ty_aggregate_film(&recipe, NULL, &sink, &error), TY_OK);
    assert_int_equal(f.shown, FRAMES);
    assert_true(mean_height(&f, 1) < mean_height(&f, 0) - 0.3e-3);
    assert_true(largest_move(&f, 1) > 2e-3f);
    assert_true(largest_move(&f, FRAMES - 1) < 0.1e-3f);
}

// One substep a frame: the velocities are those with which the instances came to where they are, the spins too.
static void velocities_tell_moves(void** state)
{
    (void)state;
    static film f;
    ty_aggregate_recipe recipe = recipe_make();
    recipe.settle.rate = 1000.0f;
    recipe.animate.fps = 1000.0f;
    recipe.animate.frames = 14 * FRAMES;
    ty_error error;
    ty_aggregate_sink sink = {keep, &f};
    assert_int_equal(ty_aggregate_film(&recipe, NULL, &sink, &error), TY_OK);
    double moved = 0.0, off = 0.0, turned = 0.0, beside = 0.0;
    for (int i = 0; i < GRAINS; i++)
    {
        const ty_affine *a = &f.transforms[FRAMES - 2][i], *b = &f.transforms[FRAMES - 1][i];
        ty_vec3 v = ty_mul(ty_sub(b->t, a->t), 1000.0f),
                w = ty_mul(ty_cross(a->x, b->x), 1000.0f / ty_length_sqr(a->x));
        w = ty_add(w, ty_mul(ty_add(ty_cross(a->y, b->y), ty_cross(a->z, b->z)), 1000.0f / ty_length_sqr(a->y)));
        moved += (double)ty_length(v);
        off += (double)ty_length(ty_sub(v, f.velocities[FRAMES - 1][i]));
        turned += (double)ty_length(ty_mul(w, 0.5f)); // each axis tells what lies across it
        beside += (double)ty_length(ty_sub(ty_mul(w, 0.5f), f.spins[FRAMES - 1][i]));
    }
    assert_true(moved > 0.0 && off < 0.05 * moved); // the relax sweep comes after the move
    assert_true(turned > 0.0 && beside < 0.1 * turned);
}

// Twice the frames a second: every second frame is the same.
static void frames_are_moments(void** state)
{
    (void)state;
    static film slow, quick;
    ty_aggregate_recipe recipe = recipe_make();
    ty_error error;
    recipe.animate.fps = 25.0f;
    ty_aggregate_sink sink = {keep, &slow};
    assert_int_equal(ty_aggregate_film(&recipe, NULL, &sink, &error), TY_OK);
    recipe.animate.fps = 50.0f;
    sink.context = &quick;
    ty_workers* workers;
    assert_int_equal(ty_workers_create(3, &workers, &error), TY_OK);
    assert_int_equal(ty_aggregate_film(&recipe, workers, &sink, &error), TY_OK);
    ty_workers_destroy(workers);
    for (int i = 0; 2 * i < FRAMES; i++)
        assert_memory_equal(slow.transforms[i], quick.transforms[2 * i], sizeof slow.transforms[0]);
}

static void refused(void** state)
{
    (void)state;
    static film f = {.fails_at = 3};
    ty_aggregate_recipe recipe = recipe_make();
    ty_error error;
    ty_aggregate_sink sink = {keep, &f};
    assert_int_equal(ty_aggregate_film(&recipe, NULL, &sink, &error), TY_BAD_FILE);
    assert_int_equal(f.shown, 2);
    recipe.animate.frames = 0;
    assert_int_equal(ty_aggregate_film(&recipe, NULL, &sink, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "animate.frames"));
    recipe = recipe_make();
    recipe.settle.solver = TY_SOLVER_XPBD;
    assert_int_equal(ty_aggregate_film(&recipe, NULL, &sink, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "solver"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(falls_and_rests),
        cmocka_unit_test(velocities_tell_moves),
        cmocka_unit_test(frames_are_moments),
        cmocka_unit_test(refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
