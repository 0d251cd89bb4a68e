// SPDX-License-Identifier: Apache-2.0
// Estimated curvature against exact values on sphere, cylinder, torus and ellipsoid, on even and on jittered meshes of
// about 10,000 triangles; then scale, mirrors, creases, and the smoothing of fields.
#include <base/cmocka_all.h>
#include <tsuya/base/rng.h>
#include <tsuya/geometry/shape.h>

typedef enum surface_kind
{
    SPHERE,
    CYLINDER, // open tube about y
    TORUS,
    ELLIPSOID,
    SURFACE_COUNT
} surface_kind;

static const char* const surface_names[] = {"sphere", "cylinder", "torus", "ellipsoid"};
static const ty_vec3 semi_axes = {0.030f, 0.015f, 0.020f};
static const float sphere_radius = 0.024f, tube_radius = 0.013f, tube_height = 0.05f, ring_radius = 0.022f,
                   ring_tube = 0.008f;

typedef struct exact
{
    float mean, k1, k2;
    ty_vec3 direction; // of k1
    bool measured;     // away from borders
} exact;

static ty_vec3 wrapped_point(surface_kind kind, float u, float v)
{
    float s, c, sv, cv;
    ty_sincos(2.0f * TY_PI * u, &s, &c);
    ty_sincos(2.0f * TY_PI * v, &sv, &cv);
    if (kind == CYLINDER)
        return ty_vec3_make(tube_radius * s, (v - 0.5f) * tube_height, tube_radius * c);
    float r = ring_radius + ring_tube * cv;
    return ty_vec3_make(r * s, ring_tube * sv, r * c);
}

// A grid of the tube or the torus with vertices moved within their cells by up to jitter of a cell.
static ty_mesh* make_wrapped(surface_kind kind, uint32_t columns, uint32_t rows, float jitter)
{
    bool torus = kind == TORUS;
    uint32_t lines = torus ? rows : rows + 1;
    ty_mesh* mesh = ty_mesh_create(columns * lines, 2 * columns * rows);
    ty_rng rng = ty_rng_make((ty_seed){5}, columns, rows);
    for (uint32_t i = 0; i < columns * lines; i++)
    {
        float du = jitter * ty_rng_range(&rng, -1.0f, 1.0f), dv = jitter * ty_rng_range(&rng, -1.0f, 1.0f);
        bool border = !torus && (i / columns == 0 || i / columns == rows);
        float u = ((float)(i % columns) + du) / (float)columns;
        mesh->positions[i] = wrapped_point(kind, u, ((float)(i / columns) + (border ? 0.0f : dv)) / (float)rows);
    }
    for (uint32_t i = 0; i < columns * rows; i++)
    {
        uint32_t row = i / columns, a = i, b = row * columns + (i + 1) % columns, up = (row + 1) % lines;
        uint32_t c = up * columns + (i + 1) % columns, d = up * columns + i % columns;
        uint32_t corners[6] = {a, b, c, a, c, d};
        for (int k = 0; k < 6; k++)
            mesh->triangles[2 * i + (uint32_t)k / 3][k % 3] = corners[k];
    }
    return mesh;
}

// The sphere's vertices moved along it by up to jitter of an edge.
static ty_mesh* make_ball(bool stretch, float jitter)
{
    ty_shape_def def = ty_shape_def_default();
    def.radius = 1.0f;
    def.divisions = 120;
    ty_mesh* mesh;
    assert_int_equal(ty_shape_create(&def, &mesh, NULL), TY_OK);
    ty_rng rng = ty_rng_make((ty_seed){6}, 0, 0);
    float reach = jitter * 2.0f * TY_PI / (float)def.divisions;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 d = {ty_rng_range(&rng, -1.0f, 1.0f), ty_rng_range(&rng, -1.0f, 1.0f), ty_rng_range(&rng, -1.0f, 1.0f)};
        uint32_t w = mesh->welds[i];
        mesh->positions[i] = w == i ? ty_normalize(ty_mad(mesh->positions[i], d, reach)) : mesh->positions[w];
    }
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        mesh->positions[i] =
            stretch ? ty_mul3(mesh->positions[i], semi_axes) : ty_mul(mesh->positions[i], sphere_radius);
    return mesh;
}

