// SPDX-License-Identifier: Apache-2.0
// The turn is exact, centred planes come back as mirrors, tiles tile, figures are what they say.
#include "loop_frames.h"

enum
{
    FRAMES = 48,
    SIDE = 40 // voxels, and pixels
};

static ty_loop_recipe base(void)
{
    ty_loop_recipe recipe = ty_loop_recipe_default();
    recipe.frames = FRAMES;
    recipe.size[0] = recipe.size[1] = SIDE;
    return recipe;
}

static void turns_are_exact(void** state)
{
    (void)state;
    for (int n = 1; n <= 64; n++)
        for (int e = 0; e <= 4; e++)
            for (int i = 0; i < n; i++)
            {
                float easing = 0.25f * (float)e;
                double s, c, s2, c2, t = (double)i / n;
                ty_loop_turn(i, n, easing, &s, &c);
                double angle = 2.0 * M_PI * t - 0.5 * (double)easing * sin(4.0 * M_PI * t);
                assert_true(fabs(s - sin(angle)) < 3e-7 && fabs(c - cos(angle)) < 3e-7);
                ty_loop_turn(i + 3 * n, n, easing, &s2, &c2);
                assert_true(s2 == s && c2 == c);
                ty_loop_turn(-i, n, easing, &s2, &c2);
                assert_true(s2 == -s && c2 == c);
                if (n % 2)
                    continue;
                ty_loop_turn(i + n / 2, n, easing, &s2, &c2);
                assert_true(s2 == -s && c2 == -c);
            }
}

// --- what a loop is ---

static void centred_planes_come_back_as_mirrors(void** state)
{
    (void)state;
    ty_loop_volume volume = loop_waves(SIDE + 1, 14.0f, false, 3);
    ty_loop_recipe recipe = base();
    for (int i = 0; i < FRAMES / 2; i += 5)
    {
        uint8_t *a = loop_inside(&recipe, &volume, i), *b = loop_inside(&recipe, &volume, i + FRAMES / 2);
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
                assert_int_equal(a[y * SIDE + x], b[y * SIDE + SIDE - 1 - x]);
        ty_free(a);
        ty_free(b);
    }
    ty_loop_volume_term(&volume);
}

// The values of frame i.
static float* values_of(const ty_loop_recipe* recipe, const ty_loop_volume* volume, int64_t i)
{
    ty_loop_painter* painter;
    const float* values;
    size_t size = (size_t)recipe->size[0] * (size_t)recipe->size[1] * sizeof(float);
    assert_int_equal(ty_loop_painter_create(recipe, volume, NULL, &painter, NULL), TY_OK);
    assert_int_equal(ty_loop_painter_slice(painter, i, recipe->frames, &values, NULL), TY_OK);
    float* copy = ty_alloc(size, 1);
    memcpy(copy, values, size);
    ty_loop_painter_destroy(painter);
    return copy;
}

static void orbits_tile(void** state)
{
    (void)state;
    ty_loop_volume volume = loop_waves(SIDE, 14.0f, true, 8);
    ty_loop_recipe recipe = base();
    recipe.motion.kind = TY_LOOP_ORBIT;
    double across_edge = 0.0, within = 0.0, between = 0.0, first_step = 0.0;
    float* last = NULL;
    for (int i = 0; i <= FRAMES; i++)
    {
        float* now = values_of(&recipe, &volume, i);
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
            {
                double step = fabs((double)now[y * SIDE + (x + 1) % SIDE] - (double)now[y * SIDE + x]);
                double down = fabs((double)now[(y + 1) % SIDE * SIDE + x] - (double)now[y * SIDE + x]);
                within = x < SIDE - 1 && step > within ? step : within;
                within = y < SIDE - 1 && down > within ? down : within;
                across_edge = x == SIDE - 1 && step > across_edge ? step : across_edge;
                across_edge = y == SIDE - 1 && down > across_edge ? down : across_edge;
                if (last)
                    between += fabs((double)now[y * SIDE + x] - (double)last[y * SIDE + x]);
            }
        first_step = i == 1 ? between : first_step;
        ty_free(last);
        last = now;
    }
    ty_free(last);
    ty_loop_volume_term(&volume);
    assert_true(across_edge <= within);
    assert_true(first_step > 0.0 && fabs(between / FRAMES - first_step) < 0.25 * first_step); // uniform speed
}

static void steps_are_as_long_as_they_are_said_to_be(void** state)
{
    (void)state;
    const int size[3] = {256, 256, 256};
    ty_loop_recipe recipe = base();
    recipe.frames = 180;
    // 2 degrees at the rim of 128 voxels: 4.5 voxels.
    double chord = 2.0 * 128.0 * sin(M_PI / 180.0);
    assert_true(fabs(ty_loop_motion_step(&recipe, size, 7, 180) - chord) < 1e-3);
    recipe.motion.kind = TY_LOOP_ORBIT;
    assert_true(fabs(ty_loop_motion_step(&recipe, size, 7, 180) - 0.25 * chord) < 1e-3);
    recipe.motion.kind = TY_LOOP_REST;
    assert_true(ty_loop_motion_step(&recipe, size, 7, 180) == 0.0);
}

static void what_lies_beside_the_volume_is_told(void** state)
{
    (void)state;
    ty_loop_volume volume = loop_waves(SIDE, 14.0f, false, 1);
    ty_loop_recipe recipe = base();
    assert_true(ty_loop_motion_outside(&recipe, &volume, 0) == 0.0);
    recipe.plane.center.x = 1.0f; // its right half is out
    assert_true(fabs(ty_loop_motion_outside(&recipe, &volume, 0) - 0.5) < 0.05);
    recipe.plane.center.x = 2.1f;
    assert_true(ty_loop_motion_outside(&recipe, &volume, 0) == 1.0);
    ty_loop_volume_term(&volume);
    volume = loop_waves(SIDE, 14.0f, true, 1);
    assert_true(ty_loop_motion_outside(&recipe, &volume, 0) == 0.0);
    ty_loop_volume_term(&volume);
}

static void figures_of_pairs_are_cohens(void** state)
{
    (void)state;
    ty_loop_pair p = ty_loop_pair_of(100, 30, 40, 20);
    assert_true(fabs(p.changed - 0.30) < 1e-12 && fabs(p.overlap - 20.0 / 30.0) < 1e-12);
    assert_true(fabs(p.jaccard - 0.4) < 1e-12 && fabs(p.density - 0.3) < 1e-12);
    assert_true(fabs(p.kappa - (0.7 - 0.54) / 0.46) < 1e-12);
    assert_true(fabs(ty_loop_pair_of(100, 20, 20, 4).kappa) < 1e-12); // as if by chance
    assert_true(ty_loop_pair_of(100, 20, 20, 20).kappa == 1.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turns_are_exact),
        cmocka_unit_test(centred_planes_come_back_as_mirrors),
        cmocka_unit_test(orbits_tile),
        cmocka_unit_test(steps_are_as_long_as_they_are_said_to_be),
        cmocka_unit_test(what_lies_beside_the_volume_is_told),
        cmocka_unit_test(figures_of_pairs_are_cohens),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
