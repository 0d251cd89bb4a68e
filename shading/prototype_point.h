// SPDX-License-Identifier: Apache-2.0
// A point of a surface in its prototype's space, exact to rounding there however far away the instance is.
#pragma once
#include <tsuya/geometry/trace.h>

static inline ty_vec3 ty_prototype_point(const ty_mesh* mesh, const ty_surface_point* x)
{
    const uint32_t* v = mesh->triangles[x->triangle];
    ty_vec3 p = ty_mul(mesh->positions[v[0]], 1.0f - x->u - x->v);
    return ty_mad(ty_mad(p, mesh->positions[v[1]], x->u), mesh->positions[v[2]], x->v);
}

// Outward, of twice the triangle's area.
static inline ty_vec3 ty_prototype_normal(const ty_mesh* mesh, uint32_t triangle)
{
    const uint32_t* v = mesh->triangles[triangle];
    const ty_vec3* q = mesh->positions;
    return ty_cross(ty_sub(q[v[1]], q[v[0]]), ty_sub(q[v[2]], q[v[0]]));
}
