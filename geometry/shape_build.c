// SPDX-License-Identifier: Apache-2.0
// Collects the vertices and triangles of a shape and makes them a mesh.
#include "shape_build.h"

static bool reserve(void** array, size_t* capacity, size_t count, size_t size)
{
    if (count < *capacity)
        return true;
    size_t wanted = *capacity ? 2 * *capacity : 1024;
    void* grown = ty_try_grow(*array, *capacity, wanted, size);
    if (!grown)
        return false;
    *array = grown;
    *capacity = wanted;
    return true;
}

uint32_t ty_shape_add_vertex(ty_shape_build* build, const ty_shape_vertex* vertex)
{
    void* array = build->vertices;
    build->failed = build->failed || build->vertex_count >= UINT32_MAX ||
                    !reserve(&array, &build->vertex_capacity, build->vertex_count, sizeof(*build->vertices));
    build->vertices = array;
    if (build->failed)
        return 0;
    build->vertices[build->vertex_count] = *vertex;
    return (uint32_t)build->vertex_count++;
}

void ty_shape_add_triangle(ty_shape_build* build, uint32_t a, uint32_t b, uint32_t c)
{
    void* array = build->triangles;
    build->failed = build->failed || build->triangle_count >= UINT32_MAX ||
                    !reserve(&array, &build->triangle_capacity, build->triangle_count, sizeof(*build->triangles));
    build->triangles = array;
    if (build->failed)
        return;
    uint32_t* triangle = build->triangles[build->triangle_count++];
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
}

void ty_shape_add_quad(ty_shape_build* build, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    if (build->failed)
        return;
    const ty_shape_vertex* v = build->vertices;
    float ac = ty_length_sqr(ty_sub(v[a].position, v[c].position));
    float bd = ty_length_sqr(ty_sub(v[b].position, v[d].position));
    bool first = ac <= bd;
    ty_shape_add_triangle(build, a, b, first ? c : d);
    ty_shape_add_triangle(build, first ? a : b, c, d);
}

void ty_shape_set_curvature(ty_shape_vertex* vertex, double k_u, double k_v, ty_vec3 u, ty_vec3 v)
{
    vertex->curvature_1 = (float)fmax(k_u, k_v);
    vertex->curvature_2 = (float)fmin(k_u, k_v);
    vertex->direction = k_u >= k_v ? u : v;
}

void ty_shape_build_term(ty_shape_build* build)
{
    ty_free(build->vertices);
    ty_free(build->triangles);
    *build = (ty_shape_build){0};
}

static bool fill_mesh(const ty_shape_build* build, ty_mesh* mesh)
{
    mesh->uvs = TY_TRY_ALLOC(ty_vec2, build->vertex_count);
    mesh->curvature_1 = TY_TRY_ALLOC(float, build->vertex_count);
    mesh->curvature_2 = TY_TRY_ALLOC(float, build->vertex_count);
    mesh->direction_1 = TY_TRY_ALLOC(ty_vec3, build->vertex_count);
    if (!mesh->uvs || !mesh->curvature_1 || !mesh->curvature_2 || !mesh->direction_1)
        return false;
    for (size_t i = 0; i < build->vertex_count; i++)
    {
        const ty_shape_vertex* v = &build->vertices[i];
        mesh->positions[i] = v->position;
        mesh->normals[i] = ty_normalize(v->normal);
        mesh->uvs[i] = v->uv;
        mesh->curvature_1[i] = v->curvature_1;
        mesh->curvature_2[i] = v->curvature_2;
        mesh->direction_1[i] = ty_normalize(v->direction);
    }
    for (size_t i = 0; i < build->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            mesh->triangles[i][k] = build->triangles[i][k];
    return true;
}

ty_status ty_shape_finish(ty_shape_build* build, ty_mesh** out, ty_error* error)
{
    *out = NULL;
    ty_mesh* mesh = NULL;
    if (!build->failed)
        mesh = ty_mesh_create((uint32_t)build->vertex_count, (uint32_t)build->triangle_count);
    bool filled = mesh && fill_mesh(build, mesh);
    ty_shape_build_term(build);
    if (!filled)
    {
        ty_mesh_destroy(mesh);
        return ty_error_set(error, TY_NO_MEMORY, "no memory for the mesh of a shape: fewer divisions need less");
    }
    ty_mesh_compute_bounds(mesh);
    ty_mesh_compute_welds(mesh);
    *out = mesh;
    return TY_OK;
}
