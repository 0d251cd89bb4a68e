// SPDX-License-Identifier: Apache-2.0
// Hosts for roots, as files: each a few closed parts and all of them as one mesh.
#pragma once
#include "base/cmocka_all.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/geometry/mesh_file.h>
#include <tsuya/geometry/shape.h>

typedef struct host_files
{
    char whole[64];
    char part[8][64];
    const char* paths[8];
    int count;
} host_files;

static ty_mesh* host_shape(ty_shape_kind kind, ty_vec3 size, float rounding, ty_vec3 at)
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
static ty_mesh* host_knot(float size, float radius, int along, int around)
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
static ty_mesh* host_ball(float radius, int divisions)
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
static void host_save(const char* name, ty_mesh** parts, int count, host_files* out)
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
static void host_make(const char* name, int detail, host_files* out)
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
        parts[0] = host_ball(0.05f, detail > 1 ? 1024 : 96);
    host_save(name, parts, count, out);
}
