// SPDX-License-Identifier: Apache-2.0
// Aggregate files: GLB with one mesh and one instanced node a prototype.
#include "glb_build.h"
#include "placement.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/geometry/aggregate.h>

enum
{
    VERTICES = 34962,
    INDICES = 34963
};

// --- what may be written ---

// Lower case, digits and underscores, and not a name that the file uses itself.
static bool name_is_free(const char* name, const char* const* reserved)
{
    size_t length = strlen(name);
    if (length == 0 || length > 31 || strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789_") != length)
        return false;
    for (; *reserved; reserved++)
        if (strcmp(name, *reserved) == 0)
            return false;
    return true;
}

static ty_status check_attributes(const ty_aggregate* a, const char* path, ty_error* error)
{
    static const char* const reserved[] = {"id", "order", "matrix0", "matrix1", "matrix2", NULL};
    if (a->attribute_count > TY_GLTF_ATTRIBUTES_MAX)
        return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "%d attributes; at most %d are written",
                               a->attribute_count, TY_GLTF_ATTRIBUTES_MAX);
    for (int k = 0; k < a->attribute_count; k++)
    {
        const ty_instance_attribute* attribute = &a->attributes[k];
        if (!name_is_free(attribute->name, reserved))
            return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "\"%s\" cannot name an attribute of a file",
                                   attribute->name);
        for (uint32_t i = 0; i < a->instance_count; i++)
            if (!isfinite(attribute->values[i]))
                return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "instance %u: %s is not finite", i,
                                       attribute->name);
    }
    return TY_OK;
}

static ty_status check_prototypes(const ty_aggregate* a, const char* path, ty_error* error)
{
    static const char* const reserved[] = {"curvature", "direction", NULL};
    for (int p = 0; p < a->prototype_count; p++)
    {
        if (!a->prototypes[p])
            return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "prototype %d is missing", p);
        ty_error fault;
        if (ty_mesh_validate(a->prototypes[p], path, &fault) != TY_OK)
            return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "prototype %d: %.900s", p, fault.text);
        for (int k = 0; k < a->prototypes[p]->attribute_count; k++)
            if (!name_is_free(a->prototypes[p]->attributes[k].name, reserved))
                return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "prototype %d: \"%s\" cannot name an attribute",
                                       p, a->prototypes[p]->attributes[k].name);
    }
    return TY_OK;
}

static ty_status check_aggregate(const ty_aggregate* a, const char* path, ty_error* error)
{
    if (a->instance_count == 0 || a->prototype_count <= 0)
        return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "an aggregate without instances is not written");
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        if (a->prototype_index[i] >= (uint32_t)a->prototype_count)
            return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "instance %u: prototype %u of %d", i,
                                   a->prototype_index[i], a->prototype_count);
        if (!ty_placement_is_regular(&a->transforms[i]))
            return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "instance %u: its matrix is singular or not finite",
                                   i);
    }
    ty_status status = check_attributes(a, path, error);
    return status == TY_OK ? check_prototypes(a, path, error) : status;
}

// --- meshes ---

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
static void set_semantic(json_t* attributes, const char* name, int accessor)
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
        set_semantic(attributes, "curvature", ty_glb_add(builder, both, n, TY_GLTF_FLOAT, 2, VERTICES));
        ty_free(both);
    }
    if (mesh->direction_1)
        set_semantic(attributes, "direction", ty_glb_add(builder, mesh->direction_1, n, TY_GLTF_FLOAT, 3, VERTICES));
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

