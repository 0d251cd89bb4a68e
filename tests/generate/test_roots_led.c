// SPDX-License-Identifier: Apache-2.0
// Where roots are led: from given places, away from what is painted, round obstacles, through the air down to the
// ground, and to every place that they shall cover.
#include "roots_grown.h"
#include <tsuya/geometry/mesh_file.h>

#define RADIUS 0.04f // m, of the host
#define PATCH 0.012f // m

static ty_roots_recipe coarse(void)
{
    ty_roots_recipe recipe = ty_roots_recipe_default();
    recipe.tip = recipe.detail = 1.0e-3f;
    recipe.host.resolution = 96;
    return recipe;
}

// A ball with a painted patch on its side, 1 as far as PATCH from its middle, 0 from twice that on; and with its upper
// quarter.
static int painted_ball(void** state)
{
    (void)state;
    ty_shape_def def = ty_shape_def_default();
    ty_mesh* mesh;
    ty_error error;
    def.kind = TY_SHAPE_SPHERE;
    def.radius = RADIUS;
    def.divisions = 96;
    if (ty_shape_create(&def, &mesh, &error) != TY_OK)
        return 1;
    float* patch = ty_mesh_add_attribute(mesh, "patch", 1);
    float* top = ty_mesh_add_attribute(mesh, "top", 1);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        float far = ty_length(ty_sub(mesh->positions[v], (ty_vec3){RADIUS, 0.0f, 0.0f}));
        patch[v] = ty_clamp(2.0f - far / PATCH, 0.0f, 1.0f);
        top[v] = mesh->positions[v].y > 0.5f * RADIUS ? 1.0f : 0.0f;
    }
    ty_status status = ty_ply_write("led_ball.ply", mesh, &error);
    ty_mesh_destroy(mesh);
    return status != TY_OK;
}

static ty_roots_recipe on_painted(void)
{
    ty_roots_recipe recipe = coarse();
    recipe.host.kind = TY_ROOTS_HOST_MESH;
    recipe.host.mesh = "led_ball.ply";
    return recipe;
}

// --- starts ---

static void roots_set_out_from_given_places(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    ty_vec3 places[] = {{0.0f, RADIUS, 0.0f}, {0.8f * RADIUS, 0.6f * RADIUS, 0.0f}, {0.0f, 0.0f, -RADIUS}};
    grown g;
    recipe.start.points = (ty_param_list){places, 3};
    recipe.count = 9;
    grow(&recipe, NULL, &g);
    int from[3] = {0}, mains = 0;
    for (int i = 0; i < g.net.line_count; i++)
    {
        const roots_line* l = &g.net.lines[i];
        assert_int_not_equal(l->kind, ROOTS_TRUNK); // places stand for it
        if (l->kind != ROOTS_MAIN)
            continue;
        const roots_point *begin = &g.net.points[l->first], *end = begin + l->count - 1;
        mains++;
        for (int k = 0; k < 3; k++)
            from[k] += ty_length(ty_sub(begin->p, places[k])) < begin->r;
        assert_true(end->p.y < begin->p.y && end->s > 0.04f); // and goes down from there
    }
    assert_int_equal(mains, 9);
    for (int k = 0; k < 3; k++)
        assert_int_equal(from[k], 3);
    drop(&g);
}

static void roots_set_out_from_painted_places(void** state)
{
    (void)state;
    ty_roots_recipe recipe = on_painted();
    grown g;
    recipe.start.attribute = "top";
    recipe.count = 6;
    grow(&recipe, NULL, &g);
    for (int i = 0; i < g.net.line_count; i++)
        for (int k = 0; g.net.lines[i].kind == ROOTS_MAIN && k < i; k++)
        {
            ty_vec3 a = g.net.points[g.net.lines[i].first].p, b = g.net.points[g.net.lines[k].first].p;
            assert_true(a.y > 0.5f * RADIUS && b.y > 0.5f * RADIUS);
            assert_true(g.net.lines[k].kind != ROOTS_MAIN || ty_length(ty_sub(a, b)) > 0.4f * RADIUS);
        }
    assert_int_equal(g.net.grown[ROOTS_MAIN], 6);
    drop(&g);
}

// --- what is painted ---

