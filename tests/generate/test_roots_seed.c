// SPDX-License-Identifier: Apache-2.0
// The thesis' method beside ours: what it does by its formulas, what fails of it on its own kinds of host, and that the
// counts are right.
#include "roots_grown.h"
#include "roots_output.h"
#include "roots_seed.h"
#include <jansson.h>
#include <string.h>

// --- hosts: a slab, a pillar, three boxes; radius 2 mm, as if the thesis' unit were 1 mm ---

enum
{
    GROUND,
    PILLAR,
    COMPOUND,
    HOSTS,
};

static const char* const names[HOSTS] = {"ground", "pillar", "compound"};

static ty_roots_object_def box(ty_vec3 size, ty_vec3 at)
{
    ty_roots_object_def def = {
        .kind = TY_ROOTS_HOST_BOX, .shape = ty_shape_def_default(), .translate = at, .scale = {1.0f, 1.0f, 1.0f}};
    def.shape.size = size;
    def.shape.rounding = 0.0f;
    return def;
}

static ty_roots_recipe recipe_for(int host)
{
    static ty_roots_object_def objects[3];
    ty_roots_recipe r = ty_roots_recipe_default();
    objects[0] = host == GROUND ? box((ty_vec3){0.3f, 0.01f, 0.3f}, (ty_vec3){0.0f, 0.0f, 0.0f})
                                : box((ty_vec3){0.02f, 0.1f, 0.02f}, (ty_vec3){0.0f, 0.0f, 0.0f});
    objects[1] = box((ty_vec3){0.018f, 0.012f, 0.018f}, (ty_vec3){0.012f, 0.02f, 0.014f});
    objects[2] = box((ty_vec3){0.014f, 0.02f, 0.012f}, (ty_vec3){-0.016f, -0.03f, 0.0f});
    r.host.objects = (ty_param_list){objects, host == COMPOUND ? 3 : 1};
    r.host.floor = host != GROUND;
    r.method = TY_ROOTS_SEED;
    r.count = 6;
    r.radius = 2e-3f;
    r.tip = r.detail = 0.8e-3f;
    r.length = 0.5f;
    r.thesis.fall = 100.0f;                     // as printed roots leave a pillar and meet nothing
    r.first.spacing = r.second.spacing = 8e-3f; // ours: about as many branches
    r.first.reach = r.second.reach = 0.08f;
    return r;
}

// The report's figures of both methods.
static json_t* figures(const ty_roots_recipe* recipe)
{
    grown g;
    ty_sink text = {0};
    grow(recipe, NULL, &g);
    ty_sink_format(&text, "{\"report\": 1");
    roots_compare(&(roots_result){.recipe = recipe, .host = &g.host, .network = &g.net}, NULL, &text);
    ty_sink_put(&text, "}", 2);
    json_t* all = json_loads((const char*)text.bytes, 0, NULL);
    json_t* methods = json_incref(json_object_get(all, "methods"));
    json_decref(all);
    ty_sink_term(&text);
    drop(&g);
    assert_non_null(methods);
    return methods;
}

