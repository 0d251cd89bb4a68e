// SPDX-License-Identifier: Apache-2.0
// Runs of a fill: events at their frame, holes that close when they are told, mattes that add up, going on to the bit.
#include "base/cmocka_all.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/generate/fill_recipe.h>

enum
{
    N = 96,
    MOST = 64
};

typedef struct film
{
    ty_exr* frames[MOST + 1]; // by number
    ty_exr* state;
    int stop_after; // frame; 0 = none
} film;

static ty_exr* exr_copy(const ty_exr* from)
{
    ty_exr* copy = ty_exr_create(from->data_window, from->display_window);
    size_t size = (size_t)ty_exr_width(from) * (size_t)ty_exr_height(from) * 4;
    for (int i = 0; i < from->channel_count; i++)
        memcpy(ty_exr_add_channel(copy, from->channels[i].name, from->channels[i].type), from->channels[i].pixels,
               size);
    for (int i = 0; i < from->attribute_count; i++)
        if (from->attributes[i].type == TY_EXR_STRING)
            ty_exr_add_string(copy, from->attributes[i].name, from->attributes[i].text);
        else if (from->attributes[i].type == TY_EXR_INT1)
            ty_exr_add_int(copy, from->attributes[i].name, from->attributes[i].integer[0]);
    return copy;
}

static ty_status put(void* context, int frame, ty_exr* image, ty_error* error)
{
    film* f = context;
    (void)error;
    assert_in_range(frame, 1, MOST);
    assert_null(f->frames[frame]);
    f->frames[frame] = exr_copy(image);
    if (frame == f->stop_after)
        ty_cancel_request(0);
    return TY_OK;
}

static ty_status keep(void* context, ty_exr* state, ty_error* error)
{
    film* f = context;
    (void)error;
    assert_null(f->state);
    f->state = exr_copy(state);
    return TY_OK;
}

static void forget(film* f)
{
    for (int i = 0; i <= MOST; i++)
        ty_exr_destroy(f->frames[i]);
    ty_exr_destroy(f->state);
    *f = (film){0};
}

static ty_status make(const ty_fill_recipe* recipe, film* out, ty_error* error)
{
    const ty_frame_sink sink = {put, keep, out};
    return ty_fill_make(recipe, NULL, &sink, error);
}

static void must_make(const ty_fill_recipe* recipe, film* out)
{
    ty_error error = {0};
    ty_status status = make(recipe, out, &error);
    if (status != TY_OK)
        print_message("%s\n", error.text);
    assert_int_equal(status, TY_OK);
}

static const char* all_outputs[] = {"u", "v", "mark", "trail", "distance", "mattes"};

static ty_fill_mark mark_of(const char* name, int preset)
{
    ty_fill_mark mark = {.name = name, .preset = preset, .color = {0.8f, 0.2f, 0.1f}, .opacity = 1.0f};
    mark.ground_opacity = 1.0f;
    mark.seed = (ty_fill_seeding){.radius = 5.0f, .seed = {1}};
    return mark;
}

static ty_fill_mark marks[TY_GRAY_SCOTT_MARKS + 1];

// A plain of N x N cells with edges, and marks for what stays empty, spots and a slow fill.
static ty_fill_recipe plain(int frames, float steps)
{
    ty_fill_recipe r = ty_fill_recipe_default();
    const char* const names[] = {"plain", "dying", "spots", "slow"};
    int count;
    const ty_fill_preset* presets = ty_fill_presets(&count);
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < count; k++)
            if (strcmp(presets[k].name, names[i]) == 0)
                marks[i] = mark_of(names[i], k);
    r.cells[0] = r.cells[1] = N;
    r.scale = 1;
    r.tile = TY_PATTERN_TILE_NONE;
    r.start = TY_PATTERN_START_PLAIN;
    r.marks = (ty_param_list){marks, 4};
    r.run.frames = frames;
    r.run.steps = steps;
    r.outputs = (ty_param_strings){all_outputs, 6};
    return r;
}

