// SPDX-License-Identifier: Apache-2.0
// What is painted on a host: by attributes of its vertices and by textures, kept at the nodes about its surface.
#include "roots_host.h"
#include <stdio.h>
#include <string.h>

enum
{
    BAND = 16, // steps from the surface, up to which masks are kept
};

// --- channels ---

static void names_list(const ty_mesh* mesh, char* text, size_t size)
{
    size_t at = 0;
    text[0] = 0;
    for (int i = 0; i < mesh->attribute_count && at < size; i++)
        at += (size_t)snprintf(text + at, size - at, "%s%s", i > 0 ? ", " : "", mesh->attributes[i].name);
}

ty_status host_channel_find(const ty_mesh* mesh, const char* key, const char* name, host_channel* out, ty_error* error)
{
    static const char channels[] = "rgba";
    const ty_mesh_attribute* found = ty_mesh_find_attribute(mesh, name);
    const char *dot = strrchr(name, '.'), *letter = dot && dot[1] && !dot[2] ? strchr(channels, dot[1]) : NULL;
    int channel = 0;
    if (!found && letter && (size_t)(dot - name) < sizeof found->name)
    {
        char base[sizeof found->name] = {0};
        memcpy(base, name, (size_t)(dot - name));
        found = ty_mesh_find_attribute(mesh, base);
        channel = (int)(letter - channels);
    }
    if (found && channel < found->components)
    {
        *out = (host_channel){found->values + channel, found->components};
        return TY_OK;
    }
    char names[200];
    names_list(mesh, names, sizeof names);
    if (mesh->attribute_count == 0)
        return ty_error_set(error, TY_BAD_INPUT, "%s: '%.100s'; the host's vertices have no attributes", key, name);
    return ty_error_set(error, TY_BAD_INPUT, "%s: '%.100s'; the host's vertices have %s", key, name, names);
}

// --- sources ---

// What brings a mask on one part of the host: an attribute, a texture, or nothing.
typedef struct source
{
    host_channel channel;
    host_texture texture;
} source;

static bool is_said(const ty_roots_mask_def* def)
{
    return (def->attribute && def->attribute[0]) || (def->texture && def->texture[0]);
}

ty_status host_mask_check(const ty_mesh* mesh, const char* key, const ty_roots_mask_def* def, ty_error* error)
{
    host_channel channel;
    if (!is_said(def) && def->channel && strcmp(def->channel, "r") != 0)
        return ty_error_set(error, TY_BAD_INPUT, "%s.channel: %.100s; of which texture?", key, def->channel);
    if (!is_said(def))
        return TY_OK;
    if (def->attribute && def->attribute[0] && def->texture && def->texture[0])
        return ty_error_set(error, TY_BAD_INPUT, "%s: an attribute or a texture, not both", key);
    if (def->attribute && def->attribute[0])
        return host_channel_find(mesh, key, def->attribute, &channel, error);
    if (!mesh->uvs)
        return ty_error_set(error, TY_BAD_INPUT, "%s.texture: the host has no texture coordinates (uv)", key);
    return TY_OK;
}

// On failure the caller frees what out holds all the same.
static ty_status source_open(const ty_mesh* mesh, const char* key, const ty_roots_mask_def* def, source* out,
                             ty_error* error)
{
    ty_status status = host_mask_check(mesh, key, def, error);
    if (status != TY_OK || !is_said(def))
        return status;
    if (def->texture && def->texture[0])
        return host_texture_read(key, def, &out->texture, error);
    return host_channel_find(mesh, key, def->attribute, &out->channel, error);
}

struct host_sources
{
    const ty_mesh* mesh;
    const host_parts* parts;
    source* items[ROOTS_MASKS]; // one for all parts, then one of each of them
    bool* own[ROOTS_MASKS];     // of each part: it has one
    bool any[ROOTS_MASKS];
};

