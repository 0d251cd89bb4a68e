// SPDX-License-Identifier: Apache-2.0
// The shading frame where maps bend it or the texture's direction turns it.
#include "bark.h"
#include "material_private.h"

// How the position moves with uv; where there is no uv, by any two directions, and uv stands still.
typedef struct tangents
{
    ty_vec3 u, v;
    bool mapped;
} tangents;

static tangents tangents_at(const ty_shading_context* context, const ty_surface_point* point)
{
    tangents t;
    t.mapped = context && context->world && ty_world_tangents(context->world, point, &t.u, &t.v);
    if (!t.mapped)
    {
        ty_frame frame = ty_frame_from_normal(point->ns);
        t.u = frame.t;
        t.v = frame.b;
    }
    return t;
}

static ty_vec3 along_surface(ty_vec3 v, ty_vec3 n)
{
    return ty_normalize(ty_mad(v, n, -ty_dot(v, n)));
}

// Directions of u and v across the normal; mirrored texture coordinates keep their sense.
static ty_frame texture_frame(const tangents* t, ty_vec3 n)
{
    ty_vec3 along = along_surface(t->u, n), across = ty_cross(n, along);
    if (!(ty_length_sqr(along) > 0.5f))
        return ty_frame_from_normal(n);
    return (ty_frame){along, ty_dot(across, t->v) < 0.0f ? ty_neg(across) : across, n};
}

static ty_vec3 mapped_normal(const ty_input* map, float strength, const ty_shading_context* context,
                             const ty_surface_point* point, const tangents* t, ty_vec3 n)
{
    ty_rgb texel = ty_input_color(map, context, point);
    ty_frame frame = texture_frame(t, n);
    ty_vec3 local = ty_vec3_make(strength * texel.r, strength * texel.g, ty_max(texel.b, 1e-3f));
    return ty_normalize(ty_to_world(frame, local));
}

// The point moved by d along the surface, uv with it.
static ty_surface_point moved(const ty_surface_point* point, const tangents* t, ty_vec3 d)
{
    ty_surface_point p = *point;
    p.position = ty_add(p.position, d);
    float uu = ty_dot(t->u, t->u), uv = ty_dot(t->u, t->v), vv = ty_dot(t->v, t->v), det = uu * vv - uv * uv;
    if (t->mapped && det > 0.0f)
    {
        float du = ty_dot(d, t->u), dv = ty_dot(d, t->v);
        p.uv.x += (vv * du - uv * dv) / det;
        p.uv.y += (uu * dv - uv * du) / det;
    }
    return p;
}

static float slope(const ty_input* height, const ty_shading_context* context, const ty_surface_point* point,
                   const tangents* t, ty_vec3 direction, float step)
{
    ty_surface_point before = moved(point, t, ty_mul(direction, -step)),
                     after = moved(point, t, ty_mul(direction, step));
    return (ty_input_float(height, context, &after) - ty_input_float(height, context, &before)) / (2.0f * step);
}

// Differences over the half of what the lookup averages; at least the texel of a picture of 2048.
static float slope_step(const ty_surface_point* point, const tangents* t)
{
    float seen = 0.5f * sqrtf(ty_max(ty_length_sqr(point->footprint[0]), ty_length_sqr(point->footprint[1])));
    float texel = t->mapped ? ty_max(ty_length(t->u), ty_length(t->v)) * (1.0f / 2048.0f) : 1e-5f;
    return ty_max(seen, texel);
}

// n - grad h (Mikkelsen 2010, "Bump mapping unparametrized surfaces on the GPU").
static ty_vec3 bumped_normal(const ty_input* height, const ty_shading_context* context, const ty_surface_point* point,
                             const tangents* t, ty_vec3 n)
{
    ty_frame frame = texture_frame(t, point->ns);
    float step = slope_step(point, t);
    n = ty_mad(n, frame.t, -slope(height, context, point, t, frame.t, step));
    return ty_normalize(ty_mad(n, frame.b, -slope(height, context, point, t, frame.b, step)));
}

void ty_shading_frame_bend(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    bool is_surface = material->model == TY_MODEL_SURFACE;
    const ty_input* map = is_surface ? &material->surface.normal : &material->cdrf.normal;
    const ty_input* bump = is_surface ? &material->surface.bump : &material->cdrf.bump;
    float strength = is_surface ? material->surface.normal_strength : material->cdrf.normal_strength;
    tangents t = tangents_at(context, &b->point);
    ty_vec3 n = b->point.ns;
    if (map->texture_index >= 0 || map->attribute_index >= 0)
        n = mapped_normal(map, strength, context, &b->point, &t, n);
    if (material->is_bark)
    {
        ty_frame frame = ty_frame_from_normal(n);
        n = ty_bark_normal(&material->bark, context, &b->point, &frame);
    }
    if (bump->texture_index >= 0)
        n = bumped_normal(bump, context, &b->point, &t, n);
    b->frame = ty_frame_from_normal(ty_facing_normal(b->entering ? n : ty_neg(n), b->wo));
}

void ty_shading_frame_turn(const ty_material* material, const ty_shading_context* context, ty_bsdf* b)
{
    tangents t = tangents_at(context, &b->point);
    ty_vec3 n = b->frame.n, along = along_surface(t.u, n), across = ty_cross(n, along);
    if (!(ty_length_sqr(along) > 0.5f))
        return;
    float sine, cosine;
    // About the outward normal, whichever side is seen.
    float turn = ty_input_float(&material->surface.specular_rotation, context, &b->point);
    ty_sincos(b->entering ? turn : -turn, &sine, &cosine);
    b->frame.t = ty_add(ty_mul(along, cosine), ty_mul(across, sine));
    b->frame.b = ty_cross(n, b->frame.t);
}
