// SPDX-License-Identifier: Apache-2.0
// Shapes with sizes for tests, and what every mesh of a shape keeps.
#pragma once
#include <base/cmocka_all.h>
#include <tsuya/geometry/shape.h>

static inline ty_shape_def shape_of(int kind)
{
    ty_shape_def def = ty_shape_def_default();
    def = ty_shape_def_complete(&def);
    def.kind = kind;
    def.divisions = 96;
    if (kind == TY_SHAPE_SWEEP)
    {
        def.size = ty_vec3_make(1.2f, 0.8f, 0.6f);
        def.rounding = 0.25f;
    }
    if (kind == TY_SHAPE_ELLIPSOID)
        def.size = ty_vec3_make(0.03f, 0.0125f, 0.018f);
    return def;
}

static inline ty_mesh* make(const ty_shape_def* def)
{
    ty_mesh* mesh = NULL;
    ty_error error = {0};
    ty_status status = ty_shape_create(def, &mesh, &error);
    if (status != TY_OK)
        print_message("%s\n", error.text);
    assert_int_equal(status, TY_OK);
    return mesh;
}

static inline ty_mesh_topology topology_of(const ty_shape_def* def)
{
    ty_mesh* mesh = make(def);
    ty_mesh_topology topology;
    ty_mesh_analyse(mesh, &topology);
    ty_mesh_destroy(mesh);
    return topology;
}

static inline void check_surface(const ty_mesh* mesh)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        assert_float_equal(ty_length(mesh->normals[i]), 1.0f, 1e-5f);
        assert_float_equal(ty_length(mesh->direction_1[i]), 1.0f, 1e-5f);
        assert_float_equal(ty_dot(mesh->normals[i], mesh->direction_1[i]), 0.0f, 1e-5f);
        assert_true(mesh->curvature_1[i] >= mesh->curvature_2[i]);
        assert_true(mesh->uvs[i].x >= 0.0f && mesh->uvs[i].x <= 1.0f);
        assert_true(mesh->uvs[i].y >= 0.0f && mesh->uvs[i].y <= 1.0f);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        const uint32_t* c = mesh->triangles[t];
        const ty_vec3* p = mesh->positions;
        ty_vec3 face = ty_normalize(ty_cross(ty_sub(p[c[1]], p[c[0]]), ty_sub(p[c[2]], p[c[0]])));
        for (int k = 0; k < 3; k++)
        {
            assert_true(ty_dot(face, mesh->normals[c[k]]) > 0.95f);
            // No triangle spans the seam.
            float du = fabsf(mesh->uvs[c[k]].x - mesh->uvs[c[(k + 1) % 3]].x);
            assert_true(du < 0.5f || mesh->triangle_count < 200);
        }
    }
}