// Length of roots in the middle of the patch, m, and how many branches leave there.
static float length_in_patch(const ty_roots_recipe* recipe, int* leave)
{
    grown g;
    float sum = 0.0f;
    grow(recipe, NULL, &g);
    *leave = 0;
    for (int i = 0; i < g.net.line_count; i++)
    {
        const roots_line* l = &g.net.lines[i];
        const roots_point* p = g.net.points + l->first;
        for (int k = 0; k < l->count; k++)
        {
            bool within = ty_length(ty_sub(p[k].p, (ty_vec3){RADIUS, 0.0f, 0.0f})) < PATCH;
            *leave += k == 0 && within && l->kind >= ROOTS_FIRST;
            sum += k > 0 && within ? ty_length(ty_sub(p[k].p, p[k - 1].p)) : 0.0f;
        }
    }
    drop(&g);
    return sum;
}

static void what_is_painted_leads_them(void** state)
{
    (void)state;
    float sum[3] = {0.0f};
    for (uint64_t seed = 1; seed <= 4; seed++)
        for (int k = 0; k < 3; k++)
        {
            ty_roots_recipe recipe = on_painted();
            int leave;
            recipe.seed.value = seed;
            recipe.host.avoid.attribute = k == 1 ? "patch" : NULL;
            recipe.host.attract.attribute = k == 2 ? "patch" : NULL;
            float length = length_in_patch(&recipe, &leave);
            sum[k] += length;
            assert_true(k != 1 || leave == 0);
        }
    print_message("in the patch: %.0f mm, avoided %.0f mm, drawn to %.0f mm\n", 1e3 * (double)sum[0],
                  1e3 * (double)sum[1], 1e3 * (double)sum[2]);
    assert_true(sum[1] < 0.25f * sum[0]);
    assert_true(sum[2] > 1.5f * sum[0]);
}

// --- obstacles ---

typedef struct passage
{
    float clear;    // the least way to an obstacle, of what is kept
    float shortest; // m, main root
    float mean;     // m
    float turn;     // cosine of the sharpest
} passage;

static passage pass(const ty_roots_recipe* recipe)
{
    grown g;
    passage out = {.clear = TY_FLOAT_MAX, .shortest = TY_FLOAT_MAX, .turn = 1.0f};
    int mains = 0;
    grow(recipe, NULL, &g);
    for (int i = 0; i < g.net.line_count; i++)
    {
        const roots_line* l = &g.net.lines[i];
        const roots_point* p = g.net.points + l->first;
        if (l->kind == ROOTS_TRUNK)
            continue;
        for (int k = 0; k < l->count; k++)
        {
            float far = roots_host_clear(&g.host, p[k].p, NULL);
            out.clear = ty_min(out.clear, far / (recipe->growth.clear * p[k].r));
            if (k > 0 && k + 1 < l->count)
                out.turn = ty_min(out.turn, ty_dot(ty_normalize(ty_sub(p[k].p, p[k - 1].p)),
                                                   ty_normalize(ty_sub(p[k + 1].p, p[k].p))));
        }
        if (l->kind != ROOTS_MAIN)
            continue;
        out.shortest = ty_min(out.shortest, p[l->count - 1].s);
        out.mean += p[l->count - 1].s;
        mains++;
    }
    out.mean /= (float)mains;
    drop(&g);
    return out;
}

// A pillar with a ball, then a bar, built into its side: roots come down to it head on and flow past.
static void roots_flow_past_obstacles(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    recipe.host.kind = TY_ROOTS_HOST_BOX;
    recipe.host.shape.size = (ty_vec3){0.02f, 0.1f, 0.02f};
    recipe.host.shape.rounding = 2e-3f;
    recipe.length = 0.5f;
    passage free = pass(&recipe);
    for (int kind = 0; kind < 2; kind++)
    {
        ty_roots_object_def object = {.shape = ty_shape_def_default(), .scale = {1.0f, 1.0f, 1.0f}};
        object.kind = kind ? TY_ROOTS_HOST_BOX : TY_ROOTS_HOST_SPHERE;
        object.shape.radius = 0.011f;
        object.shape.size = (ty_vec3){0.016f, 4e-3f, 0.01f};
        object.shape.rounding = 1e-3f;
        object.translate = (ty_vec3){0.002f, 0.02f, 0.022f};
        recipe.obstacles = (ty_param_list){&object, 1};
        passage past = pass(&recipe);
        print_message("%s: %.2f of what they keep clear, sharpest turn %.0f degrees, main roots %.0f mm, shortest %.0f "
                      "(free: %.0f, %.0f)\n",
                      kind ? "bar " : "ball", (double)past.clear, acos((double)past.turn) * 57.3,
                      1e3 * (double)past.mean, 1e3 * (double)past.shortest, 1e3 * (double)free.mean,
                      1e3 * (double)free.shortest);
        assert_true(past.clear > 0.9f);
        assert_true(past.shortest > 0.95f * free.shortest); // none ends there
        assert_true(past.mean > 0.98f * free.mean);
        assert_true(past.turn > 0.17f); // 80 degrees
    }
}

