// SPDX-License-Identifier: Apache-2.0
// Making, checking, copying and transforming indexed triangle meshes, and their attributes.
#include "mesh_curvature.h"
#include <string.h>
#include <tsuya/geometry/mesh.h>

ty_mesh* ty_mesh_create(uint32_t vertex_count, uint32_t triangle_count)
{
    ty_mesh* mesh = TY_TRY_ALLOC(ty_mesh, 1);
    if (!mesh)
        return NULL;
    mesh->vertex_count = vertex_count;
    mesh->triangle_count = triangle_count;
    mesh->positions = TY_TRY_ALLOC(ty_vec3, vertex_count);
    mesh->normals = TY_TRY_ALLOC(ty_vec3, vertex_count);
    mesh->triangles = ty_try_alloc(triangle_count, sizeof(*mesh->triangles));
    mesh->bounds = ty_bounds_empty();
    if (mesh->positions && mesh->normals && mesh->triangles)
        return mesh;
    ty_mesh_destroy(mesh);
    return NULL;
}

void ty_mesh_destroy(ty_mesh* mesh)
{
    if (!mesh)
        return;
    for (int i = 0; i < mesh->attribute_count; i++)
        ty_free(mesh->attributes[i].values);
    ty_free(mesh->attributes);
    for (int i = 0; i < mesh->slot_count; i++)
        ty_free(mesh->slot_names[i]);
    ty_free(mesh->slot_names);
    ty_free(mesh->slots);
    ty_free(mesh->positions);
    ty_free(mesh->normals);
    ty_free(mesh->uvs);
    ty_free(mesh->triangles);
    ty_free(mesh->welds);
    ty_free(mesh->curvature_1);
    ty_free(mesh->curvature_2);
    ty_free(mesh->direction_1);
    ty_free(mesh->step_positions);
    ty_free(mesh->step_normals);
    ty_free(mesh->recipe);
    ty_free(mesh->hash);
    ty_free(mesh);
}

// NULL for NULL.
static void* copy_array(const void* source, size_t count, size_t size)
{
    if (!source)
        return NULL;
    void* copy = ty_alloc(count, size);
    memcpy(copy, source, count * size);
    return copy;
}

ty_mesh* ty_mesh_copy(const ty_mesh* mesh)
{
    size_t n = mesh->vertex_count;
    ty_mesh* copy = TY_ALLOC(ty_mesh, 1);
    *copy = *mesh;
    copy->positions = copy_array(mesh->positions, n, sizeof(ty_vec3));
    copy->normals = copy_array(mesh->normals, n, sizeof(ty_vec3));
    copy->uvs = copy_array(mesh->uvs, n, sizeof(ty_vec2));
    copy->triangles = copy_array(mesh->triangles, mesh->triangle_count, sizeof(*mesh->triangles));
    copy->welds = copy_array(mesh->welds, n, sizeof(uint32_t));
    copy->curvature_1 = copy_array(mesh->curvature_1, n, sizeof(float));
    copy->curvature_2 = copy_array(mesh->curvature_2, n, sizeof(float));
    copy->direction_1 = copy_array(mesh->direction_1, n, sizeof(ty_vec3));
    copy->step_positions = copy_array(mesh->step_positions, n * (size_t)mesh->step_count, sizeof(ty_vec3));
    copy->step_normals = copy_array(mesh->step_normals, n * (size_t)mesh->step_count, sizeof(ty_vec3));
    copy->recipe = mesh->recipe ? ty_string_copy(mesh->recipe) : NULL;
    copy->hash = mesh->hash ? ty_string_copy(mesh->hash) : NULL;
    copy->attributes = copy_array(mesh->attributes, (size_t)mesh->attribute_count, sizeof(ty_mesh_attribute));
    for (int i = 0; i < copy->attribute_count; i++)
    {
        size_t size = sizeof(float) * (size_t)mesh->attributes[i].components;
        copy->attributes[i].values = copy_array(mesh->attributes[i].values, n, size);
    }
    copy->slots = copy_array(mesh->slots, mesh->triangle_count, sizeof(uint16_t));
    copy->slot_names = copy_array(mesh->slot_names, (size_t)mesh->slot_count, sizeof(char*));
    for (int i = 0; i < copy->slot_count; i++)
        copy->slot_names[i] = ty_string_copy(mesh->slot_names[i]);
    return copy;
}

