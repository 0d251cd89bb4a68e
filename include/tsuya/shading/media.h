// SPDX-License-Identifier: Apache-2.0
// The clear bodies a ray is in. Where several are, the one of highest priority is there alone (Schmidt & Budge 2002,
// "Simple nested dielectrics in ray traced images"); of equals the one entered last.
#pragma once
#include <tsuya/shading/material.h>

#define TY_MEDIA_MAX 8

typedef struct ty_medium
{
    uint32_t object, instance; // of the body
    int priority;
    float ior;
    bool alone;           // within it nothing else exists: rays meet its own surface only
    ty_scattering matter; // albedo 0: it only absorbs
} ty_medium;

// Highest priority last, of equals the one entered last: the last is where the ray is. Plain data.
typedef struct ty_media
{
    int count; // 0 = in air
    ty_medium items[TY_MEDIA_MAX];
} ty_media;

// The body behind a point of a material that bounds a medium.
ty_medium ty_medium_make(const ty_material* material, const ty_shading_context* context, const ty_surface_point* point);

// NULL = air.
static inline const ty_medium* ty_media_top(const ty_media* media)
{
    return media->count > 0 ? &media->items[media->count - 1] : NULL;
}

// Whether the surface of a body is a boundary for a ray that enters (or leaves) it, or lies within a body of higher
// priority. *outside: the index on the far side of the body from its surface, where it is one.
bool ty_media_is_boundary(const ty_media* media, const ty_medium* body, bool entering, float* outside);

// Whether it is among them.
bool ty_media_holds(const ty_media* media, const ty_medium* body);

// The ray goes on beyond the body's surface. More bodies than there is room for are left out.
void ty_media_cross(ty_media* media, const ty_medium* body, bool entering);
