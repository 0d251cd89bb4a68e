// SPDX-License-Identifier: Apache-2.0
// Host, growth, surface, and what a mesh needs besides: one piece, exact positions, normals, uv, attributes.
#include "roots.h"
#include <string.h>
#include <tsuya/base/log.h>

// --- one piece ---

static uint32_t find(uint32_t* parent, uint32_t v)
{
    while (parent[v] != v)
        v = parent[v] = parent[parent[v]];
    return v;
}

// Tips thinner than a cell leave crumbs, and roots may close a hollow in: only the largest surface stays.
static uint32_t largest_piece(const ty_mesh* mesh, uint32_t* parent)
{
    uint32_t* count = TY_ALLOC(uint32_t, mesh->vertex_count);
    uint32_t best = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        parent[v] = v;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 1; k < 3; k++)
        {
            uint32_t a = find(parent, mesh->triangles[t][0]), b = find(parent, mesh->triangles[t][k]);
            parent[a > b ? a : b] = a > b ? b : a;
        }
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        count[find(parent, v)]++;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        best = count[v] > count[best] ? v : best;
    ty_free(count);
    return best;
}

static uint32_t pieces_drop(ty_mesh* mesh)
{
    uint32_t* parent = TY_ALLOC(uint32_t, mesh->vertex_count);
    uint32_t kept = largest_piece(mesh, parent), vertices = 0, triangles = 0, dropped = mesh->triangle_count;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        if (find(parent, mesh->triangles[t][0]) == kept)
            memcpy(mesh->triangles[triangles++], mesh->triangles[t], sizeof(*mesh->triangles));
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        find(parent, v); // afterwards no chain is needed below
    uint32_t* number = TY_ALLOC(uint32_t, mesh->vertex_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (find(parent, v) == kept)
        {
            mesh->positions[vertices] = mesh->positions[v];
            number[v] = vertices++;
        }
    for (uint32_t t = 0; t < triangles; t++)
        for (int k = 0; k < 3; k++)
            mesh->triangles[t][k] = number[mesh->triangles[t][k]];
    ty_free(number);
    ty_free(parent);
    mesh->vertex_count = vertices;
    mesh->triangle_count = triangles;
    return dropped - triangles;
}

// --- what stands at each vertex ---

typedef struct dressing
{
    const roots_skin* skin;
    const roots_lines* lines;
    const ty_roots_recipe* recipe;
    ty_mesh* mesh;
    roots_sample* samples; // [vertex_count]
    float *radius, *level, *join;
} dressing;

static void vertices_dress(void* context, int64_t begin, int64_t end, int worker)
{
    const dressing* d = context;
    (void)worker;
    for (int64_t v = begin; v < end; v++)
    {
        ty_vec3* p = &d->mesh->positions[v];
        ty_vec3 n = roots_skin_normal(d->skin, *p);
        roots_sample sample = roots_skin_at(d->skin, *p);
        // Interpolation along an edge leaves a part of a cell: one step of Newton's, held within the cell.
        float most = 0.2f * d->recipe->detail;
        *p = ty_mad(*p, n, -ty_clamp(sample.distance, -most, most));
        const roots_segment* s = &d->lines->segments[sample.segment];
        d->mesh->normals[v] = n;
        d->mesh->uvs[v] = roots_skin_uv(d->skin, *p, sample);
        d->samples[v] = sample;
        d->radius[v] = ty_lerp(s->a.r, s->b.r, sample.at);
        d->level[v] = (float)s->level;
        d->join[v] = sample.join;
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
    const roots_segment* segments = d->lines->segments;
    int root = segments[d->samples[corner[0]].segment].root;
    ty_vec2 uv[3];
    bool changed[3] = {false, false, false};
    float most = 0.0f;
    for (int k = 0; k < 3; k++)
    {
        uint32_t v = corner[k];
        uv[k] = d->mesh->uvs[v];
        if (segments[d->samples[v].segment].root != root)
        {
            roots_sample sample = roots_skin_root_at(d->skin, d->mesh->positions[v], root);
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

// d says on what and by which recipe; *mesh is replaced.
static ty_status dress(dressing d, ty_workers* workers, ty_mesh** mesh, ty_error* error)
{
    d.mesh = *mesh;
    seams s = {0};
    uint32_t count = (*mesh)->vertex_count;
    (*mesh)->uvs = TY_ALLOC(ty_vec2, count);
    d.samples = TY_ALLOC(roots_sample, count);
    ty_mesh_add_attribute(*mesh, "radius", 1);
    ty_mesh_add_attribute(*mesh, "level", 1);
    ty_mesh_add_attribute(*mesh, "join", 1);
    d.radius = (*mesh)->attributes[0].values;
    d.level = (*mesh)->attributes[1].values;
    d.join = (*mesh)->attributes[2].values;
    ty_status status = TY_OK;
    if (!ty_parallel_for(workers, count, 1024, vertices_dress, &d))
        status = ty_error_set(error, TY_INTERRUPTED, "interrupted while roots were finished");
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

// --- all of it ---

static ty_status recipe_check(const ty_roots_recipe* r, ty_error* error)
{
    if (!(r->tip <= r->radius))
        return ty_error_set(error, TY_BAD_INPUT, "tip: %g mm; it is at most the radius, %g mm", (double)r->tip * 1e3,
                            (double)r->radius * 1e3);
    if (!(r->detail <= r->tip))
        return ty_error_set(error, TY_BAD_INPUT, "detail: %g mm; it is at most the tip, %g mm", (double)r->detail * 1e3,
                            (double)r->tip * 1e3);
    if (!(r->branch.share[0] <= r->branch.share[1]))
        return ty_error_set(error, TY_BAD_INPUT, "branch.share: [%g, %g]; the first is at most the second",
                            (double)r->branch.share[0], (double)r->branch.share[1]);
    return TY_OK;
}

static ty_status surface_make(const ty_roots_recipe* recipe, const roots_lines* lines, ty_workers* workers,
                              ty_mesh** out, ty_error* error)
{
    roots_skin* skin;
    roots_grid grid = {0};
    ty_status status = roots_skin_create(recipe, lines, &skin, error);
    if (status != TY_OK)
        return status;
    status = roots_skin_grid(skin, workers, &grid, error);
    if (status == TY_OK)
        status = roots_march(&grid, out, error);
    ty_free(grid.values);
    if (status == TY_OK)
    {
        uint32_t dropped = pieces_drop(*out);
        ty_log(TY_LOG_DEBUG, "roots: %u triangles of crumbs and hollows left out", dropped);
        dressing d = {.skin = skin, .lines = lines, .recipe = recipe};
        status = dress(d, workers, out, error);
    }
    roots_skin_destroy(skin);
    return status;
}

ty_status ty_roots_make(const void* def, ty_workers* workers, ty_mesh** out, ty_error* error)
{
    const ty_roots_recipe* recipe = def;
    roots_host host;
    roots_lines lines = {0};
    double start = ty_time_now();
    *out = NULL;
    ty_status status = recipe_check(recipe, error);
    if (status == TY_OK)
        status = roots_host_init(&recipe->host, &host, error);
    if (status != TY_OK)
        return status;
    status = roots_grow(recipe, &host, &lines, error);
    double grown = ty_time_now();
    if (status == TY_OK)
        status = surface_make(recipe, &lines, workers, out, error);
    if (status == TY_OK)
    {
        ty_mesh_compute_bounds(*out);
        ty_mesh_compute_welds(*out);
        ty_log(TY_LOG_INFO, "roots: %d roots of %d pieces grown in %.1f s, %u triangles in %.1f s", lines.root_count,
               lines.count, grown - start, (*out)->triangle_count, ty_time_now() - grown);
    }
    roots_lines_term(&lines);
    roots_host_term(&host);
    return status;
}
