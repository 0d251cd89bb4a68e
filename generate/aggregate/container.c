// SPDX-License-Identifier: Apache-2.0
// Containers as sampled distance fields: a half-plane table for turned shapes, a grid for meshes, planes for the box.
#include "closed_mesh.h"
#include "container_state.h"
#include "hollow.h"
#include <string.h>

enum
{
    FINE = 256, // divisions of the shape that is sampled: its facets are not to be felt
};

ty_container_def ty_container_def_default(void)
{
    ty_container_def def = {.kind = TY_CONTAINER_BOWL, .mesh = NULL, .shape = ty_shape_def_default()};
    def.cut = (ty_cut_def){.radius = 0.02f, .normal = {0.0f, 0.0f, 1.0f}};
    def.onigiri = (ty_onigiri_def){0.088f, 0.036f, 0.017f, 0.012f};
    def.shape.kind = TY_SHAPE_BOWL;
    return def;
}

bool ty_container_is_open(const ty_container* c)
{
    return c->def.kind == TY_CONTAINER_BOWL || is_planes(c) || c->def.kind == TY_CONTAINER_GROUND || is_vessel(c);
}

bool ty_container_is_turned(const ty_container* c)
{
    return is_turned(c);
}

bool ty_cut_takes(const ty_cut_def* cut, ty_vec3 p)
{
    ty_vec3 d = ty_sub(p, cut->center);
    if (cut->kind == TY_CUT_SPHERE)
        return ty_length_sqr(d) < ty_sqr(cut->radius);
    return cut->kind == TY_CUT_PLANE && ty_dot(d, cut->normal) > 0.0f;
}

float ty_container_widest(const ty_container* c)
{
    return c->widest;
}

ty_bounds ty_container_interior(const ty_container* c)
{
    return c->interior;
}

// --- lookup ---

// Cell and fraction of a coordinate; what lies outside of the table is clamped and adds to *beyond.
static int cell_of(float x, int size, float step, float* fraction, float* beyond)
{
    float clamped = ty_clamp(x, 0.0f, (float)(size - 1));
    *beyond += fabsf(x - clamped) * step;
    int i = (int)clamped;
    if (i > size - 2)
        i = size > 1 ? size - 2 : 0;
    *fraction = size > 1 ? clamped - (float)i : 0.0f;
    return i;
}

static float field_lookup(const ty_container* c, ty_vec3 q, ty_vec3* normal)
{
    float f[3], beyond = 0.0f;
    int i = cell_of((q.x - c->origin.x) / c->step, c->size[0], c->step, &f[0], &beyond);
    int j = cell_of((q.y - c->origin.y) / c->step, c->size[1], c->step, &f[1], &beyond);
    int k = c->size[2] > 1 ? cell_of((q.z - c->origin.z) / c->step, c->size[2], c->step, &f[2], &beyond) : 0;
    int corners = c->size[2] > 1 ? 8 : 4;
    float gap = 0.0f;
    ty_vec3 n = {0.0f, 0.0f, 0.0f};
    for (int e = 0; e < corners; e++)
    {
        float w = (e & 1 ? f[0] : 1.0f - f[0]) * (e & 2 ? f[1] : 1.0f - f[1]);
        if (corners == 8)
            w *= e & 4 ? f[2] : 1.0f - f[2];
        const node* at = node_at(c, i + (e & 1), j + (e >> 1 & 1), k + (e >> 2));
        gap += w * at->gap;
        n = ty_mad(n, at->normal, w);
    }
    *normal = ty_normalize(n);
    return gap + beyond;
}

static float turned_wall(const ty_container* c, ty_vec3 p, ty_vec3* normal)
{
    float rho = sqrtf(p.x * p.x + p.z * p.z);
    ty_vec3 n;
    if (c->def.kind == TY_CONTAINER_BOWL && rho > (float)(c->size[0] - 1) * c->step) // beside it the table goes on
    {
        *normal = ty_vec3_make(0.0f, 1.0f, 0.0f);
        return p.y;
    }
    float gap = field_lookup(c, ty_vec3_make(rho, p.y, 0.0f), &n);
    float s = rho > 1e-9f ? n.x / rho : 0.0f;
    *normal = ty_normalize(ty_vec3_make(p.x * s, n.y, p.z * s));
    return gap;
}

static float box_wall(const ty_container* c, int wall, ty_vec3 p, ty_vec3* normal)
{
    ty_vec3 h = c->def.shape.size;
    float side = wall & 1 ? 1.0f : -1.0f;
    switch (wall)
    {
    case 0:
        *normal = ty_vec3_make(0.0f, 1.0f, 0.0f);
        return p.y + h.y;
    case 1:
    case 2:
        *normal = ty_vec3_make(-side, 0.0f, 0.0f);
        return h.x - side * p.x;
    default:
        *normal = ty_vec3_make(0.0f, 0.0f, -side);
        return h.z - side * p.z;
    }
}

