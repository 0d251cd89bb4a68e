// SPDX-License-Identifier: Apache-2.0
// The surface of roots with what a mesh needs besides: one piece, exact positions, normals, uv, attributes.
#include "roots_output.h"
#include <string.h>

// --- what stands at each vertex ---

typedef struct dressing
{
    const roots_skin* skin;
    const roots_network* network;
    const roots_host* host;
    const ty_roots_recipe* recipe;
    ty_mesh* mesh;
    roots_sample* samples; // [vertex_count]
    float *radius, *level, *join, *sink, *root, *along, *age;
} dressing;

// What stands out from the surface of roots, bark, turns normals by its slope: the mean of the gradients of what is
// linear on the triangles about a vertex.
static void normals_tilt(ty_mesh* mesh, const roots_sample* samples)
{
    ty_vec3* slope = TY_ALLOC(ty_vec3, mesh->vertex_count);
    float* area = TY_ALLOC(float, mesh->vertex_count);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        const uint32_t* c = mesh->triangles[t];
        ty_vec3 a = mesh->positions[c[0]], b = mesh->positions[c[1]], d = mesh->positions[c[2]];
        ty_vec3 n = ty_cross(ty_sub(b, a), ty_sub(d, a)), sum;
        float twice = ty_length(n);
        if (twice == 0.0f)
            continue;
        sum = ty_mul(ty_sub(d, b), samples[c[0]].distance);
        sum = ty_mad(sum, ty_sub(a, d), samples[c[1]].distance);
        sum = ty_mul(ty_cross(n, ty_mad(sum, ty_sub(b, a), samples[c[2]].distance)), 1.0f / twice);
        for (int k = 0; k < 3; k++)
        {
            slope[c[k]] = ty_add(slope[c[k]], sum);
            area[c[k]] += twice;
        }
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (area[v] > 0.0f && ty_length_sqr(mesh->normals[v]) > 0.0f)
            mesh->normals[v] = ty_normalize(ty_mad(mesh->normals[v], slope[v], -1.0f / area[v]));
    ty_free(slope);
    ty_free(area);
}

