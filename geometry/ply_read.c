// SPDX-License-Identifier: Apache-2.0
// Meshes from PLY: keeps every scalar vertex property, fans polygons, and never trusts a count.
#include "ply.h"
#include <math.h>
#include <string.h>
#include <tsuya/geometry/mesh_file.h>

// Where a vertex property goes.
typedef struct vertex_target
{
    float* values; // NULL = nowhere
    int stride;
    float scale;
} vertex_target;

typedef struct face_list
{
    uint32_t (*triangles)[3];
    size_t count, capacity;
} face_list;

static const struct
{
    const char* names[4];
    int component;
} known_properties[] = {
    {{"x"}, 0},
    {{"y"}, 1},
    {{"z"}, 2},
    {{"nx"}, 3},
    {{"ny"}, 4},
    {{"nz"}, 5},
    {{"s", "u", "texture_u", "texture_s"}, 6},
    {{"t", "v", "texture_v", "texture_t"}, 7},
};

static int known_component(const char* name)
{
    for (size_t i = 0; i < sizeof known_properties / sizeof known_properties[0]; i++)
    {
        for (int k = 0; k < 4 && known_properties[i].names[k]; k++)
        {
            if (strcmp(known_properties[i].names[k], name) == 0)
            {
                return known_properties[i].component;
            }
        }
    }
    return -1;
}

static bool has_component(const ply_element* element, int component)
{
    for (int i = 0; i < element->property_count; i++)
    {
        if (known_component(element->properties[i].name) == component)
        {
            return true;
        }
    }
    return false;
}

static const char* const color_names[4] = {"red", "green", "blue", "alpha"};

// How many of red, green, blue, alpha make one colour: 0, 3 or 4, of one scalar type; 0 where `color` is something
// else.
static int color_components(const ply_element* element)
{
    int first = ply_find_property(element, "color") < 0 ? ply_find_property(element, color_names[0]) : -1, count = 0;
    for (; first >= 0 && count < 4; count++)
    {
        int found = ply_find_property(element, color_names[count]);
        if (found < 0 || element->properties[found].type != element->properties[first].type)
        {
            break;
        }
    }
    return count >= 3 ? count : 0;
}

// Integer colours are fractions of their range, as every program means them.
static float fraction_of(ply_type type)
{
    return type == PLY_UINT8 ? 1.0f / 255.0f : 1.0f;
}

// The place of a property in the attribute `color`, if it belongs there.
static vertex_target color_target(ty_mesh* mesh, const ply_element* element, const ply_property* property)
{
    int count = color_components(element);
    for (int i = 0; i < count; i++)
    {
        if (strcmp(property->name, color_names[i]) == 0)
        {
            bool is_encoded = property->type == PLY_UINT8 || property->type == PLY_UINT16;
            float* values = ty_mesh_add_attribute(mesh, "color", count);
            for (int k = 0; k < mesh->attribute_count; k++)
            {
                if (mesh->attributes[k].values == values)
                {
                    mesh->attributes[k].space = is_encoded ? TY_ATTRIBUTE_SRGB : TY_ATTRIBUTE_LINEAR_SRGB;
                }
            }
            return (vertex_target){values + i, count,
                                   property->type == PLY_UINT16 ? 1.0f / 65535.0f : fraction_of(property->type)};
        }
    }
    return (vertex_target){NULL, 0, 1.0f};
}

static vertex_target target_of(ty_mesh* mesh, const ply_property* property, bool has_normals)
{
    int component = known_component(property->name);
    if (component >= 0 && component < 3)
    {
        return (vertex_target){&mesh->positions[0].x + component, 3, 1.0f};
    }
    if (component >= 3 && component < 6)
    {
        return has_normals ? (vertex_target){&mesh->normals[0].x + component - 3, 3, 1.0f}
                           : (vertex_target){NULL, 0, 1.0f};
    }
    if (component >= 6)
    {
        return mesh->uvs ? (vertex_target){&mesh->uvs[0].x + component - 6, 2, 1.0f} : (vertex_target){NULL, 0, 1.0f};
    }
    return (vertex_target){ty_mesh_add_attribute(mesh, property->name, 1), 1, fraction_of(property->type)};
}

