// SPDX-License-Identifier: Apache-2.0
// Elements that are bent out of a shape: balls, grapes, beans, tofu, pebbles; and closed meshes of files.
#include "closed_mesh.h"
#include "element_kinds.h"
#include <tsuya/geometry/shape.h>

// --- meshes of files ---

static ty_vec3 extent_sorted(ty_bounds b)
{
    ty_vec3 e = ty_sub(b.high, b.low);
    float most = ty_max(e.x, ty_max(e.y, e.z)), least = ty_min(e.x, ty_min(e.y, e.z));
    return ty_vec3_make(most, e.x + e.y + e.z - most - least, least);
}

ty_status ty_solid_complete(ty_element_def* def, const char* name, ty_error* error)
{
    ty_mesh* mesh;
    ty_status status = closed_mesh_read(name, "kind mesh", def->mesh, &mesh, error);
    if (status != TY_OK)
        return status;
    ty_vec3 size = extent_sorted(mesh->bounds);
    ty_mesh_destroy(mesh);
    def->length = def->length > 0.0f ? def->length : size.x;
    if (!(def->length >= 1e-4f && def->length <= 0.5f))
        return ty_error_set(error, TY_BAD_INPUT, "%s.length: %s is %g mm long; give a length of 0.1..500 mm", name,
                            def->mesh, (double)def->length * 1e3);
    def->width = size.y * def->length / size.x;
    def->thickness = size.z * def->length / size.x;
    def->variants = 1;
    return TY_OK;
}

static ty_status file_mesh_scaled(const ty_element_def* def, ty_mesh** out, ty_error* error)
{
    ty_status status = closed_mesh_read("element", "kind mesh", def->mesh, out, error);
    if (status != TY_OK)
        return status;
    float scale = def->length / extent_sorted((*out)->bounds).x;
    ty_affine map = ty_affine_identity();
    map.x.x = map.y.y = map.z.z = scale;
    ty_mesh_transform(*out, &map);
    if (!(*out)->curvature_1)
        ty_mesh_compute_curvature(*out, 2);
    return TY_OK;
}

// --- bent balls ---

typedef struct body_shape
{
    ty_vec3 half;    // m
    float dent;      // m
    float dent_wide; // of the width of the dent against the half width
    float taper, bend;
} body_shape;

static body_shape shape_draw(const ty_element_def* def, ty_rng* rng)
{
    float bell[5];
    for (int i = 0; i < 5; i++)
        bell[i] = ty_clamp(ty_element_bell(rng), -2.0f, 2.0f);
    float v = def->variation;
    body_shape s = {.half = {0.5f * def->length * (1.0f + v * bell[0]), 0.5f * def->width * (1.0f + 0.6f * v * bell[1]),
                             0.5f * def->thickness * (1.0f + 0.6f * v * bell[1] + 0.4f * v * bell[2])}};
    s.dent = 2.0f * s.half.y * def->notch * (1.0f + 0.2f * bell[3]);
    s.taper = 0.05f + 0.5f * v * bell[4];
    s.bend = s.half.y * (0.34f + 1.5f * v * bell[4]);
    s.dent_wide = def->kind == TY_ELEMENT_GRAPE ? 0.16f : 0.5f;
    return s;
}

// Narrower away from the stem, which is at +x, where the skin is drawn in.
static ty_vec3 grape_point(const body_shape* s, ty_vec3 u)
{
    ty_vec3 p = ty_mul3(u, s->half);
    float section = 1.0f + s->taper * u.x;
    float across = u.y * u.y + u.z * u.z;
    float dent = u.x > 0.0f ? 0.35f * s->dent * ty_exp(-across / (2.0f * s->dent_wide * s->dent_wide)) : 0.0f;
    return ty_vec3_make(p.x - dent, p.y * section, p.z * section);
}

