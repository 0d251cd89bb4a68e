// SPDX-License-Identifier: Apache-2.0
// Rings along a line: where they stand, how they are turned, how they spread where a branch meets another root, and
// round ends.
#include "roots_tubes.h"

typedef struct chosen
{
    const tubes_def* def;
    const roots_line* line;
    const roots_point* points; // of the line
    bool* keep;
    float zone[2];    // m, over which the spread at either end fades; 0 = none
    float begin, end; // s of its ends
} chosen;

// --- spread ---

// Where the halves of the last ring go (3.16 of the thesis): along the root that is met, three growth points towards
// the trunk and two away from it where a branch begins, two either way where it ends. Of ours a radius stands for a
// growth point, and the share that the branch does not run along the other in its place.
static bool spread_at(const tubes_def* def, const roots_line* line, int end, ty_vec3 way, ty_vec3 off[2])
{
    const roots_network* net = def->network;
    int other = end ? line->end : line->parent, point = end ? line->end_point : line->parent_point;
    bool branch = line->kind == ROOTS_FIRST || (line->kind == ROOTS_SECOND && !def->thesis);
    float most = def->recipe->tubes.junction;
    if (!branch || other < 0 || point < 0 || net->lines[other].kind == ROOTS_TRUNK || most == 0.0f)
        return false;
    const roots_line* met = &net->lines[other];
    int last = met->first + met->count - 1;
    const int steps[2] = {end ? 2 : 3, 2};
    float r = net->points[end ? line->first + line->count - 1 : line->first].r;
    for (int half = 0; half < 2; half++)
    {
        int i = point, on = half ? 1 : -1, left = steps[half];
        while (i + on >= met->first && i + on <= last &&
               (def->thesis ? left-- > 0
                            : fabsf(net->points[i + on].s - net->points[point].s) <= most * (float)steps[half] * r))
            i += on;
        off[half] = ty_mul(ty_sub(net->points[i].p, net->points[point].p), def->thesis ? most : 1.0f);
    }
    ty_vec3 along = ty_sub(off[0], off[1]);
    float length = ty_length(along);
    if (length == 0.0f)
        return false;
    float across = def->thesis ? 1.0f : ty_length(ty_cross(along, way)) / length;
    off[0] = ty_mul(off[0], across);
    off[1] = ty_mul(off[1], across);
    return true;
}

static float zone_of(const ty_vec3 off[2], float length)
{
    return ty_min(2.5f * ty_max(ty_length(off[0]), ty_length(off[1])), 0.5f * length);
}

// --- where rings stand ---

// How far a point is off the cone from a to b, of its radius.
static float off_cone(const roots_point* p, const roots_point* a, const roots_point* b)
{
    ty_vec3 d = ty_sub(b->p, a->p), e = ty_sub(p->p, a->p);
    float l = ty_length_sqr(d), t = l > 0.0f ? ty_clamp(ty_dot(e, d) / l, 0.0f, 1.0f) : 0.0f;
    float away = ty_length(ty_mad(e, d, -t)) + fabsf(p->r - ty_lerp(a->r, b->r, t));
    float turned = ty_length(ty_sub(p->n, ty_lerp3(a->n, b->n, t)));
    return away / p->r + (1.0f - p->flat) * turned + fabsf(p->flat - ty_lerp(a->flat, b->flat, t));
}

static float longest_at(const chosen* c, float s, float r)
{
    float most = c->def->longest * r;
    if (s - c->begin < c->zone[0])
        most = ty_min(most, 0.25f * c->zone[0]);
    if (c->end - s < c->zone[1])
        most = ty_min(most, 0.25f * c->zone[1]);
    return most;
}

