// SPDX-License-Identifier: Apache-2.0
// What is painted on a host: masks about its surface, and places where roots start.
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

// --- masks ---

typedef struct baking
{
    const roots_host* host;
    const int32_t* nearest;
    host_channel channel;
    uint8_t* out;
} baking;

// The closest point is found by areas of the foot of p in the plane of the triangle, held within it: masks need no
// more.
static float triangle_value(const baking* b, int32_t triangle, ty_vec3 p)
{
    const uint32_t* c = b->host->mesh->triangles[triangle];
    const ty_vec3* at = b->host->mesh->positions;
    ty_vec3 n = ty_cross(ty_sub(at[c[1]], at[c[0]]), ty_sub(at[c[2]], at[c[0]]));
    float sum = 0.0f, weights = 1e-30f;
    for (int k = 0; k < 3; k++)
    {
        ty_vec3 q = at[c[(k + 1) % 3]], r = at[c[(k + 2) % 3]];
        float w = ty_max(ty_dot(n, ty_cross(ty_sub(q, p), ty_sub(r, p))), 0.0f);
        sum += w * b->channel.values[(size_t)c[k] * (size_t)b->channel.stride];
        weights += w;
    }
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
                float value = ty_clamp(triangle_value(b, b->nearest[node], p), 0.0f, 1.0f);
                b->out[node] = (uint8_t)(255.0f * value + 0.5f);
            }
}

ty_status host_masks_make(roots_host* host, const ty_roots_host_def* def, const int32_t* nearest, ty_workers* workers,
                          ty_error* error)
{
    static const char* const keys[ROOTS_MASKS] = {"host.avoid", "host.attract"};
    const char* const names[ROOTS_MASKS] = {def->avoid, def->attract};
    const ty_voxels* f = &host->field;
    for (int i = 0; i < ROOTS_MASKS; i++)
    {
        if (!names[i] || !names[i][0])
            continue;
        baking b = {.host = host, .nearest = nearest};
        ty_status status = host_channel_find(host->mesh, keys[i], names[i], &b.channel, error);
        if (status != TY_OK)
            return status;
        size_t count = (size_t)f->size[0] * (size_t)f->size[1] * (size_t)f->size[2];
        b.out = host->masks[i] = TY_TRY_ALLOC(uint8_t, count);
        if (!b.out)
            return ty_error_set(error, TY_NO_MEMORY, "no memory for a mask of %zu nodes", count);
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

// --- starts ---

// A given place put on the surface, where it is near.
static ty_status point_place(const roots_host* host, const ty_roots_recipe* recipe, int index, roots_start* out,
                             ty_error* error)
{
    ty_vec3 p = ((const ty_vec3*)recipe->start.points.items)[index];
    float far = 0.1f * host_longest(host->mesh), deep = ty_max(recipe->radius, 2.0f * host->field.step);
    float d = roots_host_exact(host, p, far, &out->n);
    if (!(d <= far))
        return ty_error_set(error, TY_BAD_INPUT, "start.points[%d]: [%g, %g, %g] is %.3g m from the host; at most %.3g",
                            index, (double)p.x, (double)p.y, (double)p.z, (double)d, (double)far);
    if (d < -deep)
        return ty_error_set(error, TY_BAD_INPUT,
                            "start.points[%d]: [%g, %g, %g] is inside of the host, %.3g m deep; at most %.3g", index,
                            (double)p.x, (double)p.y, (double)p.z, (double)-d, (double)deep);
    out->p = ty_mad(p, out->n, -d);
    return TY_OK;
}

// Painted vertices, each time the one that is farthest from all starts so far; the first one is the highest. Their
// order does not change with how many are asked for.
static void painted_take(const roots_host* host, const host_channel* channel, int most, roots_start* out, int* count)
{
    const ty_mesh* mesh = host->mesh;
    float* nearest = TY_ALLOC(float, mesh->vertex_count); // squared; -1: not painted
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        nearest[v] = channel->values[(size_t)v * (size_t)channel->stride] > 0.5f ? TY_FLOAT_MAX : -1.0f;
        for (int i = 0; i < *count && nearest[v] >= 0.0f; i++)
            nearest[v] = ty_min(nearest[v], ty_length_sqr(ty_sub(mesh->positions[v], out[i].p)));
    }
    while (*count < most)
    {
        int64_t best = -1;
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            if (nearest[v] > 0.0f && (best < 0 || nearest[v] > nearest[best] ||
                                      (nearest[v] == nearest[best] && mesh->positions[v].y > mesh->positions[best].y)))
                best = v;
        if (best < 0)
            break;
        roots_start* start = &out[(*count)++];
        start->p = mesh->positions[best];
        (void)roots_host_exact(host, start->p, 2.0f * host->field.step, &start->n);
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            nearest[v] = ty_min(nearest[v], ty_length_sqr(ty_sub(mesh->positions[v], start->p)));
    }
    ty_free(nearest);
}

ty_status roots_host_starts(const roots_host* host, const ty_roots_recipe* recipe, int most, roots_start** out,
                            int* count, ty_error* error)
{
    const ty_roots_start_def* def = &recipe->start;
    bool painted = def->attribute && def->attribute[0];
    int room = def->points.count > most ? def->points.count : most;
    ty_status status = TY_OK;
    host_channel channel = {0};
    *out = NULL;
    *count = 0;
    if (def->points.count == 0 && !painted)
        return TY_OK;
    if (painted)
        status = host_channel_find(host->mesh, "start.attribute", def->attribute, &channel, error);
    roots_start* starts = TY_ALLOC(roots_start, room);
    for (int i = 0; i < def->points.count && status == TY_OK; i++)
        status = point_place(host, recipe, (*count)++, &starts[i], error);
    if (status == TY_OK && painted)
        painted_take(host, &channel, most, starts, count);
    if (status == TY_OK && *count == 0)
        status = ty_error_set(error, TY_BAD_INPUT, "start.attribute: '%.100s' is above 0.5 at no vertex of the host",
                              def->attribute);
    if (status == TY_OK)
        *out = starts;
    else
    {
        *count = 0;
        ty_free(starts);
    }
    return status;
}
