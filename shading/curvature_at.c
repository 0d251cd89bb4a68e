// SPDX-License-Identifier: Apache-2.0
// Interpolated curvature. The second fundamental form is interpolated, not its axes: those have no sign and jump.
#include "curvature_at.h"

float ty_instance_scale(const ty_affine* to_world)
{
    float det = fabsf(ty_affine_determinant(to_world));
    return fabsf(det - 1.0f) < 1e-5f ? 1.0f : ty_pow(det, 1.0f / 3.0f);
}

ty_form ty_form_local(const ty_mesh* mesh, const ty_surface_point* point, ty_vec3 t, ty_vec3 b)
{
    ty_form form = {0};
    if (!mesh->curvature_1 || !mesh->curvature_2)
        return form;
    const uint32_t* corner = mesh->triangles[point->triangle];
    const float share[3] = {1.0f - point->u - point->v, point->u, point->v};
    float tt = ty_length_sqr(t), tb = ty_dot(t, b), bb = ty_length_sqr(b);
    for (int i = 0; i < 3; i++)
    {
        // k1 e1 e1 + k2 e2 e2 = k2 I + (k1 - k2) e1 e1
        float k1 = mesh->curvature_1[corner[i]], k2 = mesh->curvature_2[corner[i]], et = 0.0f, eb = 0.0f;
        if (mesh->direction_1)
        {
            et = ty_dot(mesh->direction_1[corner[i]], t);
            eb = ty_dot(mesh->direction_1[corner[i]], b);
        }
        else
            k1 = k2 = 0.5f * (k1 + k2);
        form.tt += share[i] * (k2 * tt + (k1 - k2) * et * et);
        form.tb += share[i] * (k2 * tb + (k1 - k2) * et * eb);
        form.bb += share[i] * (k2 * bb + (k1 - k2) * eb * eb);
    }
    return form;
}

// The form of the mapped surface at tangents t and b is that of the prototype at M^-1 t and M^-1 b, over how far the
// map brings tangent planes closer, |M^-T n|.
ty_form ty_form_world(const ty_world* world, const ty_surface_point* point, ty_vec3 t, ty_vec3 b)
{
    const ty_mesh* mesh = ty_world_mesh(world, point->object, point->instance);
    ty_affine to_world = ty_world_to_world(world, point->object, point->instance, point->time);
    float stretch_sqr;
    if (ty_keeps_angles(&to_world, &stretch_sqr))
    {
        // M^-1 is M^T over the stretch squared
        float stretch = sqrtf(stretch_sqr), over = 1.0f / stretch_sqr;
        ty_form f = ty_form_local(mesh, point, ty_map_transpose(&to_world, t), ty_map_transpose(&to_world, b));
        float scale = stretch * over * over;
        return (ty_form){f.tt * scale, f.tb * scale, f.bb * scale};
    }
    ty_affine to_local = ty_world_to_local(world, point->object, point->instance, point->time);
    ty_form form = ty_form_local(mesh, point, ty_map_vector(&to_local, t), ty_map_vector(&to_local, b));
    // ns is M^-T n over its length, so M^T ns is n over |M^-T n|
    float closer = ty_length(ty_map_transpose(&to_world, point->ns));
    return (ty_form){form.tt * closer, form.tb * closer, form.bb * closer};
}
