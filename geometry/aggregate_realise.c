// SPDX-License-Identifier: Apache-2.0
// All instances of an aggregate as one mesh.
#include "aggregate_write.h"
#include <string.h>
#include <tsuya/geometry/aggregate_export.h>

// What every prototype has, so that the mesh can.
typedef struct shared
{
    bool uvs, curvature, directions, slots;
} shared;

static shared find_shared(const ty_aggregate* a)
{
    shared s = {true, true, true, false};
    for (int p = 0; p < a->prototype_count; p++)
    {
        const ty_mesh* mesh = a->prototypes[p];
        s.uvs = s.uvs && mesh->uvs;
        s.curvature = s.curvature && mesh->curvature_1 && mesh->curvature_2;
        s.directions = s.directions && mesh->direction_1;
        s.slots = s.slots || mesh->slot_count > 0;
    }
    s.directions = s.directions && s.curvature;
    return s;
}

// NULL where a prototype lacks it, or has another number of components.
static const ty_mesh_attribute* common_attribute(const ty_aggregate* a, int index)
{
    const ty_mesh_attribute* first = &a->prototypes[0]->attributes[index];
    for (int p = 1; p < a->prototype_count; p++)
    {
        const ty_mesh_attribute* other = ty_mesh_find_attribute(a->prototypes[p], first->name);
        if (!other || other->components != first->components || other->space != first->space)
            return NULL;
    }
    return first;
}

// *out may hold a part after a failure: for destroy.
static ty_status create(const ty_aggregate* a, shared s, ty_mesh** out, ty_error* error)
{
    uint64_t vertices = 0, triangles = 0;
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        vertices += a->prototypes[a->prototype_index[i]]->vertex_count;
        triangles += a->prototypes[a->prototype_index[i]]->triangle_count;
    }
    if (vertices >= UINT32_MAX || triangles >= UINT32_MAX)
        return ty_error_set(error, TY_BAD_INPUT,
                            "realised, %u instances have %llu vertices and %llu triangles; a mesh has less than 2^32",
                            a->instance_count, (unsigned long long)vertices, (unsigned long long)triangles);
    ty_mesh* mesh = ty_mesh_create((uint32_t)vertices, (uint32_t)triangles);
    bool whole = mesh != NULL;
    if (whole && s.uvs)
        whole = (mesh->uvs = TY_TRY_ALLOC(ty_vec2, vertices)) != NULL;
    if (whole && s.curvature)
        whole = (mesh->curvature_1 = TY_TRY_ALLOC(float, vertices)) != NULL &&
                (mesh->curvature_2 = TY_TRY_ALLOC(float, vertices)) != NULL;
    if (whole && s.directions)
        whole = (mesh->direction_1 = TY_TRY_ALLOC(ty_vec3, vertices)) != NULL;
    if (whole && s.slots)
        whole = (mesh->slots = TY_TRY_ALLOC(uint16_t, triangles)) != NULL;
    *out = mesh;
    if (whole)
        return TY_OK;
    return ty_error_set(error, TY_NO_MEMORY, "no memory for %llu vertices and %llu triangles",
                        (unsigned long long)vertices, (unsigned long long)triangles);
}

static void copy_surface(ty_mesh* out, const ty_mesh* part, uint32_t vertex)
{
    size_t n = part->vertex_count;
    memcpy(out->positions + vertex, part->positions, n * sizeof(ty_vec3));
    memcpy(out->normals + vertex, part->normals, n * sizeof(ty_vec3));
    if (out->uvs)
        memcpy(out->uvs + vertex, part->uvs, n * sizeof(ty_vec2));
    if (out->curvature_1)
    {
        memcpy(out->curvature_1 + vertex, part->curvature_1, n * sizeof(float));
        memcpy(out->curvature_2 + vertex, part->curvature_2, n * sizeof(float));
    }
    if (out->direction_1)
        memcpy(out->direction_1 + vertex, part->direction_1, n * sizeof(ty_vec3));
}

