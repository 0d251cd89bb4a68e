// SPDX-License-Identifier: Apache-2.0
// Built-in shapes: closed and outward, their area, volume, curvature, normals and uv, the space inside them, and what
// is said about impossible sizes.
#include "shape_meshes.h"
#include <string.h>
#include <tsuya/base/rng.h>

static bool is_open(int kind)
{
    return kind == TY_SHAPE_PLANE || kind == TY_SHAPE_DISC || kind == TY_SHAPE_SWEEP;
}

// --- every shape ---

static void test_shapes_are_watertight_and_outward(void** state)
{
    (void)state;
    for (int kind = 0; kind <= TY_SHAPE_SWEEP; kind++)
    {
        ty_shape_def def = shape_of(kind);
        ty_mesh* mesh = make(&def);
        ty_mesh_topology t;
        ty_mesh_analyse(mesh, &t);
        assert_int_equal(t.components, 1);
        assert_int_equal(t.nonmanifold_edges + t.misoriented_edges, 0);
        assert_true(t.closed == !is_open(kind));
        assert_true(t.convex == (t.closed && kind != TY_SHAPE_BOWL && kind != TY_SHAPE_TORUS));
        assert_int_equal(ty_mesh_validate(mesh, "shape", NULL), TY_OK);
        check_surface(mesh);
        ty_mesh_destroy(mesh);
    }
}

// Also at the ends of the range of divisions and at the sizes of the scenes.
static void test_all_divisions_close(void** state)
{
    (void)state;
    const int divisions[] = {8, 9, 13, 50, 255, 600};
    for (int kind = 0; kind <= TY_SHAPE_SWEEP; kind++)
        for (int i = 0; i < 6; i++)
        {
            ty_shape_def def = shape_of(kind);
            def.divisions = divisions[i];
            if (kind == TY_SHAPE_BOX || kind == TY_SHAPE_CYLINDER)
                def.rounding = i & 1 ? 0.0f : 0.003f;
            ty_mesh_topology t = topology_of(&def);
            assert_true(t.closed == !is_open(kind) && t.components == 1);
            assert_int_equal(t.nonmanifold_edges + t.misoriented_edges, 0);
        }
}

typedef struct analytic
{
    double area, volume;
} analytic;

// There is no closed form: the midpoint rule over the sphere.
static double ellipsoid_area(ty_vec3 s)
{
    double sum = 0.0;
    const int n = 400;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
        {
            double u = (i + 0.5) * M_PI / n, v = (j + 0.5) * 2.0 * M_PI / n;
            double x = sin(u) * cos(v) / (double)s.x, y = sin(u) * sin(v) / (double)s.y, z = cos(u) / (double)s.z;
            sum += sin(u) * sqrt(x * x + y * y + z * z);
        }
    return sum * (double)s.x * (double)s.y * (double)s.z * 2.0 * M_PI * M_PI / ((double)n * n);
}

static analytic analytic_of(const ty_shape_def* def)
{
    double r = (double)def->radius, h = (double)def->height, e = (double)def->rounding, tube = (double)def->tube;
    double x = (double)def->size.x, y = (double)def->size.y, z = (double)def->size.z;
    switch (def->kind)
    {
    case TY_SHAPE_SPHERE:
        return (analytic){4.0 * M_PI * r * r, 4.0 / 3.0 * M_PI * r * r * r};
    case TY_SHAPE_ELLIPSOID:
        return (analytic){ellipsoid_area(def->size), 4.0 / 3.0 * M_PI * x * y * z};
    case TY_SHAPE_BOX: // Steiner: a box grown by e
    {
        double a = 2.0 * (x - e), b = 2.0 * (y - e), c = 2.0 * (z - e), faces = 2.0 * (a * b + b * c + c * a);
        return (analytic){faces + 2.0 * M_PI * e * (a + b + c) + 4.0 * M_PI * e * e,
                          a * b * c + faces * e + M_PI * e * e * (a + b + c) + 4.0 / 3.0 * M_PI * e * e * e};
    }
    case TY_SHAPE_CYLINDER: // the same for a cylinder, whose edges sum to its mean width
    {
        double q = r - e, k = h - 2.0 * e, faces = 2.0 * M_PI * q * (q + k), width = M_PI * (M_PI * q + k);
        return (analytic){faces + 2.0 * e * width + 4.0 * M_PI * e * e,
                          M_PI * q * q * k + faces * e + width * e * e + 4.0 / 3.0 * M_PI * e * e * e};
    }
    case TY_SHAPE_TORUS:
        return (analytic){4.0 * M_PI * M_PI * r * tube, 2.0 * M_PI * M_PI * r * tube * tube};
    case TY_SHAPE_PLANE:
        return (analytic){4.0 * x * z, 0.0};
    case TY_SHAPE_DISC:
        return (analytic){M_PI * r * r, 0.0};
    case TY_SHAPE_DOME:
        return (analytic){M_PI * r * r + 0.5 * ellipsoid_area((ty_vec3){def->radius, def->radius, def->height}),
                          2.0 / 3.0 * M_PI * r * r * h};
    default:
        return (analytic){2.0 * x * (2.0 * z - e + 0.5 * M_PI * e + y - e), 0.0};
    }
}