// Of a..b what has to be a ring, as Ramer 1972 and Douglas and Peucker 1973: the point that is farthest off, where it
// is too far; or the middle, where the segment is too long. -1: none.
static int farthest(const chosen* c, int a, int b)
{
    const roots_point *pa = &c->points[a], *pb = &c->points[b];
    float most = c->def->sag;
    int found = -1;
    for (int i = a + 1; i < b; i++)
    {
        float off = off_cone(&c->points[i], pa, pb);
        found = off > most ? i : found;
        most = ty_max(most, off);
    }
    if (found >= 0 || b - a < 2 || pb->s - pa->s <= longest_at(c, 0.5f * (pa->s + pb->s), 0.5f * (pa->r + pb->r)))
        return found;
    return (a + b) / 2;
}

typedef struct span
{
    int a, b;
} span;

static void points_choose(const chosen* c)
{
    int last = c->line->count - 1, depth = 0;
    span* stack = TY_ALLOC(span, c->line->count + 1); // no deeper than there are points
    c->keep[0] = c->keep[last] = true;
    stack[depth++] = (span){0, last};
    while (depth > 0)
    {
        span now = stack[--depth];
        int middle = farthest(c, now.a, now.b);
        if (middle < 0)
            continue;
        c->keep[middle] = true;
        stack[depth++] = (span){now.a, middle};
        stack[depth++] = (span){middle, now.b};
    }
    ty_free(stack);
}

// --- how they are turned ---

// Of the line itself at one of its ends.
static ty_vec3 way_at(const roots_point* points, int count, int end)
{
    int step = end == 0 ? 1 : -1, i = end + step;
    while (i + step >= 0 && i + step < count && ty_length_sqr(ty_sub(points[i].p, points[end].p)) == 0.0f)
        i += step;
    ty_vec3 way = ty_mul(ty_sub(points[i].p, points[end].p), (float)step);
    return ty_length_sqr(way) > 0.0f ? ty_normalize(way) : (ty_vec3){0.0f, -1.0f, 0.0f};
}

static ty_vec3 way_between(const tube_ring* a, const tube_ring* b, ty_vec3 otherwise)
{
    ty_vec3 d = ty_sub(b->at.p, a->at.p);
    return ty_length_sqr(d) > 0.0f ? ty_normalize(d) : otherwise;
}

// Halfway between the segments before and after; of the ends it is given.
static void tangents_set(tube_ring* rings, int count)
{
    ty_vec3 before = way_between(&rings[0], &rings[1], rings[0].t);
    for (int i = 1; i + 1 < count; i++)
    {
        ty_vec3 after = way_between(&rings[i], &rings[i + 1], before), sum = ty_add(before, after);
        rings[i].t = ty_length_sqr(sum) > 1e-6f ? ty_normalize(sum) : before;
        before = after;
    }
}

static void frame_set(tube_ring* ring, ty_vec3 side)
{
    side = ty_mad(side, ring->t, -ty_dot(side, ring->t));
    ring->e1 = ty_length_sqr(side) > 1e-8f ? ty_normalize(side) : ty_frame_from_normal(ring->t).t;
    ring->e2 = ty_cross(ring->t, ring->e1);
}

static ty_vec3 mirrored(ty_vec3 v, ty_vec3 across)
{
    float c = ty_length_sqr(across);
    return c > 1e-20f ? ty_mad(v, across, -2.0f * ty_dot(v, across) / c) : v;
}

// The frame that turns least about the line, by two reflections (Wang, Juettler, Zheng and Liu 2008).
static void frames_set(tube_ring* rings, int count)
{
    for (int i = 1; i < count; i++)
    {
        ty_vec3 step = ty_sub(rings[i].at.p, rings[i - 1].at.p);
        ty_vec3 side = mirrored(rings[i - 1].e1, step), way = mirrored(rings[i - 1].t, step);
        frame_set(&rings[i], mirrored(side, ty_sub(rings[i].t, way)));
    }
}

// A ring's vertices lie ahead of the plane of the one before, and those behind its own.
static bool crosses(const tubes_def* def, const tube_ring* a, const tube_ring* b)
{
    for (int k = 0; k < def->divisions; k++)
    {
        ty_vec3 step = ty_sub(tube_vertex(def, b, k), tube_vertex(def, a, k));
        if (ty_dot(step, a->t) <= 0.0f || ty_dot(step, b->t) <= 0.0f)
            return true;
    }
    return false;
}

