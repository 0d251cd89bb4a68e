// SPDX-License-Identifier: Apache-2.0
// Balls for any closed mesh: one for the point that is worst met, then all of them by least squares, and again.
#include "balls.h"
#include "element_kinds.h"
#include <tsuya/geometry/voxels.h>

enum
{
    SAMPLES = 3000,    // of the surface
    CANDIDATES = 9000, // nodes of the box, about
    REFINEMENTS = 3,   // of all balls, after each new one
    NODES = 32,        // of the distances across the width
};

typedef struct fit
{
    ty_voxels field;     // distances from the surface
    ty_ball* candidates; // largest inner balls about nodes of it
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

static ty_status candidates_find(fit* f, ty_error* error)
{
    const ty_voxels* v = &f->field;
    float all = (float)v->size[0] * (float)v->size[1] * (float)v->size[2];
    int stride = (int)ty_max(1.0f, ty_pow(all / (float)CANDIDATES, 1.0f / 3.0f) + 0.5f);
    size_t most = 1;
    for (int i = 0; i < 3; i++)
        most *= (size_t)((v->size[i] + stride - 1) / stride);
    f->candidates = TY_ALLOC(ty_ball, most);
    for (int k = 0; k < v->size[2]; k += stride)
        for (int j = 0; j < v->size[1]; j += stride)
            for (int i = 0; i < v->size[0]; i += stride)
            {
                float d = v->values[((size_t)k * (size_t)v->size[1] + (size_t)j) * (size_t)v->size[0] + (size_t)i];
                ty_vec3 p = ty_mad(v->origin, ty_vec3_make((float)i, (float)j, (float)k), v->step);
                if (d < 0.0f)
                    f->candidates[f->candidate_count++] = (ty_ball){p, -d};
            }
    if (f->candidate_count == 0)
        return ty_error_set(error, TY_BAD_INPUT, "the element is too thin for balls in it");
    return TY_OK;
}

// The largest ball on the way inwards from the sample that comes as near as slack to it and reaches out of the solid by
// no more: for corners that no node of the grid is near enough to.
static ty_ball corner_candidate(const fit* f, ty_vec3 p, float slack)
{
    ty_ball best = {p, 0.0f};
    ty_vec3 c = p;
    for (int i = 0; i < 64; i++)
    {
        ty_voxel_sample s = ty_voxels_sample(&f->field, c);
        float radius = slack - s.value;
        if (radius > best.radius && ty_length(ty_sub(p, c)) - radius <= slack)
            best = (ty_ball){c, radius};
        c = ty_mad(c, ty_normalize(s.gradient), -0.25f * slack);
    }
    return best;
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
    if (best.radius > 0.0f)
        return best;
    best = corner_candidate(f, p, slack);
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

// A ball may reach beyond the surface by slack; one that has left the solid, as no point of the surface keeps it from,
// goes back to where it was.
static void balls_hold(const fit* f, const ty_element* before, float slack, ty_element* e)
{
    for (int i = 0; i < e->ball_count; i++)
    {
        ty_ball* b = &e->balls[i];
        float most = slack - ty_voxels_value(&f->field, b->center);
        if (most < 0.5f * before->balls[i].radius)
            *b = before->balls[i];
        else
            b->radius = ty_min(b->radius, most);
    }
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
        for (int i = 0; i < REFINEMENTS; i++)
        {
            const ty_element before = *e;
            ty_balls_refine(f->samples, f->sample_count, 1, goal, e);
            balls_hold(f, &before, slack, e);
        }
        ty_balls_refine(f->samples, f->sample_count, 0, goal, e); // measures
        if (e->fit_max < best.fit_max)
            best = *e;
        if (e->ball_count == TY_ELEMENT_MAX_BALLS)
            break;
        e->balls[e->ball_count++] = candidate_for(f, f->samples[worst_outside(f, e)], 0.5f * goal);
    }
    *e = best;
}

ty_status ty_element_fit(ty_element* element, float tolerance, ty_error* error)
{
    const ty_mesh* mesh = element->mesh;
    fit f = {0};
    element->width = element->width > 0.0f ? element->width : middle_extent(mesh);
    float step = element->width / NODES, goal = tolerance * element->width;
    ty_status status = ty_voxels_from_mesh(mesh, step, 2.0f * step, &f.field, error);
    if (status != TY_OK)
        return status;
    f.samples = TY_ALLOC(ty_vec3, SAMPLES);
    status = candidates_find(&f, error);
    if (status == TY_OK)
    {
        samples_draw(&f, mesh);
        balls_choose(&f, goal, 0.8f * goal, element);
        ends_sort(element);
        element->capsule = ty_balls_capsule(element->balls, element->ball_count);
    }
    ty_voxels_term(&f.field);
    ty_free(f.candidates);
    ty_free(f.samples);
    return status;
}
