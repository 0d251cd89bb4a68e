// SPDX-License-Identifier: Apache-2.0
// `cdrf` by channel, under maps that keep no angles, and by the curvature that is asked for.
#include "stage.h"

static const float radius = 1e-3f;

static ty_surface_point from_above(const stage* s)
{
    return seen(s, ty_vec3_make(1e-7f, 1.0f, 2e-7f), ty_vec3_make(0, -1, 0));
}

static void set_scale(ty_cdrf_def* d, int turn)
{
    static const float scale[3] = {1.0f, 0.35f, 0.08f};
    d->mean_free_path_scale = ty_input_make(ty_rgb_make(scale[(turn + 2) % 3], scale[turn % 3], scale[(turn + 1) % 3]));
}

// --- channels ---

static void test_channels_follow_their_kernels(void** state)
{
    (void)state;
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, radius, 0, 0);
    stage_init_one(&s, &shape);
    ty_surface_point p = from_above(&s);
    for (int turn = 0; turn < 3; turn++)
        for (int e = TY_CDRF_DEPTH; e <= TY_CDRF_LOCAL; e++)
        {
            ty_cdrf_def d = white_cdrf((ty_cdrf_evaluate)e, TY_CDRF_POISSON, 0.29f * radius);
            set_scale(&d, turn);
            ty_material* m = cdrf(&d);
            float t = ty_cdrf_poisson_t(0.29f * d.mean_free_path_scale.value.g, 0);
            for (int a = 30; a <= 180; a += 50)
            {
                double angle = a * M_PI / 180;
                ty_vec3 light = {(float)(sin(angle) * 0.8), (float)cos(angle), (float)(sin(angle) * 0.6)};
                double ours = lit(&s, m, &p, p.ns, light, e == TY_CDRF_LOCAL ? 1 : 60000);
                assert_near(ours, (double)ty_cdrf_poisson(t, (float)cos(angle)), e == TY_CDRF_LOCAL ? 0.003 : 0.007);
            }
            ty_material_destroy(m);
        }
    stage_term(&s);
}

// Exits of one channel while any of three is chosen, against the Poisson kernel: chi-squared with weights.
static void check_exits_of_green(const stage* s, int turn, ty_cdrf_evaluate evaluate)
{
    enum
    {
        BINS = 24,
        COUNT = 60000
    };
    ty_cdrf_def d = white_cdrf(evaluate, TY_CDRF_POISSON, 0.29f * radius);
    set_scale(&d, turn);
    ty_material* m = cdrf(&d);
    ty_surface_point p = from_above(s);
    ty_rng rng = ty_rng_make((ty_seed){6}, 0, 0);
    double g = exp(-(double)ty_cdrf_poisson_t(0.29f * d.mean_free_path_scale.value.g, 0));
    double sum[BINS] = {0}, squares[BINS] = {0}, all = 0.0, chi = 0.0;
    for (int i = 0; i < COUNT; i++)
    {
        ty_bsdf b;
        ty_rgb weight;
        float u[4];
        random4(&rng, u);
        ty_material_prepare(m, &s->context, &p, p.ns, &b);
        if (!ty_bsdf_resolve(&b, &s->context, u, &rng, &weight))
            continue;
        double c = (double)ty_normalize(b.point.position).y, w = (double)weight.g;
        assert_true(w >= 0.0 && w <= 3.0001);
        double share = 1.0 - (1 - g * g) / (2 * g) * (1 / sqrt(1 + g * g - 2 * g * c) - 1 / (1 + g));
        int bin = (int)fmin(BINS - 1, fmax(0, share) * BINS);
        sum[bin] += w;
        squares[bin] += w * w;
        all += w;
    }
    assert_near(all / COUNT, 1.0, 0.02);
    for (int i = 0; i < BINS; i++)
        chi += (sum[i] - (double)COUNT / BINS) * (sum[i] - (double)COUNT / BINS) / squares[i];
    if (chi > BINS + 5 * sqrt(2.0 * BINS))
        fail_msg("channel %d does not follow its kernel: chi-squared %.1f of %d", turn, chi, BINS);
    ty_material_destroy(m);
}

