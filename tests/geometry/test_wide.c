// SPDX-License-Identifier: Apache-2.0
// The tests of the wide top level by themselves: boxes against exact arithmetic.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../../geometry/trace_wide_boxes.h"
#include <string.h>
#include <tsuya/base/rng.h>

static float between(ty_rng* rng, float low, float high)
{
    return low + (high - low) * ty_rng_float(rng);
}

static ty_vec3 point_between(ty_rng* rng, ty_vec3 low, ty_vec3 high)
{
    return (ty_vec3){between(rng, low.x, high.x), between(rng, low.y, high.y), between(rng, low.z, high.z)};
}

// A point of the box; every coordinate is on one of the two faces as often as between them.
static ty_vec3 point_of(ty_rng* rng, ty_bounds b)
{
    float u[3];
    for (int i = 0; i < 3; i++)
    {
        u[i] = between(rng, -0.5f, 1.5f);
        u[i] = u[i] < 0.0f ? 0.0f : u[i] > 1.0f ? 1.0f : u[i];
    }
    return (ty_vec3){u[0] < 1.0f ? b.low.x + u[0] * (b.high.x - b.low.x) : b.high.x,
                     u[1] < 1.0f ? b.low.y + u[1] * (b.high.y - b.low.y) : b.high.y,
                     u[2] < 1.0f ? b.low.z + u[2] * (b.high.z - b.low.z) : b.high.z};
}

// In double: where the ray enters the box grown by `grown`, and leaves it. The differences of floats are exact but for
// one rounding of 2^-53.
static bool meets(ty_bounds b, ty_vec3 o, ty_vec3 d, double grown, double* enter, double* leave)
{
    const double low[3] = {b.low.x, b.low.y, b.low.z}, high[3] = {b.high.x, b.high.y, b.high.z};
    const double from[3] = {o.x, o.y, o.z}, along[3] = {d.x, d.y, d.z};
    *enter = 0.0;
    *leave = 1e30;
    for (int i = 0; i < 3; i++)
    {
        double l = low[i] - grown - from[i], h = high[i] + grown - from[i];
        if (along[i] == 0.0 && (l > 0.0 || h < 0.0))
            return false;
        if (along[i] == 0.0)
            continue;
        double near = (along[i] > 0.0 ? l : h) / along[i], far = (along[i] > 0.0 ? h : l) / along[i];
        *enter = near > *enter ? near : *enter;
        *leave = far < *leave ? far : *leave;
    }
    return *enter <= *leave;
}

static float largest(ty_bounds b)
{
    ty_vec3 reach = ty_max3(ty_max3(b.high, ty_neg(b.high)), ty_max3(b.low, ty_neg(b.low)));
    return ty_max(reach.x, ty_max(reach.y, reach.z));
}

static void fill_node(ty_rng* rng, ty_wide_node* node, ty_bounds box[TY_LANES])
{
    float far = between(rng, 0.0f, 1.0f) < 0.5f ? 0.05f : 30.0f;
    for (int i = 0; i < TY_LANES; i++)
    {
        ty_vec3 at = point_between(rng, (ty_vec3){-far, -far, -far}, (ty_vec3){far, far, far});
        ty_vec3 size = point_between(rng, (ty_vec3){0, 0, 0}, (ty_vec3){0.01f, 0.01f, 0.01f});
        box[i] = (ty_bounds){at, ty_add(at, size)};
        if (i % 5 == 0) // flat ones
            box[i].high.y = box[i].low.y;
        ty_bounds padded = ty_wide_padded(box[i]);
        const float planes[6] = {padded.low.x, padded.low.y, padded.low.z, padded.high.x, padded.high.y, padded.high.z};
        for (int k = 0; k < 6; k++)
            node->plane[k][i] = planes[k];
    }
}

// From near and from far away, through corners, edges and flat boxes, along axes and nearly so: what exact arithmetic
// meets is met, and no later; what passes by at a distance of a few roundings is not.
static void boxes_are_never_missed(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make((ty_seed){41}, 0, 0);
    int met = 0, missed = 0;
    ty_wide_node node;
    ty_bounds box[TY_LANES];
    for (int round = 0; round < 200000; round++)
    {
        if (round % 20 == 0)
            fill_node(&rng, &node, box);
        static const float distances[] = {0.02f, 1.0f, 60.0f, 3000.0f};
        float far = distances[round % 4];
        ty_vec3 origin = point_between(&rng, (ty_vec3){-far, -far, -far}, (ty_vec3){far, far, far});
        int aim = (int)(ty_rng_float(&rng) * 15.99f);
        ty_vec3 target = point_of(&rng, box[aim]);
        if (round % 3 == 0) // along an axis, or nearly
            origin.z = target.z + (round % 9 == 0 ? 1e-7f * ty_rng_float(&rng) : 0.0f);
        if (round % 6 == 0)
            origin.x = target.x;
        ty_vec3 direction = ty_normalize(ty_sub(target, origin));
        ty_box_ray ray = ty_box_ray_make(origin, direction);
        _Alignas(64) float entry[TY_LANES];
        uint32_t mask = ty_meet_boxes(&node, &ray, 0.0f, TY_FLOAT_MAX, entry);
        for (int i = 0; i < TY_LANES; i++)
        {
            double enter, leave, grown = 4e-6 * (double)ty_max(largest(box[i]), largest((ty_bounds){origin, origin}));
            bool is_met = mask >> i & 1;
            if (meets(box[i], origin, direction, 0.0, &enter, &leave))
            {
                assert_true(is_met);
                assert_true((double)entry[i] <= enter);
                met++;
            }
            else if (!meets(box[i], origin, direction, grown, &enter, &leave))
            {
                assert_false(is_met);
                missed++;
            }
        }
    }
    assert_true(met > 50000 && missed > 1000000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(boxes_are_never_missed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