static ty_mesh* make_surface(surface_kind kind, float jitter)
{
    ty_mesh* mesh = NULL;
    if (kind == CYLINDER)
        mesh = make_wrapped(kind, 90, 55, jitter);
    else if (kind == TORUS)
        mesh = make_wrapped(kind, 118, 43, jitter);
    else
        mesh = make_ball(kind == ELLIPSOID, jitter);
    ty_mesh_compute_bounds(mesh);
    ty_mesh_compute_welds(mesh);
    ty_mesh_compute_normals(mesh, TY_PI);
    return mesh;
}

// Goldman 2005, "Curvature formulas for implicit curves and surfaces", for the ellipsoid sum (x_i / s_i)^2 = 1.
static exact ellipsoid_exact(ty_vec3 p)
{
    double s[3] = {(double)semi_axes.x, (double)semi_axes.y, (double)semi_axes.z};
    double x[3] = {(double)p.x, (double)p.y, (double)p.z}, g = 0.0, norm = 0.0;
    for (int i = 0; i < 3; i++)
    {
        norm += x[i] * x[i];
        g += x[i] * x[i] / (s[i] * s[i] * s[i] * s[i]);
    }
    double product = s[0] * s[0] * s[1] * s[1] * s[2] * s[2];
    double mean = (s[0] * s[0] + s[1] * s[1] + s[2] * s[2] - norm) / (2.0 * product * g * sqrt(g));
    double gauss = 1.0 / (product * g * g), spread = sqrt(fmax(mean * mean - gauss, 0.0));
    return (exact){(float)mean, (float)(mean + spread), (float)(mean - spread), {0, 0, 0}, true};
}

static exact exact_at(surface_kind kind, ty_vec3 p)
{
    float r = sqrtf(p.x * p.x + p.z * p.z), k;
    ty_vec3 round = ty_normalize(ty_vec3_make(p.z, 0.0f, -p.x));
    switch (kind)
    {
    case CYLINDER:
        return (exact){0.5f / tube_radius, 1.0f / tube_radius, 0.0f, round, fabsf(p.y) < 0.4f * tube_height};
    case TORUS:
        k = (r - ring_radius) / (ring_tube * r);
        return (exact){0.5f * (1.0f / ring_tube + k), 1.0f / ring_tube, k, {0, 0, 0}, true};
    case ELLIPSOID:
        return ellipsoid_exact(p);
    default:
        return (exact){1.0f / sphere_radius, 1.0f / sphere_radius, 1.0f / sphere_radius, {0, 0, 0}, true};
    }
}

typedef struct deviation
{
    double mean, k1, k2; // RMS, relative to the RMS of the exact mean curvature
} deviation;

static deviation measure(const ty_mesh* mesh, surface_kind kind)
{
    double mean = 0.0, k1 = 0.0, k2 = 0.0, norm = 0.0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        exact e = exact_at(kind, mesh->positions[i]);
        if (!e.measured)
            continue;
        assert_true(mesh->curvature_1[i] >= mesh->curvature_2[i]);
        mean += (double)ty_sqr(0.5f * (mesh->curvature_1[i] + mesh->curvature_2[i]) - e.mean);
        k1 += (double)ty_sqr(mesh->curvature_1[i] - e.k1);
        k2 += (double)ty_sqr(mesh->curvature_2[i] - e.k2);
        norm += (double)ty_sqr(e.mean);
    }
    return (deviation){sqrt(mean / norm), sqrt(k1 / norm), sqrt(k2 / norm)};
}

static void test_curvature_is_within_two_percent(void** state)
{
    (void)state;
    for (int kind = 0; kind < SURFACE_COUNT; kind++)
        for (int jittered = 0; jittered < 2; jittered++)
        {
            ty_mesh* mesh = make_surface((surface_kind)kind, jittered ? 0.25f : 0.0f);
            assert_in_range(mesh->triangle_count, 9000, 11500);
            ty_mesh_compute_curvature(mesh, 2);
            deviation d = measure(mesh, (surface_kind)kind);
            print_message("%s%s: mean %.4f, k1 %.4f, k2 %.4f\n", surface_names[kind], jittered ? ", jittered" : "",
                          d.mean, d.k1, d.k2);
            assert_true(d.mean < 0.02 && d.k1 < 0.03 && d.k2 < 0.03);
            ty_mesh_destroy(mesh);
        }
}