static json_t* add_mesh(ty_glb_builder* builder, const ty_mesh* mesh, int index, json_t* materials)
{
    uint32_t n = mesh->vertex_count;
    int position = ty_glb_add(builder, mesh->positions, n, TY_GLTF_FLOAT, 3, VERTICES);
    add_range(builder, position, mesh);
    json_t* attributes = json_pack("{s:i}", "POSITION", position);
    int normal = ty_glb_add(builder, mesh->normals, n, TY_GLTF_FLOAT, 3, VERTICES);
    json_object_set_new(attributes, "NORMAL", json_integer(normal));
    if (mesh->uvs)
        json_object_set_new(attributes, "TEXCOORD_0",
                            json_integer(ty_glb_add(builder, mesh->uvs, n, TY_GLTF_FLOAT, 2, VERTICES)));
    add_curvature(builder, attributes, mesh);
    for (int i = 0; i < mesh->attribute_count; i++)
    {
        const ty_mesh_attribute* a = &mesh->attributes[i];
        set_semantic(attributes, a->name, ty_glb_add(builder, a->values, n, TY_GLTF_FLOAT, a->components, VERTICES));
    }
    int indices =
        ty_glb_add(builder, mesh->triangles, 3 * (size_t)mesh->triangle_count, TY_GLTF_UNSIGNED_INT, 1, INDICES);
    char name[32];
    snprintf(name, sizeof name, "prototype_%d", index);
    json_t* primitive = json_pack("{s:o, s:i, s:i}", "attributes", attributes, "indices", indices, "mode", 4);
    if (mesh->slot_count == 1 && mesh->slot_names[0][0])
        json_object_set_new(primitive, "material", json_integer(find_material(materials, mesh->slot_names[0])));
    return json_pack("{s:s, s:[o]}", "name", name, "primitives", primitive);
}

// --- instances ---

// The instances of one prototype in order, and scratch for their columns.
typedef struct group
{
    const ty_aggregate* aggregate;
    uint32_t* members;
    uint32_t count;
    ty_placement* placements;
    float* values; // [count][4]
    bool sheared;
} group;

static void gather_group(group* g, uint32_t prototype)
{
    g->count = 0;
    g->sheared = false;
    for (uint32_t i = 0; i < g->aggregate->instance_count; i++)
        if (g->aggregate->prototype_index[i] == prototype)
        {
            if (!ty_placement_split(&g->aggregate->transforms[i], &g->placements[g->count]))
                g->sheared = true;
            g->members[g->count++] = i;
        }
}

static void add_placements(ty_glb_builder* builder, const group* g, json_t* attributes)
{
    ty_vec3* v = (ty_vec3*)g->values;
    for (uint32_t i = 0; i < g->count; i++)
        v[i] = g->placements[i].translation;
    json_object_set_new(attributes, "TRANSLATION", json_integer(ty_glb_add(builder, v, g->count, TY_GLTF_FLOAT, 3, 0)));
    ty_quat* q = (ty_quat*)g->values;
    for (uint32_t i = 0; i < g->count; i++)
        q[i] = g->placements[i].rotation;
    json_object_set_new(attributes, "ROTATION", json_integer(ty_glb_add(builder, q, g->count, TY_GLTF_FLOAT, 4, 0)));
    for (uint32_t i = 0; i < g->count; i++)
        v[i] = g->placements[i].scale;
    json_object_set_new(attributes, "SCALE", json_integer(ty_glb_add(builder, v, g->count, TY_GLTF_FLOAT, 3, 0)));
}

static void add_matrices(ty_glb_builder* builder, const group* g, json_t* attributes)
{
    static const char* const names[3] = {"matrix0", "matrix1", "matrix2"};
    ty_vec3* v = (ty_vec3*)g->values;
    for (int column = 0; column < 3; column++)
    {
        for (uint32_t i = 0; i < g->count; i++)
        {
            const ty_affine* m = &g->aggregate->transforms[g->members[i]];
            v[i] = column == 0 ? m->x : column == 1 ? m->y : m->z;
        }
        set_semantic(attributes, names[column], ty_glb_add(builder, v, g->count, TY_GLTF_FLOAT, 3, 0));
    }
}

static void add_scalars(ty_glb_builder* builder, const group* g, bool ordered, json_t* attributes)
{
    const ty_aggregate* a = g->aggregate;
    uint32_t* ids = (uint32_t*)g->values;
    for (uint32_t i = 0; i < g->count; i++)
        ids[i] = a->ids[g->members[i]];
    set_semantic(attributes, "id", ty_glb_add_integers(builder, ids, g->count));
    if (!ordered)
        set_semantic(attributes, "order", ty_glb_add_integers(builder, g->members, g->count));
    for (int k = 0; k < a->attribute_count; k++)
    {
        for (uint32_t i = 0; i < g->count; i++)
            g->values[i] = a->attributes[k].values[g->members[i]];
        set_semantic(attributes, a->attributes[k].name, ty_glb_add(builder, g->values, g->count, TY_GLTF_FLOAT, 1, 0));
    }
}

