// SPDX-License-Identifier: Apache-2.0
// Surfaces that emit: each instance is an emitter, and one of its triangles is chosen by a tree of its prototype that
// all instances share.
#include "light.h"
#include <tsuya/base/memory.h>

// Every triangle that emits at all is chosen at least as if it gave this share of the mean.
#define LEAST_EMISSION 0.05f

// --- building ---

static bool object_emits(const ty_scene* scene, const ty_scene_object* object)
{
    for (uint32_t k = 0; k < ty_scene_material_count(object); ++k)
        if (ty_material_is_emissive(scene->materials[ty_scene_material_at(object, k)]))
            return true;
    return false;
}

static ty_surface_point triangle_point(const ty_scene* scene, ty_hit hit, float u, float v)
{
    ty_surface_point point;
    hit.u = u;
    hit.v = v;
    ty_world_surface(scene->world, &hit, &point);
    return point;
}

// Mean luminance that a triangle emits, by four points.
static float triangle_emission(const ty_scene* scene, ty_hit hit)
{
    static const float places[4][2] = {
        {1.0f / 3, 1.0f / 3}, {1.0f / 6, 1.0f / 6}, {2.0f / 3, 1.0f / 6}, {1.0f / 6, 2.0f / 3}};
    const ty_material* material = ty_scene_material(scene, hit.object, hit.instance, hit.triangle);
    if (!ty_material_is_emissive(material))
        return 0.0f;
    float sum = 0.0f;
    for (int i = 0; i < 4; ++i)
    {
        ty_surface_point point = triangle_point(scene, hit, places[i][0], places[i][1]);
        float y = ty_luminance(ty_material_emission(material, &scene->shading, &point));
        sum += y > 0.0f && y < TY_FLOAT_MAX ? y : 0.0f;
    }
    return 0.25f * sum;
}

// Without its energy.
static ty_light_node triangle_leaf(const ty_mesh* mesh, uint32_t triangle, float* area)
{
    const uint32_t* corner = mesh->triangles[triangle];
    ty_vec3 a = mesh->positions[corner[0]], b = mesh->positions[corner[1]], c = mesh->positions[corner[2]];
    ty_vec3 n = ty_cross(ty_sub(b, a), ty_sub(c, a));
    *area = 0.5f * ty_length(n);
    return (ty_light_node){.low = ty_min3(a, ty_min3(b, c)),
                           .high = ty_max3(a, ty_max3(b, c)),
                           .axis = ty_normalize(n),
                           .cos_o = 1.0f,
                           .mean = ty_normalize(n),
                           .child = triangle};
}

// By what the instance's triangles emit; NULL when that is nothing.
static ty_light_tree* tree_of(const ty_scene* scene, uint32_t object, uint32_t instance)
{
    const ty_mesh* mesh = ty_world_mesh(scene->world, object, instance);
    ty_light_node* leaves = TY_ALLOC(ty_light_node, mesh->triangle_count);
    float* areas = TY_ALLOC(float, mesh->triangle_count);
    int count = 0;
    double power = 0.0, whole = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t)
    {
        if (!ty_material_is_emissive(ty_scene_material(scene, object, instance, t)))
            continue;
        ty_light_node leaf = triangle_leaf(mesh, t, &areas[count]);
        if (!(areas[count] > 0.0f))
            continue;
        leaf.energy = triangle_emission(scene, (ty_hit){.object = object, .instance = instance, .triangle = t});
        whole += (double)areas[count];
        power += (double)areas[count] * (double)leaf.energy;
        leaves[count++] = leaf;
    }
    float least = whole > 0.0 ? LEAST_EMISSION * (float)(power / whole) : 0.0f;
    for (int i = 0; i < count; ++i)
        leaves[i].energy = areas[i] * (leaves[i].energy + least) / (1.0f + LEAST_EMISSION);
    ty_light_tree* tree = power > 0.0 ? ty_light_tree_create(leaves, count, (int)mesh->triangle_count) : NULL;
    ty_free(areas);
    ty_free(leaves);
    return tree;
}

// Instances share a tree when they share the prototype and what its triangles are made of.
typedef struct tree_key
{
    uint32_t prototype, material;
    const uint32_t* slots;
} tree_key;

static bool same_key(const tree_key* a, const tree_key* b)
{
    return a->prototype == b->prototype && a->material == b->material && a->slots == b->slots;
}

typedef struct tree_list
{
    tree_key* keys;
    int capacity;
} tree_list;

static void grow(ty_light_set* set, tree_list* list)
{
    int count = set->mesh_tree_count;
    if (count < list->capacity)
        return;
    list->capacity = 2 * count + 8;
    ty_light_tree** trees = TY_ALLOC(ty_light_tree*, list->capacity);
    tree_key* keys = TY_ALLOC(tree_key, list->capacity);
    for (int i = 0; i < count; ++i)
    {
        trees[i] = set->mesh_trees[i];
        keys[i] = list->keys[i];
    }
    ty_free(set->mesh_trees);
    ty_free(list->keys);
    set->mesh_trees = trees;
    list->keys = keys;
}

