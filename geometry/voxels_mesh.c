// SPDX-License-Identifier: Apache-2.0
// The signed distance from a closed mesh: winding numbers along rows, nearest triangles by a distance transform.
#include "voxels_scan.h"
#include <string.h>

enum
{
    BAND = 4, // steps from the surface within which the distance is the nearest triangle's
};

static void signs_apply(voxels_scan* s)
{
    const ty_voxels* v = s->v;
    for (int k = 0; k < v->size[2]; k++)
        for (int j = 0; j < v->size[1]; j++)
        {
            int winding = 0;
            size_t row = voxels_index(v, 0, j, k);
            for (int i = 0; i < v->size[0]; i++)
            {
                winding += s->turns[row + (size_t)i];
                v->values[row + (size_t)i] = copysignf(v->values[row + (size_t)i], winding > 0 ? -1.0f : 1.0f);
            }
        }
}

static void distances_finish(voxels_scan* s)
{
    const ty_voxels* v = s->v;
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < v->size[2]; k++)
            for (int j = 0; j < v->size[1]; j++)
                for (int i = 0; i < v->size[0]; i++)
                {
                    size_t node = voxels_index(v, i, j, k);
                    ty_vec3 p = voxels_place(v, i, j, k);
                    if (s->site[node] == (int32_t)node)
                        continue;
                    if (pass == 1)
                        voxels_scan_ask(s, (const int[3]){i, j, k}, p);
                    else
                        voxels_scan_try(s, node, p, s->near[s->site[node]]);
                    if (pass == 0 && v->values[node] < ty_sqr((BAND + 1) * v->step))
                        voxels_scan_descend(s, node, p);
                }
    for (size_t i = 0; i < voxels_count(v); i++)
        v->values[i] = sqrtf(v->values[i]);
}

static bool mesh_scan(voxels_scan* s)
{
    size_t count = voxels_count(s->v);
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++)
    {
        voxels_scan_turn(s, s->mesh->triangles[t], 0, s->v->size[2] - 1);
        voxels_scan_spread(s, (int32_t)t, 0, s->v->size[2] - 1, false);
    }
    for (size_t i = 0; i < count; i++) // a triangle that is nearer than a step has the node in its box
        s->site[i] = s->near[i] >= 0 && s->v->values[i] <= ty_sqr(s->v->step) ? (int32_t)i : -1;
    if (!voxels_scan_transform(s, NULL))
        return false;
    distances_finish(s);
    signs_apply(s);
    return true;
}

ty_status ty_voxels_from_mesh(const ty_mesh* mesh, float step, float margin, ty_voxels* out, ty_error* error)
{
    ty_bounds bounds = ty_bounds_empty();
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        bounds = ty_bounds_add(bounds, mesh->positions[i]);
    *out = (ty_voxels){0};
    if (mesh->triangle_count == 0)
        return ty_error_set(error, TY_BAD_INPUT, "a mesh without triangles is no solid");
    ty_status status = voxels_init(bounds, step, margin, out, error);
    if (status == TY_OK)
    {
        size_t count = voxels_count(out);
        voxels_scan s = {mesh, out, TY_TRY_ALLOC(int32_t, count), TY_TRY_ALLOC(int32_t, count),
                         TY_TRY_ALLOC(int16_t, count)};
        bool held = s.site && s.near && s.turns;
        if (held)
        {
            memset(s.near, 0xff, count * sizeof(int32_t));
            held = mesh_scan(&s);
        }
        ty_free(s.site);
        ty_free(s.near);
        ty_free(s.turns);
        if (!held)
            status = ty_error_set(error, TY_NO_MEMORY, "no memory for a grid of %zu nodes", count);
    }
    if (status != TY_OK)
        ty_voxels_term(out);
    return status;
}