static ty_fill_event event_of(int at, ty_fill_op op, float x, float y, float radius)
{
    return (ty_fill_event){.at = at,
                           .op = (int)op,
                           .center = {x, y},
                           .size = {16, 16},
                           .to = {-1, -1},
                           .radius = radius,
                           .radius_to = -1,
                           .threshold = 0.5f};
}

static const float* channel(const film* f, int frame, const char* name)
{
    const ty_exr_channel* found = ty_exr_find_channel(f->frames[frame], name);
    assert_non_null(found);
    return found->pixels;
}

static int empty_cells(const film* f, int frame)
{
    int count = 0;
    const float* v = channel(f, frame, "v");
    for (int i = 0; i < N * N; i++)
        count += v[i] < 0.15f;
    return count;
}

// --- events ---

static void events_are_shown_at_their_frame(void** state)
{
    (void)state;
    ty_fill_recipe r = plain(8, 3.0f);
    ty_fill_event events[] = {event_of(4, TY_FILL_HOLE, 48, 48, 10), event_of(6, TY_FILL_FILL, 48, 48, 20),
                              event_of(7, TY_FILL_MARK, 20, 20, 5)};
    events[2].mark = "2";
    r.events = (ty_param_list){events, 3};
    film f = {0};
    must_make(&r, &f);
    const float* u = channel(&f, 4, "u");
    assert_int_equal(empty_cells(&f, 3), 0);
    assert_in_range(empty_cells(&f, 4), 300, 330); // 314 of the disc
    assert_true(u[48 * N + 48] == 1.0f && channel(&f, 4, "v")[48 * N + 48] == 0.0f);
    assert_true(empty_cells(&f, 5) > 0);
    assert_int_equal(empty_cells(&f, 6), 0);
    assert_true(channel(&f, 6, "mark")[20 * N + 20] == 0.0f && channel(&f, 7, "mark")[20 * N + 20] == 2.0f);
    forget(&f);
}

static void shapes_are_where_they_are_put(void** state)
{
    (void)state;
    static ty_vec2 triangle[] = {{10, 60}, {40, 60}, {10, 90}}, line[] = {{60, 20}, {90, 20}};
    ty_fill_recipe r = plain(5, 0.0f);
    ty_fill_event events[] = {event_of(1, TY_FILL_HOLE, 30, 30, 0), event_of(1, TY_FILL_HOLE, 0, 0, 0),
                              event_of(1, TY_FILL_HOLE, 0, 0, 4), event_of(2, TY_FILL_HOLE, 70, 60, 4)};
    events[0].shape = TY_FILL_RECTANGLE;
    events[0].size[0] = 20;
    events[0].size[1] = 10;
    events[0].angle = TY_PI / 2; // now 10 wide and 20 high
    events[1].shape = TY_FILL_POLYGON;
    events[1].points = (ty_param_list){triangle, 3};
    events[2].shape = TY_FILL_BRUSH;
    events[2].points = (ty_param_list){line, 2};
    events[2].until = 5; // the stroke is drawn
    events[3].to[0] = 90;
    events[3].to[1] = 60;
    events[3].until = 4;
    events[3].radius_to = 2.0f;
    r.events = (ty_param_list){events, 4};
    film f = {0};
    must_make(&r, &f);
    const float* v = channel(&f, 1, "v");
    assert_true(v[38 * N + 26] == 0.0f && v[38 * N + 36] > 0.3f && v[41 * N + 30] > 0.3f);
    assert_true(v[61 * N + 11] == 0.0f && v[88 * N + 38] > 0.3f); // the lower left half
    assert_true(v[20 * N + 60] == 0.0f && v[20 * N + 70] > 0.3f); // just begun
    v = channel(&f, 3, "v");
    assert_true(v[20 * N + 74] == 0.0f && v[20 * N + 84] > 0.3f); // half of it
    assert_true(v[60 * N + 80] == 0.0f && v[60 * N + 90] > 0.3f);
    v = channel(&f, 5, "v");
    assert_true(v[20 * N + 90] == 0.0f);
    assert_true(v[60 * N + 91] < 0.05f && v[57 * N + 90] > 0.3f); // thinner at the end
    forget(&f);
}

