// SPDX-License-Identifier: Apache-2.0
// Which vertices of an aggregate's bodies lie within other bodies, or near them.
#include "aggregate_facets.h"
#include <stdlib.h>
#include <string.h>

// --- bodies ---

static ty_bounds box_of(const ty_vec3* positions, uint32_t count, float margin)
{
    ty_bounds box = ty_bounds_empty();
    for (uint32_t v = 0; v < count; v++)
        box = ty_bounds_add(box, positions[v]);
    const ty_vec3 more = {margin, margin, margin};
    return (ty_bounds){ty_sub(box.low, more), ty_add(box.high, more)};
}

static ty_status world_make(facet_scene* f, uint32_t* prototypes, ty_error* error)
{
    ty_world_def def = ty_world_def_default();
    ty_status status = ty_world_create(&def, &f->world, error);
    for (int p = 0; p < f->aggregate->prototype_count && status == TY_OK; p++)
    {
        ty_mesh_topology topology;
        ty_mesh_analyse(f->aggregate->prototypes[p], &topology);
        if (!topology.closed)
            return ty_error_set(error, TY_BAD_INPUT, "prototype %d is not closed: contact facets need closed meshes",
                                p);
        f->areas[p] = ty_mesh_vertex_areas(f->aggregate->prototypes[p]);
        status = ty_world_add_prototype(f->world, f->aggregate->prototypes[p], &prototypes[p], error);
    }
    return status == TY_OK ? ty_world_commit(f->world, error) : status;
}

static ty_status bodies_make(facet_scene* f, ty_error* error)
{
    const ty_aggregate* a = f->aggregate;
    uint32_t* prototypes = TY_ALLOC(uint32_t, a->prototype_count);
    ty_status status = world_make(f, prototypes, error);
    uint32_t first = 0;
    for (uint32_t i = 0; i < a->instance_count && status == TY_OK; i++)
    {
        facet_body* b = &f->bodies[i];
        b->shape = a->prototypes[a->prototype_index[i]];
        b->areas = f->areas[a->prototype_index[i]];
        b->prototype = prototypes[a->prototype_index[i]];
        b->first = first;
        b->place = a->transforms[i];
        if (!ty_affine_invert(&b->place, &b->back))
            status = ty_error_set(error, TY_BAD_INPUT, "instance %u: its matrix is singular", i);
        b->box = box_of(f->mesh->positions + first, b->shape->vertex_count, f->def.close);
        f->widest = ty_max(f->widest, b->box.high.x - b->box.low.x);
        first += b->shape->vertex_count;
    }
    ty_free(prototypes);
    return status;
}

// --- neighbours ---

static int box_order(const void* a, const void* b)
{
    const facet_order *p = a, *q = b;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    return p->body < q->body ? -1 : p->body > q->body;
}

static bool boxes_meet(const ty_bounds* a, const ty_bounds* b)
{
    return a->low.x <= b->high.x && b->low.x <= a->high.x && a->low.y <= b->high.y && b->low.y <= a->high.y &&
           a->low.z <= b->high.z && b->low.z <= a->high.z;
}

