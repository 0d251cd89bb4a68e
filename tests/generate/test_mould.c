// SPDX-License-Identifier: Apache-2.0
// Moulds: their form, bodies that stay bent, and heaps that keep the form of a mould or do not.
#include "recipe_made.h"
#include <tsuya/generate/pile.h>

#define RADIUS 2e-3f

static ty_container* container(const ty_container_def* def)
{
    ty_container* c;
    ty_error error;
    if (ty_container_create(def, NULL, &c, &error) != TY_OK)
        fail_msg("%s", error.text);
    return c;
}

// The triangle stands on y = 0: distances to base, face, tip and sides, and what lies in it.
static void test_onigiri(void** state)
{
    (void)state;
    ty_container_def def = ty_container_def_default();
    def.kind = TY_CONTAINER_ONIGIRI;
    def.onigiri = (ty_onigiri_def){0.06f, 0.03f, 0.01f, 0.008f};
    ty_container* c = container(&def);
    float middle = 0.06f / (2.0f * sqrtf(3.0f)), top = 3.0f * middle - 0.01f;
    ty_bounds b = ty_container_interior(c);
    assert_float_equal(b.low.y, 0.0f, 1e-7f);
    assert_float_equal(b.high.y, top, 1e-6f);
    assert_float_equal(b.high.z, 0.015f, 1e-7f);
    assert_float_equal(b.high.x, 0.03f - 0.01f * (sqrtf(3.0f) - 1.0f), 1e-6f);
    ty_vec3 n;
    assert_float_equal(ty_container_wall(c, 0, ty_vec3_make(0.0f, 0.002f, 0.0f), &n), 0.002f, 1e-4f);
    assert_true(n.y > 0.99f);
    assert_float_equal(ty_container_wall(c, 0, ty_vec3_make(0.0f, middle, 0.012f), &n), 0.003f, 1e-4f);
    assert_true(n.z < -0.99f);
    assert_float_equal(ty_container_wall(c, 0, ty_vec3_make(0.0f, top - 0.004f, 0.0f), &n), 0.004f, 1e-4f);
    ty_vec3 side = {0.5f * sqrtf(3.0f) * (middle - 0.003f), middle + 0.5f * (middle - 0.003f), 0.0f};
    assert_float_equal(ty_container_wall(c, 0, side, &n), 0.003f, 1e-4f);
    assert_true(n.x < -0.8f && n.y < -0.4f);
    // On the round edge between base and face: behind its centre line by .002 along the diagonal.
    float d = 0.008f - 0.002f / sqrtf(2.0f);
    assert_float_equal(ty_container_wall(c, 0, ty_vec3_make(0.0f, d, 0.015f - d), &n), 0.006f, 1.5e-4f);
    assert_true(ty_container_holds(c, ty_vec3_make(0.0f, top - 1e-3f, 0.0f)));
    assert_false(ty_container_holds(c, ty_vec3_make(0.029f, 1e-3f, 0.0f))); // where the sharp corner would be
    assert_false(ty_container_is_open(c));
    ty_container_destroy(c);
}

// A box as a mould is closed and has round edges.
static void test_block(void** state)
{
    (void)state;
    ty_container_def def = ty_container_def_default();
    def.kind = TY_CONTAINER_BOX;
    def.role = TY_CONTAINER_MOULD;
    def.shape.size = ty_vec3_make(0.025f, 0.01f, 0.011f);
    def.shape.rounding = 0.008f;
    ty_container* c = container(&def);
    ty_vec3 n;
    assert_false(ty_container_is_open(c));
    assert_int_equal(ty_container_wall_count(c), 1);
    assert_float_equal(ty_container_wall(c, 0, ty_vec3_make(0.0f, 0.008f, 0.0f), &n), 0.002f, 1e-4f);
    assert_true(n.y < -0.99f);
    assert_false(ty_container_holds(c, ty_vec3_make(0.0245f, 0.0095f, 0.0f)));
    ty_container_destroy(c);
}

static void ball_init(ty_element* out)
{
    ty_element_def ball = ty_element_def_default();
    ball.kind = TY_ELEMENT_BALL;
    ball.length = ball.width = ball.thickness = 2.0f * RADIUS;
    ball.variants = 1;
    ty_error error;
    assert_int_equal(ty_element_init(&ball, (ty_seed){1}, 0, out, &error), TY_OK);
}