// The frame that shows a hole first, before any step, has a round one: its outline lies within a fifth of a cell of the
// circle, and pixels on it are neither one nor the other.
static void new_holes_are_smooth(void** state)
{
    (void)state;
    enum
    {
        SCALE = 4
    };
    const float cx = 47.7f, cy = 48.2f, radius = 20.3f;
    ty_fill_recipe r = plain(1, 0.0f);
    ty_fill_event hole = event_of(1, TY_FILL_HOLE, cx, cy, radius);
    r.events = (ty_param_list){&hole, 1};
    r.scale = SCALE;
    r.sharp = true;
    film f = {0};
    must_make(&r, &f);
    const float* shown = channel(&f, 1, "R");
    double area = 0.0, farthest = 0.0;
    int between = 0;
    for (int y = 0; y < SCALE * N; y++)
        for (int x = 0; x < SCALE * N; x++)
        {
            float tone = shown[y * SCALE * N + x] / marks[0].color.r;
            double d = hypot((x + 0.5) / SCALE - (double)cx, (y + 0.5) / SCALE - (double)cy) - (double)radius;
            area += 1.0 - (double)tone;
            if ((tone < 0.5f) != (d < 0.0) && fabs(d) > farthest)
                farthest = fabs(d);
            between += tone > 0.05f && tone < 0.95f;
        }
    print_message("outline %.3f cells off, area %.4f of the disc, %d pixels between\n", farthest,
                  area / (SCALE * SCALE * TY_PI * radius * radius), between);
    assert_true(farthest < 0.2);
    assert_true(fabs(area / (SCALE * SCALE * TY_PI * radius * radius) - 1.0) < 2e-3);
    assert_true(between > 2 * TY_PI * radius * SCALE * 0.8);
    forget(&f);
}

static void soft_edges_blend(void** state)
{
    (void)state;
    ty_fill_recipe r = plain(1, 0.0f);
    ty_fill_event events[] = {event_of(1, TY_FILL_HOLE, 48, 48, 20), event_of(1, TY_FILL_MARK, 48, 48, 20)};
    events[0].feather = events[1].feather = 10.0f;
    events[1].mark = "spots";
    r.events = (ty_param_list){events, 2};
    film f = {0};
    must_make(&r, &f);
    const float *v = channel(&f, 1, "v"), *mark = channel(&f, 1, "mark");
    float most = v[0];
    assert_float_equal(v[48 * N + 68] / most, 0.55f, 0.02f); // half a cell beyond the rim
    assert_float_equal(v[48 * N + 64] / most, 0.15f, 0.02f);
    assert_true(v[48 * N + 60] == 0.0f && v[48 * N + 74] == most);
    int rim = 0, marked = 0, inside = 0;
    for (int y = 0; y < N; y++)
        for (int x = 0; x < N; x++)
        {
            float d = sqrtf(ty_sqr((float)x - 47.5f) + ty_sqr((float)y - 47.5f));
            rim += fabsf(d - 20.0f) < 3.0f;
            marked += fabsf(d - 20.0f) < 3.0f && mark[y * N + x] == 2.0f;
            inside += d < 15.0f && mark[y * N + x] != 2.0f;
        }
    assert_int_equal(inside, 0);
    assert_true(marked > rim * 4 / 10 && marked < rim * 6 / 10); // thins out by chance
    forget(&f);
}

// --- what marks do ---

static void holes_close_when_they_are_told(void** state)
{
    (void)state;
    const float radii[] = {12.0f, 25.0f};
    const char* const convention[] = {"pearson", "processing"};
    for (int i = 0; i < 2; i++)
    {
        ty_fill_recipe r = plain(48, 1.0f);
        int count;
        const ty_fill_convention* conventions = ty_fill_conventions(&count);
        while (strcmp(conventions[r.convention].name, convention[i]) != 0)
            r.convention++;
        ty_fill_event hole = event_of(3, TY_FILL_HOLE, 48, 48, radii[i]);
        hole.close = 40;
        r.events = (ty_param_list){&hole, 1};
        film f = {0};
        must_make(&r, &f);
        int frame = 3;
        while (frame < 48 && empty_cells(&f, frame) > 0)
            frame++;
        assert_in_range(frame, 3 + 38, 3 + 42); // 5 %
        forget(&f);
    }
}