void ty_mesh_forget_steps(ty_mesh* mesh)
{
    ty_free(mesh->step_positions);
    ty_free(mesh->step_normals);
    mesh->step_positions = mesh->step_normals = NULL;
    mesh->step_count = 0;
}

bool ty_mesh_make_steps(ty_mesh* mesh, int step_count)
{
    TY_ASSERT(step_count > 1 && step_count <= TY_MESH_MAX_STEPS);
    ty_mesh_forget_steps(mesh);
    size_t count = mesh->vertex_count * (size_t)step_count;
    mesh->step_positions = TY_TRY_ALLOC(ty_vec3, count);
    mesh->step_normals = TY_TRY_ALLOC(ty_vec3, count);
    bool enough = mesh->step_positions && mesh->step_normals;
    if (enough)
        mesh->step_count = step_count;
    else
        ty_mesh_forget_steps(mesh);
    return enough;
}

// In double: coordinates near the float limit would overflow in the product.
static double triangle_area(const ty_mesh* mesh, uint32_t triangle)
{
    const uint32_t* c = mesh->triangles[triangle];
    ty_vec3 p = mesh->positions[c[0]], q = mesh->positions[c[1]], r = mesh->positions[c[2]];
    double ux = (double)q.x - p.x, uy = (double)q.y - p.y, uz = (double)q.z - p.z;
    double vx = (double)r.x - p.x, vy = (double)r.y - p.y, vz = (double)r.z - p.z;
    double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    return 0.5 * sqrt(x * x + y * y + z * z);
}

ty_status ty_mesh_validate(const ty_mesh* mesh, const char* name, ty_error* error)
{
    if (mesh->vertex_count == 0 || mesh->triangle_count == 0)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "mesh has no %s",
                               mesh->vertex_count == 0 ? "vertices" : "triangles");
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 p = mesh->positions[i];
        if (!ty_is_finite3(p))
            return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "vertex %u is not finite (%g, %g, %g)", i,
                                   (double)p.x, (double)p.y, (double)p.z);
    }
    double area = 0.0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
    {
        for (int k = 0; k < 3; k++)
            if (mesh->triangles[i][k] >= mesh->vertex_count)
                return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "triangle %u names vertex %u of %u", i,
                                       mesh->triangles[i][k], mesh->vertex_count);
        if (mesh->slots && mesh->slots[i] >= mesh->slot_count)
            return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "triangle %u has material slot %u of %d", i,
                                   mesh->slots[i], mesh->slot_count);
        area += triangle_area(mesh, i);
    }
    if (!(area > 0.0))
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "mesh has no area");
    return TY_OK;
}

void ty_mesh_compute_bounds(ty_mesh* mesh)
{
    ty_bounds bounds = ty_bounds_empty();
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        bounds = ty_bounds_add(bounds, mesh->positions[i]);
    mesh->bounds = bounds;
}