// --- roots that hang ---

static void aerial_roots_fall_plumb_and_take_hold(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    recipe.host.floor_height = -0.06f;
    recipe.aerial.count = 6;
    recipe.length = 0.4f;
    grown g;
    grow(&recipe, NULL, &g);
    assert_int_equal(g.net.requested[ROOTS_AERIAL], 6);
    assert_int_equal(g.net.grown[ROOTS_AERIAL], 6);
    for (int i = 0; i < g.net.line_count; i++)
    {
        const roots_line* l = &g.net.lines[i];
        const roots_point* p = g.net.points + l->first;
        if (l->kind != ROOTS_AERIAL)
            continue;
        int falls = 0, ground = 0;
        float r = g.net.points[l->parent_point].r, wide = 0.0f;
        assert_memory_equal(&p->p, &g.net.points[l->parent_point].p, sizeof p->p);
        for (int k = 0; k < l->count; k++)
        {
            ground += p[k].p.y < g.host.floor + 2.0f * p[k].r && p[k].sink > 0.0f;
            if (k == 0 || p[k].sink > 0.0f || p[k].s < p[0].s + 8.0f * r || ground)
                continue;
            ty_vec3 way = ty_sub(p[k].p, p[k - 1].p);
            falls += way.y < -0.9f * ty_length(way);
            wide += sqrtf(way.x * way.x + way.z * way.z);
        }
        print_message("aerial: %d of %d points fall plumb, %.1f mm aside, %d on the ground\n", falls, l->count,
                      1e3 * (double)wide, ground);
        assert_true(falls > 8 && wide < 0.02f);
        assert_true(ground > 4 && p[l->count - 1].p.y < g.host.floor + p[l->count - 1].r);
    }
    drop(&g);
}

// --- cover ---

// Share of places of the host, where roots can hold on, that are as near to one as they ask for.
static float covered(const grown* g, float reach)
{
    ty_rng rng = ty_rng_make((ty_seed){5}, 1, 2);
    int near = 0, all = 0;
    for (int i = 0; i < 4000; i++)
    {
        float y = ty_rng_range(&rng, -0.5f, 1.0f), a = ty_rng_range(&rng, 0.0f, 2.0f * TY_PI), best = TY_FLOAT_MAX;
        float x = ty_cos(a) * sqrtf(1.0f - y * y), z = ty_sin(a) * sqrtf(1.0f - y * y);
        ty_vec3 p = ty_mul((ty_vec3){x, y, z}, RADIUS);
        for (int k = 0; k < g->net.point_count; k++)
            best = ty_min(best, ty_length_sqr(ty_sub(p, g->net.points[k].p)));
        near += best < reach * reach;
        all++;
    }
    return (float)near / (float)all;
}

static void fine_roots_cover_what_is_left(void** state)
{
    (void)state;
    ty_roots_recipe recipe = coarse();
    grown bare, whole;
    recipe.count = 6;
    recipe.first.spacing = 0.0f;
    grow(&recipe, NULL, &bare);
    recipe.cover.spacing = 6e-3f;
    recipe.cover.radius = 1e-3f;
    grow(&recipe, NULL, &whole);
    float reach = 1.5f * recipe.cover.spacing, before = covered(&bare, reach), after = covered(&whole, reach);
    print_message("within one and a half spacings of a root: %.3f, with %d fine roots %.3f\n", (double)before,
                  whole.net.grown[ROOTS_FINE], (double)after);
    assert_true(before < 0.6f && after > 0.99f);
    for (int i = 0; i < whole.net.line_count; i++)
    {
        const roots_line* l = &whole.net.lines[i];
        if (l->kind == ROOTS_FINE)
            assert_memory_equal(&whole.net.points[l->first].p, &whole.net.points[l->parent_point].p, sizeof(ty_vec3));
    }
    drop(&bare);
    drop(&whole);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roots_set_out_from_given_places),
        cmocka_unit_test(roots_set_out_from_painted_places),
        cmocka_unit_test(what_is_painted_leads_them),
        cmocka_unit_test(roots_flow_past_obstacles),
        cmocka_unit_test(aerial_roots_fall_plumb_and_take_hold),
        cmocka_unit_test(fine_roots_cover_what_is_left),
    };
    return cmocka_run_group_tests(tests, painted_ball, NULL);
}