// Which of two rings that cross is the lesser loss; no end. 0: there are but ends.
static int lesser(const tube_ring* rings, int count, int i)
{
    float off[2] = {TY_FLOAT_MAX, TY_FLOAT_MAX};
    for (int k = 0; k < 2; k++)
        if (i + k > 0 && i + k + 1 < count)
            off[k] = off_cone(&rings[i + k].at, &rings[i + k - 1].at, &rings[i + k + 1].at);
    return count < 3 ? 0 : off[0] < off[1] ? i : i + 1;
}

// Rings that cross at bends tighter than the root is thick are left out; how many are left.
static int rings_clear(const tubes_def* def, tube_ring* rings, int count)
{
    for (bool any = true; any;)
    {
        int kept = 0, last = -1; // of neighbours one at a time
        any = false;
        tangents_set(rings, count);
        frames_set(rings, count);
        for (int i = 0; i < count; i++)
        {
            int out =
                last < i - 1 && i + 1 < count && crosses(def, &rings[i], &rings[i + 1]) ? lesser(rings, count, i) : 0;
            if (out > 0)
            {
                rings[out].join = -1.0f;
                last = out;
                any = true;
            }
        }
        for (int i = 0; i < count; i++)
            if (rings[i].join >= 0.0f)
                rings[kept++] = rings[i];
        count = kept;
    }
    return count;
}

// --- all of it ---

// Of the thesis a branch's ends stand upright, across the way to its other end, and the first half of the vertices is
// the upper one.
static void ends_turn(const tubes_def* def, const roots_line* line, tube_ring* rings, int count)
{
    ty_vec3 way = ty_sub(rings[count - 1].at.p, rings[0].at.p);
    way.y = 0.0f;
    frame_set(&rings[0], rings[0].at.n);
    if (!def->thesis || line->kind != ROOTS_FIRST || ty_length_sqr(way) == 0.0f)
        return;
    rings[0].t = rings[count - 1].t = ty_normalize(way);
    frame_set(&rings[0], ty_cross((ty_vec3){0.0f, 1.0f, 0.0f}, rings[0].t));
}

// The last one too, as near to the frame that turns least as its vertices are to one another.
static void end_align(const tubes_def* def, const roots_line* line, tube_ring* ring)
{
    if (!def->thesis || line->kind != ROOTS_FIRST || fabsf(ring->t.y) > 1e-3f)
        return;
    ty_vec3 aside = ty_cross((ty_vec3){0.0f, 1.0f, 0.0f}, ring->t);
    float sector = 2.0f * TY_PI / (float)def->divisions, sine, cosine;
    float turn = ty_atan2(ty_dot(ring->e1, ty_cross(ring->t, aside)), ty_dot(ring->e1, aside));
    ty_sincos(floorf(turn / sector + 0.5f) * sector, &sine, &cosine);
    frame_set(ring, ty_mad(ty_mul(aside, cosine), ty_cross(ring->t, aside), sine));
}

// Rings near one end spread towards where its halves go, ever less.
static void spread_set(const chosen* c, tube_ring* rings, int count, int end, const ty_vec3 off[2])
{
    int n = c->def->divisions;
    for (int i = 0; i < count; i++)
    {
        tube_ring* ring = &rings[i];
        float far = end ? c->end - ring->at.s : ring->at.s - c->begin;
        float left = 1.0f - far / c->zone[end];
        if (far >= c->zone[end] || left <= 0.0f)
            continue;
        ty_vec3 up = c->def->thesis ? (ty_vec3){0.0f, 1.0f, 0.0f} : ty_sub(off[0], off[1]);
        float turn = ty_atan2(ty_dot(up, ring->e2), ty_dot(up, ring->e1)) - 0.5f * TY_PI;
        ring->join = left * left;
        ring->off[0] = ty_mul(off[0], ring->join);
        ring->off[1] = ty_mul(off[1], ring->join);
        ring->half = ((int)floorf(turn * (float)n / (2.0f * TY_PI) + 1e-2f) + 1 + 2 * n) % n;
    }
}

