// SPDX-License-Identifier: Apache-2.0
// `cdrf` on ellipsoids, tori, slabs and heaps: against random walks, energy, depth fields, and the rays that leave.
#include "../../shading/depth_field.h"
#include "stage.h"
#include <tsuya/shading/sampling.h>

// --- random walk in an ellipsoid: diffuse entry, isotropic white scattering, Lambert where it leaves ---

static const double axes[3] = {2.5e-3, 1.4e-3, 1.0e-3};

static double exit_distance(const double p[3], const double w[3])
{
    double a = 0, b = 0, c = -1;
    for (int k = 0; k < 3; k++)
    {
        a += w[k] * w[k] / axes[k] / axes[k];
        b += p[k] * w[k] / axes[k] / axes[k];
        c += p[k] * p[k] / axes[k] / axes[k];
    }
    return (-b + sqrt(fmax(0, b * b - a * c))) / a;
}

static ty_vec3 walk_exit_normal(ty_vec3 x, ty_vec3 n, double mean_free_path, ty_rng* rng)
{
    float ux = ty_rng_float(rng);
    ty_vec3 w = ty_neg(ty_to_world(ty_frame_from_normal(n), ty_sample_cosine((ty_vec2){ux, ty_rng_float(rng)})));
    double p[3] = {(double)x.x, (double)x.y, (double)x.z};
    for (;;)
    {
        double d[3] = {(double)w.x, (double)w.y, (double)w.z}, end = exit_distance(p, d);
        double step = -log(1.0 - (double)ty_rng_float(rng)) * mean_free_path;
        for (int k = 0; k < 3; k++)
            p[k] += d[k] * fmin(step, end);
        if (step >= end)
            break;
        ux = ty_rng_float(rng);
        w = ty_sample_sphere((ty_vec2){ux, ty_rng_float(rng)});
    }
    return ty_normalize(ty_vec3_make((float)(p[0] / axes[0] / axes[0]), (float)(p[1] / axes[1] / axes[1]),
                                     (float)(p[2] / axes[2] / axes[2])));
}

#define POINTS 150
#define WALKS 1000 // in each of two halves, so that noise cancels in the mean square

static const ty_vec3 lights[3] = {{0, 0, 1}, {1, 0, 0}, {0.577350269f, 0.577350269f, 0.577350269f}};

static ty_vec3 model_normal(const stage* s, const ty_material* m, const ty_surface_point* p, ty_rng* rng)
{
    ty_bsdf b;
    ty_rgb weight;
    float u[4];
    random4(rng, u);
    ty_material_prepare(m, &s->context, p, p->ng, &b);
    assert_true(ty_bsdf_resolve(&b, &s->context, u, rng, &weight));
    return b.frame.n;
}

// Uniform over the surface: triangles in proportion to area by rejection.
static ty_surface_point random_point(const stage* s, ty_rng* rng)
{
    const ty_mesh* mesh = s->mesh;
    float largest = 0;
    for (uint32_t pass = 0, t = 0;; t++)
    {
        if (t == mesh->triangle_count)
        {
            t = 0;
            pass = 1;
        }
        uint32_t k = pass ? ty_rng_u32(rng) % mesh->triangle_count : t;
        const uint32_t* v = mesh->triangles[k];
        ty_vec3 a = mesh->positions[v[0]];
        float area = ty_length(ty_cross(ty_sub(mesh->positions[v[1]], a), ty_sub(mesh->positions[v[2]], a)));
        if (!pass)
            largest = ty_max(largest, area);
        else if (ty_rng_float(rng) * largest < area)
        {
            float q = sqrtf(ty_rng_float(rng)), r = ty_rng_float(rng);
            ty_hit hit = {.u = q * (1 - r), .v = q * r, .triangle = k};
            ty_surface_point p;
            ty_world_surface(s->world, &hit, &p);
            return p;
        }
    }
}