static void test_area_and_volume_converge_to_the_formula(void** state)
{
    (void)state;
    for (int kind = 0; kind <= TY_SHAPE_SWEEP; kind++)
    {
        if (kind == TY_SHAPE_BOWL)
            continue;
        for (int i = 0; i < 2; i++)
        {
            ty_shape_def def = shape_of(kind);
            def.divisions = i == 0 ? 96 : 384;
            if (kind == TY_SHAPE_BOX || kind == TY_SHAPE_CYLINDER)
                def.rounding = 0.008f;
            analytic exact = analytic_of(&def);
            ty_mesh_topology t = topology_of(&def);
            double error = i == 0 ? 8e-3 : 8e-3 / 16.0; // falls with the square
            assert_true(fabs(t.area / exact.area - 1.0) < error);
            if (t.closed)
                assert_true(fabs(t.volume / exact.volume - 1.0) < error);
        }
    }
}

// --- curvature ---

typedef struct curvature
{
    float mean, gauss;
} curvature;

// Goldman 2005, "Curvature formulas for implicit curves and surfaces".
static curvature ellipsoid_curvature(ty_vec3 p, ty_vec3 s)
{
    ty_vec3 q = {ty_sqr(s.x), ty_sqr(s.y), ty_sqr(s.z)};
    float g = ty_sqr(p.x / q.x) + ty_sqr(p.y / q.y) + ty_sqr(p.z / q.z), product = q.x * q.y * q.z;
    return (curvature){(q.x + q.y + q.z - ty_length_sqr(p)) / (2.0f * product * g * sqrtf(g)),
                       1.0f / (product * g * g)};
}

static curvature curvature_of(const ty_shape_def* def, ty_vec3 p, ty_vec3 n)
{
    float r = sqrtf(p.x * p.x + p.z * p.z), k = (r - def->radius) / (def->tube * r);
    switch (def->kind)
    {
    case TY_SHAPE_SPHERE:
        return (curvature){1.0f / def->radius, 1.0f / ty_sqr(def->radius)};
    case TY_SHAPE_ELLIPSOID:
        return ellipsoid_curvature(p, def->size);
    case TY_SHAPE_CYLINDER:
        return (curvature){fabsf(n.y) > 0.5f ? 0.0f : 0.5f / def->radius, 0.0f};
    case TY_SHAPE_TORUS:
        return (curvature){0.5f * (1.0f / def->tube + k), k / def->tube};
    default:
        if (n.y == -1.0f) // the base of the dome
            return (curvature){0.0f, 0.0f};
        return ellipsoid_curvature(p, ty_vec3_make(def->radius, def->height, def->radius));
    }
}

static void test_curvature_is_exact_where_there_is_a_formula(void** state)
{
    (void)state;
    const int kinds[] = {TY_SHAPE_SPHERE, TY_SHAPE_ELLIPSOID, TY_SHAPE_CYLINDER, TY_SHAPE_TORUS, TY_SHAPE_DOME};
    for (int i = 0; i < 5; i++)
    {
        ty_shape_def def = shape_of(kinds[i]);
        ty_mesh* mesh = make(&def);
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
        {
            curvature exact = curvature_of(&def, mesh->positions[v], mesh->normals[v]);
            float scale = 1.0f / def.radius, k1 = mesh->curvature_1[v], k2 = mesh->curvature_2[v];
            assert_float_equal(0.5f * (k1 + k2), exact.mean, 1e-3f * (exact.mean + 0.01f * scale));
            assert_float_equal(k1 * k2, exact.gauss, 2e-3f * (fabsf(exact.gauss) + 0.01f * scale * scale));
        }
        ty_mesh_destroy(mesh);
    }
}

static void test_stones_are_closed_and_unlike(void** state)
{
    (void)state;
    ty_shape_def def = shape_of(TY_SHAPE_STONE);
    def.relief = 0.3f;
    def.divisions = 96;
    ty_mesh *stone = make(&def), *again = make(&def);
    ty_mesh_topology topology;
    ty_mesh_analyse(stone, &topology);
    assert_true(topology.closed && topology.components == 1 && !topology.convex);
    assert_memory_equal(stone->positions, again->positions, stone->vertex_count * sizeof(ty_vec3));
    def.variant++;
    ty_mesh* other = make(&def);
    assert_memory_not_equal(stone->positions, other->positions, stone->vertex_count * sizeof(ty_vec3));
    def.relief = 0.0f; // without relief: the ellipsoid
    ty_mesh* plain = make(&def);
    for (uint32_t v = 0; v < plain->vertex_count; v++)
    {
        ty_vec3 p = plain->positions[v], s = def.size;
        assert_float_equal(ty_length(ty_vec3_make(p.x / s.x, p.y / s.y, p.z / s.z)), 1.0f, 1e-5f);
    }
    ty_mesh_destroy(stone);
    ty_mesh_destroy(again);
    ty_mesh_destroy(other);
    ty_mesh_destroy(plain);
}

