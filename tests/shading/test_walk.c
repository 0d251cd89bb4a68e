// SPDX-License-Identifier: Apache-2.0
// Random walks: free flights and the phase function by their densities, bodies by what is known of them.
#include "stage.h"
#include <tsuya/shading/media.h>
#include <tsuya/shading/sampling.h>
#include <tsuya/shading/walk.h>

static const float radius = 1e-3f;

static ty_material* walk_material(const ty_walk_def* def)
{
    ty_material* m = NULL;
    ty_error error = {0};
    assert_int_equal(ty_material_create_walk(def, &m, &error), TY_OK);
    return m;
}

static ty_walk_def bare(float mean_free_path)
{
    ty_walk_def d = ty_walk_def_default();
    d.common.color = ty_input_scalar(1);
    d.common.specular_weight = ty_input_scalar(0);
    d.common.mean_free_path = ty_input_scalar(mean_free_path);
    return d;
}

static ty_scattering matter(float mean_free_path, float albedo, float g)
{
    return (ty_scattering){ty_rgb_grey(1 / mean_free_path), ty_rgb_grey(albedo), g};
}

// Mean weight, scatterings, and cosine of exit to entry over walks that enter by the cosine at x.
typedef struct tally
{
    double r, g, b, scatterings, cosine;
    int lost, cut;
} tally;

static tally run(const stage* s, const ty_surface_point* x, const ty_scattering* m, int n)
{
    tally sum = {0};
    ty_rng rng = ty_rng_make((ty_seed){3}, 1, 4);
    ty_frame frame = ty_frame_from_normal(ty_neg(x->ng));
    for (int i = 0; i < n; i++)
    {
        ty_walk w;
        float u[4];
        random4(&rng, u);
        ty_vec3 direction = ty_to_world(frame, ty_sample_cosine((ty_vec2){u[0], u[1]}));
        ty_walk_end end = ty_walk_through(s->world, x, m, direction, u[2], &rng, &w);
        sum.lost += end == TY_WALK_LOST;
        sum.cut += end == TY_WALK_CUT;
        if (end != TY_WALK_LEFT)
            continue;
        sum.r += (double)w.beta.r / n;
        sum.g += (double)w.beta.g / n;
        sum.b += (double)w.beta.b / n;
        sum.scatterings += (double)w.scatterings / n;
        sum.cosine += (double)(w.beta.g * ty_dot(x->ng, w.exit.ng)) / n;
    }
    return sum;
}

static stage ball;
static ty_surface_point pole;

static int make_ball(void** state)
{
    (void)state;
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, radius, 0, 0);
    stage_init_one(&ball, &shape);
    pole = seen(&ball, ty_vec3_make(0, 0.01f, 0), ty_vec3_make(0, -1, 0));
    return 0;
}

static int drop_ball(void** state)
{
    (void)state;
    stage_term(&ball);
    return 0;
}

// Albedo of whole spheres of R = 4 mean free paths, and the mean number of scatterings of a white walk.
static void test_sphere(void** state)
{
    (void)state;
    ty_scattering m = matter(radius / 4, 0.98f, 0);
    assert_near(run(&ball, &pole, &m, 60000).g, 0.905, 0.005);
    m = matter(radius / 4, 0.9f, 0);
    assert_near(run(&ball, &pole, &m, 60000).g, 0.659, 0.005);
    const float optical[4] = {0.5f, 2, 4, 12};
    for (int i = 0; i < 4; i++)
    {
        m = matter(radius / optical[i], 1, 0);
        tally t = run(&ball, &pole, &m, 60000);
        // Rounding lets very few out where triangles meet.
        assert_near(t.g + t.lost / 60000.0, 1, 1e-6);
        assert_true(t.lost <= 2 && t.cut == 0);
        assert_near(t.scatterings / ((double)optical[i] * 4 / 3), 1, 0.02);
    }
}

// First moment of where light leaves a white sphere: e^-t with t = .294 at curvature * mean free path 1/4.
static void test_exits(void** state)
{
    (void)state;
    ty_scattering m = matter(radius / 4, 1, 0);
    assert_near(run(&ball, &pole, &m, 60000).cosine, exp(-0.294), 0.008);
}

// In matter of anisotropy g a transport mean free path is that of single scatterings over 1 - g.
static void test_similarity(void** state)
{
    (void)state;
    ty_scattering plain = matter(radius / 8, 1, 0), forward = matter(radius / 8 * 0.4f, 1, 0.6f);
    tally a = run(&ball, &pole, &plain, 40000), b = run(&ball, &pole, &forward, 40000);
    assert_near(b.cosine, a.cosine, 0.012);
    // Mean way through the body is 4R/3, whatever scatters in it.
    assert_near(b.scatterings / (8 / 0.4 * 4 / 3), 1, 0.03);
}