// Pooled area-weighted RMS against the walk under three lights; a fully lit Lambert point is 1.
static void pooled_error(const stage* s, const ty_material* m, double mean_free_path, double* model, double* lambert)
{
    ty_rng rng = ty_rng_make((ty_seed){17}, 0, 0);
    *model = *lambert = 0.0;
    for (int i = 0; i < POINTS; i++)
    {
        double truth[2][3] = {{0}}, ours[2][3] = {{0}};
        ty_surface_point p = random_point(s, &rng);
        for (int k = 0; k < 2 * WALKS; k++)
        {
            ty_vec3 nw = walk_exit_normal(p.position, p.ns, mean_free_path, &rng), nm = model_normal(s, m, &p, &rng);
            for (int j = 0; j < 3; j++)
            {
                truth[k & 1][j] += (double)ty_max(ty_dot(nw, lights[j]), 0) / WALKS;
                ours[k & 1][j] += (double)ty_max(ty_dot(nm, lights[j]), 0) / WALKS;
            }
        }
        for (int j = 0; j < 3; j++)
        {
            double plain = (double)ty_max(ty_dot(p.ns, lights[j]), 0);
            *model += (ours[0][j] - truth[0][j]) * (ours[1][j] - truth[1][j]) / POINTS / 3;
            *lambert += (plain - truth[0][j]) * (plain - truth[1][j]) / POINTS / 3;
        }
    }
    *model = sqrt(fmax(*model, 0));
    *lambert = sqrt(fmax(*lambert, 0));
}

static void test_ellipsoid_against_walks(void** state)
{
    (void)state;
    static const double paths[2] = {0.25e-3, 0.6e-3}, lambert_expected[2] = {0.100, 0.175};
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_ELLIPSOID, (float)axes[0], (float)axes[1], (float)axes[2]);
    stage_init_one(&s, &shape);
    for (int i = 0; i < 2; i++)
        for (int e = TY_CDRF_DEPTH; e <= TY_CDRF_PROBE; e++)
        {
            ty_cdrf_def d = white_cdrf(e, TY_CDRF_POISSON, (float)paths[i]);
            ty_material* m = cdrf(&d);
            double model, lambert;
            pooled_error(&s, m, paths[i], &model, &lambert);
            print_message("l %.2f mm, %s: RMS %.4f, Lambert %.4f\n", paths[i] * 1e3, e ? "probe" : "depth", model,
                          lambert);
            assert_near(lambert, lambert_expected[i], 0.02);
            assert_true(model < (e == TY_CDRF_DEPTH ? 0.015 : 0.06));
            ty_material_destroy(m);
        }
    stage_term(&s);
}

static void test_ellipsoid_is_symmetric(void** state)
{
    (void)state;
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_ELLIPSOID, (float)axes[0], (float)axes[1], (float)axes[2]);
    stage_init_one(&s, &shape);
    ty_cdrf_def d = white_cdrf(TY_CDRF_DEPTH, TY_CDRF_POISSON, 0.4e-3f);
    ty_material* m = cdrf(&d);
    double value[4];
    for (int i = 0; i < 4; i++)
    {
        ty_vec3 sign = ty_vec3_make(i & 1 ? -1 : 1, 1, i & 2 ? -1 : 1);
        ty_surface_point p =
            seen(&s, ty_mul3(ty_vec3_make(0.8e-3f, 0.5e-3f, 0.01f), sign), ty_vec3_make(0, 0, -sign.z));
        ty_vec3 light = ty_mul3(ty_normalize(ty_vec3_make(-0.6f, 0.5f, 0.3f)), sign);
        value[i] = lit(&s, m, &p, ty_vec3_make(0, 0, sign.z), light, 100000);
        assert_true(value[i] > 0.05 && value[i] < 0.95);
        assert_near(value[i], value[0], 0.006);
    }
    ty_material_destroy(m);
    stage_term(&s);
}

