// SPDX-License-Identifier: Apache-2.0
// Hosts for roots, as files: of a few closed parts, as those and as one mesh; and whole ones, by their distance.
#pragma once
#include "base/cmocka_all.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/noise.h>
#include <tsuya/geometry/mesh_file.h>
#include <tsuya/geometry/shape.h>
#include <tsuya/geometry/surface_net.h>

typedef struct host_files
{
    char whole[64];
    char part[8][64];
    const char* paths[8];
    int count;
} host_files;

static inline ty_mesh* host_shape(ty_shape_kind kind, ty_vec3 size, float rounding, ty_vec3 at)
{
    ty_error error;
    ty_mesh* mesh;
    ty_shape_def def = ty_shape_def_default();
    def.kind = kind;
    def.size = size;
    def.radius = size.x;
    def.height = size.y;
    def.rounding = rounding;
    def.divisions = 48;
    assert_int_equal(ty_shape_create(&def, &mesh, &error), TY_OK);
    ty_affine move = ty_affine_identity();
    move.t = at;
    ty_mesh_transform(mesh, &move);
    return mesh;
}

// A tube about the (2, 3) torus knot.
static inline ty_mesh* host_knot(float size, float radius, int along, int around)
{
    ty_mesh* mesh = ty_mesh_create((uint32_t)(along * around), (uint32_t)(2 * along * around));
    for (int i = 0; i < along; i++)
    {
        ty_vec3 p[3];
        for (int k = 0; k < 3; k++)
        {
            float a = (2.0f * TY_PI) * ((float)i + 0.01f * (float)(k - 1)) / (float)along;
            float w = 2.0f + ty_cos(3.0f * a);
            p[k] = (ty_vec3){size * w * ty_cos(2.0f * a), size * 1.3f * ty_sin(3.0f * a), size * w * ty_sin(2.0f * a)};
        }
        ty_vec3 t = ty_normalize(ty_sub(p[2], p[0])), u = ty_normalize(ty_cross(t, (ty_vec3){0.0f, 1.0f, 0.0f}));
        ty_vec3 v = ty_cross(t, u);
        for (int k = 0; k < around; k++)
        {
            float b = (2.0f * TY_PI) * (float)k / (float)around;
            ty_vec3 n = ty_add(ty_mul(u, ty_cos(b)), ty_mul(v, ty_sin(b)));
            uint32_t at = (uint32_t)(i * around + k), next = (uint32_t)((i + 1) % along * around);
            uint32_t beside = (uint32_t)((k + 1) % around);
            mesh->positions[at] = ty_mad(p[1], n, radius);
            mesh->normals[at] = n;
            ty_mesh_set_quad(
                mesh, 2 * at,
                (const uint32_t[]){at, (uint32_t)(i * around) + beside, next + beside, next + (uint32_t)k});
        }
    }
    ty_mesh_compute_bounds(mesh);
    return mesh;
}

// A ball with the relief of three octaves of waves.
static inline ty_mesh* host_ball(float radius, int divisions)
{
    ty_error error;
    ty_mesh* mesh;
    ty_shape_def def = ty_shape_def_default();
    def.kind = TY_SHAPE_STONE;
    def.size = (ty_vec3){radius, radius, radius};
    def.relief = 0.15f;
    def.variant = 11;
    def.divisions = divisions;
    assert_int_equal(ty_shape_create(&def, &mesh, &error), TY_OK);
    return mesh;
}

// Takes the parts.
static inline void host_save(const char* name, ty_mesh** parts, int count, host_files* out)
{
    ty_error error;
    uint32_t vertices = 0, triangles = 0;
    *out = (host_files){.count = count};
    for (int i = 0; i < count; i++)
    {
        vertices += parts[i]->vertex_count;
        triangles += parts[i]->triangle_count;
    }
    ty_mesh* all = ty_mesh_create(vertices, triangles);
    vertices = triangles = 0;
    for (int i = 0; i < count; i++)
    {
        const ty_mesh* part = parts[i];
        memcpy(all->positions + vertices, part->positions, part->vertex_count * sizeof(ty_vec3));
        memcpy(all->normals + vertices, part->normals, part->vertex_count * sizeof(ty_vec3));
        for (uint32_t t = 0; t < part->triangle_count; t++)
            for (int k = 0; k < 3; k++)
                all->triangles[triangles + t][k] = part->triangles[t][k] + vertices;
        vertices += part->vertex_count;
        triangles += part->triangle_count;
        snprintf(out->part[i], sizeof out->part[i], "roots_%s_%d.ply", name, i);
        out->paths[i] = out->part[i];
        assert_int_equal(ty_ply_write(out->part[i], part, &error), TY_OK);
        ty_mesh_destroy(parts[i]);
    }
    snprintf(out->whole, sizeof out->whole, "roots_%s.ply", name);
    assert_int_equal(ty_ply_write(out->whole, all, &error), TY_OK);
    ty_mesh_destroy(all);
}

