// SPDX-License-Identifier: Apache-2.0
// The mesh of a host: shapes and files, moved and put together, with what is painted on them.
#include "roots_host.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/geometry/mesh_file.h>

static const ty_shape_kind shapes[] = {TY_SHAPE_SPHERE,   TY_SHAPE_ELLIPSOID, TY_SHAPE_BOX,
                                       TY_SHAPE_CYLINDER, TY_SHAPE_STONE,     TY_SHAPE_BLOCK};

enum
{
    FARTHEST = 1000000, // m from the origin
    TIMES = 10000,      // of its longest side: beyond, numbers do not tell its parts from one another
};

// The file's own place, where it has one, goes after that of who names it.
static ty_status file_read(const char* where, const char* path, ty_mesh** out, ty_error* error)
{
    ty_error inner = {0};
    char text[900];
    ty_status status = ty_mesh_read(path, out, &inner);
    if (status == TY_OK)
        return TY_OK;
    ty_error_format(&inner, text, sizeof text);
    return ty_error_set(error, status, "%s.mesh: %s", where, text);
}

static ty_status shape_make(const char* where, int kind, const char* mesh, const ty_shape_def* def, ty_mesh** out,
                            ty_error* error)
{
    if (kind == TY_ROOTS_HOST_MESH && !mesh)
        return ty_error_set(error, TY_BAD_INPUT, "%s.mesh: the file is missing", where);
    if (kind == TY_ROOTS_HOST_MESH)
        return file_read(where, mesh, out, error);
    ty_shape_def shape = *def;
    shape.kind = shapes[kind];
    return ty_shape_create(&shape, out, error);
}

static ty_status object_make(const char* where, const ty_roots_object_def* def, ty_mesh** out, ty_error* error)
{
    if (def->scale.x == 0.0f || def->scale.y == 0.0f || def->scale.z == 0.0f)
        return ty_error_set(error, TY_BAD_INPUT, "%s.scale: [%g, %g, %g]; no component is 0", where,
                            (double)def->scale.x, (double)def->scale.y, (double)def->scale.z);
    ty_status status = shape_make(where, def->kind, def->mesh, &def->shape, out, error);
    if (status == TY_OK)
    {
        ty_affine m = ty_affine_from_trs(def->translate, ty_quat_euler(def->rotate), def->scale);
        ty_mesh_transform(*out, &m);
    }
    return status;
}

// --- merging ---

static ty_status attributes_copy(ty_mesh* out, const ty_mesh* part, uint32_t vertex, ty_error* error)
{
    for (int a = 0; a < part->attribute_count; a++)
    {
        const ty_mesh_attribute* from = &part->attributes[a];
        const ty_mesh_attribute* found = ty_mesh_find_attribute(out, from->name);
        if (found && found->components != from->components)
            return ty_error_set(error, TY_BAD_INPUT, "host: the objects' attributes '%s' have %d and %d numbers",
                                from->name, found->components, from->components);
        float* values = ty_mesh_add_attribute(out, from->name, from->components);
        size_t stride = (size_t)from->components;
        memcpy(values + vertex * stride, from->values, part->vertex_count * stride * sizeof(float));
    }
    return TY_OK;
}

static ty_status merge(ty_mesh* const* parts, int count, ty_mesh** out, ty_error* error)
{
    uint64_t vertices = 0, triangles = 0;
    bool mapped = false;
    for (int i = 0; i < count; i++)
    {
        vertices += parts[i]->vertex_count;
        triangles += parts[i]->triangle_count;
        mapped |= parts[i]->uvs != NULL;
    }
    if (vertices > INT32_MAX || triangles > INT32_MAX)
        return ty_error_set(error, TY_BAD_INPUT, "host: %llu triangles; at most %d", (unsigned long long)triangles,
                            INT32_MAX);
    ty_mesh* mesh = *out = ty_mesh_create((uint32_t)vertices, (uint32_t)triangles);
    if (mesh && mapped)
        mesh->uvs = TY_TRY_ALLOC(ty_vec2, vertices);
    if (!mesh || (mapped && !mesh->uvs))
        return ty_error_set(error, TY_NO_MEMORY, "no memory for a host of %llu triangles",
                            (unsigned long long)triangles);
    uint32_t vertex = 0, triangle = 0;
    ty_status status = TY_OK;
    for (int i = 0; i < count && status == TY_OK; i++)
    {
        const ty_mesh* part = parts[i];
        memcpy(mesh->positions + vertex, part->positions, part->vertex_count * sizeof(ty_vec3));
        memcpy(mesh->normals + vertex, part->normals, part->vertex_count * sizeof(ty_vec3));
        if (part->uvs)
            memcpy(mesh->uvs + vertex, part->uvs, part->vertex_count * sizeof(ty_vec2));
        for (uint32_t t = 0; t < part->triangle_count; t++)
            for (int k = 0; k < 3; k++)
                mesh->triangles[triangle + t][k] = vertex + part->triangles[t][k];
        status = attributes_copy(mesh, part, vertex, error);
        vertex += part->vertex_count;
        triangle += part->triangle_count;
    }
    return status;
}

