// SPDX-License-Identifier: Apache-2.0
// Nested clear bodies: which surface is a boundary, and where a ray is after it.
#include "material_private.h"
#include <tsuya/shading/media.h>

ty_medium ty_medium_make(const ty_material* material, const ty_shading_context* context, const ty_surface_point* point)
{
    const ty_surface_def* s = &material->surface;
    TY_ASSERT(material->traits & TY_TRAIT_MEDIUM);
    ty_medium body = {.object = point->object, .instance = point->instance, .priority = s->priority};
    body.ior = ty_clamp(ty_input_float(&s->specular_ior, context, point), 1.0f, 3.0f);
    if (s->transmission_depth > 0.0f)
    {
        const float blackest = 1e-6f;
        float per_m = -1.0f / s->transmission_depth;
        ty_rgb c = ty_input_color(&s->transmission_color, context, point);
        body.absorption =
            ty_rgb_make(per_m * ty_ln(ty_clamp(c.r, blackest, 1.0f)), per_m * ty_ln(ty_clamp(c.g, blackest, 1.0f)),
                        per_m * ty_ln(ty_clamp(c.b, blackest, 1.0f)));
    }
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
