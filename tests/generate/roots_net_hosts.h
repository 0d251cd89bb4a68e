// SPDX-License-Identifier: Apache-2.0
// Hosts that no shape makes, as files: a box compound, a torus knot, a bust-like union, a rough ball.
#pragma once
#include <stdlib.h>
#include <tsuya/base/noise.h>
#include <tsuya/geometry/mesh_file.h>
#include <tsuya/geometry/shape.h>
#include <tsuya/geometry/surface_net.h>

typedef float host_distance(ty_vec3 p);

static inline float host_box(ty_vec3 p, ty_vec3 c, ty_vec3 half)
{
    ty_vec3 q = {fabsf(p.x - c.x) - half.x, fabsf(p.y - c.y) - half.y, fabsf(p.z - c.z) - half.z};
    ty_vec3 out = {ty_max(q.x, 0.0f), ty_max(q.y, 0.0f), ty_max(q.z, 0.0f)};
    return ty_length(out) + ty_min(ty_max(q.x, ty_max(q.y, q.z)), 0.0f);
}

static inline float host_ball(ty_vec3 p, ty_vec3 c, ty_vec3 axes)
{
    ty_vec3 q = ty_sub(p, c);
    q = ty_vec3_make(q.x / axes.x, q.y / axes.y, q.z / axes.z);
    return (ty_length(q) - 1.0f) * ty_min(axes.x, ty_min(axes.y, axes.z));
}

// A shaft with two blocks built into it.
static float host_compound(ty_vec3 p)
{
    float d = host_box(p, (ty_vec3){0.0f, 0.0f, 0.0f}, (ty_vec3){0.02f, 0.1f, 0.02f});
    d = ty_min(d, host_box(p, (ty_vec3){0.012f, 0.02f, 0.014f}, (ty_vec3){0.018f, 0.012f, 0.018f}));
    return ty_min(d, host_box(p, (ty_vec3){-0.016f, -0.03f, 0.0f}, (ty_vec3){0.014f, 0.02f, 0.012f}));
}

// Head, neck, shoulders, pedestal.
static float host_bust(ty_vec3 p)
{
    float d = host_ball(p, (ty_vec3){0.0f, 0.075f, 0.0f}, (ty_vec3){0.024f, 0.03f, 0.027f});
    d = ty_min(d, host_ball(p, (ty_vec3){0.0f, 0.072f, 0.026f}, (ty_vec3){0.005f, 0.009f, 0.008f}));
    d = ty_min(d, host_box(p, (ty_vec3){0.0f, 0.035f, 0.0f}, (ty_vec3){0.012f, 0.022f, 0.012f}) - 0.002f);
    d = ty_min(d, host_ball(p, (ty_vec3){0.0f, 0.0f, 0.0f}, (ty_vec3){0.055f, 0.026f, 0.028f}));
    return ty_min(d, host_box(p, (ty_vec3){0.0f, -0.055f, 0.0f}, (ty_vec3){0.03f, 0.045f, 0.026f}));
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

// The (2, 3) torus knot as a closed tube.
static inline void host_knot(const char* path, float size, float tube, int along, int around)
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
