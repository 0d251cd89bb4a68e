// SPDX-License-Identifier: Apache-2.0
// Chapter 4 of Watanabe 2023 in figures: closing times, what stays, lanes, what starts spots and stripes.
#include "base/cmocka_all.h"
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/generate/fill_recipe.h>

enum
{
    N = 200
};

typedef struct look
{
    int empty, marked;   // cells with v <= .15, cells of another mark than the first
    float *v, *trail;    // of the last frame
    int* empty_by_frame; // [frames + 1]
} look;

static ty_fill_mark marks[5];

static ty_fill_mark mark_of(float feed, float kill)
{
    ty_fill_mark mark = {.feed = feed, .kill = kill, .color = {1, 1, 1}, .opacity = 1, .ground_opacity = 1};
    mark.seed = (ty_fill_seeding){.radius = 5.0f, .seed = {3}};
    return mark;
}

static ty_fill_recipe chapter(int frames, int steps)
{
    static const char* outputs[] = {"v", "trail"};
    static const float rates[5][2] = {
        {0.072f, 0.059f}, {0.052f, 0.079f}, {0.072f, 0.060f}, {0.0265f, 0.0605f}, {0.067f, 0.062f}};
    for (int i = 0; i < 5; i++)
        marks[i] = mark_of(rates[i][0], rates[i][1]);
    ty_fill_recipe r = ty_fill_recipe_default();
    r.cells[0] = r.cells[1] = N;
    r.scale = 1;
    r.tile = TY_PATTERN_TILE_NONE;
    r.start = TY_PATTERN_START_PLAIN;
    r.marks = (ty_param_list){marks, 5};
    r.run.frames = frames;
    r.run.steps = (float)steps;
    r.outputs = (ty_param_strings){outputs, 2};
    return r;
}

static ty_fill_event event_of(int at, ty_fill_op op, float x, float y, float radius, const char* mark)
{
    return (ty_fill_event){.at = at,
                           .op = (int)op,
                           .mark = mark,
                           .center = {x, y},
                           .size = {16, 16},
                           .to = {-1, -1},
                           .radius = radius,
                           .radius_to = -1,
                           .threshold = 0.5f};
}

static ty_status put(void* context, int frame, ty_exr* image, ty_error* error)
{
    look* l = context;
    (void)error;
    const float* v = ty_exr_find_channel(image, "v")->pixels;
    l->empty = 0;
    for (int i = 0; i < N * N; i++)
        l->empty += v[i] <= 0.15f;
    l->empty_by_frame[frame] = l->empty;
    memcpy(l->v, v, N * N * sizeof(float));
    memcpy(l->trail, ty_exr_find_channel(image, "trail")->pixels, N * N * sizeof(float));
    return TY_OK;
}

static void make(const ty_fill_recipe* r, look* out)
{
    ty_error error = {0};
    *out = (look){.v = TY_ALLOC(float, N* N), .trail = TY_ALLOC(float, N* N)};
    out->empty_by_frame = TY_ALLOC(int, r->run.frames + 1);
    const ty_frame_sink sink = {put, NULL, out};
    if (ty_fill_make(r, NULL, &sink, &error) != TY_OK)
        fail_msg("%s", error.text);
}

static void forget(look* l)
{
    ty_free(l->v);
    ty_free(l->trail);
    ty_free(l->empty_by_frame);
}

// Maxima of v above .2 nearer than radius to (x, y).
static int spots(const look* l, float x, float y, float radius)
{
    int count = 0;
    for (int j = 1; j < N - 1; j++)
        for (int i = 1; i < N - 1; i++)
        {
            const float* v = l->v + j * N + i;
            bool top = *v > 0.2f && v[0] >= v[-1] && v[0] > v[1] && v[0] >= v[-N] && v[0] > v[N];
            count += top && ty_sqr((float)i + 0.5f - x) + ty_sqr((float)j + 0.5f - y) < radius * radius;
        }
    return count;
}

