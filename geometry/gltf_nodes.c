// SPDX-License-Identifier: Apache-2.0
// The nodes of a glTF file's scene: objects, cameras and lights where they stand.
#include "gltf_source.h"
#include "placement.h"
#include <string.h>

// Fields of cameras[] and KHR_lights_punctual.lights[] before a node places them.
typedef struct reader
{
    ty_gltf_scene* scene;
    const json_t *root, *nodes, *cameras, *lights;
    ty_affine* maps; // [node_count] to the file
    bool* shown;     // [node_count] below the scene's roots
    size_t node_count;
    ty_error* error;
} reader;

#define FAIL(r, ...) ty_error_set_at((r)->error, TY_BAD_FILE, (r)->scene->path, 0, 0, __VA_ARGS__)

// --- maps ---

static ty_affine local_map(const json_t* node)
{
    float m[16], t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    if (json_object_get(node, "matrix") && ty_gltf_read_floats_of(node, "matrix", 16, m))
        return (ty_affine){{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
    (void)ty_gltf_read_floats_of(node, "translation", 3, t); // checked
    (void)ty_gltf_read_floats_of(node, "rotation", 4, q);
    (void)ty_gltf_read_floats_of(node, "scale", 3, s);
    ty_placement p = {{t[0], t[1], t[2]}, {q[0], q[1], q[2], q[3]}, {s[0], s[1], s[2]}};
    return ty_placement_compose(&p);
}

// Breadth first from the given nodes; every node has one parent, so each comes once.
static void map_from(reader* r, size_t* queue, size_t count)
{
    for (size_t i = 0; i < count; i++)
    {
        const json_t* children = json_object_get(json_array_get(r->nodes, queue[i]), "children");
        for (size_t k = 0; k < json_array_size(children); k++)
        {
            size_t child = (size_t)json_integer_value(json_array_get(children, k));
            if (r->shown[child])
                continue;
            ty_affine own = local_map(json_array_get(r->nodes, child));
            r->maps[child] = ty_affine_multiply(&r->maps[queue[i]], &own);
            r->shown[child] = true;
            queue[count++] = child;
        }
    }
}

static void add_root(reader* r, size_t node, size_t* queue, size_t* count)
{
    if (r->shown[node])
        return;
    r->shown[node] = true;
    r->maps[node] = local_map(json_array_get(r->nodes, node));
    queue[(*count)++] = node;
}

// The scene's roots; all nodes without a parent where there are no scenes.
static ty_status map_nodes(reader* r)
{
    const json_t* scenes = json_object_get(r->root, "scenes");
    ty_arena* arena = r->scene->source->arena;
    size_t count = 0, *queue = TY_ARENA_ALLOC(arena, size_t, r->node_count);
    int64_t chosen;
    if (!ty_gltf_read_index(r->root, "scene", 0, INT32_MAX, &chosen) ||
        (json_array_size(scenes) > 0 && (size_t)chosen >= json_array_size(scenes)))
        return FAIL(r, "\"scene\" is none of the %zu scenes", json_array_size(scenes));
    const json_t* roots = json_object_get(json_array_get(scenes, (size_t)chosen), "nodes");
    for (size_t i = 0; i < json_array_size(roots); i++)
    {
        const json_t* item = json_array_get(roots, i);
        if (!json_is_integer(item) || json_integer_value(item) < 0 || (size_t)json_integer_value(item) >= r->node_count)
            return FAIL(r, "scenes[%d].nodes[%zu] is no node", (int)chosen, i);
        add_root(r, (size_t)json_integer_value(item), queue, &count);
    }
    if (json_array_size(scenes) == 0)
    {
        bool* has_parent = TY_ARENA_ALLOC(arena, bool, r->node_count);
        for (size_t i = 0; i < r->node_count; i++)
        {
            const json_t* children = json_object_get(json_array_get(r->nodes, i), "children");
            for (size_t k = 0; k < json_array_size(children); k++)
                has_parent[json_integer_value(json_array_get(children, k))] = true;
        }
        for (size_t i = 0; i < r->node_count; i++)
            if (!has_parent[i])
                add_root(r, i, queue, &count);
    }
    map_from(r, queue, count);
    return TY_OK;
}

// --- objects ---

// Triangles there are none in a mesh of points and lines alone.
static bool has_triangles(const json_t* mesh)
{
    const json_t* primitives = json_object_get(mesh, "primitives");
    for (size_t i = 0; i < json_array_size(primitives); i++)
    {
        int64_t mode;
        if (ty_gltf_read_index(json_array_get(primitives, i), "mode", TY_GLTF_TRIANGLES, TY_GLTF_FAN, &mode) &&
            mode >= TY_GLTF_TRIANGLES)
            return true;
    }
    return false;
}

// The box that the accessors of POSITION claim.
static ty_bounds claimed_bounds(const reader* r, const json_t* mesh)
{
    ty_bounds bounds = ty_bounds_empty();
    const json_t* primitives = json_object_get(mesh, "primitives");
    for (size_t i = 0; i < json_array_size(primitives); i++)
    {
        const json_t* index = json_object_get(json_object_get(json_array_get(primitives, i), "attributes"), "POSITION");
        const json_t* accessor =
            json_array_get(json_object_get(r->root, "accessors"), (size_t)json_integer_value(index));
        float low[3], high[3];
        if (!index || !json_object_get(accessor, "min") || !json_object_get(accessor, "max") ||
            !ty_gltf_read_floats_of(accessor, "min", 3, low) || !ty_gltf_read_floats_of(accessor, "max", 3, high))
            continue;
        bounds = ty_bounds_add(bounds, ty_vec3_make(low[0], low[1], low[2]));
        bounds = ty_bounds_add(bounds, ty_vec3_make(high[0], high[1], high[2]));
    }
    return bounds;
}

static void add_bounds(const reader* r, const json_t* mesh, const ty_affine* map)
{
    ty_bounds b = claimed_bounds(r, mesh);
    for (int i = 0; i < 8 && b.low.x <= b.high.x; i++)
    {
        ty_vec3 corner = {i & 1 ? b.high.x : b.low.x, i & 2 ? b.high.y : b.low.y, i & 4 ? b.high.z : b.low.z};
        r->scene->bounds = ty_bounds_add(r->scene->bounds, ty_map_point(map, corner));
    }
}

static ty_status add_object(reader* r, size_t node, const json_t* object)
{
    ty_gltf_scene* scene = r->scene;
    const json_t* mesh_index = json_object_get(object, "mesh");
    if (!mesh_index)
        return TY_OK;
    const json_t* mesh = json_array_get(json_object_get(r->root, "meshes"), (size_t)json_integer_value(mesh_index));
    char name[128];
    ty_gltf_copy_name(object, name);
    if (!has_triangles(mesh))
    {
        ty_gltf_warn(scene, "nodes[%zu]: a mesh of points and lines is left out", node);
        return TY_OK;
    }
    if (!ty_placement_is_regular(&r->maps[node]))
    {
        ty_gltf_warn(scene, "nodes[%zu] '%s' is scaled to nothing and left out", node, name);
        return TY_OK;
    }
    ty_arena* arena = scene->source->arena;
    ty_gltf_object* out = &scene->objects[scene->object_count];
    out->name = ty_arena_string(arena, name[0] ? name : ty_arena_format(arena, "node%zu", node));
    scene->object_count++;
    out->mesh = (int)json_integer_value(mesh_index);
    out->node = (int)node;
    out->to_file = r->maps[node];
    out->is_instanced = ty_gltf_extension(object, TY_GLTF_INSTANCING) != NULL;
    if (!out->is_instanced)
        add_bounds(r, mesh, &out->to_file);
    return TY_OK;
}

// --- cameras and lights ---

static ty_status add_camera(reader* r, size_t node, const json_t* object)
{
    int64_t index;
    if (!json_object_get(object, "camera"))
        return TY_OK;
    size_t count = json_array_size(r->cameras);
    if (count == 0 || !ty_gltf_read_index(object, "camera", -2, count - 1, &index))
        return FAIL(r, "nodes[%zu].camera is none of the %zu cameras", node, count);
    const json_t* camera = json_array_get(r->cameras, (size_t)index);
    const char* type = json_string_value(json_object_get(camera, "type"));
    ty_gltf_camera* out = &r->scene->cameras[r->scene->camera_count];
    float ymag = 0.0f;
    char name[128];
    out->is_orthographic = type && strcmp(type, "orthographic") == 0;
    const json_t* lens = json_object_get(camera, out->is_orthographic ? "orthographic" : "perspective");
    bool good = ty_gltf_read_float(lens, "yfov", 1e-3f, TY_PI - 1e-3f, &out->yfov) &&
                ty_gltf_read_float(lens, "aspectRatio", 1e-3f, 1e3f, &out->aspect) &&
                ty_gltf_read_float(lens, "ymag", 1e-9f, 1e9f, &ymag);
    if (!good || !(out->is_orthographic ? ymag > 0.0f : out->yfov > 0.0f))
        return FAIL(r, "cameras[%d]: its yfov, ymag or aspectRatio is missing or out of range", (int)index);
    out->height = 2.0f * ymag;
    out->to_file = r->maps[node];
    ty_gltf_copy_name(json_object_get(object, "name") ? object : camera, name);
    ty_arena* arena = r->scene->source->arena;
    out->name = ty_arena_string(arena, name[0] ? name : ty_arena_format(arena, "camera%d", (int)index));
    r->scene->camera_count++;
    return TY_OK;
}

static ty_status read_light_kind(const reader* r, const json_t* light, int index, ty_gltf_light* out)
{
    static const char* const kinds[] = {"point", "spot", "directional"};
    const char* type = json_string_value(json_object_get(light, "type"));
    int kind = 0;
    while (kind < 3 && !(type && strcmp(type, kinds[kind]) == 0))
        kind++;
    if (kind == 3)
        return FAIL(r, "lights[%d].type is none of point, spot, directional", index);
    out->kind = (ty_gltf_light_kind)kind;
    return TY_OK;
}

static ty_status add_light(reader* r, size_t node, const json_t* object)
{
    const json_t* extension = ty_gltf_extension(object, "KHR_lights_punctual");
    int64_t index;
    if (!extension)
        return TY_OK;
    size_t count = json_array_size(r->lights);
    if (count == 0 || !ty_gltf_read_index(extension, "light", -2, count - 1, &index))
        return FAIL(r, "nodes[%zu]: its light is none of the %zu lights", node, count);
    const json_t *light = json_array_get(r->lights, (size_t)index), *spot = json_object_get(light, "spot");
    ty_gltf_light* out = &r->scene->lights[r->scene->light_count];
    *out = (ty_gltf_light){.color = {1, 1, 1}, .intensity = 1.0f, .outer = TY_PI / 4.0f};
    ty_status status = read_light_kind(r, light, (int)index, out);
    bool good = ty_gltf_read_floats_of(light, "color", 3, out->color) &&
                ty_gltf_read_float(light, "intensity", 0.0f, 1e12f, &out->intensity) &&
                ty_gltf_read_float(spot, "innerConeAngle", 0.0f, TY_PI / 2.0f, &out->inner) &&
                ty_gltf_read_float(spot, "outerConeAngle", 0.0f, TY_PI / 2.0f + 1e-6f, &out->outer);
    if (status == TY_OK && !good)
        status = FAIL(r, "lights[%d]: a number is out of range", (int)index);
    char name[128];
    out->to_file = r->maps[node];
    ty_gltf_copy_name(json_object_get(object, "name") ? object : light, name);
    ty_arena* arena = r->scene->source->arena;
    out->name = ty_arena_string(arena, name[0] ? name : ty_arena_format(arena, "light%d", (int)index));
    r->scene->light_count++;
    return status;
}

// --- all ---

static void name_meshes(const reader* r)
{
    const json_t* meshes = json_object_get(r->root, "meshes");
    ty_gltf_scene* scene = r->scene;
    ty_arena* arena = scene->source->arena;
    scene->mesh_count = (int)json_array_size(meshes);
    scene->mesh_names = TY_ARENA_ALLOC(arena, const char*, scene->mesh_count);
    scene->meshes = TY_ARENA_ALLOC(arena, ty_mesh*, scene->mesh_count);
    for (int i = 0; i < scene->mesh_count; i++)
    {
        char name[128];
        ty_gltf_copy_name(json_array_get(meshes, (size_t)i), name);
        const json_t* primitives = json_object_get(json_array_get(meshes, (size_t)i), "primitives");
        for (size_t k = 0; k < json_array_size(primitives); k++)
            scene->has_colors |=
                json_object_get(json_object_get(json_array_get(primitives, k), "attributes"), "COLOR_0") != NULL;
        scene->mesh_names[i] = ty_arena_string(arena, name[0] ? name : ty_arena_format(arena, "mesh%d", i));
    }
}

ty_status ty_gltf_read_nodes(ty_gltf_scene* scene, ty_error* error)
{
    const json_t* root = scene->source->root;
    ty_arena* arena = scene->source->arena;
    reader r = {.scene = scene, .root = root, .error = error};
    r.nodes = json_object_get(root, "nodes");
    r.cameras = json_object_get(root, "cameras");
    r.lights = json_object_get(ty_gltf_extension(root, "KHR_lights_punctual"), "lights");
    r.node_count = json_array_size(r.nodes);
    r.maps = TY_ARENA_ALLOC(arena, ty_affine, r.node_count);
    r.shown = TY_ARENA_ALLOC(arena, bool, r.node_count);
    scene->objects = TY_ARENA_ALLOC(arena, ty_gltf_object, r.node_count);
    scene->cameras = TY_ARENA_ALLOC(arena, ty_gltf_camera, r.node_count);
    scene->lights = TY_ARENA_ALLOC(arena, ty_gltf_light, r.node_count);
    scene->bounds = ty_bounds_empty();
    name_meshes(&r);
    ty_status status = map_nodes(&r);
    for (size_t i = 0; i < r.node_count && status == TY_OK; i++)
    {
        const json_t* node = json_array_get(r.nodes, i);
        if (!r.shown[i])
            continue;
        status = add_object(&r, i, node);
        if (status == TY_OK)
            status = add_camera(&r, i, node);
        if (status == TY_OK)
            status = add_light(&r, i, node);
    }
    return status;
}