int ty_container_wall_count(const ty_container* c)
{
    return is_planes(c) ? 5 : 1;
}

float ty_container_wall(const ty_container* c, int wall, ty_vec3 p, ty_vec3* normal)
{
    if (is_planes(c))
        return box_wall(c, wall, p, normal);
    if (c->def.kind == TY_CONTAINER_GROUND)
    {
        *normal = ty_vec3_make(0.0f, 1.0f, 0.0f);
        return p.y - c->def.ground;
    }
    return is_turned(c) ? turned_wall(c, p, normal) : field_lookup(c, p, normal);
}

// A node about p is one of the hollow; above the rim, one of its last row.
static bool hollow_holds(const ty_container* c, ty_vec3 p)
{
    float f[3], beyond = 0.0f;
    p.y = ty_min(p.y, c->interior.high.y - c->step);
    int i = cell_of((p.x - c->origin.x) / c->step, c->size[0], c->step, &f[0], &beyond);
    int j = cell_of((p.y - c->origin.y) / c->step, c->size[1], c->step, &f[1], &beyond);
    int k = cell_of((p.z - c->origin.z) / c->step, c->size[2], c->step, &f[2], &beyond);
    for (int e = 0; e < 8; e++)
        if (c->hollow[node_at(c, i + (e & 1), j + (e >> 1 & 1), k + (e >> 2)) - c->nodes])
            return beyond <= 0.0f;
    return false;
}

bool ty_container_holds(const ty_container* c, ty_vec3 p)
{
    ty_vec3 n;
    if (c->def.kind == TY_CONTAINER_GROUND)
        return p.y > c->def.ground && p.x * p.x + p.z * p.z < ty_sqr(c->def.shape.radius);
    if (is_vessel(c) && !hollow_holds(c, p))
        return false;
    if (c->def.kind == TY_CONTAINER_MESH || c->def.kind == TY_CONTAINER_ONIGIRI)
        return field_lookup(c, p, &n) > 0.0f;
    return ty_shape_interior_distance(&c->def.shape, p) < 0.0f;
}

bool ty_container_lost(const ty_container* c, ty_vec3 p)
{
    float rho = p.x * p.x + p.z * p.z;
    if (is_vessel(c))
        return p.x < c->outside.low.x || p.x > c->outside.high.x || p.z < c->outside.low.z || p.z > c->outside.high.z;
    if (c->def.kind == TY_CONTAINER_GROUND) // rolls on where nothing holds it
        return rho > ty_sqr(6.0f * c->def.shape.radius);
    return c->def.kind == TY_CONTAINER_BOWL && rho > ty_sqr(c->def.shape.radius);
}

// --- creation ---

// How far the hollow reaches from a point of the axis in it, along direction, up to limit; by bisection.
static float hollow_reach(const ty_shape_def* shape, ty_vec3 from, ty_vec3 direction, float limit)
{
    float low = 0.0f, high = limit;
    for (int i = 0; i < 40; i++)
    {
        float middle = 0.5f * (low + high);
        bool in = ty_shape_interior_distance(shape, ty_mad(from, direction, middle)) < 0.0f;
        *(in ? &low : &high) = middle;
    }
    return low;
}

// The hollow below the rim: its depth on the axis, and its width just below the rim.
static ty_bounds bowl_interior(const ty_shape_def* shape, ty_bounds outside)
{
    float height = outside.high.y - outside.low.y, step = height / 512.0f, rim = outside.high.y;
    while (rim > outside.low.y && ty_shape_interior_distance(shape, ty_vec3_make(0.0f, rim - step, 0.0f)) >= 0.0f)
        rim -= step;
    ty_vec3 top = {0.0f, rim - step, 0.0f};
    float depth = hollow_reach(shape, top, ty_vec3_make(0.0f, -1.0f, 0.0f), height);
    float radius = hollow_reach(shape, top, ty_vec3_make(1.0f, 0.0f, 0.0f), shape->radius);
    return (ty_bounds){{-radius, top.y - depth, -radius}, {radius, rim, radius}};
}