// Where the field has said nothing, normals are those of the triangles.
static void normals_fill(ty_mesh* mesh)
{
    bool* open = TY_ALLOC(bool, mesh->vertex_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        open[v] = ty_length_sqr(mesh->normals[v]) == 0.0f;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        const uint32_t* c = mesh->triangles[t];
        ty_vec3 p = mesh->positions[c[0]];
        ty_vec3 n = ty_cross(ty_sub(mesh->positions[c[1]], p), ty_sub(mesh->positions[c[2]], p));
        for (int k = 0; k < 3; k++)
            if (open[c[k]])
                mesh->normals[c[k]] = ty_add(mesh->normals[c[k]], n);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (open[v])
            mesh->normals[v] = ty_normalize(mesh->normals[v]);
    ty_free(open);
}

static void vertices_dress(void* context, int64_t begin, int64_t end, int worker)
{
    const dressing* d = context;
    (void)worker;
    for (int64_t v = begin; v < end; v++)
    {
        ty_vec3* p = &d->mesh->positions[v];
        ty_vec3 n;
        roots_sample sample = roots_skin_look(d->skin, *p, &n, 0.0f, NULL);
        roots_point own = roots_skin_point(d->skin, sample);
        d->mesh->normals[v] = roots_skin_keep(d->skin, sample, p) ? (ty_vec3){0.0f, 0.0f, 0.0f} : n;
        d->mesh->uvs[v] = roots_skin_uv(d->skin, *p, sample);
        d->samples[v] = sample;
        d->radius[v] = own.r;
        d->level[v] = (float)roots_level(d->network->lines[sample.line].kind);
        d->join[v] = sample.join;
        d->sink[v] = own.sink;
        d->root[v] = (float)sample.line;
        d->along[v] = own.s;
        d->age[v] = own.birth;
    }
}

// --- seams ---

typedef struct seam
{
    uint32_t triangle;
    int corner;
    ty_vec2 uv;
} seam;

typedef struct seams
{
    seam* items;
    size_t count, capacity;
    bool failed;
} seams;

static void seam_add(seams* s, uint32_t triangle, int corner, ty_vec2 uv)
{
    if (s->count == s->capacity)
    {
        size_t larger = s->capacity ? 2 * s->capacity : 4096;
        seam* grown = ty_try_grow(s->items, s->capacity, larger, sizeof(seam));
        s->failed |= !grown;
        if (!grown)
            return;
        s->items = grown;
        s->capacity = larger;
    }
    s->items[s->count++] = (seam){triangle, corner, uv};
}

// Corners of a triangle that need a uv of their own: where two roots meet it takes that of its first corner's root, and
// where u runs over the turn it goes on beyond 1.
static void triangle_seams(const dressing* d, uint32_t t, seams* out)
{
    const uint32_t* corner = d->mesh->triangles[t];
    int line = d->samples[corner[0]].line;
    ty_vec2 uv[3];
    bool changed[3] = {false, false, false};
    float most = 0.0f;
    for (int k = 0; k < 3; k++)
    {
        uint32_t v = corner[k];
        uv[k] = d->mesh->uvs[v];
        if (d->samples[v].line != line)
        {
            roots_sample sample = roots_skin_line_at(d->skin, d->mesh->positions[v], line);
            changed[k] = sample.segment >= 0;
            uv[k] = changed[k] ? roots_skin_uv(d->skin, d->mesh->positions[v], sample) : uv[k];
        }
        most = ty_max(most, uv[k].x);
    }
    for (int k = 0; k < 3; k++)
    {
        bool over = most - uv[k].x > 0.5f;
        uv[k].x += over ? 1.0f : 0.0f;
        if (over || changed[k])
            seam_add(out, t, k, uv[k]);
    }
}

// The mesh again with vertices of their own at the seams: the same place and normal, another uv.
static ty_mesh* split(const ty_mesh* mesh, const seams* s)
{
    ty_mesh* out = ty_mesh_create(mesh->vertex_count + (uint32_t)s->count, mesh->triangle_count);
    if (!out)
        return NULL;
    out->uvs = TY_ALLOC(ty_vec2, out->vertex_count);
    memcpy(out->positions, mesh->positions, mesh->vertex_count * sizeof(ty_vec3));
    memcpy(out->normals, mesh->normals, mesh->vertex_count * sizeof(ty_vec3));
    memcpy(out->uvs, mesh->uvs, mesh->vertex_count * sizeof(ty_vec2));
    memcpy(out->triangles, mesh->triangles, mesh->triangle_count * sizeof(*mesh->triangles));
    for (int a = 0; a < mesh->attribute_count; a++)
        memcpy(ty_mesh_add_attribute(out, mesh->attributes[a].name, 1), mesh->attributes[a].values,
               mesh->vertex_count * sizeof(float));
    for (size_t i = 0; i < s->count; i++)
    {
        uint32_t fresh = mesh->vertex_count + (uint32_t)i;
        uint32_t* corner = &out->triangles[s->items[i].triangle][s->items[i].corner];
        out->positions[fresh] = mesh->positions[*corner];
        out->normals[fresh] = mesh->normals[*corner];
        out->uvs[fresh] = s->items[i].uv;
        for (int a = 0; a < mesh->attribute_count; a++)
            out->attributes[a].values[fresh] = mesh->attributes[a].values[*corner];
        *corner = fresh;
    }
    return out;
}

// The mean of the principal curvatures as an attribute, 1/m: 1 / (2 r) on a straight root, below 0 where roots meet.
static void curvature_dress(ty_mesh* mesh)
{
    float* mean = ty_mesh_add_attribute(mesh, "curvature", 1);
    ty_mesh_compute_welds(mesh);
    ty_mesh_compute_curvature(mesh, 1);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        mean[v] = 0.5f * (mesh->curvature_1[v] + mesh->curvature_2[v]);
}

// d says on what and by which recipe; *mesh is replaced.
static ty_status dress(dressing d, ty_workers* workers, ty_mesh** mesh, ty_error* error)
{
    d.mesh = *mesh;
    seams s = {0};
    uint32_t count = (*mesh)->vertex_count;
    (*mesh)->uvs = TY_ALLOC(ty_vec2, count);
    d.samples = TY_ALLOC(roots_sample, count);
    d.radius = ty_mesh_add_attribute(*mesh, "radius", 1);
    d.level = ty_mesh_add_attribute(*mesh, "level", 1);
    d.join = ty_mesh_add_attribute(*mesh, "join", 1);
    d.sink = ty_mesh_add_attribute(*mesh, "sink", 1);
    d.root = ty_mesh_add_attribute(*mesh, "root", 1);
    d.along = ty_mesh_add_attribute(*mesh, "along", 1);
    d.age = ty_mesh_add_attribute(*mesh, "age", 1);
    ty_status status = TY_OK;
    if (!ty_parallel_for(workers, count, 1024, vertices_dress, &d))
        status = ty_error_set(error, TY_INTERRUPTED, "interrupted while roots were finished");
    if (status == TY_OK)
    {
        normals_tilt(*mesh, d.samples);
        normals_fill(*mesh);
        curvature_dress(*mesh);
    }
    for (uint32_t t = 0; t < (*mesh)->triangle_count && status == TY_OK; t++)
        triangle_seams(&d, t, &s);
    ty_mesh* done = status == TY_OK && !s.failed ? split(*mesh, &s) : NULL;
    if (status == TY_OK && !done)
        status = ty_error_set(error, TY_NO_MEMORY, "no memory for the seams of roots");
    ty_free(d.samples);
    ty_free(s.items);
    ty_mesh_destroy(*mesh);
    *mesh = done;
    return status;
}

// --- the surface ---

ty_status roots_surface(const ty_roots_recipe* recipe, const roots_network* network, const roots_host* host,
                        ty_workers* workers, roots_skin** skin, ty_mesh** out, ty_error* error)
{
    *out = NULL;
    ty_status status = roots_skin_create(recipe, network, host, skin, error);
    if (status != TY_OK)
        return status;
    status = roots_skin_mesh(*skin, workers, out, error);
    if (status == TY_OK)
    {
        dressing d = {.skin = *skin, .network = network, .host = host, .recipe = recipe};
        status = dress(d, workers, out, error);
    }
    if (status == TY_OK)
    {
        ty_mesh_compute_bounds(*out);
        ty_mesh_compute_welds(*out);
        return TY_OK;
    }
    roots_skin_destroy(*skin);
    *skin = NULL;
    return status;
}