static ty_status copy_triangles(ty_mesh* out, const ty_mesh* part, uint32_t vertex, uint32_t triangle, ty_error* error)
{
    uint16_t numbers[TY_MESH_MAX_SLOTS] = {0};
    for (int k = 0; out->slots && k < (part->slot_count > 0 ? part->slot_count : 1); k++)
    {
        int slot = ty_mesh_add_slot(out, part->slot_count > 0 ? part->slot_names[k] : "");
        if (slot < 0)
            return ty_error_set(error, TY_BAD_INPUT, "the prototypes have more than %d materials together",
                                TY_MESH_MAX_SLOTS);
        numbers[k] = (uint16_t)slot;
    }
    for (uint32_t t = 0; t < part->triangle_count; t++)
    {
        for (int k = 0; k < 3; k++)
            out->triangles[triangle + t][k] = vertex + part->triangles[t][k];
        if (out->slots)
            out->slots[triangle + t] = numbers[part->slots ? part->slots[t] : 0];
    }
    return TY_OK;
}

static ty_status place_instances(const ty_aggregate* a, ty_mesh* out, ty_error* error)
{
    uint32_t vertex = 0, triangle = 0;
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        ty_mesh* part = ty_mesh_copy(a->prototypes[a->prototype_index[i]]);
        ty_mesh_transform(part, &a->transforms[i]);
        copy_surface(out, part, vertex);
        ty_status status = copy_triangles(out, part, vertex, triangle, error);
        vertex += part->vertex_count;
        triangle += part->triangle_count;
        ty_mesh_destroy(part);
        if (status != TY_OK)
            return status;
    }
    return TY_OK;
}

static void fill_vertex_attribute(const ty_aggregate* a, const ty_mesh_attribute* first, ty_mesh* out)
{
    float* values = ty_mesh_add_attribute(out, first->name, first->components);
    out->attributes[out->attribute_count - 1].space = first->space;
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        const ty_mesh* mesh = a->prototypes[a->prototype_index[i]];
        size_t n = (size_t)mesh->vertex_count * (size_t)first->components;
        memcpy(values, ty_mesh_find_attribute(mesh, first->name)->values, n * sizeof(float));
        values += n;
    }
}

// One value for all vertices of an instance: of an attribute, or of the ids where values is NULL.
static void fill_instance_attribute(const ty_aggregate* a, const char* name, const float* values, ty_mesh* out)
{
    if (ty_mesh_find_attribute(out, name))
        return;
    float* at = ty_mesh_add_attribute(out, name, 1);
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        uint32_t n = a->prototypes[a->prototype_index[i]]->vertex_count;
        for (uint32_t k = 0; k < n; k++)
            *at++ = values ? values[i] : (float)a->ids[i];
    }
}

// What moves in the mesh is its vertices.
static void fill_velocity(const ty_aggregate* a, ty_mesh* out)
{
    if ((!a->velocities && !a->spins) || ty_mesh_find_attribute(out, "velocity"))
        return;
    ty_vec3* at = (ty_vec3*)ty_mesh_add_attribute(out, "velocity", 3);
    const ty_vec3 none = {0.0f, 0.0f, 0.0f}, *position = out->positions;
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        ty_vec3 v = a->velocities ? a->velocities[i] : none, w = a->spins ? a->spins[i] : none;
        uint32_t n = a->prototypes[a->prototype_index[i]]->vertex_count;
        for (uint32_t k = 0; k < n; k++)
            *at++ = ty_add(v, ty_cross(w, ty_sub(*position++, a->transforms[i].t)));
    }
}

ty_status ty_aggregate_realise(const ty_aggregate* a, ty_mesh** out, ty_error* error)
{
    *out = NULL;
    ty_mesh* mesh = NULL;
    ty_status status = ty_aggregate_check_content(a, "", error);
    if (status == TY_OK)
        status = create(a, find_shared(a), &mesh, error);
    if (status == TY_OK)
        status = place_instances(a, mesh, error);
    if (status != TY_OK)
    {
        ty_mesh_destroy(mesh);
        return status;
    }
    for (int k = 0; k < a->prototypes[0]->attribute_count; k++)
    {
        const ty_mesh_attribute* common = common_attribute(a, k);
        if (common)
            fill_vertex_attribute(a, common, mesh);
    }
    fill_instance_attribute(a, "id", NULL, mesh);
    for (int k = 0; k < a->attribute_count; k++)
        fill_instance_attribute(a, a->attributes[k].name, a->attributes[k].values, mesh);
    fill_velocity(a, mesh);
    mesh->recipe = a->recipe ? ty_string_copy(a->recipe) : NULL;
    mesh->hash = a->hash ? ty_string_copy(a->hash) : NULL;
    ty_mesh_compute_bounds(mesh);
    *out = mesh;
    return TY_OK;
}