static float at_point(const stage* s, const ty_surface_point* p, const float* field)
{
    const uint32_t* v = s->mesh->triangles[p->triangle];
    return field[v[0]] * (1 - p->u - p->v) + field[v[1]] * p->u + field[v[2]] * p->v;
}

// Lines from the point beneath x where body and spheroid are no spheres: (1 + B / sqrt(B^2 + A C)) / (4 pi), by bins of
// the cosine and around the normal.
static void test_direction_density(void** state)
{
    (void)state;
    enum
    {
        BINS = 24,
        COUNT = 64000
    };
    ty_shape_def shape = shape_of(TY_SHAPE_ELLIPSOID, 1.5e-3f, 1e-3f, 1e-3f);
    stage s;
    stage_init_one(&s, &shape);
    ty_surface_point x = seen(&s, ty_vec3_make(0.01f, 1e-5f, 2e-5f), ty_vec3_make(-1, 0, 0));
    double D = (double)at_point(&s, &x, s.field->depth), H = (double)at_point(&s, &x, s.field->curvature);
    double k = 0.5 * H + 1 / D, a = 0.5 * D, path = 0.3e-3;
    double d = (1 - exp(-(double)ty_cdrf_poisson_t((float)(k * path), 0))) / k, m = a - d, C = 1 - m * m / (a * a);
    assert_true(fabs(H * a - 1) > 0.3 && d < 0.25 * D); // no sphere, and not its middle
    ty_cdrf_def def = white_cdrf(TY_CDRF_DEPTH, TY_CDRF_POISSON, (float)path);
    ty_material* material = cdrf(&def);
    ty_rng rng = ty_rng_make((ty_seed){8}, 0, 0);
    double count[BINS] = {0}, around[8] = {0}, chi = 0, total = 0;
    int far = 0;
    ty_vec3 p = ty_mad(x.position, x.ns, -(float)d);
    for (int i = 0; i < COUNT; i++)
    {
        ty_bsdf b;
        ty_rgb weight;
        float u[4];
        random4(&rng, u);
        ty_material_prepare(material, &s.context, &x, x.ns, &b);
        assert_true(ty_bsdf_resolve(&b, &s.context, u, &rng, &weight));
        ty_vec3 way = ty_sub(b.point.position, p);
        if ((double)ty_length(way) >= D) // the far pole, or where a walk went on to before it
        {
            far++;
            continue;
        }
        ty_vec3 w = ty_to_local(ty_frame_from_normal(x.ns), ty_normalize(way));
        count[(int)fmin(BINS - 1, fmax(0, (double)(w.z + 1) * BINS / 2))]++;
        double turn = atan2((double)w.y, (double)w.x) / (2 * M_PI);
        around[(int)((turn - floor(turn)) * 8) % 8]++;
    }
    for (int i = 0; i < BINS; i++)
    {
        double expected = 0;
        for (int j = 0; j < 100; j++)
        {
            double z = -1 + 2 * (i + (j + 0.5) / 100) / BINS, A = (1 - z * z) * H / a + z * z / (a * a),
                   B = m * z / (a * a);
            expected += 0.5 * (1 + B / sqrt(B * B + A * C)) * 2 / BINS / 100 * COUNT;
        }
        total += expected;
        if (i >= 2) // the far pole lies within the first
            chi += (count[i] - expected) * (count[i] - expected) / expected;
    }
    assert_near(total / COUNT, 1, 1e-3);
    assert_true(far < COUNT / 200);
    if (chi > BINS - 2 + 5 * sqrt(2.0 * BINS))
        fail_msg("lines do not follow their density: chi-squared %.1f of %d", chi, BINS - 2);
    for (int i = 0; i < 8; i++)
        assert_near(around[i], (COUNT - far) / 8.0, 5 * sqrt(COUNT / 8.0));
    ty_material_destroy(material);
    stage_term(&s);
}

// --- energy where rays come back ---

