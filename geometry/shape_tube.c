// SPDX-License-Identifier: Apache-2.0
// A round tube swept along a smooth curve through points, with round ends: wires, stems, cords.
#include "shape_build.h"

enum
{
    MOST_POINTS = 4096,
    SAMPLES = 64, // a piece of the curve, between two points
    LEAST_STEPS = 4
};
#define MOST_VERTICES 16e6
#define TIGHTEST 0.98 // radius of the tube against that of its tightest bend

typedef struct dvec
{
    double x, y, z;
} dvec;

static dvec add(dvec a, double s, dvec b)
{
    return (dvec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static dvec scale(double s, dvec a)
{
    return (dvec){s * a.x, s * a.y, s * a.z};
}

static double dot(dvec a, dvec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static dvec cross(dvec a, dvec b)
{
    return (dvec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static dvec unit(dvec a)
{
    return scale(1.0 / sqrt(dot(a, a)), a);
}

static double distance(dvec a, dvec b)
{
    dvec d = add(a, -1.0, b);
    return sqrt(dot(d, d));
}

static ty_vec3 narrow(dvec a)
{
    return (ty_vec3){(float)a.x, (float)a.y, (float)a.z};
}

// --- the curve: centripetal Catmull-Rom (Yuksel et al. 2011), straight on beyond its ends ---

// From one point to the next in Hermite's form.
typedef struct piece
{
    dvec from, to, leave, arrive;
} piece;

typedef struct place
{
    dvec at, tangent; // unit
    dvec bend;        // towards the centre of curvature, as long as the curvature, 1/m
    double speed;     // m a piece
} place;

static dvec point(const ty_shape_def* def, int i)
{
    const ty_vec3* p = def->points.items;
    int last = def->points.count - 1;
    if (i < 0 || i > last)
    {
        int end = i < 0 ? 0 : last;
        return add(scale(2.0, point(def, end)), -1.0, point(def, 2 * end - i));
    }
    return (dvec){(double)p[i].x, (double)p[i].y, (double)p[i].z};
}

// At b, between a and c, for a parameter that runs over d.
static dvec tangent(dvec a, dvec b, dvec c, double d)
{
    double ab = sqrt(distance(a, b)), bc = sqrt(distance(b, c));
    dvec sum = add(scale(1.0 / ab, add(b, -1.0, a)), -1.0 / (ab + bc), add(c, -1.0, a));
    return scale(d, add(sum, 1.0 / bc, add(c, -1.0, b)));
}

static piece piece_at(const ty_shape_def* def, int i)
{
    dvec p = point(def, i), q = point(def, i + 1);
    double d = sqrt(distance(p, q));
    return (piece){p, q, tangent(point(def, i - 1), p, q, d), tangent(p, q, point(def, i + 2), d)};
}

static place place_on(const piece* s, double t)
{
    dvec a = add(add(scale(2.0, add(s->from, -1.0, s->to)), 1.0, s->leave), 1.0, s->arrive);
    dvec b = add(add(scale(3.0, add(s->to, -1.0, s->from)), -2.0, s->leave), -1.0, s->arrive);
    dvec first = add(add(s->leave, 2.0 * t, b), 3.0 * t * t, a), second = add(scale(2.0, b), 6.0 * t, a);
    double speed = sqrt(dot(first, first)), safe = fmax(speed, 1e-300);
    dvec along = scale(1.0 / safe, first);
    return (place){.at = add(add(add(s->from, t, s->leave), t * t, b), t * t * t, a),
                   .tangent = along,
                   .bend = scale(1.0 / (safe * safe), add(second, -dot(second, along), along)),
                   .speed = speed};
}

// How far along a piece one is, in metres and in steps, at each sample.
typedef struct ruler
{
    double length[SAMPLES + 1], steps[SAMPLES + 1];
    int step_count;
    double tightest; // curvature, 1/m; infinite where the curve turns back
} ruler;

// Chords depart from the curve by no more than those around the tube do from their circle: a sagitta of step^2
// curvature / 8 against radius (pi / divisions)^2 / 2.
static void measure(const ty_shape_def* def, const piece* s, ruler* out)
{
    double chord = distance(s->from, s->to), spacing = 2.0 * M_PI * (double)def->radius / def->divisions;
    dvec before = s->from;
    *out = (ruler){0};
    for (int i = 0; i <= SAMPLES; i++)
    {
        place now = place_on(s, (double)i / SAMPLES);
        double curvature = now.speed > 1e-5 * chord ? sqrt(dot(now.bend, now.bend)) : (double)INFINITY;
        out->tightest = fmax(out->tightest, curvature);
        if (i > 0)
        {
            double ds = distance(now.at, before);
            double density = fmin(sqrt(curvature * (double)def->radius), 1.0) / spacing;
            out->length[i] = out->length[i - 1] + ds;
            out->steps[i] = out->steps[i - 1] + fmax(density, LEAST_STEPS / chord) * ds;
        }
        before = now.at;
    }
    out->step_count = (int)fmin(ceil(out->steps[SAMPLES] - 1e-6), 4.0 * def->divisions);
}

// The sample and the part of the way to the next where that many steps lie behind.
static double find_step(const ruler* r, int step, int* sample)
{
    double wanted = r->steps[SAMPLES] * step / r->step_count;
    while (*sample + 1 < SAMPLES && r->steps[*sample + 1] < wanted)
        ++*sample;
    double from = r->steps[*sample], to = r->steps[*sample + 1];
    return fmin(fmax((wanted - from) / fmax(to - from, 1e-300), 0.0), 1.0);
}

// --- what is possible ---

static ty_status check_points(const ty_shape_def* def, ty_error* error)
{
    double extent = 0.0;
    for (int i = 0; i < def->points.count; i++)
    {
        dvec p = point(def, i);
        double most = fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z)));
        if (!(most <= 1e4) || isnan(p.x) || isnan(p.y) || isnan(p.z))
            return ty_error_set(error, TY_BAD_INPUT, "points: point %d: must be within -10000 .. 10000 m", i + 1);
        extent = fmax(extent, most);
    }
    for (int i = 1; i < def->points.count; i++)
        if (distance(point(def, i - 1), point(def, i)) < fmax(1e-7, 4e-6 * extent))
            return ty_error_set(error, TY_BAD_INPUT, "points: point %d coincides with the one before", i + 1);
    // Single precision has to keep the vertices of a ring apart.
    if (2.0 * M_PI * (double)def->radius / def->divisions < 1e-6 * extent)
        return ty_error_set(error, TY_BAD_INPUT, "radius: %g m: too thin for %d divisions at coordinates up to %g m",
                            (double)def->radius, def->divisions, extent);
    return TY_OK;
}

ty_status ty_shape_check_tube(const ty_shape_def* def, ty_error* error)
{
    int count = def->points.count;
    if (count < 2 || count > MOST_POINTS)
        return ty_error_set(error, TY_BAD_INPUT, "points: %d points: a tube needs 2 .. %d", count, MOST_POINTS);
    ty_status status = check_points(def, error);
    double vertices = 0.0;
    for (int i = 0; i + 1 < count && status == TY_OK; i++)
    {
        piece s = piece_at(def, i);
        ruler r;
        measure(def, &s, &r);
        vertices += (double)r.step_count * (def->divisions + 1);
        if (r.tightest == (double)INFINITY)
            status = ty_error_set(error, TY_BAD_INPUT, "points: the curve turns back on itself at point %d", i + 2);
        else if (r.tightest * (double)def->radius > TIGHTEST)
            status = ty_error_set(error, TY_BAD_INPUT,
                                  "points: between points %d and %d the curve bends with a radius of %g m: too tight "
                                  "for a tube of radius %g m",
                                  i + 1, i + 2, 1.0 / r.tightest, (double)def->radius);
    }
    if (status == TY_OK && vertices > MOST_VERTICES)
        status = ty_error_set(error, TY_BAD_INPUT, "divisions: %d: would make %.0f million vertices, at most %.0f are",
                              def->divisions, vertices * 1e-6, MOST_VERTICES * 1e-6);
    return status;
}

// --- the mesh ---

typedef struct sweep
{
    ty_shape_build* build;
    int divisions;
    double radius, length; // m; length with both ends
    place now;
    dvec side;      // unit, across the curve: where u begins
    double along;   // m, from the tip
    uint32_t first; // vertex of the last ring
} sweep;

// The frame that turns least about the curve, from the place before (Wang, Juettler, Zheng and Liu 2008, "Computation
// of rotation minimizing frames").
static void move_to(sweep* s, place next)
{
    dvec step = add(next.at, -1.0, s->now.at);
    double c = dot(step, step);
    dvec side = add(s->side, -2.0 / c * dot(step, s->side), step);
    dvec mirrored = add(s->now.tangent, -2.0 / c * dot(step, s->now.tangent), step);
    dvec rest = add(next.tangent, -1.0, mirrored);
    side = add(side, -2.0 / dot(rest, rest) * dot(rest, side), rest);
    s->side = unit(add(side, -dot(side, next.tangent), next.tangent));
    s->along += sqrt(c);
    s->now = next;
}

static dvec out_at(const sweep* s, double turn)
{
    float sine, cosine;
    ty_sincos((float)(2.0 * M_PI * turn), &sine, &cosine);
    return unit(add(scale((double)cosine, s->side), (double)sine, cross(s->now.tangent, s->side)));
}

// On a round end, `rise` is the sine of the latitude, negative at the beginning; 0 is the body.
static void add_vertex(sweep* s, double turn, double u, double rise)
{
    dvec out = out_at(s, turn), normal = rise * rise == 1.0
                                             ? scale(rise, s->now.tangent)
                                             : add(scale(sqrt(1.0 - rise * rise), out), rise, s->now.tangent);
    double v = (s->along + s->radius * rise) / s->length, k = 1.0 / s->radius;
    double lean = fmin(s->radius * dot(s->now.bend, out), TIGHTEST); // the check looks at samples alone
    dvec round = cross(s->now.tangent, out);
    ty_shape_vertex vertex = {.position = narrow(add(s->now.at, s->radius, normal)),
                              .normal = narrow(normal),
                              .uv = {(float)u, (float)fmin(fmax(v, 0.0), 1.0)}};
    ty_shape_set_curvature(&vertex, k, rise == 0.0 ? -lean / (1.0 - lean) * k : k, narrow(round),
                           narrow(s->now.tangent));
    ty_shape_add_vertex(s->build, &vertex);
}

// The seam's two vertices have the same bits.
static void add_ring(sweep* s, double rise)
{
    uint32_t before = s->first;
    s->first = (uint32_t)s->build->vertex_count;
    for (int i = 0; i <= s->divisions; i++)
        add_vertex(s, (double)(i % s->divisions) / s->divisions, (double)i / s->divisions, rise);
    bool from_tip = s->first - before == (uint32_t)s->divisions;
    for (uint32_t i = 0; i < (uint32_t)s->divisions; i++)
    {
        uint32_t a = before + i, d = s->first + i;
        if (from_tip)
            ty_shape_add_triangle(s->build, a, d + 1, d);
        else
            ty_shape_add_quad(s->build, a, a + 1, d + 1, d);
    }
}

// A vertex for each segment, so that each has its u.
static void add_tip(sweep* s, double rise)
{
    uint32_t before = s->first;
    s->first = (uint32_t)s->build->vertex_count;
    for (int i = 0; i < s->divisions; i++)
        add_vertex(s, 0.0, (i + 0.5) / s->divisions, rise);
    for (uint32_t i = 0; i < (uint32_t)s->divisions && rise > 0.0; i++)
        ty_shape_add_triangle(s->build, before + i, before + i + 1, s->first + i);
}

// The rings of a round end between its tip and the body.
static void add_end(sweep* s, double side)
{
    int steps = (s->divisions + 3) / 4;
    if (side < 0.0)
        add_tip(s, side);
    for (int i = 1; i < steps; i++)
        add_ring(s, side * (double)ty_sin((float)(0.5 * M_PI * (side < 0.0 ? steps - i : i) / steps)));
    if (side > 0.0)
        add_tip(s, side);
}

static dvec any_side(dvec t)
{
    double x = fabs(t.x), y = fabs(t.y), z = fabs(t.z);
    dvec axis = {x <= y && x <= z, y < x && y <= z, z < x && z < y};
    return unit(cross(axis, t));
}

// Where two pieces meet, the curvature of the flatter one holds.
static void add_piece(sweep* s, const ty_shape_def* def, int i)
{
    piece now = piece_at(def, i);
    ruler r;
    measure(def, &now, &r);
    for (int step = 1, sample = 0; step <= r.step_count; step++)
    {
        double part = find_step(&r, step, &sample);
        place next = place_on(&now, step == r.step_count ? 1.0 : (sample + part) / SAMPLES);
        if (step == r.step_count && i + 2 < def->points.count)
        {
            piece after = piece_at(def, i + 1);
            place other = place_on(&after, 0.0);
            if (dot(other.bend, other.bend) < dot(next.bend, next.bend))
                next.bend = other.bend;
        }
        move_to(s, next);
        add_ring(s, 0.0);
    }
}

void ty_shape_build_tube(ty_shape_build* build, const ty_shape_def* def)
{
    sweep s = {.build = build, .divisions = def->divisions, .radius = (double)def->radius};
    s.length = 2.0 * s.radius;
    for (int i = 0; i + 1 < def->points.count; i++)
    {
        piece now = piece_at(def, i);
        ruler r;
        measure(def, &now, &r);
        s.length += r.length[SAMPLES];
    }
    piece begin = piece_at(def, 0);
    s.now = place_on(&begin, 0.0);
    s.side = any_side(s.now.tangent);
    s.along = s.radius;
    add_end(&s, -1.0);
    add_ring(&s, 0.0);
    for (int i = 0; i + 1 < def->points.count && !build->failed; i++)
        add_piece(&s, def, i);
    add_end(&s, 1.0);
}
