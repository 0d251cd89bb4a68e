// SPDX-License-Identifier: Apache-2.0
// Nested clear bodies: which surface is a boundary, and where a ray is after it.
#include "material_private.h"
#include <limits.h>
#include <tsuya/shading/media.h>

static float channel_albedo(float scattering, float extinction)
{
    return extinction > 0.0f ? ty_min(scattering / extinction, 1.0f) : 0.0f;
}

// OpenPBR Surface 1.1, "Translucent base": the colour is what a depth lets through, the scattering is per depth; where
// that asks for negative absorption, all channels get as much grey as makes the least of them 0.
static ty_scattering transmission_matter(const ty_surface_def* s, const ty_shading_context* context,
                                         const ty_surface_point* point)
{
    const float blackest = 1e-6f;
    float per_m = 1.0f / s->transmission_depth;
    ty_rgb c = ty_input_color(&s->transmission_color, context, point),
           scatter = ty_rgb_scale(ty_input_color(&s->transmission_scatter, context, point), per_m);
    ty_rgb e = ty_rgb_make(-per_m * ty_ln(ty_clamp(c.r, blackest, 1.0f)), -per_m * ty_ln(ty_clamp(c.g, blackest, 1.0f)),
                           -per_m * ty_ln(ty_clamp(c.b, blackest, 1.0f)));
    float lacking = ty_max(ty_max(scatter.r - e.r, scatter.g - e.g), ty_max(scatter.b - e.b, 0.0f));
    e = ty_rgb_add(e, ty_rgb_grey(lacking));
    return (ty_scattering){
        e, ty_rgb_make(channel_albedo(scatter.r, e.r), channel_albedo(scatter.g, e.g), channel_albedo(scatter.b, e.b)),
        s->transmission_scatter_anisotropy};
}

ty_medium ty_medium_make(const ty_material* material, const ty_shading_context* context, const ty_surface_point* point)
{
    const ty_surface_def* s = &material->surface;
    TY_ASSERT(material->traits & TY_TRAIT_MEDIUM);
    ty_medium body = {.object = point->object, .instance = point->instance, .priority = s->priority};
    body.ior = ty_clamp(ty_input_float(&s->specular_ior, context, point), 1.0f, 3.0f);
    if (material->model == TY_MODEL_WALK)
    {
        ty_bsdf b = {.material = material, .point = *point};
        ty_walk_prepare(material, context, &b);
        body.matter = b.matter;
        body.alone = true;
        body.priority = INT_MAX;
        return body;
    }
    if (s->transmission_depth > 0.0f)
        body.matter = transmission_matter(s, context, point);
    return body;
}

static int find(const ty_media* media, const ty_medium* body)
{
    int i = media->count - 1;
    while (i >= 0 && (media->items[i].object != body->object || media->items[i].instance != body->instance))
        i--;
    return i;
}

// The last body besides this one.
static const ty_medium* top_besides(const ty_media* media, int index)
{
    int i = media->count - 1;
    if (i == index)
        i--;
    return i >= 0 ? &media->items[i] : NULL;
}

bool ty_media_is_boundary(const ty_media* media, const ty_medium* body, bool entering, float* outside)
{
    int index = find(media, body);
    const ty_medium* other = top_besides(media, index);
    *outside = other ? other->ior : 1.0f;
    if (!other)
        return true;
    // What was never entered (an open mesh, a start on the surface) is left as if it had been entered last.
    if (index < 0 || entering)
        return body->priority >= other->priority;
    return index == media->count - 1;
}

bool ty_media_holds(const ty_media* media, const ty_medium* body)
{
    return find(media, body) >= 0;
}

void ty_media_cross(ty_media* media, const ty_medium* body, bool entering)
{
    int index = find(media, body);
    if (index >= 0)
    {
        media->count--;
        for (int i = index; i < media->count; i++)
            media->items[i] = media->items[i + 1];
    }
    if (!entering || media->count == TY_MEDIA_MAX)
        return;
    int i = media->count++;
    for (; i > 0 && media->items[i - 1].priority > body->priority; i--)
        media->items[i] = media->items[i - 1];
    media->items[i] = *body;
}