// Channels that differ, walked together, are each what they are alone.
static void test_channels(void** state)
{
    (void)state;
    ty_scattering all = {{1 / 0.2e-3f, 1 / 0.5e-3f, 1 / 2e-3f}, {0.9f, 0.98f, 0.7f}, 0};
    tally t = run(&ball, &pole, &all, 120000);
    const double together[3] = {t.r, t.g, t.b};
    for (int c = 0; c < 3; c++)
    {
        ty_scattering one = {ty_rgb_grey((&all.extinction.r)[c]), ty_rgb_grey((&all.albedo.r)[c]), 0};
        assert_near(together[c], run(&ball, &pole, &one, 60000).g, 0.006);
    }
}

// Guided walks in absorbing matter are short and of nearly equal weight: unguided their second moment is 1.12 times the
// mean squared, after 31 scatterings.
static void test_guided_walks_are_alike(void** state)
{
    (void)state;
    ty_scattering m = matter(radius / 50, 0.99f, 0);
    ty_rng rng = ty_rng_make((ty_seed){3}, 1, 4);
    ty_frame frame = ty_frame_from_normal(ty_neg(pole.ng));
    double sum = 0, squares = 0, scatterings = 0;
    const int n = 40000;
    for (int i = 0; i < n; i++)
    {
        ty_walk w;
        float u[4];
        random4(&rng, u);
        ty_vec3 direction = ty_to_world(frame, ty_sample_cosine((ty_vec2){u[0], u[1]}));
        ty_walk_end end = ty_walk_through(ball.world, &pole, &m, direction, u[2], &rng, &w);
        double beta = end == TY_WALK_LEFT ? (double)w.beta.g : 0.0;
        sum += beta;
        squares += beta * beta;
        scatterings += w.scatterings;
    }
    print_message("mean %.4f, second moment %.4f of it squared, %.2f scatterings\n", sum / n, squares * n / (sum * sum),
                  scatterings / n);
    assert_true(squares * n / (sum * sum) < 1.05);
    assert_true(scatterings / n < 20);
}

// Without scattering light goes straight on and Beer's law is all there is.
static void test_absorption_alone(void** state)
{
    (void)state;
    ty_scattering m = {{500, 1000, 0}, {0, 0, 0}, 0};
    ty_rng rng = ty_rng_make((ty_seed){5}, 0, 0);
    double sum[3] = {0};
    int n = 40000;
    for (int i = 0; i < n; i++)
    {
        ty_walk w;
        if (ty_walk_through(ball.world, &pole, &m, ty_vec3_make(0, -1, 0), ty_rng_float(&rng), &rng, &w) !=
            TY_WALK_LEFT)
            continue;
        sum[0] += (double)w.beta.r / n;
        sum[1] += (double)w.beta.g / n;
        sum[2] += (double)w.beta.b / n;
        assert_near(w.exit.position.y, -radius, 1e-6);
    }
    assert_near(sum[0], exp(-1), 0.006);
    assert_near(sum[1], exp(-2), 0.006);
    assert_near(sum[2], 1, 0.006);
}

static void test_phase_function(void** state)
{
    (void)state;
    const float anisotropy[4] = {0, 0.4f, -0.7f, 0.9f};
    ty_rng rng = ty_rng_make((ty_seed){7}, 0, 0);
    for (int k = 0; k < 4; k++)
    {
        enum
        {
            BINS = 40,
            N = 80000
        };
        float g = anisotropy[k];
        double count[BINS] = {0}, around[8] = {0}, chi = 0, chi_around = 0, total = 0;
        ty_vec3 forward = ty_normalize(ty_vec3_make(0.3f, -0.5f, 0.7f));
        ty_frame frame = ty_frame_from_normal(forward);
        for (int i = 0; i < N; i++)
        {
            float u = ty_rng_float(&rng);
            ty_vec3 w = ty_to_local(frame, ty_phase_sample(g, forward, (ty_vec2){u, ty_rng_float(&rng)}));
            assert_near(ty_length(w), 1, 1e-5);
            count[(int)fmin(BINS - 1, fmax(0, (double)(w.z + 1) * BINS / 2))]++;
            double turn = atan2((double)w.y, (double)w.x) / (2 * M_PI);
            around[(int)((turn - floor(turn)) * 8) % 8]++;
        }
        for (int i = 0; i < BINS; i++)
        {
            double expected = 0;
            for (int j = 0; j < 400; j++)
                expected += (double)ty_phase_pdf(g, (float)(-1 + 2 * (i + (j + 0.5) / 400) / BINS)) * 2 * M_PI * 2 /
                            BINS / 400 * N;
            total += expected;
            chi += (count[i] - expected) * (count[i] - expected) / expected;
        }
        for (int i = 0; i < 8; i++)
            chi_around += (around[i] - N / 8.0) * (around[i] - N / 8.0) / (N / 8.0);
        assert_near(total / N, 1, 1e-3);
        assert_true(chi < 80 && chi_around < 30); // 39 and 7 degrees of freedom
    }
}

