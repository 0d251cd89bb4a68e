// SPDX-License-Identifier: Apache-2.0
// The nine shapes, rays against them by sphere tracing, and walks inside.
#include "implicit.h"
#include <math.h>

#define PI 3.14159265358979323846
#define MAX_SCATTERINGS 1000000

const implicit_shape implicit_shapes[IMPLICIT_COUNT + IMPLICIT_HELD] = {
    {"sphere", IMPLICIT_ELLIPSOID, true, {1, 1, 1}, 1.01},
    {"prolate", IMPLICIT_ELLIPSOID, true, {2.5, 1, 1}, 2.51},
    {"oblate", IMPLICIT_ELLIPSOID, true, {1.5, 1.5, 0.6}, 1.51},
    {"triaxial", IMPLICIT_ELLIPSOID, true, {2.5, 1.4, 1}, 2.51},
    {"grain", IMPLICIT_SUPER, true, {2.6, 1.05, 0.9}, 2.9},
    {"cube", IMPLICIT_CUBE, true, {1, 0.25, 0}, 1.5},
    {"disc", IMPLICIT_DISC, true, {2, 0.25, 0.2}, 2.02},
    {"dumbbell", IMPLICIT_DUMBBELL, false, {1, 1, 0.5}, 2.01},
    {"torus", IMPLICIT_TORUS, false, {1.5, 0.6, 0}, 2.11},
    {"flat ellipsoid", IMPLICIT_ELLIPSOID, true, {3, 1.2, 0.6}, 3.01},
    {"flat grain", IMPLICIT_SUPER, true, {1.8, 1.3, 0.5}, 2.5},
    {"thin torus", IMPLICIT_TORUS, false, {1, 0.3, 0}, 1.31},
};

static vec scaled(vec a, double s)
{
    return (vec){a.x * s, a.y * s, a.z * s};
}