static void marked_holes_stay_until_unmarked_at_the_rim(void** state)
{
    (void)state;
    ty_fill_recipe r = plain(30, 300.0f);
    ty_fill_event events[] = {event_of(1, TY_FILL_HOLE, 48, 48, 30), event_of(5, TY_FILL_UNMARK, 48, 78, 8),
                              event_of(5, TY_FILL_UNMARK, 48, 40, 8)};
    events[0].mark = "dying";
    r.events = (ty_param_list){events, 3};
    film f = {0};
    must_make(&r, &f);
    assert_in_range(empty_cells(&f, 4), empty_cells(&f, 1) * 97 / 100, empty_cells(&f, 1));
    const float* v = channel(&f, 30, "v");
    assert_true(v[75 * N + 48] > 0.3f); // the rim was let go
    float most = 0.0f;
    for (int y = 30; y < 50; y++)
        for (int x = 38; x < 58; x++)
            most = ty_max(most, v[y * N + x]);
    assert_true(most < 1e-4f); // the middle has nowhere to fill from
    forget(&f);
}

static void barriers_hold(void** state)
{
    (void)state;
    ty_fill_recipe r = plain(30, 200.0f);
    ty_fill_event events[] = {event_of(1, TY_FILL_HOLE, 48, 38.5f, 0), event_of(4, TY_FILL_BARRIER, 48, 60, 0),
                              event_of(20, TY_FILL_UNBARRIER, 48, 60, 0)};
    events[0].shape = events[1].shape = events[2].shape = TY_FILL_RECTANGLE;
    events[0].size[0] = events[1].size[0] = events[2].size[0] = 96;
    events[0].size[1] = 77; // it fills from below
    events[1].size[1] = events[2].size[1] = 3;
    r.events = (ty_param_list){events, 3};
    film f = {0};
    must_make(&r, &f);
    const float *v = channel(&f, 19, "v"), *mark = channel(&f, 19, "mark");
    assert_true(v[64 * N + 48] > 0.3f && v[50 * N + 48] < 0.05f); // filled up to it, empty beyond
    assert_true(mark[60 * N + 48] == -1.0f && mark[56 * N + 48] == 0.0f);
    v = channel(&f, 30, "v");
    assert_true(v[56 * N + 48] > 0.3f && channel(&f, 30, "mark")[60 * N + 48] == 0.0f); // and on, when it is gone
    forget(&f);
}

// A smooth disc of this mark gets no spots by itself; dropped ones live.
static void seeds_start_a_pattern(void** state)
{
    (void)state;
    int spots[2];
    for (int seeded = 0; seeded < 2; seeded++)
    {
        ty_fill_recipe r = plain(2, 5000.0f);
        ty_fill_event hole = event_of(1, TY_FILL_HOLE, 48, 48, 36);
        hole.mark = "spots";
        marks[2].seed.spacing = seeded ? 18.0f : 0.0f;
        r.events = (ty_param_list){&hole, 1};
        film f = {0};
        must_make(&r, &f);
        const float* v = channel(&f, 2, "v");
        spots[seeded] = 0;
        for (int y = 26; y < 70; y++) // away from the rim
            for (int x = 26; x < 70; x++)
                spots[seeded] += v[y * N + x] > 0.15f && v[y * N + x] >= v[y * N + x - 1] &&
                                 v[y * N + x] > v[y * N + x + 1] && v[y * N + x] >= v[(y - 1) * N + x] &&
                                 v[y * N + x] > v[(y + 1) * N + x];
        forget(&f);
    }
    assert_int_equal(spots[0], 0);
    assert_true(spots[1] >= 6);
}

// --- outputs ---