// With the surface's own normals the estimate needs no smoothing, whatever the triangles.
static void test_exact_normals_give_curvature_unsmoothed(void** state)
{
    (void)state;
    ty_mesh* mesh = make_surface(SPHERE, 0.25f);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        mesh->normals[i] = ty_normalize(mesh->positions[i]);
    ty_mesh_compute_curvature(mesh, 0);
    deviation d = measure(mesh, SPHERE);
    assert_true(d.mean < 0.001 && d.k1 < 0.001 && d.k2 < 0.001);
    ty_mesh_destroy(mesh);
}

static void test_directions_run_round_the_cylinder(void** state)
{
    (void)state;
    ty_mesh* mesh = make_surface(CYLINDER, 0.25f);
    ty_mesh_compute_curvature(mesh, 2);
    float worst = 1.0f;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        exact e = exact_at(CYLINDER, mesh->positions[i]);
        assert_float_equal(ty_length(mesh->direction_1[i]), 1.0f, 1e-5f);
        assert_float_equal(ty_dot(mesh->direction_1[i], mesh->normals[i]), 0.0f, 1e-5f);
        if (e.measured)
            worst = ty_min(worst, fabsf(ty_dot(mesh->direction_1[i], e.direction)));
    }
    print_message("worst direction: %.2f degrees\n", (double)(ty_acos(worst) * 180.0f / TY_PI));
    assert_true(worst > ty_cos(ty_radians(2.0f)));
    ty_mesh_destroy(mesh);
}

static void test_curvature_is_negative_where_concave(void** state)
{
    (void)state;
    ty_mesh* mesh = make_surface(SPHERE, 0.0f);
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
    {
        uint32_t second = mesh->triangles[i][1];
        mesh->triangles[i][1] = mesh->triangles[i][2];
        mesh->triangles[i][2] = second;
    }
    ty_mesh_compute_normals(mesh, TY_PI);
    ty_mesh_compute_curvature(mesh, 0);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        assert_true(fabsf(mesh->curvature_1[i] * sphere_radius + 1.0f) < 0.05f);
    ty_mesh_destroy(mesh);
}

// A carried tensor equals the one of the carried surface: ball to ellipsoid, sheared and mirrored.
static void test_transform_carries_curvature(void** state)
{
    (void)state;
    ty_shape_def def = ty_shape_def_default();
    def.radius = 1.0f;
    def.divisions = 64;
    ty_mesh* mesh;
    assert_int_equal(ty_shape_create(&def, &mesh, NULL), TY_OK);
    // A mirrored stretch in two parts whose product is diagonal, the first of which shears.
    ty_affine first = {{-0.5f, 0.2f, 0.0f}, {0.3f, 1.0f, 0.1f}, {0.0f, 0.4f, 1.0f}, {0, 0, 0}}, back;
    ty_affine stretch = {{-semi_axes.x, 0, 0}, {0, semi_axes.y, 0}, {0, 0, semi_axes.z}, {0, 0, 0}};
    assert_true(ty_affine_invert(&first, &back));
    ty_affine second = ty_affine_multiply(&stretch, &back);
    ty_mesh_transform(mesh, &first);
    ty_mesh_transform(mesh, &second);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 p = mesh->positions[i], q = semi_axes;
        exact e = ellipsoid_exact(p);
        ty_vec3 n = ty_normalize(ty_vec3_make(p.x / ty_sqr(q.x), p.y / ty_sqr(q.y), p.z / ty_sqr(q.z)));
        assert_true(ty_dot(n, mesh->normals[i]) > 0.99999f);
        assert_true(fabsf(mesh->curvature_1[i] / e.k1 - 1.0f) < 2e-3f);
        assert_true(fabsf(mesh->curvature_2[i] / e.k2 - 1.0f) < 2e-3f);
        assert_float_equal(ty_dot(mesh->direction_1[i], mesh->normals[i]), 0.0f, 1e-5f);
    }
    ty_mesh_topology topology;
    ty_mesh_analyse(mesh, &topology);
    assert_true(topology.closed);
    ty_mesh_destroy(mesh);
}

static void test_creases_keep_their_sides_apart(void** state)
{
    (void)state;
    ty_shape_def def = ty_shape_def_default();
    def.kind = TY_SHAPE_BOX;
    ty_mesh* mesh;
    assert_int_equal(ty_shape_create(&def, &mesh, NULL), TY_OK);
    ty_mesh_compute_normals(mesh, ty_radians(30.0f));
    ty_mesh_compute_curvature(mesh, 2);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        assert_true(mesh->curvature_1[i] == 0.0f && mesh->curvature_2[i] == 0.0f);
    ty_mesh_destroy(mesh);
}

