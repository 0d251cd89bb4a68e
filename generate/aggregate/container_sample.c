// SPDX-License-Identifier: Apache-2.0
// Samples the distance field of a container, from a mesh or from a formula.
#include "container_state.h"
#include <tsuya/geometry/trace.h>

enum
{
    TURNED_NODES = 224,  // in each direction of the half-plane
    GRID_NODES = 500000, // about, in all
};

typedef struct sampling
{
    ty_container* container;
    const ty_world* world;
    uint32_t prototype;
} sampling;

static void sample_rows(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const sampling* s = context;
    ty_container* c = s->container;
    bool solid = c->def.kind == TY_CONTAINER_BOWL || is_vessel(c); // the mesh is the wall itself, not the space
    float table = is_vessel(c) ? c->outside.low.y : 0.0f;
    for (int64_t row = begin; row < end; row++)
        for (int i = 0; i < c->size[0]; i++)
        {
            int j = (int)(row % c->size[1]), k = (int)(row / c->size[1]);
            ty_vec3 p = ty_add(c->origin, ty_mul(ty_vec3_make((float)i, (float)j, (float)k), c->step));
            float* at = &c->nodes[(size_t)row * (size_t)c->size[0] + (size_t)i].gap;
            if (!s->world)
            {
                *at = -(c->def.kind == TY_CONTAINER_ONIGIRI ? onigiri_distance(&c->def.onigiri, p)
                                                            : ty_shape_interior_distance(&c->def.shape, p));
                continue;
            }
            ty_closest closest = {.distance = 0.0f};
            bool found = ty_world_closest(s->world, s->prototype, p, 1e3f, &closest);
            TY_ASSERT(found);
            float gap = ty_world_inside(s->world, s->prototype, p) == solid ? -closest.distance : closest.distance;
            *at = solid ? ty_min(gap, p.y - table) : gap;
        }
}

static float difference(const ty_container* c, int axis, int i, int j, int k)
{
    int at[3] = {i, j, k}, low[3] = {i, j, k}, high[3] = {i, j, k};
    if (c->size[axis] < 2)
        return 0.0f;
    low[axis] = at[axis] > 0 ? at[axis] - 1 : 0;
    high[axis] = at[axis] < c->size[axis] - 1 ? at[axis] + 1 : at[axis];
    float d = node_at(c, high[0], high[1], high[2])->gap - node_at(c, low[0], low[1], low[2])->gap;
    return d / ((float)(high[axis] - low[axis]) * c->step);
}

static void sample_normals(ty_container* c)
{
    node* out = c->nodes;
    for (int k = 0; k < c->size[2]; k++)
        for (int j = 0; j < c->size[1]; j++)
            for (int i = 0; i < c->size[0]; i++, out++)
            {
                out->normal =
                    ty_vec3_make(difference(c, 0, i, j, k), difference(c, 1, i, j, k), difference(c, 2, i, j, k));
                if (i == 0 && c->size[2] == 1)
                    out->normal.x = 0.0f; // on the axis of a turned shape
            }
}

// Lays the table over the mesh: the half-plane z = 0, x >= 0 of a turned shape, or the whole box.
static void table_place(ty_container* c, ty_bounds b)
{
    ty_vec3 extent = ty_sub(b.high, b.low);
    float pad = 0.06f * ty_max(extent.x, ty_max(extent.y, extent.z));
    if (is_turned(c))
    {
        float width = 0.5f * extent.x + pad, height = extent.y + 2.0f * pad;
        c->step = ty_max(width, height) / (float)(TURNED_NODES - 1);
        c->origin = ty_vec3_make(0.0f, b.low.y - pad, 0.0f);
        c->size[0] = (int)(width / c->step) + 2;
        c->size[1] = (int)(height / c->step) + 2;
        c->size[2] = 1;
        return;
    }
    ty_vec3 size = ty_add(extent, ty_mul(ty_vec3_make(1.0f, 1.0f, 1.0f), 2.0f * pad));
    c->step = ty_pow(size.x * size.y * size.z / (float)GRID_NODES, 1.0f / 3.0f);
    c->origin = ty_sub(b.low, ty_vec3_make(pad, pad, pad));
    c->size[0] = (int)(size.x / c->step) + 2;
    c->size[1] = (int)(size.y / c->step) + 2;
    c->size[2] = (int)(size.z / c->step) + 2;
}

static ty_status mesh_sample(ty_container* c, const ty_mesh* mesh, size_t rows, ty_workers* workers, ty_error* error)
{
    ty_world_def def = ty_world_def_default();
    ty_world* world;
    ty_status status = ty_world_create(&def, &world, error);
    if (status != TY_OK)
        return status;
    sampling s = {c, world, 0};
    status = ty_world_add_prototype(world, mesh, &s.prototype, error);
    if (status == TY_OK)
        status = ty_world_commit(world, error);
    if (status == TY_OK && !ty_parallel_for(workers, (int64_t)rows, 8, sample_rows, &s))
        status = ty_error_set(error, TY_INTERRUPTED, "interrupted while sampling the container");
    if (status == TY_OK)
        sample_normals(c);
    ty_world_destroy(world);
    return status;
}

ty_status container_field_sample(ty_container* c, const ty_mesh* mesh, ty_workers* workers, ty_error* error)
{
    table_place(c, c->outside);
    size_t rows = (size_t)c->size[1] * (size_t)c->size[2];
    c->nodes = TY_TRY_ALLOC(node, rows * (size_t)c->size[0]);
    if (!c->nodes)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for the container's distance field");
    if (!mesh)
    {
        sampling s = {.container = c};
        if (!ty_parallel_for(workers, (int64_t)rows, 8, sample_rows, &s))
            return ty_error_set(error, TY_INTERRUPTED, "interrupted while sampling the container");
        sample_normals(c);
        return TY_OK;
    }
    return mesh_sample(c, mesh, rows, workers, error);
}