static void test_furnace_of_a_heap(void** state)
{
    (void)state;
    // Grains that overlap by a hundredth: light born inside a neighbour must get out.
    ty_affine maps[9];
    for (int i = 0; i < 9; i++)
        maps[i] = ty_affine_from_trs(
            ty_mul(ty_vec3_make((float)(i % 3 - 1), 0.02f * (float)(i % 2), (float)(i / 3 - 1)), 1.98e-3f),
            ty_quat_identity(), ty_vec3_make(1, 1, 1));
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, 1e-3f, 0, 0);
    shape.divisions = 64;
    stage_init(&s, &shape, maps, 9);
    for (int e = TY_CDRF_DEPTH; e <= TY_CDRF_LOCAL; e++)
    {
        ty_cdrf_def d = white_cdrf(e, TY_CDRF_POISSON, 0.5e-3f);
        ty_material* m = cdrf(&d);
        ty_surface_point p = seen(&s, ty_vec3_make(0.7e-3f, 0.01f, 0.5e-3f), ty_vec3_make(0, -1, 0));
        assert_near(furnace(&s, m, &p, ty_vec3_make(0, 1, 0), 20000), 1.0, e == TY_CDRF_LOCAL ? 0.005 : 1e-5);
        ty_material_destroy(m);
    }
    stage_term(&s);
}

static void test_furnace_of_a_torus(void** state)
{
    (void)state;
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_TORUS, 1.5e-3f, 0.6e-3f, 0);
    stage_init_one(&s, &shape);
    for (int e = TY_CDRF_DEPTH; e <= TY_CDRF_LOCAL; e++)
        for (int side = 0; side < 2; side++) // outer half, and inner with one negative curvature
        {
            ty_cdrf_def d = white_cdrf(e, TY_CDRF_POISSON, 0.3e-3f);
            ty_material* m = cdrf(&d);
            ty_surface_point p = seen(&s, ty_vec3_make(side ? 1.1e-3f : 1.9e-3f, 0.01f, 1e-5f), ty_vec3_make(0, -1, 0));
            assert_near(furnace(&s, m, &p, ty_vec3_make(0, 1, 0), 30000), 1.0, e == TY_CDRF_LOCAL ? 0.006 : 1e-5);
            ty_bsdf b;
            ty_material_prepare(m, &s.context, &p, ty_vec3_make(0, 1, 0), &b);
            assert_false(b.point.convex);
            if (e == TY_CDRF_LOCAL)
                check_sampling(&b, p.ns, 200000);
            ty_material_destroy(m);
        }
    stage_term(&s);
}

static void test_local_curvature_has_a_direction(void** state)
{
    (void)state;
    // On a cylinder light along the axis sees no curvature, light across it sees 1 / R.
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_CYLINDER, 1e-3f, 0, 0);
    shape.height = 10e-3f;
    stage_init_one(&s, &shape);
    ty_cdrf_def d = white_cdrf(TY_CDRF_LOCAL, TY_CDRF_POISSON, 0.25e-3f);
    ty_material* m = cdrf(&d);
    ty_vec3 out = {1, 0, 0}, across = {0, 0, 1}, along = {0, 1, 0};
    ty_surface_point p = seen(&s, ty_vec3_make(0.01f, shape.height * 0.27f, 1e-7f), ty_neg(out));
    ty_bsdf b;
    float pdf;
    ty_material_prepare(m, &s.context, &p, out, &b);
    assert_near(M_PI * (double)ty_bsdf_eval(&b, across, &pdf).g, 0.148, 0.004);
    assert_near(M_PI * (double)ty_bsdf_eval(&b, along, &pdf).g, 0.0, 0.005);
    ty_vec3 half = ty_normalize(ty_add(across, along));
    float t = ty_cdrf_poisson_t(0.125f, 0);
    assert_near(M_PI * (double)ty_bsdf_eval(&b, half, &pdf).g, (double)ty_cdrf_poisson(t, 0), 0.004);
    ty_material_destroy(m);
    stage_term(&s);
}

// --- depth fields ---

