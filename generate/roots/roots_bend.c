// SPDX-License-Identifier: Apache-2.0
// Curves that resist bending: splines in tension (Schweikert 1966) by relaxation.
#include "roots_growth.h"

// The place of the middle one of five neighbours at which the squares of first differences and, `stiff`^2 as much, of
// second ones have their least sum.
static ty_vec3 rest(const ty_vec3* p, float stiff)
{
    float b = stiff * stiff, own = 1.0f / (2.0f + 6.0f * b);
    ty_vec3 near = ty_add(p[-1], p[1]), far = ty_add(p[-2], p[2]);
    return ty_mad(ty_mul(near, (1.0f + 4.0f * b) * own), far, -b * own);
}

void roots_bend(ty_vec3* p, int count, float stiff)
{
    for (int i = 2; i < count - 2; i++)
        p[i] = rest(p + i, stiff);
    for (int i = count - 3; i >= 2; i--)
        p[i] = rest(p + i, stiff);
}