static void test_albedo_inversion(void** state)
{
    (void)state;
    assert_near(ty_walk_albedo(1, 0.3f), 1, 0);
    for (float color = 0.05f; color < 0.96f; color += 0.1f)
        for (float g = -0.5f; g < 0.9f; g += 0.5f)
            assert_near(ty_walk_color(ty_walk_albedo(color, g), g), color, 0.006);
    // A body of many mean free paths reflects what was asked for; not at the pole, which is the tip of a cone.
    ty_scattering m = matter(radius / 1000, ty_walk_albedo(0.6f, 0), 0);
    ty_surface_point x = seen(&ball, ty_vec3_make(0.01f, 0.21e-3f, 0.3e-3f), ty_vec3_make(-1, 0, 0));
    assert_near(run(&ball, &x, &m, 60000).g, 0.6, 0.006);
}

// A stretched and sheared instance is the mesh so stretched and sheared.
static void test_affine_instance(void** state)
{
    (void)state;
    ty_affine maps[2] = {{{2.0f, 0.3f, 0}, {0.5f, 0.8f, -0.2f}, {0, 0.1f, -1.1f}, {0.4f, 0, 0}}, ty_affine_identity()};
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, radius, 0, 0);
    stage s;
    stage_init(&s, &shape, maps, 1);
    ty_mesh* mesh = NULL;
    ty_error error = {0};
    assert_int_equal(ty_shape_create(&shape, &mesh, &error), TY_OK);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        mesh->positions[i] = ty_map_point(&maps[0], mesh->positions[i]);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) // the map is a reflection: keep the outside out
    {
        uint32_t v = mesh->triangles[i][1];
        mesh->triangles[i][1] = mesh->triangles[i][2];
        mesh->triangles[i][2] = v;
    }
    ty_bounds box = ty_bounds_empty();
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        box = ty_bounds_add(box, mesh->positions[i]);
    mesh->bounds = box;
    stage plain = {.mesh = mesh};
    ty_world_def def = ty_world_def_default();
    uint32_t prototype, object;
    assert_int_equal(ty_world_create(&def, &plain.world, &error), TY_OK);
    assert_int_equal(ty_world_add_prototype(plain.world, mesh, &prototype, &error), TY_OK);
    assert_int_equal(ty_world_add_object(plain.world, prototype, ty_motion_at_rest(&maps[1]),
                                         (ty_object_flags){true, TY_MASK_OPAQUE}, &object, &error),
                     TY_OK);
    assert_int_equal(ty_world_commit(plain.world, &error), TY_OK);
    ty_vec3 from = ty_vec3_make(0.4f, 0.01f, 0.003f), towards = ty_normalize(ty_vec3_make(0.02f, -1, -0.3f));
    ty_surface_point x = seen(&s, from, towards), y = seen(&plain, from, towards);
    assert_near(ty_length(ty_sub(x.position, y.position)), 0, 1e-6);
    ty_scattering m = matter(0.3e-3f, 0.95f, 0.2f);
    tally a = run(&s, &x, &m, 60000), b = run(&plain, &y, &m, 60000);
    assert_near(a.g, b.g, 0.004);
    assert_near(a.scatterings / b.scatterings, 1, 0.03);
    assert_near(a.cosine, b.cosine, 0.01);
    assert_true(a.lost + b.lost == 0);
    ty_world_destroy(plain.world);
    ty_mesh_destroy(mesh);
    stage_term(&s);
}