// Of a few decimetres; detail is 1 for what takes seconds.
static inline void host_make(const char* name, int detail, host_files* out)
{
    ty_mesh* parts[8];
    int count = 1;
    if (strcmp(name, "ground") == 0)
        parts[0] = host_shape(TY_SHAPE_BOX, (ty_vec3){0.15f, 0.02f, 0.15f}, 0.004f, (ty_vec3){0.0f, 0.0f, 0.0f});
    else if (strcmp(name, "pillar") == 0)
        parts[0] = host_shape(TY_SHAPE_BOX, (ty_vec3){0.03f, 0.1f, 0.03f}, 0.003f, (ty_vec3){0.0f, 0.0f, 0.0f});
    else if (strcmp(name, "compound") == 0)
    {
        parts[0] = host_shape(TY_SHAPE_BOX, (ty_vec3){0.06f, 0.03f, 0.06f}, 0.003f, (ty_vec3){0.0f, -0.05f, 0.0f});
        parts[1] = host_shape(TY_SHAPE_BOX, (ty_vec3){0.035f, 0.06f, 0.03f}, 0.003f, (ty_vec3){0.01f, 0.02f, 0.0f});
        parts[2] = host_shape(TY_SHAPE_BOX, (ty_vec3){0.05f, 0.012f, 0.04f}, 0.003f, (ty_vec3){0.0f, 0.085f, 0.0f});
        count = 3;
    }
    else if (strcmp(name, "knot") == 0)
        parts[0] = host_knot(0.03f, 0.016f, 200 * detail, 32 * detail);
    else if (strcmp(name, "bust") == 0)
    {
        parts[0] = host_shape(TY_SHAPE_ELLIPSOID, (ty_vec3){0.03f, 0.04f, 0.034f}, 0.0f, (ty_vec3){0.0f, 0.06f, 0.0f});
        parts[1] = host_shape(TY_SHAPE_CYLINDER, (ty_vec3){0.017f, 0.06f, 0.0f}, 0.002f, (ty_vec3){0.0f, 0.0f, 0.0f});
        parts[2] =
            host_shape(TY_SHAPE_ELLIPSOID, (ty_vec3){0.07f, 0.028f, 0.034f}, 0.0f, (ty_vec3){0.0f, -0.025f, 0.0f});
        parts[3] = host_shape(TY_SHAPE_BOX, (ty_vec3){0.045f, 0.012f, 0.03f}, 0.003f, (ty_vec3){0.0f, -0.055f, 0.0f});
        count = 4;
    }
    else
        parts[0] = host_ball(0.05f, detail > 1 ? 1160 : 96);
    host_save(name, parts, count, out);
}

// --- by their distance ---

typedef float host_distance(ty_vec3 p);

static inline float distance_box(ty_vec3 p, ty_vec3 c, ty_vec3 half)
{
    ty_vec3 q = {fabsf(p.x - c.x) - half.x, fabsf(p.y - c.y) - half.y, fabsf(p.z - c.z) - half.z};
    ty_vec3 out = {ty_max(q.x, 0.0f), ty_max(q.y, 0.0f), ty_max(q.z, 0.0f)};
    return ty_length(out) + ty_min(ty_max(q.x, ty_max(q.y, q.z)), 0.0f);
}

static inline float distance_ball(ty_vec3 p, ty_vec3 c, ty_vec3 axes)
{
    ty_vec3 q = ty_sub(p, c);
    q = ty_vec3_make(q.x / axes.x, q.y / axes.y, q.z / axes.z);
    return (ty_length(q) - 1.0f) * ty_min(axes.x, ty_min(axes.y, axes.z));
}

// A shaft with two blocks built into it.
static inline float distance_compound(ty_vec3 p)
{
    float d = distance_box(p, (ty_vec3){0.0f, 0.0f, 0.0f}, (ty_vec3){0.02f, 0.1f, 0.02f});
    d = ty_min(d, distance_box(p, (ty_vec3){0.012f, 0.02f, 0.014f}, (ty_vec3){0.018f, 0.012f, 0.018f}));
    return ty_min(d, distance_box(p, (ty_vec3){-0.016f, -0.03f, 0.0f}, (ty_vec3){0.014f, 0.02f, 0.012f}));
}

// Head, neck, shoulders, pedestal.
static inline float distance_bust(ty_vec3 p)
{
    float d = distance_ball(p, (ty_vec3){0.0f, 0.075f, 0.0f}, (ty_vec3){0.024f, 0.03f, 0.027f});
    d = ty_min(d, distance_ball(p, (ty_vec3){0.0f, 0.072f, 0.026f}, (ty_vec3){0.005f, 0.009f, 0.008f}));
    d = ty_min(d, distance_box(p, (ty_vec3){0.0f, 0.035f, 0.0f}, (ty_vec3){0.012f, 0.022f, 0.012f}) - 0.002f);
    d = ty_min(d, distance_ball(p, (ty_vec3){0.0f, 0.0f, 0.0f}, (ty_vec3){0.055f, 0.026f, 0.028f}));
    return ty_min(d, distance_box(p, (ty_vec3){0.0f, -0.055f, 0.0f}, (ty_vec3){0.03f, 0.045f, 0.026f}));
}

typedef struct host_net
{
    host_distance* distance;
    ty_vec3 origin;
    float step;
} host_net;

