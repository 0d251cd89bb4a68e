// SPDX-License-Identifier: Apache-2.0
// Sparse surface nets: closed two-manifolds whatever the field, at its zero, with good corners, the same for any
// workers.
#include "base/alloc_sweep.h"
#include "base/cmocka_all.h"
#include <stdlib.h>
#include <string.h>
#include <tsuya/geometry/surface_net.h>

#define BLOCKS 6 // a side
#define CORNER ty_radians(20.0f)

// --- fields ---

typedef float field_fn(const void* context, ty_vec3 p);

typedef struct field
{
    field_fn* at;
    const void* context;
    float step;

} field;

static void fill(void* context, const int block[3], float values[TY_NET_NODES])
{
    const field* f = context;
    for (int i = 0; i < TY_NET_NODES; i++)
    {
        int x = i % TY_NET_BLOCK, y = i / TY_NET_BLOCK % TY_NET_BLOCK, z = i / TY_NET_BLOCK / TY_NET_BLOCK;
        ty_vec3 node = {(float)(block[0] * TY_NET_BLOCK + x), (float)(block[1] * TY_NET_BLOCK + y),
                        (float)(block[2] * TY_NET_BLOCK + z)};
        values[i] = f->at(f->context, ty_mul(node, f->step));
    }
}

static bool sparse; // blocks wholly inside are not looked at

static ty_status net_make(field* f, ty_workers* workers, ty_net** out, ty_error* error)
{
    static int32_t looked[BLOCKS * BLOCKS * BLOCKS], solid[BLOCKS * BLOCKS * BLOCKS];
    int count = 0, solids = 0;
    for (int i = 0; i < BLOCKS * BLOCKS * BLOCKS; i++)
    {
        float values[TY_NET_NODES], most = -TY_FLOAT_MAX;
        fill(f, (const int[3]){i % BLOCKS, i / BLOCKS % BLOCKS, i / BLOCKS / BLOCKS}, values);
        for (int k = 0; k < TY_NET_NODES; k++)
            most = ty_max(most, values[k]);
        if (sparse && most < -3.0f * f->step)
            solid[solids++] = i;
        else
            looked[count++] = i;
    }
    assert_true(!sparse || solids > 0);
    ty_net_def def = {.step = f->step,
                      .blocks = {BLOCKS, BLOCKS, BLOCKS},
                      .active = looked,
                      .solid = solid,
                      .active_count = count,
                      .solid_count = solids,
                      .fill = fill,
                      .context = f};
    return ty_net_create(&def, workers, out, error);
}

static ty_status mesh_try(field* f, int rounds, bool mend, ty_workers* workers, ty_mesh** out, ty_net_pieces* pieces)
{
    ty_net* net;
    ty_error error;
    *out = NULL;
    ty_status status = net_make(f, workers, &net, &error);
    if (status != TY_OK)
    {
        assert_null(net);
        return status;
    }
    status = ty_net_relax(net, rounds, workers) ? ty_net_mesh(net, out, pieces, &error) : TY_INTERRUPTED;
    ty_net_destroy(net);
    if (status == TY_OK && mend)
        status = ty_mesh_mend_corners(*out, CORNER, NULL, NULL, NULL, &error);
    return status;
}

static ty_mesh* mesh_make(field* f, int rounds, bool mend, ty_workers* workers, ty_net_pieces* pieces)
{
    ty_mesh* mesh;
    assert_int_equal(mesh_try(f, rounds, mend, workers, &mesh, pieces), TY_OK);
    assert_non_null(mesh);
    return mesh;
}

typedef struct balls
{
    int count;
    ty_vec3 middle[2];
    float radius[2];
} balls;

static float balls_at(const void* context, ty_vec3 p)
{
    const balls* b = context;
    float d = TY_FLOAT_MAX;
    for (int i = 0; i < b->count; i++)
        d = ty_min(d, ty_length(ty_sub(p, b->middle[i])) - b->radius[i]);
    return d;
}

// A ball of radius 1 with a hollow of .6 in it.
static float shell_at(const void* context, ty_vec3 p)
{
    float r = ty_length(ty_sub(p, *(const ty_vec3*)context));
    return ty_max(r - 1.0f, 0.6f - r);
}

typedef struct plate
{
    ty_vec3 middle, normal;
    float half, radius;
} plate;

static float plate_at(const void* context, ty_vec3 p)
{
    const plate* w = context;
    ty_vec3 q = ty_sub(p, w->middle);
    return ty_max(fabsf(ty_dot(q, w->normal)) - w->half, ty_length(q) - w->radius);
}

