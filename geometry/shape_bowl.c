// SPDX-License-Identifier: Apache-2.0
// The bowl: a turned vessel. A smooth curve runs through the middle of its wall from the axis to the centre of the lip;
// both surfaces are its offsets by half the thickness, joined by a half circle at the lip and to the foot by fillets.
#include "shape_build.h"
#include <string.h>

typedef struct fillet
{
    double t;    // where it touches the body: parameter of the wall's middle curve
    double r, y; // centre
    double radius;
} fillet;

typedef struct bowl
{
    double half;                // half the thickness
    double lip_r, lip_y;        // centre of the lip
    double bottom, rise, curve; // middle curve: bottom + rise * (v(r) / v(lip_r))^curve
    double flat, soft, v_lip;   // v(r) = sqrt((r - flat)^2 + soft^2) - soft beyond flat, 0 within
    double foot_r, foot_wall, foot_edge;
    fillet inner, outer; // under the bowl within the foot, and outside it
} bowl;

typedef struct middle
{
    double y, slope, bend; // and derivatives by r
} middle;

static double run_of(const bowl* b, double r)
{
    double x = r - b->flat;
    return x > 0.0 ? x * x / (sqrt(x * x + b->soft * b->soft) + b->soft) : 0.0;
}

static middle middle_at(const bowl* b, double r)
{
    double x = r - b->flat, v = run_of(b, r);
    if (!(v > 0.0))
        return (middle){b->bottom, 0.0, 0.0};
    double root = sqrt(x * x + b->soft * b->soft), v1 = x / root, v2 = b->soft * b->soft / (root * root * root);
    double q = b->rise * pow(v / b->v_lip, b->curve), by_v = b->curve * q / v;
    return (middle){b->bottom + q, by_v * v1, by_v * ((b->curve - 1.0) / v * v1 * v1 + v2)};
}

// The surface at the given distance outside (below) the middle curve; negative: inside, with the normal turned.
static ty_profile_point offset_at(const bowl* b, double t, double distance)
{
    middle m = middle_at(b, t);
    double s = sqrt(1.0 + m.slope * m.slope), nr = m.slope / s, ny = -1.0 / s, k = m.bend / (s * s * s);
    double side = distance < 0.0 ? -1.0 : 1.0;
    return (ty_profile_point){.r = t + distance * nr,
                              .y = m.y + distance * ny,
                              .nr = side * nr,
                              .ny = side * ny,
                              .curvature = side * k / (1.0 + distance * k)};
}

static ty_profile_point outside_at(const void* context, double t)
{
    const bowl* b = context;
    return offset_at(b, t, b->half);
}

static ty_profile_point inside_at(const void* context, double t)
{
    const bowl* b = context;
    return offset_at(b, t, -b->half);
}

// The circle of the given radius below the body whose centre stands at r: touches the body and a wall beside it.
static fillet fillet_at(const bowl* b, double r, double radius)
{
    double low = 0.0, high = b->lip_r;
    for (int i = 0; i < 60; i++)
    {
        double t = 0.5 * (low + high);
        *(offset_at(b, t, b->half + radius).r < r ? &low : &high) = t;
    }
    return (fillet){low, r, offset_at(b, low, b->half + radius).y, radius};
}

// Where the middle curve leaves the flat, such that it passes half a thickness above the foot's top at the foot's
// radius. A foot so narrow that even a curve from the axis lies lower there gets a higher bottom instead.
static void fit_bottom(bowl* b, double foot_height)
{
    b->bottom = b->half + 0.5 * foot_height;
    b->rise = b->lip_y - b->bottom;
    double wanted = 0.5 * foot_height / b->rise, low = 0.0, high = b->foot_r;
    b->flat = 0.0;
    double at_axis = pow(run_of(b, b->foot_r) / run_of(b, b->lip_r), b->curve);
    if (at_axis < wanted)
    {
        b->bottom = (foot_height + b->half - at_axis * b->lip_y) / (1.0 - at_axis);
        b->rise = b->lip_y - b->bottom;
    }
    for (int i = 0; i < 60 && at_axis >= wanted; i++)
    {
        b->flat = 0.5 * (low + high);
        bool high_there = pow(run_of(b, b->foot_r) / run_of(b, b->lip_r), b->curve) > wanted;
        *(high_there ? &low : &high) = b->flat;
    }
    b->v_lip = run_of(b, b->lip_r);
}

