// SPDX-License-Identifier: Apache-2.0
// Flat contact facets on a realised mesh: where two bodies reach into one another, both are cut by the plane in the
// middle between their surfaces. A static pass over the render vertices, as wrinkle meshes (Müller and Chentanez 2010)
// are projected; nothing else of the bodies moves.
#include "aggregate_facets.h"
#include <stdlib.h>
#include <string.h>
#include <tsuya/geometry/aggregate_export.h>

enum
{
    PLANE_SWEEPS = 12,  // over the planes that meet in a vertex
    SURFACE_ROUNDS = 8, // each side in turn is put onto where the other went
};

#define FLAT 0.35f // deviation of what lies between two surfaces from a plane, of the mean depth

static int hit_order(const void* a, const void* b)
{
    const facet_hit *p = a, *q = b;
    if (p->other != q->other)
        return p->other < q->other ? -1 : 1;
    return p->vertex < q->vertex ? -1 : p->vertex > q->vertex;
}

// --- planes ---

typedef struct facet_plane
{
    ty_vec3 center, normal; // towards the second body
    bool flat;
} facet_plane;

// The hits of body a in body b.
static const facet_hit* hits_between(const facet_body* a, uint32_t b, int* count)
{
    int low = 0, high = a->hit_count;
    while (low < high)
    {
        int middle = (low + high) / 2;
        if (a->hits[middle].other < b)
            low = middle + 1;
        else
            high = middle;
    }
    int end = low;
    while (end < a->hit_count && a->hits[end].other == b)
        end++;
    *count = end - low;
    return a->hits + low;
}

typedef struct plane_sum
{
    ty_vec3 center, normal;
    double weight, area; // depth times area, area
    int count;
} plane_sum;

// Deep vertices tell most; those that only come near tell something where none is deep.
static void plane_add(plane_sum* s, const facet_hit* hits, int count, const facet_scene* f, const facet_body* body,
                      bool deep, float sign)
{
    for (int i = 0; i < count; i++)
    {
        const facet_hit* h = &hits[i];
        if ((h->depth > 0.0f) != deep)
            continue;
        ty_vec3 x = f->before[body->first + h->vertex], out = ty_sub(x, h->surface);
        float area = (float)body->areas[h->vertex], weight = fabsf(h->depth) * area;
        s->normal = ty_mad(s->normal, out, deep ? sign * area : -sign * area);
        s->center = ty_mad(s->center, ty_mul(ty_add(x, h->surface), 0.5f), weight);
        s->weight += (double)weight;
        s->area += (double)area;
        s->count++;
    }
}

static float plane_deviation(const facet_plane* p, const facet_hit* hits, int count, const facet_scene* f,
                             const facet_body* body)
{
    float sum = 0.0f;
    for (int i = 0; i < count; i++)
    {
        ty_vec3 middle = ty_mul(ty_add(f->before[body->first + hits[i].vertex], hits[i].surface), 0.5f);
        if (hits[i].depth > 0.0f)
            sum += fabsf(ty_dot(ty_sub(middle, p->center), p->normal)) * hits[i].depth *
                   (float)body->areas[hits[i].vertex];
    }
    return sum;
}

// The same whichever of the two asks: a is the lower number.
static facet_plane plane_between(const facet_scene* f, uint32_t a, uint32_t b)
{
    int of_a, of_b;
    const facet_hit* in_b = hits_between(&f->bodies[a], b, &of_a);
    const facet_hit* in_a = hits_between(&f->bodies[b], a, &of_b);
    plane_sum s = {.count = 0};
    for (int deep = 1; deep >= 0 && s.count == 0; deep--)
    {
        plane_add(&s, in_b, of_a, f, &f->bodies[a], deep, 1.0f);
        plane_add(&s, in_a, of_b, f, &f->bodies[b], deep, -1.0f);
    }
    facet_plane p = {.flat = false};
    float length = ty_length(s.normal);
    float weight = (float)s.weight;
    if (!(weight > 0.0f) || length < 0.5f * weight) // surfaces that face all ways have no plane between them
        return p;
    p.center = ty_mul(s.center, 1.0f / weight);
    p.normal = ty_mul(s.normal, 1.0f / length);
    float off = plane_deviation(&p, in_b, of_a, f, &f->bodies[a]) + plane_deviation(&p, in_a, of_b, f, &f->bodies[b]);
    p.flat = off <= FLAT * weight * (float)(s.weight / s.area);
    return p;
}

