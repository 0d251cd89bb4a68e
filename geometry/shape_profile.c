// SPDX-License-Identifier: Apache-2.0
// Profiles made of lines and arcs.
#include "shape_build.h"

void ty_profile_term(ty_profile* profile)
{
    ty_free(profile->points);
    *profile = (ty_profile){0};
}

static bool profile_reserve(ty_profile* profile)
{
    if (profile->count < profile->capacity)
        return true;
    size_t wanted = profile->capacity ? 2 * profile->capacity : 256;
    ty_profile_point* grown = ty_try_grow(profile->points, profile->capacity, wanted, sizeof(*grown));
    if (!grown)
        return false;
    profile->points = grown;
    profile->capacity = wanted;
    return true;
}

void ty_profile_add(ty_profile* profile, ty_profile_point point)
{
    if (fabs(point.r) < 1e-9 * profile->spacing)
        point.r = 0.0;
    if (profile->count > 0)
    {
        ty_profile_point* last = &profile->points[profile->count - 1];
        double near = 1e-6 * profile->spacing;
        if (fabs(point.r - last->r) < near && fabs(point.y - last->y) < near)
        {
            point.r = last->r;
            point.y = last->y;
            point.crease = point.nr * last->nr + point.ny * last->ny < 0.9998; // about a degree
            if (!point.crease)
            {
                if (fabs(point.curvature) < fabs(last->curvature))
                    last->curvature = point.curvature;
                return;
            }
        }
    }
    profile->failed = profile->failed || !profile_reserve(profile);
    if (!profile->failed)
        profile->points[profile->count++] = point;
}

// Steps for a piece: at least least, at most the limit.
static int piece_steps(const ty_profile* profile, double length, double spacing, int least)
{
    double steps = ceil(length / spacing - 1e-6);
    return (int)fmin(fmax(steps, least), profile->limit);
}

void ty_profile_line(ty_profile* profile, double r0, double y0, double r1, double y1, bool fine)
{
    double dr = r1 - r0, dy = y1 - y0, length = hypot(dr, dy);
    if (length <= 1e-6 * profile->spacing)
        return;
    int steps = piece_steps(profile, length, (fine ? 1.0 : 4.0) * profile->spacing, 1);
    for (int i = 0; i <= steps; i++)
    {
        double s = (double)i / steps;
        ty_profile_add(profile, (ty_profile_point){.r = i == steps ? r1 : r0 + s * dr,
                                                   .y = i == steps ? y1 : y0 + s * dy,
                                                   .nr = dy / length,
                                                   .ny = -dr / length});
    }
}

void ty_profile_arc(ty_profile* profile, double r, double y, double radius, double a0, double a1, int side)
{
    double turn = fabs(a1 - a0);
    // At least six steps a quarter turn, whatever the spacing.
    int steps = piece_steps(profile, turn * radius, profile->spacing, (int)ceil(6.0 * turn / (0.5 * M_PI) - 1e-6));
    for (int i = 0; i <= steps; i++)
    {
        double a = a0 + (a1 - a0) * i / steps, nr = cos(a), ny = sin(a);
        ty_profile_add(profile, (ty_profile_point){.r = r + side * radius * nr,
                                                   .y = y + side * radius * ny,
                                                   .nr = nr,
                                                   .ny = ny,
                                                   .curvature = side / radius});
    }
}

void ty_profile_curve(ty_profile* profile, ty_profile_curve_fn* at, const void* context, double t0, double t1)
{
    enum
    {
        samples = 2048
    };
    const double turn = 0.2; // radians a step
    double steps_to[samples + 1] = {0.0};
    ty_profile_point before = at(context, t0);
    for (int i = 1; i <= samples; i++)
    {
        ty_profile_point now = at(context, t0 + (t1 - t0) * i / samples);
        double density = fmax(1.0 / profile->spacing, fabs(now.curvature) / turn);
        steps_to[i] = steps_to[i - 1] + density * hypot(now.r - before.r, now.y - before.y);
        before = now;
    }
    int steps = piece_steps(profile, steps_to[samples], 1.0, 6);
    for (int i = 0, k = 0; i <= steps; i++)
    {
        double wanted = steps_to[samples] * i / steps;
        while (k + 1 < samples && steps_to[k + 1] < wanted)
            k++;
        double part = (wanted - steps_to[k]) / fmax(steps_to[k + 1] - steps_to[k], 1e-300);
        double t = i == steps ? t1 : t0 + (t1 - t0) * (k + fmin(part, 1.0)) / samples;
        ty_profile_add(profile, at(context, t));
    }
}
