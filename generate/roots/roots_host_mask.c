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
static ty_status source_open(const roots_host* host, const char* key, const ty_roots_mask_def* def, source* out,
                             ty_error* error)
{
    ty_status status = host_mask_check(host->mesh, key, def, error);
    if (status != TY_OK || !is_said(def))
        return status;
    if (def->texture && def->texture[0])
        return host_texture_read(key, def, &out->texture, error);
    return host_channel_find(host->mesh, key, def->attribute, &out->channel, error);
}

// --- masks ---

typedef struct baking
{
    const roots_host* host;
    const host_parts* parts;
    const int32_t* nearest;
    source* sources; // one for all parts, then one of each of them
    bool* own;       // of each part: it has one
    uint8_t* out;
} baking;

static const source* source_of(const baking* b, uint32_t triangle)
{
    int low = 0, high = b->parts->count - 1;
    while (low < high)
    {
        int middle = (low + high) / 2;
        if (triangle < b->parts->ends[middle])
            high = middle;
        else
            low = middle + 1;
    }
    return &b->sources[b->own[low] ? 1 + low : 0];
}

// The closest point is found by areas of the foot of p in the plane of the triangle, held within it: masks need no
// more.
static float triangle_value(const baking* b, uint32_t triangle, ty_vec3 p)
{
    const ty_mesh* mesh = b->host->mesh;
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
    const ty_voxels* f = &b->host->field;
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

static const char* const mask_names[ROOTS_MASKS] = {"avoid", "attract"};

static const ty_roots_mask_def* host_mask(const ty_roots_host_def* def, int which)
{
    return which == ROOTS_AVOID ? &def->avoid : &def->attract;
}

static const ty_roots_mask_def* part_mask(const ty_roots_host_def* def, int part, int which)
{
    const ty_roots_object_def* objects = def->objects.items;
    return which == ROOTS_AVOID ? &objects[part].avoid : &objects[part].attract;
}

bool host_is_painted(const ty_roots_host_def* def)
{
    bool painted = false;
    for (int i = 0; i < ROOTS_MASKS; i++)
    {
        painted |= is_said(host_mask(def, i));
        for (int k = 0; k < def->objects.count; k++)
            painted |= is_said(part_mask(def, k, i));
    }
    return painted;
}

static ty_status sources_open(baking* b, const ty_roots_host_def* def, int which, bool* any, ty_error* error)
{
    char key[64];
    snprintf(key, sizeof key, "host.%s", mask_names[which]);
    ty_status status = source_open(b->host, key, host_mask(def, which), &b->sources[0], error);
    *any = is_said(host_mask(def, which));
    for (int k = 0; k < def->objects.count && status == TY_OK; k++)
    {
        const ty_roots_mask_def* own = part_mask(def, k, which);
        snprintf(key, sizeof key, "host.objects[%d].%s", k, mask_names[which]);
        b->own[k] = is_said(own);
        *any |= b->own[k];
        status = source_open(b->host, key, own, &b->sources[1 + k], error);
        if (status == TY_OK && !b->own[k] && b->sources[0].texture.values && !b->parts->mapped[k])
            status = ty_error_set(error, TY_BAD_INPUT, "host.%s.texture: objects[%d] has no texture coordinates (uv)",
                                  mask_names[which], k);
    }
    return status;
}

static ty_status mask_make(roots_host* host, baking* b, const ty_roots_host_def* def, int which, ty_workers* workers,
                           ty_error* error)
{
    const ty_voxels* f = &host->field;
    size_t count = (size_t)f->size[0] * (size_t)f->size[1] * (size_t)f->size[2];
    bool any = false;
    int room = 1 + b->parts->count;
    b->sources = TY_ALLOC(source, room);
    b->own = TY_ALLOC(bool, b->parts->count);
    ty_status status = sources_open(b, def, which, &any, error);
    if (status == TY_OK && any)
    {
        b->out = host->masks[which] = TY_TRY_ALLOC(uint8_t, count);
        if (b->out)
            ty_parallel_all(workers, f->size[2], 2, layers_bake, b);
        else
            status = ty_error_set(error, TY_NO_MEMORY, "no memory for a mask of %zu nodes", count);
    }
    for (int i = 0; i < room; i++)
        host_texture_term(&b->sources[i].texture);
    ty_free(b->sources);
    ty_free(b->own);
    return status;
}

ty_status host_masks_make(roots_host* host, const ty_roots_host_def* def, const host_parts* parts,
                          const int32_t* nearest, ty_workers* workers, ty_error* error)
{
    baking b = {.host = host, .parts = parts, .nearest = nearest};
    ty_status status = TY_OK;
    for (int i = 0; i < ROOTS_MASKS && status == TY_OK; i++)
        status = mask_make(host, &b, def, i, workers, error);
    return status;
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
