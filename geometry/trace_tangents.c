// SPDX-License-Identifier: Apache-2.0
// How uv lies on the surface at a hit, and the part of the surface that a ray's cone covers.
#include "trace_world.h"

bool ty_world_tangents(const ty_world* world, const ty_surface_point* point, ty_vec3* dpdu, ty_vec3* dpdv)
{
    *dpdu = *dpdv = (ty_vec3){0};
    const ty_mesh* mesh = ty_world_mesh(world, point->object, point->instance);
    if (!mesh->uvs)
        return false;
    const uint32_t* v = mesh->triangles[point->triangle];
    ty_vec3 p[3];
    bool steps = mesh->step_count > 0 && !world->objects[point->object].aggregate;
    for (int i = 0; i < 3; i++)
        p[i] = steps ? ty_trace_step_value(mesh, mesh->step_positions, v[i], point->time) : mesh->positions[v[i]];
    ty_vec3 e1 = ty_sub(p[1], p[0]), e2 = ty_sub(p[2], p[0]);
    ty_vec2 a = mesh->uvs[v[0]], b = mesh->uvs[v[1]], c = mesh->uvs[v[2]];
    float u1 = b.x - a.x, v1 = b.y - a.y, u2 = c.x - a.x, v2 = c.y - a.y;
    float determinant = u1 * v2 - u2 * v1, scale = 1.0f / determinant;
    if (!(fabsf(scale) < TY_FLOAT_MAX))
        return false;
    ty_affine to_world = ty_world_to_world(world, point->object, point->instance, point->time);
    ty_vec3 pu = ty_map_vector(&to_world, ty_mul(ty_sub(ty_mul(e1, v2), ty_mul(e2, v1)), scale));
    ty_vec3 pv = ty_map_vector(&to_world, ty_mul(ty_sub(ty_mul(e2, u1), ty_mul(e1, u2)), scale));
    float area = ty_length_sqr(ty_cross(pu, pv));
    if (!(area > 0.0f) || !(area < TY_FLOAT_MAX))
        return false;
    *dpdu = pu;
    *dpdv = pv;
    return true;
}

void ty_surface_set_footprint(ty_surface_point* point, ty_vec3 direction, float width)
{
    float cosine = ty_dot(point->ng, direction), radius = 0.5f * width;
    ty_vec3 along = ty_mad(direction, point->ng, -cosine);
    float sine = ty_length(along);
    // Straight on the ellipse is a circle, and any axes will do.
    along = sine > 1e-4f ? ty_mul(along, 1.0f / sine) : ty_frame_from_normal(point->ng).t;
    point->footprint[0] = ty_mul(along, radius / ty_max(fabsf(cosine), 1e-4f));
    point->footprint[1] = ty_mul(ty_cross(point->ng, along), radius);
}