// A column of balls in a closed mould, leaning on its wall; without the walls nothing touches the lowest but the
// others, and all fall as one, by g and nothing else.
static void test_without_walls_all_falls(void** state)
{
    (void)state;
    ty_element grain;
    ball_init(&grain);
    ty_container_def form = ty_container_def_default();
    form.kind = TY_CONTAINER_BOX;
    form.role = TY_CONTAINER_MOULD;
    form.shape.size = ty_vec3_make(2.1f * RADIUS, 4.0f * RADIUS, 2.1f * RADIUS);
    ty_container* mould = container(&form);
    ty_pile_def def = ty_pile_def_default();
    def.grains = &grain;
    def.grain_count = 1;
    def.container = mould;
    ty_pile* pile = ty_pile_create(&def);
    for (int i = 0; i < 3; i++)
    {
        ty_body body = {.rotation = ty_quat_identity(), .scale = 1.0f};
        body.position = ty_vec3_make((i & 1 ? 0.5f : -0.5f) * RADIUS, ((float)i * 1.9f - 2.9f) * RADIUS, 0.0f);
        ty_pile_add(pile, &body, 1);
    }
    for (int i = 0; i < 1500; i++)
        ty_pile_step(pile, NULL);
    ty_pile_metrics m;
    ty_pile_measure(pile, &m, NULL);
    print_message("  %d float in the mould, %.3g mm/s\n", m.floating, (double)m.speed_max * 1e3);
    assert_true(m.speed_max < 1e-4f && m.loaded > 0.5f && m.floating < 3);
    ty_pile_set_container(pile, NULL);
    ty_pile_measure(pile, &m, NULL);
    assert_int_equal(m.floating, 3);
    ty_vec3 before = ty_pile_momentum(pile);
    for (int i = 0; i < 10; i++)
        ty_pile_step(pile, NULL);
    ty_vec3 gained = ty_mul(ty_sub(ty_pile_momentum(pile), before), 1.0f / 3.0f);
    print_message("  %.5g %.5g %.5g mm/s in 4 ms\n", (double)gained.x * 1e3, (double)gained.y * 1e3,
                  (double)gained.z * 1e3);
    assert_float_equal(gained.y, -9.81f * 10.0f / def.rate, 1e-5f);
    assert_true(fabsf(gained.x) < 1e-6f && fabsf(gained.z) < 1e-6f);
    ty_pile_destroy(pile);
    ty_container_destroy(mould);
    ty_element_term(&grain);
}

static ty_wall_motion belt(void* context, int wall, float seconds)
{
    (void)context, (void)wall;
    const ty_vec3 velocity = {0.1f, 0.0f, 0.0f};
    return (ty_wall_motion){ty_mul(velocity, seconds), ty_quat_identity(), velocity, {0.0f, 0.0f, 0.0f}};
}

// A ball that is stretched by s to both sides of the way it rolls: its proxy grows by s^(1/3), its moment about the
// axis it rolls about is m r^2 (1 + s^2) / 5. Put on a belt it ends at I / (I + m R^2) of its speed.
static void test_bent_body(void** state)
{
    (void)state;
    const float s = 1.6f, radius = RADIUS * ty_pow(s, 1.0f / 3.0f);
    ty_element grain;
    ball_init(&grain);
    ty_container_def room = ty_container_def_default();
    room.kind = TY_CONTAINER_GROUND;
    room.ground = 0.01f;
    ty_container* ground = container(&room);
    ty_pile_def def = ty_pile_def_default();
    def.rolling = 0.0f;
    def.grains = &grain;
    def.grain_count = 1;
    def.container = ground;
    ty_pile* pile = ty_pile_create(&def);
    ty_body body = {.position = {0.0f, 0.01f + radius, 0.0f}, .rotation = ty_quat_identity(), .scale = 1.0f};
    ty_pile_add(pile, &body, 1);
    assert_false(ty_pile_is_bent(pile));
    ty_affine map = ty_affine_identity();
    map.x.x = s;
    ty_pile_bend(pile, 0, &map);
    ty_affine frame = ty_pile_frame(pile, 0);
    assert_float_equal(frame.x.x, s, 1e-6f);
    assert_float_equal(frame.y.y, 1.0f, 1e-6f);
    ty_pile_move_walls(pile, belt, NULL);
    for (int i = 0; i < 1000; i++)
        ty_pile_step(pile, NULL);
    const ty_body* b = ty_pile_bodies(pile);
    float moment = (1.0f + s * s) / 5.0f, expected = moment / (moment + ty_sqr(radius / RADIUS));
    print_message("bent ball on a belt: %.4f of its speed, %.4f expected\n", (double)(b->velocity.x / 0.1f),
                  (double)expected);
    assert_float_equal(b->velocity.x / 0.1f, expected, 0.01f * expected);
    assert_float_equal(b->position.y, 0.01f + radius, 0.02f * radius);
    body = *b;
    ty_pile_add(pile, &body, 1); // one that is not bent
    frame = ty_pile_frame(pile, 1);
    assert_float_equal(ty_length(frame.x), 1.0f, 1e-6f);
    ty_pile_destroy(pile);
    ty_container_destroy(ground);
    ty_element_term(&grain);
}

