// SPDX-License-Identifier: Apache-2.0
// Surfaces of revolution from a profile: rings of vertices, each with its own number of segments, sewn together.
#include "shape_build.h"

typedef struct ring
{
    uint32_t first; // segments + 1 vertices (the last closes the uv seam); on the axis one vertex a segment
    int segments;
    bool axis;
} ring;

static double largest_radius(const ty_profile* profile)
{
    double radius = 0.0;
    for (size_t i = 0; i < profile->count; i++)
        radius = fmax(radius, profile->points[i].r);
    return radius;
}

static double profile_length(const ty_profile* profile)
{
    double length = 0.0;
    for (size_t i = 1; i < profile->count; i++)
        length +=
            hypot(profile->points[i].r - profile->points[i - 1].r, profile->points[i].y - profile->points[i - 1].y);
    return length;
}

// In proportion to the radius and at least 24 a few rings from the axis, but unchanged while that is within 8 %, so
// that most rings match, and where rings lie so close that the circles' sagittas would show between different numbers.
// Ends and creases do not look back: both sides of a crease must agree.
static int ring_segments(const ty_profile* profile, size_t i, int previous, double largest, int divisions)
{
    const ty_profile_point* p = &profile->points[i];
    double wanted = floor(divisions * p->r / largest + 0.5);
    if (p->crease || i == 0 || i + 1 == profile->count || profile->points[i + 1].crease)
        return (int)fmax(wanted, 6.0);
    size_t from_end = i < profile->count - 1 - i ? i : profile->count - 1 - i;
    double least = fmin(6.0 * (double)from_end, 24.0);
    wanted = fmax(wanted, least);
    bool close = hypot(p->r - p[-1].r, p->y - p[-1].y) < 0.4 * profile->spacing && previous >= least;
    bool keep = p[-1].r > 0.0 && (close || (previous > 12 && fabs(wanted - previous) < 0.08 * previous));
    return keep ? previous : (int)wanted;
}

static void add_ring_vertex(ty_shape_build* build, const ty_profile_point* p, double turn, double u, double v)
{
    double s = -sin(2.0 * M_PI * turn), c = -cos(2.0 * M_PI * turn);
    ty_shape_vertex vertex = {
        .position = {(float)(p->r * s), (float)p->y, (float)(p->r * c)},
        .normal = {(float)(p->nr * s), (float)p->ny, (float)(p->nr * c)},
        .uv = {(float)u, (float)v},
    };
    ty_vec3 along = {(float)(-p->ny * s), (float)p->nr, (float)(-p->ny * c)}, round = {(float)c, 0.0f, (float)-s};
    double k_round = p->r > 0.0 ? p->nr / p->r : p->curvature;
    ty_shape_set_curvature(&vertex, p->curvature, k_round, along, round);
    ty_shape_add_vertex(build, &vertex);
}

static ring add_ring(ty_shape_build* build, const ty_profile_point* p, int segments, double v)
{
    ring out = {(uint32_t)build->vertex_count, segments, p->r == 0.0};
    for (int i = 0; i < segments + !out.axis; i++)
    {
        double u = out.axis ? (i + 0.5) / segments : (double)i / segments;
        // The seam's two vertices have the same bits; so has the axis all round.
        add_ring_vertex(build, p, out.axis ? 0.0 : (double)(i % segments) / segments, u, v);
    }
    return out;
}

// Sews two rings: edges of both are taken in the order of their middles, which gives the convex hull of the two
// circles.
static void sew(ty_shape_build* build, ring a, ring b)
{
    TY_ASSERT(a.segments > 0 && b.segments > 0);
    int i = 0, j = 0;
    while (i < a.segments || j < b.segments)
    {
        int64_t middle_a = (int64_t)(2 * i + 1) * b.segments, middle_b = (int64_t)(2 * j + 1) * a.segments;
        bool take_a = j == b.segments || (i < a.segments && middle_a <= middle_b);
        uint32_t va = a.first + (uint32_t)i, vb = b.first + (uint32_t)j;
        if (a.axis)
            va = a.first + (uint32_t)((int64_t)j * a.segments / b.segments);
        if (b.axis)
            vb = b.first + (uint32_t)((int64_t)i * b.segments / a.segments);
        if (take_a && !a.axis)
            ty_shape_add_triangle(build, va, va + 1, vb);
        else if (!take_a && !b.axis)
            ty_shape_add_triangle(build, va, vb + 1, vb);
        i += take_a;
        j += !take_a;
    }
}

void ty_shape_turn(ty_shape_build* build, const ty_profile* profile, int divisions, ty_turned_rule rule)
{
    double largest = largest_radius(profile), length = profile_length(profile), along = 0.0;
    ring previous = {0};
    build->failed = build->failed || profile->failed;
    for (size_t i = 0; i < profile->count && !build->failed; i++)
    {
        const ty_profile_point* p = &profile->points[i];
        if (i > 0)
            along += hypot(p->r - p[-1].r, p->y - p[-1].y);
        int segments = divisions;
        if (rule == TY_TURNED_PROPORTIONAL)
            segments = ring_segments(profile, i, previous.segments, largest, divisions);
        ring now = add_ring(build, p, segments, fmin(along / length, 1.0));
        if (i > 0 && !p->crease)
            sew(build, previous, now);
        previous = now;
    }
}
