// SPDX-License-Identifier: Apache-2.0
// Recipes: tables and defaults agree, impossible wishes name their bound, and small aggregates come out at rest.
#include "recipe_made.h"
#include <tsuya/base/hash.h>

// Each number of a default lies in the range of its row, in the unit of the row.
static void assert_in_table(const ty_param_table* table, const char* def)
{
    for (int i = 0; i < table->count; i++)
    {
        const ty_param* row = &table->params[i];
        double value = 0.0, unit = 1.0;
        if (row->type == TY_PARAM_GROUP)
            assert_in_table(row->group, def + row->offset);
        if (row->type == TY_PARAM_INT)
            value = *(const int*)(const void*)(def + row->offset);
        else if (row->type == TY_PARAM_FLOAT)
            value = (double)*(const float*)(const void*)(def + row->offset);
        else
            continue;
        if (strcmp(row->unit, "mm") == 0)
            unit = 1e-3;
        if (strcmp(row->unit, "deg") == 0)
            unit = 3.14159265358979 / 180.0;
        if (row->maximum > row->minimum && !(value / unit >= row->minimum && value / unit <= row->maximum * 1.000001))
            fail_msg("%s.%s: %g is not in %g..%g", table->name, row->name, value / unit, row->minimum, row->maximum);
        assert_true(row->help[0] != 0 && row->name[0] != 0);
        assert_true(row->offset < table->size);
    }
}

static void test_defaults(void** state)
{
    (void)state;
    const ty_generator* generator = ty_generator_find("aggregate");
    assert_non_null(generator);
    assert_null(ty_generator_find("aggregat"));
    int count;
    assert_ptr_equal(ty_generator_list(&count)[0], generator);
    assert_int_equal(generator->params->size, sizeof(ty_aggregate_recipe));
    ty_aggregate_recipe recipe;
    memset(&recipe, 0xff, sizeof recipe);
    generator->params->set_default(&recipe);
    assert_int_equal(recipe.fill.count, 2000);
    assert_in_table(generator->params, (const char*)&recipe);
}

// The bowl of a recipe is that of a scene: same names, units, ranges and defaults.
static void test_container_mirrors_shapes(void** state)
{
    (void)state;
    const ty_param_table *container = ty_container_params(), *shape = ty_shape_params();
    const ty_shape_def scene = ty_shape_def_default();
    const ty_container_def mine = ty_container_def_default();
    int common = 0;
    for (int i = 0; i < container->count; i++)
        for (int k = 0; k < shape->count; k++)
        {
            const ty_param *a = &container->params[i], *b = &shape->params[k];
            if (strcmp(a->name, b->name) != 0 || a->type == TY_PARAM_ENUM)
                continue;
            common++;
            assert_int_equal(a->type, b->type);
            assert_string_equal(a->unit, b->unit);
            assert_true(a->minimum == b->minimum && a->maximum == b->maximum);
            assert_int_equal(a->offset, offsetof(ty_container_def, shape) + b->offset);
            size_t size = a->type == TY_PARAM_FLOAT3 ? sizeof(ty_vec3) : sizeof(float); // an int is as large
            assert_memory_equal((const char*)&mine + a->offset, (const char*)&scene + b->offset, size);
        }
    assert_int_equal(common, 9);
}

static ty_aggregate_recipe small_bowl(void)
{
    ty_aggregate_recipe r = ty_aggregate_recipe_default();
    set_bowl(&r.container.shape, 0.024f, 0.021f, 0.0018f, 0.010f, 0.003f);
    r.element.variants = 4;
    r.fill.count = 240;
    r.fill.heap = 6e-3f;
    return r;
}

static void test_impossible_wishes(void** state)
{
    (void)state;
    ty_aggregate_recipe r = small_bowl();
    r.element.width = 8e-3f;
    assert_refused(&r, "element.length", "");
    r = small_bowl();
    r.element.thickness = 1e-3f;
    assert_refused(&r, "element.thickness", "");
    r = small_bowl();
    r.element.variants = 65;
    assert_refused(&r, "element.variants", "");
    r = small_bowl();
    r.fill.density = 0.75f;
    assert_refused(&r, "fill.density", "");
    r = small_bowl();
    r.fill.count = 0;
    assert_refused(&r, "fill.count", "");
    r = small_bowl();
    r.fill.count = 3000;
    assert_refused(&r, "at most 4", ""); // a hollow of 13 cm^3 and a heap as steep as grains stand: some 430
    r = small_bowl();
    r.container.kind = TY_CONTAINER_BOX;
    r.container.shape.size = ty_vec3_make(0.002f, 0.01f, 0.01f);
    assert_refused(&r, "its inside", "");
    r = small_bowl();
    r.container.kind = TY_CONTAINER_MESH;
    assert_refused(&r, "container.mesh", "");
    r = small_bowl();
    r.container.shape.thickness = 0.02f;
    assert_refused(&r, "thickness", "");
}

