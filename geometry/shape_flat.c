// SPDX-License-Identifier: Apache-2.0
// Open shapes: the plane and the photographer's sweep.
#include "shape_build.h"

void ty_shape_build_plane(ty_shape_build* build, const ty_shape_def* def)
{
    uint32_t corners[4];
    for (int i = 0; i < 4; i++)
    {
        bool right = i == 1 || i == 2, back = i >= 2;
        ty_shape_vertex vertex = {
            .position = {right ? def->size.x : -def->size.x, 0.0f, back ? -def->size.z : def->size.z},
            .normal = {0.0f, 1.0f, 0.0f},
            .direction = {1.0f, 0.0f, 0.0f},
            .uv = {right ? 1.0f : 0.0f, back ? 1.0f : 0.0f},
        };
        corners[i] = ty_shape_add_vertex(build, &vertex);
    }
    ty_shape_add_quad(build, corners[0], corners[1], corners[2], corners[3]);
}

typedef struct sweep_row
{
    double y, z, ny, nz, along, curvature;
} sweep_row;

// Row i of steps + 3: the front edge, the arc, the top edge. The arc's ends are flat, as what they touch.
static sweep_row sweep_at(const ty_shape_def* def, int i, int steps)
{
    double e = (double)def->rounding, depth = (double)def->size.z, height = (double)def->size.y;
    double floor_length = 2.0 * depth - e, arc = 0.5 * M_PI * e;
    if (i == 0)
        return (sweep_row){0.0, depth, 1.0, 0.0, 0.0, 0.0};
    if (i == steps + 2)
        return (sweep_row){height, -depth, 0.0, 1.0, floor_length + arc + height - e, 0.0};
    int k = i - 1;
    double part = (double)k / steps, s = k == steps ? 1.0 : sin(0.5 * M_PI * part);
    double c = k == steps ? 0.0 : cos(0.5 * M_PI * part);
    bool end = k == 0 || k == steps;
    return (sweep_row){e - e * c, -depth + e - e * s, c, s, floor_length + arc * part, end ? 0.0 : -1.0 / e};
}

void ty_shape_build_sweep(ty_shape_build* build, const ty_shape_def* def)
{
    int steps = (def->divisions + 3) / 4;
    double length = sweep_at(def, steps + 2, steps).along;
    for (int i = 0; i < steps + 3; i++)
    {
        sweep_row row = sweep_at(def, i, steps);
        for (int right = 0; right < 2; right++)
        {
            ty_shape_vertex vertex = {
                .position = {right ? def->size.x : -def->size.x, (float)row.y, (float)row.z},
                .normal = {0.0f, (float)row.ny, (float)row.nz},
                .uv = {(float)right, (float)fmin(row.along / length, 1.0)},
            };
            ty_vec3 up = {0.0f, (float)row.nz, (float)-row.ny};
            ty_shape_set_curvature(&vertex, 0.0, row.curvature, (ty_vec3){1.0f, 0.0f, 0.0f}, up);
            ty_shape_add_vertex(build, &vertex);
        }
    }
    for (uint32_t i = 0; i < (uint32_t)steps + 2; i++)
        ty_shape_add_quad(build, 2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2);
}