static float cover(const look* l, float x, float y, float radius)
{
    int filled = 0, all = 0;
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            if (ty_sqr((float)i + 0.5f - x) + ty_sqr((float)j + 0.5f - y) < radius * radius)
            {
                all++;
                filled += l->v[j * N + i] > 0.15f;
            }
    return (float)filled / (float)all;
}

// --- 4.1 ---

static void holes_close_in_72_r(void** state)
{
    (void)state;
    const float radii[] = {11, 16, 25, 36, 54};
    for (int i = 0; i < 5; i++)
    {
        ty_fill_recipe r = chapter(430, 10);
        ty_fill_event hole = event_of(1, TY_FILL_HOLE, 100, 100, radii[i], NULL);
        r.events = (ty_param_list){&hole, 1};
        look l;
        make(&r, &l);
        int frame = 1;
        while (frame < 430 && l.empty_by_frame[frame] > 0)
            frame++;
        float rate = (float)(frame - 1) * 10.0f / radii[i];
        print_message("4.1: r %g closes in %d, %.1f r\n", (double)radii[i], (frame - 1) * 10, (double)rate);
        assert_float_equal(rate, 72.0f, 72.0f * 0.03f);
        forget(&l);
    }
}

static void overlapping_holes_are_no_case_of_their_own(void** state)
{
    (void)state;
    ty_fill_recipe r = chapter(100, 50);
    ty_fill_event events[] = {event_of(1, TY_FILL_HOLE, 90, 100, 30, NULL),
                              event_of(31, TY_FILL_HOLE, 125, 100, 20, NULL)};
    r.events = (ty_param_list){events, 2};
    look l;
    make(&r, &l);
    int frame = 31;
    assert_true(l.empty_by_frame[30] > 100 && l.empty_by_frame[31] > l.empty_by_frame[30] + 1000);
    while (frame < 100 && l.empty_by_frame[frame] > 0)
        frame++;
    print_message("4.1: cut at 1500 while another closes, all closed at %d\n", (frame - 1) * 50);
    assert_in_range((frame - 1) * 50, 2700, 3100); // 1500 and 72 times 20
    forget(&l);
}

// --- 4.2 ---

static void a_dying_mark_keeps_its_hole(void** state)
{
    (void)state;
    ty_fill_recipe r = chapter(13, 5000);
    ty_fill_event hole = event_of(1, TY_FILL_HOLE, 100.5f, 100.5f, 30, "1");
    r.events = (ty_param_list){&hole, 1};
    look l;
    make(&r, &l);
    print_message("4.2: %d cells empty, at 5000 %d, at 60000 %d\n", l.empty_by_frame[1], l.empty_by_frame[2],
                  l.empty_by_frame[13]);
    assert_in_range(l.empty_by_frame[1], 2800, 2830);
    assert_in_range(l.empty_by_frame[2], 2760, 2821);
    assert_int_equal(l.empty_by_frame[2], l.empty_by_frame[13]);
    forget(&l);
}

static void unmarked_places_fill_from_the_rim_alone(void** state)
{
    (void)state;
    ty_fill_recipe r = chapter(2, 20000);
    ty_fill_event events[] = {event_of(1, TY_FILL_HOLE, 100, 100, 30, "1"),
                              event_of(1, TY_FILL_UNMARK, 72, 100, 12, NULL),
                              event_of(1, TY_FILL_UNMARK, 108, 100, 8, NULL)};
    r.events = (ty_param_list){events, 3};
    look l;
    make(&r, &l);
    float rim = cover(&l, 78, 100, 5), middle = cover(&l, 108, 100, 8);
    print_message("4.2: unmarked at the rim %.2f filled, in the interior %.2f\n", (double)rim, (double)middle);
    assert_true(rim > 0.95f && middle == 0.0f);
    forget(&l);
}

// --- 4.3 ---