// Chance at each node, within a ball that ends before the grid.
static float chance_at(const void* context, ty_vec3 p)
{
    uint32_t seed = *(const uint32_t*)context;
    int x = (int)p.x, y = (int)p.y, z = (int)p.z;
    uint32_t h = seed * 0x9e3779b9u + (uint32_t)x * 0x85ebca6bu + (uint32_t)y * 0xc2b2ae35u + (uint32_t)z * 0x27d4eb2fu;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    float value = (float)((h ^ h >> 15) >> 8) * (2.0f / 16777216.0f) - 1.0f;
    return ty_length(ty_sub(p, ty_vec3_make(24.0f, 24.0f, 24.0f))) > 19.0f ? 1.0f : value;
}

// --- what every surface keeps ---

typedef struct half_edge
{
    uint32_t from, to, triangle;
} half_edge;

static int half_edge_compare(const void* a, const void* b)
{
    const half_edge *x = a, *y = b;
    if (x->from != y->from)
        return x->from < y->from ? -1 : 1;
    return x->to < y->to ? -1 : x->to > y->to;
}

static const half_edge* half_edge_find(const half_edge* all, size_t count, uint32_t from, uint32_t to)
{
    half_edge key = {from, to, 0};
    return bsearch(&key, all, count, sizeof(half_edge), half_edge_compare);
}

// By number, not by place: each edge belongs to two triangles that run along it in opposite ways, and the triangles
// about a vertex are one fan.
static void assert_manifold(const ty_mesh* mesh)
{
    size_t count = 3 * (size_t)mesh->triangle_count;
    half_edge* all = TY_ALLOC(half_edge, count);
    for (size_t i = 0; i < count; i++)
    {
        const uint32_t* t = mesh->triangles[i / 3];
        all[i] = (half_edge){t[i % 3], t[(i + 1) % 3], (uint32_t)(i / 3)};
        assert_true(all[i].from < mesh->vertex_count && all[i].from != all[i].to);
    }
    qsort(all, count, sizeof(half_edge), half_edge_compare);
    for (size_t i = 0; i < count; i++)
    {
        assert_true(i == 0 || half_edge_compare(&all[i - 1], &all[i]) != 0);
        assert_non_null(half_edge_find(all, count, all[i].to, all[i].from));
    }
    uint32_t met = 0;
    for (size_t i = 0; i < count; met++)
    {
        const half_edge *first = &all[i], *e = first;
        size_t valence = 0, fan = 0;
        for (; i < count && all[i].from == first->from; i++)
            valence++;
        do
        {
            const uint32_t* t = mesh->triangles[e->triangle];
            e = half_edge_find(all, count, first->from, t[0] + t[1] + t[2] - e->from - e->to);
            fan++;
        } while (e != first && fan <= valence);
        assert_int_equal(fan, valence);
    }
    assert_int_equal(met, mesh->vertex_count);
    ty_free(all);
}

static void assert_one_shell(ty_mesh* mesh)
{
    ty_mesh_topology topology;
    assert_manifold(mesh);
    ty_mesh_compute_welds(mesh);
    ty_mesh_analyse(mesh, &topology);
    assert_int_equal(topology.components, 1);
    assert_true(topology.volume > 0.0);
}

static float smallest_corner(const ty_mesh* mesh)
{
    float least = TY_PI;
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++)
    {
        const uint32_t* t = mesh->triangles[i / 3];
        ty_vec3 p = mesh->positions[t[i % 3]];
        ty_vec3 a = ty_normalize(ty_sub(mesh->positions[t[(i + 1) % 3]], p));
        ty_vec3 b = ty_normalize(ty_sub(mesh->positions[t[(i + 2) % 3]], p));
        least = ty_min(least, ty_acos(ty_dot(a, b)));
    }
    return least;
}

static float farthest(const ty_mesh* mesh, const field* f)
{
    float most = 0.0f;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        most = ty_max(most, fabsf(f->at(f->context, mesh->positions[v])));
    return most / f->step;
}

// --- tests ---

static const balls one_ball = {1, {{1.51f, 1.49f, 1.503f}}, {1.0f}};