// --- the first move: behind the planes ---

typedef struct facet_bound
{
    uint32_t vertex;
    int rank;        // among the body's
    ty_vec3 at, out; // points on the near side have a negative product with out
    float pull;      // share of the gap to the plane that is closed, 0 = it only keeps back
} facet_bound;

static facet_bound bound_of(const facet_scene* f, const facet_body* body, const facet_hit* h, const facet_plane* p,
                            float sign)
{
    ty_vec3 x = f->before[body->first + h->vertex];
    facet_bound b = {.vertex = h->vertex};
    float beyond = p->flat ? sign * ty_dot(ty_sub(x, p->center), p->normal) : 0.0f;
    if (p->flat && beyond <= fabsf(h->depth))
    {
        b.at = p->center;
        b.out = ty_mul(p->normal, sign);
    }
    else // a plane of its own, midway to the other's surface
    {
        b.at = ty_mul(ty_add(x, h->surface), 0.5f);
        b.out = ty_mul(ty_sub(x, h->surface), 1.0f / h->depth);
    }
    if (h->depth < 0.0f)
        b.pull = ty_clamp(2.0f + 2.0f * h->depth / f->def.close, 0.0f, 1.0f);
    return b;
}

static int bound_order(const void* a, const void* b)
{
    const facet_bound *p = a, *q = b;
    if (p->vertex != q->vertex)
        return p->vertex < q->vertex ? -1 : 1;
    return p->rank < q->rank ? -1 : p->rank > q->rank;
}

static void vertex_project(ty_vec3* x, const facet_bound* b, int count)
{
    for (int i = 0; i < count; i++)
        if (b[i].pull > 0.0f)
        {
            float gap = -ty_dot(ty_sub(*x, b[i].at), b[i].out);
            *x = ty_mad(*x, b[i].out, b[i].pull * ty_max(gap, 0.0f));
        }
    for (int k = 0; k < PLANE_SWEEPS; k++)
        for (int i = 0; i < count; i++)
        {
            float beyond = ty_dot(ty_sub(*x, b[i].at), b[i].out);
            *x = ty_mad(*x, b[i].out, -ty_max(beyond, 0.0f));
        }
}

static void bodies_project(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    facet_scene* f = context;
    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++)
    {
        const facet_body* body = &f->bodies[i];
        facet_bound* bounds = TY_ALLOC(facet_bound, body->hit_count);
        facet_plane plane = {.flat = false};
        for (int k = 0; k < body->hit_count; k++)
        {
            uint32_t j = body->hits[k].other;
            if (k == 0 || j != body->hits[k - 1].other)
                plane = i < j ? plane_between(f, i, j) : plane_between(f, j, i);
            bounds[k] = bound_of(f, body, &body->hits[k], &plane, i < j ? 1.0f : -1.0f);
            bounds[k].rank = k;
        }
        ty_vec3* x = f->mesh->positions + body->first;
        qsort(bounds, (size_t)body->hit_count, sizeof *bounds, bound_order);
        for (int k = 0, next; k < body->hit_count; k = next)
        {
            for (next = k; next < body->hit_count && bounds[next].vertex == bounds[k].vertex; next++)
                ;
            vertex_project(&x[bounds[k].vertex], bounds + k, next - k);
        }
        ty_free(bounds);
    }
}

// --- then: what still lies in where the other went ---

// How far the other's surface has moved at a point of it.
static ty_vec3 moved_at(const facet_scene* f, const facet_body* body, const ty_closest* c)
{
    const uint32_t* t = body->shape->triangles[c->triangle];
    const float weights[3] = {1.0f - c->u - c->v, c->u, c->v};
    ty_vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int k = 0; k < 3; k++)
        sum = ty_mad(sum, ty_sub(f->from[body->first + t[k]], f->before[body->first + t[k]]), weights[k]);
    return sum;
}