static void mattes_add_up(void** state)
{
    (void)state;
    for (int scale = 1; scale <= 3; scale += 2)
    {
        ty_fill_recipe r = plain(3, 40.0f);
        ty_fill_event events[] = {event_of(1, TY_FILL_HOLE, 40, 40, 20), event_of(1, TY_FILL_HOLE, 60, 50, 18),
                                  event_of(1, TY_FILL_MARK, 50, 62, 15), event_of(2, TY_FILL_BARRIER, 50, 50, 6)};
        ty_fill_auto wall = {.mark = "slow", .where = TY_FILL_WHERE_BAND, .reach = {0.0f, 3.0f}, .threshold = 0.1f};
        events[0].mark = "dying";
        events[2].mark = "spots";
        r.events = (ty_param_list){events, 4};
        r.autos = (ty_param_list){&wall, 1};
        r.scale = scale;
        film f = {0};
        must_make(&r, &f);
        static const char* const names[] = {"matte.plain", "matte.dying", "matte.spots", "matte.slow", "matte.closed"};
        int between[5] = {0};
        for (int i = 0; i < N * N * scale * scale; i++)
        {
            float sum = 0.0f;
            for (int k = 0; k < 5; k++)
            {
                float m = channel(&f, 3, names[k])[i];
                assert_true(m >= 0.0f && m <= 1.0f);
                between[k] += m > 0.05f && m < 0.95f;
                sum += m;
            }
            assert_float_equal(sum, 1.0f, 1e-6f);
            float d = channel(&f, 3, "distance")[i];
            if (d > 0.6f && d < 2.4f && channel(&f, 3, names[4])[i] == 0.0f)
                assert_true(channel(&f, 3, names[3])[i] > 0.999f); // all of the wall
        }
        for (int k = 0; k < 5; k++)
            assert_true(between[k] > 10); // edges are not cut
        assert_true(channel(&f, 3, names[4])[(50 * scale) * N * scale + 50 * scale] == 1.0f);
        forget(&f);
    }
}

static void distance_and_trail_are_measured(void** state)
{
    (void)state;
    ty_fill_recipe r = plain(12, 100.0f);
    ty_fill_event events[] = {event_of(1, TY_FILL_HOLE, 0, 0, 0), event_of(1, TY_FILL_FILL, 48, 48, 20)};
    events[0].shape = TY_FILL_ALL;
    r.events = (ty_param_list){events, 2};
    film f = {0};
    must_make(&r, &f);
    const float *d = channel(&f, 1, "distance"), *trail = channel(&f, 12, "trail"), *v = channel(&f, 12, "v");
    assert_float_equal(d[48 * N + 48], -19.4f, 0.6f);
    assert_float_equal(d[48 * N + 88], 20.5f, 0.6f);
    assert_float_equal(d[76 * N + 76], sqrtf(2.0f) * 28.5f - 20.0f, 0.7f);
    assert_true(trail[48 * N + 48] == 1.0f); // from the beginning
    assert_true(trail[48 * N + 90] == -1.0f);
    float last = 1.0f;
    for (int x = 69; x < 90 && trail[48 * N + x] > 0.0f; x++) // outwards later
    {
        assert_true(trail[48 * N + x] > last && trail[48 * N + x] <= 12.0f && v[48 * N + x] > 0.05f);
        last = trail[48 * N + x];
    }
    assert_true(last > 8.0f);
    forget(&f);
}

static void colors_go_through_mattes(void** state)
{
    (void)state;
    ty_fill_recipe r = plain(1, 0.0f);
    ty_fill_event hole = event_of(1, TY_FILL_HOLE, 48, 48, 20);
    marks[0].ground = (ty_rgb){0.0f, 0.0f, 1.0f};
    marks[0].ground_opacity = 0.25f;
    r.events = (ty_param_list){&hole, 1};
    film f = {0};
    must_make(&r, &f);
    assert_float_equal(channel(&f, 1, "R")[0], 0.8f, 1e-6f);
    assert_float_equal(channel(&f, 1, "A")[0], 1.0f, 1e-6f);
    assert_float_equal(channel(&f, 1, "B")[48 * N + 48], 0.25f, 1e-6f); // multiplied by its alpha
    assert_float_equal(channel(&f, 1, "A")[48 * N + 48], 0.25f, 1e-6f);
    forget(&f);
}