static ty_status mask_open(host_sources* s, const ty_roots_host_def* def, int which, ty_error* error)
{
    static const char* const names[ROOTS_MASKS] = {"avoid", "attract"};
    const ty_roots_mask_def* whole = which == ROOTS_AVOID ? &def->avoid : &def->attract;
    const ty_roots_object_def* objects = def->objects.items;
    char key[64];
    snprintf(key, sizeof key, "host.%s", names[which]);
    s->items[which] = TY_ALLOC(source, 1 + s->parts->count);
    s->own[which] = TY_ALLOC(bool, s->parts->count);
    s->any[which] = is_said(whole);
    ty_status status = source_open(s->mesh, key, whole, &s->items[which][0], error);
    for (int k = 0; k < def->objects.count && status == TY_OK; k++)
    {
        const ty_roots_mask_def* own = which == ROOTS_AVOID ? &objects[k].avoid : &objects[k].attract;
        snprintf(key, sizeof key, "host.objects[%d].%s", k, names[which]);
        s->own[which][k] = is_said(own);
        s->any[which] |= s->own[which][k];
        status = source_open(s->mesh, key, own, &s->items[which][1 + k], error);
        if (status == TY_OK && !s->own[which][k] && s->items[which][0].texture.values && !s->parts->mapped[k])
            status = ty_error_set(error, TY_BAD_INPUT, "host.%s.texture: objects[%d] has no texture coordinates (uv)",
                                  names[which], k);
    }
    return status;
}

ty_status host_sources_open(const ty_mesh* mesh, const ty_roots_host_def* def, const host_parts* parts,
                            host_sources** out, ty_error* error)
{
    host_sources* s = *out = TY_ALLOC(host_sources, 1);
    *s = (host_sources){.mesh = mesh, .parts = parts};
    ty_status status = TY_OK;
    bool any = false;
    for (int i = 0; i < ROOTS_MASKS && status == TY_OK; i++)
    {
        status = mask_open(s, def, i, error);
        any |= s->any[i];
    }
    if (status == TY_OK && any)
        return TY_OK;
    host_sources_close(s);
    *out = NULL;
    return status;
}

void host_sources_close(host_sources* s)
{
    if (!s)
        return;
    for (int i = 0; i < ROOTS_MASKS; i++)
    {
        for (int k = 0; k < 1 + s->parts->count && s->items[i]; k++)
            host_texture_term(&s->items[i][k].texture);
        ty_free(s->items[i]);
        ty_free(s->own[i]);
    }
    ty_free(s);
}

// --- masks ---

typedef struct baking
{
    const ty_voxels* field;
    const host_sources* from;
    const int32_t* nearest;
    int which;
    uint8_t* out;
} baking;

static const source* source_of(const baking* b, uint32_t triangle)
{
    const host_parts* parts = b->from->parts;
    int low = 0, high = parts->count - 1;
    while (low < high)
    {
        int middle = (low + high) / 2;
        if (triangle < parts->ends[middle])
            high = middle;
        else
            low = middle + 1;
    }
    return &b->from->items[b->which][b->from->own[b->which][low] ? 1 + low : 0];
}

// The closest point is found by areas of the foot of p in the plane of the triangle, held within it: masks need no
// more.
static float triangle_value(const baking* b, uint32_t triangle, ty_vec3 p)
{
    const ty_mesh* mesh = b->from->mesh;
    const source* from = source_of(b, triangle);
    const uint32_t* c = mesh->triangles[triangle];
    const ty_vec3* at = mesh->positions;
    ty_vec3 n = ty_cross(ty_sub(at[c[1]], at[c[0]]), ty_sub(at[c[2]], at[c[0]]));
    float sum = 0.0f, weights = 1e-30f;
    ty_vec2 uv = {0.0f, 0.0f};
    for (int k = 0; k < 3; k++)
    {
        ty_vec3 q = at[c[(k + 1) % 3]], r = at[c[(k + 2) % 3]];
        float w = ty_max(ty_dot(n, ty_cross(ty_sub(q, p), ty_sub(r, p))), 0.0f);
        weights += w;
        if (from->texture.values)
            uv = (ty_vec2){uv.x + w * mesh->uvs[c[k]].x, uv.y + w * mesh->uvs[c[k]].y};
        else if (from->channel.values)
            sum += w * from->channel.values[(size_t)c[k] * (size_t)from->channel.stride];
    }
    if (from->texture.values)
        return host_texture_at(&from->texture, (ty_vec2){uv.x / weights, uv.y / weights});
    return sum / weights;
}

