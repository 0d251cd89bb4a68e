// SPDX-License-Identifier: Apache-2.0
// Gaussian averages of per-vertex fields over a surface.
#include <stdlib.h>
#include <tsuya/geometry/mesh.h>

// Vertices within a fine cell of half the width act as one source at their centre, so that a dense mesh or a large
// width costs no more than some hundred sources a vertex. Fine cells lie in coarse ones as wide as the cut.
enum
{
    fine_per_coarse = 6,    // coarse = 3 widths
    coarse_limit = 1 << 18, // cells an axis, so that a key fits 64 bits
    fields_limit = 2
};

typedef struct cell
{
    uint64_t coarse; // (z * coarse_limit + y) * coarse_limit + x, each from 1
    uint32_t fine;
    uint32_t vertex;
} cell;

typedef struct source
{
    uint64_t coarse;
    double x, y, z, area;
    double value[fields_limit];
} source;

typedef struct source_set
{
    source* items; // by coarse cell
    size_t count;
    ty_vec3 low;
    double fine_size, width;
    int field_count;
} source_set;

static int compare_cells(const void* a, const void* b)
{
    const cell *p = a, *q = b;
    if (p->coarse != q->coarse)
        return p->coarse < q->coarse ? -1 : 1;
    if (p->fine != q->fine)
        return p->fine < q->fine ? -1 : 1;
    return p->vertex < q->vertex ? -1 : p->vertex > q->vertex;
}

static uint64_t coarse_key(const uint64_t c[3])
{
    return (c[2] * coarse_limit + c[1]) * coarse_limit + c[0];
}

static cell locate(const source_set* set, ty_vec3 p, uint32_t vertex)
{
    const double most = (double)(coarse_limit - 3) * fine_per_coarse;
    double d[3] = {(double)p.x - set->low.x, (double)p.y - set->low.y, (double)p.z - set->low.z};
    uint64_t coarse[3];
    uint32_t fine = 0;
    for (int k = 0; k < 3; k++)
    {
        uint64_t at = (uint64_t)fmin(floor(d[k] / set->fine_size), most);
        coarse[k] = at / fine_per_coarse + 1;
        fine = fine * fine_per_coarse + (uint32_t)(at % fine_per_coarse);
    }
    return (cell){coarse_key(coarse), fine, vertex};
}

double* ty_mesh_vertex_areas(const ty_mesh* mesh)
{
    double* areas = TY_ALLOC(double, mesh->vertex_count);
    for (size_t t = 0; t < mesh->triangle_count; t++)
    {
        const uint32_t* c = mesh->triangles[t];
        ty_vec3 p = mesh->positions[c[0]];
        ty_vec3 cross = ty_cross(ty_sub(mesh->positions[c[1]], p), ty_sub(mesh->positions[c[2]], p));
        for (int k = 0; k < 3; k++)
            areas[c[k]] += (double)ty_length(cross) / 6.0;
    }
    return areas;
}

static void sources_init(source_set* set, const ty_mesh* mesh, float* const* fields, int field_count, float width)
{
    ty_bounds bounds = ty_bounds_empty();
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        bounds = ty_bounds_add(bounds, mesh->positions[i]);
    *set = (source_set){.low = bounds.low,
                        .width = (double)width,
                        .fine_size = 3.0 * (double)width / fine_per_coarse,
                        .field_count = field_count};
    cell* cells = TY_ALLOC(cell, mesh->vertex_count);
    double* areas = ty_mesh_vertex_areas(mesh);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        cells[i] = locate(set, mesh->positions[i], i);
    qsort(cells, mesh->vertex_count, sizeof(*cells), compare_cells);
    set->items = TY_ALLOC(source, mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        if (i == 0 || cells[i].coarse != cells[i - 1].coarse || cells[i].fine != cells[i - 1].fine)
            set->items[set->count++].coarse = cells[i].coarse;
        source* s = &set->items[set->count - 1];
        ty_vec3 p = mesh->positions[cells[i].vertex];
        double area = areas[cells[i].vertex];
        s->x += area * (double)p.x;
        s->y += area * (double)p.y;
        s->z += area * (double)p.z;
        for (int f = 0; f < field_count; f++)
            s->value[f] += area * (double)fields[f][cells[i].vertex];
        s->area += area;
    }
    for (size_t i = 0; i < set->count; i++)
    {
        source* s = &set->items[i];
        double inverse = s->area > 0.0 ? 1.0 / s->area : 0.0;
        s->x *= inverse;
        s->y *= inverse;
        s->z *= inverse;
        for (int f = 0; f < field_count; f++)
            s->value[f] *= inverse;
    }
    ty_free(areas);
    ty_free(cells);
}

// The first source of a coarse cell not below key.
static size_t lower_bound(const source_set* set, uint64_t key)
{
    size_t low = 0, high = set->count;
    while (low < high)
    {
        size_t middle = low + (high - low) / 2;
        if (set->items[middle].coarse < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// Three neighbouring coarse cells along x are one stretch of the sorted sources.
static void gather_row(const source_set* set, uint64_t key, ty_vec3 p, double sum[fields_limit], double* weight)
{
    double inverse = 0.5 / (set->width * set->width), cut = 9.0 * set->width * set->width;
    for (size_t i = lower_bound(set, key - 1); i < set->count && set->items[i].coarse <= key + 1; i++)
    {
        const source* s = &set->items[i];
        double x = s->x - (double)p.x, y = s->y - (double)p.y, z = s->z - (double)p.z;
        double d2 = x * x + y * y + z * z;
        if (d2 > cut)
            continue;
        double w = s->area * (double)ty_exp((float)(-d2 * inverse));
        for (int f = 0; f < set->field_count; f++)
            sum[f] += w * s->value[f];
        *weight += w;
    }
}

void ty_mesh_smooth_fields(const ty_mesh* mesh, float* const* fields, int field_count, float width)
{
    TY_ASSERT(field_count >= 1 && field_count <= fields_limit);
    if (!(width > 0.0f) || mesh->vertex_count == 0)
        return;
    source_set set;
    sources_init(&set, mesh, fields, field_count, width);
    const uint64_t first_row = ((uint64_t)coarse_limit + 1) * coarse_limit;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 p = mesh->positions[i];
        uint64_t key = locate(&set, p, i).coarse - first_row;
        double sum[fields_limit] = {0.0}, weight = 0.0;
        for (uint64_t z = 0; z < 3; z++)
            for (uint64_t y = 0; y < 3; y++)
                gather_row(&set, key + (z * coarse_limit + y) * coarse_limit, p, sum, &weight);
        // A vertex far from any area keeps its value.
        for (int f = 0; f < field_count && weight > 0.0; f++)
            fields[f][i] = (float)(sum[f] / weight);
    }
    ty_free(set.items);
}

void ty_mesh_smooth_field(const ty_mesh* mesh, float* field, float width)
{
    ty_mesh_smooth_fields(mesh, &field, 1, width);
}
