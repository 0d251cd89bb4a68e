// SPDX-License-Identifier: Apache-2.0
// Angle-weighted vertex normals over welded vertices, with vertices split where an edge is sharper than the crease.
#include "mesh_edges.h"
#include <string.h>

// The angle of the triangle at its corner k.
static float corner_angle(const ty_mesh* mesh, size_t triangle, size_t k)
{
    const uint32_t* c = mesh->triangles[triangle];
    const ty_vec3* p = mesh->positions;
    ty_double3 u = ty_double3_normalize(ty_double3_between(p[c[k]], p[c[(k + 1) % 3]]));
    ty_double3 v = ty_double3_normalize(ty_double3_between(p[c[k]], p[c[(k + 2) % 3]]));
    ty_double3 cross = ty_double3_cross(u, v);
    return ty_atan2((float)sqrt(ty_double3_dot(cross, cross)), (float)ty_double3_dot(u, v));
}

// Joins the corners of two triangles at both ends of their common edge. Consecutive corners are enough on an edge of
// more than two triangles, and keep the cost linear.
static void join_across(const ty_mesh* mesh, size_t* parents, size_t h1, size_t h2)
{
    size_t next1 = h1 - h1 % 3 + (h1 % 3 + 1) % 3, next2 = h2 - h2 % 3 + (h2 % 3 + 1) % 3;
    bool same = ty_half_edge_start(mesh, h1) == ty_half_edge_start(mesh, h2);
    ty_set_join(parents, h1, same ? h2 : next2);
    ty_set_join(parents, next1, same ? next2 : h2);
}

// Each corner's root is the smallest corner of those at the same position that share a normal.
static size_t* group_corners(const ty_mesh* mesh, const ty_double3* face_normals, float crease)
{
    size_t corners = 3 * (size_t)mesh->triangle_count;
    size_t* parents = TY_ALLOC(size_t, corners);
    for (size_t i = 0; i < corners; i++)
        parents[i] = i;
    size_t count;
    size_t* sorted = ty_mesh_sort_half_edges(mesh, &count);
    double least = (double)ty_cos(ty_max(crease, 0.0f));
    for (size_t i = 0, run; i < count; i += run)
    {
        run = ty_half_edge_run(mesh, sorted, i, count);
        for (size_t k = 1; k < run; k++)
        {
            size_t h1 = sorted[i + k - 1], h2 = sorted[i + k];
            if (ty_double3_dot(face_normals[h1 / 3], face_normals[h2 / 3]) >= least)
                join_across(mesh, parents, h1, h2);
        }
    }
    ty_free(sorted);
    return parents;
}

// All corners at one position share a normal.
static size_t* group_welds(const ty_mesh* mesh)
{
    size_t corners = 3 * (size_t)mesh->triangle_count;
    size_t* groups = TY_ALLOC(size_t, corners);
    size_t* first = TY_ALLOC(size_t, mesh->vertex_count); // corner + 1
    for (size_t i = 0; i < corners; i++)
    {
        size_t* f = &first[ty_half_edge_start(mesh, i)];
        if (!*f)
            *f = i + 1;
        groups[i] = *f - 1;
    }
    ty_free(first);
    return groups;
}

// The sum for each group stands at its root corner.
static ty_double3* sum_normals(const ty_mesh* mesh, size_t* groups, const ty_double3* face_normals)
{
    size_t corners = 3 * (size_t)mesh->triangle_count;
    ty_double3* sums = TY_ALLOC(ty_double3, corners);
    for (size_t i = 0; i < corners; i++)
    {
        ty_double3 n = ty_double3_scale(face_normals[i / 3], (double)corner_angle(mesh, i / 3, i % 3));
        groups[i] = ty_set_find(groups, i);
        ty_double3* sum = &sums[groups[i]];
        *sum = (ty_double3){sum->x + n.x, sum->y + n.y, sum->z + n.z};
    }
    return sums;
}

// The corners in the order of their vertices.
static size_t* sort_corners(const ty_mesh* mesh)
{
    size_t corners = 3 * (size_t)mesh->triangle_count;
    size_t* begin = TY_ALLOC(size_t, (size_t)mesh->vertex_count + 1);
    size_t* order = TY_ALLOC(size_t, corners);
    for (size_t i = 0; i < corners; i++)
        begin[mesh->triangles[i / 3][i % 3] + 1]++;
    for (size_t v = 0; v < mesh->vertex_count; v++)
        begin[v + 1] += begin[v];
    for (size_t i = 0; i < corners; i++)
        order[begin[mesh->triangles[i / 3][i % 3]]++] = i;
    ty_free(begin);
    return order;
}

