// SPDX-License-Identifier: Apache-2.0
// What roots grow on: a mesh asked for its closest point, and the plane it stands on.
#include "roots.h"
#include <tsuya/geometry/mesh_file.h>

static const ty_shape_kind shapes[] = {TY_SHAPE_SPHERE, TY_SHAPE_ELLIPSOID, TY_SHAPE_BOX, TY_SHAPE_CYLINDER,
                                       TY_SHAPE_STONE};

static ty_status mesh_make(const ty_roots_host_def* def, ty_mesh** out, ty_error* error)
{
    if (def->kind == TY_ROOTS_HOST_MESH && !def->mesh)
        return ty_error_set(error, TY_BAD_INPUT, "host.mesh: the file is missing");
    if (def->kind == TY_ROOTS_HOST_MESH)
        return ty_mesh_read(def->mesh, out, error);
    ty_shape_def shape = def->shape;
    shape.kind = shapes[def->kind];
    return ty_shape_create(&shape, out, error);
}

static ty_status world_make(roots_host* host, ty_error* error)
{
    ty_world_def def = ty_world_def_default();
    ty_status status = ty_world_create(&def, &host->world, error);
    if (status == TY_OK)
        status = ty_world_add_prototype(host->world, host->mesh, &host->prototype, error);
    return status == TY_OK ? ty_world_commit(host->world, error) : status;
}

// A grid of that many steps along the host's longest side.
static ty_status field_make(roots_host* host, int resolution, ty_error* error)
{
    ty_vec3 size = ty_sub(host->mesh->bounds.high, host->mesh->bounds.low);
    float longest = ty_max(size.x, ty_max(size.y, size.z)), step = longest / (float)resolution;
    return ty_voxels_from_mesh(host->mesh, step, 8.0f * step, &host->field, error);
}

ty_status roots_host_init(const ty_roots_host_def* def, roots_host* out, ty_error* error)
{
    *out = (roots_host){.has_floor = def->floor};
    ty_status status = mesh_make(def, &out->mesh, error);
    if (status == TY_OK)
        status = world_make(out, error);
    if (status == TY_OK)
        status = field_make(out, 128, error);
    if (status == TY_OK)
        out->floor = out->mesh->bounds.low.y;
    else
        roots_host_term(out);
    return status;
}

void roots_host_term(roots_host* host)
{
    ty_world_destroy(host->world);
    ty_mesh_destroy(host->mesh);
    ty_voxels_term(&host->field);
    *host = (roots_host){0};
}

// --- distances ---

// Trilinear; beyond the grid the way to it is added.
static float field_value(const ty_voxels* f, ty_vec3 p, ty_vec3* gradient)
{
    ty_vec3 q = ty_mul(ty_sub(p, f->origin), 1.0f / f->step);
    const float at[3] = {q.x, q.y, q.z};
    float part[3], off[3];
    size_t low = 0, stride[3] = {1, (size_t)f->size[0], (size_t)f->size[0] * (size_t)f->size[1]};
    for (int i = 0; i < 3; i++)
    {
        float x = ty_clamp(at[i], 0.0f, (float)(f->size[i] - 1) - 1e-3f);
        int cell = (int)x;
        off[i] = at[i] - x;
        part[i] = x - (float)cell;
        low += stride[i] * (size_t)cell;
    }
    const float *v = f->values + low, *w = v + stride[2];
    size_t y = stride[1];
    float v00 = ty_lerp(v[0], v[1], part[0]), v10 = ty_lerp(v[y], v[y + 1], part[0]);
    float v01 = ty_lerp(w[0], w[1], part[0]), v11 = ty_lerp(w[y], w[y + 1], part[0]);
    float v0 = ty_lerp(v00, v10, part[1]), v1 = ty_lerp(v01, v11, part[1]);
    float dx0 = ty_lerp(v[1] - v[0], v[y + 1] - v[y], part[1]), dx1 = ty_lerp(w[1] - w[0], w[y + 1] - w[y], part[1]);
    ty_vec3 g = {ty_lerp(dx0, dx1, part[2]), ty_lerp(v10 - v00, v11 - v01, part[2]), v1 - v0};
    g = ty_mul(g, 1.0f / f->step);
    ty_vec3 beyond = ty_mul(ty_vec3_make(off[0], off[1], off[2]), f->step);
    float away = ty_length(beyond);
    *gradient = away > f->step ? ty_normalize(ty_add(ty_mul(g, ty_lerp(v0, v1, part[2])), beyond)) : g;
    return ty_lerp(v0, v1, part[2]) + away;
}

float roots_host_value(const roots_host* host, ty_vec3 p, ty_vec3* gradient)
{
    ty_vec3 g;
    float d = field_value(&host->field, p, &g), floor = p.y - host->floor;
    if (host->has_floor && floor < d)
    {
        d = floor;
        g = ty_vec3_make(0.0f, 1.0f, 0.0f);
    }
    if (gradient)
        *gradient = g;
    return d;
}

// Facets and the two sides of an edge turn the exact direction by jumps; it is the field's sign that counts.
float roots_host_exact(const roots_host* host, ty_vec3 p, float reach, ty_vec3* normal)
{
    ty_closest c;
    ty_vec3 g;
    float d = field_value(&host->field, p, &g), floor = p.y - host->floor;
    *normal = ty_normalize(g);
    if (fabsf(d) < reach && ty_world_closest(host->world, host->prototype, p, reach + host->field.step, &c))
    {
        // near the surface the field may err in the sign: the side of the facet decides then
        ty_vec3 away = ty_sub(p, c.position);
        float side = d < 0.0f ? -1.0f : 1.0f;
        if (c.distance > 1e-3f * host->field.step)
        {
            side = fabsf(d) > 0.5f * host->field.step ? side : ty_dot(away, *normal) < 0.0f ? -1.0f : 1.0f;
            *normal = ty_mul(away, side / c.distance);
        }
        d = side * c.distance;
    }
    if (!host->has_floor || floor >= d)
        return d;
    *normal = ty_vec3_make(0.0f, 1.0f, 0.0f);
    return floor;
}

ty_vec3 roots_host_project(const roots_host* host, ty_vec3 p, float height, ty_vec3* normal)
{
    ty_vec3 g;
    for (int i = 0; i < 3; i++)
    {
        float wrong = roots_host_value(host, p, &g) - height, steep = ty_max(ty_length_sqr(g), 0.25f);
        p = ty_mad(p, g, -wrong / steep);
        if (fabsf(wrong) < 1e-3f * host->field.step)
            break;
    }
    *normal = ty_length_sqr(g) > 0.0f ? ty_normalize(g) : ty_vec3_make(0.0f, 1.0f, 0.0f);
    return p;
}
