// SPDX-License-Identifier: Apache-2.0
// Textures on surfaces: by their uv or along three axes, averaged over the footprint of the ray.
#include "input_texture.h"
#include "curvature_at.h"

// Where a texture is looked up, and how uv change across the two diameters of the footprint.
typedef struct lookup
{
    ty_vec2 uv, du, dv;
} lookup;

static ty_vec2 map_uv(const ty_input* input, ty_vec2 d)
{
    return (ty_vec2){input->uv_x.x * d.x + input->uv_y.x * d.y, input->uv_x.y * d.x + input->uv_y.y * d.y};
}

static ty_texel sample(const ty_input* input, const ty_shading_context* context, lookup l)
{
    ty_vec2 uv = map_uv(input, l.uv);
    return ty_mip_texture_sample(context->textures[input->texture_index],
                                 (ty_vec2){uv.x + input->uv_t.x, uv.y + input->uv_t.y}, map_uv(input, l.du),
                                 map_uv(input, l.dv));
}

static bool has_footprint(const ty_surface_point* point)
{
    return ty_length_sqr(point->footprint[0]) > 0.0f;
}

// d = dpdu s + dpdv t in the triangle's plane: what changes of uv a step d brings, twice (a diameter for a half axis).
static ty_vec2 uv_change(ty_vec3 d, ty_vec3 dpdu, ty_vec3 dpdv, ty_vec3 n)
{
    float scale = 2.0f / ty_length_sqr(n);
    return (ty_vec2){ty_dot(ty_cross(d, dpdv), n) * scale, ty_dot(ty_cross(dpdu, d), n) * scale};
}

static lookup by_uv(const ty_shading_context* context, const ty_surface_point* point)
{
    lookup l = {.uv = point->uv};
    ty_vec3 dpdu, dpdv;
    if (!has_footprint(point) || !ty_world_tangents(context->world, point, &dpdu, &dpdv))
        return l;
    ty_vec3 n = ty_cross(dpdu, dpdv);
    l.du = uv_change(point->footprint[0], dpdu, dpdv, n);
    l.dv = uv_change(point->footprint[1], dpdu, dpdv, n);
    return l;
}

// --- along axes ---

// The point in the space whose axes count, in repetitions of the texture.
typedef struct local_point
{
    ty_vec3 position, normal, footprint[2];
} local_point;

// One repetition is as long on the object as the scene says, however large the instance is.
static local_point to_local(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point)
{
    if (input->space == TY_SPACE_WORLD)
        return (local_point){
            ty_mul(point->position, 1.0f / input->size),
            point->ns,
            {ty_mul(point->footprint[0], 2.0f / input->size), ty_mul(point->footprint[1], 2.0f / input->size)}};
    ty_affine world = ty_world_to_world(context->world, point->object, point->instance, point->time);
    ty_affine local = ty_world_to_local(context->world, point->object, point->instance, point->time);
    float scale = ty_instance_scale(&world) / input->size;
    return (local_point){ty_mul(ty_map_point(&local, point->position), scale),
                         ty_normalize(ty_map_transpose(&world, point->ns)),
                         {ty_mul(ty_map_vector(&local, point->footprint[0]), 2.0f * scale),
                          ty_mul(ty_map_vector(&local, point->footprint[1]), 2.0f * scale)}};
}

// As seen from the side that the normal is on, so that nothing is mirrored: right and up on the sides, on top and
// bottom right and away from the front.
static ty_vec2 project(ty_vec3 v, int axis, float side)
{
    switch (axis)
    {
    case 0:
        return (ty_vec2){-side * v.z, v.y};
    case 1:
        return (ty_vec2){v.x, -side * v.z};
    default:
        return (ty_vec2){side * v.x, v.y};
    }
}

// Shares of the three directions: continuous in the normal, 0 where a direction sees the surface from its edge.
static void weigh(ty_vec3 n, float blend, float weight[3])
{
    const float c[3] = {fabsf(n.x), fabsf(n.y), fabsf(n.z)};
    float most = ty_max(c[0], ty_max(c[1], c[2])), least = (1.0f - ty_clamp(blend, 1e-3f, 1.0f)) * most, sum = 0.0f;
    for (int i = 0; i < 3; i++)
        sum += weight[i] = ty_max(c[i] - least, 0.0f);
    for (int i = 0; i < 3; i++)
        weight[i] = sum > 0.0f ? weight[i] / sum : i == 1 ? 1.0f : 0.0f;
}

static lookup along(const local_point* p, int axis, float side)
{
    return (lookup){project(p->position, axis, side), project(p->footprint[0], axis, side),
                    project(p->footprint[1], axis, side)};
}

static ty_texel planar(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point)
{
    local_point p = to_local(input, context, point);
    return sample(input, context, along(&p, 1, 1.0f));
}

static ty_texel triplanar(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point)
{
    local_point p = to_local(input, context, point);
    const float side[3] = {copysignf(1.0f, p.normal.x), copysignf(1.0f, p.normal.y), copysignf(1.0f, p.normal.z)};
    float weight[3];
    ty_texel sum = {{0.0f, 0.0f, 0.0f}, 0.0f};
    weigh(p.normal, input->blend, weight);
    for (int axis = 0; axis < 3; axis++)
    {
        if (weight[axis] <= 0.0f)
            continue;
        ty_texel texel = sample(input, context, along(&p, axis, side[axis]));
        sum.rgb = ty_rgb_add(sum.rgb, ty_rgb_scale(texel.rgb, weight[axis]));
        sum.alpha += texel.alpha * weight[axis];
    }
    return sum;
}

static ty_rgb channel_of(const ty_texel* texel, ty_input_channel channel)
{
    switch (channel)
    {
    case TY_CHANNEL_ALL:
        break;
    case TY_CHANNEL_R:
        return ty_rgb_grey(texel->rgb.r);
    case TY_CHANNEL_G:
        return ty_rgb_grey(texel->rgb.g);
    case TY_CHANNEL_B:
        return ty_rgb_grey(texel->rgb.b);
    case TY_CHANNEL_A:
        return ty_rgb_grey(texel->alpha);
    case TY_CHANNEL_LUMINANCE:
        return ty_rgb_grey(ty_luminance(texel->rgb));
    }
    return texel->rgb;
}

ty_rgb ty_input_texel(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point)
{
    ty_texel texel = input->mapping == TY_MAPPING_TRIPLANAR ? triplanar(input, context, point)
                     : input->mapping == TY_MAPPING_PLANAR  ? planar(input, context, point)
                                                            : sample(input, context, by_uv(context, point));
    return channel_of(&texel, (ty_input_channel)input->channel);
}
