// SPDX-License-Identifier: Apache-2.0
// A solid turned from a profile of points: corners, round corners, and curves through points.
#include "shape_build.h"

enum
{
    MOST_POINTS = 256
};

typedef struct turned
{
    const ty_shape_point* points;
    int count;
    bool reversed; // the solid lies to the right of the profile as given
} turned;

static const ty_shape_point* point_at(const turned* t, int i)
{
    return &t->points[t->reversed ? t->count - 1 - i : i];
}

static double r_at(const turned* t, int i)
{
    return (double)point_at(t, i)->at[0];
}

static double y_at(const turned* t, int i)
{
    return (double)point_at(t, i)->at[1];
}

// Profiles from axis to axis, or back to where they began, enclose the solid; which side that is shows the sign of the
// area. Open ones are taken as given.
static turned turned_make(const ty_shape_def* def)
{
    turned t = {def->profile.items, def->profile.count, false};
    double area = 0.0;
    for (int i = 0; i < t.count; i++)
    {
        int k = (i + 1) % t.count;
        area += r_at(&t, i) * y_at(&t, k) - r_at(&t, k) * y_at(&t, i);
    }
    bool axis = r_at(&t, 0) == 0.0 && r_at(&t, t.count - 1) == 0.0;
    bool ring = r_at(&t, 0) == r_at(&t, t.count - 1) && y_at(&t, 0) == y_at(&t, t.count - 1);
    t.reversed = (axis || ring) && area < 0.0;
    return t;
}

// --- straight pieces with round corners ---

typedef struct corner
{
    double cut;           // length that the arc takes of both sides
    double turn;          // angle, positive to the left: convex
    double r0, y0;        // unit direction before
    double r1, y1;        // and after
    double before, after; // lengths of both sides
} corner;

static corner corner_at(const turned* t, int i)
{
    corner c = {.r0 = r_at(t, i) - r_at(t, i - 1),
                .y0 = y_at(t, i) - y_at(t, i - 1),
                .r1 = r_at(t, i + 1) - r_at(t, i),
                .y1 = y_at(t, i + 1) - y_at(t, i)};
    c.before = hypot(c.r0, c.y0);
    c.after = hypot(c.r1, c.y1);
    c.r0 /= c.before;
    c.y0 /= c.before;
    c.r1 /= c.after;
    c.y1 /= c.after;
    double cross = c.r0 * c.y1 - c.y0 * c.r1, dot = c.r0 * c.r1 + c.y0 * c.y1;
    c.turn = atan2(cross, dot);
    c.cut = (double)point_at(t, i)->rounding * fabs(cross) / fmax(1.0 + dot, 1e-9); // radius * tan(turn / 2)
    return c;
}

static bool is_rounded(const turned* t, int i)
{
    return i > 0 && i + 1 < t->count && point_at(t, i)->rounding > 0.0f;
}

static double cut_at(const turned* t, int i)
{
    return is_rounded(t, i) ? corner_at(t, i).cut : 0.0;
}

static void add_arc(ty_profile* profile, const turned* t, int i)
{
    corner c = corner_at(t, i);
    int side = c.turn > 0.0 ? 1 : -1;
    double radius = (double)point_at(t, i)->rounding;
    double r = r_at(t, i) - c.cut * c.r0 - side * radius * c.y0, y = y_at(t, i) - c.cut * c.y0 + side * radius * c.r0;
    double from = atan2(-c.r0, c.y0);
    if (c.cut > 0.0)
        ty_profile_arc(profile, r, y, radius, from, from + c.turn, side);
}

// From the end of the arc at point i to the beginning of that at the next.
static void add_line(ty_profile* profile, const turned* t, int i)
{
    double r0 = r_at(t, i), y0 = y_at(t, i), r1 = r_at(t, i + 1), y1 = y_at(t, i + 1);
    double length = hypot(r1 - r0, y1 - y0), a = cut_at(t, i) / length, b = 1.0 - cut_at(t, i + 1) / length;
    ty_profile_line(profile, r0 + a * (r1 - r0), y0 + a * (y1 - y0), b == 1.0 ? r1 : r0 + b * (r1 - r0),
                    b == 1.0 ? y1 : y0 + b * (y1 - y0), true);
}

// --- curves ---