static float field_at(const stage* s, const ty_surface_point* p, float mean_free_path, ty_rng* rng)
{
    // The depth d shows in how far the mean exit lies beneath: read it from the material instead of its insides.
    ty_cdrf_def d = white_cdrf(TY_CDRF_DEPTH, TY_CDRF_POISSON, mean_free_path);
    ty_material* m = cdrf(&d);
    double sum = 0;
    for (int i = 0; i < 20000; i++)
    {
        ty_bsdf b;
        ty_rgb weight;
        float u[4];
        random4(rng, u);
        ty_material_prepare(m, &s->context, p, p->ng, &b);
        assert_true(ty_bsdf_resolve(&b, &s->context, u, rng, &weight));
        sum += (double)ty_dot(ty_sub(p->position, b.point.position), p->ns) / 20000;
    }
    ty_material_destroy(m);
    return (float)sum;
}

static void test_slab_transmits(void** state)
{
    (void)state;
    // A wide slab of thickness D: k = 1/D, and the exits are on the far side with probability d / D (gambler's ruin).
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_BOX, 20e-3f, 0.5e-3f, 20e-3f);
    shape.rounding = 0.2e-3f;
    stage_init_one(&s, &shape);
    ty_surface_point p = seen(&s, ty_vec3_make(1e-3f, 0.01f, -2e-3f), ty_vec3_make(0, -1, 0));
    ty_rng rng = ty_rng_make((ty_seed){4}, 0, 0);
    double D = 1e-3, path = 0.3e-3, d = D * (1 - exp(-(double)ty_cdrf_poisson_t((float)(path / D), 0)));
    assert_near(field_at(&s, &p, (float)path, &rng) / D, d / D, 0.03);
    stage_term(&s);
}

static void test_open_mesh_has_a_field(void** state)
{
    (void)state;
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_PLANE, 1e-2f, 0, 1e-2f);
    stage_init_one(&s, &shape);
    ty_cdrf_def d = white_cdrf(TY_CDRF_DEPTH, TY_CDRF_POISSON, 0.3e-3f);
    ty_material* m = cdrf(&d);
    ty_surface_point p = seen(&s, ty_vec3_make(1e-3f, 0.01f, 1e-5f), ty_vec3_make(0, -1, 0));
    // Nothing encloses the walk, so now and then it ends without a way out: light leaves where it came in.
    assert_near(furnace(&s, m, &p, ty_vec3_make(0, 1, 0), 2000), 1.0, 1e-5);
    ty_material_destroy(m);
    stage_term(&s);
}

static void test_probe_on_a_plane(void** state)
{
    (void)state;
    // No curvature: half the light leaves within sqrt(3) s0, s0 = (4/3) l, of where it entered.
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_PLANE, 1e-2f, 0, 1e-2f);
    stage_init_one(&s, &shape);
    ty_cdrf_def d = white_cdrf(TY_CDRF_PROBE, TY_CDRF_POISSON, 0.1e-3f);
    ty_material* m = cdrf(&d);
    ty_surface_point p = seen(&s, ty_vec3_make(1e-3f, 0.01f, 1e-5f), ty_vec3_make(0, -1, 0));
    ty_rng rng = ty_rng_make((ty_seed){8}, 0, 0);
    double within = 0, beside = 0, n = 20000;
    for (int i = 0; i < (int)n; i++)
    {
        ty_bsdf b;
        ty_rgb weight;
        float u[4];
        random4(&rng, u);
        ty_material_prepare(m, &s.context, &p, p.ng, &b);
        assert_true(ty_bsdf_resolve(&b, &s.context, u, &rng, &weight));
        ty_vec3 apart = ty_sub(b.point.position, p.position);
        within += (double)ty_length(apart) < sqrt(3) * 4 / 3 * 0.1e-3;
        beside += apart.x > 0;
        assert_near(b.frame.n.y, 1.0, 1e-6);
    }
    assert_near(within / n, 0.5, 0.015);
    assert_near(beside / n, 0.5, 0.015);
    ty_material_destroy(m);
    stage_term(&s);
}