static int find_tree(ty_light_set* set, tree_list* list, uint32_t object, uint32_t instance)
{
    const ty_scene_object* o = &set->scene->objects[object];
    tree_key key = {ty_world_prototype(set->scene->world, object, instance), o->material, o->slot_materials};
    for (int i = set->mesh_tree_count - 1; i >= 0; --i)
        if (same_key(&list->keys[i], &key))
            return i;
    ty_light_tree* tree = tree_of(set->scene, object, instance);
    if (!tree)
        return -1;
    grow(set, list);
    set->mesh_trees[set->mesh_tree_count] = tree;
    list->keys[set->mesh_tree_count] = key;
    return set->mesh_tree_count++;
}

void ty_light_meshes_init(ty_light_set* set)
{
    const ty_scene* scene = set->scene;
    tree_list list = {0};
    size_t count = 0;
    set->first_mesh = TY_ALLOC(uint32_t, scene->object_count);
    for (int o = 0; o < scene->object_count; ++o)
    {
        bool emits = object_emits(scene, &scene->objects[o]);
        set->first_mesh[o] = emits ? (uint32_t)count : TY_NONE;
        count += emits ? scene->objects[o].instance_count : 0;
    }
    set->meshes = TY_ALLOC(ty_light_mesh, count);
    for (uint32_t o = 0; o < (uint32_t)scene->object_count; ++o)
        for (uint32_t i = 0; set->first_mesh[o] != TY_NONE && i < scene->objects[o].instance_count; ++i)
            set->meshes[set->mesh_count++] = (ty_light_mesh){o, i, find_tree(set, &list, o, i)};
    ty_free(list.keys);
}

void ty_light_meshes_term(ty_light_set* set)
{
    for (int i = 0; i < set->mesh_tree_count; ++i)
        ty_light_tree_destroy(set->mesh_trees[i]);
    ty_free(set->mesh_trees);
    ty_free(set->meshes);
    ty_free(set->first_mesh);
}

// --- as a whole ---

static bool is_similarity(const ty_affine* m)
{
    float x = ty_length_sqr(m->x), y = ty_length_sqr(m->y), z = ty_length_sqr(m->z),
          most = 1e-3f * ty_max(x, ty_max(y, z));
    return fabsf(x - y) < most && fabsf(y - z) < most && fabsf(ty_dot(m->x, m->y)) < most &&
           fabsf(ty_dot(m->y, m->z)) < most && fabsf(ty_dot(m->z, m->x)) < most;
}

// What this instance emits over what the tree was made from: attributes of instances may differ.
static float brightness(const ty_light_set* set, const ty_light_mesh* mesh)
{
    const ty_light_tree* tree = set->mesh_trees[mesh->tree];
    const ty_light_node* leaf = &tree->nodes[0];
    const ty_light_node* nodes = tree->nodes;
    while (!(leaf->child & TY_LIGHT_LEAF)) // down to a bright triangle
        leaf = leaf[1].energy >= nodes[leaf->child].energy ? leaf + 1 : &nodes[leaf->child];
    uint32_t triangle = leaf->child & ~TY_LIGHT_LEAF;
    float area, now = triangle_emission(
                    set->scene, (ty_hit){.object = mesh->object, .instance = mesh->instance, .triangle = triangle});
    (void)triangle_leaf(ty_world_mesh(set->scene->world, mesh->object, mesh->instance), triangle, &area);
    return now * area / leaf->energy;
}

bool ty_light_mesh_leaf(const ty_light_set* set, const ty_light_mesh* mesh, ty_light_node* out)
{
    const ty_world* world = set->scene->world;
    *out = (ty_light_node){.axis = {0.0f, 0.0f, 1.0f}, .cos_o = -1.0f};
    if (mesh->tree < 0)
        return true; // without energy
    const ty_light_node* root = &set->mesh_trees[mesh->tree]->nodes[0];
    ty_bounds box = {root->low, root->high}, swept = ty_bounds_empty();
    int steps = ty_world_is_moving(world, mesh->object) ? 9 : 1;
    for (int i = 0; i < steps; ++i)
    {
        ty_affine to_world = ty_world_to_world(world, mesh->object, mesh->instance, (float)i / 8.0f);
        swept = ty_bounds_union(swept, ty_bounds_map(&to_world, box));
    }
    ty_affine to_world = ty_world_to_world(world, mesh->object, mesh->instance, 0.0f);
    ty_affine to_local = ty_world_to_local(world, mesh->object, mesh->instance, 0.0f);
    float scale = ty_pow(fabsf(ty_affine_determinant(&to_world)), 2.0f / 3.0f);
    out->low = swept.low;
    out->high = swept.high;
    out->energy = root->energy * scale * brightness(set, mesh);
    bool flat = root->cos_o > 0.9999999f;
    if (steps > 1 || (!flat && !is_similarity(&to_world)))
        return true;
    out->mean = ty_mul(ty_normalize(ty_map_transpose(&to_local, root->mean)), ty_length(root->mean));
    out->axis = ty_normalize(ty_map_transpose(&to_local, root->axis));
    out->cos_o = root->cos_o;
    return true;
}

