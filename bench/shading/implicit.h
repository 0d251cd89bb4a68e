// SPDX-License-Identifier: Apache-2.0
// Closed shapes as functions that are negative inside, and brute-force random walks in them, in double precision: the
// truth that models are measured against. It shares nothing with the renderer but random numbers.
#pragma once
#include <stdbool.h>
#include <tsuya/base/rng.h>

typedef struct vec
{
    double x, y, z;
} vec;

typedef enum implicit_kind
{
    IMPLICIT_ELLIPSOID, // size: semi-axes
    IMPLICIT_SUPER,     // (|x|/a)^2.5 + (|y|/b)^2.5 + (|z|/c)^2.5 = 1
    IMPLICIT_TORUS,     // size: radius, tube; about z
    IMPLICIT_DISC,      // size: radius, half height, rounding; about z
    IMPLICIT_DUMBBELL,  // size: radius of two balls, their distance from the centre, width of the blend
    IMPLICIT_CUBE,      // size: half extent, rounding
} implicit_kind;

typedef struct implicit_shape
{
    const char* name;
    implicit_kind kind;
    bool convex;
    double size[3];
    double bound; // radius of a ball that holds it
} implicit_shape;

#define IMPLICIT_COUNT 9
#define IMPLICIT_HELD 3 // after them: shapes that no choice of the model was made by
extern const implicit_shape implicit_shapes[IMPLICIT_COUNT + IMPLICIT_HELD];

static inline double vec_dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vec vec_mad(vec p, vec d, double t)
{
    return (vec){p.x + d.x * t, p.y + d.y * t, p.z + d.z * t};
}

double random_double(ty_rng* rng); // (0, 1)
vec random_direction(ty_rng* rng);
vec random_cosine(vec n, ty_rng* rng);

double implicit_value(const implicit_shape* shape, vec p); // changes by no more than the distance
vec implicit_normal(const implicit_shape* shape, vec p);   // unit, outward
vec implicit_project(const implicit_shape* shape, vec p);  // onto the surface, from near it
// First crossing of the surface along the unit d within t_max, from inside or outside; negative = none.
double implicit_hit(const implicit_shape* shape, vec p, vec d, bool inside, double t_max);

// Points uniform over the surface, as crossings of uniform random lines (Crofton); volume and area come out as well.
typedef struct implicit_measure
{
    double volume, area;
} implicit_measure;
implicit_measure implicit_points(const implicit_shape* shape, uint64_t seed, int count, vec* points);

// A walk that enters at x diffusely, scatters isotropically with the given mean free path, and leaves index-matched.
// Returns the number of scatterings.
int implicit_walk(const implicit_shape* shape, vec x, vec n, double mean_free_path, ty_rng* rng, vec* exit);