static ty_status fill_vertices(ply_file* file, const ply_element* element, const vertex_target* targets)
{
    for (uint64_t item = 0; item < element->count; item++)
    {
        for (int i = 0; i < element->property_count; i++)
        {
            double value;
            ty_status status = ply_read_value(file, element->properties[i].type, &value);
            if (status != TY_OK)
            {
                return status;
            }
            if (targets[i].values)
            {
                if (!isfinite((float)value))
                {
                    return ply_fail(file, "vertex %llu: %s is not finite", (unsigned long long)item,
                                    element->properties[i].name);
                }
                targets[i].values[item * (uint64_t)targets[i].stride] = (float)value * targets[i].scale;
            }
        }
    }
    return TY_OK;
}

static ty_status read_vertices(ply_file* file, const ply_element* element, ty_mesh** out)
{
    for (int i = 0; i < element->property_count; i++)
    {
        if (element->properties[i].count_type != PLY_NO_TYPE)
        {
            return ply_fail(file, "vertex property '%s' is a list", element->properties[i].name);
        }
    }
    if (!has_component(element, 0) || !has_component(element, 1) || !has_component(element, 2))
    {
        return ply_fail(file, "vertices need the properties x, y and z");
    }
    ty_status status = ply_check_room(file, element);
    if (status != TY_OK)
    {
        return status;
    }
    if (element->count == 0)
    {
        return ply_fail(file, "there are no vertices");
    }
    ty_mesh* mesh = ty_mesh_create((uint32_t)element->count, 0);
    if (!mesh)
    {
        return ty_error_set_at(file->error, TY_NO_MEMORY, file->name, 0, 0, "no memory for %llu vertices",
                               (unsigned long long)element->count);
    }
    *out = mesh;
    bool has_normals = has_component(element, 3) && has_component(element, 4) && has_component(element, 5);
    if (has_component(element, 6) && has_component(element, 7))
    {
        mesh->uvs = TY_TRY_ALLOC(ty_vec2, element->count);
    }
    vertex_target targets[PLY_MAX_PROPERTIES];
    for (int i = 0; i < element->property_count; i++)
    {
        targets[i] = color_target(mesh, element, &element->properties[i]);
        if (!targets[i].values)
        {
            targets[i] = target_of(mesh, &element->properties[i], has_normals);
        }
    }
    return fill_vertices(file, element, targets);
}

static ty_status add_triangle(ply_file* file, face_list* faces, const uint32_t corner[3])
{
    if (faces->count == faces->capacity)
    {
        size_t capacity = faces->capacity ? 2 * faces->capacity : 1024;
        void* grown = ty_try_grow(faces->triangles, faces->capacity, capacity, sizeof faces->triangles[0]);
        if (!grown || capacity > 0xfffffffeu)
        {
            return ty_error_set_at(file->error, TY_NO_MEMORY, file->name, 0, 0, "no memory for the triangles");
        }
        faces->triangles = grown;
        faces->capacity = capacity;
    }
    memcpy(faces->triangles[faces->count++], corner, sizeof faces->triangles[0]);
    return TY_OK;
}

// One polygon, as a fan about its first corner.
static ty_status read_polygon(ply_file* file, const ply_property* property, uint32_t vertex_count, uint64_t face,
                              face_list* faces)
{
    double count, value;
    ty_status status = ply_read_value(file, property->count_type, &count);
    if (status != TY_OK)
    {
        return status;
    }
    if (!(count >= 3))
    {
        return ply_fail(file, "face %llu has %g corners", (unsigned long long)face, count);
    }
    uint32_t corner[3] = {0};
    for (double k = 0; k < count; k++)
    {
        status = ply_read_value(file, property->type, &value);
        if (status != TY_OK)
        {
            return status;
        }
        if (!(value >= 0) || value >= (double)vertex_count)
        {
            return ply_fail(file, "face %llu: vertex index %.0f is not within 0..%u", (unsigned long long)face, value,
                            vertex_count - 1);
        }
        corner[k < 2 ? (int)k : 2] = (uint32_t)value;
        if (k >= 2)
        {
            status = add_triangle(file, faces, corner);
            corner[1] = corner[2];
            if (status != TY_OK)
            {
                return status;
            }
        }
    }
    return TY_OK;
}

