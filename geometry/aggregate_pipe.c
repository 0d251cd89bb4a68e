// SPDX-License-Identifier: Apache-2.0
// An aggregate through a pipe: flat arrays behind small headers, in the machine's own byte order.
#include "pipe.h"
#include <string.h>

#define MAGIC 0x61796f74u

typedef struct pipe_header
{
    uint32_t magic, prototype_count, instance_count, attribute_count, parts;
} pipe_header;

enum
{
    HAS_VELOCITIES = 1,
    HAS_SPINS = 2
};

enum
{
    HAS_NORMALS = 1,
    HAS_UVS = 2,
    HAS_CURVATURE = 4,
    HAS_DIRECTION = 8,
    HAS_SLOTS = 16
};

typedef struct mesh_header
{
    uint32_t vertex_count, triangle_count, parts, attribute_count, slot_count;
} mesh_header;

typedef struct attribute_header
{
    char name[32];
    uint32_t components, space;
} attribute_header;

enum
{
    SLOT_NAME_SIZE = 128
};

// --- sending ---

static ty_status send_array(int fd, const void* values, size_t count, size_t size, ty_error* error)
{
    return values && count ? ty_child_write(fd, values, count * size, error) : TY_OK;
}

static ty_status send_attribute(int fd, const char* name, int components, ty_attribute_space space, const float* values,
                                size_t count, ty_error* error)
{
    attribute_header header = {.components = (uint32_t)components, .space = (uint32_t)space};
    memcpy(header.name, name, strnlen(name, sizeof header.name - 1));
    ty_status status = ty_child_write(fd, &header, sizeof header, error);
    return status == TY_OK ? send_array(fd, values, count * (size_t)components, sizeof(float), error) : status;
}

static ty_status send_slots(int fd, const ty_mesh* mesh, ty_error* error)
{
    ty_status status = send_array(fd, mesh->slots, mesh->triangle_count, sizeof(uint16_t), error);
    for (int i = 0; i < mesh->slot_count && status == TY_OK; i++)
    {
        char name[SLOT_NAME_SIZE] = {0};
        memcpy(name, mesh->slot_names[i], strnlen(mesh->slot_names[i], SLOT_NAME_SIZE - 1));
        status = ty_child_write(fd, name, sizeof name, error);
    }
    return status;
}

ty_status ty_mesh_send(int fd, const ty_mesh* mesh, ty_error* error)
{
    size_t n = mesh->vertex_count;
    bool curved = mesh->curvature_1 && mesh->curvature_2;
    mesh_header header = {mesh->vertex_count, mesh->triangle_count, 0, (uint32_t)mesh->attribute_count,
                          (uint32_t)mesh->slot_count};
    header.parts = (mesh->normals ? HAS_NORMALS : 0u) | (mesh->uvs ? HAS_UVS : 0u) | (curved ? HAS_CURVATURE : 0u) |
                   (mesh->direction_1 ? HAS_DIRECTION : 0u) | (mesh->slots ? HAS_SLOTS : 0u);
    ty_status status = ty_child_write(fd, &header, sizeof header, error);
    if (status == TY_OK)
        status = send_array(fd, mesh->positions, n, sizeof(ty_vec3), error);
    if (status == TY_OK)
        status = send_array(fd, mesh->triangles, mesh->triangle_count, sizeof mesh->triangles[0], error);
    if (status == TY_OK)
        status = send_array(fd, mesh->normals, n, sizeof(ty_vec3), error);
    if (status == TY_OK)
        status = send_array(fd, mesh->uvs, n, sizeof(ty_vec2), error);
    if (status == TY_OK && curved)
        status = send_array(fd, mesh->curvature_1, n, sizeof(float), error);
    if (status == TY_OK && curved)
        status = send_array(fd, mesh->curvature_2, n, sizeof(float), error);
    if (status == TY_OK)
        status = send_array(fd, mesh->direction_1, n, sizeof(ty_vec3), error);
    for (int i = 0; i < mesh->attribute_count && status == TY_OK; i++)
        status = send_attribute(fd, mesh->attributes[i].name, mesh->attributes[i].components, mesh->attributes[i].space,
                                mesh->attributes[i].values, n, error);
    return status == TY_OK ? send_slots(fd, mesh, error) : status;
}

