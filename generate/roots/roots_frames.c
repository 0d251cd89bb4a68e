// SPDX-License-Identifier: Apache-2.0
// Growth by time: the still mesh drawn in towards its centre lines, or a surface of its own for every frame.
#include "roots_output.h"
#include <string.h>

// The rest of the time is left to the last part to become thick in.
#define TIP_TIME 0.7f

// The tip passes at once; from then on the part thickens, ever slower, until the end: 1 - (1 - x)^2.
float roots_growth_at(float birth, float t)
{
    float begin = TIP_TIME * ty_clamp(birth, 0.0f, 1.0f);
    if (t >= 1.0f)
        return 1.0f;
    if (t <= begin)
        return 0.0f;
    float left = (1.0f - t) / (1.0f - begin);
    return 1.0f - left * left;
}

// A root lies on its host from the beginning: the centre of its section rises as it thickens.
static ty_vec3 center_at(const roots_point* p, float grown)
{
    float held = ty_min(p->sink * 20.0f, 1.0f) * (p->flat - p->sink) * p->r;
    return ty_mad(p->p, p->n, -held * (1.0f - grown));
}

// --- one topology ---

typedef struct drawing
{
    const roots_result* result;
    ty_mesh* mesh;
    roots_point* axis;       // [vertex_count] where the centre line is nearest
    const float *age, *full; // [vertex_count] of the still mesh: what it says is what happens
    float* radius;           // the same of mesh
    float t;
} drawing;

static void axes_find(void* context, int64_t begin, int64_t end, int worker)
{
    const drawing* d = context;
    const ty_mesh* still = d->result->mesh;
    (void)worker;
    for (int64_t v = begin; v < end; v++)
    {
        if (d->result->axes)
        {
            d->axis[v] = d->result->axes[v];
            continue;
        }
        roots_sample sample = roots_skin_at(d->result->skin, still->positions[v]);
        d->axis[v] =
            sample.segment >= 0 ? roots_skin_point(d->result->skin, sample) : (roots_point){.p = still->positions[v]};
    }
}

static void vertices_draw(void* context, int64_t begin, int64_t end, int worker)
{
    const drawing* d = context;
    const ty_mesh* still = d->result->mesh;
    (void)worker;
    for (int64_t v = begin; v < end; v++)
    {
        const roots_point* axis = &d->axis[v];
        float grown = roots_growth_at(d->age[v], d->t);
        d->mesh->positions[v] = ty_mad(center_at(axis, grown), ty_sub(still->positions[v], axis->p), grown);
        d->radius[v] = d->full[v] * grown;
    }
}

static void curvature_forget(ty_mesh* mesh)
{
    ty_free(mesh->curvature_1);
    ty_free(mesh->curvature_2);
    ty_free(mesh->direction_1);
    mesh->curvature_1 = mesh->curvature_2 = NULL;
    mesh->direction_1 = NULL;
}

static ty_status frames_draw(const roots_result* result, const ty_mesh_sink* sink, ty_workers* workers, ty_error* error)
{
    int count = result->recipe->grow.frames;
    drawing d = {.result = result, .mesh = ty_mesh_copy(result->mesh)};
    d.axis = TY_TRY_ALLOC(roots_point, d.mesh->vertex_count);
    d.age = ty_mesh_find_attribute(result->mesh, "age")->values;
    d.full = ty_mesh_find_attribute(result->mesh, "radius")->values;
    d.radius = ty_mesh_add_attribute(d.mesh, "radius", 1);
    ty_status status = TY_OK;
    if (!d.axis)
        status = ty_error_set(error, TY_NO_MEMORY, "no memory for the growth of %u vertices", d.mesh->vertex_count);
    if (status == TY_OK && !ty_parallel_for(workers, d.mesh->vertex_count, 1024, axes_find, &d))
        status = ty_error_set(error, TY_INTERRUPTED, "interrupted while roots grew");
    curvature_forget(d.mesh);
    for (int frame = 1; frame < count && status == TY_OK; frame++)
    {
        d.t = (float)frame / (float)count;
        if (!ty_parallel_for(workers, d.mesh->vertex_count, 4096, vertices_draw, &d))
            status = ty_error_set(error, TY_INTERRUPTED, "interrupted at frame %d of the growth", frame);
        if (status == TY_OK)
            status = sink->put(sink->context, frame, d.mesh, error);
    }
    ty_free(d.axis);
    ty_mesh_destroy(d.mesh);
    return status;
}