static void layers_bake(void* context, int64_t begin, int64_t end, int worker)
{
    const baking* b = context;
    const ty_voxels* f = b->field;
    (void)worker;
    for (int k = (int)begin; k < (int)end; k++)
        for (int j = 0; j < f->size[1]; j++)
            for (int i = 0; i < f->size[0]; i++)
            {
                size_t node = ((size_t)k * (size_t)f->size[1] + (size_t)j) * (size_t)f->size[0] + (size_t)i;
                if (fabsf(f->values[node]) > BAND * f->step)
                    continue;
                ty_vec3 p = ty_mad(f->origin, ty_vec3_make((float)i, (float)j, (float)k), f->step);
                float value = triangle_value(b, (uint32_t)b->nearest[node], p);
                b->out[node] = (uint8_t)(255.0f * ty_clamp(value, 0.0f, 1.0f) + 0.5f);
            }
}

ty_status host_masks_make(roots_host* host, const host_sources* from, const int32_t* nearest, ty_workers* workers,
                          ty_error* error)
{
    const ty_voxels* f = &host->field;
    size_t count = (size_t)f->size[0] * (size_t)f->size[1] * (size_t)f->size[2];
    for (int i = 0; i < ROOTS_MASKS; i++)
    {
        if (!from->any[i])
            continue;
        host->masks[i] = TY_TRY_ALLOC(uint8_t, count);
        if (!host->masks[i])
            return ty_error_set(error, TY_NO_MEMORY, "no memory for a mask of %zu nodes", count);
        baking b = {.field = f, .from = from, .nearest = nearest, .which = i, .out = host->masks[i]};
        ty_parallel_all(workers, f->size[2], 2, layers_bake, &b);
    }
    return TY_OK;
}

float roots_host_mask(const roots_host* host, roots_mask which, ty_vec3 p, ty_vec3* gradient)
{
    const ty_voxels* f = &host->field;
    const uint8_t* mask = host->masks[which];
    if (gradient)
        *gradient = ty_vec3_make(0.0f, 0.0f, 0.0f);
    if (!mask)
        return 0.0f;
    ty_vec3 q = ty_mul(ty_sub(p, f->origin), 1.0f / f->step), g = {0.0f, 0.0f, 0.0f};
    const float at[3] = {q.x, q.y, q.z};
    float part[3], value = 0.0f;
    size_t low = 0, stride[3] = {1, (size_t)f->size[0], (size_t)f->size[0] * (size_t)f->size[1]};
    for (int i = 0; i < 3; i++)
    {
        if (!(at[i] >= 0.0f && at[i] < (float)(f->size[i] - 1)))
            return 0.0f;
        part[i] = at[i] - floorf(at[i]);
        low += stride[i] * (size_t)at[i];
    }
    for (int e = 0; e < 8; e++)
    {
        float v = (float)mask[low + (e & 1 ? 1 : 0) + (e & 2 ? stride[1] : 0) + (e & 4 ? stride[2] : 0)] / 255.0f;
        float x = e & 1 ? part[0] : 1.0f - part[0], y = e & 2 ? part[1] : 1.0f - part[1];
        float z = e & 4 ? part[2] : 1.0f - part[2];
        value += x * y * z * v;
        g = ty_add(g, ty_vec3_make((e & 1 ? v : -v) * y * z, (e & 2 ? v : -v) * x * z, (e & 4 ? v : -v) * x * y));
    }
    if (gradient)
        *gradient = ty_mul(g, 1.0f / f->step);
    return value;
}
