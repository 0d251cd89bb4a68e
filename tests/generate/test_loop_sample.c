// SPDX-License-Identifier: Apache-2.0
// Samples of volumes: against exact arithmetic, and the same bits in every width.
#define TY_SIMD_PORTABLE
#define KERNEL portable
#include "../../generate/pattern/loop_volume.h"
ty_loop_sample_fn ty_loop_sample_portable;
#include "../../generate/pattern/loop_sample_kernel.h"
#include "loop_frames.h"

enum
{
    SIZE = 21,
    WIDTH = 61
};

static ty_loop_grid any_grid(ty_rng* rng)
{
    float p[9];
    for (int i = 0; i < 9; i++)
        p[i] = i < 3 ? ty_rng_range(rng, -8.0f, 24.0f) : ty_rng_range(rng, -0.6f, 0.6f);
    return (ty_loop_grid){{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, {p[6], p[7], p[8]}};
}

static void every_width_gives_the_same_bits(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make((ty_seed){3}, 0, 0);
    int inside = 0;
    for (int i = 0; i < 400; i++)
    {
        ty_loop_volume volume = loop_waves(SIZE, 7.0f, i % 2, (uint64_t)i % 5);
        ty_loop_grid grid = any_grid(&rng);
        int sampling = i % 3 == 0 ? TY_LOOP_NEAREST : TY_LOOP_TRILINEAR, from = i % 5;
        float a[WIDTH], b[WIDTH], c[WIDTH];
        ty_loop_sample_portable(&volume, &grid, sampling, 3, from, WIDTH, a);
        ty_loop_sample_base(&volume, &grid, sampling, 3, from, WIDTH, b);
        ty_loop_sampler()(&volume, &grid, sampling, 3, from, WIDTH, c);
        for (int x = from; x < WIDTH; x++)
        {
            ty_loop_corners corners = ty_loop_corners_of(&volume, &grid, sampling, x, 3);
            double sum = 0.0;
            for (int k = 0; k < 8; k++)
                sum += (double)corners.weight[k] * volume.values[corners.at[k]] / (double)TY_LOOP_ONE;
            assert_true(fabs(sum - (double)a[x - from]) < 1e-6);
            inside += sum > 0.0;
        }
        size_t bytes = (size_t)(WIDTH - from) * sizeof *a;
        assert_memory_equal(a, b, bytes);
        assert_memory_equal(a, c, bytes);
        ty_loop_volume_term(&volume);
    }
    assert_true(inside > 1000);
}

// The value that a place has in exact arithmetic between the voxels around it.
static double exact(const ty_loop_volume* v, const double p[3])
{
    double sum = 0.0;
    for (int c = 0; c < 8; c++)
    {
        double weight = 1.0;
        int q[3];
        for (int k = 0; k < 3; k++)
        {
            double clamped = v->wrap[k] ? p[k] : fmin(fmax(p[k], 0.0), v->size[k] - 1.0);
            double f = clamped - floor(clamped);
            q[k] = (int)floor(clamped) + (c >> k & 1);
            weight *= c >> k & 1 ? f : 1.0 - f;
            if (v->wrap[k])
                q[k] = (q[k] % v->size[k] + v->size[k]) % v->size[k];
            else if (q[k] >= v->size[k])
                q[k] = v->size[k] - 1;
        }
        sum += weight * v->values[ty_loop_voxel(v, q[0], q[1], q[2])] / (double)TY_LOOP_ONE;
    }
    return sum;
}

static void values_lie_between_eight_voxels(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make((ty_seed){4}, 0, 0);
    for (int i = 0; i < 200; i++)
    {
        ty_loop_volume v = loop_waves(SIZE, 7.0f, i % 2, (uint64_t)i % 5);
        ty_loop_grid g = any_grid(&rng);
        float out[WIDTH];
        ty_loop_sample_base(&v, &g, TY_LOOP_TRILINEAR, 2, 0, WIDTH, out);
        for (int x = 0; x < WIDTH; x++)
        {
            double p[3] = {g.origin.x + x * (double)g.across.x + 2.0 * (double)g.down.x,
                           g.origin.y + x * (double)g.across.y + 2.0 * (double)g.down.y,
                           g.origin.z + x * (double)g.across.z + 2.0 * (double)g.down.z};
            bool inside = true, near_border = false;
            for (int k = 0; k < 3; k++)
                if (!v.wrap[k])
                {
                    inside &= p[k] > -0.5 && p[k] < v.size[k] - 0.5;
                    near_border |= fabs(p[k] + 0.5) < 1e-4 || fabs(p[k] - v.size[k] + 0.5) < 1e-4;
                }
            if (!near_border)
                assert_true(fabs((double)out[x] - (inside ? exact(&v, p) : 0.0)) < 2e-5);
        }
        ty_loop_volume_term(&v);
    }
}

static void voxels_are_what_they_are(void** state)
{
    (void)state;
    ty_loop_volume v = loop_waves(SIZE, 7.0f, false, 1);
    for (int z = 0; z < SIZE; z++)
        for (int sampling = TY_LOOP_NEAREST; sampling <= TY_LOOP_TRILINEAR; sampling++)
        {
            float out[SIZE];
            ty_loop_grid g = {{0.0f, 0.0f, (float)z}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
            ty_loop_sample_base(&v, &g, sampling, z, 0, SIZE, out);
            for (int x = 0; x < SIZE; x++)
                assert_int_equal(ty_loop_number_of(out[x]), v.values[ty_loop_voxel(&v, x, z, z)]);
        }
    ty_loop_volume_term(&v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_width_gives_the_same_bits),
        cmocka_unit_test(values_lie_between_eight_voxels),
        cmocka_unit_test(voxels_are_what_they_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