// --- a surface for every frame ---

// Numbers of lines and points of the whole network in the part of it that is there; -1: not yet.
typedef struct numbers
{
    int *line, *point;
} numbers;

// What is joined that is not there yet is not joined yet.
static void joints_renumber(const numbers* n, roots_network* net)
{
    for (int l = 0; l < net->line_count; l++)
    {
        roots_line* line = &net->lines[l];
        int parent = line->parent_point < 0 ? -1 : n->point[line->parent_point];
        int end = line->end_point < 0 ? -1 : n->point[line->end_point];
        line->parent = parent < 0 ? -1 : n->line[line->parent];
        line->parent_point = line->parent < 0 ? -1 : parent;
        line->end = end < 0 ? -1 : n->line[line->end];
        line->end_point = line->end < 0 ? -1 : end;
    }
}

static int line_at(const roots_network* all, int number, float t, float finest, int* points, roots_network* out)
{
    roots_line line = all->lines[number];
    bool sprout = number == 0;
    line.first = out->point_count;
    line.count = 0;
    for (int i = 0; i < all->lines[number].count; i++)
    {
        roots_point p = all->points[all->lines[number].first + i];
        float grown = roots_growth_at(p.birth, t);
        if (p.r * grown < finest && !(sprout && i < 2))
            break;
        p.p = center_at(&p, grown);
        p.r = ty_max(p.r * grown, finest);
        points[all->lines[number].first + i] = out->point_count;
        roots_network_add_point(out, &p);
        line.count++;
    }
    if (line.count >= 2)
        return roots_network_add_line(out, &line);
    points[all->lines[number].first] = -1;
    out->point_count = line.first;
    return -1;
}

// The part of the network that is there at t: points whose section is no finer than the surface's cells, up to the
// first that is. The sprout is there from the beginning.
static void network_at(const roots_network* all, float t, float finest, roots_network* out)
{
    numbers n = {TY_ALLOC(int, all->line_count + 1), TY_ALLOC(int, all->point_count + 1)};
    *out = (roots_network){.top = all->top};
    for (int i = 0; i < all->point_count; i++)
        n.point[i] = -1;
    for (int l = 0; l < all->line_count; l++)
        n.line[l] = line_at(all, l, t, finest, n.point, out);
    joints_renumber(&n, out);
    ty_free(n.line);
    ty_free(n.point);
}

static ty_status frames_remesh(const roots_result* result, const ty_mesh_sink* sink, ty_workers* workers,
                               ty_error* error)
{
    int count = result->recipe->grow.frames;
    ty_status status = TY_OK;
    for (int frame = 1; frame < count && status == TY_OK; frame++)
    {
        roots_network network;
        roots_shape shape;
        network_at(result->network, (float)frame / (float)count, 0.75f * result->recipe->detail, &network);
        status = roots_shape_make(result->recipe, &network, result->host, workers, &shape, error);
        if (status == TY_OK)
            status = sink->put(sink->context, frame, shape.mesh, error);
        roots_shape_term(&shape);
        roots_network_term(&network);
    }
    return status;
}

ty_status roots_growth_frames(const roots_result* result, const ty_mesh_sink* sink, ty_workers* workers,
                              ty_error* error)
{
    ty_status status = result->recipe->grow.remesh ? frames_remesh(result, sink, workers, error)
                                                   : frames_draw(result, sink, workers, error);
    if (status != TY_OK)
        return status;
    ty_mesh* last = ty_mesh_copy(result->mesh);
    status = sink->put(sink->context, result->recipe->grow.frames, last, error);
    ty_mesh_destroy(last);
    return status;
}