static bowl bowl_make(const ty_shape_def* def)
{
    double foot_height = (double)def->foot_height;
    bowl b = {.half = 0.5 * (double)def->thickness, .curve = (double)def->curve, .foot_r = (double)def->foot_radius};
    b.lip_r = (double)def->radius - b.half;
    b.lip_y = (double)def->height - b.half;
    b.soft = 0.35 * b.foot_r;
    fit_bottom(&b, foot_height);
    b.foot_wall = fmin(2.6 * b.half, 0.35 * b.foot_r);
    b.foot_edge = fmin(0.3 * b.foot_wall, 0.1 * foot_height);
    double within = b.foot_r - b.foot_wall, inner = fmin(0.3 * foot_height, 0.4 * within), outer = 0.35 * foot_height;
    b.inner = fillet_at(&b, within - inner, inner);
    b.outer = fillet_at(&b, b.foot_r + outer, outer);
    return b;
}

// The largest curvature of the middle curve, 1/m.
static double sharpest_bend(const bowl* b)
{
    double sharpest = 0.0;
    for (int i = 0; i <= 1024; i++)
    {
        middle m = middle_at(b, b->lip_r * i / 1024.0);
        double s = sqrt(1.0 + m.slope * m.slope);
        sharpest = fmax(sharpest, m.bend / (s * s * s));
    }
    return sharpest;
}

ty_status ty_shape_check_bowl(const ty_shape_def* def, ty_error* error)
{
    if (def->thickness > 0.25f * def->radius)
        return ty_error_set(error, TY_BAD_INPUT, "thickness: %g m: must be at most a quarter of the radius, %g m",
                            (double)def->thickness, (double)(0.25f * def->radius));
    if (def->foot_radius > 0.9f * def->radius)
        return ty_error_set(error, TY_BAD_INPUT, "foot_radius: %g m: must be at most 0.9 of the radius, %g m",
                            (double)def->foot_radius, (double)(0.9f * def->radius));
    if (def->height < 2.0f * def->foot_height + 4.0f * def->thickness)
        return ty_error_set(error, TY_BAD_INPUT, "height: %g m: must be at least 2 foot_height + 4 thickness, %g m",
                            (double)def->height, (double)(2.0f * def->foot_height + 4.0f * def->thickness));
    bowl b = bowl_make(def);
    if (b.outer.t > 0.97 * b.lip_r)
        return ty_error_set(error, TY_BAD_INPUT, "foot_radius: %g m: leaves no room for the wall of radius %g m",
                            (double)def->foot_radius, (double)def->radius);
    double sharpest = sharpest_bend(&b);
    if (sharpest * b.half > 0.8)
        return ty_error_set(error, TY_BAD_INPUT,
                            "thickness: %g m: the wall bends too sharply for it (to %g m): smaller thickness or curve",
                            (double)def->thickness, 1.0 / sharpest);
    return TY_OK;
}

static void add_foot(ty_profile* profile, const bowl* b)
{
    double within = b->foot_r - b->foot_wall, e = b->foot_edge;
    ty_profile_point touch = outside_at(b, b->inner.t);
    double down = atan2(touch.ny, touch.nr);
    ty_profile_arc(profile, b->inner.r, b->inner.y, b->inner.radius, down, -M_PI, -1);
    ty_profile_line(profile, within, b->inner.y, within, e, false);
    ty_profile_arc(profile, within + e, e, e, -M_PI, -0.5 * M_PI, 1);
    ty_profile_line(profile, within + e, 0.0, b->foot_r - e, 0.0, false);
    ty_profile_arc(profile, b->foot_r - e, e, e, -0.5 * M_PI, 0.0, 1);
    ty_profile_line(profile, b->foot_r, e, b->foot_r, b->outer.y, false);
    touch = outside_at(b, b->outer.t);
    ty_profile_arc(profile, b->outer.r, b->outer.y, b->outer.radius, 0.0, atan2(touch.ny, touch.nr), -1);
}