static void test_exits_of_channels(void** state)
{
    (void)state;
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, radius, 0, 0);
    stage_init_one(&s, &shape);
    for (int turn = 0; turn < 2; turn++) // the facets are as wide as what the third spreads
        for (int e = TY_CDRF_DEPTH; e <= TY_CDRF_PROBE; e++)
            check_exits_of_green(&s, turn, (ty_cdrf_evaluate)e);
    stage_term(&s);
}

static double kept_of_green(const stage* s, const ty_surface_point* p, const ty_cdrf_def* d, int n)
{
    ty_material* m = cdrf(d);
    ty_rng rng = ty_rng_make((ty_seed){6}, 0, 0);
    double sum = 0.0;
    for (int i = 0; i < n; i++)
    {
        ty_bsdf b;
        ty_rgb weight;
        float u[4];
        random4(&rng, u);
        ty_material_prepare(m, &s->context, p, p->ns, &b);
        if (ty_bsdf_resolve(&b, &s->context, u, &rng, &weight))
            sum += (double)weight.g / n;
    }
    ty_material_destroy(m);
    return sum;
}

// On a torus a point within one channel's reach may not see another's exit: nothing is gained or lost by it. Most is
// hidden across a hole that is narrow beside the tube.
static void test_channels_where_light_is_hidden(void** state)
{
    (void)state;
    static const float tubes[2] = {0.6e-3f, 1.4e-3f}, paths[2] = {2e-3f, 0.4e-3f};
    for (int i = 0; i < 2; i++)
    {
        stage s;
        ty_shape_def shape = shape_of(TY_SHAPE_TORUS, 1.5e-3f, tubes[i], 0);
        stage_init_one(&s, &shape);
        ty_surface_point p = i ? seen(&s, ty_vec3_make(0.05e-3f, 1e-6f, 1e-6f), ty_vec3_make(1, 0, 0))
                               : seen(&s, ty_vec3_make(1.1e-3f, 0.01f, 1e-5f), ty_vec3_make(0, -1, 0));
        for (int turn = 0; turn < 3; turn++)
            for (int e = TY_CDRF_DEPTH; e <= TY_CDRF_PROBE; e++)
            {
                ty_cdrf_def d = white_cdrf((ty_cdrf_evaluate)e, TY_CDRF_POISSON, paths[i]);
                set_scale(&d, turn);
                double kept = kept_of_green(&s, &p, &d, 60000);
                assert_near(kept, 1.0, i ? 0.016 : 0.012);
            }
        stage_term(&s);
    }
}

// Absorbing channels spread less, by the law of their loss.
static void test_color_narrows(void** state)
{
    (void)state;
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, radius, 0, 0);
    stage_init_one(&s, &shape);
    ty_surface_point p = from_above(&s);
    for (int e = TY_CDRF_DEPTH; e <= TY_CDRF_LOCAL; e++)
    {
        ty_cdrf_def d = white_cdrf((ty_cdrf_evaluate)e, TY_CDRF_POISSON, 0.12f * radius);
        d.color = ty_input_make(ty_rgb_make(0.95f, 0.4f, 0.95f));
        ty_material* m = cdrf(&d);
        float t = ty_cdrf_poisson_t(0.12f, ty_cdrf_loss(0.4f, 0));
        assert_true(t < 0.6f * ty_cdrf_poisson_t(0.12f, 0));
        ty_vec3 side = {0.8f, 0, 0.6f};
        assert_near(lit(&s, m, &p, p.ns, side, e == TY_CDRF_LOCAL ? 1 : 200000) / 0.4, (double)ty_cdrf_poisson(t, 0),
                    0.003);
        ty_material_destroy(m);
    }
    stage_term(&s);
}

// --- maps ---

