// SPDX-License-Identifier: Apache-2.0
// All objects of a glTF scene as one mesh.
#include "gltf_source.h"
#include <string.h>

typedef struct merger
{
    const ty_gltf_scene* scene;
    ty_mesh* out;
    uint32_t vertex, triangle; // next
    ty_error* error;
} merger;

// How often an object shows its mesh.
static uint32_t repeats(const ty_gltf_object* object)
{
    return object->is_instanced ? object->instances->instance_count : 1;
}

static ty_affine placement(const ty_gltf_object* object, uint32_t instance)
{
    return object->is_instanced ? ty_affine_multiply(&object->to_file, &object->instances->transforms[instance])
                                : object->to_file;
}

static ty_status create(merger* m)
{
    uint64_t vertices = 0, triangles = 0;
    bool has_uvs = false;
    for (int i = 0; i < m->scene->object_count; i++)
    {
        const ty_mesh* mesh = m->scene->meshes[m->scene->objects[i].mesh];
        vertices += (uint64_t)mesh->vertex_count * repeats(&m->scene->objects[i]);
        triangles += (uint64_t)mesh->triangle_count * repeats(&m->scene->objects[i]);
        has_uvs |= mesh->uvs != NULL;
        if (vertices >= UINT32_MAX || triangles >= UINT32_MAX)
            return ty_error_set_at(m->error, TY_BAD_FILE, m->scene->path, 0, 0, "too large for one mesh");
    }
    if (triangles == 0)
        return ty_error_set_at(m->error, TY_BAD_FILE, m->scene->path, 0, 0, "there is no mesh in it");
    m->out = ty_mesh_create((uint32_t)vertices, (uint32_t)triangles);
    if (m->out && has_uvs)
        m->out->uvs = TY_TRY_ALLOC(ty_vec2, vertices);
    if (m->out)
        m->out->slots = TY_TRY_ALLOC(uint16_t, triangles);
    if (!m->out || !m->out->slots || (has_uvs && !m->out->uvs))
        return ty_error_set_at(m->error, TY_NO_MEMORY, m->scene->path, 0, 0, "no memory for one mesh of it all");
    return TY_OK;
}

// Attributes that every mesh has alike.
static void add_attributes(merger* m)
{
    const ty_gltf_scene* scene = m->scene;
    const ty_mesh* first = scene->meshes[scene->objects[0].mesh];
    for (int a = 0; a < first->attribute_count; a++)
    {
        const ty_mesh_attribute* attribute = &first->attributes[a];
        bool common = true;
        for (int i = 1; i < scene->object_count && common; i++)
        {
            const ty_mesh_attribute* other =
                ty_mesh_find_attribute(scene->meshes[scene->objects[i].mesh], attribute->name);
            common = other && other->components == attribute->components && other->space == attribute->space;
        }
        if (!common)
            continue;
        (void)ty_mesh_add_attribute(m->out, attribute->name, attribute->components);
        m->out->attributes[m->out->attribute_count - 1].space = attribute->space;
    }
}

static bool append_slots(merger* m, const ty_mesh* mesh)
{
    uint16_t numbers[TY_MESH_MAX_SLOTS] = {0};
    for (int i = 0; i < mesh->slot_count; i++)
    {
        int slot = ty_mesh_add_slot(m->out, mesh->slot_names[i]);
        if (slot < 0)
            return false;
        numbers[i] = (uint16_t)slot;
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        m->out->slots[m->triangle + t] = numbers[mesh->slots ? mesh->slots[t] : 0];
    return true;
}

static bool append(merger* m, const ty_mesh* mesh, const ty_affine* map)
{
    ty_mesh* placed = ty_mesh_copy(mesh);
    ty_mesh_transform(placed, map);
    size_t n = placed->vertex_count;
    memcpy(m->out->positions + m->vertex, placed->positions, n * sizeof(ty_vec3));
    memcpy(m->out->normals + m->vertex, placed->normals, n * sizeof(ty_vec3));
    if (placed->uvs)
        memcpy(m->out->uvs + m->vertex, placed->uvs, n * sizeof(ty_vec2));
    for (int a = 0; a < m->out->attribute_count; a++)
    {
        const ty_mesh_attribute* to = &m->out->attributes[a];
        size_t width = (size_t)to->components;
        memcpy(to->values + m->vertex * width, ty_mesh_find_attribute(placed, to->name)->values,
               n * width * sizeof(float));
    }
    for (uint32_t t = 0; t < placed->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            m->out->triangles[m->triangle + t][k] = m->vertex + placed->triangles[t][k];
    bool good = append_slots(m, placed);
    m->vertex += placed->vertex_count;
    m->triangle += placed->triangle_count;
    ty_mesh_destroy(placed);
    return good;
}

static ty_status append_all(merger* m)
{
    const ty_gltf_scene* scene = m->scene;
    for (int i = 0; i < scene->object_count; i++)
        for (uint32_t k = 0; k < repeats(&scene->objects[i]); k++)
        {
            ty_affine map = placement(&scene->objects[i], k);
            if (!append(m, scene->meshes[scene->objects[i].mesh], &map))
                return ty_error_set_at(m->error, TY_BAD_FILE, scene->path, 0, 0, "more than %d materials",
                                       TY_MESH_MAX_SLOTS);
        }
    return TY_OK;
}

ty_status ty_gltf_scene_merge(const ty_gltf_scene* scene, ty_mesh** out, ty_error* error)
{
    TY_ASSERT(scene->source->meshes_read);
    merger m = {.scene = scene, .error = error};
    ty_status status = create(&m);
    if (status == TY_OK)
    {
        add_attributes(&m);
        status = append_all(&m);
    }
    if (status == TY_OK)
        status = ty_mesh_validate(m.out, scene->path, error);
    if (status != TY_OK)
    {
        ty_mesh_destroy(m.out);
        *out = NULL;
        return status;
    }
    if (m.out->slot_count < 2)
    {
        ty_free(m.out->slots);
        m.out->slots = NULL;
    }
    ty_mesh_compute_welds(m.out);
    ty_mesh_compute_bounds(m.out);
    *out = m.out;
    return TY_OK;
}
