// SPDX-License-Identifier: Apache-2.0
// Half edges of a welded mesh in the order of their edges, disjoint sets, and faces in double precision.
#pragma once
#include <tsuya/geometry/mesh.h>

// Half edge h = 3 triangle + k runs from corner k to corner k + 1 of its triangle.
static inline uint32_t ty_half_edge_start(const ty_mesh* mesh, size_t h)
{
    return mesh->welds[mesh->triangles[h / 3][h % 3]];
}
static inline uint32_t ty_half_edge_end(const ty_mesh* mesh, size_t h)
{
    return mesh->welds[mesh->triangles[h / 3][(h % 3 + 1) % 3]];
}

// Two corners at one position: no area and no part in the topology.
bool ty_triangle_is_collapsed(const ty_mesh* mesh, size_t triangle);

// All half edges of triangles that are not collapsed, sorted by their two ends (without regard to direction), then by
// number. The caller frees the array. Linear time.
size_t* ty_mesh_sort_half_edges(const ty_mesh* mesh, size_t* count);

// The number of half edges from begin on that lie on the same edge.
size_t ty_half_edge_run(const ty_mesh* mesh, const size_t* sorted, size_t begin, size_t count);

// Disjoint sets over size_t; parents[i] = i to begin with. The smaller root wins.
static inline size_t ty_set_find(size_t* parents, size_t i)
{
    while (parents[i] != i)
        i = parents[i] = parents[parents[i]];
    return i;
}
static inline void ty_set_join(size_t* parents, size_t a, size_t b)
{
    a = ty_set_find(parents, a);
    b = ty_set_find(parents, b);
    parents[a < b ? b : a] = a < b ? a : b;
}

typedef struct ty_double3
{
    double x, y, z;
} ty_double3;

static inline ty_double3 ty_double3_between(ty_vec3 from, ty_vec3 to)
{
    return (ty_double3){(double)to.x - from.x, (double)to.y - from.y, (double)to.z - from.z};
}
static inline double ty_double3_dot(ty_double3 a, ty_double3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline ty_double3 ty_double3_cross(ty_double3 a, ty_double3 b)
{
    return (ty_double3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline ty_double3 ty_double3_scale(ty_double3 a, double s)
{
    return (ty_double3){a.x * s, a.y * s, a.z * s};
}
// Zero stays zero.
static inline ty_double3 ty_double3_normalize(ty_double3 a)
{
    double l = sqrt(ty_double3_dot(a, a));
    return l > 0.0 ? ty_double3_scale(a, 1.0 / l) : a;
}
// Twice the area long, outward.
static inline ty_double3 ty_triangle_cross(const ty_mesh* mesh, size_t triangle)
{
    const uint32_t* c = mesh->triangles[triangle];
    const ty_vec3* p = mesh->positions;
    return ty_double3_cross(ty_double3_between(p[c[0]], p[c[1]]), ty_double3_between(p[c[0]], p[c[2]]));
}