static ty_status reach_check(const char* where, const ty_mesh* mesh, ty_error* error)
{
    float reach = host_reach(mesh), side = host_longest(mesh), most = ty_min((float)TIMES * side, FARTHEST);
    if (reach <= most)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT,
                        "%s: it reaches %g m from the origin; at most %g m, %d times its longest side (%g m) or %d m",
                        where, (double)reach, (double)most, TIMES, (double)side, FARTHEST);
}

// What moves and scales bring may be too large for numbers, or nothing.
static ty_status mesh_finish(const char* where, ty_status status, ty_mesh** mesh, ty_error* error)
{
    if (status == TY_OK)
        status = ty_mesh_validate(*mesh, where, error);
    if (status == TY_OK)
    {
        ty_mesh_compute_bounds(*mesh);
        status = reach_check(where, *mesh, error);
    }
    if (status == TY_OK)
    {
        ty_mesh_compute_welds(*mesh);
        return TY_OK;
    }
    ty_mesh_destroy(*mesh);
    *mesh = NULL;
    return status;
}

static void parts_note(host_parts* out, ty_mesh* const* parts, int count)
{
    uint32_t end = 0;
    *out = (host_parts){count, TY_ALLOC(uint32_t, count), TY_ALLOC(bool, count)};
    for (int i = 0; i < count; i++)
    {
        out->ends[i] = end += parts[i]->triangle_count;
        out->mapped[i] = parts[i]->uvs != NULL;
    }
}

void host_parts_term(host_parts* parts)
{
    ty_free(parts->ends);
    ty_free(parts->mapped);
    *parts = (host_parts){0};
}

static ty_status part_check(const char* name, const ty_roots_object_def* def, const ty_mesh* mesh, ty_error* error)
{
    char key[64];
    snprintf(key, sizeof key, "%s.avoid", name);
    ty_status status = host_mask_check(mesh, key, &def->avoid, error);
    snprintf(key, sizeof key, "%s.attract", name);
    return status == TY_OK ? host_mask_check(mesh, key, &def->attract, error) : status;
}

ty_status host_objects_make(const char* where, const ty_param_list* objects, ty_mesh** out, host_parts* out_parts,
                            ty_error* error)
{
    ty_mesh** parts = TY_ALLOC(ty_mesh*, objects->count);
    ty_status status = TY_OK;
    *out = NULL;
    for (int i = 0; i < objects->count && status == TY_OK; i++)
    {
        char name[48];
        const ty_roots_object_def* def = (const ty_roots_object_def*)objects->items + i;
        snprintf(name, sizeof name, "%s[%d]", where, i);
        status = object_make(name, def, &parts[i], error);
        if (status == TY_OK)
            status = part_check(name, def, parts[i], error);
    }
    if (status == TY_OK)
        status = merge(parts, objects->count, out, error);
    if (status == TY_OK && out_parts)
        parts_note(out_parts, parts, objects->count);
    for (int i = 0; i < objects->count; i++)
        ty_mesh_destroy(parts[i]);
    ty_free(parts);
    return mesh_finish(where, status, out, error);
}

ty_status host_mesh_make(const ty_roots_host_def* def, ty_mesh** out, host_parts* parts, ty_error* error)
{
    if (def->objects.count > 0)
        return host_objects_make("host.objects", &def->objects, out, parts, error);
    *out = NULL;
    ty_status status = shape_make("host", def->kind, def->mesh, &def->shape, out, error);
    if (status == TY_OK)
        parts_note(parts, out, 1);
    return mesh_finish("host", status, out, error);
}

float host_longest(const ty_mesh* mesh)
{
    ty_vec3 size = ty_sub(mesh->bounds.high, mesh->bounds.low);
    return ty_max(size.x, ty_max(size.y, size.z));
}

float host_reach(const ty_mesh* mesh)
{
    ty_vec3 low = mesh->bounds.low, high = mesh->bounds.high;
    return ty_max(ty_max(-low.x, high.x), ty_max(ty_max(-low.y, high.y), ty_max(-low.z, high.z)));
}