// Length of the normal's line inside the ellipsoid at vertex i, by formula.
static double thickness_at(const ty_mesh* mesh, uint32_t i)
{
    ty_vec3 v = mesh->positions[i];
    double p[3] = {(double)v.x, (double)v.y, (double)v.z}, n[3], length = 0;
    for (int k = 0; k < 3; k++)
    {
        n[k] = -p[k] / axes[k] / axes[k];
        length += n[k] * n[k];
    }
    for (int k = 0; k < 3; k++)
        n[k] /= sqrt(length);
    return exit_distance(p, n);
}

static void test_thickness_is_smoothed(void** state)
{
    (void)state;
    // Against the definition, all vertices by all: the mean of 1/D under a Gaussian of width .35 * 3 V/A, at most D.
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_ELLIPSOID, (float)axes[0], (float)axes[1], (float)axes[2]);
    shape.divisions = 64;
    stage_init_one(&s, &shape);
    const ty_mesh* mesh = s.mesh;
    const ty_mesh_topology* topology = ty_world_topology(s.world, 0);
    double* area = TY_ALLOC(double, mesh->vertex_count);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        const uint32_t* v = mesh->triangles[t];
        ty_vec3 a = mesh->positions[v[0]];
        ty_vec3 cross = ty_cross(ty_sub(mesh->positions[v[1]], a), ty_sub(mesh->positions[v[2]], a));
        for (int k = 0; k < 3; k++)
            area[v[k]] += (double)ty_length(cross) / 6;
    }
    double width = 0.35 * 3 * topology->volume / topology->area, changed = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i += 7)
    {
        double sum = 0, weight = 0, plain = thickness_at(mesh, i);
        for (uint32_t k = 0; k < mesh->vertex_count; k++)
        {
            double d = (double)ty_length(ty_sub(mesh->positions[i], mesh->positions[k])) / width;
            double w = d < 3 ? area[k] * exp(-0.5 * d * d) : 0;
            sum += w / thickness_at(mesh, k);
            weight += w;
        }
        double expected = fmin(plain, weight / sum);
        assert_near((double)s.field->depth[i] / expected, 1.0, 0.02);
        changed = fmax(changed, 1 - expected / plain);
    }
    assert_true(changed > 0.1);
    ty_free(area);
    stage_term(&s);
}

static void test_depth_field_without_memory(void** state)
{
    (void)state;
    stage s;
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, 1e-3f, 0, 0);
    shape.divisions = 32;
    stage_init_one(&s, &shape);
    for (int i = 0; i < 3; i++)
    {
        ty_depth_field* field;
        ty_error error;
        ty_memory_fail_after(i);
        assert_int_equal(ty_depth_field_create(s.world, 0, &field, &error), TY_NO_MEMORY);
        ty_memory_fail_after(-1);
        assert_null(field);
    }
    stage_term(&s);
}

// --- the rays that leave ---