// Instances that overlap do not know of each other; shells of one mesh that overlap are one body.
static void test_overlap(void** state)
{
    (void)state;
    ty_affine maps[2] = {ty_affine_identity(), ty_affine_identity()};
    maps[1].t = ty_vec3_make(0.3e-3f, -0.2e-3f, 0);
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, radius, 0, 0);
    stage s;
    stage_init(&s, &shape, maps, 2);
    ty_scattering m = matter(radius / 4, 0.98f, 0);
    tally a = run(&ball, &pole, &m, 5000), b = run(&s, &pole, &m, 5000);
    assert_true(a.g == b.g && a.scatterings == b.scatterings && a.cosine == b.cosine);
    stage_term(&s);
}

static void test_furnace(void** state)
{
    (void)state;
    ty_walk_def d = bare(radius / 3);
    ty_material* m = walk_material(&d);
    ty_vec3 wo = ty_normalize(ty_vec3_make(0.4f, 1, 0.2f));
    assert_near(furnace(&ball, m, &pole, wo, 4000), 1, 1e-4);
    ty_material_destroy(m);
    d.common.specular_weight = ty_input_scalar(1);
    m = walk_material(&d);
    assert_near(furnace(&ball, m, &pole, wo, 40000), 1, 0.004);
    ty_material_destroy(m);
}

// What is within, said in each of the ways.
static void test_matter(void** state)
{
    (void)state;
    ty_bsdf b;
    ty_vec3 up = {0, 1, 0};
    ty_walk_def d = bare(0.25e-3f);
    d.common.color = ty_input_scalar(0.5f);
    d.anisotropy = 0.5f;
    ty_material* m = walk_material(&d);
    ty_material_prepare(m, &ball.context, &pole, up, &b);
    assert_near(b.matter.extinction.g, 8000, 1);
    assert_near(b.matter.albedo.g, 1, 0);
    assert_true(b.color.g < 0.6f && ty_bsdf_albedo(&b).g < 0.6f);
    ty_material_destroy(m);
    d.scattering = ty_input_make(ty_rgb_make(1, 2, 3));
    d.absorption = ty_input_make(ty_rgb_make(0.5f, 0, 0.1f));
    m = walk_material(&d);
    ty_material_prepare(m, &ball.context, &pole, up, &b);
    assert_near(b.matter.extinction.r, 2500, 1);
    assert_near(b.matter.albedo.r, 0.8, 1e-5);
    assert_near(b.matter.albedo.g, 1, 0);
    assert_near(b.color.r, 1, 0);
    ty_material_destroy(m);
    d = bare(0);
    d.subsurface_color = ty_input_make(ty_rgb_make(0.8f, 0.5f, 1));
    d.subsurface_radius = ty_input_scalar(0.5e-3f);
    d.subsurface_radius_scale = ty_input_make(ty_rgb_make(1, 0.5f, 0.25f));
    m = walk_material(&d);
    ty_material_prepare(m, &ball.context, &pole, up, &b);
    assert_near(b.matter.extinction.b, 8000, 1);
    assert_near(b.matter.extinction.r, 2000, 1);
    assert_near(b.matter.albedo.r, ty_walk_albedo(0.8f, 0), 0);
    assert_near(ty_bsdf_albedo(&b).r, 0.8, 0.006);
    ty_material_destroy(m);
    d = bare(0);
    while (strcmp(ty_walk_preset_names[d.preset], "marble") != 0)
        d.preset++;
    m = walk_material(&d);
    ty_material_prepare(m, &ball.context, &pole, up, &b);
    assert_near(b.matter.extinction.r, 2192.1, 0.1);
    assert_near(b.matter.albedo.b, 3.0 / 3.0071, 1e-5);
    ty_material_destroy(m);
}

// What a walk absorbs is missing from the light that the material sends back.
static void test_material_absorbs(void** state)
{
    (void)state;
    ty_walk_def d = bare(0);
    d.scattering = ty_input_make(ty_rgb_make(3.92f, 3.6f, 4)); // R = 4 mean free paths
    d.absorption = ty_input_make(ty_rgb_make(0.08f, 0.4f, 0));
    ty_material* m = walk_material(&d);
    ty_rng rng = ty_rng_make((ty_seed){8}, 0, 0);
    ty_rgb sum = {0, 0, 0};
    for (int i = 0; i < 30000; i++)
    {
        ty_bsdf b;
        ty_rgb weight;
        float u[4];
        random4(&rng, u);
        ty_material_prepare(m, &ball.context, &pole, ty_vec3_make(0, 1, 0), &b);
        if (ty_bsdf_resolve(&b, &ball.context, u, &rng, &weight))
            sum = ty_rgb_add(sum, ty_rgb_scale(weight, 1.0f / 30000));
    }
    assert_near(sum.r, 0.905, 0.006);
    assert_near(sum.g, 0.659, 0.006);
    assert_near(sum.b, 1, 1e-3);
    ty_material_destroy(m);
}

