// SPDX-License-Identifier: Apache-2.0
// The slope of a heap: a column of grains at rest in a box stands free all at once and falls apart on the ground
// (Lajeunesse et al. 2005). For a cone of uniform density tan(slope) is twice the mean height over the mean radius.
#pragma once
#include "base/cmocka_all.h"
#include <stdlib.h>
#include <string.h>
#include <tsuya/generate/pile.h>

enum
{
    HEAP_VARIANTS = 4,
};

typedef struct heap_case
{
    int count;
    float friction;
    float wet_basis; // 0: dry
    uint64_t seed;
} heap_case;

static ty_element heap_grains[HEAP_VARIANTS];

static void heap_grains_make(void)
{
    ty_element_def def = ty_element_def_default();
    ty_error error;
    def.divisions = 6;
    for (int i = 0; i < HEAP_VARIANTS; i++)
        assert_int_equal(ty_element_init(&def, (ty_seed){5}, i, &heap_grains[i], &error), TY_OK);
}

static void heap_grains_free(void)
{
    for (int i = 0; i < HEAP_VARIANTS; i++)
        ty_element_term(&heap_grains[i]);
}

static ty_pile_def heap_def(const heap_case* h, const ty_container* container)
{
    ty_pile_def def = ty_pile_def_default();
    def.grains = heap_grains;
    def.grain_count = HEAP_VARIANTS;
    def.container = container;
    def.friction = h->friction;
    if (h->wet_basis > 0.0f)
        def.bridge = ty_bridge_of_moisture(h->wet_basis);
    return def;
}

static ty_container* heap_container(int kind, float edge)
{
    ty_container_def def = ty_container_def_default();
    ty_container* out;
    ty_error error;
    def.kind = kind;
    def.shape.size = ty_vec3_make(edge, edge, edge);
    def.shape.rounding = 0.0f;
    def.shape.radius = 2.0f * edge;
    assert_int_equal(ty_container_create(&def, NULL, &out, &error), TY_OK);
    return out;
}

// At rest in a box as high as wide, bodies to be freed by the caller.
static ty_body* column_make(const heap_case* h, float edge)
{
    ty_container* box = heap_container(TY_CONTAINER_BOX, edge);
    ty_pile_def def = heap_def(h, box);
    ty_pile* pile = ty_pile_create(&def);
    ty_rng rng = ty_rng_make((ty_seed){h->seed}, 0, 0);
    for (int i = 0; i < h->count; i++)
    {
        ty_body body = {.scale = 1.0f, .grain = (uint32_t)(i % HEAP_VARIANTS)};
        for (int axis = 0; axis < 3; axis++)
            (&body.position.x)[axis] = ty_rng_range(&rng, -0.9f, 0.9f) * edge;
        float u = ty_rng_float(&rng), v = ty_rng_float(&rng);
        body.rotation = ty_quat_uniform(u, v, ty_rng_float(&rng));
        ty_pile_add(pile, &body, 1);
    }
    ty_fill_top top = {.level = edge, .radius_x = edge, .radius_z = edge};
    ty_pile_inflate(pile, &top, 200, NULL);
    ty_pile_settle(pile, 1.0f, NULL, NULL);
    ty_body* out = calloc((size_t)h->count, sizeof *out);
    memcpy(out, ty_pile_bodies(pile), (size_t)h->count * sizeof *out);
    ty_pile_destroy(pile);
    ty_container_destroy(box);
    return out;
}

// Degrees, a second after the walls are gone.
static double heap_slope(const heap_case* h)
{
    float edge = 0.5f * ty_pow((float)h->count * heap_grains[0].volume / 0.55f, 1.0f / 3.0f);
    ty_body* bodies = column_make(h, edge);
    ty_container* ground = heap_container(TY_CONTAINER_GROUND, edge);
    ty_pile_def def = heap_def(h, ground);
    ty_pile* pile = ty_pile_create(&def);
    for (int i = 0; i < h->count; i++)
    {
        bodies[i].position.y += edge;
        bodies[i].velocity = bodies[i].spin = ty_vec3_make(0.0f, 0.0f, 0.0f);
    }
    ty_pile_add(pile, bodies, h->count);
    for (int i = 0; i < 2500; i++)
        ty_pile_step(pile, NULL);
    double height = 0.0, radius = 0.0;
    for (int i = 0; i < h->count; i++)
    {
        ty_vec3 p = ty_pile_bodies(pile)[i].position;
        height += (double)p.y;
        radius += sqrt((double)(p.x * p.x + p.z * p.z));
    }
    ty_pile_destroy(pile);
    ty_container_destroy(ground);
    free(bodies);
    return atan2(2.0 * height, radius) * 180.0 / 3.14159265358979;
}
