// SPDX-License-Identifier: Apache-2.0
// Perspective projection with a thin lens.
#include "camera.h"
#include <tsuya/shading/sampling.h>

void ty_camera_init(ty_camera* camera, const ty_camera_def* def, const int size[2])
{
    ty_affine to_world = ty_affine_look_at(def->position, def->look_at, def->up);
    float half_angle = 0.5f * def->vfov, half_height = ty_sin(half_angle) / ty_cos(half_angle);
    *camera = (ty_camera){
        .origin = def->position,
        .right = to_world.x,
        .up = to_world.y,
        .forward = ty_neg(to_world.z),
        .half_width = half_height * (float)size[0] / (float)size[1],
        .half_height = half_height,
        .inverse_size = {1.0f / (float)size[0], 1.0f / (float)size[1]},
        .near_clip = def->near_clip,
    };
    camera->focus_distance = def->focus_distance;
    if (!(def->focus_distance > 0.0f))
        camera->focus_distance = ty_camera_depth(camera, def->has_focus_point ? def->focus_point : def->look_at);
    float focal_length = def->film_height / (2.0f * half_height);
    if (def->f_stop > 0.0f && camera->focus_distance > 0.0f)
        camera->lens_radius = 0.5f * focal_length / def->f_stop;
}

ty_ray ty_camera_ray(const ty_camera* camera, float x, float y, ty_vec2 lens)
{
    float sx = (2.0f * x * camera->inverse_size[0] - 1.0f) * camera->half_width;
    float sy = (1.0f - 2.0f * y * camera->inverse_size[1]) * camera->half_height;
    ty_vec3 direction =
        ty_mad(ty_mad(camera->forward, camera->right, sx), camera->up, sy); // to the plane at distance 1
    ty_ray ray = ty_ray_make(camera->origin, direction, TY_FLOAT_MAX);
    ray.mask = TY_MASK_CAMERA;
    if (camera->lens_radius > 0.0f)
    {
        ty_vec2 p = ty_sample_disc(lens);
        ty_vec3 shift = ty_mul(ty_mad(ty_mul(camera->right, p.x), camera->up, p.y), camera->lens_radius);
        ray.origin = ty_add(ray.origin, shift);
        direction = ty_mad(direction, shift, -1.0f / camera->focus_distance);
    }
    float length = ty_length(direction); // 1 / cosine to the axis
    ray.direction = ty_mul(direction, 1.0f / length);
    ray.t_min = camera->near_clip * length;
    return ray;
}

float ty_camera_depth(const ty_camera* camera, ty_vec3 p)
{
    return ty_dot(ty_sub(p, camera->origin), camera->forward);
}

// Row vectors: column c of m is what coordinate c takes from (x, y, z, 1).
static void set_column(float m[16], int column, ty_vec3 axis, float offset)
{
    m[column] = axis.x;
    m[4 + column] = axis.y;
    m[8 + column] = axis.z;
    m[12 + column] = offset;
}

void ty_camera_world_to_camera(const ty_camera* camera, float m[16])
{
    set_column(m, 0, camera->right, -ty_dot(camera->right, camera->origin));
    set_column(m, 1, camera->up, -ty_dot(camera->up, camera->origin));
    set_column(m, 2, camera->forward, -ty_dot(camera->forward, camera->origin));
    set_column(m, 3, ty_vec3_make(0.0f, 0.0f, 0.0f), 1.0f);
}

void ty_camera_world_to_ndc(const ty_camera* camera, float m[16])
{
    ty_vec3 f = camera->forward;
    // x / w = (1 + right / (half_width forward)) / 2, likewise y downwards; z / w = 1 - near / forward is for order
    // alone.
    ty_vec3 x = ty_mad(ty_mul(f, 0.5f), camera->right, 0.5f / camera->half_width);
    ty_vec3 y = ty_mad(ty_mul(f, 0.5f), camera->up, -0.5f / camera->half_height);
    set_column(m, 0, x, -ty_dot(x, camera->origin));
    set_column(m, 1, y, -ty_dot(y, camera->origin));
    set_column(m, 2, f, -ty_dot(f, camera->origin) - camera->near_clip);
    set_column(m, 3, f, -ty_dot(f, camera->origin));
}