// A vertex lies on the zero of the field between the nodes, which is 1 / (8 r) of a step squared off at most.
static void a_ball_has_its_size_and_curvature(void** state)
{
    (void)state;
    field f = {balls_at, &one_ball, 1.0f / 15.0f};
    ty_net_pieces pieces;
    ty_mesh* mesh = mesh_make(&f, 8, true, NULL, &pieces);
    ty_mesh_topology topology;
    assert_one_shell(mesh);
    assert_int_equal(pieces.shells, 1);
    assert_int_equal(pieces.voids, 0);
    ty_mesh_analyse(mesh, &topology);
    assert_float_equal((float)(topology.area / (4.0 * M_PI)), 1.0f, 0.003f);
    assert_float_equal((float)(topology.volume / (4.0 / 3.0 * M_PI)), 1.0f, 0.005f);
    assert_true(smallest_corner(mesh) >= CORNER);
    assert_true(farthest(mesh, &f) < 0.03f);
    ty_mesh_compute_normals(mesh, TY_PI);
    ty_mesh_compute_curvature(mesh, 3);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        assert_float_equal(mesh->curvature_1[v], 1.0f, 0.15f);
        assert_float_equal(mesh->curvature_2[v], 1.0f, 0.15f);
    }
    ty_mesh_destroy(mesh);
}

// As they come together nodes at the neck stand in all ways to each other: one shell or two, never an edge of four.
static void balls_that_touch_stay_manifold(void** state)
{
    (void)state;
    bool met[2] = {false, false};
    for (int i = 0; i < 24; i++)
    {
        float gap = 0.05f * (float)(i % 8) - 0.15f, turn = 0.13f * (float)i;
        ty_vec3 axis = ty_normalize((ty_vec3){ty_cos(turn), ty_sin(turn), 0.3f * (float)(i % 3)});
        float apart = 1.2f + 0.1f * gap;
        ty_vec3 middle = {2.2f, 2.2f, 2.2f};
        balls b = {2, {ty_mad(middle, axis, -0.5f * apart), ty_mad(middle, axis, 0.5f * apart)}, {0.6f, 0.6f}};
        field f = {balls_at, &b, 0.1f};
        ty_net_pieces pieces;
        ty_mesh* mesh = mesh_make(&f, 8, true, NULL, &pieces);
        assert_one_shell(mesh);
        assert_in_range(pieces.shells, 1, 2);
        assert_true(smallest_corner(mesh) >= ty_radians(10.0f)); // necks narrower than a step have nowhere to go
        met[pieces.shells - 1] = true;
        ty_mesh_destroy(mesh);
    }
    assert_true(met[0] && met[1]);
}

// Two sheets nearer to each other than nodes are.
static void thin_plates_are_closed(void** state)
{
    (void)state;
    for (int i = 0; i < 20; i++)
    {
        float turn = 0.31f * (float)i;
        plate w = {.middle = {2.4f, 2.39f, 2.41f},
                   .normal = ty_normalize((ty_vec3){ty_cos(turn), ty_sin(turn), 0.4f * (float)(i % 4)}),
                   .half = 0.1f * (0.4f + 0.06f * (float)i),
                   .radius = 1.5f};
        field f = {plate_at, &w, 0.1f};
        ty_mesh* mesh = mesh_make(&f, 8, true, NULL, NULL);
        assert_one_shell(mesh);
        ty_mesh_destroy(mesh);
    }
}

static void chance_stays_manifold(void** state)
{
    (void)state;
    for (uint32_t seed = 0; seed < 3; seed++)
        for (int mend = 0; mend < 2; mend++)
        {
            field f = {chance_at, &seed, 1.0f};
            ty_net_pieces pieces;
            ty_mesh* mesh = mesh_make(&f, 4, mend, NULL, &pieces);
            assert_true(pieces.shells + pieces.voids > 10);
            assert_manifold(mesh);
            ty_mesh_destroy(mesh);
        }
}

static void pieces_are_counted_and_the_largest_kept(void** state)
{
    (void)state;
    ty_vec3 middle = {1.7f, 1.6f, 1.65f};
    field hollow = {shell_at, &middle, 0.075f};
    ty_net_pieces pieces;
    ty_mesh_topology topology;
    ty_mesh* mesh = mesh_make(&hollow, 4, false, NULL, &pieces);
    assert_one_shell(mesh);
    assert_int_equal(pieces.shells, 1);
    assert_int_equal(pieces.voids, 1);
    ty_mesh_analyse(mesh, &topology);
    assert_float_equal((float)topology.volume, 4.19f, 0.1f); // the hollow is gone
    ty_mesh_destroy(mesh);
    balls b = {2, {{0.6f, 0.6f, 0.6f}, {2.0f, 2.0f, 2.0f}}, {0.4f, 0.8f}};
    field two = {balls_at, &b, 0.075f};
    mesh = mesh_make(&two, 4, false, NULL, &pieces);
    assert_one_shell(mesh);
    assert_int_equal(pieces.shells, 2);
    ty_mesh_compute_bounds(mesh);
    assert_true(mesh->bounds.low.x > 1.1f);
    ty_mesh_destroy(mesh);
}

