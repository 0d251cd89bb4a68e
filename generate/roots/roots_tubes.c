// SPDX-License-Identifier: Apache-2.0
// Roots as tubes, one for each line, for other programs: strips of uv, two ends each, nothing welded.
#include "roots_tubes.h"
#include "roots_output.h"
#include <tsuya/base/rec709.h>

enum
{
    NUMBERS = 7, // attributes of one number
};

static const char* const names[NUMBERS] = {"radius", "level", "join", "sink", "root", "along", "age"};

typedef struct corner
{
    ty_vec3 p, n;
    ty_vec2 uv;
    roots_point axis;
    float join;
    int line;
    uint32_t weld; // the first of the same place in its tube
} corner;

typedef struct tubes
{
    tubes_def def;
    corner* corners;
    uint32_t (*triangles)[3];
    size_t count, capacity, triangle_count, triangle_capacity;
    bool failed; // for want of memory
} tubes;

// --- vertices and triangles ---

static uint32_t corner_add(tubes* t, corner c)
{
    if (t->count == t->capacity)
    {
        size_t larger = t->capacity ? 2 * t->capacity : 4096;
        corner* grown = ty_try_grow(t->corners, t->capacity, larger, sizeof(corner));
        t->failed |= !grown;
        if (!grown)
            return 0;
        t->corners = grown;
        t->capacity = larger;
    }
    t->corners[t->count] = c;
    return (uint32_t)t->count++;
}

static void triangle_add(tubes* t, uint32_t a, uint32_t b, uint32_t c)
{
    if (t->triangle_count == t->triangle_capacity)
    {
        size_t larger = t->triangle_capacity ? 2 * t->triangle_capacity : 8192;
        void* grown = ty_try_grow(t->triangles, t->triangle_capacity, larger, sizeof *t->triangles);
        t->failed |= !grown;
        if (!grown)
            return;
        t->triangles = grown;
        t->triangle_capacity = larger;
    }
    uint32_t* out = t->triangles[t->triangle_count++];
    out[0] = a;
    out[1] = b;
    out[2] = c;
}

// --- one tube ---

// Of the surface that vertices and their neighbours along and about span; at the tip of a round end that way.
static ty_vec3 normal_at(const tubes* t, const tube_ring* rings, int count, int i, int k)
{
    int n = t->def.divisions;
    const tube_ring *before = &rings[i > 0 ? i - 1 : i], *after = &rings[i + 1 < count ? i + 1 : i];
    if (rings[i].at.r == 0.0f)
        return rings[i].t;
    ty_vec3 about = ty_sub(tube_vertex(&t->def, &rings[i], k + 1), tube_vertex(&t->def, &rings[i], k + n - 1));
    ty_vec3 along = ty_sub(tube_vertex(&t->def, after, k), tube_vertex(&t->def, before, k));
    ty_vec3 normal = ty_cross(about, along);
    ty_vec3 out = ty_sub(tube_vertex(&t->def, &rings[i], k), rings[i].at.p);
    return ty_length_sqr(normal) > 0.0f ? ty_normalize(normal) : ty_normalize(out);
}

static void strips_add(tubes* t, int line, const tube_ring* rings, int count)
{
    uint32_t n = (uint32_t)t->def.divisions, begin = (uint32_t)t->count;
    for (int i = 0; i < count; i++)
        for (int k = 0; k <= (int)n; k++)
            corner_add(t,
                       (corner){.weld = begin + (uint32_t)i * (n + 1) + (rings[i].at.r == 0.0f ? 0 : (uint32_t)k % n),
                                .p = tube_vertex(&t->def, &rings[i], k),
                                .n = normal_at(t, rings, count, i, k % (int)n),
                                .uv = {(float)k / (float)n, rings[i].v},
                                .axis = rings[i].axis,
                                .join = rings[i].join,
                                .line = line});
    for (int i = 0; i + 1 < count; i++)
        for (uint32_t k = 0; k < n; k++)
        {
            uint32_t a = begin + (uint32_t)i * (n + 1) + k, d = a + n + 1;
            triangle_add(t, a, a + 1, rings[i + 1].at.r == 0.0f ? d : d + 1);
            if (rings[i + 1].at.r > 0.0f)
                triangle_add(t, a, d + 1, d);
        }
}

// A flat end on the ring whose first vertex is given; uv is a disc as large as the surface beside it has it.
static void lid_add(tubes* t, int line, const tube_ring* ring, uint32_t first, bool end)
{
    int n = t->def.divisions;
    ty_vec3 middle = {0.0f, 0.0f, 0.0f}, out = ty_mul(ring->t, end ? 1.0f : -1.0f);
    float v = ring->v + (end ? 0.25f : -0.25f);
    uint32_t rim = (uint32_t)t->count;
    corner c = {.n = out, .axis = ring->axis, .join = ring->join, .line = line};
    for (int k = 0; k < n; k++)
    {
        float sine, cosine;
        ty_sincos(2.0f * TY_PI * (float)k / (float)n, &sine, &cosine);
        c.p = tube_vertex(&t->def, ring, k);
        c.uv = (ty_vec2){0.5f + cosine * (0.5f / TY_PI), v + (end ? sine : -sine) * (0.5f / TY_PI)};
        c.weld = first + (uint32_t)k;
        middle = ty_add(middle, c.p);
        corner_add(t, c);
    }
    c.p = ty_mul(middle, 1.0f / (float)n);
    c.uv = (ty_vec2){0.5f, v};
    c.weld = (uint32_t)t->count;
    uint32_t center = corner_add(t, c);
    for (uint32_t k = 0; k < (uint32_t)n; k++)
    {
        uint32_t a = rim + k, b = rim + (k + 1) % (uint32_t)n;
        triangle_add(t, center, end ? a : b, end ? b : a);
    }
}