// Through points, with continuous curvature: reflections and `local` show where it jumps.
typedef struct spline
{
    int first, last;          // points; those between are smooth
    double knot[MOST_POINTS]; // parameter from each point to the next, the root of the distance (centripetal)
    double r[MOST_POINTS], y[MOST_POINTS];
    double slope_r[MOST_POINTS], slope_y[MOST_POINTS]; // by the parameter
} spline;

// Slopes with which the second derivatives of neighbouring cubics agree (de Boor 1978, chapter 4), by the tridiagonal
// system. At an end it is zero, or the slope where `level` says so.
static void solve_slopes(const spline* s, const double* p, const bool level[2], double* slope)
{
    int n = s->last - s->first;
    double upper[MOST_POINTS];
    for (int i = 0; i <= n; i++)
    {
        double before = i > 0 ? 1.0 / s->knot[i - 1] : 0.0, after = i < n ? 1.0 / s->knot[i] : 0.0;
        double right = i > 0 ? 3.0 * (p[i] - p[i - 1]) * before * before : 0.0;
        right += i < n ? 3.0 * (p[i + 1] - p[i]) * after * after : 0.0;
        double middle = 2.0 * (before + after);
        if ((i == 0 && level[0]) || (i == n && level[1]))
            before = after = right = 0.0, middle = 1.0;
        double pivot = middle - (i > 0 ? before * upper[i - 1] : 0.0);
        upper[i] = after / pivot;
        slope[i] = (right - (i > 0 ? before * slope[i - 1] : 0.0)) / pivot;
    }
    for (int i = n - 1; i >= 0; i--)
        slope[i] -= upper[i] * slope[i + 1];
}

// Where it meets the axis a curve is its own mirror image; at other ends it goes on straight.
static spline spline_make(const turned* t, int first, int last)
{
    spline s = {.first = first, .last = last};
    int n = last - first;
    for (int i = 0; i <= n; i++)
    {
        s.r[i] = r_at(t, first + i);
        s.y[i] = y_at(t, first + i);
        if (i > 0)
            s.knot[i - 1] = sqrt(hypot(s.r[i] - s.r[i - 1], s.y[i] - s.y[i - 1]));
    }
    solve_slopes(&s, s.r, (const bool[2]){false, false}, s.slope_r);
    solve_slopes(&s, s.y, (const bool[2]){s.r[0] == 0.0, s.r[n] == 0.0}, s.slope_y);
    return s;
}

// Hermite's cubic with value, first and second derivative at t.
static void cubic(double p, double q, double m, double n, double t, double out[3])
{
    double a = 2.0 * p - 2.0 * q + m + n, b = -3.0 * p + 3.0 * q - 2.0 * m - n;
    out[0] = ((a * t + b) * t + m) * t + p;
    out[1] = (3.0 * a * t + 2.0 * b) * t + m;
    out[2] = 6.0 * a * t + 2.0 * b;
}

static ty_profile_point spline_at(const void* context, double t)
{
    const spline* s = context;
    int i = (int)fmin(floor(t), s->last - 1.0) - s->first, k = i + 1;
    double h = s->knot[i], at = t - s->first - i, r[3], y[3];
    cubic(s->r[i], s->r[k], h * s->slope_r[i], h * s->slope_r[k], at, r);
    cubic(s->y[i], s->y[k], h * s->slope_y[i], h * s->slope_y[k], at, y);
    double speed = fmax(hypot(r[1], y[1]), 1e-300);
    return (ty_profile_point){.r = r[0],
                              .y = y[0],
                              .nr = y[1] / speed,
                              .ny = -r[1] / speed,
                              .curvature = (r[1] * y[2] - y[1] * r[2]) / (speed * speed * speed)};
}

// --- the whole ---