// --- going on ---

static void state_to_bytes(const ty_exr* state, ty_bytes* out)
{
    ty_error error;
    const char* path = "test_fill_run.state.exr";
    assert_int_equal(ty_exr_write(path, state, &error), TY_OK);
    assert_int_equal(ty_file_read(path, (size_t)1 << 30, out, &error), TY_OK);
    assert_int_equal(remove(path), 0);
}

static void must_be_equal(const ty_exr* a, const ty_exr* b)
{
    size_t size = (size_t)ty_exr_width(a) * (size_t)ty_exr_height(a) * sizeof(float);
    assert_int_equal(a->channel_count, b->channel_count);
    for (int i = 0; i < a->channel_count; i++)
        assert_memory_equal(a->channels[i].pixels, b->channels[i].pixels, size);
}

static void stopped_runs_go_on_to_the_bit(void** state)
{
    (void)state;
    ty_fill_recipe r = plain(16, 20.5f);
    ty_fill_event events[] = {event_of(2, TY_FILL_HOLE, 40, 40, 20), event_of(3, TY_FILL_HOLE, 60, 60, 18),
                              event_of(5, TY_FILL_BARRIER, 10, 50, 4), event_of(12, TY_FILL_UNBARRIER, 20, 50, 9)};
    ty_fill_auto wall = {
        .mark = "slow", .where = TY_FILL_WHERE_BAND, .reach = {0, 2}, .threshold = 0.1f, .rates = true};
    events[1].mark = "spots";
    events[2].until = 14;
    events[2].to[0] = events[2].to[1] = 80;
    marks[2].seed = (ty_fill_seeding){14.0f, 4.0f, 0.05f, 2.0f, {3}};
    r.variation = 0.02f;
    r.events = (ty_param_list){events, 4};
    r.autos = (ty_param_list){&wall, 1};
    film whole = {0}, first = {.stop_after = 7}, rest = {0};
    must_make(&r, &whole);
    ty_error error;
    assert_int_equal(make(&r, &first, &error), TY_INTERRUPTED);
    ty_cancel_clear();
    assert_non_null(first.state);
    assert_null(first.frames[8]);
    ty_bytes bytes;
    state_to_bytes(first.state, &bytes);
    const ty_frame_sink sink = {put, keep, &rest};
    assert_int_equal(ty_fill_make_from(&r, NULL, &sink, &bytes, &error), TY_OK);
    assert_null(rest.frames[7]);
    for (int i = 8; i <= 16; i++)
        must_be_equal(whole.frames[i], rest.frames[i]);
    must_be_equal(whole.state, rest.state);
    ty_bytes_term(&bytes);
    forget(&first);
    forget(&rest);
    forget(&whole);
}

static void states_that_do_not_fit_are_refused(void** state)
{
    (void)state;
    ty_fill_recipe r = plain(3, 5.0f);
    film f = {0};
    must_make(&r, &f);
    ty_bytes bytes;
    ty_error error;
    state_to_bytes(f.state, &bytes);
    const ty_frame_sink sink = {put, NULL, &f};
    assert_int_equal(ty_fill_make_from(&r, NULL, &sink, &bytes, &error), TY_BAD_INPUT); // it is at its end
    assert_non_null(strstr(error.text, "run.frames: 3"));
    r.run.frames = 5;
    r.cells[0] = 64;
    assert_int_equal(ty_fill_make_from(&r, NULL, &sink, &bytes, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "96 x 96"));
    r.cells[0] = N;
    r.run.frames = 0;
    assert_int_equal(ty_fill_make_from(&r, NULL, &sink, &bytes, &error), TY_BAD_INPUT);
    r.run.frames = 5;
    ty_bytes_term(&bytes);
    state_to_bytes(f.frames[2], &bytes);
    assert_int_equal(ty_fill_make_from(&r, NULL, &sink, &bytes, &error), TY_BAD_FILE);
    ty_bytes_term(&bytes);
    forget(&f);
}

