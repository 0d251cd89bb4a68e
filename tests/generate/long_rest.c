// SPDX-License-Identifier: Apache-2.0
// The four piles of Gan 2023 in size, three seeds each: a body of many limbs and a mould filled to the brim, a bowl of
// rice, a bowl of roe. All come to rest, stay there for a further second, and overlap no more than they may.
#include "rest_rows.h"

enum
{
    SEEDS = 3,
};

static ty_workers* workers;

static int group_setup(void** state)
{
    (void)state;
    ty_error error;
    return ty_workers_create(2, &workers, &error) == TY_OK ? 0 : -1;
}

static int group_teardown(void** state)
{
    (void)state;
    ty_workers_destroy(workers);
    return 0;
}

// slot and width: of what is rendered, for its overlaps.
static void three_seeds(const char* name, ty_aggregate_recipe* r, const rest_bounds* bounds, const char* slot,
                        float width)
{
    for (int seed = 1; seed <= SEEDS; seed++)
    {
        r->seed.value = (uint64_t)seed;
        ty_aggregate* a = made(r, workers);
        assert_at_rest(name, a, bounds);
        assert_meshes_apart(a, slot, width, slot ? 3.0 : 7.0, 1.5);
        ty_aggregate_destroy(a);
    }
}

// --- containers: a sphere's mesh moved along its rays, and sized to a volume ---

typedef float reach_fn(ty_vec3 direction);

// Body, head and two ears, none thinner than three grains.
static float rabbit_reach(ty_vec3 d)
{
    const ty_vec3 head = {0.8f, 0.6f, 0.0f}, left = {0.3f, 0.9f, 0.3f}, right = {0.3f, 0.9f, -0.3f};
    float h = ty_max(0.0f, ty_dot(d, head)), l = ty_max(0.0f, ty_dot(d, left)), r = ty_max(0.0f, ty_dot(d, right));
    return 1.0f + 0.5f * ty_pow(h, 6.0f) + 0.5f * ty_pow(l, 40.0f) + 0.5f * ty_pow(r, 40.0f);
}

// A triangle with round corners, flat behind and in front.
static float onigiri_reach(ty_vec3 d)
{
    const float sides[5][3] = {
        {0.0f, -1.0f, 0.0f}, {0.866f, 0.5f, 0.0f}, {-0.866f, 0.5f, 0.0f}, {0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, -1.0f}};
    float sum = 0.0f;
    for (int i = 0; i < 5; i++)
    {
        float along = d.x * sides[i][0] + d.y * sides[i][1] + d.z * sides[i][2];
        sum += along > 0.0f ? ty_pow(along * (i < 3 ? 1.0f : 1.1f), 6.0f) : 0.0f;
    }
    return ty_pow(sum, -1.0f / 6.0f);
}

static void mould_write(reach_fn* reach, double volume, char* path)
{
    ty_shape_def def = ty_shape_def_default();
    def.kind = TY_SHAPE_SPHERE;
    def.radius = 1.0f;
    def.divisions = 96;
    ty_mesh* mesh;
    ty_error error;
    assert_int_equal(ty_shape_create(&def, &mesh, &error), TY_OK);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        mesh->positions[i] = ty_mul(mesh->positions[i], reach(ty_normalize(mesh->positions[i])));
    ty_mesh_topology topology;
    ty_mesh_analyse(mesh, &topology);
    float scale = ty_pow((float)(volume / topology.volume), 1.0f / 3.0f);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        mesh->positions[i] = ty_mul(mesh->positions[i], scale);
    mesh_keep(mesh, path);
    ty_mesh_destroy(mesh);
}

static void mould_rests(const char* name, reach_fn* reach, int count, float density, double volume)
{
    const rest_bounds bounds = {{0.58, 0.68}, {4.0, 7.0}};
    char path[] = "/tmp/tsuya_mould_XXXXXX.ply";
    mould_write(reach, volume, path);
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    r.container.kind = TY_CONTAINER_MESH;
    r.container.mesh = path;
    r.fill.count = count;
    r.fill.density = density;
    r.settle.watch = 1.0f;
    three_seeds(name, &r, &bounds, NULL, 3e-3f);
    unlink(path);
}

static void test_rabbit(void** state)
{
    (void)state;
    mould_rests("rabbit", rabbit_reach, 5111, 0.61f, 2.97e-4);
}

static void test_onigiri(void** state)
{
    (void)state;
    mould_rests("onigiri", onigiri_reach, 3064, 0.63f, 1.78e-4);
}

static void test_rice_bowl(void** state)
{
    (void)state;
    const rest_bounds bounds = {{0.58, 0.68}, {4.0, 7.0}};
    ty_aggregate_recipe r = rice_bowl(2000);
    three_seeds("rice bowl", &r, &bounds, NULL, 3e-3f);
}

static void test_roe_bowl(void** state)
{
    (void)state;
    const rest_bounds bounds = {{0.54, 0.65}, {3.0, 6.5}};
    ty_aggregate_recipe r = roe_bowl(310);
    three_seeds("roe bowl", &r, &bounds, "membrane", 6.2e-3f);
}

// The name of one test as an argument runs it alone.
int main(int argc, char** argv)
{
    if (argc > 1)
        cmocka_set_test_filter(argv[1]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_onigiri),
        cmocka_unit_test(test_rabbit),
        cmocka_unit_test(test_roe_bowl),
        cmocka_unit_test(test_rice_bowl),
    };
    return cmocka_run_group_tests(tests, group_setup, group_teardown);
}