// Within its size but for the relief, nearly all of the box it is hewn from, and another by its variant.
static void test_blocks_are_hewn(void** state)
{
    (void)state;
    ty_shape_def def = shape_of(TY_SHAPE_BLOCK);
    def.size = (ty_vec3){0.1f, 0.05f, 0.08f};
    def.divisions = 96;
    for (int i = 0; i < 3; i++)
    {
        def.relief = 0.15f * (float)i;
        ty_mesh* block = make(&def);
        ty_mesh_topology topology;
        ty_mesh_analyse(block, &topology);
        double box = 8.0 * 0.1 * 0.05 * 0.08, out = 0.05 * (double)def.relief;
        assert_true(topology.closed && topology.components == 1);
        assert_true(topology.volume > (i == 0 ? 0.97 : 0.8) * box && topology.volume < 1.02 * box);
        assert_true((double)block->bounds.high.x < 0.1 + out + 1e-6 &&
                    (double)block->bounds.low.y > -0.05 - out - 1e-6);
        def.variant++;
        ty_mesh* other = make(&def);
        bool same = memcmp(block->positions, other->positions, block->vertex_count * sizeof(ty_vec3)) == 0;
        assert_true(i == 0 || !same);
        ty_mesh_destroy(block);
        ty_mesh_destroy(other);
    }
}

// The bowl's own formula against the estimate from its normals, where the wall is smooth on both sides.
static void test_bowl_curvature_agrees_with_the_estimate(void** state)
{
    (void)state;
    ty_shape_def def = shape_of(TY_SHAPE_BOWL);
    def.divisions = 256;
    ty_mesh* mesh = make(&def);
    ty_mesh* estimate = ty_mesh_copy(mesh);
    ty_mesh_compute_curvature(estimate, 0);
    int concave = 0, convex = 0;
    float hollow = 0.0f;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 p = mesh->positions[i];
        hollow = ty_min(hollow, mesh->curvature_2[i]);
        if (p.y < 0.2f * def.height || p.y > 0.9f * def.height)
            continue;
        assert_float_equal(mesh->curvature_1[i], estimate->curvature_1[i], 1.2f);
        assert_float_equal(mesh->curvature_2[i], estimate->curvature_2[i], 1.2f);
        concave += mesh->curvature_1[i] < -1.0f;
        convex += mesh->curvature_2[i] > 1.0f;
    }
    assert_true(concave > 1000 && convex > 1000);
    assert_true(hollow < -2.0f / def.foot_height); // the fillets of the foot
    ty_mesh_destroy(estimate);
    ty_mesh_destroy(mesh);
}

static void test_flat_parts_are_flat(void** state)
{
    (void)state;
    ty_shape_def def = shape_of(TY_SHAPE_BOX);
    def.size = ty_vec3_make(0.6f, 0.009f, 0.044f);
    def.rounding = 0.0022f;
    def.divisions = 16;
    ty_mesh* mesh = make(&def);
    assert_true(mesh->triangle_count <= 400);
    float sharpest = 0.0f;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 n = mesh->normals[i];
        if (fabsf(n.x) == 1.0f || fabsf(n.y) == 1.0f || fabsf(n.z) == 1.0f)
            assert_true(mesh->curvature_1[i] == 0.0f && mesh->curvature_2[i] == 0.0f);
        else
            assert_float_equal(mesh->curvature_1[i] * def.rounding, 1.0f, 1e-5f);
        if (n.x == 0.0f && mesh->curvature_1[i] > 0.0f)
            assert_true(mesh->curvature_2[i] == 0.0f && mesh->direction_1[i].x == 0.0f);
        sharpest = ty_max(sharpest, mesh->curvature_2[i]);
    }
    assert_float_equal(sharpest * def.rounding, 1.0f, 1e-5f);
    ty_mesh_destroy(mesh);
}

// Where a flat and a round part meet, the flat one holds: else the linear interpolation would bend the flat one.
static void test_borders_of_round_parts(void** state)
{
    (void)state;
    ty_shape_def def = shape_of(TY_SHAPE_CYLINDER);
    def.rounding = 0.006f;
    ty_mesh* mesh = make(&def);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        float n = fabsf(mesh->normals[i].y), k1 = mesh->curvature_1[i], k2 = mesh->curvature_2[i];
        if (n > 0.9999f)
            assert_true(fabsf(k1) < 1e-3f && fabsf(k2) < 1e-3f);
        else if (n < 1e-4f)
            assert_true(fabsf(k1 * def.radius - 1.0f) < 1e-4f && fabsf(k2) < 1e-3f);
        else
            assert_true(fabsf(k1 * def.rounding - 1.0f) < 1e-4f && k2 > 0.0f);
    }
    ty_mesh_destroy(mesh);
    def = shape_of(TY_SHAPE_SWEEP);
    mesh = make(&def);
    int bent = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        bool inside = mesh->normals[i].y > 0.001f && mesh->normals[i].z > 0.001f;
        assert_true(mesh->curvature_1[i] == 0.0f);
        assert_float_equal(mesh->curvature_2[i] * def.rounding, (inside ? -1.0f : 0.0f), 1e-6f);
        bent += inside;
    }
    assert_true(bent > 20);
    ty_mesh_destroy(mesh);
}

