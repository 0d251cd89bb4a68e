// SPDX-License-Identifier: Apache-2.0
// How far the meshes of an aggregate reach into one another, measured on what is rendered: vertices of one within the
// closed mesh of another by crossing parity, and their distance to its surface. Knows nothing of balls or contacts.
#pragma once
#include "base/cmocka_all.h"
#include <stdlib.h>
#include <string.h>
#include <tsuya/geometry/aggregate.h>
#include <tsuya/geometry/trace.h>

typedef struct mesh_overlap
{
    float most;  // of the width
    float mean;  // of the width, over the pairs that overlap
    float pairs; // that overlap, per body
} mesh_overlap;

typedef struct overlap_body
{
    uint32_t prototype; // in the world
    const ty_mesh* mesh;
    ty_affine place, back;
    ty_vec3 center;
    float radius;
} overlap_body;

// Deepest vertex of a's mesh within b's, m.
static float depth_in(const ty_world* world, const overlap_body* a, const overlap_body* b)
{
    const ty_bounds* box = &b->mesh->bounds;
    ty_affine to = ty_affine_multiply(&b->back, &a->place);
    float size = ty_length(b->place.x), deepest = 0.0f;
    for (uint32_t v = 0; v < a->mesh->vertex_count; v++)
    {
        ty_vec3 p = ty_map_point(&to, a->mesh->positions[v]);
        if (p.x < box->low.x || p.x > box->high.x || p.y < box->low.y || p.y > box->high.y || p.z < box->low.z ||
            p.z > box->high.z || !ty_world_inside(world, b->prototype, p))
            continue;
        ty_closest closest;
        assert_true(ty_world_closest(world, b->prototype, p, 1.0f, &closest));
        deepest = ty_max(deepest, closest.distance * size);
    }
    return deepest;
}

// Of the instances with the slot (NULL: of all).
static overlap_body* bodies_take(const ty_aggregate* a, ty_world* world, const char* slot, int* count)
{
    uint32_t* number = calloc((size_t)a->prototype_count, sizeof *number);
    overlap_body* bodies = calloc(a->instance_count, sizeof *bodies);
    ty_error error;
    for (int i = 0; i < a->prototype_count; i++)
        assert_int_equal(ty_world_add_prototype(world, a->prototypes[i], &number[i], &error), TY_OK);
    assert_int_equal(ty_world_commit(world, &error), TY_OK);
    *count = 0;
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        const ty_mesh* mesh = a->prototypes[a->prototype_index[i]];
        if (slot && (mesh->slot_count < 1 || strcmp(mesh->slot_names[0], slot) != 0))
            continue;
        overlap_body* b = &bodies[(*count)++];
        *b = (overlap_body){.prototype = number[a->prototype_index[i]], .mesh = mesh, .place = a->transforms[i]};
        assert_true(ty_affine_invert(&b->place, &b->back));
        ty_vec3 half = ty_mul(ty_sub(mesh->bounds.high, mesh->bounds.low), 0.5f);
        b->center = ty_map_point(&b->place, ty_add(mesh->bounds.low, half));
        b->radius = 1.05f * ty_length(half) * ty_length(b->place.x);
    }
    free(number);
    return bodies;
}

static mesh_overlap mesh_overlap_measure(const ty_aggregate* a, const char* slot, float width)
{
    ty_world_def def = ty_world_def_default();
    ty_world* world;
    ty_error error;
    int count, pairs = 0;
    assert_int_equal(ty_world_create(&def, &world, &error), TY_OK);
    overlap_body* b = bodies_take(a, world, slot, &count);
    mesh_overlap out = {0};
    assert_true(count > 1);
    for (int i = 0; i < count; i++)
        for (int k = i + 1; k < count; k++)
        {
            if (ty_length(ty_sub(b[i].center, b[k].center)) > b[i].radius + b[k].radius)
                continue;
            float depth = ty_max(depth_in(world, &b[i], &b[k]), depth_in(world, &b[k], &b[i])) / width;
            out.most = ty_max(out.most, depth);
            out.mean += depth;
            pairs += depth > 0.0f;
        }
    out.mean /= ty_max(1.0f, (float)pairs);
    out.pairs = 2.0f * (float)pairs / (float)count;
    free(b);
    ty_world_destroy(world);
    return out;
}
