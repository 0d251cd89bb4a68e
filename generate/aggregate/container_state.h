// SPDX-License-Identifier: Apache-2.0
// The inside of a container: its distance field and what was found of it.
#pragma once
#include <tsuya/generate/container.h>

typedef struct node
{
    float gap;
    ty_vec3 normal; // turned shapes: (radial, up, 0)
} node;

struct ty_container
{
    ty_container_def def;
    int size[3]; // nodes; size[2] = 1 for turned shapes
    ty_vec3 origin;
    float step;
    node* nodes;
    bool* hollow; // [nodes] of a vessel from a mesh
    ty_bounds interior, outside;
    float widest;
};

static inline bool is_vessel(const ty_container* c)
{
    return c->def.kind == TY_CONTAINER_MESH && c->def.role == TY_CONTAINER_VESSEL;
}

static inline bool is_mould(const ty_container* c)
{
    return c->def.role == TY_CONTAINER_MOULD;
}

// Walls as planes, one a wall.
static inline bool is_planes(const ty_container* c)
{
    return c->def.kind == TY_CONTAINER_BOX && !is_mould(c);
}

// Round about the y axis.
static inline bool is_turned(const ty_container* c)
{
    return c->def.kind != TY_CONTAINER_BOX && c->def.kind != TY_CONTAINER_MESH && c->def.kind != TY_CONTAINER_ONIGIRI;
}

static inline const node* node_at(const ty_container* c, int i, int j, int k)
{
    return &c->nodes[((size_t)k * (size_t)c->size[1] + (size_t)j) * (size_t)c->size[0] + (size_t)i];
}

// container_sample.c
// Samples the distance to the mesh, or by the container's own formula where there is none.
TY_CHECKED ty_status container_field_sample(ty_container* c, const ty_mesh* mesh, ty_workers* workers, ty_error* error);

// onigiri.c
float onigiri_distance(const ty_onigiri_def* def, ty_vec3 p); // to the surface, negative inside
ty_bounds onigiri_bounds(const ty_onigiri_def* def);
TY_CHECKED ty_status onigiri_check(const ty_onigiri_def* def, ty_error* error);