static void test_sphere_uv_is_longitude_and_latitude(void** state)
{
    (void)state;
    ty_shape_def def = shape_of(TY_SHAPE_SPHERE);
    ty_mesh* mesh = make(&def);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 n = mesh->normals[i];
        ty_vec2 uv = mesh->uvs[i];
        float s, c, height = sqrtf(n.x * n.x + n.z * n.z);
        assert_float_equal(-ty_cos(TY_PI * uv.y), n.y, 1e-5f);
        ty_sincos(2.0f * TY_PI * uv.x, &s, &c);
        if (height > 1e-4f)
            assert_true(fabsf(n.x + height * s) < 1e-5f && fabsf(n.z + height * c) < 1e-5f);
    }
    ty_mesh_destroy(mesh);
}

// --- the bowl ---

static const ty_shape_def scene_bowls[] = {
    {.kind = TY_SHAPE_BOWL,
     .radius = 0.06f,
     .height = 0.06f,
     .thickness = 0.003f,
     .foot_radius = 0.024f,
     .foot_height = 0.007f,
     .curve = 2.8f,
     .divisions = 96},
    {.kind = TY_SHAPE_BOWL,
     .radius = 0.052f,
     .height = 0.055f,
     .thickness = 0.0028f,
     .foot_radius = 0.022f,
     .foot_height = 0.006f,
     .curve = 2.4f,
     .divisions = 192},
    {.kind = TY_SHAPE_BOWL,
     .radius = 0.05f,
     .height = 0.05f,
     .thickness = 0.0025f,
     .foot_radius = 0.02f,
     .foot_height = 0.006f,
     .curve = 1.0f,
     .divisions = 64},
    {.kind = TY_SHAPE_BOWL,
     .radius = 0.06f,
     .height = 0.06f,
     .thickness = 0.004f,
     .foot_radius = 0.012f,
     .foot_height = 0.01f,
     .curve = 4.0f,
     .divisions = 64},
    {.kind = TY_SHAPE_BOWL,
     .radius = 0.06f,
     .height = 0.04f,
     .thickness = 0.002f,
     .foot_radius = 0.045f,
     .foot_height = 0.003f,
     .curve = 1.5f,
     .divisions = 64},
};
enum
{
    bowl_count = sizeof(scene_bowls) / sizeof(scene_bowls[0])
};

static float top_v(const ty_mesh* mesh)
{
    uint32_t top = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        top = mesh->positions[i].y > mesh->positions[top].y ? i : top;
    return mesh->uvs[top].y;
}

static void test_bowl_stands_and_has_its_sizes(void** state)
{
    (void)state;
    for (int i = 0; i < bowl_count; i++)
    {
        const ty_shape_def* def = &scene_bowls[i];
        ty_mesh* mesh = make(def);
        ty_mesh_topology t;
        ty_mesh_analyse(mesh, &t);
        assert_true(t.closed && t.components == 1);
        check_surface(mesh);
        assert_float_equal(mesh->bounds.low.y, 0.0f, 1e-7f);
        assert_float_equal(mesh->bounds.high.y, def->height, 0.02f * def->thickness);
        assert_float_equal(mesh->bounds.high.x, def->radius, 0.02f * def->radius);
        assert_true(mesh->bounds.high.x <= def->radius * 1.000001f);
        float standing = 0.0f;
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
        {
            // Smooth all over: vertices at one place have one normal.
            assert_true(ty_dot(mesh->normals[v], mesh->normals[mesh->welds[v]]) > 0.9999f);
            if (mesh->positions[v].y == 0.0f)
                standing = ty_max(standing, ty_length(mesh->positions[v]));
        }
        assert_true(standing > 0.85f * def->foot_radius && standing < def->foot_radius);
        ty_mesh_destroy(mesh);
    }
}

// Inside, the distance is zero; on the outer wall it is the thickness, measured along the normal.
static void test_bowl_interior_agrees_with_its_mesh(void** state)
{
    (void)state;
    for (int i = 0; i < bowl_count; i++)
    {
        const ty_shape_def* def = &scene_bowls[i];
        ty_mesh* mesh = make(def);
        float top = top_v(mesh), rim = def->radius - 0.5f * def->thickness, worst = 0.0f, worst_wall = 0.0f;
        int inner = 0, outer = 0;
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
        {
            ty_vec3 p = mesh->positions[v];
            float d = ty_shape_interior_distance(def, p);
            bool wall = mesh->uvs[v].y < top && p.y > 0.4f * def->height && p.y < def->height - 2.0f * def->thickness;
            if (mesh->uvs[v].y >= top && p.x * p.x + p.z * p.z < ty_sqr(rim))
            {
                worst = ty_max(worst, fabsf(d));
                inner++;
            }
            else if (wall)
            {
                worst_wall = ty_max(worst_wall, fabsf(d - def->thickness));
                outer++;
            }
        }
        print_message("bowl %d: inner surface within %.1f um, wall within %.1f um\n", i, (double)(worst * 1e6f),
                      (double)(worst_wall * 1e6f));
        assert_true(inner > 500 && outer > 100);
        assert_true(worst < 20e-6f && worst_wall < 20e-6f);
        ty_mesh_destroy(mesh);
    }
}