// Of grains that stick by w and are wet by the tension given, pressed by a hand and let go.
static ty_aggregate_recipe rice_ball(float adhesion, float tension)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.element.variants = 2;
    r.container.kind = TY_CONTAINER_ONIGIRI;
    r.container.role = TY_CONTAINER_MOULD;
    r.container.onigiri = (ty_onigiri_def){0.042f, 0.021f, 0.008f, 0.006f};
    r.fill.target = TY_FILL_DENSITY;
    r.fill.density = 0.6f;
    r.settle.adhesion = adhesion;
    r.settle.cohesion = tension;
    r.settle.rolling = 0.01f;
    r.press.strain = 0.06f;
    r.press.seconds = 0.2f;
    r.press.from = TY_PRESS_AROUND;
    return r;
}

static double kept_height(const ty_aggregate_recipe* r)
{
    ty_aggregate* a = made(r, NULL);
    double kept = metric(a, "height_mm") / metric(a, "released_height_mm");
    print_message("%u grains keep %.3f of %.1f mm\n", a->instance_count, kept, metric(a, "released_height_mm"));
    assert_non_null(strstr(a->metrics, "\"rest\": true"));
    ty_aggregate_destroy(a);
    return kept;
}

static void test_mould_keeps_or_slumps(void** state)
{
    (void)state;
    ty_aggregate_recipe sticky = rice_ball(1.0f, 0.072f), dry = rice_ball(0.0f, 0.0f);
    assert_true(kept_height(&sticky) > 0.9);
    assert_true(kept_height(&dry) < 0.75);
    dry.press.release = false; // it stays in the mould: no plane below it
    ty_aggregate* held = made(&dry, NULL);
    assert_null(strstr(held->metrics, "released_height_mm"));
    ty_aggregate_destroy(held);
}

enum
{
    FRAMES = 15, // ten of them while it presses
};

typedef struct film
{
    float across[FRAMES]; // m, what the meshes take from face to face of the mould
    int shown;
} film;

static ty_status across_keep(void* context, int frame, ty_aggregate* a, ty_error* error)
{
    (void)error;
    film* f = context;
    ty_bounds all = ty_bounds_empty();
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        const ty_mesh* mesh = a->prototypes[a->prototype_index[i]];
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            all = ty_bounds_add(all, ty_map_point(&a->transforms[i], mesh->positions[v]));
    }
    f->across[frame - 1] = all.high.z - all.low.z;
    f->shown++;
    return TY_OK;
}

// It closes within .4 of the press and stays closed to its end, when what is pressed would part again; then nothing
// holds the grains.
static void test_mould_stays_closed(void** state)
{
    (void)state;
    ty_aggregate_recipe r = rice_ball(0.0f, 0.0f);
    float width = r.container.onigiri.thickness, closed = (1.0f - r.press.strain) * width;
    r.animate.frames = FRAMES;
    r.animate.fps = 10.0f / r.press.seconds;
    film f = {0};
    ty_aggregate_sink sink = {across_keep, &f};
    ty_error error;
    if (ty_aggregate_film(&r, NULL, &sink, &error) != TY_OK)
        fail_msg("%s", error.text);
    assert_int_equal(f.shown, FRAMES);
    for (int i = 0; i < FRAMES; i++)
        print_message("  frame %d: %.2f of %.2f mm\n", i + 1, (double)f.across[i] * 1e3, (double)width * 1e3);
    for (int i = 4; i < 10; i++)
        assert_float_equal(f.across[i], closed, 0.01f * width);
    assert_true(f.across[0] > closed + 0.02f * width);
    assert_true(f.across[FRAMES - 1] > width);
}

static void test_refused(void** state)
{
    (void)state;
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.container.role = TY_CONTAINER_MOULD; // a bowl
    assert_refused(&r, "container.role", "onigiri");
    r = ty_aggregate_recipe_default();
    r.press.strain = 0.1f;
    r.press.from = TY_PRESS_AROUND;
    assert_refused(&r, "press.from", "closed");
    r = rice_ball(0.0f, 0.0f);
    r.container.onigiri.corner = 0.02f;
    assert_refused(&r, "container.onigiri.corner", "0..12.1");
    r = rice_ball(0.0f, 0.0f);
    r.container.onigiri.edge = 0.011f;
    assert_refused(&r, "container.onigiri.edge", "0..10.5");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_onigiri),
        cmocka_unit_test(test_block),
        cmocka_unit_test(test_bent_body),
        cmocka_unit_test(test_without_walls_all_falls),
        cmocka_unit_test(test_mould_keeps_or_slumps),
        cmocka_unit_test(test_mould_stays_closed),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