ty_status ty_aggregate_send(int output_fd, const ty_aggregate* aggregate, ty_error* error)
{
    size_t n = aggregate->instance_count;
    pipe_header header = {MAGIC, (uint32_t)aggregate->prototype_count, aggregate->instance_count,
                          (uint32_t)aggregate->attribute_count,
                          (aggregate->velocities ? HAS_VELOCITIES : 0u) | (aggregate->spins ? HAS_SPINS : 0u)};
    ty_status status = ty_child_write(output_fd, &header, sizeof header, error);
    for (int i = 0; i < aggregate->prototype_count && status == TY_OK; i++)
        status = ty_mesh_send(output_fd, aggregate->prototypes[i], error);
    if (status == TY_OK)
        status = send_array(output_fd, aggregate->transforms, n, sizeof(ty_affine), error);
    if (status == TY_OK)
        status = send_array(output_fd, aggregate->prototype_index, n, sizeof(uint32_t), error);
    if (status == TY_OK)
        status = send_array(output_fd, aggregate->ids, n, sizeof(uint32_t), error);
    if (status == TY_OK)
        status = send_array(output_fd, aggregate->velocities, n, sizeof(ty_vec3), error);
    if (status == TY_OK)
        status = send_array(output_fd, aggregate->spins, n, sizeof(ty_vec3), error);
    for (int i = 0; i < aggregate->attribute_count && status == TY_OK; i++)
        status = send_attribute(output_fd, aggregate->attributes[i].name, 1, TY_ATTRIBUTE_NUMBERS,
                                aggregate->attributes[i].values, n, error);
    return status;
}

// --- receiving ---

static ty_status cut_off(const ty_receiver* r)
{
    return ty_error_set_at(r->error, TY_BAD_FILE, r->name, 0, 0, "what the importer sent does not add up");
}

ty_status ty_take(ty_receiver* r, void* out, size_t count, size_t size)
{
    if (count > r->left / size)
        return cut_off(r);
    memcpy(out, r->at, count * size);
    r->at += count * size;
    r->left -= count * size;
    return TY_OK;
}

// A new array; its size is bounded by what is left before memory is asked for.
static ty_status take_new(ty_receiver* r, void** out, size_t count, size_t size)
{
    if (count > r->left / size)
        return cut_off(r);
    *out = ty_try_alloc(count, size);
    if (!*out)
        return ty_error_set_at(r->error, TY_NO_MEMORY, r->name, 0, 0, "no memory for %zu bytes", count * size);
    return ty_take(r, *out, count, size);
}

static ty_status take_attribute_header(ty_receiver* r, attribute_header* header)
{
    ty_status status = ty_take(r, header, 1, sizeof *header);
    if (status == TY_OK && (header->name[31] || header->name[0] == '\0' || header->components < 1 ||
                            header->components > 4 || header->space > TY_ATTRIBUTE_LINEAR_SRGB))
        return cut_off(r);
    return status;
}

static ty_status take_parts(ty_receiver* r, ty_mesh* mesh, uint32_t parts)
{
    size_t n = mesh->vertex_count;
    ty_status status = ty_take(r, mesh->positions, n, sizeof(ty_vec3));
    if (status == TY_OK)
        status = ty_take(r, mesh->triangles, mesh->triangle_count, sizeof mesh->triangles[0]);
    if (status == TY_OK && (parts & HAS_NORMALS))
        status = ty_take(r, mesh->normals, n, sizeof(ty_vec3));
    if (status == TY_OK && (parts & HAS_UVS))
        status = take_new(r, (void**)&mesh->uvs, n, sizeof(ty_vec2));
    if (status == TY_OK && (parts & HAS_CURVATURE))
        status = take_new(r, (void**)&mesh->curvature_1, n, sizeof(float));
    if (status == TY_OK && (parts & HAS_CURVATURE))
        status = take_new(r, (void**)&mesh->curvature_2, n, sizeof(float));
    if (status == TY_OK && (parts & HAS_DIRECTION))
        status = take_new(r, (void**)&mesh->direction_1, n, sizeof(ty_vec3));
    return status;
}

// As the other mesh readers: normals that the file lacks are smooth, but for edges above 40 degrees.
static ty_status finish_mesh(ty_receiver* r, ty_mesh* mesh, int index, bool has_normals)
{
    ty_error fault;
    if (ty_mesh_validate(mesh, r->name, &fault) != TY_OK)
        return ty_error_set_at(r->error, TY_BAD_FILE, r->name, 0, 0, "prototype %d: %.900s", index, fault.text);
    for (uint32_t i = 0; i < mesh->vertex_count && has_normals; i++)
        if (!ty_is_finite3(mesh->normals[i]))
            return ty_error_set_at(r->error, TY_BAD_FILE, r->name, 0, 0,
                                   "prototype %d, vertex %u: its normal is not finite", index, i);
    ty_mesh_compute_welds(mesh);
    if (!has_normals)
        ty_mesh_compute_normals(mesh, 0.7f);
    ty_mesh_compute_bounds(mesh);
    return TY_OK;
}

static ty_status take_slots(ty_receiver* r, ty_mesh* mesh, uint32_t count, bool has_slots)
{
    ty_status status = TY_OK;
    if (count > TY_MESH_MAX_SLOTS)
        return cut_off(r);
    if (has_slots)
        status = take_new(r, (void**)&mesh->slots, mesh->triangle_count, sizeof(uint16_t));
    for (uint32_t i = 0; i < count && status == TY_OK; i++)
    {
        char name[SLOT_NAME_SIZE];
        status = ty_take(r, name, 1, sizeof name);
        name[SLOT_NAME_SIZE - 1] = 0;
        if (status == TY_OK && ty_mesh_add_slot(mesh, name) != (int)i)
            return cut_off(r);
    }
    return status;
}