// Where x has to go so that it does not lie within body as it is now: taken back by how the body moved there, it must
// not lie within the body as it was.
static ty_vec3 vertex_free(const facet_scene* f, const facet_body* body, const facet_hit* h, ty_vec3 x)
{
    ty_closest c = h->closest;
    for (int k = 0; k < 2; k++)
    {
        ty_vec3 moved = moved_at(f, body, &c), was = ty_sub(x, moved), own = ty_map_point(&body->back, was);
        if (!ty_world_closest(f->world, body->prototype, own, TY_FLOAT_MAX, &c))
            return x;
        if (k == 1 && ty_world_inside(f->world, body->prototype, own))
            return ty_add(ty_map_point(&body->place, c.position), moved_at(f, body, &c));
    }
    return x;
}

static void bodies_free(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    facet_scene* f = context;
    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++)
    {
        const facet_body* body = &f->bodies[i];
        for (int k = 0; k < body->hit_count; k++)
        {
            const facet_hit* h = &body->hits[k];
            ty_vec3* x = &f->mesh->positions[body->first + h->vertex];
            if ((i < h->other) == f->lower_moves)
                *x = vertex_free(f, &f->bodies[h->other], h, *x);
        }
    }
}

// What is left of it.
static void bodies_measure(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    facet_scene* f = context;
    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++)
    {
        facet_body* body = &f->bodies[i];
        for (int k = 0; k < body->hit_count; k++)
        {
            const facet_hit* h = &body->hits[k];
            ty_vec3 x = f->mesh->positions[body->first + h->vertex];
            body->left = ty_max(body->left, ty_length(ty_sub(vertex_free(f, &f->bodies[h->other], h, x), x)));
        }
    }
}

// --- the whole ---

static double volume_of(const ty_mesh* mesh, const ty_vec3* positions)
{
    double sum = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        const uint32_t* v = mesh->triangles[t];
        sum += (double)ty_dot(positions[v[0]], ty_cross(positions[v[1]], positions[v[2]]));
    }
    return sum / 6.0;
}

static void report_fill(const facet_scene* f, ty_facet_report* report)
{
    *report = (ty_facet_report){.volume_before = volume_of(f->mesh, f->before),
                                .volume_after = volume_of(f->mesh, f->mesh->positions)};
    for (uint32_t i = 0; i < f->count; i++)
    {
        const facet_body* body = &f->bodies[i];
        report->left = ty_max(report->left, body->left);
        for (int k = 0; k < body->hit_count; k++)
        {
            const facet_hit* h = &body->hits[k];
            report->contacts += (k == 0 || h->other != body->hits[k - 1].other) && i < h->other;
            report->deepest = ty_max(report->deepest, h->depth);
        }
    }
    for (uint32_t v = 0; v < f->mesh->vertex_count; v++)
        report->vertices += memcmp(&f->before[v], &f->mesh->positions[v], sizeof(ty_vec3)) != 0;
}

static void facets_make(facet_scene* f, ty_workers* workers)
{
    for (uint32_t i = 0; i < f->count; i++)
        if (f->bodies[i].hit_count > 0)
            qsort(f->bodies[i].hits, (size_t)f->bodies[i].hit_count, sizeof(facet_hit), hit_order);
    ty_parallel_all(workers, f->count, 16, bodies_project, f);
    for (int round = 0; round < SURFACE_ROUNDS; round++)
    {
        memcpy(f->from, f->mesh->positions, f->mesh->vertex_count * sizeof *f->from);
        f->lower_moves = round % 2 == 0;
        ty_parallel_all(workers, f->count, 16, bodies_free, f);
    }
    memcpy(f->from, f->mesh->positions, f->mesh->vertex_count * sizeof *f->from);
    ty_parallel_all(workers, f->count, 16, bodies_measure, f);
    facets_shade(f, workers);
}

ty_facet_def ty_facet_def_default(void)
{
    return (ty_facet_def){.close = 0.0f};
}

ty_status ty_aggregate_realise_facets(const ty_aggregate* a, const ty_facet_def* def, ty_workers* workers,
                                      ty_mesh** out, ty_facet_report* report, ty_error* error)
{
    facet_scene f = {.aggregate = a, .def = *def};
    *out = NULL;
    ty_status status = facets_begin(&f, workers, error);
    if (status == TY_OK)
    {
        facets_make(&f, workers);
        if (report)
            report_fill(&f, report);
        ty_mesh_compute_bounds(f.mesh);
        *out = f.mesh;
        f.mesh = NULL;
    }
    facets_end(&f);
    return status;
}