// Every grain is in the bowl or above it, and does not reach through its wall.
static void assert_in_bowl(const ty_aggregate* a, const ty_shape_def* bowl)
{
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        const ty_mesh* mesh = a->prototypes[a->prototype_index[i]];
        for (uint32_t v = 0; v < mesh->vertex_count; v += 5)
        {
            ty_vec3 p = ty_map_point(&a->transforms[i], mesh->positions[v]);
            assert_true(p.x * p.x + p.z * p.z < ty_sqr(bowl->radius + 0.004f));
            assert_true(p.y > bowl->height || ty_shape_interior_distance(bowl, p) < 0.2e-3f);
        }
    }
}

static void test_bowl(void** state)
{
    (void)state;
    ty_aggregate_recipe r = small_bowl();
    r.moisture.variation = 0.5f;
    r.moisture.drying = 0.6f;
    ty_aggregate* a = made(&r, NULL);
    assert_int_equal(a->instance_count, 240);
    assert_int_equal(a->prototype_count, 4);
    ty_shape_def bowl = r.container.shape;
    bowl.kind = TY_SHAPE_BOWL;
    assert_in_bowl(a, &bowl);
    assert_non_null(strstr(a->metrics, "\"floating\": 0"));
    assert_non_null(strstr(a->metrics, "\"rest\": true"));
    const ty_instance_attribute* moisture = ty_aggregate_find_attribute(a, "moisture");
    const ty_instance_attribute* tint = ty_aggregate_find_attribute(a, "tint");
    const ty_instance_attribute* depth = ty_aggregate_find_attribute(a, "depth");
    double top = 0.0, deep = 0.0, mean_tint = 0.0;
    int top_count = 0, deep_count = 0;
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        float scale = ty_length(a->transforms[i].x);
        assert_true(fabsf(ty_length(a->transforms[i].y) - scale) < 1e-5f && scale > 0.89f && scale < 1.11f);
        assert_int_equal(a->ids[i], i);
        assert_true(fabsf(moisture->values[i]) <= 1.0f && fabsf(tint->values[i]) <= 1.0f);
        mean_tint += (double)tint->values[i] / a->instance_count;
        bool surface = depth->values[i] < 1e-3f;
        *(surface ? &top : &deep) += (double)moisture->values[i];
        *(surface ? &top_count : &deep_count) += 1;
    }
    assert_true(top_count > 40 && deep_count > 40);
    assert_true(top / top_count < deep / deep_count - 0.15); // drier at the surface
    assert_true(fabs(mean_tint) < 0.12);
    ty_aggregate_destroy(a);
}

static ty_hash aggregate_hash(const ty_aggregate* a)
{
    ty_hasher* hasher = ty_hasher_create();
    ty_hasher_add(hasher, a->transforms, a->instance_count * sizeof *a->transforms);
    ty_hasher_add(hasher, a->prototype_index, a->instance_count * sizeof *a->prototype_index);
    for (int i = 0; i < a->attribute_count; i++)
        ty_hasher_add(hasher, a->attributes[i].values, a->instance_count * sizeof(float));
    for (int i = 0; i < a->prototype_count; i++)
        ty_hasher_add(hasher, a->prototypes[i]->normals, a->prototypes[i]->vertex_count * sizeof(ty_vec3));
    ty_hasher_add_string(hasher, a->metrics);
    return ty_hasher_end(hasher);
}

