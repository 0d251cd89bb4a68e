// SPDX-License-Identifier: Apache-2.0
// `evaluate: depth` where bodies are thin beside the mean free path: light walks there.
#include "stage.h"
#include <tsuya/shading/walk.h>

#define POINTS 40

static const ty_vec3 lights[3] = {{0, 1, 0}, {1, 0, 0}, {0.577350269f, 0.577350269f, 0.577350269f}};

static void make_disc(stage* s)
{
    ty_shape_def shape = shape_of(TY_SHAPE_CYLINDER, 2e-3f, 0, 0);
    shape.height = 0.5e-3f;
    shape.rounding = 0.2e-3f;
    stage_init_one(s, &shape);
}

static ty_material* white_walk(float mean_free_path)
{
    ty_walk_def d = ty_walk_def_default();
    ty_material* m;
    ty_error error = {0};
    d.common.color = ty_input_scalar(1);
    d.common.specular_weight = ty_input_scalar(0);
    d.common.mean_free_path = ty_input_scalar(mean_free_path);
    assert_int_equal(ty_material_create_walk(&d, &m, &error), TY_OK);
    return m;
}

// From all around, so that the rim is among them.
static ty_surface_point point_of(const stage* s, int i)
{
    float z = 1.0f - 2.0f * ((float)i + 0.5f) / POINTS, r = sqrtf(1 - z * z), turn = 2.4f * (float)i;
    ty_vec3 out = {r * ty_cos(turn), z, r * ty_sin(turn)};
    return seen(s, ty_mul(out, 0.01f), ty_neg(out));
}

// RMS of what points show over all lights, and how far the sum under light from the edge is off.
static void compare(const stage* s, const ty_material* a, const ty_material* b, double* rms, double* flux)
{
    double squares = 0.0, sums[2] = {0};
    for (int i = 0; i < POINTS; i++)
    {
        ty_surface_point p = point_of(s, i);
        for (int k = 0; k < 3; k++)
        {
            double x = lit(s, a, &p, p.ns, lights[k], 5000), y = lit(s, b, &p, p.ns, lights[k], 5000);
            squares += (x - y) * (x - y) / (3 * POINTS);
            sums[0] += k == 1 ? x : 0.0;
            sums[1] += k == 1 ? y : 0.0;
        }
    }
    *rms = sqrt(squares);
    *flux = sums[0] / sums[1] - 1.0;
}

static void test_plates_walk(void** state)
{
    (void)state;
    stage s;
    make_disc(&s);
    for (int i = 0; i < 2; i++)
    {
        float path = i ? 0.15e-3f : 0.6e-3f; // every second walks, all do
        ty_cdrf_def d = white_cdrf(TY_CDRF_DEPTH, TY_CDRF_POISSON, path);
        ty_material *depth = cdrf(&d), *walk = white_walk(path);
        double rms, flux;
        compare(&s, depth, walk, &rms, &flux);
        print_message("disc, l %.2f mm: depth against walk, RMS %.4f, flux %+.1f %%\n", 1e3 * (double)path, rms,
                      100 * flux);
        assert_true(rms < (i ? 0.012 : 0.003)); // those that walk have the walk's own random numbers
        assert_near(flux, 0, i ? 0.045 : 0.003);
        ty_material_destroy(depth);
        ty_material_destroy(walk);
    }
    stage_term(&s);
}

// Channels of which one walks, one does so now and then, and one never: each stays white and shows what it shows alone.
static void test_channels_of_a_plate(void** state)
{
    (void)state;
    static const float scale[3] = {1.0f, 0.5f, 0.1f};
    stage s;
    make_disc(&s);
    for (int turn = 0; turn < 3; turn++)
    {
        ty_cdrf_def d = white_cdrf(TY_CDRF_DEPTH, TY_CDRF_POISSON, 0.3e-3f), alone = d;
        d.mean_free_path_scale = ty_input_make(ty_rgb_make(scale[(turn + 2) % 3], scale[turn], scale[(turn + 1) % 3]));
        alone.mean_free_path = ty_input_scalar(0.3e-3f * scale[turn]);
        ty_material *m = cdrf(&d), *grey = cdrf(&alone);
        ty_surface_point p = seen(&s, ty_vec3_make(1.8e-3f, 0.01f, 1e-5f), ty_vec3_make(0, -1, 0));
        ty_rng rng = ty_rng_make((ty_seed){6}, 0, 0);
        double sum = 0.0;
        int n = 100000;
        for (int i = 0; i < n; i++)
        {
            ty_bsdf b;
            ty_rgb weight;
            float u[4];
            random4(&rng, u);
            ty_material_prepare(m, &s.context, &p, p.ns, &b);
            if (ty_bsdf_resolve(&b, &s.context, u, &rng, &weight))
                sum += (double)weight.g / n;
        }
        assert_near(sum, 1.0, 0.012);
        // The light that comes through tells channels apart.
        static const ty_vec3 beneath = {0, -1, 0};
        assert_near(lit(&s, m, &p, p.ns, beneath, 100000), lit(&s, grey, &p, p.ns, beneath, 30000), 0.012);
        ty_material_destroy(m);
        ty_material_destroy(grey);
    }
    stage_term(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plates_walk),
        cmocka_unit_test(test_channels_of_a_plate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