static void test_bowl_is_open_above(void** state)
{
    (void)state;
    const ty_shape_def* def = &scene_bowls[0];
    float rim = def->radius - 0.5f * def->thickness;
    assert_true(ty_shape_interior_distance(def, ty_vec3_make(0.0f, 0.03f, 0.0f)) < -0.01f);
    assert_true(ty_shape_interior_distance(def, ty_vec3_make(0.0f, 0.09f, 0.0f)) < -0.06f);
    assert_true(ty_shape_interior_distance(def, ty_vec3_make(rim - 1e-4f, 0.09f, 0.0f)) < -0.029f);
    assert_true(ty_shape_interior_distance(def, ty_vec3_make(0.0f, 0.09f, rim + 1e-3f)) > 0.029f);
    assert_true(ty_shape_interior_distance(def, ty_vec3_make(0.0f, -0.01f, 0.0f)) > 0.01f);
    assert_true(ty_shape_interior_distance(def, ty_vec3_make(0.055f, 0.02f, 0.0f)) > 0.0f);
    // Above the hollow the lip is what is nearest.
    ty_vec3 p = {0.0f, 0.08f, 0.0f};
    assert_float_equal(ty_shape_interior_distance(def, p),
                       -hypotf(rim, 0.02f + 0.5f * def->thickness) + 0.5f * def->thickness, 5e-5f);
}

// --- the space inside ---

// Above the rim a bowl's distance changes sign without passing zero: nothing is promised across that.
static bool is_promised(const ty_shape_def* def, ty_vec3 p)
{
    return def->kind != TY_SHAPE_BOWL || p.y < def->height - 0.5f * def->thickness;
}

static void test_interior_distance_is_lipschitz(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make((ty_seed){11}, 0, 0);
    for (int kind = 0; kind <= TY_SHAPE_DOME; kind++)
    {
        ty_shape_def def = shape_of(kind);
        if (kind == TY_SHAPE_BOX || kind == TY_SHAPE_CYLINDER)
            def.rounding = 0.006f;
        for (int i = 0; i < 20000 && !is_open(kind); i++)
        {
            ty_vec3 p, d;
            p = ty_vec3_make(ty_rng_range(&rng, -0.1f, 0.1f), ty_rng_range(&rng, -0.1f, 0.1f),
                             ty_rng_range(&rng, -0.1f, 0.1f));
            d = ty_vec3_make(ty_rng_range(&rng, -1.0f, 1.0f), ty_rng_range(&rng, -1.0f, 1.0f),
                             ty_rng_range(&rng, -1.0f, 1.0f));
            ty_vec3 q = ty_mad(p, d, i & 1 ? 0.1f : 0.003f);
            if (!is_promised(&def, p) || !is_promised(&def, q))
                continue;
            float change = fabsf(ty_shape_interior_distance(&def, p) - ty_shape_interior_distance(&def, q));
            assert_true(change <= ty_length(ty_sub(p, q)) * 1.00001f + 1e-7f);
        }
    }
}

// Zero on the surface, and the distance itself a little within and without.
static void test_interior_distance_follows_the_surface(void** state)
{
    (void)state;
    for (int kind = 0; kind <= TY_SHAPE_DOME; kind++)
    {
        if (is_open(kind) || kind == TY_SHAPE_BOWL)
            continue;
        ty_shape_def def = shape_of(kind);
        if (kind == TY_SHAPE_BOX || kind == TY_SHAPE_CYLINDER)
            def.rounding = 0.006f;
        ty_mesh* mesh = make(&def);
        const float step = 0.001f;
        for (uint32_t i = 0; i < mesh->vertex_count; i++)
        {
            ty_vec3 p = mesh->positions[i], n = mesh->normals[i];
            assert_float_equal(ty_shape_interior_distance(&def, p), 0.0f, 1e-7f);
            bool edge = kind == TY_SHAPE_DOME && p.y < 2.0f * step && ty_length(p) > def.radius - 2.0f * step;
            if (edge)
                continue;
            assert_float_equal(ty_shape_interior_distance(&def, ty_mad(p, n, step)), step, 2e-7f);
            assert_float_equal(ty_shape_interior_distance(&def, ty_mad(p, n, -step)), -step, 2e-7f);
        }
        ty_mesh_destroy(mesh);
    }
    ty_shape_def def = shape_of(TY_SHAPE_ELLIPSOID);
    assert_float_equal(ty_shape_interior_distance(&def, ty_vec3_make(0, 0, 0)), -0.0125f, 1e-8f);
    def = shape_of(TY_SHAPE_PLANE);
    assert_true(ty_shape_interior_distance(&def, ty_vec3_make(0, 0, 0)) > 0.0f);
}

// --- sizes and memory ---

static void assert_refused(ty_shape_def def, const char* field)
{
    ty_mesh* mesh = (ty_mesh*)&def;
    ty_error error = {0};
    assert_int_equal(ty_shape_create(&def, &mesh, &error), TY_BAD_INPUT);
    assert_null(mesh);
    assert_int_equal(strncmp(error.text, field, strlen(field)), 0);
}

