// SPDX-License-Identifier: Apache-2.0
// The recipes of scenes/fill_events: holes that overlap, one cut while another fills, a wall put up while a fill
// spreads. None of them is a special case: all close when the largest disc in them would, and walls keep what is behind
// them.
#include "scene/fixture.h"
#include <math.h>
#include <tsuya/image/exr.h>

enum
{
    WIDE = 192,
    HIGH = 128,
    MOST = 140
};

#define LEVEL 0.15f

typedef struct film
{
    ty_exr* frames[MOST + 1]; // by number, u and v
    int count;
} film;

static film make(const char* name, int count)
{
    static const char* const sets[] = {"scale=1", "outputs=[u, v]"};
    char recipe[TY_PATH_MAX], pattern[TY_PATH_MAX], path[TY_PATH_MAX];
    ty_scene_options options = {.sets = (const char**)sets, .set_count = 2};
    film f = {.count = count};
    ty_error error = {0};
    ty_path_join(SCENES "/fill_events", name, recipe);
    fixture_clear();
    ty_status status =
        ty_recipe_make(recipe, "fill", fixture_path("events.###.exr", pattern), 0, &options, &fixture_errors);
    fixture_print_errors();
    assert_int_equal(status, TY_OK);
    for (int i = 1; i <= count; i++)
    {
        ty_path_frame(pattern, i, path);
        if (ty_exr_read(path, &f.frames[i], &error) != TY_OK)
            fail_msg("%s", error.text);
        unlink(path);
    }
    return f;
}

static void forget(film* f)
{
    for (int i = 1; i <= f->count; i++)
        ty_exr_destroy(f->frames[i]);
}

static const float* plane(const film* f, int frame, const char* name)
{
    const ty_exr_channel* found = ty_exr_find_channel(f->frames[frame], name);
    assert_non_null(found);
    return found->pixels;
}

// Cells of [x0, x1) x [y0, y1) below the level. All that is there is finite.
static int empty_cells(const film* f, int frame, int x0, int y0, int x1, int y1)
{
    const float *u = plane(f, frame, "u"), *v = plane(f, frame, "v");
    int count = 0;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
        {
            const int at = y * WIDE + x;
            assert_true(u[at] >= 0.0f && u[at] <= 1.0f && v[at] >= 0.0f && v[at] < 1.0f);
            count += v[at] < LEVEL;
        }
    return count;
}

// The largest v of the closed cell of barrier.yaml; its u is that of an empty field, to the bit.
static float most_within(const film* f, int frame)
{
    const float *u = plane(f, frame, "u"), *v = plane(f, frame, "v");
    float most = 0.0f;
    for (int y = 20; y < 68; y++)
        for (int x = 112; x < 168; x++)
        {
            assert_true(u[y * WIDE + x] == 1.0f);
            most = fmaxf(most, v[y * WIDE + x]);
        }
    return most;
}

static int closed_at(const film* f, int from)
{
    while (from < f->count && empty_cells(f, from, 0, 0, WIDE, HIGH) > 0)
        from++;
    return from;
}

// Cells to the nearest filled one from that which is farthest: the radius of the largest disc in what is empty.
static float largest_disc(const film* f, int frame)
{
    const float* v = plane(f, frame, "v");
    float most = 0.0f;
    for (int i = 0; i < WIDE * HIGH; i++)
    {
        float least = v[i] < LEVEL ? 1e9f : 0.0f;
        for (int k = 0; k < WIDE * HIGH && least > most; k++)
        {
            const float x = (float)(k % WIDE - i % WIDE), y = (float)(k / WIDE - i / WIDE);
            if (v[k] >= LEVEL && x * x + y * y < least)
                least = x * x + y * y;
        }
        most = fmaxf(most, least);
    }
    return sqrtf(most);
}

// Within 3 %, and the frame on either side.
static void assert_closes(const char* what, const film* f, int from, int steps)
{
    const float radius = largest_disc(f, from), rate = (float)((closed_at(f, from) - from) * steps) / radius;
    print_message("%s: largest disc %.1f cells, closed %d steps later, %.1f times that\n", what, (double)radius,
                  (closed_at(f, from) - from) * steps, (double)rate);
    assert_true(closed_at(f, from) < f->count);
    assert_float_equal(rate, 72.0f, 72.0f * 0.03f + (float)steps / radius);
}

static void overlapping_holes_close_as_the_largest_disc_in_them(void** state)
{
    (void)state;
    film f = make("overlap.yaml", 49);
    assert_in_range(empty_cells(&f, 1, 0, 0, WIDE, HIGH), 5400, 6000); // less than two discs, 6,195
    assert_closes("overlapping", &f, 1, 60);
    forget(&f);
}

static void a_hole_cut_while_another_fills_joins_it(void** state)
{
    (void)state;
    film f = make("meanwhile.yaml", 61);
    const int before = empty_cells(&f, 25, 0, 0, WIDE, HIGH), after = empty_cells(&f, 26, 0, 0, WIDE, HIGH);
    assert_true(before > 500 && after > before + 1200); // 2,463 cells, some of which were empty
    assert_closes("cut meanwhile", &f, 26, 60);
    forget(&f);
}

static void a_wall_stops_what_spreads(void** state)
{
    (void)state;
    film f = make("barrier.yaml", 131);
    // where the front stands when the wall is put up, and that it is passed through the gap alone
    assert_true(plane(&f, 21, "v")[50 * WIDE + 48] > LEVEL && plane(&f, 21, "v")[50 * WIDE + 60] < LEVEL);
    assert_true(plane(&f, 45, "v")[10 * WIDE + 74] > LEVEL && plane(&f, 45, "v")[120 * WIDE + 84] > LEVEL);
    assert_int_equal(empty_cells(&f, 45, 80, 0, WIDE, 60), (WIDE - 80) * 60);
    // all around the closed cell it fills; within, the far end of the front's tail that was walled in dies away
    assert_true(most_within(&f, 21) < 1e-20f);
    for (int frame = 22; frame <= 90; frame++)
        assert_true(most_within(&f, frame) <= most_within(&f, frame - 1));
    assert_int_equal(empty_cells(&f, 90, 80, 60, 108, HIGH), 0);
    assert_true(plane(&f, 97, "v")[44 * WIDE + 114] > LEVEL);
    assert_int_equal(empty_cells(&f, 131, 112, 20, 168, 68), 0);
    forget(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(overlapping_holes_close_as_the_largest_disc_in_them),
        cmocka_unit_test(a_hole_cut_while_another_fills_joins_it),
        cmocka_unit_test(a_wall_stops_what_spreads),
    };
    return cmocka_run_group_tests(tests, fixture_begin, fixture_end);
}
