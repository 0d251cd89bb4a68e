// SPDX-License-Identifier: Apache-2.0
// Where a uniform line through a point on the axis of a spheroid leaves it, when gambler's ruin chooses the end.
// Lengths in semi-axes: the point at height m above the centre, 1 being the pole, where the curvature is h.
#pragma once
#include <tsuya/base/math.h>

typedef struct ty_spheroid_exit
{
    float m;
    float e; // (1 - m^2) h, at least 0
} ty_spheroid_exit;

// depth: of the point beneath the pole, 0 .. thickness; thickness = both semi-axes.
static inline ty_spheroid_exit ty_spheroid_exit_make(float depth, float thickness, float curvature)
{
    float q = 2.0f * depth / thickness;
    return (ty_spheroid_exit){1.0f - q, q * (2.0f - q) * 0.5f * curvature * thickness};
}

// Root of the discriminant of the crossings along a unit direction of height z.
static inline float ty_spheroid_exit_root(ty_spheroid_exit s, float z)
{
    return ty_safe_sqrt(s.e + (1.0f - s.e) * z * z);
}

// Density of the end's direction over that of a uniform one: it does not depend on the azimuth.
static inline float ty_spheroid_exit_density(ty_spheroid_exit s, float z)
{
    float root = ty_spheroid_exit_root(s, z);
    return root < 1e-12f ? 1.0f : 1.0f + s.m * z / root;
}

// Height of the direction below which a share u of the ends lies: the density integrates to
// u = (1 + z) / 2 - m (1 - z^2) / (2 + 2 root(z)), a quadratic in z.
static inline float ty_spheroid_exit_height(ty_spheroid_exit s, float u)
{
    float m = s.m, c = 1.0f - s.e, v = 2.0f * u - 1.0f, b = c * v + m, last = c * v * v + m * (2.0f * v + m);
    float root = m * ty_safe_sqrt(s.e + last);
    // Of the two forms of the root the one that nothing cancels in.
    bool same = b * m >= 0.0f;
    float over = same ? last : b - root, under = same ? b + root : c - m * m;
    return fabsf(under) > 1e-6f ? ty_clamp(over / under, -1.0f, 1.0f) : v;
}