static void test_impossible_sizes_name_the_field(void** state)
{
    (void)state;
    ty_shape_def def = shape_of(TY_SHAPE_SPHERE);
#define REFUSED(kind_, field, value, name)                                                                             \
    do                                                                                                                 \
    {                                                                                                                  \
        def = shape_of(kind_);                                                                                         \
        def.field = (value);                                                                                           \
        assert_refused(def, name);                                                                                     \
    } while (0)
    REFUSED(TY_SHAPE_SPHERE, kind, TY_SHAPE_TUBE + 1, "shape");
    REFUSED(TY_SHAPE_SPHERE, kind, -1, "shape");
    REFUSED(TY_SHAPE_SPHERE, divisions, 7, "divisions");
    REFUSED(TY_SHAPE_SPHERE, divisions, 4097, "divisions");
    REFUSED(TY_SHAPE_SPHERE, radius, 0.0f, "radius");
    REFUSED(TY_SHAPE_SPHERE, radius, -1.0f, "radius");
    REFUSED(TY_SHAPE_SPHERE, radius, NAN, "radius");
    REFUSED(TY_SHAPE_SPHERE, radius, INFINITY, "radius");
    REFUSED(TY_SHAPE_DISC, radius, 0.0f, "radius");
    REFUSED(TY_SHAPE_ELLIPSOID, size.y, 0.0f, "size");
    REFUSED(TY_SHAPE_BOX, size.z, -1.0f, "size");
    REFUSED(TY_SHAPE_BOX, rounding, 0.051f, "rounding");
    REFUSED(TY_SHAPE_BOX, rounding, -0.001f, "rounding");
    REFUSED(TY_SHAPE_PLANE, size.x, 0.0f, "size");
    REFUSED(TY_SHAPE_CYLINDER, height, -1.0f, "height");
    REFUSED(TY_SHAPE_CYLINDER, rounding, 0.0301f, "rounding");
    REFUSED(TY_SHAPE_TORUS, tube, 0.06f, "tube");
    REFUSED(TY_SHAPE_TORUS, tube, 0.0f, "tube");
    REFUSED(TY_SHAPE_DOME, height, NAN, "height");
    REFUSED(TY_SHAPE_SWEEP, rounding, 0.0f, "rounding");
    REFUSED(TY_SHAPE_SWEEP, rounding, 0.81f, "rounding");
    REFUSED(TY_SHAPE_BOWL, thickness, 0.07f, "thickness");
    REFUSED(TY_SHAPE_BOWL, thickness, -0.001f, "thickness");
    REFUSED(TY_SHAPE_BOWL, foot_radius, 0.058f, "foot_radius");
    REFUSED(TY_SHAPE_BOWL, foot_height, -0.001f, "foot_height");
    REFUSED(TY_SHAPE_BOWL, foot_height, 0.04f, "height");
    REFUSED(TY_SHAPE_BOWL, curve, 0.5f, "curve");
    REFUSED(TY_SHAPE_BOWL, curve, NAN, "curve");
#undef REFUSED
    def = shape_of(TY_SHAPE_BOWL);
    def.thickness = 0.008f;
    def.curve = 1.0f;
    def.foot_radius = 0.003f;
    def.foot_height = 0.002f;
    assert_refused(def, "thickness");
    // A plane has no height: its y is free.
    def = shape_of(TY_SHAPE_PLANE);
    def.size.y = 0.0f;
    ty_mesh_destroy(make(&def));
}

// Whatever the sizes, a bowl is either refused or sound.
// What is not given follows the radius and the height: a bowl of any size can be had by those two.
static void test_lengths_follow_the_size(void** state)
{
    (void)state;
    for (float radius = 0.01f; radius < 0.5f; radius *= 1.7f)
        for (float share = 0.35f; share < 2.0f; share *= 1.5f)
        {
            ty_shape_def def = ty_shape_def_default();
            def.kind = TY_SHAPE_BOWL;
            def.radius = radius;
            def.height = share * radius;
            ty_mesh* mesh = make(&def);
            ty_shape_def whole = ty_shape_def_complete(&def);
            assert_float_equal(mesh->bounds.high.y, def.height, 0.02f * whole.thickness);
            assert_float_equal(whole.foot_radius, 0.4f * radius, 1e-6f);
            assert_true(ty_shape_interior_distance(&def, ty_vec3_make(0.0f, 0.6f * def.height, 0.0f)) < 0.0f);
            ty_mesh_destroy(mesh);
        }
    ty_shape_def dome = ty_shape_def_default();
    dome.kind = TY_SHAPE_DOME;
    dome.radius = 0.02f;
    ty_mesh* mesh = make(&dome);
    assert_float_equal(mesh->bounds.high.y, 0.02f, 1e-5f);
    ty_mesh_destroy(mesh);
}

static void test_random_bowls_are_refused_or_sound(void** state)
{
    (void)state;
    ty_rng rng = ty_rng_make((ty_seed){3}, 0, 0);
    int made = 0;
    for (int i = 0; i < 300; i++)
    {
        ty_shape_def def = shape_of(TY_SHAPE_BOWL);
        def.divisions = 8 + (int)(ty_rng_u32(&rng) % 60u);
        def.radius = ty_rng_range(&rng, 0.02f, 0.2f);
        def.height = ty_rng_range(&rng, 0.01f, 0.3f);
        def.thickness = ty_rng_range(&rng, 0.0005f, 0.02f);
        def.foot_radius = ty_rng_range(&rng, 0.002f, def.radius);
        def.foot_height = ty_rng_range(&rng, 0.001f, 0.02f);
        def.curve = ty_rng_range(&rng, 1.0f, 12.0f);
        ty_mesh* mesh;
        if (ty_shape_create(&def, &mesh, NULL) != TY_OK)
            continue;
        made++;
        ty_mesh_topology t;
        ty_mesh_analyse(mesh, &t);
        assert_true(t.closed && t.components == 1);
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
        {
            assert_true(ty_is_finite3(mesh->positions[v]) && isfinite(mesh->curvature_1[v]));
            assert_true(mesh->positions[v].y > -1e-6f && mesh->positions[v].y < def.height + 1e-6f);
            assert_true(isfinite(ty_shape_interior_distance(&def, mesh->positions[v])));
        }
        ty_mesh_destroy(mesh);
    }
    assert_true(made > 100);
}