static void what_lies_inside_need_not_be_stored(void** state)
{
    (void)state;
    ty_mesh* meshes[2];
    field f = {balls_at, &one_ball, 1.0f / 20.0f};
    for (int i = 0; i < 2; i++)
    {
        sparse = i == 1;
        meshes[i] = mesh_make(&f, 8, true, NULL, NULL);
    }
    sparse = false;
    assert_int_equal(meshes[0]->vertex_count, meshes[1]->vertex_count);
    assert_memory_equal(meshes[0]->positions, meshes[1]->positions, meshes[0]->vertex_count * sizeof(ty_vec3));
    assert_int_equal(meshes[0]->triangle_count, meshes[1]->triangle_count);
    assert_one_shell(meshes[1]);
    ty_mesh_destroy(meshes[0]);
    ty_mesh_destroy(meshes[1]);
}

static ty_vec3 on_the_ball(void* context, ty_vec3 p)
{
    int* asked = context;
    ++*asked;
    return ty_normalize(p);
}

// A ball of rings: needles at its poles, which any flip, collapse or move has to get out of.
static ty_mesh* ball_of_rings(void)
{
    enum
    {
        RINGS = 24,
        TURN = 96,
    };
    ty_mesh* mesh = ty_mesh_create(2 + RINGS * TURN, 2 * TURN + 2 * TURN * (RINGS - 1));
    uint32_t t = 0;
    for (int r = 0; r < RINGS; r++)
        for (int i = 0; i < TURN; i++)
        {
            float lat = TY_PI * (float)(r + 1) / (float)(RINGS + 1), lon = 2.0f * TY_PI * (float)i / (float)TURN;
            mesh->positions[2 + r * TURN + i] =
                (ty_vec3){ty_sin(lat) * ty_cos(lon), ty_sin(lat) * ty_sin(lon), ty_cos(lat)};
        }
    mesh->positions[0] = (ty_vec3){0.0f, 0.0f, 1.0f};
    mesh->positions[1] = (ty_vec3){0.0f, 0.0f, -1.0f};
    for (uint32_t i = 0; i < TURN; i++)
    {
        uint32_t next = (i + 1) % TURN, last = 2 + (RINGS - 1) * TURN;
        memcpy(mesh->triangles[t++], (uint32_t[3]){0, 2 + i, 2 + next}, sizeof(uint32_t[3]));
        memcpy(mesh->triangles[t++], (uint32_t[3]){1, last + next, last + i}, sizeof(uint32_t[3]));
        for (uint32_t r = 0; r + 1 < RINGS; r++)
        {
            uint32_t a = 2 + r * TURN;
            ty_mesh_set_quad(mesh, t, (const uint32_t[4]){a + i, a + TURN + i, a + TURN + next, a + next});
            t += 2;
        }
    }
    return mesh;
}

static void corners_are_mended(void** state)
{
    (void)state;
    for (int held = 0; held < 2; held++)
    {
        ty_mesh* mesh = ball_of_rings();
        float before = smallest_corner(mesh), after;
        int asked = 0;
        ty_error error;
        assert_true(before < ty_radians(5.0f));
        ty_mesh_hold* hold = held ? on_the_ball : NULL;
        assert_int_equal(ty_mesh_mend_corners(mesh, CORNER, hold, &asked, &after, &error), TY_OK);
        assert_one_shell(mesh);
        assert_true(smallest_corner(mesh) >= CORNER);
        assert_float_equal(after, smallest_corner(mesh), 1e-3f);
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            assert_float_equal(ty_length(mesh->positions[v]), 1.0f, (held ? 1e-6f : 0.02f));
        assert_int_equal(asked > 0, held);
        ty_mesh_destroy(mesh);
    }
}