// The first in order whose box begins at x or beyond.
static uint32_t order_at(const facet_scene* f, float x)
{
    uint32_t low = 0, high = f->count;
    while (low < high)
    {
        uint32_t middle = low + (high - low) / 2;
        if (f->order[middle].low < x)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// --- hits ---

static void hit_push(facet_body* body, const facet_hit* hit)
{
    if (body->hit_count == body->hit_capacity)
    {
        int grown = 2 * body->hit_capacity + 32;
        body->hits = ty_grow(body->hits, (size_t)body->hit_capacity, (size_t)grown, sizeof *body->hits);
        body->hit_capacity = grown;
    }
    body->hits[body->hit_count++] = *hit;
}

static bool in_box(const ty_bounds* b, ty_vec3 p)
{
    return p.x >= b->low.x && p.x <= b->high.x && p.y >= b->low.y && p.y <= b->high.y && p.z >= b->low.z &&
           p.z <= b->high.z;
}

// Whether all of a's vertices lie within b, found by the first that does not.
static bool lies_within(const facet_scene* f, const facet_body* a, const facet_body* b)
{
    for (uint32_t v = 0; v < a->shape->vertex_count; v++)
    {
        ty_vec3 own = ty_map_point(&b->back, f->mesh->positions[a->first + v]);
        if (!in_box(&b->shape->bounds, own) || !ty_world_inside(f->world, b->prototype, own))
            return false;
    }
    return true;
}

static void vertex_look(const facet_scene* f, facet_body* body, uint32_t vertex, uint32_t other)
{
    const facet_body* b = &f->bodies[other];
    ty_vec3 x = f->mesh->positions[body->first + vertex];
    if (!in_box(&b->box, x))
        return;
    ty_vec3 own = ty_map_point(&b->back, x);
    bool inside = in_box(&b->shape->bounds, own) && ty_world_inside(f->world, b->prototype, own);
    facet_hit hit = {.vertex = vertex, .other = other};
    if ((!inside && f->def.close <= 0.0f) || !ty_world_closest(f->world, b->prototype, own, TY_FLOAT_MAX, &hit.closest))
        return;
    hit.surface = ty_map_point(&b->place, hit.closest.position);
    float distance = ty_length(ty_sub(x, hit.surface));
    hit.depth = inside ? distance : -distance;
    if (distance > 1e-9f && hit.depth > -f->def.close)
        hit_push(body, &hit);
}

typedef void facet_pair_fn(const facet_scene* f, uint32_t i, uint32_t j);

static void each_neighbour(const facet_scene* f, uint32_t i, facet_pair_fn* fn)
{
    const ty_bounds* box = &f->bodies[i].box;
    for (uint32_t k = order_at(f, box->low.x - f->widest); k < f->count; k++)
    {
        uint32_t j = f->order[k].body;
        if (f->order[k].low > box->high.x)
            return;
        if (j != i && boxes_meet(box, &f->bodies[j].box))
            fn(f, i, j);
    }
}

static void pair_nest(const facet_scene* f, uint32_t i, uint32_t j)
{
    facet_body *a = &f->bodies[i], *b = &f->bodies[j];
    if (!a->inner && in_box(&b->box, a->box.low) && in_box(&b->box, a->box.high))
        a->inner = lies_within(f, a, b);
}

static void pair_look(const facet_scene* f, uint32_t i, uint32_t j)
{
    facet_body* body = &f->bodies[i];
    if (body->inner || f->bodies[j].inner)
        return;
    for (uint32_t v = 0; v < body->shape->vertex_count; v++)
        vertex_look(f, body, v, j);
}

static void bodies_nest(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    for (int64_t i = begin; i < end; i++)
        each_neighbour(context, (uint32_t)i, pair_nest);
}

static void bodies_look(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    for (int64_t i = begin; i < end; i++)
        each_neighbour(context, (uint32_t)i, pair_look);
}

ty_status facets_begin(facet_scene* f, ty_workers* workers, ty_error* error)
{
    ty_status status = ty_aggregate_realise(f->aggregate, &f->mesh, error);
    if (status != TY_OK)
        return status;
    f->count = f->aggregate->instance_count;
    f->areas = TY_ALLOC(double*, f->aggregate->prototype_count);
    f->bodies = TY_TRY_ALLOC(facet_body, f->count);
    f->order = TY_TRY_ALLOC(facet_order, f->count);
    f->before = TY_TRY_ALLOC(ty_vec3, f->mesh->vertex_count);
    f->from = TY_TRY_ALLOC(ty_vec3, f->mesh->vertex_count);
    if (!f->bodies || !f->order || !f->before || !f->from)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for the contacts of %u instances", f->count);
    memcpy(f->before, f->mesh->positions, f->mesh->vertex_count * sizeof *f->before);
    status = bodies_make(f, error);
    if (status != TY_OK)
        return status;
    for (uint32_t i = 0; i < f->count; i++)
        f->order[i] = (facet_order){f->bodies[i].box.low.x, i};
    qsort(f->order, f->count, sizeof *f->order, box_order);
    ty_parallel_all(workers, f->count, 16, bodies_nest, f);
    ty_parallel_all(workers, f->count, 16, bodies_look, f);
    return TY_OK;
}

void facets_end(facet_scene* f)
{
    for (uint32_t i = 0; i < f->count && f->bodies; i++)
        ty_free(f->bodies[i].hits);
    ty_free(f->bodies);
    for (int p = 0; p < f->aggregate->prototype_count && f->areas; p++)
        ty_free(f->areas[p]);
    ty_free(f->areas);
    ty_free(f->order);
    ty_free(f->before);
    ty_free(f->from);
    ty_mesh_destroy(f->mesh);
    ty_world_destroy(f->world);
}