static void test_shapes_survive_exhaustion(void** state)
{
    (void)state;
    for (int kind = 0; kind <= TY_SHAPE_SWEEP; kind++)
    {
        bool done = false;
        for (long i = 0; !done && i < 100; i++)
        {
            ty_shape_def def = shape_of(kind);
            ty_mesh* mesh;
            ty_memory_fail_after(i);
            ty_status status = ty_shape_create(&def, &mesh, NULL);
            ty_memory_fail_after(-1);
            done = status == TY_OK;
            assert_true(done ? mesh != NULL : status == TY_NO_MEMORY && !mesh);
            ty_mesh_destroy(mesh);
        }
        assert_true(done);
    }
}

static void test_parameters_match_the_struct(void** state)
{
    (void)state;
    const ty_param_table* table = ty_shape_params();
    assert_int_equal(table->size, sizeof(ty_shape_def));
    ty_shape_def def;
    memset(&def, 0xff, sizeof(def));
    table->set_default(&def);
    ty_shape_def expected = ty_shape_def_default();
    size_t covered = 0;
    for (int i = 0; i < table->count; i++)
    {
        const ty_param* p = &table->params[i];
        bool list = p->type == TY_PARAM_LIST || p->type == TY_PARAM_POINTS;
        size_t size = p->type == TY_PARAM_FLOAT3 ? 12 : list ? sizeof(void*) : 4;
        assert_memory_equal((char*)&def + p->offset, (char*)&expected + p->offset, size);
        covered += list ? sizeof(ty_param_list) : size;
        if (p->type != TY_PARAM_ENUM)
            continue;
        assert_string_equal(p->name, "shape");
        int choices = 0;
        while (p->choices[choices])
            choices++;
        assert_int_equal(choices, TY_SHAPE_TUBE + 1);
        assert_string_equal(p->choices[TY_SHAPE_BOWL], "bowl");
        assert_string_equal(p->choices[TY_SHAPE_SWEEP], "sweep");
        assert_string_equal(p->choices[TY_SHAPE_TORUS], "torus");
    }
    assert_true(covered <= sizeof(ty_shape_def) && sizeof(ty_shape_def) - covered < 2 * sizeof(void*)); // padding
    // The default itself makes a mesh for every shape but the sweep, which needs a bend.
    for (int kind = 0; kind < TY_SHAPE_SWEEP; kind++)
    {
        def = ty_shape_def_default();
        def.kind = kind;
        ty_mesh_destroy(make(&def));
    }
}

static ty_mesh* lathe(const ty_shape_point* points, int count, int divisions)
{
    ty_shape_def def = shape_of(TY_SHAPE_LATHE);
    def.profile = (ty_param_list){(void*)points, count};
    def.divisions = divisions;
    return make(&def);
}

static double volume_of(const ty_mesh* mesh)
{
    double six = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        const uint32_t* c = mesh->triangles[t];
        const ty_vec3* p = mesh->positions;
        six += (double)ty_dot(p[c[0]], ty_cross(p[c[1]], p[c[2]]));
    }
    return six / 6.0;
}

static void check_lathe(const ty_mesh* mesh, double volume, double tolerance)
{
    ty_mesh_topology t;
    ty_mesh_analyse(mesh, &t);
    assert_true(t.closed && t.components == 1);
    assert_int_equal(t.nonmanifold_edges + t.misoriented_edges, 0);
    check_surface(mesh);
    assert_true(fabs(volume_of(mesh) / volume - 1.0) < tolerance);
}

// What an arc of radius e takes of a right angle at r: a square less a quarter disc, turned about the axis.
static double taken_by_arc(double r, double e)
{
    const double pi = 3.14159265358979;
    return 2 * pi * (e * e * (1 - pi / 4) * (r - e) + e * e * e * (0.5 - 1.0 / 3));
}