// The hollow of a vessel, from the sampled distances, and what fits in it.
static ty_status vessel_find(ty_container* c, ty_error* error)
{
    size_t nodes = (size_t)c->size[0] * (size_t)c->size[1] * (size_t)c->size[2];
    bool* empty = TY_TRY_ALLOC(bool, nodes);
    c->hollow = TY_TRY_ALLOC(bool, nodes);
    if (!empty || !c->hollow)
    {
        ty_free(empty);
        return ty_error_set(error, TY_NO_MEMORY, "no memory for the hollow of the container");
    }
    for (size_t i = 0; i < nodes; i++)
        empty[i] = c->nodes[i].gap > 0.0f;
    int rim = ty_hollow_find(empty, c->size, c->hollow);
    ty_free(empty);
    if (rim < 0)
        return ty_error_set(
            error, TY_BAD_INPUT,
            "container.mesh: %s holds nothing: with role vessel it is a wall thicker than %.3g mm about a "
            "hollow that is open at the top",
            c->def.mesh, (double)c->step * 1e3);
    c->interior = ty_bounds_empty();
    for (size_t i = 0; i < nodes; i++)
        if (c->hollow[i])
        {
            size_t x = i % (size_t)c->size[0], y = i / (size_t)c->size[0] % (size_t)c->size[1];
            ty_vec3 at = {(float)x, (float)y, (float)(i / ((size_t)c->size[0] * (size_t)c->size[1]))};
            c->interior = ty_bounds_add(c->interior, ty_mad(c->origin, at, c->step));
        }
    return TY_OK;
}

static void widest_find(ty_container* c)
{
    ty_vec3 size = ty_sub(c->interior.high, c->interior.low);
    c->widest = 0.5f * ty_min(size.x, size.z);
    if (ty_container_is_open(c))
        return;
    c->widest = ty_min(c->widest, 0.5f * size.y);
    if (c->def.kind != TY_CONTAINER_MESH && c->def.kind != TY_CONTAINER_ONIGIRI)
        return;
    c->widest = 0.0f;
    for (size_t i = 0; i < (size_t)c->size[0] * (size_t)c->size[1] * (size_t)c->size[2]; i++)
        c->widest = ty_max(c->widest, c->nodes[i].gap);
}

// mesh: NULL where a formula tells the distance.
static ty_status container_sample(ty_container* c, const ty_mesh* mesh, ty_workers* workers, ty_error* error)
{
    if (mesh)
    {
        c->outside = mesh->bounds;
        c->interior = c->def.kind == TY_CONTAINER_BOWL ? bowl_interior(&c->def.shape, mesh->bounds) : mesh->bounds;
    }
    ty_status status = TY_OK;
    if (!is_planes(c))
        status = container_field_sample(c, c->def.kind == TY_CONTAINER_BOX ? NULL : mesh, workers, error);
    if (status == TY_OK && is_vessel(c))
        status = vessel_find(c, error);
    return status;
}

static const int shape_kinds[] = {TY_SHAPE_BOWL, TY_SHAPE_BOX, TY_SHAPE_SPHERE, TY_SHAPE_DOME};

static ty_status shape_make(ty_container* c, ty_mesh** mesh, ty_error* error)
{
    if (c->def.kind == TY_CONTAINER_MESH)
        return closed_mesh_read("container", "shape mesh", c->def.mesh, mesh, error);
    if (c->def.kind == TY_CONTAINER_ONIGIRI)
    {
        c->interior = c->outside = onigiri_bounds(&c->def.onigiri);
        return onigiri_check(&c->def.onigiri, error);
    }
    c->def.shape.kind = shape_kinds[c->def.kind];
    c->def.shape.divisions = c->def.shape.divisions > FINE ? c->def.shape.divisions : FINE;
    ty_error impossible;
    ty_status status = ty_shape_create(&c->def.shape, mesh, &impossible);
    return status == TY_OK ? status : ty_error_set(error, status, "container.%s", impossible.text);
}

static ty_status ground_make(ty_container* c, ty_error* error)
{
    float r = c->def.shape.radius, y = c->def.ground;
    c->interior = (ty_bounds){{-r, y, -r}, {r, y, r}};
    return r > 0.0f ? TY_OK : ty_error_set(error, TY_BAD_INPUT, "container.radius: %g; it is above 0", (double)r);
}

ty_status ty_container_create(const ty_container_def* def, ty_workers* workers, ty_container** out, ty_error* error)
{
    *out = NULL;
    if (def->role == TY_CONTAINER_MOULD && (def->kind == TY_CONTAINER_BOWL || def->kind == TY_CONTAINER_GROUND))
        return ty_error_set(error, TY_BAD_INPUT,
                            "container.role: a mould is closed: take box, sphere, dome, onigiri or mesh");
    ty_container* c = TY_ALLOC(ty_container, 1);
    c->def = *def;
    ty_mesh* mesh = NULL;
    ty_status status;
    if (def->kind == TY_CONTAINER_GROUND)
        status = ground_make(c, error);
    else
    {
        status = shape_make(c, &mesh, error);
        if (status == TY_OK)
            status = container_sample(c, mesh, workers, error);
    }
    if (status == TY_OK)
        widest_find(c);
    ty_mesh_destroy(mesh);
    if (status == TY_OK)
        *out = c;
    else
        ty_container_destroy(c);
    return status;
}

void ty_container_destroy(ty_container* c)
{
    if (!c)
        return;
    ty_free(c->nodes);
    ty_free(c->hollow);
    ty_free(c);
}
