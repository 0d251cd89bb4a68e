// SPDX-License-Identifier: Apache-2.0
// Perspective, orthographic and all-round projection, with a thin lens.
#include "camera.h"

static void set_lens(ty_camera* camera, const ty_camera_def* def)
{
    camera->focus_distance = def->focus_distance;
    if (!(def->focus_distance > 0.0f))
        camera->focus_distance = ty_camera_depth(camera, def->has_focus_point ? def->focus_point : def->look_at);
    if (camera->projection == TY_PROJECTION_EQUIRECTANGULAR || !(camera->focus_distance > 0.0f))
        return;
    if (def->aperture > 0.0f)
        camera->lens_radius = 0.5f * def->aperture;
    else if (def->f_stop > 0.0f && camera->projection == TY_PROJECTION_PERSPECTIVE)
        camera->lens_radius = 0.5f * (def->film_height / (2.0f * camera->half_height)) / def->f_stop;
    ty_lens_init(&camera->lens, def);
}

void ty_camera_init(ty_camera* camera, const ty_camera_def* def, const int size[2])
{
    ty_affine to_world = ty_affine_look_at(def->position, def->look_at, def->up);
    float half_angle = 0.5f * def->vfov, half_height = ty_sin(half_angle) / ty_cos(half_angle);
    if (def->projection == TY_PROJECTION_ORTHOGRAPHIC)
        half_height = 0.5f * def->ortho_height;
    *camera = (ty_camera){
        .projection = (ty_projection)def->projection,
        .origin = def->position,
        .right = to_world.x,
        .up = to_world.y,
        .forward = ty_neg(to_world.z),
        .half_width = half_height * (float)size[0] / (float)size[1],
        .half_height = half_height,
        .shift = {2.0f * def->shift[0], 2.0f * def->shift[1]},
        .inverse_size = {1.0f / (float)size[0], 1.0f / (float)size[1]},
        .near_clip = def->near_clip,
        .far_clip = def->far_clip > 0.0f ? def->far_clip : TY_FLOAT_MAX,
    };
    set_lens(camera, def);
}

// Right-handed axes from interpolated ones.
static void straighten(ty_camera* camera)
{
    camera->forward = ty_normalize(camera->forward);
    camera->right = ty_normalize(ty_mad(camera->right, camera->forward, -ty_dot(camera->right, camera->forward)));
    camera->up = ty_cross(camera->right, camera->forward);
}

void ty_camera_at(const ty_camera* steps, int count, float time, ty_camera* out)
{
    float at = ty_clamp(time, 0.0f, 1.0f) * (float)(count - 1);
    int i = (int)at < count - 1 ? (int)at : count > 1 ? count - 2 : 0;
    const ty_camera *a = &steps[i], *b = &steps[count > 1 ? i + 1 : 0];
    float s = at - (float)i;
    *out = *a;
    out->origin = ty_lerp3(a->origin, b->origin, s);
    out->right = ty_lerp3(a->right, b->right, s);
    out->forward = ty_lerp3(a->forward, b->forward, s);
    straighten(out);
    out->half_width = ty_lerp(a->half_width, b->half_width, s);
    out->half_height = ty_lerp(a->half_height, b->half_height, s);
    out->shift[0] = ty_lerp(a->shift[0], b->shift[0], s);
    out->shift[1] = ty_lerp(a->shift[1], b->shift[1], s);
    out->lens_radius = ty_lerp(a->lens_radius, b->lens_radius, s);
    out->focus_distance = ty_lerp(a->focus_distance, b->focus_distance, s);
    out->near_clip = ty_lerp(a->near_clip, b->near_clip, s);
}

static float across(const ty_camera* camera, float x)
{
    return (2.0f * x * camera->inverse_size[0] - 1.0f + camera->shift[0]) * camera->half_width;
}

static float upwards(const ty_camera* camera, float y)
{
    return (1.0f - 2.0f * y * camera->inverse_size[1] + camera->shift[1]) * camera->half_height;
}

// From the lens towards the plane of focus. direction is per metre along the axis; clips are along the axis.
static ty_ray finish(const ty_camera* camera, ty_ray ray, ty_vec3 direction, ty_vec2 lens)
{
    if (camera->lens_radius > 0.0f)
    {
        ty_vec2 p = ty_lens_sample(&camera->lens, lens);
        ty_vec3 shift = ty_mul(ty_mad(ty_mul(camera->right, p.x), camera->up, p.y), camera->lens_radius);
        ray.origin = ty_add(ray.origin, shift);
        direction = ty_mad(direction, shift, -1.0f / camera->focus_distance);
    }
    float length = ty_length(direction); // 1 / cosine to the axis
    ray.direction = ty_mul(direction, 1.0f / length);
    ray.t_min = camera->near_clip * length;
    if (camera->far_clip < TY_FLOAT_MAX)
        ray.t_max = camera->far_clip * length;
    return ray;
}

