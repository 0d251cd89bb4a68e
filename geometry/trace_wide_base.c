// SPDX-License-Identifier: Apache-2.0
// The wide top level for what every machine of the build has.
#define KERNEL base
#include "trace_wide_kernel.h"

void ty_wide_to_sphere(const ty_affine* map, ty_vec3* origin, ty_vec3* direction)
{
    const float m[3][4] = {{map->x.x, map->y.x, map->z.x, map->t.x},
                           {map->x.y, map->y.y, map->z.y, map->t.y},
                           {map->x.z, map->y.z, map->z.z, map->t.z}};
    const ty_vec3 p = *origin, w = *direction;
    float o[3], d[3];
    for (int i = 0; i < 3; i++)
    {
        o[i] = fmaf(m[i][0], p.x, fmaf(m[i][1], p.y, fmaf(m[i][2], p.z, m[i][3])));
        d[i] = fmaf(m[i][0], w.x, fmaf(m[i][1], w.y, m[i][2] * w.z));
    }
    *origin = (ty_vec3){o[0], o[1], o[2]};
    *direction = (ty_vec3){d[0], d[1], d[2]};
}
