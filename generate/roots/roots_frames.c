// SPDX-License-Identifier: Apache-2.0
// Growth by time: the still mesh drawn in towards its centre lines, or a surface of its own for every frame.
#include "roots_output.h"
#include "roots_skin.h"
#include <string.h>

// --- one topology ---

// Where a vertex hangs: between a point of the centre lines and the next, and how far from there in the end.
typedef struct hanging
{
    int point; // -1 = nowhere
    float at;
    ty_vec3 offset;
} hanging;

typedef struct drawing
{
    const roots_result* result;
    ty_mesh* mesh;
    hanging* vertices; // [vertex_count]
    roots_carry* carry;
    ty_vec3* places;         // [point_count] of the centre lines at t
    const float *age, *full; // [vertex_count] of the still mesh: what it says is what happens
    float* radius;           // the same of mesh
    float t;
    const float* bent; // the still mesh's curvature, or NULL: it has none
    float* curvature;  // the same of mesh
} drawing;

static void axes_find(void* context, int64_t begin, int64_t end, int worker)
{
    const drawing* d = context;
    const ty_mesh* still = d->result->mesh;
    const roots_skin* skin = d->result->skin;
    (void)worker;
    for (int64_t v = begin; v < end; v++)
    {
        d->vertices[v] = (hanging){.point = -1};
        if (d->result->axes)
        {
            d->vertices[v].offset = ty_sub(still->positions[v], d->result->axes[v].p);
            continue;
        }
        roots_sample sample = roots_skin_at(skin, still->positions[v]);
        if (sample.segment >= 0)
            d->vertices[v] = (hanging){.point = skin->segments[sample.segment].point,
                                       .at = sample.at,
                                       .offset = ty_sub(still->positions[v], roots_skin_point(skin, sample).p)};
    }
}

static void vertices_draw(void* context, int64_t begin, int64_t end, int worker)
{
    const drawing* d = context;
    (void)worker;
    for (int64_t v = begin; v < end; v++)
    {
        const hanging* h = &d->vertices[v];
        float grown = roots_growth_at(d->age[v], d->t);
        float at = grown > 0.0f ? h->at : floorf(h->at + 0.5f); // what waits does not stand between two places
        ty_vec3 p = h->point < 0 ? (ty_vec3){0} : ty_lerp3(d->places[h->point], d->places[h->point + 1], at);
        if (d->result->axes) // tubes, each by itself
            p = roots_center_at(&d->result->axes[v], grown);
        d->radius[v] = d->full[v] * grown;
        if (d->bent)
            d->curvature[v] = d->bent[v] / ty_max(grown, 1e-3f); // thinner roots are rounder
        if (h->point >= 0 || d->result->axes)
            d->mesh->positions[v] = ty_mad(p, h->offset, grown);
    }
}

// The still mesh's normals know of bark; where the surface has turned away from them its own take over.
static void normals_turn(const drawing* d, ty_vec3* sums)
{
    const ty_mesh* still = d->result->mesh;
    ty_mesh* mesh = d->mesh;
    memset(sums, 0, mesh->vertex_count * sizeof *sums);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        const uint32_t* c = mesh->triangles[t];
        ty_vec3 a = mesh->positions[c[0]];
        ty_vec3 n = ty_cross(ty_sub(mesh->positions[c[1]], a), ty_sub(mesh->positions[c[2]], a));
        for (int k = 0; k < 3; k++)
            sums[still->welds[c[k]]] = ty_add(sums[still->welds[c[k]]], n);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        ty_vec3 n = sums[still->welds[v]];
        float length = ty_length(n);
        mesh->normals[v] = still->normals[v];
        if (!(length > 1e-12f))
            continue;
        n = ty_mul(n, 1.0f / length);
        float kept = ty_clamp(2.5f * ty_dot(n, still->normals[v]) - 1.25f, 0.0f, 1.0f);
        if (kept < 1.0f)
            mesh->normals[v] = ty_normalize(ty_lerp3(n, still->normals[v], kept));
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
    d.vertices = TY_TRY_ALLOC(hanging, d.mesh->vertex_count);
    d.places = TY_TRY_ALLOC(ty_vec3, result->network->point_count);
    d.carry = roots_carry_create(result->network, result->host, result->recipe->join, result->recipe->detail);
    d.age = ty_mesh_find_attribute(result->mesh, "age")->values;
    d.full = ty_mesh_find_attribute(result->mesh, "radius")->values;
    d.radius = ty_mesh_add_attribute(d.mesh, "radius", 1);
    const ty_mesh_attribute* bent = ty_mesh_find_attribute(result->mesh, "curvature");
    d.bent = bent ? bent->values : NULL;
    d.curvature = bent ? ty_mesh_add_attribute(d.mesh, "curvature", 1) : NULL;
    ty_status status = TY_OK;
    ty_vec3* sums = TY_TRY_ALLOC(ty_vec3, d.mesh->vertex_count);
    if (!d.vertices || !d.places || !d.carry || !sums)
        status = ty_error_set(error, TY_NO_MEMORY, "no memory for the growth of %u vertices", d.mesh->vertex_count);
    if (status == TY_OK && !ty_parallel_for(workers, d.mesh->vertex_count, 1024, axes_find, &d))
        status = ty_error_set(error, TY_INTERRUPTED, "interrupted while roots grew");
    curvature_forget(d.mesh);
    for (int frame = 1; frame < count && status == TY_OK; frame++)
    {
        d.t = (float)frame / (float)count;
        roots_carry_at(d.carry, d.t, d.places);
        if (!ty_parallel_for(workers, d.mesh->vertex_count, 4096, vertices_draw, &d))
            status = ty_error_set(error, TY_INTERRUPTED, "interrupted at frame %d of the growth", frame);
        if (status == TY_OK)
            normals_turn(&d, sums);
        if (status == TY_OK)
            status = sink->put(sink->context, frame, d.mesh, error);
    }
    ty_free(sums);
    ty_free(d.vertices);
    ty_free(d.places);
    roots_carry_destroy(d.carry);
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
        p.p = roots_center_at(&p, grown);
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