// A ball stretched to an ellipsoid is that ellipsoid.
static void test_stretched_ball(void** state)
{
    (void)state;
    static const float axes[3] = {2.0f, 1.3f, 0.9f};
    ty_affine turned = ty_affine_from_trs((ty_vec3){0}, ty_quat_axis_angle(ty_vec3_make(0.6f, 0, 0.8f), 0.7f),
                                          ty_vec3_make(axes[0], axes[1], axes[2]));
    ty_affine turn =
        ty_affine_from_trs((ty_vec3){0}, ty_quat_axis_angle(ty_vec3_make(0.6f, 0, 0.8f), 0.7f), ty_vec3_make(1, 1, 1));
    stage ball, mesh;
    ty_shape_def sphere = shape_of(TY_SHAPE_SPHERE, radius, 0, 0);
    ty_shape_def ellipsoid = shape_of(TY_SHAPE_ELLIPSOID, axes[0] * radius, axes[1] * radius, axes[2] * radius);
    stage_init(&ball, &sphere, &turned, 1);
    stage_init(&mesh, &ellipsoid, &turn, 1);
    static const ty_vec3 lights[3] = {{0, 0, 1}, {1, 0, 0}, {-0.6f, 0.64f, 0.48f}};
    double squares[3] = {0}, lambert = 0.0;
    for (int i = 0; i < 36; i++)
    {
        float z = -1.0f + ((float)i + 0.5f) / 18, r = sqrtf(1 - z * z), a = (float)i * 2.4f;
        ty_vec3 from = {r * ty_cos(a), r * ty_sin(a), z};
        ty_surface_point p = seen(&ball, ty_mul(from, 0.01f), ty_neg(from)),
                         q = seen(&mesh, ty_mul(from, 0.01f), ty_neg(from));
        assert_near(ty_dot(p.ns, q.ns), 1.0, 1e-3);
        for (int e = TY_CDRF_DEPTH; e <= TY_CDRF_LOCAL; e++)
        {
            ty_cdrf_def d = white_cdrf((ty_cdrf_evaluate)e, TY_CDRF_POISSON, 0.4e-3f);
            ty_material* m = cdrf(&d);
            int n = e == TY_CDRF_LOCAL ? 1 : 8000;
            for (int k = 0; k < 3; k++)
            {
                double x = lit(&ball, m, &p, p.ns, lights[k], n), y = lit(&mesh, m, &q, q.ns, lights[k], n);
                squares[e] += (x - y) * (x - y) / 108;
                if (e == TY_CDRF_LOCAL)
                    lambert += (y - (double)ty_max(ty_dot(q.ns, lights[k]), 0)) *
                               (y - (double)ty_max(ty_dot(q.ns, lights[k]), 0)) / 108;
            }
            ty_material_destroy(m);
        }
    }
    print_message("stretched ball against ellipsoid, RMS: depth %.4f probe %.4f local %.4f (effect %.3f)\n",
                  sqrt(squares[0]), sqrt(squares[1]), sqrt(squares[2]), sqrt(lambert));
    // What depth is off by is the smoothing of thickness along the ball, which knows nothing of the ellipsoid (.0034);
    // a chord that leaves out how the ball bends gives .0048. The others see one surface.
    assert_true(sqrt(squares[TY_CDRF_DEPTH]) < 0.004);
    assert_true(sqrt(squares[TY_CDRF_PROBE]) < 0.002);
    assert_true(sqrt(squares[TY_CDRF_LOCAL]) < 0.002);
    stage_term(&ball);
    stage_term(&mesh);
}

