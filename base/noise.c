// SPDX-License-Identifier: Apache-2.0
// Value noise: a hash at each point of the lattice.
#include <tsuya/base/noise.h>
#include <tsuya/base/rng.h>

static float lattice(int x, int y, int z, uint32_t seed)
{
    uint32_t h = ty_mix32((uint32_t)z + seed);
    h = ty_mix32((uint32_t)y + 0x85ebca6bu * h);
    return 2.0f * ty_u32_to_float(ty_mix32((uint32_t)x + 0x9e3779b9u * h)) - 1.0f;
}

float ty_value_noise(ty_vec3 p, uint32_t seed)
{
    int i = (int)floorf(p.x), j = (int)floorf(p.y), k = (int)floorf(p.z);
    ty_vec3 f = {p.x - (float)i, p.y - (float)j, p.z - (float)k};
    ty_vec3 w = ty_mul3(ty_mul3(f, f), ty_sub(ty_vec3_make(3.0f, 3.0f, 3.0f), ty_mul(f, 2.0f)));
    float sum[2];
    for (int e = 0; e < 2; e++)
    {
        float low = ty_lerp(lattice(i, j, k + e, seed), lattice(i + 1, j, k + e, seed), w.x);
        float high = ty_lerp(lattice(i, j + 1, k + e, seed), lattice(i + 1, j + 1, k + e, seed), w.x);
        sum[e] = ty_lerp(low, high, w.y);
    }
    return ty_lerp(sum[0], sum[1], w.z);
}