// --- smoothing of fields ---

// A flat square of side 1 with n cells a side.
static ty_mesh* make_square(uint32_t n)
{
    ty_mesh* mesh = ty_mesh_create((n + 1) * (n + 1), 2 * n * n);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        mesh->positions[i] = ty_vec3_make((float)(i % (n + 1)) / (float)n, 0.0f, (float)(i / (n + 1)) / (float)n);
    for (uint32_t i = 0; i < n * n; i++)
    {
        uint32_t a = i / n * (n + 1) + i % n, corners[6] = {a, a + n + 1, a + n + 2, a, a + n + 2, a + 1};
        for (uint32_t k = 0; k < 6; k++)
            mesh->triangles[2 * i + k / 3][k % 3] = corners[k];
    }
    return mesh;
}

// A wave of length L keeps exp(-2 pi^2 width^2 / L^2) of its height under a Gaussian.
static void test_smoothing_damps_waves_as_a_gaussian(void** state)
{
    (void)state;
    ty_mesh* mesh = make_square(200);
    const float lengths[] = {0.5f, 0.25f}, widths[] = {0.012f, 0.04f, 0.06f};
    float* field = TY_ALLOC(float, mesh->vertex_count);
    for (int l = 0; l < 2; l++)
        for (int w = 0; w < 3; w++)
        {
            for (uint32_t i = 0; i < mesh->vertex_count; i++)
                field[i] = ty_cos(2.0f * TY_PI * (mesh->positions[i].x - 0.5f) / lengths[l]);
            ty_mesh_smooth_field(mesh, field, widths[w]);
            float kept = ty_exp(-2.0f * ty_sqr(TY_PI * widths[w] / lengths[l]));
            uint32_t middle = 100 * 201 + 100;
            assert_float_equal(field[middle], kept, 0.03f);
            // An odd wave across stays zero: no side is left out.
            for (uint32_t i = 0; i < mesh->vertex_count; i++)
                field[i] = ty_sin(2.0f * TY_PI * (mesh->positions[i].x + mesh->positions[i].z - 1.0f) / lengths[l]);
            ty_mesh_smooth_field(mesh, field, widths[w]);
            assert_float_equal(field[middle], 0.0f, 1e-2f);
        }
    ty_free(field);
    ty_mesh_destroy(mesh);
}

static void test_smoothing_keeps_constants_and_repeats(void** state)
{
    (void)state;
    ty_shape_def def = ty_shape_def_default();
    def.radius = 1.0f;
    ty_mesh* mesh;
    assert_int_equal(ty_shape_create(&def, &mesh, NULL), TY_OK);
    float* one = TY_ALLOC(float, mesh->vertex_count);
    float* two = TY_ALLOC(float, mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        one[i] = 3.25f;
    ty_mesh_smooth_field(mesh, one, 0.2f);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        assert_float_equal(one[i], 3.25f, 1e-5f);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        one[i] = two[i] = (float)(mesh->welds[i] * 37u % 101u);
    ty_mesh_smooth_field(mesh, one, 0.2f);
    ty_mesh_smooth_field(mesh, two, 0.2f);
    assert_memory_equal(one, two, mesh->vertex_count * sizeof(float));
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        assert_true(one[i] == one[mesh->welds[i]]);
        assert_float_equal(one[i], 50.0f, 12.0f);
    }
    // Narrower than the mesh: as it was, but for what the seam's other vertices hold.
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        one[i] = (float)(mesh->welds[i] * 37u % 101u);
    ty_mesh_smooth_field(mesh, one, 0.005f);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        assert_float_equal(one[i], (float)(mesh->welds[i] * 37u % 101u), 1e-4f);
    ty_free(one);
    ty_free(two);
    ty_mesh_destroy(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_curvature_is_within_two_percent),
        cmocka_unit_test(test_exact_normals_give_curvature_unsmoothed),
        cmocka_unit_test(test_directions_run_round_the_cylinder),
        cmocka_unit_test(test_curvature_is_negative_where_concave),
        cmocka_unit_test(test_transform_carries_curvature),
        cmocka_unit_test(test_creases_keep_their_sides_apart),
        cmocka_unit_test(test_smoothing_damps_waves_as_a_gaussian),
        cmocka_unit_test(test_smoothing_keeps_constants_and_repeats),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