// Blunt ends, bent towards +y, where the hilum is drawn in between them.
static ty_vec3 bean_point(const body_shape* s, ty_vec3 u)
{
    float x = ty_min(fabsf(u.x), 1.0f), blunt = sqrtf((1.0f + x + x * x) / (1.0f + x));
    ty_vec3 p = {s->half.x * u.x, s->half.y * u.y * blunt, s->half.z * u.z * blunt};
    float along = u.x * u.x, wide = 2.0f * s->dent_wide * s->dent_wide;
    float dent = u.y > 0.0f ? s->dent * u.y * ty_exp(-along / wide - u.z * u.z / 0.6f) : 0.0f;
    p.y += s->bend * (along - 0.33f) - dent;
    p.y *= 1.0f / (1.0f + 0.5f * s->bend / s->half.y); // the bend is part of the width
    return p;
}

// The corners of a cut block are a little off, each by chance; sides stay as straight lines.
static ty_vec3 block_point(const ty_vec3* corners, ty_vec3 half, ty_vec3 p)
{
    float f[3] = {0.5f + 0.5f * p.x / half.x, 0.5f + 0.5f * p.y / half.y, 0.5f + 0.5f * p.z / half.z};
    for (int c = 0; c < 8; c++)
    {
        float w = (c & 1 ? f[0] : 1.0f - f[0]) * (c & 2 ? f[1] : 1.0f - f[1]) * (c & 4 ? f[2] : 1.0f - f[2]);
        p = ty_mad(p, corners[c], w);
    }
    return p;
}

static void block_bend(const ty_element_def* def, ty_vec3 half, ty_rng* rng, ty_mesh* mesh)
{
    ty_vec3 corners[8];
    float most = 0.5f * def->variation * half.z;
    for (int i = 0; i < 8; i++)
    {
        corners[i].x = most * ty_element_bell(rng);
        corners[i].y = most * ty_element_bell(rng);
        corners[i].z = most * ty_element_bell(rng);
    }
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        mesh->positions[i] = block_point(corners, half, mesh->positions[i]);
}

static void ball_bend(const ty_element_def* def, const body_shape* s, ty_mesh* mesh)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 u = mesh->positions[i];
        mesh->positions[i] = def->kind == TY_ELEMENT_GRAPE  ? grape_point(s, u)
                             : def->kind == TY_ELEMENT_BEAN ? bean_point(s, u)
                                                            : ty_mul3(u, s->half);
    }
}

ty_status ty_solid_mesh(const ty_element_def* def, ty_seed seed, int variant, ty_mesh** out, ty_error* error)
{
    if (def->kind == TY_ELEMENT_MESH)
        return file_mesh_scaled(def, out, error);
    ty_rng rng = ty_rng_make(seed, 0x736f6c6964, (uint64_t)variant);
    body_shape s = shape_draw(def, &rng);
    ty_shape_def shape = ty_shape_def_default();
    shape.kind = TY_SHAPE_SPHERE;
    shape.radius = def->kind == TY_ELEMENT_BALL ? s.half.x : 1.0f;
    shape.divisions = 4 * def->divisions;
    shape.size = s.half;
    if (def->kind == TY_ELEMENT_TOFU)
    {
        shape.kind = TY_SHAPE_BOX;
        shape.rounding = 0.12f * s.half.z;
        shape.divisions = 24;
    }
    if (def->kind == TY_ELEMENT_PEBBLE)
    {
        shape.kind = TY_SHAPE_STONE;
        shape.relief = 0.1f;
        shape.variant = (int)(ty_rng_u32(&rng) >> 12);
        shape.divisions = 8 * def->divisions;
    }
    if (def->kind == TY_ELEMENT_BALL)
        shape.radius = 0.5f * def->length;
    ty_status status = ty_shape_create(&shape, out, error);
    if (status != TY_OK || def->kind == TY_ELEMENT_BALL || def->kind == TY_ELEMENT_PEBBLE)
        return status;
    if (def->kind == TY_ELEMENT_TOFU)
        block_bend(def, s.half, &rng, *out);
    else
        ball_bend(def, &s, *out);
    ty_mesh_compute_welds(*out);
    ty_mesh_compute_normals(*out, TY_PI);
    ty_mesh_compute_curvature(*out, 2);
    return TY_OK;
}