// A round cylinder from corners and arcs, either way round, and a half ball from a curve through exact points.
static void test_lathe_turns_known_solids(void** state)
{
    (void)state;
    const double pi = 3.14159265358979;
    const ty_shape_point can[4] = {
        {{0, -0.03f}, 0, false}, {{0.02f, -0.03f}, 0.005f, false}, {{0.02f, 0.03f}, 0, false}, {{0, 0.03f}, 0, false}};
    const ty_shape_point back[4] = {can[3], can[2], can[1], can[0]};
    for (int i = 0; i < 2; i++)
    {
        ty_mesh* mesh = lathe(i ? back : can, 4, 512);
        check_lathe(mesh, pi * 0.02 * 0.02 * 0.06 - taken_by_arc(0.02, 0.005), 2e-4);
        ty_mesh_destroy(mesh);
    }
    ty_shape_point ball[10];
    for (int i = 0; i < 9; i++)
        ball[i] = (ty_shape_point){
            {i == 8 ? 0.0f : (float)(0.03 * cos(i * pi / 16)), (float)(0.03 * sin(i * pi / 16))}, 0, i > 0 && i < 8};
    ball[9] = (ty_shape_point){{0, 0}, 0, false};
    const ty_shape_point half[11] = {
        {{0, 0}, 0, false}, ball[0], ball[1], ball[2], ball[3], ball[4], ball[5], ball[6], ball[7], ball[8]};
    ty_mesh* mesh = lathe(half, 10, 256);
    check_lathe(mesh, 2 * pi / 3 * 0.03 * 0.03 * 0.03, 2e-3);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        if (mesh->positions[i].y > 0.02f) // its lower end is straight
        {
            assert_float_equal(0.03f * mesh->curvature_1[i], 1.0f, 0.02f);
            assert_float_equal(0.03f * mesh->curvature_2[i], 1.0f, 0.02f);
        }
    ty_mesh_destroy(mesh);
    // A ring: it ends where it began.
    const ty_shape_point ring[5] = {{{0.02f, 0}, 0, false},
                                    {{0.03f, 0}, 0.002f, false},
                                    {{0.03f, 0.01f}, 0, false},
                                    {{0.02f, 0.01f}, 0, false},
                                    {{0.02f, 0}, 0, false}};
    mesh = lathe(ring, 5, 128);
    check_lathe(mesh, pi * (0.0009 - 0.0004) * 0.01 - taken_by_arc(0.03, 0.002), 1e-3);
    ty_mesh_destroy(mesh);
}

static void test_bad_lathes_are_refused(void** state)
{
    (void)state;
    const ty_shape_point bad[][4] = {
        {{{0, 0}, 0, false}, {{-0.01f, 0}, 0, false}, {{0.01f, 0.01f}, 0, false}, {{0, 0.01f}, 0, false}},
        {{{0, 0}, 0, false}, {{0.01f, 0}, 0.02f, false}, {{0.01f, 0.01f}, 0, false}, {{0, 0.01f}, 0, false}},
        {{{0, 0}, 0, true}, {{0.01f, 0}, 0, false}, {{0.01f, 0.01f}, 0, false}, {{0, 0.01f}, 0, false}},
        {{{0, 0}, 0, false}, {{0.01f, 0}, 0, false}, {{0.01f, 0}, 0, false}, {{0, 0.01f}, 0, false}},
        {{{0, 0}, 0, false}, {{0.01f, 0}, 0, true}, {{0.01f, 0.01f}, 0.001f, false}, {{0, 0.01f}, 0, false}},
        {{{0, 0}, 0, false}, {{0, 0.01f}, 0, false}, {{0.01f, 0.01f}, 0, false}, {{0, 0.02f}, 0, false}},
        {{{0.05f, 0}, 0, false},
         {{0.0001f, 0.001f}, 0, true},
         {{0.0001f, 0.05f}, 0, true},
         {{0.05f, 0.051f}, 0, false}},
    };
    ty_mesh* mesh;
    ty_error error = {0};
    for (size_t i = 0; i < sizeof(bad) / sizeof(bad[0]); i++)
    {
        ty_shape_def def = shape_of(TY_SHAPE_LATHE);
        def.profile = (ty_param_list){(void*)bad[i], 4};
        assert_int_equal(ty_shape_create(&def, &mesh, &error), TY_BAD_INPUT);
        assert_memory_equal(error.text, "profile", 7);
    }
    ty_shape_def none = shape_of(TY_SHAPE_LATHE);
    assert_int_equal(ty_shape_create(&none, &mesh, &error), TY_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shapes_are_watertight_and_outward),
        cmocka_unit_test(test_all_divisions_close),
        cmocka_unit_test(test_area_and_volume_converge_to_the_formula),
        cmocka_unit_test(test_curvature_is_exact_where_there_is_a_formula),
        cmocka_unit_test(test_stones_are_closed_and_unlike),
        cmocka_unit_test(test_blocks_are_hewn),
        cmocka_unit_test(test_bowl_curvature_agrees_with_the_estimate),
        cmocka_unit_test(test_flat_parts_are_flat),
        cmocka_unit_test(test_borders_of_round_parts),
        cmocka_unit_test(test_sphere_uv_is_longitude_and_latitude),
        cmocka_unit_test(test_bowl_stands_and_has_its_sizes),
        cmocka_unit_test(test_bowl_interior_agrees_with_its_mesh),
        cmocka_unit_test(test_bowl_is_open_above),
        cmocka_unit_test(test_interior_distance_is_lipschitz),
        cmocka_unit_test(test_interior_distance_follows_the_surface),
        cmocka_unit_test(test_impossible_sizes_name_the_field),
        cmocka_unit_test(test_lengths_follow_the_size),
        cmocka_unit_test(test_random_bowls_are_refused_or_sound),
        cmocka_unit_test(test_shapes_survive_exhaustion),
        cmocka_unit_test(test_parameters_match_the_struct),
        cmocka_unit_test(test_lathe_turns_known_solids),
        cmocka_unit_test(test_bad_lathes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
