// SPDX-License-Identifier: Apache-2.0
// Balls for any closed mesh: one for the point that is worst met, then all of them by least squares, and again.
#include "balls.h"
#include "element_kinds.h"
#include <tsuya/geometry/trace.h>

enum
{
    SAMPLES = 3000,    // of the surface
    CANDIDATES = 9000, // cells of the box
    REFINEMENTS = 3,   // of all balls, after each new one
};

typedef struct fit
{
    ty_ball* candidates; // largest inner balls about the points of a grid
    int candidate_count;
    ty_vec3* samples;
    uint32_t sample_count;
} fit;

// Points even over the surface: a walk through the triangles that stops at equal steps of area, each at a place of the
// R2 sequence (Roberts 2018) within its triangle.
static void samples_draw(fit* f, const ty_mesh* mesh)
{
    double total = 0.0, passed = 0.0;
    for (uint32_t pass = 0; pass < 2; pass++)
        for (uint32_t t = 0; t < mesh->triangle_count; t++)
        {
            const uint32_t* c = mesh->triangles[t];
            ty_vec3 a = mesh->positions[c[0]], u = ty_sub(mesh->positions[c[1]], a);
            ty_vec3 v = ty_sub(mesh->positions[c[2]], a);
            double area = (double)ty_length(ty_cross(u, v));
            if (pass == 0)
            {
                total += area;
                continue;
            }
            passed += area;
            while (f->sample_count < SAMPLES && ((double)f->sample_count + 0.5) * total <= passed * SAMPLES)
            {
                float s = 0.5f + 0.7548776662f * (float)f->sample_count,
                      w = 0.5f + 0.5698402910f * (float)f->sample_count;
                s -= floorf(s);
                w -= floorf(w);
                if (s + w > 1.0f)
                {
                    s = 1.0f - s;
                    w = 1.0f - w;
                }
                f->samples[f->sample_count++] = ty_mad(ty_mad(a, u, s), v, w);
            }
        }
}

static ty_status candidates_find(fit* f, const ty_mesh* mesh, ty_error* error)
{
    ty_world_def def = ty_world_def_default();
    ty_world* world;
    uint32_t prototype;
    ty_status status = ty_world_create(&def, &world, error);
    if (status != TY_OK)
        return status;
    status = ty_world_add_prototype(world, mesh, &prototype, error);
    if (status == TY_OK)
        status = ty_world_commit(world, error);
    ty_vec3 low = mesh->bounds.low, size = ty_sub(mesh->bounds.high, low);
    float step = ty_pow(size.x * size.y * size.z / (float)CANDIDATES, 1.0f / 3.0f);
    int n[3] = {(int)(size.x / step) | 1, (int)(size.y / step) | 1, (int)(size.z / step) | 1};
    for (int k = 0; k < n[2] && status == TY_OK; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0] && f->candidate_count < 2 * CANDIDATES; i++)
            {
                ty_vec3 share = {((float)i + 0.5f) / (float)n[0], ((float)j + 0.5f) / (float)n[1],
                                 ((float)k + 0.5f) / (float)n[2]};
                ty_vec3 p = ty_add(low, ty_mul3(size, share));
                ty_closest closest;
                if (ty_world_inside(world, prototype, p) && ty_world_closest(world, prototype, p, 1e3f, &closest))
                    f->candidates[f->candidate_count++] = (ty_ball){p, closest.distance};
            }
    ty_world_destroy(world);
    if (status == TY_OK && f->candidate_count == 0)
        return ty_error_set(error, TY_BAD_INPUT, "the element is too thin for balls in it");
    return status;
}