// --- sampling ---

// The point that gathers light, in the space of the instance's prototype.
static void to_prototype(const ty_light_set* set, const ty_light_mesh* mesh, const ty_light_point* at,
                         const ty_affine* to_world, ty_vec3* p, ty_vec3* n)
{
    ty_affine to_local = ty_world_to_local(set->scene->world, mesh->object, mesh->instance, at->time);
    *p = ty_map_point(&to_local, at->position);
    *n = ty_normalize(ty_map_transpose(to_world, at->normal));
}

static float area_of(const ty_light_set* set, const ty_light_mesh* mesh, const ty_affine* to_world, uint32_t triangle)
{
    const ty_mesh* m = ty_world_mesh(set->scene->world, mesh->object, mesh->instance);
    const uint32_t* corner = m->triangles[triangle];
    ty_vec3 a = m->positions[corner[0]];
    ty_vec3 e1 = ty_map_vector(to_world, ty_sub(m->positions[corner[1]], a));
    ty_vec3 e2 = ty_map_vector(to_world, ty_sub(m->positions[corner[2]], a));
    return 0.5f * ty_length(ty_cross(e1, e2));
}

// What a path would find there: where the surface lets through it emits nothing.
static ty_rgb emitted(const ty_scene* scene, const ty_material* material, const ty_surface_point* point, ty_vec3 wi)
{
    ty_rgb emission = ty_material_emission_towards(material, &scene->shading, point, ty_neg(wi));
    if (!(ty_material_traits(material) & TY_TRAIT_TRANSPARENT))
        return emission;
    return ty_rgb_scale(emission, ty_material_transparency(material, &scene->shading, point, ty_neg(wi)).opacity);
}

bool ty_light_mesh_sample(const ty_light_set* set, const ty_light_mesh* mesh, const ty_light_point* at, double choice,
                          ty_vec2 u, ty_light_sample* out)
{
    const ty_scene* scene = set->scene;
    ty_affine to_world = ty_world_to_world(scene->world, mesh->object, mesh->instance, at->time);
    ty_vec3 p, n;
    to_prototype(set, mesh, at, &to_world, &p, &n);
    float probability;
    int triangle = ty_light_tree_sample(set->mesh_trees[mesh->tree], p, n, &choice, &probability);
    if (triangle < 0)
        return false;
    float root = sqrtf(u.x);
    ty_hit hit = {.object = mesh->object, .instance = mesh->instance, .triangle = (uint32_t)triangle, .time = at->time};
    ty_surface_point point = triangle_point(scene, hit, root * (1.0f - u.y), root * u.y);
    ty_vec3 d = ty_sub(point.position, at->position);
    float distance_sqr = ty_length_sqr(d);
    out->distance = sqrtf(distance_sqr);
    out->wi = ty_mul(d, 1.0f / out->distance);
    float cosine = -ty_dot(out->wi, point.ng);
    if (!(cosine > 0.0f) || !(out->distance > 0.0f))
        return false;
    const ty_material* material = ty_scene_material(scene, mesh->object, mesh->instance, hit.triangle);
    out->radiance = emitted(scene, material, &point, out->wi);
    out->pdf = probability * distance_sqr / (cosine * area_of(set, mesh, &to_world, hit.triangle));
    out->delta = false;
    out->solid = true;
    out->target = ty_offset_origin(&point, point.ng);
    return out->pdf > 0.0f && isfinite(out->pdf);
}

float ty_light_mesh_pdf(const ty_light_set* set, const ty_light_mesh* mesh, const ty_light_point* at,
                        const ty_surface_point* met, ty_vec3 wi)
{
    float cosine = -ty_dot(wi, met->ng);
    if (mesh->tree < 0 || !(cosine > 0.0f))
        return 0.0f;
    ty_affine to_world = ty_world_to_world(set->scene->world, mesh->object, mesh->instance, at->time);
    ty_vec3 p, n;
    to_prototype(set, mesh, at, &to_world, &p, &n);
    float probability = ty_light_tree_probability(set->mesh_trees[mesh->tree], p, n, (int)met->triangle);
    return probability * ty_length_sqr(ty_sub(met->position, at->position)) /
           (cosine * area_of(set, mesh, &to_world, met->triangle));
}