static void test_one_seed_one_result(void** state)
{
    (void)state;
    ty_aggregate_recipe r = small_bowl();
    ty_hash hashes[4];
    for (int i = 0; i < 4; i++)
    {
        ty_workers* workers = NULL;
        ty_error error;
        assert_int_equal(ty_workers_create(i < 3 ? i + 1 : 1, &workers, &error), TY_OK);
        r.seed.value = i < 3 ? 7 : 8;
        ty_aggregate* a = made(&r, workers);
        hashes[i] = aggregate_hash(a);
        ty_aggregate_destroy(a);
        ty_workers_destroy(workers);
    }
    assert_memory_equal(&hashes[0], &hashes[1], sizeof(ty_hash));
    assert_memory_equal(&hashes[0], &hashes[2], sizeof(ty_hash));
    assert_memory_not_equal(&hashes[0], &hashes[3], sizeof(ty_hash));
}

static void test_sphere(void** state)
{
    (void)state;
    ty_aggregate_recipe r = small_bowl();
    r.container.kind = TY_CONTAINER_SPHERE;
    r.container.shape.radius = 0.016f;
    r.fill.count = 180;
    ty_aggregate* a = made(&r, NULL);
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        const ty_mesh* mesh = a->prototypes[a->prototype_index[i]];
        for (uint32_t v = 0; v < mesh->vertex_count; v += 5)
            assert_true(ty_length(ty_map_point(&a->transforms[i], mesh->positions[v])) < 0.016f + 0.2e-3f);
    }
    ty_aggregate_destroy(a);
}

// A torus from a file: grains lie within its tube, none in the hole.
static void test_mesh(void** state)
{
    (void)state;
    ty_shape_def torus = ty_shape_def_default();
    torus.kind = TY_SHAPE_TORUS;
    torus.radius = 0.02f;
    torus.tube = 0.009f;
    ty_mesh* mesh;
    ty_error error;
    assert_int_equal(ty_shape_create(&torus, &mesh, &error), TY_OK);
    char path[] = "/tmp/tsuya_container_XXXXXX.ply";
    mesh_keep(mesh, path);
    ty_aggregate_recipe r = small_bowl();
    r.container.kind = TY_CONTAINER_MESH;
    r.container.mesh = path;
    r.fill.count = 300;
    ty_aggregate* a = made(&r, NULL);
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        ty_vec3 p = a->transforms[i].t;
        float ring = sqrtf(p.x * p.x + p.z * p.z) - torus.radius;
        assert_true(ring * ring + p.y * p.y < ty_sqr(torus.tube - 1e-3f));
    }
    ty_aggregate_destroy(a);
    mesh->triangle_count -= 2; // an open surface
    assert_int_equal(ty_ply_write(path, mesh, &error), TY_OK);
    assert_refused(&r, "closed", "");
    ty_mesh_destroy(mesh);
    unlink(path);
}

// The sampled walls of a bowl and a sphere against the shapes' own distances.
static void test_walls(void** state)
{
    (void)state;
    ty_container_def def = ty_container_def_default();
    ty_container* bowl;
    ty_error error;
    assert_int_equal(ty_container_create(&def, NULL, &bowl, &error), TY_OK);
    def.shape.kind = TY_SHAPE_BOWL;
    ty_rng rng = ty_rng_make((ty_seed){1}, 2, 3);
    int inside = 0;
    for (int i = 0; i < 4000; i++)
    {
        float x = ty_rng_range(&rng, -0.05f, 0.05f), y = ty_rng_range(&rng, 0.005f, 0.05f);
        ty_vec3 n, p = {x, y, ty_rng_range(&rng, -0.05f, 0.05f)};
        float distance = ty_shape_interior_distance(&def.shape, p), gap = ty_container_wall(bowl, 0, p, &n);
        assert_true(fabsf(ty_length(n) - 1.0f) < 1e-3f);
        if (distance > 0.0f || p.y > 0.045f) // below the rim the hollow's distance is that of the wall
            continue;
        inside++;
        assert_true(ty_container_holds(bowl, p));
        assert_true(fabsf(gap + distance) < 0.15e-3f + 0.03f * fabsf(distance));
        float further = ty_container_wall(bowl, 0, ty_mad(p, n, 0.2e-3f), &n);
        assert_true(gap < 0.3e-3f || gap > 0.015f || further > gap + 0.1e-3f);
    }
    assert_true(inside > 500);
    ty_vec3 up; // the table
    assert_true(fabsf(ty_container_wall(bowl, 0, ty_vec3_make(0.05f, 1e-3f, 0.0f), &up) - 1e-3f) < 1e-4f &&
                up.y > 0.99f);
    assert_true(ty_container_lost(bowl, ty_vec3_make(0.061f, 0.01f, 0.0f)));
    assert_false(ty_container_lost(bowl, ty_vec3_make(0.03f, 0.07f, 0.0f)));
    ty_container_destroy(bowl);
}