static float circumference(const roots_point* p)
{
    return 2.0f * TY_PI * p->r * sqrtf(0.5f * (1.0f + p->flat * p->flat));
}

static void lengths_set(tube_ring* rings, int count)
{
    for (int i = 1; i < count; i++)
    {
        float length = ty_length(ty_sub(rings[i].at.p, rings[i - 1].at.p));
        rings[i].v =
            rings[i - 1].v + 2.0f * length / (circumference(&rings[i].axis) + circumference(&rings[i - 1].axis));
    }
}

// Half a ball, its last ring a point.
static int cap_add(const tubes_def* def, tube_ring* rings, int count)
{
    int steps = (def->divisions + 3) / 4;
    steps = steps < TUBE_CAP ? steps : TUBE_CAP;
    const tube_ring last = rings[count - 1];
    for (int i = 1; i <= steps; i++)
    {
        float sine, cosine;
        ty_sincos(0.5f * TY_PI * (float)i / (float)steps, &sine, &cosine);
        tube_ring* ring = &rings[count++];
        *ring = last;
        ring->at.p = ty_mad(last.at.p, last.t, sine * last.at.r);
        ring->at.r = i < steps ? cosine * last.at.r : 0.0f;
        ring->v = last.v + 0.25f * (float)i / (float)steps;
    }
    return count;
}

ty_vec3 tube_vertex(const tubes_def* def, const tube_ring* ring, int k)
{
    int n = def->divisions, j = k % n;
    float sine, cosine;
    ty_sincos(2.0f * TY_PI * (float)j / (float)n, &sine, &cosine);
    ty_vec3 d = ty_add(ty_mul(ring->e1, cosine), ty_mul(ring->e2, sine));
    ty_vec3 up = ty_mad(ring->at.n, ring->t, -ty_dot(ring->at.n, ring->t));
    float l = ty_length_sqr(up);
    if (l > 1e-8f)
        d = ty_mad(d, up, (ring->at.flat - 1.0f) * ty_dot(d, up) / l);
    bool first = (j - ring->half + n) % n < n / 2;
    return ty_add(ty_mad(ring->at.p, d, ring->at.r), ring->off[first ? 0 : 1]);
}

int tube_rings(const tubes_def* def, int number, tube_ring* out)
{
    const roots_line* line = &def->network->lines[number];
    chosen c = {.def = def, .line = line, .points = def->network->points + line->first};
    int last = line->count - 1, count = 0;
    ty_vec3 off[2][2], ways[2];
    if (line->count < 2)
        return 0;
    c.begin = c.points[0].s;
    c.end = c.points[last].s;
    ways[0] = way_at(c.points, line->count, 0);
    ways[1] = way_at(c.points, line->count, last);
    for (int end = 0; end < 2; end++)
        if (spread_at(def, line, end, ways[end], off[end]))
            c.zone[end] = zone_of(off[end], c.end - c.begin);
    c.keep = TY_ALLOC(bool, line->count);
    points_choose(&c);
    for (int i = 0; i <= last; i++)
    {
        bool same = count > 0 && ty_length(ty_sub(c.points[i].p, out[count - 1].at.p)) < 1e-3f * c.points[i].r;
        if ((c.keep[i] || def->thesis) && !same)
            out[count++] = (tube_ring){.at = c.points[i], .axis = c.points[i]};
    }
    ty_free(c.keep);
    if (count < 2)
        return 0;
    out[0].t = ways[0];
    out[count - 1].t = ways[1];
    tangents_set(out, count);
    ends_turn(def, line, out, count);
    if (!def->thesis)
        count = rings_clear(def, out, count);
    frames_set(out, count);
    end_align(def, line, &out[count - 1]);
    for (int end = 0; end < 2; end++)
        if (c.zone[end] > 0.0f)
            spread_set(&c, out, count, end, off[end]);
    lengths_set(out, count);
    return line->end < 0 && line->kind != ROOTS_TRUNK ? cap_add(def, out, count) : count;
}