static vec cross(vec a, vec b)
{
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double length(vec a)
{
    return sqrt(vec_dot(a, a));
}

static vec unit(vec a)
{
    return scaled(a, 1.0 / length(a));
}

double random_double(ty_rng* rng)
{
    return ((double)(ty_rng_u64(rng) >> 11) + 0.5) * 0x1p-53;
}

vec random_direction(ty_rng* rng)
{
    double z = 2.0 * random_double(rng) - 1.0, turn = 2.0 * PI * random_double(rng), s = sqrt(1.0 - z * z);
    return (vec){s * cos(turn), s * sin(turn), z};
}

// The normal plus a point of the unit sphere is distributed by the cosine.
vec random_cosine(vec n, ty_rng* rng)
{
    for (;;)
    {
        vec d = vec_mad(random_direction(rng), n, 1.0);
        if (vec_dot(d, d) > 1e-16)
            return unit(d);
    }
}

// --- the shapes ---

static double rounded(double a, double b, double c, double rounding)
{
    double m = fmax(a, fmax(b, c)), x = fmax(a, 0), y = fmax(b, 0), z = fmax(c, 0);
    return fmin(m, 0) + sqrt(x * x + y * y + z * z) - rounding;
}

static double dumbbell(const double* size, vec p)
{
    double a = length((vec){p.x - size[1], p.y, p.z}) - size[0], b = length((vec){p.x + size[1], p.y, p.z}) - size[0];
    double h = fmax(1.0 - fabs(a - b) / size[2], 0);
    return fmin(a, b) - 0.25 * h * h * size[2];
}

// Sum of the 2.5th powers, without the root: enough for the sign.
static double super_sum(const double* size, vec p)
{
    double a = fabs(p.x) / size[0], b = fabs(p.y) / size[1], c = fabs(p.z) / size[2];
    return a * a * sqrt(a) + b * b * sqrt(b) + c * c * sqrt(c);
}

static vec over_axes(const implicit_shape* shape, vec p)
{
    return (vec){p.x / shape->size[0], p.y / shape->size[1], p.z / shape->size[2]};
}

double implicit_value(const implicit_shape* shape, vec p)
{
    const double* size = shape->size;
    switch (shape->kind)
    {
    case IMPLICIT_ELLIPSOID:
        return (length(over_axes(shape, p)) - 1.0) * size[2];
    case IMPLICIT_SUPER:
        return (pow(super_sum(size, p), 0.4) - 1.0) * size[2];
    case IMPLICIT_TORUS:
    {
        double q = sqrt(p.x * p.x + p.y * p.y) - size[0];
        return sqrt(q * q + p.z * p.z) - size[1];
    }
    case IMPLICIT_DISC:
        return rounded(sqrt(p.x * p.x + p.y * p.y) - (size[0] - size[2]), fabs(p.z) - (size[1] - size[2]), -1e9,
                       size[2]);
    case IMPLICIT_DUMBBELL:
        return dumbbell(size, p);
    case IMPLICIT_CUBE:
    {
        double h = size[0] - size[1];
        return rounded(fabs(p.x) - h, fabs(p.y) - h, fabs(p.z) - h, size[1]);
    }
    }
    return 0.0;
}

static bool is_inside(const implicit_shape* shape, vec p)
{
    vec q = over_axes(shape, p);
    if (shape->kind == IMPLICIT_ELLIPSOID)
        return vec_dot(q, q) < 1.0;
    return shape->kind == IMPLICIT_SUPER ? super_sum(shape->size, p) < 1.0 : implicit_value(shape, p) < 0.0;
}

static vec gradient(const implicit_shape* shape, vec p)
{
    const double h = 1e-5;
    vec e[3] = {{h, 0, 0}, {0, h, 0}, {0, 0, h}};
    double g[3];
    for (int i = 0; i < 3; i++)
        g[i] = (implicit_value(shape, vec_mad(p, e[i], 1)) - implicit_value(shape, vec_mad(p, e[i], -1))) / (2 * h);
    return (vec){g[0], g[1], g[2]};
}

vec implicit_normal(const implicit_shape* shape, vec p)
{
    const double* s = shape->size;
    if (shape->kind == IMPLICIT_ELLIPSOID)
        return unit((vec){p.x / (s[0] * s[0]), p.y / (s[1] * s[1]), p.z / (s[2] * s[2])});
    return unit(gradient(shape, p));
}

vec implicit_project(const implicit_shape* shape, vec p)
{
    for (int i = 0; i < 4; i++)
    {
        vec g = gradient(shape, p);
        p = vec_mad(p, g, -implicit_value(shape, p) / vec_dot(g, g));
    }
    return p;
}

// --- rays ---

// The crossing between a and b, where the signs differ: false position, halved when one end stays (Illinois).
static double root(const implicit_shape* shape, vec p, vec d, double a, double fa, double b, double fb)
{
    for (int i = 0; i < 60 && b - a > 1e-10; i++)
    {
        double t = i % 4 == 3 ? 0.5 * (a + b) : a - fa * (b - a) / (fb - fa),
               f = implicit_value(shape, vec_mad(p, d, t));
        if (fabs(f) < 1e-12)
            return t;
        if ((f < 0) == (fa < 0))
        {
            a = t;
            fa = f;
            fb *= 0.5;
        }
        else
        {
            b = t;
            fb = f;
            fa *= 0.5;
        }
    }
    return 0.5 * (a + b);
}

static double quadric_hit(const implicit_shape* shape, vec p, vec d, bool inside)
{
    vec q = over_axes(shape, p), w = over_axes(shape, d);
    double a = vec_dot(w, w), b = vec_dot(q, w), rest = b * b - a * (vec_dot(q, q) - 1.0);
    if (rest < 0.0)
        return inside ? 0.0 : -1.0;
    double t = (inside ? -b + sqrt(rest) : -b - sqrt(rest)) / a;
    return inside && t < 0.0 ? 0.0 : t;
}

double implicit_hit(const implicit_shape* shape, vec p, vec d, bool inside, double t_max)
{
    if (shape->kind == IMPLICIT_ELLIPSOID)
    {
        double t = quadric_hit(shape, p, d, inside);
        return t < t_max ? t : -1.0;
    }
    double sign = inside ? -1.0 : 1.0, limit = fmin(t_max, length(p) + 2.0 * shape->bound), t = 0.0, before = 0.0;
    double f = implicit_value(shape, p), f_before = f;
    while (t < limit)
    {
        before = t;
        f_before = f;
        t = fmin(t + fmax(f * sign, 1e-4), limit);
        f = implicit_value(shape, vec_mad(p, d, t));
        if (f * sign < 0.0)
            return root(shape, p, d, before, f_before, t, f);
    }
    return -1.0;
}

implicit_measure implicit_points(const implicit_shape* shape, uint64_t seed, int count, vec* points)
{
    ty_rng rng = ty_rng_make((ty_seed){seed}, 0, 0);
    double inside_length = 0.0;
    long lines = 0, crossings = 0;
    for (int found = 0; found < count || lines < 10000 + 100 * count; lines++)
    {
        vec d = random_direction(&rng), t = unit(cross(d, fabs(d.x) < 0.5 ? (vec){1, 0, 0} : (vec){0, 1, 0}));
        double r = shape->bound * sqrt(random_double(&rng)), turn = 2.0 * PI * random_double(&rng);
        vec o = vec_mad(vec_mad(scaled(t, r * cos(turn)), cross(d, t), r * sin(turn)), d, -1.5 * shape->bound);
        bool inside = false;
        for (int k = 0; k < 8; k++)
        {
            double s = implicit_hit(shape, o, d, inside, 1e9);
            if (s < 0.0)
                break;
            crossings++;
            inside_length += inside ? s : 0.0;
            vec x = vec_mad(o, d, s);
            // Not from every line: crossings of one line belong together.
            if (found < count && lines % 7 == 0)
                points[found++] = implicit_project(shape, x);
            inside = !inside;
            o = vec_mad(x, d, 1e-6);
            if (shape->convex && !inside)
                break;
        }
    }
    double disc = PI * shape->bound * shape->bound;
    return (implicit_measure){inside_length / (double)lines * disc, 2.0 * disc * (double)crossings / (double)lines};
}

// --- walks ---

static double crossing(const implicit_shape* shape, vec p, vec q, vec d, double step)
{
    if (!shape->convex || shape->kind == IMPLICIT_ELLIPSOID)
        return implicit_hit(shape, p, d, true, shape->convex ? 1e9 : step);
    double f = fmin(implicit_value(shape, p), -1e-12);
    return root(shape, p, d, 0.0, f, step, fmax(implicit_value(shape, q), 1e-12));
}

int implicit_walk(const implicit_shape* shape, vec x, vec n, double mean_free_path, ty_rng* rng, vec* exit)
{
    vec p = vec_mad(x, n, -1e-7), d = random_cosine(scaled(n, -1.0), rng);
    for (int count = 0; count < MAX_SCATTERINGS; count++)
    {
        double step = -log(random_double(rng)) * mean_free_path;
        vec q = vec_mad(p, d, step);
        // A segment between two points of a convex body stays in it.
        if (!shape->convex || !is_inside(shape, q))
        {
            double s = crossing(shape, p, q, d, step);
            if (s >= 0.0)
            {
                *exit = vec_mad(p, d, s);
                return count;
            }
        }
        p = q;
        d = random_direction(rng);
    }
    *exit = p;
    return MAX_SCATTERINGS;
}