static void test_spawned_rays(void** state)
{
    (void)state;
    stage ball, ring;
    ty_shape_def sphere = shape_of(TY_SHAPE_SPHERE, 1e-3f, 0, 0), torus = shape_of(TY_SHAPE_TORUS, 1.5e-3f, 0.6e-3f, 0);
    stage_init_one(&ball, &sphere);
    stage_init_one(&ring, &torus);
    ty_cdrf_def d = white_cdrf(TY_CDRF_LOCAL, TY_CDRF_POISSON, 0.3e-3f);
    ty_material* m = cdrf(&d);
    ty_vec3 up = {0, 1, 0}, down = ty_normalize(ty_vec3_make(0.6f, -0.8f, 0));
    ty_surface_point p = seen(&ball, up, ty_neg(up));
    ty_bsdf b;
    ty_ray ray;
    ty_material_prepare(m, &ball.context, &p, up, &b);
    ty_bsdf_spawn(&b, down, 0.5f, &ray);
    assert_int_equal(ray.flags, TY_RAY_FRONT_ONLY);
    assert_true(ray.skip_instance == 0 && ray.skip_distance == TY_FLOAT_MAX && ray.t_max == TY_FLOAT_MAX);
    assert_true(ray.origin.y < p.position.y);
    // The ring may shadow itself: own hits are passed through for three chords of the osculating circle, .7..1.3 times.
    p = seen(&ring, ty_vec3_make(1.9e-3f, 0.01f, 1e-5f), ty_neg(up));
    ty_material_prepare(m, &ring.context, &p, p.ns, &b);
    ty_vec3 across = ty_normalize(ty_vec3_make(p.ns.y, -p.ns.x, 0)), in = ty_normalize(ty_mad(across, p.ns, -0.75f));
    ty_bsdf_spawn(&b, in, 0.5f, &ray);
    assert_near(ray.skip_distance / (6 * 0.6f * 0.6e-3f), 1.0, 0.03);
    float middle = ray.skip_distance;
    ty_bsdf_spawn(&b, in, 0.0f, &ray);
    assert_near(ray.skip_distance / middle, 0.7, 1e-3);
    ty_bsdf_spawn(&b, p.ns, 0.5f, &ray);
    assert_true(ray.skip_instance == TY_NONE);
    ty_material_destroy(m);
    // A clear ball: refracted rays must meet it again, reflected ones cannot.
    ty_surface_def g = ty_surface_def_default();
    g.transmission_weight = ty_input_scalar(1);
    m = surface(&g);
    p = seen(&ball, up, ty_neg(up));
    ty_material_prepare(m, &ball.context, &p, up, &b);
    ty_bsdf_spawn(&b, up, 0.5f, &ray);
    assert_true(ray.skip_instance == 0);
    ty_bsdf_spawn(&b, ty_neg(up), 0.5f, &ray);
    assert_true(ray.skip_instance == TY_NONE);
    ty_material_destroy(m);
    stage_term(&ball);
    stage_term(&ring);
}

static void test_glass_ball_vanishes(void** state)
{
    (void)state;
    stage s;
    ty_shape_def sphere = shape_of(TY_SHAPE_SPHERE, 1e-2f, 0, 0);
    ty_affine identity = ty_affine_identity();
    ty_error error;
    assert_int_equal(ty_shape_create(&sphere, &s.mesh, &error), TY_OK);
    stage_place(&s, &identity, 1, false);
    ty_surface_def g = ty_surface_def_default();
    g.transmission_weight = ty_input_scalar(1);
    g.specular_roughness = ty_input_scalar(0);
    ty_material* m = surface(&g);
    for (int i = 0; i < 20; i++)
    {
        ty_vec3 from = ty_vec3_make(0.98e-2f * (float)i / 20, 0.1e-2f, 1);
        ty_surface_point p = seen(&s, from, ty_vec3_make(0, 0, -1));
        assert_near(furnace(&s, m, &p, ty_vec3_make(0, 0, 1), 2000), 1.0, 0.005);
    }
    ty_material_destroy(m);
    stage_term(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ellipsoid_against_walks),
        cmocka_unit_test(test_ellipsoid_is_symmetric),
        cmocka_unit_test(test_direction_density),
        cmocka_unit_test(test_furnace_of_a_heap),
        cmocka_unit_test(test_furnace_of_a_torus),
        cmocka_unit_test(test_local_curvature_has_a_direction),
        cmocka_unit_test(test_slab_transmits),
        cmocka_unit_test(test_open_mesh_has_a_field),
        cmocka_unit_test(test_probe_on_a_plane),
        cmocka_unit_test(test_thickness_is_smoothed),
        cmocka_unit_test(test_depth_field_without_memory),
        cmocka_unit_test(test_spawned_rays),
        cmocka_unit_test(test_glass_ball_vanishes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