ty_status ty_mesh_take(ty_receiver* r, int index, ty_mesh** out)
{
    mesh_header header;
    ty_status status = ty_take(r, &header, 1, sizeof header);
    if (status != TY_OK)
        return status;
    if (header.vertex_count > r->left / sizeof(ty_vec3) || header.triangle_count > r->left / (3 * sizeof(uint32_t)))
        return cut_off(r);
    ty_mesh* mesh = ty_mesh_create(header.vertex_count, header.triangle_count);
    if (!mesh)
        return ty_error_set_at(r->error, TY_NO_MEMORY, r->name, 0, 0, "no memory for prototype %d", index);
    *out = mesh;
    status = take_parts(r, mesh, header.parts);
    for (uint32_t i = 0; i < header.attribute_count && status == TY_OK; i++)
    {
        attribute_header attribute;
        status = take_attribute_header(r, &attribute);
        if (status == TY_OK && mesh->vertex_count > r->left / (attribute.components * sizeof(float)))
            return cut_off(r);
        if (status == TY_OK && ty_mesh_find_attribute(mesh, attribute.name))
            return cut_off(r);
        if (status == TY_OK)
            status = ty_take(r, ty_mesh_add_attribute(mesh, attribute.name, (int)attribute.components),
                             (size_t)mesh->vertex_count * attribute.components, sizeof(float));
        if (status == TY_OK)
            mesh->attributes[mesh->attribute_count - 1].space = (ty_attribute_space)attribute.space;
    }
    if (status == TY_OK)
        status = take_slots(r, mesh, header.slot_count, header.parts & HAS_SLOTS);
    return status == TY_OK ? finish_mesh(r, mesh, index, header.parts & HAS_NORMALS) : status;
}

static ty_status take_instances(ty_receiver* r, ty_aggregate* a, const pipe_header* sent)
{
    size_t n = a->instance_count;
    ty_status status = ty_take(r, a->transforms, n, sizeof(ty_affine));
    if (status == TY_OK)
        status = ty_take(r, a->prototype_index, n, sizeof(uint32_t));
    if (status == TY_OK)
        status = ty_take(r, a->ids, n, sizeof(uint32_t));
    if (status == TY_OK && (sent->parts & HAS_VELOCITIES))
        status = take_new(r, (void**)&a->velocities, n, sizeof(ty_vec3));
    if (status == TY_OK && (sent->parts & HAS_SPINS))
        status = take_new(r, (void**)&a->spins, n, sizeof(ty_vec3));
    for (uint32_t i = 0; i < sent->attribute_count && status == TY_OK; i++)
    {
        attribute_header header;
        status = take_attribute_header(r, &header);
        if (status == TY_OK && n > r->left / sizeof(float))
            return cut_off(r);
        if (status == TY_OK)
            status = ty_take(r, ty_aggregate_add_attribute(a, header.name), n, sizeof(float));
    }
    return status;
}

ty_status ty_aggregate_take(ty_receiver* r, ty_aggregate** out)
{
    *out = NULL;
    pipe_header header;
    ty_status status = ty_take(r, &header, 1, sizeof header);
    if (status != TY_OK)
        return status;
    if (header.magic != MAGIC || header.prototype_count > r->left / sizeof(mesh_header) ||
        header.instance_count > r->left / sizeof(ty_affine))
        return cut_off(r);
    ty_aggregate* a = ty_aggregate_create(header.instance_count, (int)header.prototype_count);
    if (!a)
        return ty_error_set_at(r->error, TY_NO_MEMORY, r->name, 0, 0, "no memory for %u instances",
                               header.instance_count);
    for (uint32_t i = 0; i < header.prototype_count && status == TY_OK; i++)
        status = ty_mesh_take(r, (int)i, &a->prototypes[i]);
    if (status == TY_OK)
        status = take_instances(r, a, &header);
    if (status != TY_OK)
        ty_aggregate_destroy(a);
    else
        *out = a;
    return status;
}

ty_status ty_receive_end(const ty_receiver* r)
{
    return r->left ? cut_off(r) : TY_OK;
}

ty_status ty_aggregate_receive(const char* name, const void* bytes, size_t size, ty_aggregate** out, ty_error* error)
{
    ty_receiver r = {name, bytes, size, error};
    ty_status status = ty_aggregate_take(&r, out);
    if (status == TY_OK)
        status = ty_receive_end(&r);
    if (status != TY_OK)
    {
        ty_aggregate_destroy(*out);
        *out = NULL;
    }
    return status;
}