static json_t* add_node(ty_glb_builder* builder, const group* g, uint32_t prototype, bool ordered)
{
    json_t* attributes = json_object();
    add_placements(builder, g, attributes);
    if (g->sheared)
        add_matrices(builder, g, attributes);
    add_scalars(builder, g, ordered, attributes);
    return json_pack("{s:i, s:{s:{s:o}}}", "mesh", (int)prototype, "extensions", TY_GLTF_INSTANCING, "attributes",
                     attributes);
}

// Whether all instances of one prototype stand before those of the next, so that the nodes' order tells theirs.
static bool order_is_grouped(const ty_aggregate* a)
{
    for (uint32_t i = 1; i < a->instance_count; i++)
        if (a->prototype_index[i] < a->prototype_index[i - 1])
            return false;
    return true;
}

static void add_nodes(ty_glb_builder* builder, const ty_aggregate* a, json_t* root)
{
    group g = {.aggregate = a,
               .members = TY_ALLOC(uint32_t, a->instance_count),
               .placements = TY_ALLOC(ty_placement, a->instance_count),
               .values = TY_ALLOC(float, 4 * (size_t)a->instance_count)};
    bool ordered = order_is_grouped(a);
    json_t *nodes = json_array(), *roots = json_array();
    for (int p = 0; p < a->prototype_count; p++)
    {
        gather_group(&g, (uint32_t)p);
        if (g.count == 0)
            continue;
        json_array_append_new(roots, json_integer((json_int_t)json_array_size(nodes)));
        json_array_append_new(nodes, add_node(builder, &g, (uint32_t)p, ordered));
    }
    json_object_set_new(root, "nodes", nodes);
    json_object_set_new(root, "scenes", json_pack("[{s:o}]", "nodes", roots));
    json_object_set_new(root, "scene", json_integer(0));
    ty_free(g.members);
    ty_free(g.placements);
    ty_free(g.values);
}

// --- what it was made from ---

static ty_status make_extras(const ty_aggregate* a, const char* path, json_t** out, ty_error* error)
{
    json_t* own = json_object();
    *out = json_pack("{s:o}", "tsuya", own);
    const char* texts[2][2] = {{"recipe", a->recipe}, {"hash", a->hash}};
    for (int i = 0; i < 2; i++)
        if (texts[i][1] && json_object_set_new(own, texts[i][0], json_string(texts[i][1])) != 0)
            return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "the %s is not UTF-8", texts[i][0]);
    if (!a->metrics)
        return TY_OK;
    json_error_t where;
    json_t* metrics = json_loads(a->metrics, JSON_REJECT_DUPLICATES, &where);
    if (!json_is_object(metrics))
    {
        json_decref(metrics);
        return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "the metrics are not a JSON object");
    }
    json_object_set_new(own, "metrics", metrics);
    return TY_OK;
}

ty_status ty_aggregate_write(const char* path, const ty_aggregate* aggregate, ty_error* error)
{
    ty_status status = check_aggregate(aggregate, path, error);
    if (status != TY_OK)
        return status;
    json_t* extras = NULL;
    status = make_extras(aggregate, path, &extras, error);
    json_t* root =
        json_pack("{s:{s:s, s:s, s:o}, s:[s], s:[s]}", "asset", "version", "2.0", "generator", "tsuya", "extras",
                  extras, "extensionsUsed", TY_GLTF_INSTANCING, "extensionsRequired", TY_GLTF_INSTANCING);
    if (status == TY_OK)
    {
        ty_glb_builder builder;
        ty_glb_builder_init(&builder);
        json_t *meshes = json_array(), *materials = json_array();
        for (int p = 0; p < aggregate->prototype_count; p++)
            json_array_append_new(meshes, add_mesh(&builder, aggregate->prototypes[p], p, materials));
        json_object_set_new(root, "meshes", meshes);
        if (json_array_size(materials) > 0)
            json_object_set(root, "materials", materials);
        json_decref(materials);
        add_nodes(&builder, aggregate, root);
        status = ty_glb_write(&builder, root, path, error);
        ty_glb_builder_term(&builder);
    }
    json_decref(root);
    return status;
}
