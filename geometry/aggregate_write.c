// SPDX-License-Identifier: Apache-2.0
// Aggregate files: GLB with one mesh and one instanced node a prototype.
#include "aggregate_write.h"
#include "glb_mesh.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>
#include <tsuya/geometry/aggregate.h>

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
    static const char* const reserved[] = {"id", "order", "matrix0", "matrix1", "matrix2", "velocity", "spin", NULL};
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

ty_status ty_aggregate_check_content(const ty_aggregate* a, const char* path, ty_error* error)
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
        if ((a->velocities && !ty_is_finite3(a->velocities[i])) || (a->spins && !ty_is_finite3(a->spins[i])))
            return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "instance %u: its velocity is not finite", i);
    }
    ty_status status = check_attributes(a, path, error);
    return status == TY_OK ? check_prototypes(a, path, error) : status;
}

// --- instances ---

const ty_instance_attribute* ty_aggregate_attribute_by_name(const ty_aggregate* a, int k)
{
    const ty_instance_attribute* found = NULL;
    for (int i = 0; i < a->attribute_count; i++)
    {
        int before = 0;
        for (int j = 0; j < a->attribute_count; j++)
            before += strcmp(a->attributes[j].name, a->attributes[i].name) < 0;
        if (before == k)
            found = &a->attributes[i];
    }
    TY_ASSERT(found); // no name stands twice
    return found;
}

ty_status ty_aggregate_split(const ty_aggregate* a, const char* path, const char* holder, ty_placement** out,
                             ty_error* error)
{
    uint32_t sheared = 0;
    *out = TY_TRY_ALLOC(ty_placement, a->instance_count);
    if (!*out)
        return ty_error_set_at(error, TY_NO_MEMORY, path, 0, 0, "no memory for %u instances", a->instance_count);
    for (uint32_t i = 0; i < a->instance_count; i++)
        sheared += !ty_placement_split(&a->transforms[i], &(*out)[i]);
    if (sheared > 0)
        ty_log(TY_LOG_WARNING, "%s: %u of %u instances are sheared, which %s cannot hold", path, sheared,
               a->instance_count, holder);
    return TY_OK;
}

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
        ty_glb_set_semantic(attributes, names[column], ty_glb_add(builder, v, g->count, TY_GLTF_FLOAT, 3, 0));
    }
}

static void add_vectors(ty_glb_builder* builder, const group* g, const char* name, const ty_vec3* values,
                        json_t* attributes)
{
    ty_vec3* v = (ty_vec3*)g->values;
    for (uint32_t i = 0; i < g->count; i++)
        v[i] = values[g->members[i]];
    ty_glb_set_semantic(attributes, name, ty_glb_add(builder, v, g->count, TY_GLTF_FLOAT, 3, 0));
}

static void add_scalars(ty_glb_builder* builder, const group* g, bool ordered, json_t* attributes)
{
    const ty_aggregate* a = g->aggregate;
    uint32_t* ids = (uint32_t*)g->values;
    for (uint32_t i = 0; i < g->count; i++)
        ids[i] = a->ids[g->members[i]];
    ty_glb_set_semantic(attributes, "id", ty_glb_add_integers(builder, ids, g->count));
    if (!ordered)
        ty_glb_set_semantic(attributes, "order", ty_glb_add_integers(builder, g->members, g->count));
    for (int k = 0; k < a->attribute_count; k++)
    {
        const ty_instance_attribute* attribute =
            ty_aggregate_attribute_by_name(a, k); // the order in which they are read
        for (uint32_t i = 0; i < g->count; i++)
            g->values[i] = attribute->values[g->members[i]];
        ty_glb_set_semantic(attributes, attribute->name, ty_glb_add(builder, g->values, g->count, TY_GLTF_FLOAT, 1, 0));
    }
}

static json_t* add_node(ty_glb_builder* builder, const group* g, uint32_t prototype, bool ordered)
{
    json_t* attributes = json_object();
    add_placements(builder, g, attributes);
    if (g->sheared)
        add_matrices(builder, g, attributes);
    if (g->aggregate->velocities)
        add_vectors(builder, g, "velocity", g->aggregate->velocities, attributes);
    if (g->aggregate->spins)
        add_vectors(builder, g, "spin", g->aggregate->spins, attributes);
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

static void add_state(ty_glb_builder* builder, const ty_aggregate* a, json_t* root)
{
    int view = ty_glb_add_bytes(builder, a->state.data, a->state.size);
    json_array_append_new(json_object_get(root, "extensionsUsed"), json_string(TY_GLTF_STATE));
    json_object_set_new(root, "extensions", json_pack("{s:{s:i}}", TY_GLTF_STATE, "bufferView", view));
}

ty_status ty_aggregate_write(const char* path, const ty_aggregate* aggregate, ty_error* error)
{
    ty_status status = ty_aggregate_check_content(aggregate, path, error);
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
        {
            char name[32];
            snprintf(name, sizeof name, "prototype_%d", p);
            json_array_append_new(meshes, ty_glb_mesh_json(&builder, aggregate->prototypes[p], name, materials));
        }
        json_object_set_new(root, "meshes", meshes);
        if (json_array_size(materials) > 0)
            json_object_set(root, "materials", materials);
        json_decref(materials);
        add_nodes(&builder, aggregate, root);
        if (aggregate->state.size > 0)
            add_state(&builder, aggregate, root);
        status = ty_glb_write(&builder, root, path, error);
        ty_glb_builder_term(&builder);
    }
    json_decref(root);
    return status;
}