// Normals and curvature at vertex i under the linear part of m, whose determinant's sign is given. For x' = A x the
// outward normal goes with sign(det) cof(A) n, and the second fundamental form of the carried tangents keeps its values
// up to the factor |det| / |cof(A) n|; both are well defined for a singular A too.
static void transform_surface(ty_mesh* mesh, uint32_t i, const ty_affine* m, const ty_affine* cofactor, float det)
{
    ty_vec3 n = mesh->normals[i];
    ty_vec3 carried = ty_mul(ty_map_vector(cofactor, n), copysignf(1.0f, det));
    ty_vec3 normal = ty_normalize(carried);
    mesh->normals[i] = normal;
    if (!mesh->curvature_1 || !mesh->curvature_2 || !mesh->direction_1)
        return;
    ty_vec3 d1 = mesh->direction_1[i];
    ty_vec3 u = ty_map_vector(m, d1), v = ty_map_vector(m, ty_cross(n, d1));
    ty_vec3 t = ty_normalize(ty_sub(u, ty_mul(normal, ty_dot(u, normal))));
    ty_vec3 b = ty_cross(normal, t);
    // u = a t, v = s t + c b: solved for the second fundamental form on (t, b).
    float a = ty_dot(u, t), s = ty_dot(v, t), c = ty_dot(v, b), length = ty_length(carried);
    if (a == 0.0f || c == 0.0f || length == 0.0f)
        return;
    float factor = fabsf(det) / length, k1 = mesh->curvature_1[i] * factor, k2 = mesh->curvature_2[i] * factor;
    float shear = s / a;
    ty_curvature_tensor tensor = {k1 / (a * a), -shear * k1 / (a * c), (k2 + shear * shear * k1) / (c * c)};
    ty_curvature_decompose(tensor, t, b, &mesh->curvature_1[i], &mesh->curvature_2[i], &mesh->direction_1[i]);
}

void ty_mesh_transform(ty_mesh* mesh, const ty_affine* m)
{
    ty_affine cofactor = {ty_cross(m->y, m->z), ty_cross(m->z, m->x), ty_cross(m->x, m->y), {0, 0, 0}};
    float det = ty_affine_determinant(m);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        mesh->positions[i] = ty_map_point(m, mesh->positions[i]);
        transform_surface(mesh, i, m, &cofactor, det);
    }
    for (uint32_t i = 0; det < 0.0f && i < mesh->triangle_count; i++)
    {
        uint32_t* c = mesh->triangles[i];
        uint32_t second = c[1];
        c[1] = c[2];
        c[2] = second;
    }
    ty_mesh_compute_bounds(mesh);
}

const ty_mesh_attribute* ty_mesh_find_attribute(const ty_mesh* mesh, const char* name)
{
    for (int i = 0; i < mesh->attribute_count; i++)
        if (strcmp(mesh->attributes[i].name, name) == 0)
            return &mesh->attributes[i];
    return NULL;
}

float* ty_mesh_add_attribute(ty_mesh* mesh, const char* name, int components)
{
    TY_ASSERT(components >= 1 && components <= 4);
    TY_ASSERT(strlen(name) < sizeof(mesh->attributes->name));
    const ty_mesh_attribute* found = ty_mesh_find_attribute(mesh, name);
    if (found)
    {
        TY_ASSERT(found->components == components);
        return found->values;
    }
    size_t count = (size_t)mesh->attribute_count;
    mesh->attributes = ty_grow(mesh->attributes, count, count + 1, sizeof(ty_mesh_attribute));
    ty_mesh_attribute* attribute = &mesh->attributes[mesh->attribute_count++];
    *attribute = (ty_mesh_attribute){.components = components};
    memcpy(attribute->name, name, strlen(name) + 1);
    attribute->values = ty_alloc(mesh->vertex_count, sizeof(float) * (size_t)components);
    return attribute->values;
}

void ty_mesh_set_quad(ty_mesh* mesh, uint32_t first, const uint32_t q[4])
{
    static const int cut[2][6] = {{0, 1, 3, 1, 2, 3}, {0, 1, 2, 0, 2, 3}};
    const ty_vec3* p = mesh->positions;
    bool across = ty_length_sqr(ty_sub(p[q[0]], p[q[2]])) <= ty_length_sqr(ty_sub(p[q[1]], p[q[3]]));
    for (uint32_t e = 0; e < 6; e++)
        mesh->triangles[first + e / 3][e % 3] = q[cut[across][e]];
}