// The five planes of a box: each gap is to the plane, each normal leads away from it.
static void test_box_walls(void** state)
{
    (void)state;
    ty_container_def def = ty_container_def_default();
    def.kind = TY_CONTAINER_BOX;
    def.shape.size = ty_vec3_make(0.03f, 0.02f, 0.04f);
    def.shape.rounding = 0.0f;
    ty_container* box;
    ty_error error;
    assert_int_equal(ty_container_create(&def, NULL, &box, &error), TY_OK);
    assert_int_equal(ty_container_wall_count(box), 5);
    const ty_vec3 p = {0.01f, -0.015f, 0.02f};
    const float gaps[6] = {0.04f, 0.02f, 0.005f, 0.0f, 0.06f, 0.02f}; // along -x +x -y +y -z +z; +y is open
    int seen = 0;
    for (int w = 0; w < 5; w++)
    {
        ty_vec3 n, again;
        float gap = ty_container_wall(box, w, p, &n);
        int along = n.x != 0.0f ? n.x < 0.0f : n.y != 0.0f ? 2 + (n.y < 0.0f) : 4 + (n.z < 0.0f);
        seen |= 1 << along;
        assert_true(fabsf(gap - gaps[along]) < 1e-7f && ty_length(n) == 1.0f);
        assert_true(fabsf(ty_container_wall(box, w, ty_mad(p, n, 1e-3f), &again) - gap - 1e-3f) < 1e-7f);
    }
    assert_int_equal(seen, 0x37);
    ty_container_destroy(box);
}

// Of two grains dropped, one beside the bowl: it is taken out, the other comes to rest in the hollow.
static void test_lost(void** state)
{
    (void)state;
    ty_container_def def = ty_container_def_default();
    ty_container* bowl;
    ty_error error;
    ty_element grain;
    ty_element_def rice = ty_element_def_default();
    assert_int_equal(ty_container_create(&def, NULL, &bowl, &error), TY_OK);
    assert_int_equal(ty_element_init(&rice, (ty_seed){1}, 0, &grain, &error), TY_OK);
    ty_vec3 up;
    assert_float_equal(ty_container_wall(bowl, 0, ty_vec3_make(0.2f, 0.03f, 0.3f), &up), 0.03f,
                       1e-6f); // over the table
    assert_float_equal(ty_container_wall(bowl, 0, ty_vec3_make(-0.2f, -0.01f, 0.0f), &up), -0.01f, 1e-6f);
    assert_true(up.y == 1.0f);
    ty_pile_def pile_def = ty_pile_def_default();
    pile_def.grains = &grain;
    pile_def.grain_count = 1;
    pile_def.container = bowl;
    ty_pile* pile = ty_pile_create(&pile_def);
    ty_body two[2] = {{.position = {0.07f, 0.05f, 0.0f}, .rotation = ty_quat_identity(), .scale = 1.0f},
                      {.position = {0.0f, 0.02f, 0.01f}, .rotation = ty_quat_identity(), .scale = 1.0f}};
    ty_pile_add(pile, two, 2);
    int lost = 0;
    assert_int_equal(ty_pile_settle(pile, 2.0f, NULL, &lost), TY_PILE_LOST);
    assert_int_equal(lost, 1);
    assert_int_equal(ty_pile_count(pile), 1);
    assert_int_equal(ty_pile_settle(pile, 4.0f, NULL, &lost), TY_PILE_REST);
    assert_int_equal(lost, 0);
    assert_true(ty_container_holds(bowl, ty_pile_bodies(pile)[0].position));
    ty_pile_destroy(pile);
    ty_element_term(&grain);
    ty_container_destroy(bowl);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_container_mirrors_shapes),
        cmocka_unit_test(test_impossible_wishes),
        cmocka_unit_test(test_walls),
        cmocka_unit_test(test_box_walls),
        cmocka_unit_test(test_lost),
        cmocka_unit_test(test_bowl),
        cmocka_unit_test(test_one_seed_one_result),
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_mesh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