static void test_furnace_of_stretched_bodies(void** state)
{
    (void)state;
    // A torus sheared and mirrored.
    ty_affine map = {{-2, 0.3f, 0}, {0.5f, 1, 0.2f}, {0, 0.4f, 0.7f}, {0, 0, 0}};
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_TORUS, 1.5e-3f, 0.6e-3f, 0);
    stage_init(&s, &shape, &map, 1);
    for (int e = TY_CDRF_DEPTH; e <= TY_CDRF_LOCAL; e++)
        for (int which = TY_CDRF_CURVATURE_AUTOMATIC; which <= TY_CDRF_CURVATURE_MAXIMAL; which++)
        {
            ty_cdrf_def d = white_cdrf((ty_cdrf_evaluate)e, TY_CDRF_POISSON, 0.3e-3f);
            d.curvature = which;
            ty_material* m = cdrf(&d);
            ty_surface_point p = seen(&s, ty_vec3_make(-3e-3f, 0.01f, 1e-5f), ty_vec3_make(0, -1, 0));
            assert_near(furnace(&s, m, &p, ty_vec3_make(0, 1, 0), e == TY_CDRF_LOCAL ? 30000 : 4000), 1.0,
                        e == TY_CDRF_LOCAL ? 0.008 : 1e-5);
            ty_material_destroy(m);
        }
    stage_term(&s);
}

// --- curvature ---

static void test_curvature_that_is_asked_for(void** state)
{
    (void)state;
    // On a cylinder: 0 along it, 1 / R across, 1 / 2R on average.
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_CYLINDER, radius, 0, 0);
    shape.height = 10e-3f;
    stage_init_one(&s, &shape);
    ty_vec3 out = {1, 0, 0}, across = {0, 0, 1}, along = {0, 1, 0};
    ty_surface_point p = seen(&s, ty_vec3_make(0.01f, shape.height * 0.27f, 1e-7f), ty_neg(out));
    static const float x_across[4] = {0.25f, 0.125f, 0.25f, 0.25f}, x_along[4] = {0, 0.125f, 0, 0.25f};
    for (int which = TY_CDRF_CURVATURE_AUTOMATIC; which <= TY_CDRF_CURVATURE_MAXIMAL; which++)
    {
        ty_cdrf_def d = white_cdrf(TY_CDRF_LOCAL, TY_CDRF_POISSON, 0.25e-3f);
        d.curvature = which;
        ty_material* m = cdrf(&d);
        assert_near(lit(&s, m, &p, out, across, 1), (double)ty_cdrf_poisson(ty_cdrf_poisson_t(x_across[which], 0), 0),
                    0.004);
        assert_near(lit(&s, m, &p, out, along, 1), (double)ty_cdrf_poisson(ty_cdrf_poisson_t(x_along[which], 0), 0),
                    0.006);
        ty_material_destroy(m);
    }
    // Ways out: `automatic` is the mean.
    for (int e = TY_CDRF_DEPTH; e <= TY_CDRF_PROBE; e++)
    {
        double reach[4];
        for (int which = TY_CDRF_CURVATURE_AUTOMATIC; which <= TY_CDRF_CURVATURE_MAXIMAL; which++)
        {
            ty_cdrf_def d = white_cdrf((ty_cdrf_evaluate)e, TY_CDRF_POISSON, 0.25e-3f);
            d.curvature = which;
            ty_material* m = cdrf(&d);
            reach[which] = lit(&s, m, &p, out, across, 400000);
            ty_material_destroy(m);
        }
        assert_near(reach[TY_CDRF_CURVATURE_AUTOMATIC], reach[TY_CDRF_CURVATURE_MEAN], 1e-9);
        double towards = reach[TY_CDRF_CURVATURE_DIRECTIONAL] - reach[TY_CDRF_CURVATURE_MEAN];
        double most = reach[TY_CDRF_CURVATURE_MAXIMAL] - reach[TY_CDRF_CURVATURE_MEAN];
        // Their exits lie on the true surface, so that little changes: -.0020 and .0012 with depth.
        assert_true(fabs(towards) > 3e-4 && fabs(towards) < 0.02 && fabs(most) > 3e-4 && fabs(most) < 0.02);
    }
    stage_term(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_channels_follow_their_kernels),
        cmocka_unit_test(test_exits_of_channels),
        cmocka_unit_test(test_channels_where_light_is_hidden),
        cmocka_unit_test(test_color_narrows),
        cmocka_unit_test(test_stretched_ball),
        cmocka_unit_test(test_furnace_of_stretched_bodies),
        cmocka_unit_test(test_curvature_that_is_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