static inline void host_fill(void* context, const int block[3], float values[TY_NET_NODES])
{
    const host_net* net = context;
    for (int i = 0; i < TY_NET_NODES; i++)
    {
        int x = block[0] * TY_NET_BLOCK + i % TY_NET_BLOCK,
            y = block[1] * TY_NET_BLOCK + i / TY_NET_BLOCK % TY_NET_BLOCK;
        int z = block[2] * TY_NET_BLOCK + i / (TY_NET_BLOCK * TY_NET_BLOCK);
        values[i] = net->distance(ty_mad(net->origin, (ty_vec3){(float)x, (float)y, (float)z}, net->step));
    }
}

static inline void host_write(const char* path, ty_mesh* mesh)
{
    ty_error error = {0};
    ty_mesh_compute_welds(mesh);
    ty_mesh_compute_normals(mesh, TY_PI);
    ty_mesh_compute_bounds(mesh);
    if (ty_ply_write(path, mesh, &error) != TY_OK)
        abort();
    ty_mesh_destroy(mesh);
}

static inline void host_implicit(const char* path, host_distance* distance, ty_vec3 half, float step)
{
    host_net context = {distance, ty_neg(half), step};
    ty_net_def def = {.origin = context.origin, .step = step, .fill = host_fill, .context = &context};
    const float size[3] = {half.x, half.y, half.z};
    ty_net* net;
    ty_mesh* mesh;
    ty_error error = {0};
    def.active_count = 1;
    for (int i = 0; i < 3; i++)
        def.active_count *= def.blocks[i] = (int)(2.0f * size[i] / (step * TY_NET_BLOCK)) + 1;
    int32_t* active = malloc((size_t)def.active_count * sizeof *active);
    for (int i = 0; i < def.active_count; i++)
        active[i] = i;
    def.active = active;
    if (ty_net_create(&def, NULL, &net, &error) != TY_OK || ty_net_mesh(net, &mesh, NULL, &error) != TY_OK)
        abort();
    ty_net_destroy(net);
    free(active);
    host_write(path, mesh);
}

// The (2, 3) torus knot as a closed tube, about z.
static inline void host_lying_knot(const char* path, float size, float tube, int along, int around)
{
    ty_mesh* mesh = ty_mesh_create((uint32_t)(along * around), (uint32_t)(2 * along * around));
    for (int i = 0; i < along; i++)
    {
        ty_vec3 p[3];
        for (int k = -1; k <= 1; k++)
        {
            float a = 2.0f * TY_PI * (float)(i + k) / (float)along, s2, c2, s3, c3;
            ty_sincos(2.0f * a, &s2, &c2);
            ty_sincos(3.0f * a, &s3, &c3);
            p[k + 1] = ty_mul((ty_vec3){(2.0f + c3) * c2, (2.0f + c3) * s2, 1.3f * s3}, size / 3.0f);
        }
        ty_vec3 t = ty_normalize(ty_sub(p[2], p[0])), u = ty_normalize(ty_cross(t, (ty_vec3){0.0f, 0.0f, 1.0f}));
        ty_vec3 v = ty_cross(t, u);
        for (int j = 0; j < around; j++)
        {
            float s, c;
            ty_sincos(2.0f * TY_PI * (float)j / (float)around, &s, &c);
            mesh->positions[i * around + j] = ty_mad(ty_mad(p[1], u, tube * c), v, tube * s);
            uint32_t corner[4] = {(uint32_t)(i * around + j), (uint32_t)(i * around + (j + 1) % around),
                                  (uint32_t)((i + 1) % along * around + (j + 1) % around),
                                  (uint32_t)((i + 1) % along * around + j)};
            uint32_t turned[4] = {corner[0], corner[3], corner[2], corner[1]};
            ty_mesh_set_quad(mesh, (uint32_t)(2 * (i * around + j)), turned);
        }
    }
    ty_mesh_compute_welds(mesh);
    ty_mesh_topology topology;
    ty_mesh_analyse(mesh, &topology);
    for (uint32_t i = 0; topology.volume < 0.0 && i < mesh->triangle_count; i++)
    {
        uint32_t* c = mesh->triangles[i];
        uint32_t swap = c[1];
        c[1] = c[2];
        c[2] = swap;
    }
    host_write(path, mesh);
}

// A ball of 0.75 divisions^2 triangles, displaced by noise.
static inline void host_rough(const char* path, float radius, int divisions)
{
    ty_shape_def def = ty_shape_def_default();
    def.kind = TY_SHAPE_SPHERE;
    def.radius = radius;
    def.divisions = divisions;
    ty_mesh* mesh;
    ty_error error = {0};
    if (ty_shape_create(&def, &mesh, &error) != TY_OK)
        abort();
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 n = ty_normalize(mesh->positions[i]);
        float sum = 0.0f, weight = 0.12f, scale = 2.0f;
        for (int k = 0; k < 4; k++, weight *= 0.5f, scale *= 2.1f)
            sum += weight * ty_value_noise(ty_mul(n, scale), (uint32_t)k);
        mesh->positions[i] = ty_mul(n, radius * (1.0f + sum));
    }
    host_write(path, mesh);
}
