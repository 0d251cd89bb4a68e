// SPDX-License-Identifier: Apache-2.0
// Meshes into a GLB file.
#include "glb_mesh.h"
#include <string.h>
#include <tsuya/geometry/aggregate_export.h>

enum
{
    VERTICES = 34962,
    INDICES = 34963
};

static json_t* list3(ty_vec3 v)
{
    return json_pack("[f, f, f]", (double)v.x, (double)v.y, (double)v.z);
}

static void add_range(ty_glb_builder* builder, int accessor, const ty_mesh* mesh)
{
    ty_bounds box = ty_bounds_empty();
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        box = ty_bounds_add(box, mesh->positions[i]);
    json_t* object = json_array_get(builder->accessors, (size_t)accessor);
    json_object_set_new(object, "min", list3(box.low));
    json_object_set_new(object, "max", list3(box.high));
}

// "_" and the name in upper case.
void ty_glb_set_semantic(json_t* attributes, const char* name, int accessor)
{
    char semantic[40] = "_";
    size_t n = 1;
    for (; *name && n < sizeof semantic - 1; name++, n++)
        semantic[n] = (char)(*name >= 'a' && *name <= 'z' ? *name - 'a' + 'A' : *name);
    semantic[n] = '\0';
    json_object_set_new(attributes, semantic, json_integer(accessor));
}

static void add_curvature(ty_glb_builder* builder, json_t* attributes, const ty_mesh* mesh)
{
    uint32_t n = mesh->vertex_count;
    if (mesh->curvature_1 && mesh->curvature_2)
    {
        ty_vec2* both = TY_ALLOC(ty_vec2, n);
        for (uint32_t i = 0; i < n; i++)
            both[i] = (ty_vec2){mesh->curvature_1[i], mesh->curvature_2[i]};
        ty_glb_set_semantic(attributes, "curvature", ty_glb_add(builder, both, n, TY_GLTF_FLOAT, 2, VERTICES));
        ty_free(both);
    }
    if (mesh->direction_1)
        ty_glb_set_semantic(attributes, "direction",
                            ty_glb_add(builder, mesh->direction_1, n, TY_GLTF_FLOAT, 3, VERTICES));
}

// Images of the format begin at the top.
static int add_uvs(ty_glb_builder* builder, const ty_mesh* mesh)
{
    ty_vec2* uvs = TY_ALLOC(ty_vec2, mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        uvs[i] = (ty_vec2){mesh->uvs[i].x, 1.0f - mesh->uvs[i].y};
    int accessor = ty_glb_add(builder, uvs, mesh->vertex_count, TY_GLTF_FLOAT, 2, VERTICES);
    ty_free(uvs);
    return accessor;
}

// The number of a material of that name, added when there is none.
static int find_material(json_t* materials, const char* name)
{
    int count = (int)json_array_size(materials);
    for (int i = 0; i < count; i++)
        if (strcmp(json_string_value(json_object_get(json_array_get(materials, (size_t)i), "name")), name) == 0)
            return i;
    json_array_append_new(materials, json_pack("{s:s}", "name", name));
    return count;
}

// What the format takes as colours of vertices: linear, of Rec.709.
static bool is_color(const ty_mesh_attribute* a)
{
    return strcmp(a->name, "color") == 0 && a->components >= 3 && a->space == TY_ATTRIBUTE_LINEAR_SRGB;
}

// What the primitives of a mesh share.
static json_t* add_vertices(ty_glb_builder* builder, const ty_mesh* mesh)
{
    uint32_t n = mesh->vertex_count;
    int position = ty_glb_add(builder, mesh->positions, n, TY_GLTF_FLOAT, 3, VERTICES);
    add_range(builder, position, mesh);
    json_t* attributes = json_pack("{s:i}", "POSITION", position);
    int normal = ty_glb_add(builder, mesh->normals, n, TY_GLTF_FLOAT, 3, VERTICES);
    json_object_set_new(attributes, "NORMAL", json_integer(normal));
    if (mesh->uvs)
        json_object_set_new(attributes, "TEXCOORD_0", json_integer(add_uvs(builder, mesh)));
    add_curvature(builder, attributes, mesh);
    for (int i = 0; i < mesh->attribute_count; i++)
    {
        const ty_mesh_attribute* a = &mesh->attributes[i];
        int values = ty_glb_add(builder, a->values, n, TY_GLTF_FLOAT, a->components, VERTICES);
        if (is_color(a))
            json_object_set_new(attributes, "COLOR_0", json_integer(values));
        else
            ty_glb_set_semantic(attributes, a->name, values);
    }
    return attributes;
}

static int add_triangles(ty_glb_builder* builder, const ty_mesh* mesh, int slot)
{
    uint32_t(*chosen)[3] = ty_alloc(mesh->triangle_count, sizeof *chosen);
    size_t count = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        if (!mesh->slots || mesh->slots[t] == slot)
            memcpy(chosen[count++], mesh->triangles[t], sizeof *chosen);
    int accessor = count > 0 ? ty_glb_add(builder, chosen, 3 * count, TY_GLTF_UNSIGNED_INT, 1, INDICES) : -1;
    ty_free(chosen);
    return accessor;
}

json_t* ty_glb_mesh_json(ty_glb_builder* builder, const ty_mesh* mesh, const char* name, json_t* materials)
{
    json_t *attributes = add_vertices(builder, mesh), *primitives = json_array();
    for (int s = 0; s < (mesh->slots ? mesh->slot_count : 1); s++)
    {
        int indices = add_triangles(builder, mesh, s);
        if (indices < 0) // a material of no triangle
            continue;
        json_t* primitive = json_pack("{s:O, s:i, s:i}", "attributes", attributes, "indices", indices, "mode", 4);
        if (s < mesh->slot_count && mesh->slot_names[s][0])
            json_object_set_new(primitive, "material", json_integer(find_material(materials, mesh->slot_names[s])));
        json_array_append_new(primitives, primitive);
    }
    json_decref(attributes);
    return json_pack("{s:s, s:o}", "name", name, "primitives", primitives);
}

ty_status ty_glb_write_mesh(const char* path, const ty_mesh* mesh, ty_error* error)
{
    json_t* own = json_object();
    json_t* root =
        json_pack("{s:{s:s, s:s, s:{s:o}}, s:[{s:i}], s:[{s:[i]}], s:i}", "asset", "version", "2.0", "generator",
                  "tsuya", "extras", "tsuya", own, "nodes", "mesh", 0, "scenes", "nodes", 0, "scene", 0);
    if (mesh->recipe)
        json_object_set_new(own, "recipe", json_string(mesh->recipe));
    if (mesh->hash)
        json_object_set_new(own, "hash", json_string(mesh->hash));
    ty_glb_builder builder;
    ty_glb_builder_init(&builder);
    json_t* materials = json_array();
    json_object_set_new(root, "meshes", json_pack("[o]", ty_glb_mesh_json(&builder, mesh, "mesh", materials)));
    if (json_array_size(materials) > 0)
        json_object_set(root, "materials", materials);
    json_decref(materials);
    ty_status status = ty_glb_write(&builder, root, path, error);
    ty_glb_builder_term(&builder);
    json_decref(root);
    return status;
}