static ty_status check_point(const turned* t, int i, ty_error* error)
{
    const ty_shape_point* p = point_at(t, i);
    int number = (t->reversed ? t->count - 1 - i : i) + 1;
    if (!(p->at[0] >= 0.0f && p->at[0] <= 1e4f && fabsf(p->at[1]) <= 1e4f))
        return ty_error_set(error, TY_BAD_INPUT, "profile: point %d: its radius must be within 0 .. 10000 m", number);
    if (i > 0 && hypot(r_at(t, i) - r_at(t, i - 1), y_at(t, i) - y_at(t, i - 1)) < 1e-7)
        return ty_error_set(error, TY_BAD_INPUT, "profile: point %d coincides with the next or last one", number);
    if (i > 0 && i + 1 < t->count && p->at[0] == 0.0f)
        return ty_error_set(error, TY_BAD_INPUT, "profile: point %d: only the ends may lie on the axis", number);
    if (p->rounding > 0.0f &&
        (p->smooth || i == 0 || i + 1 == t->count || point_at(t, i - 1)->smooth || point_at(t, i + 1)->smooth))
        return ty_error_set(error, TY_BAD_INPUT, "profile: point %d: `rounding` is for corners between straight pieces",
                            number);
    if (p->smooth && (i == 0 || i + 1 == t->count))
        return ty_error_set(error, TY_BAD_INPUT, "profile: point %d: an end cannot be `smooth`", number);
    return TY_OK;
}

// Arcs must leave each other room, and a curve must stay on its side of the axis.
static ty_status check_piece(const turned* t, int i, ty_error* error)
{
    double length = hypot(r_at(t, i + 1) - r_at(t, i), y_at(t, i + 1) - y_at(t, i));
    if (cut_at(t, i) + cut_at(t, i + 1) > length * (1.0 + 1e-6))
        return ty_error_set(error, TY_BAD_INPUT, "profile: `rounding` about %g %g is too large for the piece of %g m",
                            (double)point_at(t, i + 1)->at[0], (double)point_at(t, i + 1)->at[1], length);
    return TY_OK;
}

static int run_end(const turned* t, int first)
{
    int last = first + 1;
    while (last + 1 < t->count && point_at(t, last)->smooth)
        last++;
    return last;
}

static ty_status check_curve(const turned* t, int first, int last, ty_error* error)
{
    const spline s = spline_make(t, first, last);
    for (int k = 0; k <= 64 * (last - first); k++)
    {
        double at = first + k / 64.0;
        if (spline_at(&s, at).r < (k == 0 || k == 64 * (last - first) ? 0.0 : -1e-9))
            return ty_error_set(error, TY_BAD_INPUT, "profile: the curve after point %d crosses the axis", first + 1);
    }
    return TY_OK;
}

ty_status ty_shape_check_lathe(const ty_shape_def* def, ty_error* error)
{
    if (def->profile.count < 2 || def->profile.count > MOST_POINTS)
        return ty_error_set(error, TY_BAD_INPUT, "profile: %d points: a lathe needs 2 .. %d", def->profile.count,
                            MOST_POINTS);
    turned t = turned_make(def);
    ty_status status = TY_OK;
    for (int i = 0; i < t.count && status == TY_OK; i++)
        status = check_point(&t, i, error);
    for (int i = 0; i + 1 < t.count && status == TY_OK; i++)
        status = check_piece(&t, i, error);
    for (int i = 0; i + 1 < t.count && status == TY_OK; i = run_end(&t, i))
        if (run_end(&t, i) > i + 1)
            status = check_curve(&t, i, run_end(&t, i), error);
    return status;
}

void ty_shape_build_lathe(ty_shape_build* build, const ty_shape_def* def)
{
    turned t = turned_make(def);
    double radius = 0.0;
    for (int i = 0; i < t.count; i++)
        radius = fmax(radius, r_at(&t, i));
    ty_profile profile = {.spacing = 2.0 * M_PI * radius / def->divisions, .limit = 4 * def->divisions};
    for (int i = 0; i + 1 < t.count;)
    {
        int last = run_end(&t, i);
        if (is_rounded(&t, i))
            add_arc(&profile, &t, i);
        if (last == i + 1)
            add_line(&profile, &t, i);
        else
        {
            spline s = spline_make(&t, i, last);
            ty_profile_curve(&profile, spline_at, &s, i, last);
        }
        i = last;
    }
    bool ring = r_at(&t, 0) == r_at(&t, t.count - 1) && y_at(&t, 0) == y_at(&t, t.count - 1);
    if (ring && r_at(&t, 0) > 0.0 && !profile.failed)
    {
        // The ends meet in the same bits, so that they weld.
        profile.points[profile.count - 1].r = profile.points[0].r;
        profile.points[profile.count - 1].y = profile.points[0].y;
    }
    ty_shape_turn(build, &profile, def->divisions, ring ? TY_TURNED_EVEN : TY_TURNED_PROPORTIONAL);
    ty_profile_term(&profile);
}
