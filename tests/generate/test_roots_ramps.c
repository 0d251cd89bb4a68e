// SPDX-License-Identifier: Apache-2.0
// Radii and branches along ramps: as thick, and as many, as the recipe says, and all else stays.
#include "base/cmocka_all.h"
#include "roots.h"
#include <stdlib.h>
#include <string.h>

static ty_roots_recipe column(void)
{
    ty_roots_recipe recipe = ty_roots_recipe_default();
    recipe.host.kind = TY_ROOTS_HOST_CYLINDER;
    recipe.host.shape.radius = 0.05f;
    recipe.host.shape.height = 0.3f;
    recipe.host.resolution = 96;
    recipe.count = 8;
    recipe.length = 0.4f;
    recipe.tip = recipe.detail = 0.8e-3f;
    return recipe;
}

static roots_network grow(const ty_roots_recipe* recipe)
{
    roots_host host;
    roots_network net;
    ty_error error = {0};
    assert_int_equal(roots_host_init(recipe, NULL, NULL, &host, &error), TY_OK);
    assert_int_equal(roots_grow(recipe, &host, NULL, &net, &error), TY_OK);
    roots_host_term(&host);
    return net;
}

static void radii_follow_the_ramp(void** state)
{
    (void)state;
    static ty_vec2 points[] = {{0.0f, 1.5f}, {0.25f, 0.75f}, {0.75f, 1.0f}};
    ty_roots_recipe recipe = column();
    recipe.first.spacing = recipe.second.spacing = 0.0f; // whose pipes would add to it
    roots_network plain = grow(&recipe);
    recipe.radius_by_length = (ty_param_list){points, 3};
    roots_network shaped = grow(&recipe);
    assert_int_equal(shaped.point_count, plain.point_count);
    int seen = 0;
    for (int l = 0; l < plain.line_count; l++)
        for (int i = 0; i < plain.lines[l].count && plain.lines[l].kind == ROOTS_MAIN; i++)
        {
            int at = plain.lines[l].first + i;
            float t = (plain.points[at].s - plain.points[plain.lines[l].first].s) / recipe.length;
            float factor = t <= 0.25f ? 1.5f - 3.0f * t : t <= 0.75f ? 0.75f + 0.5f * (t - 0.25f) : 1.0f;
            float expected = ty_max(factor * plain.points[at].r, ty_min(plain.points[at].r, recipe.tip));
            assert_float_equal(shaped.points[at].r, expected, 0.02f * expected);
            seen++;
        }
    assert_true(seen > 500);
    roots_network_term(&plain);
    roots_network_term(&shaped);
}

// First branches by where they leave, below and above the middle of the column, which is at 0.
static void branches_count(const roots_network* net, int out[2])
{
    memset(out, 0, 2 * sizeof *out);
    for (int l = 0; l < net->line_count; l++)
        if (net->lines[l].kind == ROOTS_FIRST)
            out[net->points[net->lines[l].parent_point].p.y > 0.0f]++;
}

static void branches_leave_where_the_ramp_lets_them(void** state)
{
    (void)state;
    static ty_vec2 above[] = {{0.5f, 0.0f}, {0.5001f, 1.0f}}, thin[] = {{0.0f, 0.3f}};
    ty_roots_recipe recipe = column();
    roots_network net = grow(&recipe);
    int all[2], some[2];
    branches_count(&net, all);
    assert_true(all[0] >= 8 && all[1] >= 20);
    roots_network_term(&net);
    recipe.first.density_by_height = (ty_param_list){above, 2};
    net = grow(&recipe);
    branches_count(&net, some);
    print_message("%d and %d branches below and above; with a step %d and %d", all[0], all[1], some[0], some[1]);
    assert_int_equal(net.requested[ROOTS_FIRST], net.grown[ROOTS_FIRST]);
    assert_true(some[0] <= 1); // one may move with what the others do to its root
    assert_true(abs(some[1] - all[1]) <= 2);
    roots_network_term(&net);
    recipe.first.density_by_height = (ty_param_list){thin, 1};
    net = grow(&recipe);
    branches_count(&net, some);
    print_message("; at .3 %d and %d\n", some[0], some[1]);
    assert_float_equal((float)(some[0] + some[1]) / (float)(all[0] + all[1]), 0.3f, 0.1f);
    roots_network_term(&net);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radii_follow_the_ramp),
        cmocka_unit_test(branches_leave_where_the_ramp_lets_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