static void a_slow_mark_falls_behind(void** state)
{
    (void)state;
    ty_fill_recipe r = chapter(2, 6000);
    ty_fill_event events[] = {event_of(1, TY_FILL_BARRIER, 100, 100, 0, NULL),
                              event_of(1, TY_FILL_BARRIER, 100, 100, 0, NULL),
                              event_of(1, TY_FILL_MARK, 151, 100, 0, "2"), event_of(1, TY_FILL_FILL, 100, 14, 0, NULL)};
    const float sizes[4][2] = {{192, 192}, {4, 200}, {98, 200}, {200, 20}};
    for (int i = 0; i < 4; i++)
    {
        events[i].shape = TY_FILL_RECTANGLE;
        memcpy(events[i].size, sizes[i], sizeof sizes[i]);
    }
    events[0].invert = true;
    r.start = TY_PATTERN_START_EMPTY;
    r.events = (ty_param_list){events, 4};
    look l;
    make(&r, &l);
    int rows[2] = {0, 0};
    for (int y = 0; y < N; y++)
        for (int lane = 0; lane < 2; lane++)
            if (l.v[y * N + 50 + 100 * lane] > 0.15f)
                rows[lane] = y;
    print_message("4.3: at 6000 the lanes are at rows %d and %d: %.2f\n", rows[0], rows[1],
                  (double)(rows[1] - 23) / (double)(rows[0] - 23));
    assert_in_range(rows[0], 108, 112);
    assert_in_range(rows[1], 76, 80);
    forget(&l);
}

// --- 4.4 ---

static int spots_after(float radius, float spacing, float rough, int steps)
{
    ty_fill_recipe r = chapter(2, steps);
    ty_fill_event hole = event_of(1, TY_FILL_HOLE, 100, 100, radius, "3");
    marks[3].seed.spacing = spacing;
    marks[3].seed.rough = rough;
    r.events = (ty_param_list){&hole, 1};
    look l;
    make(&r, &l);
    int count = spots(&l, 100, 100, radius - 7.0f);
    print_message("4.4: r %g, spots dropped %g cells apart, outline rough by %g: %d spots at %d\n", (double)radius,
                  (double)spacing, (double)rough, count, steps);
    forget(&l);
    return count;
}

static void spots_need_something_to_start_from(void** state)
{
    (void)state;
    assert_int_equal(spots_after(55, 0, 0, 40000), 0);
    assert_true(spots_after(55, 20, 3, 5000) > 15);
    assert_true(spots_after(55, 20, 3, 15000) > 30);
    assert_true(spots_after(25, 20, 3, 15000) <= 6);
    assert_int_equal(spots_after(12, 20, 3, 15000), 0); // the rim eats them
}

// --- 4.5 ---

static float stripes_after(float jitter, int steps)
{
    ty_fill_recipe r = chapter(2, steps);
    ty_fill_event hole = event_of(1, TY_FILL_HOLE, 100, 100, 60, "4");
    marks[4].seed.jitter = jitter;
    r.events = (ty_param_list){&hole, 1};
    look l;
    make(&r, &l);
    float covered = cover(&l, 100, 100, 54);
    print_message("4.5: feed differs by %g: %.3f covered at %d\n", (double)jitter, (double)covered, steps);
    forget(&l);
    return covered;
}

static void stripes_need_an_uneven_outline(void** state)
{
    (void)state;
    assert_true(stripes_after(0.0f, 80000) < 0.01f);
    assert_true(stripes_after(0.02f, 4000) < 0.01f);
    assert_true(stripes_after(0.02f, 10000) > 0.02f);
    assert_float_equal(stripes_after(0.02f, 40000), 0.55f, 0.06f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(holes_close_in_72_r),
        cmocka_unit_test(overlapping_holes_are_no_case_of_their_own),
        cmocka_unit_test(a_dying_mark_keeps_its_hole),
        cmocka_unit_test(unmarked_places_fill_from_the_rim_alone),
        cmocka_unit_test(a_slow_mark_falls_behind),
        cmocka_unit_test(spots_need_something_to_start_from),
        cmocka_unit_test(stripes_need_an_uneven_outline),
    };
    ty_log_set_level(TY_LOG_ERROR);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