static double number(const json_t* methods, const char* method, const char* key)
{
    const json_t* value = json_object_get(json_object_get(methods, method), key);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

static void methods_print(const char* host, const json_t* m)
{
    static const char* const methods[] = {"seed", "wrap"};
    for (int i = 0; i < 2; i++)
        print_message("%-9s %s: %3.0f of %3.0f fail (%.0f no angle, %.0f restarts, %.0f no partner), %.0f kinked, "
                      "%.2f r too deep, %.0f %% held\n",
                      host, methods[i], number(m, methods[i], "failed"), number(m, methods[i], "branches"),
                      number(m, methods[i], "no_angle"), number(m, methods[i], "restarts"),
                      number(m, methods[i], "no_partner"), number(m, methods[i], "kinked"),
                      number(m, methods[i], "deepest"), 100.0 * number(m, methods[i], "held"));
}

// --- what fails ---

static void it_fails_where_ours_does_not(void** state)
{
    (void)state;
    for (int host = 0; host < HOSTS; host++)
    {
        ty_roots_recipe recipe = recipe_for(host);
        json_t* m = figures(&recipe);
        double asked = number(m, "seed", "branches"), failed = number(m, "seed", "failed");
        double reasons = number(m, "seed", "no_angle") + number(m, "seed", "restarts") + number(m, "seed", "points") +
                         number(m, "seed", "no_partner");
        methods_print(names[host], m);
        assert_true(asked > 20.0 && failed == reasons);
        assert_true(failed > 0.2 * asked);
        assert_true(number(m, "seed", "kinked") > 2.0 && number(m, "seed", "deepest") > 0.5);
        // those that found no angle are drawn as far as they came, and only they have loose ends
        assert_true(number(m, "seed", "broken") > 0.0);
        assert_true(number(m, "seed", "broken") <= number(m, "seed", "no_angle"));
        assert_true(number(m, "wrap", "branches") > 10.0);
        assert_true(number(m, "wrap", "failed") == 0.0 && number(m, "wrap", "broken") == 0.0);
        assert_true(number(m, "wrap", "kinked") == 0.0 && number(m, "wrap", "deepest") < 0.5);
        assert_true(number(m, "wrap", "held") > number(m, "seed", "held"));
        json_decref(m);
    }
}

// As printed the way is S - Lambda - U, of which the first part grows: at d units from the middle a root falls by one
// in d, and leaves its host.
static void as_printed_roots_drift_away(void** state)
{
    (void)state;
    for (int host = 0; host < HOSTS; host++)
    {
        ty_roots_recipe recipe = recipe_for(host);
        recipe.thesis.fall = 1.0f;
        json_t* m = figures(&recipe);
        methods_print(names[host], m);
        assert_true(number(m, "wrap", "held") > 0.8);
        assert_true(number(m, "seed", "held") < (host == GROUND ? 0.6 : 0.1));
        json_decref(m);
    }
}

// A way of ours between the same places, which hang on to nothing else.
static bool wraps(const growth* g, ty_vec3 a, ty_vec3 b, ty_vec3 na, ty_vec3 nb, uint64_t key, wrap* w)
{
    const roots_point from = {.p = a, .n = na, .r = 2e-3f, .flat = 1.0f},
                      to = {.p = b, .n = nb, .r = 2e-3f, .flat = 1.0f};
    ty_vec3 way = ty_normalize(ty_sub(b, a));
    wrap_def def = {.a = from, .b = to, .ta = way, .tb = way, .r = 2e-3f, .flat = 1.0f, .wander = 0.05f, .key = key};
    return roots_wrap(g, &def, w) != WRAP_NONE;
}

static bool kinked(const ty_vec3* p, int count)
{
    for (int i = 1; i + 1 < count; i++)
    {
        ty_vec3 u = ty_sub(p[i - 1], p[i]), v = ty_sub(p[i + 1], p[i]);
        if (ty_dot(u, v) > ty_cos(ty_radians(100.0f)) * ty_length(u) * ty_length(v))
            return true;
    }
    return false;
}

static ty_vec3 place_about(const roots_host* host, float turn, float y, ty_vec3* n)
{
    float s, c;
    ty_sincos(turn, &s, &c);
    return roots_host_project(host, (ty_vec3){0.045f * c, y, 0.045f * s}, 2.01e-3f, n);
}

// Places about the host as an independent re-implementation of the dodging took them: of 400 pairs it lost 236 on the
// pillar and 219 on three boxes, with 159 and 179 kinked; ours lost none.
static void pairs_about_a_pillar(void** state)
{
    (void)state;
    static const int lost[HOSTS] = {0, 236, 219};
    seed_curve* c = TY_ALLOC(seed_curve, 1);
    wrap* w = TY_ALLOC(wrap, 1);
    for (int host = PILLAR; host < HOSTS; host++)
    {
        ty_roots_recipe recipe = recipe_for(host);
        grown on;
        recipe.host.floor = false;
        grow(&recipe, NULL, &on);
        const growth g = {.recipe = &recipe, .host = &on.host};
        const seed_run run = {.g = &g, .unit = 1e-3f, .r = 2e-3f};
        int failed[ROOTS_FAILURES + 1] = {0}, kinks = 0, ours = 0, our_kinks = 0;
        for (uint64_t i = 0; i < 400; i++)
        {
            ty_rng rng = ty_rng_make((ty_seed){3}, i, 0);
            float turn = ty_rng_range(&rng, 0.0f, 2.0f * TY_PI), y = ty_rng_range(&rng, -0.07f, 0.07f);
            float other = turn + ty_rng_range(&rng, 0.6f, 1.4f), aside = ty_rng_range(&rng, -8e-3f, 8e-3f);
            ty_vec3 na, nb, a = place_about(&on.host, turn, y, &na), b = place_about(&on.host, other, y + aside, &nb);
            roots_failure failure = seed_curve_find(&run, a, b, &rng, c);
            failed[failure]++;
            kinks += failure == ROOTS_FAILURES && kinked(c->places, c->count);
            bool found = wraps(&g, a, b, na, nb, i, w);
            ours += !found;
            our_kinks += found && kinked(w->p, w->count);
        }
        int all = 400 - failed[ROOTS_FAILURES];
        print_message("%-9s of 400 pairs %d fail (%d no angle, %d restarts), %d kinked; ours %d, %d kinked\n",
                      names[host], all, failed[ROOTS_NO_ANGLE], failed[ROOTS_RESTARTS], kinks, ours, our_kinks);
        assert_in_range(all, lost[host] - 60, lost[host] + 60);
        assert_true(kinks > 100);
        assert_int_equal(ours + our_kinks, 0);
        drop(&on);
    }
    ty_free(c);
    ty_free(w);
}

// --- its formulas ---

static float apart(ty_vec3 a, ty_vec3 b)
{
    return ty_length(ty_sub(a, b));
}

static void lines_are_those_of_the_thesis(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_for(PILLAR);
    float unit = recipe.radius * recipe.thesis.unit;
    grown g;
    grow(&recipe, NULL, &g);
    int firsts = 0, seconds = 0, bent = 0;
    for (int i = 0; i < g.net.line_count; i++)
    {
        const roots_line* l = &g.net.lines[i];
        const roots_point* p = g.net.points + l->first;
        if (l->kind == ROOTS_MAIN)
        {
            assert_true(apart(p[0].p, g.net.points[0].p) == 0.0f); // all from G
            assert_float_equal(apart(p[1].p, p[0].p), 10.0f * unit, 1e-3f * unit);
            for (int k = 2; k < l->count; k++) // five moves of at most 4 ahead and 4 aside
                assert_true(apart(p[k].p, p[k - 1].p) <= 2.0f * 5.0f * sqrtf(32.0f) * unit);
        }
        else if (l->kind == ROOTS_FIRST)
        {
            const roots_line* from = &g.net.lines[l->parent];
            int b = l->parent_point - from->first;
            assert_true(b >= 4 && (b - 4) % 5 == 0);
            assert_true(apart(p[0].p, g.net.points[l->parent_point].p) == 0.0f);
            if (l->end >= 0)
            {
                assert_int_equal(l->end, (l->parent + 1) % recipe.count);
                assert_int_equal(l->end_point - g.net.lines[l->end].first, b);
                assert_true(apart(p[l->count - 1].p, g.net.points[l->end_point].p) == 0.0f);
            }
            if (b + 5 < from->count) // (3.14): the root goes on along 2 M' - K, its first control point
            {
                const roots_point* m = &g.net.points[l->parent_point];
                ty_vec3 way = ty_normalize(ty_sub(m[1].p, m[0].p)), off = ty_normalize(ty_sub(p[1].p, p[0].p));
                bent += ty_dot(way, off) < 0.7f;
            }
            firsts++;
        }
        else if (l->kind == ROOTS_SECOND)
        {
            assert_int_equal(l->count, 6);
            assert_int_equal(g.net.lines[l->parent].kind, ROOTS_FIRST);
            assert_int_equal(g.net.lines[l->parent].parent, g.net.lines[l->end].parent); // of one main root
            assert_int_equal(g.net.lines[l->end].parent_point - g.net.lines[l->parent].parent_point, 5);
            seconds++;
        }
        for (int k = 0; k < l->count; k++)
            assert_true(p[k].r == recipe.radius && p[k].flat == 1.0f);
    }
    assert_true(firsts > 10 && seconds > 5 && 2 * bent > firsts);
    drop(&g);
}

// Before branches bend them: one that creeps over the ground up to a wall.
static void main_roots_do_not_enter_the_host(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_for(GROUND);
    ty_roots_object_def* objects = recipe.host.objects.items;
    grown g;
    objects[1] = box((ty_vec3){0.005f, 0.05f, 0.3f}, (ty_vec3){0.06f, 0.05f, 0.0f});
    recipe.host.objects.count = 2;
    recipe.start.points = (ty_param_list){(ty_vec3[]){{0.0f, 0.01f, 0.0f}}, 1};
    recipe.count = 1;
    recipe.length = 0.25f; // not to where the wall ends
    grow(&recipe, NULL, &g);
    float farthest = 0.0f;
    assert_int_equal(g.net.line_count, 1);
    for (int k = 0; k < g.net.point_count; k++)
    {
        ty_vec3 n;
        assert_true(roots_host_exact(&g.host, g.net.points[k].p, 0.01f, &n) >= recipe.radius);
        farthest = ty_max(farthest, g.net.points[k].p.x);
    }
    assert_true(farthest > 0.04f && farthest < 0.053f); // it came to the wall
    drop(&g);
}

static void workers_and_repeats_change_nothing(void** state)
{
    (void)state;
    ty_roots_recipe recipe = recipe_for(COMPOUND);
    grown a, b;
    ty_workers* workers;
    ty_error error;
    grow(&recipe, NULL, &a);
    assert_int_equal(ty_workers_create(3, &workers, &error), TY_OK);
    grow(&recipe, workers, &b);
    assert_int_equal(a.net.point_count, b.net.point_count);
    assert_memory_equal(a.net.points, b.net.points, (size_t)a.net.point_count * sizeof(roots_point));
    assert_memory_equal(a.net.failed, b.net.failed, sizeof a.net.failed);
    drop(&b);
    recipe.seed.value++;
    grow(&recipe, NULL, &b);
    assert_true(memcmp(a.net.points, b.net.points, 100 * sizeof(roots_point)) != 0);
    ty_workers_destroy(workers);
    drop(&a);
    drop(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_fails_where_ours_does_not),
        cmocka_unit_test(as_printed_roots_drift_away),
        cmocka_unit_test(pairs_about_a_pillar),
        cmocka_unit_test(lines_are_those_of_the_thesis),
        cmocka_unit_test(main_roots_do_not_enter_the_host),
        cmocka_unit_test(workers_and_repeats_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
