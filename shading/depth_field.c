// SPDX-License-Identifier: Apache-2.0
// Thickness and curvature per vertex of a prototype, smoothed over the surface: what `evaluate: depth` reads.
#include "depth_field.h"
#include <tsuya/base/memory.h>

// Thickness from rays along the inward normals; where none is found (open meshes), of a ball with the same curvature.
static void measure(const ty_world* world, uint32_t prototype, const ty_mesh* mesh, ty_depth_field* field)
{
    float size = ty_length(ty_sub(mesh->bounds.high, mesh->bounds.low)), step = 1e-4f * size;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        float h = mesh->curvature_1 && mesh->curvature_2 ? 0.5f * (mesh->curvature_1[i] + mesh->curvature_2[i]) : 0.0f;
        ty_vec3 n = ty_normalize(mesh->normals[i]), inward = ty_neg(n);
        ty_hit hit;
        bool found = ty_world_intersect_prototype(world, prototype, ty_mad(mesh->positions[i], inward, step), inward,
                                                  2.0f * size, &hit, NULL);
        field->depth[i] = found ? ty_max(hit.t + step, 2.0f * step) : h * size > 2.0f ? 2.0f / h : size;
        field->curvature[i] = h;
    }
}

static float smoothing_width(const ty_mesh* mesh, const ty_mesh_topology* topology)
{
    if (topology->closed && topology->area > 0.0)
        return (float)(0.35 * 3.0 * topology->volume / topology->area);
    return 0.1f * ty_length(ty_sub(mesh->bounds.high, mesh->bounds.low));
}

ty_status ty_depth_field_create(const ty_world* world, uint32_t prototype, ty_depth_field** out, ty_error* error)
{
    *out = NULL;
    const ty_mesh* mesh = ty_world_prototype_mesh(world, prototype);
    uint32_t count = mesh->vertex_count;
    ty_depth_field* field = TY_ALLOC(ty_depth_field, 1);
    float* inverse = TY_TRY_ALLOC(float, count);
    field->depth = TY_TRY_ALLOC(float, count);
    field->curvature = TY_TRY_ALLOC(float, count);
    if (!inverse || !field->depth || !field->curvature)
    {
        ty_free(inverse);
        ty_depth_field_destroy(field);
        return ty_error_set(error, TY_NO_MEMORY, "no memory for the depth field of %u vertices", count);
    }
    measure(world, prototype, mesh, field);
    for (uint32_t i = 0; i < count; i++)
        inverse[i] = 1.0f / field->depth[i];
    float width = smoothing_width(mesh, ty_world_topology(world, prototype));
    float* const fields[] = {inverse, field->curvature};
    ty_mesh_smooth_fields(mesh, fields, 2, width);
    for (uint32_t i = 0; i < count; i++)
    {
        field->depth[i] = ty_min(field->depth[i], 1.0f / inverse[i]);
        field->curvature[i] = ty_max(field->curvature[i], 0.0f);
    }
    ty_free(inverse);
    *out = field;
    return TY_OK;
}

void ty_depth_field_destroy(ty_depth_field* field)
{
    if (!field)
        return;
    ty_free(field->depth);
    ty_free(field->curvature);
    ty_free(field);
}