void ty_shape_build_bowl(ty_shape_build* build, const ty_shape_def* def)
{
    bowl b = bowl_make(def);
    double spacing = 2.0 * M_PI * (double)def->radius / def->divisions;
    ty_profile profile = {.spacing = spacing, .limit = 2 * def->divisions};
    ty_profile_curve(&profile, outside_at, &b, 0.0, b.inner.t);
    add_foot(&profile, &b);
    ty_profile_curve(&profile, outside_at, &b, b.outer.t, b.lip_r);
    ty_profile_point edge = outside_at(&b, b.lip_r);
    double a = atan2(edge.ny, edge.nr);
    ty_profile_arc(&profile, b.lip_r, b.lip_y, b.half, a, a + M_PI, 1);
    ty_profile_curve(&profile, inside_at, &b, b.lip_r, 0.0);
    ty_shape_turn(build, &profile, def->divisions, TY_TURNED_PROPORTIONAL);
    ty_profile_term(&profile);
}

// --- distance to the hollow ---

enum
{
    body_nodes = 56,
    lip_nodes = 8,
    outline_nodes = body_nodes + lip_nodes + 1
};

// The inner profile from the axis up to the top of the lip, as a polyline with rising r.
typedef struct outline
{
    float r[outline_nodes], y[outline_nodes];
} outline;

// Nodes closer where the curve bends, and moved outward by half of what the chords cut off.
static void trace_body(const bowl* b, outline* out)
{
    enum
    {
        samples = 1024
    };
    double weights[samples + 1] = {0.0};
    double base = 0.5 / sqrt(b->lip_r);
    ty_profile_point before = inside_at(b, 0.0);
    for (int i = 1; i <= samples; i++)
    {
        ty_profile_point now = inside_at(b, b->lip_r * i / samples);
        double step = hypot(now.r - before.r, now.y - before.y);
        weights[i] = weights[i - 1] + step * (sqrt(fabs(now.curvature)) + base);
        before = now;
    }
    for (int i = 0, k = 0; i <= body_nodes; i++)
    {
        double wanted = weights[samples] * i / body_nodes;
        while (k + 1 < samples && weights[k + 1] < wanted)
            k++;
        double part = (wanted - weights[k]) / (weights[k + 1] - weights[k]);
        ty_profile_point p = inside_at(b, b->lip_r * (k + fmin(part, 1.0)) / samples);
        double density = sqrt(fabs(p.curvature)) + base, chord = weights[samples] / body_nodes / density;
        double shift = i == 0 ? 0.0 : chord * chord * p.curvature / 16.0; // curvature is negative: along -n
        out->r[i] = (float)(p.r + shift * p.nr);
        out->y[i] = (float)(p.y + shift * p.ny);
    }
}

static void trace_outline(const ty_shape_def* def, outline* out)
{
    bowl b = bowl_make(def);
    trace_body(&b, out);
    ty_profile_point edge = inside_at(&b, b.lip_r);
    double a0 = atan2(edge.ny, edge.nr);
    for (int i = 1; i <= lip_nodes; i++)
    {
        double a = a0 + (0.5 * M_PI - a0) * i / lip_nodes;
        out->r[body_nodes + i] = (float)(b.lip_r + b.half * cos(a));
        out->y[body_nodes + i] = (float)(b.lip_y + b.half * sin(a));
    }
}

// The outline of the def last asked for, so that a solver's many calls make it once. Each thread has its own, and what
// it holds is a function of def alone.
static const outline* cached_outline(const ty_shape_def* def)
{
    static _Thread_local outline cache;
    static _Thread_local float cached[6];
    float key[6] = {def->radius, def->height, def->thickness, def->foot_radius, def->foot_height, def->curve};
    if (memcmp(key, cached, sizeof(key)) != 0)
    {
        trace_outline(def, &cache);
        memcpy(cached, key, sizeof(key));
    }
    return &cache;
}

float ty_shape_bowl_distance(const ty_shape_def* def, ty_vec3 p)
{
    const outline* line = cached_outline(def);
    float r = sqrtf(p.x * p.x + p.z * p.z), nearest = TY_FLOAT_MAX, height = TY_FLOAT_MAX;
    for (int i = 0; i + 1 < outline_nodes; i++)
    {
        float ar = line->r[i], ay = line->y[i], dr = line->r[i + 1] - ar, dy = line->y[i + 1] - ay;
        float s = ty_clamp(((r - ar) * dr + (p.y - ay) * dy) / (dr * dr + dy * dy), 0.0f, 1.0f);
        nearest = ty_min(nearest, ty_sqr(r - ar - s * dr) + ty_sqr(p.y - ay - s * dy));
        if (r >= ar && r < line->r[i + 1])
            height = ay + dy * ((r - ar) / dr);
    }
    float distance = sqrtf(nearest);
    return p.y > height ? -distance : distance;
}