// The largest candidate that comes as near as slack to the sample; else the one that comes nearest.
static ty_ball candidate_for(const fit* f, ty_vec3 p, float slack)
{
    ty_ball best = {p, 0.0f}, nearest = f->candidates[0];
    float least = TY_FLOAT_MAX;
    for (int i = 0; i < f->candidate_count; i++)
    {
        const ty_ball* b = &f->candidates[i];
        float square = ty_length_sqr(ty_sub(p, b->center));
        if (square <= ty_sqr(b->radius + slack) && b->radius > best.radius)
            best = *b;
        if (best.radius > 0.0f)
            continue;
        float d = sqrtf(square) - b->radius;
        if (d < least)
        {
            least = d;
            nearest = *b;
        }
    }
    return best.radius > 0.0f ? best : nearest;
}

static ty_ball largest_candidate(const fit* f)
{
    ty_ball best = f->candidates[0];
    for (int i = 1; i < f->candidate_count; i++)
        best = f->candidates[i].radius > best.radius ? f->candidates[i] : best;
    return best;
}

// The sample that lies farthest outside of the union.
static uint32_t worst_outside(fit* f, const ty_element* e)
{
    uint32_t worst = 0;
    float most = -TY_FLOAT_MAX;
    for (uint32_t i = 0; i < f->sample_count; i++)
    {
        float least = TY_FLOAT_MAX;
        for (int b = 0; b < e->ball_count; b++)
            least = ty_min(least, ty_length(ty_sub(f->samples[i], e->balls[b].center)) - e->balls[b].radius);
        if (least > most)
        {
            most = least;
            worst = i;
        }
    }
    return worst;
}

// The two centres farthest apart become the first and the last: the ends of the capsule.
static void ends_sort(ty_element* e)
{
    int from = 0, to = e->ball_count - 1;
    float most = -1.0f;
    for (int i = 0; i < e->ball_count; i++)
        for (int k = i + 1; k < e->ball_count; k++)
        {
            float d = ty_length_sqr(ty_sub(e->balls[i].center, e->balls[k].center));
            if (d > most)
            {
                most = d;
                from = i;
                to = k;
            }
        }
    ty_ball first = e->balls[from], last = e->balls[to];
    e->balls[to] = e->balls[e->ball_count - 1]; // to > from, or there is one ball
    e->balls[e->ball_count - 1] = last;
    if (e->ball_count > 1)
    {
        e->balls[from] = e->balls[0];
        e->balls[0] = first;
    }
}

static float middle_extent(const ty_mesh* mesh)
{
    ty_vec3 e = ty_sub(mesh->bounds.high, mesh->bounds.low);
    return e.x + e.y + e.z - ty_max(e.x, ty_max(e.y, e.z)) - ty_min(e.x, ty_min(e.y, e.z));
}

// A ball for the worst point, then all by least squares, until the goal holds; the best so far where it does not.
static void balls_choose(fit* f, float goal, float slack, ty_element* e)
{
    ty_element best = *e;
    best.fit_max = TY_FLOAT_MAX;
    e->ball_count = 0;
    e->balls[e->ball_count++] = largest_candidate(f);
    while (best.fit_max > goal)
    {
        ty_balls_refine(f->samples, f->sample_count, REFINEMENTS, goal, e);
        if (e->fit_max < best.fit_max)
            best = *e;
        if (e->ball_count == TY_ELEMENT_MAX_BALLS)
            break;
        e->balls[e->ball_count++] = candidate_for(f, f->samples[worst_outside(f, e)], slack);
    }
    *e = best;
}

ty_status ty_element_fit(ty_element* element, float tolerance, ty_error* error)
{
    const ty_mesh* mesh = element->mesh;
    fit f = {0};
    element->width = middle_extent(mesh);
    f.samples = TY_ALLOC(ty_vec3, SAMPLES);
    f.candidates = TY_ALLOC(ty_ball, 2 * CANDIDATES);
    ty_status status = candidates_find(&f, mesh, error);
    if (status == TY_OK)
    {
        samples_draw(&f, mesh);
        balls_choose(&f, tolerance * element->width, 0.5f * tolerance * element->width, element);
        ends_sort(element);
        element->capsule = ty_balls_capsule(element->balls, element->ball_count);
    }
    ty_free(f.candidates);
    ty_free(f.samples);
    return status;
}