// Longitude grows to the right, latitude upwards; over the poles it goes down on the other side.
static ty_ray all_round(const ty_camera* camera, ty_ray ray, float x, float y)
{
    float longitude = 2.0f * TY_PI * (x * camera->inverse_size[0] - 0.5f), so, co;
    float latitude = TY_PI * (0.5f - y * camera->inverse_size[1]), sa, ca;
    ty_sincos(longitude, &so, &co);
    ty_sincos(latitude, &sa, &ca);
    ray.direction =
        ty_normalize(ty_mad(ty_mad(ty_mul(camera->forward, ca * co), camera->right, ca * so), camera->up, sa));
    ray.t_min = camera->near_clip;
    ray.t_max = camera->far_clip;
    return ray;
}

ty_ray ty_camera_ray(const ty_camera* camera, float x, float y, ty_vec2 lens)
{
    ty_ray ray = ty_ray_make(camera->origin, camera->forward, TY_FLOAT_MAX);
    ray.mask = TY_MASK_CAMERA;
    if (camera->projection == TY_PROJECTION_EQUIRECTANGULAR)
        return all_round(camera, ray, x, y);
    float sx = across(camera, x), sy = upwards(camera, y);
    ty_vec3 direction = camera->forward; // to the plane at distance 1
    if (camera->projection == TY_PROJECTION_ORTHOGRAPHIC)
        ray.origin = ty_mad(ty_mad(ray.origin, camera->right, sx), camera->up, sy);
    else
        direction = ty_mad(ty_mad(direction, camera->right, sx), camera->up, sy);
    return finish(camera, ray, direction, lens);
}

float ty_camera_depth(const ty_camera* camera, ty_vec3 p)
{
    ty_vec3 way = ty_sub(p, camera->origin);
    return camera->projection == TY_PROJECTION_EQUIRECTANGULAR ? ty_length(way) : ty_dot(way, camera->forward);
}

// Row vectors: column c of m is what coordinate c takes from (x, y, z, 1).
static void set_column(float m[16], int column, ty_vec3 axis, float offset)
{
    m[column] = axis.x;
    m[4 + column] = axis.y;
    m[8 + column] = axis.z;
    m[12 + column] = offset;
}

static void set_axis(float m[16], int column, const ty_camera* camera, ty_vec3 axis, float offset)
{
    set_column(m, column, axis, offset - ty_dot(axis, camera->origin));
}

void ty_camera_world_to_camera(const ty_camera* camera, float m[16])
{
    set_axis(m, 0, camera, camera->right, 0.0f);
    set_axis(m, 1, camera, camera->up, 0.0f);
    set_axis(m, 2, camera, camera->forward, 0.0f);
    set_column(m, 3, ty_vec3_make(0.0f, 0.0f, 0.0f), 1.0f);
}

// x = (1 - shift + right / half width) / 2 at distance 1, likewise y downwards; z = 1 - near / forward (perspective) or
// forward - near is for order alone.
bool ty_camera_world_to_ndc(const ty_camera* camera, float m[16])
{
    float middle[2] = {0.5f * (1.0f - camera->shift[0]), 0.5f * (1.0f + camera->shift[1])};
    ty_vec3 f = camera->forward, none = {0.0f, 0.0f, 0.0f};
    ty_vec3 right = ty_mul(camera->right, 0.5f / camera->half_width);
    ty_vec3 down = ty_mul(camera->up, -0.5f / camera->half_height);
    switch (camera->projection)
    {
    case TY_PROJECTION_PERSPECTIVE:
        set_axis(m, 0, camera, ty_mad(right, f, middle[0]), 0.0f);
        set_axis(m, 1, camera, ty_mad(down, f, middle[1]), 0.0f);
        set_axis(m, 2, camera, f, -camera->near_clip);
        set_axis(m, 3, camera, f, 0.0f);
        return true;
    case TY_PROJECTION_ORTHOGRAPHIC:
        set_axis(m, 0, camera, right, middle[0]);
        set_axis(m, 1, camera, down, middle[1]);
        set_axis(m, 2, camera, f, -camera->near_clip);
        set_column(m, 3, none, 1.0f);
        return true;
    case TY_PROJECTION_EQUIRECTANGULAR:
        break;
    }
    return false;
}
