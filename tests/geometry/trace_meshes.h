// SPDX-License-Identifier: Apache-2.0
// Small meshes and random maps for the tests of tracing and aggregates.
#pragma once
#include <tsuya/base/rng.h>
#include <tsuya/geometry/trace.h>

// Winds the triangle so that it faces along its vertices' normals.
static inline void set_triangle(ty_mesh* mesh, uint32_t t, uint32_t a, uint32_t b, uint32_t c)
{
    const ty_vec3* p = mesh->positions;
    ty_vec3 n = ty_add(mesh->normals[a], ty_add(mesh->normals[b], mesh->normals[c]));
    bool outward = ty_dot(ty_cross(ty_sub(p[b], p[a]), ty_sub(p[c], p[a])), n) > 0.0f;
    mesh->triangles[t][0] = a;
    mesh->triangles[t][1] = outward ? b : c;
    mesh->triangles[t][2] = outward ? c : b;
}

// A torus about y: radius 1, tube .4.
static inline ty_mesh* make_torus(uint32_t columns, uint32_t rows)
{
    ty_mesh* mesh = ty_mesh_create(columns * rows, 2 * columns * rows);
    for (uint32_t i = 0; i < columns * rows; i++)
    {
        float s, c, sa, ca;
        ty_sincos(2.0f * TY_PI * (float)(i % columns) / (float)columns, &s, &c);
        ty_sincos(2.0f * TY_PI * (float)(i / columns) / (float)rows, &sa, &ca);
        mesh->normals[i] = ty_vec3_make(c * ca, sa, s * ca);
        mesh->positions[i] = ty_vec3_make(c * (1.0f + 0.4f * ca), 0.4f * sa, s * (1.0f + 0.4f * ca));
    }
    for (uint32_t i = 0; i < columns * rows; i++)
    {
        uint32_t r = i / columns, c = i % columns, right = r * columns + (c + 1) % columns;
        uint32_t up = (r + 1) % rows * columns + c, diagonal = (r + 1) % rows * columns + (c + 1) % columns;
        set_triangle(mesh, 2 * i, i, right, diagonal);
        set_triangle(mesh, 2 * i + 1, i, diagonal, up);
    }
    ty_mesh_compute_bounds(mesh);
    ty_mesh_compute_welds(mesh);
    return mesh;
}

// A closed unit sphere: two poles and `rows` rings of `columns` vertices; 2 columns rows triangles.
static inline ty_mesh* make_sphere(uint32_t columns, uint32_t rows)
{
    ty_mesh* mesh = ty_mesh_create(columns * rows + 2, 2 * columns * rows);
    uint32_t south = columns * rows, north = south + 1, t = 0;
    for (uint32_t i = 0; i < columns * rows; i++)
    {
        float s, c, sa, ca;
        ty_sincos(2.0f * TY_PI * (float)(i % columns) / (float)columns, &s, &c);
        ty_sincos(TY_PI * ((float)(i / columns + 1) / (float)(rows + 1) - 0.5f), &sa, &ca);
        mesh->positions[i] = ty_normalize(ty_vec3_make(c * ca, sa, s * ca));
    }
    mesh->positions[south] = ty_vec3_make(0.0f, -1.0f, 0.0f);
    mesh->positions[north] = ty_vec3_make(0.0f, 1.0f, 0.0f);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        mesh->normals[i] = mesh->positions[i];
    for (uint32_t i = 0; i < columns * rows; i++)
    {
        uint32_t r = i / columns, right = r * columns + (i + 1) % columns;
        if (r == 0)
            set_triangle(mesh, t++, south, i, right);
        if (r + 1 == rows)
        {
            set_triangle(mesh, t++, i, right, north);
            continue;
        }
        set_triangle(mesh, t++, i, right, right + columns);
        set_triangle(mesh, t++, i, right + columns, i + columns);
    }
    ty_mesh_compute_bounds(mesh);
    ty_mesh_compute_welds(mesh);
    return mesh;
}

static inline ty_vec3 random_direction(ty_rng* rng)
{
    float z = ty_rng_range(rng, -1.0f, 1.0f), r = ty_safe_sqrt(1.0f - z * z), s, c;
    ty_sincos(2.0f * TY_PI * ty_rng_float(rng), &s, &c);
    return ty_vec3_make(r * c, r * s, z);
}

static inline ty_vec3 random_point(ty_rng* rng, float half)
{
    float x = ty_rng_range(rng, -half, half), y = ty_rng_range(rng, -half, half);
    return ty_vec3_make(x, y, ty_rng_range(rng, -half, half));
}

static inline ty_quat random_rotation(ty_rng* rng)
{
    float a = ty_rng_float(rng), b = ty_rng_float(rng);
    return ty_quat_uniform(a, b, ty_rng_float(rng));
}

// Rotated, stretched along its own axes by .5 to 2 times size, and every third mirrored.
static inline ty_affine random_map(ty_rng* rng, uint32_t i, float half, float size)
{
    ty_vec3 at = random_point(rng, half);
    ty_quat q = random_rotation(rng);
    float x = ty_rng_range(rng, 0.5f, 2.0f), y = ty_rng_range(rng, 0.5f, 2.0f), z = ty_rng_range(rng, 0.5f, 2.0f);
    return ty_affine_from_trs(at, q, ty_vec3_make(i % 3 == 0 ? -x * size : x * size, y * size, z * size));
}
