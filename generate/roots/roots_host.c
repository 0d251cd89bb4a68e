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

ty_status roots_host_init(const ty_roots_host_def* def, roots_host* out, ty_error* error)
{
    *out = (roots_host){.has_floor = def->floor};
    ty_status status = mesh_make(def, &out->mesh, error);
    if (status == TY_OK)
        status = world_make(out, error);
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
    *host = (roots_host){0};
}

// The side of p by the smooth normal at its closest point, which open meshes have too.
static float mesh_distance(const roots_host* host, ty_vec3 p, float reach, ty_vec3* normal)
{
    ty_closest c;
    *normal = ty_vec3_make(0.0f, 1.0f, 0.0f);
    if (!ty_world_closest(host->world, host->prototype, p, reach, &c))
        return reach;
    const uint32_t* corner = host->mesh->triangles[c.triangle];
    const ty_vec3* n = host->mesh->normals;
    ty_vec3 smooth = ty_mul(n[corner[0]], 1.0f - c.u - c.v), away = ty_sub(p, c.position);
    smooth = ty_normalize(ty_mad(ty_mad(smooth, n[corner[1]], c.u), n[corner[2]], c.v));
    float side = ty_dot(away, smooth) < 0.0f ? -1.0f : 1.0f;
    // Facets turn the exact gradient by jumps; half of the smooth normal keeps lines smooth.
    *normal = ty_normalize(c.distance > 1e-6f ? ty_mad(smooth, away, side / c.distance) : smooth);
    return side * c.distance;
}

float roots_host_distance(const roots_host* host, ty_vec3 p, float reach, float blend, ty_vec3* normal)
{
    float d = mesh_distance(host, p, reach, normal);
    float floor = p.y - host->floor;
    if (!host->has_floor || floor >= d + blend)
        return d;
    const ty_vec3 up = {0.0f, 1.0f, 0.0f};
    // The polynomial smooth minimum (Quilez) and its gradient.
    float h = ty_clamp(0.5f + 0.5f * (d - floor) / blend, 0.0f, 1.0f);
    *normal = ty_normalize(ty_lerp3(*normal, up, h));
    return ty_lerp(d, floor, h) - blend * h * (1.0f - h);
}
