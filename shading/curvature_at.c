// SPDX-License-Identifier: Apache-2.0
// Interpolated curvature. The second fundamental form is interpolated, not its axes: those have no sign and jump.
#include "curvature_at.h"

float ty_instance_scale(const ty_affine* to_world)
{
    float det = fabsf(ty_affine_determinant(to_world));
    return fabsf(det - 1.0f) < 1e-5f ? 1.0f : ty_pow(det, 1.0f / 3.0f);
}

float ty_mean_curvature(const ty_world* world, const ty_surface_point* point)
{
    const ty_mesh* mesh = ty_world_mesh(world, point->object, point->instance);
    if (!mesh->curvature_1 || !mesh->curvature_2)
        return 0.0f;
    float k1 = ty_world_interpolate(world, point, mesh->curvature_1);
    float k2 = ty_world_interpolate(world, point, mesh->curvature_2);
    ty_affine to_world = ty_world_to_world(world, point->object, point->instance, point->time);
    return 0.5f * (k1 + k2) / ty_instance_scale(&to_world);
}

void ty_second_form(const ty_world* world, const ty_surface_point* point, ty_vec3 t, ty_vec3 b, float form[3])
{
    form[0] = form[1] = form[2] = 0.0f;
    const ty_mesh* mesh = ty_world_mesh(world, point->object, point->instance);
    if (!mesh->curvature_1 || !mesh->curvature_2)
        return;
    ty_affine to_world = ty_world_to_world(world, point->object, point->instance, point->time);
    const uint32_t* corner = mesh->triangles[point->triangle];
    const float share[3] = {1.0f - point->u - point->v, point->u, point->v};
    float per_scale = 1.0f / ty_instance_scale(&to_world);
    for (int i = 0; i < 3; i++)
    {
        float k1 = mesh->curvature_1[corner[i]], k2 = mesh->curvature_2[corner[i]], c = 0.707106781f, s = c;
        if (mesh->direction_1)
        {
            ty_vec3 e = ty_map_vector(&to_world, mesh->direction_1[corner[i]]);
            float et = ty_dot(e, t), eb = ty_dot(e, b), length_sqr = et * et + eb * eb;
            float inverse = length_sqr > 0.0f ? 1.0f / sqrtf(length_sqr) : 0.0f;
            c = et * inverse;
            s = eb * inverse;
        }
        else
            k1 = k2 = 0.5f * (k1 + k2);
        float w = share[i] * per_scale;
        form[0] += w * (k1 * c * c + k2 * s * s);
        form[1] += w * (k1 - k2) * c * s;
        form[2] += w * (k1 * s * s + k2 * c * c);
    }
}