// A tube of three corners, long against its width: no edge about it can go, as that would close it, no flip helps, and
// within its faces there is no room.
static void necks_get_room(void** state)
{
    (void)state;
    enum
    {
        RINGS = 12,
    };
    static const ty_vec3 section[3] = {{0.0f, 0.0f, 0.0f}, {0.05f, 0.0f, 0.0f}, {0.1f, 0.05f, 0.0f}};
    ty_mesh* mesh = ty_mesh_create(3 * RINGS, 6 * (RINGS - 1) + 2);
    for (uint32_t i = 0; i < 3 * RINGS; i++)
        mesh->positions[i] = ty_add(section[i % 3], ty_vec3_make(0.0f, 0.0f, (float)(i / 3)));
    for (uint32_t i = 0; i < 3 * (RINGS - 1); i++)
    {
        uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
        ty_mesh_set_quad(mesh, 2 * i, (const uint32_t[4]){i, next, next + 3, i + 3});
    }
    uint32_t caps = 6 * (RINGS - 1), last = 3 * (RINGS - 1);
    memcpy(mesh->triangles[caps], (uint32_t[3]){0, 2, 1}, sizeof(uint32_t[3]));
    memcpy(mesh->triangles[caps + 1], (uint32_t[3]){last, last + 1, last + 2}, sizeof(uint32_t[3]));
    ty_error error;
    assert_one_shell(mesh);
    assert_true(smallest_corner(mesh) < ty_radians(3.0f));
    assert_int_equal(ty_mesh_mend_corners(mesh, CORNER, NULL, NULL, NULL, &error), TY_OK);
    assert_one_shell(mesh);
    assert_true(smallest_corner(mesh) > ty_radians(15.0f));
    ty_mesh_destroy(mesh);
}

static void workers_change_no_bit(void** state)
{
    (void)state;
    uint32_t seed = 5;
    field fields[] = {{chance_at, &seed, 1.0f}, {balls_at, &one_ball, 1.0f / 15.0f}};
    for (int i = 0; i < 2; i++)
    {
        ty_mesh* first = NULL;
        for (int threads = 1; threads <= 3; threads++)
        {
            ty_workers* workers;
            ty_error error;
            assert_int_equal(ty_workers_create(threads, &workers, &error), TY_OK);
            ty_mesh* mesh = mesh_make(&fields[i], 8, true, workers, NULL);
            first = first ? first : mesh;
            assert_int_equal(mesh->vertex_count, first->vertex_count);
            assert_int_equal(mesh->triangle_count, first->triangle_count);
            assert_memory_equal(mesh->positions, first->positions, mesh->vertex_count * sizeof(ty_vec3));
            assert_memory_equal(mesh->triangles, first->triangles, mesh->triangle_count * sizeof(*mesh->triangles));
            if (mesh != first)
                ty_mesh_destroy(mesh);
            ty_workers_destroy(workers);
        }
        ty_mesh_destroy(first);
    }
}

static ty_status sweep(void* context)
{
    ty_mesh* mesh;
    ty_status status = mesh_try(context, 2, true, NULL, &mesh, NULL);
    ty_mesh_destroy(mesh);
    return status;
}

static void memory_may_end_anywhere(void** state)
{
    (void)state;
    field f = {balls_at, &one_ball, 1.0f / 15.0f};
    assert_true(ty_alloc_sweep(sweep, &f) > 12);
}

static void nothing_is_refused_and_a_signal_ends_it(void** state)
{
    (void)state;
    balls none = {1, {{-9.0f, 0.0f, 0.0f}}, {1.0f}};
    field f = {balls_at, &none, 0.1f}, ball = {balls_at, &one_ball, 1.0f / 15.0f};
    ty_net* net;
    ty_error error;
    assert_int_equal(net_make(&f, NULL, &net, &error), TY_BAD_INPUT);
    assert_null(net);
    ty_cancel_request(0);
    assert_int_equal(net_make(&ball, NULL, &net, &error), TY_INTERRUPTED);
    ty_cancel_clear();
    assert_null(net);
    assert_int_equal(net_make(&ball, NULL, &net, &error), TY_OK);
    ty_cancel_request(0);
    assert_false(ty_net_relax(net, 3, NULL));
    ty_cancel_clear();
    ty_net_destroy(net);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_has_its_size_and_curvature),
        cmocka_unit_test(balls_that_touch_stay_manifold),
        cmocka_unit_test(thin_plates_are_closed),
        cmocka_unit_test(chance_stays_manifold),
        cmocka_unit_test(pieces_are_counted_and_the_largest_kept),
        cmocka_unit_test(what_lies_inside_need_not_be_stored),
        cmocka_unit_test(corners_are_mended),
        cmocka_unit_test(necks_get_room),
        cmocka_unit_test(workers_change_no_bit),
        cmocka_unit_test(memory_may_end_anywhere),
        cmocka_unit_test(nothing_is_refused_and_a_signal_ends_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