static void tube_add(tubes* t, int line, tube_ring* rings)
{
    int count = tube_rings(&t->def, line, rings);
    if (count < 2)
        return;
    uint32_t begin = (uint32_t)t->count, last = (uint32_t)((count - 1) * (t->def.divisions + 1));
    strips_add(t, line, rings, count);
    lid_add(t, line, &rings[0], begin, false);
    if (rings[count - 1].at.r > 0.0f)
        lid_add(t, line, &rings[count - 1], begin + last, true);
}

// --- the mesh ---

static void color_set(ty_mesh* mesh, ty_rgb color)
{
    ty_rgb c = ty_rgb_to_rec709(color);
    float* values = ty_mesh_add_attribute(mesh, "color", 3);
    mesh->attributes[mesh->attribute_count - 1].space = TY_ATTRIBUTE_LINEAR_SRGB;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        values[3 * v] = ty_max(c.r, 0.0f);
        values[3 * v + 1] = ty_max(c.g, 0.0f);
        values[3 * v + 2] = ty_max(c.b, 0.0f);
    }
}

static void mesh_fill(const tubes* t, ty_mesh* mesh, roots_point* axes)
{
    float* values[NUMBERS];
    mesh->uvs = TY_ALLOC(ty_vec2, t->count);
    mesh->welds = TY_ALLOC(uint32_t, t->count);
    for (int i = 0; i < NUMBERS; i++)
        values[i] = ty_mesh_add_attribute(mesh, names[i], 1);
    for (size_t v = 0; v < t->count; v++)
    {
        const corner* c = &t->corners[v];
        const float numbers[NUMBERS] = {c->axis.r,      (float)roots_level(t->def.network->lines[c->line].kind),
                                        c->join,        c->axis.sink,
                                        (float)c->line, c->axis.s,
                                        c->axis.birth};
        mesh->positions[v] = c->p;
        mesh->normals[v] = c->n;
        mesh->uvs[v] = c->uv;
        mesh->welds[v] = c->weld;
        for (int i = 0; i < NUMBERS; i++)
            values[i][v] = numbers[i];
        if (axes)
            axes[v] = c->axis;
    }
    for (size_t i = 0; i < t->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            mesh->triangles[i][k] = t->triangles[i][k];
    color_set(mesh, t->def.recipe->tubes.color);
    ty_mesh_compute_bounds(mesh);
}

static tubes_def def_make(const ty_roots_recipe* recipe, const roots_network* network, int level)
{
    int divisions = recipe->tubes.divisions >> level;
    tubes_def def = {.recipe = recipe, .network = network, .thesis = recipe->method == TY_ROOTS_SEED && level == 0};
    def.divisions = divisions > 3 ? divisions : 3;
    def.sag = 1.0f - ty_cos(TY_PI / (float)def.divisions);
    def.longest = 8.0f * (float)(1 << level);
    return def;
}

// Of ours; the thesis' roots lie as they lie.
typedef struct holding
{
    const roots_host* host;
    tubes* tubes;
} holding;

static void corners_keep(void* context, int64_t begin, int64_t end, int worker)
{
    const holding* h = context;
    (void)worker;
    for (int64_t v = begin; v < end; v++)
    {
        corner* c = &h->tubes->corners[v];
        if (h->tubes->def.network->lines[c->line].kind != ROOTS_TRUNK) // stands in it
            roots_host_keep(h->host, c->axis.sink * c->axis.r, &c->p);
    }
}

ty_status roots_tubes_make(const ty_roots_recipe* recipe, const roots_network* network, const roots_host* host,
                           int level, ty_workers* workers, ty_mesh** out, roots_point** axes, ty_error* error)
{
    int most = 2;
    tubes t = {.def = def_make(recipe, network, level)};
    *out = NULL;
    for (int l = 0; l < network->line_count; l++)
        most = network->lines[l].count > most ? network->lines[l].count : most;
    tube_ring* rings = TY_TRY_ALLOC(tube_ring, (int64_t)most + TUBE_CAP);
    t.failed = !rings;
    for (int l = 0; l < network->line_count && !t.failed; l++)
        tube_add(&t, l, rings);
    if (recipe->method != TY_ROOTS_SEED && !t.failed)
        ty_parallel_all(workers, (int64_t)t.count, 256, corners_keep, &(holding){host, &t});
    bool fits = !t.failed && t.count < UINT32_MAX && t.triangle_count < UINT32_MAX;
    if (fits && t.triangle_count > 0)
        *out = ty_mesh_create((uint32_t)t.count, (uint32_t)t.triangle_count);
    if (*out && axes)
        *axes = TY_TRY_ALLOC(roots_point, t.count);
    if (*out && (!axes || *axes))
        mesh_fill(&t, *out, axes ? *axes : NULL);
    else
    {
        ty_mesh_destroy(*out);
        *out = NULL;
    }
    bool none = !t.failed && t.triangle_count == 0;
    ty_free(rings);
    ty_free(t.corners);
    ty_free(t.triangles);
    if (*out)
        return TY_OK;
    return none ? ty_error_set(error, TY_BAD_INPUT, "not a single root could be grown")
                : ty_error_set(error, TY_NO_MEMORY, "no memory for the tubes of %d points", network->point_count);
}