// --- what is refused ---

static void must_refuse(const ty_fill_recipe* r, const char* text)
{
    ty_error error = {0};
    film f = {0};
    assert_int_equal(make(r, &f, &error), TY_BAD_INPUT);
    if (!strstr(error.text, text))
        print_message("%s\n", error.text);
    assert_non_null(strstr(error.text, text));
    for (int i = 0; i <= MOST; i++)
        assert_null(f.frames[i]);
}

static void impossible_ones_are_refused(void** state)
{
    (void)state;
    ty_fill_recipe r = plain(8, 3.0f);
    ty_fill_event e = event_of(9, TY_FILL_HOLE, 48, 48, 10);
    r.events = (ty_param_list){&e, 1};
    must_refuse(&r, "events[0].at: 9 lies after the run: it has frames 1..8");
    e.at = 5;
    e.until = 4;
    must_refuse(&r, "events[0].until: 4 lies before");
    e.until = 0;
    e.mark = "spot";
    must_refuse(&r, "events[0].mark: no mark 'spot' in the table; it has 0 plain, 1 dying, 2 spots, 3 slow");
    e.mark = "4";
    must_refuse(&r, "no mark '4'");
    e.mark = NULL;
    e.op = TY_FILL_MARK;
    must_refuse(&r, "which one?");
    e = event_of(1, TY_FILL_HOLE, 48, 48, 10);
    e.shape = TY_FILL_POLYGON;
    must_refuse(&r, "events[0].points: 0; this shape has at least 3");
    e.shape = TY_FILL_IMAGE;
    must_refuse(&r, "give `image`");
    e.shape = TY_FILL_CIRCLE;
    e.close = 5;
    e.mark = "dying";
    must_refuse(&r, "no front moves into it");
    e.close = 0;
    r.run.frames = 0;
    must_refuse(&r, "events: a loop has none");
    r = plain(8, 3.0f);
    r.time_step = 1.3f;
    must_refuse(&r, "time_step: 1.3");
    r = plain(8, 3.0f);
    r.stencil = 7;
    must_refuse(&r, "stencil: 7");
    r = plain(8, 3.0f);
    r.marks.count = 17;
    must_refuse(&r, "marks: 17 rows; a table has at most 16");
    r = plain(8, 3.0f);
    marks[3].name = "dying";
    must_refuse(&r, "marks[3].name: 'dying' is the name of mark 1 already");
    r = plain(8, 3.0f);
    const char* wrong[] = {"w"};
    r.outputs = (ty_param_strings){wrong, 1};
    must_refuse(&r, "outputs: 'w' is none of");
    r = plain(8, 3.0f);
    ty_fill_auto band = {.mark = "lost", .where = TY_FILL_WHERE_BAND, .reach = {0, 2}};
    r.autos = (ty_param_list){&band, 1};
    must_refuse(&r, "auto[0].mark: no mark 'lost'");
    band = (ty_fill_auto){.mark = "slow", .where = TY_FILL_WHERE_BAND, .reach = {2, 2}};
    must_refuse(&r, "auto[0].reach");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(events_are_shown_at_their_frame),
        cmocka_unit_test(shapes_are_where_they_are_put),
        cmocka_unit_test(new_holes_are_smooth),
        cmocka_unit_test(soft_edges_blend),
        cmocka_unit_test(holes_close_when_they_are_told),
        cmocka_unit_test(marked_holes_stay_until_unmarked_at_the_rim),
        cmocka_unit_test(barriers_hold),
        cmocka_unit_test(seeds_start_a_pattern),
        cmocka_unit_test(mattes_add_up),
        cmocka_unit_test(distance_and_trail_are_measured),
        cmocka_unit_test(colors_go_through_mattes),
        cmocka_unit_test(stopped_runs_go_on_to_the_bit),
        cmocka_unit_test(states_that_do_not_fit_are_refused),
        cmocka_unit_test(impossible_ones_are_refused),
    };
    ty_log_set_level(TY_LOG_ERROR);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