// Mist in a clear body: per depth, and grey absorption where the colour leaves less than is scattered.
static void test_mist(void** state)
{
    (void)state;
    ty_error error = {0};
    ty_surface_def d = ty_surface_def_default();
    d.transmission_weight = ty_input_scalar(1);
    d.transmission_depth = 0.01f;
    d.transmission_scatter = ty_input_make(ty_rgb_make(1, 2, 3));
    d.transmission_scatter_anisotropy = 0.4f;
    ty_material* m = NULL;
    assert_int_equal(ty_material_create_surface(&d, &m, &error), TY_OK);
    ty_scattering s = ty_medium_make(m, NULL, &pole).matter;
    assert_near(s.extinction.r, 300, 1e-3);
    assert_near(s.extinction.b, 300, 1e-3);
    assert_near(s.albedo.r, 1.0 / 3, 1e-5);
    assert_near(s.albedo.b, 1, 1e-5);
    assert_near(s.anisotropy, 0.4f, 0);
    ty_material_destroy(m);
    d.transmission_color = ty_input_scalar(0.36787944f);
    d.transmission_scatter = ty_input_scalar(0.5f);
    assert_int_equal(ty_material_create_surface(&d, &m, &error), TY_OK);
    s = ty_medium_make(m, NULL, &pole).matter;
    assert_near(s.extinction.g, 100, 1e-3);
    assert_near(s.albedo.g, 0.5, 1e-5);
    ty_material_destroy(m);
    d.transmission_depth = 0;
    assert_int_equal(ty_material_create_surface(&d, &m, &error), TY_BAD_INPUT);
}

static void test_refused(void** state)
{
    (void)state;
    ty_material* m;
    ty_error error = {0};
    ty_walk_def d = bare(1e-3f);
    d.preset = 1;
    d.scattering = ty_input_scalar(1);
    assert_int_equal(ty_material_create_walk(&d, &m, &error), TY_BAD_INPUT);
    assert_true(strncmp(error.text, "preset", 6) == 0);
    d.preset = 0;
    d.subsurface_color = ty_input_scalar(0.5f);
    assert_int_equal(ty_material_create_walk(&d, &m, &error), TY_BAD_INPUT);
    assert_true(strncmp(error.text, "subsurface_color", 16) == 0);
    d.scattering = ty_input_scalar(-1);
    d.anisotropy = 1;
    assert_int_equal(ty_material_create_walk(&d, &m, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "-0.99..0.99"));
}

// A ball with a hole: what gets out there does not come back, and no walk is endless.
static void test_open_mesh(void** state)
{
    (void)state;
    ty_shape_def shape = shape_of(TY_SHAPE_SPHERE, radius, 0, 0);
    stage s;
    ty_error error = {0};
    ty_affine identity = ty_affine_identity();
    assert_int_equal(ty_shape_create(&shape, &s.mesh, &error), TY_OK);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s.mesh->triangle_count; i++)
        if (s.mesh->positions[s.mesh->triangles[i][0]].y > -0.5f * radius)
            memcpy(s.mesh->triangles[kept++], s.mesh->triangles[i], sizeof s.mesh->triangles[i]);
    s.mesh->triangle_count = kept;
    stage_place(&s, &identity, 1, false);
    ty_surface_point x = seen(&s, ty_vec3_make(0, 0.01f, 0), ty_vec3_make(0, -1, 0));
    ty_scattering m = matter(radius / 2, 1, 0);
    tally t = run(&s, &x, &m, 20000);
    assert_true(t.lost > 1000 && t.cut == 0);
    assert_near(t.g + t.lost / 20000.0, 1, 1e-6);
    stage_term(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_exits),
        cmocka_unit_test(test_similarity),
        cmocka_unit_test(test_channels),
        cmocka_unit_test(test_guided_walks_are_alike),
        cmocka_unit_test(test_absorption_alone),
        cmocka_unit_test(test_phase_function),
        cmocka_unit_test(test_albedo_inversion),
        cmocka_unit_test(test_affine_instance),
        cmocka_unit_test(test_overlap),
        cmocka_unit_test(test_furnace),
        cmocka_unit_test(test_matter),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_mist),
        cmocka_unit_test(test_material_absorbs),
        cmocka_unit_test(test_open_mesh),
    };
    return cmocka_run_group_tests(tests, make_ball, drop_ball);
}