// Gives each (vertex, group) pair a vertex of its own: corners are renamed, and source[] tells what each new vertex
// copies. group_of holds the group + 1 of each vertex (0 = used by no triangle). Returns the new vertex count.
static size_t split_vertices(ty_mesh* mesh, const size_t* groups, uint32_t* source, size_t* group_of)
{
    size_t corners = 3 * (size_t)mesh->triangle_count, count = mesh->vertex_count;
    size_t* order = sort_corners(mesh);
    uint32_t* vertex_of = TY_ALLOC(uint32_t, corners); // of each group, for the old vertex at hand
    size_t* owner = TY_ALLOC(size_t, corners);         // that old vertex + 1
    for (size_t i = 0; i < corners; i++)
    {
        uint32_t* v = &mesh->triangles[order[i] / 3][order[i] % 3];
        size_t group = groups[order[i]];
        if (owner[group] != (size_t)*v + 1)
        {
            TY_ASSERT(count < UINT32_MAX);
            owner[group] = (size_t)*v + 1;
            source[count] = *v;
            vertex_of[group] = group_of[*v] ? (uint32_t)count++ : *v;
            group_of[vertex_of[group]] = group + 1;
        }
        *v = vertex_of[group];
    }
    ty_free(owner);
    ty_free(vertex_of);
    ty_free(order);
    return count;
}

// An array over vertices (NULL stays NULL) grown to count, the new ones copied from their sources.
static void* extend(void* array, size_t old_count, size_t count, size_t size, const uint32_t* source)
{
    if (!array)
        return NULL;
    char* grown = ty_grow(array, old_count, count, size);
    for (size_t i = old_count; i < count; i++)
        memcpy(grown + i * size, grown + source[i] * size, size);
    return grown;
}

static void extend_vertices(ty_mesh* mesh, size_t count, const uint32_t* source)
{
    size_t old = mesh->vertex_count;
    mesh->positions = extend(mesh->positions, old, count, sizeof(ty_vec3), source);
    mesh->normals = extend(mesh->normals, old, count, sizeof(ty_vec3), source);
    mesh->uvs = extend(mesh->uvs, old, count, sizeof(ty_vec2), source);
    mesh->welds = extend(mesh->welds, old, count, sizeof(uint32_t), source);
    mesh->curvature_1 = extend(mesh->curvature_1, old, count, sizeof(float), source);
    mesh->curvature_2 = extend(mesh->curvature_2, old, count, sizeof(float), source);
    mesh->direction_1 = extend(mesh->direction_1, old, count, sizeof(ty_vec3), source);
    for (int i = 0; i < mesh->attribute_count; i++)
    {
        size_t size = sizeof(float) * (size_t)mesh->attributes[i].components;
        mesh->attributes[i].values = extend(mesh->attributes[i].values, old, count, size, source);
    }
    mesh->vertex_count = (uint32_t)count;
}

void ty_mesh_compute_normals(ty_mesh* mesh, float crease)
{
    size_t corners = 3 * (size_t)mesh->triangle_count;
    if (!mesh->welds)
        ty_mesh_compute_welds(mesh);
    ty_double3* face_normals = TY_ALLOC(ty_double3, mesh->triangle_count);
    for (size_t t = 0; t < mesh->triangle_count; t++)
        face_normals[t] = ty_double3_normalize(ty_triangle_cross(mesh, t));
    size_t* groups = crease >= TY_PI ? group_welds(mesh) : group_corners(mesh, face_normals, crease);
    ty_double3* sums = sum_normals(mesh, groups, face_normals);
    uint32_t* source = TY_ALLOC(uint32_t, mesh->vertex_count + corners);
    size_t* group_of = TY_ALLOC(size_t, mesh->vertex_count + corners);
    size_t count = split_vertices(mesh, groups, source, group_of);
    extend_vertices(mesh, count, source);
    for (size_t i = 0; i < count; i++)
    {
        // Vertices of no triangle, and groups without area, still get a unit vector.
        ty_double3 n = group_of[i] ? ty_double3_normalize(sums[group_of[i] - 1]) : (ty_double3){0, 0, 0};
        ty_vec3 normal = {(float)n.x, (float)n.y, (float)n.z};
        mesh->normals[i] = ty_length_sqr(normal) > 0.0f ? ty_normalize(normal) : (ty_vec3){0, 1, 0};
    }
    ty_free(group_of);
    ty_free(source);
    ty_free(sums);
    ty_free(groups);
    ty_free(face_normals);
}