static ty_status read_faces(ply_file* file, const ply_element* element, uint32_t vertex_count, face_list* faces)
{
    int indices = ply_find_property(element, "vertex_indices");
    indices = indices >= 0 ? indices : ply_find_property(element, "vertex_index");
    if (indices < 0 || element->properties[indices].count_type == PLY_NO_TYPE)
    {
        return ply_fail(file, "faces need a list property vertex_indices");
    }
    ty_status status = ply_check_room(file, element);
    ply_element part = {.count = 1, .property_count = 1};
    for (uint64_t face = 0; face < element->count && status == TY_OK; face++)
    {
        for (int i = 0; i < element->property_count && status == TY_OK; i++)
        {
            part.properties[0] = element->properties[i];
            status = i == indices ? read_polygon(file, &element->properties[i], vertex_count, face, faces)
                                  : ply_skip_element(file, &part);
        }
    }
    return status;
}

static ty_status read_elements(ply_file* file, ty_mesh** mesh, face_list* faces, bool* has_normals)
{
    for (int i = 0; i < file->element_count; i++)
    {
        const ply_element* element = &file->elements[i];
        ty_status status;
        if (strcmp(element->name, "vertex") == 0 && !*mesh)
        {
            status = read_vertices(file, element, mesh);
            *has_normals = has_component(element, 3) && has_component(element, 4) && has_component(element, 5);
        }
        else if (strcmp(element->name, "face") == 0 && *mesh)
        {
            status = read_faces(file, element, (*mesh)->vertex_count, faces);
        }
        else if (strcmp(element->name, "tristrips") == 0)
        {
            status = ply_fail(file, "triangle strips are not read; write faces");
        }
        else
        {
            status = ply_check_room(file, element);
            status = status == TY_OK ? ply_skip_element(file, element) : status;
        }
        if (status != TY_OK)
        {
            return status;
        }
    }
    if (!*mesh || faces->count == 0)
    {
        return ply_fail(file, !*mesh ? "there is no element vertex" : "there are no faces");
    }
    return TY_OK;
}

// Some writers leave zeros where they had no normal; then all are computed.
static bool normals_are_usable(const ty_mesh* mesh)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        float length = ty_length_sqr(mesh->normals[i]);
        if (!(length > 0.5f && length < 2.0f))
        {
            return false;
        }
    }
    return true;
}

ty_status ply_read(const char* name, const void* bytes, size_t size, float crease, ty_mesh** out, ty_error* error)
{
    *out = NULL;
    ply_file file;
    ty_mesh* mesh = NULL;
    face_list faces = {0};
    bool has_normals = false;
    ty_status status = ply_open(&file, name, bytes, size, error);
    status = status == TY_OK ? read_elements(&file, &mesh, &faces, &has_normals) : status;
    if (status == TY_OK)
    {
        TY_ASSERT(mesh);
        ty_free(mesh->triangles);
        mesh->triangles = faces.triangles;
        mesh->triangle_count = (uint32_t)faces.count;
        faces.triangles = NULL;
        status = ty_mesh_validate(mesh, name, error);
    }
    ty_free(faces.triangles);
    if (status != TY_OK)
    {
        ty_mesh_destroy(mesh);
        return status;
    }
    ty_mesh_compute_welds(mesh);
    if (!has_normals || !normals_are_usable(mesh))
    {
        ty_mesh_compute_normals(mesh, crease);
    }
    ty_mesh_compute_bounds(mesh);
    mesh->recipe = ply_note_read(&file, "recipe");
    mesh->hash = ply_note_read(&file, "hash");
    if (mesh->hash)
    {
        mesh->hash[strcspn(mesh->hash, "\n")] = 0;
    }
    *out = mesh;
    return TY_OK;
}

ty_status ty_ply_read_memory(const char* name, const void* bytes, size_t size, ty_mesh** out, ty_error* error)
{
    return ply_read(name, bytes, size, 0.7f, out, error); // 40 degrees: boxes keep their edges, scans stay smooth
}
